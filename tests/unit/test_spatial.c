/* test_spatial.c: random spatial mechanisms have the same accelerations and reactions in whatever
 * trees they are formulated
 *
 * Every choice of trees starts from the position and the velocities of the first one. */
#include "spatial.h"

/* under the sanitizers fewer, which show how memory is used as well */
#ifdef __SANITIZE_ADDRESS__
enum { MODELS = 5 };
#else
enum { MODELS = 20 };
#endif
enum { MOST_BODIES = 12, CHOICES = 5 };

typedef struct Compared {
    int systems;
    int reactions;
    int redundant_rows; /* equations */
    int open;           /* reactions that one of the two can't tell */
} Compared;

static void compare(const char *scene, const char *trees, const Words *names, const double *first,
                    const double *values, int of_bodies, Compared *compared)
{
    double largest[2] = {1e-3, 1e-3};

    for (int i = 0; i < names->count; i++)
        if (!isnan(first[i]))
            largest[i >= of_bodies] = fmax(largest[i >= of_bodies], fabs(first[i]));
    for (int i = 0; i < names->count; i++) {
        if (i >= of_bodies && (isnan(first[i]) || isnan(values[i]))) {
            compared->open++;
            continue;
        }
        compared->reactions += i >= of_bodies;
        if (fabs(values[i] - first[i]) <= 1e-9 * largest[i >= of_bodies])
            continue;
        test_faults++;
        printf("%s%s: %s is %.15g, wanted %.15g\n", scene, trees, names->at[i], values[i],
               first[i]);
        return;
    }
}

/* accelerations and reactions in all choices of trees */
static void check_scene(const char *scene, const char *positions, int bodies, uint64_t *random,
                        Compared *compared)
{
    Words names = {0};
    int of_bodies = 0;
    double *first = NULL;
    Text motion = {0};

    for (int choice = 0; choice < CHOICES && test_faults == 0; choice++) {
        Model *model = scene_new(scene);
        char *trees = choose_trees(model, choice, random);
        System *system;
        ResultReader *reader = NULL;
        Diag diag = {0};

        scene_add(model, trees);
        system = scene_system(model);
        if (system != NULL)
            add_guesses(model, system, positions);
        if (choice == 0 && system != NULL)
            guess_speeds(model, system, random);
        else
            scene_add(model, motion.at);
        if (system != NULL)
            reader = assembled(model, system, &diag);
        if (system != NULL && reader == NULL) {
            test_faults++;
            printf("%s%s%s: %s (%s)\n", scene, trees, positions, diag.message, diag.hint);
        }
        if (reader != NULL && condition(reader, system) > 1e-2) {
            double *values;

            if (names.count == 0)
                compared_names(model, bodies, &names, &of_bodies);
            values = values_of(model, reader, (const char *const *)names.at, names.count);
            if (first == NULL) {
                start_bodies(model, reader, bodies, "init", motions, COUNT(motions), &motion);
                first = values;
                values = NULL;
            } else {
                compare(scene, trees, &names, first, values, of_bodies, compared);
                compared->systems++;
                for (int i = 0; system_dropped(system, i) != NULL; i++)
                    compared->redundant_rows++;
            }
            mem_free(values);
        } else if (first == NULL) {
            choice = CHOICES; /* near a singular position: another model */
        }
        assembled_free(reader);
        system_free(system);
        mem_free(trees);
        model_free(model);
    }
    for (int i = 0; i < names.count; i++)
        mem_free(names.at[i]);
    LIST_FREE(names);
    mem_free(first);
    text_free(&motion);
}

static void check_models(bool loop, bool twins)
{
    uint64_t random = (loop ? 1900 : 1600) + (twins ? 3 : 0);
    Compared compared = {0};

    for (int i = 0; i < MODELS && test_faults == 0; i++) {
        int bodies = loop ? 3 + pick(&random, 10) : 1 + pick(&random, MOST_BODIES);
        Text scene = {0};
        Text positions = {0};
        char *open = random_tree_of_bodies(&random, bodies);
        Model *model = scene_new(open);
        System *system;
        ResultReader *reader = NULL;
        Diag diag = {0};

        text_add(&scene, open);
        scene_add(model, "tree joint");
        guess_joints(model, &random, &positions);
        scene_add(model, positions.at != NULL ? positions.at : "");
        system = scene_system(model);
        if (system != NULL)
            reader = assembled(model, system, &diag);
        if (reader == NULL) {
            test_faults++;
            printf("%s: %s\n", open, diag.message);
        } else {
            start_bodies(model, reader, bodies, "guess", places, COUNT(places), &positions);
            if (loop)
                close_loop(model, reader, bodies, &random, &scene);
            if (twins) {
                char *real = mem_text(scene.at, scene.length);
                char *guesses = mem_text(positions.at, positions.length);

                add_twins(real, &scene);
                add_twin_guesses(guesses, &positions);
                mem_free(real);
                mem_free(guesses);
            }
            check_scene(scene.at, positions.at, bodies, &random, &compared);
        }
        assembled_free(reader);
        system_free(system);
        model_free(model);
        mem_free(open);
        text_free(&scene);
        text_free(&positions);
    }
    printf("%s%s: %d systems, %d equations vanished, %d reactions compared, %d open\n",
           loop ? "loops" : "trees", twins ? " with virtual joints" : "", compared.systems,
           compared.redundant_rows, compared.reactions, compared.open);
    EXPECT(compared.systems > MODELS);
    EXPECT(compared.open == 0);
    EXPECT((compared.redundant_rows > 5 * MODELS) == twins);
}

static void open_chains_accelerate_alike_in_all_trees(void)
{
    check_models(false, false);
}

static void loops_accelerate_alike_in_all_trees(void)
{
    check_models(true, false);
}

/* a virtual joint in the place of a real one: its equations vanish, its reaction doesn't */
static void displaced_joints_of_open_chains_carry_the_same(void)
{
    check_models(false, true);
}

static void displaced_joints_of_loops_carry_the_same(void)
{
    check_models(true, true);
}

int main(void)
{
    RUN(open_chains_accelerate_alike_in_all_trees);
    RUN(loops_accelerate_alike_in_all_trees);
    RUN(displaced_joints_of_open_chains_carry_the_same);
    RUN(displaced_joints_of_loops_carry_the_same);
    return test_end();
}

/* test_spatial_simbody.c: random spatial mechanisms have the accelerations and reactions that
 * Simbody finds
 *
 * tests/oracle/simbody_oracle.cpp reads the statements themselves and the bodies' positions and
 * velocities; configure finds Simbody or leaves this test out. */
#include "spatial.h"

#include <unistd.h>

enum { MODELS = 24, MOST_BODIES = 12, CHOICES = 3 };

/* lines `NAME VALUE` in the order of printing */
typedef struct Answer {
    char *text;
    bool ended_well;
} Answer;

static char *oracle_path(void)
{
    const char *top = getenv("TOP_BUILDDIR");
    Text path = {0};

    text_addf(&path, "%s/simbody_oracle", top != NULL ? top : ".");
    return text_done(&path);
}

static Answer ask(const char *question)
{
    char *path = oracle_path();
    char name[] = "simbody.XXXXXX";
    int file = mkstemp(name);
    FILE *out = file >= 0 ? fdopen(file, "w") : NULL;
    Text command = {0}, text = {0};
    Answer answer = {0};
    char piece[256];
    FILE *in;

    if (out == NULL) {
        mem_free(path);
        return answer;
    }
    (void)fputs(question, out);
    (void)fclose(out);
    text_addf(&command, "'%s' <%s 2>&1", path, name);
    in = popen(command.at, "r");
    while (in != NULL && fgets(piece, sizeof piece, in) != NULL)
        text_add(&text, piece);
    answer.ended_well = in != NULL && pclose(in) == 0;
    answer.text = text_done(&text);
    (void)unlink(name);
    text_free(&command);
    mem_free(path);
    return answer;
}

static double answered(const Answer *answer, const char *name)
{
    size_t length = strlen(name);

    for (const char *line = answer->text; line != NULL && *line != '\0';) {
        if (strncmp(line, name, length) == 0 && line[length] == ' ')
            return strtod(line + length, NULL);
        line = strchr(line, '\n');
        line = line != NULL ? line + 1 : NULL;
    }
    return NAN;
}

static void state_lines(const Model *model, ResultReader *reader, int bodies, Text *text)
{
    for (int i = 0; i < bodies; i++) {
        text_addf(text, "state b%d", i);
        for (int k = 0; k < COUNT(places) + COUNT(motions); k++) {
            char name[32];

            snprintf(name, sizeof name, "b%d.%s", i,
                     k < COUNT(places) ? places[k] : motions[k - COUNT(places)]);
            text_addf(text, " %.17g", value_of(model, reader, name));
        }
        text_char(text, '\n');
    }
}

typedef struct Compared {
    int accelerations;
    int reactions;
    double worst[2]; /* of each, relative to the largest */
} Compared;

static void compare(const char *scene, const char *trees, const Answer *answer, const Words *names,
                    const double *values, int of_bodies, Compared *compared)
{
    double largest[2] = {1e-3, 1e-3};

    for (int i = 0; i < names->count; i++)
        largest[i >= of_bodies] =
            fmax(largest[i >= of_bodies], fabs(answered(answer, names->at[i])));
    for (int i = 0; i < names->count; i++) {
        bool reaction = i >= of_bodies;
        double wanted = answered(answer, names->at[i]);
        double off = fabs(values[i] - wanted) / largest[reaction];

        /* undetermined: the loop's joint repeats what others do */
        if (reaction && (isnan(values[i]) || isnan(wanted)))
            continue;
        if (reaction)
            compared->reactions++;
        else
            compared->accelerations++;
        compared->worst[reaction] = fmax(compared->worst[reaction], off);
        if (off <= 1e-9)
            continue;
        test_faults++;
        printf("%s%s: %s is %.15g, Simbody says %.15g\n", scene, trees, names->at[i], values[i],
               wanted);
        return;
    }
}

typedef struct Case {
    int bodies;
    char *scene;     /* statements */
    char *positions; /* guesses */
} Case;

static void compare_choice(const Case *c, const Model *model, ResultReader *reader,
                           const char *trees, Compared *compared)
{
    Text question = {0};
    Words names = {0};
    int of_bodies = 0;
    double *values;
    Answer answer;

    text_add(&question, c->scene);
    state_lines(model, reader, c->bodies, &question);
    answer = ask(question.at);
    compared_names(model, c->bodies, &names, &of_bodies);
    values = values_of(model, reader, (const char *const *)names.at, names.count);
    if (answer.ended_well) {
        compare(c->scene, trees, &answer, &names, values, of_bodies, compared);
    } else {
        test_faults++;
        printf("%s%s%s", question.at, trees, answer.text);
    }
    for (int i = 0; i < names.count; i++)
        mem_free(names.at[i]);
    LIST_FREE(names);
    mem_free(values);
    mem_free(answer.text);
    text_free(&question);
}

/* accelerations and reactions in trees of this choice, unless near a singular position */
static void check_choice(const Case *c, int choice, uint64_t *random, Compared *compared)
{
    Model *model = scene_new(c->scene);
    char *trees = choose_trees(model, choice, random);
    System *system;
    ResultReader *reader = NULL;
    Diag diag = {0};

    scene_add(model, trees);
    system = scene_system(model);
    if (system != NULL) {
        add_guesses(model, system, c->positions);
        guess_speeds(model, system, random);
        reader = assembled(model, system, &diag);
        if (reader == NULL) {
            test_faults++;
            printf("%s%s: %s (%s)\n", c->scene, trees, diag.message, diag.hint);
        }
    }
    if (reader != NULL && condition(reader, system) > 1e-2)
        compare_choice(c, model, reader, trees, compared);
    assembled_free(reader);
    system_free(system);
    mem_free(trees);
    model_free(model);
}

/* a tree in a random position, then closed or not, moving, in some choices of trees */
static void check_model(bool loop, uint64_t *random, Compared *compared)
{
    Case c = {.bodies = loop ? 3 + pick(random, 10) : 1 + pick(random, MOST_BODIES)};
    char *open = random_tree_of_bodies(random, c.bodies);
    Text scene = {0}, start = {0};
    Model *model;
    System *system;
    ResultReader *position = NULL;
    Diag diag = {0};

    model = scene_new(open);
    text_add(&scene, open);
    scene_add(model, "tree joint");
    guess_joints(model, random, &start);
    scene_add(model, start.at != NULL ? start.at : "");
    system = scene_system(model);
    if (system != NULL)
        position = assembled(model, system, &diag);
    if (position == NULL) {
        test_faults++;
        printf("%s: %s\n", open, diag.message);
    } else {
        start_bodies(model, position, c.bodies, "guess", places, COUNT(places), &start);
        if (loop)
            close_loop(model, position, c.bodies, random, &scene);
        c.scene = scene.at;
        c.positions = start.at;
        for (int choice = 0; choice < CHOICES && test_faults == 0; choice++)
            check_choice(&c, choice, random, compared);
    }
    assembled_free(position);
    system_free(system);
    model_free(model);
    mem_free(open);
    text_free(&scene);
    text_free(&start);
}

static void check_models(bool loop)
{
    uint64_t random = loop ? 2022 : 1994;
    Compared compared = {0};

    for (int i = 0; i < MODELS && test_faults == 0; i++)
        check_model(loop, &random, &compared);
    printf("%s: %d accelerations off by %.1e at most, %d reactions by %.1e\n",
           loop ? "loops" : "trees", compared.accelerations, compared.worst[0], compared.reactions,
           compared.worst[1]);
    EXPECT(compared.accelerations > 6 * MODELS);
    EXPECT(compared.reactions > 6 * MODELS);
}

static void open_chains_move_as_simbody_says(void)
{
    check_models(false);
}

static void loops_move_as_simbody_says(void)
{
    check_models(true);
}

int main(void)
{
    char *oracle = oracle_path();

    if (access(oracle, X_OK) != 0) {
        SKIP("spatial mechanisms against Simbody", "configure found no Simbody (libsimbody-dev)");
    } else {
        RUN(open_chains_move_as_simbody_says);
        RUN(loops_move_as_simbody_says);
    }
    mem_free(oracle);
    return test_end();
}

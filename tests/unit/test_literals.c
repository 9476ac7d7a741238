/* test_literals.c: equations outlast edits of the numbers that stand in them as parameters */
#include "scene.h"

#include "base/text.h"
#include "compile/residual.h"

enum { LINKS = 20 };

static Model *chain(bool loop)
{
    Text text = {0};
    Model *model;

    text_add(&text, "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < LINKS; i++) {
        text_addf(&text, "body b%d mass=%d inertia=[0.3, 0.4, 0.5]\n", i, i + 2);
        text_addf(&text, "arm h%d b%d [-0.5, 0, 0.%d]\n", i, i, i + 1);
        if (i == 0)
            text_add(&text, "revolute j0 ground h0\n");
        else
            text_addf(&text, "arm t%d b%d [0.5, 0, 0]\nrevolute j%d t%d h%d axis=[1, 2, %d]\n", i,
                      i - 1, i, i, i, i + 1);
    }
    if (loop)
        text_addf(&text, "arm e b%d [0.5, 0, 0]\narm g ground [3, 0, 0]\nspherical c g e\n",
                  LINKS - 1);
    model = scene_new(text.at);
    text_free(&text);
    return model;
}

static System *form(const Model *model)
{
    const SystemOptions options = {.has_lifted = true};
    Scene scene = {0};
    System *system = NULL;
    Diag diag = {0};

    EXPECT(model_scene(model, &scene, &diag) == OK &&
           system_new_view(&scene, &options, &system, &diag) == OK);
    scene_free(&scene);
    return system;
}

/* whether the equations are those of the model behind the edit too */
static bool follows(Model *model, System *system, const char *edit)
{
    Scene scene = {0};
    Diag diag = {0};
    bool follows;

    scene_add(model, edit);
    EXPECT(model_scene(model, &scene, &diag) == OK);
    follows = system_follows(system, &scene);
    EXPECT(!follows || system_revision(system) == model_revision(model));
    scene_free(&scene);
    return follows;
}

static void numbers_change_no_equation(void)
{
    Model *model = chain(false);
    System *system = form(model);
    Diag diag = {0};

    EXPECT(follows(model, system, "set b3.mass = 7\nset b4.mass = 1"));
    EXPECT(follows(model, system, "set b3.inertia = [1, 2, 2.5]"));
    EXPECT(follows(model, system, "set h5.position = [0.25, 0, -2]"));
    EXPECT(follows(model, system, "set j6.axis = [2, 3, 6]"));
    EXPECT_NEAR(model_number(model, system_lifted_constant(system, 0)), 2, 0);
    EXPECT(follows(model, system, "set b0.mass = 1/4"));
    EXPECT_NEAR(model_number(model, system_lifted_constant(system, 0)), 0.25, 0);
    EXPECT(model_undo(model, &diag) == OK && follows(model, system, ""));
    EXPECT_NEAR(model_number(model, system_lifted_constant(system, 0)), 2, 0);
    system_free(system);
    model_free(model);
}

static void what_is_no_number_there_does(void)
{
    static const char *const edits[] = {
        "set b3.mass = 0",                  /* its terms vanish */
        "set h5.position = [0.25, 0.5, 1]", /* one more */
        "set h5.position = [0, 0, 1]",      /* and none where there was one */
        "set j6.axis = [0, 1, 0]",          /* a turn about one of the axes */
        "set j6.axis = [1, 2, 8]",          /* that of j7 */
        "set b3.mass = 2*M",                /* the user's parameter */
        "gravity [0, 0, -1]",
        "spring k j3 k=1",
        "delete j4\nprismatic j4 t4 h4 axis=[1, 2, 5]",
        "tree absolute",
        "output E = b3.x",
    };

    for (int i = 0; i < COUNT(edits); i++) {
        Model *model = chain(false);
        System *system;

        scene_add(model, "M = 3");
        system = form(model);
        if (follows(model, system, edits[i])) {
            test_faults++;
            printf("%s\n", edits[i]);
        }
        system_free(system);
        model_free(model);
    }
}

static void lengths_of_a_circuit_of_joints_stay_numbers(void)
{
    Model *model = chain(true);
    System *system = form(model);

    EXPECT(follows(model, system, "set b3.mass = 7"));
    EXPECT(!follows(model, system, "set h5.position = [0.25, 0, -2]"));
    system_free(system);
    scene_add(model, "tree absolute");
    system = form(model);
    EXPECT(follows(model, system, "set h5.position = [0.125, 0, -2]"));
    system_free(system);
    model_free(model);
}

static void a_thousand_edits_take_no_room(void)
{
    static const char *const edits[] = {"set b3.mass = 7", "set b3.mass = 8",
                                        "set h5.position = [0.25, 0, -2]",
                                        "set h5.position = [0.5, 0, -1.5]"};
    Model *model = chain(false);
    System *system = form(model);
    int64_t nodes = 0;
    bool all = true;

    for (int i = 0; i < 1000; i++) {
        all = follows(model, system, edits[i % COUNT(edits)]) && all;
        if (i + 1 == COUNT(edits))
            nodes = arena_nodes(model_arena(model));
    }
    EXPECT(all);
    EXPECT(arena_nodes(model_arena(model)) == nodes);
    system_free(system);
    model_free(model);
}

static void a_program_is_made_once(void)
{
    Model *model = chain(false);
    System *system = form(model);
    ArenaMark *mark = arena_mark(model_arena(model));
    Expr inputs[2 * LINKS];
    ResidualOrder order = {.arena = model_arena(model),
                           .roots = system_run(system)->force,
                           .root_count = system_nu(system),
                           .inputs = inputs,
                           .input_count = 2 * LINKS};
    Residual *one = NULL, *same = NULL, *other = NULL;
    Diag diag = {0};

    for (int i = 0; i < LINKS; i++) {
        inputs[i] = system_q(system, i)->symbol;
        inputs[LINKS + i] = system_u(system, i)->symbol;
    }
    EXPECT(residual_new(&order, &one, &diag) == OK && residual_new(&order, &same, &diag) == OK);
    EXPECT(one == same);
    order.root_count--;
    EXPECT(residual_new(&order, &other, &diag) == OK && other != one);
    residual_free(one);
    residual_free(same);
    residual_free(other);
    arena_release(model_arena(model), mark);
    system_free(system);
    model_free(model);
}

int main(void)
{
    RUN(numbers_change_no_equation);
    RUN(what_is_no_number_there_does);
    RUN(lengths_of_a_circuit_of_joints_stay_numbers);
    RUN(a_thousand_edits_take_no_room);
    RUN(a_program_is_made_once);
    return test_end();
}

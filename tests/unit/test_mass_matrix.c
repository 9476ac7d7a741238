/* test_mass_matrix.c: M by forces and moments passed on in numbers is M written out, and what is
 * solved without it is what it solves */
#include "scene.h"

#include "base/text.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/accelerations.h"
#include "simulate/equations/articulated.h"
#include "simulate/equations/mass_matrix.h"

#include <string.h>

typedef struct Kind {
    const char *type, *keys;
} Kind;

static const Kind planar_kinds[] = {{"revolute", ""}, {"prismatic", "axis=[3, 4]"}};
static const Kind spatial_kinds[] = {
    {"revolute", "axis=[1, 2, 2]"}, {"prismatic", "axis=[2, 3, 6]"}, {"revolute", "axis=z"},
    {"cylindrical", "axis=y"},      {"universal", "axes=[x, y]"},    {"screw", "axis=x pitch=0.1"},
};

static void add_body(Text *text, int i, int before, bool planar, uint64_t *random)
{
    const char *z = planar ? "]" : ", 0.3]";
    const Kind *kind = planar ? &planar_kinds[(int)test_uniform(random, 0, COUNT(planar_kinds))]
                              : &spatial_kinds[(int)test_uniform(random, 0, COUNT(spatial_kinds))];
    const bool turns = strcmp(kind->type, "revolute") == 0;
    const bool backward = turns && test_uniform(random, 0, 1) < 0.3;

    text_addf(text, "body b%d mass=%g inertia=", i, test_uniform(random, 0, 2));
    text_addf(text, planar ? "%g\n" : "[%g, 1, 2, 0.1, 0.2, 0.3]\n", test_uniform(random, 1, 2));
    text_addf(text, "arm h%d b%d [%g, 0.1%s%s\n", i, i, test_uniform(random, -1, 1), z,
              planar ? "" : " rotation=x(20 deg)");
    if (before < 0)
        text_addf(text, "arm t%d ground [0.1, 0.2%s\n", i, z);
    else
        text_addf(text, "arm t%d b%d [%g, 0.5%s\n", i, before, test_uniform(random, -1, 1), z);
    text_addf(text, backward ? "%s j%d h%d t%d %s\n" : "%s j%d t%d h%d %s\n", kind->type, i, i, i,
              kind->keys);
    if (turns && test_uniform(random, 0, 1) < 0.3)
        text_addf(text, "motor M%d j%d e 0 R=1 L=0.1 Kt=1 Kv=1 J=0.2 ratio=3\n", i, i);
}

/* a tree of bodies on joints of every kind, some passed from their heads, some with a rotor */
static char *long_mechanism(uint64_t *random, bool planar, int bodies)
{
    Text text = {0};

    text_add(&text, planar ? "scene planar\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < bodies; i++)
        add_body(&text, i, i < 3 ? i - 1 : (int)test_uniform(random, i - 3, i), planar, random);
    return text_done(&text);
}

static double *numbers_of(const Expr *needs, int count, SceneState *state)
{
    double *numbers = NEW_ARRAY(double, count);

    for (int i = 0; i < count; i++)
        numbers[i] = expr_evaluate(needs[i], scene_value, state);
    return numbers;
}

/* M du is the force that du was found for */
static void expect_solved(const System *system, const double *mass, SceneState *state)
{
    Articulated *articulated = articulated_new(system);
    const int n = system_nu(system);
    uint64_t random = state->seed;
    double *force = NEW_ARRAY(double, n), *du = NEW_ARRAY(double, n), *numbers;
    int count;
    const Expr *needs;

    EXPECT(articulated != NULL);
    if (articulated == NULL)
        return;
    needs = articulated_needs(articulated, &count);
    numbers = numbers_of(needs, count, state);
    for (int j = 0; j < n; j++)
        force[j] = test_uniform(&random, -1, 1);
    for (int again = 0; again < 2; again++) { /* the last numbers leave nothing */
        EXPECT(articulated_factor(articulated, numbers));
        articulated_solve(articulated, force, du);
    }
    for (int j = 0; j < n; j++) {
        double sum = 0, terms = 1;

        for (int k = 0; k < n; k++) {
            sum += mass[j * n + k] * du[k];
            terms += fabs(mass[j * n + k] * du[k]);
        }
        EXPECT_NEAR(sum, force[j], 1e-11 * terms);
    }
    MEM_FREE(force, du, numbers);
    articulated_free(articulated);
}

static void compare_masses(Model *model, System *system, uint64_t seed)
{
    MassMatrix *matrix = mass_matrix_new(system);
    const int n = system_nu(system);
    SceneState state = {model, seed};
    int count;
    const Expr *needs;
    double *numbers, *mass;
    Diag diag = {0};

    EXPECT(matrix != NULL && system_form_mass(system, &diag) == OK);
    if (matrix == NULL)
        return;
    needs = mass_matrix_needs(matrix, &count);
    numbers = numbers_of(needs, count, &state);
    mass_matrix_set(matrix, numbers);
    mass_matrix_set(matrix, numbers); /* the last numbers leave nothing */
    mass = pattern_spread(mass_matrix_places(matrix), mass_matrix_at(matrix));
    for (int i = 0; i < n * n; i++) {
        const double written = expr_evaluate(system_run(system)->mass[i], scene_value, &state);

        EXPECT_NEAR(mass[i], written, 1e-9 * (1 + fabs(written)));
    }
    if (system_m(system) == 0) /* else rotors tie speeds together */
        expect_solved(system, mass, &state);
    MEM_FREE(numbers, mass);
    mass_matrix_free(matrix);
}

static void M_passed_on_is_M_written_out(void)
{
    uint64_t random = 1971;

    for (int i = 0; i < 12 && test_faults == 0; i++) {
        char *text = long_mechanism(&random, i % 2 == 0, 17 + i);
        Model *model = scene_new(text);
        System *system;

        scene_add(model, i % 6 == 5 ? "tree absolute" : "tree joint");
        system = scene_system(model);
        if (system != NULL)
            compare_masses(model, system, 17U + (unsigned)i);
        if (test_faults > 0)
            printf("    in\n%s", text);
        system_free(system);
        model_free(model);
        mem_free(text);
    }
}

static void compare_accelerations(System *system, SceneState *state)
{
    const int n = system_nu(system);
    Expr *told = NEW_ARRAY(Expr, 3 * n);
    double *du;

    EXPECT(system_pushes(system, told + 2 * n, NULL) == OK);
    EXPECT(system_accelerations(system, system_run(system)->force, told + 2 * n, told, told + n) !=
           ELIMINATED_NOT);
    du = numbers_of(told, told[0] != NULL ? 2 * n : 0, state);
    for (int j = 0; j < n && told[0] != NULL; j++) {
        const double force = expr_evaluate(system_run(system)->force[j], scene_value, state);
        double sum = 0, terms = fabs(force);

        for (int k = 0; k < n; k++) {
            const Expr entry = system_run(system)->mass[j * n + k];
            const double part = expr_evaluate(entry, scene_value, state) * du[k];

            sum += part;
            terms += fabs(part);
        }
        EXPECT_NEAR(sum, force, 1e-11 * terms);
        EXPECT(du[n + j] > 0.99); /* a pivot is no more than the diagonal entry */
    }
    MEM_FREE(told, du);
}

static void few_speeds_are_eliminated_in_symbols(void)
{
    uint64_t random = 7;

    for (int i = 0; i < 24 && test_faults == 0; i++) {
        char *text = long_mechanism(&random, i % 2 == 0, 1 + i / 3);
        Model *model = scene_new(text);
        System *system;

        scene_add(model, "tree joint");
        system = scene_system(model);
        if (system != NULL)
            compare_accelerations(system, &(SceneState){model, 3U + (unsigned)i});
        if (test_faults > 0)
            printf("    in\n%s", text);
        system_free(system);
        model_free(model);
        mem_free(text);
    }
}

/* that joints turn about no axis costs them a matrix each, not one for each vector: so many
 * operations a joint */
static void turns_askew_are_a_matrix_each(void)
{
    enum { BODIES = 6, MOST = 550 };
    Text text = {0};
    Model *model;
    System *system;
    Expr told[3 * BODIES];
    OpCount ops;

    text_add(&text, "gravity [0, 0, -9.81]\narm t0 ground [0, 0, 1]\n");
    for (int i = 0; i < BODIES; i++) {
        text_addf(&text, "body b%d mass=%d inertia=[1, 2, 3, 0.1, 0.2, 0.3]\n", i, i + 1);
        text_addf(&text, "arm h%d b%d [-0.4, 0.2, 0.1]\narm t%d b%d [0.5, 0.2, 0.3]\n", i, i, i + 1,
                  i);
        text_addf(&text, "revolute j%d t%d h%d axis=%s\n", i, i, i,
                  i % 2 == 0 ? "[1, 2, 2]" : "[2, 3, 6]");
    }
    text_add(&text, "tree joint\n");
    model = scene_new(text.at);
    system = scene_system(model);
    EXPECT(system != NULL && system_nu(system) == BODIES);
    EXPECT(system_pushes(system, told + 2 * (ptrdiff_t)BODIES, NULL) == OK);
    EXPECT(system_accelerations(system, system_run(system)->force, told + 2 * (ptrdiff_t)BODIES,
                                told, told + BODIES) == ELIMINATED_ALONG_TREES);
    ops = expr_count_shared(told, BODIES);
    EXPECT(ops.add + ops.mul < MOST * BODIES);
    system_free(system);
    model_free(model);
    text_free(&text);
}

int main(void)
{
    RUN(turns_askew_are_a_matrix_each);
    RUN(few_speeds_are_eliminated_in_symbols);
    RUN(M_passed_on_is_M_written_out);
    return test_end();
}

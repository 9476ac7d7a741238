/* test_constrained.c: accelerations and multipliers eliminated in symbols are those of the
 * equations by dense factors, and of four-bars by hand */
#include "scene.h"

#include "base/text.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/reduced/constrained.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/motion.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#define GRAVITY 9.81

/* --- against dense factors --- */

/* a tree of bodies, and joints that close loops in it */
static char *looped(uint64_t *random, bool planar, int bodies, int loops)
{
    Text text = {0};

    text_add(&text, planar ? "scene planar\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < bodies; i++) {
        const int before = i < 2 ? i - 1 : (int)test_uniform(random, i - 2, i);
        const char *z = planar ? "]" : ", 0.3]";

        text_addf(&text, "body b%d mass=%g inertia=", i, test_uniform(random, 0.5, 2));
        text_addf(&text, planar ? "%g\n" : "[%g, 1, 2, 0.1, 0.2, 0.3]\n",
                  test_uniform(random, 1, 2));
        text_addf(&text, "arm h%d b%d [%g, 0.1%s\n", i, i, test_uniform(random, -1, 1), z);
        text_addf(&text, "arm e%d b%d [%g, 0.7%s\n", i, i, test_uniform(random, -1, 1), z);
        if (before < 0)
            text_addf(&text, "revolute j%d ground h%d%s\n", i, i, planar ? "" : " axis=[1, 2, 2]");
        else if (planar || i % 3 == 0)
            text_addf(&text, "revolute j%d b%d h%d\n", i, before, i);
        else
            text_addf(&text, "spherical j%d b%d h%d\n", i, before, i);
    }
    for (int i = 0; i < loops; i++)
        text_addf(&text, "%s c%d e%d e%d\n", planar ? "revolute" : "spherical", i,
                  bodies - 1 - 3 * i, bodies - 3 - 3 * i);
    return text_done(&text);
}

typedef struct Dense {
    int nu, m;
    double *mass, *rows, *force, *gamma, *asked;
} Dense;

static double value(Expr e, SceneState *state)
{
    return expr_evaluate(e, scene_value, state);
}

static Dense dense_new(System *system, SceneState *state)
{
    const EquationForm *r = system_run(system);
    const int nu = system_nu(system), m = system_m(system);
    Dense d = {.nu = nu, .m = m};

    d.mass = NEW_ARRAY(double, nu *nu);
    d.rows = NEW_ARRAY(double, m *nu);
    d.force = NEW_ARRAY(double, nu);
    d.gamma = NEW_ARRAY(double, m);
    d.asked = NEW_ARRAY(double, m);
    for (int i = 0; i < nu * nu; i++)
        d.mass[i] = value(r->mass[i], state);
    for (int i = 0; i < m * nu; i++)
        d.rows[i] = value(r->phi_u[i], state);
    for (int j = 0; j < nu; j++)
        d.force[j] = value(r->force[j], state);
    for (int k = 0; k < m; k++) {
        d.gamma[k] = value(r->gamma[k], state);
        d.asked[k] = value(system_multiplier(system, k), state);
    }
    return d;
}

static void dense_free(Dense *d)
{
    MEM_FREE(d->mass, d->rows, d->force, d->gamma, d->asked);
}

/* [M G^T; G 0] x = [top; bottom]; top may be NULL for 0 */
static void dense_solve(const Dense *d, const double *top, const double *bottom, double *x)
{
    const int n = d->nu + d->m;
    gsl_matrix *a = gsl_matrix_calloc((size_t)n, (size_t)n);
    gsl_vector *b = gsl_vector_calloc((size_t)n);
    gsl_vector_view out = gsl_vector_view_array(x, (size_t)n);
    gsl_permutation *p = gsl_permutation_alloc((size_t)n);
    int sign;

    for (int i = 0; i < d->nu; i++)
        for (int j = 0; j < d->nu; j++)
            gsl_matrix_set(a, (size_t)i, (size_t)j, d->mass[i * d->nu + j]);
    for (int k = 0; k < d->m; k++)
        for (int j = 0; j < d->nu; j++) {
            gsl_matrix_set(a, (size_t)d->nu + (size_t)k, (size_t)j, d->rows[k * d->nu + j]);
            gsl_matrix_set(a, (size_t)j, (size_t)d->nu + (size_t)k, d->rows[k * d->nu + j]);
        }
    for (int i = 0; i < n; i++)
        gsl_vector_set(b, (size_t)i,
                       i < d->nu        ? (top != NULL ? top[i] : 0)
                       : bottom != NULL ? bottom[i - d->nu]
                                        : 0);
    (void)gsl_linalg_LU_decomp(a, p, &sign);
    (void)gsl_linalg_LU_solve(a, p, b, &out.vector);
    gsl_permutation_free(p);
    gsl_vector_free(b);
    gsl_matrix_free(a);
}

static double largest(const double *x, int count)
{
    double most = 0;

    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* p_k is the k-th diagonal entry of G M^-1 G^T, whatever the order */
static void expect_taken(const Dense *d, const Constrained *solved, SceneState *state)
{
    const Dense free = {.nu = d->nu, .mass = d->mass};
    double *x = NEW_ARRAY(double, d->nu);

    for (int k = 0; k < d->m; k++) {
        double sum = 0;

        dense_solve(&free, d->rows + (ptrdiff_t)k * d->nu, NULL, x);
        for (int j = 0; j < d->nu; j++)
            sum += d->rows[k * d->nu + j] * x[j];
        EXPECT_NEAR(value(solved->taken[k], state), sum, 1e-9 * (1 + sum));
        EXPECT(value(solved->pivot[k], state) > 0);
        EXPECT(value(solved->pivot[k], state) < (1 + 1e-9) * sum);
    }
    mem_free(x);
}

/* *waiting: how many speeds are eliminated behind the rows; *looked_at: of how many rows pivots are
 * told; each may be NULL */
static void compare(System *system, SceneState *state, int *waiting, int *looked_at)
{
    const int nu = system_nu(system), m = system_m(system);
    double *x = NEW_ARRAY(double, nu + m), *s = NEW_ARRAY(double, nu + m), size, step;
    int *rows = NEW_ARRAY(int, m);
    Constrained *solved;
    Diag diag = {0};
    Dense d;

    for (int k = 0; k < m; k++)
        rows[k] = k;
    /* before M is written out: long mechanisms do without */
    solved = constrained_new(system, rows, m, system_run(system)->force, system_run(system)->gamma,
                             INFINITY);
    EXPECT(solved != NULL && m > 0 && system_form_mass(system, &diag) == OK);
    if (solved == NULL)
        return;
    d = dense_new(system, state);
    dense_solve(&d, d.force, d.gamma, x);
    dense_solve(&d, NULL, d.asked, s);
    size = largest(x, nu + m);
    step = largest(s, nu);
    for (int j = 0; j < nu; j++) {
        EXPECT_NEAR(value(solved->acceleration[j], state), x[j], 1e-8 * size);
        EXPECT_NEAR(value(solved->step[j], state), s[j], 1e-8 * step);
        EXPECT(value(solved->excess[j], state) > (solved->left_count > 0   ? 0
                                                  : solved->looked_at == 0 ? 0.5
                                                                           : 1) -
                                                     1e-12);
    }
    for (int i = 0; i < solved->left_count; i++) {
        EXPECT(value(solved->left[i], state) > 0);
        EXPECT(value(solved->left[i], state) < 1 + 1e-12);
    }
    if (waiting != NULL)
        *waiting = solved->left_count;
    for (int k = 0; k < m; k++)
        EXPECT_NEAR(value(solved->multiplier[k], state), x[nu + k], 1e-8 * size);
    if (solved->looked_at > 0)
        expect_taken(&d, solved, state);
    if (looked_at != NULL)
        *looked_at = solved->looked_at;
    dense_free(&d);
    constrained_free(solved);
    MEM_FREE(x, s, rows);
}

static void symbols_solve_what_dense_factors_solve(void)
{
    uint64_t random = 1904;

    for (int i = 0; i < 16 && test_faults == 0; i++) {
        char *text = looped(&random, i % 2 == 0, 6 + i / 2 + (i > 11 ? 8 : 0), i % 4 < 2 ? 1 : 2);
        Model *model = scene_new(text);
        System *system;

        scene_add(model, i % 4 < 2 ? "tree joint" : "tree absolute");
        system = scene_system(model);
        if (system != NULL)
            compare(system, &(SceneState){model, 5U + (unsigned)i}, NULL, NULL);
        if (test_faults > 0)
            printf("    in\n%s", text);
        system_free(system);
        model_free(model);
        mem_free(text);
    }
}

/* a tree of bodies, either of which is a joint's tail */
static char *hanging(uint64_t *random, bool planar, int bodies)
{
    const char *joint = planar ? "revolute" : "spherical";
    Text text = {0};

    text_add(&text, planar ? "scene planar\ngravity [0, -9.81]\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < bodies; i++) {
        const int before = i == 0 ? -1 : (int)test_uniform(random, 0, i);
        const char *z = planar ? "]" : ", 0.3]";

        text_addf(&text, "body b%d mass=%g inertia=", i, test_uniform(random, 0.5, 2));
        text_addf(&text, planar ? "%g" : "[%g, 1, 2, 0.1, 0.2, 0.3]", test_uniform(random, 1, 2));
        text_addf(&text, "\narm h%d b%d [%g, 0.1%s\n", i, i, test_uniform(random, -1, 1), z);
        text_addf(&text, "arm e%d b%d [%g, 0.7%s\n", i, i, test_uniform(random, -1, 1), z);
        if (before < 0)
            text_addf(&text, "%s j%d ground h%d\n", joint, i, i);
        else if (i % 2 == 0)
            text_addf(&text, "%s j%d e%d h%d\n", joint, i, before, i);
        else
            text_addf(&text, "%s j%d h%d e%d\n", joint, i, i, before);
    }
    return text_done(&text);
}

/* where each row has an entry of 1 at a speed that those behind it haven't: no pivots of rows,
 * which can't become dependent */
static void rows_of_trees_tell_speeds(void)
{
    uint64_t random = 1906;

    for (int i = 0; i < 12 && test_faults == 0; i++) {
        char *text = hanging(&random, i % 3 < 2, 2 + i);
        Model *model = scene_new(text);
        System *system;
        int looked_at = -1;

        scene_add(model, "tree absolute");
        system = scene_system(model);
        if (system != NULL)
            compare(system, &(SceneState){model, 17U + (unsigned)i}, NULL, &looked_at);
        EXPECT(i % 3 == 2 || looked_at == 0); /* in space it may take more products */
        if (test_faults > 0)
            printf("    in\n%s", text);
        system_free(system);
        model_free(model);
        mem_free(text);
    }
}

/* What takes too many products, or nodes, is given up, and the next one is not to miss anything. */
static void what_is_too_large_is_given_up(void)
{
    uint64_t random = 1905;
    char *text = looped(&random, true, 8, 1);
    Model *model = scene_new(text);
    System *system = scene_system(model);
    Arena *arena = system_arena(system);
    const EquationForm *r = system_run(system);
    const int m = system_m(system);
    int *rows = NEW_ARRAY(int, m);
    int64_t limit;
    Constrained *solved;

    for (int k = 0; k < m; k++)
        rows[k] = k;
    EXPECT(constrained_new(system, rows, m, r->force, r->gamma, 10) == NULL);
    EXPECT(arena_status(arena) == OK);
    limit = arena_limit(arena, arena_nodes(arena) + 5);
    EXPECT(constrained_new(system, rows, m, r->force, r->gamma, INFINITY) == NULL);
    EXPECT(arena_status(arena) == OK);
    (void)arena_limit(arena, limit);
    solved = constrained_new(system, rows, m, r->force, r->gamma, INFINITY);
    EXPECT(solved != NULL && m > 0);
    constrained_free(solved);
    system_free(system);
    model_free(model);
    MEM_FREE(rows, text);
}

/* a platform on legs of two links each, in the trees in which it waits for them */
static Model *legged(uint64_t *random, int legs)
{
    Text text = {0}, tree = {0};
    Model *model;

    text_add(&text, "scene planar\nbody m mass=8 inertia=0.3\n");
    text_add(&tree, "tree m");
    for (int i = 0; i < legs; i++) {
        text_addf(&text, "arm g%d ground [%g, %g]\n", i, test_uniform(random, -1, 1),
                  test_uniform(random, -1, 1));
        text_addf(&text, "arm p%d m [%g, %g]\n", i, test_uniform(random, -1, 1),
                  test_uniform(random, -1, 1));
        text_addf(&text, "body a%d mass=%g inertia=1\nbody b%d mass=%g inertia=1\n", i,
                  test_uniform(random, 0.5, 2), i, test_uniform(random, 0.5, 2));
        text_addf(&text, "arm l%d a%d [-0.4, 0]\narm k%d a%d [0.5, 0]\n", i, i, i, i);
        text_addf(&text, "arm j%d b%d [-0.3, 0]\narm e%d b%d [0.6, 0]\n", i, i, i, i);
        text_addf(&text, "revolute s%d g%d l%d\nrevolute t%d k%d j%d\nrevolute h%d e%d p%d\n", i, i,
                  i, i, i, i, i, i, i);
        text_addf(&tree, " s%d t%d", i, i);
    }
    model = scene_new(text.at);
    scene_add(model, tree.at);
    text_free(&text);
    text_free(&tree);
    return model;
}

static void a_platform_waits_for_its_legs(void)
{
    uint64_t random = 2026;

    for (int legs = 3; legs <= 12 && test_faults == 0; legs++) {
        Model *model = legged(&random, legs);
        System *system = scene_system(model);
        int waiting = 0;

        if (system != NULL)
            compare(system, &(SceneState){model, 11U + (unsigned)legs}, &waiting, NULL);
        EXPECT(legs < 6 || waiting == 3);
        if (test_faults > 0)
            printf("    of %d legs\n", legs);
        system_free(system);
        model_free(model);
    }
}

/* --- against four-bars by hand --- */

#define OFF 1e-4 /* of states, m or rad, and of their rates */

/* cranks of 1 m that stand on the ground 1 m apart, side by side, and couplers between their tops
 */
static char *parallelograms(int n)
{
    Text text = {0};

    text_addf(&text, "scene planar\ngravity [0, -%g]\n", GRAVITY);
    for (int i = 0; i <= n; i++)
        text_addf(&text,
                  "body c%d mass=1 inertia=1/12\narm g%d ground [%d, 0]\narm cl%d c%d [0, -1/2]\n"
                  "arm ch%d c%d [0, 1/2]\nrevolute a%d g%d cl%d\n",
                  i, i, i, i, i, i, i, i, i, i);
    for (int i = 0; i < n; i++)
        text_addf(&text,
                  "body k%d mass=1 inertia=1/12\narm kl%d k%d [-1/2, 0]\narm kr%d k%d [1/2, 0]\n"
                  "revolute l%d ch%d kl%d\nrevolute r%d kr%d ch%d\n",
                  i, i, i, i, i, i, i, i, i, i, i + 1);
    return text_done(&text);
}

/* its coordinate and rate where all cranks lean by `angle` and turn with `speed` */
static void place_one(const char *name, double angle, double speed, double *q, double *u)
{
    const char kind = name[0];
    const char *component = strchr(name, '.');
    const int i = (int)strtol(name + 1, NULL, 10);
    const double reach = kind == 'c' ? 0.5 : 1;

    if (component == NULL) { /* of joints: couplers stay level */
        *q = kind == 'l' ? -angle : angle;
        *u = kind == 'l' ? -speed : speed;
    } else if (component[1] == 'x') {
        *q = i + (kind == 'k' ? 0.5 : 0) - reach * sin(angle);
        *u = -reach * speed * cos(angle);
    } else if (component[1] == 'y') {
        *q = reach * cos(angle);
        *u = -reach * speed * sin(angle);
    } else {
        *q = kind == 'c' ? angle : 0;
        *u = kind == 'c' ? speed : 0;
    }
}

static void place(const System *system, double angle, double speed, double *y)
{
    const int n = system_n(system);

    for (int i = 0; i < n; i++)
        place_one(system_q(system, i)->name, angle, speed, &y[i], &y[n + i]);
}

/* whether crank 0 has the acceleration that it has by hand */
static void expect_motion(Motion *motion, const System *system, int n, double angle, double speed)
{
    const int length = motion_length(motion);
    const double by_hand = GRAVITY * sin(angle) * ((n + 1) / 2.0 + n) / ((n + 1) / 3.0 + n);
    double *y = NEW_ARRAY(double, length);
    Solved solved;

    place(system, angle, speed, y);
    EXPECT(motion_solve(motion, 0, y, &solved));
    for (int i = 0; i < system_n(system); i++) {
        const char *name = system_q(system, i)->name;

        if (strcmp(name, "a0") == 0 || strcmp(name, "c0.theta") == 0)
            EXPECT_NEAR(solved.acceleration[i], by_hand, 1e-11 * n * n * GRAVITY);
    }
    mem_free(y);
}

/* the same where a step begins, up to near the flat position, where its rates are those of the
 * nearest state */
static void expect_steps(Motion *motion, const System *system, int n)
{
    const Ode *ode = motion_ode(motion);
    const int length = motion_length(motion);
    double *y = NEW_ARRAY(double, length), *rates = NEW_ARRAY(double, length);

    for (double off = 0.6; off > 0.02; off /= 1.3) {
        const double angle = asin(1) - off;
        const double by_hand = GRAVITY * sin(angle) * ((n + 1) / 2.0 + n) / ((n + 1) / 3.0 + n);

        place(system, angle, 1.5, y);
        ode->begin(ode->context, 0, y, 1e-3);
        EXPECT(ode->rate(ode->context, 0, y, rates));
        for (int i = 0; i < system_n(system); i++) {
            const char *name = system_q(system, i)->name;

            if (strcmp(name, "a0") == 0 || strcmp(name, "c0.theta") == 0)
                EXPECT_NEAR(rates[system_n(system) + i], by_hand, 1e-11 * n * n / (off * off));
        }
    }
    MEM_FREE(y, rates);
}

/* A state off by a little is brought back by factors and by what is eliminated: to the nearest in
 * other metrics, so no farther than by what it was off, times what masses differ by; */
static void expect_near(Motion *motion, const System *system)
{
    const int all = 2 * system_n(system), length = motion_length(motion);
    double *y = NEW_ARRAY(double, length), *off = NEW_ARRAY(double, length);
    double position, velocity, moved = 0;

    place(system, 0.7, 1.2, off);
    for (int i = 0; i < all; i++)
        off[i] += OFF * sin(1 + i);
    memcpy(y, off, (size_t)length * sizeof(double));
    EXPECT(motion_project(motion, 0, y));
    motion_residuals(motion, 0, y, &position, &velocity);
    EXPECT(position < 1e-12 && velocity < 1e-12);
    for (int i = 0; i < all; i++)
        moved = fmax(moved, fabs(y[i] - off[i]));
    EXPECT(moved > 0 && moved < 12 * OFF);
    MEM_FREE(y, off);
}

/* speeds off by a little alike */
static void projected(Motion *motion, const System *system, double *y)
{
    const int n = system_n(system);

    place(system, 0.7, 1.2, y);
    for (int i = 0; i < n; i++)
        y[n + i] += OFF * sin(1 + i);
    EXPECT(motion_project(motion, 0, y));
}

/* foreseen: elimination is asked for by what is to come */
static void expect_alike(const Equations *eq, Motion *motion, const System *system, int n,
                         bool foreseen)
{
    const int length = motion_length(motion), all = 2 * system_n(system);
    double *before = NEW_ARRAY(double, length), *after = NEW_ARRAY(double, length);
    int64_t factored;
    Diag diag = {0};

    /* it hasn't paid yet, and won't in as many more steps as there were */
    EXPECT(motion_try_coordinate_partitioning(motion, 1e9, &diag) == OK && eq->eliminated == NULL);
    for (int i = 0; i < (foreseen ? MOTION_FACTORS_SEEN : MOTION_FACTORS_PAID - 1); i++)
        expect_motion(motion, system, n, 0.4 + 1e-4 * i, -1.5);
    EXPECT(motion_try_coordinate_partitioning(motion, foreseen ? 2 : 0, &diag) == OK &&
           eq->eliminated == NULL);
    expect_motion(motion, system, n, 0.3, -1.5);
    projected(motion, system, before);
    expect_near(motion, system);
    EXPECT(motion_try_coordinate_partitioning(motion, foreseen ? 30 : 0, &diag) == OK &&
           eq->eliminated != NULL);
    factored = motion_counts(motion).factorisations;
    for (int i = 0; i < 6; i++) /* near the flat position, where factors are due again, too */
        expect_motion(motion, system, n, 0.3 + 0.25 * i, 2 - 0.7 * i);
    EXPECT(motion_counts(motion).factorisations >= factored + 6);
    expect_steps(motion, system, n);
    projected(motion, system, after);
    expect_near(motion, system);
    for (int i = 0; i < all; i++)
        EXPECT_NEAR(after[i], before[i], 1e-12);
    MEM_FREE(before, after);
}

static double parameter(void *model, Expr symbol)
{
    return model_parameter_value(model, symbol);
}

static void measure(int n, const char *coordinates, bool foreseen)
{
    char *text = parallelograms(n);
    Model *model = scene_new(text);
    Parameters parameters = {.value = parameter, .context = model};
    CompiledEquations *numbers = NULL;
    VariableIndex *layout;
    System *system;
    Diag diag = {0};

    scene_add(model, coordinates);
    system = scene_system(model);
    layout = variable_index_new(system);
    EXPECT(compiled_new(layout, &parameters, &numbers, &diag) == OK);
    if (numbers != NULL) {
        int *rows = NEW_ARRAY(int, layout->m);
        Motion *motion;

        for (int k = 0; k < layout->m; k++)
            rows[k] = k;
        motion =
            motion_new(compiled_equations(numbers),
                       &(MotionOptions){.rows = rows, .row_count = layout->m, .tolerance = 1e-9});
        expect_alike(compiled_equations(numbers), motion, system, n, foreseen);
        motion_free(motion);
        mem_free(rows);
    }
    compiled_free(numbers);
    parameters_free(&parameters);
    variable_index_free(layout);
    system_free(system);
    model_free(model);
    mem_free(text);
}

static void four_bars_move_as_by_hand(void)
{
    static const int cells[] = {1, 3, 8};

    for (int i = 0; i < COUNT(cells) && test_faults == 0; i++) {
        measure(cells[i], "tree joint", i == 1);
        measure(cells[i], "tree absolute", i != 1);
    }
}

int main(void)
{
    RUN(symbols_solve_what_dense_factors_solve);
    RUN(rows_of_trees_tell_speeds);
    RUN(what_is_too_large_is_given_up);
    RUN(a_platform_waits_for_its_legs);
    RUN(four_bars_move_as_by_hand);
    return test_end();
}

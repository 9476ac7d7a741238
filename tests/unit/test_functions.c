/* test_functions.c: a model as functions of numbers, for programs: against closed forms, the
 * session's own values, difference quotients, and itself in other lanes and threads */
#include "../random.h"
#include "session_kit.h"

#include <threads.h>

enum { ROOM = 60, LANES = 8 };

/* a model, its evaluator, and a state of it in each lane */
typedef struct Lab {
    ct_model *model;
    ct_evaluator *evaluator;
    int lanes, np, ny, ns;
    double p[ROOM * LANES], t[LANES], y[ROOM * LANES], s[ROOM * LANES];
} Lab;

#define SWINGING                                                                                   \
    "scene planar; gravity [0, -9.81]; L = 0.5 m; m = 2\n"                                         \
    "body bob mass=m inertia=0.01; arm top bob [0, L]; revolute h ground top; tree h\n"            \
    "init h = 30 deg, h' = 2\n"
#define ARM                                                                                        \
    "scene planar; gravity [0, -9.81]; L = 0.4; T1 = 3; kt = 0.3\n"                                \
    "body a mass=3 inertia=0.05; body b mass=2 inertia=0.02\n"                                     \
    "arm a1 a [-L/2, 0]; arm a2 a [L/2, 0]; arm b1 b [-L/2, 0]\n"                                  \
    "revolute h1 ground a1; revolute h2 a2 b1; actuator act h1 torque=T1\n"                        \
    "vsource E k 0 6; motor M h2 k 0 R=1 L=0.01 Kt=kt Kv=kt\n"                                     \
    "output power = E.v*M.i; output high = b.y\ninit h1 = 0.3, h2 = -0.7, h1' = 1, M.i = 2\n"
#define FOUR_BAR                                                                                   \
    "scene planar; gravity [0, -9.81]; r = 0.3\n"                                                  \
    "body a mass=1 inertia=0.01; body b mass=2 inertia=0.05; body c mass=1 inertia=0.02\n"         \
    "arm a1 a [-r/2, 0]; arm a2 a [r/2, 0]; arm b1 b [-0.4, 0]; arm b2 b [0.4, 0]\n"               \
    "arm c1 c [-0.3, 0]; arm c2 c [0.3, 0]; arm g ground [0.9, 0]\n"                               \
    "revolute h1 ground a1; revolute h2 a2 b1; revolute h3 b2 c2; revolute h4 g c1\n"              \
    "init h1 = 1.1, h1' = 3\n"
/* one crank too many: hinges of the coupler repeat each other */
#define PARALLEL                                                                                   \
    "scene planar; gravity [0, -9.81]; m = 2; body a mass=m inertia=1; body b mass=1 inertia=1\n"  \
    "body d mass=1 inertia=1; body c mass=1 inertia=1; arm gb ground [1, 0]\n"                     \
    "arm gd ground [2, 0]; arm a1 a [0, 1]; arm b1 b [0, 1]; arm d1 d [0, 1]\n"                    \
    "arm cb c [1, 0]; arm cd c [2, 0]; revolute h1 ground a; revolute h2 gb b\n"                   \
    "revolute h3 gd d; revolute h4 a1 c; revolute h5 b1 cb; revolute h6 d1 cd\n"                   \
    "tree h1 h2 h3 h4; output push = h5.fx + 2*h6.fx; output share = h5.fx; init h1 = 0.4\n"
#define IN_SPACE                                                                                   \
    "gravity [0, -9.81, 0]; m = 2; body a mass=m inertia=[1, 2, 3]\n"                              \
    "body b mass=1 inertia=[1, 1, 2]; body c mass=1 inertia=[2, 1, 1]\n"                           \
    "arm a2 a [1, 0, 0]; arm b2 b [0, 1, 0]; arm c0 c [0, -1, 0]; arm a1 a [-0.2, 0, 0]\n"         \
    "arm g2 ground [1.2, 0, 0]; revolute j1 ground a1 axis=z; revolute j2 a2 b axis=z\n"           \
    "revolute j3 c0 b2 axis=z; revolute j4 g2 c axis=z; tree absolute\n"                           \
    "output high = a.wz; output share = j2.fz; init j1 = 0.2; guess a.x = 0.2\n"
#define RECTIFIER                                                                                  \
    "vsource E a 0 2 + sin(t); Is = 1e-9; diode D a b Is=Is; resistor R b 0 100\n"                 \
    "capacitor C b 0 1 uF; init C.v = 1\n"
#define TURNING                                                                                    \
    "gravity [0, 0, -9.81]; body b mass=1.5 inertia=[0.1, 0.2, 0.25]; arm e b [0.1, 0.2, 0.3]\n"   \
    "spherical h ground e; m = 1.5\ninit h.q0 = 0.8, h.q1 = 0.6, b.Wz = 3\n"

static Lab lab_new(const char *text, const char *derivatives, int lanes)
{
    Kit kit = kit_new();
    const ct_model_options options = {.derivatives = derivatives, .lanes = lanes};
    double p[ROOM], y[ROOM], s[ROOM];
    Lab lab = {.lanes = lanes};

    EXPECT_DONE(&kit, text);
    EXPECT(ct_model_new(kit.session, &options, &lab.model, &kit.error) == CT_OK);
    kit_free(&kit); /* the model lives on */
    lab.evaluator = ct_evaluator_new(lab.model);
    lab.np = ct_model_size(lab.model, CT_PARAMETERS);
    lab.ny = ct_model_size(lab.model, CT_STATE);
    lab.ns = ct_model_size(lab.model, CT_SOLUTION);
    ct_model_start(lab.model, p, y, s);
    for (int lane = 0; lane < lanes; lane++) {
        for (int i = 0; i < lab.np; i++)
            lab.p[i * lanes + lane] = p[i];
        for (int i = 0; i < lab.ny; i++)
            lab.y[i * lanes + lane] = y[i];
        for (int i = 0; i < lab.ns; i++)
            lab.s[i * lanes + lane] = s[i];
    }
    return lab;
}

static void lab_free(Lab *lab)
{
    ct_evaluator_free(lab->evaluator);
    ct_model_free(lab->model);
}

static ct_status lab_solve(Lab *lab)
{
    return ct_solve(lab->evaluator, lab->p, lab->t, lab->y, lab->s);
}

static int place(const Lab *lab, ct_part part, const char *name)
{
    const int i = ct_model_find(lab->model, part, name);

    EXPECT(i >= 0);
    return i < 0 ? 0 : i;
}

/* a function's values in one lane */
static int values_of(Lab *lab, const char *name, double *values)
{
    int rows = 0, columns = 0;
    const int function = ct_model_function(lab->model, name, &rows, &columns);

    EXPECT_TEXT(ct_model_function_name(lab->model, function), name);
    ct_evaluate(lab->evaluator, function, lab->p, lab->t, lab->y, lab->s, values);
    return rows * columns;
}

/* theta'' = -m g l sin(theta)/(I + m l^2) */
static void a_pendulum_is_as_its_formula_says(void)
{
    Lab lab = lab_new(SWINGING, "solution derivative", 1);
    const double g = 9.81, l = 0.5, m = 2, inertia = 0.01 + m * l * l, h = lab.y[0];
    const int L = place(&lab, CT_PARAMETERS, "L"),
              solution = ct_model_function(lab.model, "solution", NULL, NULL),
              derivative = ct_model_function(lab.model, "derivative", NULL, NULL);
    double rates[2], values[4];

    EXPECT_NEAR(h, acos(-1) / 6, 1e-14);
    EXPECT_TEXT(ct_model_unit(lab.model, CT_STATE, 1), "rad/s");
    EXPECT_TEXT(ct_model_name(lab.model, CT_SOLUTION, 0), "h''");
    EXPECT(ct_model_name(lab.model, CT_SOLUTION, 1) == NULL);
    EXPECT_TEXT(ct_model_unit(lab.model, CT_PARAMETERS, L), "m");
    EXPECT(ct_rates(lab.evaluator, lab.p, lab.t, lab.y, lab.s, rates) == CT_OK);
    EXPECT_NEAR(rates[0], 2, 1e-14);
    EXPECT_NEAR(rates[1], -m * g * l * sin(h) / inertia, 1e-12);
    EXPECT(values_of(&lab, "mass", values) == 1);
    EXPECT_NEAR(values[0], inertia, 1e-14);
    EXPECT(ct_derivatives(lab.evaluator, derivative, CT_STATE, lab.p, lab.t, lab.y, lab.s,
                          values) == CT_OK);
    EXPECT(values[0] == 0 && values[1] == 1 && values[3] == 0);
    EXPECT_NEAR(values[2], -m * g * l * cos(h) / inertia, 1e-12);
    EXPECT(ct_derivatives(lab.evaluator, solution, CT_PARAMETERS, lab.p, lab.t, lab.y, lab.s,
                          values) == CT_OK);
    EXPECT_NEAR(values[L],
                -m * g * sin(h) / inertia + 2 * m * m * g * l * l * sin(h) / inertia / inertia,
                1e-12);
    lab.p[L] = 0.25;
    EXPECT(lab_solve(&lab) == CT_OK);
    EXPECT_NEAR(lab.s[0], -m * g * 0.25 * sin(h) / (0.01 + m / 16), 1e-12);
    lab_free(&lab);
}

/* what the session tells of the same start, in its own way, by the same names */
static void solutions_are_the_sessions(void)
{
    static const char *const models[] = {ARM, FOUR_BAR, RECTIFIER, TURNING};

    for (int k = 0; k < (int)(sizeof models / sizeof *models); k++) {
        Lab lab = lab_new(models[k], NULL, 1);
        Kit kit = kit_new();
        double values[ROOM] = {0};

        EXPECT_DONE(&kit, models[k]);
        memset(lab.s, 0, sizeof lab.s);
        EXPECT(lab_solve(&lab) == CT_OK);
        for (int i = 0; i < lab.ns; i++) {
            const char *name = ct_model_name(lab.model, CT_SOLUTION, i);
            const double wanted = kit_value(&kit, name);

            EXPECT_NEAR(lab.s[i], wanted, 1e-10 * (1 + fabs(wanted)));
        }
        for (int i = 0, count = values_of(&lab, "residual", values); i < count; i++)
            EXPECT_NEAR(values[i], 0, 1e-9);
        for (int i = 0, count = values_of(&lab, "outputs", values); i < count; i++)
            EXPECT_NEAR(values[i], kit_value(&kit, ct_model_name(lab.model, CT_OUTPUTS, i)), 1e-10);
        kit_free(&kit);
        lab_free(&lab);
    }
}

/* of what `function` gives, s solved, by one number */
static void quotient(Lab *lab, int function, double *number, double step, int count, double *out)
{
    const double was = *number;
    double ahead[ROOM];

    *number = was + step;
    EXPECT(lab_solve(lab) == CT_OK);
    ct_evaluate(lab->evaluator, function, lab->p, lab->t, lab->y, lab->s, ahead);
    *number = was - step;
    EXPECT(lab_solve(lab) == CT_OK);
    ct_evaluate(lab->evaluator, function, lab->p, lab->t, lab->y, lab->s, out);
    for (int i = 0; i < count; i++)
        out[i] = (ahead[i] - out[i]) / (2 * step);
    *number = was;
    EXPECT(lab_solve(lab) == CT_OK);
}

static void derivatives_are_quotients(void)
{
    static const char *const models[] = {ARM, FOUR_BAR, RECTIFIER, TURNING};
    static const char *const names[] = {"derivative", "solution", "outputs", "mass", "forces"};

    for (int k = 0; k < (int)(sizeof models / sizeof *models); k++) {
        Lab lab = lab_new(models[k], "mass forces derivative solution outputs", 1);

        EXPECT(lab_solve(&lab) == CT_OK);
        for (int f = 0; f < (int)(sizeof names / sizeof *names); f++) {
            int rows = 0, columns = 0;
            const int function = ct_model_function(lab.model, names[f], &rows, &columns);

            for (ct_part part = CT_PARAMETERS; part <= CT_STATE; part++) {
                double slopes[ROOM * ROOM], wanted[ROOM];
                const int size = ct_model_size(lab.model, part);
                double *numbers = part == CT_STATE ? lab.y : lab.p;

                EXPECT(ct_derivatives(lab.evaluator, function, part, lab.p, lab.t, lab.y, lab.s,
                                      slopes) == CT_OK);
                for (int i = 0; i < size; i++) {
                    quotient(&lab, function, &numbers[i],
                             1e-5 * (numbers[i] != 0 ? fabs(numbers[i]) : 1), rows * columns,
                             wanted);
                    for (int row = 0; row < rows * columns; row++)
                        EXPECT_NEAR(slopes[row * size + i], wanted[row],
                                    2e-6 * (10 + fabs(wanted[row])));
                }
            }
        }
        lab_free(&lab);
    }
}

/* a state on the constraints, what follows from it, and the derivatives of that by the state */
typedef struct Place {
    double y[ROOM], values[ROOM + 2], slopes[(ROOM + 2) * ROOM];
} Place;

/* Moved by numbers at random, as far as constraints let it. */
static void move(Lab *lab, const double *from, double far, uint64_t *seed, Place *out)
{
    const int derivative = ct_model_function(lab->model, "derivative", NULL, NULL),
              outputs = ct_model_function(lab->model, "outputs", NULL, NULL);

    double moved = HUGE_VAL;

    while (moved > 5 * far) { /* rows that all but repeat each other may lead it anywhere */
        for (int i = 0; i < lab->ny; i++)
            lab->y[i] = from[i] + test_uniform(seed, -far, far);
        EXPECT(ct_project(lab->evaluator, lab->p, lab->t, lab->y) == CT_OK);
        moved = 0;
        for (int i = 0; i < lab->ny; i++)
            moved = fmax(moved, fabs(lab->y[i] - from[i]));
    }
    memcpy(out->y, lab->y, sizeof out->y);
    EXPECT(ct_rates(lab->evaluator, lab->p, lab->t, lab->y, lab->s, out->values) == CT_OK);
    ct_evaluate(lab->evaluator, outputs, lab->p, lab->t, lab->y, lab->s, out->values + lab->ny);
    EXPECT(ct_derivatives(lab->evaluator, derivative, CT_STATE, lab->p, lab->t, lab->y, lab->s,
                          out->slopes) == CT_OK);
    /* the second output is a share of what repeats, which nothing determines */
    EXPECT(ct_derivatives(lab->evaluator, outputs, CT_STATE, lab->p, lab->t, lab->y, lab->s,
                          out->slopes + lab->ny * lab->ny) == CT_FAILED);
    EXPECT(isnan(out->slopes[(lab->ny + 1) * lab->ny]));
}

/* From place to place on the constraints accelerations, and what follows from them, differ as the
 * derivatives there say. */
static void redundant_constraints_leave_accelerations_theirs(void)
{
    static const char *const models[] = {PARALLEL, IN_SPACE};
    const double far = 1e-4;
    uint64_t seed = 11;

    for (int k = 0; k < 20; k++) {
        Lab lab = lab_new(models[k / 10], "derivative outputs", 1);
        double start[ROOM];
        static Place at[2];

        move(&lab, memcpy(start, lab.y, sizeof start), 0.1, &seed, &at[0]);
        move(&lab, at[0].y, far, &seed, &at[1]);
        for (int row = 0; row <= lab.ny; row++) { /* of the rates, then the first output */
            const double wanted = (at[1].values[row] - at[0].values[row]) / far;
            double sum = 0;

            for (int i = 0; i < lab.ny; i++)
                sum += (at[0].slopes[row * lab.ny + i] + at[1].slopes[row * lab.ny + i]) / 2 *
                       (at[1].y[i] - at[0].y[i]) / far;
            EXPECT_NEAR(sum, wanted, 1e-6 * (10 + fabs(wanted)));
        }
        lab_free(&lab);
    }
}

/* The residual at random states, where nothing of it is 0: it has a function's derivatives by p, y
 * and s alike. */
static void slopes_of_the_residual_are_quotients(void)
{
    static const char *const models[] = {SWINGING, ARM, FOUR_BAR, RECTIFIER, TURNING, PARALLEL};
    uint64_t seed = 5;

    for (int k = 0; k < 5 * (int)(sizeof models / sizeof *models); k++) {
        Lab lab = lab_new(models[k / 5], "residual", 1);
        int rows = 0;
        const int residual = ct_model_function(lab.model, "residual", &rows, NULL);

        for (int i = 0; i < lab.ny; i++)
            lab.y[i] += test_uniform(&seed, -0.1, 0.1);
        for (int i = 0; i < lab.ns; i++)
            lab.s[i] += test_uniform(&seed, -1, 1);
        for (ct_part part = CT_PARAMETERS; part <= CT_SOLUTION; part++) {
            double slopes[ROOM * ROOM], ends[2][ROOM];
            double *const numbers[] = {lab.p, lab.y, lab.s};
            const int size = ct_model_size(lab.model, part);

            EXPECT(ct_partial_derivatives(lab.evaluator, residual, part, lab.p, lab.t, lab.y, lab.s,
                                          slopes) == CT_OK);
            for (int i = 0; i < size; i++) {
                double *number = &numbers[part][i];
                const double was = *number, h = 1e-5 * (was != 0 ? fabs(was) : 1);

                for (int side = 0; side < 2; side++) {
                    *number = was + (2 * side - 1) * h;
                    ct_evaluate(lab.evaluator, residual, lab.p, lab.t, lab.y, lab.s, ends[side]);
                }
                *number = was;
                for (int row = 0; row < rows; row++) {
                    const double wanted = (ends[1][row] - ends[0][row]) / (2 * h);

                    EXPECT_NEAR(slopes[row * size + i], wanted,
                                1e-6 * (1 + fabs(wanted)) + 1e-11 * fabs(ends[0][row]) / h);
                }
            }
        }
        lab_free(&lab);
    }
}

/* each lane another state: what is found in one is what is found alone */
static void simd_batch_dont_know_of_each_other(void)
{
    static const char *const models[] = {ARM, FOUR_BAR, RECTIFIER, TURNING};

    for (int k = 0; k < (int)(sizeof models / sizeof *models); k++)
        for (int lanes = 2; lanes <= LANES; lanes *= 2) {
            Lab many = lab_new(models[k], "derivative", lanes),
                one = lab_new(models[k], "derivative", 1);
            const int derivative = ct_model_function(one.model, "derivative", NULL, NULL);
            double rates[ROOM * LANES], rate[ROOM], all[ROOM * ROOM * LANES], alone[ROOM * ROOM];

            for (int i = 0; i < many.ny; i++)
                for (int lane = 0; lane < lanes; lane++)
                    many.y[i * lanes + lane] += 0.01 * ((lane * 7 + i * 3) % 11);
            EXPECT(ct_project(many.evaluator, many.p, many.t, many.y) == CT_OK);
            EXPECT(ct_rates(many.evaluator, many.p, many.t, many.y, many.s, rates) == CT_OK);
            EXPECT(ct_derivatives(many.evaluator, derivative, CT_STATE, many.p, many.t, many.y,
                                  many.s, all) == CT_OK);
            for (int lane = 0; lane < lanes; lane++) {
                for (int i = 0; i < one.ny; i++)
                    one.y[i] = many.y[i * lanes + lane];
                EXPECT(ct_rates(one.evaluator, one.p, one.t, one.y, one.s, rate) == CT_OK);
                EXPECT(ct_derivatives(one.evaluator, derivative, CT_STATE, one.p, one.t, one.y,
                                      one.s, alone) == CT_OK);
                for (int i = 0; i < one.ny; i++)
                    EXPECT_NEAR(rates[i * lanes + lane], rate[i], 1e-9 * (1 + fabs(rate[i])));
                for (int i = 0; i < one.ny * one.ny; i++)
                    EXPECT_NEAR(all[i * lanes + lane], alone[i], 1e-7 * (1 + fabs(alone[i])));
            }
            lab_free(&many);
            lab_free(&one);
        }
}

static void a_state_is_put_onto_the_constraints(void)
{
    Lab lab = lab_new(FOUR_BAR, NULL, 4);
    double off[ROOM * LANES], jacobian[ROOM * LANES];
    int rows, columns;

    for (int i = 0; i < lab.ny; i++)
        for (int lane = 0; lane < 4; lane++)
            lab.y[i * 4 + lane] += 0.02 * lane * (i % 3);
    EXPECT(ct_project(lab.evaluator, lab.p, lab.t, lab.y) == CT_OK);
    for (int i = 0, count = values_of(&lab, "constraints", off); i < 4 * count; i++)
        EXPECT_NEAR(off[i], 0, 1e-12);
    (void)ct_model_function(lab.model, "jacobian", &rows, &columns);
    (void)values_of(&lab, "jacobian", jacobian);
    for (int row = 0; row < rows; row++)
        for (int lane = 0; lane < 4; lane++) {
            double sum = 0; /* nothing moves the ground: nu is 0 */

            for (int j = 0; j < columns; j++)
                sum += jacobian[(row * columns + j) * 4 + lane] *
                       lab.y[(lab.ny - columns + j) * 4 + lane];
            EXPECT_NEAR(sum, 0, 1e-11);
        }
    lab_free(&lab);
}

/* a load that a lane takes away leaves its speed without inertia */
static void a_lane_without_a_solution_says_so(void)
{
    Lab lab =
        lab_new("Cap = 1 uF; vsource E a 0 1; resistor R a b 10; capacitor C b 0 Cap", NULL, 2);

    lab.p[1] = 0;
    EXPECT(lab_solve(&lab) == CT_FAILED);
    EXPECT(isnan(lab.s[1]) && !isnan(lab.s[0]));
    lab.p[1] = 2e-6;
    lab.s[1] = 0;
    for (int i = 0; i < lab.ns; i++)
        lab.s[i * 2 + 1] = 0;
    EXPECT(lab_solve(&lab) == CT_OK);
    EXPECT_NEAR(lab.s[0], 2 * lab.s[1], 1e-6 * fabs(lab.s[0]));
    lab_free(&lab);
}

static void what_there_isnt_is_refused(void)
{
    static const struct {
        const char *text;
        ct_model_options options;
        const char *message;
    } wrong[] = {
        {SWINGING, {.derivatives = "mass mess"}, "no function 'mess'"},
        {SWINGING, {.lanes = 3}, "1, 2, 4 or 8 lanes"},
        {"k = 2", {.lanes = 1}, "no equations yet"},
    };

    for (int i = 0; i < (int)(sizeof wrong / sizeof *wrong); i++) {
        Kit kit = kit_new();
        ct_model *model = NULL;

        EXPECT_DONE(&kit, wrong[i].text);
        EXPECT(ct_model_new(kit.session, &wrong[i].options, &model, &kit.error) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT(model == NULL);
        kit_free(&kit);
    }
}

/* --- threads --- */

#ifndef COTREE_FAULTS /* whose book of what is held is one for all threads */
enum { THREADS = 4, CALLS = 2000 };

typedef struct Share {
    const ct_model *model;
    double sum;
} Share;

/* many evaluations; each thread the same ones */
static int evaluate_much(void *context)
{
    Share *share = context;
    ct_evaluator *e = ct_evaluator_new(share->model);
    double p[ROOM], y[ROOM], s[ROOM], rates[ROOM], t = 0;

    ct_model_start(share->model, p, y, s);
    for (int k = 0; k < CALLS; k++) {
        y[0] = 0.001 * k;
        p[0] = 0.3 + 1e-4 * k;
        if (ct_rates(e, p, &t, y, s, rates) != CT_OK)
            share->sum = NAN;
        for (int i = 0; i < ct_model_size(share->model, CT_STATE); i++)
            share->sum += rates[i];
    }
    ct_evaluator_free(e);
    return 0;
}

static void threads_share_a_model(void)
{
    static const char *const models[] = {ARM, FOUR_BAR};

    for (int m = 0; m < (int)(sizeof models / sizeof *models); m++) {
        Lab lab = lab_new(models[m], NULL, 1);
        Share alone = {lab.model, 0}, shares[THREADS];
        thrd_t threads[THREADS];

        (void)evaluate_much(&alone);
        EXPECT(isfinite(alone.sum));
        for (int i = 0; i < THREADS; i++) {
            shares[i] = (Share){lab.model, 0};
            EXPECT(thrd_create(&threads[i], evaluate_much, &shares[i]) == thrd_success);
        }
        for (int i = 0; i < THREADS; i++) {
            EXPECT(thrd_join(threads[i], NULL) == thrd_success);
            EXPECT(shares[i].sum == alone.sum);
        }
        lab_free(&lab);
    }
}

#endif

int main(void)
{
    RUN(a_pendulum_is_as_its_formula_says);
    RUN(solutions_are_the_sessions);
    RUN(derivatives_are_quotients);
    RUN(redundant_constraints_leave_accelerations_theirs);
    RUN(slopes_of_the_residual_are_quotients);
    RUN(simd_batch_dont_know_of_each_other);
    RUN(a_state_is_put_onto_the_constraints);
    RUN(a_lane_without_a_solution_says_so);
    RUN(what_there_isnt_is_refused);
#ifndef COTREE_FAULTS
    RUN(threads_share_a_model);
#endif
    return test_end();
}

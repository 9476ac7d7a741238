/* test_integration.c: integrators, projection, switches on systems written by hand */
#include "simulate/integrate/condensed.h"
#include "simulate/integrate/shifted.h"
#include "simulate/run/integration.h"

#include "base/memory.h"
#include "simulate_problems.h"
#include "test.h"

/* a forward run of a problem; the caller frees the grid */
static Status run(Problem *p, const char *method, bool embedded, double rtol, const double *start,
                  double to, double every, Grid *grid, IntegrationReport *out, Diag *diag)
{
    MotionOptions options = {
        .embedded = embedded, .rows = p->rows, .row_count = p->eq.m, .tolerance = rtol};
    Motion *motion = motion_new(&p->eq, &options);
    IntegrationPlan plan = {
        .segment = {.equations = &p->eq, .motion = motion, .stiff = &method_radau},
        .method = method != NULL ? method_find(method) : NULL,
        .control = {.rtol = rtol, .atol = rtol},
        .to = to,
        .every = every};
    Status status = integrate(&plan, start, grid, out, diag);

    remarks_free(&out->remarks);
    LIST_FREE(out->jumps);
    motion_free(motion);
    return status;
}

static double last(const Grid *grid, int i)
{
    return grid_row(grid, grid->count - 1)[i];
}

static Stepper *spring_stepper(Problem *p, Motion **motion, const Method *method, double h)
{
    static const double start[3] = {1, 0, 0};
    MotionOptions options = {.tolerance = 1e-8};
    Control control = {.rtol = 1e3, .atol = 1e3, .step = h};
    Stepper *s;

    problem_spring(p);
    *motion = motion_new(&p->eq, &options);
    s = method->create(motion_ode(*motion), &control);
    EXPECT(method->start(s, 0, start, NULL) == OK);
    s->next = h;
    return s;
}

/* error of y'' = -y at t = 2 with fixed steps, and of what is read in the middle of the last one */
static void spring_errors(const Method *method, double h, double *end, double *middle)
{
    Problem p;
    Motion *motion;
    Stepper *s = spring_stepper(&p, &motion, method, h);
    double y[3], t;

    *middle = 0;
    while (s->t < 2 - 1e-12) {
        EXPECT(method->step(s, 2, NULL) == OK);
        for (int k = 1; k < 4; k++) {
            t = s->before + k * (s->t - s->before) / 4;
            method->at(s, t, y);
            *middle = fmax(*middle, fabs(y[0] - cos(t)));
        }
    }
    *end = fmax(fabs(s->y[0] - cos(2)), fabs(s->y[1] + sin(2)));
    method->destroy(s);
    motion_free(motion);
}

static void dop853_has_order_8_and_its_interpolant_7(void)
{
    double coarse, fine, coarse_middle, fine_middle;

    spring_errors(&method_dop853, 0.5, &coarse, &coarse_middle);
    spring_errors(&method_dop853, 0.25, &fine, &fine_middle);
    EXPECT(log2(coarse / fine) > 7.6);
    EXPECT(log2(coarse_middle / fine_middle) > 7.4); /* its local error is one order higher */
    EXPECT(fine < 1e-10 && fine_middle < 1e-9);
}

enum { SLOW = 8 };

/* one that is pulled to sin 3 t, fast, and slow ones that are sines */
static bool pulled_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    rate[0] = 3 * cos(3 * t) - 250 * (y[0] - sin(3 * t));
    for (int i = 1; i <= SLOW; i++)
        rate[i] = cos(t + i);
    return true;
}

static void dop853_tells_what_decays_fast_in_between_as_well_as_at_the_end(void)
{
    for (double rtol = 1e-4; rtol > 1e-9; rtol /= 10) {
        const Ode ode = {.n = 1 + SLOW, .rate = pulled_rate};
        const Control control = {.rtol = rtol, .atol = rtol};
        Stepper *s = method_dop853.create(&ode, &control);
        double y[1 + SLOW] = {0}, middle = 0;

        for (int i = 1; i <= SLOW; i++)
            y[i] = sin(i);
        EXPECT(method_dop853.start(s, 0, y, NULL) == OK);
        while (s->t < 1) {
            EXPECT(method_dop853.step(s, 1, NULL) == OK);
            for (int k = 1; k < 20; k++) {
                const double t = s->before + k * (s->t - s->before) / 20;

                method_dop853.at(s, t, y);
                middle = fmax(middle, fabs(y[0] - sin(3 * t)));
            }
        }
        EXPECT(middle < 10 * rtol);
        method_dop853.destroy(s);
    }
}

/* y'' = -y, but at one instant, where rates are anything and are known to be */
typedef struct Spoilt {
    double at, rounding_error;
    int evaluations;
} Spoilt;

static bool spoilt_rate(void *context, double t, const double *y, double *rate)
{
    Spoilt *s = context;
    const double off = fabs(t - s->at) < 1e-9 ? 0.5 : 0;

    s->evaluations++;
    s->rounding_error = fmax(s->rounding_error, off > 0 ? 1e-9 : 0);
    rate[0] = y[1] + off;
    rate[1] = -y[0] - off;
    return true;
}

static double spoilt_blur(void *context)
{
    Spoilt *s = context;
    const double rounding_error = s->rounding_error;

    s->rounding_error = 0;
    return rounding_error;
}

/* the largest error within one step of h, with rates that are anything at `at` of it */
static double error_within(double h, double at, int *evaluations)
{
    Spoilt spoilt = {.at = at * h};
    const Ode ode = {
        .n = 2, .context = &spoilt, .rate = spoilt_rate, .rounding_error = spoilt_blur};
    const Control control = {.rtol = 1e-8, .atol = 1e-8, .step = h};
    Stepper *s = method_dop853.create(&ode, &control);
    double y[2] = {1, 0}, largest = 0;

    EXPECT(method_dop853.start(s, 0, y, NULL) == OK);
    s->next = h;
    EXPECT(method_dop853.step(s, h, NULL) == OK);
    EXPECT(s->t == h);
    for (int k = 1; k < 40; k++) {
        method_dop853.at(s, k * h / 40, y);
        largest = fmax(largest, fmax(fabs(y[0] - cos(k * h / 40)), fabs(y[1] + sin(k * h / 40))));
    }
    method_dop853.destroy(s);
    *evaluations = spoilt.evaluations;
    return largest;
}

/* one that the step itself doesn't read */
static void dop853_tells_a_stage_between_by_its_slope_where_rates_are_anything(void)
{
    static const double nodes[] = {0.1, 0.2, 7 / 9.0};
    const double h = 0.25;
    int plain;
    const double error = error_within(h, -1, &plain);

    EXPECT(error < 1e-10);
    for (int i = 0; i < COUNT(nodes); i++) {
        int evaluations;

        EXPECT(error_within(h, nodes[i], &evaluations) < 1e-8);
        EXPECT(evaluations > plain && evaluations < plain + 25); /* two parts take 31 more */
    }
}

static void rk4_has_order_4(void)
{
    double coarse, fine, coarse_middle, fine_middle;

    spring_errors(&method_rk4, 0.1, &coarse, &coarse_middle);
    spring_errors(&method_rk4, 0.05, &fine, &fine_middle);
    EXPECT(log2(coarse / fine) > 3.7);
    EXPECT(log2(coarse_middle / fine_middle) > 3.5);
}

static void every_method_meets_its_tolerance_on_a_spring(void)
{
    static const double start[3] = {1, 0, 0};

    for (int i = 0; method_row(i) != NULL; i++) {
        const char *name = method_row(i)->name;
        Problem p;
        Grid grid = {0};
        IntegrationReport out;

        problem_spring(&p);
        EXPECT(run(&p, name, false, 1e-10, start, 10, strcmp(name, "rk4") == 0 ? 0.01 : 0.1, &grid,
                   &out, NULL) == OK);
        EXPECT_NEAR(last(&grid, 0), cos(10), 1e-7);
        EXPECT_NEAR(out.reached, 10, 0);
        EXPECT(out.counts.steps > 0 && out.counts.evaluations > 0);
        grid_free(&grid);
    }
}

/* the length of the first step from (1, cos 1, -sin 1), and its error, of a stepper that may have
 * gone another way before; next: a driver's guess, or 0 */
static double first_step(const Method *method, int steps_before, double next, double *error)
{
    static const double zero[3] = {1, 0, 0};
    const double start[3] = {cos(1), -sin(1), 0};
    MotionOptions options = {.tolerance = 1e-8};
    Control control = {.rtol = 1e-6, .atol = 1e-6};
    Problem p;
    Motion *motion;
    Stepper *s;
    double length;

    problem_spring(&p);
    motion = motion_new(&p.eq, &options);
    s = method->create(motion_ode(motion), &control);
    if (steps_before > 0) {
        EXPECT(method->start(s, 0, zero, NULL) == OK);
        s->next = 1e-4; /* for that start, and no other */
    }
    for (int i = 0; i < steps_before; i++)
        EXPECT(method->step(s, 1000, NULL) == OK);
    EXPECT(method->start(s, 1, start, NULL) == OK);
    s->next = next;
    EXPECT(method->step(s, 1000, NULL) == OK);
    length = s->t - s->before;
    *error = fabs(s->y[0] - cos(s->t));
    method->destroy(s);
    motion_free(motion);
    return length;
}

static void a_start_forgets_the_steps_before_it(void)
{
    for (int i = 0; method_row(i) != NULL; i++) {
        const Method *method = method_row(i);
        double error;
        const double fresh = first_step(method, 0, 0, &error);

        if (method->has_fixed_step)
            continue;
        EXPECT(error < 1e-5 && fresh > 0);
        EXPECT_NEAR(first_step(method, 1, 0, &error), fresh, 1e-12 * fresh);
        EXPECT_NEAR(first_step(method, 20, 0, &error), fresh, 1e-12 * fresh);
        EXPECT_NEAR(first_step(method, 20, fresh / 8, &error), fresh / 8, 1e-9 * fresh);
    }
}

static const double pendulum_start[7] = {-1, 0, -1.5707963267948966, 0, 0, 0, 0};

/* reference A01 (Jacobi elliptic functions), released at x = -1: position at 10 s */
static void pendulum_agrees_with_elliptic_functions(void)
{
    static const char *const names[] = {"dop853", "adams", "bdf", "ida", "radau"};
    static const double bound[] = {1e-9, 1e-7, 2e-6, 2e-6, 1e-8};

    for (int embedded = 0; embedded < 2; embedded++)
        for (int i = 0; i < COUNT(names); i++) {
            Problem p;
            Grid grid = {0};
            IntegrationReport out;
            Diag diag = {0};

            problem_pendulum(&p, false);
            EXPECT(run(&p, names[i], embedded, 1e-12, pendulum_start, 10, 0.01, &grid, &out,
                       &diag) == OK);
            EXPECT_TEXT(diag.message, "");
            EXPECT(grid.count == 1001);
            EXPECT_NEAR(last(&grid, 0), -0.27508746257611695, bound[i]);
            EXPECT_NEAR(last(&grid, 1), -0.96141920509912512, bound[i]);
            EXPECT(out.position_residual < 1e-12 && out.velocity_residual < 1e-12);
            grid_free(&grid);
        }
}

static void multipliers_are_the_rod_force(void)
{
    Problem p;
    MotionOptions options = {.rows = p.rows, .row_count = 2};
    Motion *motion;
    Solved solved;
    const double still[7] = {0, -1, 0, 0, 0, 0, 0};

    problem_pendulum(&p, false);
    motion = motion_new(&p.eq, &options);
    EXPECT(motion_solve(motion, 0, still, &solved));
    /* lambda is minus the force on the head: the ground holds the mass up */
    EXPECT_NEAR(solved.multipliers[0], 0, 1e-14);
    EXPECT_NEAR(solved.multipliers[1], -9.81, 1e-13);
    motion_free(motion);
}

static void a_repeated_row_shares_the_least_multipliers(void)
{
    static const int independent[] = {0, 1};
    const double start[7] = {-1, 0, -1.5707963267948966, 0, -3, 3, 0};
    Problem p;
    MotionOptions options = {.rows = independent, .row_count = 2};
    Motion *motion;
    Solved solved;
    double y[7];

    memcpy(y, start, sizeof y);
    problem_pendulum(&p, true);
    motion = motion_new(&p.eq, &options);
    EXPECT(motion_project(motion, 0, y));
    EXPECT(motion_solve(motion, 0, y, &solved));
    EXPECT(fabs(solved.multipliers[0]) > 1);
    EXPECT_NEAR(solved.multipliers[0], solved.multipliers[2], 1e-12);
    motion_free(motion);
}

/* reference A02 at 10 s; every tolerance stays on the parallelogram branch */
static void four_bar_passes_its_singular_positions(void)
{
    static const double start[7] = {0, 0, 0, -1, -1, 0, 0};

    for (int digits = 4; digits <= 12; digits++) {
        Problem p;
        Grid grid = {0};
        IntegrationReport out;
        Diag diag = {0};

        problem_four_bar(&p);
        EXPECT(run(&p, "dop853", false, pow(10, -digits), start, 10, 0.01, &grid, &out, &diag) ==
               OK);
        EXPECT_TEXT(diag.message, "");
        if (digits >= 8) {
            EXPECT_NEAR(-sin(last(&grid, 0)), 0.47838505776097055901, 1e-5);
            EXPECT_NEAR(cos(last(&grid, 0)), 0.87815017879120930116, 1e-5);
        }
        for (int i = 0; i < grid.count; i++)
            EXPECT_NEAR(sin(grid_row(&grid, i)[2]), 0, digits >= 6 ? 1e-3 : 0.1);
        grid_free(&grid);
    }
}

static void a_switch_in_time_is_met_exactly(void)
{
    static const double start[4] = {0, 0, 0, 0};
    static const char *const names[] = {"dop853", "bdf", "adams", "ida", "radau"};

    for (int i = 0; i < COUNT(names); i++) {
        Problem p;
        Grid grid = {0};
        IntegrationReport out;
        double at_switch = 1 - exp(-5);
        double bound = i == 0 ? 1e-11 : 1e-8;

        problem_coil(&p, 0.1);
        EXPECT(run(&p, names[i], false, 1e-11, start, 1, 0.1, &grid, &out, NULL) == OK);
        EXPECT_NEAR(grid_row(&grid, 5)[2], at_switch, bound);
        EXPECT_NEAR(last(&grid, 2), -1 + (1 + at_switch) * exp(-5), bound);
        if (i == 0)
            EXPECT(out.counts.rejected == 0); /* no step felt the jump */
        grid_free(&grid);
    }
}

static void a_switch_in_the_state_is_located(void)
{
    static const double start[3] = {0.5, 0, 0}; /* reaches 0 at t = 1, then again every 2 s */
    Problem p;
    Grid grid = {0};
    IntegrationReport out;
    Diag diag = {0};

    problem_valley(&p);
    EXPECT(run(&p, "dop853", false, 1e-10, start, 100, 1, &grid, &out, &diag) == OK);
    EXPECT_TEXT(diag.message, "");
    EXPECT_NEAR(last(&grid, 0), 0.5, 1e-9);
    EXPECT_NEAR(last(&grid, 1), 0, 1e-9);
    EXPECT(out.counts.steps < 1500);
    grid_free(&grid);
}

static void messages_speak_of_a_network_where_nothing_moves(void)
{
    const MotionOptions options = {.tolerance = 1e-8};
    Problem p;
    Motion *motion;
    Diag diag = {0};

    EXPECT(ode_undefined(&(Ode){.is_network = true}, 0.5, &diag) == E_SOLVER);
    EXPECT_TEXT(diag.message, "at t = 0.5 s: the network's rates are undefined");
    problem_spring(&p);
    motion = motion_new(&p.eq, &options);
    EXPECT(ode_undefined(motion_ode(motion), 0.5, &diag) == E_SOLVER);
    EXPECT_TEXT(diag.message, "at t = 0.5 s: the accelerations are undefined");
    motion_free(motion);
}

/* --- a margin that is negative where the run begins --- */

/* y = sin t, and two margins: one far above 0, and size (sin t - 3/2), which rises and stays
 * negative */
static double margin_size;

static void hopeless_margin(void *context, double t, const double *q, const double *u,
                            const double *x, double *out)
{
    (void)context, (void)t, (void)u, (void)x;
    out[0] = 1;
    out[1] = margin_size * (q[0] - 1.5);
}

/* the segment is always the right one; when it was asked for is noted */
typedef struct Asked {
    int times;
    double last; /* s */
} Asked;

static Status no_other(void *context, double t, double behind, Nearness near, const double *y,
                       Segment *segment, const double **out, Diag *diag)
{
    Asked *asked = context;

    (void)behind, (void)near, (void)y, (void)segment, (void)out, (void)diag;
    asked->times++;
    asked->last = t;
    return OK;
}

static Status run_beside_margin(double size, Asked *asked, Diag *diag)
{
    static const double start[3] = {0, 1, 0};
    const MotionOptions options = {.tolerance = 1e-8};
    Problem p;
    IntegrationPlan plan = {.control = {.rtol = 1e-8, .atol = 1e-8},
                            .mode_switch = no_other,
                            .context = asked,
                            .to = 100,
                            .every = 1};
    Grid grid = {0};
    IntegrationReport out;
    Status status;

    problem_spring(&p);
    margin_size = size;
    p.eq.switches = hopeless_margin;
    p.eq.switch_count = p.eq.margin_count = 2;
    plan.segment = (Segment){.equations = &p.eq, .motion = motion_new(&p.eq, &options)};
    *asked = (Asked){0};
    status = integrate(&plan, start, &grid, &out, diag);
    motion_free(plan.segment.motion);
    remarks_free(&out.remarks);
    LIST_FREE(out.jumps);
    grid_free(&grid);
    return status;
}

/* On its way up at first, a margin of 1e-7 of the largest may be what an instant that is located
 * badly leaves, but not ten times longer than it should take to rise: 3/2 s. A margin that is large
 * is none of that. */
static void a_margin_that_stays_negative_is_not_integrated_through(void)
{
    Diag diag = {0};
    Asked asked;

    EXPECT(run_beside_margin(1e-7, &asked, &diag) == OK);
    EXPECT(asked.times == 2);
    EXPECT_NEAR(asked.last, 15, 1e-3); /* slopes are told by differences */
    EXPECT(run_beside_margin(1, &asked, &diag) == E_SOLVER);
    EXPECT(strstr(diag.message, "switches to and fro without end") != NULL);
}

static void stiffness_is_noticed_and_handed_over(void)
{
    static const double start[4] = {0, 0, 0, 0};
    Problem p;
    Grid grid = {0};
    IntegrationReport out;

    problem_coil(&p, 1e-6);
    EXPECT(run(&p, NULL, false, 1e-8, start, 1, 0.1, &grid, &out, NULL) == OK);
    EXPECT(out.method == &method_radau);
    EXPECT(out.counts.steps < 2000);
    /* s' = t up to 0.5 s, then falls */
    EXPECT_NEAR(last(&grid, 1), 0, 1e-5);
    grid_free(&grid);

    problem_coil(&p, 0.1);
    EXPECT(run(&p, NULL, false, 1e-8, start, 1, 0.1, &grid, &out, NULL) == OK);
    EXPECT(out.method == &method_dop853);
    grid_free(&grid);
}

static void output_times_are_multiples_of_the_step(void)
{
    EXPECT(grid_rows(0, 2, 0.01) == 200);
    EXPECT(grid_rows(0, 0.05, 0.00025) == 200);
    EXPECT(grid_rows(0, 1, 0.3) == 4);
    EXPECT(grid_time(0, 2, 0.01, grid_rows(0, 2, 0.01), 7) == 7 * 0.01);
    EXPECT(grid_time(0, 1, 0.3, grid_rows(0, 1, 0.3), 4) == 1);
    EXPECT(grid_time(0, 2, 0.01, grid_rows(0, 2, 0.01), 200) == 2);
}

static bool stop_at_once(void *context)
{
    return --*(int *)context < 0;
}

static void a_stopped_run_keeps_its_rows(void)
{
    int left = 20;
    CallMonitor watch = {.context = &left, .stop = stop_at_once};
    Problem p;
    MotionOptions options = {.rows = p.rows, .row_count = 2, .tolerance = 1e-10};
    Motion *motion;
    IntegrationPlan plan = {.segment = {.equations = &p.eq},
                            .control = {.rtol = 1e-10, .atol = 1e-10},
                            .to = 1000,
                            .every = 0.01,
                            .watch = &watch};
    Grid grid = {0};
    IntegrationReport out;
    Diag diag = {0};

    problem_pendulum(&p, false);
    motion = motion_new(&p.eq, &options);
    plan.segment.motion = motion;
    EXPECT(integrate(&plan, pendulum_start, &grid, &out, &diag) == E_STOPPED);
    EXPECT(grid.count > 10 && grid.count < 100000);
    EXPECT(strncmp(diag.message, "stopped at t = ", 15) == 0);
    remarks_free(&out.remarks);
    LIST_FREE(out.jumps);
    grid_free(&grid);
    motion_free(motion);
}

/* a spring whose force turns into NaN beyond y = 0 */
static void broken_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;

    spring_velocity(context, u, x);
    if (p->q[0] < 0)
        p->force[0] = NAN;
}

static void nan_ends_a_run_with_its_time(void)
{
    static const double start[3] = {1, 0, 0};
    static const char *const names[] = {"dop853", "rk4"};

    for (int i = 0; i < COUNT(names); i++) {
        Problem p;
        Grid grid = {0};
        IntegrationReport out;
        Diag diag = {0};

        problem_spring(&p);
        p.eq.velocity = broken_velocity;
        EXPECT(run(&p, names[i], false, 1e-8, start, 10, 0.01, &grid, &out, &diag) == E_SOLVER);
        EXPECT(strncmp(diag.message, "at t = 1.5", 10) == 0);
        EXPECT(out.reached > 1.4 && out.reached < 1.571);
        grid_free(&grid);
    }
}

/* --- the Jacobian of few states of a network --- */

/* x' = -3 x y + z, y' = z - y, 0 = z - x^2; w = (x, y, z) */
static bool network_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    (void)t;
    rate[0] = -3 * y[0] * y[1] + y[0] * y[0];
    rate[1] = y[0] * y[0] - y[1];
    return true;
}

static bool network_start(void *context, double t, const double *y, double *w, double *rate)
{
    w[0] = y[0];
    w[1] = y[1];
    w[2] = y[0] * y[0];
    rate[2] = 0;
    return network_rate(context, t, y, rate);
}

static int network_pattern(void *context, const int **row, const int **column)
{
    static const int rows[] = {0, 0, 0, 1, 1, 2, 2}, columns[] = {0, 1, 2, 1, 2, 0, 2};

    (void)context;
    *row = rows;
    *column = columns;
    return COUNT(rows);
}

static bool network_jacobian(void *context, double t, double c, const double *w, const double *rate,
                             double *values)
{
    const double at[] = {c + 3 * w[1], 3 * w[0], -1, c + 1, -1, -2 * w[0], 1};

    (void)context;
    (void)t;
    (void)rate;
    memcpy(values, at, sizeof at);
    return true;
}

static void few_states_of_a_network_have_an_exact_jacobian_by_one_evaluation(void)
{
    const Ode ode = {.n = 2,
                     .rate = network_rate,
                     .dae = {.n = 3,
                             .start = network_start,
                             .pattern = network_pattern,
                             .jacobian = network_jacobian,
                             .is_index_one = true}};
    const double x = 0.7, y = -1.3, at[] = {x, y}, shift = 5;
    const double J[2][2] = {{2 * x - 3 * y, -3 * x}, {2 * x, -1}};
    Counts counts = {0};
    Shifted *shifted = shifted_new(&ode, &counts);
    double rate[2], b[2] = {1, 2};

    (void)network_rate(NULL, 0, at, rate);
    EXPECT(shifted_differentiate(shifted, 0, at, rate));
    EXPECT(counts.evaluations == 1 && counts.jacobians == 1);
    EXPECT(shifted_factor(shifted, shift, 1, 2));
    shifted_solve(shifted, b);
    for (int i = 0; i < 2; i++)
        EXPECT_NEAR(shift * b[i] - J[i][0] * b[0] - J[i][1] * b[1], i + 1, 1e-13);
    shifted_free(shifted);
}

/* entries of random signs, most of the positions' 0: they are told by speeds, some by each other */
static void fill_jacobian(double *jacobian, int n, int positions, uint64_t *random)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            jacobian[i * n + j] = i >= positions || (j >= positions && test_random(random) % 3 == 0)
                                      ? test_uniform(random, -100, 100)
                                      : 0;
    if (positions > 2)
        jacobian[1] = jacobian[n] = 1;
}

static void condensed_equations_have_the_solutions_of_all(void)
{
    enum { MOST = 12 };
    uint64_t random = 7;

    for (int trial = 0; trial < 50; trial++) {
        const int n = 1 + (int)(test_random(&random) % MOST), positions = trial % (n + 1);
        const double s = 30, alpha = 20, beta = 25;
        Condensed *condensed = condensed_new(n);
        double jacobian[MOST * MOST], b[MOST], c[MOST], d[MOST];

        fill_jacobian(jacobian, n, positions, &random);
        for (int i = 0; i < n; i++)
            b[i] = c[i] = d[i] = i + 1;
        condensed_set(condensed, jacobian);
        EXPECT(condensed_factor(condensed, s, alpha, beta));
        condensed_solve(condensed, b);
        condensed_solve_pair(condensed, c, d);
        for (int i = 0; i < n; i++) { /* (alpha - i beta - J)(c + i d) */
            double real = s * b[i], re = alpha * c[i] + beta * d[i],
                   im = alpha * d[i] - beta * c[i];

            for (int j = 0; j < n; j++) {
                real -= jacobian[i * n + j] * b[j];
                re -= jacobian[i * n + j] * c[j];
                im -= jacobian[i * n + j] * d[j];
            }
            EXPECT_NEAR(real, i + 1, 1e-9);
            EXPECT_NEAR(re, i + 1, 1e-9);
            EXPECT_NEAR(im, i + 1, 1e-9);
        }
        /* the real one alone, for another s */
        for (int i = 0; i < n; i++)
            b[i] = i + 1;
        EXPECT(condensed_factor_real(condensed, 2 * s));
        condensed_solve(condensed, b);
        for (int i = 0; i < n; i++) {
            double real = 2 * s * b[i];

            for (int j = 0; j < n; j++)
                real -= jacobian[i * n + j] * b[j];
            EXPECT_NEAR(real, i + 1, 1e-9);
        }
        condensed_free(condensed);
    }
}

int main(void)
{
    RUN(condensed_equations_have_the_solutions_of_all);
    RUN(few_states_of_a_network_have_an_exact_jacobian_by_one_evaluation);
    RUN(dop853_has_order_8_and_its_interpolant_7);
    RUN(dop853_tells_what_decays_fast_in_between_as_well_as_at_the_end);
    RUN(dop853_tells_a_stage_between_by_its_slope_where_rates_are_anything);
    RUN(rk4_has_order_4);
    RUN(every_method_meets_its_tolerance_on_a_spring);
    RUN(a_start_forgets_the_steps_before_it);
    RUN(pendulum_agrees_with_elliptic_functions);
    RUN(multipliers_are_the_rod_force);
    RUN(a_repeated_row_shares_the_least_multipliers);
    RUN(four_bar_passes_its_singular_positions);
    RUN(a_switch_in_time_is_met_exactly);
    RUN(a_switch_in_the_state_is_located);
    RUN(messages_speak_of_a_network_where_nothing_moves);
    RUN(a_margin_that_stays_negative_is_not_integrated_through);
    RUN(stiffness_is_noticed_and_handed_over);
    RUN(output_times_are_multiples_of_the_step);
    RUN(a_stopped_run_keeps_its_rows);
    RUN(nan_ends_a_run_with_its_time);
    return test_end();
}

/* An optimiser that calls a model a million times: it finds the length and the damping of a
 * pendulum from a measured swing. It evaluates eight candidates about the best one at once. */
#include <cotree.h>

#include <math.h>
#include <stdio.h>

enum { LANES = 8, STEPS = 1200, STATES = 2 };
#define STEP 0.0025 /* s */

static const char pendulum[] = "scene planar; gravity [0, -9.81]; L = 0.7 m; d = 0.2 [N*m*s/rad]\n"
                               "body bob mass=1 inertia=0.01; arm top bob [0, L]\n"
                               "revolute h ground top; damper b h d=d; init h = 60 deg\n";
static long calls;

static ct_status build(ct_session *session, const char *text, ct_error *error)
{
    ct_cursor cursor = {.text = text, .line = 1};
    ct_status status = CT_OK;

    while (status == CT_OK && text[cursor.next] != '\0') {
        ct_statement *statement;

        status = ct_parse(&cursor, false, &statement, error);
        if (status == CT_OK) {
            status = ct_apply(session, statement, error);
            ct_statement_free(statement);
        }
    }
    return status;
}

/* advance y and s of all lanes by one step of the classical Runge-Kutta method */
static void step(ct_evaluator *e, const double *p, double *y, double *s)
{
    static const double weight[4] = {1, 2, 2, 1}, part[4] = {0.5, 0.5, 1, 0}, t[LANES];
    double at[STATES * LANES], rates[STATES * LANES], sum[STATES * LANES] = {0};

    for (int i = 0; i < STATES * LANES; i++)
        at[i] = y[i];
    for (int k = 0; k < 4; k++, calls++) {
        (void)ct_rates(e, p, t, at, s,
                       rates); /* without a solution the rates are NAN, and never the best */
        for (int i = 0; i < STATES * LANES; i++) {
            sum[i] += weight[k] * rates[i] / 6;
            at[i] = y[i] + STEP * part[k] * rates[i];
        }
    }
    for (int i = 0; i < STATES * LANES; i++)
        y[i] += STEP * sum[i];
}

/* each lane's angle after each step */
static void swing(const ct_model *model, ct_evaluator *e, const double *p, double *angle)
{
    double start[STATES], y[STATES * LANES], s[LANES] = {0};

    ct_model_start(model, NULL, start, NULL);
    for (int i = 0; i < STATES * LANES; i++)
        y[i] = start[i / LANES];
    for (int k = 0; k < STEPS; k++) {
        step(e, p, y, s);
        for (int lane = 0; lane < LANES; lane++)
            angle[k * LANES + lane] = y[lane];
    }
}

/* the sum of squared differences of each lane from the measured values */
static void compare(const double *angle, const double *measured, double *sum)
{
    for (int lane = 0; lane < LANES; lane++) {
        sum[lane] = 0;
        for (int k = 0; k < STEPS; k++)
            sum[lane] += pow(angle[k * LANES + lane] - measured[k * LANES], 2);
    }
}

/* p of all lanes about the best: along both parameters and diagonally */
static void surround(const double *best, const double *span, double *p)
{
    static const int way[LANES][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                      {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};

    for (int i = 0; i < 2; i++)
        for (int lane = 0; lane < LANES; lane++)
            p[i * LANES + lane] = best[i] + way[lane][i] * span[i];
}

int main(void)
{
    static double angle[STEPS * LANES], measured[STEPS * LANES];
    double p[2 * LANES], sum[LANES], best[2], span[2] = {0.1, 0.1}, least = INFINITY;
    const ct_model_options options = {.lanes = LANES};
    ct_session *session = ct_session_new(NULL);
    ct_model *model = NULL;
    ct_evaluator *e;
    ct_error error;

    if (session == NULL || build(session, pendulum, &error) != CT_OK ||
        ct_model_new(session, &options, &model, &error) != CT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    ct_session_free(session);
    e = ct_evaluator_new(model);
    for (int i = 0; i < 2 * LANES; i++)
        p[i] = i < LANES ? 0.5 : 0.05; /* the values to find */
    swing(model, e, p, measured);
    ct_model_start(model, best, NULL, NULL);
    while (span[0] > 1e-8) {
        int lane = 0;

        surround(best, span, p);
        swing(model, e, p, angle);
        compare(angle, measured, sum);
        for (int k = 1; k < LANES; k++)
            lane = sum[k] < sum[lane] ? k : lane;
        if (sum[lane] < least) {
            least = sum[lane];
            best[0] = p[lane];
            best[1] = p[LANES + lane];
        } else {
            span[0] /= 2;
            span[1] /= 2;
        }
    }
    printf("%s = %.5f, %s = %.5f after %ld evaluations\n", ct_model_name(model, CT_PARAMETERS, 0),
           best[0], ct_model_name(model, CT_PARAMETERS, 1), best[1], calls * LANES);
    ct_evaluator_free(e);
    ct_model_free(model);
    return 0;
}

/* session_sweep_plan.c: the runs that a sweep or a Monte Carlo asks for
 *
 * Of a sweep the values of each key are combined with all values of the others: the first key
 * varies slowest. Sets of a file vary before all of them. */
#include "session/session_sweep.h"

#include "base/worker_processes.h"
#include "language/verbs.h"
#include "simulate/sweep/correlation.h"
#include "simulate/sweep/distribution.h"
#include "simulate/sweep/sampling.h"

#include <math.h>

/* the values of one parameter; or a distribution */
typedef struct SweepAxis {
    const char *name;
    const Syntax *value;
    LIST(double) values;
    Distribution distribution;
} SweepAxis;

typedef struct SweepPlan {
    ct_session *session;
    const Statement *statement;
    LIST(SweepAxis) axes;
    SweepSets sets;
    const Syntax *keep, *file, *correlation;
    double *factor; /* of the correlation; NULL: none */
    Sampling sampling;
    Diag *diag;
} SweepPlan;

static const double most_runs = 1e7;

static void plan_free(SweepPlan *plan)
{
    for (int i = 0; i < plan->axes.count; i++)
        LIST_FREE(plan->axes.at[i].values);
    LIST_FREE(plan->axes);
    mem_free(plan->factor);
    sweep_sets_free(&plan->sets);
}

const Syntax *sweep_kept(const Statement *statement, int i)
{
    for (int k = 0; k < statement->pairs.count; k++) {
        const Syntax *value = statement->pairs.at[k].value;

        if (strcmp(statement->pairs.at[k].name, "keep") != 0)
            continue;
        if (value->kind == SYNTAX_VECTOR)
            return i < value->count ? value->args[i] : NULL;
        return i == 0 ? value : NULL;
    }
    return NULL;
}

/* --- names --- */

static Status check_parameter(const SweepPlan *plan, const char *name, Place place)
{
    const Model *model = plan->session->model;
    Suggest suggest = suggest_for(name);
    const char *dot = strrchr(name, '.');

    if (model_has_parameter(model, name))
        return OK;
    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;

        suggest_offer(&suggest, expr_name(model_parameter(model, i, &definition)));
    }
    for (int i = 0; verb_key(&plan->statement->row, i) != NULL; i++)
        suggest_offer(&suggest, verb_key(&plan->statement->row, i));
    (void)diag_at(plan->diag, E_NAME, place, "there is no parameter '%s'", name);
    if (dot != NULL && suggest.best == NULL)
        diag_hint(plan->diag, "make it one: P = 1 and set %s = P, then %s P=..", name,
                  plan->statement->verb);
    else
        suggest_or_hint(&suggest, plan->diag, "'show params' lists the parameters");
    return E_NAME;
}

static bool has_axis(const SweepPlan *plan, const char *name)
{
    for (int i = 0; i < plan->axes.count; i++)
        if (strcmp(plan->axes.at[i].name, name) == 0)
            return true;
    return false;
}

/* --- numbers --- */

Status sweep_number(ct_session *session, const char *name, const Syntax *syntax, double *out,
                    Diag *diag)
{
    Text unit = {0};
    Status status;

    CHECK(session_number(session, syntax, out, diag));
    session_unit(session, name, &unit);
    if (unit.length > 0)
        CHECK(model_check_unit(session->model, syntax, unit.at, name, diag));
done:
    text_free(&unit);
    return status;
}

/* the same, of a run */
static Status number_for(const SweepPlan *plan, const char *name, const Syntax *syntax, double *out)
{
    TRY(sweep_number(plan->session, name, syntax, out, plan->diag));
    if (!isfinite(*out))
        return diag_at(plan->diag, E_VALUE, syntax->place, "%s has no finite value here", name);
    return OK;
}

/* how many: a whole number, at least `least` */
static Status count_of(const SweepPlan *plan, const Syntax *syntax, const char *what, int least,
                       int *out)
{
    double value;

    TRY(session_number(plan->session, syntax, &value, plan->diag));
    if (!(value >= least && value <= most_runs) || value != floor(value))
        return diag_at(plan->diag, E_VALUE, syntax->place,
                       "%s is a whole number from %d to %.0f, not %g", what, least, most_runs,
                       value);
    *out = (int)value;
    return OK;
}

static bool is_call(const Syntax *syntax, const char *name)
{
    return syntax->kind == SYNTAX_CALL && strcmp(syntax->text, name) == 0;
}

/* --- axes of a sweep --- */

/* range(from, to, count), logrange(from, to, count); both ends are exact */
static Status read_range(const SweepPlan *plan, SweepAxis *axis, bool is_log)
{
    const Syntax *call = axis->value;
    double ends[2] = {0};
    int count = 0;

    if (call->count != 3) {
        (void)diag_at(plan->diag, E_VALUE, call->place, "%s takes 3 numbers, not %d", call->text,
                      call->count);
        diag_hint(plan->diag, "%s=%s(FROM, TO, COUNT)", axis->name, call->text);
        return E_VALUE;
    }
    for (int i = 0; i < 2; i++)
        TRY(number_for(plan, axis->name, call->args[i], &ends[i]));
    TRY(count_of(plan, call->args[2], "the count of a range", 1, &count));
    if (is_log && !(ends[0] * ends[1] > 0)) {
        (void)diag_at(plan->diag, E_VALUE, call->place,
                      "the ends of logrange have one sign, and neither is 0");
        diag_hint(plan->diag, "range(FROM, TO, COUNT) goes through 0");
        return E_VALUE;
    }
    for (int i = 0; i < count; i++) {
        const double s = count > 1 ? (double)i / (count - 1) : 0;

        LIST_PUSH(axis->values, i == 0           ? ends[0]
                                : i == count - 1 ? ends[1]
                                : is_log         ? ends[0] * pow(ends[1] / ends[0], s)
                                                 : ends[0] + s * (ends[1] - ends[0]));
    }
    return OK;
}

static Status read_list(const SweepPlan *plan, SweepAxis *axis)
{
    const Syntax *list = axis->value;
    double value;

    for (int i = 0; i < list->count; i++) {
        TRY(number_for(plan, axis->name, list->args[i], &value));
        LIST_PUSH(axis->values, list->has_unit ? value * list->unit.factor : value);
    }
    if (list->has_unit && list->count > 0) {
        Text unit = {0};
        Syntax one = {.kind = SYNTAX_NUMBER,
                      .text = "1",
                      .has_unit = true,
                      .unit = list->unit,
                      .unit_text = list->unit_text,
                      .height = 1,
                      .place = list->unit_place,
                      .unit_place = list->unit_place};
        Status status = OK;

        session_unit(plan->session, axis->name, &unit);
        if (unit.length > 0)
            status = model_check_unit(plan->session->model, &one, unit.at, axis->name, plan->diag);
        text_free(&unit);
        return status;
    }
    if (list->count == 0)
        return diag_at(plan->diag, E_VALUE, list->place, "%s has no values", axis->name);
    return OK;
}

static Status read_values(const SweepPlan *plan, SweepAxis *axis)
{
    const Syntax *value = axis->value;
    double one;

    if (is_call(value, "range") || is_call(value, "logrange"))
        return read_range(plan, axis, value->text[0] == 'l');
    if (value->kind == SYNTAX_VECTOR)
        return read_list(plan, axis);
    if (value->kind == SYNTAX_CALL &&
        (distribution_find(value->text) >= 0 || strcmp(value->text, "truncated") == 0)) {
        (void)diag_at(plan->diag, E_VALUE, value->place, "a sweep has no random values");
        diag_hint(plan->diag, "montecarlo 1000 %s=%s(..) keep=[..] : %s", axis->name, value->text,
                  plan->statement->rest->text);
        return E_VALUE;
    }
    TRY(number_for(plan, axis->name, value, &one));
    LIST_PUSH(axis->values, one);
    return OK;
}

/* --- axes of a Monte Carlo --- */

static Status refuse_distribution(const SweepPlan *plan, const SweepAxis *axis)
{
    Text list = {0};

    for (int i = 0; distribution_name(i) != NULL; i++)
        text_addf(&list, "%s%s(%s)", i > 0 ? ", " : "", distribution_name(i),
                  distribution_arguments(i));
    (void)diag_at(plan->diag, E_VALUE, axis->value->place, "%s needs a distribution", axis->name);
    diag_hint(plan->diag, "%s; truncated(.., LOW, HIGH) bounds one", list.at);
    text_free(&list);
    return E_VALUE;
}

static Status read_distribution(const SweepPlan *plan, SweepAxis *axis)
{
    const Syntax *call = axis->value;
    Distribution *d = &axis->distribution;
    Status status;

    d->low = -INFINITY;
    d->high = INFINITY;
    if (is_call(call, "truncated")) {
        if (call->count != 3) {
            (void)diag_at(plan->diag, E_VALUE, call->place,
                          "truncated takes a distribution and two bounds");
            diag_hint(plan->diag, "%s=truncated(normal(MEAN, DEVIATION), LOW, HIGH)", axis->name);
            return E_VALUE;
        }
        TRY(number_for(plan, axis->name, call->args[1], &d->low));
        TRY(number_for(plan, axis->name, call->args[2], &d->high));
        call = call->args[0];
    }
    d->kind = call->kind == SYNTAX_CALL ? distribution_find(call->text) : -1;
    if (d->kind < 0)
        return refuse_distribution(plan, axis);
    if (call->count != distribution_argument_count(d->kind)) {
        (void)diag_at(plan->diag, E_VALUE, call->place, "%s takes %d numbers, not %d", call->text,
                      distribution_argument_count(d->kind), call->count);
        diag_hint(plan->diag, "%s(%s)", call->text, distribution_arguments(d->kind));
        return E_VALUE;
    }
    for (int i = 0; i < call->count; i++)
        TRY(number_for(plan, axis->name, call->args[i], &d->at[i]));
    status = distribution_check(d, plan->diag);
    if (status != OK && plan->diag != NULL)
        plan->diag->place = axis->value->place;
    return status;
}

/* --- keys --- */

static Status read_sampling(SweepPlan *plan, const Syntax *value)
{
    const char *word = value->kind == SYNTAX_VARIABLE ? value->text : "";

    for (Sampling i = 0; i < SAMPLINGS; i++)
        if (strcmp(word, sampling_name(i)) == 0) {
            plan->sampling = i;
            return OK;
        }
    return diag_at(plan->diag, E_VALUE, value->place, "points= is one of random, latin, sobol");
}

static Status read_pair(SweepPlan *plan, const Pair *pair, bool is_random)
{
    SweepAxis axis = {.name = pair->name, .value = pair->value};

    if (pair->primes > 0) {
        (void)diag_at(plan->diag, E_NAME, pair->name_place, "a parameter has no primes");
        diag_hint(plan->diag, "make the initial rate one: init %s' = P, then %s P=..", pair->name,
                  plan->statement->verb);
        return E_NAME;
    }
    if (strcmp(pair->name, "keep") == 0) {
        plan->keep = pair->value;
        return OK;
    }
    if (strcmp(pair->name, "jobs") == 0 || strcmp(pair->name, "file") == 0 ||
        strcmp(pair->name, "part") == 0)
        return OK; /* sweep_jobs(), sweep_file_plan() */
    if (is_random && strcmp(pair->name, "correlation") == 0) {
        plan->correlation = pair->value;
        return OK;
    }
    if (strcmp(pair->name, is_random ? "points" : "sets") == 0) {
        if (is_random)
            return read_sampling(plan, pair->value);
        plan->file = pair->value;
        return sweep_sets_read(plan->session, pair->value, &plan->sets, plan->diag);
    }
    TRY(check_parameter(plan, pair->name, pair->name_place));
    LIST_PUSH(plan->axes, axis);
    return is_random ? read_distribution(plan, &plan->axes.at[plan->axes.count - 1])
                     : read_values(plan, &plan->axes.at[plan->axes.count - 1]);
}

static Status check_sets(const SweepPlan *plan)
{
    for (int i = 0; i < plan->sets.names.count; i++) {
        const char *name = plan->sets.names.at[i];
        const Unit *unit = &plan->sets.units.at[i];
        Dimension own;

        TRY(check_parameter(plan, name, plan->file->place));
        if (has_axis(plan, name))
            return diag_at(plan->diag, E_NAME, plan->file->place,
                           "%s has values in '%s' and in the statement", name, plan->file->text);
        for (int k = 0; k < i; k++)
            if (strcmp(plan->sets.names.at[k], name) == 0)
                return diag_at(plan->diag, E_NAME, plan->file->place, "'%s' has %s twice",
                               plan->file->text, name);
        if (unit->factor == 0 || !model_text_dimension(plan->session->model, name, &own))
            continue;
        own = dimension_without_angle(own);

        const Dimension in_file = dimension_without_angle(unit->dimension);

        if (memcmp(&own, &in_file, sizeof own) != 0)
            return diag_at(plan->diag, E_UNIT, plan->file->place,
                           "the unit of %s in '%s' has another dimension than %s", name,
                           plan->file->text, name);
    }
    return OK;
}

/* the rows of the matrix are lists, in the order of the parameters */
static Status read_correlation(SweepPlan *plan)
{
    const Syntax *matrix = plan->correlation;
    const int n = plan->axes.count;
    bool is_square = matrix->kind == SYNTAX_VECTOR && matrix->count == n;
    Status status;

    for (int i = 0; is_square && i < n; i++)
        is_square = matrix->args[i]->kind == SYNTAX_VECTOR && matrix->args[i]->count == n;
    if (!is_square) {
        (void)diag_at(
            plan->diag, E_VALUE, matrix->place,
            "correlation= is a matrix with a row and a column for each of the %d parameters", n);
        diag_hint(plan->diag, "correlation=[[1, 0.5], [0.5, 1]]");
        return E_VALUE;
    }
    plan->factor = mem_array((size_t)n * (size_t)n, sizeof *plan->factor);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            TRY(session_number(plan->session, matrix->args[i]->args[k],
                               &plan->factor[(size_t)i * (size_t)n + (size_t)k], plan->diag));
    status = correlation_factor(plan->factor, n, plan->diag);
    if (status != OK && plan->diag != NULL)
        plan->diag->place = matrix->place;
    return status;
}

static Status check_keep(const SweepPlan *plan)
{
    if (plan->keep == NULL || (plan->keep->kind == SYNTAX_VECTOR && plan->keep->count == 0)) {
        (void)diag_at(plan->diag, E_MISSING, plan->statement->verb_place,
                      "nothing is to be kept of the runs");
        diag_hint(plan->diag, "keep=[max(h1), h1] keeps the largest h1 and the last one of each");
        return E_MISSING;
    }
    return OK;
}

/* --- the table --- */

static void add_columns(const SweepPlan *plan, SweepTable *table)
{
    const int sets = plan->sets.names.count;

    for (int i = 0; i < sets + plan->axes.count; i++) {
        const char *name = i < sets ? plan->sets.names.at[i] : plan->axes.at[i - sets].name;
        Text unit = {0};

        session_unit(plan->session, name, &unit);
        sweep_table_column(table, name, unit.at != NULL ? unit.at : "");
        text_free(&unit);
    }
    for (int i = 0; sweep_kept(plan->statement, i) != NULL; i++) {
        const Syntax *item = sweep_kept(plan->statement, i);
        Text name = {0}, unit = {0};

        syntax_print(&name, item);
        (void)session_shown_unit(plan->session, item, "", &unit);
        sweep_table_column(table, name.at, unit.at != NULL ? unit.at : "");
        text_free(&name);
        text_free(&unit);
    }
    sweep_table_open(table, sets + plan->axes.count);
}

static void fill_products(const SweepPlan *plan, SweepTable *table)
{
    const int sets = plan->sets.names.count;

    for (int r = 0; r < table->planned; r++) {
        double *row = sweep_table_row(table, r);
        int rest = r;

        for (int i = plan->axes.count - 1; i >= 0; i--) {
            row[sets + i] = plan->axes.at[i].values.at[rest % plan->axes.at[i].values.count];
            rest /= plan->axes.at[i].values.count;
        }
        for (int i = 0; i < sets; i++)
            row[i] = plan->sets.values.at[(ptrdiff_t)rest * sets + i];
    }
}

static Status fill_random(const SweepPlan *plan, SweepTable *table)
{
    const int columns = plan->axes.count;
    double *points = mem_array((size_t)table->planned * (size_t)columns, sizeof *points);
    Status status;

    CHECK(sampling_fill(plan->sampling, plan->session->seed, table->planned, columns, points,
                        plan->diag));
    for (int r = 0; plan->factor != NULL && r < table->planned; r++)
        correlation_apply(plan->factor, columns, points + (ptrdiff_t)r * columns);
    for (int r = 0; r < table->planned; r++)
        for (int i = 0; i < columns; i++)
            sweep_table_row(table, r)[i] = distribution_quantile(
                &plan->axes.at[i].distribution, points[(ptrdiff_t)r * columns + i]);
done:
    mem_free(points);
    return status;
}

static Status count_runs(const SweepPlan *plan, int *out)
{
    double runs = plan->sets.rows > 0 ? plan->sets.rows : 1;

    for (int i = 0; i < plan->axes.count; i++)
        runs *= plan->axes.at[i].values.count;
    if (runs > most_runs)
        return diag_at(plan->diag, E_VALUE, plan->statement->verb_place,
                       "these are %.3g runs, and up to %.0f are possible", runs, most_runs);
    *out = (int)runs;
    return OK;
}

Status sweep_jobs(ct_session *session, const Statement *s, int *out, bool *given, Diag *diag)
{
    const SweepPlan plan = {.session = session, .statement = s, .diag = diag};

    *given = model_settings(session->model)->is_given[SETTING_JOBS];
    *out = *given ? 1 + model_setting_value(session->model, SETTING_JOBS)
                  : worker_processes_available();
    for (int i = 0; i < s->pairs.count; i++) {
        const Pair *pair = &s->pairs.at[i];

        if (strcmp(pair->name, "jobs") != 0 || pair->primes > 0)
            continue;
        *given = true;
        TRY(count_of(&plan, pair->value, "jobs", 1, out));
        if (*out > MOST_WORKERS)
            return diag_at(diag, E_VALUE, pair->value->place, "jobs is from 1 to %d", MOST_WORKERS);
    }
    return OK;
}

Status sweep_plan(ct_session *session, const Statement *s, SweepTable **out, Diag *diag)
{
    SweepPlan plan = {.session = session, .statement = s, .diag = diag};
    const bool is_random = s->row.number == VERB_montecarlo;
    SweepTable *table = NULL;
    int runs = 0;
    Status status = OK;

    if (is_random)
        CHECK(count_of(&plan, s->operands.at[0].value, "the number of runs", 1, &runs));
    for (int i = 0; i < s->pairs.count; i++)
        CHECK(read_pair(&plan, &s->pairs.at[i], is_random));
    if (plan.correlation != NULL)
        CHECK(read_correlation(&plan));
    CHECK(check_sets(&plan));
    CHECK(check_keep(&plan));
    if (plan.axes.count + plan.sets.names.count == 0) {
        status = diag_at(diag, E_MISSING, s->verb_place, "no parameter varies");
        diag_hint(diag, is_random ? "montecarlo 1000 L=normal(0.1, 0.01) keep=[..] : simulate 5"
                                  : "sweep L=range(0.1, 0.3, 20) keep=[..] : simulate 5");
        goto done;
    }
    if (!is_random)
        CHECK(count_runs(&plan, &runs));
    table = sweep_table_new(runs);
    table->is_random = is_random;
    add_columns(&plan, table);
    if (is_random)
        CHECK(fill_random(&plan, table));
    else
        fill_products(&plan, table);
    *out = table;
    table = NULL;
done:
    if (status != OK && diag != NULL && diag->place.line == 0)
        diag->place = s->verb_place;
    sweep_table_free(table);
    plan_free(&plan);
    return status;
}

/* session_fit_plan.c: the data of a fit, and what they are compared with */
#include "session/session_fit.h"

#include <math.h>

typedef struct PlanReader {
    ct_session *session;
    const Statement *statement;
    FitPlan *plan;
    Diag *diag;
} PlanReader;

void fit_plan_free(FitPlan *plan)
{
    for (int i = 0; i < plan->targets.count; i++)
        MEM_FREE(plan->targets.at[i].times, plan->targets.at[i].data);
    LIST_FREE(plan->targets);
}

/* --- targets --- */

/* the call of table() in to=; NULL: there is none */
static const Syntax *find_table(const Syntax *syntax)
{
    const Syntax *found = NULL;

    if (syntax->kind == SYNTAX_CALL && strcmp(syntax->text, "table") == 0)
        return syntax;
    for (int i = 0; i < syntax->count && found == NULL; i++)
        found = find_table(syntax->args[i]);
    return found;
}

/* the points of a table in a formula */
static Status find_curve(const PlanReader *r, const Syntax *syntax, const Curve **out)
{
    Formula formula = {0};

    TRY(formula_new(r->session, syntax, &formula, r->diag));
    for (int i = -1; i < formula.leaves.count && *out == NULL; i++) {
        const Expr root = i < 0 ? formula.whole : formula.leaves.at[i].expr;
        Expr *tables = NULL;

        if (root != NULL && expr_tables(&root, 1, &tables) > 0)
            *out = expr_data(tables[0]);
        mem_free(tables);
    }
    formula_free(&formula);
    return OK;
}

static Status read_number_target(const PlanReader *r, FitTarget *target)
{
    Text unit = {0};
    double value;
    Status status;

    CHECK(session_number(r->session, target->to, &value, r->diag));
    (void)session_shown_unit(r->session, target->by, "", &unit);
    if (unit.length > 0)
        CHECK(model_check_unit(r->session->model, target->to, unit.at, "to=", r->diag));
    if (!isfinite(value)) {
        status = diag_at(r->diag, E_VALUE, target->to->place, "to= has no value");
        goto done;
    }
    target->count = 1;
    target->times = NEW_ARRAY(double, 1);
    target->data = NEW_ARRAY(double, 1);
    target->data[0] = value;
    target->spread = value != 0 ? fabs(value) : 1;
done:
    text_free(&unit);
    return status;
}

static Status read_target(const PlanReader *r, FitTarget *target)
{
    const Syntax *table = find_table(target->to);

    if (table == NULL)
        return read_number_target(r, target);
    if (table->count < 2 || table->args[1]->kind != SYNTAX_VARIABLE ||
        strcmp(table->args[1]->text, "t") != 0 || table->args[1]->primes > 0) {
        (void)diag_at(r->diag, E_VALUE, table->place, "data are a function of the time");
        diag_hint(r->diag, "to=table(\"data.csv\", t, \"column\")");
        return E_VALUE;
    }
    TRY(find_curve(r, target->to, &target->curve));
    return OK;
}

static Status read_sigma(const PlanReader *r, const Syntax *syntax, FitTarget *target)
{
    TRY(session_number(r->session, syntax, &target->sigma, r->diag));
    if (!(target->sigma > 0 && isfinite(target->sigma)))
        return diag_at(r->diag, E_VALUE, syntax->place,
                       "sigma= is a standard deviation, above 0, not %g", target->sigma);
    return OK;
}

/* as many items in each list as signals */
static Status check_counts(const PlanReader *r, const char *name, const Syntax *list, int count)
{
    if (syntax_list_count(list) == count)
        return OK;
    return diag_at(r->diag, E_VALUE, list->place, "%s= has %d value%s, and by= has %d", name,
                   syntax_list_count(list), syntax_list_count(list) == 1 ? "" : "s", count);
}

static Status read_targets(const PlanReader *r)
{
    const Syntax *to = statement_key(r->statement, "to"), *by = statement_key(r->statement, "by"),
                 *sigma = statement_key(r->statement, "sigma");
    const int count = syntax_list_count(by);

    if (count == 0 || to == NULL) {
        (void)diag_at(r->diag, E_MISSING, r->statement->verb_place,
                      count == 0 ? "by= is missing: what the run has to match the data"
                                 : "to= is missing: the data");
        diag_hint(r->diag, "fit k d to=table(\"data.csv\", t, \"h\") by=h : simulate 5");
        return E_MISSING;
    }
    TRY(check_counts(r, "to", to, count));
    if (sigma != NULL)
        TRY(check_counts(r, "sigma", sigma, count));
    r->plan->has_sigma = sigma != NULL;
    for (int i = 0; i < count; i++) {
        const FitTarget blank = {.to = syntax_list_item(to, i), .by = syntax_list_item(by, i)};
        FitTarget *target;

        LIST_PUSH(r->plan->targets, blank);
        target = &r->plan->targets.at[i];
        TRY(read_target(r, target));
        if (sigma != NULL)
            TRY(read_sigma(r, syntax_list_item(sigma, i), target));
    }
    return OK;
}

static Status read_loss(const PlanReader *r)
{
    const Syntax *value = statement_key(r->statement, "loss");
    const char *word = value != NULL && value->kind == SYNTAX_VARIABLE ? value->text : "";
    Text list = {0};

    if (value == NULL)
        return OK;
    for (Loss i = 0; i < LOSSES; i++) {
        text_addf(&list, "%s%s", i > 0 ? ", " : "", loss_name(i));
        if (strcmp(word, loss_name(i)) == 0) {
            r->plan->loss = i;
            text_free(&list);
            return OK;
        }
    }
    (void)diag_at(r->diag, E_VALUE, value->place, "loss= is one of %s", list.at);
    text_free(&list);
    return E_VALUE;
}

Status fit_plan(ct_session *session, const Statement *s, FitPlan *out, Diag *diag)
{
    const PlanReader reader = {session, s, out, diag};

    *out = (FitPlan){0};
    TRY(read_targets(&reader));
    return read_loss(&reader);
}

/* --- data --- */

/* standard deviation; the size of the largest where all are equal */
static double spread_of(const double *values, int count)
{
    double mean = 0, squares = 0, most = 0;

    for (int i = 0; i < count; i++) {
        mean += values[i] / count;
        most = fmax(most, fabs(values[i]));
    }
    for (int i = 0; i < count; i++)
        squares += (values[i] - mean) * (values[i] - mean) / count;
    return squares > 0 ? sqrt(squares) : most > 0 ? most : 1;
}

static Status take_data(ct_session *session, FitTarget *target, Run *run, Diag *diag)
{
    const double *rows = result_times(run->result);
    const double from = rows[0], to = rows[result_rows(run->result) - 1];
    Formula formula = {0};
    Status status = OK;

    target->times = NEW_ARRAY(double, target->curve->count);
    target->data = NEW_ARRAY(double, target->curve->count);
    for (int i = 0; i < target->curve->count; i++) {
        const double t = session_row_time(run->result, target->curve->data[i]);

        if (t >= from && t <= to)
            target->times[target->count++] = t;
    }
    if (target->count == 0)
        return diag_at(diag, E_VALUE, target->to->place,
                       "'%s' has no data from %g to %g s, where the run is", target->curve->file,
                       from, to);
    CHECK(formula_new(session, target->to, &formula, diag));
    CHECK(formula_rows(session, &formula, 1, run, run, target->times, target->count, target->data,
                       1, 0, diag));
    target->spread = spread_of(target->data, target->count);
done:
    formula_free(&formula);
    return status;
}

Status fit_plan_data(ct_session *session, FitPlan *plan, int *left, Diag *diag)
{
    *left = 0;
    for (int i = 0; i < plan->targets.count; i++) {
        FitTarget *target = &plan->targets.at[i];

        if (target->curve == NULL)
            continue;
        if (session->runs.count == 0)
            return diag_at(diag, E_VALUE, target->to->place,
                           "data over the time need a run after the colon");
        TRY(take_data(session, target, &session->runs.at[session->runs.count - 1], diag));
        *left += target->curve->count - target->count;
    }
    return OK;
}

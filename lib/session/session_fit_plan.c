/* session_fit_plan.c: what a fit is to find, and the data that it has */
#include "session/session_fit.h"

#include "language/verbs.h"

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
    LIST_FREE(plan->unknowns);
}

static const Syntax *key_of(const PlanReader *r, const char *name)
{
    for (int i = 0; i < r->statement->pairs.count; i++)
        if (strcmp(r->statement->pairs.at[i].name, name) == 0)
            return r->statement->pairs.at[i].value;
    return NULL;
}

/* [a, b] is a list, anything else a list of one */
static int list_count(const Syntax *list)
{
    return list == NULL ? 0 : list->kind == SYNTAX_VECTOR ? list->count : 1;
}

static const Syntax *list_item(const Syntax *list, int i)
{
    return list->kind == SYNTAX_VECTOR ? list->args[i] : list;
}

/* --- unknowns --- */

static Status check_unknown(const PlanReader *r, const char *name, int primes, Place place)
{
    const Model *model = r->session->model;
    Suggest suggest = suggest_for(name);

    if (primes > 0 || !model_has_parameter(model, name)) {
        for (int i = 0; i < model_parameter_count(model); i++) {
            Expr definition;

            suggest_offer(&suggest, expr_name(model_parameter(model, i, &definition)));
        }
        for (int i = 0; verb_key(&r->statement->row, i) != NULL; i++)
            suggest_offer(&suggest, verb_key(&r->statement->row, i));
        (void)diag_at(r->diag, E_NAME, place, "there is no parameter '%s%.*s'", name,
                      primes < 9 ? primes : 9, "'''''''''");
        suggest_or_hint(&suggest, r->diag,
                        "a value of a part or an initial value is one by a name: P = 1, then "
                        "'set' or 'init' with P");
        return E_NAME;
    }
    for (int i = 0; i < model_override_count(model); i++)
        if (strcmp(model_override_name(model, i), name) == 0)
            return diag_at(r->diag, E_VALUE, place, "%s is set by -D", name);
    for (int i = 0; i < r->plan->unknowns.count; i++)
        if (strcmp(r->plan->unknowns.at[i].name, name) == 0)
            return diag_at(r->diag, E_NAME, place, "%s is there twice", name);
    return OK;
}

static double value_now(const ct_session *session, const char *name)
{
    const Model *model = session->model;

    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(model, i, &definition);

        if (strcmp(expr_name(symbol), name) == 0)
            return model_parameter_value(model, symbol);
    }
    return NAN;
}

static Status add_unknown(const PlanReader *r, const char *name, int primes, Place place)
{
    FitUnknown unknown = {.name = name, .place = place, .low = -INFINITY, .high = INFINITY};

    TRY(check_unknown(r, name, primes, place));
    unknown.start = value_now(r->session, name);
    if (!isfinite(unknown.start))
        return diag_at(r->diag, E_VALUE, place, "%s has no value to start from", name);
    LIST_PUSH(r->plan->unknowns, unknown);
    return OK;
}

static Status read_bound(const PlanReader *r, const char *name, const Syntax *syntax, double *out)
{
    Text unit = {0};
    Status status;

    CHECK(session_number(r->session, syntax, out, r->diag));
    session_unit(r->session, name, &unit);
    if (unit.length > 0)
        CHECK(model_check_unit(r->session->model, syntax, unit.at, name, r->diag));
    if (isnan(*out))
        status = diag_at(r->diag, E_VALUE, syntax->place, "this bound of %s has no value", name);
done:
    text_free(&unit);
    return status;
}

/* k=[LOW, HIGH] */
static Status add_bounded(const PlanReader *r, const Pair *pair)
{
    const Syntax *value = pair->value;
    FitUnknown *unknown;

    TRY(add_unknown(r, pair->name, pair->primes, pair->name_place));
    unknown = &r->plan->unknowns.at[r->plan->unknowns.count - 1];
    if (value->kind != SYNTAX_VECTOR || value->count != 2 || value->has_unit) {
        (void)diag_at(r->diag, E_VALUE, value->place, "%s= takes two bounds", pair->name);
        diag_hint(r->diag, "%s=[LOW, HIGH]; without bounds: fit %s to=..", pair->name, pair->name);
        return E_VALUE;
    }
    TRY(read_bound(r, pair->name, value->args[0], &unknown->low));
    TRY(read_bound(r, pair->name, value->args[1], &unknown->high));
    if (!(unknown->low < unknown->high))
        return diag_at(r->diag, E_VALUE, value->place,
                       "the lower bound of %s, %g, is not below the upper one, %g", pair->name,
                       unknown->low, unknown->high);
    unknown->start = fmin(fmax(unknown->start, unknown->low), unknown->high);
    return OK;
}

static bool is_key(const PlanReader *r, const char *name)
{
    for (int i = 0; verb_key(&r->statement->row, i) != NULL; i++)
        if (strcmp(verb_key(&r->statement->row, i), name) == 0)
            return true;
    return false;
}

static Status read_unknowns(const PlanReader *r)
{
    const Statement *s = r->statement;

    for (int i = 0; i < s->operands.count; i++) {
        const Syntax *operand = s->operands.at[i].value;

        if (operand->kind != SYNTAX_VARIABLE || operand->has_unit)
            return diag_at(r->diag, E_NAME, operand->place, "this is no parameter");
        TRY(add_unknown(r, operand->text, operand->primes, operand->place));
    }
    for (int i = 0; i < s->pairs.count; i++)
        if (!is_key(r, s->pairs.at[i].name))
            TRY(add_bounded(r, &s->pairs.at[i]));
    if (r->plan->unknowns.count > 0)
        return OK;
    (void)diag_at(r->diag, E_MISSING, s->verb_place, "no parameter is to be found");
    diag_hint(r->diag, "fit k d to=table(\"data.csv\", t, \"h\") by=h : simulate 5");
    return E_MISSING;
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
    if (list_count(list) == count)
        return OK;
    return diag_at(r->diag, E_VALUE, list->place, "%s= has %d value%s, and by= has %d", name,
                   list_count(list), list_count(list) == 1 ? "" : "s", count);
}

static Status read_targets(const PlanReader *r)
{
    const Syntax *to = key_of(r, "to"), *by = key_of(r, "by"), *sigma = key_of(r, "sigma");
    const int count = list_count(by);

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
        const FitTarget blank = {.to = list_item(to, i), .by = list_item(by, i)};
        FitTarget *target;

        LIST_PUSH(r->plan->targets, blank);
        target = &r->plan->targets.at[i];
        TRY(read_target(r, target));
        if (sigma != NULL)
            TRY(read_sigma(r, list_item(sigma, i), target));
    }
    return OK;
}

static Status read_loss(const PlanReader *r)
{
    const Syntax *value = key_of(r, "loss");
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
    TRY(read_unknowns(&reader));
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
                           "data over the time need a run behind the colon");
        TRY(take_data(session, target, &session->runs.at[session->runs.count - 1], diag));
        *left += target->curve->count - target->count;
    }
    return OK;
}

/* session_fit_entry.c: figures of the last fit: fit.value(k), fit.error(k), fit.correlation(k, d)
 */
#include "session/session_fit.h"

#include <math.h>

typedef struct FitEntry {
    const char *name;
    const char *usage;
    int count; /* of arguments */
    double (*value)(const FitResult *fit, const int *parameters);
    bool has_unit; /* that of the parameter */
} FitEntry;

static double value_of(const FitResult *fit, const int *parameters)
{
    return fit->parameters.at[parameters[0]].value;
}

static double error_of(const FitResult *fit, const int *parameters)
{
    return fit->parameters.at[parameters[0]].error;
}

static double half_of(const FitResult *fit, const int *parameters)
{
    return fit->parameters.at[parameters[0]].half;
}

static double correlation_of(const FitResult *fit, const int *parameters)
{
    return fit->correlations[parameters[0] * fit->parameters.count + parameters[1]];
}

/* clang-format off */
static const FitEntry entries[] = {
    {"fit.value",       "fit.value(PARAMETER)",                  1, value_of,       true},
    {"fit.error",       "fit.error(PARAMETER)",                  1, error_of,       true},
    {"fit.half",        "fit.half(PARAMETER)",                   1, half_of,        true},
    {"fit.correlation", "fit.correlation(PARAMETER, PARAMETER)", 2, correlation_of, false},
};
/* clang-format on */

static const FitEntry *find_entry(const char *name)
{
    for (int i = 0; i < COUNT(entries); i++)
        if (strcmp(entries[i].name, name) == 0)
            return &entries[i];
    return NULL;
}

bool fit_entry_is_called(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && find_entry(syntax->text) != NULL;
}

static Status need_fit(const ct_session *session, Diag *diag)
{
    if (session->fit != NULL)
        return OK;
    (void)diag_set(diag, E_MISSING, "there is no fit yet");
    diag_hint(diag, "fit k d to=table(\"data.csv\", t, \"h\") by=h : simulate 5");
    return E_MISSING;
}

static Status read_parameter(const FitResult *fit, const Syntax *syntax, int *out, Diag *diag)
{
    Text list = {0};

    *out = syntax->kind == SYNTAX_VARIABLE ? fit_result_find(fit, syntax->text) : -1;
    if (*out >= 0)
        return OK;
    for (int i = 0; i < fit->parameters.count; i++)
        text_addf(&list, "%s%s", i > 0 ? ", " : "", fit->parameters.at[i].name);
    (void)diag_at(diag, E_NAME, syntax->place, "the fit has no such parameter");
    diag_hint(diag, "it has: %.300s", list.at);
    text_free(&list);
    return E_NAME;
}

Status fit_entry_value(const ct_session *session, const Syntax *call, double *out, Diag *diag)
{
    const FitEntry *entry = find_entry(call->text);
    int parameters[2] = {0};

    TRY(need_fit(session, diag));
    if (call->count != entry->count) {
        (void)diag_at(diag, E_VALUE, call->place, "%s takes %d argument%s, not %d", call->text,
                      entry->count, entry->count == 1 ? "" : "s", call->count);
        diag_hint(diag, "%s", entry->usage);
        return E_VALUE;
    }
    for (int i = 0; i < entry->count; i++)
        TRY(read_parameter(session->fit, call->args[i], &parameters[i], diag));
    *out = entry->value(session->fit, parameters);
    return OK;
}

Status fit_size_value(ct_session *session, const char *path, double *out, Diag *diag)
{
    TRY(need_fit(session, diag));
    if (strcmp(path, "fit.points") == 0)
        *out = session->fit->points;
    else if (strcmp(path, "fit.runs") == 0)
        *out = session->fit->runs;
    else if (strcmp(path, "fit.rms") == 0)
        *out = session->fit->signals.at[0].rms;
    else if (strcmp(path, "fit.converged") == 0)
        *out = session->fit->is_converged;
    else {
        (void)diag_set(diag, E_NAME, "there is no '%s'", path);
        diag_hint(diag, "fit.points, fit.runs and fit.converged; fit.rms is the root mean square "
                        "of the residuals of the first signal; fit.value(PARAMETER) is a value");
        return E_NAME;
    }
    return OK;
}

bool fit_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out)
{
    const FitEntry *entry = find_entry(call->text);
    const FitResult *fit = session->fit;
    size_t fault;
    Unit unit;
    int i;

    if (entry == NULL || fit == NULL || !entry->has_unit || call->count != 1)
        return false;
    i = call->args[0]->kind == SYNTAX_VARIABLE ? fit_result_find(fit, call->args[0]->text) : -1;
    if (i < 0 || fit->parameters.at[i].unit[0] == '\0' ||
        !unit_parse(fit->parameters.at[i].unit, strlen(fit->parameters.at[i].unit), &unit, &fault))
        return false;
    *out = unit.dimension;
    return true;
}

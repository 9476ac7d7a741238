/* netdae.c: G and its derivatives by x, x' and z, compiled to numbers */
#include "simulate/equations/netdae.h"

#include "algebra/linear.h"
#include "algebra/pattern.h"
#include "base/memory.h"
#include "simulate/equations/mode_forms.h"

#include <string.h>

struct NetDae {
    const VariableIndex *l;
    Parameters *parameters;
    Motion *motion;
    Dae dae;
    Probe *probe; /* computes G, its derivatives by x, x', z, and power */
    bool is_compiled, is_linear;
    Pattern pattern; /* of the Jacobian by w */
    int *place;      /* index into it of each derivative, then of work' */
    double *weight;
    bool *has_rate;
    ModeForms *forms; /* where the equations are linear; NULL: not needed yet */
};

/* --- compiling --- */

typedef LIST(Expr) Values;

/* index of [x; z] in w: work is between them */
static int shifted(const VariableIndex *l, int place)
{
    return place < l->nx ? place : place + 1;
}

/* derivatives by x' and by x have a common entry */
static void find_pattern(NetDae *d)
{
    const VariableIndex *l = d->l;
    int count;
    const Slope *slopes = residual_slopes(probe_residual(d->probe), &count);
    int *row = NEW_ARRAY(int, count + 1), *column = NEW_ARRAY(int, count + 1);

    d->is_linear = true;
    for (int k = 0; k < count; k++) {
        const int by = slopes[k].unknown;

        row[k] = shifted(l, slopes[k].row);
        column[k] = shifted(l, by < l->nx ? by : by - l->nx);
        d->is_linear = d->is_linear && (slopes[k].kinds & ~(1U << SYMBOL_PARAMETER)) == 0;
    }
    /* only the derivative by work': others have no influence on the solution */
    row[count] = column[count] = l->nx;
    d->place = NEW_ARRAY(int, count + 1);
    d->pattern = pattern_of(d->dae.n, d->dae.n, count + 1, row, column, d->place);
    MEM_FREE(row, column);
}

static bool compile(NetDae *d)
{
    const VariableIndex *l = d->l;
    Values roots = {0};
    Expr *unknowns = variable_index_network(l);
    ProbeOrder order = {
        .row_count = l->nx + l->nz, .unknowns = unknowns, .unknown_count = 2 * l->nx + l->nz};

    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(roots, system_run(l->system)->network_residual[i]);
    LIST_PUSH(roots, system_power(l->system));
    order.roots = roots.at;
    order.root_count = roots.count;
    d->is_compiled = probe_make(l, d->parameters, &order, &d->probe, NULL) == OK;
    if (d->is_compiled)
        find_pattern(d);
    LIST_FREE(roots);
    mem_free(unknowns);
    return d->is_compiled;
}

/* --- for a solver --- */

static const double *values_at(NetDae *d, double t, const double *w, const double *w_rate)
{
    RowValues row = {.t = motion_clock(d->motion, t), .x = w, .rates = w_rate};

    row.z = w + d->l->nx + 1;
    return probe_values(d->probe, &row);
}

static bool residual(void *context, double t, const double *w, const double *w_rate, double *out)
{
    NetDae *d = context;
    const VariableIndex *l = d->l;
    const double *values = values_at(d, t, w, w_rate);

    memcpy(out, values, (size_t)l->nx * sizeof(double));
    out[l->nx] = w_rate[l->nx] - values[l->nx + l->nz];
    memcpy(out + l->nx + 1, values + l->nx, (size_t)l->nz * sizeof(double));
    return vector_is_finite(out, d->dae.n);
}

static bool jacobian(void *context, double t, double c, const double *w, const double *w_rate,
                     double *out)
{
    NetDae *d = context;
    const VariableIndex *l = d->l;
    int count;
    const Slope *slopes = residual_slopes(probe_residual(d->probe), &count);
    const double *values = values_at(d, t, w, w_rate) + l->nx + l->nz + 1;

    memset(out, 0, (size_t)d->pattern.count * sizeof(double));
    for (int k = 0; k < count; k++) {
        const bool by_rate = slopes[k].unknown >= l->nx && slopes[k].unknown < 2 * l->nx;

        out[d->place[k]] += by_rate ? c * values[k] : values[k];
    }
    out[d->place[count]] = c;
    return vector_is_finite(out, d->pattern.count);
}

static bool start(void *context, double t, const double *y, double *w, double *w_rate)
{
    NetDae *d = context;
    const VariableIndex *l = d->l;
    Solved solved;
    size_t bytes = (size_t)l->nx * sizeof(double);

    if ((!d->is_compiled && !compile(d)) || !motion_solve(d->motion, t, y, &solved))
        return false;
    memset(w_rate, 0, (size_t)d->dae.n * sizeof(double));
    memcpy(w, y, bytes + sizeof(double));
    memcpy(w_rate, solved.rates, bytes);
    memcpy(w + l->nx + 1, solved.algebraic, (size_t)l->nz * sizeof(double));
    w_rate[l->nx] = values_at(d, t, w, w_rate)[l->nx + l->nz];
    return vector_is_finite(w, d->dae.n) && vector_is_finite(w_rate, d->dae.n);
}

static bool is_linear(void *context)
{
    NetDae *d = context;

    return (d->is_compiled || compile(d)) && d->is_linear;
}

static int pattern(void *context, const int **row, const int **column)
{
    const NetDae *d = context;

    *row = d->pattern.row;
    *column = d->pattern.column;
    return d->pattern.count;
}

static const HessenbergForm *known(void *context)
{
    const NetDae *d = context;

    return d->forms != NULL ? mode_forms_find(d->forms, d->l->closed) : NULL;
}

static const HessenbergForm *keep(void *context, HessenbergForm *given)
{
    NetDae *d = context;

    if (d->forms == NULL)
        d->forms = mode_forms_new(d->l->switches);
    return mode_forms_store(d->forms, d->l->closed, given);
}

NetDae *netdae_new(const VariableIndex *l, Parameters *parameters, Motion *motion)
{
    NetDae *d;

    if (l->n > 0 || l->nu > 0 || l->m > 0 || l->nx == 0)
        return NULL;
    d = NEW(NetDae);
    d->l = l;
    d->parameters = parameters;
    d->motion = motion;
    d->dae = (Dae){.n = l->nx + 1 + l->nz,
                   .context = d,
                   .residual = residual,
                   .start = start,
                   .pattern = pattern,
                   .jacobian = jacobian,
                   .is_index_one = true,
                   .is_linear = is_linear,
                   .known = known,
                   .keep = keep};
    d->weight = NEW_ARRAY(double, d->dae.n);
    d->has_rate = NEW_ARRAY(bool, d->dae.n);
    for (int i = 0; i < d->dae.n; i++) {
        d->weight[i] = i == l->nx ? 1e20 : 1; /* work has no influence on other unknowns */
        d->has_rate[i] = i <= l->nx;
    }
    d->dae.weight = d->weight;
    d->dae.has_rate = d->dae.is_tested = d->has_rate;
    return d;
}

void netdae_free(NetDae *d)
{
    if (d == NULL)
        return;
    mode_forms_free(d->forms);
    probe_free(d->probe);
    pattern_free(&d->pattern);
    MEM_FREE(d->place, d->weight, d->has_rate, d);
}

const Dae *netdae_equations(const NetDae *d)
{
    return &d->dae;
}

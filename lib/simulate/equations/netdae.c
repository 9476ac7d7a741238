/* netdae.c: G and its derivatives by x, x' and z in numbers */
#include "simulate/equations/netdae.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/mode_forms.h"

#include <string.h>

struct NetDae {
    const Layout *l;
    Parameters *parameters;
    Motion *motion;
    Dae dae;
    Slopes slopes;
    Probe *probe; /* G, power, slopes */
    bool is_compiled, is_linear;
    /* pattern of the Jacobian, and which place of it a slope is added to */
    int entries;
    int *row, *column, *place;
    double *weight;
    bool *has_rate;
    ModeForms *forms; /* where the equations are linear; NULL: not asked for yet */
};

/* --- derivatives --- */

typedef LIST(Expr) Values;

static void add_slopes_by_states(const Layout *l, int row, const int *state_of, Slopes *out)
{
    Expr residual = system_run(l->system)->network_residual[row];
    Expr *symbols;
    int count = expr_symbols(&residual, 1, &symbols);

    out->row = mem_grow(out->row, (size_t)out->count + (size_t)count, sizeof(int));
    out->column = mem_grow(out->column, (size_t)out->count + (size_t)count, sizeof(int));
    out->value = mem_grow(out->value, (size_t)out->count + (size_t)count, sizeof(Expr));
    for (int i = 0; i < count; i++) {
        Expr slope;

        if (expr_symbol_kind(symbols[i]) != SYMBOL_STATE)
            continue;
        slope = expr_diff(system_arena(l->system), residual, symbols[i]);
        if (expr_is_zero(slope))
            continue;
        out->row[out->count] = row;
        out->column[out->count] = state_of[expr_symbol_number(symbols[i])];
        out->value[out->count++] = slope;
    }
    mem_free(symbols);
}

Slopes slopes_of(const Layout *l)
{
    const Reading *run = system_run(l->system);
    Slopes out = {.count = run->network_entries, .rates = run->network_entries};
    int *state_of;
    int most = 0;

    out.row = NEW_ARRAY(int, out.count + 1);
    out.column = NEW_ARRAY(int, out.count + 1);
    out.value = NEW_ARRAY(Expr, out.count + 1);
    for (int k = 0; k < out.count; k++) {
        out.row[k] = run->network[k].row;
        out.column[k] = run->network[k].column;
        out.value[k] = run->network[k].value;
    }
    for (int i = 0; i < l->nx; i++)
        if (expr_symbol_number(l->symbols[l->x + i]) > most)
            most = expr_symbol_number(l->symbols[l->x + i]);
    state_of = NEW_ARRAY(int, most + 1);
    for (int i = 0; i < l->nx; i++)
        state_of[expr_symbol_number(l->symbols[l->x + i])] = i;
    for (int i = 0; i < l->nx + l->nz; i++)
        add_slopes_by_states(l, i, state_of, &out);
    mem_free(state_of);
    return out;
}

void slopes_free(Slopes *slopes)
{
    mem_free(slopes->row);
    mem_free(slopes->column);
    mem_free(slopes->value);
    *slopes = (Slopes){0};
}

/* --- pattern --- */

/* work stands between x and z */
static int shifted(const Layout *l, int place)
{
    return place < l->nx ? place : place + 1;
}

/* slopes by x' and by x may share a place: the first one in a row makes it */
static void find_pattern(NetDae *d)
{
    const Slopes *s = &d->slopes;
    int n = d->dae.n;
    int *start = NEW_ARRAY(int, n + 1);
    int *order = NEW_ARRAY(int, s->count);
    int *entry = NEW_ARRAY(int, n); /* of a column in the row at hand, plus 1 */

    d->row = NEW_ARRAY(int, s->count + 1);
    d->column = NEW_ARRAY(int, s->count + 1);
    d->place = NEW_ARRAY(int, s->count);
    for (int k = 0; k < s->count; k++)
        start[shifted(d->l, s->row[k]) + 1]++;
    for (int i = 0; i < n; i++)
        start[i + 1] += start[i];
    for (int k = 0; k < s->count; k++)
        order[start[shifted(d->l, s->row[k])]++] = k;
    for (int i = 0; i < s->count; i++) {
        int k = order[i];
        int row = shifted(d->l, s->row[k]), column = shifted(d->l, s->column[k]);

        if (entry[column] == 0 || d->row[entry[column] - 1] != row) {
            d->row[d->entries] = row;
            d->column[d->entries] = column;
            entry[column] = ++d->entries;
        }
        d->place[k] = entry[column] - 1;
    }
    /* work' alone: what it follows from needn't be told to a solver */
    d->row[d->entries] = d->column[d->entries] = d->l->nx;
    d->entries++;
    mem_free(start);
    mem_free(order);
    mem_free(entry);
}

static bool compile(NetDae *d)
{
    const Layout *l = d->l;
    const Reading *run = system_run(l->system);
    Values roots = {0};
    Status status;

    d->slopes = slopes_of(l);
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(roots, run->network_residual[i]);
    LIST_PUSH(roots, system_power(l->system));
    for (int k = 0; k < d->slopes.count; k++)
        LIST_PUSH(roots, d->slopes.value[k]);
    d->is_linear = true;
    for (int k = 0; k < d->slopes.count; k++)
        d->is_linear = d->is_linear && stage_of(d->slopes.value[k]) == STAGE_PARAMETER;
    status = probe_new(l, d->parameters, roots.at, roots.count, &d->probe, NULL);
    LIST_FREE(roots);
    find_pattern(d);
    d->is_compiled = status == OK;
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
    const Layout *l = d->l;
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
    const Slopes *s = &d->slopes;
    const double *values = values_at(d, t, w, w_rate) + d->l->nx + d->l->nz + 1;

    memset(out, 0, (size_t)d->entries * sizeof(double));
    for (int k = 0; k < s->count; k++) {
        bool by_rate = k < s->rates && s->column[k] < d->l->nx;

        out[d->place[k]] += by_rate ? c * values[k] : values[k];
    }
    out[d->entries - 1] = c;
    return vector_is_finite(out, d->entries);
}

static bool start(void *context, double t, const double *y, double *w, double *w_rate)
{
    NetDae *d = context;
    const Layout *l = d->l;
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

    *row = d->row;
    *column = d->column;
    return d->entries;
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
    return mode_forms_keep(d->forms, d->l->closed, given);
}

NetDae *netdae_new(const Layout *l, Parameters *parameters, Motion *motion)
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
                   .is_linear = is_linear,
                   .known = known,
                   .keep = keep};
    d->weight = NEW_ARRAY(double, d->dae.n);
    d->has_rate = NEW_ARRAY(bool, d->dae.n);
    for (int i = 0; i < d->dae.n; i++) {
        d->weight[i] = i == l->nx ? 1e20 : 1; /* work steers nothing */
        d->has_rate[i] = i <= l->nx;
    }
    d->dae.weight = d->weight;
    d->dae.has_rate = d->has_rate;
    return d;
}

void netdae_free(NetDae *d)
{
    if (d == NULL)
        return;
    mode_forms_free(d->forms);
    slopes_free(&d->slopes);
    probe_free(d->probe);
    mem_free(d->row);
    mem_free(d->column);
    mem_free(d->place);
    mem_free(d->weight);
    mem_free(d->has_rate);
    mem_free(d);
}

const Dae *netdae_equations(const NetDae *d)
{
    return &d->dae;
}

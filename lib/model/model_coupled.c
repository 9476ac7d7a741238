/* model_coupled.c: checks whether the stored energy of coupled parts is positive definite
 *
 * Coupled coils store the energy i^T L i / 2 (J). L (H, n x n), with their inductances on its
 * diagonal and the mutual inductances off it, must be positive definite. Otherwise the coils would
 * return more energy than they received, and a run would grow without a message. For two coils this
 * means |M| < sqrt(L1*L2).
 *
 * Close couplings of several coils are given one by one, and until the last is given their matrix
 * has wrong zeros. So while two of the coils aren't coupled yet, only pairs are checked. The whole
 * matrix is checked when equations are made of it. */
#include "model/model_impl.h"

#include <math.h>
#include <string.h>

/* relative to a diagonal entry: less is rounding error, of a coupling without leakage */
#define LEAST 1e-12

/* of parts coupled with each other, directly or through others */
typedef struct CouplingCheck {
    State *state;
    const Instance *part; /* the part being checked; it may not be among the state's parts yet */
    LIST(const Instance *)
    members;
    int couplings;
    double *matrix; /* of that many members */
    bool is_known;
} CouplingCheck;

static int place_in(const CouplingCheck *c, const Instance *part)
{
    for (int i = 0; i < c->members.count; i++)
        if (c->members.at[i] == part)
            return i;
    return -1;
}

/* couplings of the state, and the part itself where it is a new coupling; NULL at the end */
static const Instance *coupling_at(const CouplingCheck *c, int i)
{
    const State *state = c->state;
    const bool is_new =
        c->part->number >= state->parts.count || state->parts.at[c->part->number] != c->part;

    if (i < state->couplings.count)
        return state->parts.at[state->couplings.at[i]];
    return i == state->couplings.count && is_new && c->part->row->couple != NULL ? c->part : NULL;
}

/* in order of making */
static void add_member(CouplingCheck *c, const Instance *part)
{
    int at = c->members.count;

    if (place_in(c, part) >= 0)
        return;
    LIST_PUSH(c->members, part);
    for (; at > 0 && c->members.at[at - 1]->number > part->number; at--)
        c->members.at[at] = c->members.at[at - 1];
    c->members.at[at] = part;
}

static void gather(CouplingCheck *c)
{
    const Instance *const *parts = (const Instance *const *)c->state->parts.at;
    const Instance *coupling;
    int before;

    if (c->part->row->couple == NULL)
        add_member(c, c->part);
    else
        add_member(c, parts[c->part->parts[0]]);
    do {
        before = c->members.count;
        c->couplings = 0;
        for (int i = 0; (coupling = coupling_at(c, i)) != NULL; i++) {
            if (place_in(c, parts[coupling->parts[0]]) < 0 &&
                place_in(c, parts[coupling->parts[1]]) < 0)
                continue;
            c->couplings++;
            for (int k = 0; k < 2; k++)
                add_member(c, parts[coupling->parts[k]]);
        }
    } while (c->members.count > before);
}

static double entry(CouplingCheck *c, const Instance *coupling, const Instance *const parts[2],
                    int row, int column)
{
    const Expr e = coupling->row->stores(coupling, c->state->arena, parts, row, column);

    if ((expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) != 0) {
        c->is_known = false;
        return 0;
    }
    return state_number(c->state, e);
}

static void fill(CouplingCheck *c)
{
    const int n = c->members.count;
    const Instance *coupling;

    c->matrix = NEW_ARRAY(double, n *n);
    c->is_known = true;
    for (int i = 0; (coupling = coupling_at(c, i)) != NULL; i++) {
        const Instance *parts[2];
        int at[2];

        for (int k = 0; k < 2; k++) {
            parts[k] = c->state->parts.at[coupling->parts[k]];
            at[k] = place_in(c, parts[k]);
        }
        if (at[0] < 0)
            continue;
        for (int k = 0; k < 2; k++) {
            c->matrix[at[k] * n + at[k]] = entry(c, coupling, parts, k, k);
            c->matrix[at[k] * n + at[1 - k]] += entry(c, coupling, parts, k, 1 - k);
        }
    }
}

static bool is_positive(const CouplingCheck *c)
{
    const int n = c->members.count;
    double *a = NEW_ARRAY(double, n *n);
    bool positive = true;

    memcpy(a, c->matrix, (size_t)(n * n) * sizeof(double));
    for (int k = 0; k < n; k++) {
        const double own = a[k * n + k];

        for (int i = k; i < n; i++)
            for (int j = 0; j < k; j++)
                a[i * n + k] -= a[i * n + j] * a[k * n + j] / a[j * n + j];
        positive = positive && a[k * n + k] > LEAST * own;
    }
    mem_free(a);
    return positive;
}

static Status refuse(const CouplingCheck *c, Diag *diag)
{
    const int n = c->members.count;
    Text names = {0};

    for (int i = 0; i < n; i++)
        text_addf(&names, "%s%s",
                  i == 0       ? ""
                  : i == n - 1 ? " and "
                               : ", ",
                  c->members.at[i]->name);
    if (n == 2 && c->couplings == 1) {
        (void)diag_set(diag, E_VALUE, "%s can't be coupled by M = %g H: sqrt(L1*L2) is %g H",
                       names.at, c->matrix[1], sqrt(c->matrix[0] * c->matrix[3]));
        diag_hint(diag, "M is less than that; perfect coupling, without leakage, is a transformer "
                        "with an inductor across");
    } else {
        (void)diag_set(diag, E_VALUE,
                       "%s can't be coupled like this: they would give back more energy than they "
                       "took",
                       names.at);
        diag_hint(diag, "the matrix of L and M has to be positive definite: take smaller k= or M= "
                        "in their couplings");
    }
    text_free(&names);
    return E_VALUE;
}

/* the first two parts whose couplings are not permitted; false: there are none */
static bool find_pair(const CouplingCheck *c, int pair[2])
{
    const int n = c->members.count;

    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++) {
            const double m = c->matrix[i * n + k], own = c->matrix[k * n + k];

            if (m != 0 &&
                !(own > 0 && c->matrix[i * n + i] - m * m / own > LEAST * c->matrix[i * n + i])) {
                pair[0] = k;
                pair[1] = i;
                return true;
            }
        }
    return false;
}

/* whether every two of them are coupled */
static bool is_complete(const CouplingCheck *c)
{
    const int n = c->members.count;

    for (int i = 0; i < n * n; i++)
        if (c->matrix[i] == 0)
            return false;
    return true;
}

/* checks the parts coupled with this part alone, which further couplings can't make valid */
static Status check_so_far(CouplingCheck *c, Text *remarks, Diag *diag)
{
    int pair[2];

    if (!c->is_known || is_positive(c))
        return OK;
    if (is_complete(c))
        return refuse(c, diag);
    if (find_pair(c, pair)) {
        const int n = c->members.count;
        const Instance *first = c->members.at[pair[0]], *second = c->members.at[pair[1]];
        const double m = c->matrix[pair[0] * n + pair[1]];
        CouplingCheck two = {.couplings = 1};
        double matrix[4] = {c->matrix[pair[0] * n + pair[0]], m, m,
                            c->matrix[pair[1] * n + pair[1]]};

        LIST_PUSH(two.members, first);
        LIST_PUSH(two.members, second);
        two.matrix = matrix;
        (void)refuse(&two, diag);
        LIST_FREE(two.members);
        return E_VALUE;
    }
    text_addf(remarks,
              "%s waits for couplings of its coils with the others: coupled as closely as "
              "two of these, the third is coupled with both\n",
              c->part->name);
    return OK;
}

Status coupled_check(State *state, const Instance *part, Text *remarks, Diag *diag)
{
    CouplingCheck c = {.state = state, .part = part};
    Status status = OK;

    gather(&c);
    if (c.couplings > 0) {
        fill(&c);
        status = check_so_far(&c, remarks, diag);
    }
    mem_free(c.matrix);
    LIST_FREE(c.members);
    return status;
}

Status couplings_check(State *state, Diag *diag)
{
    ArenaMark *mark = arena_mark(state->arena);
    Status status = OK;

    for (int i = 0; i < state->couplings.count && status == OK; i++) {
        CouplingCheck c = {.state = state, .part = state->parts.at[state->couplings.at[i]]};

        gather(&c);
        fill(&c);
        if (c.is_known && !is_positive(&c))
            status = refuse(&c, diag);
        mem_free(c.matrix);
        LIST_FREE(c.members);
    }
    arena_release(state->arena, mark);
    return status;
}

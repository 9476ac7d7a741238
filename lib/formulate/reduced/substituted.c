/* substituted.c: elimination from the leaves to the root, each speed by its row or by its mass
 *
 * By row k, u'_s = gamma - sum c_j u'_j eliminates both u'_s and lambda_k. For the other speeds
 * A_ij then loses c_i A_sj + A_si c_j - A_ss c_i c_j, and b_i loses c_i b_s. A row is used when no
 * other remaining row contains its speed. A speed in no remaining row is eliminated by its mass. So
 * a body that hangs on a joint is first moved to the joint's point, then its angle is eliminated.
 *
 * That point is an unknown of its own, h = sum c_j u'_j over the speeds of other bodies. It is
 * substituted when one of these is to be eliminated. Otherwise each of the parent's speeds would
 * move all beyond a joint before the angle is eliminated.
 *
 * The accelerations due to gamma come first, with all speeds that no row determines at 0: b is F
 * minus M times these, and all that follows is homogeneous. */
#include "formulate/reduced/substituted.h"

#include "base/memory.h"
#include "formulate/system/system_impl.h"

typedef struct SubstitutedShare { /* of an unknown */
    int unknown;
    Expr value;
} SubstitutedShare;

typedef struct Neighbour { /* an entry of A */
    int unknown;
    int at;
} Neighbour;

typedef struct SubstitutedUnknown {
    LIST(Neighbour) neighbours;
    LIST(SubstitutedShare) follows; /* how it follows from others: -sum value x */
    LIST(int) pools;                /* unknowns that are sums which contain it */
    /* constraint rows that contain it, by number among those in use */
    LIST(SubstitutedShare) rows;
    int row;  /* the row that determines it; -1: none */
    int last; /* time at which the last of its rows is used */
    bool is_gone;
    /* entry of A, and its value without the reductions by pivots, from squares alone: at least half
     * of that value */
    Expr own, whole;
    Expr inverse; /* NULL: it is substituted */
    Expr right, asked;
    /* its part due to gamma, and its part due to the symbols of multipliers */
    Expr given, given_step;
} SubstitutedUnknown;

typedef struct Taken { /* a row, in the order of use */
    int row, speed;
    Expr sign; /* its entry */
} Taken;

struct Substitution {
    System *system;
    Arena *arena;
    int nu, m, count; /* of speeds, rows, and unknowns so far */
    const int *rows;
    const MassEntries *mass;
    LIST(SubstitutedShare) * row; /* entries of each row */
    Taken *taken;
    SubstitutedUnknown *unknown; /* speeds, then pools */
    LIST(Expr) entries;
    LIST(int) order;
    bool is_counting; /* only counts products: values are 1 */
    int64_t products;
};

/* --- which row determines which speed, and when --- */

static bool is_unit(Expr e)
{
    return expr_is(e, 1) || expr_is(e, -1);
}

static void read_rows(Substitution *s)
{
    for (int k = 0; k < s->m; k++) {
        const Expr *row = system_run(s->system)->phi_u + (ptrdiff_t)s->rows[k] * s->nu;

        for (int j = 0; j < s->nu; j++)
            if (!expr_is_zero(row[j])) {
                LIST_PUSH(s->row[k], (SubstitutedShare){j, expr_name_temporary(s->arena, row[j])});
                LIST_PUSH(s->unknown[j].rows, (SubstitutedShare){k, row[j]});
            }
    }
}

/* a speed that the row determines, which no other remaining row contains; -1: none */
static int determined_speed(const Substitution *s, int k, const int *left)
{
    for (int i = 0; i < s->row[k].count; i++) {
        const SubstitutedShare *share = &s->row[k].at[i];

        if (left[share->unknown] == 1 && is_unit(share->value))
            return i;
    }
    return -1;
}

/* Assigns to each row a speed that it determines and that no other remaining row contains, row
 * after row. False where rows remain. */
static bool take_rows(Substitution *s)
{
    int *left = NEW_ARRAY(int, s->nu); /* rows of a speed */
    bool *is_taken = NEW_ARRAY(bool, s->m);
    LIST(int) next = {0};
    int count = 0;

    for (int j = 0; j < s->nu; j++)
        left[j] = s->unknown[j].rows.count;
    for (int k = 0; k < s->m; k++)
        LIST_PUSH(next, k);
    while (next.count > 0) {
        const int k = next.at[--next.count];
        const int i = is_taken[k] ? -1 : determined_speed(s, k, left);

        if (i < 0)
            continue;
        is_taken[k] = true;
        s->taken[count] = (Taken){k, s->row[k].at[i].unknown, s->row[k].at[i].value};
        s->unknown[s->taken[count].speed].row = k;
        for (int a = 0; a < s->row[k].count; a++) {
            SubstitutedUnknown *held = &s->unknown[s->row[k].at[a].unknown];

            held->last = count;
            left[s->row[k].at[a].unknown]--;
            for (int b = 0; b < held->rows.count && left[s->row[k].at[a].unknown] == 1; b++)
                if (!is_taken[held->rows.at[b].unknown])
                    LIST_PUSH(next, held->rows.at[b].unknown);
        }
        count++;
    }
    LIST_FREE(next);
    MEM_FREE(left, is_taken);
    return count == s->m;
}

/* --- arithmetic, or counting alone --- */

static Expr times(Substitution *s, Expr a, Expr b)
{
    if (!s->is_counting)
        return expr_mul(s->arena, a, b);
    if (expr_is_zero(a) || expr_is_zero(b))
        return expr_int(s->arena, 0);
    s->products += !is_unit(a) && !is_unit(b);
    return is_unit(a) && is_unit(b) ? a : expr_int(s->arena, 2);
}

static Expr less(Substitution *s, Expr a, Expr b)
{
    return s->is_counting && !expr_is_zero(b) ? expr_int(s->arena, 2) : expr_sub(s->arena, a, b);
}

static void hold(const Substitution *s, Expr *e)
{
    *e = expr_name_temporary(s->arena, *e);
}

/* --- the matrix --- */

static Expr *find_entry(Substitution *s, int i, int j)
{
    const SubstitutedUnknown *x = &s->unknown[i];

    for (int k = 0; k < x->neighbours.count; k++)
        if (x->neighbours.at[k].unknown == j)
            return &s->entries.at[x->neighbours.at[k].at];
    return NULL;
}

static Expr *new_entry(Substitution *s, int i, int j)
{
    LIST_PUSH(s->unknown[i].neighbours, (Neighbour){j, s->entries.count});
    LIST_PUSH(s->unknown[j].neighbours, (Neighbour){i, s->entries.count});
    LIST_PUSH(s->entries, expr_int(s->arena, 0));
    return &s->entries.at[s->entries.count - 1];
}

static void take_off(Substitution *s, int i, int j, Expr value)
{
    Expr *at;

    if (expr_is_zero(value))
        return;
    if (i == j) {
        at = &s->unknown[i].own;
    } else {
        at = find_entry(s, i, j);
        at = at != NULL ? at : new_entry(s, i, j);
    }
    *at = less(s, *at, value);
}

static void begin_matrix(Substitution *s)
{
    const Expr zero = expr_int(s->arena, 0);

    s->entries.count = s->order.count = 0;
    s->count = s->nu;
    for (int i = 0; i < s->nu + s->m; i++) {
        SubstitutedUnknown *x = &s->unknown[i];

        x->neighbours.count = x->follows.count = x->pools.count = 0;
        x->own = x->whole = x->right = x->asked = x->given = x->given_step = zero;
        x->inverse = NULL;
        x->is_gone = false;
    }
    for (int i = 0; i < s->mass->count; i++) {
        const Entry *entry = &s->mass->at[i];

        take_off(s, entry->row, entry->column, expr_neg(s->arena, entry->value));
    }
    for (int j = 0; j < s->nu; j++)
        s->unknown[j].whole = s->unknown[j].own;
}

/* the remaining unknowns with an entry of A in the row of this one */
static void list_neighbours(Substitution *s, SubstitutedUnknown *x, int **unknown, Expr **value,
                            int *count)
{
    *unknown = NEW_ARRAY(int, x->neighbours.count);
    *value = NEW_ARRAY(Expr, x->neighbours.count);
    *count = 0;
    for (int i = 0; i < x->neighbours.count; i++) {
        const Neighbour *n = &x->neighbours.at[i];

        if (s->unknown[n->unknown].is_gone || expr_is_zero(s->entries.at[n->at]))
            continue;
        hold(s, &s->entries.at[n->at]);
        (*unknown)[*count] = n->unknown;
        (*value)[(*count)++] = s->entries.at[n->at];
    }
}

static void leave(Substitution *s, int i)
{
    SubstitutedUnknown *x = &s->unknown[i];

    x->is_gone = true;
    LIST_PUSH(s->order, i);
    hold(s, &x->own);
    hold(s, &x->whole);
    hold(s, &x->right);
    hold(s, &x->asked);
}

/* index among those that x follows from; -1: it is none of them */
static int place_among(const SubstitutedUnknown *x, int unknown)
{
    for (int i = 0; i < x->follows.count; i++)
        if (x->follows.at[i].unknown == unknown)
            return i;
    return -1;
}

static Expr value_of_neighbour(const int *neighbours, const Expr *value, int count, int unknown)
{
    for (int i = 0; i < count; i++)
        if (neighbours[i] == unknown)
            return value[i];
    return NULL;
}

/* A of those that x follows from, and of its neighbours; value: entries in the row of x */
static void substitute_in_matrix(Substitution *s, SubstitutedUnknown *x, const int *neighbours,
                                 const Expr *value, int count)
{
    for (int i = 0; i < x->follows.count; i++) {
        const SubstitutedShare *c = &x->follows.at[i];
        const Expr a = value_of_neighbour(neighbours, value, count, c->unknown);
        const Expr own = a != NULL ? a : expr_int(s->arena, 0);
        const Expr rest = expr_name_temporary(s->arena, less(s, own, times(s, x->own, c->value)));
        const Expr twice = expr_name_temporary(s->arena, less(s, rest, expr_neg(s->arena, own)));

        for (int j = 0; j < count; j++)
            if (place_among(x, neighbours[j]) < i)
                take_off(s, c->unknown, neighbours[j], times(s, c->value, value[j]));
        for (int j = 0; j < i; j++)
            take_off(s, c->unknown, x->follows.at[j].unknown,
                     times(s, x->follows.at[j].value, rest));
        take_off(s, c->unknown, c->unknown, times(s, c->value, twice));
    }
}

/* substitutes x = -sum follows, where all of these remain */
static void substitute(Substitution *s, int which)
{
    SubstitutedUnknown *x = &s->unknown[which];
    int *neighbours, count;
    Expr *value;

    leave(s, which);
    list_neighbours(s, x, &neighbours, &value, &count);
    substitute_in_matrix(s, x, neighbours, value, count);
    for (int i = 0; i < x->follows.count; i++) {
        const SubstitutedShare *c = &x->follows.at[i];
        SubstitutedUnknown *onto = &s->unknown[c->unknown];

        onto->right = less(s, onto->right, times(s, c->value, x->right));
        onto->asked = less(s, onto->asked, times(s, c->value, x->asked));
        if (!s->is_counting)
            onto->whole = expr_add(s->arena, onto->whole,
                                   expr_mul(s->arena, expr_square(s->arena, c->value), x->whole));
    }
    MEM_FREE(neighbours, value);
}

/* eliminates the sums (pools) that contain a speed, which has to precede that of the speed */
static void substitute_pools(Substitution *s, int speed)
{
    for (int i = 0; i < s->unknown[speed].pools.count; i++)
        if (!s->unknown[s->unknown[speed].pools.at[i]].is_gone)
            substitute(s, s->unknown[speed].pools.at[i]);
}

static bool eliminate_by_mass(Substitution *s, int speed)
{
    SubstitutedUnknown *x = &s->unknown[speed];
    int *neighbours, count;
    Expr *value;

    substitute_pools(s, speed);
    leave(s, speed);
    if (expr_is_zero(x->own))
        return false;
    x->inverse =
        s->is_counting
            ? x->own
            : expr_name_temporary(s->arena, expr_div(s->arena, expr_int(s->arena, 1), x->own));
    list_neighbours(s, x, &neighbours, &value, &count);
    for (int i = 0; i < count; i++) {
        SubstitutedUnknown *onto = &s->unknown[neighbours[i]];
        const Expr part = expr_name_temporary(s->arena, times(s, value[i], x->inverse));

        LIST_PUSH(x->follows, (SubstitutedShare){neighbours[i], part});
        for (int j = i; j < count; j++)
            take_off(s, neighbours[i], neighbours[j], times(s, part, value[j]));
        onto->right = less(s, onto->right, times(s, part, x->right));
        onto->asked = less(s, onto->asked, times(s, part, x->asked));
    }
    MEM_FREE(neighbours, value);
    return true;
}

/* --- rows --- */

/* when an unknown is eliminated */
static int time_of(const Substitution *s, int speed)
{
    return s->unknown[speed].last;
}

static Expr share_of_row(const Substitution *s, const Taken *taken, const SubstitutedShare *share)
{
    return expr_is(taken->sign, 1) ? share->value : expr_neg(s->arena, share->value);
}

/* replaces the speeds of other bodies in a row by one unknown: those that aren't eliminated
 * first */
static void pool(Substitution *s, const Taken *taken, int first)
{
    const int number = s->count++;
    SubstitutedUnknown *sum = &s->unknown[number];

    for (int i = 0; i < s->row[taken->row].count; i++) {
        const SubstitutedShare *share = &s->row[taken->row].at[i];

        if (share->unknown == taken->speed || time_of(s, share->unknown) == first)
            continue;
        LIST_PUSH(
            sum->follows,
            (SubstitutedShare){share->unknown, expr_neg(s->arena, share_of_row(s, taken, share))});
        LIST_PUSH(s->unknown[share->unknown].pools, number);
    }
    LIST_PUSH(s->unknown[taken->speed].follows, (SubstitutedShare){number, expr_int(s->arena, 1)});
}

static void take_row(Substitution *s, const Taken *taken)
{
    SubstitutedUnknown *x = &s->unknown[taken->speed];
    int first = s->m, later = 0, others = s->row[taken->row].count - 1;

    substitute_pools(s, taken->speed);
    for (int i = 0; i < s->row[taken->row].count; i++) {
        const int held = s->row[taken->row].at[i].unknown;

        if (held == taken->speed)
            continue;
        later = time_of(s, held) < first ? 1 : later + (time_of(s, held) == first);
        first = time_of(s, held) < first ? time_of(s, held) : first;
    }
    later = others - later;
    for (int i = 0; i < s->row[taken->row].count; i++) {
        const SubstitutedShare *share = &s->row[taken->row].at[i];

        if (share->unknown != taken->speed && (later < 2 || time_of(s, share->unknown) == first))
            LIST_PUSH(x->follows,
                      (SubstitutedShare){share->unknown, share_of_row(s, taken, share)});
    }
    if (later >= 2)
        pool(s, taken, first);
    substitute(s, taken->speed);
}

/* Eliminates speeds that no row determines and no remaining row contains. */
static bool eliminate_freed(Substitution *s, int time)
{
    for (int i = 0; i < (time < 0 ? s->nu : s->row[s->taken[time].row].count); i++) {
        const int j = time < 0 ? i : s->row[s->taken[time].row].at[i].unknown;

        if (s->unknown[j].row < 0 && s->unknown[j].last == time && !eliminate_by_mass(s, j))
            return false;
    }
    return true;
}

static bool eliminate(Substitution *s)
{
    if (!eliminate_freed(s, -1))
        return false;
    for (int i = 0; i < s->m; i++) {
        take_row(s, &s->taken[i]);
        if (!eliminate_freed(s, i) || arena_status(s->arena) != OK)
            return false;
    }
    return true;
}

/* --- given parts, and the result --- */

/* the given part of a speed that a row determines; that of the others is known */
static void give(Substitution *s, const Taken *taken, const Expr *gamma)
{
    SubstitutedUnknown *x = &s->unknown[taken->speed];
    Expr now = gamma[s->rows[taken->row]], step = system_multiplier(s->system, s->rows[taken->row]);

    if (!expr_is(taken->sign, 1)) {
        now = expr_neg(s->arena, now);
        step = expr_neg(s->arena, step);
    }
    for (int i = 0; i < s->row[taken->row].count; i++) {
        const SubstitutedShare *share = &s->row[taken->row].at[i];
        const SubstitutedUnknown *other = &s->unknown[share->unknown];
        const Expr c = share_of_row(s, taken, share);

        if (share->unknown == taken->speed || other->row < 0)
            continue;
        now = expr_sub(s->arena, now, expr_mul(s->arena, c, other->given));
        step = expr_sub(s->arena, step, expr_mul(s->arena, c, other->given_step));
    }
    x->given = expr_name_temporary(s->arena, now);
    x->given_step = expr_name_temporary(s->arena, step);
}

static void take_off_given(Substitution *s, int i, int j, Expr mass)
{
    SubstitutedUnknown *x = &s->unknown[i];
    const SubstitutedUnknown *other = &s->unknown[j];

    x->right = expr_sub(s->arena, x->right, expr_mul(s->arena, mass, other->given));
    x->asked = expr_sub(s->arena, x->asked, expr_mul(s->arena, mass, other->given_step));
}

static void begin_right(Substitution *s, const Expr *force, const Expr *gamma)
{
    for (int i = s->m - 1; i >= 0; i--)
        give(s, &s->taken[i], gamma);
    for (int j = 0; j < s->nu; j++)
        s->unknown[j].right = force[j];
    for (int i = 0; i < s->mass->count; i++) {
        const Entry *entry = &s->mass->at[i];

        take_off_given(s, entry->row, entry->column, entry->value);
        if (entry->row != entry->column)
            take_off_given(s, entry->column, entry->row, entry->value);
    }
}

static void substitute_back(Substitution *s)
{
    for (int i = s->order.count - 1; i >= 0; i--) {
        SubstitutedUnknown *x = &s->unknown[s->order.at[i]];
        const Expr zero = expr_int(s->arena, 0);

        x->right = x->inverse != NULL ? expr_mul(s->arena, x->right, x->inverse) : zero;
        x->asked = x->inverse != NULL ? expr_mul(s->arena, x->asked, x->inverse) : zero;
        for (int k = 0; k < x->follows.count; k++) {
            const SubstitutedShare *c = &x->follows.at[k];
            const SubstitutedUnknown *other = &s->unknown[c->unknown];

            x->right = expr_sub(s->arena, x->right, expr_mul(s->arena, c->value, other->right));
            x->asked = expr_sub(s->arena, x->asked, expr_mul(s->arena, c->value, other->asked));
        }
        hold(s, &x->right);
        hold(s, &x->asked);
    }
}

/* the load on the speed that a row determines, once the rows before it are known */
static Expr set_one_multiplier(const Substitution *s, const Taken *taken, const Expr *forces,
                               const Expr *multiplier)
{
    const SubstitutedUnknown *x = &s->unknown[taken->speed];
    Expr sum = forces[taken->speed];

    for (int i = 0; i < x->rows.count; i++)
        if (x->rows.at[i].unknown != taken->row)
            sum = expr_sub(
                s->arena, sum,
                expr_mul(s->arena, x->rows.at[i].value, multiplier[x->rows.at[i].unknown]));
    return expr_name_temporary(s->arena, expr_mul(s->arena, taken->sign, sum));
}

/* F - M u' must be the load of the multipliers */
static void set_all_multipliers(Substitution *s, const Expr *force, const Constrained *out)
{
    Expr *rest = NEW_ARRAY(Expr, s->nu);

    for (int j = 0; j < s->nu; j++)
        rest[j] = force[j];
    for (int i = 0; i < s->mass->count; i++) {
        const Entry *e = &s->mass->at[i];

        rest[e->row] = expr_sub(s->arena, rest[e->row],
                                expr_mul(s->arena, e->value, out->acceleration[e->column]));
        if (e->row != e->column)
            rest[e->column] = expr_sub(s->arena, rest[e->column],
                                       expr_mul(s->arena, e->value, out->acceleration[e->row]));
    }
    for (int i = 0; i < s->m; i++)
        out->multiplier[s->taken[i].row] =
            set_one_multiplier(s, &s->taken[i], rest, out->multiplier);
    mem_free(rest);
}

bool substitution_solve(Substitution *s, const Expr *force, const Expr *gamma,
                        const Constrained *out)
{
    begin_matrix(s);
    begin_right(s, force, gamma);
    if (!eliminate(s))
        return false;
    substitute_back(s);
    for (int j = 0; j < s->nu; j++) {
        const SubstitutedUnknown *x = &s->unknown[j];

        out->acceleration[j] =
            expr_name_temporary(s->arena, expr_add(s->arena, x->right, x->given));
        out->step[j] = expr_name_temporary(s->arena, expr_add(s->arena, x->asked, x->given_step));
        out->excess[j] =
            x->inverse != NULL ? expr_mul(s->arena, x->whole, x->inverse) : expr_int(s->arena, 1);
    }
    set_all_multipliers(s, force, out);
    return arena_status(s->arena) == OK;
}

int64_t substitution_products(const Substitution *s)
{
    return s->products;
}

Substitution *substitution_new(System *system, const MassEntries *mass, const int *rows,
                               int row_count)
{
    const int nu = system_nu(system);
    Substitution *s = NEW(Substitution);

    *s = (Substitution){.system = system,
                        .arena = system_arena(system),
                        .nu = nu,
                        .m = row_count,
                        .rows = rows,
                        .mass = mass};
    s->row = mem_array((size_t)row_count, sizeof *s->row);
    s->taken = NEW_ARRAY(Taken, row_count);
    s->unknown = NEW_ARRAY(SubstitutedUnknown, nu + row_count);
    for (int i = 0; i < nu; i++)
        s->unknown[i].row = s->unknown[i].last = -1;
    read_rows(s);
    if (take_rows(s)) {
        s->is_counting = true;
        begin_matrix(s);
        if (eliminate(s)) {
            s->is_counting = false;
            return s;
        }
    }
    substitution_free(s);
    return NULL;
}

void substitution_free(Substitution *s)
{
    if (s == NULL)
        return;
    for (int k = 0; k < s->m; k++)
        LIST_FREE(s->row[k]);
    for (int i = 0; i < s->nu + s->m; i++) {
        LIST_FREE(s->unknown[i].neighbours);
        LIST_FREE(s->unknown[i].follows);
        LIST_FREE(s->unknown[i].pools);
        LIST_FREE(s->unknown[i].rows);
    }
    LIST_FREE(s->entries);
    LIST_FREE(s->order);
    MEM_FREE(s->row, s->taken, s->unknown, s);
}

/* constrained.c: L D L^T of [M G^T; G 0] in symbols, speeds before multipliers
 *
 * This order needs no row exchange: as long as the rows are independent, all pivots of M are
 * positive and those that follow are negative. Speeds of many rows, as a platform's, are eliminated
 * after the rows where that is cheaper and other speeds determine all of these rows
 * (algebra/kkt_border.h): then each leg is eliminated by itself.
 *
 * In each class the order is chosen from the pattern for low fill-in (algebra/ldl.h), and its cost
 * is counted before anything is written. A multiplier's pivot d is what earlier multipliers leave
 * of p, its entry of G M^-1 G^T: d / p measures the distance to a singular configuration
 * (algebra/kkt.h). */
#include "formulate/reduced/constrained.h"

#include "algebra/kkt_border.h"
#include "algebra/ldl.h"
#include "algebra/pattern.h"
#include "base/memory.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/operation_cost.h"
#include "formulate/reduced/substituted.h"
#include "formulate/system/system_impl.h"

#include <math.h>

enum {
    MOST_PAIRS = 20000,    /* of speeds with an entry of M */
    MOST_PRODUCTS = 60000, /* of the elimination, */
    /* and of the whole result: 150000 take half the time of numeric factors */
    MOST_OPERATIONS = 250000
};

/* A value and the parts still to be added to it, which are summed at once when it is read. A sum
 * that grows part by part would be formed anew with each. */
typedef struct Sum {
    Expr value;
    int parts; /* the last of them in `parts`, plus 1 */
} Sum;

typedef struct ConstrainedPart {
    Expr value;
    int before; /* the part before, of the same sum, plus 1 */
} ConstrainedPart;

typedef struct ConstrainedTerm {
    int column;
    Sum value; /* of the matrix, then of L^T */
} ConstrainedTerm;

typedef struct ConstrainedRow { /* row of an unknown, in the order of elimination */
    LIST(ConstrainedTerm) beyond;
    Sum own;
    Expr inverse;
    /* of a speed eliminated after the rows: its entry of M, plus what rows before it add */
    Expr stiff;
    Sum right, asked; /* right sides: F and gamma, and s; then the solutions */
} ConstrainedRow;

typedef struct ConstrainedElimination {
    System *system;
    Arena *arena;
    int nu, m, size;
    const int *rows; /* constraint rows in use */
    MassEntries entries;
    int *class;          /* of an unknown (KktClass) */
    int *place_of;       /* index of an unknown, by classes */
    int owns;            /* speeds that are eliminated before the rows */
    ConstrainedRow *row; /* by place */
    LIST(ConstrainedPart) parts;
    LIST(Expr) terms; /* of the sum being formed */
} ConstrainedElimination;

/* --- the matrix --- */

/* false: there are too many */
static bool list_mass(ConstrainedElimination *e)
{
    const CompositeMass *composite = system_composite_mass(e->system);
    const Expr *mass = system_run(e->system)->mass;

    if (mass == NULL) {
        if (composite == NULL || composite_mass_pairs(composite) > MOST_PAIRS)
            return false;
        composite_mass_entries(e->system, &e->entries);
        return true;
    }
    for (int i = 0; i < e->nu; i++)
        for (int j = i; j < e->nu; j++)
            if (!expr_is_zero(mass[i * e->nu + j]))
                LIST_PUSH(e->entries, (Entry){i, j, mass[i * e->nu + j]});
    return e->entries.count <= MOST_PAIRS;
}

static void list_constraints(ConstrainedElimination *e)
{
    for (int k = 0; k < e->m; k++) {
        const Expr *row = system_run(e->system)->phi_u + (ptrdiff_t)e->rows[k] * e->nu;

        for (int j = 0; j < e->nu; j++)
            if (!expr_is_zero(row[j]))
                LIST_PUSH(e->entries, (Entry){j, e->nu + k, expr_name_temporary(e->arena, row[j])});
    }
}

/* its entry in the stored half, 0 at first */
static Sum *entry_at(ConstrainedElimination *e, int a, int b)
{
    ConstrainedRow *row = &e->row[a < b ? a : b];
    const int column = a < b ? b : a;

    if (a == b)
        return &row->own;
    for (int i = 0; i < row->beyond.count; i++)
        if (row->beyond.at[i].column == column)
            return &row->beyond.at[i].value;
    LIST_PUSH(row->beyond, (ConstrainedTerm){column, {expr_int(e->arena, 0), 0}});
    return &row->beyond.at[row->beyond.count - 1].value;
}

/* Adds the entries by index, each once, and their values. */
static void place_entries(ConstrainedElimination *e)
{
    for (int i = 0; i < e->size; i++)
        e->row[i].own = e->row[i].right = e->row[i].asked = (Sum){expr_int(e->arena, 0), 0};
    for (int i = 0; i < e->entries.count; i++) {
        const Entry *entry = &e->entries.at[i];
        Sum *at = entry_at(e, e->place_of[entry->row], e->place_of[entry->column]);

        at->value = expr_add(e->arena, at->value, entry->value);
    }
}

/* Classifies speeds and rows for the order of elimination. A border, speeds that are eliminated
 * after all rows, is used where it pays and where every row still has a speed of its own before it;
 * otherwise all speeds precede the rows. */
static void find_classes(ConstrainedElimination *e, const KktPlaces *places)
{
    bool *late = NEW_ARRAY(bool, e->m);
    bool waits = true;

    kkt_classes(places, kkt_border(places), late, e->class);
    for (int k = 0; k < e->m; k++)
        waits = waits && e->class[e->nu + k] == CLASS_EARLY;
    if (!waits)
        kkt_classes(places, NO_BORDER, late, e->class);
    for (int i = 0; i < e->nu; i++)
        e->owns += e->class[i] == CLASS_OWN;
    mem_free(late);
}

/* products that the elimination needs in the order that is found */
static int64_t find_order(ConstrainedElimination *e)
{
    const int count = e->entries.count;
    int *row = NEW_ARRAY(int, 3 * count), *column = row + count, *place = column + count;
    KktPlaces places = {.nu = e->nu, .m = e->m};
    Pattern once;
    LdlOrder *order;
    int64_t products;

    for (int i = 0; i < count; i++) {
        const Entry *entry = &e->entries.at[i];

        row[i] = entry->row < entry->column ? entry->row : entry->column;
        column[i] = entry->row < entry->column ? entry->column : entry->row;
    }
    once = pattern_of(e->size, e->size, count, row, column, place);
    places.entries = once.count;
    places.mass_entries = once.start[e->nu];
    places.row = once.row;
    places.column = once.column;
    find_classes(e, &places);
    order = ldl_order_new(e->size, e->class, once.count, once.row, once.column, place, e->place_of);
    products = ldl_order_products(order);
    ldl_order_free(order);
    pattern_free(&once);
    mem_free(row);
    return products;
}

/* --- elimination --- */

static void add_product(ConstrainedElimination *e, Sum *to, Expr factor, Expr value)
{
    if (expr_is_zero(value))
        return;
    LIST_PUSH(e->parts, (ConstrainedPart){expr_mul(e->arena, factor, value), to->parts});
    to->parts = e->parts.count;
}

static Expr sum_of(ConstrainedElimination *e, Sum *sum)
{
    if (sum->parts == 0)
        return sum->value;
    e->terms.count = 0;
    LIST_PUSH(e->terms, sum->value);
    for (int i = sum->parts; i > 0; i = e->parts.at[i - 1].before)
        LIST_PUSH(e->terms, e->parts.at[i - 1].value);
    sum->parts = 0;
    return sum->value = expr_sum(e->arena, e->terms.at, e->terms.count);
}

static Expr hold_sum(ConstrainedElimination *e, Sum *sum)
{
    return sum->value = expr_name_temporary(e->arena, sum_of(e, sum));
}

/* false: there is no pivot */
static bool eliminate_row(ConstrainedElimination *e, int k)
{
    ConstrainedRow *row = &e->row[k];
    const int count = row->beyond.count;
    const Expr own = hold_sum(e, &row->own), right = hold_sum(e, &row->right),
               asked = hold_sum(e, &row->asked);

    if (expr_is_zero(own))
        return false;
    row->inverse = expr_name_temporary(e->arena, expr_div(e->arena, expr_int(e->arena, 1), own));
    for (int i = 0; i < count; i++)
        (void)hold_sum(e, &row->beyond.at[i].value);
    for (int i = 0; i < count; i++) {
        const int column = row->beyond.at[i].column;
        const Expr value = row->beyond.at[i].value.value;
        const Expr part = expr_name_temporary(e->arena, expr_mul(e->arena, value, row->inverse));
        const Expr off = expr_neg(e->arena, part);

        for (int j = i; j < count; j++)
            add_product(e, entry_at(e, column, row->beyond.at[j].column), off,
                        row->beyond.at[j].value.value);
        add_product(e, &e->row[column].right, off, right);
        add_product(e, &e->row[column].asked, off, asked);
        row->beyond.at[i].value.value = part;
    }
    return true;
}

/* the entry of M of a speed */
static Expr own_mass(const ConstrainedElimination *e, const MassEntries *entries, int speed)
{
    Expr sum = expr_int(e->arena, 0);

    for (int i = 0; i < entries->count; i++)
        if (entries->at[i].row == speed && entries->at[i].column == speed)
            sum = expr_add(e->arena, sum, entries->at[i].value);
    return expr_name_temporary(e->arena, sum);
}

/* What masses, eliminated before, leave of the rows. The speeds eliminated after the rows have
 * measures of their own. */
static bool set_taken(ConstrainedElimination *e, const Constrained *out)
{
    Expr *mass = NEW_ARRAY(Expr, e->nu);
    bool has_mass = true;

    for (int j = 0; j < e->nu; j++)
        if (e->class[j] == CLASS_BORDER) {
            ConstrainedRow *row = &e->row[e->place_of[j]];

            mass[j] = own_mass(e, &e->entries, j);
            has_mass = has_mass && !expr_is_zero(mass[j]);
            row->stiff = expr_sub(e->arena, mass[j], sum_of(e, &row->own));
        }
    for (int k = 0; k < e->m; k++) {
        ConstrainedRow *row = &e->row[e->place_of[e->nu + k]];

        out->taken[k] = expr_neg(e->arena, sum_of(e, &row->own));
    }
    for (int i = 0; i < e->entries.count && has_mass; i++) {
        const Entry *entry = &e->entries.at[i];
        const int k = entry->column - e->nu;

        if (k < 0 || e->class[entry->row] != CLASS_BORDER)
            continue;
        out->taken[k] = expr_add(
            e->arena, out->taken[k],
            expr_div(e->arena, expr_mul(e->arena, entry->value, entry->value), mass[entry->row]));
    }
    for (int k = 0; k < e->m; k++)
        out->taken[k] = expr_name_temporary(e->arena, out->taken[k]);
    mem_free(mass);
    return has_mass;
}

/* Completes the diagonal entries of the speeds that are eliminated after the rows: before that they
 * lack what the elimination of rows adds. */
static void set_stiff(ConstrainedElimination *e)
{
    for (int i = e->owns + e->m; i < e->size; i++)
        e->row[i].stiff = expr_name_temporary(
            e->arena, expr_add(e->arena, e->row[i].stiff, sum_of(e, &e->row[i].own)));
}

static bool eliminate(ConstrainedElimination *e, const Constrained *out)
{
    for (int i = 0; i < e->size; i++) {
        if (i == e->owns && !set_taken(e, out))
            return false;
        if (i == e->owns + e->m)
            set_stiff(e);
        if (!eliminate_row(e, i) || arena_status(e->arena) != OK)
            return false;
    }
    return true;
}

static void substitute_back(ConstrainedElimination *e)
{
    for (int i = e->size - 1; i >= 0; i--) {
        ConstrainedRow *row = &e->row[i];

        row->right.value = expr_mul(e->arena, row->right.value, row->inverse);
        row->asked.value = expr_mul(e->arena, row->asked.value, row->inverse);
        for (int k = 0; k < row->beyond.count; k++) {
            const ConstrainedTerm *term = &row->beyond.at[k];
            const ConstrainedRow *later = &e->row[term->column];
            const Expr off = expr_neg(e->arena, term->value.value);

            add_product(e, &row->right, off, later->right.value);
            add_product(e, &row->asked, off, later->asked.value);
        }
        (void)hold_sum(e, &row->right);
        (void)hold_sum(e, &row->asked);
    }
}

static void set_status(const ConstrainedElimination *e, const MassEntries *entries,
                       const Constrained *out)
{
    for (int j = 0; j < e->nu; j++) {
        const ConstrainedRow *row = &e->row[e->place_of[j]];

        out->acceleration[j] = row->right.value;
        out->step[j] = row->asked.value;
        out->excess[j] = expr_int(e->arena, 0);
    }
    for (int i = 0; i < entries->count; i++) {
        const Entry *entry = &entries->at[i];

        if (entry->row == entry->column)
            out->excess[entry->row] = expr_add(e->arena, out->excess[entry->row], entry->value);
    }
    for (int j = 0; j < e->nu; j++)
        out->excess[j] = expr_mul(e->arena, out->excess[j], e->row[e->place_of[j]].inverse);
    for (int k = 0; k < e->m; k++) {
        const ConstrainedRow *row = &e->row[e->place_of[e->nu + k]];

        out->multiplier[k] = row->right.value;
        out->pivot[k] = expr_name_temporary(e->arena, expr_neg(e->arena, row->own.value));
    }
    for (int i = 0; i < out->left_count; i++) {
        const ConstrainedRow *row = &e->row[e->owns + e->m + i];

        out->left[i] = expr_div(e->arena, row->own.value, row->stiff);
    }
}

static Constrained *arrays_new(int nu, int m, int looked_at, int waiting)
{
    Constrained *out = NEW(Constrained);

    out->places = constrained_places(nu, m, looked_at, waiting);
    out->acceleration = NEW_ARRAY(Expr, out->places.count);
    out->multiplier = out->acceleration + out->places.multiplier;
    out->excess = out->acceleration + out->places.excess;
    out->pivot = out->acceleration + out->places.pivot;
    out->taken = out->acceleration + out->places.taken;
    out->left = out->acceleration + out->places.left;
    out->looked_at = looked_at;
    out->left_count = waiting;
    out->step = out->acceleration + out->places.step;
    return out;
}

static bool is_worth_it(const ConstrainedElimination *e, const Constrained *out)
{
    return arena_status(e->arena) == OK &&
           operation_cost(out->acceleration, out->places.count) <= MOST_OPERATIONS;
}

/* NULL: it is impossible, or not worth it */
static Constrained *solve(ConstrainedElimination *e, const Expr *force, const Expr *gamma)
{
    Constrained *out = arrays_new(e->nu, e->m, e->m, e->nu - e->owns);

    place_entries(e);
    for (int j = 0; j < e->nu; j++)
        e->row[e->place_of[j]].right.value = force[j];
    for (int k = 0; k < e->m; k++) {
        ConstrainedRow *row = &e->row[e->place_of[e->nu + k]];

        row->right.value = gamma[e->rows[k]];
        row->asked.value = system_multiplier(e->system, e->rows[k]);
    }
    if (eliminate(e, out)) {
        substitute_back(e);
        set_status(e, &e->entries, out);
        if (is_worth_it(e, out))
            return out;
    }
    constrained_free(out);
    return NULL;
}

/* The same by rows that determine speeds; NULL: they don't, or it needs more than `most`
 * products. */
static Constrained *solve_substituting(ConstrainedElimination *e, const Expr *force,
                                       const Expr *gamma, double most)
{
    Substitution *s = substitution_new(e->system, &e->entries, e->rows, e->m);
    Constrained *out = NULL;

    if (s != NULL && (double)substitution_products(s) <= most) {
        out = arrays_new(e->nu, e->m, 0, 0);
        if (!substitution_solve(s, force, gamma, out) || !is_worth_it(e, out)) {
            constrained_free(out);
            out = NULL;
        }
    }
    substitution_free(s);
    return out;
}

Constrained *constrained_new(System *system, const int *rows, int row_count, const Expr *force,
                             const Expr *gamma, double most)
{
    const int nu = system_nu(system);
    ConstrainedElimination e = {.system = system,
                                .arena = system->arena,
                                .nu = nu,
                                .m = row_count,
                                .size = nu + row_count,
                                .rows = rows};
    Constrained *out = NULL;

    system_touch(system);
    e.class = NEW_ARRAY(int, e.size);
    e.place_of = NEW_ARRAY(int, e.size);
    e.row = NEW_ARRAY(ConstrainedRow, e.size);
    if (list_mass(&e)) {
        const int mass_count = e.entries.count;
        double products;

        list_constraints(&e);
        products = (double)find_order(&e);
        e.entries.count = mass_count;
        out = solve_substituting(&e, force, gamma, fmin(MOST_PRODUCTS, fmin(most, products)));
        if (out == NULL && arena_status(e.arena) == OK && products <= fmin(MOST_PRODUCTS, most)) {
            list_constraints(&e);
            out = solve(&e, force, gamma);
        }
    }
    if (out == NULL)
        /* discards what was too large or was stopped; the caller continues without it */
        arena_reset(e.arena);
    for (int i = 0; i < e.size; i++)
        LIST_FREE(e.row[i].beyond);
    LIST_FREE(e.entries);
    LIST_FREE(e.parts);
    LIST_FREE(e.terms);
    MEM_FREE(e.class, e.place_of, e.row);
    return out;
}

void constrained_free(Constrained *constrained)
{
    if (constrained == NULL)
        return;
    MEM_FREE(constrained->acceleration, constrained);
}

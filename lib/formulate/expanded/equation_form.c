/* equation_form.c: which equation form a program is made from, and what a program costs
 *
 * A small system in expanded form often needs fewer operations, once common subexpressions are
 * shared, than the recursive definitions that serve a system of any size. Where expanding is cheap,
 * both forms are tried, and M multiplied out as well. The run uses the cheapest. */
#include "formulate/expanded/equation_form.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/expanded/block_entry.h"
#include "formulate/expanded/expanded.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <string.h>

enum {
    MOST_SPEEDS = 7,       /* above, definitions are cheaper and expanding takes long */
    MOST_OPERATIONS = 800, /* of the definitions: spatial chains of three become too long */
    FUNCTION_PRICE = 20    /* a sine costs about as much as twenty additions in a run */
};

static const Block blocks[] = {BLOCK_MASS, BLOCK_FORCES, BLOCK_CONSTRAINTS, BLOCK_JACOBIAN,
                               BLOCK_ACCELERATION};

/* operation count, with weighted functions */
static int64_t cost(const Expr *roots, int count)
{
    OpCount ops = expr_count_shared(roots, count);

    return ops.add + ops.mul + FUNCTION_PRICE * ops.fun;
}

static Expr **block_of(EquationForm *reading, Block block)
{
    switch (block) {
    case BLOCK_MASS:
        return &reading->mass;
    case BLOCK_FORCES:
        return &reading->force;
    case BLOCK_CONSTRAINTS:
        return &reading->phi;
    case BLOCK_JACOBIAN:
        return &reading->phi_u;
    default:
        return &reading->gamma;
    }
}

static int block_entries(const System *system, Block block)
{
    int rows;
    int columns;

    system_block_size(system, block, &rows, &columns);
    return rows * columns;
}

/* the entries of all blocks as shown, block after block */
static Status write_out(System *system, Expr *out, Diag *diag)
{
    for (int b = 0; b < COUNT(blocks); b++) {
        int rows;
        int columns;

        system_block_size(system, blocks[b], &rows, &columns);
        for (int i = 0; i < rows * columns; i++, out++) {
            TRY(show_entry(system, blocks[b], i / columns, i % columns, out, diag));
            if (blocks[b] == BLOCK_CONSTRAINTS &&
                system->constraints->rows.at[i].reported.is_rate) /* it is that of a velocity row */
                *out = expr_int(system->arena, 0);
        }
    }
    return OK;
}

/* M with its products multiplied out: entries share terms that common factors would hide */
static void open_mass(System *system, Expr *mass)
{
    enum { MOST_TERMS = 200 };
    int n = system->kinematics->u.count;
    bool ignored;

    for (int i = 0; i < n; i++)
        for (int j = i; j < n; j++) {
            Expr e = expr_expand_over(system->arena, mass[i * n + j], ~(1U << SYMBOL_PARAMETER),
                                      MOST_TERMS, &ignored);

            mass[i * n + j] = mass[j * n + i] = expr_fold(system->arena, e);
        }
}

/* Shares common subexpressions in the entries of all blocks. Stores the entries in `best` where
 * they are the cheapest so far. */
static void offer(System *system, Expr *entries, int count, Expr *best, int64_t *least)
{
    int counts[COUNT(blocks)];
    int64_t price;

    for (int b = 0; b < COUNT(blocks); b++)
        counts[b] = block_entries(system, blocks[b]);
    expr_part_angles(system->arena, entries, counts, COUNT(blocks));
    expr_share(system->arena, entries, count);
    price = cost(entries, count);
    if (price >= *least)
        return;
    *least = price;
    memcpy(best, entries, (size_t)count * sizeof(Expr));
}

Status equation_form_choose(System *system, Diag *diag)
{
    int count = 0;
    int filled = 0;
    int64_t least = INT64_MAX;
    Expr *entries = NULL;
    Expr *shown = NULL;
    Expr *best;
    Status status = OK;

    system->definitions = system->run;
    system->dynamics->writes_out = expanded_fits(system);
    if (system->kinematics->u.count > MOST_SPEEDS || system->kinematics->u.count == 0 ||
        system->run.mass == NULL || !system->dynamics->writes_out)
        return OK;
    for (int b = 0; b < COUNT(blocks); b++)
        count += block_entries(system, blocks[b]);
    entries = NEW_ARRAY(Expr, count);
    shown = NEW_ARRAY(Expr, count);
    for (int b = 0; b < COUNT(blocks); b++)
        for (int i = 0; i < block_entries(system, blocks[b]); i++)
            entries[filled++] = (*block_of(&system->run, blocks[b]))[i];
    if (cost(entries, count) > MOST_OPERATIONS)
        goto done;
    CHECK(write_out(system, shown, diag));
    best = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    offer(system, entries, count, best, &least);
    memcpy(entries, shown, (size_t)count * sizeof(Expr));
    offer(system, entries, count, best, &least);
    open_mass(system, shown); /* the first block */
    offer(system, shown, count, best, &least);
    for (int b = 0; b < COUNT(blocks); b++) {
        *block_of(&system->run, blocks[b]) = best;
        best += block_entries(system, blocks[b]);
    }
done:
    MEM_FREE(entries, shown);
    return status;
}

/* --- operation cost of a program --- */

typedef LIST(Expr) EquationFormRoots;

static void gather(EquationFormRoots *out, const Expr *entries, int more)
{
    for (int i = 0; i < more; i++)
        LIST_PUSH(*out, entries[i]);
}

static void gather_mass(const System *system, EquationFormRoots *out)
{
    const CompositeMass *mass = system->dynamics->composite_mass;
    const int nu = system->kinematics->u.count;

    if (mass == NULL) {
        gather(out, system->run.mass, nu * nu);
        return;
    }
    gather(out, mass->needs.at, mass->needs.count);
    for (int i = 0; i < system->dynamics->shares.count; i++)
        gather(out, &system->dynamics->shares.at[i].value, 1);
}

static Status program_count(const System *system, const CallMonitor *watch, OpCount *out)
{
    const EquationForm *run = &system->run;
    const CompositeMass *mass = system->dynamics->composite_mass;
    int nu = system->kinematics->u.count;
    int m = system->constraints->rows.count;
    int w = system->network->x.count + system->network->z.count;
    EquationFormRoots roots = {0};
    Status status;

    gather_mass(system, &roots);
    gather(&roots, run->force, nu);
    gather(&roots, run->phi_u, m * nu);
    for (int k = 0; k < m; k++) /* whole turns are added once */
        LIST_PUSH(roots, system->constraints->rows.at[k].kind == ROW_ANGLE
                             ? system_plain(system, run->phi[k])
                             : run->phi[k]);
    gather(&roots, run->nu, m);
    gather(&roots, run->gamma, m);
    for (int i = 0; i < run->network_entries; i++)
        LIST_PUSH(roots, run->network[i].value);
    gather(&roots, run->network_rhs, w);
    status = expr_count_watched(roots.at, roots.count, watch, out);
    LIST_FREE(roots);
    if (status == OK && mass != NULL)
        *out = op_count_plus(*out, composite_mass_passing(mass));
    return status;
}

Status system_price(const System *system, const CallMonitor *watch, OpCount *count, double *price)
{
    const double unknowns = (double)(system->kinematics->u.count + system->constraints->rows.count);
    OpCount ops;

    TRY(program_count(system, watch, &ops));

    /* Gauss elimination: as many additions as multiplications, in factoring and in substituting */
    *price = (double)(ops.add + ops.mul + FUNCTION_PRICE * ops.fun) +
             2 * unknowns * unknowns * (unknowns / 3 + 1);
    *count = ops;
    return OK;
}

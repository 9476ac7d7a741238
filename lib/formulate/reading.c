/* reading.c: which reading a program is made from, and what a program costs
 *
 * A small system written as by hand often takes fewer operations, once its common
 * subexpressions are shared, than the definitions that serve a system of any size. Where it
 * does, and writing it out is cheap, the run uses what is shown. */
#include "formulate/system_impl.h"

enum {
    MOST_SPEEDS = 7,       /* beyond, definitions win and writing out takes long */
    MOST_OPERATIONS = 800, /* of the definitions: spatial chains of three grow out of hand */
    FUNCTION_PRICE = 20    /* a sine costs about as much as twenty additions in a run */
};

static const Block blocks[] = {BLOCK_MASS, BLOCK_FORCES, BLOCK_CONSTRAINTS, BLOCK_JACOBIAN,
                               BLOCK_ACCELERATION};

/* operations, functions weighed */
static int64_t cost(const Expr *roots, int count)
{
    OpCount ops = expr_count_shared(roots, count);

    return ops.add + ops.mul + FUNCTION_PRICE * ops.fun;
}

static Expr **block_of(Reading *reading, Block block)
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
    Status status = OK;

    for (int b = 0; b < COUNT(blocks); b++) {
        int rows;
        int columns;

        system_block_size(system, blocks[b], &rows, &columns);
        for (int i = 0; i < rows * columns; i++)
            CHECK(system_show(system, blocks[b], i / columns, i % columns, out++, diag));
    }
done:
    return status;
}

Status reading_choose(System *system, Diag *diag)
{
    int count = 0;
    int filled = 0;
    Expr *defined = NULL;
    Expr *shown;
    int64_t price;
    Status status = OK;

    system->definitions = system->run;
    if (system->u.count > MOST_SPEEDS || system->u.count == 0 || !system_writes_out(system))
        return OK;
    for (int b = 0; b < COUNT(blocks); b++)
        count += block_entries(system, blocks[b]);
    defined = NEW_ARRAY(Expr, count);
    shown = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    for (int b = 0; b < COUNT(blocks); b++)
        for (int i = 0; i < block_entries(system, blocks[b]); i++)
            defined[filled++] = (*block_of(&system->run, blocks[b]))[i];
    price = cost(defined, count);
    if (price > MOST_OPERATIONS)
        goto done;
    CHECK(write_out(system, shown, diag));
    if (cost(shown, count) >= price)
        goto done;
    for (int b = 0; b < COUNT(blocks); b++) {
        *block_of(&system->run, blocks[b]) = shown;
        shown += block_entries(system, blocks[b]);
    }
done:
    mem_free(defined);
    return status;
}

/* --- the price of a program --- */

static void gather(Expr *out, int *count, const Expr *entries, int more)
{
    for (int i = 0; i < more; i++)
        out[(*count)++] = entries[i];
}

OpCount system_program_count(const System *system)
{
    const Reading *run = &system->run;
    int nu = system->u.count;
    int m = system->rows.count;
    int w = system->x.count + system->z.count;
    Expr *roots = NEW_ARRAY(Expr, nu * (nu + 1 + m) + 3 * m + run->network_entries + w);
    int count = 0;
    OpCount ops;

    gather(roots, &count, run->mass, nu * nu);
    gather(roots, &count, run->force, nu);
    gather(roots, &count, run->phi_u, m * nu);
    gather(roots, &count, run->phi, m);
    gather(roots, &count, run->nu, m);
    gather(roots, &count, run->gamma, m);
    for (int i = 0; i < run->network_entries; i++)
        roots[count++] = run->network[i].value;
    gather(roots, &count, run->network_rhs, w);
    ops = expr_count_shared(roots, count);
    mem_free(roots);
    return ops;
}

double system_price(const System *system)
{
    OpCount ops = system_program_count(system);
    double unknowns = (double)(system->u.count + system->rows.count);

    /* Gauss: as many additions as multiplications, both while factoring and while substituting */
    return (double)(ops.add + ops.mul + FUNCTION_PRICE * ops.fun) +
           2 * unknowns * unknowns * (unknowns / 3 + 1);
}

/* counting.c: operation counts of a system's blocks, as written and with shared subexpressions */
#include "formulate/system/system_impl.h"

static const Expr *run_block(const System *system, Block block)
{
    const EquationForm *run = &system->run;

    switch (block) {
    case BLOCK_MASS:
        return run->mass;
    case BLOCK_FORCES:
        return run->force;
    case BLOCK_CONSTRAINTS:
        return run->phi;
    case BLOCK_JACOBIAN:
        return run->phi_u;
    case BLOCK_VELOCITY:
        return run->nu;
    case BLOCK_ACCELERATION:
        return run->gamma;
    case BLOCK_NETWORK_RHS:
        return run->network_rhs;
    case BLOCK_NETWORK: /* sparse */
    case BLOCK_EMBEDDED_MASS:
    case BLOCK_EMBEDDED_FORCES:
    case BLOCK_DEPENDENT_RATES:
    case BLOCK_COMPLEMENT:
    case BLOCK_COUNT:
        break;
    }
    return NULL;
}

/* the nonzero entries of A */
static OpCount count_network(const System *system, bool shared)
{
    const EquationForm *run = &system->run;
    Expr *entries = NEW_ARRAY(Expr, run->network_entries);
    OpCount count;

    for (int i = 0; i < run->network_entries; i++)
        entries[i] = run->network[i].value;
    count = shared ? expr_count_shared(entries, run->network_entries)
                   : expr_count(entries, run->network_entries);
    mem_free(entries);
    return count;
}

static bool exceeds(OpCount a, OpCount b)
{
    return a.add > b.add || a.mul > b.mul || a.fun > b.fun;
}

/* The recursive form shares subexpressions that a run computes once. For short blocks it may need
 * more operations of a kind than the written form: then the written form with its own shared
 * subexpressions is counted. */
Status system_count(System *system, Block block, bool shared, OpCount *out, Diag *diag)
{
    system_touch(system);
    int rows;
    int columns;
    const Expr *run;
    Expr *entries = NULL;
    OpCount written, recursive;
    Status status = OK;

    if (block == BLOCK_NETWORK) {
        *out = count_network(system, shared);
        return OK;
    }
    system_block_size(system, block, &rows, &columns);
    if (shared && block == BLOCK_MASS)
        CHECK(system_form_mass(system, diag));
    entries = NEW_ARRAY(Expr, (size_t)rows * (size_t)columns);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++)
            CHECK(system_show(system, block, r, c, &entries[r * columns + c], diag));
    written = expr_count(entries, rows * columns);
    run = run_block(system, block);
    if (!shared) {
        *out = written;
        goto done;
    }
    recursive = expr_count_shared(run != NULL ? run : entries, rows * columns);
    *out = exceeds(recursive, written) ? expr_count_shared(entries, rows * columns) : recursive;
done:
    mem_free(entries);
    return status;
}

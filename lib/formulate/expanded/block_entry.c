/* block_entry.c: an entry of any block of the equations */
#include "formulate/expanded/block_entry.h"
#include "formulate/expanded/embedded.h"
#include "formulate/expanded/expanded.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/system_impl.h"

Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag)
{
    switch (block) {
    case BLOCK_EMBEDDED_MASS:
        return entry_formed(system, block, embedded_mass, row, column, out, diag);
    case BLOCK_EMBEDDED_FORCES:
        return entry_formed(system, block, embedded_force, row, column, out, diag);
    case BLOCK_DEPENDENT_RATES:
        return entry_formed(system, block, embedded_dependent_rate, row, column, out, diag);
    case BLOCK_COMPLEMENT:
        return entry_formed(system, block, embedded_complement, row, column, out, diag);
    default:
        return expanded_entry(system, block, row, column, out, diag);
    }
}

Status system_show(System *system, Block block, int row, int column, Expr *out, Diag *diag)
{
    system_touch(system);
    Status status = show_entry(system, block, row, column, out, diag);

    if (status == OK)
        *out = system_plain(system, *out);
    return status;
}

Status system_show_alone(System *system, Block block, int row, int column, Expr *out, Diag *diag)
{
    TRY(system_show(system, block, row, column, out, diag));
    if (!system->dynamics->writes_out)
        *out = system_written(system, *out);
    return OK;
}

/* residual.h: rows of expressions over unknowns, with their derivatives, compiled
 *
 * Rows r(x, p) (m x 1) of unknowns x (n x 1) and inputs p, with the entries of dr/dx that aren't
 * identically 0. Derivatives are formed symbolically and computed by one Program with the rows. A
 * Residual is made once and const ever after. The numbers of one evaluation are in a Workspace of
 * its program; each thread has its own. */
#ifndef COTREE_COMPILE_RESIDUAL_H
#define COTREE_COMPILE_RESIDUAL_H

#include "base/call_monitor.h"
#include "compile/program.h"

typedef struct Residual Residual;

/* a derivative that isn't 0: of a row by an unknown */
typedef struct Slope {
    int row, unknown;
    unsigned kinds; /* of symbols in it, as of expr_kinds() */
} Slope;

/* All is borrowed during the call. */
typedef struct ResidualOrder {
    Arena *arena;      /* of all; derivatives are formed there */
    const Expr *roots; /* expressions to compute */
    int root_count;
    int row_count;        /* so many of them, the first, are rows: they are differentiated */
    const Expr *unknowns; /* by these symbols, each once */
    int unknown_count;
    const Expr *inputs; /* symbols that the caller sets, without parameters */
    int input_count;
    ProgramBlocks blocks;                     /* of these inputs; a parameter is of none */
    Expr (*put)(const void *context, Expr e); /* compiled for a root or slope; NULL: itself */
    const void *context;
    const CallMonitor *watch; /* may be NULL */
} ResidualOrder;

/* New; residual_free(). Fails as program_new() does, or with E_STOPPED. O(nodes), and a derivative
 * for each row and unknown in it. */
MUST_USE Status residual_new(const ResidualOrder *order, Residual **out, Diag *diag);
void residual_free(Residual *residual); /* NULL is fine */

/* Its inputs are those of the order, then the parameters; its roots likewise, then the slopes. */
const Program *residual_program(const Residual *residual);
/* the parameters that its roots contain, in the order of their inputs; borrowed from the arena */
const Expr *residual_parameters(const Residual *residual, int *count);
/* Row by row, in a row by rising unknowns. Borrowed. */
const Slope *residual_slopes(const Residual *residual, int *count);
int residual_row_count(const Residual *residual);
int residual_first_slope(const Residual *residual); /* index of the first among the roots */
#endif

/* view.h: what is looked at, and how it is written
 *
 * A View borrows a model, the equations made of it and its last run; what a topic does
 * not need may be NULL. Everything in lib/export writes from a View to a Text. */
#ifndef COTREE_PRESENT_VIEW_H
#define COTREE_PRESENT_VIEW_H

#include "formulate/system/system.h"
#include "model/model.h"
#include "present/layout.h"
#include "present/named_laws.h"
#include "present/terminal_graph.h"
#include "simulate/analyse/linearize.h"
#include "simulate/fit/fit_result.h"
#include "simulate/fit/optimum.h"
#include "simulate/sweep/sweep_table.h"

/* reads expressions over the user's variables at one instant: out[i] of items[i], 0 where it is no
 * more than rounding */
typedef struct ViewInstant {
    Status (*read)(const void *context, const Expr *items, int count, double *out, Diag *diag);
    /* which parts with dry friction share a load: count x count */
    Status (*shares)(const void *context, const char *const *parts, int count, bool *out,
                     Diag *diag);
    const void *context;
    double time; /* s */
} ViewInstant;

typedef struct View {
    const Model *model;
    System *system;       /* of the model as it is; NULL unless equations are needed */
    const Result *result; /* the last run; NULL */
    /* run i of run_count, from 0 */
    const Result *(*run)(const void *session, int i);
    /* integrals of expressions over the user's variables over the last run */
    Status (*integrals)(const void *session, const Expr *items, int count, double *out, Diag *diag);
    const void *session;
    int run_count;
    const Linear *linear;          /* the last linearisation; NULL */
    const SweepTable *sweep;       /* the last sweep; NULL */
    const FitResult *fit;          /* the last fit; NULL */
    const Optimum *optimum;        /* of the last optimisation; NULL */
    const TerminalGraph *terminal; /* the graph with instances as their ports; NULL: as it is */
    const ViewInstant *instant;    /* where a topic shows values; NULL */
    DefinedLaws *defined; /* with laws that formulas call by name; NULL: they are written out */
    int freedoms;         /* degrees of freedom found by an assembly; -1: none yet */
    Page page;
    const CallMonitor *watch;
} View;

static inline NotationKind view_kind(const View *view)
{
    return notation_row(view->page.notation)->kind;
}

/* the graph that is looked at, and its trees as model_trees() has them */
const Graph *view_graph(const View *view);
MUST_USE Status view_trees(const View *view, const Tree *trees[TREE_KINDS], Diag *diag);
/* the type of an edge by its statement: "revolute"; of a port its subsystem's name */
const char *view_edge_type(const View *view, int edge);

/* whether the model has mechanical parts at all: a circuit has no coordinates to speak of */
bool view_is_mechanical(const View *view);
/* "2 states, 1 algebraic unknown", what there is of the network; "no unknowns" */
void view_network(Text *out, const System *system);

/* "2 degrees of freedom" if they are known or there are no constraints, else the difference "n - m
 * = 1", which redundant constraints make too small */
void view_freedoms(Text *out, const System *system, int freedoms);

/* what the user called it: "mass(1,2)", "(h8 - s11)"; new string */
char *view_name(const Syntax *syntax);

/* Append an expression in the view's notation. */
void view_add(Text *out, const View *view, Expr e);
/* the same as a new string */
char *view_expression(const View *view, Expr e);

/* An equation between sums, or a name and its value: terms are written in their order, each a
 * coefficient followed by a symbol (or NULL). */
typedef struct ViewTerm {
    Expr coefficient;
    Expr symbol;
} ViewTerm;

/* Append "a*s^2 + (b + c)*s - 1"; "0" where nothing is left. */
void view_add_sum(Text *out, const View *view, const ViewTerm *terms, int count);
/* Append "(inside)". */
void view_bracket(Text *out, const View *view, const char *inside);

typedef struct ShownEquation {
    char *lead; /* text before it: "h9 x: "; owned; NULL: none */
    char *name; /* the left side, if it isn't a sum; owned; NULL */
    LIST(ViewTerm) left;
    LIST(ViewTerm) right; /* no terms: 0 */
} ShownEquation;
typedef LIST(ShownEquation) EquationList;

/* Print the equations and free the list. If an equation has more than VIEW_BUDGET operations, all
 * are written with named subexpressions, listed afterwards as `where`. Programming languages have
 * no equations: they get `residual = left - right`. */
enum { VIEW_BUDGET = 2000 };
void view_equations(Text *out, const View *view, EquationList *equations);
/* the same between view_open() and view_close() */
void view_block(Text *out, const View *view, EquationList *equations);
void equations_free(EquationList *equations); /* an empty list is fine */
/* the commonest one: name = e */
void view_value(EquationList *equations, char *name, Expr e);

/* "mass(1,2)", or as the notation writes it: M_{1,2}, M[0][1], M(1,2); new string.
 * column -1: of a vector */
char *view_entry_name(const View *view, const char *text, const char *letter, int row, int column);

/* Append the unit in which the page shows what has such a unit in SI ("N*m"): what its value in SI
 * is to be divided by. */
double view_unit(const View *view, const char *si, Text *out);
/* The value in SI of a variable or parameter, with a unit where it has one: "30 deg". */
void view_quantity(const View *view, const char *name, double value, int digits, Text *out);

/* begin and end of an alignment in LaTeX; nothing in other notations */
void view_open(Text *out, const View *view);
void view_close(Text *out, const View *view);

/* "a remark" as the notation writes comments */
void view_comment(Text *out, const View *view, const char *words);

#endif

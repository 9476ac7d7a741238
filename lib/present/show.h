/* show.h: the topics of `show`
 *
 * A topic is a row: its name, its requirements, its arguments, and the function that writes it. */
#ifndef COTREE_PRESENT_SHOW_H
#define COTREE_PRESENT_SHOW_H

#include "present/view.h"

typedef enum Need {
    NEED_MODEL,
    NEED_SYSTEM,  /* equations by the trees */
    NEED_RUNNING, /* equations as a run evaluates them */
    NEED_CODE,    /* these, and the assembled start */
    NEED_RUN,     /* the last run; equations too */
    NEED_COURSE,  /* the last run, or with `at` values at an instant of it */
    NEED_INSTANT, /* values at an instant of the last run, or at the start */
    NEED_LINEAR   /* the last linearisation */
} Need;

/* arguments of a topic */
typedef enum TopicOperands {
    OPERANDS_NOTHING,
    OPERANDS_NUMBERS, /* a row, a row and a column */
    OPERANDS_EDGES,   /* names of edges */
    OPERANDS_LEVEL,   /* velocity or acceleration, and rows */
    OPERANDS_ENTRY,   /* a name, a row, or an entry: mass(2,3) */
    OPERANDS_PAIR,    /* output and input of the linearisation, by number or name */
    OPERANDS_ITEMS,   /* two: an output and an input */
    OPERANDS_PART,    /* a subsystem or instance; internal or ports */
    OPERANDS_PORTS    /* two terminals; or frames, `of` and a part of the model, `at` an instant */
} TopicOperands;

/* notations that a topic is written in, a bit each */
typedef enum Written {
    AS_TEXT = 1U << NOTATION_TEXT,
    AS_NARRATIVE = AS_TEXT | 1U << NOTATION_LATEX,
    AS_NUMBERS = AS_NARRATIVE | 1U << NOTATION_C | 1U << NOTATION_MATLAB,
    AS_FORMULAS = (1U << NOTATIONS) - 1
} Written;

/* unknowns of networks in what is shown of a mechanism */
typedef enum ShownNetworks {
    NETWORKS_AS_POSSIBLE, /* eliminated where their equations are linear */
    NETWORKS_KEPT,
    NETWORKS_ELIMINATED
} ShownNetworks;

typedef struct Selection {
    int numbers[2]; /* from 1 */
    int number_count;
    const char *const *names;
    int name_count;
    bool is_open;           /* show the inside of instances of subsystems, not only their ports */
    const char *level;      /* "velocity", "acceleration" or NULL */
    const Syntax *item;     /* OPERANDS_ENTRY, OPERANDS_PART; NULL: all */
    const Syntax *items[2]; /* OPERANDS_ITEMS; NULL: none */
    const char *part;       /* OPERANDS_PART: "internal", "ports"; NULL: both */
    /* OPERANDS_PORTS */
    const Syntax *const *ports;
    int port_count;
    bool has_of;
    const Syntax *const *of; /* after `of` */
    int of_count;
    const Syntax *at; /* NULL: in symbols */
    ShownNetworks networks;
} Selection;

typedef struct Topic {
    const char *name;
    const char *brief;
    Need need;
    TopicOperands operands;
    Written written;
    Status (*show)(const View *view, const Selection *selection, Text *out, Diag *diag);
} Topic;

const Topic *topic_find(const char *name); /* NULL: none */
const Topic *topic_at(int i);              /* 0, 1, ... until NULL */
/* word i of the notations that it is written in, of NULL any: 0, 1, ... until NULL */
const char *topic_notation(const Topic *topic, int i);

/* What the statement `show ...` needs; a variable (`show h9.fx`) needs equations, the name of a
 * part (`show R1`) only the model. */
MUST_USE Status show_need(const View *view, const Statement *statement, Need *need, Diag *diag);
/* Write what the statement requests; for a name without a formula, the text of `info`. Fails with
 * E_NAME for an unknown topic or edge, E_VALUE for an entry beyond the last, the errors of
 * equations. */
MUST_USE Status show(const View *view, const Statement *statement, Text *out, Diag *diag);
/* --- the functions of topics --- */
typedef MUST_USE Status ShowFunction(const View *view, const Selection *selection, Text *out,
                                     Diag *diag);

ShowFunction show_graph, show_nodes, show_edges, show_tree, show_incidence, show_circuits,
    show_cutsets, show_structure;
ShowFunction show_coordinates, show_constraints, show_jacobian, show_mass, show_forces,
    show_equations, show_network, show_events, show_sides;
ShowFunction show_sweep, show_statistics, show_fit, show_optimum;
void fit_print(const View *view, const FitResult *fit, Text *out);
void optimum_print(const View *view, const Optimum *optimum, Text *out);
ShowFunction show_subsystem;
ShowFunction show_derivation, show_power, show_partition, show_complement;
ShowFunction show_outputs, show_params, show_init, show_run, show_runs, show_settings, show_program;

/* --- equations one by one, each after its edge's name --- */

/* row i of M u' + Phi_u^T lambda = F */
MUST_USE Status equations_add_motion(const View *view, EquationList *equations, int i,
                                     int lead_width, Diag *diag);
/* "M7: L7*i' = ..." */
void equations_add_network(const View *view, EquationList *equations, int i, int lead_width);

/* a matrix of the linear equations, by its letter */
typedef struct LinearMatrix {
    char letter;
    const double *at; /* rows x columns */
    int rows, columns;
    char *const *row_names;
    char *const *column_names;
} LinearMatrix;
LinearMatrix linear_matrix(const Linear *linear, char letter);
/* A, B, C, D with the names of their rows and columns */
void linear_print(const View *view, const Linear *linear, Text *out);
ShowFunction show_linear, show_transfer, show_state;
ShowFunction show_symbolic_transfer, show_thevenin, show_norton;
/* whether it is a frame, or has the form of a frame's member */
bool port_is_frame(const View *view, const Syntax *syntax);
/* the same topics for frames of mechanisms */
MUST_USE Status show_port(const View *view, const Selection *selection, bool is_norton, Text *out,
                          Diag *diag);
/* E_MISSING without a linearisation, or without inputs or outputs of it */
MUST_USE Status linear_check_pairs(const Linear *linear, Diag *diag);
/* a number of which `error` is open: six digits, or those that are known, one at least */
void linear_known(Text *out, double value, double error);
void linear_latex(Text *out, double value, int digits); /* 1.5 \cdot 10^{-9} */
/* a line a mode, or why there are none; what moves on lines of its own where that is wider than the
 * page (0: never) */
void modes_print(const View *view, const Modes *modes, Text *out);

/* what an event of the model does, in words: "stops", "s1' = -0.8*s1'" */
void event_print(Text *out, const Event *event);

/* One variable or expression of the user's: `left = its expression`. Programming languages get a
 * left side that they can assign to: an expression is `value`, followed by its number (0: it is the
 * only one). */
MUST_USE Status show_expression(const View *view, const Syntax *syntax, int number, Text *out,
                                Diag *diag);

/* E_MISSING: there is no run */
MUST_USE Status show_without_run(Diag *diag);
/* a run's report: what ran, its work, residuals and energy; without its remarks */
void report_print(Text *out, const Result *result, const char *name);
/* the same in one line: final time, work, drift */
void report_line(Text *out, const Result *result, const char *name);
/* A line for each part with dry friction in the last run: when it stuck, how often it slipped, the
 * energy that it lost. Nothing where there are none. */
MUST_USE Status report_friction(const View *view, Text *out, Diag *diag);

#endif

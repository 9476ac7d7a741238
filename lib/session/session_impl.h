/* session_impl.h: the parts of a session, for the files of lib/session*.c
 *
 * A session owns a model, the equations made of it, its runs, and the last messages. Systems are
 * made when needed and live while they belong to the present model or a run refers to them. */
#ifndef COTREE_SESSION_SESSION_IMPL_H
#define COTREE_SESSION_SESSION_IMPL_H

#include "cotree.h"

#include "base/memory.h"
#include "base/text.h"
#include "model/model.h"
#include "present/count.h"
#include "present/show.h"
#include "simulate/analyse/linearize.h"
#include "simulate/fit/fit_result.h"
#include "simulate/fit/optimum.h"
#include "simulate/run/run.h"
#include "simulate/sweep/sweep_table.h"

#include <string.h>

/* Values of parameters at the start of a run; lives as long as the run. */
typedef struct ParameterValues {
    const Model *model; /* for parameters made later */
    LIST(int) places;   /* by numbers of symbols: index plus 1; 0: not stored */
    LIST(Expr) symbols;
    LIST(double) values;
} ParameterValues;

typedef struct Run {
    Result *result;       /* NULL: there is none */
    ResultReader *reader; /* of it */
    ParameterValues *parameters;
    Host *host; /* what its inputs were set to; NULL: nobody set any */
} Run;

/* reports the result of a verb */
typedef void Report(const ct_session *session, Text *out);

struct ct_session {
    ct_hooks hooks;
    CallMonitor watch; /* the hooks, as lib/ knows them */
    int polls;         /* of a try with failing allocations */
    const char *phase; /* that was reported last in this call; NULL: none */
    double fraction;   /* of it */
    Model *model;
    LIST(System *) systems; /* of the runs and, last, of the model at the latest request */
    LIST(Run) runs;         /* run1 is the first */
    Run start;              /* assembled from the model as it is, or its equilibrium; result NULL:
                               not yet. No run depends on it */
    Linear *linear;         /* the last linearisation; NULL */
    bool linear_is_old;     /* the model has changed since */
    Modes *modes;           /* and modes */
    SweepTable *sweep;      /* of the last sweep or Monte Carlo; NULL */
    FitResult *fit;         /* the last one; NULL */
    Optimum *optimum;       /* likewise */
    uint64_t seed;          /* of random numbers */
    bool is_sweeping;       /* a run is one of many, which leave the model as it is */
    double run_rtol;        /* of runs without rtol=; 0: the default */
    Report *reporter;       /* for ct_report(); NULL: as in runs */
    bool start_is_later;    /* a bare name means the start, not the end of the last run */
    bool changed;           /* since the last run */
    uint64_t covered;       /* revision whose virtual branches lose no freedom, and 1 */
    uint64_t freed;         /* revision whose freedoms are known, and 1 */
    int freedoms;
    Threads *threads; /* for runs and queries of them, as many as are set */
    TreeCosts costs;
    int cost_now; /* of the trees chosen last, a place in `costs` */
    Text remarks; /* of the last call; at NULL: none */
};

/* returns the statement of the public handle; never NULL for input that isn't NULL */
static inline const Statement *statement_of(const ct_statement *statement)
{
    return (const Statement *)(const void *)statement;
}
static inline const Syntax *syntax_of(const ct_expression *expression)
{
    return (const Syntax *)(const void *)expression;
}
static inline const ct_expression *expression_of(const Syntax *syntax)
{
    return (const ct_expression *)(const void *)syntax;
}

/* who carries it out */
static inline Room session_room(const Statement *s)
{
    if (s->kind != STATEMENT_VERB)
        return ROOM_MODEL;
    return s->row.shows_alone && s->operands.count == 0 ? ROOM_CALLER : s->row.room;
}

/* the public error of a status: returns what the public function returns */
ct_status session_report(Status status, const Diag *diag, ct_error *error);
/* At the start of each call of cotree.h that may allocate: when out of memory, the session is
 * unchanged and the call returns `failure`. */
#define SESSION_CALL(session, failure)                                                             \
    TRANSACTION(failure);                                                                          \
    session_enter(session)
void session_enter(const ct_session *handle);
/* The same for work that may take long: when the stop hook requests it, the work is left and the
 * session unchanged. */
#define SESSION_WORK(session, error)                                                               \
    TRANSACTION(session_left(session, transaction.is_stopped, error));                             \
    session_work(session)
void session_work(const ct_session *handle);
/* that memory has ended, or the user has */
ct_status session_left(ct_session *session, bool is_stopped, ct_error *error);
/* before anything that may remark */
void session_begin(ct_session *session);
void session_remark(ct_session *session, const char *lines);
/* the remarks of a result, without the end at a bound, which is reported as an error */
void session_remark_result(ct_session *session, const Result *result);

/* (session_import.c) The whole of a file that a statement names. */
MUST_USE Status session_read_file(ct_session *session, const Syntax *name, Text *out, Diag *diag);
/* (session_change.c) Changes of the model since model_begin_group() become one undo step, or are
 * undone. */
void session_end_group(ct_session *session, int group, const char *called, uint64_t revision,
                       bool keep);
/* the model is no longer what it was at that revision */
void session_note_change(ct_session *session, uint64_t revision, bool trees_only);

/* the equations of the model as it is; borrowed */
MUST_USE Status session_system(ct_session *session, System **out, Diag *diag);
/* the same in that form, whatever is set */
MUST_USE Status session_system_of(ct_session *session, NetworkForm form, bool has_lifted,
                                  System **out, Diag *diag);
/* the same to be run: of a large model numbers of parts are parameters there */
MUST_USE Status session_running(ct_session *session, System **out, Diag *diag);
/* the same, in which the guards of such events may be held (SystemOptions.rests) */
MUST_USE Status session_resting(ct_session *session, const Expr *rests, int rest_count,
                                System **out, Diag *diag);
/* The equations to show: those of the present trees, even if runs use a network in state form. */
MUST_USE Status session_shown(ct_session *session, System **out, Diag *diag);
/* the equations that something needs which is to be shown */
MUST_USE Status session_prepare(ct_session *session, Need need, View *view, Diag *diag);
/* The same for output as formulas. If these contain full turns of angles, the initial state is
 * assembled, which chooses the turns. Without an initial state a remark reports that they are
 * omitted. */
MUST_USE Status session_prepare_formulas(ct_session *session, Need need, View *view, Diag *diag);
void session_end_formulas(const View *view); /* once they are written */
/* What formulas that call laws by name are formed of (session_named_laws.c). */
typedef struct NamedLaws {
    ArenaMark *mark;
    Model *fork;
    Scene scene;
    System *system, *substituted; /* of the fork; of the model, borrowed */
    DefinedLaws defined;
} NamedLaws;
/* With `set laws named`, let the view of a statement for readers show such formulas. After
 * session_prepare_formulas(); session_end_named_laws() in any case. */
MUST_USE Status session_name_laws(ct_session *session, const Statement *s, NamedLaws *out,
                                  View *view, Diag *diag);
void session_end_named_laws(ct_session *session, NamedLaws *laws, View *view);
/* full turns of the assembled start, of each sum of angles; new */
int *session_turns_of_start(const System *system, const Result *start);
/* free systems that neither the model nor a run needs any more */
void session_free_unused(ct_session *session);
/* what there is to look at; `system` and `result` as needed */
View session_view(const ct_session *session);

/* --- trees (session_trees.c) --- */

/* `tree best`: search, select the cheapest trees, and add a remark on the comparison. Bounded by a
 * number of formulations and a time. After E_STOPPED the best trees so far are selected. */
MUST_USE Status session_best_trees(ct_session *session, Diag *diag);
/* apply every statement of a text, up to the first that fails */
MUST_USE Status session_apply_text(Model *model, const char *text, int *count, Diag *diag);

/* --- virtual branches (session_freedoms.c) --- */

/* Assemble in trees of real edges and in those of the system, and compare the freedoms, once a
 * revision. E_BRANCH names a virtual branch that removes some. */
MUST_USE Status session_check_freedoms(ct_session *session, System *system,
                                       const SimulationInput *setting, Diag *diag);
/* The same for trees just chosen, quietly: E_BRANCH, or OK, also where nothing can be assembled. */
MUST_USE Status session_try_trees(ct_session *session, Diag *diag);
/* freedoms that the last assembly of the present model found; -1: there was none */
void session_note_freedoms(ct_session *session, const Result *result);
int session_freedoms(const ct_session *session);
/* warn of virtual free joints among the branches */
void session_remark_free(ct_session *session);

/* --- runs --- */

void run_free(Run *run);
/* an expression of parameters as the run had them; one made since, as it is now */
double run_number(const Run *run, Expr e);
/* quantities that must not reach 0 in a run, each with its event and its initial value */
typedef struct BoundWatch {
    LIST(Bound) bounds;
    LIST(Event) events;
    LIST(double) from;
    Pool *pool;
} BoundWatch;

/* The input of a run, made from the present model. */
typedef struct RunInput {
    ParameterValues *parameters;
    StartValues start;
    Host *host;
    const Event **events;
    BoundWatch watch;
    SimulationInput setting;
} RunInput;
/* to run that System */
void run_input_make(ct_session *session, const System *system, RunInput *input);
void run_input_go_on(RunInput *input, const Run *old); /* with the numbers of parts that that had */
void run_input_free(RunInput *input);                  /* its arrays */
/* An embedding program takes part in the run: its settings in the continued run apply here too. */
void run_input_host(RunInput *input, const Host *host, const Run *old);
/* Monitor the limits of the laws of the system's parts in the run of this input; `old`: the run
 * that it continues, or NULL. Afterwards: E_SOLVER, naming the part and the quantity that reached
 * 0, if one did; else the status of the run. */
void watch_bounds(System *system, const Run *old, RunInput *input);
MUST_USE Status check_bounds(const RunInput *input, ResultReader *reader, Status status,
                             Diag *diag);
void watch_free(BoundWatch *watch);
/* the result, its reader, and the parameters that it was made with */
Run run_input_done(RunInput *input, Result *result, ResultReader *reader);
/* the assembled start of the model as it is, made when it isn't there yet; borrowed */
MUST_USE Status session_start(ct_session *session, Run **out, Diag *diag);
/* what a bare name means: the last run, or the start; NULL diag place */
MUST_USE Status session_source(ct_session *session, Run **out, Diag *diag);
/* the last run, with a remark where the model has changed since; the start where there is none */
MUST_USE Status session_last_run(ct_session *session, Run **out, Diag *diag);
/* The result of an equilibrium replaces initial values and guesses: guesses of every coordinate,
 * multi-turn angle and network unknown, one step of the model's history. */
MUST_USE Status session_store_equilibrium(ct_session *session, const Run *equilibrium,
                                          const char *called, Diag *diag);

/* --- one function a verb --- */

typedef MUST_USE Status Analysis(ct_session *session, const Statement *statement, Diag *diag);
#define SESSION_VERB(word, ...) Analysis session_##word;
#include "language/verbs.def"

/* adds a remark if the last linearisation is of another model, or of an instant of a motion */
void session_remark_linear(ct_session *session);
/* entries of what these found (linear.A, modes.omega): a number for the name; -1: none */
int session_entry(const char *name);
MUST_USE Status session_entry_value(const ct_session *session, int entry, const int *index,
                                    int count, double *out, Diag *diag);
/* of an entry whose numbers are written out; the context of an EntryFinder is the session */
bool session_entry_dimension(void *context, const Syntax *call, Dimension *out);

/* entries of the last sweep, sweep.value(3, max(h1)), and its sizes, sweep.runs
 * (session_sweep_entry.c) */
bool sweep_entry_is_called(const Syntax *syntax);
/* the argument that is a number, as the run of sweep.value; NULL: there is none */
const Syntax *sweep_entry_number(const Syntax *call);
MUST_USE Status sweep_entry_value(const ct_session *session, const Syntax *call, double number,
                                  double *out, Diag *diag);
MUST_USE Status sweep_size(ct_session *session, const char *path, double *out, Diag *diag);
bool sweep_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out);

/* the same of the last fit, fit.value(k) and fit.points (session_fit_entry.c) */
bool fit_entry_is_called(const Syntax *syntax);
MUST_USE Status fit_entry_value(const ct_session *session, const Syntax *call, double *out,
                                Diag *diag);
MUST_USE Status fit_size_value(ct_session *session, const char *path, double *out, Diag *diag);
bool fit_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out);

/* and of the last optimisation, optimum.value(k) and optimum.figure (session_optimum_entry.c) */
bool optimum_entry_is_called(const Syntax *syntax);
MUST_USE Status optimum_entry_value(const ct_session *session, const Syntax *call, double *out,
                                    Diag *diag);
MUST_USE Status optimum_size_value(ct_session *session, const char *path, double *out, Diag *diag);
bool optimum_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out);

/* --- values --- */

/* the SI unit of the variable of that name, "rad/s"; "" if its dimension isn't known */
void session_unit(const ct_session *session, const char *name, Text *out);

/* outputs written out, also in one another: a run older than an output knows its parts */
Expr session_add_outputs(const Model *model, Expr e);

/* An expression of the user's over variables, runs and counts, ready to be evaluated. */
typedef enum LeafKind {
    LEAF_CONSTANT,
    LEAF_VARIABLE,
    LEAF_INTEGRAL,
    LEAF_SENSITIVITY /* of a variable by a parameter */
} LeafKind;

typedef struct Leaf {
    LeafKind kind;
    double value; /* of a constant */
    Expr expr;    /* of a variable: over names of the user's; its integral from the run's start */
    int run;      /* place in session->runs, or -1 for what a bare name means */
    Expr symbol;  /* its placeholder in `whole` */
    Expr by;      /* of a sensitivity: the parameter */
} Leaf;

typedef struct Formula {
    LIST(Leaf) leaves;
    Expr whole;   /* over the leaves' symbols */
    double scale; /* 1 / unit to be shown in */
} Formula;

void formula_free(Formula *formula);
/* Read an expression: names checked, functions of runs computed. */
MUST_USE Status formula_new(ct_session *session, const Syntax *syntax, Formula *out, Diag *diag);
bool formula_needs_run(const Formula *formula); /* or is made of numbers and parameters alone */
/* one number: at an instant (at not NULL), else at the end; `source` what bare names mean, NULL
 * where no run is needed */
MUST_USE Status formula_value(ct_session *session, const Formula *formula, Run *source,
                              const double *at, double *out, Diag *diag);
/* how far it moves where what it is made of does by a rounding */
MUST_USE Status formula_rounding(ct_session *session, const Formula *formula, Run *source,
                                 const double *at, double *out, Diag *diag);
/* 0 in the place of a value, found by formula_value() or formula_rows(), that rounding alone made:
 * it is no larger than it moves where what it is made of does by a rounding */
bool formula_may_be_rounding(const Syntax *item, double value); /* it is small enough to look */
MUST_USE Status formula_round(ct_session *session, const Formula *formula, Run *source,
                              const double *at, double *value, Diag *diag);
/* the run whose grid a list is on: the one that its items name, else `source` */
/* a time of the grid that is meant: within rounding of one, that one */
double session_row_time(const Result *result, double t);
Run *formula_grid(ct_session *session, const Formula *formulas, int count, Run *source);
/* values at `rows` times of several formulas, row by row: out is rows x stride, from column
 * `first` on; times NULL: the rows of `grid` */
MUST_USE Status formula_rows(ct_session *session, const Formula *formulas, int count, Run *grid,
                             Run *source, const double *times, int rows, double *out, int stride,
                             int first, Diag *diag);

/* functions of a whole run (session_figures.c): max(h8), first(h8 > 1), settling(h8, 0.1) */
bool figure_is_called(const Syntax *syntax);
/* of the last run, which there is; `band` is a second argument. E_VALUE if the run doesn't
 * determine such a number */
MUST_USE Status figure_value(ct_session *session, const Syntax *call, const Formula *argument,
                             double band, double *out, Diag *diag);

/* the parameter of that name, which there is */
Expr session_parameter(const ct_session *session, const char *name);
/* Sensitivities (session_sensitivity.c): d(h)/d(L), with a factor before it: a*d(h)/d(L). */
bool sensitivity_is_called(const ct_session *session, const Syntax *syntax);
/* h, the numerator with its factor, and L */
MUST_USE Status sensitivity_read(ct_session *session, const Syntax *syntax, const Syntax **item,
                                 const Syntax **numerator, Expr *parameter, Diag *diag);
/* Derivatives of expressions over variables by parameters of the model, at ascending times of the
 * last run: out is rows x items x parameters. E_MISSING for any other run. */
MUST_USE Status session_sensitivities(ct_session *session, Run *run, const Expr *items,
                                      int item_count, const Expr *parameters, int count,
                                      const double *times, int rows, double *out, Diag *diag);

/* Spectra (session_spectrum.c): spectrum(h8) only together with other spectra, in a table whose
 * first column is the frequency, Hz. A formula here is that of the argument; `values` is new. */
static inline bool spectrum_is_called(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && strcmp(syntax->text, "spectrum") == 0;
}
MUST_USE Status spectrum_formula(ct_session *session, const Syntax *item, Formula *out, Diag *diag);
MUST_USE Status spectrum_rows(ct_session *session, const Formula *formulas, int columns, Run *grid,
                              Run *source, double **values, int *rows, Diag *diag);

/* the value that `print` shows, at an instant of the last run or (NULL) at its end or the initial
 * state */
MUST_USE Status session_value_at(ct_session *session, const Syntax *syntax, const double *at,
                                 double *out, Diag *diag);

/* Append the unit of an expression in units of a list ("" for SI), nothing if its dimension isn't
 * known. Returns the divisor of its value in SI. */
double session_shown_unit(const ct_session *session, const Syntax *syntax, const char *units,
                          Text *out);

/* A number made of numbers, parameters and functions of runs; the same of a time. */
MUST_USE Status session_number(ct_session *session, const Syntax *syntax, double *out, Diag *diag);
MUST_USE Status session_instant(ct_session *session, const Syntax *at, double *out, Diag *diag);

/* If a message has no source position, set that of the variable that it names, among the requested
 * items. */
void session_place_item(const Syntax *const *items, int count, Diag *diag);

#endif

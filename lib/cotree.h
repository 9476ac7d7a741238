/* cotree.h: libcotree, modelling of mechatronic multibody systems by linear graphs
 *
 * A session holds a model, its equations and its runs. A program gives it statements
 * of the command language, one logical line at a time, and asks for equations, values
 * and tables. The library never prints, never exits, and starts no process.
 *
 * Where memory ends in a call, the call fails: CT_FAILED with "out of memory", or NULL
 * where it returns something new, or nothing where it returns void. What it had begun is
 * taken back and its memory given back; the session, its model, runs and what can be
 * undone are as they were, what was to be written is unwritten, and all calls work on.
 *
 * Strings said to be new are the caller's, to be freed with ct_free(). Everything
 * else handed out is borrowed and valid until the next call with the same session.
 * A session belongs to one thread at a time. The first one switches off GSL's error handler, which
 * is that of the whole process and would end it; a program that wants another sets it after. */
#ifndef COTREE_H
#define COTREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ct_status {
    CT_OK = 0,
    CT_FAILED,  /* an error, said in ct_error */
    CT_STOPPED, /* the stop hook asked for it; what was computed is kept */
    CT_UNMET,   /* an expectation did not hold */
    CT_NOT_MINE /* ct_apply(): a verb that looks, runs or draws, for the caller to do */
} ct_status;

/* What went wrong, at the user's place in the text; line and column count from 1, 0: nowhere. */
typedef struct ct_error {
    ct_status status;
    int line;
    int column; /* in bytes */
    int width;
    char message[600];
    char hint[400];   /* "" where there is none */
    char inside[300]; /* where in a definition it arose: lines to be shown as they are; "" */
    bool is_unsolved; /* a computation failed: no start, no step or no convergence was found */
} ct_error;

typedef struct ct_session ct_session;
typedef struct ct_statement ct_statement;
typedef struct ct_expression ct_expression; /* borrowed from its statement */

typedef struct ct_hooks {
    void *context;
    bool (*stop)(void *context); /* whether to stop what is going on; called often; may be NULL */
    void (*progress)(void *context, const char *phase,
                     double fraction); /* fraction < 0: unknown; may be NULL */
    /* where a file is that a statement reads data from: new, malloc(); NULL: it may not be read.
     * Without the hook it is where its name says. */
    char *(*find_file)(void *context, const char *name);
    /* what `set` takes beside the session's own settings, for completion: a name, the words it may
     * be set to, NULL; NULL instead: no more; may be NULL */
    const char *const *(*setting)(void *context, int i);
    /* Files of rows of sweeps: `append` adds bytes at the end of one, which need not exist;
     * `content` is what it has, new, malloc(); NULL: there is no such file. Each returns or sets
     * what failed: new, malloc(); NULL: nothing. Without the hooks no such files are written. */
    char *(*append)(void *context, const char *name, const char *bytes, size_t length);
    char *(*content)(void *context, const char *name, char **why);
    bool unicode; /* Greek letters, dots, superscripts in what is shown */
    int columns;  /* width to wrap shown text to; 0: never */
    /* that shown numbers are in: "mm deg rpm"; the caller's, as long as the session; NULL: SI */
    const char *units;
} ct_hooks;

const char *ct_version(void); /* "0.1.0" */
double ct_clock(void);        /* s, that goes forward only; since when doesn't matter */
ct_session *
ct_session_new(const ct_hooks *hooks); /* hooks are copied, NULL: none; new; ct_session_free() */
void ct_session_free(ct_session *session);
void ct_session_hooks(ct_session *session, const ct_hooks *hooks);
void ct_free(void *piece);

/* --- statements --- */

/* A text of statements and how far it was read; {.text = text, .line = 1} begins. */
typedef struct ct_cursor {
    const char *text;  /* the caller's; any number of lines */
    size_t next;       /* offset of the next statement; the text's length at the end */
    int line;          /* number of the physical line there */
    size_t line_start; /* offset at which that line begins */
} ct_cursor;

/* Read the next statement, and step over it; after an error the cursor stays where it is. A
 * logical line is physical lines joined by a backslash at their ends. `shortened`: verbs may be
 * shortened. *out is new (ct_statement_free) and may be empty. Reading a text to its end costs its
 * length. */
ct_status ct_parse(ct_cursor *cursor, bool shortened, ct_statement **out, ct_error *error);
void ct_statement_free(ct_statement *statement);
bool ct_statement_is_empty(const ct_statement *statement);
const char *ct_statement_text(const ct_statement *statement);
const char *ct_verb(const ct_statement *statement); /* full; "" for NAME = expr and f(x) = expr */
/* Who carries a statement out: ct_apply(), ct_run(), or whoever calls, by the functions below. */
typedef enum ct_room { CT_MODEL, CT_SESSION, CT_CALLER } ct_room;
ct_room ct_carrier(const ct_statement *statement);
bool ct_prints(const ct_statement *statement); /* something, which `>` may send to a file */
const ct_statement *ct_rest(const ct_statement *statement); /* of `time STATEMENT`; NULL */
int ct_operand_count(const ct_statement *statement);
const ct_expression *ct_operand(const ct_statement *statement, int i);
int ct_operand_sign(const ct_statement *statement, int i); /* '+', '-', '|' behind a bar, or 0 */
int ct_key_count(const ct_statement *statement);
const char *ct_key(const ct_statement *statement, int i, const ct_expression **value);
const ct_expression *ct_key_value(const ct_statement *statement,
                                  const char *key);                   /* NULL: not given */
const ct_expression *ct_at(const ct_statement *statement);            /* of `at t`; NULL */
const ct_expression *ct_versus(const ct_statement *statement);        /* of `vs x`; NULL */
const ct_expression *ct_near(const ct_statement *statement);          /* of `a ~ b`: b; NULL */
const ct_expression *ct_within(const ct_statement *statement);        /* NULL */
const char *ct_as(const ct_statement *statement);                     /* NULL */
const char *ct_redirect(const ct_statement *statement, bool *append); /* file name or NULL */
/* an error at a place of the statement (NULL expression: at its verb) */
ct_status ct_error_at(const ct_statement *statement, const ct_expression *expression,
                      ct_error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

char *ct_expression_text(const ct_expression *expression); /* new; as written, blanks normalised */
const char *ct_expression_word(
    const ct_expression *expression); /* the name, word or string; NULL when it is none */

/* --- the model --- */

/* import FORMAT "FILE": statements made of another program's file. With `text` they are new, and
 * nothing changes; where it is NULL the model takes them, all or none, as one step to undo.
 * ct_remarks() tells what was left out. */
ct_status ct_import(ct_session *session, const ct_statement *statement, char **text,
                    ct_error *error);
/* store NAME "FILE": new: what the file is to hold, the definition of a subsystem and those that it
 * needs. */
ct_status ct_store(ct_session *session, const ct_statement *statement, char **text,
                   ct_error *error);
/* load "FILE": the definitions that ct_store() wrote, as one step to undo. What was damaged, edited
 * or written by another program is refused. */
ct_status ct_load(ct_session *session, const ct_statement *statement, ct_error *error);
/* Build: what the model takes (components, parameters, init, tree, ...). CT_NOT_MINE, with nothing
 * done and no error, for other verbs; but a name alone, which is printed, fails as a mistyped verb
 * where nothing has it. On failure the model is as it was. */
ct_status ct_apply(ct_session *session, const ct_statement *statement, ct_error *error);
const char *
ct_remarks(const ct_session *session); /* lines that the last call had to say to the user; "". Those
                                         that begin with "warning: " are for quiet ones, too */
/* The subsystem whose definition is being read: each statement is one of its lines, up to `end`; or
 * NULL. It may be dropped. */
const char *ct_defining(const ct_session *session);
void ct_drop_definition(ct_session *session);
ct_status ct_undo(ct_session *session, ct_error *error); /* ct_remarks() names what was undone */
ct_status ct_redo(ct_session *session, ct_error *error);
/* What changes the model from ct_begin_group() to ct_end_group(), which takes what that returned,
 * is undone and done again together, as what it is `called`. Returns how many statements that are.
 */
int ct_begin_group(ct_session *session);
int ct_end_group(ct_session *session, int outer, const char *called);
/* The statements that made the model as it is, in full and in order, each with a number that no
 * other statement of the session has; those behind one that was undone are new ones. */
int ct_step_count(const ct_session *session);
const char *ct_step(const ct_session *session, int i, int *number);
/* whether it took away all that was there before it: ct_clear() */
bool ct_step_clears(const ct_session *session, int i);
void ct_clear(ct_session *session);
char *ct_save(const ct_session *session);      /* new: a script that rebuilds the model */
bool ct_is_changed(const ct_session *session); /* since the last run */

/* --- looking; new strings --- */

/* show TOPIC [...] [as NOTATION], the whole statement */
ct_status ct_show(ct_session *session, const ct_statement *statement, char **text, ct_error *error);
ct_status ct_count(ct_session *session, const ct_statement *statement, char **text,
                   ct_error *error); /* count, count trees */
ct_status ct_check(ct_session *session, char **text, ct_error *error);
ct_status ct_info(ct_session *session, const ct_statement *statement, char **text, ct_error *error);
ct_status ct_tree_text(ct_session *session, char **text, ct_error *error); /* `tree` alone */
/* What a picture goes onto. */
typedef struct ct_paper {
    const char *format;   /* "text", "svg", "gnuplot" (commands, data included), "dot", "html" */
    int columns, rows;    /* of characters, for text; 0: 79 and 30 */
    double width, height; /* px: of what was drawn, for gnuplot */
} ct_paper;
/* draw, the whole statement; only the linear graph goes as dot */
ct_status ct_draw(ct_session *session, const ct_statement *statement, ct_paper *paper, char **text,
                  ct_error *error);
/* animate, the whole statement: as svg or html one text, else one a picture, each to be shown for
 * *interval seconds. *frames ends with NULL: ct_words_free(). */
ct_status ct_animate(ct_session *session, const ct_statement *statement, ct_paper *paper,
                     char ***frames, double *interval, ct_error *error);

/* --- help, from the tables --- */

char *
ct_help(const char *word); /* NULL or "": the overview; NULL is returned for an unknown word */
char *ct_apropos(const char *word);
const char *ct_help_suggest(const char *word); /* what an unknown word may have meant; NULL */
char *ct_reference(const char *format); /* "texinfo", "man" or "words"; NULL for another format */
/* every example of verbs and components, for tests: name and statements; false at the end */
bool ct_example(int i, const char **name, const char **text);
/* Words that could stand at `cursor` of the line, in order; a new array of new strings ended by
 * NULL, *start the offset of the word that they complete. Free with ct_words_free(). */
char **ct_complete(ct_session *session, const char *line, size_t cursor, size_t *start);
void ct_words_free(char **words);
/* names of verbs: 0, 1, ... until NULL */
const char *ct_verb_name(int i);

/* --- runs --- */

/* simulate, kinematics, inverse, assemble, resume: the whole statement. The result becomes run1,
 * run2 ... (assemble, equilibrium: the start). linearize and modes keep theirs for ct_show(),
 * ct_value() and ct_export(). ct_report() tells about it, ct_remarks() what had to be said. */
ct_status ct_run(ct_session *session, const ct_statement *statement, ct_error *error);
/* A forward run that a program takes part in: it sees the rows, and sets the inputs of the model
 * (parts of the kind 'input'), each at the multiples of its period. Both are told the items, in SI:
 * NAN where one has no value; at an instant of inputs, as they are just before it. Both return
 * whether the run is to stop there; what there is is kept then, and CT_STOPPED returned. They are
 * called in the thread of the call, and must not call the session. *value, the input's so far, may
 * be left as it is. Methods take their steps as without them; an input that changes ends a step. */
typedef struct ct_run_options {
    bool resumes;    /* go on from the end of the last run, as `resume` does */
    double duration; /* s */
    double every; /* from row to row, s; 0 here and below: as `simulate` without the key has it */
    double rtol, atol;
    double step, maxstep; /* s */
    const char *method;   /* NULL: auto */
    bool check, realtime;
    const ct_expression *const *items; /* of statements, as ct_table() takes them; borrowed */
    int item_count;
    void *context;
    bool (*row)(void *context, double t, const double *values); /* may be NULL */
    bool (*input)(void *context, const char *name, double t, const double *values,
                  double *value); /* may be NULL */
} ct_run_options;
/* The result is that of `simulate` or `resume`, and kept as theirs. */
ct_status ct_simulate(ct_session *session, const ct_run_options *options, ct_error *error);
char *ct_report(ct_session *session);        /* new: the last run's report, as `show run` */
int ct_run_count(const ct_session *session); /* runs so far: run1 ... */
/* "L = 0.7 m" or "L=0.7": a value that a parameter has whatever statements define it with, now or
 * later; save and undo know nothing of it. */
ct_status ct_override(ct_session *session, const char *text, ct_error *error);
const char *ct_override_unused(const ct_session *session); /* a name that no parameter has; NULL */
/* Of random numbers, as of montecarlo; a new session has 0. Numbers depend on the seed and on the
 * number of the run alone. */
void ct_seed(ct_session *session, uint64_t seed);
/* What a run reports, as numbers: NAN where one is not known. */
typedef struct ct_figures {
    const char *method; /* that ran last; NULL: nothing was integrated */
    int rows;
    double from, to;          /* s: of the rows */
    double rtol, atol;        /* 0: nothing was integrated */
    int64_t steps, rejected;  /* rejected ones are among them */
    int64_t evaluations;      /* of the right-hand side */
    double position_residual; /* largest of the constraints' equations, in SI */
    double velocity_residual; /* largest of their rates */
    double energy_drift;      /* J: largest, of energy less work */
    double energy_scale;      /* J: largest kinetic or |potential| energy, to compare */
    double global_error;      /* of check=on, in SI */
    double wall;              /* s: that it took */
    bool stopped;             /* by the stop hook */
} ct_figures;
/* Of run1, run2 ...; 0: of the last one. False where there is no such run; *out is as it was. */
bool ct_run_figures(const ct_session *session, int run, ct_figures *out);

/* One value: over variables, parameters and functions of runs (max(h8), run2.h8); `at` NULL: the
 * end of the last run or the assembled start, as the language says. */
ct_status ct_value(ct_session *session, const ct_expression *expression, const ct_expression *at,
                   double *value, ct_error *error);
/* Of a value of ct_value() or ct_table() in SI, for a reader: 0 where it is no more than rounding,
 * of states by their largest and of parameters, makes of nothing; else as it is. `at`, s, is NULL
 * for the end. */
ct_status ct_round(ct_session *session, const ct_expression *expression, const double *at,
                   double *value, ct_error *error);
/* The SI unit of an expression where its dimension is known: new, "N*m"; NULL: it isn't, or it is a
 * number. */
char *ct_unit(const ct_session *session, const ct_expression *expression);
/* The same in units of a list, "mm deg": in *size what a value in SI is divided by to be in it. */
char *ct_unit_in(const ct_session *session, const ct_expression *expression, const char *units,
                 double *size);
/* whether a text is such a list: of units, no two of one dimension */
ct_status ct_check_units(const char *units, ct_error *error);
/* The value of a key that is a time, as every=, in s; `name` is what messages call it. */
ct_status ct_duration(ct_session *session, const ct_expression *expression, const char *name,
                      double *value, ct_error *error);
/* A table: first column t, then one an item, of the last run (or the run the items name). `count`
 * 0: all coordinates, speeds and network states. `every` > 0: on that grid, else the run's.
 * `values` is new, rows x (columns), row by row; `names` new (ct_words_free), with the unit asked
 * for behind a name in brackets. Of spectra, which stand alone, the first column is f, Hz, and no
 * `every`. */
ct_status ct_table(ct_session *session, const ct_expression *const *items, int count, double every,
                   double **values, int *rows, int *columns, char ***names, ct_error *error);
/* The same by columns: the last one has no name. ct_columns_free() */
typedef struct ct_column {
    char *name;     /* as written, without a unit */
    char *unit;     /* that the values are in: of the item, else SI; "": not known, or a number */
    double *values; /* one a row */
} ct_column;
ct_status ct_columns(ct_session *session, const ct_expression *const *items, int count,
                     double every, ct_column **out, int *columns, int *rows, ct_error *error);
void ct_columns_free(ct_column *columns); /* NULL is fine */
/* The statement that `plot fit` is: data, signals and residuals of the last fit; new, or NULL. */
char *ct_fit_plot(ct_session *session, ct_error *error);
/* The table of the last sweep or Monte Carlo, in units of a list (NULL: SI): *parameters columns of
 * parameters, then figures, NAN where a run failed. ct_columns_free() */
ct_status ct_sweep_columns(ct_session *session, const char *units, ct_column **out, int *columns,
                           int *parameters, int *rows, bool *is_random, ct_error *error);
/* The points of measured data, table("file", x, column) over a run: when x is that of a point, and
 * the point's value in the item's unit. `values` is new, rows x 2, and so is the name for a reader;
 * both NULL of any other item. */
ct_status ct_measured(ct_session *session, const ct_expression *item, double **values, int *rows,
                      char **name, ct_error *error);
/* The keys of plot. Ranges are in what the axis shows: that of y in the unit of the first item. */
typedef struct ct_plot {
    double x[2], y[2]; /* NAN, NAN: not given */
    bool x_is_log, y_is_log;
    bool panels;       /* each item has its own */
    bool map;          /* of a sweep of two parameters: colours and contours */
    const char *title; /* the statement's, or the model's; "" */
} ct_plot;
ct_status ct_plot_keys(ct_session *session, const ct_statement *statement, ct_plot *out,
                       ct_error *error);
/* When the i-th event happened in that run (1 ...; 0: the last), rising; its name. NULL: there
 * is no such event. */
const char *ct_run_event(const ct_session *session, int run, int i, const double **times,
                         int *count);
/* Curves over axes as text, for a terminal; what is borrowed has to last for the call. */
typedef struct ct_curve {
    const double *x, *y;
    int count, stride; /* from one number to the next, of both */
    double x_scale;    /* x is drawn times this */
    const char *label; /* "h1 [deg]" */
    bool is_points;    /* not joined */
    bool is_right;     /* on the right axis */
} ct_curve;
typedef struct ct_chart {
    const char *title, *x_label, *left_label, *right_label; /* "" none */
    double x[2], y[2];                                      /* NAN: what the curves need */
    bool x_is_log, y_is_log, has_equal_scales;
    bool fits_x; /* of x no more than the data */
    const ct_curve *curves;
    int count;
    const double *marks; /* where a line stands upright, and its name */
    const char *const *mark_names;
    int mark_count;
} ct_chart;
/* Charts above one another, in so many characters, at least 20 x 8 each; curves of braille where
 * `unicode`, a letter on each where there are several. new */
char *ct_chart_text(const ct_chart *charts, int count, int columns, int rows, bool unicode);
/* bode: the whole statement, of the last linearisation. First column the frequency, Hz, then gain,
 * dB, and phase, degrees, of each output against each input, NaN where nothing gets through or
 * rounding leaves it open, which is remarked; `values` and `names` as of ct_table(). */
ct_status ct_bode(ct_session *session, const ct_statement *statement, double **values, int *rows,
                  int *columns, char ***names, ct_error *error);
ct_status ct_bode_csv(ct_session *session, const ct_statement *statement, bool with_header,
                      char **text, ct_error *error); /* the same as csv; new */
/* expect CONDITION, expect A ~ B within TOL: CT_UNMET with the two values in the message */
ct_status ct_expect(ct_session *session, const ct_statement *statement, ct_error *error);
/* export FORMAT ...: text to be written where the caller likes. new */
ct_status ct_export(ct_session *session, const ct_statement *statement, bool with_header,
                    char **text, ct_error *error);
/* The same of formats that are several files in one: *out is new, ct_archive_free(); NULL: it is a
 * text, for ct_export(). */
typedef struct ct_archive ct_archive;
ct_status ct_export_archive(ct_session *session, const ct_statement *statement, ct_archive **out,
                            ct_error *error);
/* it goes to a file as a zip; else its one file does, as it is */
bool ct_archive_is_zip(const ct_archive *archive);
/* its files, 0, 1 ...; false: no more */
bool ct_archive_file(const ct_archive *archive, int i, const char **name, const char **bytes,
                     size_t *length);
/* Where a shared library belongs in it that a caller compiles of its sources/ for this machine;
 * NULL: there is no name for such machines. */
const char *ct_archive_binary(const ct_archive *archive);
/* The zip or the file, new, with that library; `binary` NULL: without. */
ct_status ct_archive_pack(ct_session *session, const ct_archive *archive, const char *binary,
                          size_t binary_length, char **bytes, size_t *length, ct_error *error);
void ct_archive_free(ct_archive *archive); /* NULL is fine */
const char *ct_title(const ct_session *session);

/* --- a model as functions of numbers ---
 *
 * For a controller, an optimiser, another solver: the equations of a session's model, compiled. A
 * ct_model is const once made, and has nothing of its session, which may go on or be freed; any
 * number of threads may share it. What computes is a ct_evaluator, of which each thread has its
 * own.
 *
 * Functions take arrays, all in SI:
 *
 *     p   parameters of the user's, each a name of the model
 *     t   time, s
 *     y   the state: coordinates, speeds, states of networks, references of angles of full turns
 *     s   what is solved for at a state: x' of networks, their algebraic unknowns, accelerations
 *         (u'), multipliers
 *
 * and give matrices row by row, by the names that they have in exported code, too: constraints,
 * jacobian, velocity, gamma, mass, forces, map, derivative (the rates of y, from s), outputs,
 * conditions; and residual, which is 0 where s is the solution: of networks' equations, of
 * M u' + Phi_u^T lambda - F, of Phi_u u' - gamma; and solution, s itself. With several lanes each
 * number of an array, t too, is as many beside each other: y[i * lanes + lane]. */
typedef struct ct_model ct_model;
typedef struct ct_evaluator ct_evaluator;

typedef enum ct_part { CT_PARAMETERS, CT_STATE, CT_SOLUTION, CT_OUTPUTS } ct_part;

typedef struct ct_model_options {
    const ct_expression *const *outputs; /* of statements, as ct_table() takes them; borrowed */
    int output_count;                    /* 0: those that the model has */
    const char *derivatives; /* "derivative outputs": functions that are differentiated; NULL */
    int lanes;               /* 1, 2, 4 or 8 evaluations at once; 0: 1 */
} ct_model_options;

/* Form and compile what the model has now; `options` NULL: all 0. *out is new: ct_model_free().
 * Fails where equations do, where an output depends on something that no function is given, and
 * where a function to be differentiated isn't there. The cost is that of exporting the model and of
 * compiling its functions and their derivatives; a parameter's value is not compiled in. */
ct_status ct_model_new(ct_session *session, const ct_model_options *options, ct_model **out,
                       ct_error *error);
void ct_model_free(ct_model *model); /* NULL is fine; after its evaluators */
int ct_model_size(const ct_model *model, ct_part part);
/* "h8", "h8'", "C2.v", "lambda(1)"; borrowed; NULL: there is no such entry */
const char *ct_model_name(const ct_model *model, ct_part part, int i);
/* its unit, "rad/s"; "" where its dimension isn't known; borrowed; NULL as above */
const char *ct_model_unit(const ct_model *model, ct_part part, int i);
int ct_model_find(const ct_model *model, ct_part part, const char *name); /* -1: there is none */
/* The parameters' values, and the start as it was assembled; each array may be NULL. One lane. */
void ct_model_start(const ct_model *model, double *p, double *y, double *s);
/* The number of a function, and what it gives; -1: there is none. rows, columns may be NULL. */
int ct_model_function(const ct_model *model, const char *name, int *rows, int *columns);
const char *ct_model_function_name(const ct_model *model, int function); /* NULL at the end */

/* NULL where memory ends; ct_evaluator_free(), by whatever thread has it then */
ct_evaluator *ct_evaluator_new(const ct_model *model);
void ct_evaluator_free(ct_evaluator *evaluator); /* NULL is fine */
/* The calls below allocate nothing and lock nothing. Arrays must not overlap.
 *
 * Values of a function: rows * columns * lanes numbers. What isn't a number there is NAN. O(its
 * operations). */
void ct_evaluate(ct_evaluator *evaluator, int function, const double *p, const double *t,
                 const double *y, const double *s, double *values);
/* s for a state; what it was is where Newton's method begins. CT_FAILED: where a lane's equations
 * are singular, or have no solution near, its s are NAN. O(entries of s, cubed), but for mechanisms
 * of few speeds without loops, which are eliminated in straight-line code. */
ct_status ct_solve(ct_evaluator *evaluator, const double *p, const double *t, const double *y,
                   double *s);
/* ct_solve(), and the rates of y */
ct_status ct_rates(ct_evaluator *evaluator, const double *p, const double *t, const double *y,
                   double *s, double *rates);
/* y onto the constraints, by the least correction: positions, then speeds; references of angles
 * next to them. CT_FAILED as ct_solve(), with NAN in the lane's y. */
ct_status ct_project(ct_evaluator *evaluator, const double *p, const double *t, double *y);
/* Derivatives of a function among those that were to be differentiated: (rows * columns) x
 * (entries of the part) x lanes. CT_OUTPUTS is no part to differentiate by.
 *
 * ct_partial_derivatives() leaves the other arrays as they are. ct_derivatives() lets s follow from
 * p, t and y, at which it must be the solution: so those of `derivative` by CT_STATE are the matrix
 * of the linearised equations. By CT_STATE or CT_PARAMETERS; CT_FAILED where the solution is
 * singular. Where constraints repeat each other, derivatives hold along what the constraints allow,
 * as sums of columns; entries that depend on multipliers which are not determined are NAN, with
 * CT_FAILED. */
ct_status ct_partial_derivatives(ct_evaluator *evaluator, int function, ct_part by, const double *p,
                                 const double *t, const double *y, const double *s, double *values);
ct_status ct_derivatives(ct_evaluator *evaluator, int function, ct_part by, const double *p,
                         const double *t, const double *y, const double *s, double *values);

#ifdef __cplusplus
}
#endif

#endif

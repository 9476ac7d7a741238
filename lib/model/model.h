/* model.h: the live model: statements applied to the graph, parameters, trees, undo, revision
 *
 * A model is defined by its accepted statements, in order. A statement that fails does not change
 * the model. All returned pointers are borrowed and valid until the next change; the arena lives as
 * long as the model. */
#ifndef COTREE_MODEL_MODEL_H
#define COTREE_MODEL_MODEL_H

#include "component/component.h"
#include "graph/tree.h"
#include "language/syntax.h"
#include "model/event.h"
#include "model/scene.h"
#include "model/subsystem.h"

#include <stdio.h>

typedef struct Model Model;

Model *model_new(void); /* new, empty; spatial */
void model_free(Model *model);

/* Applies one statement that builds: a parameter, a law, or a verb of ROOM_MODEL. Prints nothing.
 * Remarks for the user (what was completed, what was not changed) are model_remarks(). */
MUST_USE Status model_apply(Model *model, const Statement *statement, Diag *diag);
/* The subsystem whose definition is being read: statements are lines of it until its end; NULL. */
const char *model_defining(const Model *model);
void model_drop_definition(Model *model);
const char *model_remarks(const Model *model); /* of the last model_apply(), lines; may be "" */
MUST_USE Status model_undo(Model *model,
                           Diag *diag); /* the last statement; E_MISSING when there is none */
MUST_USE Status model_redo(Model *model, Diag *diag);
void model_forget_undone(Model *model); /* nothing can be redone any more */
/* Makes the last `count` statements, at least one, a single step of undo and redo, with the text
 * `called`. */
void model_join(Model *model, int count, const char *called);
/* Steps from model_begin_group() to model_end_group(), whose argument is the returned value, are
 * undone together. Returns the number of steps. Groups may be nested. */
int model_begin_group(Model *model);
int model_end_group(Model *model, int outer, const char *called);
int model_leave_group(Model *model, int outer); /* they remain single steps; 0 */
/* the steps that are in effect: the full statement of each, and a unique number */
int model_step_count(const Model *model);
const char *model_step(const Model *model, int i, int *serial);
bool model_step_clears(const Model *model, int i); /* whether it is a model_clear() */
const char *model_undone(const Model *model); /* text of the statement that was undone or redone */
void model_clear(Model *model);               /* as model_new(); can be undone */
char *model_save(const Model *model);         /* new: a script that rebuilds it */

/* It changes whenever equations may have changed (a part, a tree, a law), and not where numbers
 * alone have (a parameter, an initial value). A number is never used again, not even after undo.
 */
uint64_t model_revision(const Model *model);

Arena *model_arena(const Model *model);
const Graph *model_graph(const Model *model);
bool model_is_planar(const Model *model);
const Expr *model_gravity(const Model *model); /* three, ground axes, m/s^2 */
const char *model_title(const Model *model);

int model_count(const Model *model); /* number of instances, without deleted ones */
const Instance *model_instance(const Model *model,
                               int i); /* in order of making; Instance.number is i */
const Instance *model_find(const Model *model, const char *name); /* NULL */
/* the part whose name is the start of a dotted name ("T1" of "T1.s.v"), and its member after the
 * dot; NULL */
const Instance *model_owner(const Model *model, const char *path, const char **member);
const Instance *model_edge_owner(const Model *model, int edge);
/* the coordinate with that name: its owner and index in the owner; false: none */
bool model_coordinate(const Model *model, const char *name, const Instance **owner, int *index);

/* The trees completed from the user's choices; NULL for kinds whose domain has no edge. Stored
 * until the graph or a choice changes. Fails as tree_complete() does. */
MUST_USE Status model_trees(const Model *model, const Tree *trees[TREE_KINDS], Diag *diag);

/* The mechanical trees of `tree joint` or `tree absolute`, without the user's choices; new,
 * tree_free(); NULL where the graph has none. Fails as tree_complete() does. */
MUST_USE Status model_preset_trees(const Model *model, bool absolute, Tree *out[2], Diag *diag);
/* New: a model of the same statements over the same arena, to try others on; the first must outlive
 * it. */
MUST_USE Status model_fork(const Model *model, Model **out, Diag *diag);
/* The same, with laws of one argument that formulas call by name (arena_add_law()): for print only.
 */
MUST_USE Status model_fork_named(const Model *model, Model **out, Diag *diag);
/* A part of a model: components and instances of subsystems, with the arms on their bodies and on
 * ground. */
typedef struct Extract {
    const char *const *names;
    const Place *places;
    int count;
    const char *const *frames; /* that must be of the part, or such that it is attached to them */
    const Place *frame_places;
    int frame_count;
} Extract;

/* a terminal that the part shares with the rest */
typedef struct ExtractedTerminal {
    const char *node;
    Domain domain;
    bool is_across; /* the source gives its voltage; otherwise its current */
} ExtractedTerminal;

/* Where a part was attached to the rest; names are borrowed from the model. */
typedef struct ExtractedEnds {
    LIST(const char *) frames; /* of massless bodies, which take the place of the rest's */
    /* Terminal i has a source, EXTRACT_SOURCE with i, of the parameters EXTRACT_VALUE with (i, 0),
     * (i, 1) and (i, 2): its value and the rates of it at the time EXTRACT_TIME. */
    LIST(ExtractedTerminal) terminals;
} ExtractedEnds;
#define EXTRACT_VALUE    "port__value%d_%d"
#define EXTRACT_TIME     "port__time"
#define EXTRACT_SOURCE   "port__source%d"
#define EXTRACT_INSTANCE "port__use"

/* New: the part by itself (NULL: all), a model over the same arena, which must outlive it. Adds to
 * `ends`, whose lists the caller frees. E_NAME for an unknown name, E_MODEL where a frame isn't one
 * of the part, or a component needs something outside of it. */
MUST_USE Status model_extract(const Model *model, const Extract *part, Model **out,
                              ExtractedEnds *ends, Diag *diag);
/* New: an instance of a subsystem by itself, or of a definition one that is called
 * EXTRACT_INSTANCE. Instead of the frames that `use` binds it has massless bodies, as ends->frames,
 * and all terminals have sources. Bodies and terminals are named as the ports: "leg1.A". `name` is
 * of a definition, or of an instance that is not inside another one. */
MUST_USE Status model_isolate(const Model *model, const char *name, Model **out,
                              ExtractedEnds *ends, Diag *diag);
/* An expression of such a part with variables, such as "leg1.e.v'", in place of the parameters of
 * its sources. */
Expr model_extracted(Arena *arena, const ExtractedEnds *ends, Expr e);
/* The statement of a source, for printf() with its name, its two terminals and its value. */
const char *model_source_statement(Domain domain, bool is_across);
/* From now on statements of the fork may attach parts inside instances, to examine these. */
void model_open_insides(Model *fork);

/* The input of formulation, for the current model; scene_free(). Borrowed until the next change.
 * Fails as model_trees() does. */
MUST_USE Status model_scene(const Model *model, Scene *out, Diag *diag);
SceneSource model_scene_source(const Model *model);

/* Parameters: symbols of kind SYMBOL_PARAMETER with a defining expression each. A new one changes
 * no revision, so refer to them by symbol, not by number. */
int model_parameter_count(const Model *model);
Expr model_parameter(const Model *model, int i, Expr *definition);
bool model_has_parameter(const Model *model, const char *name); /* O(parameters) */
double model_parameter_value(const Model *model, Expr symbol);  /* current value, SI */
/* Values that replace those of definitions, of which statements and `save` know nothing: of several
 * of a name the last one applies. */
int model_override_count(const Model *model);
const char *model_override_name(const Model *model, int i);
void model_override(Model *model, const char *name, double value); /* adds one, in SI */
/* E_VALUE and others if a parameter's value is one that parts refuse, such as a mass below 0. */
MUST_USE Status model_check_parameter(Model *model, const char *name, Diag *diag);
/* Adds one by an expression, of a parameter that may be defined later. A failure adds none. */
MUST_USE Status model_override_by(Model *model, const char *name, const Syntax *value, Diag *diag);
void model_drop_overrides(Model *model, int count); /* all after the first `count` */
/* value of an expression of parameters only */
double model_number(const Model *model, Expr e);
/* the same, as Scene.number */
double model_scene_number(const void *model, Expr e);

/* Outputs: name = expression over variables (SYMBOL_VARIABLE), t and parameters. They change no
 * equation, nor the revision. Where an expression contains the name of
 * an output, the output is substituted. */
int model_output_count(const Model *model);
Expr model_output(const Model *model, int i, const char **name);
/* the law with that name: its body over `count` arguments; NULL: there is none */
Expr model_law(const Model *model, const char *name, const Expr **arguments, int *count);

/* initial values and guesses: variable (by name and primes), value (expression of parameters) */
typedef struct Start {
    const char *name; /* "h8", "m1.x", "C2.v", "M7.i" */
    int primes;
    Expr value;
    bool is_guess;
    Place place;
} Start;
int model_start_count(const Model *model);
const Start *model_start(const Model *model, int i);

/* Subsystems and their instances, in order of making. */
int model_subsystem_count(const Model *model);
const Subsystem *model_subsystem(const Model *model, int i);
const Subsystem *model_find_subsystem(const Model *model, const char *name); /* NULL */
/* New: the definition and those that it needs, one on each line; NULL: there is none. */
char *model_store(const Model *model, const char *name);
/* The model's statement that defines the same parameter, law or subsystem as `s`; *same: with equal
 * text. NULL: there is none. */
const char *model_definition_like(const Model *model, const Statement *s, bool *same);
/* the keys that `use` sets of the subsystem with that name: ports, then parameters; NULL at the
 * end */
const char *model_subsystem_key(const Model *model, const char *name, int i);
int model_use_count(const Model *model);
const Use *model_use(const Model *model, int i);
const Use *model_find_use(const Model *model, const char *name); /* NULL */
/* the outermost instance that contains the name; -1: none */
int model_use_around(const Model *model, const char *name);

int model_event_count(const Model *model);
const Event *model_event(const Model *model, int i);

/* Finds the files that statements name. */
typedef struct DataFinder {
    char *(*find)(void *context,
                  const char *name); /* new, malloc(): its path; NULL: it may not be read */
    void *context;
    bool given; /* shared data is not read again */
} DataFinder;
void model_find_data(Model *model, const DataFinder *finder);
/* A file that a statement names. Call data_close() even if it could not be opened. */
typedef struct DataFile {
    FILE *in;
    char *path; /* from the finder; NULL */
    Cleanup cleanup;
} DataFile;
MUST_USE Status data_open(const DataFinder *finder, const char *name, Place place, DataFile *out,
                          Diag *diag);
void data_close(DataFile *file);
/* Settings of the model, with the words of each: its name, its values, NULL; NULL: no more. For a
 * setting of whole numbers the words are only some of the values. */
typedef enum ModelSetting {
#define SETTING(id, ...)        SETTING_##id,
#define NUMBER_SETTING(id, ...) SETTING_##id,
#include "model/model_settings.def"
    MODEL_SETTINGS
} ModelSetting;
const char *const *model_setting(int i);
/* of each setting the index of its value, from 0; for whole numbers the value minus 1 */
typedef struct SettingValues {
    int at[MODEL_SETTINGS];
    bool is_given[MODEL_SETTINGS]; /* by a statement */
} SettingValues;
const SettingValues *model_settings(const Model *model);
static inline int model_setting_value(const Model *model, ModelSetting setting)
{
    return model_settings(model)->at[setting];
}
void model_setting_text(const Model *model, ModelSetting setting, Text *out); /* appends it */
Form model_form(const Model *model, const char *const **independent,
                int *count); /* names of coordinates; count 0: chosen by pivoting */

/* Converts a syntax tree into an expression over parameters, t and variables: units to SI, laws and
 * outputs substituted, names checked. A variable is a SYMBOL_VARIABLE of its own name with its
 * primes ("h8'", "m1.x", "lambda(1)", "model.n"): the coordinate's name, if J1 is written for
 * theta1. One of another run has its prefix ("run2.h8"). min, max, mean and rms of one argument,
 * which are computed over a run, become a symbol of that text ("max(h8)"). A prime on a bracket or
 * a call is the derivative along the primed variables. Unknown names fail with E_NAME and a
 * suggestion. */
MUST_USE Status model_expression(const Model *model, const Syntax *syntax, Expr *out, Diag *diag);
/* `a sign b` or, where b is NULL, `sign a`, by an operator of the language; NULL: it is none */
Expr model_operation(Arena *arena, const char *sign, Expr a, Expr b);
/* The same for a call whose arguments are expressions already. Those that are texts, in a call that
 * has text arguments, are NULL. */
MUST_USE Status model_call(const Model *model, const Syntax *syntax, const Expr *args, Expr *out,
                           Diag *diag);
bool model_call_takes_text(const Syntax *syntax);
/* Finds the dimensions of entries that only the model's owner knows, as linear.A(1,2): false where
 * it doesn't know them either. */
typedef struct EntryFinder {
    bool (*dimension)(void *context, const Syntax *call, Dimension *out);
    void *context;
} EntryFinder;
void model_find_entries(Model *model, const EntryFinder *finder);

/* Dimensions of texts whose names are known; each fails with E_UNIT at its position. An unknown
 * dimension is always accepted. */
/* an item: its sums and arguments, and the unit after it in which it is displayed */
MUST_USE Status model_check_shown(const Model *model, const Syntax *item, Diag *diag);
/* the value of a key, "every", whose unit is `unit` */
MUST_USE Status model_check_unit(const Model *model, const Syntax *syntax, const char *unit,
                                 const char *name, Diag *diag);
/* f.lost, energy.lost: the integral of f.loss, energy.loss over a run */
bool model_is_integral(const Model *model, const char *name);
/* False where it is unknown. */
bool model_dimension(const Model *model, const Syntax *syntax, Dimension *out);
/* the same for an expression's text, as the name of a state or an item */
bool model_text_dimension(const Model *model, const char *text, Dimension *out);
/* the SI unit of a member of one of its instances, "effort"; NULL */
const char *model_member_unit(const Model *model, const Instance *part, const char *member);
/* unit of a beam's quantity at a position, by the text before its bracket, "b1.v"; NULL: none */
const char *model_place_unit(const Model *model, const char *text);
/* two values that are compared */
MUST_USE Status model_check_alike(const Model *model, const Syntax *left, const Syntax *right,
                                  Diag *diag);
/* whether the dotted name is a variable that exists with that many primes; if not, reports why */
MUST_USE Status model_check_variable(const Model *model, const char *path, int primes, Place place,
                                     Diag *diag);
/* whether `delete` can remove the name: neither a coordinate nor a terminal */
bool model_can_go(const Model *model, const char *name);
/* whether it is a name of the model, including terminals */
bool model_has_name(const Model *model, const char *name);
/* every name that could follow, for completion: call with 0, 1, ... until NULL */
const char *model_name(const Model *model, int i);

#endif

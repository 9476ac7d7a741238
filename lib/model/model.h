/* model.h: the live model: statements applied to the graph, parameters, trees, undo, revision
 *
 * A model is what its accepted statements say, in order. A statement that fails leaves
 * the model as it was. Everything handed out is borrowed and valid until the next
 * change; the arena lives as long as the model. */
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

/* Apply one statement that builds: a parameter, a law, or a verb of ROOM_MODEL. Says nothing.
 * Remarks for the user (what was completed, what was kept) are model_remarks(). */
MUST_USE Status model_apply(Model *model, const Statement *statement, Diag *diag);
/* The subsystem whose definition is being read: statements are its lines until its end; NULL. */
const char *model_defining(const Model *model);
void model_drop_definition(Model *model);
const char *model_remarks(const Model *model); /* of the last model_apply(), lines; may be "" */
MUST_USE Status model_undo(Model *model,
                           Diag *diag); /* the last statement; E_MISSING when there is none */
MUST_USE Status model_redo(Model *model, Diag *diag);
void model_forget_undone(Model *model); /* nothing is left to redo */
/* The last `count` statements, at least one, are undone and done again as one, that of `called`. */
void model_join(Model *model, int count, const char *called);
/* Steps from model_begin_group() to model_end_group(), which takes what that returned, are undone
 * together; how many there are. Groups may lie within groups. */
int model_begin_group(Model *model);
int model_end_group(Model *model, int outer, const char *called);
int model_leave_group(Model *model, int outer); /* they stay single steps; 0 */
/* the steps that count: the statement of each, in full, and a number that no other step has */
int model_step_count(const Model *model);
const char *model_step(const Model *model, int i, int *serial);
bool model_step_clears(const Model *model, int i); /* whether it is one of model_clear() */
const char *model_undone(const Model *model); /* text of the statement that undo/redo moved over */
void model_clear(Model *model);               /* as model_new(); can be undone */
char *model_save(const Model *model);         /* new: a script that rebuilds it */

/* Two counters: `revision` changes whenever equations may have changed (a part, a tree, a law),
 * `values` whenever only numbers have (a parameter, an initial value). Never reused, also not by
 * undo. */
uint64_t model_revision(const Model *model);
uint64_t model_values(const Model *model);

Arena *model_arena(const Model *model);
const Graph *model_graph(const Model *model);
bool model_is_planar(const Model *model);
const Expr *model_gravity(const Model *model); /* three, ground axes, m/s^2 */
const char *model_title(const Model *model);

int model_count(const Model *model); /* of instances, deleted ones left out */
const Instance *model_instance(const Model *model,
                               int i); /* in order of making; Instance.number is i */
const Instance *model_find(const Model *model, const char *name); /* NULL */
/* the part that a dotted name begins with ("T1" of "T1.s.v"), and its member behind the dot; NULL
 */
const Instance *model_owner(const Model *model, const char *path, const char **member);
const Instance *model_edge_owner(const Model *model, int edge);
/* the coordinate of that name: its owner and index in the owner; false: none */
bool model_coordinate(const Model *model, const char *name, const Instance **owner, int *index);

/* Trees that the user's choices complete to; kinds whose domain has no edge are NULL. Kept until
 * the graph or a choice changes. Fails as tree_complete() does. */
MUST_USE Status model_trees(const Model *model, const Tree *trees[TREE_KINDS], Diag *diag);

/* The mechanical trees of `tree joint` or `tree absolute`, whatever is chosen; new, tree_free();
 * NULL where the graph has none. Fails as tree_complete() does. */
MUST_USE Status model_preset_trees(const Model *model, bool absolute, Tree *out[2], Diag *diag);
/* New: a model of the same statements over the same arena, to try others on; it may not outlive the
 * first. */
MUST_USE Status model_fork(const Model *model, Model **out, Diag *diag);
/* What the fork is given from now on may attach inside instances, as what only looks does. */
void model_open_insides(Model *fork);

/* What formulation takes of the model as it is now; scene_free(). Borrowed until the next change.
 * Fails as model_trees() does. */
MUST_USE Status model_scene(const Model *model, Scene *out, Diag *diag);
SceneSource model_scene_source(const Model *model);

/* Parameters: symbols of kind SYMBOL_PARAMETER with a defining expression each. A new one changes
 * neither revision nor values, so remember them by symbol, not by number. */
int model_parameter_count(const Model *model);
Expr model_parameter(const Model *model, int i, Expr *definition);
double model_parameter_value(const Model *model, Expr symbol); /* now, SI */
/* evaluate an expression of parameters only */
double model_number(const Model *model, Expr e);
/* the same, as Scene.number */
double model_scene_number(const void *model, Expr e);

/* Outputs: name = expression over variables (SYMBOL_VARIABLE), t and parameters. They change no
 * equation: a new one leaves revision and values as they are, and where an expression names one,
 * it is put in place. */
int model_output_count(const Model *model);
Expr model_output(const Model *model, int i, const char **name);
/* the law of that name: its body over `count` arguments; NULL: there is none */
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
/* New: the definition and those that it needs, a line each; NULL: there is none. */
char *model_store(const Model *model, const char *name);
/* The model's statement that defines the name of a parameter, law or subsystem which `s` defines;
 * *same: in the same words. NULL: there is none. */
const char *model_definition_like(const Model *model, const Statement *s, bool *same);
/* what `use` gives the subsystem of that name: ports, then parameters; NULL at the end */
const char *model_subsystem_key(const Model *model, const char *name, int i);
int model_use_count(const Model *model);
const Use *model_use(const Model *model, int i);
const Use *model_find_use(const Model *model, const char *name); /* NULL */
/* The outermost instance that a name lies in, or, from `within` on, the outermost inside that one;
 * -1: none. */
int model_use_around(const Model *model, const char *name, int within);

int model_event_count(const Model *model);
const Event *model_event(const Model *model, int i);

/* Where the files are that statements name. */
typedef struct DataFinder {
    char *(*find)(void *context,
                  const char *name); /* new, malloc(): its path; NULL: not to be read */
    void *context;
    bool given; /* what is shared is not read anew */
} DataFinder;
void model_find_data(Model *model, const DataFinder *finder);
/* A file that a statement names there. data_close() also where it could not be opened. */
typedef struct DataFile {
    FILE *in;
    char *path; /* of the finder's making; NULL */
    Cleanup cleanup;
} DataFile;
MUST_USE Status data_open(const DataFinder *finder, const char *name, Place place, DataFile *out,
                          Diag *diag);
void data_close(DataFile *file);
/* Settings that the model keeps, and the words of each: its name, its values, NULL; NULL: no more.
 * Of one of whole numbers they are but some. */
typedef enum ModelSetting {
#define SETTING(id, ...)        SETTING_##id,
#define NUMBER_SETTING(id, ...) SETTING_##id,
#include "model/model_settings.def"
    MODEL_SETTINGS
} ModelSetting;
const char *const *model_setting(int i);
/* which of the values, from 0; of whole numbers how much more than 1 */
int model_setting_value(const Model *model, ModelSetting setting);
void model_setting_text(const Model *model, ModelSetting setting, Text *out); /* append it */
Form model_form(const Model *model, const char *const **independent,
                int *count); /* names of coordinates; count 0: chosen by pivoting */

/* Turn a syntax tree into an expression over parameters, t and variables: units to SI, laws and
 * outputs put in place, names checked. A variable is a SYMBOL_VARIABLE of its own name with its
 * primes ("h8'", "m1.x", "lambda(1)", "model.n"): the coordinate's, where J1 stands for theta1.
 * One of another run keeps its prefix ("run2.h8"); min, max, mean and rms of one argument, which
 * are taken over a run, become a symbol of that text ("max(h8)"). A prime on a bracket or a call is
 * the derivative along the primed variables. Names that aren't known fail with E_NAME and a
 * suggestion. */
MUST_USE Status model_expression(const Model *model, const Syntax *syntax, Expr *out, Diag *diag);
/* `a sign b` or, where b is NULL, `sign a`, by an operator of the language; NULL: it is none */
Expr model_operation(Arena *arena, const char *sign, Expr a, Expr b);
/* The same of a call, its arguments already expressions: those that are texts, of a call that takes
 * some, are NULL. */
MUST_USE Status model_call(const Model *model, const Syntax *syntax, const Expr *args, Expr *out,
                           Diag *diag);
bool model_call_takes_text(const Syntax *syntax);
/* What tells dimensions of entries that only the model's owner knows, as linear.A(1,2): false where
 * it doesn't, either. */
typedef struct EntryFinder {
    bool (*dimension)(void *context, const Syntax *call, Dimension *out);
    void *context;
} EntryFinder;
void model_find_entries(Model *model, const EntryFinder *finder);

/* Dimensions, of texts whose names are known; each fails with E_UNIT at its place. What can't be
 * inferred fits everything. */
/* an item: its sums and arguments, and the unit behind it that it is to be shown in */
MUST_USE Status model_check_shown(const Model *model, const Syntax *item, Diag *diag);
/* the value of a key, "every", that is in `unit` */
MUST_USE Status model_check_unit(const Model *model, const Syntax *syntax, const char *unit,
                                 const char *name, Diag *diag);
/* False where it isn't known. */
bool model_dimension(const Model *model, const Syntax *syntax, Dimension *out);
/* the same of an expression's text, as the name of a state or an item */
bool model_text_dimension(const Model *model, const char *text, Dimension *out);
/* the unit in SI of a member of one of its instances, "effort"; NULL */
const char *model_member_unit(const Model *model, const Instance *part, const char *member);
/* of what a beam tells at a place along it, by the text before its bracket, "b1.v"; NULL: nothing
 */
const char *model_place_unit(const Model *model, const char *text);
/* two that are compared */
MUST_USE Status model_check_alike(const Model *model, const Syntax *left, const Syntax *right,
                                  Diag *diag);
/* whether the dotted name means a variable that can be asked for, with that many primes; if not,
 * why */
MUST_USE Status model_check_variable(const Model *model, const char *path, int primes, Place place,
                                     Diag *diag);
/* whether a name is one that `delete` takes: neither a coordinate nor a terminal */
bool model_can_go(const Model *model, const char *name);
/* whether it is the name of anything, of a terminal too */
bool model_has_name(const Model *model, const char *name);
/* every name that could follow, for completion: call with 0, 1, ... until NULL */
const char *model_name(const Model *model, int i);

#endif

/* model_impl.h: shared by the files of the model
 *
 * A State is everything that accepted statements made. It can be rebuilt from its lines at any
 * time, which is how names are deleted and laws replaced. A statement is read and checked
 * completely before it changes its State, or it builds another State that replaces it. So a failure
 * changes nothing. A statement adds to the ends of the lists, and records what it changes in place;
 * undo uses both. Strings and parts live in the State's pool, expressions in the model's arena. */
#ifndef COTREE_MODEL_MODEL_IMPL_H
#define COTREE_MODEL_MODEL_IMPL_H

#include "base/names.h"
#include "model/measure.h"
#include "model/model.h"

typedef LIST(const char *) NameList;
typedef LIST(int) NumberList;

/* --- names --- */

typedef enum ThingKind { THING_PART, THING_COORDINATE, THING_DEFINITION, THING_USE } ThingKind;

typedef struct Thing { /* meaning of a name of State.names, by its number there */
    ThingKind kind;
    int index; /* part (the owner of a coordinate), definition or use */
    int coordinate;
} Thing;

typedef enum DefinitionKind {
    DEFINES_PARAMETER,
    DEFINES_LAW,
    DEFINES_OUTPUT,
    DEFINES_EVENT,
    DEFINES_SUBSYSTEM
} DefinitionKind;

/* the choice of a definition's own `tree` in one of its instances */
typedef struct InsideChoice {
    int use;
    int kind; /* of tree */
    bool excluded;
    const char *name;
} InsideChoice;

typedef struct Definition {
    DefinitionKind kind;
    const char *name;
    Expr symbol;          /* for a parameter */
    Expr body;            /* for a law: over its arguments */
    const Syntax *syntax; /* for a law: its text, in the state's pool */
    Measure measure;      /* for a parameter or output */
    Expr *arguments;
    int argument_count;
    const Event *event; /* for an event; in the state's pool */
    const Subsystem *subsystem;
    int line;
    bool is_known; /* for a parameter: `value` is current */
    double value;
} Definition;

/* --- the script that rebuilds the state --- */

typedef struct Line {
    const char *text;
    int definition;  /* the definition that it makes; -1 */
    int part;        /* the part that it makes or sets; -1 */
    const char *key; /* a later line of the same part and key supersedes it; NULL */
    int *uses;       /* definitions that it needs */
    int use_count;
    int use;      /* the use that it makes; -1 */
    int inside;   /* the use that made it, with which it is removed; -1 */
    bool is_gone; /* superseded by a later line */
} Line;

typedef struct StartEntry {
    Start start;
    const char *text; /* "h8' = 12" */
    int name_index;   /* of `text` up to "=", in State.start_names */
    /* number of the statement that set it: those of one statement are saved on one line */
    int group;
} StartEntry;

typedef struct Choice { /* for one tree */
    bool absolute;      /* bodies before joints */
    NameList chosen;
    NameList excluded;
} Choice;

/* The contents of a State besides its lists. */
typedef struct Setup {
    bool planar;
    Expr gravity[3];
    const char *title;
    int datum[DOMAIN_COUNT]; /* nodes; -1 until needed */
    int group_count;
    Form form;
    SettingValues settings;
} Setup;

/* --- values before changes in place (model_mark.c) --- */

typedef enum ChangeKind {
    CHANGED_LINE,
    CHANGED_DEFINITION,
    CHANGED_VALUES, /* of a part */
    CHANGED_CHOICE, /* of a tree */
    CHANGED_INDEPENDENT,
    CHANGED_EQUATIONS, /* of a use */
    ADDED_START,
    REMOVED_START
} ChangeKind;

typedef struct Change {
    ChangeKind kind;
    int at; /* number of the line, definition, part, tree, use or start */
    union {
        Line line;
        Definition definition;
        Value *values;
        Choice *choice; /* owned, as are the two below */
        NameList *independent;
        const BlockEquations *equations; /* of the pool */
        StartEntry start;
    } was;
} Change;

typedef struct State State;

typedef struct Outcome {
    bool changes_equations; /* a statement may have */
    Text remarks;
} Outcome;

/* Applies a statement to *state, or replaces *state by another State. */
typedef MUST_USE Status Apply(State **state, const Statement *statement, Outcome *outcome,
                              Diag *diag);

/* A value that replaces that of a parameter's definition (model_override.c). */
typedef struct Override {
    char *name;
    double value;
    Measure measure;
} Override;
typedef struct Overrides {
    LIST(Override) list;
} Overrides;

struct State {
    Arena *arena;         /* the model's */
    Overrides *overrides; /* the model's */
    Apply *apply; /* carries out statements: those of a definition, lines of a state rebuilt */
    Pool *pool;
    Setup setup;
    Graph *graph;
    Names *names;       /* of all except parameters: a part may have a parameter's name */
    LIST(Thing) things; /* by number in `names` */
    Names *parameter_names;
    LIST(Thing) parameters; /* definitions, by number in `parameter_names`, in order of making */
    Names *terminals;
    NumberList terminal_nodes;
    LIST(Instance *) parts;
    NumberList couplings; /* of parts, among these */
    NumberList edge_owner;
    LIST(Definition) definitions;
    NumberList outputs; /* definitions, in order of making */
    NumberList events;
    LIST(Line) lines;
    Choice choices[TREE_KINDS];
    LIST(StartEntry) starts;
    Names *start_names;  /* "h8'", with primes */
    NumberList start_of; /* by number in start_names: index in `starts`, or -1 */
    NameList independent;
    LIST(Use) uses;
    LIST(InsideChoice) inside_choices;
    int inside;   /* the use whose statements are being applied; -1 */
    bool is_open; /* statements may attach parts inside instances: a fork that examines them */
    bool has_named_laws; /* formulas call laws by name: a fork that prints them */
    Tree *trees[TREE_KINDS];
    bool has_trees;
    LIST(Change) changes;
    struct State *before; /* the state that this one replaced, unchanged since then; NULL */
    int number;           /* number of states that the model had before this one */
};

State *state_new(Arena *arena, Overrides *overrides, Apply *apply);
void state_free(State *state); /* including those before it; NULL is fine */
/* Carries out a statement by the function of its verb (model_apply.c): what a State is given. */
Apply verb_apply;
/* Applies a statement, or the text of one, by the state's function. */
Apply state_apply;
MUST_USE Status state_apply_text(State **state, const char *text, Diag *diag);
/* a copy in the state's pool */
const char *state_text(State *state, const char *text);
/* The meaning of a name where a part may be meant: a part precedes a parameter with its name; NULL:
 * none. */
const Thing *state_thing(const State *state, const char *name);
/* the meaning of a bare name in an expression: a parameter precedes a part with its name */
const Thing *state_value_thing(const State *state, const char *name);
const Instance *state_part(const State *state, const char *name);
/* the part whose name is the start of a dotted name, up to the first dot that ends a part's name;
 * *member is what follows the dot, or "". NULL: no part. */
const Instance *state_owner(const State *state, const char *path, const char **member);
void state_name(State *state, const char *name, ThingKind kind, int index, int coordinate);
void state_name_parameter(State *state, const char *name, int definition);
/* Replaces *state by another state, which owns the old one as `before`. */
void state_replace(State **state, State *next);
/* Call when the graph or a choice has changed. */
void state_forget_trees(State *state);
MUST_USE Status state_trees(State *state, const Tree *trees[TREE_KINDS], Diag *diag);
MUST_USE Status state_preset_trees(const State *state, bool absolute, Tree *out[2], Diag *diag);

/* --- undo (model_mark.c) --- */

/* A state before a statement. */
typedef struct StateMark {
    int state; /* its number */
    PoolMark pool;
    GraphMark graph;
    Setup setup;
    int names, terminals, parts, couplings, edge_owners, definitions, parameters, outputs, events,
        lines, start_names, uses, inside_choices, changes;
} StateMark;

StateMark state_mark(const State *state);
/* Restores *state at the mark; false, with nothing changed, if that is no longer stored. */
bool state_go_back(State **state, const StateMark *mark);
/* Frees the states before this one that exceed a limit; in bytes. */
void state_forget_before(State *state, size_t bytes);
/* Call before one is changed in place: */
void state_retain_line(State *state, int line);
void state_retain_definition(State *state, int definition);
void state_retain_choice(State *state, TreeKind kind);
void state_retain_independent(State *state);
void state_retain_values(State *state, int part, Value *values); /* their old values */
void state_retain_equations(State *state, int use);
/* index of the starts by name, from number `first` on (model_start.c) */
void starts_index(State *state, int first);
/* sets the index of the start of one name; -1: none */
void state_place_start(State *state, int name_index, int place);

/* --- names in a statement (model_names.c) --- */

/* The bare name that a syntax tree is, without primes and brackets. NULL: it is something else. */
const char *syntax_name(const Syntax *syntax);
/* whether `name` can be a new name; `taken_as` is its kind ("a parameter") */
MUST_USE Status name_is_free(const State *state, const char *name, Place place, Diag *diag);
/* the same for a new parameter, which may have the name of a part, unless that part is a value
 * too */
MUST_USE Status name_is_free_for_parameter(const State *state, const char *name, Place place,
                                           Diag *diag);
/* whether the bare name of the part is a variable in expressions, or easily could be */
bool part_is_value(const Instance *part);
/* whether a new part with known coordinates can have its name where a parameter has it */
MUST_USE Status part_can_share(const State *state, const Instance *part, Place place, Diag *diag);
/* the node of a terminal; makes one for a new name */
int state_terminal(State *state, const char *name, Domain domain);
Domain terminal_domain(const State *state, const char *name); /* of an existing terminal */
/* length of "run12." or "last." at the start; 0: none */
size_t run_prefix(const char *path);
/* units of variables of the whole model, and of entries that `show` prints; NULL: none or
 * unknown */
const char *whole_unit(const char *path);
const char *entry_unit(const char *name);
MUST_USE Status name_unknown(const State *state, const char *what, const char *name, Place place,
                             Diag *diag);
/* "a revolute", "a parameter": the kind of a name */
void name_describe(const State *state, const Thing *thing, Text *text);
/* the next name for suggestions: 0, 1, ...; NULL at the end */
const char *state_name_at(const State *state, int i);

/* permitted names in addition to parts' variables */
enum { ALLOW_MODEL = 1, ALLOW_RUNS = 2 };
/* f.lost, energy.lost: an integral over a run, which no equation can have */
bool variable_is_integral(const State *state, const char *name);
/* The variable's own name ("J1" may be written for "theta1"), without primes. `own` is a part under
 * construction, or NULL. */
MUST_USE Status variable_resolve(const State *state, const Instance *own, const char *path,
                                 int primes, unsigned allow, Place place, Text *name, Diag *diag);
/* a coordinate by its name or, where it has only one, its owner's */
MUST_USE Status coordinate_resolve(const State *state, const char *path, Place place, int *owner,
                                   int *coordinate, Diag *diag);

/* --- expressions (model_value.c) --- */

typedef enum ScopeKind {
    SCOPE_PARAMETER,
    SCOPE_LAW,
    SCOPE_NUMBER, /* a value of a part, over parameters */
    SCOPE_EFFORT, /* a value of a part, over all variables */
    SCOPE_DRIVE,
    SCOPE_START,
    SCOPE_OUTPUT,
    SCOPE_EVENT,
    SCOPE_ASK
} ScopeKind;

/* --- data of table() (model_data.c) --- */

/* Reads the files named by the calls in a syntax tree, each column as a table of the arena; `anew`:
 * also those already read. Fails at the file's name, or at the column's. */
MUST_USE Status data_read(const DataFinder *finder, Arena *arena, const Syntax *syntax, bool anew,
                          Diag *diag);
MUST_USE Status data_read_statement(const DataFinder *finder, Arena *arena,
                                    const Statement *statement, bool anew, Diag *diag);
/* the column argument of a call of table(); borrowed */
const char *data_column(const Syntax *call);

typedef struct Scope {
    const State *state;
    ScopeKind kind;
    const char *const *arguments; /* of a law */
    int argument_count;
    const Instance *own;        /* the part under construction */
    const EntryFinder *entries; /* NULL: none */
    NumberList uses;            /* definitions that were used */
} Scope;

MUST_USE Status scope_expression(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag);
/* in the state's pool, with room for at least three entries; a scalar is refused */
MUST_USE Status scope_vector(Scope *scope, const Syntax *syntax, Expr **out, int *count,
                             Diag *diag);
void scope_use(Scope *scope, int definition);
MUST_USE Status function_call(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                              Diag *diag);

/* --- dimensions (measure.c, measure_check.c) --- */

/* Of an expression whose names are known. Fails with E_UNIT at the operand or argument that does
 * not match. */
MUST_USE Status measure_of(const Scope *scope, const Syntax *syntax, Measure *out, Diag *diag);
/* of a unit's text, which must be valid; NULL: any */
Measure measure_of_unit(const char *unit);
/* of a member of a part, as in its table; NULL: it has none, or there is no such member */
const char *member_unit(const State *state, const Instance *part, const char *name);
/* the flexible part of a call for a deflection or section load, b1.v(x) (model_along.c); NULL: the
 * call is none */
const Instance *part_along(const State *state, const char *text, const char **member);
/* unit of a beam's quantity at a position, by the text before its bracket, "b1.v"; NULL: there is
 * no such quantity */
const char *place_unit(const State *state, const char *text);
/* whether `name`, b1.v(0.5) with or without primes, has one more derivative: points along a
 * flexible part have two, section loads none */
bool place_has_rate(const State *state, const char *name);
/* of a variable by its own name, without primes */
Measure variable_measure(const State *state, const Instance *own, const char *name);
bool measure_same(Measure a, Measure b);
bool measures_fit(Measure a, Measure b);
/* The common measure of two that are `what` ("added"), or E_UNIT at one of them. */
MUST_USE Status measures_join(Measure a, Measure b, const Syntax *left, const Syntax *right,
                              const char *what, Measure *out, Diag *diag);
bool measure_is_plain(Measure measure); /* no dimension, and no angle */
void measure_print(Text *text, Measure measure);
/* the hint where two measures don't match */
#define SI_HINT "a plain number is taken as SI"
void measure_hint(Measure a, Measure b, const char *otherwise, Diag *diag);

/* Checks a value, or each entry of a vector, against the unit required for `name`; NULL: any. A
 * value without units is in SI. */
MUST_USE Status unit_check(const Scope *scope, const Syntax *syntax, const char *unit,
                           const char *name, Diag *diag);
/* checks that entries that are `what` ("added") have the same dimension, whichever it is */
MUST_USE Status unit_check_alike(const Scope *scope, const Syntax *syntax, const char *what,
                                 Diag *diag);
/* checks two values that are compared */
MUST_USE Status unit_check_compared(const Scope *scope, const Syntax *left, const Syntax *right,
                                    Diag *diag);
/* checks an item, and the unit after it in which it is displayed */
MUST_USE Status unit_check_shown(const Scope *scope, const Syntax *item, Diag *diag);

/* --- values of parts (model_param.c) --- */

typedef struct Wanted {
    const Param *param;
    bool on_angle;
} Wanted;

MUST_USE Status param_read(Scope *scope, Wanted wanted, const Syntax *syntax, Value *out,
                           Diag *diag);
/* Checks the value just read against the others of its row that are ALIKE. */
MUST_USE Status param_check_alike(const Component *row, const Value *values, int index,
                                  const Syntax *syntax, Diag *diag);
void param_fallback(State *state, const Param *param, Value *out);

/* --- are they valid numbers (model_check.c) --- */

/* Refuses invalid numbers for values of the part, with the current values of parameters; valid but
 * unlikely ones get a remark. */
MUST_USE Status part_check(State *state, const Instance *part, Text *remarks, Diag *diag);
/* the same for all parts that depend on a new value of the definition */
MUST_USE Status parts_check_after(State *state, int definition, Text *remarks, Diag *diag);

/* Refuses couplings that no parts can have, of the part or with it, whatever couplings follow
 * (model_coupled.c). O(n^3) for n parts coupled with each other. */
MUST_USE Status coupled_check(State *state, const Instance *part, Text *remarks, Diag *diag);
/* checks all existing couplings */
MUST_USE Status couplings_check(State *state, Diag *diag);

MUST_USE Status key_unknown(const Component *row, const char *key, Place place, Diag *diag);
/* Checks that in a planar scene no shift or turn of a part leaves the plane. */
MUST_USE Status part_check_plane(const State *state, const Instance *part, Place place, Diag *diag);

/* Adds a definition and the line that makes it, as the last line. */
int definition_add(State *state, Definition d, const char *text, const Scope *scope);
Overrides *overrides_new(void);
void overrides_free(Overrides *overrides);                           /* NULL is fine */
const Override *override_find(const State *state, const char *name); /* NULL: there is none */
void overrides_add(Overrides *overrides, const char *name, double value, Measure measure);
void overrides_drop(Overrides *overrides, int count); /* all after the first `count` */
/* E_UNIT if the override of a parameter that is to have that measure has another dimension */
MUST_USE Status override_check(const State *state, const char *name, Measure measure, Diag *diag);
Definition *definition_find(const State *state, const char *name, DefinitionKind kind); /* NULL */
int definition_index(const State *state, const Definition *d);
/* --- definitions and lines --- */

double definition_value(State *state, int definition);
void definitions_forget_values(State *state); /* of parameters: they depend on each other */
/* value of an expression of parameters alone, with their current values */
double state_number(State *state, Expr body);
/* the same without changing the state: nothing is stored */
double state_number_now(const State *state, Expr body);
/* the number of an entry of a part's value, by its name from instance_lifted_constant() */
double state_lifted_constant(State *state, const char *name);
/* adds a last line, which receives the uses of the scope (NULL: none) */
int line_add(State *state, const char *text, int definition, int part, const Scope *scope);
void line_uses(State *state, Line *line, const Scope *scope);
/* Earlier lines of this part (or -1) and key are superseded. */
void line_supersede(State *state, int part, const char *key);
/* Numbers of the lines in effect, each after those it uses, outputs late where nothing needs them
 * earlier, events last; new, free with mem_free(). */
int *lines_in_order(const State *state, int *count);
/* A State from the old one's lines, without line `without` (-1: none). Trees, starts and form are
 * copied where their names still exist; a remark lists what was dropped. With `broken`, lines that
 * fail are left out, and the names that they would make are added there; otherwise the first
 * failure is returned. */
MUST_USE Status state_rebuild(const State *old, int without, State **out, NameList *broken,
                              Text *remarks, Diag *diag);
/* the same of all lines, with laws that formulas call by name */
MUST_USE Status state_rebuild_named(const State *old, State **out, Diag *diag);
/* (model_scene.c) outputs and instances of subsystems, of a scene that has none yet */
void state_list_scene(const State *state, Scene *scene);
/* (model_extract.c) see model_extract() */
MUST_USE Status state_extract(const State *old, const Extract *part, State **out,
                              ExtractedEnds *ends, Diag *diag);
/* the same, see model_isolate() */
MUST_USE Status state_isolate(const State *old, const char *name, State **out, ExtractedEnds *ends,
                              Diag *diag);
/* Applies each pair of a statement, all or none. */
typedef MUST_USE Status ApplyPair(State **state, const Pair *pair, Outcome *outcome, Diag *diag);
MUST_USE Status apply_pairs(State **state, const Statement *statement, ApplyPair *apply,
                            Outcome *outcome, Diag *diag);
void name_list_add(NameList *list, const char *name); /* unless it is in the list */
/* the statement's text with its full verb; new */
char *statement_full_text(const Statement *statement);
/* (model_store.c) see model_store() and model_definition_like() */
char *state_store(const State *state, const char *name);
const char *state_definition_like(const State *state, const Statement *s, bool *same);
void state_save(const State *state, Text *text);
void choices_save(const State *state, Text *text);
void choices_copy(State *to, const State *from, Text *remarks);
/* `tree` and `cotree` of a definition, for one of its instances */
Apply apply_tree_inside;
void starts_save(const State *state, Text *text);
/* Applies initial values and form again, since laws may have changed. Those of variables that no
 * longer exist are dropped with a remark. Those that fail are added to `broken`; if that is NULL,
 * it fails. */
MUST_USE Status starts_copy(State *to, const State *from, NameList *broken, Text *remarks,
                            Diag *diag);

/* Refuses a variable that follows from others, and so can't have an initial value; otherwise
 * returns its own name. Checks the unit of the value. */
MUST_USE Status initial_check(const Scope *scope, const Pair *pair, Text *name, Diag *diag);

/* --- subsystems (model_subsystem.c, model_use.c, model_reach.c, model_rename.c) --- */

const Use *state_use(const State *state, const char *name); /* NULL */
/* The innermost use that contains a dotted name; -1: none. */
int state_use_around(const State *state, const char *name);
bool name_is_inside(const char *name, const char *use);
const Subsystem *state_subsystem(const State *state, const char *name, int *definition); /* NULL */
int subsystem_port(const Subsystem *subsystem, const char *name);                        /* -1 */
/* Refuses a name inside an instance as a place to attach a part, unless it is a port of it. */
MUST_USE Status use_check_reach(const State *state, const char *name, Place place, Diag *diag);
/* Refuses "leg1.A" where the statement of leg1 binds its port A. */
MUST_USE Status use_check_bound(const State *state, const char *name, Place place, Diag *diag);
/* the line that a rebuilt state has instead of this one: that of the outermost use */
int line_root(const State *state, int line);

/* Starts the trial of a definition's statements: makes an instance with the definition's name,
 * whose ports are bound where they occur; *use is its number. */
MUST_USE Status subsystem_begin(State *state, const Statement *statement, int *use, Diag *diag);
/* Applies a statement of a definition to its instance. */
MUST_USE Status use_apply(State **state, int use, const Statement *statement, Outcome *outcome,
                          Diag *diag);
/* The same for all of them; diag->inside shows the line that fails. */
MUST_USE Status use_apply_body(State **state, int use, const Body *body, Outcome *outcome,
                               Diag *diag);
/* Frees ports of a trial whose nodes were removed with a statement that failed. */
void subsystem_forget_places(State *state, int use);
/* Refuses ports that nothing inside uses. */
MUST_USE Status subsystem_check_ports(const State *state, int use, Place place, Diag *diag);

/* `unknown`, `internal` or `give` */
bool verb_gives(const Statement *statement);
/* The replacement for an effort at a port where equations are given: ".fx" of a frame, "_source.i"
 * of a terminal; `rest` follows the port's name. NULL: it is no effort. */
const char *given_effort(const Port *port, const char *rest);
/* Equations instead of parts (model_given.c). Finds the unknowns that move frames in a definition's
 * statements, before these are applied. */
void given_begin(State *state, int use, const Body *body);
/* Refuses parts in addition to equations. */
MUST_USE Status given_allows(State *state, int use, const Statement *s, Diag *diag);
/* Adds one of those, in the instance's names; `from` is the original statement. */
MUST_USE Status given_add(State *state, int use, const Statement *renamed, const Statement *from,
                          Diag *diag);
/* After all lines are read (model_given_end.c): checks them, and sets the values of the parts made
 * for them. *at_use: the fault is in the instance's binding, not in a line. */
MUST_USE Status given_end(State *state, int use, bool *at_use, Diag *diag);

/* A definition that is being read (model_opened.c). */
typedef struct Opened Opened;
MUST_USE Status opened_begin(const State *state, const Statement *statement, Opened **out,
                             Diag *diag); /* new */
void opened_free(Opened *opened);         /* NULL is fine */
const char *opened_name(const Opened *opened);
MUST_USE Status opened_add(Opened *opened, const Statement *statement, Diag *diag);
/* The complete definition as one statement, borrowed from `opened`; `place` is the position of its
 * end. */
MUST_USE Status opened_end(Opened *opened, Place place, const Statement **out, Diag *diag);

/* A definition's statement in the names of an instance, in `pool`. */
MUST_USE Status statement_rename(State *state, int use, const Statement *statement, Pool *pool,
                                 Statement *out, Diag *diag);
/* Refuses a new value of a parameter with another dimension. */
MUST_USE Status parameter_check_alike(const Scope *scope, const char *name, Measure measure,
                                      const Syntax *value, Diag *diag);
/* A plain number that replaces a quantity is in the quantity's SI unit. */
void parameter_measure_like(State *state, const char *name, Measure measure);
/* set leg1.L1 = 0.5 */
MUST_USE Status set_inside_parameter(State *state, const Pair *pair, Outcome *outcome, Diag *diag);

/* --- settings (model_settings.c) --- */

/* value of one of model_settings.def, as text */
void setting_text(const State *state, ModelSetting setting, Text *out);
/* set NAME VALUE, or NAME = VALUE */
MUST_USE Status setting_apply(State *state, ModelSetting setting, const Statement *statement,
                              Outcome *outcome, Diag *diag);

/* --- one function for each verb --- */

Apply apply_parameter, apply_law, apply_component;
#define MODEL_VERB(word, ...) Apply apply_##word;
#include "language/verbs.def"

#endif

/* model_impl.h: what the files of the model share
 *
 * A State is everything that accepted statements made; it can be built anew from its
 * lines at any time, which is how names are deleted and laws replaced. A statement is
 * read and checked in full before it changes its State, or it builds another State and
 * puts that in place, so that a failure leaves nothing behind. What it adds goes to the
 * ends of the lists, and what it changes in place is noted: that is the way back.
 * Strings and parts live in the State's pool, expressions in the model's arena. */
#ifndef COTREE_MODEL_MODEL_IMPL_H
#define COTREE_MODEL_MODEL_IMPL_H

#include "base/names.h"
#include "model/measure.h"
#include "model/model.h"

typedef LIST(const char *) NameList;
typedef LIST(int) NumberList;

/* --- names --- */

typedef enum ThingKind { THING_PART, THING_COORDINATE, THING_DEFINITION, THING_USE } ThingKind;

typedef struct Thing { /* what a name of State.names stands for, by its number there */
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

/* what a definition's own `tree` chose, in one of its instances */
typedef struct InsideChoice {
    int use;
    int kind; /* of tree */
    bool excluded;
    const char *name;
} InsideChoice;

typedef struct Definition {
    DefinitionKind kind;
    const char *name;
    Expr symbol;          /* of a parameter */
    Expr body;            /* of a law: over its arguments */
    const Syntax *syntax; /* of a law: its text, in the state's pool */
    Measure measure;      /* of a parameter or output */
    Expr *arguments;
    int argument_count;
    const Event *event; /* of an event; in the state's pool */
    const Subsystem *subsystem;
    int line;
    bool is_known; /* parameter: `value` is that of its body */
    double value;
} Definition;

/* --- the script that rebuilds the state --- */

typedef struct Line {
    const char *text;
    int definition;  /* that it makes; -1 */
    int part;        /* that it makes or sets; -1 */
    const char *key; /* a later line of the same part and key supersedes it; NULL */
    int *uses;       /* definitions that it needs */
    int use_count;
    int use;      /* that it makes; -1 */
    int inside;   /* the use that made it: it comes with that one's line; -1 */
    bool is_gone; /* superseded by a later line */
} Line;

typedef struct StartEntry {
    Start start;
    const char *text; /* "h8' = 12" */
    int name;         /* in State.start_names */
    int group;        /* the statement that gave it: those of one are saved on one line */
} StartEntry;

typedef struct Choice { /* of one tree */
    bool absolute;      /* bodies before joints */
    NameList chosen;
    NameList excluded;
} Choice;

/* by setting: which of its values, from 0 */
typedef struct SettingValues {
    int at[MODEL_SETTINGS];
} SettingValues;

/* What a State is besides its lists. */
typedef struct Setup {
    bool planar;
    Expr gravity[3];
    const char *title;
    int datum[DOMAIN_COUNT];
    int group_count;
    Form form;
    SettingValues settings;
} Setup;

/* --- what was changed in place, as it was before (model_mark.c) --- */

typedef enum ChangeKind {
    CHANGED_LINE,
    CHANGED_DEFINITION,
    CHANGED_VALUES, /* of a part */
    CHANGED_CHOICE, /* of a tree */
    CHANGED_INDEPENDENT,
    CHANGED_SETUP,
    ADDED_START,
    REMOVED_START
} ChangeKind;

typedef struct Change {
    ChangeKind kind;
    int at; /* which line, definition, part, tree, start */
    union {
        Line line;
        Definition definition;
        Value *values;
        Choice *choice; /* given, as are the two below */
        NameList *independent;
        Setup *setup;
        StartEntry start;
    } was;
} Change;

typedef struct State {
    Arena *arena; /* the model's */
    Pool *pool;
    bool planar;
    Expr gravity[3];
    const char *title;
    Graph *graph;
    Names *names;       /* of all but parameters: a part may have a parameter's name */
    LIST(Thing) things; /* by number in `names` */
    Names *parameter_names;
    LIST(Thing) parameters; /* definitions, by number in `parameter_names`, in order of making */
    Names *terminals;
    NumberList terminal_nodes;
    int datum[DOMAIN_COUNT]; /* nodes; -1 until needed */
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
    NumberList start_of; /* by number in start_names: its place in `starts`, or -1 */
    int group_count;
    Form form;
    SettingValues settings;
    NameList independent;
    LIST(Use) uses;
    LIST(InsideChoice) inside_choices;
    int inside;   /* the use whose statements are being applied; -1 */
    bool is_open; /* what comes may attach inside instances: a fork that is looked into */
    Tree *trees[TREE_KINDS];
    bool has_trees;
    LIST(Change) changes;
    struct State *before; /* the one that this took the place of, as it was then; NULL */
    int number;           /* how many the model had before this one */
} State;

/* what a statement changed, from little to much */
typedef enum Effect { EFFECT_NONE, EFFECT_VALUES, EFFECT_EQUATIONS } Effect;

typedef struct Outcome {
    Effect effect;
    Text remarks;
} Outcome;

/* Apply a statement to *state, or put another State in its place. */
typedef MUST_USE Status Apply(State **state, const Statement *statement, Outcome *outcome,
                              Diag *diag);

State *state_new(Arena *arena);
void state_free(State *state); /* with those before it; NULL is fine */
Apply state_apply;
/* a copy in the state's pool */
const char *state_text(State *state, const char *text);
/* What a name stands for where a part may: a part before a parameter of its name; NULL: nothing. */
const Thing *state_thing(const State *state, const char *name);
/* what the bare name stands for in an expression: the parameter before a part of its name */
const Thing *state_value_thing(const State *state, const char *name);
const Instance *state_part(const State *state, const char *name);
/* the part that a dotted name begins with, the first dot that ends one counting; what stands behind
 * the dot, or "", in *member. NULL: no part. */
const Instance *state_owner(const State *state, const char *path, const char **member);
void state_name(State *state, const char *name, ThingKind kind, int index, int coordinate);
void state_name_parameter(State *state, const char *name, int definition);
/* Put another state in the place of *state, which stays before it. */
void state_replace(State **state, State *next);
/* The graph or a choice changed. */
void state_forget_trees(State *state);
MUST_USE Status state_trees(State *state, const Tree *trees[TREE_KINDS], Diag *diag);
MUST_USE Status state_preset_trees(const State *state, bool absolute, Tree *out[2], Diag *diag);

/* --- the way back (model_mark.c) --- */

/* A state as a statement found it. */
typedef struct StateMark {
    int state; /* its number */
    PoolMark pool;
    GraphMark graph;
    int names, terminals, parts, couplings, edge_owners, definitions, parameters, outputs, events,
        lines, start_names, uses, inside_choices, changes;
} StateMark;

StateMark state_mark(const State *state);
/* Back to what *state was at the mark; false, with nothing changed, where that is too long ago. */
bool state_go_back(State **state, const StateMark *mark);
/* Let go of the states before that are more than a session should hold; a bound in bytes. */
void state_forget_before(State *state, size_t bytes);
Setup state_setup(const State *state);
/* Note what a statement changed of the setup. */
void state_note_setup(State *state, const Setup *before);
/* Before one is changed in place: */
void state_retain_line(State *state, int line);
void state_retain_definition(State *state, int definition);
void state_retain_choice(State *state, TreeKind kind);
void state_retain_independent(State *state);
void state_retain_values(State *state, int part, Value *values); /* as they were */
/* where the starts stand, from the one at `first` on (model_start.c) */
void starts_index(State *state, int first);
/* and where one of that name does; -1: nowhere */
void state_place_start(State *state, int name, int place);

/* --- names in a statement (model_names.c) --- */

/* The bare name that a syntax tree is, without primes; brackets around it are taken off. NULL: it
 * is something else. */
const char *syntax_name(const Syntax *syntax);
/* whether `name` can become a new name; `taken_as` is what it would be ("a parameter") */
MUST_USE Status name_is_free(const State *state, const char *name, Place place, Diag *diag);
/* the same of a new parameter, which may have the name of a part: unless that is a value, too */
MUST_USE Status name_is_free_for_parameter(const State *state, const char *name, Place place,
                                           Diag *diag);
/* whether expressions take the bare name of the part for a variable, or easily could */
bool part_is_value(const Instance *part);
/* whether a new part, its coordinates known, can have its name where a parameter has it */
MUST_USE Status part_can_share(const State *state, const Instance *part, Place place, Diag *diag);
/* the node of a terminal; of a new name, a new one */
int state_terminal(State *state, const char *name, Domain domain);
Domain terminal_domain(const State *state, const char *name); /* of one that there is */
/* length of "run12." or "last." at the start; 0: none */
size_t run_prefix(const char *path);
/* units of variables of the model as a whole, of entries of what is shown; NULL: none or unknown */
const char *whole_unit(const char *path);
const char *entry_unit(const char *name);
MUST_USE Status name_unknown(const State *state, const char *what, const char *name, Place place,
                             Diag *diag);
/* "a revolute", "a parameter": what a name is */
void name_describe(const State *state, const Thing *thing, Text *text);
/* the next name that matters for suggestions: 0, 1, ...; NULL at the end */
const char *state_name_at(const State *state, int i);

/* what may be asked for besides parts' variables */
enum { ALLOW_MODEL = 1, ALLOW_RUNS = 2 };
/* The variable's own name ("J1" may stand for "theta1"), without primes. `own` is a part in the
 * making, or NULL. */
MUST_USE Status variable_resolve(const State *state, const Instance *own, const char *path,
                                 int primes, unsigned allow, Place place, Text *name, Diag *diag);
/* a coordinate by its name or, where it has only one, its owner's */
MUST_USE Status coordinate_resolve(const State *state, const char *path, Place place, int *owner,
                                   int *coordinate, Diag *diag);

/* --- expressions (model_value.c) --- */

typedef enum ScopeKind {
    SCOPE_PARAMETER,
    SCOPE_LAW,
    SCOPE_NUMBER, /* a value of a part, of parameters */
    SCOPE_EFFORT, /* a value of a part, of everything */
    SCOPE_DRIVE,
    SCOPE_START,
    SCOPE_OUTPUT,
    SCOPE_EVENT,
    SCOPE_ASK
} ScopeKind;

/* --- data of table() (model_data.c) --- */

/* Read the files that the calls below a syntax tree name, each column a table of the arena; `anew`:
 * also those that are there. Fails at the file's name, or at the column's. */
MUST_USE Status data_read(const DataFinder *finder, Arena *arena, const Syntax *syntax, bool anew,
                          Diag *diag);
MUST_USE Status data_read_statement(const DataFinder *finder, Arena *arena,
                                    const Statement *statement, bool anew, Diag *diag);
/* the column that a call of table() asks for; borrowed */
const char *data_column(const Syntax *call);

typedef struct Scope {
    const State *state;
    ScopeKind kind;
    const char *const *arguments; /* of a law */
    int argument_count;
    const Instance *own;        /* the part in the making */
    const EntryFinder *entries; /* NULL: none */
    NumberList uses;            /* definitions met */
} Scope;

MUST_USE Status scope_expression(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag);
/* in the state's pool, with room for three at the least; a scalar is refused */
MUST_USE Status scope_vector(Scope *scope, const Syntax *syntax, Expr **out, int *count,
                             Diag *diag);
void scope_use(Scope *scope, int definition);
MUST_USE Status function_call(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                              Diag *diag);

/* --- dimensions (measure.c, measure_check.c) --- */

/* Of an expression whose names are known. Fails with E_UNIT at the operand or argument that can't
 * stand where it does. */
MUST_USE Status measure_of(const Scope *scope, const Syntax *syntax, Measure *out, Diag *diag);
/* of a text's unit, which is known to be well written; NULL: any */
Measure measure_of_unit(const char *unit);
/* of a member of a part, as it stands there; NULL: it has none, or there is no such member */
const char *member_unit(const State *state, const Instance *part, const char *name);
/* of what a beam tells at a place along it, by the text before its bracket, "b1.v"; NULL: it
 * tells no such thing */
const char *place_unit(const State *state, const char *text);
/* whether `name`, b1.v(0.5) with or without primes, has one derivative more: of points along a part
 * that deforms, twice; of what its sections carry, none */
bool place_has_rate(const State *state, const char *name);
/* of a variable by its own name, without primes */
Measure variable_measure(const State *state, const Instance *own, const char *name);
bool measure_same(Measure a, Measure b);
bool measures_fit(Measure a, Measure b);
/* Two that are `what` ("added"): their measure, or E_UNIT at one of them. */
MUST_USE Status measures_join(Measure a, Measure b, const Syntax *left, const Syntax *right,
                              const char *what, Measure *out, Diag *diag);
bool measure_is_plain(Measure measure); /* no dimension, not even an angle */
void measure_print(Text *text, Measure measure);
/* the way out where these two don't fit */
#define SI_HINT "a plain number is taken as SI"
void measure_hint(Measure a, Measure b, const char *otherwise, Diag *diag);

/* A value, or each entry of a vector, against the unit that `name` wants; NULL: any. What was
 * written without units is in SI. */
MUST_USE Status unit_check(const Scope *scope, const Syntax *syntax, const char *unit,
                           const char *name, Diag *diag);
/* entries that are `what` ("added"), which have one dimension, whichever */
MUST_USE Status unit_check_alike(const Scope *scope, const Syntax *syntax, const char *what,
                                 Diag *diag);
/* two values that are compared */
MUST_USE Status unit_check_compared(const Scope *scope, const Syntax *left, const Syntax *right,
                                    Diag *diag);
/* an item, and the unit behind it that it is to be shown in */
MUST_USE Status unit_check_shown(const Scope *scope, const Syntax *item, Diag *diag);

/* --- values of parts (model_param.c) --- */

typedef struct Wanted {
    const Param *param;
    bool on_angle;
} Wanted;

MUST_USE Status param_read(Scope *scope, Wanted wanted, const Syntax *syntax, Value *out,
                           Diag *diag);
/* The value that was just read from there against the others of its row that are ALIKE. */
MUST_USE Status param_check_alike(const Component *row, const Value *values, int index,
                                  const Syntax *syntax, Diag *diag);
void param_fallback(State *state, const Param *param, Value *out);

/* --- whether they make sense (model_check.c) --- */

/* Refuse numbers that values of the part can't be, those of parameters as they are now; what is
 * legal and unlikely is remarked. */
MUST_USE Status part_check(State *state, const Instance *part, Text *remarks, Diag *diag);
/* the same for all parts that a new value of the definition reaches */
MUST_USE Status parts_check_after(State *state, int definition, Text *remarks, Diag *diag);

/* Refuse couplings that no parts could have, of the part or with it, whatever couplings are still
 * to come (model_coupled.c). O(n^3) for n parts coupled with each other. */
MUST_USE Status coupled_check(State *state, const Instance *part, Text *remarks, Diag *diag);
/* and all that there are, as they are */
MUST_USE Status couplings_check(State *state, Diag *diag);

MUST_USE Status key_unknown(const Component *row, const char *key, Place place, Diag *diag);
/* In a planar scene no step of a part leaves the plane. */
MUST_USE Status part_check_plane(const State *state, const Instance *part, Place place, Diag *diag);

/* A new definition by the last line, which it makes. */
int definition_add(State *state, Definition d, const char *text, const Scope *scope);
Definition *definition_find(const State *state, const char *name, DefinitionKind kind); /* NULL */
int definition_index(const State *state, const Definition *d);
/* --- definitions and lines --- */

double definition_value(State *state, int definition);
void definitions_forget_values(State *state); /* of parameters: they follow from one another */
/* an expression of parameters alone, as they are now */
double state_number(State *state, Expr body);
/* the same where the state stays as it is: nothing is kept */
double state_number_now(const State *state, Expr body);
/* the number that stands in a part's value, by the name that instance_literal() gave it */
double state_literal(State *state, const char *name);
/* a new last line; takes over the uses of the scope (NULL: none) */
int line_add(State *state, const char *text, int definition, int part, const Scope *scope);
void line_uses(State *state, Line *line, const Scope *scope);
/* Earlier lines of this part (or -1) and key no longer count. */
void line_supersede(State *state, int part, const char *key);
/* Numbers of the lines that count, what they use before them, outputs late where nothing needs
 * them earlier, events behind all; new, free with mem_free(). */
int *lines_in_order(const State *state, int *count);
/* A State from the old one's lines, without line `without` (-1: none); trees, starts and form are
 * taken over where their names live on, and what fell away is remarked. With `broken`, lines that
 * fail are left out and what they make is named there; without, the first failure is returned. */
MUST_USE Status state_rebuild(const State *old, int without, State **out, NameList *broken,
                              Text *remarks, Diag *diag);
/* Apply the text of one statement. */
MUST_USE Status state_apply_text(State **state, const char *text, Text *remarks, Diag *diag);
/* Apply each pair of a statement, all or none. */
typedef MUST_USE Status ApplyPair(State **state, const Pair *pair, Outcome *outcome, Diag *diag);
MUST_USE Status apply_pairs(State **state, const Statement *statement, ApplyPair *apply,
                            Outcome *outcome, Diag *diag);
void name_list_add(NameList *list, const char *name); /* once */
/* the statement's text with its verb in full; new */
char *statement_full_text(const Statement *statement);
/* (model_store.c) as model_store() and model_definition_like() */
char *state_store(const State *state, const char *name);
const char *state_definition_like(const State *state, const Statement *s, bool *same);
void state_save(const State *state, Text *text);
void choices_save(const State *state, Text *text);
void choices_copy(State *to, const State *from, Text *remarks);
/* `tree` and `cotree` of a definition, for one of its instances */
Apply apply_tree_inside;
void starts_save(const State *state, Text *text);
/* Initial values and form are applied anew, since laws may have changed: those of variables that
 * are gone fall away with a remark; those that fail are in `broken`, or NULL: fail. */
MUST_USE Status starts_copy(State *to, const State *from, NameList *broken, Text *remarks,
                            Diag *diag);

/* Refuses a variable that follows from the rest, and so can't be given a value; its own name. A
 * value's unit is checked. */
MUST_USE Status initial_check(const Scope *scope, const Pair *pair, Text *name, Diag *diag);

/* --- subsystems (model_subsystem.c, model_use.c, model_rename.c) --- */

const Use *state_use(const State *state, const char *name); /* NULL */
/* The innermost use that a dotted name lies in; -1: none. */
int state_use_around(const State *state, const char *name);
bool name_is_inside(const char *name, const char *use);
const Subsystem *state_subsystem(const State *state, const char *name, int *definition); /* NULL */
int subsystem_port(const Subsystem *subsystem, const char *name);                        /* -1 */
/* Refuse a name inside an instance where something is to be attached, unless it is a port of it. */
MUST_USE Status use_check_reach(const State *state, const char *name, Place place, Diag *diag);
/* Refuse "leg1.A" where leg1 is told what its port A is. */
MUST_USE Status use_check_bound(const State *state, const char *name, Place place, Diag *diag);
/* the line that a rebuilt state has in the place of this one: that of the outermost use */
int line_root(const State *state, int line);

/* Begin what a definition's statements are tried on: an instance of its own name, whose ports are
 * bound where they are met; *use is its number. */
MUST_USE Status subsystem_begin(State *state, const Statement *statement, int *use, Diag *diag);
/* Apply a statement of a definition to its instance. */
MUST_USE Status use_apply(State **state, int use, const Statement *statement, Outcome *outcome,
                          Diag *diag);
/* The same of a body's lines; of one that fails diag->inside shows it. */
MUST_USE Status use_apply_lines(State **state, int use, const char *body, Outcome *outcome,
                                Diag *diag);
/* Ports of a trial whose places were taken back with a statement that failed are free again. */
void subsystem_forget_places(State *state, int use);
/* Refuse ports that nothing inside knows. */
MUST_USE Status subsystem_check_ports(const State *state, int use, Place place, Diag *diag);

/* `unknown`, `internal` or `give` */
bool verb_gives(const Statement *statement);
/* What stands for an effort at a port where equations are given: ".fx" of a frame, "_source.i" of a
 * terminal; `rest` is what follows the port's name. NULL: it is no effort. */
const char *given_effort(const Port *port, const char *rest);
/* Equations in the place of parts (model_given.c). Of a definition's lines, before they are
 * applied: which unknowns move frames. */
void given_begin(State *state, int use, const char *body);
/* Refuse parts beside equations. */
MUST_USE Status given_allows(State *state, int use, const Statement *s, Diag *diag);
/* One of those, in the instance's names; `from` is as it was written. */
MUST_USE Status given_add(State *state, int use, const Statement *renamed, const Statement *from,
                          Diag *diag);
/* All lines are there (model_given_end.c): check them, and tell the values of the parts made for
 * them. *at_use: what is wrong stands where the instance is bound, not in a line. */
MUST_USE Status given_end(State *state, int use, bool *at_use, Diag *diag);

/* A definition that is being read (model_opened.c). */
typedef struct Opened Opened;
MUST_USE Status opened_begin(const State *state, const Statement *statement, Opened **out,
                             Diag *diag); /* new */
void opened_free(Opened *opened);         /* NULL is fine */
const char *opened_name(const Opened *opened);
MUST_USE Status opened_add(Opened *opened, const Statement *statement, Diag *diag);
/* The whole as one statement, new; `place` is that of its end. */
MUST_USE Status opened_end(const Opened *opened, Place place, Statement **out, Diag *diag);

/* A definition's statement in the names of an instance: new lists, trees in `pool`. */
MUST_USE Status statement_rename(State *state, int use, const Statement *statement, Pool *pool,
                                 Statement *out, Diag *diag);
/* Refuse another value of a parameter that has another dimension. */
MUST_USE Status parameter_check_alike(const Scope *scope, const char *name, Measure measure,
                                      const Syntax *value, Diag *diag);
/* A plain number that took the place of a quantity is in the SI unit of that. */
void parameter_measure_like(State *state, const char *name, Measure measure);
/* set leg1.L1 = 0.5 */
MUST_USE Status set_inside_parameter(State *state, const Pair *pair, Outcome *outcome, Diag *diag);

/* of one of model_settings.def, as it is set (model_scene.c) */
void setting_text(const State *state, ModelSetting setting, Text *out);

/* --- one function a verb --- */

Apply apply_parameter, apply_law, apply_component;
#define MODEL_VERB(word, ...) Apply apply_##word;
#include "language/verbs.def"

#endif

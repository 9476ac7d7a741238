/* code.h: a model as functions of numbers, before they are written in a language
 *
 *     p   parameters, then what follows from them alone
 *     y   coordinates q, speeds u, network states x, references of angles of full turns
 *     s   the solution: x', algebraic unknowns z, u', lambda
 *
 * Every function has the arguments (p, t, y, s) and returns one array. All of them are lowered
 * together, once, like a Program (compile/lower.h): so they compute the same numbers as a run.
 *
 * Live code handles events by itself. The parameters are followed by the signs of the event
 * functions at which equations jump, so that the equations are smooth between events; while a
 * motion slides along such a surface its sign is between the two. s is followed by a direction (dt,
 * dy, ds, dp, dsigns), along which functions `tangent_...` are derivatives: `tangent_p_...` by
 * parameters and signs of surfaces that may be slid along, the others by the rest. */
#ifndef COTREE_EXPORT_CODE_H
#define COTREE_EXPORT_CODE_H

#include "compile/lower.h"
#include "export/write.h"
#include "simulate/equations/variable_index.h"

typedef enum CodeArray { CODE_P, CODE_T, CODE_Y, CODE_S } CodeArray;

typedef struct CodeInput { /* a symbol whose number is an argument of functions */
    const char *name;      /* identifier, the same in all languages; NULL for t */
    CodeArray array;
    int place; /* in it */
} CodeInput;

typedef struct CodeFunction {
    const char *name; /* without the prefix */
    const char *what; /* meaning of the result */
    int first;        /* of its entries among the roots, row by row */
    int rows, columns;
    bool is_matrix; /* also of one column */
} CodeFunction;

/* unknowns of s that are solved for together: rows of [A | b], A step = b */
typedef struct CodeGroup {
    int first, count; /* in s */
    int function;
    bool iterates; /* Newton: the step is added to s; else it is s */
} CodeGroup;

/* event functions, at whose zeros something jumps or has a kink; first those that are linear in t
 * alone (code_live.c) */
typedef struct CodeSide {
    Surface surface; /* its sign is a parameter */
    Expr call;       /* that jumps or bends there */
    bool is_timed;
    bool is_floor; /* timed, and jumps at each whole number of its phase */
    bool is_jump;  /* of the equations, in the state: the motion may slide along it, */
    Expr slip;     /* as long as this is 0: h, or h', which its sign affects; NULL: it doesn't */
    Expr off;      /* what else is 0 then */
} CodeSide;

typedef struct CodeEvent {
    const Event *event;
    int first; /* of its values, among those of all events */
} CodeEvent;

/* a variable that an event sets */
typedef enum CodeLevel { CODE_COORDINATE, CODE_SPEED, CODE_STATE } CodeLevel;
/* positions that may be held when events set others (formulate/system_build/held_coordinates.h) */
typedef enum CodeHeldKind { CODE_GIVEN, CODE_JOINT, CODE_BODY, CODE_FRAME } CodeHeldKind;
typedef struct CodeTarget {
    CodeLevel level;
    int place; /* of a state that it is itself, in y; -1 */
    CodeHeldKind held_kind;
    int node;     /* of a position: the frame whose it is; -1 */
    int attitude; /* that it is an Euler parameter of; -1 */
    int rate;     /* of a position: the target that is its rate; -1 */
    int turning;  /* of a given attitude: a component of its angular velocity; -1 */
    const char *name;
} CodeTarget;

typedef struct CodeLive {
    bool is_wanted;
    LIST(CodeSide) sides;
    int timed;
    int first;        /* of the signs, in p */
    LIST(int) slides; /* sides with a slip */
    LIST(CodeEvent) events;
    LIST(CodeTarget) targets;
    int given;         /* count of given ones, first; others: held, or rates */
    LIST(int) samples; /* states that are sampled */
    LIST(int) held;    /* states that an importer sets: inputs */
    Expr *seeds; /* the direction: 1 + ny + ns symbols, then one a model parameter, one a slide */
    int seed_count;
    int tangents[2][4]; /* functions: of each group, or of what modes have in its place; by p */
    bool *depends;      /* by model parameter: it follows from others */
} CodeLive;

/* an ideal switch, whose side is a parameter (code_modes.c) */
typedef struct CodeIdeal {
    int place; /* among the switches of the system */
    IdealSwitch ideal;
    Expr closed; /* parameter: 1 or 0 */
} CodeIdeal;

typedef struct CodeModes {
    LIST(CodeIdeal) ideals;
    LIST(int) gives;  /* each edge's through, then across variable is an impulse of a source */
    int first;        /* of their sides, in p */
    int group;        /* of unknowns that they are among */
    int functions[2]; /* its rows' rates; what closed or open ones share */
    double *rows;     /* of that group, in the mode at the start; count x count */
} CodeModes;

/* a state and what follows from it here */
typedef struct CodeState {
    double t;
    double *y, *s;
    double *sums; /* at code_off(y): of each function's entries, entry i times 1 + i mod 7, */
    double *size; /* and of their magnitudes, or more where rounding leaves more of them */
} CodeState;

/* the motion of drivers as inputs (code_inverse.c) */
enum { MOTIONS = 3 }; /* what a driver prescribes, its rate, its second rate */
typedef struct InverseMotion {
    Expr symbol[MOTIONS]; /* parameters of no model */
    Expr law[MOTIONS];    /* what they were, in t */
} InverseMotion;

struct Inverse {
    Arena *arena;
    System *system;              /* in which laws follow them */
    Expr now;                    /* parameter: the instant at which they do */
    LIST(InverseMotion) motions; /* one a driver */
};

typedef struct Code {
    const View *view;
    const Inverse *inverse; /* NULL: none; borrowed */
    bool is_direct;         /* the motion of drivers is the state: */
    LIST(int) direct;       /* one a driver: its coordinate */
    Arena *arena;
    VariableIndex *layout;
    int ny, ns;
    LIST(Expr) parameters; /* symbols, of the model first */
    LIST(CodeInput) inputs;
    LIST(Expr) roots;
    LIST(CodeFunction) functions;
    CodeGroup groups[2];
    int group_count;
    bool is_explicit;     /* u', and lambda, are written out: function `accelerations` */
    bool is_redundant;    /* constraints repeat each other */
    bool is_augmented;    /* the embedded form was asked for, and is too long to be written out */
    LIST(char *) outputs; /* the requested items, as text */
    LIST(char *) conditions;
    CodeLive live;
    CodeModes modes;
    Lowered lowered;
    int *derived; /* one a value: its place in p; -1 */
    int derived_count;
    const double *values; /* of parameters, then the start: borrowed from CodeStart */
    LIST(CodeState) states;
    double loss[2]; /* of u' and lambda: what rounding leaves of them, in the unit of sizes */
    Pool *texts;
} Code;

/* New; code_free(). Fails if a formula needs a value that is no argument of functions. */
MUST_USE Status code_new(const Exported *what, bool is_live, Code **out, Diag *diag);
/* the same for an Exported that is all 0 (except for `live`), but only formulas: not lowered,
 * without numbers */
MUST_USE Status code_form(const Exported *what, Code *code, Diag *diag);
void code_free(Code *code); /* NULL is fine */
/* what is 0 where s is the solution: ns rows, of networks, motion, constraints */
void code_residual(const Code *code, Expr *rows);
/* The start's values; the start as a state, where equations have a solution there, and up to `most`
 * states at random about it, on the constraints, with numbers from here (code_states.c). */
enum { CODE_STATES = 20 };
MUST_USE Status code_add_states(Code *code, const Exported *what, int most, Diag *diag);

/* of code with an inverse */
void code_find_direct(Code *code);
void code_write_now(Code *code);

/* --- functions (code_function.c) --- */

/* The last one from now on: its number. */
int code_add_function(Code *code, const char *name, const char *what, const Expr *entries, int rows,
                      int columns);
/* A user's formula in the arguments of functions; `name` is for messages. */
MUST_USE Status code_resolve(Code *code, Expr user, Expr *out, const char *name, Diag *diag);

/* --- live code (code_live.c) --- */

/* What jumps in the roots and in the model's events, and what happens there; then the roots are on
 * signs. */
MUST_USE Status code_live_events(Code *code, Diag *diag);
/* Sampled states, and functions `periods` and `samples`: their next values. */
MUST_USE Status code_add_samples(Code *code, Diag *diag);
/* a step sets sampled states at whole multiples of their periods */
static inline bool code_is_sampled(const Code *code)
{
    return !code->live.is_wanted && code->live.samples.count > 0;
}
/* derivatives of functions along a direction; the last functions that there are */
void code_live_tangents(Code *code);
/* parameters that follow from others */
void code_live_relations(Code *code);
void code_live_free(CodeLive *live);

/* --- ideal switches (code_modes.c) --- */

/* Those of the system. Fails where its form has no row for one. */
MUST_USE Status code_find_modes(Code *code, Diag *diag);
bool code_has_modes(const Code *code);
/* residuals of networks with a side each */
void code_sided_rows(const Code *code, Expr *rows);
/* the functions by which residuals, networks first, are solved in any mode */
MUST_USE Status code_add_modes(Code *code, const Expr *rows, int count, Diag *diag);
/* what jumps or bends there because a diode has two sides */
bool code_is_side(const Code *code, Expr call);
/* margins of diodes: above 0 while closed, below while open; of switches 0 */
void code_margins(const Code *code, Expr *out);
/* their numbers in C */
void code_modes_begin(const Code *code, Text *out);
/* the rows of the mode at the start, from the values of all functions there */
void code_modes_store(Code *code, const double *roots);
/* E_MODEL, naming a part: a language without derivatives can't solve them. O(count^3). */
MUST_USE Status code_modes_check(const Code *code, const char *language, Diag *diag);
void code_modes_free(CodeModes *modes);
/* Rows [A | b] of residuals over unknowns of s from `first` on, as a function: its number. A is
 * their Jacobian, b what they lack. */
int code_newton_rows(Code *code, const Expr *residuals, int first, int count, const char *name,
                     const char *what);
/* the same of the first unknowns, which Newton's method solves for as a group */
void code_add_newton(Code *code, const Expr *residuals, int count, const char *name);

static inline double code_off(int i, double y)
{
    return y * (1 + (double)(i % 5 + 1) / 32);
}

/* what rounding of x', z, u' and lambda counts against: their largest numbers in all states, or
 * what the equations for them lose, if that is more */
enum { CODE_PARTS = 4 };
void code_sizes(const Code *code, double sizes[CODE_PARTS]);

/* --- a language (languages.c) --- */

struct Language;

/* a word of texts, $NAME, and what is written there */
typedef struct CodeWord {
    const char *name;
    void (*write)(const Code *code, const struct Language *language, Text *out);
} CodeWord;

/* a part of a file, and which files have it */
typedef enum CodeWhen {
    CODE_ALWAYS,
    CODE_WITH_TABLES,
    CODE_WITH_MODES,
    CODE_WITH_SAMPLES,
    CODE_WITH_REDUNDANCE,
    CODE_WITHOUT_REDUNDANCE
} CodeWhen;
typedef struct CodeText {
    const char *text;
    CodeWhen when;
} CodeText;

typedef struct Language {
    Notation notation;
    const char *array;            /* "%s[%d]" */
    const char *matrix;           /* of two indices; NULL: row by row in one */
    const char *local, *result;   /* a line that makes a name, one that sets an entry: "%s = %s" */
    const char *onward;           /* at the end of a line that is continued */
    const char *number, *rounded; /* around a literal; around what isn't of the type; NULL */
    const char *power[3];         /* text before, between and after base and exponent */
    void (*open)(Text *out, const Code *code, const CodeFunction *function, const char *locals);
    const char *close;
    const char *check;    /* the command for a file FILE that checks itself */
    bool differentiates;  /* constraints of states in a mode of ideal switches */
    const char *between;  /* places in a list */
    const char *truth[2]; /* no, yes */
    const char *ideal[2]; /* around the name of an ideal part; between two */
    /* a part of s by Newton's method: of a function, a place and a count; by linear equations: of
     * two places and a function; accelerations: of two places */
    const char *solve[3];
    const char *state, *sums; /* a case of a number; the sums of a function in it */
    const CodeWord *words;    /* of its own, which may replace those of all; last NULL */
    const CodeText *texts;    /* of the whole file; last NULL. Or: */
    void (*file)(const Code *code, const struct Language *language, Text *out);
    void (*wrap)(Text *out, size_t from); /* what was written from there on; NULL */
} Language;

extern const Language language_c, language_fortran, language_matlab, language_python;

/* the function in a language (code_print.c) */
void code_print(const Code *code, int function, const Language *language, Text *out);
/* the lines that set derived parameters; the names that they make, a new string */
char *code_print_derived(const Code *code, const Language *language, Text *out);
/* additions, multiplications, functions of one */
OpCount code_count(const Code *code, int function);
/* The description of the file, each line after `lead`: model, trees, arrays with their entries,
 * functions and their costs, the self-check. (code_head.c) */
void code_head(const Code *code, const Language *language, const char *lead, Text *out);
/* A text with its words written: the code's numbers, its lists, its parts. (code_text.c) */
void code_fill(const Code *code, const Language *language, const char *text, Text *out);
/* the whole file (code_text.c) */
void code_file(const Code *code, const Language *language, Text *out);
/* "name[i]" */
void code_element(const Language *language, const char *name, int i, Text *out);
/* a number as the language writes it */
void code_number(const Language *language, double value, Text *out);
/* a line that sets `left` */
void code_set(const Language *language, const char *left, const char *right, Text *out);
/* name[i] = value; a line each */
void code_set_array(const Language *language, const char *name, const double *values, int count,
                    Text *out);

#endif

/* write_c.c: equations as C functions
 *
 * A function a block takes parameters p, time t, coordinates q, speeds u, network
 * states x and algebraic unknowns z, and writes the block row by row; those of a nonlinear network
 * take the rates xd of x, too, and where angles of chords count turns all of them take values near
 * these. Symbols become local variables with the user's names, made into
 * identifiers. */
#include "export/write.h"
#include "present/abbreviate.h"
#include "present/tables.h"

#include "base/names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

typedef struct Rename { /* symbols and the identifiers that stand for them */
    Arena *arena;
    Names *taken;
    LIST(Expr) symbols;
    LIST(Expr) identifiers;
    LIST(const char *) sources; /* "q[0]", kept in `pool` */
    Pool *pool;
    bool near; /* whether anything reads what picks the turn of an angle */
} Rename;

/* what an identifier of ours may not be: keywords, and what the functions call their own */
static const char *const reserved[] = {
    "auto",    "break",  "case",  "char",   "const",   "continue", "default",  "do",
    "double",  "else",   "enum",  "extern", "float",   "for",      "goto",     "if",
    "inline",  "int",    "long",  "return", "short",   "signed",   "sizeof",   "static",
    "struct",  "switch", "union", "void",   "while",   "y0",       "y1",       "yn",
    "j0",      "j1",     "jn",    "gamma",  "p",       "t",        "q",        "u",
    "x",       "z",      "out",   "sin",    "cos",     "tan",      "asin",     "acos",
    "atan",    "atan2",  "sinh",  "cosh",   "tanh",    "exp",      "log",      "sqrt",
    "fabs",    "pow",    "fmin",  "fmax",   "floor",   "sign",     "step",     "ramp",
    "main",    "near",   "rint",  "table",  "typedef", "volatile", "unsigned", "register",
    "restrict"};

/* letters, digits and _ of the name; a prime becomes _d; unique */
static const char *identifier(Rename *rename, const char *name)
{
    Text text = {0};
    const char *out;
    int count = 2;

    for (const char *c = name; *c != '\0'; c++)
        if (*c == '\'')
            text_add(&text, "_d");
        else if (isalnum((unsigned char)*c) || *c == '_')
            text_char(&text, *c);
        else if (*c != ')')
            text_char(&text, '_');
    if (text.length == 0 || isdigit((unsigned char)text.at[0])) {
        Text prefixed = {0};

        text_addf(&prefixed, "v_%s", text.at != NULL ? text.at : "");
        text_free(&text);
        text = prefixed;
    }
    if (names_find(rename->taken, text.at) >= 0) {
        const size_t length = text.length;

        do {
            text.length = length;
            text_addf(&text, "_%d", count++);
        } while (names_find(rename->taken, text.at) >= 0);
    }
    (void)names_add(rename->taken, text.at);
    out = pool_text(rename->pool, text.at, text.length);
    text_free(&text);
    return out;
}

static void add_symbol(Rename *rename, Expr symbol, const char *array, int index)
{
    char source[40];

    (void)snprintf(source, sizeof source, "%s[%d]", array, index);
    LIST_PUSH(rename->symbols, symbol);
    LIST_PUSH(rename->identifiers,
              expr_symbol(rename->arena, identifier(rename, expr_name(symbol)), SYMBOL_ARGUMENT));
    LIST_PUSH(rename->sources, pool_text(rename->pool, source, strlen(source)));
}

static Rename rename_all(const View *view)
{
    const System *system = view->system;
    Rename rename = {.arena = model_arena(view->model), .taken = names_new(), .pool = pool_new(0)};

    for (int i = 0; i < COUNT(reserved); i++)
        (void)names_add(rename.taken, reserved[i]);
    for (int i = 0; i < model_parameter_count(view->model); i++) {
        Expr definition;

        add_symbol(&rename, model_parameter(view->model, i, &definition), "p", i);
    }
    for (int i = 0; i < system_n(system); i++)
        add_symbol(&rename, system_q(system, i)->symbol, "q", i);
    for (int i = 0; i < system_nu(system); i++)
        add_symbol(&rename, system_u(system, i)->symbol, "u", i);
    for (int i = 0; i < system_nx(system); i++)
        add_symbol(&rename, system_x(system, i)->symbol, "x", i);
    for (int i = 0; i < system_nz(system); i++)
        add_symbol(&rename, system_z(system, i)->symbol, "z", i);
    for (int i = 0; i < system_multi_turn_count(system); i++)
        add_symbol(&rename, system_multi_turn(system, i)->reference, "near", i);
    if (system_run(system)->network_nonlinear)
        for (int i = 0; i < system_nx(system); i++)
            add_symbol(&rename, system_state_rate(system, i), "xd", i);
    return rename;
}

static void rename_free(Rename *rename)
{
    names_free(rename->taken);
    pool_free(rename->pool);
    LIST_FREE(rename->symbols);
    LIST_FREE(rename->identifiers);
    LIST_FREE(rename->sources);
}

/* --- one function --- */

/* the locals that a block uses, copied from the arguments */
static void add_locals(Text *out, const Rename *rename, const Expr *roots, int count)
{
    for (int i = 0; i < rename->symbols.count; i++) {
        bool used = false;

        for (int r = 0; !used && r < count; r++)
            used = expr_depends(roots[r], rename->symbols.at[i]);
        if (used)
            text_addf(out, "    const double %s = %s;\n", expr_name(rename->identifiers.at[i]),
                      rename->sources.at[i]);
    }
}

static void add_function(Text *out, const Rename *rename, const char *name, const char *what,
                         const Expr *entries, int rows, int columns, bool of_rates)
{
    /* no name of the user begins so */
    static const Naming naming = {"_v", 1, 0};
    const int count = rows * columns;
    Expr *roots = NEW_ARRAY(Expr, count);
    Abbreviation shared;

    for (int i = 0; i < count; i++)
        roots[i] = expr_substitute(rename->arena, entries[i], rename->symbols.at,
                                   rename->identifiers.at, rename->symbols.count);
    shared = abbreviate(rename->arena, roots, count, &naming);
    text_addf(out,
              "\n/* %s, %d x %d, row by row */\nvoid %s(const double *p, double t, const double "
              "*q, const double *u,\n    const double *x, const double *z, %s%sdouble *out)\n{\n",
              what, rows, columns, name, rename->near ? "const double *near, " : "",
              of_rates ? "const double *xd, " : "");
    add_locals(out, rename, entries, count);
    for (int i = 0; i < shared.definitions.count; i++) {
        text_addf(out, "    const double %s = ", expr_name(shared.definitions.at[i].symbol));
        expr_print(out, shared.definitions.at[i].value, NOTATION_C);
        text_add(out, ";\n");
    }
    text_addf(out, "\n    (void)p, (void)t, (void)q, (void)u, (void)x, (void)z%s%s;\n",
              rename->near ? ", (void)near" : "", of_rates ? ", (void)xd" : "");
    for (int i = 0; i < count; i++) {
        text_addf(out, "    out[%d] = ", i);
        expr_print(out, shared.roots[i], NOTATION_C);
        text_add(out, ";\n");
    }
    text_add(out, "}\n");
    abbreviation_free(&shared);
    mem_free(roots);
}

/* a function has no place for accelerations, multipliers and efforts */
static Status check_symbols(const Rename *rename, const Expr *entries, int count, const char *what,
                            Diag *diag)
{
    Expr *symbols = NULL;
    const int found = expr_symbols(entries, count, &symbols);
    Status status = OK;

    for (int i = 0; status == OK && i < found; i++) {
        bool known = expr_symbol_kind(symbols[i]) == SYMBOL_TIME;

        for (int k = 0; !known && k < rename->symbols.count; k++)
            known = rename->symbols.at[k] == symbols[i];
        if (!known)
            status = diag_set(diag, E_MISSING,
                              "%s depends on %s, which no function of the C source is given", what,
                              expr_name(symbols[i]));
    }
    mem_free(symbols);
    return status;
}

/* --- data --- */

/* one array a table: its points, then x, y and y'' of each; and what computes the curve */
static void add_tables(Text *out, const Expr *roots, int count)
{
    Expr *symbols = NULL;
    const int found = expr_tables(roots, count, &symbols);

    if (found > 0)
        text_add(
            out,
            "\n/* a natural cubic spline, or a derivative of it; constant outside its points */\n"
            "static double table(const double *data, double v, int order)\n{\n"
            "    const int n = (int)data[0];\n"
            "    const double *x = data + 1, *y = x + n, *m = y + n;\n"
            "    int i = 0, last = n - 1;\n\n"
            "    if (v < x[0] || v > x[n - 1])\n"
            "        return order > 0 ? 0 : v < x[0] ? y[0] : y[n - 1];\n"
            "    while (last - i > 1) {\n"
            "        const int middle = (i + last) / 2;\n\n"
            "        if (v < x[middle])\n            last = middle;\n"
            "        else\n            i = middle;\n    }\n"
            "    const double h = x[i + 1] - x[i], a = (x[i + 1] - v) / h, b = (v - x[i]) / h;\n\n"
            "    if (order == 0)\n"
            "        return a * y[i] + b * y[i + 1] +\n"
            "               ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]) * h * h / 6;\n"
            "    if (order == 1)\n"
            "        return (y[i + 1] - y[i]) / h +\n"
            "               ((3 * b * b - 1) * m[i + 1] - (3 * a * a - 1) * m[i]) * h / 6;\n"
            "    return order == 2 ? a * m[i] + b * m[i + 1] : order == 3 ? (m[i + 1] - m[i]) / h "
            ": "
            "0;\n}\n");
    tables_print(out, NOTATION_C, "\n", roots, count);
    mem_free(symbols);
}

/* --- the file --- */

static void add_list(Text *out, const char *array, const char *what,
                     const Variable *(*variable)(const System *, int), const System *system,
                     int count)
{
    for (int i = 0; i < count; i++)
        text_addf(out, " *   %s[%d] %s%s\n", array, i, variable(system, i)->name,
                  i == 0 ? what : "");
}

static void add_head(Text *out, const View *view, bool near)
{
    const System *system = view->system;

    text_addf(out,
              "/* %s\n *\n * M u' + Phi_u^T lambda = F,  Phi = 0,  Phi_u u = nu,  "
              "Phi_u u' = gamma,  %s\n *\n",
              model_title(view->model) != NULL && model_title(view->model)[0] != '\0'
                  ? model_title(view->model)
                  : "equations of motion",
              system_run(system)->network_nonlinear ? "G(x', z) = 0, A = dG/d[x'; z]"
                                                    : "A [x'; z] = r");
    for (int i = 0; i < model_parameter_count(view->model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(view->model, i, &definition);

        text_addf(out, " *   p[%d] %s = ", i, expr_name(symbol));
        text_number(out, model_parameter_value(view->model, symbol), 17);
        text_char(out, '\n');
    }
    add_list(out, "q", "  (coordinates)", system_q, system, system_n(system));
    add_list(out, "u", "  (speeds)", system_u, system, system_nu(system));
    add_list(out, "x", "  (network states)", system_x, system, system_nx(system));
    add_list(out, "z", "  (algebraic unknowns)", system_z, system, system_nz(system));
    for (int i = 0; near && i < system_multi_turn_count(system); i++) {
        const MultiTurn *turn = system_multi_turn(system, i);

        text_addf(out,
                  " *   near[%d] %s  (picks the turn: any value less than half a turn from %s)\n",
                  i, expr_name(turn->reference), turn->name);
    }
    text_add(out, " */\n#include <math.h>\n\n"
                  "static inline double sign(double v) { return (v > 0) - (v < 0); }\n"
                  "static inline double step(double v) { return v >= 0; }\n"
                  "static inline double ramp(double v) { return v > 0 ? v : 0; }\n");
}

/* a function a block (M, F, Phi, Phi_u, gamma ...), straight-line, each common subexpression
 * computed once; needs math.h alone */
static Status write(const Exported *what, Text *out, Diag *diag)
{
    const View *view = &what->view;
    System *system = view->system;
    const Status formed = system_form_mass(system, diag);
    const Reading *r = system_run(system);
    const int nu = system_nu(system), m = system_m(system), n = system_n(system);
    const int k = system_nx(system) + system_nz(system);
    Expr *network = system_network_matrix(system);
    const struct {
        const char *name, *what;
        const Expr *entries;
        int rows, columns;
    } blocks[] = {
        {"model_q_rate", "q'", r->q_rate, n, 1},
        {"model_mass", "mass matrix M", r->mass, nu, nu},
        {"model_forces", "right side F", r->force, nu, 1},
        {"model_constraints", "constraints Phi", r->phi, m, 1},
        {"model_jacobian", "jacobian Phi_u", r->phi_u, m, nu},
        {"model_velocity", "nu", r->nu, m, 1},
        {"model_acceleration", "gamma", r->gamma, m, 1},
        {"model_network", "network matrix A", network, k, k},
        {r->network_nonlinear ? "model_network_residual" : "model_network_rhs",
         r->network_nonlinear ? "residual G of the network" : "right side r of the network",
         r->network_nonlinear ? r->network_residual : r->network_rhs, k, 1},
    };
    const int first_network = COUNT(blocks) - 2;
    Rename rename = rename_all(view);
    LIST(Expr) all = {0};
    Status status = OK;

    CHECK(formed);
    for (int i = 0; i < COUNT(blocks); i++)
        for (int j = 0; j < blocks[i].rows * blocks[i].columns; j++) {
            LIST_PUSH(all, blocks[i].entries[j]);
            rename.near =
                rename.near || (expr_kinds(blocks[i].entries[j]) & 1U << SYMBOL_TURN) != 0;
        }
    add_head(out, view, rename.near);
    add_tables(out, all.at, all.count);
    for (int i = 0; i < COUNT(blocks); i++) {
        CHECK(poll(view->watch));
        CHECK(check_symbols(&rename, blocks[i].entries, blocks[i].rows * blocks[i].columns,
                            blocks[i].what, diag));
        if (blocks[i].rows * blocks[i].columns > 0)
            add_function(out, &rename, blocks[i].name, blocks[i].what, blocks[i].entries,
                         blocks[i].rows, blocks[i].columns,
                         r->network_nonlinear && i >= first_network);
    }
done:
    LIST_FREE(all);
    mem_free(network);
    rename_free(&rename);
    return status;
}

const Format format_c = {NEED_RUNNING, write};

/* session_formula.c: splits a user's expression into parts that runs and the session can evaluate
 *
 * An expression is split into leaves. Subtrees that the model can resolve are variables of one run;
 * functions of runs (max(h8)), counts and sizes are numbers. The operations above the leaves are
 * evaluated over their values. Usually there is one leaf and no operation. */
#include "session/session_impl.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void formula_free(Formula *formula)
{
    LIST_FREE(formula->leaves);
}

/* --- numbers that the session knows --- */

/* Freedoms as reported by 'check': the number of motions that the constraints allow at the initial
 * state. If that can't be assembled, they are counted from the numbers of equations, with a
 * remark. */
static Status model_freedoms(ct_session *session, System *system, double *out, Diag *diag)
{
    const int difference = system_nu(system) - system_m(system);
    Run *start;
    Text line = {0};
    Status status = OK;

    *out = difference;
    if (system_m(system) == 0)
        return OK;
    if (session_freedoms(session) < 0) {
        status = session_start(session, &start, diag);
        if (status == E_STOPPED)
            return status;
    }
    if (session_freedoms(session) >= 0) {
        *out = session_freedoms(session);
        return OK;
    }
    text_addf(&line,
              "model.dof is n - m = %d, whatever constraints repeat others: the start can't be "
              "assembled",
              difference);
    session_remark(session, line.at);
    text_free(&line);
    *diag = (Diag){0};
    return OK;
}

/* sizes of the model: model.n ... */
static Status model_size(ct_session *session, const char *path, double *out, Diag *diag)
{
    System *system;

    TRY(session_system(session, &system, diag));
    if (strcmp(path, "model.n") == 0)
        *out = system_n(system);
    else if (strcmp(path, "model.m") == 0)
        *out = system_m(system);
    else if (strcmp(path, "model.dof") == 0)
        return model_freedoms(session, system, out, diag);
    else {
        diag_set(diag, E_NAME, "there is no '%s'", path);
        diag_hint(diag, "model.n, model.m and model.dof: coordinates, constraints, freedoms");
        return E_NAME;
    }
    return OK;
}

/* count.mass.add, count.shared.mass.add */
static Status count_size(ct_session *session, const char *path, double *out, Diag *diag)
{
    const bool shared = strncmp(path, "count.shared.", 13) == 0;
    const char *block = path + (shared ? 13 : 6);
    const char *dot = strrchr(block, '.');
    char *name = mem_text(block, dot != NULL ? (size_t)(dot - block) : strlen(block));
    const char *const *independent;
    System *system;
    OpCount count;
    Status status = OK;
    int independents;

    CHECK(session_shown(session, &system, diag));
    CHECK(count_block(system, model_form(session->model, &independent, &independents), name, shared,
                      &count, diag));
    if (dot != NULL && strcmp(dot, ".add") == 0)
        *out = (double)count.add;
    else if (dot != NULL && strcmp(dot, ".mul") == 0)
        *out = (double)count.mul;
    else if (dot != NULL && strcmp(dot, ".fun") == 0)
        *out = (double)count.fun;
    else {
        diag_set(diag, E_NAME, "'%s' needs .add, .mul or .fun at its end", path);
        status = E_NAME;
    }
done:
    mem_free(name);
    return status;
}

static const struct {
    const char *prefix;
    Status (*value)(ct_session *session, const char *path, double *out, Diag *diag);
} sizes[] = {{"model.", model_size},
             {"count.", count_size},
             {"sweep.", sweep_size},
             {"fit.", fit_size_value},
             {"optimum.", optimum_size_value}};

static int find_size(const char *path)
{
    for (int i = 0; i < COUNT(sizes); i++)
        if (strncmp(path, sizes[i].prefix, strlen(sizes[i].prefix)) == 0)
            return i;
    return -1;
}

/* run2.h8: the number of the run and the start of the rest; 0: no such prefix */
static int run_prefix(const char *path, const char **rest)
{
    char *end;
    long number;

    if (strncmp(path, "run", 3) != 0 || !isdigit((unsigned char)path[3]))
        return 0;
    number = strtol(path + 3, &end, 10);
    if (*end != '.' || number < 1 || number > 1000000)
        return 0;
    *rest = end + 1;
    return (int)number;
}

/* --- cutting --- */

static bool is_entry(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL &&
           (session_entry(syntax->text) >= 0 || sweep_entry_is_called(syntax) ||
            fit_entry_is_called(syntax) || optimum_entry_is_called(syntax));
}

/* whether the model understands the whole subtree; run: the one that all its names have, 0: none */
static bool is_pure(const ct_session *session, const Syntax *syntax, int *run, bool *bare)
{
    const char *rest;

    if (figure_is_called(syntax) || spectrum_is_called(syntax) ||
        sensitivity_is_called(session, syntax))
        return false;
    if (syntax->kind == SYNTAX_VARIABLE || syntax->kind == SYNTAX_CALL) {
        const int prefix = run_prefix(syntax->text, &rest);

        if (find_size(syntax->text) >= 0 || is_entry(syntax))
            return false;
        if (prefix > 0 && *run > 0 && prefix != *run)
            return false;
        if (prefix > 0)
            *run = prefix;
        else if (syntax->kind == SYNTAX_VARIABLE)
            *bare = true;
    }
    for (int i = 0; i < syntax->count; i++)
        if (!is_pure(session, syntax->args[i], run, bare))
            return false;
    return *run == 0 || !*bare;
}

/* the tree without its run prefixes, in the pool */
static Syntax *strip(Pool *pool, const Syntax *syntax)
{
    Syntax *out = pool_alloc(pool, sizeof *out);
    const char *rest;

    *out = *syntax;
    if ((syntax->kind == SYNTAX_VARIABLE || syntax->kind == SYNTAX_CALL) &&
        run_prefix(syntax->text, &rest) > 0)
        out->text = rest;
    out->args = pool_alloc(pool, sizeof *out->args * (size_t)(syntax->count + 1));
    for (int i = 0; i < syntax->count; i++)
        out->args[i] = strip(pool, syntax->args[i]);
    return out;
}

typedef struct Cut {
    ct_session *session;
    Formula *formula;
} Cut;

static Expr push_leaf(Cut *cut, Leaf leaf)
{
    char name[24];

    (void)snprintf(name, sizeof name, "#%d", cut->formula->leaves.count + 1);
    leaf.symbol = expr_symbol(model_arena(cut->session->model), name, SYMBOL_ARGUMENT);
    LIST_PUSH(cut->formula->leaves, leaf);
    return leaf.symbol;
}

/* replace the symbols of sizes in an expression by their numbers */
static Status put_sizes(ct_session *session, Expr *e, Diag *diag)
{
    Arena *arena = model_arena(session->model);
    Expr *symbols = NULL, *numbers;
    const int count = expr_symbols(e, 1, &symbols);
    int used = 0;
    Status status = OK;

    numbers = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        const char *name = expr_name(symbols[i]);
        const int size = find_size(name);
        double value;

        if (size < 0 || expr_symbol_kind(symbols[i]) != SYMBOL_VARIABLE)
            continue;
        CHECK(sizes[size].value(session, name, &value, diag));
        symbols[used] = symbols[i];
        numbers[used++] = expr_real(arena, value);
    }
    *e = expr_substitute(arena, *e, symbols, numbers, used);
done:
    MEM_FREE(symbols, numbers);
    return status;
}

/* an entry of the equations that are shown, over variables that any form of the network has */
static Expr entry_shown(System *shown, System *running, Arena *arena, Expr entry)
{
    const unsigned own = 1U << SYMBOL_STATE | 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC;
    Expr *symbols = NULL, *names;
    Expr out, there;
    Diag ignored;
    int count, used = 0;

    if (system_variable(shown, expr_name(entry), 0, &out, &ignored) != OK)
        return entry;
    count = expr_symbols(&out, 1, &symbols);
    names = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        if ((1U << expr_symbol_kind(symbols[i]) & own) == 0)
            continue;
        symbols[used] = symbols[i];
        names[used++] = expr_symbol(arena, expr_name(symbols[i]), SYMBOL_VARIABLE);
    }
    out = expr_substitute(arena, out, symbols, names, used);
    MEM_FREE(symbols, names);
    return system_resolve(running, out, &there, &ignored) == OK ? out : entry;
}

/* whether a name is that of an entry: mass(2,2), and not lambda(1), which a run has */
static bool is_block_entry(const char *name)
{
    const char *bracket = strchr(name, '(');

    for (Block block = 0; bracket != NULL && block < BLOCK_COUNT; block++)
        if (strlen(block_name(block)) == (size_t)(bracket - name) &&
            strncmp(block_name(block), name, (size_t)(bracket - name)) == 0)
            return true;
    return false;
}

/* Entries of blocks are those that `show` shows, also where a run takes the network in state form.
 * A run of an earlier model has its own. */
static Status put_shown(ct_session *session, int run, Expr *e, Diag *diag)
{
    Arena *arena = model_arena(session->model);
    System *running, *shown = NULL;
    Expr *symbols = NULL, *values;
    const int count = expr_symbols(e, 1, &symbols);
    int used = 0;
    Status status = OK;

    values = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        if (expr_symbol_kind(symbols[i]) != SYMBOL_VARIABLE ||
            !is_block_entry(expr_name(symbols[i])) ||
            (run > 0 && system_revision(result_system(session->runs.at[run - 1].result)) !=
                            model_revision(session->model)))
            continue;
        if (shown == NULL) {
            CHECK(session_system(session, &running, diag));
            if (system_tree_is_normal(running))
                break;
            CHECK(session_shown(session, &shown, diag));
        }
        symbols[used] = symbols[i];
        values[used++] = entry_shown(shown, running, arena, symbols[i]);
    }
    *e = expr_substitute(arena, *e, symbols, values, used);
done:
    MEM_FREE(symbols, values);
    return status;
}

/* f.lost: the integral of f.loss */
static Expr push_integral(Cut *cut, const char *name, int run)
{
    char *power = mem_text(name, strlen(name));
    Expr symbol;

    power[strlen(power) - 1] = 's';
    symbol = expr_symbol(model_arena(cut->session->model), power, SYMBOL_VARIABLE);
    mem_free(power);
    return push_leaf(cut, (Leaf){.kind = LEAF_INTEGRAL, .expr = symbol, .run = run - 1});
}

/* Where e has integrals over the run each of its symbols becomes a leaf. *found: it has. */
static Expr cut_integrals(Cut *cut, Expr e, int run, bool *found)
{
    const ct_session *session = cut->session;
    Expr *symbols = NULL, *leaves;
    const int count = expr_symbols(&e, 1, &symbols);
    Expr out = e;

    leaves = NEW_ARRAY(Expr, count);
    *found = false;
    for (int i = 0; i < count; i++)
        *found = *found || model_is_integral(session->model, expr_name(symbols[i]));
    for (int i = 0; i < count && *found; i++)
        leaves[i] =
            model_is_integral(session->model, expr_name(symbols[i]))
                ? push_integral(cut, expr_name(symbols[i]), run)
                : push_leaf(cut, (Leaf){.kind = LEAF_VARIABLE, .expr = symbols[i], .run = run - 1});
    if (*found)
        out = expr_substitute(model_arena(session->model), e, symbols, leaves, count);
    MEM_FREE(symbols, leaves);
    return out;
}

static Status cut_pure(Cut *cut, const Syntax *syntax, int run, Expr *out, Diag *diag)
{
    ct_session *session = cut->session;
    Pool *pool = pool_new(4096);
    Status status = OK;
    bool has_integral;
    Expr e;

    if (run > session->runs.count) {
        diag_at(diag, E_NAME, syntax->place, "there is no run%d", run);
        if (session->runs.count > 0)
            diag_hint(diag, "the last one is run%d", session->runs.count);
        else
            diag_hint(diag, "there is no run yet: 'simulate 10' makes one");
        status = E_NAME;
        goto done;
    }
    CHECK(model_expression(session->model, run > 0 ? strip(pool, syntax) : syntax, &e, diag));
    e = session_add_outputs(session->model, e);
    CHECK(put_sizes(session, &e, diag));
    CHECK(put_shown(session, run, &e, diag));
    *out = cut_integrals(cut, e, run, &has_integral);
    if (!has_integral && !expr_is_number(e))
        *out = push_leaf(cut, (Leaf){.kind = LEAF_VARIABLE, .expr = e, .run = run - 1});
done:
    pool_free(pool);
    return status;
}

static Status cut_any(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag);

/* a function of a run: a number */
static Status cut_figure(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    Formula argument = {0};
    double band = 0, value;
    Status status;

    if (cut->session->runs.count == 0) {
        diag_at(diag, E_MISSING, syntax->place,
                "'%s' %sis taken over the last run, and there is none yet", syntax->text,
                syntax->count == 1 ? "of one argument " : "");
        diag_hint(diag, "'simulate 10' makes one");
        return E_MISSING;
    }
    CHECK(formula_new(cut->session, syntax->args[0], &argument, diag));
    if (syntax->count > 1)
        CHECK(session_number(cut->session, syntax->args[1], &band, diag));
    CHECK(figure_value(cut->session, syntax, &argument, band, &value, diag));
    *out = push_leaf(cut, (Leaf){.kind = LEAF_CONSTANT, .value = value, .run = -1});
done:
    formula_free(&argument);
    return status;
}

static Status cut_size(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    double value = 0;
    Status status;

    status = sizes[find_size(syntax->text)].value(cut->session, syntax->text, &value, diag);
    if (status != OK) {
        if (diag->place.line == 0)
            diag->place = syntax->place;
        return status;
    }
    *out = push_leaf(cut, (Leaf){.kind = LEAF_CONSTANT, .value = value, .run = -1});
    return OK;
}

/* linear.A(1,2): its numbers are numbers, or made of parameters */
static Status cut_entry(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    int index[2] = {0, 0};
    double value = 0;
    Status status = OK;

    for (int i = 0; i < syntax->count && i < COUNT(index); i++) {
        Formula formula = {0};

        CHECK(formula_new(cut->session, syntax->args[i], &formula, diag));
        if (!formula_needs_run(&formula))
            status = formula_value(cut->session, &formula, NULL, NULL, &value, diag);
        else
            status = diag_at(diag, E_VALUE, syntax->args[i]->place,
                             "an entry of %s is picked by whole numbers from 1", syntax->text);
        formula_free(&formula);
        CHECK(status);
        index[i] = value == floor(value) && fabs(value) < 1e6 ? (int)value : 0;
    }
    CHECK(session_entry_value(cut->session, session_entry(syntax->text), index, syntax->count,
                              &value, diag));
    *out = push_leaf(cut, (Leaf){.kind = LEAF_CONSTANT, .value = value, .run = -1});
done:
    if (status != OK && diag->place.line == 0)
        diag->place = syntax->place;
    return status;
}

/* sweep.value(3, max(h1)) */
static Status cut_sweep(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    const Syntax *argument = sweep_entry_number(syntax);
    double number = 0, value = 0;
    Status status = OK;

    if (argument != NULL)
        CHECK(session_number(cut->session, argument, &number, diag));
    CHECK(sweep_entry_value(cut->session, syntax, number, &value, diag));
    *out = push_leaf(cut, (Leaf){.kind = LEAF_CONSTANT, .value = value, .run = -1});
done:
    if (status != OK && diag->place.line == 0)
        diag->place = syntax->place;
    return status;
}

/* fit.value(k), optimum.value(k) */
static Status cut_fit(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    double value = 0;
    Status status;

    CHECK(optimum_entry_is_called(syntax) ? optimum_entry_value(cut->session, syntax, &value, diag)
                                          : fit_entry_value(cut->session, syntax, &value, diag));
    *out = push_leaf(cut, (Leaf){.kind = LEAF_CONSTANT, .value = value, .run = -1});
done:
    if (status != OK && diag->place.line == 0)
        diag->place = syntax->place;
    return status;
}

/* a function or law of leaves; the parameters that a law brings are leaves more */
static Status cut_call(Cut *cut, const Syntax *syntax, const Expr *args, Expr *out, Diag *diag)
{
    Arena *arena = model_arena(cut->session->model);
    Expr *symbols = NULL, *leaves = NULL;
    int count, used = 0;
    Status status = OK;

    CHECK(model_call(cut->session->model, syntax, args, out, diag));
    count = expr_symbols(out, 1, &symbols);
    leaves = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        const SymbolKind kind = expr_symbol_kind(symbols[i]);

        if (kind == SYMBOL_ARGUMENT || kind == SYMBOL_TABLE)
            continue;
        symbols[used] = symbols[i];
        leaves[used++] =
            push_leaf(cut, (Leaf){.kind = LEAF_VARIABLE, .expr = symbols[i], .run = -1});
    }
    *out = expr_substitute(arena, *out, symbols, leaves, used);
done:
    MEM_FREE(symbols, leaves);
    return status;
}

/* a*d(h)/d(L): `numerator` is a*d(h) */
static Status cut_numerator(Cut *cut, const Syntax *numerator, Expr derivative, Expr *out,
                            Diag *diag)
{
    Arena *arena = model_arena(cut->session->model);
    Expr inner = NULL, factor = NULL;
    Status status = OK;

    *out = derivative;
    if (numerator->kind == SYNTAX_CALL)
        return OK;
    CHECK(cut_numerator(cut, numerator->args[numerator->count - 1], derivative, &inner, diag));
    if (numerator->count > 1)
        CHECK(cut_any(cut, numerator->args[0], &factor, diag));
    *out = model_operation(arena, numerator->text, numerator->count > 1 ? factor : inner,
                           numerator->count > 1 ? inner : NULL);
done:
    return status;
}

static Status cut_sensitivity(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    ct_session *session = cut->session;
    const Syntax *item = NULL, *numerator = NULL;
    Leaf leaf = {.kind = LEAF_SENSITIVITY};
    int run = 0;
    bool bare = false;
    Pool *pool = pool_new(4096);
    Status status = OK;

    CHECK(sensitivity_read(session, syntax, &item, &numerator, &leaf.by, diag));
    if (!is_pure(session, item, &run, &bare))
        CHECK(diag_at(diag, E_VALUE, item->place,
                      "a derivative is of variables of one run, not of functions of runs"));
    if (session->runs.count == 0 || run > session->runs.count) {
        status = diag_at(diag, E_MISSING, syntax->place, "there is no such run yet");
        diag_hint(diag, "'simulate 10' makes one");
        goto done;
    }
    CHECK(model_expression(session->model, run > 0 ? strip(pool, item) : item, &leaf.expr, diag));
    leaf.expr = session_add_outputs(session->model, leaf.expr);
    leaf.run = run - 1;
    CHECK(cut_numerator(cut, numerator, push_leaf(cut, leaf), out, diag));
done:
    pool_free(pool);
    return status;
}

/* a subtree that the model can't resolve as a whole: its parts, combined */
static Status cut_joined(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    Expr *args = NEW_ARRAY(Expr, syntax->count);
    Status status = OK;

    /* the name of a file is no value */
    for (int i = 0; i < syntax->count; i++)
        if (syntax->args[i]->kind != SYNTAX_STRING || !model_call_takes_text(syntax))
            CHECK(cut_any(cut, syntax->args[i], &args[i], diag));
    *out = NULL;
    if (syntax->primes == 0 && syntax->kind == SYNTAX_GROUP)
        *out = args[0];
    else if (syntax->kind == SYNTAX_UNARY || syntax->kind == SYNTAX_BINARY)
        *out = model_operation(model_arena(cut->session->model), syntax->text, args[0],
                               syntax->count > 1 ? args[1] : NULL);
    else if (syntax->primes == 0 && syntax->kind == SYNTAX_CALL)
        CHECK(cut_call(cut, syntax, args, out, diag));
    if (*out == NULL)
        status = diag_at(diag, E_VALUE, syntax->place,
                         "this can't be made of values of several runs, of functions of runs or "
                         "of counts");
done:
    mem_free(args);
    return status;
}

static Status cut_any(Cut *cut, const Syntax *syntax, Expr *out, Diag *diag)
{
    int run = 0;
    bool bare = false;

    if (spectrum_is_called(syntax)) {
        (void)diag_at(diag, E_VALUE, syntax->place, "a spectrum is no number, but one a frequency");
        diag_hint(diag, "'plot spectrum(h8)' draws one, 'table' lists it");
        return E_VALUE;
    }
    if (figure_is_called(syntax))
        return cut_figure(cut, syntax, out, diag);
    if (syntax->kind == SYNTAX_VARIABLE && find_size(syntax->text) >= 0)
        return cut_size(cut, syntax, out, diag);
    if (sweep_entry_is_called(syntax))
        return cut_sweep(cut, syntax, out, diag);
    if (fit_entry_is_called(syntax) || optimum_entry_is_called(syntax))
        return cut_fit(cut, syntax, out, diag);
    if (is_entry(syntax))
        return cut_entry(cut, syntax, out, diag);
    if (sensitivity_is_called(cut->session, syntax))
        return cut_sensitivity(cut, syntax, out, diag);
    if (is_pure(cut->session, syntax, &run, &bare))
        return cut_pure(cut, syntax, run, out, diag);
    return cut_joined(cut, syntax, out, diag);
}

Status formula_new(ct_session *session, const Syntax *syntax, Formula *out, Diag *diag)
{
    Formula formula = {.scale = 1};
    Cut cut = {session, &formula};
    Syntax bare = *syntax;
    Status status;

    /* after a literal it is the literal's unit, after anything else the unit to show it in */
    if (syntax->has_unit && syntax->kind != SYNTAX_NUMBER && syntax->kind != SYNTAX_VECTOR) {
        formula.scale = 1 / syntax->unit.factor;
        bare.has_unit = false;
    }
    status = cut_any(&cut, &bare, &formula.whole, diag);
    if (status == OK)
        status = model_check_shown(session->model, syntax, diag);
    if (status != OK) {
        formula_free(&formula);
        return status;
    }
    *out = formula;
    return OK;
}

/* a number that a message calls `what` */
static Status number_called(ct_session *session, const Syntax *syntax, const char *what,
                            double *out, Diag *diag)
{
    Formula formula = {0};
    Status status;

    CHECK(formula_new(session, syntax, &formula, diag));
    if (formula_needs_run(&formula)) {
        status =
            diag_at(diag, E_VALUE, syntax->place, "%s is a number, or made of parameters", what);
        goto done;
    }
    CHECK(formula_value(session, &formula, NULL, NULL, out, diag));
done:
    formula_free(&formula);
    return status;
}

Status session_number(ct_session *session, const Syntax *syntax, double *out, Diag *diag)
{
    return number_called(session, syntax, "what stands here", out, diag);
}

Status session_instant(ct_session *session, const Syntax *at, double *out, Diag *diag)
{
    TRY(number_called(session, at, "an instant", out, diag));
    return model_check_unit(session->model, at, "s", "an instant", diag);
}

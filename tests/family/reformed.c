/* reformed.c: a model that is edited, and typed anew after each edit */
#include "reformed.h"

#include "base/memory.h"
#include "compile/program.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/system/system.h"
#include "model/model.h"

#include <string.h>

struct Reformed {
    Model *model;
    System *system; /* of its equations, from those before the last edits on */
    bool has_lifted;
};

Reformed *reformed_new(bool has_lifted)
{
    Reformed *reformed = NEW(Reformed);

    reformed->model = model_new();
    reformed->has_lifted = has_lifted;
    return reformed;
}

void reformed_free(Reformed *reformed)
{
    system_free(reformed->system);
    model_free(reformed->model);
    mem_free(reformed);
}

typedef LIST(Expr) Roots;

static void add_roots(Roots *roots, const Expr *more, int count)
{
    for (int i = 0; more != NULL && i < count; i++)
        LIST_PUSH(*roots, more[i]);
}

/* all that a run evaluates */
static void list_roots(const System *system, Roots *roots)
{
    const EquationForm *run = system_run(system);
    const CompositeMass *mass = system_composite_mass(system);
    const int n = system_n(system), nu = system_nu(system), m = system_m(system),
              network = system_nx(system) + system_nz(system);
    const Entry *share;

    add_roots(roots, run->phi, m);
    add_roots(roots, run->phi_u, m * nu);
    add_roots(roots, run->nu, m);
    add_roots(roots, run->gamma, m);
    add_roots(roots, run->force, nu);
    add_roots(roots, run->q_rate, n);
    add_roots(roots, run->network_rhs, network);
    for (int i = 0; i < run->network_entries; i++)
        LIST_PUSH(*roots, run->network[i].value);
    if (mass == NULL)
        add_roots(roots, run->mass, nu * nu);
    else
        add_roots(roots, mass->needs.at, mass->needs.count);
    for (int i = 0; (share = system_mass_share(system, i)) != NULL; i++)
        LIST_PUSH(*roots, share->value);
}

static Status carry_out(Model *model, const Statement *statement, Diag *diag)
{
    if (statement->kind == STATEMENT_VERB && strcmp(statement->row.name, "undo") == 0)
        return model_undo(model, diag);
    if (statement->kind == STATEMENT_VERB && strcmp(statement->row.name, "redo") == 0)
        return model_redo(model, diag);
    return model_apply(model, statement, diag);
}

/* statements as far as they can be applied; true: one was refused, which `story` gets */
static bool apply(Model *model, const char *lines, Text *story)
{
    bool refused = false;

    for (size_t next = 0; lines[0] != '\0'; lines += next, next = 0) {
        Statement *statement = NULL;
        Diag diag = {0};
        const Status parsed =
            statement_parse(lines, 1, (SyntaxOptions){0}, &next, &statement, &diag);

        if (parsed != OK || carry_out(model, statement, &diag) != OK) {
            text_addf(story, "  (%s)\n", diag.message);
            refused = true;
        }
        statement_free(statement);
    }
    return refused;
}

/* as a session does it */
static Status form(const Model *model, bool has_lifted, System **system, Diag *diag)
{
    const SystemOptions options = {.has_lifted = has_lifted};
    Scene scene = {0};
    System *formed = NULL;
    Status status = OK;

    CHECK(model_scene(model, &scene, diag));
    if (*system == NULL || !system_follows(*system, &scene)) {
        CHECK(system_new_view(&scene, &options, &formed, diag));
        system_free(*system);
        *system = formed;
    }
done:
    scene_free(&scene);
    return status;
}

/* the program of all roots; names of all roots' symbols, in the order of making, are its inputs */
static char *program_text(const Roots *roots, Diag *diag)
{
    Text text = {0};
    Program *program = NULL;
    Expr *symbols = NULL;
    const int count = expr_symbols(roots->at, roots->count, &symbols);
    const Status status = program_new(roots->at, roots->count, symbols, count, &program, diag);

    for (int i = 0; i < count; i++)
        text_addf(&text, "%s ", expr_name(symbols[i]));
    text_char(&text, '\n');
    if (status == OK)
        program_print(&text, program);
    program_free(program);
    mem_free(symbols);
    return text_done(&text);
}

/* the same names and kinds in the same order */
static void make_symbols(const Roots *roots, Arena *arena)
{
    Expr *symbols = NULL;
    const int count = expr_symbols(roots->at, roots->count, &symbols);

    for (int i = 0; i < count; i++)
        (void)expr_symbol(arena, expr_name(symbols[i]), expr_symbol_kind(symbols[i]));
    mem_free(symbols);
}

/* the first line in which they differ */
static void add_difference(Text *story, const char *one, const char *other)
{
    size_t same = 0;

    for (size_t i = 0; one[i] == other[i] && one[i] != '\0'; i++)
        same = one[i] == '\n' ? i + 1 : same;
    text_addf(story, "edited: %.*s\ntyped: %.*s\n", (int)strcspn(one + same, "\n"), one + same,
              (int)strcspn(other + same, "\n"), other + same);
}

static bool is_typed_anew(const Reformed *reformed, Text *story)
{
    char *saved = model_save(reformed->model), *edited = NULL, *typed = NULL;
    Model *anew = model_new();
    System *fresh = NULL;
    Roots roots = {0}, fresh_roots = {0};
    Diag diag = {0};
    bool same = false;

    list_roots(reformed->system, &roots);
    make_symbols(&roots, model_arena(anew));
    if (apply(anew, saved, story) || form(anew, reformed->has_lifted, &fresh, &diag) != OK) {
        text_addf(story, "typed anew: %s\n%s", diag.message, saved);
        goto done;
    }
    list_roots(fresh, &fresh_roots);
    edited = program_text(&roots, &diag);
    typed = program_text(&fresh_roots, &diag);
    same = roots.count == fresh_roots.count && strcmp(edited, typed) == 0;
    if (!same) {
        text_addf(story, "%d roots, %d typed anew, of\n%s", roots.count, fresh_roots.count, saved);
        add_difference(story, edited, typed);
    }
done:
    system_free(fresh);
    model_free(anew);
    LIST_FREE(roots);
    LIST_FREE(fresh_roots);
    MEM_FREE(saved, edited, typed);
    return same;
}

Reform reformed_change(Reformed *reformed, const char *lines, Text *story)
{
    Diag diag = {0};

    text_add(story, lines);
    (void)apply(reformed->model, lines, story);
    if (form(reformed->model, reformed->has_lifted, &reformed->system, &diag) != OK) {
        text_addf(story, "  (%s)\n", diag.message);
        return REFORM_REFUSED;
    }
    return is_typed_anew(reformed, story) ? REFORM_SAME : REFORM_DIFFERS;
}

/* scene.h: models from statements, for tests */
#ifndef COTREE_TESTS_SCENE_H
#define COTREE_TESTS_SCENE_H

#include "form.h"
#include "formulate/system/system.h"
#include "test.h"

/* Apply statements, lines separated by \n; a fault of the test when one fails. */
__attribute__((unused)) static void scene_add(Model *model, const char *text)
{
    const char *line = text != NULL ? text : ""; /* a Text that nothing was added to */

    while (*line != '\0') {
        size_t length = strcspn(line, "\n");
        char *copy = mem_text(line, length);
        size_t next = 0;
        Diag diag = {0};

        while (next < length) {
            Statement *statement = NULL;

            if (statement_parse(copy, 1, (SyntaxOptions){0}, &next, &statement, &diag) != OK ||
                (statement->kind != STATEMENT_EMPTY &&
                 model_apply(model, statement, &diag) != OK)) {
                test_faults++;
                printf("%s\n    %s (%s)\n", copy, diag.message, diag.hint);
                next = length;
            }
            statement_free(statement);
        }
        mem_free(copy);
        line += length + (line[length] == '\n');
    }
}

__attribute__((unused)) static Model *scene_new(const char *text)
{
    Model *model = model_new();

    scene_add(model, text);
    return model;
}

/* its equations, or NULL and a fault */
__attribute__((unused)) static System *scene_system(const Model *model)
{
    System *system = NULL;
    Diag diag = {0};

    if (form_system(model, &system, &diag) != OK) {
        test_faults++;
        printf("no equations: %s (%s)\n", diag.message, diag.hint);
    }
    return system;
}

/* an expression of the language, over the user's variables; NULL where it isn't one */
__attribute__((unused)) static Expr scene_read(const Model *model, const char *text)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Expr e = NULL;
    Diag diag = {0};

    if (syntax_parse_expression(text, pool, &syntax, &diag) != OK ||
        model_expression(model, syntax, &e, &diag) != OK) {
        test_faults++;
        printf("%s: %s (%s)\n", text, diag.message, diag.hint);
        e = NULL;
    }
    pool_free(pool);
    return e;
}

/* the same over the system's variables; 0 where it can't be determined */
__attribute__((unused)) static Expr scene_expression(const Model *model, System *system,
                                                     const char *text)
{
    Expr e = scene_read(model, text);
    Diag diag = {0};

    if (e == NULL)
        return expr_int(model_arena(model), 0);
    if (system_resolve(system, e, &e, &diag) != OK) {
        test_faults++;
        printf("%s: %s (%s)\n", text, diag.message, diag.hint);
    }
    return e;
}

/* numbers for symbols, by kind and number of the symbol: repeatable and all different */
typedef struct SceneState {
    const Model *model;
    uint64_t seed;
} SceneState;

/* m1.q0 .. m1.q3 */
__attribute__((unused)) static bool scene_is_parameter(Expr symbol)
{
    const char *name = expr_name(symbol);
    size_t length = strlen(name);

    return expr_symbol_kind(symbol) == SYMBOL_COORDINATE && length > 3 && name[length - 3] == '.' &&
           name[length - 2] == 'q';
}

/* four of unit length, told apart by the letters of the part's name */
__attribute__((unused)) static double scene_parameter(const SceneState *state, Expr symbol)
{
    const char *name = expr_name(symbol);
    uint64_t random = state->seed;
    double p[4];
    double norm = 0.0;

    for (const char *c = name; *c != '.'; c++)
        random = 31U * random + (unsigned char)*c;
    for (int i = 0; i < 4; i++) {
        p[i] = test_uniform(&random, -1.0, 1.0);
        norm += p[i] * p[i];
    }
    return p[name[strlen(name) - 1] - '0'] / sqrt(norm);
}

__attribute__((unused)) static double scene_value(void *context, Expr symbol)
{
    const SceneState *state = context;
    uint64_t random = state->seed + 77U * (uint64_t)expr_symbol_number(symbol);

    if (expr_symbol_kind(symbol) == SYMBOL_PARAMETER && expr_name(symbol)[0] == '#')
        return 0; /* whole turns of a sum of angles */
    if (expr_symbol_kind(symbol) == SYMBOL_PARAMETER)
        return model_parameter_value(state->model, symbol);
    if (scene_is_parameter(symbol))
        return scene_parameter(state, symbol);
    return test_uniform(&random, -2.0, 2.0);
}

#endif

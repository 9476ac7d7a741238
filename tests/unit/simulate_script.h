/* simulate_script.h: run a script of the command language through the library, for tests
 *
 * Statements that build go to the model; `simulate` and its kin run; `expect A ~ B within TOL at T`
 * is looked at; the items of `export csv` are kept, to be compared with reference data. */
#ifndef COTREE_TESTS_SIMULATE_SCRIPT_H
#define COTREE_TESTS_SIMULATE_SCRIPT_H

#include "form.h"
#include "formulate/system/system.h"
#include "session/session_impl.h"
#include "simulate/run/run.h"
#include "test.h"

/* what a test has differently from the script */
typedef struct Changes {
    const char *before; /* statements ahead of the run, lines; NULL */
    const char *method; /* NULL: the script's */
    double rtol;        /* 0: the script's */
    double duration;    /* 0: the script's */
    bool skip_expects;  /* the data tells */
} Changes;

typedef struct Script {
    Model *model;
    System *system;
    Result *result;
    ResultReader *reader; /* of the result */
    LIST(Expr) items;     /* of the last export */
    int expects;
    Diag diag; /* of the run */
    Status status;
    Text remarks; /* of the result, once script_remarks() has been asked */
} Script;

static double script_parameter(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

static void script_fail(const char *line, const Diag *diag)
{
    test_faults++;
    printf("%s\n    %s (%s)\n", line, diag->message, diag->hint);
}

static double script_number(Script *script, const Syntax *syntax)
{
    Diag diag = {0};
    Expr e;

    if (model_expression(script->model, syntax, &e, &diag) != OK) {
        script_fail("a number", &diag);
        return NAN;
    }
    return model_number(script->model, e);
}

static double script_key(Script *script, const Statement *statement, const char *key)
{
    for (int i = 0; i < statement->pairs.count; i++)
        if (strcmp(statement->pairs.at[i].name, key) == 0)
            return script_number(script, statement->pairs.at[i].value);
    return 0;
}

static void script_start(Script *script, StartValues *start)
{
    start->count = model_start_count(script->model);
    start->at = NEW_ARRAY(StartValue, start->count);
    for (int i = 0; i < start->count; i++) {
        const Start *given = model_start(script->model, i);

        start->at[i] = (StartValue){given->name, given->primes,
                                    model_number(script->model, given->value), given->is_guess};
    }
}

static void script_run(Script *script, const Statement *statement, const Changes *changes)
{
    StartValues start;
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script->model,
                               .scene = model_scene_source(script->model),
                               .start = &start};
    RunOptions options = {.every = script_key(script, statement, "every"),
                          .rtol = script_key(script, statement, "rtol"),
                          .atol = script_key(script, statement, "atol")};
    Status status;

    options.duration = changes->duration;
    if (options.duration == 0 && statement->operands.count > 0)
        options.duration = script_number(script, statement->operands.at[0].value);
    if (changes->rtol > 0)
        options.rtol = options.atol = changes->rtol;
    options.method = changes->method;
    result_reader_free(script->reader);
    result_free(script->result);
    system_free(script->system);
    script->reader = NULL;
    script->result = NULL;
    script->system = NULL;
    setting.form = model_form(script->model, &setting.independent, &setting.independent_count);
    script_start(script, &start);
    status = form_system(script->model, &script->system, &script->diag);
    if (status == OK && strcmp(statement->verb, "simulate") == 0)
        status = run_simulate(script->system, &setting, &options, &script->result, &script->reader,
                              &script->diag);
    else if (status == OK && strcmp(statement->verb, "inverse") == 0)
        status = run_inverse(script->system, &setting, &options, &script->result, &script->reader,
                             &script->diag);
    else if (status == OK && strcmp(statement->verb, "kinematics") == 0)
        status = run_kinematics(script->system, &setting, &options, &script->result,
                                &script->reader, &script->diag);
    else if (status == OK)
        status =
            run_assemble(script->system, &setting, &script->result, &script->reader, &script->diag);
    script->status = status;
    mem_free(start.at);
}

static Expr script_expression(Script *script, const Syntax *syntax)
{
    Diag diag = {0};
    Expr e = NULL;

    if (model_expression(script->model, syntax, &e, &diag) != OK)
        script_fail("an expression", &diag);
    return e != NULL ? session_add_outputs(script->model, e) : NULL;
}

static void script_expect(Script *script, const Statement *statement)
{
    Expr got = script_expression(script, statement->operands.at[0].value);
    Diag diag = {0};
    double wanted, within, at, value;

    if (script->result == NULL || statement->near_value == NULL || got == NULL)
        return;
    wanted = script_number(script, statement->near_value);
    within = script_number(script, statement->within);
    at = statement->at != NULL ? script_number(script, statement->at)
                               : result_times(script->result)[result_rows(script->result) - 1];
    if (result_reader_values_at(script->reader, &got, 1, at, &value, &diag) != OK) {
        script_fail(statement->text, &diag);
        return;
    }
    script->expects++;
    if (!(fabs(value - wanted) <= within)) {
        test_faults++;
        printf("%s\n    is %.15g, off by %.3g\n", statement->text, value, value - wanted);
    }
}

static void script_statement(Script *script, const Statement *statement, const Changes *changes);

static void script_lines(Script *script, const char *text, const Changes *changes)
{
    size_t next = 0, end = strlen(text);

    while (next < end) {
        Statement *statement = NULL;
        Diag diag = {0};

        if (statement_parse(text, 1, (SyntaxOptions){0}, &next, &statement, &diag) != OK) {
            script_fail("a line", &diag);
            return;
        }
        script_statement(script, statement, changes);
        statement_free(statement);
    }
}

static void script_statement(Script *script, const Statement *statement, const Changes *changes)
{
    static const char *const runs[] = {"simulate", "inverse", "kinematics", "assemble"};
    Diag diag = {0};

    if (statement->kind == STATEMENT_EMPTY)
        return;
    for (int i = 0; statement->kind == STATEMENT_VERB && i < COUNT(runs); i++)
        if (strcmp(statement->verb, runs[i]) == 0) {
            if (changes->before != NULL)
                script_lines(script, changes->before, &(Changes){0});
            script_run(script, statement, changes);
            return;
        }
    if (statement->kind == STATEMENT_VERB && strcmp(statement->verb, "expect") == 0) {
        if (!changes->skip_expects)
            script_expect(script, statement);
        return;
    }
    if (statement->kind == STATEMENT_VERB && strcmp(statement->verb, "export") == 0) {
        script->items.count = 0;
        for (int i = 1; i < statement->operands.count; i++)
            LIST_PUSH(script->items, script_expression(script, statement->operands.at[i].value));
        return;
    }
    if (statement->kind == STATEMENT_VERB && statement->row.room != ROOM_MODEL)
        return;
    if (model_apply(script->model, statement, &diag) != OK)
        script_fail(statement->text, &diag);
}

/* Run statements; a run's own failure is in script->status, other failures are the test's. */
__attribute__((unused)) static void script_open(Script *script, const char *text,
                                                const Changes *changes)
{
    *script = (Script){.model = model_new()};
    script_lines(script, text, changes);
}

__attribute__((unused)) static void script_close(Script *script)
{
    LIST_FREE(script->items);
    text_free(&script->remarks);
    result_reader_free(script->reader);
    result_free(script->result);
    system_free(script->system);
    model_free(script->model);
}

/* a variable at the end of the run, or at an instant */
__attribute__((unused)) static double value_at(Script *script, const char *text, double at)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Diag diag = {0};
    Expr e = NULL;
    double value = NAN;

    if (script->result == NULL || syntax_parse_expression(text, pool, &syntax, &diag) != OK ||
        model_expression(script->model, syntax, &e, &diag) != OK ||
        result_reader_values_at(script->reader, &e, 1, at, &value, &diag) != OK)
        script_fail(text, &diag);
    pool_free(pool);
    return value;
}

/* what its result has to say, in lines */
__attribute__((unused)) static const char *script_remarks(Script *script)
{
    text_free(&script->remarks);
    if (script->result != NULL)
        remarks_write(result_remarks(script->result), &script->remarks);
    return script->remarks.at != NULL ? script->remarks.at : "";
}

/* the text of a file of the sources; NULL and a fault when it isn't there */
__attribute__((unused)) static char *script_file(const char *path)
{
    const char *top = getenv("TOP_SRCDIR");
    Text name = {0}, text = {0};
    char buffer[4096];
    size_t got;
    FILE *file;

    text_addf(&name, "%s/%s", top != NULL ? top : ".", path);
    file = fopen(name.at, "r");
    if (file == NULL) {
        test_faults++;
        printf("can't read %s\n", name.at);
        text_free(&name);
        return NULL;
    }
    while ((got = fread(buffer, 1, sizeof buffer, file)) > 0)
        text_add_n(&text, buffer, got);
    (void)fclose(file);
    text_free(&name);
    return text_done(&text);
}

#endif

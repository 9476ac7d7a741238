/* session_model.c: a model as functions of numbers: formed, differentiated, compiled, named
 *
 * Here the functions of exported code (export/code.h) are compiled instead. Programs don't refer to
 * the arena that they were made from, so neither does a ct_model. */
#include "session/session_model.h"

#include "session/session_code.h"

#include <stdio.h>

/* what is at hand while one is made */
typedef struct SessionModelBuilder {
    ct_session *session;
    const Code *code;
    ct_model *model;
    Expr *inputs;
    const char *wanted; /* names of functions to be differentiated; NULL */
    Evaluator evaluator;
} SessionModelBuilder;

/* --- functions --- */

static Status compile(const SessionModelBuilder *making, const Expr *roots, int count,
                      Program **program, Native **native, Diag *diag)
{
    Status status = OK;

    CHECK(program_new(roots, count, making->inputs, making->model->input_count, program, diag));
    CHECK(monitor_poll(&making->session->watch));
    *native = simd_batch_native(*program, making->model->lanes, making->evaluator);
done:
    return status;
}

/* by the symbols of a part, row by row */
static Status differentiate(const SessionModelBuilder *making, const Expr *roots, int count,
                            CodeArray array, SessionSlopes *out, Diag *diag)
{
    Arena *arena = making->code->arena;
    const ct_model *model = making->model;
    LIST(Expr) slopes = {0};
    LIST(int) rows = {0};
    LIST(int) columns = {0};
    Status status = OK;

    for (int row = 0; row < count; row++) {
        Expr *symbols = NULL;
        const int found = expr_symbols(&roots[row], 1, &symbols);

        for (int i = 0; i < model->input_count; i++)
            for (int k = 0; k < found && model->inputs[i].array == array; k++)
                if (symbols[k] == making->inputs[i] && model->inputs[i].place >= 0) {
                    const Expr slope = expr_diff(arena, roots[row], symbols[k]);

                    if (expr_is_zero(slope))
                        continue;
                    LIST_PUSH(slopes, slope);
                    LIST_PUSH(rows, row);
                    LIST_PUSH(columns, model->inputs[i].place);
                }
        mem_free(symbols);
        CHECK(monitor_poll(&making->session->watch));
    }
    if (arena_status(arena) != OK) {
        status = diag_set(diag, arena_status(arena), "the derivatives are too long: %s",
                          arena_failure(arena));
        arena_reset(arena);
        goto done;
    }
    out->count = slopes.count;
    out->row = rows.at;
    out->column = columns.at;
    rows.at = columns.at = NULL;
    CHECK(compile(making, slopes.at, slopes.count, &out->program, &out->native, diag));
done:
    LIST_FREE(slopes);
    LIST_FREE(rows);
    LIST_FREE(columns);
    return status;
}

/* whether the name is one of the words in the text, separated by blanks */
static bool is_among(const char *words, const char *name)
{
    const size_t length = strlen(name);

    for (const char *c = words; c != NULL && (c = strstr(c, name)) != NULL; c += length)
        if ((c == words || c[-1] == ' ') && (c[length] == ' ' || c[length] == '\0'))
            return true;
    return false;
}

static Status add_function(const SessionModelBuilder *making, const char *name, const Expr *roots,
                           int rows, int columns, Diag *diag)
{
    static const CodeArray arrays[DIFFERENTIABLE] = {
        [CT_PARAMETERS] = CODE_P, [CT_STATE] = CODE_Y, [CT_SOLUTION] = CODE_S};
    ct_model *model = making->model;
    ModelFunction *f;
    Status status = OK;

    LIST_PUSH(model->functions, (ModelFunction){.name = pool_text(model->texts, name, strlen(name)),
                                                .rows = rows,
                                                .columns = columns});
    f = &model->functions.at[model->functions.count - 1];
    model->largest = rows * columns > model->largest ? rows * columns : model->largest;
    CHECK(compile(making, roots, rows * columns, &f->program, &f->native, diag));
    /* derivatives with the solution need those of the residual */
    f->has_slopes =
        is_among(making->wanted, name) || (making->wanted != NULL && strcmp(name, "residual") == 0);
    for (int part = 0; f->has_slopes && part < DIFFERENTIABLE; part++)
        CHECK(differentiate(making, roots, rows * columns, arrays[part], &f->slopes[part], diag));
done:
    return status;
}

static Status add_functions(const SessionModelBuilder *making, Diag *diag)
{
    const Code *code = making->code;
    ct_model *model = making->model;
    Expr *rows = NEW_ARRAY(Expr, code->ns);
    Status status = OK;

    for (int i = 0; i < code->functions.count; i++) {
        const CodeFunction *f = &code->functions.at[i];

        CHECK(add_function(making, f->name, code->roots.at + f->first, f->rows, f->columns, diag));
    }
    code_residual(code, rows);
    CHECK(add_function(making, "residual", rows, code->ns, 1, diag));
    for (int i = 0; i < model->input_count; i++)
        if (model->inputs[i].array == CODE_S)
            rows[model->inputs[i].place] = making->inputs[i];
    CHECK(add_function(making, "solution", rows, code->ns, 1, diag));
    model->accelerations = model_function_find(model, "accelerations");
    model->residual = model_function_find(model, "residual");
done:
    mem_free(rows);
    return status;
}

static Status check_wanted(const SessionModelBuilder *making, Diag *diag)
{
    const char *c = making->wanted;

    while (c != NULL && *c != '\0') {
        const size_t length = strcspn(c, " ");
        char *name = mem_text(c, length);
        const bool is_known = length == 0 || model_function_find(making->model, name) >= 0;
        const Status status =
            is_known ? OK : diag_set(diag, E_NAME, "the model has no function '%s'", name);

        mem_free(name);
        if (status != OK)
            return status;
        c += length + (c[length] == ' ');
    }
    return OK;
}

/* --- entries --- */

static const char *unit_of(const SessionModelBuilder *making, const char *name)
{
    Text text = {0};
    const char *out;

    session_unit(making->session, name, &text);
    out = text.length > 0 ? pool_text(making->model->texts, text.at, text.length) : "";
    text_free(&text);
    return out;
}

static void add_entry(const SessionModelBuilder *making, ct_part part, const char *name)
{
    ct_model *model = making->model;

    LIST_PUSH(model->entries[part],
              (ModelEntry){pool_text(model->texts, name, strlen(name)), unit_of(making, name)});
}

static void take_inputs(SessionModelBuilder *making)
{
    static const ct_part parts[] = {
        [CODE_P] = CT_PARAMETERS, [CODE_Y] = CT_STATE, [CODE_S] = CT_SOLUTION};
    const Code *code = making->code;
    const VariableIndex *l = code->layout;
    ct_model *model = making->model;

    model->input_count = code->inputs.count;
    model->inputs = NEW_ARRAY(struct ModelInput, code->inputs.count);
    making->inputs = NEW_ARRAY(Expr, code->inputs.count);
    for (int i = 0; i < code->inputs.count; i++) {
        const int of_layout = i - code->parameters.count;
        const CodeInput *input = &code->inputs.at[i];

        making->inputs[i] = of_layout < 0 ? code->parameters.at[i] : l->symbols[of_layout];
        model->inputs[i] = (struct ModelInput){
            input->array, input->place, stage_of_symbol(expr_symbol_kind(making->inputs[i]))};
    }
    /* in the order of their arrays, which isn't that of the layout */
    for (CodeArray array = CODE_P; array <= CODE_S; array++)
        for (int place = 0, i = 0; array != CODE_T && i < model->input_count; i++)
            if (model->inputs[i].array == array && model->inputs[i].place == place) {
                add_entry(making, parts[array], expr_name(making->inputs[i]));
                place++;
                i = -1;
            }
    for (int i = 0; i < code->outputs.count; i++)
        add_entry(making, CT_OUTPUTS, code->outputs.at[i]);
}

static void take_numbers(const SessionModelBuilder *making)
{
    const Code *code = making->code;
    ct_model *model = making->model;
    const int counts[] = {code->parameters.count, code->ny, code->ns};
    const double *from[] = {code->values, code->values + code->parameters.count,
                            code->states.count > 0 ? code->states.at[0].s : NULL};

    for (int part = 0; part < DIFFERENTIABLE; part++) {
        model->start[part] = pool_alloc(model->texts, (size_t)(counts[part] + 1) * sizeof(double));
        if (from[part] != NULL && counts[part] > 0)
            memcpy(model->start[part], from[part], (size_t)counts[part] * sizeof(double));
    }
}

static void take_structure(const SessionModelBuilder *making)
{
    const Code *code = making->code;
    const VariableIndex *l = code->layout;
    ct_model *model = making->model;

    model->n = l->n;
    model->nu = l->nu;
    model->nx = l->nx;
    model->m = l->m;
    model->ns = code->ns;
    model->is_redundant = code->is_redundant;
    model->group_count = code->group_count;
    memcpy(model->groups, code->groups, sizeof model->groups);
    for (int i = 0, first; (first = system_quaternion(l->system, i)) >= 0; i++)
        LIST_PUSH(model->quaternions, first);
}

/* --- the whole --- */

static Status check_options(const ct_model_options *options, Diag *diag)
{
    const int lanes = options->lanes;

    return lanes == 1 || lanes == 2 || lanes == 4 || lanes == 8
               ? OK
               : diag_set(diag, E_VALUE, "a model has 1, 2, 4 or 8 lanes, not %d", lanes);
}

static Status make(SessionModelBuilder *making, const Exported *what,
                   const ct_model_options *options, Diag *diag)
{
    ct_model *model = making->model = NEW(ct_model);
    Code *code = NEW(Code);
    Status status = OK;

    model->texts = pool_new(0);
    model->lanes = options->lanes;
    making->wanted = options->derivatives;
    making->evaluator = (Evaluator)model_setting_value(making->session->model, SETTING_EVALUATOR);
    making->code = code;
    CHECK(code_form(what, code, diag));
    CHECK(code_add_states(code, what, 0, diag));
    take_inputs(making);
    take_numbers(making);
    take_structure(making);
    CHECK(add_functions(making, diag));
    CHECK(check_wanted(making, diag));
done:
    code_free(code);
    mem_free(making->inputs);
    return status;
}

ct_status ct_model_new(ct_session *session, const ct_model_options *options, ct_model **out,
                       ct_error *error)
{
    SESSION_WORK(session, error);

    SessionModelBuilder making = {.session = session};
    ct_model_options asked = options != NULL ? *options : (ct_model_options){0};
    Exported what = {.view = session_view(session)};
    CodeItems items = {0};
    Diag diag = {0};
    Status status;

    session_begin(session);
    asked.lanes = asked.lanes == 0 ? 1 : asked.lanes;
    CHECK(check_options(&asked, &diag));
    for (int i = 0; i < asked.output_count; i++)
        CHECK(session_code_item(session, syntax_of(asked.outputs[i]), &items, &diag));
    CHECK(session_read_code(session, &items, false, &what, &diag));
    CHECK(make(&making, &what, &asked, &diag));
    *out = making.model;
    making.model = NULL;
done:
    code_items_free(&items);
    ct_model_free(making.model);
    return session_report(status, &diag, error);
}

void ct_model_free(ct_model *model)
{
    if (model == NULL)
        return;
    for (int i = 0; i < model->functions.count; i++) {
        ModelFunction *f = &model->functions.at[i];

        native_free(f->native);
        program_free(f->program);
        for (int part = 0; part < DIFFERENTIABLE; part++) {
            native_free(f->slopes[part].native);
            program_free(f->slopes[part].program);
            MEM_FREE(f->slopes[part].row, f->slopes[part].column);
        }
    }
    LIST_FREE(model->functions);
    for (int part = 0; part <= CT_OUTPUTS; part++)
        LIST_FREE(model->entries[part]);
    LIST_FREE(model->quaternions);
    mem_free(model->inputs);
    pool_free(model->texts);
    mem_free(model);
}

/* --- what there is --- */

int ct_model_size(const ct_model *model, ct_part part)
{
    return model->entries[part].count;
}

const char *ct_model_name(const ct_model *model, ct_part part, int i)
{
    return i >= 0 && i < model->entries[part].count ? model->entries[part].at[i].name : NULL;
}

const char *ct_model_unit(const ct_model *model, ct_part part, int i)
{
    return i >= 0 && i < model->entries[part].count ? model->entries[part].at[i].unit : NULL;
}

int ct_model_find(const ct_model *model, ct_part part, const char *name)
{
    for (int i = 0; i < model->entries[part].count; i++)
        if (strcmp(model->entries[part].at[i].name, name) == 0)
            return i;
    return -1;
}

void ct_model_start(const ct_model *model, double *p, double *y, double *s)
{
    double *const arrays[DIFFERENTIABLE] = {p, y, s};

    for (int part = 0; part < DIFFERENTIABLE; part++)
        if (arrays[part] != NULL && model->entries[part].count > 0)
            memcpy(arrays[part], model->start[part],
                   (size_t)model->entries[part].count * sizeof(double));
}

int model_function_find(const ct_model *model, const char *name)
{
    for (int i = 0; i < model->functions.count; i++)
        if (strcmp(model->functions.at[i].name, name) == 0)
            return i;
    return -1;
}

int ct_model_function(const ct_model *model, const char *name, int *rows, int *columns)
{
    const int i = model_function_find(model, name);

    if (i >= 0 && rows != NULL)
        *rows = model->functions.at[i].rows;
    if (i >= 0 && columns != NULL)
        *columns = model->functions.at[i].columns;
    return i;
}

const char *ct_model_function_name(const ct_model *model, int function)
{
    return function >= 0 && function < model->functions.count ? model->functions.at[function].name
                                                              : NULL;
}

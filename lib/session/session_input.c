/* session_input.c: the input of a run, made from the present model */
#include "session/session_impl.h"

/* --- parameters --- */

static void keep_value(ParameterValues *values, Expr symbol)
{
    LIST_PUSH(values->symbols, symbol);
    LIST_PUSH(values->values, model_parameter_value(values->model, symbol));
    while (values->places.count <= expr_symbol_number(symbol))
        LIST_PUSH(values->places, 0);
    values->places.at[expr_symbol_number(symbol)] = values->symbols.count;
}

static ParameterValues *parameters_now(const Model *model, const System *system)
{
    ParameterValues *values = NEW(ParameterValues);

    values->model = model;
    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;

        keep_value(values, model_parameter(model, i, &definition));
    }
    for (int i = 0; system_lifted_constant(system, i) != NULL; i++)
        keep_value(values, system_lifted_constant(system, i));
    return values;
}

/* as the run had it; a parameter made since, as it is now */
static double parameter_value(void *context, Expr symbol)
{
    const ParameterValues *values = context;
    const int number = expr_symbol_number(symbol);
    const int at = number < values->places.count ? values->places.at[number] - 1 : -1;

    if (at >= 0 && values->symbols.at[at] == symbol)
        return values->values.at[at];
    return model_parameter_value(values->model, symbol);
}

double run_number(const Run *run, Expr e)
{
    return expr_evaluate(e, parameter_value, run->parameters);
}

void run_free(Run *run)
{
    result_reader_free(run->reader);
    result_free(run->result);
    if (run->parameters != NULL) {
        mem_keep(run->parameters);
        LIST_FREE(run->parameters->places);
        LIST_FREE(run->parameters->symbols);
        LIST_FREE(run->parameters->values);
    }
    mem_free(run->parameters);
    if (run->host != NULL) {
        mem_keep(run->host);
        LIST_FREE(run->host->values);
    }
    mem_free(run->host);
    *run = (Run){0};
}

/* --- the input of a run --- */

void run_input_free(RunInput *input)
{
    MEM_FREE(input->start.at, input->events);
    watch_free(&input->watch);

    Run run = {.parameters = input->parameters, .host = input->host};

    run_free(&run);
}

void run_input_make(ct_session *session, const System *system, RunInput *input)
{
    const Model *model = session->model;
    const int count = model_start_count(model);

    /* the runs of a sweep are shared among processes */
    threads_set(session->threads,
                session->is_sweeping ? 1 : 1 + model_setting_value(model, SETTING_JOBS));
    input->parameters = parameters_now(model, system);
    input->start.at = mem_array((size_t)count, sizeof *input->start.at);
    for (int i = 0; i < count; i++) {
        const Start *start = model_start(model, i);

        input->start.at[input->start.count++] =
            (StartValue){.name = start->name,
                         .primes = start->primes,
                         .value = model_number(model, start->value),
                         .is_guess = start->is_guess};
    }
    input->events = mem_array((size_t)model_event_count(model), sizeof *input->events);
    for (int i = 0; i < model_event_count(model); i++)
        input->events[i] = model_event(model, i);
    input->setting =
        (SimulationInput){.parameter = parameter_value,
                          .context = input->parameters,
                          .scene = model_scene_source(model),
                          .events = input->events,
                          .event_count = model_event_count(model),
                          .start = &input->start,
                          .evaluator = (Evaluator)model_setting_value(model, SETTING_EVALUATOR),
                          .threads = session->threads,
                          .watch = &session->watch};
    input->setting.form =
        model_form(model, &input->setting.independent, &input->setting.independent_count);
}

void run_input_go_on(RunInput *input, const Run *old)
{
    const System *system = result_system(old->result);
    ParameterValues *values = input->parameters;

    for (int i = 0; system_lifted_constant(system, i) != NULL; i++)
        values->values
            .at[values->places.at[expr_symbol_number(system_lifted_constant(system, i))] - 1] =
            parameter_value(old->parameters, system_lifted_constant(system, i));
}

void run_input_host(RunInput *input, const Host *host, const Run *old)
{
    const Host *before = old != NULL ? old->host : NULL;

    if (host == NULL && before == NULL)
        return;
    input->host = input->setting.host = NEW(Host);
    if (host != NULL)
        *input->host = *host;
    for (int i = 0; before != NULL && i < before->values.count; i++)
        LIST_PUSH(input->host->values, before->values.at[i]);
}

Run run_input_done(RunInput *input, Result *result, ResultReader *reader)
{
    Run run = {result, reader, input->parameters, input->host};

    if (input->host != NULL) /* functions of the embedding program aren't called after the run */
        *input->host = (Host){.values = input->host->values};
    input->parameters = NULL;
    input->host = NULL;
    return run;
}

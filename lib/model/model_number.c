/* model_number.c: current values of parameters and of expressions of them */
#include "model/model_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- values of parameters --- */

static double known_value(void *context, Expr symbol)
{
    const State *state = context;
    const Definition *d = definition_find(state, expr_name(symbol), DEFINES_PARAMETER);

    return d != NULL ? d->value : (double)NAN;
}

double state_lifted_constant(State *state, const char *name)
{
    const char *dot = strrchr(name, '.'), *bracket = strrchr(name, '[');
    double value = NAN;
    char *owner, *key;
    const Instance *part;
    int param;

    if (dot == NULL || bracket == NULL || bracket < dot)
        return value;
    owner = mem_text(name + 1, (size_t)(dot - name) - 1);
    key = mem_text(dot + 1, (size_t)(bracket - dot) - 1);
    part = state_part(state, owner);
    param = part != NULL ? component_param(part->row, key) : -1;
    if (param >= 0) {
        const int entry = (int)strtol(bracket + 1, NULL, 10);

        if (entry < part->values[param].count)
            value = expr_evaluate(part->values[param].at[entry], known_value, state);
    }
    mem_free(owner);
    mem_free(key);
    return value;
}

/* pushes the parameters that must be known first; returns whether there were any */
static bool push_unknown(const State *state, Expr body, NumberList *stack)
{
    Expr *symbols = NULL;
    int count = expr_symbols(&body, 1, &symbols);
    int before = stack->count;

    for (int i = 0; i < count; i++) {
        const Definition *d = definition_find(state, expr_name(symbols[i]), DEFINES_PARAMETER);

        if (d != NULL && !d->is_known)
            LIST_PUSH(*stack, definition_index(state, d));
    }
    mem_free(symbols);
    return stack->count > before;
}

double definition_value(State *state, int definition)
{
    NumberList stack = {0};

    LIST_PUSH(stack, definition);
    while (stack.count > 0) {
        Definition *d = &state->definitions.at[stack.at[stack.count - 1]];

        const Override *override = override_find(state, d->name);

        if (d->is_known || override != NULL || !push_unknown(state, d->body, &stack)) {
            mem_keep_part(state->definitions.at, d, sizeof *d);
            if (!d->is_known)
                d->value =
                    override != NULL ? override->value : expr_evaluate(d->body, known_value, state);
            d->is_known = true;
            stack.count--;
        }
    }
    LIST_FREE(stack);
    return state->definitions.at[definition].value;
}

void definitions_forget_values(State *state)
{
    for (int i = 0; i < state->parameters.count; i++) {
        Definition *d = &state->definitions.at[state->parameters.at[i].index];

        if (!d->is_known)
            continue;
        mem_keep_part(state->definitions.at, d, sizeof *d);
        d->is_known = false;
    }
}

double state_number(State *state, Expr body)
{
    NumberList stack = {0};

    (void)push_unknown(state, body, &stack);
    for (int i = 0; i < stack.count; i++)
        (void)definition_value(state, stack.at[i]);
    LIST_FREE(stack);
    return expr_evaluate(body, known_value, state);
}

double state_number_now(const State *state, Expr body)
{
    Expr *symbols = NULL;
    int count = expr_symbols(&body, 1, &symbols);

    /* parameters depend on others, and none on itself */
    while (count > 0) {
        for (int i = 0; i < count; i++) {
            const Definition *d = definition_find(state, expr_name(symbols[i]), DEFINES_PARAMETER);

            if (d == NULL) {
                mem_free(symbols);
                return NAN;
            }
            const Override *override = override_find(state, d->name);
            const Expr value =
                override != NULL ? expr_real(state->arena, override->value) : d->body;

            body = expr_substitute(state->arena, body, &symbols[i], &value, 1);
        }
        mem_free(symbols);
        symbols = NULL;
        count = arena_status(state->arena) == OK ? expr_symbols(&body, 1, &symbols) : 0;
    }
    mem_free(symbols);
    return expr_evaluate(body, NULL, NULL);
}

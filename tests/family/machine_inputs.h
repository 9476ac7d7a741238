/* machine_inputs.h: sources, actuators, and numbers of any part that become parameters */
#ifndef COTREE_TESTS_MACHINE_INPUTS_H
#define COTREE_TESTS_MACHINE_INPUTS_H

#include "machine_slopes.h"

#include <ctype.h>

/* numbers of a machine that a script may write as a parameter */
typedef struct CompiledEquations {
    double *at[8 * LOADS + 20 * ELEMENTS + 3 * PLACES];
    int count;
} CompiledEquations;

static inline void take_numbers(CompiledEquations *n, double *first, const double *last)
{
    for (; first <= last; first++)
        n->at[n->count++] = first;
}

static inline void find_numbers(Machine *m, CompiledEquations *n)
{
    n->count = 0;
    take_numbers(n, m->mass, m->mass + m->bodies - 1);
    for (int i = 0; i < m->places; i++)
        take_numbers(n, m->place[i].r.at, m->place[i].r.at + 2);
    for (int i = 0; i < m->loads; i++) {
        take_numbers(n, &m->load[i].k, &m->load[i].drag);
        for (int k = 0; k < 3; k++)
            take_numbers(n, &m->load[i].wave[k].low, &m->load[i].wave[k].size);
    }
    for (int i = 0; i < m->elements; i++) {
        take_numbers(n, &m->element[i].value, &m->element[i].high);
        take_numbers(n, &m->element[i].wave.low, &m->element[i].wave.size);
    }
    for (int j = 0; j < m->hinges; j++)
        take_numbers(n, &m->hinge[j].pitch, &m->hinge[j].pitch);
}

/* where a number stands in a script, once; NULL: it doesn't */
static inline char *place_of(char *text, const char *number)
{
    char *found = strstr(text, number);

    if (found == NULL || strlen(number) < 10 || strstr(found + 1, number) != NULL)
        return NULL;
    if (found > text && (isdigit((unsigned char)found[-1]) || found[-1] == '.'))
        return NULL;
    return isdigit((unsigned char)found[strlen(number)]) || found[strlen(number)] == 'e' ? NULL
                                                                                         : found;
}

/* a number becomes a parameter; false: it isn't written */
static inline bool make_parameter(Script *script, double number, const char *name)
{
    static char rest[sizeof script->text];
    char text[40];
    char *found;

    (void)snprintf(text, sizeof text, "%.17g", number);
    found = place_of(script->text, text);
    if (found == NULL)
        return false;
    (void)snprintf(rest, sizeof rest, "%s", found + strlen(text));
    script->length = (size_t)(found - script->text);
    write_piece(script, "%s%s", name, rest);
    (void)snprintf(rest, sizeof rest, "%s", script->text);
    script->length = 0;
    write_piece(script, "%s = %s\n%s", name, text, rest);
    return true;
}

/* NOLINTNEXTLINE(readability-non-const-parameter): it is changed later */
static inline void add_input(Slopes *s, double *number, double sign, const char *name)
{
    SlopeInput *in = &s->input[s->inputs++];

    *in = (SlopeInput){.number = number, .sign = sign, .step = 1e-3 * (1 + fabs(*number))};
    (void)snprintf(in->name, sizeof in->name, "%s", name);
}

static inline void draw_inputs(Member *member, Slopes *s)
{
    Machine *m = &s->d->m;
    static CompiledEquations numbers;

    for (int i = 0; i < m->elements && s->inputs < 2; i++)
        if ((m->element[i].kind == ACROSS || m->element[i].kind == THROUGH) && chance(member, 0.6))
            add_input(s, &m->element[i].wave.low, m->element[i].kind == ACROSS ? 1 : -1,
                      m->element[i].name);
    for (int i = 0; i < m->loads && s->inputs < 3; i++)
        if (m->load[i].kind == ALONG && m->load[i].k == 0 && chance(member, 0.6))
            add_input(s, &m->load[i].wave[0].low, 1, m->load[i].name);
    find_numbers(m, &numbers);
    for (int tries = 0; tries < 40 && s->inputs < INPUTS; tries++) {
        double *number = numbers.at[member_one_of(member, numbers.count)];
        char name[16];
        bool taken = *number == 0;

        for (int i = 0; i < s->inputs; i++)
            taken = taken || s->input[i].number == number;
        (void)snprintf(name, sizeof name, "P%d", s->inputs);
        if (!taken && make_parameter(&s->d->script, *number, name)) {
            add_input(s, number, 1, name);
            s->input[s->inputs - 1].step = 3e-4 * fabs(*number);
        }
    }
}

#endif

/* machine_hybrid_draw.h: random switches, diodes, sampled blocks and events of a machine */
#ifndef COTREE_TESTS_MACHINE_HYBRID_DRAW_H
#define COTREE_TESTS_MACHINE_HYBRID_DRAW_H

#include "machine_hybrid.h"

/* --- conditions --- */

static inline const char *state_name(const Machine *m, const Element *e)
{
    (void)m;
    return e->kind == CAPACITY || e->kind == PLATE || e->kind == PIEZO ? "v" : "i";
}

/* an electrical state of its own; -1: none */
static inline int draw_state(Member *member, const Machine *m)
{
    for (int tries = 0; tries < 12 && m->elements > 0; tries++) {
        const int i = member_one_of(member, m->elements);
        const Element *e = &m->element[i];

        if (e->state >= 0 && e->first && m->node_domain[e->p] == ELECTRIC &&
            (e->kind == CAPACITY || e->kind == INERTANCE || e->kind == MOTOR || e->kind == COIL ||
             e->kind == PLATE || e->kind == PIEZO))
            return i;
    }
    return -1;
}

static inline Signal draw_signal(Member *member, const Drawn *d)
{
    const Machine *m = &d->m;
    Signal s = {.kind = (SignalKind)member_one_of(member, 5), .sign = chance(member, 0.5) ? 1 : -1};
    char name[180], level[40];

    s.index = s.kind == SIGNAL_BODY    ? member_one_of(member, m->bodies)
              : s.kind == SIGNAL_STATE ? draw_state(member, m)
                                       : draw_coordinate(member, m, -1);
    if (s.index < 0)
        s.kind = SIGNAL_WAVE;
    s.level = some(member, s.kind == SIGNAL_RATE ? 2 : 0.7);
    switch (s.kind) {
    case SIGNAL_WAVE:
        s.wave = (Wave){0, 1, member_between(member, 5, 40), some(member, 3)};
        (void)snprintf(name, sizeof name, "sin(%.17g*t + %.17g)", s.wave.pace, s.wave.phase);
        break;
    case SIGNAL_PLACE:
        (void)snprintf(name, sizeof name, "%s", m->coordinate[s.index].name);
        s.level += d->q[m->coordinate[s.index].hinge]
                       [s.index - m->hinge[m->coordinate[s.index].hinge].coordinate];
        break;
    case SIGNAL_RATE:
        (void)snprintf(name, sizeof name, "%s'", m->coordinate[s.index].name);
        break;
    case SIGNAL_BODY:
        s.axis = member_one_of(member, m->planar ? 2 : 3);
        (void)snprintf(name, sizeof name, "b%d.%c", s.index, "xyz"[s.axis]);
        break;
    case SIGNAL_STATE:
        (void)snprintf(name, sizeof name, "%s.%s", m->element[s.index].name,
                       state_name(m, &m->element[s.index]));
        break;
    }
    (void)snprintf(level, sizeof level, "%.17g", s.level);
    (void)snprintf(s.text, sizeof s.text, "%s %s %s", name, s.sign > 0 ? ">" : "<", level);
    if (chance(member, 0.2)) {
        char more[60];

        s.after = member_between(member, 0.03, 0.3);
        (void)snprintf(more, sizeof more, " && t > %.17g", s.after);
        (void)strncat(s.text, more, sizeof s.text - strlen(s.text) - 1);
    }
    return s;
}

/* --- parts --- */

static inline void draw_sides(Member *member, Element *e, bool ideal, Script *script)
{
    if (ideal)
        return;
    e->low = member_decades(member, 0.05, 1);
    e->high = member_between(member, 50, 400);
    write_piece(script, " Ron=%.17g Roff=%.17g", e->low, e->high);
}

static inline void draw_switch(Member *member, Hybrid *h, int p, int m)
{
    Drawn *d = &h->d;
    CallMonitor *w = &h->watch[h->watches++];
    Element *e;

    *w = (CallMonitor){
        .kind = WATCH_SWITCH, .signal = draw_signal(member, d), .element = d->m.elements};
    e = new_element(&d->m, SWITCH, p, m);
    write_element(d, "switch", e, "");
    write_piece(&d->script, " when=(%s)", w->signal.text);
    draw_sides(member, e, chance(member, 0.6), &d->script);
    write_line(&d->script, "%s", "");
}

static inline void draw_diode(Member *member, Hybrid *h, int p, int m, bool ideal)
{
    Drawn *d = &h->d;
    CallMonitor *w = &h->watch[h->watches++];
    Element *e;

    *w = (CallMonitor){.kind = WATCH_DIODE, .element = d->m.elements};
    e = new_element(&d->m, DIODE, p, m);
    write_element(d, "diode", e, "");
    draw_sides(member, e, ideal, &d->script);
    if (chance(member, 0.5)) {
        e->rest = member_between(member, 0.1, 0.8);
        write_piece(&d->script, " Vf=%.17g", e->rest);
    }
    write_line(&d->script, "%s", "");
}

static inline void draw_block(Member *member, Hybrid *h, int node)
{
    static const char *const words[] = {"pd", "pid", "gain", "integrator", "lag", "transfer"};
    Drawn *d = &h->d;
    Machine *m = &d->m;
    Block *b = &h->block[h->blocks++];
    const int c = draw_coordinate(member, m, -1);
    const char *of;
    char text[160], potential[30];
    Element *e;

    *b = (Block){.kind = (BlockKind)member_one_of(member, 6), .element = m->elements, .of = c};
    b->period = member_between(member, 0.01, 0.12);
    if (c < 0 || chance(member, 0.2)) {
        b->of = node > 1 ? -1 - member_one_of(member, node - 1) : c;
        if (b->of < 0 && (node <= 1 || m->node_domain[-b->of] != ELECTRIC))
            b->of = c >= 0 ? c : -node;
    }
    e = new_element(m, HELD, node, 0);
    write_element(d, words[b->kind], e, "");
    (void)snprintf(potential, sizeof potential, "%s.v", node_name(m, b->of < 0 ? -b->of : 0));
    of = b->of >= 0 ? m->coordinate[b->of].name : potential;
    b->Kp = member_between(member, 1, 8) * (b->of < 0 ? 0.1 : 1);
    write_piece(&d->script, " of=%s period=%.17g", of, b->period);
    switch (b->kind) {
    case BLOCK_PD:
    case BLOCK_PID:
        b->ref = draw_wave(member, 1);
        b->Kd = b->kind == BLOCK_PD || chance(member, 0.6) ? member_between(member, 0.02, 0.4) : 0;
        b->T = chance(member, 0.5) ? member_between(member, 0.02, 0.2) : 0;
        write_piece(&d->script, " ref=%s Kp=%.17g", wave_text(&b->ref, 1, text), b->Kp);
        if (b->Kd != 0)
            write_piece(&d->script, " Kd=%.17g", b->Kd);
        if (b->T > 0)
            write_piece(&d->script, " filter=%.17g", b->T);
        if (b->kind == BLOCK_PID) {
            b->Ki = member_between(member, 0.5, 10);
            b->x = chance(member, 0.5) ? some(member, 0.3) : 0;
            write_piece(&d->script, " Ki=%.17g initial=%.17g", b->Ki, b->x);
        }
        break;
    case BLOCK_GAIN:
        write_piece(&d->script, " k=%.17g", b->Kp);
        break;
    case BLOCK_INTEGRATOR:
    case BLOCK_LAG:
        b->x = chance(member, 0.5) ? some(member, 1) : 0;
        b->T = member_between(member, 0.02, 0.3);
        write_piece(&d->script, " k=%.17g initial=%.17g", b->Kp, b->x);
        if (b->kind == BLOCK_LAG)
            write_piece(&d->script, " T=%.17g", b->T);
        break;
    case BLOCK_TRANSFER:
        for (int k = 0; k < 3; k++)
            b->b[k] = some(member, 2);
        b->a[0] = member_between(member, 1, 6);
        b->a[1] = member_between(member, 1, 60);
        write_piece(&d->script, " num=[%.17g, %.17g, %.17g] den=[1, %.17g, %.17g]", b->b[0],
                    b->b[1], b->b[2], b->a[0], b->a[1]);
        break;
    }
    b->limited = chance(member, 0.3);
    if (b->limited) {
        b->high = member_between(member, 0.5, 5);
        b->low = -member_between(member, 0.5, 5);
        write_piece(&d->script, " limits=[%.17g, %.17g]", b->low, b->high);
    }
    write_line(&d->script, "%s", "");
}

static inline void plain_resistance(Member *member, Drawn *d, int p, int m)
{
    Element *e = new_element(&d->m, RESISTANCE, p, m);

    e->value = member_decades(member, 0.5, 20);
    write_element(d, "resistor", e, "");
    write_line(&d->script, " %.17g", e->value);
}

/* a source, sampled or not, that feeds parts by way of a switch or a diode */
static inline void draw_switched(Member *member, Hybrid *h)
{
    Drawn *d = &h->d;
    Machine *m = &d->m;
    int node, next, capacity = -1;

    if (m->elements > ELEMENTS - 9 || m->nodes > NODES - 4)
        return;
    node = new_node(m, ELECTRIC);
    if (h->blocks < BLOCKS && chance(member, 0.6))
        draw_block(member, h, node);
    else
        draw_source(member, d, node);
    next = new_node(m, ELECTRIC);
    plain_resistance(member, d, node, next);
    node = next;
    if (h->watches < WATCHES - 2 && chance(member, 0.6)) {
        next = new_node(m, ELECTRIC);
        if (chance(member, 0.5))
            draw_switch(member, h, node, next);
        else if (chance(member, 0.5))
            draw_diode(member, h, node, next, chance(member, 0.6));
        else
            draw_diode(member, h, next, node, chance(member, 0.6));
        plain_resistance(member, d, next, 0);
        node = next;
    }
    for (int k = 1 + member_one_of(member, 2); k > 0; k--)
        draw_shunt(member, d, node, &capacity);
    if (h->watches < WATCHES - 1 && chance(member, 0.4)) { /* one that takes over */
        const bool up = chance(member, 0.5);

        draw_diode(member, h, up ? node : 0, up ? 0 : node, capacity < 0 && chance(member, 0.5));
    }
}

static inline void draw_event(Member *member, Hybrid *h, int number, bool may_stop)
{
    Drawn *d = &h->d;
    Machine *m = &d->m;
    CallMonitor *w = &h->watch[h->watches++];
    const int c = draw_coordinate(member, m, -1), e = draw_state(member, m),
              kind = member_one_of(member, 3);

    *w = (CallMonitor){.kind = WATCH_EVENT, .target = -1, .state = -1, .factor = some(member, 1)};
    w->signal = draw_signal(member, d);
    w->add = chance(member, 0.3) ? some(member, 0.5) : 0;
    write_piece(&d->script, "event ev%d when=(%s)", number, w->signal.text);
    if (kind == 0 && c >= 0) {
        const char *name = m->coordinate[c].name;

        w->target = c;
        write_line(&d->script, " %s'=%.17g*%s' + %.17g", name, w->factor, name, w->add);
    } else if (kind == 1 && e >= 0) {
        const char *name = m->element[e].name, *of = state_name(m, &m->element[e]);

        w->state = m->element[e].state;
        write_line(&d->script, " %s.%s=%.17g*%s.%s + %.17g", name, of, w->factor, name, of, w->add);
    } else {
        w->stops = chance(member, 0.5) && may_stop;
        write_line(&d->script, " do=%s", w->stops ? "stop" : "mark");
    }
}

/* --- whole --- */

/* false: nothing jumps in it */
static inline bool draw_hybrid(Member *member, Hybrid *h, bool may_stop)
{
    Drawn *d = &h->d;
    int events;

    memset(h, 0, sizeof *h);
    while (!draw_machine(member, d))
        ;
    /* its start is written anew, with what comes on top */
    for (int k = 1 + member_one_of(member, 2); k > 0; k--) {
        Real states[2 * ELEMENTS];
        const Machine *m = &d->m;
        const int from = 13 * m->bodies + m->coordinates;

        memcpy(states, d->y + from, sizeof states);
        memset(d->y + from, 0, sizeof states);
        for (int i = 0; i < m->states; i++)
            d->y[13 * BODIES + TURNS + i] = states[i];
        draw_switched(member, h);
        for (int i = 0; i < m->states; i++)
            states[i] = d->y[13 * BODIES + TURNS + i];
        memset(d->y + from, 0, (MOST_STATES - (size_t)from) * sizeof(Real));
        for (int i = 0; i < m->states; i++)
            d->y[from + i] = states[i];
    }
    events = member_one_of(member, 3);
    for (int k = 0; k < events && h->watches < WATCHES; k++)
        draw_event(member, h, k, may_stop);
    return h->watches + h->blocks > 0;
}

#endif

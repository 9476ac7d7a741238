/* machine_networks.h: random networks of four domains about the joints of a mechanism */
#ifndef COTREE_TESTS_MACHINE_NETWORKS_H
#define COTREE_TESTS_MACHINE_NETWORKS_H

#include "machine_draw.h"

/* --- networks --- */

static int new_node(Machine *m, int domain)
{
    (void)snprintf(m->node[m->nodes], sizeof m->node[0], "n%d", m->nodes);
    m->node_domain[m->nodes] = domain;
    return m->nodes++;
}

typedef enum Domain { ELECTRIC, SHAFT, SLIDE, HYDRAULIC } Domain;

static Element *new_element(Machine *m, ElementKind kind, int p, int minus)
{
    Element *e = &m->element[m->elements];

    *e = (Element){.kind = kind, .p = p, .m = minus, .state = -1, .more = -1, .first = true};

    (void)snprintf(e->name, sizeof e->name, "e%d", m->elements);
    m->elements++;
    return e;
}

static const char *node_name(const Machine *m, int node)
{
    return node == 0 ? "0" : m->node[node];
}

static void write_element(Drawn *d, const char *word, const Element *e, const char *joint)
{
    write_piece(&d->script, "%s %s %s%s%s %s", word, e->name, joint, joint[0] != '\0' ? " " : "",
                node_name(&d->m, e->p), node_name(&d->m, e->m));
}

/* a coordinate that is a shift or a turn; -1: there is none */
static int draw_coordinate(Member *member, const Machine *m, int shift)
{
    int tries = 12;

    while (m->coordinates > 0 && tries-- > 0) {
        const int c = member_one_of(member, m->coordinates);

        if (shift < 0 || m->coordinate[c].shift == shift)
            return c;
    }
    return -1;
}

static void draw_source(Member *member, Drawn *d, int node)
{
    Machine *m = &d->m;
    const int c = draw_coordinate(member, m, -1);
    const int kind = c < 0 ? 0 : still ? 4 * member_one_of(member, 2) : member_one_of(member, 5);
    Element *e;
    char text[160];

    if (kind < 2) {
        e = new_element(m, ACROSS, node, 0);
        e->wave = draw_wave(member, 6);
        write_element(d, "vsource", e, "");
        write_line(&d->script, " %s", wave_text(&e->wave, 1, text));
        return;
    }
    e = new_element(m, kind == 2 ? PD : kind == 3 ? PID : LAG, node, 0);
    e->coordinate = c;
    e->wave = draw_wave(member, 1);
    e->limited = chance(member, 0.25);
    e->high = member_between(member, 0.5, 6);
    e->low = -member_between(member, 0.5, 6);
    if (e->kind == LAG) {
        e->K = some(member, 4);
        e->T = member_between(member, 0.05, 0.5);
        e->state = m->states++;
        write_element(d, "lag", e, "");
        write_piece(&d->script, " of=%s k=%.17g T=%.17g", m->coordinate[c].name, e->K, e->T);
    } else {
        e->Kp = member_between(member, 1, 12);
        e->Kd = member_between(member, 0.05, 0.8);
        if (chance(member, 0.4)) {
            e->T = member_between(member, 0.02, 0.2);
            e->more = m->states++;
        }
        if (e->kind == PID) {
            e->Ki = member_between(member, 0.5, 10);
            e->state = m->states++;
        }
        write_element(d, e->kind == PD ? "pd" : "pid", e, "");
        write_piece(&d->script, " ref=%s of=%s Kp=%.17g Kd=%.17g", wave_text(&e->wave, 1, text),
                    m->coordinate[c].name, e->Kp, e->Kd);
        if (e->kind == PID)
            write_piece(&d->script, " Ki=%.17g", e->Ki);
        if (e->T > 0)
            write_piece(&d->script, " filter=%.17g", e->T);
    }
    if (e->limited)
        write_piece(&d->script, " limits=[%.17g, %.17g]", e->low, e->high);
    write_line(&d->script, "%s", "");
}

/* the start of a state of a network, told */
static void begin_state(Member *member, Drawn *d, const Element *e, const char *name, double size)
{
    const double z = some(member, size);

    if (!e->first)
        return;
    d->y[13 * BODIES + TURNS + e->state] = z;

    write_line(&d->script, "init %s.%s = %.17g", e->name, name, z);
}

/* --- what stands between a node and the datum --- */

/* a part of a circuit there, at the coordinate c if it has one */
typedef Element *DrawPart(Member *member, Drawn *d, int node, int c);

/* of two terminals and a value; `least` and what it may be times */
static Element *draw_plain(Member *member, Drawn *d, int node, ElementKind kind, const char *word,
                           double least, double most)
{
    Element *e = new_element(&d->m, kind, node, 0);

    e->value = member_decades(member, least, most);
    write_element(d, word, e, "");
    write_line(&d->script, " %.17g", e->value);
    return e;
}

static Element *draw_resistance(Member *member, Drawn *d, int node, int c)
{
    (void)c;
    return draw_plain(member, d, node, RESISTANCE, "resistor", 0.5, 20);
}

static Element *draw_capacity(Member *member, Drawn *d, int node, int c)
{
    (void)c;
    return draw_plain(member, d, node, CAPACITY, "capacitor", 0.005, 0.2);
}

static Element *draw_inductance(Member *member, Drawn *d, int node, int c)
{
    (void)c;
    return draw_plain(member, d, node, INERTANCE, "inductor", 0.05, 2);
}

static Element *draw_motor(Member *member, Drawn *d, int node, int c)
{
    Element *e = new_element(&d->m, MOTOR, node, 0);

    e->R = member_decades(member, 0.3, 5);
    e->L = chance(member, 0.6) ? member_decades(member, 0.02, 0.5) : 0;
    e->K = member_between(member, 0.1, 0.6);
    e->Kv = chance(member, 0.6) ? e->K : member_between(member, 0.1, 0.6);
    e->J = chance(member, 0.5) ? member_decades(member, 1e-3, 0.1) : 0;
    e->B = chance(member, 0.5) ? member_decades(member, 1e-3, 0.1) : 0;
    e->ratio = chance(member, 0.5) ? 1 : some(member, 4);
    e->coordinate = c;
    write_element(d, "motor", e, d->m.coordinate[c].name);
    write_line(&d->script, " R=%.17g L=%.17g Kt=%.17g Kv=%.17g J=%.17g B=%.17g ratio=%.17g", e->R,
               e->L, e->K, e->Kv, e->J, e->B, e->ratio);
    return e;
}

static Element *draw_coil(Member *member, Drawn *d, int node, int c)
{
    Element *e = new_element(&d->m, COIL, node, 0);
    const char *joint = d->m.coordinate[c].name;

    e->R = member_decades(member, 0.3, 5);
    e->L = chance(member, 0.6) ? member_decades(member, 0.02, 0.5) : 0;
    e->K = some(member, 0.8);
    e->bend = chance(member, 0.5) ? some(member, 0.6) : 0;
    e->pace = some(member, 3);
    e->coordinate = c;
    write_element(d, "voicecoil", e, joint);
    write_line(&d->script, " K=%.17g*(1 + %.17g*sin(%.17g*%s)) R=%.17g L=%.17g", e->K, e->bend,
               e->pace, joint, e->R, e->L);
    return e;
}

static Element *draw_solenoid(Member *member, Drawn *d, int node, int c)
{
    Element *e = new_element(&d->m, SOLENOID, node, 0);
    const char *joint = d->m.coordinate[c].name;

    e->value = member_decades(member, 0.05, 0.8);
    e->R = member_decades(member, 0.3, 5);
    e->bend = some(member, 0.7);
    e->pace = some(member, 3);
    e->coordinate = c;
    write_element(d, "solenoid", e, joint);
    write_line(&d->script, " L=%.17g*(1 + %.17g*sin(%.17g*%s)) R=%.17g", e->value, e->bend, e->pace,
               joint, e->R);
    return e;
}

static Element *draw_plates(Member *member, Drawn *d, int node, int c)
{
    Element *e = new_element(&d->m, PLATE, node, 0);
    const char *joint = d->m.coordinate[c].name;

    e->value = member_decades(member, 0.01, 0.2);
    e->bend = some(member, 0.7);
    e->pace = some(member, 3);
    e->coordinate = c;
    write_element(d, "platecap", e, joint);
    write_line(&d->script, " C=%.17g*(1 + %.17g*sin(%.17g*%s))", e->value, e->bend, e->pace, joint);
    return e;
}

static Element *draw_piezo(Member *member, Drawn *d, int node, int c)
{
    Element *e = new_element(&d->m, PIEZO, node, 0);

    e->value = member_decades(member, 0.01, 0.2);
    e->d = some(member, 0.3);
    e->k = member_decades(member, 0.3, 5);
    e->rest = some(member, 0.5);
    e->coordinate = c;
    write_element(d, "piezo", e, d->m.coordinate[c].name);
    write_line(&d->script, " C=%.17g d=%.17g k=%.17g rest=%.17g", e->value, e->d, e->k, e->rest);
    return e;
}

static void draw_shunt(Member *member, Drawn *d, int node, int *capacity)
{
    static DrawPart *const parts[] = {draw_resistance, draw_capacity, draw_inductance, draw_motor,
                                      draw_coil,       draw_solenoid, draw_plates,     draw_piezo};
    Machine *m = &d->m;
    const int c = draw_coordinate(member, m, -1);
    Element *e;

    if (m->elements >= ELEMENTS - 6)
        return;
    e = parts[member_one_of(member, c < 0 ? 3 : 8)](member, d, node, c);
    if (e->kind == CAPACITY || e->kind == PLATE || e->kind == PIEZO) {
        e->first = *capacity < 0; /* of capacities in parallel the first has the state */
        if (e->first)
            *capacity = m->states++;
        e->state = *capacity;
        begin_state(member, d, e, "v", 3);
    } else if (e->kind == INERTANCE || e->kind == SOLENOID || e->L > 0) {
        e->state = m->states++;
        begin_state(member, d, e, "i", 1);
    }
}

static void draw_circuit(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    int node = new_node(m, ELECTRIC);
    Element *e;

    draw_source(member, d, node);
    for (int stages = 1 + member_one_of(member, 2); stages > 0; stages--) {
        const int next = new_node(m, ELECTRIC);
        int capacity = -1;

        e = new_element(m, RESISTANCE, node, next);
        e->value = member_decades(member, 0.5, 20);
        write_element(d, "resistor", e, "");
        write_line(&d->script, " %.17g", e->value);
        for (int k = 1 + member_one_of(member, 3); k > 0; k--)
            draw_shunt(member, d, next, &capacity);
        node = next;
        if (stages > 1 && chance(member, 0.4)) { /* two windings, or an amplifier on the way */
            const bool amplifier = chance(member, 0.4), gyrator = chance(member, 0.4);
            const int behind = new_node(m, ELECTRIC);

            e = new_element(m,
                            amplifier ? AMPLIFIER
                            : gyrator ? GYRATOR
                                      : WINDINGS,
                            amplifier ? behind : node, 0);
            e->c = amplifier ? node : behind;
            e->K = (chance(member, 0.5) ? 1 : -1) * member_between(member, 0.4, 2.5);
            write_element(d, amplifier ? "vcvs" : gyrator ? "gyrator" : "transformer", e, "");
            write_line(&d->script, " %s 0 %s=%.17g", node_name(m, e->c),
                       amplifier ? "gain"
                       : gyrator ? "r"
                                 : "n",
                       e->K);
            node = behind;
        }
    }
}

/* a line of masses, springs and dampers that turns or shifts a coordinate */
static void draw_line(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    const int c = draw_coordinate(member, m, -1);
    const bool shift = c >= 0 && m->coordinate[c].shift;
    const Domain domain = shift ? SLIDE : SHAFT;
    char text[160];
    int a, b;
    Element *e;

    if (c < 0 || m->elements > ELEMENTS - 6)
        return;
    a = new_node(m, domain);
    b = new_node(m, domain);
    e = new_element(m, THROUGH, a, 0);
    e->wave = draw_wave(member, 3);
    write_element(d, shift ? "forcesource" : "torquesource", e, "");
    write_line(&d->script, " %s", wave_text(&e->wave, -1, text));
    e = new_element(m, CAPACITY, a, 0);
    e->value = member_decades(member, 0.05, 1);
    e->state = m->states++;
    write_element(d, shift ? "slug" : "flywheel", e, "");
    write_line(&d->script, " %s=%.17g", shift ? "m" : "J", e->value);
    begin_state(member, d, e, shift ? "v" : "w", 1);
    e = new_element(m, SPRING_DAMPER, a, b);
    e->k = member_decades(member, 2, 60);
    e->d = member_decades(member, 0.1, 3);
    e->state = m->states++;
    write_element(d, shift ? "rod" : "shaft", e, "");
    write_line(&d->script, " k=%.17g d=%.17g", e->k, e->d);
    begin_state(member, d, e, shift ? "deflection" : "twist", 0.5);
    if (!shift && chance(member, 0.5)) {
        const int behind = new_node(m, domain);

        e = new_element(m, WINDINGS, b, 0);
        e->c = behind;
        e->K = (chance(member, 0.5) ? 1 : -1) * member_between(member, 0.4, 2.5);
        write_element(d, "gear", e, "");
        write_line(&d->script, " %s 0 ratio=%.17g", node_name(m, behind), e->K);
        b = behind;
    }
    if (chance(member, 0.4)) {
        e = new_element(m, WHEEL_ON_END, b, 0);
        e->J = member_decades(member, 0.02, 0.5);
        e->coordinate = c;
        write_element(d, shift ? "slug" : "flywheel", e, "");
        write_line(&d->script, " %s=%.17g", shift ? "m" : "J", e->J);
    }
    e = new_element(m, COIL, b, 0);
    e->K = 1;
    e->coordinate = c;
    write_element(d, shift ? "rodend" : "shaftend", e, m->coordinate[c].name);
    write_line(&d->script, "%s", "");
}

static void draw_hydraulics(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    const int c = draw_coordinate(member, m, 1);
    char text[160];
    int a, b, last;
    Element *e;

    if (c < 0 || m->elements > ELEMENTS - 7)
        return;
    a = new_node(m, HYDRAULIC);
    b = new_node(m, HYDRAULIC);
    e = new_element(m, ACROSS, a, 0);
    e->wave = draw_wave(member, 2e4);
    write_element(d, "pump", e, "");
    write_line(&d->script, " pressure=%s", wave_text(&e->wave, 1, text));
    e = new_element(m, RESISTANCE, a, b);
    e->value = member_decades(member, 1e6, 2e7);
    write_element(d, "pipe", e, "");
    write_line(&d->script, " R=%.17g", e->value);
    if (chance(member, 0.6)) {
        e = new_element(m, CAPACITY, b, 0);
        e->value = member_decades(member, 5e-9, 1e-7);
        e->state = m->states++;
        write_element(d, "tank", e, "");
        write_line(&d->script, " C=%.17g", e->value);
        begin_state(member, d, e, "p", 1e4);
    }
    last = b;
    if (chance(member, 0.5)) {
        last = new_node(m, HYDRAULIC);
        e = new_element(m, INERTANCE, b, last);
        e->value = member_decades(member, 1e5, 2e6);
        e->state = m->states++;
        write_element(d, "inertance", e, "");
        write_line(&d->script, " I=%.17g", e->value);
        begin_state(member, d, e, "flow", 1e-4);
        e = new_element(m, RESISTANCE, last, 0);
        e->value = member_decades(member, 1e6, 2e7);
        write_element(d, "pipe", e, "");
        write_line(&d->script, " R=%.17g", e->value);
    }
    e = new_element(m, PISTON, last, 0);
    e->K = member_decades(member, 2e-4, 2e-3);
    e->coordinate = c;
    write_element(d, "cylinder", e, m->coordinate[c].name);
    write_line(&d->script, " area=%.17g", e->K);
}

#endif

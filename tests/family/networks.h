/* networks.h: random networks of diodes, switches, capacitors and coils, and multipliers */
#ifndef COTREE_TESTS_NETWORKS_H
#define COTREE_TESTS_NETWORKS_H

#include "../random.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define PI 3.14159265358979323846
enum { NODES = 8, STAGES = 10, ROOM = 2 * STAGES + 1, PARTS = 48, POINTS = 6 };

typedef enum Kind { RESISTOR, CAPACITOR, COIL, SOURCE, DIODE, SWITCH } Kind;

typedef struct Part {
    Kind kind;
    int plus, minus; /* 0: ground */
    double value;    /* ohm, F, H; of a source its amplitude */
    double series;   /* of a source, behind which it stands, or of a switch, ohm; 0: none */
    double on, off, least;
    double Is, scale;    /* of an exponential diode: A, V */
    double phase, level; /* of a source; of a switch, closed while sin(w t + phase) > level */
    double start;        /* V of a capacitor */
} Part;

typedef enum Diodes { WITH_RESISTANCES, IDEAL, EXPONENTIAL } Diodes;

typedef struct Network {
    int nodes, count; /* without ground */
    bool ideal;       /* its switches, too */
    bool exponential;
    double omega, end;  /* rad/s, s */
    double tolerance;   /* of the run, relative and absolute; 0: next to none */
    double longer;      /* times `end` that the run is asked to go, though it is stopped; 0: none */
    const char *method; /* NULL: by itself */
    Part part[PARTS];
} Network;

static Part *add(Network *net, Kind kind, int plus, int minus)
{
    Part *part = &net->part[net->count++];

    *part = (Part){.kind = kind, .plus = plus, .minus = minus};
    return part;
}

static int pick(uint64_t *random, int count)
{
    return (int)(test_random(random) % (uint64_t)count);
}

/* two nodes that aren't the same */
static void pick_ends(uint64_t *random, const Network *net, int ends[2])
{
    ends[0] = pick(random, net->nodes + 1);
    ends[1] = (ends[0] + 1 + pick(random, net->nodes)) % (net->nodes + 1);
}

/* join two nodes; false: they were */
static bool join(int *joined, const int ends[2])
{
    int a = ends[0], b = ends[1];

    while (joined[a] != a)
        a = joined[a];
    while (joined[b] != b)
        b = joined[b];
    joined[a] = b;
    return a != b;
}

static void add_diodes(Network *net, uint64_t *random, int count)
{
    const double least = pick(random, 2) * 0.7;

    for (int i = 0; i < count; i++) {
        int ends[2];
        Part *diode;

        pick_ends(random, net, ends);
        diode = add(net, DIODE, ends[0], ends[1]);
        diode->on = net->ideal ? 1e-5 : test_decades(random, 0.01, 10);
        diode->off = net->ideal ? 1e11 : test_decades(random, 1e5, 1e8);
        diode->least = net->ideal && pick(random, 2) ? 0 : least;
        if (net->exponential) {
            diode->Is = test_decades(random, 1e-14, 1e-8);
            diode->scale = test_uniform(random, 1, 2);
        }
    }
}

static void make(Network *net, uint64_t *random, Diodes law)
{
    const int diodes = 3 + pick(random, 10);
    int joined[NODES + 1]; /* by capacitors: another node, or itself */
    const bool ideal = law == IDEAL;
    /* charged capacitors across exponential diodes would drive more current than there is */
    bool given = law == WITH_RESISTANCES && pick(random, 2);

    *net = (Network){
        .nodes = 3 + pick(random, NODES - 2), .ideal = ideal, .exponential = law == EXPONENTIAL};
    net->omega = 2 * PI * test_decades(random, 50, 1000);
    net->end = 2.3 * 2 * PI / net->omega;
    for (int i = 0; i < 1 + pick(random, 2); i++) {
        Part *source = add(net, SOURCE, 1 + pick(random, net->nodes), 0);

        source->value = test_decades(random, 1, 100);
        source->phase = pick(random, 2) ? test_uniform(random, -PI, PI) : 0;
        source->series = test_decades(random, 10, 1000);
    }
    for (int node = 1; node <= net->nodes; node++) /* nothing hangs in the air */
        add(net, RESISTOR, node, pick(random, node))->value = test_decades(random, 100, 1e5);
    for (int i = 0; i <= NODES; i++)
        joined[i] = i;
    for (int i = pick(random, 4); i > 0; i--) {
        int ends[2];
        Part *part;

        pick_ends(random, net, ends);
        part = add(net, CAPACITOR, ends[0], ends[1]);
        part->value = test_decades(random, 1e-8, 1e-5);
        part->start = test_uniform(random, -20, 20);
        given = join(joined, ends) && given;
    }
    for (int i = 0; i < net->count; i++) /* in a circuit of capacitors the last one follows */
        net->part[i].start *= given;
    for (int i = pick(random, 3); i > 0; i--) { /* beside a resistor: no current is cut off */
        int ends[2];

        pick_ends(random, net, ends);
        add(net, COIL, ends[0], ends[1])->value = test_decades(random, 1e-3, 1);
        add(net, RESISTOR, ends[0], ends[1])->value = test_decades(random, 10, 1e4);
    }
    for (int i = pick(random, 3); i > 0; i--) {
        int ends[2];
        Part *part;

        pick_ends(random, net, ends);
        part = add(net, SWITCH, ends[0], ends[1]);
        part->on = ideal ? 1e-5 : test_decades(random, 0.01, 10);
        part->off = ideal ? 1e11 : test_decades(random, 1e5, 1e8);
        part->phase = test_uniform(random, -PI, PI);
        part->level = test_uniform(random, -0.5, 0.5);
        part->series = test_decades(random, 1, 100);
    }
    add_diodes(net, random, diodes);
}

/* A Greinacher cascade: node 1 behind the source's resistance, then two nodes a stage. */
__attribute__((unused)) static void make_multiplier(Network *net, uint64_t *random)
{
    const int stages = 1 + pick(random, STAGES);
    const double C = test_decades(random, 1e-7, 3e-6), least = pick(random, 2) * 0.7;
    const double on = test_decades(random, 0.03, 10), off = test_decades(random, 1e6, 1e9);
    Part *source;
    int up = 1, down = 0; /* where the last stage ends */

    *net = (Network){.nodes = 1 + 2 * stages, .omega = 2 * PI * test_decades(random, 50, 2000)};
    net->end = 2.3 * 2 * PI / net->omega;
    source = add(net, SOURCE, 1, 0);
    source->value = test_decades(random, 10, 500);
    source->series = test_decades(random, 3, 100);
    for (int k = 1; k <= stages; k++) {
        const int to[] = {2 * k, 2 * k + 1};

        add(net, CAPACITOR, up, to[0])->value = C;
        add(net, DIODE, down, to[0]);
        add(net, DIODE, to[0], to[1]);
        add(net, CAPACITOR, down, to[1])->value = C;
        up = to[0];
        down = to[1];
    }
    for (int i = 0; i < net->count; i++)
        if (net->part[i].kind == DIODE) {
            net->part[i].on = on;
            net->part[i].off = off;
            net->part[i].least = least;
        }
    if (pick(random, 2))
        add(net, RESISTOR, down, 0)->value = test_decades(random, 1e4, 1e7);
}

#endif

/* family_network_trees.c: linear networks with a motor or a cylinder on a joint, in random trees
 *
 * Node k has a capacitor (a tank) to ground, v_k' = (sum of currents into k)/C_k; coils
 * (inertances) between nodes have i' = (v_a - v_b)/L, resistors (pipes) i = (v_a - v_b)/R; a source
 * E sin(w t) feeds node 1 through a resistor. A motor at the last node takes i = (v - Kv h')/R and
 * turns a body by Kt i, a cylinder takes the flow A s' and pushes by A p. These equations are
 * integrated here by the classical Runge-Kutta method, and held against runs in the state form and
 * after `set network tree` in random trees, which may be refused by that statement or by `tree`,
 * but no later. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum { NODES = 4, LINKS = 8, EDGES = NODES + LINKS + 3, STATES = NODES + LINKS + 2 };

typedef struct Link {
    bool is_coil;
    int from, to; /* nodes, 1 first; 0: ground */
    double value;
} Link;

typedef struct Net {
    bool hydraulic;
    int nodes, links;
    double C[NODES + 1], feed, E, omega; /* F, ohm, V, rad/s */
    Link link[LINKS];
    double R, Kt, Kv, inertia; /* of the motor; a cylinder has Kt = Kv = its area */
    double start[STATES];      /* v of nodes, i of coils, h, h' */
} Net;

/* --- the answer --- */

static void rates(const Net *net, double t, const double *x, double *out)
{
    const double *v = x - 1, *i = x + net->nodes, *h = x + net->nodes + net->links;
    double into[NODES + 1] = {0}, drive;

    into[1] = (net->E * sin(net->omega * t) - v[1]) / net->feed;
    for (int k = 0; k < net->links; k++) {
        const Link *link = &net->link[k];
        const double across = v[link->from] - (link->to > 0 ? v[link->to] : 0);
        const double current = link->is_coil ? i[k] : across / link->value;

        out[net->nodes + k] = link->is_coil ? across / link->value : 0;
        into[link->from] -= current;
        into[link->to] += current;
    }
    if (net->hydraulic) {
        into[net->nodes] -= net->Kt * h[1];
        drive = net->Kt * v[net->nodes];
    } else {
        const double current = (v[net->nodes] - net->Kv * h[1]) / net->R;

        into[net->nodes] -= current;
        drive = net->Kt * current;
    }
    for (int k = 1; k <= net->nodes; k++)
        out[k - 1] = into[k] / net->C[k];
    out[net->nodes + net->links] = h[1];
    out[net->nodes + net->links + 1] = drive / net->inertia;
}

static void integrate(const Net *net, double end, double x[STATES])
{
    const int n = net->nodes + net->links + 2, steps = 4000;
    const double h = end / steps;
    double k[4][STATES], y[STATES];

    for (int j = 0; j < steps; j++) {
        rates(net, h * j, x, k[0]);
        for (int stage = 1; stage < 4; stage++) {
            const double part = stage == 3 ? h : h / 2;

            for (int i = 0; i < n; i++)
                y[i] = x[i] + part * k[stage - 1][i];
            rates(net, h * j + part, y, k[stage]);
        }
        for (int i = 0; i < n; i++)
            x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

/* --- a member --- */

static Net draw(Member *m)
{
    Net net = {.hydraulic = member_one_of(m, 2) == 0,
               .nodes = 1 + member_one_of(m, NODES),
               .feed = member_between(m, 0.5, 3),
               .E = member_between(m, 1, 6),
               .omega = member_between(m, 1, 5),
               .R = member_between(m, 0.4, 2),
               .Kt = member_between(m, 0.2, 1),
               .Kv = member_between(m, 0.2, 1),
               .inertia = member_decades(m, 0.05, 2)};

    for (int k = 1; k <= net.nodes; k++)
        net.C[k] = member_between(m, 0.05, 0.5);
    for (int k = 1; k < net.nodes; k++) /* joined in a row, by something */
        net.link[net.links++] = (Link){.from = k, .to = k + 1};
    for (int k = member_one_of(m, 3); k > 0; k--) {
        const int from = 1 + member_one_of(m, net.nodes);
        const int to = member_one_of(m, net.nodes + 1);

        if (from != to)
            net.link[net.links++] = (Link){.from = from, .to = to};
    }
    for (int k = 0; k < net.links; k++) {
        net.link[k].is_coil = member_one_of(m, 2) == 0;
        net.link[k].value = member_between(m, 0.3, 2);
    }
    for (int k = 0; k < net.nodes; k++)
        net.start[k] = member_between(m, -2, 2);
    for (int k = 0; k < net.links; k++)
        net.start[net.nodes + k] = net.link[k].is_coil ? member_between(m, -1, 1) : 0;
    net.start[net.nodes + net.links] = member_between(m, -0.5, 0.5);
    net.start[net.nodes + net.links + 1] = member_between(m, -1, 1);
    return net;
}

static const char *coil(const Net *net)
{
    return net->hydraulic ? "flow" : "i";
}

static const char *across(const Net *net)
{
    return net->hydraulic ? "p" : "v";
}

static void node_name(char out[32], int node)
{
    (void)snprintf(out, 8, node == 0 ? "0" : "n%d", node);
}

static void write_model(const Net *net, Script *s)
{
    const bool water = net->hydraulic;

    write_line(s, "scene planar\nbody b mass=%.17g inertia=%.17g", net->inertia, net->inertia);
    write_line(s, water ? "prismatic h ground b axis=x" : "revolute h ground b");
    write_line(
        s, water ? "pump E s 0 pressure=%.17g*sin(%.17g*t)" : "vsource E s 0 %.17g*sin(%.17g*t)",
        net->E, net->omega);
    write_line(s, water ? "pipe R0 s n1 R=%.17g" : "resistor R0 s n1 R=%.17g", net->feed);
    for (int k = 1; k <= net->nodes; k++)
        write_line(s, "%s C%d n%d 0 C=%.17g", water ? "tank" : "capacitor", k, k, net->C[k]);
    for (int k = 0; k < net->links; k++) {
        const Link *link = &net->link[k];
        char to[32];

        node_name(to, link->to);
        if (link->is_coil)
            write_line(s, "%s K%d n%d %s %s=%.17g", water ? "inertance" : "inductor", k, link->from,
                       to, water ? "I" : "L", link->value);
        else
            write_line(s, "%s K%d n%d %s R=%.17g", water ? "pipe" : "resistor", k, link->from, to,
                       link->value);
    }
    if (water)
        write_line(s, "cylinder M h n%d 0 area=%.17g", net->nodes, net->Kt);
    else
        write_line(s, "motor M h n%d 0 R=%.17g Kt=%.17g Kv=%.17g", net->nodes, net->R, net->Kt,
                   net->Kv);
    for (int k = 1; k <= net->nodes; k++)
        write_line(s, "init C%d.%s = %.17g", k, across(net), net->start[k - 1]);
    for (int k = 0; k < net->links; k++)
        if (net->link[k].is_coil)
            write_line(s, "init K%d.%s = %.17g", k, coil(net), net->start[net->nodes + k]);
    write_line(s, "init h = %.17g, h' = %.17g", net->start[net->nodes + net->links],
               net->start[net->nodes + net->links + 1]);
}

/* a spanning tree of the edges in random order; node NODES + 1 is the source's */
static void write_tree(Member *m, const Net *net, Script *s)
{
    char name[EDGES][32];
    int ends[EDGES][2], order[EDGES], joined[NODES + 2], count = 0;

#define EDGE(from, to, ...)                                                                        \
    (ends[count][0] = (from), ends[count][1] = (to),                                               \
     (void)snprintf(name[count++], sizeof name[0], __VA_ARGS__))
    EDGE(NODES + 1, 0, "E");
    EDGE(NODES + 1, 1, "R0");
    EDGE(net->nodes, 0, "M");
    for (int k = 1; k <= net->nodes; k++)
        EDGE(k, 0, "C%d", k);
    for (int k = 0; k < net->links; k++)
        EDGE(net->link[k].from, net->link[k].to, "K%d", k);
#undef EDGE
    for (int k = 0; k < NODES + 2; k++)
        joined[k] = k;
    for (int k = 0; k < count; k++) {
        const int other = member_one_of(m, k + 1);

        order[k] = order[other];
        order[other] = k;
    }
    write_piece(s, "tree %s", net->hydraulic ? "hydraulic" : "electrical");
    for (int k = 0; k < count; k++) {
        const int from = joined[ends[order[k]][0]], to = joined[ends[order[k]][1]];

        if (from == to)
            continue;
        for (int j = 0; j < NODES + 2; j++)
            if (joined[j] == from)
                joined[j] = to;
        write_piece(s, " %s", name[order[k]]);
    }
    write_line(s, "%s", "");
}

static bool states_agree(Member *m, Kit *kit, const Net *net, const double *right, double bound,
                         const char *what)
{
    double off = fabs(kit_value(kit, "h") - right[net->nodes + net->links]);
    char name[32];

    off = fmax(off, fabs(kit_value(kit, "h'") - right[net->nodes + net->links + 1]));
    for (int k = 0; k < net->nodes; k++) {
        (void)snprintf(name, sizeof name, "C%d.%s", k + 1, across(net));
        off = fmax(off, fabs(kit_value(kit, name) - right[k]));
    }
    for (int k = 0; k < net->links; k++) {
        (void)snprintf(name, sizeof name, "K%d.%s", k, coil(net));
        if (net->link[k].is_coil)
            off = fmax(off, fabs(kit_value(kit, name) - right[net->nodes + k]));
    }
    return isfinite(off) && keeps(m, what, off, bound);
}

static Verdict trees_run_or_are_refused(Member *m)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf"};
    const Net net = draw(m);
    const bool sets_first = member_one_of(m, 2) == 0;
    const char *method = methods[member_one_of(m, 4)];
    Script s = {.length = 0}, tree = {.length = 0}, run = {.length = 0};
    double right[STATES];
    Verdict verdict = DISAGREES;
    Kit kit = kit_new();

    memcpy(right, net.start, sizeof right);
    integrate(&net, 2, right);
    write_model(&net, &s);
    write_tree(m, &net, &tree);
    write_line(&run, "simulate 2 every=0.5 rtol=1e-8 atol=1e-10 method=%s", method);
    tell(m, "%s%s%s(%s)\n", s.text, tree.text, run.text, sets_first ? "set first" : "tree first");
    if (kit_do(&kit, s.text) != CT_OK || kit_do(&kit, run.text) != CT_OK ||
        !states_agree(m, &kit, &net, right, 1e-5, "state form"))
        goto done;
    if (kit_do(&kit, sets_first ? "set network tree\n" : tree.text) != CT_OK)
        goto done; /* the state form takes any tree */
    if (kit_do(&kit, sets_first ? tree.text : "set network tree\n") != CT_OK)
        verdict = REFUSED;
    if (verdict == REFUSED && strstr(kit.error.message, "in this tree") == NULL &&
        strstr(kit.error.message, "the equations of this tree") == NULL)
        verdict = DISAGREES;
    /* what was refused left the model as it was */
    if (kit_do(&kit, run.text) != CT_OK || !states_agree(m, &kit, &net, right, 1e-5, "tree form"))
        verdict = DISAGREES;
    else if (verdict != REFUSED)
        verdict = AGREES;
done:
    if (verdict != AGREES)
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"networks run in random trees", 80, 0.35, 0, trees_run_or_are_refused}};

    return family_main(families, sizeof families / sizeof *families, argc, argv);
}

/* test_random_networks.c: random networks have one solution, whatever the tree
 *
 * Networks of R, L, C and sources, independent and controlled, up to 200 elements: a random
 * spanning tree of elements that may carry any current, and chords that may have any voltage.
 * Circuits of capacitors and voltage sources and cutsets of inductors and current sources come
 * about by themselves. What a run tells is held to Kirchhoff's laws and the elements' own at every
 * output point, to Tellegen's theorem (also with voltages of one tree and currents of another), and
 * to the balance of energy. */
#include "scene.h"

#include "form.h"
#include "simulate/run/run.h"

#include <stdarg.h>

/* an improper tree's equations of high order grow fast: integrated up to FEW elements */
enum { MOST_ELEMENTS = 200, SMALL = 80, FEW = 12 };

typedef enum Kind { RESISTOR, CAPACITOR, INDUCTOR, VSOURCE, ISOURCE, VCVS, CCVS, VCCS, CCCS } Kind;

static const char *const words[] = {"resistor", "capacitor", "inductor", "vsource", "isource",
                                    "vcvs",     "ccvs",      "vccs",     "cccs"};
static const char letters[] = "RCLVIEHGF";

typedef struct Element {
    Kind kind;
    int plus, minus; /* nodes; 0 is the datum */
    double value;    /* ohm, F, H; amplitude of a source; gain */
    double speed;    /* of a source's sine, rad/s */
    int sensed[2];   /* nodes, or an element's number */
} Element;

typedef struct Network {
    int nodes;
    int count;
    Element at[MOST_ELEMENTS];
} Network;

static int pick(uint64_t *random, int count)
{
    return (int)(test_random(random) % (uint64_t)count);
}

static bool is_controlled(const Element *element)
{
    return element->kind >= VCVS;
}

static bool senses_current(const Element *element)
{
    return element->kind == CCVS || element->kind == CCCS;
}

static bool stores(const Element *element)
{
    return element->kind == CAPACITOR || element->kind == INDUCTOR;
}

static Element random_element(uint64_t *random, Kind kind, int plus, int minus)
{
    static const double least[] = {0.5, 0.2, 0.2, -5.0, -1.0, -0.3, -0.3, -0.3, -0.3};
    static const double most[] = {5.0, 2.0, 2.0, 5.0, 1.0, 0.3, 0.3, 0.3, 0.3};

    return (Element){.kind = kind,
                     .plus = plus,
                     .minus = minus,
                     .value = test_uniform(random, least[kind], most[kind]),
                     .speed = test_uniform(random, 0.5, 3.0)};
}

/* what controls a source: two nodes, or the current of the last resistor before it */
static void random_sense(uint64_t *random, Network *net, int i)
{
    Element *element = &net->at[i];
    int *sensed = element->sensed;

    sensed[0] = pick(random, net->nodes);
    sensed[1] = (sensed[0] + 1 + pick(random, net->nodes - 1)) % net->nodes;
    if (!senses_current(element))
        return;
    for (sensed[0] = i; sensed[0] >= 0 && net->at[sensed[0]].kind != RESISTOR; sensed[0]--)
        continue;
    if (sensed[0] < 0)
        element->kind = RESISTOR;
}

/* of which a network is made: its spanning tree, and what is added across */
typedef struct Mix {
    Kind in_tree[8];
    Kind across[8];
} Mix;

static const Mix independent = {
    {RESISTOR, RESISTOR, RESISTOR, CAPACITOR, CAPACITOR, INDUCTOR, VSOURCE, RESISTOR},
    {RESISTOR, RESISTOR, RESISTOR, CAPACITOR, CAPACITOR, INDUCTOR, INDUCTOR, ISOURCE},
};
/* no inductors that a controlled current would have to run through */
static const Mix controlled_currents = {
    {RESISTOR, RESISTOR, RESISTOR, CAPACITOR, CAPACITOR, RESISTOR, VSOURCE, RESISTOR},
    {RESISTOR, RESISTOR, RESISTOR, CAPACITOR, CAPACITOR, VCCS, CCCS, RESISTOR},
};
/* no capacitors that a controlled voltage would stand across */
static const Mix controlled_voltages = {
    {RESISTOR, RESISTOR, RESISTOR, INDUCTOR, RESISTOR, VCVS, VSOURCE, CCVS},
    {RESISTOR, RESISTOR, RESISTOR, INDUCTOR, INDUCTOR, RESISTOR, INDUCTOR, ISOURCE},
};

static Network random_network(uint64_t *random, int count, const Mix *mix)
{
    Network net = {.nodes = 2 + (count - 2) / 2, .count = count};

    for (int i = 0; i < count; i++) {
        bool tree = i < net.nodes - 1;
        int plus = tree ? i + 1 : pick(random, net.nodes);
        int minus =
            tree ? pick(random, i + 1) : (plus + 1 + pick(random, net.nodes - 1)) % net.nodes;
        Kind kind = i == 0 ? VSOURCE
                    : tree ? mix->in_tree[pick(random, COUNT(mix->in_tree))]
                           : mix->across[pick(random, COUNT(mix->across))];

        net.at[i] = pick(random, 2) == 0 ? random_element(random, kind, plus, minus)
                                         : random_element(random, kind, minus, plus);
        if (is_controlled(&net.at[i]))
            random_sense(random, &net, i);
    }
    return net;
}

static void add_node(Text *text, int node)
{
    text_addf(text, node == 0 ? " 0" : " n%d", node);
}

static char *network_text(const Network *net)
{
    Text text = {0};

    for (int i = 0; i < net->count; i++) {
        const Element *element = &net->at[i];

        text_addf(&text, "%s %c%d", words[element->kind], letters[element->kind], i);
        add_node(&text, element->plus);
        add_node(&text, element->minus);
        if (senses_current(element)) {
            text_addf(&text, " of=R%d.i gain=", element->sensed[0]);
        } else if (is_controlled(element)) {
            add_node(&text, element->sensed[0]);
            add_node(&text, element->sensed[1]);
            text_add(&text, " gain=");
        }
        text_addf(&text, " %.17g", element->value);
        if (element->kind == VSOURCE || element->kind == ISOURCE)
            text_addf(&text, "*sin(%.17g*t)", element->speed);
        text_char(&text, '\n');
    }
    /* at rest, also where the tree's own variables are others */
    for (int i = 0; i < net->count; i++)
        if (stores(&net->at[i]))
            text_addf(&text, "init %c%d.%c = 0\n", letters[net->at[i].kind], i,
                      net->at[i].kind == CAPACITOR ? 'v' : 'i');
    return text_done(&text);
}

/* --- a run and what it tells --- */

/* columns of a row: v of each element, i of each, the rate of what it stores, if it does, and
 * potentials of the nodes */
typedef struct Told {
    int rows, columns;
    double *values;
    const double *times;
    Result *result;
} Told;

static double told_at(const Told *told, int row, int column)
{
    return told->values[row * told->columns + column];
}

static double parameter_value(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

typedef LIST(Expr) Items;

static void push(const Model *model, Items *items, bool rate, const char *format, ...)
{
    Text name = {0};
    va_list list;
    char plain[40];

    va_start(list, format);
    (void)vsnprintf(plain, sizeof plain, format, list);
    va_end(list);
    text_addf(&name, "%s%s", plain, rate ? "'" : "");
    LIST_PUSH(*items, expr_symbol(model_arena(model), name.at, SYMBOL_VARIABLE));
    text_free(&name);
}

static void push_all(const Model *model, const Network *net, bool rates, Items *items)
{
    for (int i = 0; i < net->count; i++)
        push(model, items, false, "%c%d.v", letters[net->at[i].kind], i);
    for (int i = 0; i < net->count; i++)
        push(model, items, false, "%c%d.i", letters[net->at[i].kind], i);
    for (int i = 0; i < net->count; i++)
        push(model, items, rates && stores(&net->at[i]), "%c%d.%c", letters[net->at[i].kind], i,
             net->at[i].kind == INDUCTOR ? 'i' : 'v');
    for (int node = 1; node < net->nodes; node++)
        push(model, items, false, "n%d.v", node);
}

static bool run(Model *model, const Network *net, bool rates, System **system, Told *told)
{
    /* steps short enough for the energy, whose error does not choose them */
    RunOptions options = {
        .duration = 2.0, .every = 0.25, .rtol = 1e-11, .atol = 1e-11, .step = 0.05};
    StartValues start = {model_start_count(model), NULL};
    SimulationInput setting = {.parameter = parameter_value, .context = model, .start = &start};
    Items items = {0};
    ResultReader *reader = NULL;
    Diag diag = {0};
    Status status;

    *told = (Told){0};
    *system = scene_system(model);
    if (*system == NULL)
        return false;
    push_all(model, net, rates, &items);
    start.at = NEW_ARRAY(StartValue, start.count);
    for (int i = 0; i < start.count; i++) {
        const Start *from = model_start(model, i);

        start.at[i] = (StartValue){from->name, from->primes, 0.0, from->is_guess};
    }
    status = run_simulate(*system, &setting, &options, &told->result, &reader, &diag);
    if (status == OK) {
        told->rows = result_rows(told->result);
        told->columns = items.count;
        told->times = result_times(told->result);
        told->values = NEW_ARRAY(double, (size_t)told->rows *(size_t)items.count);
        status = result_reader_values(reader, items.at, items.count, told->values, &diag);
    }
    if (status != OK) {
        test_faults++;
        printf("%s (%s)\n", diag.message, diag.hint);
    }
    result_reader_free(reader);
    mem_free(start.at);
    LIST_FREE(items);
    return status == OK;
}

static void told_free(Told *told)
{
    mem_free(told->values);
    result_free(told->result);
}

/* --- claims --- */

static double largest(const Told *told, int first, int count)
{
    double size = 0.0;

    for (int r = 0; r < told->rows; r++)
        for (int c = first; c < first + count; c++)
            size = fmax(size, fabs(told_at(told, r, c)));
    return size;
}

static void expect_small(double value, double limit, const char *what, int which, double t)
{
    if (fabs(value) <= limit)
        return;
    test_faults++;
    printf("%s %d at t = %.3g: off by %.3g, at most %.3g\n", what, which, t, value, limit);
}

static double potential(const Network *net, const Told *told, int row, int node)
{
    return node > 0 ? told_at(told, row, 3 * net->count - 1 + node) : 0.0;
}

static void expect_kirchhoff(const Network *net, const Told *told, int row)
{
    double *sums = NEW_ARRAY(double, net->nodes);
    double volts = largest(told, 0, net->count);
    double amperes = largest(told, net->count, net->count);

    for (int i = 0; i < net->count; i++) {
        const Element *element = &net->at[i];
        double plus = potential(net, told, row, element->plus);
        double minus = potential(net, told, row, element->minus);

        expect_small(plus - minus - told_at(told, row, i), 1e-12 * volts, "voltage law of", i,
                     told->times[row]);
        sums[element->plus] += told_at(told, row, net->count + i);
        sums[element->minus] -= told_at(told, row, net->count + i);
    }
    for (int node = 0; node < net->nodes; node++)
        expect_small(sums[node], 1e-12 * amperes, "current law of node", node, told->times[row]);
    mem_free(sums);
}

/* how far an element is off its own law, in volts or amperes */
static double off_law(const Network *net, const Told *told, int row, int which)
{
    const Element *element = &net->at[which];
    double v = told_at(told, row, which);
    double i = told_at(told, row, net->count + which);
    double rate = told_at(told, row, 2 * net->count + which);
    double source = element->value * sin(element->speed * told->times[row]);
    double sensed;

    if (senses_current(element))
        sensed = told_at(told, row, net->count + element->sensed[0]);
    else
        sensed = potential(net, told, row, element->sensed[0]) -
                 potential(net, told, row, element->sensed[1]);
    switch (element->kind) {
    case RESISTOR:
        return v - element->value * i;
    case CAPACITOR:
        return i - element->value * rate;
    case INDUCTOR:
        return v - element->value * rate;
    case VSOURCE:
        return v - source;
    case ISOURCE:
        return i - source;
    case VCVS:
    case CCVS:
        return v - element->value * sensed;
    default:
        return i - element->value * sensed;
    }
}

static void expect_laws(const Network *net, const Told *told, int row)
{
    double size = largest(told, 0, 2 * net->count);

    for (int i = 0; i < net->count; i++)
        expect_small(off_law(net, told, row, i), 1e-11 * size, words[net->at[i].kind], i,
                     told->times[row]);
}

/* voltages of one, currents of the other: both keep Kirchhoff's laws, so they add up to nothing */
static void expect_tellegen(const Network *net, const Told *volts, const Told *amperes, int row)
{
    double sum = 0.0;
    double size = 0.0;

    for (int i = 0; i < net->count; i++) {
        double power = told_at(volts, row, i) * told_at(amperes, row, net->count + i);

        sum += power;
        size += fabs(power);
    }
    /* where all powers are near nothing, what they are at other times is the measure */
    size =
        fmax(size, 1e-3 * largest(volts, 0, net->count) * largest(amperes, net->count, net->count));
    expect_small(sum, 1e-10 * size, "Tellegen's theorem, elements", net->count, volts->times[row]);
}

static void expect_energy(const Network *net, const Told *told)
{
    double size = 0.0;

    for (int i = 0; i < net->count; i++)
        size += fmax(largest(told, i, 1) * largest(told, net->count + i, 1), 1e-3);
    expect_small(result_report(told->result)->energy_drift, 1e-9 * size, "energy, elements",
                 net->count, 2.0);
}

static void expect_same(const Network *net, const Told *first, const Told *told)
{
    double size = largest(first, 0, 2 * net->count);

    for (int r = 0; r < first->rows; r++)
        for (int c = 0; c < 2 * net->count; c++)
            expect_small(told_at(told, r, c) - told_at(first, r, c), 1e-8 * size, "column", c,
                         first->times[r]);
}

/* --- trees --- */

/* `tree electrical ...`: voltage sources first, then as proper says or as chance has it */
static char *random_tree(const Model *model, const Network *net, bool proper, uint64_t *random)
{
    static const int rank[] = {
        [CAPACITOR] = 1, [RESISTOR] = 2, [INDUCTOR] = 3, [ISOURCE] = 4, [VCCS] = 4, [CCCS] = 4};
    const Graph *graph = model_graph(model);
    int *preference = NEW_ARRAY(int, graph_edge_count(graph));
    TreeChoice choice = {.preference = preference};
    Tree *tree = NULL;
    Diag diag = {0};
    Text text = {0};

    for (int e = 0; e < graph_edge_count(graph); e++) {
        Kind kind = net->at[e].kind;
        int order = proper || rank[kind] == 0 || rank[kind] == 4 ? rank[kind] : 2;

        preference[e] = 1000 * order + pick(random, 1000);
    }
    text_add(&text, "tree electrical");
    EXPECT(tree_complete(graph, TREE_ELECTRICAL, &choice, false, &tree, &diag) == OK);
    for (int e = 0; e < graph_edge_count(graph) && tree != NULL; e++)
        if (tree_has(tree, e))
            text_addf(&text, " %s", graph_edge(graph, e)->name);
    tree_free(tree);
    mem_free(preference);
    return text_done(&text);
}

/* what is done differently in the k-th of a network's runs */
typedef struct Way {
    bool proper;    /* tree */
    bool tree_form; /* integrates that tree's equations, not those of a normal tree */
} Way;

/* Some improper trees are refused: nobody would read equations as long as theirs. */
static bool refused(const Model *model, int *count)
{
    System *system = NULL;
    Diag diag = {0};
    bool is_refused =
        form_system(model, &system, &diag) != OK && strstr(diag.message, "grow too long") != NULL;

    system_free(system);
    *count += is_refused;
    return is_refused;
}

static void choose(Model *model, const Network *net, Way way, uint64_t *random)
{
    char *tree = random_tree(model, net, way.proper, random);

    scene_add(model, tree);
    if (way.tree_form)
        scene_add(model, "set network tree\n");
    mem_free(tree);
}

static void expect_all(const Network *net, Way way, const Told *first, const Told *told)
{
    for (int r = 0; r < told->rows; r++) {
        expect_kirchhoff(net, told, r);
        if (way.proper)
            expect_laws(net, told, r);
        expect_tellegen(net, told, told, r);
        expect_tellegen(net, first, told, r);
        expect_tellegen(net, told, first, r);
    }
    if (way.proper)
        expect_energy(net, told);
    expect_same(net, first, told);
}

/* trees that were refused */
static int check_network(uint64_t *random, int size, int trees, const Mix *mix)
{
    Network net = random_network(random, size, mix);
    char *text = network_text(&net);
    Model *models[8] = {NULL};
    System *systems[8] = {NULL};
    Told told[8] = {{0}};
    int before = test_faults;
    int refusals = 0;

    for (int k = 0; k < trees && test_faults == before; k++) {
        Way way = {.proper = k % 2 == 1 || k == 0,
                   .tree_form = k > 0 && (k % 2 == 1 || size <= FEW)};

        models[k] = scene_new(text);
        if (k > 0)
            choose(models[k], &net, way, random);
        if (!way.proper && refused(models[k], &refusals))
            continue;
        if (run(models[k], &net, way.proper, &systems[k], &told[k]))
            expect_all(&net, way, &told[0], &told[k]);
    }
    if (test_faults > before)
        printf("%s", text);
    for (int k = 0; k < trees; k++) {
        told_free(&told[k]);
        system_free(systems[k]);
        model_free(models[k]);
    }
    mem_free(text);
    return refusals;
}

static void small_networks_have_one_solution(void)
{
    uint64_t random = 5;
    int refusals = 0;

    for (int i = 0; i < SMALL && test_faults == 0; i++)
        refusals += check_network(&random, 4 + pick(&random, FEW - 4), 5, &independent);
    printf("%d trees of %d refused\n", refusals, 4 * SMALL);
    EXPECT(refusals <= 4 * SMALL / 40);
}

static void networks_of_200_elements_have_one_solution(void)
{
    uint64_t random = 200;

    for (int i = 0; i < 4 && test_faults == 0; i++)
        EXPECT(check_network(&random, MOST_ELEMENTS, 4, &independent) == 0);
}

static void controlled_sources_keep_to_their_gains_in_all_trees(void)
{
    uint64_t random = 4;

    for (int i = 0; i < SMALL && test_faults == 0; i++)
        check_network(&random, FEW + 1 + pick(&random, 20), 4,
                      i % 2 == 0 ? &controlled_currents : &controlled_voltages);
    EXPECT(check_network(&random, MOST_ELEMENTS, 3, &controlled_currents) == 0);
    EXPECT(check_network(&random, MOST_ELEMENTS, 3, &controlled_voltages) == 0);
}

int main(void)
{
    RUN(small_networks_have_one_solution);
    RUN(networks_of_200_elements_have_one_solution);
    RUN(controlled_sources_keep_to_their_gains_in_all_trees);
    return test_end();
}

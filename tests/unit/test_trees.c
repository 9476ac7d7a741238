/* test_trees.c: whatever trees are chosen, the motion and the reactions are the same, and the
 * reactions put on each body satisfy Newton and Euler
 *
 * Of each model up to 50 random pairs of trees (all where there are fewer) are run from the same
 * start; under the sanitizers 12, which show how memory is used as well. */
#include "scene.h"

#include "simulate/run/run.h"

#ifdef __SANITIZE_ADDRESS__
enum { MOST_PAIRS = 12 };
#else
enum { MOST_PAIRS = 50 };
#endif
enum { MOST_TRIES = 400 };

typedef struct Case {
    const char *name;
    const char *scene;
    const char *start; /* init and guess */
    const char *loads; /* forces and torques by hand: "frame fx fy mz;" in the language */
    double duration, every;
    int fewest; /* pairs there must be */
} Case;

#define FOUR_BAR_BODY(name) "body " name " mass=1 inertia=1/12\n"

static const Case cases[] = {
    {"slider-crank",
     "scene planar\ngravity [0, -9.81]\n"
     "body m1 mass=2 inertia=0.01\nbody m2 mass=1.2 inertia=0.03\nbody m3 mass=3 inertia=0.01\n"
     "arm r4 m1 [-0.08, 0]\narm r5 m1 [0.12, 0]\narm r6 m2 [0.25, 0]\narm r7 m2 [-0.35, 0]\n"
     "revolute h8 ground r4\nrevolute h9 r5 r6\nrevolute h10 m3 r7\n"
     "prismatic s11 ground m3 axis=x\nforce F12 m3 [-25 + 10*sin(5*t), 0]\n",
     "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67, m2.theta = 2.85, m1.theta = 1.05\n"
     "guess m3.x = 0.67, m2.x = 0.34, m2.y = 0.1, m1.x = 0.04, m1.y = 0.07, h9 = 1.8\n",
     "m3 -25+10*sin(5*t) 0 0;", 0.1, 0.02, 50},
    {"motor arm",
     "scene planar\ngravity [0, -9.81]\n"
     "body m1 mass=2 inertia=0.03\nbody m2 mass=1.5 inertia=0.015\n"
     "arm p1 m1 [-0.2, 0]\narm q1 m1 [0.2, 0]\narm p2 m2 [-0.15, 0]\n"
     "revolute J1 ground p1 coord=theta1\nrevolute J2 q1 p2 coord=theta2\n"
     "motor M7 J1 a 0 R=1.2 L=0.05 Kt=0.8 Kv=0.8\nmotor M8 J2 b 0 R=1.5 L=0.04 Kt=0.5 Kv=0.5\n"
     "vsource V1 a 0 24 V\nvsource V2 b 0 12 V\n",
     "init theta1 = -90 deg, theta2 = 0, theta1' = 0, theta2' = 0, M7.i = 0, M8.i = 0\n"
     "guess m1.theta = -1.57, m2.theta = -1.57, m1.y = -0.2, m2.y = -0.55, m1.x = 0, m2.x = 0\n",
     "m1 0 0 M7.torque-M8.torque;m2 0 0 M8.torque;", 0.3, 0.05, 9},
    {"pendulum",
     "scene planar\ngravity [0, -9.81]\nbody p1 mass=1 inertia=0\narm pin p1 [0, 1]\n"
     "revolute h1 ground pin\n",
     "init h1 = -90 deg, h1' = 0\nguess p1.x = -1, p1.y = 0, p1.theta = -1.57\n", "", 0.5, 0.1, 4},
    {"four-bar",
     "scene planar\ngravity [0, -9.81]\n" FOUR_BAR_BODY("c0") FOUR_BAR_BODY("c1") FOUR_BAR_BODY(
         "k0") "arm g0 ground [0, 0]\narm g1 ground [1, 0]\narm cl0 c0 [0, -1/2]\narm ch0 c0 [0, "
               "1/2]\n"
               "arm cl1 c1 [0, -1/2]\narm ch1 c1 [0, 1/2]\narm kl0 k0 [-1/2, 0]\narm kr0 k0 [1/2, "
               "0]\n"
               "revolute a0 g0 cl0\nrevolute a1 g1 cl1\nrevolute l0 ch0 kl0\nrevolute r0 kr0 ch1\n",
     "init a0 = 0.1, a0' = -1\nguess a1 = 0.1, l0 = -0.1, r0 = 0.1, c0.theta = 0.1, c1.theta = "
     "0.1, k0.theta = 0\n"
     "guess c0.x = -0.05, c0.y = 0.5, c1.x = 0.95, c1.y = 0.5, k0.x = 0.4, k0.y = 1\n",
     "", 0.3, 0.05, 50},
    {"Andrews' squeezer",
     "scene planar\narm A ground [-0.06934, -0.00227]\narm B ground [-0.03635, 0.03273]\n"
     "arm C ground [0.014, 0.072]\n"
     "body K1 mass=0.04325 inertia=2.194e-6\nbody K2 mass=0.00365 inertia=4.410e-7\n"
     "body K3 mass=0.02373 inertia=5.255e-6\nbody K4 mass=0.00706 inertia=5.667e-7\n"
     "body K5 mass=0.07050 inertia=1.169e-5\nbody K6 mass=0.00706 inertia=5.667e-7\n"
     "body K7 mass=0.05498 inertia=1.912e-5\n"
     "arm O1 K1 [-0.00092, 0]\narm F1 K1 [0.00608, 0]\narm F2 K2 [0.0115, 0]\narm E2 K2 [-0.0165, "
     "0]\n"
     "arm B3 K3 [-0.01043, 0.01874]\narm E3 K3 [-0.01043, -0.01626]\narm D3 K3 [0.00957, 0.00074]\n"
     "arm G4 K4 [0, 0.00579]\narm E4 K4 [0, -0.01421]\narm A5 K5 [-0.02308, -0.00916]\n"
     "arm G5 K5 [0.01692, -0.00916]\narm H6 K6 [-0.00579, 0]\narm E6 K6 [0.01421, 0]\n"
     "arm A7 K7 [-0.00449, 0.01228]\narm H7 K7 [-0.00449, -0.02772]\n"
     "revolute jO ground O1 coord=beta\nrevolute jF F1 F2 coord=Theta\nrevolute jB B B3 "
     "coord=gamma\n"
     "revolute jG G5 G4 coord=Phi\nrevolute jA5 A A5 coord=delta\nrevolute jH H7 H6 coord=Omega\n"
     "revolute jA7 A A7 coord=epsilon\nrevolute jE3 E3 E2\nrevolute jE4 E4 E2\nrevolute jE6 E6 E2\n"
     "spring k1 C D3 k=4530 length=0.07785\ntorque mom K1 0.033\n",
     "init beta = -0.0617138900142764496, beta' = 0\n"
     "guess Theta = 0, gamma = 0.455279819, Phi = 0.22266839, delta = 0.48736498, Omega = "
     "-0.22266839, epsilon = "
     "1.23054745\n",
     "K1 0 0 0.033;C -k1.effort*(D3.x-C.x)/sqrt((D3.x-C.x)^2+(D3.y-C.y)^2) "
     "-k1.effort*(D3.y-C.y)/sqrt((D3.x-C.x)^2+(D3.y-C.y)^2) 0;"
     "D3 k1.effort*(D3.x-C.x)/sqrt((D3.x-C.x)^2+(D3.y-C.y)^2) "
     "k1.effort*(D3.y-C.y)/sqrt((D3.x-C.x)^2+(D3.y-C.y)^2) 0;",
     0.01, 0.0025, 50},
};

/* --- balances, written in the command language --- */

/* the body that a frame is fixed in, "ground" for the datum */
static const char *body_of(const Model *model, const char *frame)
{
    const Instance *instance = model_find(model, frame);

    while (instance != NULL && instance->row->family == FAMILY_ARM) {
        frame = graph_node(model_graph(model), instance->tail)->name;
        instance = model_find(model, frame);
    }
    return frame;
}

/* a load at a frame of the body: its force and its moment about the mass centre */
static void add_load(Text *force_x, Text *force_y, Text *moment, const char *body,
                     const char *frame, const char *fx, const char *fy, const char *mz)
{
    text_addf(force_x, " - (%s)", fx);
    text_addf(force_y, " - (%s)", fy);
    text_addf(moment, " - (%s) - ((%s.x - %s.x)*(%s) - (%s.y - %s.y)*(%s))", mz, frame, body, fy,
              frame, body, fx);
}

static void add_joint(const Model *model, const Instance *joint, const Instance *body, Text text[3])
{
    const Graph *graph = model_graph(model);
    const char *head = graph_node(graph, joint->head)->name;
    const char *tail = graph_node(graph, joint->tail)->name;
    const char *j = joint->name;
    char fx[64];
    char fy[64];
    char mz[300];

    if (strcmp(body_of(model, head), body->name) == 0) {
        snprintf(fx, sizeof fx, "%s.fx", j);
        snprintf(fy, sizeof fy, "%s.fy", j);
        snprintf(mz, sizeof mz, "%s.tz", j);
        add_load(&text[0], &text[1], &text[2], body->name, head, fx, fy, mz);
    }
    if (strcmp(body_of(model, tail), body->name) == 0) {
        snprintf(fx, sizeof fx, "-%s.fx", j);
        snprintf(fy, sizeof fy, "-%s.fy", j);
        snprintf(mz, sizeof mz, "-%s.tz - ((%s.x - %s.x)*%s.fy - (%s.y - %s.y)*%s.fx)", j, head,
                 tail, j, head, tail, j);
        add_load(&text[0], &text[1], &text[2], body->name, tail, fx, fy, mz);
    }
}

static void add_given(const Model *model, const char *loads, const Instance *body, Text text[3])
{
    while (*loads != '\0') {
        char parts[4][300];

        for (int i = 0; i < 4; i++) {
            size_t length = strcspn(loads, i < 3 ? " " : ";");

            snprintf(parts[i], sizeof parts[i], "%.*s", (int)length, loads);
            loads += length + 1;
        }
        if (strcmp(body_of(model, parts[0]), body->name) == 0)
            add_load(&text[0], &text[1], &text[2], body->name, parts[0], parts[1], parts[2],
                     parts[3]);
    }
}

typedef LIST(Expr) Items;

static void push(const Model *model, Items *items, const char *text)
{
    Expr e = scene_read(model, text);

    if (e != NULL)
        LIST_PUSH(*items, e);
}

/* m a - forces and I alpha - moments of each body: all zero */
static void push_balances(const Model *model, const Case *one, Items *items)
{
    for (int i = 0; i < model_count(model); i++) {
        const Instance *body = model_instance(model, i);
        double mass;
        double inertia;
        double gravity = model_number(model, model_gravity(model)[1]);
        Text text[3] = {{0}, {0}, {0}};

        if (body->row->family != FAMILY_BODY)
            continue;
        mass = model_number(model, instance_scalar(body, "mass"));
        inertia = model_number(model, instance_scalar(body, "inertia"));
        text_addf(&text[0], "%.17g*%s.ax", mass, body->name);
        text_addf(&text[1], "%.17g*(%s.ay - (%.17g))", mass, body->name, gravity);
        text_addf(&text[2], "%.17g*%s.alphaz", inertia, body->name);
        for (int j = 0; j < model_count(model); j++)
            if (model_instance(model, j)->row->family == FAMILY_JOINT)
                add_joint(model, model_instance(model, j), body, text);
        add_given(model, one->loads, body, text);
        for (int k = 0; k < 3; k++) {
            push(model, items, text[k].at);
            text_free(&text[k]);
        }
    }
}

/* forces of joints and places of bodies: the same for every pair */
static void push_motion(const Model *model, Items *items)
{
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);
        static const char *const of_joint[] = {"fx", "fy", "tz"};
        static const char *const of_body[] = {"x", "y", "vx", "vy", "wz", "ax", "ay"};
        bool joint = instance->row->family == FAMILY_JOINT;
        int count = joint                                  ? COUNT(of_joint)
                    : instance->row->family == FAMILY_BODY ? COUNT(of_body)
                                                           : 0;

        for (int k = 0; k < count; k++) {
            char name[80];

            snprintf(name, sizeof name, "%s.%s", instance->name, joint ? of_joint[k] : of_body[k]);
            push(model, items, name);
        }
    }
}

/* --- random pairs --- */

/* the statement that chooses a random tree; new string */
static char *random_tree(const Model *model, TreeKind kind, uint64_t *random)
{
    const Graph *graph = model_graph(model);
    int *preference = NEW_ARRAY(int, graph_edge_count(graph));
    TreeChoice choice = {.preference = preference};
    Tree *tree = NULL;
    Diag diag = {0};
    Text text = {0};

    for (int e = 0; e < graph_edge_count(graph); e++)
        preference[e] = (int)(test_random(random) % 1000);
    text_addf(&text, "tree %s", tree_kind_name(kind));
    EXPECT(tree_complete(graph, kind, &choice, false, &tree, &diag) == OK);
    for (int e = 0; e < graph_edge_count(graph) && tree != NULL; e++)
        if (tree_has(tree, e) && graph_branching(graph, e, kind) != BRANCH_ALWAYS)
            text_addf(&text, " %s", graph_edge(graph, e)->name);
    tree_free(tree);
    mem_free(preference);
    return text_done(&text);
}

static double parameter_value(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

/* values of all items at all rows; NULL and a fault when it can't be run */
static double *run_pair(Model *model, const Case *one, int *rows, int *count, int *balances)
{
    System *system = scene_system(model);
    StartValues start = {model_start_count(model), NULL};
    RunOptions options = {
        .duration = one->duration, .every = one->every, .rtol = 1e-11, .atol = 1e-12};
    SimulationInput setting = {.parameter = parameter_value, .context = model, .start = &start};
    ResultReader *reader = NULL;
    Result *result = NULL;
    Items items = {0};
    double *values = NULL;
    Diag diag = {0};

    if (system == NULL)
        return NULL;
    start.at = NEW_ARRAY(struct StartValue, start.count);
    for (int i = 0; i < start.count; i++) {
        const Start *from = model_start(model, i);

        start.at[i] = (struct StartValue){from->name, from->primes,
                                          model_number(model, from->value), from->is_guess};
    }
    push_motion(model, &items);
    *balances = items.count;
    push_balances(model, one, &items);
    *count = items.count;
    if (run_simulate(system, &setting, &options, &result, &reader, &diag) == OK) {
        *rows = result_rows(result);
        values = NEW_ARRAY(double, (size_t)*rows *(size_t)*count);
        if (result_reader_values(reader, items.at, items.count, values, &diag) != OK) {
            mem_free(values);
            values = NULL;
        }
    }
    if (values == NULL) {
        test_faults++;
        printf("%s: %s (%s)\n", one->name, diag.message, diag.hint);
    }
    result_reader_free(reader);
    result_free(result);
    mem_free(start.at);
    LIST_FREE(items);
    system_free(system);
    return values;
}

/* largest of a column over the rows, of the first run */
static double column_scale(const double *values, int rows, int count, int column)
{
    double scale = 0.0;

    for (int r = 0; r < rows; r++)
        scale = fmax(scale, fabs(values[r * count + column]));
    return scale;
}

static void compare(const Case *one, const char *trees, const double *first, const double *values,
                    int rows, int count, int balances)
{
    double largest = 0.0;

    for (int c = 0; c < balances; c++)
        largest = fmax(largest, column_scale(first, rows, count, c));
    for (int c = 0; c < count; c++) {
        double scale = fmax(column_scale(first, rows, count, c), 1e-4 * largest);

        for (int r = 0; r < rows; r++) {
            double wanted = c < balances ? first[r * count + c] : 0.0;
            double error = fabs(values[r * count + c] - wanted);

            if (error <= 1e-7 * (c < balances ? scale : largest))
                continue;
            test_faults++;
            printf("%s, %s: column %d of %d, row %d: %.12g, wanted %.12g\n", one->name, trees, c,
                   count, r, values[r * count + c], wanted);
            return;
        }
    }
}

static void check_case(const Case *one)
{
    uint64_t random = 20;
    LIST(char *) seen = {0};
    double *first = NULL;
    int rows = 0;

    for (int attempt = 0; attempt < MOST_TRIES && seen.count < MOST_PAIRS && test_faults == 0;
         attempt++) {
        Model *model = scene_new(one->scene);
        char *translation = random_tree(model, TREE_TRANSLATION, &random);
        char *rotation = random_tree(model, TREE_ROTATION, &random);
        Text pair = {0};
        double *values = NULL;
        int count = 0;
        int balances = 0;
        bool is_new = true;

        text_addf(&pair, "%s\n%s\n", translation, rotation);
        for (int i = 0; i < seen.count; i++)
            is_new = is_new && strcmp(seen.at[i], pair.at) != 0;
        if (is_new) {
            scene_add(model, pair.at);
            scene_add(model, one->start);
            values = run_pair(model, one, &rows, &count, &balances);
            if (first == NULL && values != NULL) {
                first = values;
                values = NULL;
            }
            if (first != NULL)
                compare(one, pair.at, first, values != NULL ? values : first, rows, count,
                        balances);
            LIST_PUSH(seen, text_done(&pair));
        }
        mem_free(values);
        text_free(&pair);
        mem_free(translation);
        mem_free(rotation);
        model_free(model);
    }
    printf("%s: %d pairs of trees\n", one->name, seen.count);
    EXPECT(seen.count >= (one->fewest < MOST_PAIRS ? one->fewest : MOST_PAIRS));
    for (int i = 0; i < seen.count; i++)
        mem_free(seen.at[i]);
    LIST_FREE(seen);
    mem_free(first);
}

static void slider_crank_moves_alike_in_all_trees(void)
{
    check_case(&cases[0]);
}

static void motor_arm_moves_alike_in_all_trees(void)
{
    check_case(&cases[1]);
}

static void pendulum_moves_alike_in_all_trees(void)
{
    check_case(&cases[2]);
}

static void four_bar_moves_alike_in_all_trees(void)
{
    check_case(&cases[3]);
}

static void squeezer_moves_alike_in_all_trees(void)
{
    check_case(&cases[4]);
}

int main(void)
{
    RUN(slider_crank_moves_alike_in_all_trees);
    RUN(motor_arm_moves_alike_in_all_trees);
    RUN(pendulum_moves_alike_in_all_trees);
    RUN(four_bar_moves_alike_in_all_trees);
    RUN(squeezer_moves_alike_in_all_trees);
    return test_end();
}

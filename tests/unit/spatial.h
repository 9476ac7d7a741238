/* spatial.h: random spatial mechanisms for tests, and what is compared of them
 *
 * A tree of bodies with random joints is put into a random position; a joint that closes a
 * loop is fitted into that position by an arm. */
#ifndef COTREE_TESTS_SPATIAL_H
#define COTREE_TESTS_SPATIAL_H

#include "scene.h"

#include "simulate/run/run.h"

#include <gsl/gsl_linalg.h>

typedef LIST(Expr) Items;
typedef LIST(char *) Words;

static const char *const kinds[] = {"revolute",  "prismatic",   "cylindrical", "universal",
                                    "spherical", "planarjoint", "weld",        "revolute",
                                    "screw",     "free"};

static int pick(uint64_t *random, int count)
{
    return (int)(test_random(random) % (uint64_t)count);
}

static void add_vector(Text *text, uint64_t *random, double size)
{
    text_addf(text, "[%.3f, %.3f, %.3f]", test_uniform(random, -size, size),
              test_uniform(random, -size, size), test_uniform(random, 0.1, size));
}

/* a joint of a random kind with random axes */
static void add_joint(Text *text, uint64_t *random, int number, const char *tail, const char *head,
                      const char *kind)
{
    text_addf(text, "%s j%d %s %s", kind, number, tail, head);
    if (strcmp(kind, "universal") == 0) {
        static const char *const axes[] = {"[x, y]", "[z, x]", "[y, -z]"};

        text_addf(text, " axes=%s", axes[pick(random, 3)]);
    } else if (strcmp(kind, "planarjoint") == 0) {
        text_add(text, " normal=");
        add_vector(text, random, 1.0);
    } else if (strcmp(kind, "revolute") == 0 || strcmp(kind, "prismatic") == 0 ||
               strcmp(kind, "cylindrical") == 0 || strcmp(kind, "screw") == 0) {
        text_add(text, " axis=");
        add_vector(text, random, 1.0);
    }
    if (strcmp(kind, "screw") == 0)
        text_add(text, " pitch=0.3");
    text_char(text, '\n');
}

/* bodies b0, b1 ... hung on ground or on one another */
static char *random_tree_of_bodies(uint64_t *random, int bodies)
{
    Text text = {0};

    text_add(&text, "gravity [0.5, 1, -9.81]\n");
    for (int i = 0; i < bodies; i++) {
        int parent = i == 0 ? -1 : pick(random, i + 1) - (pick(random, 3) == 0);

        if (parent >= i)
            parent = i - 1;
        text_addf(&text, "body b%d mass=%.3f inertia=[%.3f, %.3f, %.3f, 0.01, -0.02, 0.03]\n", i,
                  test_uniform(random, 0.5, 2.0), test_uniform(random, 0.3, 0.5),
                  test_uniform(random, 0.3, 0.5), test_uniform(random, 0.3, 0.5));
        text_addf(&text, "arm h%d b%d ", i, i);
        add_vector(&text, random, 0.6);
        text_addf(&text, " rotation=x(%.3f)*z(%.3f)\n", test_uniform(random, -2.0, 2.0),
                  test_uniform(random, -2.0, 2.0));
        if (parent < 0)
            text_addf(&text, "arm t%d ground ", i);
        else
            text_addf(&text, "arm t%d b%d ", i, parent);
        add_vector(&text, random, 0.6);
        text_addf(&text, " rotation=y(%.3f)\n", test_uniform(random, -2.0, 2.0));
        {
            char tail[16];
            char head[16];

            snprintf(tail, sizeof tail, "t%d", i);
            snprintf(head, sizeof head, "h%d", i);
            add_joint(&text, random, i, tail, head, kinds[pick(random, COUNT(kinds))]);
        }
    }
    return text_done(&text);
}

/* beside each joint of a scene a virtual one of its kind, between the same frames: v3 beside j3 */
__attribute__((unused)) static void add_twins(const char *scene, Text *text)
{
    for (const char *line = scene; *line != '\0';) {
        size_t length = strcspn(line, "\n");
        const char *name = strchr(line, ' ') + 1;

        if (name[0] == 'j')
            text_addf(text, "virtual %.*s v%.*s\n", (int)(name - line) - 1, line,
                      (int)(line + length - name) - 1, name + 1);
        line += length + (line[length] == '\n');
    }
}

/* ... and what is guessed of the one is guessed of the other */
__attribute__((unused)) static void add_twin_guesses(const char *guesses, Text *text)
{
    for (const char *line = guesses; *line != '\0';) {
        size_t length = strcspn(line, "\n");
        const char *name = line + strlen("guess ");

        if (name[0] == 'j')
            text_addf(text, "guess v%.*s\n", (int)(line + length - name) - 1, name + 1);
        line += length + (line[length] == '\n');
    }
}

/* --- values --- */

static void push(const Model *model, Items *items, const char *text)
{
    Expr e = scene_read(model, text);

    if (e != NULL)
        LIST_PUSH(*items, e);
}

static double parameter_value(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

/* a reader of the assembled positions, and of the speeds; assembled_free(). NULL: there are none */
static ResultReader *assembled(Model *model, System *system, Diag *diag)
{
    StartValues start = {model_start_count(model), NULL};
    SimulationInput setting = {.parameter = parameter_value, .context = model, .start = &start};
    ResultReader *reader = NULL;
    Result *result = NULL;

    start.at = NEW_ARRAY(struct StartValue, start.count);
    for (int i = 0; i < start.count; i++) {
        const Start *from = model_start(model, i);

        start.at[i] = (struct StartValue){from->name, from->primes,
                                          model_number(model, from->value), from->is_guess};
    }
    if (run_assemble(system, &setting, &result, &reader, diag) != OK)
        reader = NULL;
    mem_free(start.at);
    return reader;
}

static void assembled_free(ResultReader *reader)
{
    Result *result = reader != NULL ? (Result *)result_reader_result(reader) : NULL;

    result_reader_free(reader);
    result_free(result);
}

/* values of names, each of them a variable, all at once; where some can't be determined each for
 * itself, and those are NAN */
static double *values_of(const Model *model, ResultReader *reader, const char *const *names,
                         int count)
{
    double *values = NEW_ARRAY(double, count);
    Items items = {0};
    Diag diag = {0};

    for (int i = 0; i < count; i++)
        push(model, &items, names[i]);
    if (items.count < count || result_reader_values(reader, items.at, count, values, &diag) != OK)
        for (int i = 0; i < items.count; i++)
            if (result_reader_values(reader, &items.at[i], 1, &values[i], &diag) != OK)
                values[i] = NAN;
    LIST_FREE(items);
    return values;
}

static double value_of(const Model *model, ResultReader *reader, const char *name)
{
    double *values = values_of(model, reader, &name, 1);
    double value = values[0];

    mem_free(values);
    return value;
}

/* --- starts --- */

/* random values for the coordinates of the joints */
static void guess_joints(const Model *model, uint64_t *random, Text *text)
{
    for (int i = 0; i < model_count(model); i++) {
        const Instance *joint = model_instance(model, i);

        for (int c = 0; joint->row->family == FAMILY_JOINT && c < joint->coord_count; c++) {
            double value = test_uniform(random, -0.8, 0.8);

            if (joint->coord_kind[c] == COORDINATE_PARAMETER) {
                double norm = 0.0;
                double p[4];

                for (int k = 0; k < 4; k++) {
                    p[k] = test_uniform(random, 0.2, 1.0);
                    norm += p[k] * p[k];
                }
                for (int k = 0; k < 4; k++)
                    text_addf(text, "guess %s = %.17g\n", joint->coord[c + k], p[k] / sqrt(norm));
                c += 3;
                continue;
            }
            text_addf(text, "guess %s = %.17g\n", joint->coord[c], value);
        }
    }
}

/* random values for the speeds of this system, from which the ones that fit are found */
__attribute__((unused)) static void guess_speeds(Model *model, const System *system,
                                                 uint64_t *random)
{
    for (int i = 0; i < system_nu(system); i++) {
        char line[80];

        snprintf(line, sizeof line, "guess %s = %.3f", system_u(system, i)->name,
                 test_uniform(random, -1.0, 1.0));
        scene_add(model, line);
    }
}

static const char *const places[] = {"x", "y", "z", "q0", "q1", "q2", "q3"};
static const char *const motions[] = {"vx", "vy", "vz", "wx", "wy", "wz"};

/* lines `verb b3.x = value` of members of all bodies */
static void start_bodies(const Model *model, ResultReader *reader, int bodies, const char *verb,
                         const char *const *members, int count, Text *text)
{
    Words names = {0};
    double *values;

    for (int i = 0; i < bodies * count; i++) {
        char name[32];

        snprintf(name, sizeof name, "b%d.%s", i / count, members[i % count]);
        LIST_PUSH(names, mem_text(name, strlen(name)));
    }
    values = values_of(model, reader, (const char *const *)names.at, names.count);
    for (int i = 0; i < names.count; i++) {
        text_addf(text, "%s %s = %.17g\n", verb, names.at[i], values[i]);
        mem_free(names.at[i]);
    }
    LIST_FREE(names);
    mem_free(values);
}

/* --- closing a loop in the position that the open tree is in --- */

static void matrix_of(const Model *model, ResultReader *reader, int body, double r[3], double R[9])
{
    char name[16];
    double p[4];

    for (int k = 0; k < 3; k++) {
        snprintf(name, sizeof name, "b%d.%s", body, places[k]);
        r[k] = value_of(model, reader, name);
    }
    for (int k = 0; k < 4; k++) {
        snprintf(name, sizeof name, "b%d.%s", body, places[3 + k]);
        p[k] = value_of(model, reader, name);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;

            R[3 * i + j] = 2.0 * p[1 + i] * p[1 + j];
            if (i == j)
                R[4 * i] += p[0] * p[0] - p[1] * p[1] - p[2] * p[2] - p[3] * p[3];
            else
                R[3 * i + j] += (j == (i + 1) % 3 ? -2.0 : 2.0) * p[0] * p[1 + k];
        }
}

/* an arm on ground that lies where the last body is, and a joint between the two */
static void close_loop(const Model *model, ResultReader *reader, int bodies, uint64_t *random,
                       Text *text)
{
    static const char *const closing[] = {"spherical", "universal", "cylindrical", "planarjoint"};
    double r[3];
    double R[9];
    char head[16];

    matrix_of(model, reader, bodies - 1, r, R);
    /* R = Rz Ry Rx */
    text_addf(
        text, "arm closing ground [%.17g, %.17g, %.17g] rotation=z(%.17g)*y(%.17g)*x(%.17g)\n",
        r[0], r[1], r[2], atan2(R[3], R[0]), -asin(fmax(-1.0, fmin(1.0, R[6]))), atan2(R[7], R[8]));
    snprintf(head, sizeof head, "b%d", bodies - 1);
    add_joint(text, random, 99, "closing", head, closing[pick(random, COUNT(closing))]);
}

/* --- comparing --- */

/* smallest over largest singular value of Phi_u; 1 without constraints */
static double condition(ResultReader *reader, const System *system)
{
    int m = system_m(system);
    int n = system_nu(system);
    gsl_matrix *a;
    gsl_matrix *V;
    gsl_vector *s;
    gsl_vector *work;
    double *entries;
    double ratio;
    Diag diag = {0};

    if (m == 0)
        return 1.0;
    if (m > n)
        return 0.0;
    a = gsl_matrix_alloc((size_t)n, (size_t)m);
    V = gsl_matrix_alloc((size_t)m, (size_t)m);
    s = gsl_vector_alloc((size_t)m);
    work = gsl_vector_alloc((size_t)m);
    entries = NEW_ARRAY(double, m *n);
    EXPECT(result_reader_values(reader, system_run(system)->phi_u, m * n, entries, &diag) == OK);
    for (int i = 0; i < m * n; i++)
        gsl_matrix_set(a, (size_t)(i % n), (size_t)(i / n), entries[i]);
    mem_free(entries);
    (void)gsl_linalg_SV_decomp(a, V, s, work);
    ratio = gsl_vector_get(s, (size_t)m - 1) / gsl_vector_get(s, 0);
    gsl_matrix_free(a);
    gsl_matrix_free(V);
    gsl_vector_free(s);
    gsl_vector_free(work);
    return ratio;
}

static void compared_names(const Model *model, int bodies, Words *names, int *of_bodies)
{
    static const char *const of_body[] = {"ax", "ay", "az", "alphax", "alphay", "alphaz"};
    static const char *const of_joint[] = {"fx", "fy", "fz", "tx", "ty", "tz"};
    char name[32];

    for (int i = 0; i < bodies; i++)
        for (int k = 0; k < COUNT(of_body); k++) {
            snprintf(name, sizeof name, "b%d.%s", i, of_body[k]);
            LIST_PUSH(*names, mem_text(name, strlen(name)));
        }
    *of_bodies = names->count;
    for (int i = 0; i < model_count(model); i++)
        for (int k = 0;
             model_instance(model, i)->row->family == FAMILY_JOINT && k < COUNT(of_joint); k++) {
            snprintf(name, sizeof name, "%s.%s", model_instance(model, i)->name, of_joint[k]);
            LIST_PUSH(*names, mem_text(name, strlen(name)));
        }
}

/* the branch, or now and then the virtual one beside it where that has a freedom; a screw's for
 * both trees */
static const char *branch_name(const Model *model, const Instance *owner, TreeKind kind,
                               uint64_t *random)
{
    const Instance *twin;
    char name[16];

    snprintf(name, sizeof name, "v%s", owner->name + 1);
    twin = model_find(model, name);
    if (owner->name[0] != 'j' || twin == NULL ||
        graph_branching(model_graph(model), twin->edge, kind) == BRANCH_NEVER ||
        (strcmp(owner->row->name, "screw") == 0 ? owner->number % 2 : pick(random, 2)) == 0)
        return owner->name;
    return twin->name;
}

/* a statement with random trees, or a preset */
static char *choose_trees(const Model *model, int choice, uint64_t *random)
{
    const Graph *graph = model_graph(model);
    Text text = {0};

    if (choice < 2)
        text_add(&text, choice == 0 ? "tree joint\n" : "tree absolute\n");
    for (TreeKind kind = TREE_TRANSLATION; choice >= 2 && kind <= TREE_ROTATION; kind++) {
        int *preference = NEW_ARRAY(int, graph_edge_count(graph));
        TreeChoice chosen = {.preference = preference};
        Tree *tree = NULL;
        Diag diag = {0};

        for (int e = 0; e < graph_edge_count(graph); e++) {
            const Instance *owner = model_edge_owner(model, e);
            bool tied = owner != NULL && strcmp(owner->row->name, "screw") == 0;

            /* a screw is a branch of both trees or of none: of both here */
            preference[e] = tied ? -1 : pick(random, 1000);
        }
        EXPECT(tree_complete(graph, kind, &chosen, false, &tree, &diag) == OK);
        text_addf(&text, "tree %s", tree_kind_name(kind));
        for (int e = 0; tree != NULL && e < graph_edge_count(graph); e++)
            if (tree_has(tree, e) && graph_branching(graph, e, kind) != BRANCH_ALWAYS)
                text_addf(&text, " %s",
                          branch_name(model, model_edge_owner(model, e), kind, random));
        text_char(&text, '\n');
        tree_free(tree);
        mem_free(preference);
    }
    return text_done(&text);
}

/* the joint that closes the loop does so where its coordinates are 0 */
static void guess_closing(Model *model, const char *coordinate)
{
    const size_t length = strlen(coordinate);
    char line[80];

    if (strncmp(coordinate + 1, "99", 2) != 0)
        return;
    snprintf(line, sizeof line, "guess %s = %d", coordinate,
             length > 3 && strcmp(coordinate + length - 3, ".q0") == 0);
    scene_add(model, line);
}

/* those of the guesses that are coordinates of the system: others may be told in more than one way
 */
static void add_guesses(Model *model, const System *system, const char *guesses)
{
    for (int i = 0; i < system_n(system); i++)
        guess_closing(model, system_q(system, i)->name);
    while (guesses != NULL && *guesses != '\0') {
        size_t length = strcspn(guesses, "\n");
        char *line = mem_text(guesses, length);

        for (int i = 0; i < system_n(system); i++) {
            const char *name = system_q(system, i)->name;

            if (strncmp(line + strlen("guess "), name, strlen(name)) == 0 &&
                line[strlen("guess ") + strlen(name)] == ' ')
                scene_add(model, line);
        }
        mem_free(line);
        guesses += length + (guesses[length] == '\n');
    }
}

#endif

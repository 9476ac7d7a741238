/* bench_edit.c: a chain of 100 links, and a ladder of 1000 elements, formed anew, and after an edit
 * of the middle
 *
 * Both up to the programs that a run steps with.
 *
 * `bench_edit planar joint insert` (or spatial; absolute; another row of `counted_edits`) forms the
 * equations alone, after an edit that follows earlier equations; with the last word `anew` it forms
 * those of the edited model for the first time. Instructions are counted by
 *     valgrind --tool=callgrind --toggle-collect=counted bench_edit planar joint insert
 */
#include "formulate/system/system.h"
#include "model/model.h"

#include "../random.h"
#include "bench.h"
#include "bench_compile.h"
#include "bench_model.h"

#include <math.h>
#include <string.h>

enum { LINKS = 100, RUNGS = 500, TRIES = 4 };

static void add_link(Text *text, int i, bool planar, uint64_t *random)
{
    const char *z = planar ? "" : ", 0.1";

    text_addf(text, "body b%d mass=%.3f inertia=", i, test_uniform(random, 0.5, 2.0));
    if (planar)
        text_addf(text, "%.3f\n", test_uniform(random, 0.3, 0.5));
    else
        text_addf(text, "[%.3f, %.3f, %.3f, 0.01, -0.02, 0.03]\n", test_uniform(random, 0.3, 0.5),
                  test_uniform(random, 0.3, 0.5), test_uniform(random, 0.3, 0.5));
    text_addf(text, "arm h%d b%d [%.3f, 0%s]\n", i, i, test_uniform(random, -0.6, -0.3), z);
    if (i > 0)
        text_addf(text, "arm t%d b%d [%.3f, 0.2%s]\n", i, i - 1, test_uniform(random, 0.3, 0.6), z);
    text_addf(text, "revolute j%d ", i);
    if (i == 0)
        text_add(text, "ground h0");
    else
        text_addf(text, "t%d h%d", i, i);
    if (!planar)
        text_addf(text, " axis=[%.3f, %.3f, 1]", test_uniform(random, -1.0, 1.0),
                  test_uniform(random, -1.0, 1.0));
    text_char(text, '\n');
}

static char *chain_text(bool planar, const char *tree, bool loop)
{
    Text text = {0};
    uint64_t random = 1993;

    text_add(&text, planar ? "scene planar\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < LINKS; i++)
        add_link(&text, i, planar, &random);
    if (loop)
        text_addf(&text, "arm e b%d [0.4, 0.2%s]\narm g ground [3, 1%s]\nrevolute closing g e\n",
                  LINKS - 1, planar ? "" : ", 0", planar ? "" : ", 0");
    text_addf(&text, "tree %s\n", tree);
    return text_done(&text);
}

/* Those of the model as it is, from those before an edit (or NULL): as a session does it. */
static Status renew(const Model *model, System **system, Diag *diag)
{
    const SystemOptions options = {.has_lifted = true};
    Scene scene = {0};
    System *made = NULL;
    Status status = OK;

    CHECK(model_scene(model, &scene, diag));
    if (*system == NULL || !system_follows(*system, &scene)) {
        CHECK(system_new_view(&scene, &options, &made, diag));
        system_free(*system);
        *system = made;
    }
done:
    scene_free(&scene);
    return status;
}

/* The equations and the programs that a run steps with: seconds. */
static double form(const Model *model, System **system)
{
    const double began = clock_now();
    Diag diag = {0};
    const Status status = renew(model, system, &diag);
    const double took = clock_now() - began;

    if (status == OK)
        return took + bench_compile(model, *system);
    printf("# %s\n", diag.message);
    return took;
}

static void edit(Model *model, const char *lines)
{
    size_t next = 0;

    while (next < strlen(lines)) {
        Statement *statement = NULL;
        Diag diag = {0};
        const bool applied =
            statement_parse(lines, 1, (SyntaxOptions){0}, &next, &statement, &diag) == OK &&
            model_apply(model, statement, &diag) == OK;

        statement_free(statement);
        if (!applied) {
            printf("# %s\n", diag.message);
            return;
        }
    }
}

static void chain_line(bool planar, const char *tree, bool loop, const char *what, double seconds)
{
    Text name = {0};

    text_addf(&name, "edit.%s_%s%s_%d_%s", planar ? "planar" : "spatial", tree, loop ? "_loop" : "",
              LINKS, what);
    bench_line(name.at, 1e3 * seconds, "ms");
    text_free(&name);
}

static const struct Edit {
    const char *what, *one, *other;
} planar_edits[] =
    {
        {"mass", "set b50.mass = 1.25", "set b50.mass = 1.75"},
        {"length", "set h50.position = [-0.5, 0]", "set h50.position = [-0.4, 0]"},
        {"type", "delete j50; revolute j50 t50 h50", "delete j50; prismatic j50 t50 h50 axis=x"},
        {"body", "body more mass=1 inertia=1; revolute tip b99 more", "delete tip; delete more"},
},
  spatial_edits[] = {
      {"mass", "set b50.mass = 1.25", "set b50.mass = 1.75"},
      {"length", "set h50.position = [-0.5, 0, 0.2]", "set h50.position = [-0.4, 0, 0.1]"},
      {"joint", "set j50.axis = [0.5, 0.25, 1]", "set j50.axis = [0.25, 0.5, 1]"},
      {"type", "delete j50; revolute j50 t50 h50", "delete j50; prismatic j50 t50 h50 axis=x"},
      {"body", "body more mass=1 inertia=[1, 1, 1]; revolute tip b99 more",
       "delete tip; delete more"},
};

static void bench_chain(bool planar, const char *tree, bool loop)
{
    const struct Edit *edits = planar ? planar_edits : spatial_edits;
    const char *choice = strcmp(tree, "joint") == 0 ? "tree joint" : "tree absolute";
    char *text = chain_text(planar, tree, loop);
    double least = 1e300;
    Model *model = NULL;
    System *system = NULL;

    for (int i = 0; i < TRIES; i++) {
        system_free(system);
        system = NULL;
        model_free(model);
        model = bench_model(text);
        least = fmin(least, form(model, &system));
    }
    chain_line(planar, tree, loop, "anew", least);
    for (int k = 0; k < (planar ? COUNT(planar_edits) : COUNT(spatial_edits)); k++) {
        double sum = 0;

        /* the mean of edits each of which changes something */
        for (int i = 0; i < TRIES; i++) {
            edit(model, i % 2 == 0 ? edits[k].one : edits[k].other);
            if (strcmp(edits[k].what, "type") == 0 || strcmp(edits[k].what, "body") == 0)
                edit(model, choice);
            sum += form(model, &system);
        }
        chain_line(planar, tree, loop, edits[k].what, sum / TRIES);
    }
    system_free(system);
    model_free(model);
    mem_free(text);
}

/* --- one edit, for who counts instructions --- */

static const struct CountedEdit {
    const char *what, *planar, *spatial;
} counted_edits[] = {
    {"insert",
     "delete j50; body more mass=1 inertia=1; arm s more [0.4, 0]; revolute j50 t50 more;"
     "revolute j50b s h50",
     "delete j50; body more mass=1 inertia=[1, 1, 1]; arm s more [0.4, 0, 0];"
     "revolute j50 t50 more; revolute j50b s h50"},
    {"append", "body more mass=1 inertia=1; revolute tip b99 more",
     "body more mass=1 inertia=[1, 1, 1]; revolute tip b99 more"},
    {"delete", "delete j99", "delete j99"},
    {"middle", "delete j50", "delete j50"},
};

__attribute__((noinline)) static void counted(const Model *model, System **system)
{
    Diag diag = {0};

    if (renew(model, system, &diag) != OK)
        printf("# %s\n", diag.message);
}

static int count_once(bool planar, const char *tree, const char *what, bool anew)
{
    char *text = chain_text(planar, tree, false);
    Model *model = bench_model(text);
    System *system = NULL;
    Diag diag = {0};

    if (!anew && renew(model, &system, &diag) != OK)
        printf("# %s\n", diag.message);
    for (int i = 0; i < COUNT(counted_edits); i++)
        if (strcmp(counted_edits[i].what, what) == 0)
            edit(model, planar ? counted_edits[i].planar : counted_edits[i].spatial);
    edit(model, strcmp(tree, "joint") == 0 ? "tree joint" : "tree absolute");
    counted(model, &system);
    system_free(system);
    model_free(model);
    mem_free(text);
    return 0;
}

static char *ladder_text(void)
{
    Text text = {0};
    uint64_t random = 1993;

    text_add(&text, "vsource V n0 0 sin(10*t)\n");
    for (int i = 0; i < RUNGS; i++)
        text_addf(&text, "resistor R%d n%d n%d %.3f\ncapacitor C%d n%d 0 %.6f\n", i, i, i + 1,
                  test_uniform(&random, 1, 2), i, i + 1, test_uniform(&random, 1e-3, 2e-3));
    return text_done(&text);
}

static void bench_ladder(void)
{
    static const char *const edits[] = {"set R50.R = 1.25", "set R50.R = 1.75"};
    char *text = ladder_text();
    Model *model = bench_model(text);
    System *system = NULL;
    double sum = 0;

    bench_line("edit.ladder_1000_anew", 1e3 * form(model, &system), "ms");
    for (int i = 0; i < TRIES; i++) {
        edit(model, edits[i % 2]);
        sum += form(model, &system);
    }
    bench_line("edit.ladder_1000_resistance", 1e3 * sum / TRIES, "ms");
    system_free(system);
    model_free(model);
    mem_free(text);
}

int main(int argc, char **argv)
{
    static const char *const trees[] = {"joint", "absolute"};

    if (argc >= 4)
        return count_once(strcmp(argv[1], "planar") == 0, argv[2], argv[3], argc > 4);
    for (int i = 0; i < COUNT(trees); i++) {
        bench_chain(true, trees[i], false);
        bench_chain(false, trees[i], false);
    }
    bench_chain(true, "joint", true);
    bench_ladder();
    return 0;
}

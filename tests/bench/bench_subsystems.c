/* bench_subsystems.c: a planar robot of 30 legs, and a platform on 30 spatial ones, each leg an
 * instance of one definition, against the same parts written out: forming the equations in
 * milliseconds, both in turn, alone and with the programs that a run steps with, and after one leg
 * was changed, removed and added again, with the programs then; and runs of them, on two threads in
 * parts of the time on one
 *
 * `bench_subsystems planar legs form` (or spatial; or flat) forms the equations once; with another
 * last word it forms them again after an edit, or compiles: instructions are counted by
 *     valgrind --tool=callgrind --toggle-collect=counted bench_subsystems planar legs form
 */
#include "formulate/system/system.h"
#include "model/model.h"

#include "../unit/session_kit.h"
#include "base/text.h"
#include "bench.h"
#include "bench_compile.h"
#include "bench_model.h"

#include <math.h>
#include <string.h>

enum { LEGS = 30, TRIES = 9 };

static void add_planar(Text *text, const char *p, const char *base)
{
    text_addf(text, "%sL1 = 0.4\n%sL2 = 0.6\n", p, p);
    text_addf(text, "body %sl1 mass=3 inertia=0.04\nbody %sl2 mass=4 inertia=0.12\n", p, p);
    text_addf(text, "arm %sa1 %sl1 [-%sL1/2, 0]\narm %sk1 %sl1 [%sL1/2, 0]\n", p, p, p, p, p, p);
    text_addf(text, "arm %sk2 %sl2 [-%sL2/2, 0]\narm %sB %sl2 [%sL2/2, 0]\n", p, p, p, p, p, p);
    text_addf(text, "revolute %sth1 %s %sa1\nrevolute %sth2 %sk1 %sk2\n", p, base, p, p, p, p);
    text_addf(text, "motor %sM %sth1 %su 0 R=1 L=1 Kt=1 Kv=1\nresistor %sR %su 0 5\n", p, p, p, p,
              p);
}

static void add_spatial(Text *text, const char *p, const char *base)
{
    text_addf(text, "%sL1 = 0.4\n%sL2 = 0.6\n", p, p);
    text_addf(text, "body %sl1 mass=3 inertia=[0.04, 0.05, 0.06]\n", p);
    text_addf(text, "body %sl2 mass=4 inertia=[0.12, 0.1, 0.05]\n", p);
    text_addf(text, "arm %sa1 %sl1 [-%sL1/2, 0, 0]\narm %sk1 %sl1 [%sL1/2, 0, 0]\n", p, p, p, p, p,
              p);
    text_addf(text, "arm %sk2 %sl2 [-%sL2/2, 0, 0]\narm %sB %sl2 [%sL2/2, 0, 0]\n", p, p, p, p, p,
              p);
    text_addf(text, "universal %sth1 %s %sa1 axes=[y, z]\n", p, base, p);
    text_addf(text, "prismatic %sth2 %sk1 %sk2 axis=x\nspring %ssp %sth2 k=100 rest=0.2\n", p, p, p,
              p, p);
}

static char *robot_text(bool planar, bool flat)
{
    void (*const add_leg)(Text *, const char *, const char *) = planar ? add_planar : add_spatial;
    const char *const z = planar ? "" : ", 0", *const dot = flat ? "_" : ".";
    Text text = {0};

    text_add(&text, planar ? "scene planar\ngravity [0, -9.81]\nbody m mass=8 inertia=0.08\n"
                           : "gravity [0, 0, -9.81]\nbody m mass=8 inertia=[0.1, 0.2, 0.3]\n");
    if (!flat) {
        text_add(&text, "subsystem leg frames=[A, B]\n");
        add_leg(&text, "", "A");
        text_add(&text, "end\n");
    }
    for (int i = 0; i < LEGS; i++) {
        const double at = 2 * M_PI * i / LEGS;
        Text prefix = {0}, base = {0};

        text_addf(&prefix, "leg%d%s", i, dot);
        text_addf(&base, "g%d", i);
        text_addf(&text, "arm g%d ground [%.5f, %.5f%s]\narm p%d m [%.5f, %.5f%s]\n", i,
                  0.6 * cos(at), 0.6 * sin(at), z, i, 0.2 * cos(at), 0.2 * sin(at), z);
        if (flat)
            add_leg(&text, prefix.at, base.at);
        else
            text_addf(&text, "use leg leg%d A=g%d\n", i, i);
        text_addf(&text, "%s h%d leg%d%sB p%d\n", planar ? "revolute" : "spherical", i, i, dot, i);
        text_free(&prefix);
        text_free(&base);
    }
    text_add(&text, "tree m");
    for (int i = 0; i < LEGS; i++)
        text_addf(&text, " leg%d%sth1 leg%d%sth2", i, dot, i, dot);
    text_char(&text, '\n');
    return text_done(&text);
}

static void apply(Model *model, const char *line)
{
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag = {0};

    if (statement_parse(line, 1, (SyntaxOptions){0}, &next, &statement, &diag) != OK ||
        model_apply(model, statement, &diag) != OK)
        printf("# %s\n", diag.message);
    statement_free(statement);
}

/* seconds, from the equations before an edit (*before NULL: none) to those of the model as it is,
 * as a session does it */
__attribute__((noinline)) static double form(Model *model, System **before)
{
    const SystemOptions options = {.has_lifted = true};
    Scene scene = {0};
    System *system = NULL;
    Diag diag = {0};
    Status status;
    const double began = clock_now();

    status = model_scene(model, &scene, &diag);
    if (status == OK && (*before == NULL || !system_follows(*before, &scene)))
        status = system_new_view(&scene, &options, &system, &diag);
    const double took = clock_now() - began;

    if (status != OK)
        printf("# %s\n", diag.message);
    if (system != NULL) {
        system_free(*before);
        *before = system;
    }
    scene_free(&scene);
    return took;
}

static void line(bool planar, const char *what, double value, const char *unit)
{
    Text name = {0};

    text_addf(&name, "subsystems.%s_%d_%s", planar ? "planar" : "spatial", LEGS, what);
    bench_line(name.at, value, unit);
    text_free(&name);
}

static void remove_leg(Model *model)
{
    apply(model, "delete h7");
    apply(model, "delete leg7");
}

static void add_again(Model *model, bool planar)
{
    apply(model, "use leg leg7 A=g7");
    apply(model, planar ? "revolute h7 leg7.B p7" : "spherical h7 leg7.B p7");
    apply(model, "tree + leg7.th1 + leg7.th2 - h7");
}

/* one leg of many: its number, itself away, itself again; parts of the time that all take */
static void bench_edits(bool planar, const char *text)
{
    static const char *const what[] = {"edit", "remove", "add", "compile_after_add"};
    double least[COUNT(what)] = {1e300, 1e300, 1e300, 1e300}, all = 1e300;

    for (int i = 0; i < TRIES; i++) {
        Model *model = bench_model(text);
        System *system = NULL;

        all = fmin(all, form(model, &system));
        apply(model, "set leg7.l1.mass = 5");
        least[0] = fmin(least[0], form(model, &system));
        remove_leg(model);
        least[1] = fmin(least[1], form(model, &system));
        add_again(model, planar);
        least[2] = fmin(least[2], form(model, &system));
        least[3] = fmin(least[3], bench_compile(model, system));
        system_free(system);
        model_free(model);
    }
    for (int k = 0; k < COUNT(what); k++)
        line(planar, what[k], least[k] / all, "of all");
}

typedef struct Times {
    double formed, compiled; /* seconds, the least; compiled: both together */
} Times;

static void time_once(const char *text, Times *least)
{
    Model *model = bench_model(text);
    System *system = NULL;
    double formed;

    if (model == NULL)
        return;
    formed = form(model, &system);
    least->formed = fmin(least->formed, formed);
    least->compiled = fmin(least->compiled, formed + bench_compile(model, system));
    system_free(system);
    model_free(model);
}

static void bench_robot(bool planar)
{
    char *texts[] = {robot_text(planar, false), robot_text(planar, true)};
    Times least[] = {{1e300, 1e300}, {1e300, 1e300}};

    for (int i = 0; i < TRIES; i++)
        for (int flat = 0; flat < 2; flat++)
            time_once(texts[flat], &least[flat]);
    bench_edits(planar, texts[0]);
    line(planar, "time", 1e3 * least[0].formed, "ms");
    line(planar, "flat_time", 1e3 * least[1].formed, "ms");
    line(planar, "ratio", least[0].formed / least[1].formed, "of flat");
    line(planar, "compiled", 1e3 * least[0].compiled, "ms");
    line(planar, "compiled_ratio", least[0].compiled / least[1].compiled, "of flat");
    mem_free(texts[0]);
    mem_free(texts[1]);
}

/* s that a run takes in a session, at least; the session has run it before */
static double run_once(Kit *kit, int threads)
{
    char set[40];
    double least;

    (void)snprintf(set, sizeof set, "set jobs %d\n", threads);
    if (kit_do(kit, set) != CT_OK)
        printf("# %s\n", kit->error.message);
    BENCH_LEAST(1, least,
                if (kit_do(kit, "simulate 2 every=0.1\n") != CT_OK)
                    printf("# %s\n", kit->error.message));
    return least;
}

/* by turns, so that what else the machine does disturbs both */
static void bench_run(bool planar)
{
    char *text = robot_text(planar, false);
    Kit kit = kit_new();
    double least[2] = {1e300, 1e300};

    if (kit_do(&kit, text) != CT_OK)
        printf("# %s\n", kit.error.message);
    for (int i = 0; i < 2 * TRIES; i++)
        least[i % 2] = fmin(least[i % 2], run_once(&kit, 1 + i % 2));
    line(planar, "run", 1e3 * least[0], "ms");
    line(planar, "two_threads", least[1] / least[0], "of one");
    kit_free(&kit);
    mem_free(text);
}

/* --- one of them, for who counts instructions --- */

enum { COUNT_FORM, COUNT_EDIT, COUNT_REMOVE, COUNT_ADD, COUNT_COMPILE, COUNT_COMPILE_ADDED };

static const char *const counts[] = {"form", "edit", "remove", "add", "compile", "compile_added"};

__attribute__((noinline)) static void counted(Model *model, System **system, bool compiles)
{
    if (compiles)
        (void)bench_compile(model, *system);
    else
        (void)form(model, system);
}

/* what comes before it isn't counted */
static void count_after(Model *model, bool planar, int what)
{
    const bool compiles = what == COUNT_COMPILE_ADDED || what == COUNT_COMPILE;
    System *system = NULL;

    if (what != COUNT_FORM)
        (void)form(model, &system);
    if (what == COUNT_COMPILE_ADDED)
        (void)bench_compile(model, system);
    if (what == COUNT_EDIT)
        apply(model, "set leg7.l1.mass = 5");
    if (what == COUNT_REMOVE || what == COUNT_ADD || what == COUNT_COMPILE_ADDED)
        remove_leg(model);
    if (what == COUNT_ADD || what == COUNT_COMPILE_ADDED) {
        (void)form(model, &system);
        add_again(model, planar);
    }
    if (what == COUNT_COMPILE_ADDED)
        (void)form(model, &system);
    counted(model, &system, compiles);
    system_free(system);
}

static int count_once(bool planar, bool flat, const char *word)
{
    char *text = robot_text(planar, flat);
    Model *model = bench_model(text);
    int what = 0;

    while (what < COUNT(counts) && strcmp(counts[what], word) != 0)
        what++;
    if (model != NULL && what < COUNT(counts))
        count_after(model, planar, what);
    model_free(model);
    mem_free(text);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 4)
        return count_once(strcmp(argv[1], "planar") == 0, strcmp(argv[2], "flat") == 0, argv[3]);
    bench_robot(true);
    bench_robot(false);
    bench_run(true);
    bench_run(false);
    return 0;
}

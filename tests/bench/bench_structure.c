/* bench_structure.c: time of an evaluation by number of bodies, in both kinds of coordinates:
 * chains of links on revolute joints, and four-bars in a row, rods of 1 m and 1 kg. Per body it
 * should be flat. */
#include "bench.h"
#include "robot_text.h"
#include "simulate_script.h"

#include "base/text.h"

static char *chain_text(int links)
{
    Text text = {0};
    char *chain = robot_chain(links);

    text_add(&text, chain);
    for (int i = 0; i < links; i++)
        text_addf(&text, "init h%d = %g\n", i, 0.3 * (i * 7 % 5 - 2));
    mem_free(chain);
    return text_done(&text);
}

static char *four_bars_text(int cells)
{
    Text text = {0};

    text_add(&text, "scene planar\ngravity [0, -9.81]\n");
    for (int k = 0; k <= cells; k++) {
        text_addf(&text, "arm g%d ground [%d, 0]\nbody r%d mass=1 inertia=1/12\n", k, k, k);
        text_addf(&text, "arm a%d r%d [0, -0.5]\narm t%d r%d [0, 0.5]\n", k, k, k, k);
        text_addf(&text, "revolute h%d g%d a%d\nguess h%d = 0\n", k, k, k, k);
    }
    for (int k = 0; k < cells; k++) {
        text_addf(&text, "body c%d mass=1 inertia=1/12\narm l%d c%d [-0.5, 0]\n", k, k, k);
        text_addf(&text, "arm q%d c%d [0.5, 0]\nrevolute u%d t%d l%d\n", k, k, k, k, k);
        text_addf(&text, "revolute v%d q%d t%d\n", k, k, k + 1);
    }
    text_add(&text, "init h0 = 0, h0' = -1\n");
    return text_done(&text);
}

/* the quickest of some runs; false: it didn't run */
static bool run_some(const char *model, const char *tree, double duration, RunReport *out)
{
    Text text = {0};
    bool ran = true;

    text_addf(&text, "%stree %s\nsimulate %g rtol=1e-6 every=%g\n", model, tree, duration,
              duration);
    for (int i = 0; i < 4 && ran; i++) {
        Script script;

        script_open(&script, text.at, &(Changes){0});
        ran = script.result != NULL;
        if (!ran)
            printf("# tree %s: %s\n", tree, script.diag.message);
        else if (i == 0 || result_report(script.result)->wall < out->wall)
            *out = *result_report(script.result);
        script_close(&script);
    }
    text_free(&text);
    return ran;
}

/* what a run takes beyond one of a fifth of its time, which compiles and assembles as much */
static void bench_size(const char *kind, char *(*write)(int), int size, const char *tree,
                       double duration)
{
    char *model = write(size), name[60];
    RunReport first = {0}, all = {0};

    (void)snprintf(name, sizeof name, "structure.%s_%d_%s", kind, size, tree);
    if (run_some(model, tree, duration / 5, &first) && run_some(model, tree, duration, &all))
        bench_line(name,
                   1e6 * (all.wall - first.wall) / (double)(all.evaluations - first.evaluations),
                   "us/evaluation");
    else
        test_faults++;
    mem_free(model);
}

int main(void)
{
    static const struct {
        const char *kind;
        char *(*write)(int);
        int size;
        double joint, absolute; /* s; 0: left out, forming it takes too long */
    } cases[] = {
        {"chain", chain_text, 2, 20, 20},       {"chain", chain_text, 10, 2, 2},
        {"chain", chain_text, 50, 1, 1},        {"chain", chain_text, 200, 0.5, 0.5},
        {"chain", chain_text, 1000, 0.4, 0},    {"four_bar", four_bars_text, 1, 10, 10},
        {"four_bar", four_bars_text, 10, 2, 2}, {"four_bar", four_bars_text, 40, 1, 1},
    };

    for (int i = 0; i < COUNT(cases); i++) {
        bench_size(cases[i].kind, cases[i].write, cases[i].size, "joint", cases[i].joint);
        if (cases[i].absolute > 0)
            bench_size(cases[i].kind, cases[i].write, cases[i].size, "absolute", cases[i].absolute);
    }
    return test_faults > 0 ? 1 : 0;
}

/* bench_simulate.c: work of a run of each reference at fixed tolerances: evaluations of the
 * right-hand side, steps, milliseconds; the error is what tests/unit/test_simulate_cases.c bounds
 */
#include "bench.h"
#include "simulate_script.h"

#include "base/text.h"

static void bench_text(const char *name, const char *text, Changes changes)
{
    double least = 1e300;
    long evaluations = 0, steps = 0;
    char line[80];

    changes.skip_expects = true;
    for (int i = 0; i < 5 && text != NULL; i++) {
        Script script;

        script_open(&script, text, &changes);
        if (script.result == NULL) {
            printf("# %s: %s\n", name, script.diag.message);
        } else {
            const RunReport *report = result_report(script.result);

            least = fmin(least, report->wall);
            evaluations = (long)report->evaluations;
            steps = (long)report->steps;
        }
        script_close(&script);
    }
    (void)snprintf(line, sizeof line, "simulate.%s", name);
    bench_line(line, 1e3 * least, "ms");
    (void)snprintf(line, sizeof line, "simulate.%s_rhs", name);
    bench_line(line, (double)evaluations, "evaluations");
    (void)snprintf(line, sizeof line, "simulate.%s_steps", name);
    bench_line(line, (double)steps, "steps");
}

static void bench_case(const char *name, const char *path, Changes changes)
{
    char *text = script_file(path);

    bench_text(name, text, changes);
    mem_free(text);
}

/* links on hinges with springs and dampers, thrown about: implicit methods renew their Jacobian */
static void bench_stiff_chain(const char *name, const char *method)
{
    Text text = {0};

    text_add(&text, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= 40; i++) {
        text_addf(&text,
                  "body b%d mass=1 inertia=0.01\narm a%d b%d [-0.1, 0]\narm c%d b%d [0.1, 0]\n", i,
                  i, i, i, i);
        if (i == 1)
            text_add(&text, "revolute h1 ground a1\n");
        else
            text_addf(&text, "revolute h%d c%d a%d\n", i, i - 1, i);
        text_addf(&text, "spring k%d h%d k=200 d=0.02\n", i, i);
    }
    text_add(&text, "init h1 = 1, h2 = -2, h1' = 9\nsimulate 0.05\n");
    bench_text(name, text.at, (Changes){.method = method});
    text_free(&text);
}

/* 21 flywheels and 20 clutches that stick and slip, or the same laws with tanh(w/1e-4) */
static void bench_clutches(const char *name, bool regularised)
{
    Text text = {0};

    for (int i = 0; i <= 20; i++)
        text_addf(&text, "flywheel J%d a%d 0 J=%g\ninit J%d.w = %d\n", i, i, 1 + 0.3 * (i % 3), i,
                  i * 13 % 7 - 3);
    for (int i = 0; i < 20; i++)
        if (regularised)
            text_addf(&text, "torquesource c%d a%d a%d -%d*tanh((J%d.w - J%d.w)/1e-4)\n", i, i,
                      i + 1, 3 + 2 * (i * 7 % 5), i, i + 1);
        else
            text_addf(&text, "clutch c%d a%d a%d torque=%d\n", i, i, i + 1, 3 + 2 * (i * 7 % 5));
    text_add(&text, "torquesource T a0 0 10*sin(4*t)\nsimulate 3\n");
    bench_text(name, text.at, (Changes){.method = regularised ? "radau" : NULL});
    text_free(&text);
}

/* a ball that comes to rest on a floor, in some 300 impacts */
static void bench_ball(const char *name)
{
    bench_text(name,
               "scene planar\ngravity [0, -9.81]\nbody m mass=1\nprismatic s ground m axis=y\n"
               "init s = 1\nstop floor s low=0 e=0.95\nsimulate 20\n",
               (Changes){0});
}

/* 10 blocks in a row, with gaps between them: the first is thrown at the others, and a wall at the
 * end sends them back */
static void bench_blocks(const char *name)
{
    Text text = {0};

    text_add(&text, "scene planar\n");
    for (int i = 1; i <= 10; i++) {
        text_addf(&text, "body m%d mass=%g\nprismatic s%d ground m%d axis=x\n", i,
                  1 + 0.3 * (i % 3), i, i);
        if (i > 1)
            text_addf(&text, "backlash g%d s%d s%d gap=%g e=0.8\n", i, i, i - 1, 0.2 + 0.01 * i);
    }
    text_add(&text, "stop w s10 high=0.5 low=-0.5 e=0.7\ninit s1' = 3\nsimulate 3\n");
    bench_text(name, text.at, (Changes){0});
    text_free(&text);
}

int main(void)
{
    static const struct {
        const char *name, *path;
        Changes changes;
    } cases[] = {
        {"slider_crank_1e-9", "scripts/paper/1_slider_crank_one_tree.ct", {.rtol = 1e-9}},
        {"slider_crank_embedded_1e-9",
         "scripts/paper/1_slider_crank_one_tree.ct",
         {.rtol = 1e-9, .before = "form embedded\n"}},
        {"slider_crank_bdf_1e-12",
         "scripts/paper/1_slider_crank_one_tree.ct",
         {.rtol = 1e-12, .method = "bdf"}},
        {"slider_crank_ida_1e-12",
         "scripts/paper/1_slider_crank_one_tree.ct",
         {.rtol = 1e-12, .method = "ida"}},
        {"motor_arm_1e-12", "scripts/paper/3_motor_arm_forward.ct", {.rtol = 1e-12}},
        {"motor_arm_inverse", "scripts/paper/3_motor_arm_inverse.ct", {0}},
        {"pendulum_joint_1e-12", "scripts/reference/ref_A01_pendulum_joint.ct", {.rtol = 1e-12}},
        {"pendulum_absolute_1e-12",
         "scripts/reference/ref_A01_pendulum_absolute.ct",
         {.rtol = 1e-12}},
        {"four_bar_joint_1e-8",
         "scripts/reference/ref_A02_four_bar_joint.ct",
         {.rtol = 1e-8, .duration = 10}},
        {"four_bar_absolute_1e-8",
         "scripts/reference/ref_A02_four_bar_absolute.ct",
         {.rtol = 1e-8, .duration = 10}},
        {"andrews_joint_1e-10",
         "scripts/reference/ref_A03_andrews.ct",
         {.rtol = 1e-10, .duration = 0.03}},
        {"andrews_absolute_1e-10",
         "scripts/reference/ref_A03_andrews.ct",
         {.rtol = 1e-10, .duration = 0.03, .before = "tree absolute\n"}},
    };

    for (int i = 0; i < COUNT(cases); i++)
        bench_case(cases[i].name, cases[i].path, cases[i].changes);
    bench_stiff_chain("stiff_chain_40_radau", "radau");
    bench_stiff_chain("stiff_chain_40_bdf", "bdf");
    bench_clutches("clutches_20", false);
    bench_clutches("clutches_20_tanh", true);
    bench_ball("ball_stop");
    bench_blocks("blocks_10_gaps");
    return test_faults > 0 ? 1 : 0;
}

/* test_evaluator.c: whatever evaluates, runs are the same */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#ifndef PR_SET_MDWE /* older headers than systems */
#define PR_SET_MDWE              65
#define PR_MDWE_REFUSE_EXEC_GAIN 1
#endif

/* a double pendulum with a spring that stiffens, and a forced circuit with a nonlinear coil */
static const char *const models[] = {
    "scene planar\ngravity [0, -9.81]\nbody a mass=1 inertia=0.1\n"
    "body b mass=0.5 inertia=0.02\narm a0 a [-0.4, 0]; arm a1 a [0.6, 0]; arm b0 b [-0.7, 0]\n"
    "revolute h1 ground a0\nrevolute h2 a1 b0\n"
    "torque T1 b -exp(h2/4)*log(2 + cos(h1))\ninit h1 = 1, h2' = 3\n",
    "vsource V1 a 0 10*sin(300*t)\nresistor R1 a b 5\ninductor L1 b 0 0.1\n"
    "capacitor C1 b 0 1e-5\ninit L1.i = 0, C1.v = 0\n"};
static const char *const shown[] = {"h1 + 10*h2", "L1.i + 10*C1.v"};

static double end_of_run(int model, const char *evaluator, const char *run)
{
    Kit kit = kit_new();
    char line[64];
    double value;

    (void)snprintf(line, sizeof line, "set evaluator %s\n", evaluator);
    EXPECT_DONE(&kit, line);
    EXPECT_DONE(&kit, models[model]);
    EXPECT_DONE(&kit, run);
    value = kit_value(&kit, shown[model]);
    kit_free(&kit);
    return value;
}

static void strict_runs_have_the_interpreters_digits(void)
{
    static const char *const runs[] = {"simulate 2 method=dop853",
                                       "simulate 0.5 method=rk4 step=5e-5",
                                       "simulate 0.5 method=radau"};

    for (int model = 0; model < COUNT(models); model++)
        for (int i = 0; i < COUNT(runs); i++)
            EXPECT(end_of_run(model, "strict", runs[i]) ==
                   end_of_run(model, "interpreter", runs[i]));
}

static void native_runs_agree_to_rounding(void)
{
    for (int model = 0; model < COUNT(models); model++) {
        const char *run = "simulate 1 rtol=1e-10 atol=1e-10";
        const double strict = end_of_run(model, "strict", run);

        EXPECT_NEAR(end_of_run(model, "native", run), strict, 1e-8 * (1 + fabs(strict)));
    }
}

static const char *kit_text(const Kit *kit)
{
    return kit->text != NULL ? kit->text : "";
}

static void the_setting_is_shown_saved_and_taken_back(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "show settings");
    EXPECT(strstr(kit_text(&kit), "evaluator  strict") != NULL);
    EXPECT_DONE(&kit, "set evaluator native");
    EXPECT_DONE(&kit, "show settings");
    EXPECT(strstr(kit_text(&kit), "evaluator  native") != NULL);
    EXPECT_FAILS(&kit, "set evaluator fast", "evaluator is strict or native or interpreter");
    EXPECT_DONE(&kit, "undo");
    EXPECT_DONE(&kit, "show settings");
    EXPECT(strstr(kit_text(&kit), "evaluator  strict") != NULL);
    kit_free(&kit);
}

/* --- threads --- */

/* a free body with arms enough that threads pay; new */
static char *armed(void)
{
    Text text = {0};

    text_add(&text, "gravity [0, 0, -9.81]\nbody m mass=8 inertia=[1, 2, 3]\n"
                    "subsystem limb frames=[A]\nbody l mass=2 inertia=[0.04, 0.05, 0.06]\n"
                    "body k mass=1 inertia=[0.1, 0.2, 0.2]\narm a l [-0.3, 0, 0.1]\n"
                    "arm b l [0.3, 0.1, 0]\narm c k [-0.2, 0, 0]\n"
                    "universal th A a axes=[y, z]\nspherical el b c\nend\n");
    for (int i = 0; i < 24; i++)
        text_addf(&text, "arm p%d m [%d, 1, 0]\nuse limb limb%d A=p%d\ninit limb%d.th.a1' = 1\n", i,
                  i, i, i, i);
    return text_done(&text);
}

static bool stops_later(void *context)
{
    int *left = context;

    return (*left)-- <= 0;
}

static void a_run_of_several_threads_can_be_stopped(void)
{
    int left = 60;
    const ct_hooks hooks = {.context = &left, .stop = stops_later, .columns = 80};
    Kit kit = kit_new();
    char *model = armed();
    double end;

    EXPECT_DONE(&kit, "set jobs 4");
    EXPECT_DONE(&kit, model);
    EXPECT_DONE(&kit, "simulate 0.2");
    end = kit_value(&kit, "m.x");
    ct_session_hooks(kit.session, &hooks);
    EXPECT(kit_do(&kit, "simulate 1e5 every=1") == CT_STOPPED);
    ct_session_hooks(kit.session, NULL);
    EXPECT_DONE(&kit, "simulate 0.2");
    EXPECT(kit_value(&kit, "m.x") == end);
    EXPECT_DONE(&kit, "set jobs 1");
    EXPECT_DONE(&kit, "simulate 0.2");
    EXPECT(kit_value(&kit, "m.x") == end);
    mem_free(model);
    kit_free(&kit);
}

static void wrong_numbers_of_threads_are_refused(void)
{
    static const char *const wrong[] = {
        "set jobs 0",   "set jobs=0",  "set jobs 1.5", "set jobs many",
        "set jobs 1e9", "set jobs 65", "set jobs 2 m", "set jobs",
        "set jobs 2 3", "set jobs=-1", "set jobs='2'", "set jobs=2, evaluator=native"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "set jobs 3");
    for (int i = 0; i < COUNT(wrong); i++)
        EXPECT(kit_do(&kit, wrong[i]) == CT_FAILED);
    EXPECT_FAILS(&kit, "set jobs 0", "jobs is a whole number from 1 to 64");
    EXPECT(strstr(kit.error.hint, "set jobs 2") != NULL);
    EXPECT_DONE(&kit, "show settings");
    EXPECT(strstr(kit_text(&kit), "jobs       3") != NULL);
    EXPECT_DONE(&kit, "set jobs=64");
    EXPECT_DONE(&kit, "undo");
    EXPECT_DONE(&kit, "show settings");
    EXPECT(strstr(kit_text(&kit), "jobs       3") != NULL);
    kit_free(&kit);
}

/* --- memory --- */

/* whether any memory of this process can be written and run at once; where that isn't told: no */
static bool some_memory_is_both(void)
{
    FILE *maps = fopen("/proc/self/maps", "r");
    char line[400];
    bool is_both = false;

    while (maps != NULL && fgets(line, sizeof line, maps) != NULL)
        is_both = is_both || strstr(line, " rwx") != NULL;
    if (maps != NULL)
        (void)fclose(maps);
    return is_both;
}

static void no_memory_is_written_and_run(void)
{
    const bool before = some_memory_is_both(); /* as a tool's around this process */
    Kit kit = kit_new();

    EXPECT_DONE(&kit, models[0]);
    EXPECT_DONE(&kit, "simulate 1");
    EXPECT(before || !some_memory_is_both());
    kit_free(&kit);
}

/* The last one: this process may make no memory run from now on, where the system can refuse it. */
static void a_refusal_leaves_the_interpreter(void)
{
    const double strict = end_of_run(0, "strict", "simulate 1");
    Kit kit;

#ifdef __linux__
    if (prctl(PR_SET_MDWE, PR_MDWE_REFUSE_EXEC_GAIN, 0L, 0L, 0L) != 0)
        return;
#else
    return;
#endif
    EXPECT(end_of_run(0, "strict", "simulate 1") == strict);
    kit = kit_new();
    EXPECT_DONE(&kit, "set evaluator native");
    EXPECT(strstr(ct_remarks(kit.session), "no native code can be run here") != NULL);
    EXPECT_DONE(&kit, "set evaluator strict");
    EXPECT(strstr(ct_remarks(kit.session), "native") == NULL);
    kit_free(&kit);
}

int main(void)
{
    RUN(strict_runs_have_the_interpreters_digits);
    RUN(native_runs_agree_to_rounding);
    RUN(the_setting_is_shown_saved_and_taken_back);
    RUN(a_run_of_several_threads_can_be_stopped);
    RUN(wrong_numbers_of_threads_are_refused);
    RUN(no_memory_is_written_and_run);
    RUN(a_refusal_leaves_the_interpreter);
    return test_end();
}

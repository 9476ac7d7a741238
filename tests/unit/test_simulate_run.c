/* test_simulate_run.c: assembly, driven runs, results and messages on small models */
#include "simulate_script.h"

#include "base/text.h"
#include "form.h"

#define CRANK                                                                                      \
    "scene planar\ngravity [0, -9.81]\n"                                                           \
    "body m1 mass=2 inertia=0.01\nbody m2 mass=1.2 inertia=0.03\nbody m3 mass=3 inertia=0.01\n"    \
    "arm r4 m1 [-0.08, 0]\narm r5 m1 [0.12, 0]\narm r6 m2 [0.25, 0]\narm r7 m2 [-0.35, 0]\n"       \
    "revolute h8 ground r4\nrevolute h9 r5 r6\nrevolute h10 m3 r7\nprismatic s11 ground m3 "       \
    "axis=x\n"                                                                                     \
    "tree h8 h10 s11\n"

#define PENDULUM                                                                                   \
    "scene planar\ngravity [0, -9.81]\nbody p mass=2 inertia=0.5\narm a p [0, 1.5]\n"              \
    "revolute h ground a\n"

static Script run(const char *text, Changes changes)
{
    Script script;

    script_open(&script, text, &changes);
    return script;
}

static void expect_message(const char *text, Status status, const char *message)
{
    Script script = run(text, (Changes){0});

    EXPECT(script.status == status);
    EXPECT_TEXT(script.diag.message, message);
    EXPECT(script.diag.hint[0] != '\0' || status == E_STOPPED || status == E_SOLVER ||
           status == E_VALUE);
    script_close(&script);
}

/* --- assembly --- */

static void a_guess_chooses_the_elbow(void)
{
    Script right = run(CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\nassemble",
                       (Changes){0});
    Script left = run(CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 0.3, s11 = -0.5\nassemble",
                      (Changes){0});
    double up = asin(0.2 * sin(3.14159265358979323846 / 3) / 0.6);

    EXPECT_NEAR(value_at(&right, "h10", 0), 3.14159265358979323846 - up, 1e-13);
    EXPECT_NEAR(value_at(&left, "h10", 0), up, 1e-13);
    EXPECT_NEAR(value_at(&left, "s11", 0), 0.1 - 0.6 * cos(up), 1e-13);
    EXPECT_NEAR(value_at(&right, "h8'", 0), 12, 1e-13);
    script_close(&right);
    script_close(&left);
}

static void any_variable_may_be_given(void)
{
    Script script =
        run(CRANK "init m3.x = 0.7, m3.vx = -1\nguess h8 = 1, h10 = 2.8\nassemble", (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_NEAR(value_at(&script, "s11", 0), 0.7, 1e-13);
    EXPECT_NEAR(value_at(&script, "s11'", 0), -1, 1e-12);
    EXPECT(value_at(&script, "h8", 0) > 0.5);
    script_close(&script);
}

static void chords_may_be_given_in_absolute_coordinates(void)
{
    Script script = run(CRANK "tree absolute\ninit h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = "
                              "0.67\nassemble",
                        (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_NEAR(value_at(&script, "s11", 0), 0.674456264653803, 1e-12);
    EXPECT_NEAR(value_at(&script, "h10'", 0), -2.08893187146837, 1e-11);
    script_close(&script);
}

static void network_states_may_be_given(void)
{
    Script script = run("resistor R1 a b 10\ncapacitor C1 b 0 1e-3\nvsource V1 a 0 5\n"
                        "init R1.i = 0.2\nassemble",
                        (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_TEXT(script.diag.message, "");
    EXPECT_NEAR(value_at(&script, "C1.v", 0), 3, 1e-12);
    script_close(&script);
}

static void contradicting_values_are_named(void)
{
    Script script =
        run(CRANK "init h8 = 60 deg, s11 = 0.9\nguess h10 = 2.85\nassemble", (Changes){0});
    const char *given = strstr(script.diag.message, "; given: ");

    EXPECT(script.status == E_ASSEMBLE);
    EXPECT(strstr(script.diag.message, "the parts can't be put together; missed: h9 (x) by 0.2") ==
           script.diag.message);
    EXPECT_TEXT(given, "; given: h8 = 1.0472, s11 = 0.9");
    EXPECT_TEXT(script.diag.hint, "leave one of the given values out, or make it a guess");
    EXPECT(script.result == NULL);
    script_close(&script);
}

static void a_loop_that_cant_close_is_named(void)
{
    expect_message(PENDULUM "arm far ground [9, 9]\nrevolute k far p\ntree h\nassemble", E_ASSEMBLE,
                   "the parts can't be put together; missed: k (x) by 9, k (y) by 7.5");
}

static void contradicting_speeds_are_named(void)
{
    Script script = run(CRANK "init h8 = 60 deg, h8' = 12, s11' = 0\nguess h10 = 2.85, s11 = "
                              "0.67\nassemble",
                        (Changes){0});

    EXPECT(script.status == E_ASSEMBLE);
    EXPECT(strstr(script.diag.message, "no speeds satisfy the constraints; missed: h9 (x) by ") ==
           script.diag.message);
    EXPECT(strstr(script.diag.message, "h8' = 12, s11' = 0") != NULL);
    script_close(&script);
}

static void contradicting_currents_are_named(void)
{
    Script script = run("resistor R1 a b 10\ncapacitor C1 b 0 1e-3\nvsource V1 a 0 5\n"
                        "init R1.i = 0.2, C1.v = 1\nassemble",
                        (Changes){0});

    EXPECT(script.status == E_ASSEMBLE);
    EXPECT(strstr(script.diag.message, "the network's initial values contradict; missed: ") ==
           script.diag.message);
    script_close(&script);
}

static void forces_are_no_initial_values(void)
{
    Script script = run(CRANK, (Changes){0});
    StartValue value = {"h9.fx", 0, 3, false};
    StartValues start = {1, &value};
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model),
                               .start = &start};
    Diag diag = {0};

    EXPECT(form_system(script.model, &script.system, &diag) == OK);
    EXPECT(run_assemble(script.system, &setting, &script.result, NULL, &diag) == E_ASSEMBLE);
    EXPECT_TEXT(diag.message, "h9.fx follows from forces and can't be an initial value");
    script_close(&script);
}

static void a_start_without_accelerations_is_refused(void)
{
    expect_message(
        "scene planar\nbody p mass=1 inertia=0\nrevolute h ground p\nsimulate 1", E_SINGULAR,
        "no accelerations can be found at the start: what h moves has no mass or inertia");
}

static void a_repeated_joint_is_redundant(void)
{
    Script script = run(PENDULUM "revolute h2 ground a\ntree h\ninit h = 1, h' = 0\n"
                                 "simulate 1 rtol=1e-10",
                        (Changes){0});
    Script twice = run(PENDULUM "revolute h2 ground a\ntree absolute\ninit h = 1, h' = 0\n"
                                "simulate 1 rtol=1e-10",
                       (Changes){0});

    EXPECT(script.status == OK && twice.status == OK);
    EXPECT(strstr(script_remarks(&twice), "redundant: h") != NULL);
    EXPECT_NEAR(value_at(&script, "h", 1), value_at(&twice, "h", 1), 1e-9);
    /* both pins carry the same: nothing tells them apart */
    EXPECT_NEAR(value_at(&twice, "h.fy", 1), value_at(&twice, "h2.fy", 1), 1e-9);
    script_close(&script);
    script_close(&twice);
}

static void a_singular_start_is_told(void)
{
    Script script = run("scene planar\nbody c0 mass=1 inertia=1\nbody k mass=1 inertia=1\n"
                        "body c1 mass=1 inertia=1\narm g ground [1, 0]\narm b0 c0 [0, 1]\n"
                        "arm b1 c1 [0, 1]\narm k0 k [-0.5, 0]\narm k1 k [0.5, 0]\n"
                        "revolute a0 ground c0\nrevolute a1 g c1\nrevolute l b0 k0\nrevolute r b1 "
                        "k1\ntree a0 a1 l\n"
                        "init a0 = 90 deg, a1 = 90 deg, l = -90 deg\nassemble",
                        (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_TEXT(script_remarks(&script),
                "the start is a singular position: 1 of 2 constraints hold there\n");
    script_close(&script);
}

/* --- driven --- */

static void a_driven_crank_moves_its_slider(void)
{
    Script script = run(CRANK "driver D1 h8 = 1 + 2*pi*t\nguess h10 = 2.9, s11 = 0.7\n"
                              "kinematics 1 every=0.1",
                        (Changes){0});
    const double pi = 3.14159265358979323846;

    EXPECT(script.status == OK);
    for (int k = 0; k <= 10; k++) {
        double a = 1 + 2 * pi * k / 10, up = asin(0.2 * sin(a) / 0.6);

        EXPECT_NEAR(value_at(&script, "s11", k / 10.0), 0.2 * cos(a) + 0.6 * cos(up), 1e-12);
        EXPECT_NEAR(value_at(&script, "s11'", k / 10.0),
                    -2 * pi * 0.2 * (sin(a) + cos(a) * tan(up)), 1e-10);
    }
    script_close(&script);
}

static void the_effort_of_a_driver_is_what_the_motion_takes(void)
{
    Script script = run(PENDULUM "driver D1 h = 0.3*t^2\ninverse 2 every=0.5", (Changes){0});
    double at = 1.5, angle = 0.3 * at * at;

    EXPECT(script.status == OK);
    EXPECT_NEAR(value_at(&script, "D1.effort", at),
                (0.5 + 2 * 1.5 * 1.5) * 0.6 + 2 * 9.81 * 1.5 * sin(angle), 1e-10);
    script_close(&script);
}

static void another_coordinate_supplies_the_same_power(void)
{
    static const char own[] = CRANK "driver D1 s11 = 0.7 + 0.05*sin(3*t)\nguess h8 = 0.9, h10 = "
                                    "2.9\ninverse 1 every=0.25";
    static const char by[] = CRANK "driver D1 s11 = 0.7 + 0.05*sin(3*t) by=h8\nguess h8 = 0.9, "
                                   "h10 = 2.9\ninverse 1 every=0.25";
    Script first = run(own, (Changes){0}), second = run(by, (Changes){0});

    EXPECT(first.status == OK && second.status == OK);
    EXPECT_TEXT(second.diag.message, "");
    if (second.status == OK) {
        const char *force = "D1.effort*s11'";

        /* the reaction of the pin differs: the way of the force does */
        EXPECT(fabs(value_at(&first, "h9.fx", 0.5) - value_at(&second, "h9.fx", 0.5)) > 1e-3);
        EXPECT(fabs(value_at(&first, force, 0.5)) > 1e-3);
        /* the driver's effort is then that of the coordinate that supplies it */
        EXPECT_NEAR(value_at(&second, "D1.effort*h8'", 0.5), value_at(&first, force, 0.5), 1e-9);
    }
    script_close(&first);
    script_close(&second);
}

static void missing_drivers_are_counted(void)
{
    expect_message(CRANK "kinematics 1", E_MODEL, "1 freedom is left that no driver moves");
}

static void a_supplied_driver_is_not_for_forward_runs(void)
{
    expect_message(CRANK "driver D1 s11 = 0.7 by=h8\nguess h8 = 0.9, h10 = 2.9\nsimulate 1",
                   E_MODEL, "a driver with by= is for inverse runs: h8.effort is not known here");
}

static void an_effort_that_cant_work_is_named(void)
{
    expect_message(PENDULUM "body p2 mass=1 inertia=1\nrevolute k ground p2\n"
                            "driver D1 h = t by=k\ndriver D2 k = 0\ninverse 1 every=0.5",
                   E_SINGULAR, "at t = 0 s no k.effort can produce the motion asked for");
}

static void a_state_beside_the_motion_hides_a_source(void)
{
    expect_message(PENDULUM "motor M h e 0 R=1 L=0.1 Kt=1 Kv=1\nvsource V e 0 0\n"
                            "resistor R1 e c 5\ncapacitor C1 c 0 1e-3\n"
                            "driver D1 h = sin(t) by=V\ninverse 1 every=0.5",
                   E_MODEL, "C1.v does not follow from the motion, so the sources can't be found");
}

static void a_stop_in_the_way_of_a_driver_ends_the_run(void)
{
    Script script = run(CRANK "driver D1 s11 = 0.7 + 0.5*t\nguess h8 = 0.9, h10 = 2.9\nkinematics "
                              "1 every=0.05",
                        (Changes){0});

    EXPECT(script.status == E_SOLVER);
    EXPECT(strstr(script.diag.message, "the drivers lead where the parts can't follow") != NULL);
    /* crank and rod are stretched at 0.8 m, 0.2 s */
    EXPECT(script.result != NULL && result_report(script.result)->reached > 0.1);
    script_close(&script);
}

/* --- forms --- */

static void the_embedded_form_takes_the_users_coordinates(void)
{
    Script script = run(CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                              "form embedded independent=[s11]\nsimulate 2 rtol=1e-9",
                        (Changes){0});
    Script plain = run(CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                             "simulate 2 rtol=1e-9",
                       (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_TEXT(script.diag.message, "");
    /* the slide can't tell the crank's way at a dead centre */
    EXPECT(script.result != NULL &&
           strstr(script_remarks(&script), "independent coordinates chosen anew at t = ") != NULL);
    EXPECT_NEAR(value_at(&script, "h8", 2), value_at(&plain, "h8", 2), 1e-6);
    script_close(&script);
    script_close(&plain);
}

static void an_unknown_independent_coordinate_is_named(void)
{
    expect_message(CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                         "form embedded independent=[h9]\nsimulate 2",
                   E_NAME, "'h9' is no coordinate of these trees");
}

/* --- forward: results --- */

static void a_resumed_run_is_one_run(void)
{
    Script script =
        run(PENDULUM "init h = 1, h' = 0\nsimulate 1 every=0.1 rtol=1e-11", (Changes){0});
    Script whole =
        run(PENDULUM "init h = 1, h' = 0\nsimulate 3 every=0.1 rtol=1e-11", (Changes){0});
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model)};
    RunOptions options = {.duration = 2, .every = 0.1, .rtol = 1e-11};
    ResultReader *reader = NULL;
    Result *resumed = NULL;
    Diag diag = {0};

    EXPECT(run_resume(script.result, &setting, &options, &resumed, &reader, &diag) == OK);
    EXPECT(result_rows(resumed) == result_rows(whole.result));
    result_reader_free(script.reader);
    result_free(script.result);
    script.reader = reader;
    script.result = resumed;
    EXPECT_NEAR(value_at(&script, "h", 3), value_at(&whole, "h", 3), 1e-9);
    EXPECT_NEAR(value_at(&script, "h", 0.5), value_at(&whole, "h", 0.5), 1e-10);
    script_close(&script);
    script_close(&whole);
}

static void only_forward_runs_are_resumed(void)
{
    Script script = run(PENDULUM "init h = 1, h' = 0\nassemble", (Changes){0});
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model)};
    RunOptions options = {.duration = 2};
    Result *resumed = NULL;
    Diag diag = {0};

    EXPECT(run_resume(script.result, &setting, &options, &resumed, NULL, &diag) == E_MISSING);
    EXPECT_TEXT(diag.message, "only a forward run can be resumed");
    script_close(&script);
}

static void values_between_rows_are_interpolated_and_projected(void)
{
    static const char text[] = CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                                     "simulate 1 every=0.01 rtol=1e-11";
    static const char fine[] = CRANK "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                                     "simulate 1 every=0.0025 rtol=1e-11";
    Script script = run(text, (Changes){0}), exact = run(fine, (Changes){0});

    EXPECT_NEAR(value_at(&script, "h8", 0.4375), value_at(&exact, "h8", 0.4375), 1e-8);
    EXPECT_NEAR(value_at(&script, "h8'", 0.4375), value_at(&exact, "h8'", 0.4375), 1e-5);
    EXPECT(value_at(&script, "constraint.error", 0.4375) < 1e-13);
    script_close(&script);
    script_close(&exact);
}

static void an_instant_outside_the_run_is_refused(void)
{
    Script script = run(PENDULUM "init h = 1, h' = 0\nsimulate 1 every=0.1", (Changes){0});
    Arena *arena = system_arena(script.system);
    Expr e = expr_symbol(arena, "h", SYMBOL_VARIABLE);
    Diag diag = {0};
    double value;

    EXPECT(result_reader_values_at(script.reader, &e, 1, 1.5, &value, &diag) == E_VALUE);
    EXPECT_TEXT(diag.message, "t = 1.5 s is outside the run, which goes from 0 to 1 s");
    script_close(&script);
}

static void a_second_run_estimates_the_error(void)
{
    Script script = run(PENDULUM "init h = 2, h' = 0", (Changes){0});
    StartValue values[2] = {{"h", 0, 2, false}, {"h", 1, 0, false}};
    StartValues start = {2, values};
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model),
                               .start = &start};
    RunOptions options = {.duration = 20, .rtol = 1e-6, .check = true};
    RunOptions exact = {.duration = 20, .rtol = 1e-12};
    ResultReader *reader = NULL;
    Result *fine = NULL;
    Expr e[2];
    double got[2], wanted[2], off;
    Diag diag = {0};

    EXPECT(form_system(script.model, &script.system, &diag) == OK);
    EXPECT(run_simulate(script.system, &setting, &options, &script.result, &script.reader, &diag) ==
           OK);
    EXPECT(run_simulate(script.system, &setting, &exact, &fine, &reader, &diag) == OK);
    e[0] = expr_symbol(system_arena(script.system), "h", SYMBOL_VARIABLE);
    e[1] = expr_symbol(system_arena(script.system), "h'", SYMBOL_VARIABLE);
    EXPECT(result_reader_values_at(script.reader, e, 2, 20, got, &diag) == OK);
    EXPECT(result_reader_values_at(reader, e, 2, 20, wanted, &diag) == OK);
    off = fmax(fabs(got[0] - wanted[0]), fabs(got[1] - wanted[1]));
    EXPECT(result_report(script.result)->global_error > off);
    EXPECT(result_report(script.result)->global_error < 100 * off);
    EXPECT(isnan(result_report(fine)->global_error));
    result_reader_free(reader);
    result_free(fine);
    script_close(&script);
}

static void an_unresolved_run_is_told(void)
{
    Script script =
        run(PENDULUM "body p2 mass=2 inertia=0.5\narm b p [0, -1.5]\narm c p2 [0, 1.5]\n"
                     "revolute k b c\ntree joint",
            (Changes){0});
    StartValue value = {"h", 0, 3, false};
    StartValues start = {1, &value};
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model),
                               .start = &start};
    RunOptions options = {.duration = 100, .rtol = 1e-5, .check = true};
    Diag diag = {0};

    EXPECT(form_system(script.model, &script.system, &diag) == OK);
    EXPECT(run_simulate(script.system, &setting, &options, &script.result, &script.reader, &diag) ==
           OK);
    EXPECT(script.result != NULL && strstr(script_remarks(&script), "not resolved: ") != NULL);
    EXPECT(result_report(script.result)->is_unresolved);
    EXPECT(isnan(result_report(script.result)->global_error));
    script_close(&script);
}

static void the_report_balances_energy(void)
{
    Script script = run(CRANK "force F m3 [-25 + 10*sin(5*t), 0]\ndamper d1 ground m3 d=0.5\n"
                              "spring k1 h8 k=3 rest=1\ninit h8 = 60 deg, h8' = 12\n"
                              "guess h10 = 2.85, s11 = 0.67\nsimulate 2 rtol=1e-10",
                        (Changes){0});
    const RunReport *report = result_report(script.result);

    EXPECT(script.status == OK);
    EXPECT(report->energy_scale > 5);
    EXPECT(report->energy_drift < 1e-8);
    EXPECT(report->position_residual < 1e-13 && report->velocity_residual < 1e-12);
    EXPECT(report->steps > 10 && report->evaluations > 100 && report->factorisations > 100);
    script_close(&script);
}

/* 50 J in a spring that oil slows down, 0.5 J in a capacitor: hardly anything moves, or nothing */
static void drift_is_compared_with_the_largest_stored_energy(void)
{
    Script script = run("scene planar\nbody m mass=1 inertia=1\nprismatic s ground m axis=[1, 0]\n"
                        "spring k1 s k=100 rest=0\ndamper d1 s d=1000\ninit s = 1\nsimulate 1",
                        (Changes){0});

    EXPECT(script.status == OK && result_report(script.result)->energy_drift < 1e-6);
    EXPECT_NEAR(result_report(script.result)->energy_scale, 50, 1e-6);
    script_close(&script);
    script = run("capacitor C a 0 1\nresistor R a 0 1\ninit C.v = 1\nsimulate 1", (Changes){0});
    EXPECT(script.status == OK && result_report(script.result)->energy_drift < 1e-6);
    EXPECT_NEAR(result_report(script.result)->energy_scale, 0.5, 1e-9);
    script_close(&script);
}

/* a driver in a forward run works: its power is in the balance */
static void drivers_work(void)
{
    static const char *const forms[] = {"", "form embedded\n"};

    for (int i = 0; i < 2; i++) {
        Text text = {0};
        Script script;

        text_addf(&text, "%s%s%s", PENDULUM,
                  "body p2 mass=1 inertia=1\narm b p [0, -1]\narm c p2 [0, 1]\nrevolute k b c\n"
                  "driver D1 h = 0.3*t^2\ninit k = 0.2, k' = 0\n",
                  forms[i]);
        text_add(&text, "simulate 3 rtol=1e-10");
        script = run(text.at, (Changes){0});
        EXPECT(script.status == OK);
        EXPECT_NEAR(value_at(&script, "h", 3), 2.7, 1e-12);
        EXPECT(result_report(script.result)->energy_scale > 1);
        EXPECT(result_report(script.result)->energy_drift < 1e-7);
        script_close(&script);
        text_free(&text);
    }
}

/* --- forward: messages --- */

static void wrong_options_are_refused(void)
{
    Script script = run(PENDULUM "init h = 1, h' = 0\nassemble", (Changes){0});
    static const struct {
        RunOptions options;
        Status status;
        const char *message, *hint;
    } wrong[] = {
        {{.duration = 1, .method = "dop85"},
         E_NAME,
         "there is no method 'dop85'",
         "did you mean 'dop853'? 'help methods' lists them"},
        {{.duration = 1, .method = "xyzzy"},
         E_NAME,
         "there is no method 'xyzzy'",
         "'help methods' lists them"},
        {{.duration = 0}, E_VALUE, "a run takes a duration above 0, in seconds", ""},
        {{.duration = 1, .every = -1},
         E_VALUE,
         "every, rtol, atol, step and maxstep can't be below 0",
         ""},
        {{.duration = 1, .rtol = 1e-15},
         E_VALUE,
         "rtol=1e-15 is finer than numbers are",
         "1e-12 is about the finest that makes sense"},
        {{.duration = 1, .rtol = 1},
         E_VALUE,
         "rtol=1 permits an error as large as the value itself",
         "1e-3 is about the coarsest that makes sense"},
        {{.duration = 1, .every = 1e-9},
         E_VALUE,
         "that makes 1e+09 rows",
         "take a larger step of output, every="},
    };
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model)};

    for (int i = 0; i < COUNT(wrong); i++) {
        Result *result = NULL;
        Diag diag = {0};

        EXPECT(run_simulate(script.system, &setting, &wrong[i].options, &result, NULL, &diag) ==
               wrong[i].status);
        EXPECT_TEXT(diag.message, wrong[i].message);
        EXPECT_TEXT(diag.hint, wrong[i].hint);
        EXPECT(result == NULL);
    }
    script_close(&script);
}

static void an_undefined_force_ends_the_run_and_keeps_it(void)
{
    Script script = run(PENDULUM "torque T p sqrt(1 - t)\ninit h = 1, h' = 0\n"
                                 "simulate 2 every=0.1",
                        (Changes){0});

    EXPECT(script.status == E_SOLVER);
    EXPECT(strstr(script.diag.message, "at t = 0.99") == script.diag.message ||
           strstr(script.diag.message, "at t = 1") == script.diag.message);
    EXPECT(script.result != NULL && result_rows(script.result) >= 10);
    script_close(&script);
}

static bool stop_later(void *context)
{
    return --*(int *)context < 0;
}

static void ctrl_c_keeps_the_rows(void)
{
    Script script = run(PENDULUM "init h = 1, h' = 0\nassemble", (Changes){0});
    int left = 50;
    CallMonitor watch = {.context = &left, .stop = stop_later};
    StartValue value = {"h", 0, 1, false};
    StartValues start = {1, &value};
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model),
                               .start = &start,
                               .watch = &watch};
    RunOptions options = {.duration = 1000, .every = 0.1};
    Result *result = NULL;
    Diag diag = {0};

    EXPECT(run_simulate(script.system, &setting, &options, &result, NULL, &diag) == E_STOPPED);
    EXPECT(result != NULL && result_rows(result) > 1);
    EXPECT(result != NULL && result_report(result)->stopped);
    result_free(result);
    script_close(&script);
}

static void a_circuit_runs_without_mechanics(void)
{
    Script script = run("resistor R1 a b 10\ncapacitor C1 b 0 1e-3\nvsource V1 a 0 if(t < 0.02, 5, "
                        "0)\ninit C1.v = 1\nsimulate 0.05 rtol=1e-10",
                        (Changes){0});
    double at_switch = 5 - 4 * exp(-2);

    EXPECT(script.status == OK);
    EXPECT_TEXT(script.diag.message, "");
    EXPECT_NEAR(value_at(&script, "C1.v", 0.02), at_switch, 1e-10);
    EXPECT_NEAR(value_at(&script, "C1.v", 0.05), at_switch * exp(-3), 1e-10);
    EXPECT(result_report(script.result)->energy_drift < 1e-10);
    script_close(&script);
}

static void what_has_no_states_runs_too(void)
{
    Script script = run("resistor R1 a b 10\nresistor R2 b 0 10\nvsource V1 a 0 5*t\n"
                        "simulate 1 every=0.1",
                        (Changes){0});

    EXPECT(script.status == OK);
    EXPECT_TEXT(script.diag.message, "");
    EXPECT(script.result != NULL && result_rows(script.result) == 11);
    EXPECT_NEAR(value_at(&script, "R2.v", 0.5), 1.25, 1e-14);
    script_close(&script);
}

/* an oscillator between two one-sided springs: the force has kinks at +-1 that the steps meet */
static void a_one_sided_spring_is_met_at_its_ends(void)
{
    Script script = run("scene planar\nbody m mass=1 inertia=1\nprismatic s ground m axis=x\n"
                        "actuator a s force=-100*(max(s - 1, 0) + min(s + 1, 0))\n"
                        "init s = 0, s' = 3\nsimulate 100 every=1 rtol=1e-10",
                        (Changes){0});
    /* free flight of 2/3 s across, half a period of omega = 10 in each spring */
    double period = 2 * (2 / 3.0 + 3.14159265358979323846 / 10);
    double phase = fmod(100, period);

    EXPECT(script.status == OK);
    /* 100 s end in the last free flight of a period */
    EXPECT(phase > period - 1 / 3.0);
    EXPECT_NEAR(value_at(&script, "s", 100), 3 * (phase - period), 1e-8);
    script_close(&script);
}

/* an inductance of no weight: the electrical time is 1e-7 of the mechanical one */
#define STIFF                                                                                      \
    PENDULUM "motor M h e 0 R=1 L=1e-6 Kt=2 Kv=2\nvsource V e 0 if(t < 1, 5, 0)\n"                 \
             "init h = 0.5, h' = 0, M.i = 0\nsimulate 2 rtol=1e-8"

static void a_stiff_model_is_handed_over(void)
{
    Script script = run(STIFF, (Changes){0}), bdf = run(STIFF, (Changes){.method = "bdf"});

    EXPECT(script.status == OK && bdf.status == OK);
    EXPECT_TEXT(result_report(script.result)->method, "radau");
    EXPECT(strstr(script_remarks(&script), "stiff from t = ") != NULL);
    EXPECT(result_report(script.result)->steps < 5000);
    EXPECT_NEAR(value_at(&script, "h", 2), value_at(&bdf, "h", 2), 1e-5);
    EXPECT_NEAR(value_at(&script, "M.i", 2), value_at(&bdf, "M.i", 2), 1e-4);
    EXPECT(result_report(script.result)->energy_drift < 1e-4);
    script_close(&script);
    script_close(&bdf);
}

/* a pulse late in the run, after nothing: v = integral of the pulse */
static void no_method_steps_over_a_pulse(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "adams", "ida"};

    for (int i = 0; i < COUNT(methods); i++) {
        Script script = run("isource I 0 a exp(-((t - 5)/0.2)^2)\ncapacitor C a 0 1\n"
                            "resistor R a 0 1e6\ninit C.v = 0\nsimulate 10 rtol=1e-6 atol=1e-6",
                            (Changes){.method = methods[i]});

        EXPECT(script.status == OK);
        EXPECT_NEAR(value_at(&script, "C.v", 10), 0.2 * sqrt(3.14159265358979323846), 1e-4);
        script_close(&script);
    }
}

/* a line of equal sections behind a source, and a run of it */
static Script run_line(const char *section, int count, const char *end, Changes changes)
{
    Text text = {0};
    Script script;

    text_add(&text, "vsource E a0 0 exp(-((t - 1.2 us)/240 ns)^2)\nresistor R a0 b0 30\n");
    for (int i = 0; i < count; i++)
        text_addf(&text, section, i, i, i + 1, i, i + 1);
    text_add(&text, end);
    script = run(text.at, changes);
    text_free(&text);
    return script;
}

#define COILS     "inductor L%d b%d b%d 1 uH\ncapacitor C%d b%d 0 1 nF\n"
#define RESISTORS "resistor R%d b%d b%d 1\ncapacitor C%d b%d 0 1 nF\n"

/* waves of high frequency cut the explicit steps, and backward differentiation would be worse */
static void a_long_line_of_coils_stays_explicit(void)
{
    const char *end = "resistor Z b100 0 50\nsimulate 6 us rtol=1e-4 atol=1e-4";
    Script script = run_line(COILS, 100, end, (Changes){0});
    Script radau = run_line(COILS, 100, end, (Changes){.method = "radau", .rtol = 1e-7});

    EXPECT(script.status == OK && radau.status == OK);
    EXPECT_TEXT(result_report(script.result)->method, "dop853");
    EXPECT_TEXT(script_remarks(&script), "");
    EXPECT_NEAR(value_at(&script, "b100.v", 4.4e-6), value_at(&radau, "b100.v", 4.4e-6), 1e-2);
    EXPECT_NEAR(value_at(&script, "b50.v", 6e-6), value_at(&radau, "b50.v", 6e-6), 1e-2);
    script_close(&script);
    script_close(&radau);
}

static void a_long_line_of_resistors_is_handed_over(void)
{
    const char *end = "resistor Z b100 0 50\nsimulate 6 us rtol=1e-6";
    Script script = run_line(RESISTORS, 100, end, (Changes){0});

    EXPECT(script.status == OK);
    EXPECT(strstr(script_remarks(&script), "stiff from t = ") != NULL);
    EXPECT_TEXT(result_report(script.result)->method, "ida");
    script_close(&script);
}

static void every_method_has_a_line_of_help(void)
{
    const char *brief = NULL;

    EXPECT_TEXT(run_method(0, &brief), "auto");
    for (int i = 0; run_method(i, &brief) != NULL; i++)
        EXPECT(brief != NULL && strlen(brief) > 20);
}

int main(void)
{
    RUN(a_guess_chooses_the_elbow);
    RUN(any_variable_may_be_given);
    RUN(chords_may_be_given_in_absolute_coordinates);
    RUN(network_states_may_be_given);
    RUN(contradicting_values_are_named);
    RUN(a_loop_that_cant_close_is_named);
    RUN(contradicting_speeds_are_named);
    RUN(contradicting_currents_are_named);
    RUN(forces_are_no_initial_values);
    RUN(a_start_without_accelerations_is_refused);
    RUN(a_repeated_joint_is_redundant);
    RUN(a_singular_start_is_told);
    RUN(a_driven_crank_moves_its_slider);
    RUN(the_effort_of_a_driver_is_what_the_motion_takes);
    RUN(another_coordinate_supplies_the_same_power);
    RUN(missing_drivers_are_counted);
    RUN(a_supplied_driver_is_not_for_forward_runs);
    RUN(an_effort_that_cant_work_is_named);
    RUN(a_state_beside_the_motion_hides_a_source);
    RUN(a_stop_in_the_way_of_a_driver_ends_the_run);
    RUN(the_embedded_form_takes_the_users_coordinates);
    RUN(an_unknown_independent_coordinate_is_named);
    RUN(a_resumed_run_is_one_run);
    RUN(only_forward_runs_are_resumed);
    RUN(values_between_rows_are_interpolated_and_projected);
    RUN(an_instant_outside_the_run_is_refused);
    RUN(a_second_run_estimates_the_error);
    RUN(an_unresolved_run_is_told);
    RUN(the_report_balances_energy);
    RUN(drift_is_compared_with_the_largest_stored_energy);
    RUN(drivers_work);
    RUN(wrong_options_are_refused);
    RUN(an_undefined_force_ends_the_run_and_keeps_it);
    RUN(ctrl_c_keeps_the_rows);
    RUN(a_circuit_runs_without_mechanics);
    RUN(what_has_no_states_runs_too);
    RUN(a_one_sided_spring_is_met_at_its_ends);
    RUN(a_stiff_model_is_handed_over);
    RUN(no_method_steps_over_a_pulse);
    RUN(a_long_line_of_coils_stays_explicit);
    RUN(a_long_line_of_resistors_is_handed_over);
    RUN(every_method_has_a_line_of_help);
    return test_end();
}

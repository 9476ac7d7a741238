/* test_session_run.c: runs, values, tables, expectations */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

static void a_run_keeps_energy_and_meets_the_start(void)
{
    Kit kit = kit_new();
    double h, u;

    EXPECT_DONE(&kit, PENDULUM "simulate 2 every=0.01 rtol=1e-10 atol=1e-10");
    EXPECT_HOLDS(kit.text, "0 ... 2 s, 201 rows");
    EXPECT(ct_run_count(kit.session) == 1);
    EXPECT_NEAR(kit_value(&kit, "h at 0"), M_PI / 3, 1e-14);
    EXPECT_NEAR(kit_value(&kit, "energy.total"), -9.81 / 2, 1e-8);
    h = kit_value(&kit, "h at 1.7");
    u = kit_value(&kit, "h' at 1.7");
    EXPECT_NEAR(u * u / 2 - 9.81 * cos(h), -9.81 / 2, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "h'' at 1.7"), -9.81 * sin(h), 1e-9);
    kit_free(&kit);
}

/* period of a pendulum by the arithmetic-geometric mean (Gauss) */
static void the_period_is_that_of_the_closed_form(void)
{
    Kit kit = kit_new();
    double a = 1, b = cos(M_PI / 6), period;
    char line[120];

    for (int i = 0; i < 6; i++) {
        const double mean = (a + b) / 2;

        b = sqrt(a * b);
        a = mean;
    }
    period = 2 * M_PI / sqrt(9.81) / a;
    (void)snprintf(line, sizeof line, "simulate %.17g rtol=1e-11 atol=1e-11", period);
    EXPECT_DONE(&kit, PENDULUM);
    EXPECT_DONE(&kit, line);
    EXPECT_NEAR(kit_value(&kit, "h"), M_PI / 3, 1e-8);
    kit_free(&kit);
}

static void a_value_is_of_the_end_of_the_run_until_something_changes(void)
{
    Kit kit = kit_new();
    double end;

    EXPECT_DONE(&kit, PENDULUM);
    EXPECT_NEAR(kit_value(&kit, "h"), M_PI / 3, 1e-14);
    EXPECT_DONE(&kit, "simulate 0.5 every=0.1");
    end = kit_value(&kit, "h");
    EXPECT_NEAR(end, kit_value(&kit, "h at 0.5"), 0);
    EXPECT(fabs(end - M_PI / 3) > 0.1);
    /* an output looks at the run, it changes nothing */
    EXPECT_DONE(&kit, "output twice = 2*h");
    EXPECT_NEAR(kit_value(&kit, "twice"), 2 * end, 1e-15);
    EXPECT_DONE(&kit, "init h = 0.25");
    EXPECT_NEAR(kit_value(&kit, "h"), 0.25, 1e-15);
    EXPECT_NEAR(kit_value(&kit, "h at 0.5"), end, 0);
    EXPECT_NEAR(kit_value(&kit, "run1.h"), end, 0);
    EXPECT_DONE(&kit, "assemble");
    EXPECT_HOLDS(kit.text, "h ");
    EXPECT_HOLDS(kit.text, "0.25 rad");
    kit_free(&kit);
}

static void an_instant_within_rounding_of_a_row_is_that_row(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.1");
    EXPECT(kit_value(&kit, "h at 0.3") == kit_value(&kit, "h at 0.1 + 0.2"));
    EXPECT(kit_value(&kit, "h at 0.3") != kit_value(&kit, "h at 0.3001"));
    EXPECT(isnan(kit_value(&kit, "h at 1.5")));
    EXPECT_HOLDS(kit.error.message, "outside the run");
    kit_free(&kit);
}

static void runs_keep_the_parameters_they_were_made_with(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 0.5");
    EXPECT_NEAR(kit_value(&kit, "sqrt(m.x^2 + m.y^2)"), 1, 1e-14);
    EXPECT_DONE(&kit, "L = 2");
    EXPECT_NEAR(kit_value(&kit, "sqrt(m.x^2 + m.y^2)"), 2, 1e-14);
    EXPECT_NEAR(kit_value(&kit, "sqrt(m.x^2 + m.y^2) at 0.5"), 1, 1e-14);
    EXPECT_NEAR(kit_value(&kit, "run1.m.x^2 + run1.m.y^2"), 1, 1e-14);
    EXPECT_DONE(&kit, "simulate 0.5");
    EXPECT_NEAR(kit_value(&kit, "run2.m.x^2 + run2.m.y^2"), 4, 1e-13);
    EXPECT_NEAR(kit_value(&kit, "run1.m.x^2 + run1.m.y^2"), 1, 1e-14);
    kit_free(&kit);
}

static void runs_survive_an_edit_of_the_model(void)
{
    Kit kit = kit_new();
    double end;

    EXPECT_DONE(&kit, PENDULUM "simulate 0.5");
    end = kit_value(&kit, "h");
    EXPECT_DONE(&kit, "tree m\nsimulate 0.5\nbody m2 mass=1\ntorque T m2 1\nundo\nundo");
    EXPECT_NEAR(kit_value(&kit, "run1.h"), end, 0);
    EXPECT_NEAR(kit_value(&kit, "run2.h"), end, 1e-7);
    EXPECT_NEAR(kit_value(&kit, "run2.h - run1.h"), 0, 1e-7);
    kit_free(&kit);
}

static void functions_of_runs_see_every_row(void)
{
    Kit kit = kit_new();

    /* theta = 2 pi t over one turn: its sine has mean 0 and rms 1/sqrt(2) over even rows */
    EXPECT_DONE(&kit, "scene planar\nbody m mass=1\narm p m [-1, 0]\nrevolute h ground p\n"
                      "driver D h = 2*pi*t\nkinematics 1 every=0.001");
    EXPECT_NEAR(kit_value(&kit, "max(h)"), 2 * M_PI, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "min(h)"), 0, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "mean(sin(h))"), 0, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "rms(sin(h))"), sqrt(0.5), 1e-9);
    EXPECT_NEAR(kit_value(&kit, "max(m.x) - min(m.x)"), 2, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "max(2, mean(h)/pi)"), 2, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "if(max(h) > 6, 1, 0) + abs(-min(h))"), 1, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "h at max(h)/(4*pi)"), M_PI, 1e-9);
    EXPECT_DONE(&kit, "kinematics 0.5 every=0.001");
    EXPECT_NEAR(kit_value(&kit, "max(run1.h) - max(h)"), M_PI, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "max(run1.h - h)"), 0, 1e-12);
    kit_free(&kit);
}

static void sizes_and_entries_are_values(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES CRANK_START);
    EXPECT_NEAR(kit_value(&kit, "model.n"), 2, 0);
    EXPECT_NEAR(kit_value(&kit, "model.m"), 1, 0);
    EXPECT_NEAR(kit_value(&kit, "model.dof"), 1, 0);
    EXPECT_NEAR(kit_value(&kit, "model.n - model.m - model.dof"), 0, 0);
    /* m1 L4^2 + I1 + (m2 + m3)(L4 + L5)^2, by hand */
    EXPECT_NEAR(kit_value(&kit, "mass(1,1)"), 2 * 0.0064 + 0.01 + 4.2 * 0.04, 1e-14);
    EXPECT_NEAR(kit_value(&kit, "mass(1,2) - mass(2,1)"), 0, 0);
    EXPECT_NEAR(kit_value(&kit, "constraint.error"), 0, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "h8 [deg]"), 60, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "2 mm"), 0.002, 1e-18);
    EXPECT_NEAR(kit_value(&kit, "energy.kinetic + energy.potential - energy.total"), 0, 1e-12);
    /* the multiplier is the guide's force with reversed sign (seed case 1) */
    EXPECT_NEAR(kit_value(&kit, "lambda(1) + s11.fy"), 0, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "forces(1)*0 + 3"), 3, 1e-12);
    kit_free(&kit);
}

static void a_value_that_is_none_is_refused(void)
{
    /* clang-format off */
    static const struct { const char *expression, *message; } wrong[] = {
        {"h9",             "h9"},
        {"run1.h",         "there is no run1"},
        {"max(h)",         "there is none yet"},
        {"model.size",     "there is no 'model.size'"},
        {"count.mass",     "needs .add, .mul or .fun"},
        {"count.mas.add",  "no block of equations"},
        {"lambda(1)",      "lambda(1)"},
        {"h at h",         "an instant is a number"},
        {"pulse(model.n, 0, 1)",                 "pulse does not take 3 arguments"},
        {"pulse(model.n, 0, 1, 0, -1, 0, 1, 2)", "times of a pulse aren't negative"},
        {"atan2(model.n)",                       "atan2 takes 2 arguments, got 1"},
        {"max(\"a\", model.n)",                  "not a text"},
        {"gape(model.n)",                        "unknown function 'gape'"},
        {"(model.n)'",     "can't be made of values"},
    };
    /* clang-format on */
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        EXPECT(isnan(kit_value(&kit, wrong[i].expression)));
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT(kit.error.column > 0);
    }
    EXPECT_DONE(&kit, "simulate 0.1");
    EXPECT(isnan(kit_value(&kit, "run7.h")));
    EXPECT_HOLDS(kit.error.hint, "run1");
    EXPECT_NEAR(kit_value(&kit, "h at 0"), M_PI / 3, 1e-14);
    kit_free(&kit);
}

/* three parallel cranks on one rod, the third of which repeats what the others hold */
static void freedoms_are_counted_alike_wherever_asked_for(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "scene planar\nbody rod mass=1 inertia=1\narm l rod [-1, 0]\narm r rod [1, 0]\n"
                "arm gl ground [-1, 0]\narm gr ground [1, 0]\n"
                "body c1 mass=1 inertia=1\nbody c2 mass=1 inertia=1\nbody c3 mass=1 inertia=1\n"
                "arm e1 c1 [0, 1]\narm e2 c2 [0, 1]\narm e3 c3 [0, 1]\n"
                "revolute h1 gl c1\nrevolute h2 ground c2\nrevolute h3 gr c3\n"
                "revolute k1 e1 l\nrevolute k2 e2 rod\nrevolute k3 e3 r\n"
                "tree h1 h2 h3 k1\noutput free = 2*model.dof\n");
    EXPECT_NEAR(kit_value(&kit, "model.n - model.m"), 0, 0);
    EXPECT_NEAR(kit_value(&kit, "model.dof"), 1, 0);
    EXPECT_DONE(&kit, "check\n");
    EXPECT_HOLDS(kit.text, "4 coordinates, 4 constraints: 1 degree of freedom\n");
    EXPECT_DONE(&kit, "simulate 0.1 every=0.1\nexpect model.dof == 1\nexpect free == 2\n");
    EXPECT_FAILS(&kit, "show model.dof", "counts what the constraints leave free");
    /* where nothing can be assembled the difference is told, and that it is one */
    EXPECT_DONE(&kit, "arm far ground [9, 0]\nrevolute k4 far r\n");
    EXPECT_NEAR(kit_value(&kit, "model.dof"), -2, 0);
    EXPECT_HOLDS(ct_remarks(kit.session), "model.dof is n - m = -2");
    kit_free(&kit);
}

static void any_function_is_taken_of_what_the_session_knows(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "k = 3\nlaw(x, y) = k*x + y\n");
    EXPECT_NEAR(kit_value(&kit, "min(model.n, 4, model.dof, 0.5)"), 0.5, 0);
    EXPECT_NEAR(kit_value(&kit, "max(model.n, 4, model.dof, 0.5)"), 4, 0);
    EXPECT_NEAR(kit_value(&kit, "law(model.n, 2)"), 5, 0);
    EXPECT_NEAR(kit_value(&kit, "law(2, law(model.n, model.n))"), 10, 0);
    EXPECT_NEAR(kit_value(&kit, "pulse(model.n + 2.5, 0, 8, 1, 1, 1, 1, 6)"), 4, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "pwl(model.n, 0, 3, 2, 5)"), 4, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "if(model.n == 1, law(model.n, 0), 7)"), 3, 0);
    EXPECT_DONE(&kit, "simulate 0.5 every=0.1\nsimulate 2 every=0.1");
    EXPECT_NEAR(kit_value(&kit, "law(t, max(t)) at 0.5"), 3.5, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "max(run1.h, run2.h, h) - max(run1.h, h)"), 0, 0);
    kit_free(&kit);
}

static void options_that_make_no_sense_are_refused(void)
{
    /* clang-format off */
    static const struct { const char *line; int column; const char *message; } wrong[] = {
        {"simulate 0",              10, "must be positive"},
        {"simulate -2",             10, "must be positive"},
        {"simulate 1 every=0",      18, "every must be positive"},
        {"simulate 1 rtol=-1e-6",   17, "rtol must be positive"},
        {"simulate 1 every=h",      18, "made of parameters"},
        {"simulate 1 method=rk45",  19, "there is no method 'rk45'"},
        {"simulate 1 check=perhaps", 18, "on or off"},
        {"resume 1",                 1, "no run to go on with"},
        {"kinematics 1",             1, ""},
    };
    /* clang-format on */
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const ct_status status = kit_do(&kit, wrong[i].line);

        if (status != CT_FAILED || kit.error.column != wrong[i].column ||
            strstr(kit.error.message, wrong[i].message) == NULL) {
            test_faults++;
            printf("'%s': status %d, column %d: %s\n", wrong[i].line, status, kit.error.column,
                   kit.error.message);
        }
        EXPECT(ct_run_count(kit.session) == 0);
    }
    EXPECT(kit_do(&kit, "simulate 1 method=rk45") == CT_FAILED);
    EXPECT_HOLDS(kit.error.hint, "rk4");
    EXPECT_DONE(&kit, "simulate 0.1");
    kit_free(&kit);
}

static void resume_goes_on_with_what_was_said_before(void)
{
    Kit kit = kit_new();
    double whole;

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.01 rtol=1e-10 atol=1e-10");
    whole = kit_value(&kit, "h");
    EXPECT_DONE(&kit, "simulate 0.4 every=0.01 rtol=1e-10 atol=1e-10\nresume 0.6");
    EXPECT_HOLDS(kit.text, "0 ... 1 s, 101 rows");
    EXPECT_HOLDS(kit.text, "rtol 1e-10");
    EXPECT_NEAR(kit_value(&kit, "h"), whole, 1e-8);
    EXPECT(ct_run_count(kit.session) == 3);
    kit_free(&kit);
}

/* --- tables --- */

static void a_table_has_a_row_an_instant_and_names_as_written(void)
{
    Kit kit = kit_new();
    ct_statement *statement = NULL;
    const ct_expression *items[4];
    const char *line = "table h [deg] (h' + 1) mass(1,1) run1.h";
    double *values = NULL;
    char **names = NULL;
    int rows, columns;

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.1");
    EXPECT(ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit.error) == CT_OK);
    for (int i = 0; i < 4; i++)
        items[i] = ct_operand(statement, i);
    EXPECT(ct_table(kit.session, items, 4, 0, &values, &rows, &columns, &names, &kit.error) ==
           CT_OK);
    EXPECT(rows == 11 && columns == 5);
    EXPECT_TEXT(names[0], "t");
    EXPECT_TEXT(names[1], "h [deg]");
    EXPECT_TEXT(names[2], "(h' + 1)");
    EXPECT_TEXT(names[3], "mass(1,1)");
    EXPECT(names[5] == NULL);
    EXPECT_NEAR(values[1], 60, 1e-12);
    EXPECT_NEAR(values[2], 1, 1e-12);
    EXPECT_NEAR(values[3], 1, 1e-14);
    EXPECT_NEAR(values[50], 1, 1e-15);
    EXPECT_NEAR(values[51], kit_value(&kit, "h [deg] at 1"), 1e-12);
    EXPECT_NEAR(values[54], kit_value(&kit, "h"), 0);
    ct_free(values);
    ct_words_free(names);

    EXPECT(ct_table(kit.session, items, 1, 0.25, &values, &rows, &columns, &names, &kit.error) ==
           CT_OK);
    EXPECT(rows == 5 && columns == 2);
    EXPECT_NEAR(values[2], 0.25, 1e-15);
    EXPECT_NEAR(values[3], kit_value(&kit, "h [deg] at 0.25"), 1e-9);
    ct_free(values);
    ct_words_free(names);
    ct_statement_free(statement);
    kit_free(&kit);
}

static void a_table_without_items_holds_all_coordinates_and_speeds(void)
{
    Kit kit = kit_new();
    double *values = NULL;
    char **names = NULL;
    int rows, columns;

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES CRANK_START);
    EXPECT(ct_table(kit.session, NULL, 0, 0, &values, &rows, &columns, &names, &kit.error) ==
           CT_OK);
    EXPECT(rows == 1 && columns == 5);
    EXPECT_TEXT(names[2], "h10");
    EXPECT_TEXT(names[3], "h8'");
    EXPECT_NEAR(values[3], 12, 1e-12);
    ct_free(values);
    ct_words_free(names);
    kit_free(&kit);
}

static void csv_has_a_header_and_reads_back_to_the_last_bit(void)
{
    Kit kit = kit_new();
    ct_statement *statement = NULL;
    char *text = NULL;
    const char *line;
    double t, h;

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.1\nexport csv h h' mass(1,1)");
    EXPECT(kit.text != NULL && strncmp(kit.text, "t,h,h',\"mass(1,1)\"\n", 19) == 0);
    line = kit.text;
    for (int i = 0; i < 4 && line != NULL; i++)
        line = strchr(line, '\n') + 1;
    EXPECT(sscanf(line, "%lf,%lf", &t, &h) == 2);
    EXPECT(t == kit_value(&kit, "t at 0.3") && h == kit_value(&kit, "h at 0.3"));

    EXPECT(ct_parse(&(ct_cursor){.text = "export csv h", .line = 1}, false, &statement,
                    &kit.error) == CT_OK);
    EXPECT(ct_export(kit.session, statement, false, &text, &kit.error) == CT_OK);
    EXPECT(text != NULL && strncmp(text, "0,1.047", 7) == 0);
    ct_free(text);
    ct_statement_free(statement);
    /* from the assembled start one row */
    EXPECT_DONE(&kit, "init h = 0.5\nexport csv start");
    EXPECT_TEXT(kit.text, "t,h,h'\n0,0.5,0\n");
    kit_free(&kit);
}

static void items_of_several_runs_stand_on_one_grid(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.1\nsimulate 0.5 every=0.05\n"
                               "export csv run1.h run1.h'");
    EXPECT_HOLDS(kit.text, "\n1,");
    EXPECT_DONE(&kit, "export csv h run1.h");
    EXPECT(kit.text != NULL && strstr(kit.text, "\n1,") == NULL);
    EXPECT(kit_do(&kit, "simulate 2\nexport csv h run1.h") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "run1 has no value at t = 1.004 s");
    kit_free(&kit);
}

/* --- expectations --- */

static void an_expectation_holds_or_says_by_how_much_not(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 1 every=0.1");
    EXPECT_DONE(&kit, "expect h ~ 60*pi/180 within 1e-12 at 0\nexpect max(h) < 1.1\n"
                      "expect model.n == 1 && model.m == 0");
    EXPECT(kit_do(&kit, "expect h ~ 1 within 1e-3 at 0") == CT_UNMET);
    EXPECT(kit.error.status == CT_UNMET && kit.error.column == 8);
    EXPECT_HOLDS(kit.error.message, "h is 1.047197551196");
    EXPECT_HOLDS(kit.error.message, "at t = 0");
    EXPECT_HOLDS(kit.error.message, "expected 1 rad within 0.001 rad");
    EXPECT_HOLDS(kit.error.message, "off by 0.0472 rad");
    EXPECT(strstr(kit.error.hint, "turn") == NULL);
    EXPECT(kit_do(&kit, "expect h ~ 60 deg + 4*pi within 1e-9 at 0") == CT_UNMET);
    EXPECT_HOLDS(kit.error.hint, "that is 2 whole turns");
    EXPECT(kit_do(&kit, "expect h' ~ -2*pi within 1e-9 at 0") == CT_UNMET);
    EXPECT(strstr(kit.error.hint, "turn") == NULL);
    EXPECT(kit_do(&kit, "expect model.n == 2") == CT_UNMET);
    EXPECT_HOLDS(kit.error.message, "left is 1, right is 2");
    EXPECT(kit_do(&kit, "expect 0*h") == CT_UNMET);
    EXPECT_HOLDS(kit.error.message, "does not hold");
    EXPECT(kit_do(&kit, "expect nobody > 2") == CT_FAILED);
    /* what is no number is near nothing */
    EXPECT(kit_do(&kit, "expect sqrt(h - 100) ~ 0 within 1e9") != CT_OK);
    kit_free(&kit);
}

/* --- stopping --- */

typedef struct Patience {
    int left;
} Patience;

static bool lose_patience(void *context)
{
    Patience *patience = context;

    return patience->left-- <= 0;
}

static void a_stopped_run_keeps_what_it_has(void)
{
    Patience patience = {20};
    const ct_hooks hooks = {.context = &patience, .stop = lose_patience, .columns = 80};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "assemble");
    ct_session_hooks(kit.session, &hooks);
    EXPECT(kit_do(&kit, "simulate 1e5 every=1") == CT_STOPPED);
    ct_session_hooks(kit.session, NULL);
    if (ct_run_count(kit.session) == 1)
        EXPECT(!isnan(kit_value(&kit, "h")));
    EXPECT_DONE(&kit, "simulate 0.1\nresume 0.1\nshow constraints");
    kit_free(&kit);
}

static void a_stopped_derivation_leaves_the_session_whole(void)
{
    Kit kit = kit_new();

    for (int calls = 0; calls < 30; calls++) {
        Patience patience = {calls};
        const ct_hooks hooks = {.context = &patience, .stop = lose_patience, .columns = 80};

        EXPECT_DONE(&kit, "clear\n" SLIDER_CRANK ONE_TREE);
        EXPECT_DONE(&kit, "mass = 1");
        ct_session_hooks(kit.session, &hooks);
        (void)kit_do(&kit, "tree h8 h9 h10\nshow equations\ncount\ncheck\nshow mass");
        ct_session_hooks(kit.session, NULL);
        EXPECT_DONE(&kit, "tree h8 h10 s11\nshow equations");
    }
    kit_free(&kit);
}

/* M of a long chain is written out when somebody asks: that asks for a stop at each column, and
 * what was stopped is formed anew */
static void what_is_formed_later_can_be_stopped_too(void)
{
    enum { BODIES = 40, PLENTY = 1 << 30 };
    Patience patience = {PLENTY};
    const ct_hooks hooks = {.context = &patience, .stop = lose_patience, .columns = 80};
    Kit kit = kit_new();
    char chain[BODIES * 120] = "";
    char *whole;

    for (int i = 0; i < BODIES; i++) {
        char tail[8] = "ground";

        if (i > 0)
            (void)snprintf(tail, sizeof tail, "b%d", i - 1);
        (void)snprintf(chain + strlen(chain), sizeof chain - strlen(chain),
                       "body b%d mass=1 inertia=[1, 2, 3]; arm a%d b%d [0.1, 0.2, 0.3]\n"
                       "revolute h%d %s a%d axis=%c\n",
                       i, i, i, i, tail, i, "xyz"[i % 3]);
    }
    EXPECT_DONE(&kit, chain);
    EXPECT_DONE(&kit, "show coordinates");
    ct_session_hooks(kit.session, &hooks);
    for (int calls = 0; calls < BODIES; calls += 13) {
        patience.left = calls;
        EXPECT(kit_do(&kit, "count mass") == CT_STOPPED);
    }
    patience.left = PLENTY;
    EXPECT_DONE(&kit, "count mass");
    EXPECT(PLENTY - patience.left >= BODIES);
    whole = mem_text(kit.text, strlen(kit.text));
    ct_session_hooks(kit.session, NULL);
    EXPECT_DONE(&kit, "set b0.mass = 2; set b0.mass = 1; count mass");
    EXPECT_TEXT(kit.text, whole);
    mem_free(whole);
    kit_free(&kit);
}

/* angular speeds of a joint with Euler parameters, in the axes of its head: those of the arm there
 * while the tail rests; the same whatever trees they are given in */
/* a chain of hinged bodies in their own coordinates, turned the wrong way: work for assembly */
static void write_chain(Text *text, int n)
{
    for (int i = 0; i < n; i++) {
        text_addf(text, "body b%d mass=1 inertia=[1, 2, 3]; arm p%d b%d [0, 0, 1]\n", i, i, i);
        text_addf(text, "arm q%d b%d [0, 0, -1]\n", i, i);
        if (i == 0)
            text_add(text, "revolute h0 ground p0 axis=x\n");
        else
            text_addf(text, "revolute h%d q%d p%d axis=x\n", i, i - 1, i);
    }
    text_add(text, "tree absolute; init b3.y = 2, b3.q1 = 0.3\n");
}

typedef struct Asked {
    int left; /* how often it is answered with no */
} Asked;

static bool note_question(void *context)
{
    Asked *asked = context;

    return asked->left-- <= 0;
}

static void a_start_can_be_stopped_anywhere(void)
{
    Asked asked = {.left = 1000000000};
    const ct_hooks hooks = {.context = &asked, .stop = note_question, .columns = 80};
    Kit kit = {.session = ct_session_new(&hooks)};
    Text text = {0};
    int questions, stops = 0;

    write_chain(&text, 20);
    EXPECT_DONE(&kit, text.at);
    EXPECT_DONE(&kit, "assemble");
    EXPECT_DONE(&kit, "init b3.y = 2.01");
    asked.left = 1000000000;
    EXPECT_DONE(&kit, "assemble");
    questions = 1000000000 - asked.left;

    for (int left = 1; left < questions / 2; left += 1 + questions / 50) {
        /* what was computed is kept: another value asks for it anew */
        (void)snprintf(text.at, text.length, "init b3.y = %.17g", 2 + 1e-3 * left);
        asked.left = 1000000000;
        EXPECT_DONE(&kit, text.at);
        asked.left = left;
        if (kit_do(&kit, "assemble") == CT_OK) {
            /* the question came when everything was found */
            asked.left = 1000000000;
            EXPECT(kit_value(&kit, "constraint.error") < 1e-9);
            continue;
        }
        EXPECT(kit.error.status == CT_STOPPED);
        EXPECT_HOLDS(kit.error.message, "stopped");
        stops++;
    }
    EXPECT(stops > 5);
    text_free(&text);
    kit_free(&kit);
}

/* Each verb that may take long, stopped at the first question, at the last and at some between: the
 * model is as it was, and the same verb then finds what it finds in a session that never stopped.
 */
static void what_is_stopped_anywhere_leaves_nothing_behind(void)
{
    static const char *const verbs[] = {
        "tree translation b0 b1\n",
        "show equations",
        "show derivation",
        "show mass",
        "count",
        "check",
        "assemble",
        "equilibrium",
        "linearize",
        "modes",
        "inverse 0.1",
        "draw mechanism",
        "export c > \"-\"",
        "set h0.axis = [1, 0, 0]",
        "tree best",
    };
    enum { PLENTY = 1 << 30 };
    Text text = {0};
    int stops = 0;

    write_chain(&text, 6);
    for (int v = 0; v < COUNT(verbs); v++) {
        Patience patience = {PLENTY};
        const ct_hooks hooks = {.context = &patience, .stop = lose_patience, .columns = 80};
        Kit whole = {.session = ct_session_new(&hooks)}, kit = {.session = ct_session_new(&hooks)};
        char *before, *after, *answer;
        ct_status status;
        int questions;

        EXPECT_DONE(&whole, text.at);
        patience.left = PLENTY;
        status = kit_do(&whole, verbs[v]);
        questions = PLENTY - patience.left;
        answer = mem_text(whole.text != NULL ? whole.text : "",
                          strlen(whole.text != NULL ? whole.text : ""));
        after = ct_save(whole.session);

        patience.left = PLENTY;
        EXPECT_DONE(&kit, text.at);
        before = ct_save(kit.session);
        for (int n = 0; n < questions; n += 1 + questions / 12) {
            char *saved;

            patience.left = n;
            (void)kit_do(&kit, verbs[v]);
            stops += kit.error.status == CT_STOPPED;
            patience.left = PLENTY;
            saved = ct_save(kit.session);
            EXPECT(strcmp(saved, before) == 0 || strcmp(saved, after) == 0);
            if (strcmp(saved, before) != 0) /* the next try begins there, too */
                EXPECT_DONE(&kit, "undo");
            ct_free(saved);
        }
        EXPECT(kit_do(&kit, verbs[v]) == status);
        EXPECT_TEXT(kit.text != NULL ? kit.text : "", answer);
        ct_free(before);
        ct_free(after);
        mem_free(answer);
        kit_free(&kit);
        kit_free(&whole);
    }
    EXPECT(stops > 40);
    text_free(&text);
}

/* s'' = 6 s^2 by s = 1/(1 - t)^2: no method gets past t = 1, and none tries without end */
static void a_solution_that_ends_ends_the_run(void)
{
    static const char *const methods[] = {"dop853", "adams", "bdf",       "ida",
                                          "radau",  "rk4",   "symplectic"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, 0]\nbody m1 mass=1\n"
                      "prismatic s ground m1 axis=x\nactuator F s force=6*s^2\n"
                      "init s = 1, s' = 2\n");
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        char line[60];

        (void)snprintf(line, sizeof line, "simulate 3 method=%s", methods[i]);
        EXPECT_FAILS(&kit, line, "grows without bound there");
    }
    kit_free(&kit);
}

/* it never is ahead of the clock; a busy machine may leave it behind, which is told then */
static void a_run_keeps_up_with_the_clock(void)
{
    Kit kit = kit_new();
    ct_figures figures = {0};

    EXPECT_DONE(&kit, "capacitor C a 0 1\nresistor R a 0 1\ninit C.v = 1\n"
                      "simulate 0.3 every=0.1 realtime=on step=0.01");
    EXPECT(ct_run_figures(kit.session, 0, &figures) && figures.wall >= 0.299);
    EXPECT_DONE(&kit, "expect C.v ~ exp(-0.3) within 1e-9\nshow run");
    EXPECT_HOLDS(kit.text, "real time");
    EXPECT_HOLDS(kit.text, "rk4");
    EXPECT_FAILS(&kit, "simulate 1 realtime=on method=radau", "can't keep up with the clock");
    EXPECT_HOLDS(kit.error.hint, "rk4 or symplectic");
    EXPECT_FAILS(&kit, "simulate 1 realtime=often", "realtime is on or off");
    EXPECT_DONE(&kit, "simulate 0.3 every=0.1 realtime=off step=0.01\nshow run");
    EXPECT_LACKS(kit.text, "real time");
    kit_free(&kit);
}

static void figures_are_those_of_the_run_that_is_asked_for(void)
{
    Kit kit = kit_new();
    ct_figures first = {0}, last = {0}, none = {.rows = 7};

    EXPECT(!ct_run_figures(kit.session, 0, &none) && none.rows == 7);
    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody p mass=2 inertia=0.5\n"
                      "arm a p [0, 1.5]\nrevolute h ground a\ninit h = 1\n"
                      "simulate 1 every=0.1 rtol=1e-9\nsimulate 2 every=0.1 check=on\n");
    EXPECT(ct_run_figures(kit.session, 1, &first) && ct_run_figures(kit.session, 0, &last));
    EXPECT(!ct_run_figures(kit.session, 3, &none) && none.rows == 7);
    EXPECT(first.rows == 11 && first.from == 0 && first.to == 1 && first.rtol == 1e-9);
    EXPECT(last.rows == 21 && last.to == 2 && last.steps > 0 && last.evaluations > last.steps);
    EXPECT(isnan(first.global_error) && last.global_error >= 0 && last.global_error < 1e-6);
    EXPECT(first.energy_drift < 1e-6 * first.energy_scale && !first.stopped);
    EXPECT_TEXT(first.method, "dop853");
    kit_free(&kit);
}

/* Stiff beams blow up what a first step of dop853 tries: no part of the motion, that makes no place
 * of it look singular, to whichever method goes on. A slider-crank whose rod is four beams. */
static void a_step_given_up_leaves_nothing_behind(void)
{
    static const char *const methods[] = {"auto", "radau", "dop853"};
    ct_figures of[3] = {{0}};
    Kit kit = kit_new();
    char line[120];

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody crank mass=0.5 inertia=1e-3\n"
                      "revolute h1 ground crank\narm e0 crank [0.15, 0]\n");
    for (int i = 1; i <= 4; i++) {
        (void)snprintf(line, sizeof line,
                       "beam b%d length=0.1 mass_per_length=0.5 EA=1e6 EIz=20 modes=[0, 2] "
                       "damping=[0, 1e-4]\narm e%d b%d at=0.1\n",
                       i, i, i);
        EXPECT_DONE(&kit, line);
        (void)snprintf(line, sizeof line, "%s j%d e%d b%d\n", i == 1 ? "revolute" : "weld", i,
                       i - 1, i);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "body slider mass=0.5 inertia=1e-3\nrevolute h3 e4 slider\n"
                      "prismatic s ground slider axis=x\ninit h1 = 30 deg, h1' = 20\n"
                      "guess s = 0.5\n");
    for (int i = 0; i < 3; i++) {
        (void)snprintf(line, sizeof line, "simulate 0.05 every=0.01 rtol=1e-6 method=%s\n",
                       methods[i]);
        EXPECT_DONE(&kit, line);
        EXPECT(ct_run_figures(kit.session, 0, &of[i]));
    }
    EXPECT_TEXT(of[0].method, "radau");
    EXPECT((double)of[0].evaluations < 1.5 * (double)of[1].evaluations);
    EXPECT(of[2].rejected < of[2].steps / 10);
    kit_free(&kit);
}

/* A parallelogram that a driver leads through its flat positions moves evenly, in few long steps.
 * In shorter ones their dense output comes near such a position and is far worse. */
static void rows_of_long_steps_past_singular_positions_are_found(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\n"
                      "body c0 mass=1.4 inertia=0.12\n"
                      "arm c0a c0 [-0.5, 0]; arm c0b c0 [0.5, 0]\nrevolute h0 ground c0a\n"
                      "body c1 mass=1.2 inertia=0.1\n"
                      "arm c1a c1 [-0.5, 0]; arm c1b c1 [0.5, 0]\n"
                      "arm g1 ground [1.8, 0]\nrevolute h1 g1 c1a\n"
                      "body k0 mass=2 inertia=0.6\n"
                      "arm k0a k0 [-0.9, 0]; arm k0b k0 [0.9, 0]\n"
                      "revolute l0 c0b k0a\nrevolute r0 k0b c1b\ncotree l0\n"
                      "guess h1=1, l0=-1, r0=1\ninit h0 = 1\ndriver D h0 = 1 - 4*t\n"
                      "simulate 3 every=0.01\n");
    for (int row = 0; row <= 300; row++) {
        char at[60];

        (void)snprintf(at, sizeof at, "h1 - h0 at %.2f", 0.01 * row);
        EXPECT_NEAR(kit_value(&kit, at), 0, 1e-9);
        (void)snprintf(at, sizeof at, "h1' - h0' at %.2f", 0.01 * row);
        EXPECT_NEAR(kit_value(&kit, at), 0, 1e-6);
    }
    kit_free(&kit);
}

int main(void)
{
    RUN(a_run_keeps_energy_and_meets_the_start);
    RUN(the_period_is_that_of_the_closed_form);
    RUN(a_value_is_of_the_end_of_the_run_until_something_changes);
    RUN(an_instant_within_rounding_of_a_row_is_that_row);
    RUN(runs_keep_the_parameters_they_were_made_with);
    RUN(runs_survive_an_edit_of_the_model);
    RUN(functions_of_runs_see_every_row);
    RUN(sizes_and_entries_are_values);
    RUN(a_value_that_is_none_is_refused);
    RUN(freedoms_are_counted_alike_wherever_asked_for);
    RUN(any_function_is_taken_of_what_the_session_knows);
    RUN(options_that_make_no_sense_are_refused);
    RUN(resume_goes_on_with_what_was_said_before);
    RUN(a_table_has_a_row_an_instant_and_names_as_written);
    RUN(a_table_without_items_holds_all_coordinates_and_speeds);
    RUN(csv_has_a_header_and_reads_back_to_the_last_bit);
    RUN(items_of_several_runs_stand_on_one_grid);
    RUN(an_expectation_holds_or_says_by_how_much_not);
    RUN(a_stopped_run_keeps_what_it_has);
    RUN(a_stopped_derivation_leaves_the_session_whole);
    RUN(what_is_formed_later_can_be_stopped_too);
    RUN(a_start_can_be_stopped_anywhere);
    RUN(what_is_stopped_anywhere_leaves_nothing_behind);
    RUN(a_solution_that_ends_ends_the_run);
    RUN(a_run_keeps_up_with_the_clock);
    RUN(figures_are_those_of_the_run_that_is_asked_for);
    RUN(a_step_given_up_leaves_nothing_behind);
    RUN(rows_of_long_steps_past_singular_positions_are_found);
    return test_end();
}

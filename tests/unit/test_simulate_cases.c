/* test_simulate_cases.c: scripts of the paper's cases and of reference mechanisms, run through the
 * library and compared with data computed elsewhere (tests/data/README) */
#include "simulate_script.h"

#include "base/text.h"

/* a table of numbers: a line of names, then rows */
typedef struct Reference {
    int rows, columns;
    double *at; /* rows x columns */
} Reference;

static Reference read_table(const char *path)
{
    Reference table = {0};
    char *text = script_file(path);
    char *line = text != NULL ? strchr(text, '\n') : NULL;
    LIST(double) numbers = {0};

    while (line != NULL && line[1] != '\0') {
        char *end = line;

        table.columns = 0;
        do {
            LIST_PUSH(numbers, strtod(end + 1, &end));
            table.columns++;
        } while (*end == ',');
        table.rows++;
        line = *end == '\n' ? end : NULL;
    }
    table.at = numbers.at;
    mem_free(text);
    return table;
}

typedef struct Case {
    const char *script, *data;
    Changes changes;
    double bound;    /* of the largest value of each column */
    int last_column; /* of the data, for the last item; 0: in order */
    int columns;     /* compared; 0: all items */
} Case;

/* largest difference of item k to its column, over the column's largest value */
static double difference(const Script *script, const Reference *table, const double *values, int k,
                         int column)
{
    int rows = result_rows(script->result);
    const double *times = result_times(script->result);
    double largest = 0, scale = 0;
    int row = 0;

    for (int i = 0; i < table->rows; i++) {
        double t = table->at[i * table->columns];
        double wanted = table->at[i * table->columns + column];

        scale = fmax(scale, fabs(wanted));
        while (row < rows - 1 && times[row] < t - 1e-9)
            row++;
        if (fabs(times[row] - t) < 1e-9) {
            double off = fabs(values[row * script->items.count + k] - wanted);

            largest = off <= largest ? largest : off;
        }
    }
    return largest / (scale > 0 ? scale : 1);
}

/* the largest of these differences */
static double compare(const Case *c)
{
    char *text = script_file(c->script);
    Reference table = read_table(c->data);
    Script script = {0};
    double *values = NULL;
    Diag diag = {0};
    double worst = INFINITY;

    if (text == NULL || table.rows == 0)
        goto done;
    script_open(&script, text, &c->changes);
    if (script.status != OK || script.result == NULL) {
        test_faults++;
        printf("%s: %s (%s)\n", c->script, script.diag.message, script.diag.hint);
        goto done;
    }
    values = NEW_ARRAY(double, result_rows(script.result) * script.items.count);
    EXPECT(result_reader_values(script.reader, script.items.at, script.items.count, values,
                                &diag) == OK);
    EXPECT_TEXT(diag.message, "");
    worst = 0;
    for (int k = 0; k < script.items.count && (c->columns == 0 || k < c->columns); k++) {
        int column = c->last_column > 0 && k == script.items.count - 1 ? c->last_column : k + 1;
        double off = difference(&script, &table, values, k, column);

        worst = off <= worst ? worst : off; /* a NAN stays */
        if (!(off <= c->bound)) {
            test_faults++;
            printf("%s with %s: column %d is off by %.3g of its largest value\n", c->script,
                   c->changes.method != NULL ? c->changes.method : "auto", column, off);
        }
    }
    if (getenv("VERBOSE") != NULL) {
        const RunReport *report = result_report(script.result);

        printf("%-45s %-7s rtol %-7.1g worst %.2e  steps %lld rhs %lld  Phi %.1e  dE %.1e  %.0f "
               "ms\n%s",
               c->script, report->method, report->rtol, worst, (long long)report->steps,
               (long long)report->evaluations, report->position_residual, report->energy_drift,
               1e3 * report->wall, script_remarks(&script));
    }
done:
    mem_free(values);
    script_close(&script);
    mem_free(table.at);
    mem_free(text);
    return worst;
}

#define ONE_TREE  "scripts/paper/1_slider_crank_one_tree.ct"
#define TWO_TREES "scripts/paper/1_slider_crank_two_trees.ct"
#define CRANK     "tests/data/slider_crank.csv"

static void slider_crank_agrees_in_both_trees_forms_and_all_methods(void)
{
    static const char *const scripts[] = {ONE_TREE, TWO_TREES};
    static const char *const forms[] = {"form augmented\n", "form embedded\n"};
    static const char *const methods[] = {"dop853", "radau", "bdf", "adams", "ida"};

    for (int s = 0; s < 2; s++)
        for (int f = 0; f < 2; f++)
            for (int m = 0; m < COUNT(methods); m++) {
                Case c = {.script = scripts[s],
                          .data = CRANK,
                          .changes = {.before = forms[f],
                                      .method = methods[m],
                                      .rtol = m < 2 ? 1e-9 : 1e-12},
                          .bound = 1e-7,
                          .last_column = s == 1 ? 20 : 0};

                c.changes.skip_expects = true;
                (void)compare(&c);
            }
}

static void motor_arm_forward_agrees(void)
{
    Case c = {.script = "scripts/paper/3_motor_arm_forward.ct",
              .data = "tests/data/motor_arm_forward.csv",
              .changes = {.rtol = 1e-12},
              .bound = 1e-8};

    (void)compare(&c);
}

static void motor_arm_inverse_finds_currents_and_voltages(void)
{
    Case c = {.script = "scripts/paper/3_motor_arm_inverse.ct",
              .data = "tests/data/motor_arm_inverse.csv",
              .bound = 1e-9};

    (void)compare(&c);
}

static void pendulum_agrees_for_ten_seconds(void)
{
    static const char *const scripts[] = {"scripts/reference/ref_A01_pendulum_joint.ct",
                                          "scripts/reference/ref_A01_pendulum_absolute.ct"};

    for (int i = 0; i < 2; i++) {
        Case c = {.script = scripts[i],
                  .data = "tests/data/pendulum_10s.csv",
                  .changes = {.rtol = 1e-12},
                  .bound = 1e-9};

        (void)compare(&c);
    }
}

static void pendulum_agrees_for_two_thousand_seconds(void)
{
    Case c = {.script = "scripts/reference/ref_A01_pendulum_2000s.ct",
              .data = "tests/data/pendulum_2000s.csv",
              .bound = 1e-6};

    (void)compare(&c);
}

static void four_bar_keeps_its_branch(void)
{
    static const char *const scripts[] = {"scripts/reference/ref_A02_four_bar_joint.ct",
                                          "scripts/reference/ref_A02_four_bar_absolute.ct"};

    for (int i = 0; i < 2; i++)
        for (int digits = 4; digits <= 12; digits += 2) {
            Case c = {.script = scripts[i],
                      .data = "tests/data/four_bar.csv",
                      .changes = {.rtol = pow(10, -digits), .duration = 10},
                      .bound = digits >= 8 ? 1e-5 : 0.2,
                      .columns = 2};

            c.changes.skip_expects = true;
            (void)compare(&c);
        }
}

/* cranks in a row of length 1, upright at first, joined by couplers; all move as one */
static char *parallel_cranks(int loops)
{
    Text text = {0};

    text_add(&text, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 0; i <= loops; i++)
        text_addf(&text,
                  "body c%d mass=1 inertia=1/12\narm g%d ground [%d, 0]\narm cl%d c%d [0, -1/2]\n"
                  "arm ch%d c%d [0, 1/2]\nrevolute a%d g%d cl%d\n",
                  i, i, i, i, i, i, i, i, i, i);
    for (int i = 0; i < loops; i++)
        text_addf(&text,
                  "body k%d mass=1 inertia=1/12\narm kl%d k%d [-1/2, 0]\narm kr%d k%d [1/2, 0]\n"
                  "revolute l%d ch%d kl%d\nrevolute r%d kr%d ch%d\n",
                  i, i, i, i, i, i, i, i, i, i, i + 1);
    text_add(&text, "tree absolute\ninit a0 = 0, a0' = -1\n");
    for (int i = 0; i < loops; i++)
        text_addf(&text, "guess a%d = 0, l%d = 0\n", i + 1, i);
    text_add(&text, "simulate 10 every=0.025\n");
    return text_done(&text);
}

/* At each of their flat positions a step is taken over all loops' singular positions at once. That
 * their energy stays tells how fast they are where they are. */
static void many_cranks_pass_their_singular_positions(void)
{
    enum { LOOPS = 40 };
    const double inertia = (LOOPS + 1) / 3.0 + LOOPS, lever = (LOOPS + 1) / 2.0 + LOOPS;
    static const double tolerances[] = {1e-5, 1e-7, 1e-8, 1e-9};
    char *text = parallel_cranks(LOOPS);

    for (int k = 0; k < COUNT(tolerances); k++) {
        const Changes changes = {.rtol = tolerances[k]};
        Script script;

        script_open(&script, text, &changes);
        EXPECT(script.status == OK);
        for (int i = 0; i <= 20 && script.status == OK; i++) {
            const double t = i / 2.0, y = value_at(&script, "ch0.y", t);
            const double speed = value_at(&script, "a0'", t);
            const double right = 1 + 2 * 9.81 * lever * (1 - y) / inertia;

            EXPECT_NEAR(speed * speed, right, 1e3 * tolerances[k] * right);
            EXPECT_NEAR(value_at(&script, "ch40.y", t), y, 1e3 * tolerances[k]);
        }
        if (script.status == OK)
            EXPECT(result_report(script.result)->steps < 500);
        script_close(&script);
    }
    mem_free(text);
}

static void andrews_agrees(void)
{
    static const char *const trees[] = {NULL, "tree absolute\n", "tree jO K2 jB jG K5 jH jA7\n"};

    for (int i = 0; i < 3; i++) {
        Case c = {.script = "scripts/reference/ref_A03_andrews.ct",
                  .data = "tests/data/andrews.csv",
                  .changes = {.before = trees[i], .rtol = 1e-10, .duration = 0.03},
                  .bound = 1e-8,
                  .columns = 7};

        c.changes.skip_expects = true;
        (void)compare(&c);
    }
}

/* Two digits of tolerance at least halve the error, six gain four digits, down to what rounding
 * leaves: the spin about the middle axis grows as exp(2.9 t/s) for half a period of 5.3 s, a factor
 * of 4e6 on 1e-16. */
static void errors_of_spinning_bodies_fall_with_the_tolerance(void)
{
    static const struct {
        const char *script, *data;
    } cases[] = {{"scripts/reference/ref_heavy_top.ct", "tests/data/heavy_top.csv"},
                 {"scripts/reference/ref_free_body.ct", "tests/data/free_body.csv"}};

    const double floor_of_rounding = 1e-9;

    for (int i = 0; i < COUNT(cases); i++) {
        double first = 0, before = INFINITY, error = INFINITY;

        for (int digits = 6; digits <= 12; digits += 2) {
            Case c = {.script = cases[i].script,
                      .data = cases[i].data,
                      .changes = {.rtol = pow(10, -digits), .skip_expects = true},
                      .bound = 1};

            error = compare(&c);
            EXPECT(error < 0.5 * before + floor_of_rounding);
            if (digits == 6)
                first = error;
            before = error;
        }
        EXPECT(error < 1e-4 * first + floor_of_rounding);
    }
}

static void scripts_meet_what_they_expect(void)
{
    static const char *const scripts[] = {
        ONE_TREE,
        TWO_TREES,
        "scripts/paper/3_motor_arm_forward.ct",
        "scripts/paper/3_motor_arm_inverse.ct",
        "scripts/reference/ref_A01_pendulum_joint.ct",
        "scripts/reference/ref_A01_pendulum_absolute.ct",
        "scripts/reference/ref_A02_four_bar_joint.ct",
        "scripts/reference/ref_A02_four_bar_absolute.ct",
        "scripts/reference/ref_A03_andrews.ct",
        "scripts/reference/ref_A03_andrews_beta062.ct",
    };

    for (int i = 0; i < COUNT(scripts); i++) {
        char *text = script_file(scripts[i]);
        Script script = {0};

        if (text == NULL)
            continue;
        script_open(&script, text, &(Changes){0});
        EXPECT(script.status == OK);
        EXPECT_TEXT(script.diag.message, "");
        EXPECT(script.expects > 10);
        script_close(&script);
        mem_free(text);
    }
}

int main(void)
{
    RUN(slider_crank_agrees_in_both_trees_forms_and_all_methods);
    RUN(motor_arm_forward_agrees);
    RUN(motor_arm_inverse_finds_currents_and_voltages);
    RUN(pendulum_agrees_for_ten_seconds);
    RUN(pendulum_agrees_for_two_thousand_seconds);
    RUN(four_bar_keeps_its_branch);
    RUN(many_cranks_pass_their_singular_positions);
    RUN(andrews_agrees);
    RUN(errors_of_spinning_bodies_fall_with_the_tolerance);
    RUN(scripts_meet_what_they_expect);
    return test_end();
}

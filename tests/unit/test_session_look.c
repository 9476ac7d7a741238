/* test_session_look.c: show, count, info, check, tree, draw */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

static void one_tree_gives_the_two_equations_of_the_paper(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE "show constraints");
    EXPECT_HOLDS(kit.text, "2 constraints in 3 coordinates (h8, h10, s11): 1 degree of freedom");
    /* eq. 6 up to order and sign of the whole */
    EXPECT_HOLDS(kit.text, "(L4 + L5)*cos(h8)");
    EXPECT_HOLDS(kit.text, "(L6 + L7)*cos(h10)");
    EXPECT_HOLDS(kit.text, "(L6 + L7)*sin(h10)");
    EXPECT_HOLDS(kit.text, "s11");
    kit_free(&kit);
}

static void two_trees_give_the_one_equation_of_the_paper(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES "show constraints");
    EXPECT_HOLDS(kit.text, "1 constraint in 2 coordinates (h8, h10): 1 degree of freedom");
    EXPECT_HOLDS(kit.text, "(L4 + L5)*sin(h8) - (L6 + L7)*sin(h10) = 0");
    EXPECT(kit.text != NULL && strstr(kit.text, "cos") == NULL);
    kit_free(&kit);
}

static void rates_of_constraints_are_linear_in_rates(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES "show constraints velocity");
    EXPECT_HOLDS(kit.text, "(L4 + L5)*cos(h8)*h8' - (L6 + L7)*cos(h10)*h10' = 0");
    EXPECT_DONE(&kit, "show constraints acceleration 1");
    EXPECT_HOLDS(kit.text, "(L4 + L5)*cos(h8)*h8'' - (L6 + L7)*cos(h10)*h10''");
    EXPECT_HOLDS(kit.text, "= h8'^2*(L4 + L5)*sin(h8) - h10'^2*(L6 + L7)*sin(h10)");
    kit_free(&kit);
}

/* theory: J theta'' = ... and L i' = V - R i - K theta', the paper's eqs. 16-17 for one arm */
static void the_motor_arm_has_a_mechanical_and_an_electrical_equation(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MOTOR_ARM "show equations");
    EXPECT_HOLDS(kit.text, "(M*a^2 + J)*theta'' = K7*M7.i");
    EXPECT_HOLDS(kit.text, "M7:  L7*M7.i' = ");
    EXPECT_HOLDS(kit.text, "- R7*M7.i");
    EXPECT_HOLDS(kit.text, "- K7*theta'");
    kit_free(&kit);
}

/* every topic prints something, formulas in every notation, and no line is wider than the page */
static void every_topic_fits_the_page(void)
{
    enum { FORMULAS = 8 }; /* that come first */
    static const char *const topics[] = {"constraints", "constraints velocity",
                                         "jacobian",    "mass",
                                         "forces",      "equations",
                                         "network",     "outputs",
                                         "graph",       "nodes",
                                         "edges",       "tree",
                                         "params",      "incidence",
                                         "circuits",    "cutsets",
                                         "coordinates", "settings",
                                         "structure",   "program"};
    static const char *const notations[] = {"",      " as text",   " as latex",
                                            " as c", " as matlab", " as tree"};
    static const char *const models[] = {SLIDER_CRANK ONE_TREE, MOTOR_ARM, "scene planar"};
    char line[80];

    for (int m = 0; m < 3; m++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, models[m]);
        for (size_t t = 0; t < sizeof topics / sizeof topics[0]; t++)
            for (int n = 0; n < (t < FORMULAS ? 6 : 2); n++) {
                (void)snprintf(line, sizeof line, "show %s%s", topics[t], notations[n]);
                EXPECT_DONE(&kit, line);
                for (const char *at = kit.text; n < 2 && at != NULL && *at != '\0';) {
                    const size_t length = strcspn(at, "\n");

                    if (length > 80 && strcmp(topics[t], "program") != 0) {
                        test_faults++;
                        printf("'%s' is wider than the page: %.*s\n", line, (int)length, at);
                    }
                    at += length + (at[length] == '\n');
                }
            }
        kit_free(&kit);
    }
}

/* What a run does once, again only where something has changed, and not at all: each where it is
 * so, and not where it isn't. */
static void a_program_tells_what_is_hoisted_kept_and_skipped(void)
{
#define FREE_BODY "body b mass=1 inertia=[1, 1, 1]\nfree f ground b\n"
    static const struct {
        const char *model, *holds, *lacks;
    } cases[] = {
        /* nothing but numbers: no operation is left of them */
        {FREE_BODY, "hoisted  0 operations of", NULL},
        /* a*b alone */
        {"a = 2; b = 3\nscene planar\nbody m mass=1 inertia=1\nprismatic s ground m axis=x\n"
         "force F m [a*b*cos(t), 0]\n",
         "hoisted  1 operation of", NULL},
        {FREE_BODY, "kept     M, which is constant", "which accelerations do without"},
        {SLIDER_CRANK ONE_TREE, "skipped  ", "M, which is constant"},
        {"resistor R a b 10\ncapacitor C b 0 1 mF\nvsource V a 0 5*sin(t)\n",
         "kept     the matrix of the network, which is constant", "M, which"},
        {"resistor R a b 10\ncapacitor C b 0 (1 + 0.1*t)*1e-3\nvsource V a 0 5*sin(t)\n",
         "operations of t and coordinates", "matrix of the network"},
        /* a matrix of six on six whose diagonal is all there is */
        {FREE_BODY, "skipped  30 of 36 entries of M, which are 0", "multiplier"},
        {SLIDER_CRANK TWO_TREES, "solving at rows of t, coordinates, speeds", "embedded"},
        {SLIDER_CRANK TWO_TREES, "skipped  factoring the matrix of accelerations and 1 multiplier",
         "multipliers"},
        /* rows that are always independent: a program of rates alone */
        {"scene planar\ngravity [0, -9.81]\nbody b mass=1 inertia=1\narm a b [-1, 0]\nrevolute h "
         "ground a\n"
         "tree absolute\n",
         "rates, where constraints are eliminated:\n", NULL},
        {SLIDER_CRANK TWO_TREES, "skipped  factoring", "rates, where"},
        {SLIDER_CRANK TWO_TREES "form embedded\n",
         "skipped  1 multiplier, which the embedded form does without", "factoring"},
    };

    for (int i = 0; i < COUNT(cases); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, cases[i].model);
        EXPECT_DONE(&kit, "show program");
        EXPECT_HOLDS(kit.text, cases[i].holds);
        if (cases[i].lacks != NULL)
            EXPECT_LACKS(kit.text, cases[i].lacks);
        kit_free(&kit);
    }
#undef FREE_BODY
}

/* what stands on the left of an assignment has to be something that can be assigned to */
static void programs_assign_to_names(void)
{
    static const struct {
        const char *line, *text;
    } shown[] = {{"show (2*s) as c", "value = 2.0*s;\n"},
                 {"show ((s)) as c", "value = s;\n"},
                 {"show sin(s) (s - 1) as matlab", "value1 = sin(s);\nvalue2 = s - 1;\n"},
                 {"show F.effort as c", "F_effort = 6.0*s;\n"},
                 {"show F.effort as matlab", "F_effort = 6*s;\n"},
                 {"show s'' as matlab", "value = s_dd;\n"},
                 {"show (2*s) as text", "(2*s) = 2*s\n"},
                 {"value = 3; show (2*s) as c", "value_ = 2.0*s;\n"}};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m1 mass=1\nprismatic s ground m1 axis=x\n"
                      "actuator F s force=6*s\n");
    for (int i = 0; i < COUNT(shown); i++) {
        EXPECT_DONE(&kit, shown[i].line);
        EXPECT_TEXT(kit.text, shown[i].text);
    }
    kit_free(&kit);
}

static void latex_has_its_brackets_in_pairs(void)
{
    Kit kit = kit_new();
    int depth = 0, left = 0;

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE "show equations as latex");
    EXPECT_HOLDS(kit.text, "\\begin{align*}");
    EXPECT_HOLDS(kit.text, "\\end{align*}\n");
    EXPECT_HOLDS(kit.text, "\\ddot{h}_{8}");
    for (const char *c = kit.text; c != NULL && *c != '\0'; c++) {
        depth += *c == '{' ? 1 : *c == '}' ? -1 : 0;
        left += strncmp(c, "\\left", 5) == 0 && c[5] != 'a'    ? 1
                : strncmp(c, "\\right", 6) == 0 && c[6] != 'a' ? -1
                                                               : 0;
        EXPECT(depth >= 0);
        /* \left and \right may not stand on two lines of an alignment */
        if (strncmp(c, "\\\\\n", 3) == 0)
            EXPECT(left == 0 && depth == 0);
    }
    EXPECT(depth == 0 && left == 0);
    kit_free(&kit);
}

static void entries_and_variables_can_be_asked_for(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MOTOR_ARM "show mass 1 1");
    EXPECT_TEXT(kit.text, "mass(1,1) = M*a^2 + J\n");
    EXPECT_DONE(&kit, "show M7.torque");
    EXPECT_TEXT(kit.text, "M7.torque = K7*M7.i\n");
    EXPECT_DONE(&kit, "show mass(1,1)");
    EXPECT_TEXT(kit.text, "mass(1,1) = M*a^2 + J\n");
    EXPECT_DONE(&kit, "show cutsets J1");
    EXPECT_HOLDS(kit.text, "J1 + m1 + M7");
    EXPECT_DONE(&kit, "show mass 1 1 as c");
    EXPECT_HOLDS(kit.text, "mass[0][0] = ");
    kit_free(&kit);
}

static void what_cannot_be_shown_is_refused_with_a_way_out(void)
{
    /* clang-format off */
    static const struct { const char *line; int column; const char *message, *hint; } wrong[] = {
        {"show constraint", 6,  "nothing to show is called 'constraint'", "show constraints"},
        {"show eq",         6,  "nothing to show is called 'eq'", "'show equations'"},
        {"show con",        6,  "nothing to show is called 'con'", "'show constraints'"},
        {"show derivation 99", 17, "the equations have",        "show equations"},
        {"show derivation mass(9,1)", 22, "has the rows 1 to",  ""},
        {"show derivation mass(1)", 17, "a row and a column",   ""},
        {"show derivation network(1)", 17, "no block",          "mass(2,3)"},
        {"show derivation h80", 17, "h80",                      ""},
        {"show derivation h8 h9", 20, "at a time",              ""},
        {"show derivation (h8 + h9)", 17, "takes a name",       ""},
        {"show derivation h8 as c", 23, "'show derivation' is not written as c", "only as text, latex"},
        {"show tree as latex", 14, "'show tree' is not written as latex", "only as text"},
        {"show linear as python", 16, "is not written as python", "only as text, latex, c, matlab"},
        {"show run as c",    13, "is not written as c",         "only as text"},
        {"show mass 9",     11, "there is no row 9",            ""},
        {"show mass 1 9",   11, "there is no column 9",         ""},
        {"show mass 1 1 1", 15, "a row and a column only",      ""},
        {"show mass 0",     11, "counted 1, 2, 3",              ""},
        {"show mass h8",    11, "takes no names",               ""},
        {"show tree 1",     11, "takes no numbers",             ""},
        {"show constraints h8", 18, "velocity or acceleration", ""},
        {"show cutsets h9",  14, "no branch",                   "show circuits"},
        {"show circuits h8", 15, "no chord",                    "show cutsets"},
        {"show cutsets h80", 14, "no edge is called 'h80'",     "h8"},
        {"show cutsets (h8 + h9)", 14, "expected a name",       ""},
        {"show mass as word", 14, "no notation is called 'word'", "latex"},
        {"show nothing.like", 6, "nothing",                     ""},
        {"show run",         0, "no run yet",                   "simulate"},
        {"count mas",        7, "no block of equations is called 'mas'", "mass"},
        {"count weights",    7, "no block of equations",        "mass forces"},
        {"info h88",         6, "nothing is called 'h88'",      "h8"},
    };
    /* clang-format on */
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const ct_status status = kit_do(&kit, wrong[i].line);

        if (status != CT_FAILED || (wrong[i].column > 0 && kit.error.column != wrong[i].column) ||
            strstr(kit.error.message, wrong[i].message) == NULL ||
            strstr(kit.error.hint, wrong[i].hint) == NULL) {
            test_faults++;
            printf("'%s': status %d, column %d: %s (%s)\n", wrong[i].line, status, kit.error.column,
                   kit.error.message, kit.error.hint);
        }
        EXPECT_DONE(&kit, "show constraints");
    }
    kit_free(&kit);
}

static void equations_of_a_model_that_is_not_whole_are_refused(void)
{
    Kit kit = kit_new();

    /* neither terminal is tied to 0 */
    EXPECT_DONE(&kit, "scene planar\nresistor R1 a b 10\nresistor R2 a b 10");
    EXPECT(kit_do(&kit, "show equations") == CT_FAILED);
    EXPECT(kit.error.message[0] != '\0');
    EXPECT_DONE(&kit, "show edges");
    EXPECT_DONE(&kit, "info R1");
    kit_free(&kit);
}

static void counts_are_those_of_the_rule(void)
{
    Kit kit = kit_new();

    /* M*a^2 + J: one sum of two, a product of two with a square */
    EXPECT_DONE(&kit, MOTOR_ARM "count mass");
    EXPECT_HOLDS(kit.text, "mass");
    EXPECT_NEAR(kit_value(&kit, "count.mass.add"), 1, 0);
    EXPECT_NEAR(kit_value(&kit, "count.mass.mul"), 2, 0);
    EXPECT_NEAR(kit_value(&kit, "count.mass.fun"), 0, 0);
    EXPECT_NEAR(kit_value(&kit, "count.total.mul"),
                kit_value(&kit, "count.mass.mul") + kit_value(&kit, "count.forces.mul") +
                    kit_value(&kit, "count.network.mul") + kit_value(&kit, "count.network_rhs.mul"),
                0);
    EXPECT(kit_value(&kit, "count.shared.total.mul") > 0);
    kit_free(&kit);
}

static void count_trees_puts_the_trees_tried_side_by_side(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE TWO_TREES "count trees");
    EXPECT_HOLDS(kit.text, ": h8 h10 s11\n");
    EXPECT_HOLDS(kit.text, ": translation h8 h9 h10; rotation h8 h10 s11\n");
    /* undoing a choice of trees leaves the list as it is */
    EXPECT_DONE(&kit, "undo\ncount trees");
    EXPECT_HOLDS(kit.text, ": h8 h10 s11\n");
    /* another graph starts another list */
    EXPECT_DONE(&kit, "body m4 mass=1\ncount trees");
    EXPECT(strstr(kit.text, ": h8 h10 s11\n") == NULL);
    kit_free(&kit);
}

/* a row of `count trees`: operations as written */
static bool trees_have(const char *text, int row, const double *counts)
{
    char lead[16];
    const char *at;
    double read[5];

    (void)snprintf(lead, sizeof lead, "\n%d ", row);
    at = text != NULL ? strstr(text, lead) : NULL;
    return at != NULL &&
           sscanf(at + 2, "%lf %lf %lf %lf %lf", read, read + 1, read + 2, read + 3, read + 4) ==
               5 &&
           read[2] == counts[0] && read[3] == counts[1] && read[4] == counts[2];
}

/* what takes long to count is counted where that is asked for */
static void many_entries_are_counted_when_they_are_asked_for(void)
{
    static const char *const counts[] = {"count.total.add", "count.total.mul", "count.total.fun"};
    static const char *const trees[] = {"tree absolute", "tree joint"};
    double expected[2][3];
    Kit kit = kit_new();
    char text[1200] = "";

    for (int i = 0; i < 6; i++) {
        char tail[8] = "ground";

        if (i > 0)
            (void)snprintf(tail, sizeof tail, "b%d", i - 1);
        (void)snprintf(text + strlen(text), sizeof text - strlen(text),
                       "body b%d mass=1 inertia=[1, 2, 3]; arm a%d b%d [0.1, 0.2, 0.3]\n"
                       "revolute h%d %s a%d axis=%c\n",
                       i, i, i, i, tail, i, "xyz"[i % 3]);
    }
    EXPECT_DONE(&kit, text);
    EXPECT_DONE(&kit, trees[0]);
    EXPECT_HOLDS(ct_remarks(kit.session), "42 coordinates, 30 constraints");
    EXPECT_LACKS(ct_remarks(kit.session), "additions");
    EXPECT_DONE(&kit, trees[1]);
    EXPECT_HOLDS(ct_remarks(kit.session), "additions");
    EXPECT_LACKS(ct_remarks(kit.session), "before");
    for (int i = 0; i < 2; i++) {
        Kit other = kit_new();

        EXPECT_DONE(&other, text);
        EXPECT_DONE(&other, trees[i]);
        for (int k = 0; k < 3; k++)
            expected[i][k] = kit_value(&other, counts[k]);
        kit_free(&other);
    }
    EXPECT_DONE(&kit, "count trees");
    EXPECT(trees_have(kit.text, 1, expected[1])); /* those of the beginning are of joints */
    EXPECT(trees_have(kit.text, 2, expected[0]));
    kit_free(&kit);
}

static void the_embedded_form_has_no_multipliers(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES "show equations");
    EXPECT_HOLDS(kit.text, "lambda(1)");
    EXPECT_DONE(&kit, "form embedded\nshow equations");
    EXPECT(kit.text != NULL && strstr(kit.text, "lambda(1)") == NULL);
    EXPECT_HOLDS(kit.text, "h8''");
    EXPECT_DONE(&kit, "count");
    EXPECT_HOLDS(kit.text, "embedded");
    kit_free(&kit);
}

static void the_embedded_form_of_many_constraints_is_counted_as_the_augmented(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "tree absolute\nform embedded\ncount");
    EXPECT_HOLDS(kit.text, "too many constraints");
    EXPECT_HOLDS(kit.text, "mass");
    EXPECT(kit_do(&kit, "show equations") == CT_FAILED);
    EXPECT(kit.error.hint[0] != '\0');
    EXPECT_DONE(&kit, "show constraints");
    kit_free(&kit);
}

static void info_tells_ends_signs_and_variables(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE "info h9");
    EXPECT_HOLDS(kit.text, "r5 -> r6");
    EXPECT_HOLDS(kit.text, "chord (cotree)");
    EXPECT_HOLDS(kit.text, "h9.fx");
    EXPECT_HOLDS(kit.text, "revolute h9 r5 r6");
    kit_free(&kit);
}

/* each with its unit, that of an effort by what it acts along */
static void info_tells_what_can_be_asked_of_a_part(void)
{
    static const struct {
        const char *line, *asked;
    } parts[] = {
        {"info M1", "M1.v [V], M1.i [A], M1.power [W], M1.torque [N*m]"},
        {"info V1", "V1.v [V], V1.i [A], V1.power [W]\n"},
        {"info S1", "S1.effort [N*m], S1.power [W]\n"},
        {"info S2", "S2.effort [N], S2.power [W]\n"},
        {"info A1", "A1.effort [N], A1.power [W]\n"},
        {"info D1", "D1.effort [N], D1.power [W]\n"},
        {"info C1", "C1.v [V], C1.i [A], C1.power [W], C1.q [C], C1.force [N],\n"},
        {"info s", "s [m], s' [m/s], s.fx [N]"},
        {"info h", "h [rad], h' [rad/s], h.fx [N]"},
    };
    Kit kit = kit_new();
    char wanted[160];

    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\nrevolute h ground b\n"
                      "body c mass=1 inertia=1\nprismatic s ground c axis=x\n"
                      "vsource V1 p 0 12\nmotor M1 h p 0 R=1 Kt=0.1\n"
                      "spring S1 h k=2\nspring S2 s k=2\nactuator A1 s force=1\n"
                      "damper D1 b c d=1\nplatecap C1 s p 0 C=1e-9/s");
    for (int i = 0; i < COUNT(parts); i++) {
        EXPECT_DONE(&kit, parts[i].line);
        (void)snprintf(wanted, sizeof wanted, "can be asked for: %s", parts[i].asked);
        EXPECT_HOLDS(kit.text, wanted);
    }
    EXPECT_DONE(&kit, "info S1.effort");
    EXPECT_HOLDS(kit.text, "; in N*m\n");
    kit_free(&kit);
}

static void info_knows_every_kind_of_name(void)
{
    static const struct {
        const char *name, *told;
    } names[] = {{"M7", "v is plus against minus"},
                 {"J1", "theta"},
                 {"theta", "coordinate of J1"},
                 {"J1.fx", "in N"},
                 {"R7", "parameter, R7 = 1.2"},
                 {"p1", "arm"},
                 {"power", "output"},
                 {"grow", "grow: law, grow(x, y) = R7*x + y^2\n"},
                 {"e", "terminal"},
                 {"ground", "the datum"}};
    Kit kit = kit_new();
    char line[40];

    EXPECT_DONE(&kit, MOTOR_ARM "output power = M7.v*M7.i\ngrow(x, y) = R7*x + y^2\n");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        (void)snprintf(line, sizeof line, "info %s", names[i].name);
        EXPECT_DONE(&kit, line);
        EXPECT_HOLDS(kit.text, names[i].told);
    }
    kit_free(&kit);
}

static void show_of_a_part_tells_what_info_does(void)
{
    static const char *const names[] = {"M7", "p1", "m1", "R7", "e", "ground", "theta"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MOTOR_ARM);
    for (int i = 0; i < COUNT(names); i++) {
        char line[40];
        char *told;

        (void)snprintf(line, sizeof line, "info %s", names[i]);
        EXPECT_DONE(&kit, line);
        told = mem_text(kit.text, strlen(kit.text));
        (void)snprintf(line, sizeof line, "show %s", names[i]);
        EXPECT_DONE(&kit, line);
        EXPECT_TEXT(kit.text, told);
        mem_free(told);
    }
    /* a formula where there is one */
    EXPECT_DONE(&kit, "show M7.torque R7");
    EXPECT_HOLDS(kit.text, "M7.torque = ");
    EXPECT_HOLDS(kit.text, "R7: parameter");
    kit_free(&kit);
}

static void the_parts_of_a_model_that_is_not_whole_are_shown(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 1\nvsource E2 a 0 2\nresistor R1 a 0 5\nshow R1");
    EXPECT_HOLDS(kit.text, "R1: resistor");
    EXPECT(kit_do(&kit, "show R1.i") != CT_OK);
    kit_free(&kit);
}

static void check_tells_freedoms_and_what_is_unused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE CRANK_START "spare = 3\narm tool m3 [0, 1]\ncheck");
    EXPECT_HOLDS(kit.text, "1 degree of freedom");
    EXPECT_HOLDS(kit.text, "spare");
    EXPECT_HOLDS(kit.text, "tool");
    EXPECT_HOLDS(kit.text, "can be assembled");
    /* a crank longer than what the rod reaches */
    EXPECT_DONE(&kit, "L5 = 3\ninit h8 = 90 deg\ncheck");
    EXPECT_HOLDS(kit.text, "can't be assembled");
    kit_free(&kit);
}

static void drawings_hold_every_edge(void)
{
    static const char *const edges[] = {"m1", "r4", "h8", "h9", "s11", "F12"};
    Kit kit = kit_new();
    char *dot = NULL;

    EXPECT_DONE(&kit, SLIDER_CRANK TWO_TREES "draw");
    EXPECT(kit_draw(&kit, "draw", "dot", &dot) == CT_OK);
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        EXPECT_HOLDS(kit.text, edges[i]);
        EXPECT_HOLDS(dot, edges[i]);
    }
    EXPECT_HOLDS(dot, "digraph");
    EXPECT_HOLDS(dot, "h9 (translation)");
    ct_free(dot);
    EXPECT_DONE(&kit, "tree");
    EXPECT_HOLDS(kit.text, "translation\n  branches");
    EXPECT_DONE(&kit, "clear\ndraw");
    EXPECT_HOLDS(kit.text, "no edges yet");
    kit_free(&kit);
}

/* a chain whose formulas are long */
static void a_long_entry_is_written_over_named_parts(void)
{
    Kit kit = kit_new();
    char line[200];

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nL = 1\n");
    for (int i = 0; i < 24; i++) {
        (void)snprintf(line, sizeof line, "body b%d mass=1 inertia=0.1\narm a%d b%d [-L, 0]\n", i,
                       i, i);
        EXPECT_DONE(&kit, line);
        (void)snprintf(line, sizeof line, "arm c%d b%d [L, 0]\n", i, i);
        EXPECT_DONE(&kit, line);
        if (i == 0)
            (void)snprintf(line, sizeof line, "revolute h0 ground a0\n");
        else
            (void)snprintf(line, sizeof line, "revolute h%d c%d a%d\n", i, i - 1, i);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "tree joint\nshow forces 1");
    EXPECT_HOLDS(kit.text, "where w1 = ");
    EXPECT(kit.text != NULL && strlen(kit.text) < 200000);
    kit_free(&kit);
}

/* --- matrices wider than the page --- */

enum { MOST_WORDS = 64, MOST_LINES = 256 };

/* lines of words; a line that begins like the first one is a heading of further columns */
typedef struct Grid {
    char *text;
    char *word[MOST_LINES][MOST_WORDS];
    int words[MOST_LINES];
    int lines;
} Grid;

/* what stands from `begin` on, up to `end` at a line's begin */
static Grid *grid_of(const char *text, const char *begin, const char *end)
{
    Grid *grid = NEW(Grid);
    const char *from = strstr(text, begin), *to = from != NULL ? strstr(from, end) : NULL;
    char *rest;

    EXPECT(from != NULL && to != NULL);
    grid->text = from != NULL && to != NULL ? mem_text(from, (size_t)(to - from + 1)) : NULL;
    for (char *line = grid->text != NULL ? strtok_r(grid->text, "\n", &rest) : NULL;
         line != NULL && grid->lines < MOST_LINES; line = strtok_r(NULL, "\n", &rest)) {
        int *count = &grid->words[grid->lines];
        char *left;

        for (char *word = strtok_r(line, " ", &left); word != NULL && *count < MOST_WORDS;
             word = strtok_r(NULL, " ", &left))
            grid->word[grid->lines][(*count)++] = word;
        grid->lines++;
    }
    return grid;
}

static void grid_free(Grid *grid)
{
    mem_free(grid->text);
    mem_free(grid);
}

/* the entry in a row and a column by their names; "" */
static const char *grid_at(const Grid *grid, const char *row, const char *column)
{
    int heading = 0;

    for (int i = 0; i < grid->lines; i++) {
        if (strcmp(grid->word[i][0], grid->word[0][0]) == 0)
            heading = i;
        if (i == heading || strcmp(grid->word[i][0], row) != 0)
            continue;
        for (int c = 1; c < grid->words[heading] && c < grid->words[i]; c++)
            if (strcmp(grid->word[heading][c], column) == 0)
                return grid->word[i][c];
    }
    return "";
}

static int widest_line(const char *text)
{
    int widest = 0;

    for (const char *at = text; at != NULL && *at != '\0';) {
        const int length = (int)strcspn(at, "\n");

        widest = length > widest ? length : widest;
        at += length + (at[length] == '\n');
    }
    return widest;
}

static void add_arms(Kit *kit, int count)
{
    char line[256];

    EXPECT_DONE(kit, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= count; i++) {
        (void)snprintf(line, sizeof line,
                       "body b%d mass=1 inertia=0.1\narm a%d b%d [-1, 0]\narm c%d b%d [1, 0]\n", i,
                       i, i, i, i);
        EXPECT_DONE(kit, line);
        if (i == 1)
            (void)snprintf(line, sizeof line, "revolute q1 ground a1\n");
        else
            (void)snprintf(line, sizeof line, "revolute q%d c%d a%d\n", i, i - 1, i);
        EXPECT_DONE(kit, line);
    }
    EXPECT_DONE(kit, "actuator T q1 torque=0\nspring S q2 k=3");
}

static void add_ladder(Kit *kit, int count)
{
    char line[128];

    EXPECT_DONE(kit, "vsource V1 n0 0 1\n");
    for (int i = 1; i <= count; i++) {
        (void)snprintf(line, sizeof line, "resistor R%d n%d n%d %d\ncapacitor C%d n%d 0 1\n", i,
                       i - 1, i, i, i, i);
        EXPECT_DONE(kit, line);
    }
}

/* the entries of A are those of the whole table */
static void dd_matrices_stand_in_blocks_of_columns(void)
{
    static const struct {
        void (*add)(Kit *kit, int count);
        int count, columns;
        const char *order;
    } models[] = {
        {add_arms, 9, 18, "linearize inputs=[T] outputs=[q1]"},
        {add_arms, 9, 18, "linearize inputs=[T] outputs=[q1]\nshow linear"},
        {add_ladder, 14, 14, "show state"},
    };
    static const int pages[] = {200, 60, 80}; /* the whole, then in blocks */

    for (int m = 0; m < COUNT(models); m++) {
        Grid *grid[COUNT(pages)];

        for (int p = 0; p < COUNT(pages); p++) {
            const ct_hooks hooks = {.columns = pages[p]};
            Kit kit = {.session = ct_session_new(&hooks)};

            models[m].add(&kit, models[m].count);
            EXPECT_DONE(&kit, models[m].order);
            EXPECT(widest_line(kit.text) <= pages[p]);
            EXPECT(p == 0 || widest_line(kit.text) > pages[p] - 12);
            grid[p] = grid_of(kit.text, "\nA ", "\nB ");
            kit_free(&kit);
        }
        EXPECT(grid[0]->words[0] == 1 + models[m].columns);
        for (int p = 1; p < COUNT(pages); p++)
            for (int r = 1; r < grid[0]->lines; r++)
                for (int c = 1; c < grid[0]->words[0]; c++)
                    EXPECT_TEXT(grid_at(grid[p], grid[0]->word[r][0], grid[0]->word[0][c]),
                                grid[0]->word[r][c]);
        for (int p = 0; p < COUNT(pages); p++)
            grid_free(grid[p]);
    }
}

/* crosses and dots of a full mass matrix of 45 speeds: each row has all of its columns */
static void dd_patterns_stand_in_blocks_of_columns(void)
{
    static const int pages[] = {60, 80};

    for (int p = 0; p < COUNT(pages); p++) {
        const ct_hooks hooks = {.columns = pages[p]};
        Kit kit = {.session = ct_session_new(&hooks)};
        int last = 0, from, to, crosses = 0;

        add_arms(&kit, 45);
        EXPECT_DONE(&kit, "show structure");
        EXPECT(widest_line(kit.text) <= pages[p] && widest_line(kit.text) > pages[p] - 3);
        for (const char *at = kit.text; (at = strstr(at, "\n columns ")) != NULL; at++) {
            EXPECT(sscanf(at, " columns %d to %d", &from, &to) == 2);
            EXPECT(from == last + 1);
            last = to;
        }
        EXPECT(last == 45);
        for (const char *at = strstr(kit.text, "\n columns "); (at = strstr(at, " x")) != NULL;
             at++)
            crosses += at[2] == ' ' || at[2] == '\n';
        EXPECT(crosses == 45 * 45);
        kit_free(&kit);
    }
}

/* Where the last of many bodies is, near ground and far from it: by turns about y and z, one after
 * the other, from the tip inward, p = turn(p + [1, 0, 0]). */
static void places_far_out_are_those_of_the_turns(void)
{
    enum { BODIES = 27 };
    Text text = {0};
    Kit kit = kit_new();
    char name[16];

    for (int i = 0; i < BODIES; i++) {
        text_addf(&text, "body b%d mass=1 inertia=[1, 2, 3]; arm s%d b%d [-1, 0, 0]\n", i, i, i);
        if (i == 0)
            text_add(&text, "revolute h0 ground s0 axis=z\n");
        else
            text_addf(&text, "revolute h%d b%d s%d axis=%c\n", i, i - 1, i, "zy"[i % 2]);
        text_addf(&text, "init h%d = %.17g\n", i, 0.1 + 0.03 * i);
    }
    EXPECT_DONE(&kit, text.at);
    EXPECT_DONE(&kit, "assemble");
    for (int last = 8; last < BODIES; last += 9) { /* 8 and 17 are written out, 26 isn't */
        double p[3] = {0, 0, 0};

        for (int i = last; i >= 0; i--) {
            const double c = cos(0.1 + 0.03 * i), s = sin(0.1 + 0.03 * i), x = p[0] + 1;
            double *across = i % 2 == 0 ? &p[1] : &p[2];
            const double side = i % 2 == 0 ? *across : -*across, turned = s * x + c * side;

            p[0] = c * x - s * side;
            *across = i % 2 == 0 ? turned : -turned;
        }
        for (int k = 0; k < 3; k++) {
            (void)snprintf(name, sizeof name, "b%d.%c", last, "xyz"[k]);
            EXPECT_NEAR(kit_value(&kit, name), p[k], 1e-12);
        }
    }
    text_free(&text);
    kit_free(&kit);
}

int main(void)
{
    RUN(places_far_out_are_those_of_the_turns);
    RUN(dd_matrices_stand_in_blocks_of_columns);
    RUN(dd_patterns_stand_in_blocks_of_columns);
    RUN(one_tree_gives_the_two_equations_of_the_paper);
    RUN(two_trees_give_the_one_equation_of_the_paper);
    RUN(rates_of_constraints_are_linear_in_rates);
    RUN(the_motor_arm_has_a_mechanical_and_an_electrical_equation);
    RUN(every_topic_fits_the_page);
    RUN(a_program_tells_what_is_hoisted_kept_and_skipped);
    RUN(programs_assign_to_names);
    RUN(latex_has_its_brackets_in_pairs);
    RUN(entries_and_variables_can_be_asked_for);
    RUN(what_cannot_be_shown_is_refused_with_a_way_out);
    RUN(equations_of_a_model_that_is_not_whole_are_refused);
    RUN(counts_are_those_of_the_rule);
    RUN(count_trees_puts_the_trees_tried_side_by_side);
    RUN(many_entries_are_counted_when_they_are_asked_for);
    RUN(the_embedded_form_has_no_multipliers);
    RUN(the_embedded_form_of_many_constraints_is_counted_as_the_augmented);
    RUN(info_tells_ends_signs_and_variables);
    RUN(info_tells_what_can_be_asked_of_a_part);
    RUN(info_knows_every_kind_of_name);
    RUN(show_of_a_part_tells_what_info_does);
    RUN(the_parts_of_a_model_that_is_not_whole_are_shown);
    RUN(check_tells_freedoms_and_what_is_unused);
    RUN(drawings_hold_every_edge);
    RUN(a_long_entry_is_written_over_named_parts);
    return test_end();
}

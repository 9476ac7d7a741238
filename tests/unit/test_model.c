/* test_model.c: what statements make of a model */
#include "test_model.h"

static const char crank[] =
    "scene planar\ngravity [0, -9.81]\n"
    "L4 = 0.08 m; L5 = 0.12 m; L6 = 0.25 m; L7 = 0.35 m\n"
    "body m1 mass=2 inertia=0.01\nbody m2 mass=1.2 inertia=0.03\n"
    "body m3 mass=3 inertia=0.01\narm r4 m1 [-L4, 0]\narm r5 m1 [L5, 0]\n"
    "arm r6 m2 [L6, 0]\narm r7 m2 [-L7, 0]\nrevolute h8 ground r4\n"
    "revolute h9 r5 r6\nrevolute h10 m3 r7\nprismatic s11 ground m3 axis=x\n"
    "force F12 m3 [-25 + 10*sin(5*t), 0]\n";

static Status apply(Model *model, const char *text)
{
    Diag diag = {0};
    Status status = apply_text(model, text, &diag);

    if (status != OK)
        printf("%s: %s\n", text, diag.message);
    return status;
}

static double parameter(const Model *model, const char *name)
{
    return model_parameter_value(model, expr_symbol(model_arena(model), name, SYMBOL_PARAMETER));
}

/* --- the graph --- */

static void parts_make_frames_and_edges(void)
{
    Model *model = model_of(crank);
    const Graph *graph = model_graph(model);
    const Instance *arm = model_find(model, "r4");
    const Instance *joint = model_find(model, "h9");

    EXPECT(graph_node_count(graph) == 8);
    EXPECT(graph_edge_count(graph) == 12);
    EXPECT_TEXT(graph_node(graph, arm->tail)->name, "m1");
    EXPECT_TEXT(graph_node(graph, arm->head)->name, "r4");
    EXPECT_TEXT(graph_node(graph, joint->tail)->name, "r5");
    EXPECT(graph_node(graph, model_find(model, "m1")->tail)->datum);
    EXPECT(graph_branching(graph, arm->edge, TREE_ROTATION) == BRANCH_ALWAYS);
    EXPECT(graph_branching(graph, model_find(model, "F12")->edge, TREE_TRANSLATION) ==
           BRANCH_NEVER);
    EXPECT(model_edge_owner(model, joint->edge) == joint);
    EXPECT(model_is_planar(model));
    EXPECT_NEAR(model_number(model, model_gravity(model)[1]), -9.81, 0);
    model_free(model);
}

static void terminals_spring_into_being(void)
{
    Model *model = model_of("a = 3\nvsource E a 0 10\nresistor R a b 5\nresistor Q b gnd a");
    const Graph *graph = model_graph(model);

    EXPECT(graph_find_node(graph, "b") >= 0);
    EXPECT(graph_node(graph, model_find(model, "E")->head)->datum);
    EXPECT(model_find(model, "E")->head == model_find(model, "Q")->head);
    EXPECT(graph_node(graph, model_find(model, "E")->head)->domain == DOMAIN_ELECTRICAL);
    EXPECT_EXPRESSION(model, "a + a.v", "a + a.v");
    model_free(model);
}

static void virtual_joints_enter_where_they_have_freedom(void)
{
    Model *model = model_of("body a mass=1\nbody b mass=1\nvirtual revolute v a b\n"
                            "virtual prismatic w a b\nvirtual free u a b");
    const Graph *graph = model_graph(model);
    const int v = model_find(model, "v")->edge;
    const int w = model_find(model, "w")->edge;

    EXPECT(model_find(model, "v")->is_virtual);
    EXPECT(graph_branching(graph, v, TREE_TRANSLATION) == BRANCH_NEVER);
    EXPECT(graph_branching(graph, v, TREE_ROTATION) == BRANCH_UNCHOSEN);
    EXPECT(graph_branching(graph, w, TREE_TRANSLATION) == BRANCH_UNCHOSEN);
    EXPECT(graph_branching(graph, w, TREE_ROTATION) == BRANCH_NEVER);
    EXPECT(graph_branching(graph, model_find(model, "u")->edge, TREE_ROTATION) == BRANCH_UNCHOSEN);
    EXPECT_BRANCHES(model, TREE_ROTATION, "a b");
    model_free(model);
}

/* --- names --- */

static void coordinates_have_the_names_that_users_give(void)
{
    Model *model = model_of("scene planar\nbody m mass=1\nrevolute J ground m coord=phi\n"
                            "planarjoint P ground m coords=[a, b, c]\nfree f ground m");
    const Instance *owner = NULL;
    int index = -1;

    EXPECT(model_coordinate(model, "phi", &owner, &index));
    EXPECT(owner == model_find(model, "J") && index == 0);
    EXPECT(!model_coordinate(model, "J", &owner, &index));
    EXPECT(model_coordinate(model, "c", &owner, &index) && index == 2);
    EXPECT(model_coordinate(model, "m.theta", &owner, &index) && index == 2);
    EXPECT(owner->coord_kind[2] == COORDINATE_ANGLE && owner->coord_rotation[2]);
    EXPECT(model_coordinate(model, "f.y", &owner, &index) && index == 1);
    /* what the user wrote first still finds them */
    EXPECT_EXPRESSION(model, "J'", "phi'");
    EXPECT_EXPRESSION(model, "P.s2''", "b''");
    model_free(model);
}

static void the_rows_words_win_over_names(void)
{
    Model *model = model_of("z = 3\ny = 2\nbody m mass=1\nrevolute h ground m axis=y");

    EXPECT(expr_is(instance_value(model_find(model, "h"), "axis")->at[1], 1));
    model_free(model);
}

static void members_are_variables(void)
{
    Model *model = model_of("scene planar\nbody m mass=1\nrevolute h ground m\n"
                            "vsource E a 0 1\nmotor M h a 0 R=1 Kt=1\ndriver D h = t");
    static const char *const good[] = {"h",
                                       "h''",
                                       "m.x'",
                                       "m.ax",
                                       "h.fx",
                                       "h.effort",
                                       "E.i'",
                                       "a.v",
                                       "M.torque",
                                       "M.power",
                                       "D.effort",
                                       "energy.total",
                                       "count.shared.mass.add",
                                       "model.dof",
                                       "constraint.error"};
    static const char *const bad[] = {"h'''",       "m",          "m.z", "h.tx",
                                      "E.q",        "b.v",        "a.i", "m.ax'",
                                      "count.mass", "energy.all", "t",   "ground.x"};
    Diag diag;

    for (int i = 0; i < COUNT(good); i++) {
        size_t length = strcspn(good[i], "'");
        char *name = mem_text(good[i], length);

        EXPECT(model_check_variable(model, name, (int)(strlen(good[i]) - length), (Place){0},
                                    &diag) == OK);
        mem_free(name);
    }
    for (int i = 0; i < COUNT(bad); i++) {
        size_t length = strcspn(bad[i], "'");
        char *name = mem_text(bad[i], length);

        EXPECT(model_check_variable(model, name, (int)(strlen(bad[i]) - length), (Place){0},
                                    &diag) == E_NAME);
        mem_free(name);
    }
    model_free(model);
}

/* --- expressions --- */

static void numbers_are_exact_in_si(void)
{
    Model *model = model_new();

    EXPECT_EXPRESSION(model, "3 mm", "0.003");
    EXPECT_EXPRESSION(model, "1/3 + 1/6", "0.5");
    EXPECT_EXPRESSION(model, "2 [kN/m]", "2000");
    EXPECT_EXPRESSION(model, "0.1 + 0.2 - 0.3", "0");
    EXPECT_EXPRESSION(model, "180 deg - pi", "0");
    EXPECT_EXPRESSION(model, "-2^2", "-4");
    EXPECT_EXPRESSION(model, "1 < 2 && !(3 <= 2)", "1");
    EXPECT_EXPRESSION(model, "max(1, 5, 3)", "5");
    model_free(model);
}

static void laws_are_put_in_place(void)
{
    Model *model = model_of("k = 2\nf(x) = k*x^2\ng(x, y) = f(y) - x\nS(t) = t/2 - sin(t)\n"
                            "body m mass=1\nrevolute h ground m");

    EXPECT_EXPRESSION(model, "f(h')", "k*h'^2");
    EXPECT_EXPRESSION(model, "g(1, h)", "k*h^2 - 1");
    EXPECT_EXPRESSION(model, "S(t)", "0.5*t - sin(t)");
    EXPECT_EXPRESSION(model, "S(t)'", "0.5 - cos(t)");
    EXPECT_EXPRESSION(model, "f(h)'", "2*k*h'*h");
    EXPECT_EXPRESSION(model, "(h*h')'", "h'^2 + h*h''");
    model_free(model);
}

/* the value at a time of an expression of t alone */
static double at_time(const Model *model, const char *text, double t)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Expr e = NULL;
    Diag diag = {0};
    double value = (double)NAN;
    Expr time = expr_symbol(model_arena(model), "t", SYMBOL_TIME);
    Expr now = expr_real(model_arena(model), t);

    if (syntax_parse_expression(text, pool, &syntax, &diag) == OK &&
        model_expression(model, syntax, &e, &diag) == OK)
        value = model_number(model, expr_substitute(model_arena(model), e, &time, &now, 1));
    pool_free(pool);
    return value;
}

/* the source of SPICE: low until delay, up in rise, there for width, down in fall, again */
static double pulse_by_hand(double t, bool again)
{
    double x = t - 0.5;

    if (x < 0)
        return 1;
    if (again)
        x = fmod(x, 2.0);
    if (x < 0.1)
        return 1 + 4 * x / 0.1;
    if (x < 0.1 + 0.7)
        return 5;
    return x < 0.1 + 0.7 + 0.2 ? 5 - 4 * (x - 0.8) / 0.2 : 1;
}

static void pulses_repeat_and_polygons_join_points(void)
{
    Model *model = model_new();

    for (int i = 0; i < 460; i++) {
        double t = 0.013 * i;

        EXPECT_NEAR(at_time(model, "pulse(t, 1, 5, 0.5, 0.1, 0.2, 0.7, 2)", t),
                    pulse_by_hand(t, true), 1e-9);
        EXPECT_NEAR(at_time(model, "pulse(t, 1, 5, 0.5, 0.1, 0.2, 0.7)", t),
                    pulse_by_hand(t, false), 1e-9);
    }
    EXPECT_NEAR(at_time(model, "pulse(t, 0, 1, 1, 0, 0, 1)", 1.5), 1, 0);
    EXPECT_NEAR(at_time(model, "pulse(t, 0, 1, 1, 0, 0, 1)", 2.5), 0, 0);
    EXPECT_NEAR(at_time(model, "pwl(t, 1, 10, 2, 20, 4, 0, 4, 5)", 0), 10, 0);
    EXPECT_NEAR(at_time(model, "pwl(t, 1, 10, 2, 20, 4, 0, 4, 5)", 1.5), 15, 1e-12);
    EXPECT_NEAR(at_time(model, "pwl(t, 1, 10, 2, 20, 4, 0, 4, 5)", 3), 10, 1e-12);
    EXPECT_NEAR(at_time(model, "pwl(t, 1, 10, 2, 20, 4, 0, 4, 5)", 4.5), 5, 0);
    EXPECT_NEAR(at_time(model, "pwl(t, 0, 7)", 3), 7, 0);
    model_free(model);
}

static void what_a_run_knows_stays_a_name(void)
{
    Model *model = model_of("body m mass=1\nrevolute h ground m coord=phi\noutput p = h'^2");

    EXPECT_EXPRESSION(model, "p", "phi'^2");
    EXPECT_EXPRESSION(model, "run2.h'", "run2.phi'");
    EXPECT_EXPRESSION(model, "run2.p", "run2.phi'^2");
    EXPECT_EXPRESSION(model, "max(abs(h)) - 1", "max(abs(phi)) - 1");
    EXPECT_EXPRESSION(model, "mass( 2, 3 )", "mass(2,3)");
    EXPECT_EXPRESSION(model, "lambda(1) + 2*model.n", "lambda(1) + 2*model.n");
    model_free(model);
}

/* --- parameters --- */

static void parameters_follow_one_another(void)
{
    Model *model = model_of("k1 = 2\nk2 = 3*k1\nf(x) = x + k2\nk3 = f(1)\ntitle \"x\"");
    uint64_t revision = model_revision(model);

    EXPECT_NEAR(parameter(model, "k3"), 7, 0);
    EXPECT(apply(model, "k1 = 10") == OK);
    EXPECT_NEAR(parameter(model, "k2"), 30, 0);
    EXPECT_NEAR(parameter(model, "k3"), 31, 0);
    EXPECT(model_revision(model) == revision);
    EXPECT(apply(model, "k0 = 1; k1 = 2*k0") == OK);
    EXPECT_NEAR(parameter(model, "k3"), 7, 0);
    EXPECT(model_parameter_count(model) == 4);
    model_free(model);
}

static void values_alone_change_no_equation(void)
{
    Model *model = model_of("k = 1\nbody m mass=k\nrevolute h ground m");
    uint64_t revision = model_revision(model);

    EXPECT(apply(model, "init h = 1") == OK);
    EXPECT(apply(model, "k = 2") == OK);
    EXPECT(model_revision(model) == revision);
    EXPECT(apply(model, "output p = h") == OK);
    EXPECT(model_revision(model) == revision);
    EXPECT(apply(model, "gravity [0, 0, -k]") == OK);
    EXPECT(model_revision(model) > revision);
    revision = model_revision(model);
    EXPECT(model_undo(model, NULL) == OK);
    EXPECT(model_revision(model) > revision);
    model_free(model);
}

static void a_new_law_reaches_what_uses_it(void)
{
    Model *model = model_of("f(t) = 2*t\ng(t) = f(t) + 1\nvsource E a 0 g(t)\noutput p = f(t)");
    uint64_t revision = model_revision(model);

    EXPECT(apply(model, "f(t) = sin(t)") == OK);
    EXPECT(model_revision(model) > revision);
    EXPECT_EXPRESSION(model, "g(t)", "sin(t) + 1");
    EXPECT_EXPRESSION(model, "p", "sin(t)");
    EXPECT(instance_scalar(model_find(model, "E"), "value") ==
           expr_add(model_arena(model),
                    expr_sin(model_arena(model), expr_symbol(model_arena(model), "t", SYMBOL_TIME)),
                    expr_int(model_arena(model), 1)));
    model_free(model);
}

static void a_new_output_reaches_what_uses_it(void)
{
    Model *model = model_of("body m mass=1\nrevolute h ground m\noutput p = h\noutput q = 2*p\n"
                            "actuator a h torque=q");

    EXPECT(apply(model, "output p = h'") == OK);
    EXPECT_EXPRESSION(model, "q", "2*h'");
    EXPECT(apply(model, "output q = h, late = q + 1") == OK);
    EXPECT_EXPRESSION(model, "late", "h + 1");
    EXPECT(model_output_count(model) == 3);
    model_free(model);
}

/* --- trees --- */

static void one_list_sets_both_mechanical_trees(void)
{
    Model *model = model_of(crank);

    EXPECT(apply(model, "tree h8 h10 s11") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h8 h10 s11");
    EXPECT_BRANCHES(model, TREE_ROTATION, "h8 h10 s11");
    EXPECT(apply(model, "tree translation h8 h9 h10") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h8 h9 h10");
    EXPECT_BRANCHES(model, TREE_ROTATION, "h8 h10 s11");
    model_free(model);
}

static void what_is_open_is_completed_and_said(void)
{
    Model *model = model_of(crank);

    EXPECT(apply(model, "tree h8") == OK);
    EXPECT_TEXT(model_remarks(model),
                "completed with h9 (translation, rotation), h10 (translation), s11 (rotation)\n");
    EXPECT(apply(model, "tree absolute") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "m1 m2 m3");
    EXPECT(apply(model, "body m4 mass=1 inertia=0") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "m1 m2 m3 m4");
    EXPECT(apply(model, "tree joint") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h8 h9 h10 m4");
    model_free(model);
}

static void signs_change_only_trees_that_an_edge_enters(void)
{
    Model *model =
        model_of("body m1 mass=1\nbody m2 mass=1\nbody m3 mass=1\nrevolute h1 ground m1\n"
                 "revolute h2 m1 m2\nrevolute h3 m2 m3\nvirtual revolute v m1 m3");

    EXPECT(apply(model, "tree + v - h3") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h1 h2 h3");
    EXPECT_BRANCHES(model, TREE_ROTATION, "h1 h2 v");
    EXPECT(apply(model, "tree rotation - v") == OK);
    EXPECT_BRANCHES(model, TREE_ROTATION, "m3 h1 h2");
    EXPECT(apply(model, "cotree h1") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "m1 h2 h3");
    model_free(model);
}

static void electrical_names_set_the_electrical_tree(void)
{
    Model *model = model_of("scene planar\nbody m mass=1 inertia=1\nrevolute h ground m\n"
                            "vsource E a 0 1\nresistor R a b 1\nmotor M h b 0 R=1 L=1 Kt=1");

    EXPECT_BRANCHES(model, TREE_ELECTRICAL, "E R");
    EXPECT(apply(model, "tree E M") == OK);
    EXPECT_BRANCHES(model, TREE_ELECTRICAL, "E M");
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h");
    EXPECT(apply(model, "tree electrical + R - M") == OK);
    EXPECT_BRANCHES(model, TREE_ELECTRICAL, "E R");
    model_free(model);
}

static void choices_outlive_a_graph_that_grows(void)
{
    Model *model = model_of("scene planar\nbody m1 mass=1\nbody m2 mass=1\narm p m1 [1, 0]\n"
                            "tree m1\nrevolute h p m2\ntree + h - m2");

    EXPECT_BRANCHES(model, TREE_TRANSLATION, "m1 h");
    EXPECT(apply(model, "body m3 mass=1") == OK);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "m1 h m3");
    model_free(model);
}

/* --- starts, form, set, delete --- */

static void starts_replace_and_forget(void)
{
    Model *model = model_of("a = 2\nbody m mass=1\nrevolute h ground m coord=phi\n"
                            "capacitor C p 0 1 uF\ninit h = 30 deg, h' = 60 rpm\ninit C.v = a\n"
                            "guess m.vx = 1\ninit phi = 1");

    EXPECT(model_start_count(model) == 4);
    EXPECT_TEXT(model_start(model, 3)->name, "phi");
    EXPECT_NEAR(model_number(model, model_start(model, 0)->value), 2 * M_PI, 1e-12);
    EXPECT(model_start(model, 0)->primes == 1);
    EXPECT(model_start(model, 2)->is_guess);
    EXPECT(apply(model, "init none") == OK);
    EXPECT(model_start_count(model) == 1);
    EXPECT(apply(model, "guess none") == OK);
    EXPECT(model_start_count(model) == 0);
    model_free(model);
}

static void forms_name_coordinates(void)
{
    Model *model = model_of("body m mass=1\nrevolute h ground m coord=phi\n"
                            "form embedded independent=[h]");
    const char *const *names = NULL;
    int count = 0;

    EXPECT(model_form(model, &names, &count) == FORM_EMBEDDED);
    EXPECT(count == 1);
    EXPECT_TEXT(names[0], "phi");
    EXPECT(apply(model, "form augmented") == OK);
    EXPECT(model_form(model, &names, &count) == FORM_AUGMENTED && count == 0);
    model_free(model);
}

static void set_changes_a_value_in_place(void)
{
    Model *model = model_of("k = 3\nbody m mass=1\nrevolute h ground m\nspring s h k=5");
    const int edge = model_find(model, "s")->edge;

    EXPECT(apply(model, "set s.k = 2*k") == OK);
    EXPECT_NEAR(model_number(model, instance_scalar(model_find(model, "s"), "k")), 6, 0);
    EXPECT(apply(model, "set m.mass = 7, h.axis = x") == OK);
    EXPECT(expr_is(instance_value(model_find(model, "h"), "axis")->at[0], 1));
    EXPECT(model_find(model, "s")->edge == edge);
    model_free(model);
}

static void deleting_tells_what_falls_away(void)
{
    Model *model = model_of(crank);

    EXPECT(apply(model, "tree h8 h10 s11\ninit h8 = 1, s11 = 2\nform embedded independent=[s11]") ==
           OK);
    EXPECT(apply(model, "delete s11") == OK);
    EXPECT_TEXT(model_remarks(model), "s11 is no longer among the edges chosen for trees\n"
                                      "forgot init s11 = 2\n"
                                      "s11 is no longer an independent coordinate\n");
    EXPECT(model_find(model, "s11") == NULL);
    EXPECT(model_find(model, "F12")->number == model_count(model) - 1);
    EXPECT(model_start_count(model) == 1);
    EXPECT_BRANCHES(model, TREE_TRANSLATION, "h8 h9 h10");
    EXPECT(apply(model, "revolute s11 ground m3") == OK);
    model_free(model);
}

static void drivers_name_what_supplies_them(void)
{
    Model *model = model_of("scene planar\nbody m mass=1\nrevolute h ground m coord=phi\n"
                            "vsource V a 0 0\nresistor R a 0 1\ndriver D phi = 2*t by=V\n"
                            "driver E m.x = t by=phi");
    const Instance *D = model_find(model, "D");

    EXPECT(D->joint == model_find(model, "h")->number && D->on_angle);
    EXPECT(D->by == model_find(model, "V")->number && D->by_coordinate == -1);
    EXPECT(model_find(model, "E")->joint == model_find(model, "m")->number);
    EXPECT(model_find(model, "E")->by == model_find(model, "h")->number);
    EXPECT(model_find(model, "E")->by_coordinate == 0);
    model_free(model);
}

static void names_can_be_listed(void)
{
    Model *model = model_of("k = 1\nbody m mass=1\nresistor R p 0 1");
    Text all = {0};

    for (int i = 0; model_name(model, i) != NULL; i++)
        text_addf(&all, "%s ", model_name(model, i));
    EXPECT_TEXT(all.at, "k m m.x m.y m.z m.q0 m.q1 m.q2 m.q3 R p ");
    text_free(&all);
    model_free(model);
}

int main(void)
{
    RUN(parts_make_frames_and_edges);
    RUN(terminals_spring_into_being);
    RUN(virtual_joints_enter_where_they_have_freedom);
    RUN(coordinates_have_the_names_that_users_give);
    RUN(the_rows_words_win_over_names);
    RUN(members_are_variables);
    RUN(numbers_are_exact_in_si);
    RUN(laws_are_put_in_place);
    RUN(pulses_repeat_and_polygons_join_points);
    RUN(what_a_run_knows_stays_a_name);
    RUN(parameters_follow_one_another);
    RUN(values_alone_change_no_equation);
    RUN(a_new_law_reaches_what_uses_it);
    RUN(a_new_output_reaches_what_uses_it);
    RUN(one_list_sets_both_mechanical_trees);
    RUN(what_is_open_is_completed_and_said);
    RUN(signs_change_only_trees_that_an_edge_enters);
    RUN(electrical_names_set_the_electrical_tree);
    RUN(choices_outlive_a_graph_that_grows);
    RUN(starts_replace_and_forget);
    RUN(forms_name_coordinates);
    RUN(set_changes_a_value_in_place);
    RUN(deleting_tells_what_falls_away);
    RUN(drivers_name_what_supplies_them);
    RUN(names_can_be_listed);
    return test_end();
}

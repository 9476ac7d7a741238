/* test_component.c: laws that every row obeys, and what single rows say */
#include "component/component.h"
#include "test_model.h"

/* --- laws over all rows --- */

static void every_row_explains_itself(void)
{
    const Component *row;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        EXPECT(component_find(row->name) == row);
        EXPECT(row->brief != NULL && strlen(row->brief) > 3);
        EXPECT(row->brief != NULL && row->brief[strlen(row->brief) - 1] != '.');
        EXPECT(row->help != NULL && strlen(row->help) > 20);
        EXPECT(row->example != NULL && strstr(row->example, row->name) != NULL);
        EXPECT(row->see != NULL && row->see[0] != '\0');
        for (int j = 0; j < row->param_count; j++)
            EXPECT(row->params[j].meaning[0] != '\0' &&
                   component_param(row, row->params[j].name) == j);
    }
    EXPECT(component_find("gearbox") == NULL);
}

static void expect_unit(const char *unit)
{
    Unit parsed;
    size_t fault = 0;
    const char *bar = unit != NULL ? strchr(unit, '|') : NULL;

    if (unit == NULL)
        return;
    if (bar != NULL)
        EXPECT(unit_parse(bar + 1, strlen(bar + 1), &parsed, &fault));
    EXPECT(unit_parse(unit, bar != NULL ? (size_t)(bar - unit) : strlen(unit), &parsed, &fault));
}

static void every_unit_is_one(void)
{
    const Component *row;
    const Member *member;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        for (int j = 0; j < row->param_count; j++)
            expect_unit(row->params[j].unit);
        for (int planar = 0; planar < 2; planar++)
            for (int j = 0; (member = component_member(row, planar == 1, j)) != NULL; j++)
                expect_unit(member->unit);
    }
}

static void every_example_builds(void)
{
    const Component *row;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        Model *model = model_of(row->example);
        const Tree *trees[TREE_KINDS];
        Diag diag = {0};
        bool found = false;

        for (int j = 0; j < model_count(model); j++)
            found = found || strcmp(model_instance(model, j)->row->name, row->name) == 0;
        EXPECT(found);
        EXPECT(model_trees(model, trees, &diag) == OK);
        model_free(model);
    }
}

/* theory 2: coordinates of each half, spatial and planar */
static void joints_have_the_freedoms_of_the_table(void)
{
    static const struct {
        const char *name;
        int shifts, turns, planar_shifts, planar_turns;
        bool quaternion;
    } table[] = {
        {"body", 3, 0, 2, 1, true},      {"arm", 0, 0, 0, 0, false},
        {"revolute", 0, 1, 0, 1, false}, {"prismatic", 1, 0, 1, 0, false},
        {"weld", 0, 0, 0, 0, false},     {"planarjoint", 2, 1, 2, 1, false},
        {"free", 3, 0, 2, 1, true},
    };

    for (int i = 0; i < COUNT(table); i++)
        for (int planar = 0; planar < 2; planar++) {
            Text text = {0};
            Model *model;
            const Instance *part;
            Steps steps;
            int count;

            text_addf(&text, "%sbody a mass=1\nbody b mass=1\n", planar ? "scene planar\n" : "");
            if (strcmp(table[i].name, "body") == 0)
                text_add(&text, "body x mass=2");
            else
                text_addf(&text, "%s x a %s%s", table[i].name,
                          strcmp(table[i].name, "arm") == 0 ? "" : "b",
                          strcmp(table[i].name, "prismatic") == 0 ? " axis=x" : "");
            model = model_of(text.at);
            part = model_find(model, "x");
            part->row->steps(part, model_arena(model), planar == 1, &steps);
            (void)instance_coords(part, planar == 1, &count);
            EXPECT(steps.shift_count == (planar ? table[i].planar_shifts : table[i].shifts));
            EXPECT(steps.turn_count == (planar ? table[i].planar_turns : table[i].turns));
            EXPECT(steps.quaternion == (table[i].quaternion && !planar));
            EXPECT(count == part->coord_count);
            EXPECT(count == steps.shift_count + steps.turn_count + (steps.quaternion ? 4 : 0));
            model_free(model);
            text_free(&text);
        }
}

/* --- axes --- */

static double number(const Model *model, Expr e)
{
    return model_number(model, e);
}

static void expect_triad(const Model *model, const Expr u[3])
{
    Expr n[2][3];
    double m[3][3];

    axis_complement(model_arena(model), u, n[0], n[1]);
    for (int i = 0; i < 3; i++) {
        m[0][i] = number(model, u[i]);
        m[1][i] = number(model, n[0][i]);
        m[2][i] = number(model, n[1][i]);
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            EXPECT_NEAR(m[a][0] * m[b][0] + m[a][1] * m[b][1] + m[a][2] * m[b][2], a == b, 1e-14);
    /* right-handed: u x n1 = n2 */
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        EXPECT_NEAR(m[0][j] * m[1][k] - m[0][k] * m[1][j], m[2][i], 1e-14);
    }
}

static void complements_make_right_handed_triads(void)
{
    static const char *const axes[] = {
        "x",  "y",         "z",         "-x",         "-y",
        "-z", "[1, 1, 0]", "[1, 2, 3]", "[0, -1, 2]", "[cos(a), sin(a), 0]"};

    for (int i = 0; i < COUNT(axes); i++) {
        Text text = {0};
        Model *model;

        text_addf(&text, "a = 0.3\nbody b mass=1\nrevolute h ground b axis=%s", axes[i]);
        model = model_of(text.at);
        expect_triad(model, instance_value(model_find(model, "h"), "axis")->at);
        model_free(model);
        text_free(&text);
    }
}

static void axes_are_exact_unit_vectors(void)
{
    Model *model = model_of("body b mass=1\nrevolute h ground b axis=[3, 0, -4]\n"
                            "a = 0.7\nrevolute k ground b axis=[sin(a), 0, cos(a)]\n"
                            "revolute d ground b");
    const Expr *u = instance_value(model_find(model, "h"), "axis")->at;
    const Expr *w = instance_value(model_find(model, "k"), "axis")->at;
    int64_t num = 0;
    int64_t den = 0;

    EXPECT(expr_rational_parts(u[0], &num, &den) && num == 3 && den == 5);
    EXPECT(expr_rational_parts(u[2], &num, &den) && num == -4 && den == 5);
    EXPECT_NEAR(number(model, w[0]), sin(0.7), 1e-15);
    EXPECT(expr_is(instance_value(model_find(model, "d"), "axis")->at[2], 1));
    model_free(model);
}

static void rotations_turn_about_z_then_the_new_x(void)
{
    Model *model = model_of("a = 0.4\nbody b mass=1\narm p b [1, 2, 3] rotation=z(90 deg)*x(a)");
    const Expr *R = instance_value(model_find(model, "p"), "rotation")->at;
    double c = cos(0.4);
    double s = sin(0.4);
    const double wanted[] = {0, -c, s, 1, 0, 0, 0, s, c};

    for (int i = 0; i < 9; i++)
        EXPECT_NEAR(number(model, R[i]), wanted[i], 1e-15);
    EXPECT(expr_is_zero(R[0]) && expr_is(R[3], 1));
    model_free(model);
}

/* --- efforts and relations --- */

static Expr symbol(const Model *model, const char *name)
{
    return expr_symbol(model_arena(model), name, SYMBOL_STATE);
}

static void expect_expr(Expr got, const char *wanted)
{
    char *text = expr_text(got);

    EXPECT_TEXT(text, wanted);
    mem_free(text);
}

static Motion1 motion_of(const Model *model)
{
    return (Motion1){symbol(model, "x"), symbol(model, "w"), symbol(model, "v"),
                     symbol(model, "i")};
}

static double value_at(const Model *model, Expr e, double x, double w, double v, double i)
{
    Expr symbols[] = {symbol(model, "x"), symbol(model, "w"), symbol(model, "v"),
                      symbol(model, "i")};
    Expr values[] = {expr_real(model_arena(model), x), expr_real(model_arena(model), w),
                     expr_real(model_arena(model), v), expr_real(model_arena(model), i)};

    return model_number(model, expr_substitute(model_arena(model), e, symbols, values, 4));
}

static void springs_push_back(void)
{
    Model *model = model_of("scene planar\nbody b mass=1\nprismatic s ground b axis=x\n"
                            "spring k1 ground b k=10 length=2 d=3\nspring k2 s k=10 rest=1\n"
                            "damper d1 s d=4\nactuator a1 ground b force=2*t");
    Motion1 motion = motion_of(model);
    const Instance *k1 = model_find(model, "k1");
    const Instance *k2 = model_find(model, "k2");
    Expr (*effort)(const Instance *, Arena *, const Motion1 *) = k1->row->effort;
    Arena *arena = model_arena(model);

    EXPECT_NEAR(value_at(model, effort(k1, arena, &motion), 5, 7, 0, 0), -(10 * 3 + 3 * 7), 1e-12);
    EXPECT_NEAR(value_at(model, k1->row->potential(k1, arena, &motion), 5, 7, 0, 0), 45, 1e-12);
    EXPECT_NEAR(value_at(model, effort(k2, arena, &motion), 5, 7, 0, 0), -40, 1e-12);
    EXPECT(k1->joint < 0 && k2->joint == model_find(model, "s")->number);
    EXPECT(graph_edge(model_graph(model), k2->edge)->head == model_find(model, "b")->head);
    EXPECT_NEAR(
        value_at(model,
                 model_find(model, "d1")->row->effort(model_find(model, "d1"), arena, &motion), 0,
                 2, 0, 0),
        -8, 1e-12);
    expect_expr(model_find(model, "a1")->row->effort(model_find(model, "a1"), arena, &motion),
                "2*t");
    model_free(model);
}

static Relation relation_of(const Model *model, const char *name)
{
    const Instance *part = model_find(model, name);
    Motion1 motion = motion_of(model);
    Relation relation;

    part->row->relation(part, model_arena(model), 0, &motion, &relation);
    return relation;
}

static void motors_balance_their_power(void)
{
    Model *model = model_of("scene planar\nbody b mass=1\nrevolute h ground b\n"
                            "motor M h a 0 R=2 L=0.1 Kt=0.5 J=0.01 B=0.02 ratio=10\n"
                            "motor N h a 0 R=2 Kv=0.5\nmotor O h a 0 R=0 Kt=1");
    const Instance *part = model_find(model, "M");
    Motion1 motion = motion_of(model);
    Relation relation = relation_of(model, "M");
    double i = 3;
    double w = 5;
    double effort =
        value_at(model, part->row->effort(part, model_arena(model), &motion), 0, w, 0, i);
    double back = value_at(model, relation.rest, 0, w, 0, i) - 2 * i;

    EXPECT(relation.kind == RELATION_INDUCTIVE);
    EXPECT_NEAR(back, 0.5 * 10 * w, 1e-12);
    /* back-emf times current = power to the joint + friction (20 N*m*s/rad there is 0.02*10^2) */
    EXPECT_NEAR(back * i, effort * w + 0.02 * 100 * w * w, 1e-12);
    EXPECT_NEAR(model_number(model, part->row->rotor(part, model_arena(model))), 1.0, 1e-12);
    EXPECT(relation_of(model, "N").kind == RELATION_RESISTIVE);
    EXPECT(relation_of(model, "O").kind == RELATION_ACROSS);
    EXPECT(part->edge >= 0 && part->scalar_count == 1);
    EXPECT(graph_branching(model_graph(model), part->edge, TREE_ROTATION) == BRANCH_NEVER);
    model_free(model);
}

static void storage_keeps_its_charge_and_flux(void)
{
    Model *model = model_of("capacitor C1 a 0 2 + C1.v + t\ninductor L1 a 0 3*L1.i\n"
                            "capacitor C2 a 0 2");
    Relation C = relation_of(model, "C1");
    Relation L = relation_of(model, "L1");

    EXPECT(C.kind == RELATION_CAPACITIVE && L.kind == RELATION_INDUCTIVE);
    expect_expr(C.content, "v*(t + C1.v + 2)");
    expect_expr(L.content, "3*i*L1.i");
    expect_expr(relation_of(model, "C2").content, "2*v");
    expect_expr(relation_of(model, "C2").stored, "v^2");
    EXPECT(expr_is_zero(relation_of(model, "C2").rest));
    model_free(model);
}

static void sources_are_what_they_say(void)
{
    Model *model = model_of("vsource E a 0 10 V + t\nisource I a 0 1 mA\nresistor R a 0 2 kohm");

    expect_expr(relation_of(model, "E").value, "t + 10");
    EXPECT(relation_of(model, "E").kind == RELATION_ACROSS);
    EXPECT(relation_of(model, "I").kind == RELATION_THROUGH);
    EXPECT_NEAR(model_number(model, relation_of(model, "I").value), 1e-3, 1e-18);
    EXPECT_NEAR(model_number(model, relation_of(model, "R").value), 2000, 0);
    model_free(model);
}

static void wrenches_and_inertias_come_from_the_row(void)
{
    Model *model = model_of("body b mass=2 inertia=[1, 2, 2.5, 0.1, 0.2, 0.3]\n"
                            "force F b [1, t, 0] in=body\ntorque T b [0, 0, 4]");
    const Instance *b = model_find(model, "b");
    const Instance *F = model_find(model, "F");
    const Instance *T = model_find(model, "T");
    Expr mass;
    Expr I[6];
    Expr f[3];
    Expr m[3];
    bool in_body = false;

    b->row->inertia(b, model_arena(model), false, &mass, I);
    EXPECT(expr_is(mass, 2));
    EXPECT_NEAR(model_number(model, I[5]), 0.3, 0);
    F->row->wrench(F, model_arena(model), false, f, m, &in_body);
    EXPECT(in_body && expr_is(f[0], 1) && expr_is_zero(m[2]));
    T->row->wrench(T, model_arena(model), false, f, m, &in_body);
    EXPECT(!in_body && expr_is(m[2], 4) && expr_is_zero(f[0]));
    model_free(model);
}

int main(void)
{
    RUN(every_row_explains_itself);
    RUN(every_unit_is_one);
    RUN(every_example_builds);
    RUN(joints_have_the_freedoms_of_the_table);
    RUN(complements_make_right_handed_triads);
    RUN(axes_are_exact_unit_vectors);
    RUN(rotations_turn_about_z_then_the_new_x);
    RUN(springs_push_back);
    RUN(motors_balance_their_power);
    RUN(storage_keeps_its_charge_and_flux);
    RUN(sources_are_what_they_say);
    RUN(wrenches_and_inertias_come_from_the_row);
    return test_end();
}

/* test_session.c: life of a session, statements, building, starts, undo, long chains */
#include "session_kit.h"

#include "algebra/matrix3.h"
#include "base/memory.h"
#include "base/text.h"

static void a_statement_is_handed_out_in_parts(void)
{
    const char *line = "simulate 10 every=0.01 method=bdf; print h8 at 0.5  # and more";
    ct_statement *statement = NULL;
    const ct_expression *value = NULL;
    ct_error error;
    ct_cursor cursor = {.text = line, .line = 3};
    char *text;

    EXPECT(ct_parse(&cursor, false, &statement, &error) == CT_OK);
    EXPECT_TEXT(ct_verb(statement), "simulate");
    EXPECT_TEXT(ct_statement_text(statement), "simulate 10 every=0.01 method=bdf");
    EXPECT(ct_operand_count(statement) == 1 && ct_key_count(statement) == 2);
    EXPECT_TEXT(ct_key(statement, 1, &value), "method");
    EXPECT_TEXT(ct_expression_word(value), "bdf");
    EXPECT(ct_key(statement, 2, NULL) == NULL && ct_operand(statement, 1) == NULL);
    EXPECT(ct_key_value(statement, "rtol") == NULL);
    text = ct_expression_text(ct_key_value(statement, "every"));
    EXPECT_TEXT(text, "0.01");
    ct_free(text);
    ct_statement_free(statement);

    EXPECT(ct_parse(&cursor, false, &statement, &error) == CT_OK);
    EXPECT_TEXT(ct_verb(statement), "print");
    EXPECT(ct_at(statement) != NULL && ct_versus(statement) == NULL);
    EXPECT(ct_error_at(statement, ct_at(statement), &error, "no %s", "good") == CT_FAILED);
    EXPECT(error.line == 3 && error.column == 48);
    EXPECT_TEXT(error.message, "no good");
    ct_statement_free(statement);
    EXPECT(cursor.next == strlen(line));
}

static void trailing_words_have_their_own_calls(void)
{
    static const char *const lines[] = {"plot h8 vs s11 > \"a.png\"",
                                        "expect h8 ~ 1 within 1e-3 at 2",
                                        "show mass as latex >> \"b.tex\"", "tree + vh16 - h14"};
    ct_statement *statement = NULL;
    ct_error error;
    bool append = true;

    for (int i = 0; i < 4; i++) {
        EXPECT(ct_parse(&(ct_cursor){.text = lines[i], .line = 1}, false, &statement, &error) ==
               CT_OK);
        if (i == 0) {
            EXPECT_TEXT(ct_expression_word(ct_versus(statement)), "s11");
            EXPECT_TEXT(ct_redirect(statement, &append), "a.png");
            EXPECT(!append);
        }
        EXPECT((ct_near(statement) != NULL) == (i == 1));
        EXPECT((ct_within(statement) != NULL) == (i == 1));
        if (i == 2) {
            EXPECT_TEXT(ct_as(statement), "latex");
            EXPECT_TEXT(ct_redirect(statement, &append), "b.tex");
            EXPECT(append);
        }
        EXPECT(ct_operand_sign(statement, 0) == (i == 3 ? '+' : 0));
        EXPECT(ct_operand_sign(statement, 1) == (i == 3 ? '-' : 0));
        ct_statement_free(statement);
    }
}

static void a_bad_line_is_refused_at_its_place(void)
{
    ct_statement *statement = NULL;
    ct_error error;

    EXPECT(ct_parse(&(ct_cursor){.text = "plto h8", .line = 7}, false, &statement, &error) ==
           CT_FAILED);
    EXPECT(error.line == 7 && error.column == 1 && error.width == 4);
    EXPECT_HOLDS(error.hint, "plot");
}

static void an_empty_line_is_an_empty_statement(void)
{
    ct_statement *statement = NULL;
    ct_error error;
    Kit kit = kit_new();

    EXPECT(ct_parse(&(ct_cursor){.text = "  # only words", .line = 1}, false, &statement, &error) ==
           CT_OK);
    EXPECT(ct_statement_is_empty(statement));
    EXPECT_TEXT(ct_verb(statement), "");
    EXPECT(ct_apply(kit.session, statement, &error) == CT_OK);
    ct_statement_free(statement);
    kit_free(&kit);
}

static void apply_leaves_looking_and_running_to_the_caller(void)
{
    static const char *const lines[] = {"show mass", "simulate 1", "tree",
                                        "print 1",   "undo",       "help"};
    Kit kit = kit_new();

    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        ct_statement *statement = NULL;
        EXPECT(ct_parse(&(ct_cursor){.text = lines[i], .line = 1}, false, &statement, &kit.error) ==
               CT_OK);
        EXPECT(ct_apply(kit.session, statement, &kit.error) == CT_NOT_MINE);
        ct_statement_free(statement);
    }
    kit_free(&kit);
}

static void a_statement_that_fails_changes_nothing(void)
{
    Kit kit = kit_new();
    char *before, *after;

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE);
    before = ct_save(kit.session);
    EXPECT(kit_do(&kit, "body m1 mass=3") == CT_FAILED);
    EXPECT(kit_do(&kit, "tree h8 h9 h10 s11") == CT_FAILED);
    EXPECT(kit_do(&kit, "revolute h12 r4 nowhere") == CT_FAILED);
    after = ct_save(kit.session);
    EXPECT_TEXT(after, before);
    ct_free(before);
    ct_free(after);
    EXPECT_DONE(&kit, "show constraints");
    kit_free(&kit);
}

static void save_rebuilds_the_model(void)
{
    Kit one = kit_new(), two = kit_new();
    char *first, *second;

    EXPECT_DONE(&one, SLIDER_CRANK TWO_TREES CRANK_START "title \"crank\"\n");
    first = ct_save(one.session);
    EXPECT_DONE(&two, first);
    second = ct_save(two.session);
    EXPECT_TEXT(second, first);
    EXPECT_TEXT(ct_title(two.session), "crank");
    EXPECT_NEAR(kit_value(&two, "h10"), kit_value(&one, "h10"), 0);
    ct_free(first);
    ct_free(second);
    kit_free(&one);
    kit_free(&two);
}

static void undo_and_redo_name_what_they_move_over(void)
{
    Kit kit = kit_new();

    EXPECT(ct_undo(kit.session, &kit.error) == CT_FAILED);
    EXPECT(kit.error.message[0] != '\0');
    EXPECT_DONE(&kit, SLIDER_CRANK);
    EXPECT_DONE(&kit, "undo");
    EXPECT_HOLDS(ct_remarks(kit.session), "force F12 m3");
    EXPECT(kit_do(&kit, "info F12") == CT_FAILED);
    EXPECT_DONE(&kit, "redo");
    EXPECT_HOLDS(ct_remarks(kit.session), "force F12 m3");
    EXPECT_DONE(&kit, "info F12");
    EXPECT(ct_redo(kit.session, &kit.error) == CT_FAILED);
    kit_free(&kit);
}

static void clear_starts_anew(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 0.1\n");
    EXPECT(ct_run_count(kit.session) == 1);
    EXPECT_DONE(&kit, "clear");
    EXPECT(ct_run_count(kit.session) == 0);
    EXPECT(kit_do(&kit, "info m") == CT_FAILED);
    EXPECT_DONE(&kit, PENDULUM "simulate 0.1\n");
    kit_free(&kit);
}

static void the_model_is_changed_until_it_runs(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM);
    EXPECT(ct_is_changed(kit.session));
    EXPECT_DONE(&kit, "simulate 0.1");
    EXPECT(!ct_is_changed(kit.session));
    EXPECT_DONE(&kit, "output o = 2*h");
    EXPECT(!ct_is_changed(kit.session));
    EXPECT_DONE(&kit, "L = 2");
    EXPECT(ct_is_changed(kit.session));
    kit_free(&kit);
}

static void trees_tell_what_they_cost(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE);
    EXPECT_HOLDS(ct_remarks(kit.session), "3 coordinates, 2 constraints, 1 degree of freedom");
    EXPECT_DONE(&kit, TWO_TREES);
    EXPECT_HOLDS(ct_remarks(kit.session), "2 coordinates, 1 constraint, 1 degree of freedom");
    kit_free(&kit);
}

static void two_sessions_know_nothing_of_each_other(void)
{
    Kit one = kit_new(), two = kit_new();

    EXPECT_DONE(&one, PENDULUM);
    EXPECT_DONE(&two, SLIDER_CRANK ONE_TREE CRANK_START);
    EXPECT_DONE(&one, "simulate 0.1");
    EXPECT_DONE(&two, "simulate 0.1");
    EXPECT(kit_do(&one, "info h8") == CT_FAILED);
    EXPECT(kit_do(&two, "info h") == CT_FAILED);
    EXPECT_NEAR(kit_value(&one, "model.n"), 1, 0);
    EXPECT_NEAR(kit_value(&two, "model.n"), 3, 0);
    kit_free(&one);
    EXPECT_NEAR(kit_value(&two, "h8 at 0"), M_PI / 3, 1e-12);
    kit_free(&two);
}

static void a_session_needs_no_hooks(void)
{
    ct_session *session = ct_session_new(NULL);

    EXPECT(ct_version()[0] != '\0');
    EXPECT_TEXT(ct_title(session), "");
    EXPECT_TEXT(ct_remarks(session), "");
    ct_session_hooks(session, NULL);
    ct_session_free(session);
    ct_session_free(NULL);
}

/* whatever comes after whatever: every statement is done or refused, and the session goes on */
static void a_session_bears_any_order_of_statements(void)
{
    static const char *const lines[] = {
        "tree h8 h10 s11",
        "tree translation h8 h9 h10",
        "tree rotation h8 h10 s11",
        "tree absolute",
        "tree joint",
        "cotree h8",
        "form embedded",
        "form embedded independent=[h8]",
        "form augmented",
        "init h8 = 60 deg, h8' = 12",
        "init none",
        "guess h10 = 2.85",
        "L5 = 0.1",
        "L5 = 5",
        "L5 = 0.12",
        "set m1.mass = 3",
        "delete F12",
        "delete m2",
        "delete h9",
        "undo",
        "undo",
        "redo",
        "body m9 mass=1 inertia=0.1",
        "arm r9 m9 [1, 0]",
        "revolute h19 m3 r9",
        "driver D1 h8 = 2*t",
        "output o1 = h9.fx + mass(1,1)",
        "resistor R1 a 0 10",
        "vsource E1 a 0 sin(t)",
        "motor M1 h8 a 0 R=1 Kt=0.1",
        "assemble",
        "simulate 0.02 every=0.01 rtol=1e-4 atol=1e-4",
        "simulate 0.02 method=bdf",
        "resume 0.01",
        "kinematics 0.02 every=0.01",
        "inverse 0.02 every=0.01",
        "print h8, h9.fx, o1, run1.h8, max(h8), model.n, count.total.add",
        "print h8 at 0.01",
        "table h8 (h8 - run1.h8) every=0.005",
        "table",
        "expect h8 ~ 1 within 1 at 0.01",
        "export csv",
        "export csv h8 run2.s11 o1",
        "export c",
        "export latex",
        "show graph",
        "show equations",
        "show constraints acceleration",
        "show mass as latex",
        "show o1",
        "show h10.fx",
        "show program",
        "show run",
        "count",
        "count trees",
        "check",
        "info h8",
        "draw",
        "tree",
    };
    uint64_t state = 2;

    for (int session = 0; session < 12; session++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, SLIDER_CRANK);
        for (int i = 0; i < 60; i++) {
            const char *line = lines[test_random(&state) % (sizeof lines / sizeof lines[0])];
            const ct_status status = kit_do(&kit, line);

            if (status != CT_OK)
                EXPECT(kit.error.message[0] != '\0' && kit.error.status == status);
        }
        EXPECT_DONE(&kit, "clear\n" PENDULUM "simulate 0.1");
        kit_free(&kit);
    }
}

/* how often equations were formed */
static void count_formed(void *context, const char *phase, double fraction)
{
    (void)fraction;
    *(int *)context += strcmp(phase, "formulating") == 0;
}

static void undo_and_redo_of_an_edit_form_no_equations(void)
{
    static const char run[] = "simulate 0.01";
    int formed = 0;
    const ct_hooks hooks = {.columns = 80, .context = &formed, .progress = count_formed};
    Kit kit = {.session = ct_session_new(&hooks)};
    Text chain = {0};
    int once;
    double before, behind;

    text_add(&chain,
             "gravity [0, -9.81, 0]\nbody b0 mass=1 inertia=[1, 1, 1]\nrevolute j0 ground b0\n");
    for (int i = 1; i < 20; i++)
        text_addf(&chain,
                  "body b%d mass=1.5 inertia=[1, 1, 1]\narm t%d b%d [1.5, 0, 0]\nrevolute j%d t%d "
                  "b%d\n",
                  i, i, i - 1, i, i, i);
    EXPECT_DONE(&kit, chain.at);
    text_free(&chain);
    EXPECT_DONE(&kit, run);
    before = kit_value(&kit, "b19.y");
    once = formed;
    EXPECT(once > 0);
    EXPECT_DONE(&kit, "delete j19");
    EXPECT_DONE(&kit, "prismatic j19 t19 b19 axis=y");
    EXPECT_DONE(&kit, "init j19' = 3");
    EXPECT_DONE(&kit, run);
    behind = kit_value(&kit, "b19.y");
    EXPECT(formed > once && fabs(behind - before) > 1e-9);
    once = formed;
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++)
            EXPECT(ct_undo(kit.session, &kit.error) == CT_OK);
        EXPECT_DONE(&kit, run);
        EXPECT_NEAR(kit_value(&kit, "b19.y"), before, 0);
        for (int k = 0; k < 3; k++)
            EXPECT(ct_redo(kit.session, &kit.error) == CT_OK);
        EXPECT_DONE(&kit, run);
        EXPECT_NEAR(kit_value(&kit, "b19.y"), behind, 0);
    }
    EXPECT(formed == once);
    /* a number of a part changes none either */
    EXPECT_DONE(&kit, "set b7.mass = 2.5");
    EXPECT_DONE(&kit, run);
    EXPECT(formed == once);
    kit_free(&kit);
}

/* by rotations one after the other (Rodrigues); gravity is along none of the axes */
static void what_hangs_beyond_many_turns_is_where_they_bring_it(void)
{
    enum { LINKS = 30 };
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0.36, 0.48, 0.8}};
    static const double gravity[3] = {1, -2, -9}, down[3] = {0, 0, -1};
    double R[9], at[3] = {0}, potential = 0;
    Kit kit = kit_new();
    Text text = {0};

    matrix3_one(R);
    text_add(&text, "gravity [1, -2, -9]\n");
    for (int i = 0; i < LINKS; i++) {
        const double *axis = axes[i % 3];
        double turn[9], half[3];

        text_addf(&text, "body b%d mass=2 inertia=[1, 2, 3]; arm p%d b%d [0, 0, 1]; ", i, i, i);
        text_addf(&text, "arm q%d b%d [0, 0, -1]; revolute h%d ", i, i, i);
        text_addf(&text, i == 0 ? "ground " : "q%d ", i - 1);
        text_addf(&text, "p%d axis=[%g, %g, %g]; init h%d = %d/10\n", i, axis[0], axis[1], axis[2],
                  i, i % 7 - 3);
        matrix3_turn(axis, (i % 7 - 3) / 10.0, turn);
        matrix3_times(R, turn, R);
        matrix3_apply(R, down, half);
        for (int k = 0; k < 3; k++) {
            potential -= 2 * gravity[k] * (at[k] + half[k]);
            at[k] += 2 * half[k];
        }
    }
    EXPECT_DONE(&kit, text.at);
    EXPECT_DONE(&kit, "assemble");
    EXPECT_NEAR(kit_value(&kit, "q29.x at 0"), at[0], 1e-12);
    EXPECT_NEAR(kit_value(&kit, "q29.y at 0"), at[1], 1e-12);
    EXPECT_NEAR(kit_value(&kit, "q29.z at 0"), at[2], 1e-12);
    EXPECT_NEAR(kit_value(&kit, "energy.potential at 0"), potential, 1e-9);
    text_free(&text);
    kit_free(&kit);
}

static void angular_speeds_of_joints_can_be_given(void)
{
    static const char *const trees[] = {"tree joint\n", "tree absolute\n",
                                        "tree translation b\ntree rotation j\n"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[0.1, 0.2, 0.3]\n"
                      "arm g ground [0.3, 0, 0] rotation=y(0.4)\n"
                      "arm p b [0.1, 0.2, 0.4] rotation=x(0.5)*z(1.1)\n"
                      "spherical j p g\n"
                      "init j.q0 = 0.8, j.q1 = 0.6, j.q2 = 0, j.q3 = 0\n"
                      "init j.Wx = 1, j.Wy = -2, j.Wz = 3\n");
    for (int i = 0; i < 3; i++) {
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "assemble\n");
        EXPECT_NEAR(kit_value(&kit, "j.Wx"), 1, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "j.Wy"), -2, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "j.Wz"), 3, 1e-9);
        /* the head is g, which rests: its tail turns the other way round */
        EXPECT_NEAR(kit_value(&kit, "p.wx*cos(0.4) - p.wz*sin(0.4)"), -1, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "p.wy"), 2, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "p.wx*sin(0.4) + p.wz*cos(0.4)"), -3, 1e-9);
    }
    kit_free(&kit);
}

/* an equation that vanished by the values of parameters is looked at again with others */
static void parts_that_no_longer_fit_are_told(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nL1 = 0.5\nL2 = 0.5\nbody m1 mass=1 inertia=1\n"
                      "arm a m1 [0, L1]\narm g ground [0, L2]\nprismatic s1 ground m1 axis=x\n"
                      "prismatic s2 g a axis=x\ntree s1\nassemble\nL1 = 0.7\n");
    EXPECT(kit_do(&kit, "assemble") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "s2 can't be assembled");
    EXPECT_DONE(&kit, "L2 = 0.7\nassemble\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_statement_is_handed_out_in_parts);
    RUN(trailing_words_have_their_own_calls);
    RUN(a_bad_line_is_refused_at_its_place);
    RUN(an_empty_line_is_an_empty_statement);
    RUN(apply_leaves_looking_and_running_to_the_caller);
    RUN(a_statement_that_fails_changes_nothing);
    RUN(save_rebuilds_the_model);
    RUN(undo_and_redo_name_what_they_move_over);
    RUN(clear_starts_anew);
    RUN(the_model_is_changed_until_it_runs);
    RUN(trees_tell_what_they_cost);
    RUN(two_sessions_know_nothing_of_each_other);
    RUN(a_session_needs_no_hooks);
    RUN(a_session_bears_any_order_of_statements);
    RUN(undo_and_redo_of_an_edit_form_no_equations);
    RUN(what_hangs_beyond_many_turns_is_where_they_bring_it);
    RUN(angular_speeds_of_joints_can_be_given);
    RUN(parts_that_no_longer_fit_are_told);
    return test_end();
}

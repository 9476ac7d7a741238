/* test_model_history.c: undo, redo, save; the scripts that have to run as they stand */
#include "test_model.h"

/* --- random sessions --- */

/* Statements that make sense now and then: names clash, are missing, are used or not. */
static char *random_statement(uint64_t *seed)
{
    static const char *const forms[] = {
        "body b%d mass=k%d inertia=0.1",
        "arm r%d b%d [k1, 0]",
        "arm r%d ground [1, %d]",
        "revolute h%d ground b%d",
        "revolute h%d r%d b1",
        "prismatic s%d r1 b%d axis=x",
        "virtual revolute v%d b0 b%d",
        "spring q%d h%d k=3",
        "force f%d b%d [h1, t]",
        "k%d = %d",
        "k%d = 2*k%d",
        "l%d(x) = k%d*x",
        "l%d(x) = l%d(x)^2",
        "output o%d = h%d'",
        "output o%d = l1(o%d)",
        "vsource E%d a%d 0 l1(t)",
        "resistor R%d a0 a%d 2",
        "resistor R%d a%d 0 k0",
        "motor M%d h%d a1 0 R=1 Kt=1",
        "driver D%d h%d = l1(t)",
        "set b%d.mass = %d",
        "set b%d.inertia = k%d",
        "delete b%d",
        "delete h%d",
        "delete k%d",
        "delete l%d",
        "delete R%d",
        "tree h%d b%d",
        "tree + h%d - b%d",
        "tree rotation h%d",
        "cotree h%d",
        "tree - b%d",
        "tree absolute",
        "tree joint",
        "tree electrical R%d",
        "init h%d = k%d",
        "init b%d.x = 1, h%d' = l1(2)",
        "guess h%d = %d",
        "init none",
        "form embedded independent=[h%d]",
        "form augmented",
        "gravity [0, -k%d]",
        "title \"t%d\"",
    };
    Text text = {0};
    const char *form = forms[test_random(seed) % COUNT(forms)];
    int a = (int)(test_random(seed) % 3);
    int b = (int)(test_random(seed) % 3);

    for (const char *c = form; *c != '\0'; c++) {
        if (c[0] == '%' && c[1] == 'd') {
            text_addf(&text, "%d", a);
            a = b;
            c++;
        } else
            text_char(&text, *c);
    }
    return text_done(&text);
}

typedef struct Snapshot {
    char *save;
    char *graph;
} Snapshot;

static Snapshot snapshot(const Model *model)
{
    return (Snapshot){model_save(model), graph_text(model)};
}

static bool is_at(const Model *model, const Snapshot *wanted)
{
    Snapshot now = snapshot(model);
    bool same = strcmp(now.save, wanted->save) == 0 && strcmp(now.graph, wanted->graph) == 0;

    if (!same)
        printf("--- now\n%s--- wanted\n%s", now.save, wanted->save);
    mem_free(now.save);
    mem_free(now.graph);
    return same;
}

static void undo_and_redo_pass_the_same_states(void)
{
    for (uint64_t round = 0; round < 30; round++) {
        uint64_t seed = 77 + round;
        Model *model = model_of("scene planar\nk0 = 1; k1 = 2; k2 = 3");
        LIST(Snapshot) states = {0};
        int first = 0;

        LIST_PUSH(states, snapshot(model));
        for (int i = 0; i < 120; i++) {
            char *text = random_statement(&seed);
            Diag diag = {0};
            uint64_t revision = model_revision(model);

            if (apply_text(model, text, &diag) == OK)
                LIST_PUSH(states, snapshot(model));
            else
                EXPECT(is_at(model, &states.at[states.count - 1]) && diag.message[0] != '\0');
            EXPECT(model_revision(model) >= revision);
            mem_free(text);
        }
        EXPECT(states.count > 20);
        for (int i = states.count - 2; i >= first; i--) {
            EXPECT(model_undo(model, NULL) == OK);
            EXPECT(is_at(model, &states.at[i]));
        }
        for (int i = 1; i < states.count; i++) {
            EXPECT(model_redo(model, NULL) == OK);
            EXPECT(is_at(model, &states.at[i]));
        }
        for (int i = 0; i < states.count; i++) {
            mem_free(states.at[i].save);
            mem_free(states.at[i].graph);
        }
        LIST_FREE(states);
        model_free(model);
    }
}

/* what the model is after a number of steps, told by the texts of those steps */
static bool is_as_made_anew(const Model *model)
{
    Model *fresh = model_new();
    Snapshot wanted;
    int serial;
    bool same;

    for (int i = 0; i < model_step_count(model); i++)
        if (strcmp(model_step(model, i, &serial), "clear") == 0)
            model_clear(fresh);
        else
            EXPECT(apply_text(fresh, model_step(model, i, &serial), NULL) == OK);
    wanted = snapshot(fresh);
    same = is_at(model, &wanted);
    mem_free(wanted.save);
    mem_free(wanted.graph);
    model_free(fresh);
    return same;
}

static void walks_back_and_forth_end_where_the_statements_lead(void)
{
    for (uint64_t round = 0; round < 40; round++) {
        uint64_t seed = 4711 + round;
        Model *model = model_of("scene planar\nk0 = 1; k1 = 2; k2 = 3");
        int groups[2];
        int depth = 0;

        for (int i = 0; i < 300; i++) {
            const uint64_t what = test_random(&seed) % 16;
            char *text = random_statement(&seed);

            if (what < 9)
                (void)!apply_text(model, text, NULL);
            else if (what < 12)
                (void)!model_undo(model, NULL);
            else if (what < 14)
                (void)!model_redo(model, NULL);
            else if (what < 15 && depth < 2)
                groups[depth++] = model_begin_group(model);
            else if (what < 15) {
                depth--;
                EXPECT(model_end_group(model, groups[depth], "group") >= 0);
            } else if (test_random(&seed) % 8 == 0)
                model_clear(model);
            mem_free(text);
            if (i % 5 == 0)
                EXPECT(is_as_made_anew(model));
        }
        while (model_undo(model, NULL) == OK)
            EXPECT(model_step_count(model) % 7 != 0 || is_as_made_anew(model));
        EXPECT(model_step_count(model) == 0);
        while (model_redo(model, NULL) == OK)
            EXPECT(model_step_count(model) % 7 != 0 || is_as_made_anew(model));
        EXPECT(is_as_made_anew(model));
        model_free(model);
    }
}

/* a deleted name makes another state, and so many are not all kept */
static void what_is_no_longer_kept_is_made_anew(void)
{
    Model *model = model_of("scene planar\nk = 1\nbody a mass=k");
    enum { MANY = 2400 };

    for (int i = 0; i < MANY; i++) {
        EXPECT(apply_text(model, "body b mass=2", NULL) == OK);
        EXPECT(apply_text(model, "delete b", NULL) == OK);
    }
    for (int i = 2 * MANY; i > 0; i--) {
        EXPECT(model_undo(model, NULL) == OK);
        EXPECT(model_step_count(model) == 3 + i - 1);
        EXPECT((model_find(model, "b") != NULL) == (i % 2 == 0));
    }
    EXPECT(is_as_made_anew(model));
    EXPECT(model_redo(model, NULL) == OK && model_find(model, "b") != NULL);
    model_free(model);
}

static void a_group_is_one_step(void)
{
    Model *model = model_of("a = 1");
    const int outer = model_begin_group(model);
    int inner;

    EXPECT(apply_text(model, "b = 2", NULL) == OK);
    inner = model_begin_group(model);
    EXPECT(apply_text(model, "c = 3", NULL) == OK && apply_text(model, "d = 4", NULL) == OK);
    EXPECT(model_end_group(model, inner, "inner") == 2);
    EXPECT(model_end_group(model, outer, "outer") == 3);
    EXPECT(model_undo(model, NULL) == OK && model_parameter_count(model) == 1);
    EXPECT_TEXT(model_undone(model), "outer");
    EXPECT(model_redo(model, NULL) == OK && model_parameter_count(model) == 4);
    EXPECT(model_undo(model, NULL) == OK && model_undo(model, NULL) == OK);
    EXPECT(model_redo(model, NULL) == OK && model_parameter_count(model) == 1);

    /* a group that goes back behind its own beginning has what it made since */
    inner = model_begin_group(model);
    EXPECT(model_undo(model, NULL) == OK && apply_text(model, "e = 5", NULL) == OK);
    EXPECT(model_end_group(model, inner, "back") == 1);
    EXPECT(model_undo(model, NULL) == OK && model_parameter_count(model) == 0);
    EXPECT(model_undo(model, NULL) == E_MISSING);
    model_free(model);
}

static void what_is_saved_rebuilds_the_model(void)
{
    for (uint64_t round = 0; round < 30; round++) {
        uint64_t seed = 1234 + round;
        Model *model = model_of("scene planar\nk0 = 1; k1 = 2; k2 = 3");
        Snapshot saved;
        Model *again;

        for (int i = 0; i < 150; i++) {
            char *text = random_statement(&seed);

            (void)!apply_text(model, text, NULL);
            mem_free(text);
        }
        saved = snapshot(model);
        again = model_of(saved.save);
        EXPECT(is_at(again, &saved));
        EXPECT(model_start_count(model) == model_start_count(again));
        for (int i = 0; i < model_parameter_count(model); i++) {
            Expr p = model_parameter(model, i, NULL);
            Expr q = expr_symbol(model_arena(again), expr_name(p), SYMBOL_PARAMETER);

            EXPECT_NEAR(model_parameter_value(model, p), model_parameter_value(again, q), 0);
        }
        mem_free(saved.save);
        mem_free(saved.graph);
        model_free(again);
        model_free(model);
    }
}

static void clearing_can_be_undone(void)
{
    Model *model = model_of("scene planar\nbody m mass=1");
    Snapshot before = snapshot(model);
    char *empty;

    model_clear(model);
    empty = model_save(model);
    EXPECT_TEXT(empty, "");
    EXPECT(!model_is_planar(model));
    EXPECT(model_undo(model, NULL) == OK);
    EXPECT_TEXT(model_undone(model), "clear");
    EXPECT(is_at(model, &before));
    EXPECT(model_redo(model, NULL) == OK);
    EXPECT(model_count(model) == 0);
    mem_free(empty);
    mem_free(before.save);
    mem_free(before.graph);
    model_free(model);
}

static void a_new_statement_ends_redo(void)
{
    Model *model = model_of("a = 1\nb = 2");

    EXPECT(model_undo(model, NULL) == OK);
    EXPECT_TEXT(model_undone(model), "b = 2");
    EXPECT(apply_text(model, "c = 3", NULL) == OK);
    EXPECT(model_redo(model, NULL) == E_MISSING);
    model_free(model);
}

static void shortened_verbs_are_saved_in_full(void)
{
    Model *model = model_new();
    const char *text = "virt rev h1 ground m1 axis=z";
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag = {0};
    char *saved;

    EXPECT(apply_text(model, "body m1 mass=1", &diag) == OK);
    if (statement_parse(text, 1, (SyntaxOptions){.shortened = true}, &next, &statement, &diag) !=
        OK) {
        /* `virtual` itself may be no word that shortens */
        next = 0;
        text = "virtual rev h1 ground m1 axis=z";
        EXPECT(statement_parse(text, 1, (SyntaxOptions){.shortened = true}, &next, &statement,
                               &diag) == OK);
    }
    EXPECT(model_apply(model, statement, &diag) == OK);
    saved = model_save(model);
    EXPECT_TEXT(saved, "body m1 mass=1\nvirtual revolute h1 ground m1 axis=z\n");
    mem_free(saved);
    statement_free(statement);
    model_free(model);
}

static void redefined_parameters_are_saved_where_they_are_needed(void)
{
    Model *model = model_of("k1 = 1\nbody m mass=k1\nk2 = 5\nk1 = 2*k2\ntitle \"a\"\ntitle \"b\"");
    char *saved = model_save(model);

    EXPECT_TEXT(saved, "k2 = 5\nk1 = 2*k2\nbody m mass=k1\ntitle \"b\"\n");
    mem_free(saved);
    model_free(model);
}

/* --- scripts --- */

static char *read_script(const char *name)
{
    const char *top = getenv("TOP_SRCDIR");
    Text path = {0};
    Text text = {0};
    char chunk[4096];
    size_t got;
    FILE *file;

    text_addf(&path, "%s/scripts/%s", top != NULL ? top : ".", name);
    file = fopen(path.at, "r");
    text_free(&path);
    EXPECT(file != NULL);
    while (file != NULL && (got = fread(chunk, 1, sizeof chunk, file)) > 0)
        text_add_n(&text, chunk, got);
    if (file != NULL)
        (void)fclose(file);
    return text_done(&text);
}

/* name, branches of the two mechanical trees in order of making */
static const struct {
    const char *name;
    const char *translation;
    const char *rotation;
} scripts[] = {
    {"paper/1_slider_crank_one_tree.ct", "h8 h10 s11", "h8 h10 s11"},
    {"paper/1_slider_crank_two_trees.ct", "h8 h9 h10", "h8 h10 s11"},
    {"paper/3_motor_arm_forward.ct", "J1 J2", "J1 J2"},
    {"paper/3_motor_arm_inverse.ct", "J1 J2", "J1 J2"},
    {"paper/4_spatial_slider_crank_a.ct", "h1 h3 h4", "h1 h3 h4"},
    {"paper/4_spatial_slider_crank_c.ct", "h1 h3 h4", "h1 h3 h4"},
    {"reference/ref_A01_pendulum_2000s.ct", "h1", "h1"},
    {"reference/ref_A01_pendulum_absolute.ct", "p1", "p1"},
    {"reference/ref_A01_pendulum_joint.ct", "h1", "h1"},
    {"reference/ref_A02_four_bar_absolute.ct", "c0 c1 k0", "c0 c1 k0"},
    {"reference/ref_A02_four_bar_joint.ct", "a0 a1 l0", "a0 a1 l0"},
    {"reference/ref_A03_andrews.ct", "jO jF jB jG jA5 jH jA7", "jO jF jB jG jA5 jH jA7"},
    {"reference/ref_A03_andrews_beta062.ct", "jO jF jB jG jA5 jH jA7", "jO jF jB jG jA5 jH jA7"},
};

static void scripts_build_their_models(void)
{
    for (int i = 0; i < COUNT(scripts); i++) {
        char *text = read_script(scripts[i].name);
        Model *model = model_of(text);
        Snapshot saved = snapshot(model);
        Model *again = model_of(saved.save);

        EXPECT_BRANCHES(model, TREE_TRANSLATION, scripts[i].translation);
        EXPECT_BRANCHES(model, TREE_ROTATION, scripts[i].rotation);
        EXPECT(is_at(again, &saved));
        model_free(again);
        model_free(model);
        mem_free(saved.save);
        mem_free(saved.graph);
        mem_free(text);
    }
}

int main(void)
{
    RUN(undo_and_redo_pass_the_same_states);
    RUN(walks_back_and_forth_end_where_the_statements_lead);
    RUN(what_is_no_longer_kept_is_made_anew);
    RUN(a_group_is_one_step);
    RUN(what_is_saved_rebuilds_the_model);
    RUN(clearing_can_be_undone);
    RUN(a_new_statement_ends_redo);
    RUN(shortened_verbs_are_saved_in_full);
    RUN(redefined_parameters_are_saved_where_they_are_needed);
    RUN(scripts_build_their_models);
    return test_end();
}

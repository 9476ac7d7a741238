/* fuzz_session.c: bent statements, given to a session that holds a model
 *
 * Everything a statement can ask for is asked: equations, runs, values, tables, completions. Beside
 * what the sanitizers see: a statement that fails leaves the model as it was and says why, at a
 * place inside its text, and every call ends soon after the stop hook says so. */
#include "mutate.h"

#include "cotree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* what a session holds before the bent text comes */
static const char *const models[] = {
    "",
    "scene planar; gravity [0, -9.81]; L4 = 0.1; L5 = 0.2; body m1 mass=1 inertia=0.01;"
    "body m2 mass=1.5 inertia=0.03; body m3 mass=2 inertia=0.01; arm r4 m1 [-L4, 0];"
    "arm r5 m1 [L4, 0]; arm r6 m2 [L5, 0]; arm r7 m2 [-L5, 0]; revolute h8 ground r4;"
    "revolute h9 r5 r6; revolute h10 m3 r7; prismatic s11 ground m3 axis=x;"
    "force F12 m3 [-5 + sin(t), 0]; init h8 = 45 deg, h8' = 10; guess h10 = 2.8",
    "scene planar; gravity [0, -9.81]; body m1 mass=2 inertia=0.03; arm p1 m1 [-0.2, 0];"
    "revolute J1 ground p1 coord=th; motor M7 J1 a 0 R=1.2 L=0.05 Kt=0.8 Kv=0.8;"
    "vsource V1 a 0 24 V; resistor R1 a b 10 ohm; capacitor C1 b 0 1 uF; S(t) = sin(pi*t)/2;"
    "output power = M7.v*M7.i; spring k1 J1 k=3",
    "gravity [0, 0, -9.81]; body b mass=1 inertia=[1, 2, 3]; arm p b [0, 0, 1];"
    "revolute h ground p axis=[1, 1, 0]; body c mass=1 inertia=[1, 1, 1]; weld w b c",
    "vsource V1 a 0 12; switch S1 a b when=t*5 - floor(t*5) < 0.4; diode D1 0 b;"
    "inductor L1 b c 1; capacitor C1 c 0 0.1; resistor R1 c 0 50; init L1.i = 0, C1.v = 0",
    "Vp = 325; w = 10; vsource Va a 0 Vp*sin(w*t); vsource Vb b 0 Vp*sin(w*t - 2*pi/3);"
    "vsource Vc c 0 Vp*sin(w*t + 2*pi/3); diode D1 a p; diode D2 b p; diode D3 c p; diode D4 n a;"
    "diode D5 n b; diode D6 n c; inductor L1 p q 1; resistor R1 q n 20; init L1.i = 0",
    "scene planar; body m1 mass=1 inertia=0.02; revolute h1 ground m1; vsource V1 a 0 24;"
    "motor M1 h1 x y R=1 L=0.1 Kt=0.1 Kv=0.1; pwm(t) = t - floor(t) - 0.7; init h1 = 0, h1' = 0;"
    "switch S1 a x when=pwm(t) < 0; switch S2 x 0 when=pwm(t) >= 0; switch S3 a y when=pwm(t) >= 0;"
    "switch S4 y 0 when=pwm(t) < 0; init M1.i = 0",
};

/* whether the call that goes on has had its share of time */
static bool share_is_over(void *context)
{
    const clock_t *began = context;

    return (double)(clock() - *began) > 0.1 * CLOCKS_PER_SEC;
}

/* everything that prints: the text is thrown away */
static ct_status look(ct_session *session, const ct_statement *statement, ct_error *error)
{
    const char *verb = ct_verb(statement);
    char *text = NULL;
    ct_status status = CT_OK;

    if (strcmp(verb, "show") == 0)
        status = ct_show(session, statement, &text, error);
    else if (strcmp(verb, "count") == 0)
        status = ct_count(session, statement, &text, error);
    else if (strcmp(verb, "info") == 0)
        status = ct_info(session, statement, &text, error);
    else if (strcmp(verb, "check") == 0)
        status = ct_check(session, &text, error);
    else if (strcmp(verb, "tree") == 0)
        status = ct_tree_text(session, &text, error);
    else if (strcmp(verb, "draw") == 0)
        status = ct_draw(session, statement, &(ct_paper){.format = "svg"}, &text, error);
    else if (strcmp(verb, "animate") == 0) {
        char **frames = NULL;
        double interval;

        status = ct_animate(session, statement, &(ct_paper){.format = "text"}, &frames, &interval,
                            error);
        if (status == CT_OK)
            ct_words_free(frames);
    } else if (strcmp(verb, "export") == 0)
        status = ct_export(session, statement, true, &text, error);
    else if (strcmp(verb, "expect") == 0)
        status = ct_expect(session, statement, error);
    else if (strcmp(verb, "print") == 0 && ct_operand_count(statement) > 0) {
        double value;

        status = ct_value(session, ct_operand(statement, 0), ct_at(statement), &value, error);
    } else if (strcmp(verb, "plot") == 0 || strcmp(verb, "table") == 0) {
        const ct_expression *items[8];
        double *values = NULL;
        char **names = NULL;
        int rows, columns, count = ct_operand_count(statement);

        count = count < 8 ? count : 8;
        for (int i = 0; i < count; i++)
            items[i] = ct_operand(statement, i);
        status = ct_table(session, items, count, 0, &values, &rows, &columns, &names, error);
        if (status == CT_OK) {
            ct_free(values);
            ct_words_free(names);
        }
    }
    if (status == CT_OK)
        ct_free(text);
    return status;
}

static ct_status carry_out(ct_session *session, const ct_statement *statement, ct_error *error)
{
    const ct_room carrier = ct_carrier(statement);
    const char *verb = ct_verb(statement);

    if (ct_statement_is_empty(statement))
        return CT_OK;
    if (carrier != CT_CALLER)
        return (carrier == CT_MODEL ? ct_apply : ct_run)(session, statement, error);
    if (strcmp(verb, "undo") == 0)
        return ct_undo(session, error);
    if (strcmp(verb, "redo") == 0)
        return ct_redo(session, error);
    if (strcmp(verb, "clear") == 0)
        ct_clear(session);
    return look(session, statement, error);
}

static void check_error(const char *text, const ct_error *error)
{
    mutate_claim(error->message[0] != '\0', "a failure says why");
    if (error->line == 1 && strchr(text, '\n') == NULL)
        mutate_claim(error->column >= 1 && error->column <= (int)strlen(text) + 1 &&
                         error->width >= 1,
                     "the place is inside the text");
}

static void check_unchanged(const ct_session *session, const char *before)
{
    char *after = ct_save(session);

    mutate_claim(strcmp(before, after) == 0, "a statement that fails leaves the model as it was");
    ct_free(after);
}

/* Apply a text; the rest of it is left when a statement fails. */
static void apply(ct_session *session, const char *text, clock_t *began)
{
    ct_cursor cursor = {.text = text, .line = 1};
    const size_t length = strlen(text);

    while (cursor.next < length) {
        ct_error error = {0};
        ct_statement *statement = NULL;
        size_t start = cursor.next;
        char *before = ct_save(session);
        ct_status status = ct_parse(&cursor, length % 2 == 0, &statement, &error);

        *began = clock();
        if (status == CT_OK) {
            mutate_claim(cursor.next > start, "reading goes forward");
            status = carry_out(session, statement, &error);
            ct_statement_free(statement);
        } else
            cursor.next = length;
        if (status == CT_FAILED) {
            check_error(text, &error);
            check_unchanged(session, before);
            cursor.next = length;
        }
        ct_free(before);
    }
}

static void check_completion(ct_session *session, const char *text)
{
    size_t start = 0, cursor = strcspn(text, "\n");

    ct_words_free(ct_complete(session, text, cursor, &start));
    mutate_claim(start <= cursor, "completion begins before the cursor");
}

/* back over everything and forth again: the same model, and an empty one between */
static void check_way_back(ct_session *session)
{
    char *before = ct_save(session);
    const int steps = ct_step_count(session);
    int moves = 0;
    char *middle;

    while (ct_step_count(session) > 0 && ct_undo(session, NULL) == CT_OK)
        moves++;
    mutate_claim(ct_step_count(session) == 0, "everything can be undone");
    middle = ct_save(session);
    mutate_claim(middle[0] == '\0', "and nothing is left then");
    while (moves-- > 0)
        mutate_claim(ct_redo(session, NULL) == CT_OK, "what was undone can be done again");
    mutate_claim(ct_step_count(session) == steps, "with as many steps");
    check_unchanged(session, before);
    ct_free(middle);
    ct_free(before);
}

void mutate_target(const char *text)
{
    size_t length = strlen(text);
    clock_t began = clock();
    ct_hooks hooks = {.context = &began, .stop = share_is_over, .columns = 80};
    ct_session *session = ct_session_new(&hooks);

    apply(session, models[length % (sizeof models / sizeof *models)], &began);
    apply(session, text, &began);
    check_completion(session, text);
    began = clock();
    check_way_back(session);
    ct_session_free(session);
}

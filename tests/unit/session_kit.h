/* session_kit.h: a session driven by text, as tests of the public interface need it */
#ifndef COTREE_TESTS_SESSION_KIT_H
#define COTREE_TESTS_SESSION_KIT_H

#include "cotree.h"
#include "test.h"

#define UNUSED __attribute__((unused))

/* what the last statement printed (NULL: nothing), and what went wrong */
typedef struct Kit {
    ct_session *session;
    char *text;
    ct_error error;
} Kit;

UNUSED static Kit kit_new(void)
{
    const ct_hooks hooks = {.columns = 80};

    return (Kit){.session = ct_session_new(&hooks)};
}

UNUSED static void kit_free(Kit *kit)
{
    ct_free(kit->text);
    ct_session_free(kit->session);
}

static ct_status kit_print(Kit *kit, const ct_statement *statement)
{
    ct_status status = CT_OK;
    double value;

    for (int i = 0; status == CT_OK && i < ct_operand_count(statement); i++)
        status =
            ct_value(kit->session, ct_operand(statement, i), ct_at(statement), &value, &kit->error);
    return status;
}

static ct_status kit_table(Kit *kit, const ct_statement *statement)
{
    const ct_expression *items[64];
    int count = ct_operand_count(statement);
    double *values = NULL, every = 0;
    char **names = NULL;
    int rows, columns;
    ct_status status = CT_OK;

    for (int i = 0; i < count && i < 64; i++)
        items[i] = ct_operand(statement, i);
    if (ct_versus(statement) != NULL && count < 64)
        items[count++] = ct_versus(statement);
    if (ct_key_value(statement, "every") != NULL)
        status = ct_duration(kit->session, ct_key_value(statement, "every"), "every", &every,
                             &kit->error);
    if (status == CT_OK && strcmp(ct_verb(statement), "plot") == 0)
        status = ct_plot_keys(kit->session, statement, &(ct_plot){0}, &kit->error);
    if (status == CT_OK)
        status = ct_table(kit->session, items, count, every, &values, &rows, &columns, &names,
                          &kit->error);
    if (status == CT_OK) {
        ct_free(values);
        ct_words_free(names);
    }
    return status;
}

/* the first frame */
static ct_status kit_animate(Kit *kit, const ct_statement *statement)
{
    char **frames = NULL;
    double interval;
    const ct_status status = ct_animate(kit->session, statement, &(ct_paper){.format = "svg"},
                                        &frames, &interval, &kit->error);

    if (status == CT_OK) {
        kit->text = frames[0];
        ct_free(frames);
    }
    return status;
}

static ct_status kit_run(Kit *kit, const ct_statement *statement)
{
    const ct_status status = ct_run(kit->session, statement, &kit->error);

    if (status == CT_OK)
        kit->text = ct_report(kit->session);
    return status;
}

/* what a shell does with a verb that the model doesn't take */
static ct_status kit_other(Kit *kit, const ct_statement *statement)
{
    ct_session *session = kit->session;
    const char *verb = ct_verb(statement);
    bool append;

    if (strcmp(verb, "show") == 0)
        return ct_show(session, statement, &kit->text, &kit->error);
    if (strcmp(verb, "count") == 0)
        return ct_count(session, statement, &kit->text, &kit->error);
    if (strcmp(verb, "check") == 0)
        return ct_check(session, &kit->text, &kit->error);
    if (strcmp(verb, "info") == 0)
        return ct_info(session, statement, &kit->text, &kit->error);
    if (strcmp(verb, "tree") == 0)
        return ct_tree_text(session, &kit->text, &kit->error);
    if (strcmp(verb, "draw") == 0)
        return ct_draw(session, statement, &(ct_paper){.format = "text"}, &kit->text, &kit->error);
    if (strcmp(verb, "animate") == 0)
        return kit_animate(kit, statement);
    if (strcmp(verb, "undo") == 0)
        return ct_undo(session, &kit->error);
    if (strcmp(verb, "redo") == 0)
        return ct_redo(session, &kit->error);
    if (strcmp(verb, "export") == 0)
        return ct_export(session, statement, true, &kit->text, &kit->error);
    if (strcmp(verb, "expect") == 0)
        return ct_expect(session, statement, &kit->error);
    if (strcmp(verb, "print") == 0 && ct_redirect(statement, &append) == NULL)
        return kit_print(kit, statement);
    if (strcmp(verb, "bode") == 0)
        return ct_bode_csv(session, statement, true, &kit->text, &kit->error);
    if (strcmp(verb, "plot") == 0 || strcmp(verb, "table") == 0)
        return kit_table(kit, statement);
    if (strcmp(verb, "clear") == 0) {
        ct_clear(session);
        return CT_OK;
    }
    if (ct_carrier(statement) == CT_CALLER) /* files, help, history: nothing of the session's */
        return CT_OK;
    return kit_run(kit, statement);
}

/* run every statement of a text; stops at the first that fails */
UNUSED static ct_status kit_do(Kit *kit, const char *text)
{
    const size_t length = strlen(text);
    ct_cursor cursor = {.text = text, .line = 1};
    ct_status status = CT_OK;

    while (status == CT_OK && cursor.next < length) {
        ct_statement *statement = NULL;

        status = ct_parse(&cursor, false, &statement, &kit->error);
        if (status != CT_OK)
            break;
        ct_free(kit->text);
        kit->text = NULL;
        if (!ct_statement_is_empty(statement)) {
            status = ct_apply(kit->session, statement, &kit->error);
            if (status == CT_NOT_MINE)
                status = kit_other(kit, statement);
        }
        ct_statement_free(statement);
    }
    return status;
}

/* the value of an expression, NAN where it has none */
UNUSED static double kit_value(Kit *kit, const char *expression)
{
    const size_t room = strlen(expression) + sizeof "print ";
    char *line = malloc(room);
    ct_statement *statement = NULL;
    double value = NAN;
    ct_status parsed = CT_FAILED;

    if (line != NULL) {
        (void)snprintf(line, room, "print %s", expression);
        parsed = ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit->error);
    }
    free(line);
    if (parsed != CT_OK)
        return NAN;
    if (ct_value(kit->session, ct_operand(statement, 0), ct_at(statement), &value, &kit->error) !=
        CT_OK)
        value = NAN;
    ct_statement_free(statement);
    return value;
}

/* the last of the lines is refused, with a message that holds the part */
#define EXPECT_FAILS(kit, lines, part)                                                             \
    do {                                                                                           \
        EXPECT(kit_do(kit, lines) != CT_OK);                                                       \
        EXPECT_HOLDS((kit)->error.message, part);                                                  \
    } while (0)

#define EXPECT_DONE(kit, lines)                                                                    \
    do {                                                                                           \
        if (kit_do(kit, lines) != CT_OK) {                                                         \
            test_faults++;                                                                         \
            printf("%s:%d: %d:%d: %s\n", __FILE__, __LINE__, (kit)->error.line,                    \
                   (kit)->error.column, (kit)->error.message);                                     \
        }                                                                                          \
    } while (0)

#define EXPECT_HOLDS(got, part)                                                                    \
    do {                                                                                           \
        const char *got_ = (got);                                                                  \
        if (got_ == NULL || strstr(got_, part) == NULL) {                                          \
            test_faults++;                                                                         \
            printf("%s:%d: '%s' isn't in:\n%s\n", __FILE__, __LINE__, part, got_ ? got_ : "NULL"); \
        }                                                                                          \
    } while (0)

#define EXPECT_LACKS(got, part)                                                                    \
    do {                                                                                           \
        const char *got_ = (got);                                                                  \
        if (got_ == NULL || strstr(got_, part) != NULL) {                                          \
            test_faults++;                                                                         \
            printf("%s:%d: '%s' is in:\n%s\n", __FILE__, __LINE__, part, got_ ? got_ : "NULL");    \
        }                                                                                          \
    } while (0)

/* what is refused, where, and how that is said */
typedef struct Refusal {
    const char *before, *line;
    int column;
    const char *message, *hint; /* parts of them */
} Refusal;

UNUSED static void kit_expect_refused(const Refusal *wrong)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, wrong->before);
    EXPECT(kit_do(&kit, wrong->line) == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, wrong->message);
    EXPECT_HOLDS(kit.error.hint, wrong->hint);
    if (kit.error.column != wrong->column) {
        test_faults++;
        printf("%s: column %d, wanted %d\n", wrong->line, kit.error.column, wrong->column);
    }
    kit_free(&kit);
}

/* --- models --- */

/* the paper's planar slider-crank, its sizes as parameters */
#define SLIDER_CRANK                                                                               \
    "scene planar\n"                                                                               \
    "L4 = 0.08; L5 = 0.12; L6 = 0.25; L7 = 0.35\n"                                                 \
    "gravity [0, -9.81]\n"                                                                         \
    "body m1 mass=2 inertia=0.01\n"                                                                \
    "body m2 mass=1.2 inertia=0.03\n"                                                              \
    "body m3 mass=3 inertia=0.01\n"                                                                \
    "arm r4 m1 [-L4, 0]\n"                                                                         \
    "arm r5 m1 [L5, 0]\n"                                                                          \
    "arm r6 m2 [L6, 0]\n"                                                                          \
    "arm r7 m2 [-L7, 0]\n"                                                                         \
    "revolute h8 ground r4\n"                                                                      \
    "revolute h9 r5 r6\n"                                                                          \
    "revolute h10 m3 r7\n"                                                                         \
    "prismatic s11 ground m3 axis=x\n"                                                             \
    "force F12 m3 [-25 + 10*sin(5*t), 0]\n"

#define ONE_TREE    "tree h8 h10 s11\n"
#define TWO_TREES   "tree translation h8 h9 h10\ntree rotation h8 h10 s11\n"
#define CRANK_START "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85\n"

/* one arm of the paper's motor-driven arm, all sizes as parameters */
#define MOTOR_ARM                                                                                  \
    "scene planar\n"                                                                               \
    "g = 9.81; M = 2; J = 0.03; a = 0.2; R7 = 1.2; L7 = 0.05; K7 = 0.8\n"                          \
    "gravity [0, -g]\n"                                                                            \
    "body m1 mass=M inertia=J\n"                                                                   \
    "arm p1 m1 [-a, 0]\n"                                                                          \
    "revolute J1 ground p1 coord=theta\n"                                                          \
    "V(t) = 24 + sin(t)\n"                                                                         \
    "motor M7 J1 e 0 R=R7 L=L7 Kt=K7 Kv=K7\n"                                                      \
    "vsource V1 e 0 V(t)\n"

/* a mass on a rod of 1 m: E = 1/2 u^2 - g cos(h) */
#define PENDULUM                                                                                   \
    "scene planar\n"                                                                               \
    "gravity [0, -9.81]\n"                                                                         \
    "L = 1\n"                                                                                      \
    "body m mass=1 inertia=0\n"                                                                    \
    "arm p m [0, L]\n"                                                                             \
    "revolute h ground p\n"                                                                        \
    "init h = 60 deg, h' = 0\n"

/* the text of a drawing in a format; new, ct_free() */
UNUSED static ct_status kit_draw(Kit *kit, const char *line, const char *format, char **out)
{
    ct_cursor cursor = {.text = line, .line = 1};
    ct_statement *statement = NULL;
    ct_status status = ct_parse(&cursor, false, &statement, &kit->error);

    if (status == CT_OK)
        status = ct_draw(kit->session, statement, &(ct_paper){.format = format}, out, &kit->error);
    ct_statement_free(statement);
    return status;
}

#endif

/* test_syntax.c: statements read as the command language says */
#include "test.h"

#include "base/memory.h"
#include "language/syntax.h"

#include <ftw.h>

static const SyntaxOptions script = {false};
static const SyntaxOptions prompt = {.shortened = true};

/* the first statement of a text; NULL and a message where it fails */
static Statement *read_as(const char *text, SyntaxOptions options)
{
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag;

    if (statement_parse(text, 1, options, &next, &statement, &diag) == OK)
        return statement;
    printf("%s\n%d:%d: %s\n", text, diag.place.line, diag.place.column, diag.message);
    test_faults++;
    return NULL;
}

static Statement *read_text(const char *text)
{
    return read_as(text, script);
}

static void expect_tree(const Syntax *syntax, const char *wanted)
{
    Text text = {0};

    if (syntax != NULL)
        syntax_print(&text, syntax);
    EXPECT_TEXT(text.at != NULL ? text.at : "", wanted);
    text_free(&text);
}

/* where a text fails, and how */
static void expect_fault(const char *text, Status wanted, int line, int column, int width)
{
    Statement *statement = NULL;
    Status status = OK;
    size_t next = 0;
    Diag diag = {0};

    while (status == OK && next < strlen(text)) {
        statement_free(statement);
        statement = NULL;
        status = statement_parse(text, 1, script, &next, &statement, &diag);
    }
    EXPECT(status == wanted);
    EXPECT(diag.place.line == line && diag.place.column == column && diag.place.width == width);
    if (diag.place.line != line || diag.place.column != column || diag.place.width != width)
        printf("%s: %d:%d+%d %s\n", text, diag.place.line, diag.place.column, diag.place.width,
               diag.message);
    statement_free(statement);
}

/* --- expressions --- */

/* the tree with every operation in brackets */
static void write_bracketed(Text *text, const Syntax *s)
{
    if (s->kind == SYNTAX_BINARY || s->kind == SYNTAX_UNARY) {
        text_char(text, '(');
        if (s->kind == SYNTAX_BINARY)
            write_bracketed(text, s->args[0]);
        text_add(text, s->text);
        write_bracketed(text, s->args[s->count - 1]);
        text_char(text, ')');
    } else if (s->kind == SYNTAX_GROUP)
        write_bracketed(text, s->args[0]);
    else
        syntax_print(text, s);
}

static void expect_structure(const char *expression, const char *wanted)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Text text = {0};
    Diag diag;

    EXPECT(syntax_parse_expression(expression, pool, &syntax, &diag) == OK);
    if (syntax != NULL)
        write_bracketed(&text, syntax);
    EXPECT_TEXT(text.at, wanted);
    text_free(&text);
    pool_free(pool);
}

static void operators_bind_as_in_mathematics(void)
{
    expect_structure("a + b*c", "(a+(b*c))");
    expect_structure("a - b - c", "((a-b)-c)");
    expect_structure("a/b*c", "((a/b)*c)");
    expect_structure("-a^2", "(-(a^2))");
    expect_structure("a^b^c", "(a^(b^c))");
    expect_structure("2^-a", "(2^(-a))");
    expect_structure("-a*b", "((-a)*b)");
    expect_structure("a - -b", "(a-(-b))");
    expect_structure("a < b + 1 && !c || d", "(((a<(b+1))&&(!c))||d)");
    expect_structure("(a + b)*c", "((a+b)*c)");
}

static void primes_and_calls_touch(void)
{
    Statement *s = read_text("output y = h8'' + (a*b)' + f(x, 2)'");

    if (s == NULL)
        return;
    expect_tree(s->pairs.at[0].value, "h8'' + (a*b)' + f(x, 2)'");
    EXPECT(s->pairs.at[0].value->args[0]->args[0]->primes == 2);
    EXPECT(s->pairs.at[0].value->args[1]->kind == SYNTAX_CALL);
    EXPECT(s->pairs.at[0].value->args[1]->primes == 1);
    statement_free(s);
}

static void a_literal_takes_a_unit(void)
{
    Statement *s = read_text("body m1 mass=2.5 g inertia=[1, 2, 3] [kg*m^2]");

    if (s == NULL)
        return;
    EXPECT(s->pairs.count == 2);
    EXPECT_TEXT(s->pairs.at[0].value->text, "2.5");
    EXPECT(s->pairs.at[0].value->has_unit);
    EXPECT_NEAR(s->pairs.at[0].value->unit.factor, 1e-3, 1e-18);
    EXPECT_TEXT(s->pairs.at[0].value->unit_text, "g");
    EXPECT(s->pairs.at[0].value->unit_place.column == 18);
    EXPECT_TEXT(s->pairs.at[1].value->unit_text, "[kg*m^2]");
    EXPECT(s->pairs.at[1].value->kind == SYNTAX_VECTOR && s->pairs.at[1].value->count == 3);
    statement_free(s);
}

static void a_word_before_an_equals_sign_is_the_next_key(void)
{
    Statement *s = read_text("use leg leg1 R=10 k=2 m=3");

    if (s == NULL)
        return;
    EXPECT(s->pairs.count == 3);
    EXPECT(!s->pairs.at[0].value->has_unit && !s->pairs.at[1].value->has_unit);
    EXPECT_TEXT(s->pairs.at[2].name, "m");
    statement_free(s);
}

static void clear_products_of_units_and_names_pass(void)
{
    static const char *const lines[] = {"x = 0.1 V*sin(y)", "x = t/0.1 s",  "x = 2 m*L4",
                                        "x = (2 kg)*m",     "x = 2 [kg*m]", "x = 5 [mm^2]"};

    for (int i = 0; i < COUNT(lines); i++)
        statement_free(read_text(lines[i]));
}

/* --- statements --- */

static void names_and_laws_are_definitions(void)
{
    Statement *s = read_text("k2 = 2*k1 # twice");

    if (s == NULL)
        return;
    EXPECT(s->kind == STATEMENT_PARAMETER);
    EXPECT_TEXT(s->name, "k2");
    EXPECT_TEXT(s->text, "k2 = 2*k1");
    expect_tree(s->value, "2*k1");
    statement_free(s);

    s = read_text("C(s, d) = eps*A/(d - s)");
    if (s == NULL)
        return;
    EXPECT(s->kind == STATEMENT_LAW);
    EXPECT(s->argument_count == 2);
    EXPECT_TEXT(s->arguments[1], "d");
    expect_tree(s->value, "eps*A/(d - s)");
    statement_free(s);
}

static void a_component_has_name_places_values_and_keys(void)
{
    Statement *s = read_text("arm r5 m1 [L5, 0] rotation=z(90 deg)*x(a)");

    if (s == NULL)
        return;
    EXPECT_TEXT(s->verb, "arm");
    EXPECT(s->operands.count == 3);
    expect_tree(s->operands.at[0].value, "r5");
    expect_tree(s->operands.at[2].value, "[L5, 0]");
    expect_tree(s->pairs.at[0].value, "z(90 deg)*x(a)");
    EXPECT(s->row.component != NULL);
    statement_free(s);
}

static void a_place_is_one_word_and_a_value_follows(void)
{
    Statement *s = read_text("vsource E1 a 0 -5");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 4);
    EXPECT(s->operands.at[2].value->kind == SYNTAX_NUMBER);
    expect_tree(s->operands.at[3].value, "-5");
    statement_free(s);

    s = read_text("vsource E1 a b (x)");
    if (s == NULL)
        return;
    expect_tree(s->operands.at[3].value, "(x)");
    statement_free(s);
}

static void a_spring_stands_on_two_frames_or_one_joint(void)
{
    Statement *s = read_text("spring k1 h8 k=10 rest=0.1");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 2 && s->pairs.count == 2);
    statement_free(s);
    s = read_text("spring k1 r1 r2 k=10");
    if (s == NULL)
        return;
    EXPECT(s->operands.count == 3 && s->pairs.count == 1);
    statement_free(s);
}

static void pairs_take_expressions_up_to_the_next(void)
{
    Statement *s = read_text("init h8 = 60 deg, h8' = 12 s11 = -0.1*9.81/200 m1.vx = 2");

    if (s == NULL)
        return;
    EXPECT(s->pairs.count == 4);
    EXPECT_TEXT(s->pairs.at[1].name, "h8");
    EXPECT(s->pairs.at[1].primes == 1);
    expect_tree(s->pairs.at[2].value, "-0.1*9.81/200");
    EXPECT_TEXT(s->pairs.at[3].name, "m1.vx");
    EXPECT(s->pairs.at[3].name_place.column == 48);
    statement_free(s);

    s = read_text("driver D1 theta1 = -pi/2 + 1.2*S(t) by=V1");
    if (s == NULL)
        return;
    EXPECT(s->operands.count == 1 && s->pairs.count == 2);
    expect_tree(s->pairs.at[0].value, "-pi/2 + 1.2*S(t)");
    EXPECT_TEXT(s->pairs.at[1].name, "by");
    statement_free(s);
}

static void trees_are_set_or_changed(void)
{
    Statement *s = read_text("tree rotation + vh16 - h14");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 3);
    EXPECT(s->operands.at[0].sign == 0 && s->operands.at[1].sign == '+');
    EXPECT(s->operands.at[2].sign == '-');
    statement_free(s);

    s = read_text("tree (rotation) h8");
    if (s == NULL)
        return;
    EXPECT(s->operands.at[0].value->kind == SYNTAX_GROUP);
    expect_tree(s->operands.at[0].value, "(rotation)");
    statement_free(s);
}

static void what_prints_goes_to_a_file(void)
{
    Statement *s = read_text("plot h8 [deg] (h9 - h8)' vs t > \"a b.png\"");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 2);
    EXPECT_TEXT(s->operands.at[0].value->unit_text, "[deg]");
    EXPECT(s->operands.at[1].value->primes == 1);
    expect_tree(s->versus, "t");
    EXPECT_TEXT(s->redirect, "a b.png");
    EXPECT(!s->append);
    statement_free(s);

    s = read_text("export csv >> \"x.csv\"");
    if (s == NULL)
        return;
    EXPECT(s->append);
    statement_free(s);
}

static void elsewhere_greater_compares(void)
{
    Statement *s = read_text("expect a > b at 2");

    if (s == NULL)
        return;
    EXPECT_TEXT(s->operands.at[0].value->text, ">");
    expect_tree(s->at, "2");
    statement_free(s);
}

static void expectations_have_a_tolerance(void)
{
    Statement *s = read_text("expect b.fz ~ -317.25 within 4e-06 at 0");

    if (s == NULL)
        return;
    expect_tree(s->operands.at[0].value, "b.fz");
    expect_tree(s->near_value, "-317.25");
    expect_tree(s->within, "4e-06");
    expect_tree(s->at, "0");
    statement_free(s);
}

static void print_shows_expressions_in_units(void)
{
    Statement *s = read_text("print max(h8) [deg], s11 + 1 mm at 2 s");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 2);
    EXPECT_TEXT(s->operands.at[0].value->unit_text, "[deg]");
    expect_tree(s->at, "2 s");
    statement_free(s);
}

static void show_takes_topics_entries_and_a_notation(void)
{
    Statement *s = read_text("show mass 2 3 as latex");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 3);
    EXPECT(s->operands.at[1].value->kind == SYNTAX_NUMBER && !s->operands.at[1].value->has_unit);
    EXPECT_TEXT(s->as, "latex");
    EXPECT(s->as_place.column == 18);
    statement_free(s);
}

static void a_statement_may_follow_a_colon(void)
{
    Statement *s = read_text("sweep L4=range(0.1, 0.3, 20) keep=s11 : simulate 5 every=0.1");

    EXPECT(s != NULL && s->rest != NULL);
    if (s == NULL || s->rest == NULL)
        return;
    EXPECT_TEXT(s->rest->verb, "simulate");
    EXPECT_TEXT(s->rest->text, "simulate 5 every=0.1");
    statement_free(s);
}

static void complete_takes_the_line_as_it_stands(void)
{
    Statement *s = read_text("complete print \"a; h8 ");

    if (s == NULL)
        return;
    EXPECT_TEXT(s->operands.at[0].value->text, "print \"a; h8 ");
    statement_free(s);
}

static void virtual_stands_before_joints(void)
{
    Statement *s = read_text("virtual revolute vh16 m1 m3 axis=z");

    if (s == NULL)
        return;
    EXPECT(s->is_virtual);
    EXPECT_TEXT(s->verb, "revolute");
    statement_free(s);
}

static void a_question_mark_is_help(void)
{
    Statement *s = read_text("?revolute");

    if (s == NULL)
        return;
    EXPECT_TEXT(s->verb, "help");
    expect_tree(s->operands.at[0].value, "revolute");
    statement_free(s);
}

static void words_are_shortened_at_the_prompt_only(void)
{
    Statement *s = read_as("sim 5", prompt);
    size_t next = 0;
    Diag diag;

    if (s == NULL)
        return;
    EXPECT_TEXT(s->verb, "simulate");
    statement_free(s);
    s = NULL;
    expect_fault("simul 5", E_NAME, 1, 1, 5);
    EXPECT(statement_parse("re r1", 1, prompt, &next, &s, &diag) == E_NAME);
    EXPECT(strstr(diag.message, "ambiguous") != NULL && strstr(diag.message, "resistor") != NULL);
    EXPECT(next == 0 && s == NULL);
    /* alone it may be a name */
    EXPECT(statement_parse("re", 1, prompt, &next, &s, &diag) == OK);
    EXPECT(s != NULL && strcmp(s->verb, "print") == 0 && s->unknown != NULL &&
           strstr(s->unknown->message, "ambiguous") != NULL);
    statement_free(s);
    s = NULL;
    next = 0;
}

/* --- lines --- */

static void statements_on_a_line_stand_between_semicolons(void)
{
    const char *text = "a = 1; title \"x; y\"; b = 2; # c = 3";
    static const char *const wanted[] = {"a = 1", "title \"x; y\"", "b = 2", ""};
    size_t next = 0;
    int count = 0;

    while (next < strlen(text) && count < COUNT(wanted)) {
        Statement *s = NULL;
        Diag diag;

        EXPECT(statement_parse(text, 1, script, &next, &s, &diag) == OK);
        if (s == NULL)
            return;
        EXPECT_TEXT(s->text, wanted[count++]);
        EXPECT(s->kind != STATEMENT_EMPTY || count == COUNT(wanted));
        statement_free(s);
    }
    EXPECT(count == COUNT(wanted) && next == strlen(text));
}

static void a_backslash_joins_lines(void)
{
    Statement *s = read_text("export csv a b \\\n   c \\\r\n   > \"x\"");

    if (s == NULL)
        return;
    EXPECT(s->operands.count == 4);
    EXPECT_TEXT(s->text, "export csv a b c > \"x\"");
    EXPECT(s->operands.at[3].place.line == 2 && s->operands.at[3].place.column == 4);
    statement_free(s);
}

static void places_are_those_of_the_physical_line(void)
{
    expect_fault("plot a \\\n  b -c", E_SYNTAX, 2, 5, 1);
    expect_fault("x = 1\nplto x", E_NAME, 2, 1, 4);
    expect_fault("x = 1\rplto x", E_NAME, 2, 1, 4);
    expect_fault("plot a \\\r  b -c", E_SYNTAX, 2, 5, 1);
    expect_fault("x = (1 + \\\n 2", E_SYNTAX, 1, 5, 1);
    expect_fault("x = (1\n + 2)", E_SYNTAX, 1, 5, 1);
}

static void carriage_returns_tabs_and_byte_order_marks_pass(void)
{
    Statement *s = read_text("\xEF\xBB\xBF\tx\t=\t3\t\r\n");

    if (s == NULL)
        return;
    EXPECT_TEXT(s->name, "x");
    statement_free(s);
}

static void strange_bytes_are_refused_at_their_place(void)
{
    expect_fault("x = \x01", E_SYNTAX, 1, 5, 1);
    expect_fault("title \"a\xFF\"", E_SYNTAX, 1, 9, 1);
    expect_fault("x = 1 # \xC3(", E_SYNTAX, 1, 9, 1);
    expect_fault("x = \xE2\x80\x9C", E_SYNTAX, 1, 5, 3);
    expect_fault("title \"\xED\xA0\x80\"", E_SYNTAX, 1, 8, 1);
    statement_free(read_text("title \"\xC3\xA9t\xC3\xA9 \xF0\x9F\x98\x80\" # na\xC3\xAFve"));
}

/* --- limits --- */

static char *repeat(const char *start, const char *unit, int count, const char *end)
{
    Text text = {0};

    text_add(&text, start);
    for (int i = 0; i < count; i++)
        text_add(&text, unit);
    text_add(&text, end);
    return text_done(&text);
}

static void deep_nesting_is_an_error_with_a_place(void)
{
    static const char *const units[] = {"(", "-", "[", "f(", "1^", "!", "(-"};

    for (int i = 0; i < COUNT(units); i++) {
        char *text = repeat("x = ", units[i], 100000, "1");
        size_t next = 0;
        Statement *s = NULL;
        Diag diag = {0};

        EXPECT(statement_parse(text, 1, script, &next, &s, &diag) == E_SYNTAX);
        EXPECT(diag.place.column > 100 && diag.place.column < 1000);
        mem_free(text);
    }
    for (int i = 0; i < 2; i++) {
        char *text = repeat("", i == 0 ? "time " : "sweep L=1 : ", 100000, "quit");
        size_t next = 0;
        Statement *s = NULL;

        EXPECT(statement_parse(text, 1, script, &next, &s, NULL) == E_SYNTAX);
        mem_free(text);
    }
}

static void long_sums_are_bounded_and_long_lists_are_not(void)
{
    char *text = repeat("x = 1", " + a", 900, "");
    char *longer = repeat("x = 1", " + a", 5000, "");
    char *list = repeat("plot", " h8", 100000, "");
    Statement *s = read_text(text);
    size_t next = 0;
    Diag diag = {0};

    EXPECT(s != NULL && s->value->height == 901);
    statement_free(s);
    s = NULL;
    EXPECT(statement_parse(longer, 1, script, &next, &s, &diag) == E_SYNTAX);
    EXPECT(strstr(diag.message, "in a row") != NULL);
    s = read_text(list);
    EXPECT(s != NULL && s->operands.count == 100000);
    statement_free(s);
    mem_free(text);
    mem_free(longer);
    mem_free(list);
}

/* --- scripts --- */

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    Text text = {0};
    char room[4096];
    size_t length;

    if (file == NULL)
        return NULL;
    while ((length = fread(room, 1, sizeof room, file)) > 0)
        text_add_n(&text, room, length);
    (void)fclose(file);
    return text_done(&text);
}

static int read_script(const char *path)
{
    char *text = read_file(path);
    size_t next = 0;
    int count = 0;

    EXPECT(text != NULL);
    while (text != NULL && next < strlen(text)) {
        Statement *s = NULL;
        Diag diag;

        if (statement_parse(text, 1, script, &next, &s, &diag) != OK) {
            printf("%s:%d:%d: %s\n", path, diag.place.line, diag.place.column, diag.message);
            test_faults++;
            break;
        }
        count += s->kind != STATEMENT_EMPTY ? 1 : 0;
        statement_free(s);
    }
    mem_free(text);
    return count;
}

static int scripts_read;

static int visit(const char *path, const struct stat *info, int type, struct FTW *where)
{
    size_t length = strlen(path);

    (void)info;
    (void)where;
    if (type == FTW_F && length > 3 && strcmp(path + length - 3, ".ct") == 0) {
        EXPECT(read_script(path) > 0);
        scripts_read++;
    }
    return 0;
}

static void every_script_reads(void)
{
    const char *source = getenv("TOP_SRCDIR");
    char path[1024];

    (void)snprintf(path, sizeof path, "%s/scripts", source != NULL ? source : ".");
    EXPECT(nftw(path, visit, 8, FTW_PHYS) == 0);
    EXPECT(scripts_read >= 10);
}

int main(void)
{
    RUN(operators_bind_as_in_mathematics);
    RUN(primes_and_calls_touch);
    RUN(a_literal_takes_a_unit);
    RUN(a_word_before_an_equals_sign_is_the_next_key);
    RUN(clear_products_of_units_and_names_pass);
    RUN(names_and_laws_are_definitions);
    RUN(a_component_has_name_places_values_and_keys);
    RUN(a_place_is_one_word_and_a_value_follows);
    RUN(a_spring_stands_on_two_frames_or_one_joint);
    RUN(pairs_take_expressions_up_to_the_next);
    RUN(trees_are_set_or_changed);
    RUN(what_prints_goes_to_a_file);
    RUN(elsewhere_greater_compares);
    RUN(expectations_have_a_tolerance);
    RUN(print_shows_expressions_in_units);
    RUN(show_takes_topics_entries_and_a_notation);
    RUN(a_statement_may_follow_a_colon);
    RUN(complete_takes_the_line_as_it_stands);
    RUN(virtual_stands_before_joints);
    RUN(a_question_mark_is_help);
    RUN(words_are_shortened_at_the_prompt_only);
    RUN(statements_on_a_line_stand_between_semicolons);
    RUN(a_backslash_joins_lines);
    RUN(places_are_those_of_the_physical_line);
    RUN(carriage_returns_tabs_and_byte_order_marks_pass);
    RUN(strange_bytes_are_refused_at_their_place);
    RUN(deep_nesting_is_an_error_with_a_place);
    RUN(long_sums_are_bounded_and_long_lists_are_not);
    RUN(every_script_reads);
    return test_end();
}

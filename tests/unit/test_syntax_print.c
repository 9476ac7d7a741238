/* test_syntax_print.c: a tree is printed as text that reads as the same tree */
#include "test.h"

#include "base/memory.h"
#include "language/syntax.h"

typedef struct Maker {
    uint64_t random;
    Pool *pool;
} Maker;

static Syntax *make_node(Maker *maker, SyntaxKind kind, const char *text, int count)
{
    Syntax *node = pool_alloc(maker->pool, sizeof *node);

    *node = (Syntax){.kind = kind, .text = text, .unit_text = "", .count = count};
    node->args = pool_alloc(maker->pool, (size_t)(count + 1) * sizeof(Syntax *));
    return node;
}

static int pick(Maker *maker, int count)
{
    return (int)(test_random(&maker->random) % (unsigned)count);
}

static Syntax *make_expression(Maker *maker, int level, int depth);

static bool starts_with_string(const Syntax *syntax)
{
    while (syntax->kind == SYNTAX_BINARY)
        syntax = syntax->args[0];
    return syntax->kind == SYNTAX_STRING;
}

/* what the grammar allows as a primary */
static Syntax *make_primary(Maker *maker, int depth)
{
    static const char *const numbers[] = {"0", "1", "2.5", ".5", "1e-3", "4.", "12e+4"};
    static const char *const names[] = {"x", "h8", "m3.x", "leg1.h2.fx", "a_b", "mass"};
    static const char *const units[] = {"[mm]", "[kN/m]", "[kg*m^2]", "[1/s]"};
    int kind = depth <= 0 ? pick(maker, 3) : pick(maker, 7);
    Syntax *node;

    if (kind == 0 || kind == 4) {
        node = kind == 0 ? make_node(maker, SYNTAX_NUMBER, numbers[pick(maker, COUNT(numbers))], 0)
                         : make_node(maker, SYNTAX_VECTOR, "", 1 + pick(maker, 3));
        if (pick(maker, 3) == 0) {
            node->has_unit = true;
            node->unit_text = units[pick(maker, COUNT(units))];
        }
    } else if (kind == 1 || kind == 3)
        node = make_node(maker, SYNTAX_VARIABLE, names[pick(maker, COUNT(names))], 0);
    else if (kind == 2)
        node = make_node(maker, SYNTAX_STRING, "a; b # c", 0);
    else if (kind == 5)
        node = make_node(maker, SYNTAX_CALL, names[pick(maker, COUNT(names))], 1 + pick(maker, 3));
    else
        node = make_node(maker, SYNTAX_GROUP, "", 1);
    if (kind == 1 || kind == 3 || kind == 5 || kind == 6)
        node->primes = pick(maker, 4) == 0 ? 1 + pick(maker, 3) : 0;
    for (int i = 0; i < node->count; i++)
        node->args[i] = make_expression(maker, 0, depth - 1);
    return node;
}

/* levels: 0 ||, 1 &&, 2 comparison, 3 sum, 4 product, 5 unary, 6 power, 7 primary */
static Syntax *make_expression(Maker *maker, int level, int depth)
{
    static const char *const ops[7][6] = {
        {"||"},          {"&&"}, {"<", "<=", ">", ">=", "==", "!="}, {"+", "-"}, {"*", "/"},
        {"-", "+", "!"}, {"^"}};
    static const int counts[7] = {1, 1, 6, 2, 2, 3, 1};
    Syntax *node;

    if (level == 7 || depth <= 0)
        return make_primary(maker, depth);
    if (pick(maker, 3) != 0)
        return make_expression(maker, level + 1, depth);
    node = make_node(maker, level == 5 ? SYNTAX_UNARY : SYNTAX_BINARY,
                     ops[level][pick(maker, counts[level])], level == 5 ? 1 : 2);
    if (level == 5)
        node->args[0] = make_expression(maker, 5, depth - 1);
    else {
        /* chains join from the left, comparisons not at all, powers from the right */
        node->args[0] = make_expression(maker, level == 2 ? 3 : level == 6 ? 7 : level, depth - 1);
        node->args[1] = make_expression(maker, level == 6 ? 5 : level + 1, depth - 1);
        /* > "file" is no comparison */
        if (starts_with_string(node->args[1]) && strcmp(node->text, ">") == 0)
            node->text = "<";
    }
    return node;
}

static bool same(const Syntax *a, const Syntax *b)
{
    if (a->kind != b->kind || strcmp(a->text, b->text) != 0 || a->primes != b->primes ||
        a->has_unit != b->has_unit || strcmp(a->unit_text, b->unit_text) != 0 ||
        a->count != b->count)
        return false;
    for (int i = 0; i < a->count; i++)
        if (!same(a->args[i], b->args[i]))
            return false;
    return true;
}

static void what_is_printed_reads_as_the_same_tree(void)
{
    Maker maker = {.random = 7};

    for (int i = 0; i < 20000 && test_faults == 0; i++) {
        Syntax *read = NULL;
        Text text = {0};
        Syntax *made;
        Diag diag = {0};

        maker.pool = pool_new(0);
        made = make_expression(&maker, 0, 1 + i % 7);
        syntax_print(&text, made);
        EXPECT(syntax_parse_expression(text.at, maker.pool, &read, &diag) == OK);
        EXPECT(read != NULL && same(made, read));
        if (read == NULL || !same(made, read))
            printf("%s\n%d: %s\n", text.at, diag.place.column, diag.message);
        text_free(&text);
        pool_free(maker.pool);
    }
}

static bool same_place(Place a, Place b)
{
    return a.line == b.line && a.column == b.column && a.width == b.width;
}

static bool same_places(const Syntax *a, const Syntax *b)
{
    bool same = same_place(a->place, b->place) && same_place(a->unit_place, b->unit_place) &&
                same_place(a->op_place, b->op_place);

    for (int i = 0; i < a->count; i++)
        same = same && same_places(a->args[i], b->args[i]);
    return same;
}

/* as written, and as a line of a definition */
static void copies_have_the_places_of_their_text(void)
{
    static const char *const texts[][2] = {
        {"revol  b A B axis=[1, 2, -3] ", "revolute  b A B axis=[1, 2, -3]"},
        {"  virtual   rev h A \\\n   b axis=z", "virtual revolute h A b axis=z"},
        {"f(x)  =  a*sin(x) \\\r\n\\\n + \\\n1 mm", "f(x)  =  a*sin(x) + 1 mm"},
        {"L = max(a, \\\n [1, \\\n 2 ]) + (3 \\\n -b)", "L = max(a, [1, 2 ]) + (3 -b)"},
        {" L = (2 mm)  - d.x # long", "L = (2 mm)  - d.x"},
        {"outpu P = h.T*h',   Q=1", "output P = h.T*h',   Q=1"}};

    for (int i = 0; i < COUNT(texts); i++) {
        Pool *pool = pool_new(0);
        Statement *written = NULL, *line = NULL, copy;
        Text text = {0};
        Diag diag = {0};
        bool same;

        text_addf(&text, "   %s", texts[i][1]);
        if (statement_parse(texts[i][0], 9, (SyntaxOptions){.shortened = true}, NULL, &written,
                            &diag) != OK ||
            statement_parse(text.at, 7, (SyntaxOptions){false}, NULL, &line, &diag) != OK) {
            EXPECT_TEXT(diag.message, "");
            continue;
        }
        statement_copy_to(pool, written, texts[i][1], 7, 4, &copy);
        EXPECT_TEXT(copy.text, line->text);
        same = same_place(copy.place, line->place) &&
               same_place(copy.verb_place, line->verb_place) &&
               same_place(copy.name_place, line->name_place) &&
               (copy.value == NULL || same_places(copy.value, line->value));
        for (int k = 0; k < copy.operands.count; k++)
            same = same && same_place(copy.operands.at[k].place, line->operands.at[k].place) &&
                   same_places(copy.operands.at[k].value, line->operands.at[k].value);
        for (int k = 0; k < copy.pairs.count; k++)
            same = same && same_place(copy.pairs.at[k].name_place, line->pairs.at[k].name_place) &&
                   same_places(copy.pairs.at[k].value, line->pairs.at[k].value);
        EXPECT(same);
        if (!same)
            printf("%s\n", texts[i][0]);
        text_free(&text);
        statement_free(written);
        statement_free(line);
        pool_free(pool);
    }
}

int main(void)
{
    RUN(copies_have_the_places_of_their_text);
    RUN(what_is_printed_reads_as_the_same_tree);
    return test_end();
}

/* family_units.c: random expressions with random units, made together with their dimension and
 * value
 *
 * Each expression is made for a dimension that was drawn before, so that what it is and what it is
 * worth are known without looking at it: units and their sizes are those of the SI brochure, in a
 * table of this file. Wrong ones are right ones with an operand or argument of another dimension.
 */
#include "../unit/session_kit.h"
#include "family.h"

#include <math.h>

enum { BASES = 5, DEEPEST = 5, TEXT = 6000, TRIES = 200 };

static const double pi = 3.14159265358979323846;

typedef struct Dim {
    int of[BASES]; /* m kg s A K; an angle is a number */
} Dim;

/* a unit that may stand behind a number, with the prefixes that may stand before it */
static const struct {
    const char *name;
    const char *prefixes;
    double size;
    Dim dim;
} units[] = {
    {"m", "mkuc", 1, {{1, 0, 0, 0, 0}}},     {"g", "mk", 1e-3, {{0, 1, 0, 0, 0}}},
    {"tonne", "", 1e3, {{0, 1, 0, 0, 0}}},   {"s", "mun", 1, {{0, 0, 1, 0, 0}}},
    {"min", "", 60, {{0, 0, 1, 0, 0}}},      {"hour", "", 3600, {{0, 0, 1, 0, 0}}},
    {"A", "mku", 1, {{0, 0, 0, 1, 0}}},      {"K", "m", 1, {{0, 0, 0, 0, 1}}},
    {"N", "kM", 1, {{1, 1, -2, 0, 0}}},      {"J", "kM", 1, {{2, 1, -2, 0, 0}}},
    {"W", "mk", 1, {{2, 1, -3, 0, 0}}},      {"Pa", "kM", 1, {{-1, 1, -2, 0, 0}}},
    {"bar", "m", 1e5, {{-1, 1, -2, 0, 0}}},  {"V", "mk", 1, {{2, 1, -3, -1, 0}}},
    {"ohm", "kM", 1, {{2, 1, -3, -2, 0}}},   {"S", "m", 1, {{-2, -1, 3, 2, 0}}},
    {"C", "mun", 1, {{0, 0, 1, 1, 0}}},      {"F", "unp", 1, {{-2, -1, 4, 2, 0}}},
    {"H", "mu", 1, {{2, 1, -2, -2, 0}}},     {"Wb", "m", 1, {{2, 1, -2, -1, 0}}},
    {"T", "m", 1, {{0, 1, -2, -1, 0}}},      {"L", "m", 1e-3, {{3, 0, 0, 0, 0}}},
    {"Wh", "k", 3600, {{2, 1, -2, 0, 0}}},   {"Ah", "m", 3600, {{0, 0, 1, 1, 0}}},
    {"gn", "", 9.80665, {{1, 0, -2, 0, 0}}},
};

/* units of each base alone, for what is left over in a compound */
static const struct {
    const char *name;
    double size;
} bases[BASES][3] = {{{"m", 1}, {"mm", 1e-3}, {"km", 1e3}},
                     {{"kg", 1}, {"g", 1e-3}, {"tonne", 1e3}},
                     {{"s", 1}, {"ms", 1e-3}, {"min", 60}},
                     {{"A", 1}, {"mA", 1e-3}, {"kA", 1e3}},
                     {{"K", 1}, {"mK", 1e-3}, {"K", 1}}};

/* what can be asked for at the start, with the value that `init` gives */
static const struct {
    const char *name;
    double value;
    Dim dim;
} variables[] = {{"s1", 0.7, {{1, 0, 0, 0, 0}}},     {"s1'", 1.3, {{1, 0, -1, 0, 0}}},
                 {"m1.x", 0.7, {{1, 0, 0, 0, 0}}},   {"m1.vx", 1.3, {{1, 0, -1, 0, 0}}},
                 {"C1.v", 2.5, {{2, 1, -3, -1, 0}}}, {"a.v", 2.5, {{2, 1, -3, -1, 0}}},
                 {"h1", 0.6, {{0, 0, 0, 0, 0}}},     {"h1'", 1.7, {{0, 0, -1, 0, 0}}}};

#define SCENE                                                                                      \
    "scene planar\nbody m1 mass=1 inertia=1\nbody m2 mass=1 inertia=1\n"                           \
    "prismatic s1 ground m1 axis=x\nrevolute h1 ground m2\n"                                       \
    "capacitor C1 a 0 1\nresistor R1 a 0 1\n"                                                      \
    "init s1 = 0.7, s1' = 1.3, h1 = 0.6, h1' = 1.7, C1.v = 2.5\n"                                  \
    "both(x, y) = abs(x) + abs(y)\ntimes(x, y) = x*y\nover(x, y) = x/y\nroot(x) = sqrt(x)\n"

enum { PARAMETERS = 4 };

/* what was made: of which dimension and value; `is_known`: no plain number hides it; has_units: one
 * was written */
typedef struct Made {
    double value;
    bool is_known;
    bool has_units;
} Made;

typedef struct Maker {
    Member *member;
    char text[TEXT];
    size_t length;
    Dim parameter[PARAMETERS];
    Made parameter_made[PARAMETERS];
    int parameters;
    bool spoil;     /* make one operand or argument of another dimension */
    bool all_known; /* no plain numbers */
    bool no_variables;
    bool is_spoiled; /* where: */
    size_t from, to;
    Dim of_spoiled;
} Maker;

/* --- chance --- */

static int draw(Maker *m, int count)
{
    return (int)(test_random(&m->member->random) % (uint64_t)count);
}

static Dim random_dim(Maker *m)
{
    const int i = draw(m, (int)(sizeof units / sizeof units[0]) + 3);

    if (i >= (int)(sizeof units / sizeof units[0]))
        return (Dim){{draw(m, 3) - 1, draw(m, 3) - 1, draw(m, 5) - 2, draw(m, 3) - 1, 0}};
    return units[i].dim;
}

static bool dim_same(Dim a, Dim b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static bool dim_is_none(Dim a)
{
    return dim_same(a, (Dim){{0}});
}

static Dim other_dim(Maker *m, Dim dim)
{
    Dim other = random_dim(m);

    while (dim_same(other, dim) || dim_is_none(other))
        other = random_dim(m);
    return other;
}

static Dim dim_plus(Dim a, Dim b, int times)
{
    for (int i = 0; i < BASES; i++)
        a.of[i] += times * b.of[i];
    return a;
}

static int dim_size(Dim a)
{
    int size = 0;

    for (int i = 0; i < BASES; i++)
        size += abs(a.of[i]);
    return size;
}

/* --- text --- */

static void put(Maker *m, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    const int more = vsnprintf(m->text + m->length, TEXT - m->length, format, arguments);
    va_end(arguments);
    if (more > 0 && m->length + (size_t)more < TEXT)
        m->length += (size_t)more;
}

static double prefix_size(char prefix)
{
    static const char letters[] = "pnumckM";
    static const double sizes[] = {1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 1e3, 1e6};

    return sizes[strchr(letters, prefix) - letters];
}

/* one unit of the table, a prefix before it; its size */
static double put_named(Maker *m, int i)
{
    const size_t count = strlen(units[i].prefixes);
    const int k = draw(m, (int)count + 1);

    if (k == (int)count) {
        put(m, "%s", units[i].name);
        return units[i].size;
    }
    put(m, "%c%s", units[i].prefixes[k], units[i].name);
    return units[i].size * prefix_size(units[i].prefixes[k]);
}

static void put_power(Maker *m, const char *name, int power, bool *first)
{
    put(m, *first ? (power < 0 ? "1/%s" : "%s") : (power < 0 ? "/%s" : "*%s"), name);
    if (abs(power) > 1)
        put(m, "^%d", abs(power));
    *first = false;
}

/* a compound unit in brackets; its size */
static double put_compound(Maker *m, Dim dim, bool with_angle)
{
    const int count = (int)(sizeof units / sizeof units[0]);
    const int with = draw(m, 2 * count);
    bool first = true;
    double size = 1;

    put(m, "[");
    if (with < count) {
        size = put_named(m, with);
        dim = dim_plus(dim, units[with].dim, -1);
        first = false;
    }
    for (int i = 0; i < BASES; i++) {
        const int k = draw(m, 3);

        if (dim.of[i] == 0)
            continue;
        put_power(m, bases[i][k].name, dim.of[i], &first);
        size *= pow(bases[i][k].size, dim.of[i]);
    }
    if (with_angle && draw(m, 6) == 0) {
        put_power(m, "deg", 1, &first);
        size *= pi / 180;
    }
    if (first)
        put(m, "1");
    put(m, "]");
    return size;
}

/* a unit of the dimension, behind a number or an item; its size */
static double put_unit(Maker *m, Dim dim, bool in_brackets, bool with_angle)
{
    int matching[64];
    int count = 0;
    double size;

    for (int i = 0; i < (int)(sizeof units / sizeof units[0]); i++)
        if (dim_same(units[i].dim, dim))
            matching[count++] = i;
    if (count == 0 || draw(m, 3) == 0)
        return put_compound(m, dim, with_angle);
    put(m, in_brackets ? "[" : "");
    size = put_named(m, matching[draw(m, count)]);
    put(m, in_brackets ? "]" : "");
    return size;
}

/* --- expressions --- */

static Made make(Maker *m, Dim dim, int depth);

static Made make_literal(Maker *m, Dim dim)
{
    const double number = 0.5 + 0.25 * draw(m, 7);
    Made out = {number, true, true};

    if (!m->all_known && draw(m, 8) == 0) {
        put(m, "%g", number);
        return (Made){number, false, false};
    }
    /* in brackets of its own, or a power behind it would be taken for its unit's */
    put(m, "(%g ", number);
    out.value *= put_unit(m, dim, false, true);
    put(m, ")");
    return out;
}

static Made make_leaf(Maker *m, Dim dim)
{
    const int first = draw(m, 100);

    for (int k = 0; k < 100 && draw(m, 3) > 0; k++) {
        const int i = (first + k) % (int)(sizeof variables / sizeof variables[0]);
        const int p = (first + k) % PARAMETERS;

        if (!m->no_variables && dim_same(variables[i].dim, dim)) {
            put(m, "%s", variables[i].name);
            return (Made){variables[i].value, true, false};
        }
        if (p < m->parameters && dim_same(m->parameter[p], dim)) {
            put(m, "p%d", p);
            return m->parameter_made[p];
        }
    }
    return make_literal(m, dim);
}

/* What stands beside `dim` in a sum: of the same, or where the expression is to be spoiled, and
 * then *wrong, of another. */
static Dim beside(Maker *m, Dim dim, int depth, bool *wrong)
{
    *wrong = m->spoil && !m->is_spoiled && (depth == 0 || draw(m, 3) == 0);
    if (!*wrong)
        return dim;
    m->is_spoiled = true;
    m->of_spoiled = dim;
    return other_dim(m, dim);
}

static Made joined(Made a, Made b, double value)
{
    return (Made){value, a.is_known || b.is_known, a.has_units || b.has_units};
}

/* The sum, or the difference where that cancels less: the sign in the text follows. */
static double add(Maker *m, size_t sign, double a, double b)
{
    const bool plus = m->text[sign] == '+';
    const double sum = a + b, difference = a - b;
    const double better = fabs(sum) > fabs(difference) ? sum : difference;

    if (fabs(plus ? sum : difference) >= 0.01 * fabs(better))
        return plus ? sum : difference;
    m->text[sign] = better == sum ? '+' : '-';
    return better;
}

/* two of one dimension */
static Made make_alike(Maker *m, Dim dim, int depth)
{
    /* before, between, behind; what it is worth */
    static const char *const forms[][3] = {{"(", " + ", ")"},         {"min(", ", ", ")"},
                                           {"max(", ", ", ")"},       {"both(", ", ", ")"},
                                           {"if(1 < 2, ", ", ", ")"}, {"(", " - ", ")"}};
    const int form = draw(m, 6);
    const size_t start = m->length;
    size_t sign;
    bool wrong;
    const Dim second = beside(m, dim, depth, &wrong);
    Made a, b;

    put(m, "%s", forms[form][0]);
    a = make(m, dim, depth - 1);
    sign = m->length + 1;
    put(m, "%s", forms[form][1]);
    b = make(m, second, depth - 1);
    put(m, "%s", forms[form][2]);
    if (wrong) {
        m->from = start;
        m->to = m->length;
    }
    switch (form) {
    case 1:
        return joined(a, b, fmin(a.value, b.value));
    case 2:
        return joined(a, b, fmax(a.value, b.value));
    case 3:
        return joined(a, b, fabs(a.value) + fabs(b.value));
    case 4:
        return joined(a, b, a.value);
    default:
        return joined(a, b, add(m, sign, a.value, b.value));
    }
}

static Made multiplied(Made a, Made b, double value)
{
    return (Made){value, a.is_known && b.is_known, a.has_units || b.has_units};
}

static Made make_product(Maker *m, Dim dim, int depth)
{
    const Dim by = random_dim(m);
    const bool divides = draw(m, 2) == 0;
    const int form = draw(m, 3);
    const Dim first = dim_plus(dim, by, divides ? 1 : -1);
    Made a, b;

    if (dim_size(first) > 14)
        return make_leaf(m, dim);
    put(m, form == 0 ? (divides ? "over(" : "times(") : "(");
    a = make(m, first, depth - 1);
    put(m, form == 0 ? ", " : divides ? "/" : "*");
    b = make(m, by, depth - 1);
    put(m, ")");
    return multiplied(a, b, divides ? a.value / b.value : a.value * b.value);
}

/* dim = 2 e: a square; else the root of a square, which every dimension has */
static Made make_power(Maker *m, Dim dim, int depth)
{
    bool even = true;
    Dim half = dim;
    Made a;

    for (int i = 0; i < BASES; i++) {
        even = even && dim.of[i] % 2 == 0;
        half.of[i] = dim.of[i] / 2;
    }
    if (even && draw(m, 2) == 0) {
        put(m, "(");
        a = make(m, half, depth - 1);
        put(m, ")^%s", draw(m, 2) == 0 ? "2" : "(4/2)");
        a.value = a.value * a.value;
        return a;
    }
    if (dim_size(dim) > 7)
        return make_leaf(m, dim);
    put(m, draw(m, 2) == 0 ? "sqrt(abs(" : "root(abs(");
    a = make(m, dim_plus(dim, dim, 1), depth - 1);
    put(m, "))");
    a.value = sqrt(fabs(a.value));
    return a;
}

/* tanh(number)*x, whose argument may be spoiled: only with a unit is it sure to be wrong */
static Made make_scaled(Maker *m, Dim dim, int depth)
{
    const size_t start = m->length;
    bool wrong;
    const Dim inside = beside(m, (Dim){{0}}, depth, &wrong);
    Made a, b;

    put(m, "(tanh(");
    a = wrong ? make_literal(m, inside) : make(m, inside, depth - 1);
    put(m, ")");
    if (wrong) {
        m->from = start;
        m->to = m->length;
    }
    put(m, "*");
    b = make(m, dim, depth - 1);
    put(m, ")");
    return (Made){tanh(a.value) * b.value, b.is_known, b.has_units};
}

static Made make_signed(Maker *m, Dim dim, int depth)
{
    const bool minus = draw(m, 2) == 0;
    Made a;

    put(m, minus ? "(-" : "abs(");
    a = make(m, dim, depth - 1);
    put(m, ")");
    a.value = minus ? -a.value : fabs(a.value);
    return a;
}

static Made make(Maker *m, Dim dim, int depth)
{
    static Made (*const ways[])(Maker *, Dim, int) = {
        make_alike, make_alike, make_product, make_product, make_power, make_scaled, make_signed};

    if (depth <= 0 || m->length > TEXT / 2)
        return make_leaf(m, dim);
    return ways[draw(m, 7)](m, dim, depth);
}

/* --- the program beside it --- */

/* one statement after the scene: parameters of random dimensions, also of ones that are wanted */
static void set_up(Maker *m, Kit *kit, Dim dim)
{
    char line[TEXT + 20];

    EXPECT_DONE(kit, SCENE);
    for (int p = 0; p < PARAMETERS; p++) {
        m->length = 0;
        m->parameter[p] = p == 0 ? dim : random_dim(m);
        m->parameter_made[p] = make_literal(m, m->parameter[p]);
        (void)snprintf(line, sizeof line, "p%d = %s", p, m->text);
        tell(m->member, "%s\n", line);
        EXPECT_DONE(kit, line);
    }
    m->parameters = PARAMETERS;
    m->length = 0;
    m->text[0] = '\0';
}

static ct_status value_of(Kit *kit, const char *text, double *value)
{
    char line[TEXT + 300];
    ct_statement *statement = NULL;

    (void)snprintf(line, sizeof line, "print %s", text);
    if (ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit->error) != CT_OK)
        return CT_FAILED;

    const ct_status status =
        ct_value(kit->session, ct_operand(statement, 0), NULL, value, &kit->error);

    ct_statement_free(statement);
    return status;
}

static bool is_about_units(const char *message)
{
    static const char *const parts[] = {"can't be added",
                                        "can't be subtracted",
                                        "can't be compared",
                                        "can't be arguments",
                                        "can't be shown in",
                                        " expected for ",
                                        " takes a number or an angle"};

    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (strstr(message, parts[i]) != NULL)
            return true;
    return false;
}

/* --- the claims --- */

static Verdict right_ones_have_their_value(Member *member)
{
    Maker m = {.member = member};
    Kit kit = kit_new();
    const Dim dim = random_dim(&m);
    double value = NAN, size;
    Made made;
    Verdict verdict = AGREES;

    set_up(&m, &kit, dim);
    put(&m, "(");
    made = make(&m, dim, 1 + draw(&m, DEEPEST));
    put(&m, ") ");
    size = put_unit(&m, dim, true, false);
    tell(member, "%s\nis %.15g\n", m.text, made.value / size);
    if (value_of(&kit, m.text, &value) != CT_OK) {
        tell(member, "column %d: %s\n", kit.error.column, kit.error.message);
        verdict = DISAGREES;
    } else if (isfinite(made.value) && fabs(value * size - made.value) > 1e-6 * fabs(made.value)) {
        tell(member, "got %.15g\n", value);
        verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* spoiled so that both dimensions are known, within TRIES */
static Made make_spoiled(Maker *m, Dim dim)
{
    Made made = {0};

    m->spoil = m->all_known = true;
    for (int i = 0; i < TRIES && !m->is_spoiled; i++) {
        m->length = 0;
        made = make(m, dim, 1 + draw(m, DEEPEST));
    }
    return made;
}

static Verdict wrong_operands_are_refused_where_they_stand(Member *member)
{
    Maker m = {.member = member};
    Kit kit = kit_new();
    const Dim dim = random_dim(&m);
    const int before = (int)strlen("print ");
    double value;
    Verdict verdict = AGREES;

    m.all_known = true;
    set_up(&m, &kit, dim);
    (void)make_spoiled(&m, dim);
    tell(member, "%s\nwrong in columns %d to %d\n", m.text, (int)m.from + before + 1,
         (int)m.to + before);
    if (!m.is_spoiled || value_of(&kit, m.text, &value) == CT_OK ||
        !is_about_units(kit.error.message) || kit.error.column <= (int)m.from + before ||
        kit.error.column > (int)m.to + before || kit.error.width < 1) {
        tell(member, "got column %d: %s\n", kit.error.column, kit.error.message);
        verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

static Verdict what_is_known_is_shown_in_no_other_unit(Member *member)
{
    Maker m = {.member = member};
    Kit kit = kit_new();
    const Dim dim = random_dim(&m);
    double value;
    Made made;
    Verdict verdict = AGREES;

    set_up(&m, &kit, dim);
    put(&m, "(");
    made = make(&m, dim, 1 + draw(&m, DEEPEST));
    put(&m, ") ");
    (void)put_unit(&m, other_dim(&m, dim), true, false);
    tell(member, "%s\nis %s\n", m.text, made.is_known ? "known" : "not known");
    if ((value_of(&kit, m.text, &value) != CT_OK) != made.is_known ||
        (made.is_known && strstr(kit.error.message, "can't be shown in") == NULL)) {
        tell(member, "got %s\n", kit.error.message);
        verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* places where a dimension is wanted, with what may stand there: numbers and parameters alone, or
 * variables too */
static const struct {
    const char *before;
    const char *behind;
    Dim dim;
    bool takes_variables;
} places[] = {
    {"body q mass=abs(", ")", {{0, 1, 0, 0, 0}}, false},
    {"arm q m1 [0, ", "]", {{1, 0, 0, 0, 0}}, false},
    {"gravity [", ", 0]", {{1, 0, -2, 0, 0}}, false},
    {"init s1' = ", "", {{1, 0, -1, 0, 0}}, false},
    {"guess h1' = ", "", {{0, 0, -1, 0, 0}}, false},
    {"init C1.v = ", "", {{2, 1, -3, -1, 0}}, false},
    {"set R1.R = ", "", {{2, 1, -3, -2, 0}}, true},
    {"inductor q a b ", "", {{2, 1, -2, -2, 0}}, true},
    {"vsource q c 0 ", "", {{2, 1, -3, -1, 0}}, true},
    {"isource q c 0 ", "", {{0, 0, 0, 1, 0}}, true},
    {"actuator q s1 force=", "", {{1, 1, -2, 0, 0}}, true},
    {"actuator q h1 torque=", "", {{2, 1, -2, 0, 0}}, true},
    {"force q m1 [0, ", "]", {{1, 1, -2, 0, 0}}, true},
    {"spring q s1 k=", "", {{0, 1, -2, 0, 0}}, false},
    {"spring q h1 k=", "", {{2, 1, -2, 0, 0}}, false},
    {"damper q s1 d=", "", {{0, 1, -1, 0, 0}}, true},
    {"heatcap q c 0 C=abs(", ")", {{2, 1, -2, 0, -1}}, false},
    {"pump q c 0 pressure=", "", {{-1, 1, -2, 0, 0}}, true},
    {"torquesource q c 0 ", "", {{2, 1, -2, 0, 0}}, true},
    {"driver q s1 = ", "", {{1, 0, 0, 0, 0}}, false},
    {"event q when=s1 > ", " do=stop", {{1, 0, 0, 0, 0}}, true},
    {"event q when=s1 > 1 C1.v=", "", {{2, 1, -3, -1, 0}}, true},
    {"expect s1 ~ ", " within 1e30", {{1, 0, 0, 0, 0}}, true},
    {"expect C1.v < 1e30 || C1.v > ", "", {{2, 1, -3, -1, 0}}, true},
    {"output q = R1.i + ", "", {{0, 0, 0, 1, 0}}, true},
};

/* of a place: what is right is taken, what is wrong refused, and nothing changes */
static Verdict places_take_what_is_right_alone(Member *member)
{
    Maker m = {.member = member};
    Kit kit = kit_new();
    const int i = draw(&m, (int)(sizeof places / sizeof places[0]));
    const bool right = draw(&m, 2) == 0;
    const Dim dim = right ? places[i].dim : other_dim(&m, places[i].dim);
    char line[TEXT + 200];
    char *before, *after;
    Made made = {0};
    Verdict verdict = AGREES;

    set_up(&m, &kit, dim);
    m.all_known = !right;
    m.no_variables = !places[i].takes_variables;
    do {
        m.length = 0;
        made = make(&m, dim, 1 + draw(&m, DEEPEST - 1));
    } while (!right && !(made.has_units && made.is_known));
    (void)snprintf(line, sizeof line, "%s%s%s", places[i].before, m.text, places[i].behind);
    tell(member, "%s\nis %s\n", line, right ? "right" : "wrong");
    before = ct_save(kit.session);

    const ct_status status = kit_do(&kit, line);
    /* what has no place for variables says so first; a value may be one that no part can have */
    const bool about = status != CT_OK && is_about_units(kit.error.message);
    const bool elsewhere = status != CT_OK && !about;

    after = ct_save(kit.session);
    if (elsewhere)
        verdict = REFUSED;
    else if (about == right || (!right && strcmp(before, after) != 0))
        verdict = DISAGREES;
    tell(member, "got %s\n", status == CT_OK ? "nothing" : kit.error.message);
    ct_free(before);
    ct_free(after);
    kit_free(&kit);
    return verdict;
}

/* a parameter that stands in a sum of a known dimension takes another value, no other dimension */
static Verdict parameters_keep_the_dimension_they_are_used_in(Member *member)
{
    Maker m = {.member = member};
    Kit kit = kit_new();
    const Dim dim = random_dim(&m), other = other_dim(&m, dim);
    char line[TEXT + 200], again[TEXT + 20];
    double value = NAN;
    Made made, next;
    Verdict verdict = AGREES;

    set_up(&m, &kit, dim);
    m.all_known = true;
    m.parameters = 0;
    made = make(&m, dim, 2);
    (void)snprintf(line, sizeof line, "output q = p0 + (%s)", m.text);
    tell(member, "%s\n", line);
    if (!made.is_known || kit_do(&kit, line) != CT_OK)
        verdict = DISAGREES;
    m.length = 0;
    (void)make_literal(&m, other);
    (void)snprintf(again, sizeof again, "p0 = %s", m.text);
    tell(member, "%s is refused\n", again);
    if (kit_do(&kit, again) == CT_OK || strstr(kit.error.message, "what uses p0") == NULL)
        verdict = DISAGREES;
    m.length = 0;
    next = make_literal(&m, dim);
    (void)snprintf(again, sizeof again, "p0 = %s", m.text);
    tell(member, "%s makes it %.15g\n", again, made.value + next.value);
    if (kit_do(&kit, again) != CT_OK || value_of(&kit, "q", &value) != CT_OK ||
        fabs(value - made.value - next.value) > 1e-6 * (fabs(made.value) + fabs(next.value)))
        verdict = DISAGREES;
    tell(member, "got %.15g %s\n", value, kit.error.message);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"right ones have their value", 400, 0, 0, right_ones_have_their_value},
        {"wrong operands are refused where they stand", 400, 0, 0,
         wrong_operands_are_refused_where_they_stand},
        {"what is known is shown in no other unit", 300, 0, 0,
         what_is_known_is_shown_in_no_other_unit},
        {"places take what is right alone", 600, 0.05, 0, places_take_what_is_right_alone},
        {"parameters keep the dimension they are used in", 300, 0, 0,
         parameters_keep_the_dimension_they_are_used_in},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

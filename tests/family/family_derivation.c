/* family_derivation.c: the terms that `show derivation` prints, as numbers, in random models
 *
 * What is read is the printed text alone, by a reader of this file. The oracle is Newton's law in
 * the numbers of a run: accelerations and multipliers at a start come from the recursive form,
 * which knows no terms. So in each row of motion the terms of M times accelerations, and those of
 * the Jacobian times multipliers, must make up those of F. The terms of a constraint must add up to
 * 0 in an assembled position. */
#include "../unit/session_kit.h"
#include "shown_models.h"

enum { MOST_ROWS = 24 };

/* --- what is printed, as a number --- */

/* names of subexpressions, "where w1 = ..." */
enum { MOST_WHERE = 4000 };
static double where[MOST_WHERE];

/* A printed formula with the values of variables: sums and products as people read them, without
 * the program's own reader, since a coefficient 1 takes its unit along when it goes. */
typedef struct Formula {
    Kit *kit;
    const char *at;
} Formula;

static double read_sum(Formula *f);

static bool starts(Formula *f, const char *text)
{
    if (strncmp(f->at, text, strlen(text)) != 0)
        return false;
    f->at += strlen(text);
    return true;
}

/* w12, or a variable with its dots and primes */
static double read_name(Formula *f)
{
    const size_t length = strspn(f->at, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789_.'");
    char name[80];

    (void)snprintf(name, sizeof name, "%.*s", (int)length, f->at);
    f->at += length;
    if (name[0] == 'w' && strspn(name + 1, "0123456789") == length - 1 && length > 1)
        return atoi(name + 1) < MOST_WHERE ? where[atoi(name + 1)] : NAN;
    return length > 0 ? kit_value(f->kit, name) : NAN;
}

/* The angle of (x, y) that is nearest to where the joint is: "unwrap(y, x, j0.near)". */
static double read_unwrapped(Formula *f)
{
    const double y = read_sum(f), x = starts(f, ", ") ? read_sum(f) : NAN;
    const size_t length = starts(f, ", ") ? strcspn(f->at, ".") : 0;
    char joint[40];

    (void)snprintf(joint, sizeof joint, "%.*s", (int)length, f->at);
    f->at += length;
    if (!starts(f, ".near)"))
        return NAN;

    const double angle = atan2(y, x);

    return angle + 2 * M_PI * round((kit_value(f->kit, joint) - angle) / (2 * M_PI));
}

static double read_primary(Formula *f)
{
    static const struct {
        const char *name;
        double (*value)(double);
    } calls[] = {{"", NULL},   {"sin", sin},   {"cos", cos},
                 {"tan", tan}, {"sqrt", sqrt}, {"exp", exp}};
    char *end;

    for (int i = 0; i < COUNT(calls); i++) {
        char open[8];

        (void)snprintf(open, sizeof open, "%s(", calls[i].name);
        if (!starts(f, open))
            continue;

        const double inside = read_sum(f);

        if (!starts(f, ")"))
            return NAN;
        return calls[i].value != NULL ? calls[i].value(inside) : inside;
    }
    if (starts(f, "unwrap("))
        return read_unwrapped(f);
    if (*f->at < '0' || *f->at > '9')
        return read_name(f);

    const double number = strtod(f->at, &end);

    f->at = end;
    return number;
}

static double read_power(Formula *f)
{
    const double base = read_primary(f);

    return starts(f, "^") ? pow(base, starts(f, "-") ? -read_primary(f) : read_primary(f)) : base;
}

static double read_product(Formula *f)
{
    double value = starts(f, "-") ? -read_power(f) : read_power(f);

    for (;;)
        if (starts(f, "*"))
            value *= read_power(f);
        else if (starts(f, "/"))
            value /= read_power(f);
        else
            return value;
}

static double read_sum(Formula *f)
{
    double value = read_product(f);

    for (;;)
        if (starts(f, " + "))
            value += read_product(f);
        else if (starts(f, " - "))
            value -= read_product(f);
        else
            return value;
}

/* The value of a text; NAN where it is no formula. */
static double value_of(Kit *kit, const char *text, size_t length)
{
    char *copy = malloc(length + 1);
    Formula f = {kit, copy};

    memcpy(copy, text, length);
    copy[length] = '\0';

    const double value = read_sum(&f);
    const bool is_whole = *f.at == '\0';

    free(copy);
    return is_whole ? value : NAN;
}

/* the definitions, each over earlier ones */
static void read_where(Kit *kit, const char *text)
{
    for (const char *line = strstr(text, "where w1 = "); line != NULL; line = strchr(line, '\n')) {
        int number = 0, start = 0;

        line += strspn(line, "\n ");
        if (strncmp(line, "where ", 6) == 0)
            line += 6;
        if (sscanf(line, "w%d = %n", &number, &start) != 1 || start == 0 || number >= MOST_WHERE)
            return;
        where[number] = value_of(kit, line + start, strcspn(line + start, "\n"));
    }
}

/* what the terms that the statement's text lists add up to; false: it has none */
static bool read_terms(Kit *kit, const char *statement, double *out)
{
    if (kit_do(kit, statement) != CT_OK || kit->text == NULL)
        return false;

    char *text = strdup(kit->text);

    *out = 0;
    read_where(kit, text);
    for (const char *line = text; line != NULL && *line != '\0';) {
        const char *end = strchr(line, '\n'), *value = strstr(line, " = ");
        const bool is_term = strncmp(line, "  ", 2) == 0 && line[2] != ' ';
        const size_t length = end != NULL ? (size_t)(end - line) : strlen(line);

        if (is_term && value != NULL && value < line + length)
            *out += value_of(kit, value + 3, (size_t)(line + length - value) - 3);
        line = end != NULL ? end + 1 : NULL;
    }
    free(text);
    return true;
}

static bool entry_of(Member *m, Kit *kit, const char *block, int row, int column, double *out)
{
    char statement[80];

    if (column > 0)
        (void)snprintf(statement, sizeof statement, "show derivation %s(%d,%d)", block, row,
                       column);
    else
        (void)snprintf(statement, sizeof statement, "show derivation %s(%d)", block, row);
    if (!read_terms(kit, statement, out)) {
        tell(m, "%s: %s\n", statement, kit->error.message);
        return false;
    }
    if (m->told)
        tell(m, "%s: %.17g\n", statement, *out);
    return true;
}

/* the speed of row i and its acceleration: "j0''", "b1.x''" */
static bool acceleration_of(Kit *kit, int row, double *out)
{
    char statement[48], name[64];
    const char *mark;

    (void)snprintf(statement, sizeof statement, "show derivation forces(%d)", row);
    if (kit_do(kit, statement) != CT_OK || kit->text == NULL ||
        (mark = strstr(kit->text, "row of ")) == NULL)
        return false;
    (void)snprintf(name, sizeof name, "%.*s'", (int)strcspn(mark + 7, "\n"), mark + 7);
    *out = kit_value(kit, name);
    return true;
}

static Verdict check_rows(Member *m, Kit *kit)
{
    const int rows = (int)kit_value(kit, "model.m");
    double rates[MOST_ROWS], entry;
    bool good = true;
    int n = 0;

    while (n < MOST_ROWS && acceleration_of(kit, n + 1, &rates[n]))
        n++;
    if (n == MOST_ROWS)
        return REFUSED;
    if (n == 0)
        return DISAGREES;
    for (int j = 0; j < n; j++) {
        double off = 0, size = 1;

        for (int k = 0; k < n; k++) {
            if (!entry_of(m, kit, "mass", j + 1, k + 1, &entry))
                return DISAGREES;
            off += entry * rates[k];
            size += fabs(entry * rates[k]);
        }
        for (int k = 0; k < rows; k++) {
            char lambda[24];

            (void)snprintf(lambda, sizeof lambda, "lambda(%d)", k + 1);
            if (!entry_of(m, kit, "jacobian", k + 1, j + 1, &entry))
                return DISAGREES;
            off += entry * kit_value(kit, lambda);
            size += fabs(entry * kit_value(kit, lambda));
        }
        if (!entry_of(m, kit, "forces", j + 1, 0, &entry))
            return DISAGREES;
        good = keeps(m, "row of motion", fabs(off - entry) / size, 1e-9) && good;
    }
    for (int k = 0; k < rows; k++) {
        if (!entry_of(m, kit, "constraints", k + 1, 0, &entry))
            return DISAGREES;
        good = keeps(m, "constraint", fabs(entry), 1e-9) && good;
    }
    return good ? AGREES : DISAGREES;
}

static Verdict check_shape(Member *m, const Shape *shape)
{
    const ct_hooks hooks = {.columns = 0};
    Kit kit = {.session = ct_session_new(&hooks)};
    Verdict verdict = DISAGREES;

    tell(m, "%s", shape->script.text);
    if (kit_do(&kit, shape->script.text) == CT_OK)
        verdict = check_rows(m, &kit);
    else
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

static Verdict plane_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_chain(m, &shape, true);
    return check_shape(m, &shape);
}

static Verdict space_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_chain(m, &shape, false);
    return check_shape(m, &shape);
}

static Verdict crank_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_crank(m, &shape);
    return check_shape(m, &shape);
}

static const Family families[] = {
    {"terms shown of plane chains obey Newton's law", 80, 0, 0, plane_member},
    {"terms shown of spatial chains obey Newton's law", 40, 0.5, 0, space_member},
    {"terms shown of slider-cranks obey Newton's law", 80, 0, 0, crank_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}

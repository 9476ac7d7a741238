/* family_printed.c: printed equations hold in the motion that a run has
 *
 * `show equations` is read as mathematics, in each notation, by a reader of this file, which shares
 * nothing with the program's. At the start of a run every equation has to hold: with the
 * accelerations, multipliers and rates of networks that come from the recursive form, which knows
 * no printed formula. The entries of M are read likewise, and M has to be symmetric. */
#include "../unit/session_kit.h"
#include "shown_models.h"

#include <ctype.h>

typedef enum Style { PLAIN, C_CODE, PYTHON, FORTRAN, MATLAB, LATEX, STYLES } Style;
static const char *const words[] = {"text", "c", "python", "fortran", "matlab", "latex"};

/* --- a reader of all notations --- */

enum { MOST_NAMES = 512, MOST_WHERE = 4000 };

typedef struct Reader {
    Kit *kit;
    Style style;
    const char *at;
    double size; /* sum of the sizes of the terms of sums outside of brackets */
    int depth;
    int known;
    struct {
        char name[80];
        double value;
    } names[MOST_NAMES];
    double where[MOST_WHERE];
    bool failed;
    char missed[80];
} Reader;

static double read_sum(Reader *r);

/* white space, and how LaTeX breaks lines, also within brackets */
static void skip_blanks(Reader *r)
{
    static const char *const blanks[] = {"&", "\\,", "\\quad", "\\\\", "\\right.", "\\left.", "{}"};
    bool found = true;

    while (found) {
        found = isspace((unsigned char)*r->at);
        r->at += found;
        for (int i = 0; i < COUNT(blanks) && !found; i++) {
            found = strncmp(r->at, blanks[i], strlen(blanks[i])) == 0;
            r->at += found ? strlen(blanks[i]) : 0;
        }
    }
}

static bool starts(Reader *r, const char *text)
{
    skip_blanks(r);
    if (strncmp(r->at, text, strlen(text)) != 0)
        return false;
    r->at += strlen(text);
    return true;
}

/* the value of a variable, by its name in the language of models; NAN: there is none */
static double value_named(Reader *r, const char *name)
{
    char of[80];
    int i = 0;

    /* the reference of an angle is next to it */
    (void)snprintf(of, sizeof of, "%s", name);
    if (strlen(of) > 5 && strcmp(of + strlen(of) - 5, ".near") == 0)
        of[strlen(of) - 5] = '\0';
    while (i < r->known && strcmp(r->names[i].name, name) != 0)
        i++;
    if (i == r->known && i < MOST_NAMES) {
        (void)snprintf(r->names[i].name, sizeof r->names[i].name, "%s", name);
        r->names[i].value = strcmp(name, "t") == 0 ? 0 : kit_value(r->kit, of);
        r->known++;
    }
    return i < MOST_NAMES ? r->names[i].value : NAN;
}

static bool is_where(const char *name)
{
    return name[0] == 'w' && name[1] != '\0' && strspn(name + 1, "0123456789") == strlen(name) - 1;
}

static double where_named(Reader *r, const char *name)
{
    const int number = atoi(name + 1);

    return number < MOST_WHERE ? r->where[number] : NAN;
}

/* m1_theta_dd is m1.theta'', lambda_3_ is lambda(3) */
static double value_of_code(Reader *r, const char *code)
{
    const char *primes = "";
    char base[80], name[96];
    size_t length = strlen(code);
    int number;
    double value;

    if (sscanf(code, "lambda_%d_", &number) == 1) {
        (void)snprintf(name, sizeof name, "lambda(%d)", number);
        return value_named(r, name);
    }
    if (length > 3 && strcmp(code + length - 3, "_dd") == 0) {
        primes = "''";
        length -= 3;
    } else if (length > 2 && strcmp(code + length - 2, "_d") == 0) {
        primes = "'";
        length -= 2;
    }
    (void)snprintf(base, sizeof base, "%.*s", (int)length, code);
    (void)snprintf(name, sizeof name, "%s%s", base, primes);
    value = strchr(base, '_') == NULL ? value_named(r, name) : NAN;
    if (strchr(base, '_') != NULL) {
        *strchr(base, '_') = '.';
        (void)snprintf(name, sizeof name, "%s%s", base, primes);
        value = value_named(r, name);
    }
    return value;
}

/* "m_{1}.\ddot{\theta}" is m1.theta'' */
static double read_latex_name(Reader *r)
{
    char name[80] = "", primes[3] = "";
    size_t length = 0;
    bool is_lambda = false;

    for (int braces = 0; length + 8 < sizeof name;) {
        if (strncmp(r->at, "\\ddot{", 6) == 0 || strncmp(r->at, "\\dot{", 5) == 0) {
            (void)strcat(primes, r->at[2] == 'd' ? "''" : "'");
            r->at += r->at[2] == 'd' ? 6 : 5;
            braces++;
        } else if (strncmp(r->at, "\\lambda_{", 9) == 0) {
            is_lambda = true;
            r->at += 9;
            braces++;
        } else if (strncmp(r->at, "\\theta", 6) == 0) {
            length += (size_t)snprintf(name + length, sizeof name - length, "theta");
            r->at += 6;
        } else if (strncmp(r->at, "\\mathrm{", 8) == 0 || strncmp(r->at, "\\mathit{", 8) == 0) {
            r->at += 8;
            braces++;
        } else if (strncmp(r->at, "_{", 2) == 0) {
            r->at += 2;
            braces++;
        } else if (*r->at == '}' && braces > 0) {
            r->at++;
            braces--;
        } else if (isalnum((unsigned char)*r->at) || *r->at == '.') {
            name[length++] = *r->at++;
            name[length] = '\0';
        } else
            break;
    }
    if (is_where(name))
        return where_named(r, name);
    if (is_lambda) {
        char whole[96];

        (void)snprintf(whole, sizeof whole, "lambda(%s)", name);
        return value_named(r, whole);
    }
    (void)strcat(name, primes);
    return length > 0 ? value_named(r, name) : NAN;
}

static double read_name(Reader *r)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const char *const begun = r->at;
    char name[80];
    size_t length;
    double value;

    if (r->style == LATEX)
        return starts(r, "\\pi") ? M_PI : read_latex_name(r);
    if (starts(r, "math.pi"))
        return M_PI;
    if (starts(r, "math.tau"))
        return 2 * M_PI;
    length = strspn(r->at, letters);
    if (r->style == PLAIN)
        length += strspn(r->at + length, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                         "0123456789_.'");
    (void)snprintf(name, sizeof name, "%.*s", (int)length, r->at);
    r->at += length;
    if (strcmp(name, "pi") == 0)
        return M_PI;
    if (is_where(name))
        return where_named(r, name);
    if (strcmp(name, "lambda") == 0 && *r->at == '(') {
        (void)snprintf(name, sizeof name, "lambda(%d)", atoi(r->at + 1));
        r->at += strcspn(r->at, ")") + 1;
        return value_named(r, name);
    }
    value = length == 0 ? NAN : r->style == PLAIN ? value_named(r, name) : value_of_code(r, name);
    if (isnan(value) && !r->failed) {
        r->failed = true;
        (void)snprintf(r->missed, sizeof r->missed, "%.40s at %.30s", name, begun);
    }
    return value;
}

/* what stands in brackets, which are open */
static double read_inside(Reader *r, const char *close)
{
    double value;

    r->depth++;
    value = read_sum(r);
    r->depth--;
    return starts(r, close) ? value : NAN;
}

static double squared(double x)
{
    return x * x;
}

typedef struct Call {
    const char *name;
    double (*value)(double);
} Call;
static const Call calls[] = {
    {"math.sin", sin}, {"math.cos", cos}, {"math.tan", tan},   {"sin", sin},     {"cos", cos},
    {"tan", tan},      {"sqrt", sqrt},    {"math.sqrt", sqrt}, {"exp", exp},     {"math.exp", exp},
    {"fabs", fabs},    {"abs", fabs},     {"rint", rint},      {"anint", round}, {"round", round}};

static bool read_call(Reader *r, double *out)
{
    for (int i = 0; i < COUNT(calls); i++) {
        char open[16];

        (void)snprintf(open, sizeof open, "%s(", calls[i].name);
        if (r->style != LATEX && starts(r, open)) {
            *out = calls[i].value(read_inside(r, ")"));
            return true;
        }
        (void)snprintf(open, sizeof open, "\\%s", calls[i].name);
        if (r->style == LATEX && starts(r, open)) {
            const bool is_squared = starts(r, "^{2}");

            *out = starts(r, "\\left(") ? calls[i].value(read_inside(r, "\\right)")) : NAN;
            *out = is_squared ? squared(*out) : *out;
            return true;
        }
    }
    if (starts(r, "atan2(") || starts(r, "math.atan2(")) {
        const double y = read_inside(r, ",");

        *out = atan2(y, read_inside(r, ")"));
        return true;
    }
    if (starts(r, "pow(")) {
        const double base = read_inside(r, ",");

        *out = pow(base, read_inside(r, ")"));
        return true;
    }
    if (starts(r, "\\left|")) {
        *out = fabs(read_inside(r, "\\right|"));
        return true;
    }
    if (starts(r, "\\sqrt{")) {
        *out = sqrt(read_inside(r, "}"));
        return true;
    }
    if (starts(r, "\\frac{")) {
        const double over = read_inside(r, "}");

        *out = starts(r, "{") ? over / read_inside(r, "}") : NAN;
        return true;
    }
    return false;
}

/* The angle of (x, y) that is nearest to a: "unwrap(y, x, a)". */
static double read_unwrapped(Reader *r, const char *close)
{
    const double y = read_inside(r, ","), x = read_inside(r, ",");
    const double near = read_inside(r, close), angle = atan2(y, x);

    return angle + 2 * M_PI * round((near - angle) / (2 * M_PI));
}

static double read_primary(Reader *r)
{
    double value;

    if (read_call(r, &value))
        return value;
    if (starts(r, "unwrap("))
        return read_unwrapped(r, ")");
    if (starts(r, "\\operatorname{unwrap}\\left("))
        return read_unwrapped(r, "\\right)");
    if (starts(r, "\\left("))
        return read_inside(r, "\\right)");
    if (starts(r, "("))
        return read_inside(r, ")");
    if (isdigit((unsigned char)*r->at)) {
        char *end;

        value = strtod(r->at, &end);
        r->at = end;
        if (r->style == FORTRAN && *r->at == 'd') /* 1.5d-3 */
            value *= pow(10, (double)strtol(r->at + 1, &end, 10));
        if (r->style == FORTRAN && *r->at == 'd')
            r->at = end;
        if (starts(r, "\\cdot 10^{")) {
            value *= pow(10, strtod(r->at, &end));
            r->at = end;
            (void)starts(r, "}");
        }
        return value;
    }
    return read_name(r);
}

static double read_power(Reader *r)
{
    const double base = read_primary(r);

    if (r->style == LATEX && starts(r, "^{"))
        return pow(base, read_inside(r, "}"));
    if (r->style == LATEX || !(starts(r, "**") || starts(r, "^")))
        return base;
    return pow(base, starts(r, "-") ? -read_power(r) : read_power(r));
}

/* in LaTeX factors stand next to each other */
static bool another_factor(Reader *r)
{
    skip_blanks(r);
    return r->style == LATEX && *r->at != '\0' && strchr("+-=}&\\),|", *r->at) == NULL
               ? true
               : r->style == LATEX &&
                     (strncmp(r->at, "\\left", 5) == 0 || strncmp(r->at, "\\frac", 5) == 0 ||
                      strncmp(r->at, "\\sin", 4) == 0 || strncmp(r->at, "\\cos", 4) == 0 ||
                      strncmp(r->at, "\\sqrt", 5) == 0 ||
                      strncmp(r->at, "\\operatorname", 13) == 0 ||
                      strncmp(r->at, "\\dot", 4) == 0 || strncmp(r->at, "\\ddot", 5) == 0 ||
                      strncmp(r->at, "\\lambda", 7) == 0 || strncmp(r->at, "\\theta", 6) == 0 ||
                      strncmp(r->at, "\\pi", 3) == 0);
}

static double read_product(Reader *r)
{
    const bool is_negative = starts(r, "-");
    double value = read_power(r);

    for (;;) {
        skip_blanks(r);
        if (strncmp(r->at, "**", 2) == 0)
            return NAN;
        if (starts(r, "/"))
            value /= read_power(r);
        else if (starts(r, "*") || another_factor(r))
            value *= read_power(r);
        else
            return is_negative ? -value : value;
    }
}

static double read_sum(Reader *r)
{
    double value = read_product(r), term;

    if (r->depth == 0)
        r->size += fabs(value);
    for (;;) {
        const bool adds = starts(r, "+");

        if (!adds && !starts(r, "-"))
            return value;
        term = read_product(r);
        value += adds ? term : -term;
        if (r->depth == 0)
            r->size += fabs(term);
    }
}

/* --- equations of a text --- */

/* left - right of an equation, or the value of a residual, over the sizes of terms; NAN where it
 * is no equation */
static double off_of(Reader *r, const char *text)
{
    double off;

    r->at = text;
    r->size = 0;
    r->depth = 0;
    r->failed = false;
    off = read_sum(r);
    if (starts(r, "="))
        off -= read_sum(r);
    (void)starts(r, ";");
    skip_blanks(r);
    return *r->at == '\0' ? off / fmax(r->size, 1e-3) : NAN;
}

/* the next equation of a text, a definition among them, its label taken off; false: none is left */
static bool next_equation(const char **text, Style style, char *out, size_t room)
{
    while (**text != '\0') {
        const size_t length = strcspn(*text, "\n");
        const char *line = *text;
        size_t used = 0;

        *text += length + (line[length] == '\n');
        if (strchr("/#!%\\", line[0]) != NULL && line[0] != '\0' && line[0] != ' ')
            continue;
        if (memchr(line, '=', length) == NULL &&
            !(style == LATEX && memchr(line, '&', length) != NULL))
            continue;
        if (length >= room)
            return false;
        if (style == LATEX && memmem(line, length, "\\text{", 6) != NULL) /* a remark */
            continue;
        memcpy(out, line, length);
        out[used = length] = '\0';
        /* a line of LaTeX that goes on, or code over several lines */
        while (strncmp(*text, "  &\\quad", 8) == 0 || (style == FORTRAN && out[used - 1] == '&')) {
            const size_t more = strcspn(*text, "\n");

            if (style == FORTRAN)
                used--;
            if (used + more >= room)
                return false;
            memcpy(out + used, *text, more);
            out[used += more] = '\0';
            *text += more + ((*text)[more] == '\n');
        }
        return true;
    }
    return false;
}

/* w1 = ..., in code perhaps after its type */
static bool is_definition(const char *line, int *number, const char **formula)
{
    int start = 0;

    line += strspn(line, " &");
    if (strncmp(line, "where ", 6) == 0)
        line += 6 + strspn(line + 6, " ");
    if (strncmp(line, "const double ", 13) == 0)
        line += 13;
    else if (strncmp(line, "double ", 7) == 0)
        line += 7;
    if ((sscanf(line, "w_{%d} & = %n", number, &start) != 1 || start == 0) &&
        (sscanf(line, "w_{%d} = %n", number, &start) != 1 || start == 0) &&
        (sscanf(line, "w%d = %n", number, &start) != 1 || start == 0))
        return false;
    *formula = line + start;
    return start > 0 && *number < MOST_WHERE;
}

static const char *formula_of(const char *line, Style style)
{
    const char *at;

    if (style != PLAIN && style != LATEX) /* residual[0] = ... */
        return strchr(line, '=') + 1;
    if (style == LATEX)
        return line;
    at = strstr(line, ":  "); /* h9  x:  ... */
    return at != NULL ? at + 3 : line + strspn(line, " ");
}

static Verdict check_style(Member *m, Reader *r, Style style)
{
    static char line[1 << 16];
    char statement[48];
    const char *at;
    char *text;
    bool good = true;
    int equations = 0;

    (void)snprintf(statement, sizeof statement, "show equations as %s", words[style]);
    if (kit_do(r->kit, statement) != CT_OK || r->kit->text == NULL) {
        tell(m, "%s: %s\n", statement, r->kit->error.message);
        return DISAGREES;
    }
    text = strdup(r->kit->text);
    r->style = style;
    /* definitions may stand after what uses them, each over earlier ones */
    for (int pass = 0; pass < 2; pass++)
        for (at = text; next_equation(&at, style, line, sizeof line);) {
            const char *formula;
            int number;
            double off;

            if (is_definition(line, &number, &formula)) {
                if (pass == 0) {
                    off_of(r, formula);
                    r->at = formula;
                    r->where[number] = read_sum(r);
                    if (isnan(r->where[number]))
                        tell(m, "%s: w%d is none: %.200s\n", words[style], number, line);
                }
                continue;
            }
            if (pass == 0)
                continue;
            off = off_of(r, formula_of(line, style));
            equations++;
            if (!keeps(m, words[style], fabs(off), 1e-9)) {
                tell(m, "%.600s\n%s\n", line, r->failed ? r->missed : "");
                good = false;
            }
        }
    free(text);
    if (equations == 0)
        tell(m, "%s: no equation\n", statement);
    return good && equations > 0 ? AGREES : DISAGREES;
}

static Verdict check_model(Member *m, const char *script)
{
    static Reader r;
    const ct_hooks hooks = {.columns = 0};
    Kit kit = {.session = ct_session_new(&hooks)};
    Verdict verdict = AGREES;

    tell(m, "%s", script);
    if (kit_do(&kit, script) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = REFUSED;
    }
    r = (Reader){.kit = &kit};
    for (Style style = PLAIN; style < STYLES && verdict == AGREES; style++)
        verdict = check_style(m, &r, style);
    kit_free(&kit);
    return verdict;
}

/* --- models --- */

static Verdict plane_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_chain(m, &shape, true);
    return check_model(m, shape.script.text);
}

static Verdict space_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_chain(m, &shape, false);
    return check_model(m, shape.script.text);
}

static Verdict crank_member(Member *m)
{
    static Shape shape;

    shape = (Shape){.bodies = 0};
    write_crank(m, &shape);
    return check_model(m, shape.script.text);
}

/* bodies in absolute coordinates, turned by more than half a turn, with springs between them */
static Verdict turned_member(Member *m)
{
    static Script s;
    const int bodies = 2 + one_of(m, 3);

    s = (Script){0};
    write_line(&s, "scene planar\ngravity [0, -9.81]");
    for (int i = 0; i < bodies; i++) {
        write_body(m, &s, i, true);
        if (i == 0)
            write_line(&s, "revolute j0 ground p0");
        else
            write_line(&s, "revolute j%d q%d p%d", i, i - 1, i);
        if (one_of(m, 2) == 0)
            write_line(&s, "spring s%d j%d k=%.3f rest=%.3f", i, i, draw(m, 1, 20), draw(m, -1, 1));
    }
    if (one_of(m, 2) == 0)
        write_line(&s, "pd c0 e 0 ref=%.3f of=j%d Kp=%.3f Kd=0\nmotor M1 j%d e 0 R=1 L=0.1 Kt=0.5",
                   draw(m, -1, 1), bodies - 1, draw(m, 1, 5), bodies - 1);
    write_line(&s, "tree absolute");
    for (int i = 0; i < bodies; i++)
        write_line(&s, "init b%d.theta = %.4f", i, draw(m, -8, 8));
    return check_model(m, s.text);
}

/* beams, whose entries are sums of sums */
static Verdict beam_member(Member *m)
{
    static const char *const stiffenings[] = {"full", "linear", "off"};
    static Script s;
    const int shapes = 1 + one_of(m, 3);

    s = (Script){0};
    write_line(&s, "scene planar\nl = %.3f", draw(m, 0.5, 2));
    write_line(&s,
               "beam b1 length=l mass_per_length=%.17g EA=%.3f EIz=%.3f modes=[%d, %d] "
               "stiffening=%s",
               1 + one_of(m, 5) / 3.0, draw(m, 100, 900), draw(m, 10, 50), one_of(m, 2), shapes,
               stiffenings[one_of(m, 3)]);
    write_line(&s, "revolute h1 ground b1\narm e1 b1 at=l");
    write_line(&s, "body m2 mass=%.3f inertia=%.3f\nrevolute h2 e1 m2", draw(m, 0.1, 1),
               draw(m, 0.01, 0.1));
    write_line(&s, "init h1' = %.3f, b1.v1 = %.3f", draw(m, -2, 2), draw(m, -0.05, 0.05));
    return check_model(m, s.text);
}

static const Family families[] = {
    {"equations printed of plane chains hold in a run", 40, 0, 0, plane_member},
    {"equations printed of spatial chains hold in a run", 12, 0, 0, space_member},
    {"equations printed of slider-cranks hold in a run", 40, 0.1, 0, crank_member},
    {"equations printed of bodies turned by full turns hold in a run", 40, 0, 0, turned_member},
    {"equations printed of beams hold in a run", 30, 0, 0, beam_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}

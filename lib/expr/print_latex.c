/* print_latex.c: expressions for LaTeX
 *
 * Division is a fraction, names get subscripts from their digits and dots from their
 * primes: h8' is \dot{h}_{8}. */
#include "expr/greek.h"
#include "expr/print_impl.h"

#include "base/decimal.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* denominators up to which a fraction is not written as a decimal, and digits of those */
enum { SMALL = 9, SHORT_DECIMAL = 6 };

/* 1.5e-9 as 1.5 times a power of ten, 1e-12 as the power alone */
void latex_digits(Text *out, const char *digits)
{
    const char *exponent = strchr(digits, 'e');
    const char *one = digits + (digits[0] == '-');
    bool is_power;

    if (exponent == NULL) {
        text_add(out, digits);
        return;
    }
    is_power = one + 1 == exponent && one[0] == '1';
    text_add_n(out, digits, (size_t)((is_power ? one : exponent) - digits));
    text_addf(out, "%s10^{%d}", is_power ? "" : "\\cdot ", (int)strtol(exponent + 1, NULL, 10));
}

static void latex_double(Text *out, double value)
{
    char digits[DECIMAL_SIZE];

    (void)decimal_print(digits, value, DECIMAL_EXACT);
    latex_digits(out, digits);
}

static bool is_decimal(char decimal[64], Number number)
{
    return number.den > SMALL && ratio_decimal(decimal, number, SHORT_DECIMAL);
}

static Level latex_number(Text *out, Number number)
{
    char decimal[64];

    if (number.den == 1 && integer_power(decimal, number.num)) {
        latex_digits(out, decimal);
        return LEVEL_PRODUCT;
    }
    if (number.den == 0)
        latex_double(out, number.real);
    else if (number.den == 1)
        text_addf(out, "%lld", (long long)number.num);
    else if (is_decimal(decimal, number))
        latex_digits(out, decimal);
    else
        text_addf(out, "\\frac{%lld}{%lld}", (long long)number.num, (long long)number.den);
    return number.den == 1 ? LEVEL_ATOM : LEVEL_PRODUCT;
}

/* --- names --- */

/* One word of a name: letters under dots, the rest as subscripts. */
static void latex_word(Text *out, const char *word, size_t length, int primes)
{
    static const char *const dots[] = {"", "\\dot{", "\\ddot{", "\\dddot{"};
    size_t letters = 0;
    const Greek *greek;

    while (letters < length && isalpha((unsigned char)word[letters]))
        letters++;
    greek = greek_find(word, letters);
    text_add(out, dots[primes]);
    if (greek != NULL)
        text_addf(out, "\\%s", greek->name);
    else if (letters == 1)
        text_add_n(out, word, 1);
    else
        text_addf(out, "\\mathrm{%.*s}", (int)letters, word);
    if (primes > 0)
        text_char(out, '}');
    if (letters == length)
        return;

    text_add(out, "_{");
    letters += word[letters] == '_';
    while (letters < length) {
        size_t part = 0;

        while (letters + part < length && word[letters + part] != '_')
            part++;
        if (part > 0 && isalpha((unsigned char)word[letters]))
            text_addf(out, "\\mathrm{%.*s}", (int)part, word + letters);
        else
            text_add_n(out, word + letters, part);
        letters += part;
        if (letters < length)
            text_char(out, ',');
        letters += letters < length;
    }
    text_char(out, '}');
}

/* "table" with the file and the column below */
static void latex_table(Text *out, const Curve *curve)
{
    const char *const words[] = {curve->file, curve->column[0] != '\0' ? ", " : "", curve->column};

    text_add(out, "\\operatorname{table}_{\\text{");
    for (int i = 0; i < COUNT(words); i++)
        for (const char *c = words[i]; *c != '\0'; c++) {
            if (strchr("#$%&_{}", *c) != NULL)
                text_char(out, '\\');
            text_char(out, strchr("\\~^", *c) != NULL ? ' ' : *c);
        }
    text_add(out, "}}");
}

/* words between dots, primes after the last */
static void latex_name(Text *out, const char *name, size_t end)
{
    int primes = 0;

    for (; end > 0 && name[end - 1] == '\'' && primes < 3; end--)
        primes++;
    for (size_t at = 0; at < end;) {
        size_t length = strcspn(name + at, ".");

        if (at + length >= end) {
            latex_word(out, name + at, end - at, primes);
            return;
        }
        latex_word(out, name + at, length, 0);
        text_char(out, '.');
        at += length + 1;
    }
}

/* a name, one that is numbered, lambda(1), or the law of one called for another, D1.law(C1.v) */
static void latex_symbol(Text *out, Expr symbol)
{
    const char *name = expr_name(symbol);
    const char *open = strchr(name, '(');

    if (expr_data(symbol) != NULL && !curve_is_law(expr_data(symbol))) {
        latex_table(out, expr_data(symbol));
    } else if (open != NULL && isdigit((unsigned char)open[1])) {
        latex_name(out, name, (size_t)(open - name));
        text_addf(out, "_{%.*s}", (int)strlen(open) - 2, open + 1);
    } else if (open != NULL) {
        latex_name(out, name, (size_t)(open - name));
        text_add(out, "\\left(");
        latex_name(out, open + 1, strlen(open) - 2);
        text_add(out, "\\right)");
    } else {
        latex_name(out, name, strlen(name));
    }
}

/* --- products, powers, calls --- */

/* A numerator or denominator; a single factor needs no brackets. */
static void write_part_of_fraction(Printer *printer, Number number, const Piece *pieces, int count)
{
    bool numbered = !number_is(number, 1) || count == 0;

    if (numbered)
        write_number(printer, number, LEVEL_PRODUCT);
    if (numbered && count > 0)
        say(printer, printer->dialect->times);
    write_pieces(printer, pieces, count, printer->dialect->times);
    if (!numbered && count == 1)
        printer->pieces.at[printer->pieces.count - 1].level = LEVEL_ANY;
}

static void latex_fraction(Printer *printer, const Fraction *fraction)
{
    char decimal[64];
    Number above = fraction->number;
    Number below = number_int(1);

    if (above.den > 1 && !is_decimal(decimal, above)) {
        below = number_int(above.den);
        above.den = 1;
    }
    if (number_is(below, 1) && fraction->below.count == 0) {
        fraction_inline(printer, fraction, "");
        return;
    }
    say(printer, "\\frac{");
    write_part_of_fraction(printer, above, fraction->above.at, fraction->above.count);
    say(printer, "}{");
    write_part_of_fraction(printer, below, fraction->below.at, fraction->below.count);
    say(printer, "}");
}

static const char *const names[] = {
#define OP(id, name, args, derivative, c, latex, value, dimension) latex,
#include "expr/ops.def"
#undef OP
};

/* sin^2(x) instead of (sin(x))^2 */
static bool takes_power(Expr e)
{
    return e->kind == EXPR_CALL && e->count == 1 && e->op <= OP_LOG;
}

static void write_exponent(Printer *printer, Expr exponent, Number number)
{
    say(printer, "^{");
    if (exponent != NULL)
        write_node(printer, exponent, LEVEL_ANY);
    else
        write_number(printer, number, LEVEL_ANY);
    say(printer, "}");
}

static void latex_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    if (!takes_power(base)) {
        write_node(printer, base, LEVEL_ATOM);
        write_exponent(printer, exponent, number);
        return;
    }
    say(printer, names[base->op]);
    write_exponent(printer, exponent, number);
    say(printer, "\\left(");
    write_node(printer, node_args(base)[0], LEVEL_ANY);
    say(printer, "\\right)");
}

static void latex_call(Printer *printer, Expr e)
{
    const Expr *args = node_args(e);

    if (write_operator(printer, e, names[e->op]))
        return;
    if (e->op == OP_IF) {
        say(printer, "\\begin{cases} ");
        write_node(printer, args[1], LEVEL_ANY);
        say(printer, " & \\text{if } ");
        write_node(printer, args[0], LEVEL_ANY);
        say(printer, " \\\\ ");
        write_node(printer, args[2], LEVEL_ANY);
        say(printer, " & \\text{otherwise} \\end{cases}");
        return;
    }
    if (e->op == OP_TABLE && expr_data(args[0]) != NULL) {
        static const char *const primes[CURVE_ORDERS] = {"", "'", "''", "'''"};

        if (write_law(printer, e))
            return;
        write_node(printer, args[0], LEVEL_ATOM);
        say(printer, primes[(int)expr_value(args[2])]);
        say(printer, "\\left(");
        write_node(printer, args[1], LEVEL_ANY);
        say(printer, "\\right)");
        return;
    }
    say(printer, names[e->op]);
    say(printer, e->op == OP_SQRT ? "{" : e->op == OP_ABS ? "" : "\\left(");
    write_arguments(printer, e);
    say(printer, e->op == OP_SQRT ? "}" : e->op == OP_ABS ? "\\right|" : "\\right)");
}

const Dialect dialect_latex = {
    .plus = " + ",
    .minus = " - ",
    .times = "\\,",
    .open = "\\left(",
    .close = "\\right)",
    .names_pi = true,
    .number = latex_number,
    .symbol = latex_symbol,
    .fraction = latex_fraction,
    .power = latex_power,
    .power_level = plain_power_level,
    .call = latex_call,
    .call_level = operator_level,
};

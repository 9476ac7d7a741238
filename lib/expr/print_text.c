/* print_text.c: what a person types, and the same with Greek letters and raised digits */
#include "expr/greek.h"
#include "expr/print_impl.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* digits up to which a fraction is written as a decimal even if that is longer */
enum { SHORT_DECIMAL = 6, LONG_DECIMAL = 15 };

static Level text_number_level(Text *out, Number number)
{
    char decimal[64];
    char ratio[64];

    if (number.den == 0) {
        double_text(decimal, number.real);
        text_add(out, decimal);
        return LEVEL_ATOM;
    }
    if (number.den == 1 && integer_power(decimal, number.num)) {
        text_add(out, decimal);
        return LEVEL_ATOM;
    }
    snprintf(ratio, sizeof ratio, "%lld/%lld", (long long)number.num, (long long)number.den);
    if (number.den == 1)
        *strchr(ratio, '/') = '\0';
    else if (ratio_decimal(decimal, number, SHORT_DECIMAL) ||
             (ratio_decimal(decimal, number, LONG_DECIMAL) && strlen(decimal) <= strlen(ratio))) {
        text_add(out, decimal);
        return LEVEL_ATOM;
    }
    text_add(out, ratio);
    return number.den == 1 ? LEVEL_ATOM : LEVEL_PRODUCT;
}

static void text_symbol(Text *out, Expr symbol)
{
    text_add(out, expr_name(symbol));
}

/* 2/3*m is 2*m/3 */
static void text_fraction(Printer *printer, const Fraction *fraction)
{
    Fraction split = *fraction;
    Number den = number_int(1);
    Text digits = {0};
    bool whole = printer->dialect->number(&digits, fraction->number) == LEVEL_ATOM;

    text_free(&digits);
    if (whole || (fraction->above.count == 0 && fraction->below.count == 0)) {
        fraction_inline(printer, fraction, "/");
        return;
    }
    den.num = fraction->number.den;
    split.number.den = 1;
    split.below.at = NEW_ARRAY(Piece, fraction->below.count + 1);
    split.below.at[0] = (Piece){.kind = PIECE_NUMBER, .number = den, .level = LEVEL_UNARY};
    split.below.count = fraction->below.count + 1;
    for (int i = 0; i < fraction->below.count; i++)
        split.below.at[i + 1] = fraction->below.at[i];
    fraction_inline(printer, &split, "/");
    mem_free(split.below.at);
}

static void text_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    write_node(printer, base, LEVEL_ATOM);
    say(printer, "^");
    if (exponent != NULL)
        write_node(printer, exponent, LEVEL_ATOM);
    else
        write_number(printer, number, LEVEL_ATOM);
}

/* table("file.csv", x, column), followed by the order of a derivative */
static void text_table(Printer *printer, Expr e)
{
    const Expr *args = node_args(e);
    const Curve *table = expr_data(args[0]);
    const bool is_number = table->column[strspn(table->column, "0123456789")] == '\0';

    say(printer, "table(\"");
    say(printer, table->file);
    say(printer, "\", ");
    write_node(printer, args[1], LEVEL_ANY);
    say(printer, is_number ? ", " : ", \"");
    say(printer, table->column);
    say(printer, is_number ? "" : "\"");
    if (!expr_is_zero(args[2])) {
        say(printer, ", ");
        write_node(printer, args[2], LEVEL_ANY);
    }
    say(printer, ")");
}

static void text_call(Printer *printer, Expr e)
{
    if (e->op == OP_TABLE && expr_data(node_args(e)[0]) != NULL) {
        if (!write_law(printer, e))
            text_table(printer, e);
        return;
    }
    if (write_operator(printer, e, op_name(e->op)))
        return;
    say(printer, op_name(e->op));
    say(printer, "(");
    write_arguments(printer, e);
    say(printer, ")");
}

const Dialect dialect_text = {
    .plus = " + ",
    .minus = " - ",
    .times = "*",
    .open = "(",
    .close = ")",
    .names_pi = true,
    .number = text_number_level,
    .symbol = text_symbol,
    .fraction = text_fraction,
    .power = text_power,
    .power_level = plain_power_level,
    .call = text_call,
    .call_level = operator_level,
};

/* --- Unicode --- */

static void unicode_symbol(Text *out, Expr symbol)
{
    const char *name = expr_name(symbol);

    while (*name != '\0') {
        size_t length = 0;
        const Greek *greek;

        while (isalpha((unsigned char)name[length]))
            length++;
        greek = greek_find(name, length);
        if (greek != NULL)
            text_add(out, greek->letter);
        else
            text_add_n(out, name, length);
        /* the next word starts after a dot or underscore */
        name += length;
        for (length = 0; name[length] != '\0' && name[length] != '.' && name[length] != '_';)
            length++;
        length += name[length] != '\0';
        text_add_n(out, name, length);
        name += length;
    }
}

static void unicode_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

    if (exponent != NULL && is_number(exponent))
        number = number_of(exponent);
    if ((exponent != NULL && !is_number(exponent)) || number.den != 1 || number.num < 0 ||
        number.num > 99) {
        text_power(printer, base, exponent, number);
        return;
    }
    write_node(printer, base, LEVEL_ATOM);
    if (number.num > 9)
        say(printer, raised[number.num / 10]);
    say(printer, raised[number.num % 10]);
}

static void unicode_call(Printer *printer, Expr e)
{
    static const char *const signs[OP_COUNT] = {
        [OP_LE] = "≤", [OP_NE] = "≠", [OP_AND] = "∧", [OP_OR] = "∨", [OP_NOT] = "¬"};

    if (signs[e->op] == NULL || !write_operator(printer, e, signs[e->op]))
        text_call(printer, e);
}

const Dialect dialect_unicode = {
    .plus = " + ",
    .minus = " - ",
    .times = "·",
    .open = "(",
    .close = ")",
    .names_pi = true,
    .number = text_number_level,
    .symbol = unicode_symbol,
    .fraction = text_fraction,
    .power = unicode_power,
    .power_level = plain_power_level,
    .call = unicode_call,
    .call_level = operator_level,
};

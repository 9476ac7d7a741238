/* print_code.c: expressions as source code of C, Matlab, Python and Fortran
 *
 * Every number is a double. Names become identifiers: h8' is h8_d, m3.x is m3_x. A
 * function that the language has not got is a pattern: $0 is an argument, %0 an
 * argument between operators. */
#include "expr/print_impl.h"

#include "base/decimal.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* powers up to which C multiplies, digits of a decimal */
enum { SMALL_POWER = 4, SHORT_DECIMAL = 15 };

static void code_symbol(Text *out, Expr symbol)
{
    bool primed = false;

    for (const char *c = expr_name(symbol); *c != '\0'; c++) {
        if (*c == '\'') {
            text_add(out, primed ? "d" : "_d");
            primed = true;
        } else
            text_char(out, isalnum((unsigned char)*c) ? *c : '_');
    }
}

static void python_symbol(Text *out, Expr symbol)
{
    text_add(out, strcmp(expr_name(symbol), "pi") == 0 ? "math." : "");
    code_symbol(out, symbol);
}

/* --- numbers --- */

/* `whole` is appended to an integer, `mark` is the letter of an exponent */
static Level code_number(Text *out, Number number, const char *whole, char mark)
{
    char digits[64];
    char *e;

    if (number.den == 0 || number.pi != 0) {
        decimal_print(digits, number_value(number), DECIMAL_EXACT);
    } else if (!ratio_decimal(digits, number, SHORT_DECIMAL)) {
        text_addf(out, "%lld%s", (long long)number.num, whole);
        if (number.den != 1)
            text_addf(out, "/%lld%s", (long long)number.den, whole);
        return number.den != 1 ? LEVEL_PRODUCT : LEVEL_ATOM;
    }
    e = strchr(digits, 'e');
    if (e != NULL)
        *e = mark;
    text_add(out, digits);
    if (e == NULL && strchr(digits, '.') == NULL)
        text_add(out, whole);
    else if (e == NULL && mark == 'd')
        text_add(out, "d0");
    return LEVEL_ATOM;
}

static Level c_number(Text *out, Number number)
{
    return code_number(out, number, ".0", 'e');
}

static Level plain_number(Text *out, Number number)
{
    return code_number(out, number, "", 'e');
}

static Level fortran_number(Text *out, Number number)
{
    return code_number(out, number, ".0d0", 'd');
}

static void code_fraction(Printer *printer, const Fraction *fraction)
{
    fraction_inline(printer, fraction, "/");
}

/* --- powers --- */

/* How often C multiplies a symbol by itself, or 0. */
static int times_itself(Expr base, Expr exponent, Number number)
{
    if (exponent != NULL && is_number(exponent))
        number = number_of(exponent);
    else if (exponent != NULL)
        return 0;
    if (base->kind != EXPR_SYMBOL || number.den != 1 || number.num > SMALL_POWER || number.num < 2)
        return 0;
    return (int)number.num;
}

static void write_exponent(Printer *printer, Expr exponent, Number number, Level level)
{
    if (exponent != NULL)
        write_node(printer, exponent, level);
    else
        write_number(printer, number, level);
}

static void c_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    int times = times_itself(base, exponent, number);

    if (times == 0) {
        say(printer, "pow(");
        write_node(printer, base, LEVEL_ANY);
        say(printer, ", ");
        write_exponent(printer, exponent, number, LEVEL_ANY);
        say(printer, ")");
        return;
    }
    for (int i = 0; i < times; i++) {
        if (i > 0)
            say(printer, "*");
        write_node(printer, base, LEVEL_ATOM);
    }
}

static Level c_power_level(Expr base, Expr exponent, Number number)
{
    return times_itself(base, exponent, number) > 0 ? LEVEL_PRODUCT : LEVEL_ATOM;
}

static void sign_power(Printer *printer, Expr base, Expr exponent, Number number, const char *sign)
{
    static const char *const whole[] = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};

    write_node(printer, base, LEVEL_ATOM);
    say(printer, sign);
    if (exponent != NULL && is_number(exponent))
        number = number_of(exponent);
    /* an integer, so that a negative base may have it */
    if ((exponent == NULL || is_number(exponent)) && number.den == 1 && number.num >= 0 &&
        number.num <= 9)
        say(printer, whole[number.num]);
    else
        write_exponent(printer, exponent, number, LEVEL_ATOM);
}

static void star_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    sign_power(printer, base, exponent, number, "**");
}

static void matlab_power(Printer *printer, Expr base, Expr exponent, Number number)
{
    sign_power(printer, base, exponent, number, "^");
}

/* --- functions --- */

static const char *const patterns[OP_COUNT][NOTATIONS] = {
#define CODE(id, c, matlab, python, fortran, numpy)                                                \
    [OP_##id] = {[NOTATION_C] = c,                                                                 \
                 [NOTATION_MATLAB] = matlab,                                                       \
                 [NOTATION_PYTHON] = python,                                                       \
                 [NOTATION_FORTRAN] = fortran,                                                     \
                 [NOTATION_NUMPY] = numpy},
#include "expr/code_functions.def"
#undef CODE
};

static const char *const c_names[] = {
#define OP(id, name, args, derivative, c, latex, value, dimension) c,
#include "expr/ops.def"
#undef OP
};

static void write_pattern(Printer *printer, const char *pattern, Expr e)
{
    for (const char *c = pattern; *c != '\0';) {
        size_t plain = strcspn(c, "$%");

        write_part(printer, c, plain);
        c += plain;
        if (*c == '\0')
            break;
        write_node(printer, node_args(e)[c[1] - '0'], *c == '%' ? LEVEL_SUM : LEVEL_ANY);
        c += 2;
    }
}

static void write_call(Printer *printer, Expr e, Notation notation, const char *library)
{
    if (patterns[e->op][notation] != NULL) {
        write_pattern(printer, patterns[e->op][notation], e);
        return;
    }
    if (write_operator(printer, e, c_names[e->op]))
        return;
    say(printer, library);
    say(printer, c_names[e->op]);
    say(printer, "(");
    write_arguments(printer, e);
    say(printer, ")");
}

static void c_call(Printer *printer, Expr e)
{
    write_call(printer, e, NOTATION_C, "");
}

/* table1_, table1_d ...: functions, whose names must not start like those of C */
static void matlab_symbol(Text *out, Expr symbol)
{
    if (expr_data(symbol) != NULL)
        text_addf(out, "%s_", expr_name(symbol) + 1);
    else
        code_symbol(out, symbol);
}

static void matlab_table(Printer *printer, Expr e)
{
    static const char *const derivatives[CURVE_ORDERS] = {"(", "d(", "dd(", "ddd("};
    const Expr *args = node_args(e);

    write_node(printer, args[0], LEVEL_ATOM);
    say(printer, derivatives[(int)expr_value(args[2])]);
    write_node(printer, args[1], LEVEL_ANY);
    say(printer, ")");
}

static void matlab_call(Printer *printer, Expr e)
{
    if (e->op == OP_TABLE && expr_data(node_args(e)[0]) != NULL)
        matlab_table(printer, e);
    else
        write_call(printer, e, NOTATION_MATLAB, "");
}

static void python_call(Printer *printer, Expr e)
{
    write_call(printer, e, NOTATION_PYTHON, "math.");
}

static void fortran_call(Printer *printer, Expr e)
{
    write_call(printer, e, NOTATION_FORTRAN, "");
}

static Level matlab_level(Expr e)
{
    return patterns[e->op][NOTATION_MATLAB] != NULL ? LEVEL_ATOM : operator_level(e);
}

char *op_code(Op op, Notation notation)
{
    const char *pattern = patterns[op][notation];
    Text text = {0};

    if (pattern != NULL)
        text_add(&text, pattern);
    else if (isalpha((unsigned char)c_names[op][0])) {
        text_addf(&text, "%s%s(", notation == NOTATION_NUMPY ? "np." : "", c_names[op]);
        for (int i = 0; i < op_args(op); i++)
            text_addf(&text, "%s$%d", i > 0 ? ", " : "", i);
        text_char(&text, ')');
    } else
        text_addf(&text, op_args(op) == 1 ? "(%s%%0)" : "(%%0 %s %%1)", c_names[op]);
    return text_done(&text);
}

/* patterns are in brackets or are functions */
static Level closed_level(Expr e)
{
    (void)e;
    return LEVEL_ATOM;
}

/* clang-format off */
#define INLINE .plus = " + ", .minus = " - ", .times = "*", .open = "(", .close = ")", \
               .fraction = code_fraction

const Dialect dialect_c = {INLINE, .symbol = code_symbol, .number = c_number,
    .power = c_power, .power_level = c_power_level, .call = c_call, .call_level = operator_level};
const Dialect dialect_matlab = {INLINE, .names_pi = true, .symbol = matlab_symbol, .number = plain_number,
    .power = matlab_power, .power_level = plain_power_level, .call = matlab_call,
    .call_level = matlab_level};
const Dialect dialect_python = {INLINE, .names_pi = true, .symbol = python_symbol, .number = plain_number,
    .power = star_power, .power_level = plain_power_level, .call = python_call,
    .call_level = closed_level};
const Dialect dialect_fortran = {INLINE, .symbol = code_symbol, .number = fortran_number,
    .power = star_power, .power_level = plain_power_level, .call = fortran_call,
    .call_level = closed_level};
/* clang-format on */

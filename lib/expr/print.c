/* print.c: expressions as text, the part that all notations share */
#include "expr/print_impl.h"

#include "base/decimal.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- laying out --- */

void say(Printer *printer, const char *text)
{
    write_part(printer, text, strlen(text));
}

void write_part(Printer *printer, const char *text, size_t length)
{
    LIST_PUSH(printer->pieces, (Piece){.kind = PIECE_TEXT, .text = text, .length = length});
}

void write_node(Printer *printer, Expr e, Level level)
{
    LIST_PUSH(printer->pieces, (Piece){.kind = PIECE_NODE, .e = e, .level = level});
}

void write_number(Printer *printer, Number number, Level level)
{
    LIST_PUSH(printer->pieces, (Piece){.kind = PIECE_NUMBER, .number = number, .level = level});
}

void write_pieces(Printer *printer, const Piece *pieces, int count, const char *between)
{
    for (int i = 0; i < count; i++) {
        if (i > 0)
            say(printer, between);
        LIST_PUSH(printer->pieces, pieces[i]);
    }
}

void write_arguments(Printer *printer, Expr e)
{
    for (int i = 0; i < e->count; i++) {
        if (i > 0)
            say(printer, ", ");
        write_node(printer, node_args(e)[i], LEVEL_ANY);
    }
}

/* --- sums --- */

typedef LIST(Expr) Summands;

/* The terms of a sum, and of sums among them. A named sum, or one with a shorter form, isn't merged
 * into the surrounding sum. Its sign is that of its own terms. */
static Summands summands_of(Expr sum)
{
    Summands waiting = {0}, terms = {0};

    LIST_PUSH(waiting, sum);
    while (waiting.count > 0) {
        const Expr e = waiting.at[--waiting.count];
        const Expr inside = held(e);

        if (inside->kind != EXPR_SUM) {
            LIST_PUSH(terms, e);
            continue;
        }
        for (int i = inside->count; i-- > 0;)
            LIST_PUSH(waiting, node_args(inside)[i]);
    }
    LIST_FREE(waiting);
    return terms;
}

/* The first term that needs no minus sign; a sum reads better when it starts there. */
static int first_term(const Summands *terms)
{
    for (int i = 0; i < terms->count; i++) {
        if (!is_negative(held(terms->at[i])))
            return i;
    }
    return 0;
}

static void write_term(Printer *printer, Expr term, bool first)
{
    const bool negative = is_negative(held(term));

    if (negative)
        say(printer, first ? "-" : printer->dialect->minus);
    else if (!first)
        say(printer, printer->dialect->plus);
    LIST_PUSH(printer->pieces, (Piece){.kind = negative ? PIECE_MAGNITUDE : PIECE_NODE,
                                       .e = term,
                                       .level = negative ? LEVEL_PRODUCT : LEVEL_SUM});
}

static void lay_sum(Printer *printer, Expr sum)
{
    Summands terms = summands_of(sum);
    const int start = first_term(&terms);

    assert(terms.count > 0);
    write_term(printer, terms.at[start], true);
    for (int i = 0; i < terms.count; i++) {
        if (i != start)
            write_term(printer, terms.at[i], false);
    }
    LIST_FREE(terms);
}

/* --- products --- */

/* A factor is printed above the line, or with the opposite exponent below it. */
static void sort_factor(Fraction *fraction, Expr factor)
{
    Expr exponent = factor->kind == EXPR_POWER ? node_args(factor)[1] : NULL;

    if (exponent != NULL && is_number(exponent) && is_negative(exponent)) {
        Number opposite = number_neg(number_of(exponent));

        LIST_PUSH(fraction->below,
                  (Piece){.kind = number_is(opposite, 1) ? PIECE_NODE : PIECE_POWER,
                          .e = node_args(factor)[0],
                          .number = opposite,
                          .level = LEVEL_UNARY});
    } else
        LIST_PUSH(fraction->above, (Piece){.kind = PIECE_NODE, .e = factor, .level = LEVEL_UNARY});
}

/* what every notation writes as it writes a symbol */
static const struct {
    struct ExprNode head;
    SymbolData data;
} symbol_pi = {{.kind = EXPR_SYMBOL}, {.name = "pi"}};

static bool is_named(const Printer *printer, Number number)
{
    return printer->dialect->names_pi && number.den != 0 && number.pi != 0;
}

/* denominators that angles have: pi/2, not 0.5*pi, but 0.1*pi */
static bool divides_turns(int64_t den)
{
    return den > 1 && den <= 12 && den % 5 != 0;
}

/* the power of pi in the fraction's number is a factor, above or below */
static void sort_pi(Fraction *fraction)
{
    const int64_t power = fraction->number.pi;
    const Piece pi = {.kind = power == 1 || power == -1 ? PIECE_NODE : PIECE_POWER,
                      .e = &symbol_pi.head,
                      .number = number_int(power < 0 ? -power : power),
                      .level = LEVEL_UNARY};

    fraction->number.pi = 0;
    if (divides_turns(fraction->number.den)) {
        LIST_PUSH(fraction->below, (Piece){.kind = PIECE_NUMBER,
                                           .number = number_int(fraction->number.den),
                                           .level = LEVEL_UNARY});
        fraction->number.den = 1;
    }
    if (power > 0)
        LIST_PUSH(fraction->above, pi);
    else
        LIST_PUSH(fraction->below, pi);
}

/* Whether a factor is a named product whose factors can stand among those around it: one with a
 * number, can't. */
static bool is_merged(Expr factor)
{
    const Expr inside = held(factor);

    return inside != factor && inside->kind == EXPR_PRODUCT && !is_number(node_args(inside)[0]);
}

/* a product, or a power below the line, without its sign; or a number, where e is NULL */
static void lay_product(Printer *printer, Expr e, Number number)
{
    Fraction fraction = {.number = number};
    const bool is_product = e != NULL && e->kind == EXPR_PRODUCT;
    const Expr *factors = is_product ? node_args(e) : &e;
    const int count = is_product ? e->count : e != NULL;
    const bool numbered = count > 0 && is_number(factors[0]);

    if (numbered)
        fraction.number = number_of(factors[0]);
    if (number_sign(fraction.number) < 0)
        fraction.number = number_neg(fraction.number);
    if (is_named(printer, fraction.number))
        sort_pi(&fraction);
    for (int i = numbered; i < count; i++) {
        const Expr factor = factors[i];

        assert(factor != NULL);
        if (!is_merged(factor))
            sort_factor(&fraction, factor);
        for (int k = 0; is_merged(factor) && k < held(factor)->count; k++)
            sort_factor(&fraction, node_args(held(factor))[k]);
    }
    printer->dialect->fraction(printer, &fraction);
    LIST_FREE(fraction.above);
    LIST_FREE(fraction.below);
}

static void lay_number(Printer *printer, Number number)
{
    if (is_named(printer, number))
        lay_product(printer, NULL, number);
    else
        printer->dialect->number(printer->out, number);
}

void fraction_inline(Printer *printer, const Fraction *fraction, const char *divide)
{
    bool numbered = !number_is(fraction->number, 1) || fraction->above.count == 0;

    if (numbered)
        write_number(printer, fraction->number, LEVEL_PRODUCT);
    if (numbered && fraction->above.count > 0)
        say(printer, printer->dialect->times);
    write_pieces(printer, fraction->above.at, fraction->above.count, printer->dialect->times);
    if (fraction->below.count == 0)
        return;
    say(printer, divide);
    if (fraction->below.count > 1)
        say(printer, printer->dialect->open);
    write_pieces(printer, fraction->below.at, fraction->below.count, printer->dialect->times);
    if (fraction->below.count > 1)
        say(printer, printer->dialect->close);
}

/* --- operators --- */

Level operator_level(Expr e)
{
    switch (e->op) {
    case OP_OR:
        return LEVEL_OR;
    case OP_AND:
        return LEVEL_AND;
    case OP_NOT:
        return LEVEL_UNARY;
    case OP_LT:
    case OP_LE:
    case OP_EQ:
    case OP_NE:
        return LEVEL_COMPARE;
    default:
        return LEVEL_ATOM;
    }
}

Level plain_power_level(Expr base, Expr exponent, Number number)
{
    (void)base;
    (void)exponent;
    (void)number;
    return LEVEL_POWER;
}

bool write_operator(Printer *printer, Expr e, const char *sign)
{
    Level level = operator_level(e);

    if (level == LEVEL_ATOM)
        return false;
    if (e->op == OP_NOT) {
        say(printer, sign);
        write_node(printer, node_args(e)[0], LEVEL_POWER);
        return true;
    }
    /* comparisons don't chain; the others bind to the left */
    write_node(printer, node_args(e)[0], level == LEVEL_COMPARE ? LEVEL_SUM : level);
    say(printer, " ");
    say(printer, sign);
    say(printer, " ");
    write_node(printer, node_args(e)[1], (Level)(level + 1));
    return true;
}

bool write_law(Printer *printer, Expr e)
{
    const Expr *args = node_args(e);
    const Curve *curve = expr_data(args[0]);
    const int order = (int)expr_value(args[2]);

    if (!curve_is_law(curve))
        return false;
    write_node(printer, args[0], LEVEL_ATOM);
    for (int i = 0; i < order; i++)
        say(printer, "'");
    if (order > 0 && args[1]->kind == EXPR_SYMBOL && strcmp(expr_name(args[1]), curve->column) == 0)
        return true;
    /* brackets of TeX that grow have room around them */
    say(printer, args[1]->kind == EXPR_SYMBOL ? "(" : printer->dialect->open);
    write_node(printer, args[1], LEVEL_ANY);
    say(printer, args[1]->kind == EXPR_SYMBOL ? ")" : printer->dialect->close);
    return true;
}

/* --- numbers --- */

bool ratio_decimal(char text[64], Number number, int most)
{
    int64_t rest = number.den;
    int twos = 0;
    int fives = 0;
    int places;
    int length;
    __int128 digits = number.num;
    char plain[24];

    for (; rest % 2 == 0; rest /= 2)
        twos++;
    for (; rest % 5 == 0; rest /= 5)
        fives++;
    places = twos > fives ? twos : fives;
    if (rest != 1 || places > 18)
        return false;
    for (int i = twos; i < places; i++)
        digits *= 2;
    for (int i = fives; i < places; i++)
        digits *= 5;
    if (digits > 999999999999999)
        return false;
    length = snprintf(plain, sizeof plain, "%lld", (long long)digits);
    if (length > most)
        return false;
    if (places == 0)
        snprintf(text, 64, "%s", plain);
    else if (places < length)
        snprintf(text, 64, "%.*s.%s", length - places, plain, plain + length - places);
    else if (places < length + 4)
        snprintf(text, 64, "0.%.*s%s", places - length, "0000", plain);
    else
        snprintf(text, 64, "%c%s%se-%d", plain[0], length > 1 ? "." : "", plain + 1,
                 places - length + 1);
    return true;
}

enum { LONG_INTEGER = 6, ENOUGH_SAVED = 3 }; /* digits: 100000 and 1500000 in full, but 1e6 */

bool integer_power(char text[64], int64_t value)
{
    const int written = snprintf(text, 64, "%lld", (long long)value);
    char digits[24];
    int last = written - 1, exponent, length;

    while (last > 0 && text[last] == '0')
        last--;
    snprintf(digits, sizeof digits, "%.*s", last + 1, text);
    const char *first = digits + (digits[0] == '-');
    exponent = written - 1 - (digits[0] == '-');
    length = snprintf(text, 64, "%.*s%s%se%d", (int)(first - digits) + 1, digits,
                      first[1] != '\0' ? "." : "", first + 1, exponent);
    return exponent >= LONG_INTEGER && length + ENOUGH_SAVED <= written;
}

void double_text(char text[64], double value)
{
    int64_t num;
    int64_t den;

    (void)decimal_print(text, value, DECIMAL_EXACT);
    /* a short decimal would be read as an exact one */
    if (decimal_exact(text, &num, &den))
        snprintf(text, 64, "%#.17g", value);
}

/* --- the machine --- */

static Level number_level(const Printer *printer, Number number)
{
    Text digits = {0};
    Level level;

    if (is_named(printer, number))
        return number.pi == 1 && number.num == 1 && number.den == 1 ? LEVEL_ATOM : LEVEL_PRODUCT;
    level = printer->dialect->number(&digits, number);
    text_free(&digits);
    return level;
}

/* whether e prints as a division although it is no product */
static bool is_reciprocal(Expr e)
{
    return e->kind == EXPR_POWER && is_number(node_args(e)[1]) && is_negative(node_args(e)[1]);
}

static Level node_level(const Printer *printer, Expr e)
{
    switch (e->kind) {
    case EXPR_SUM:
        return LEVEL_SUM;
    case EXPR_PRODUCT:
        return LEVEL_PRODUCT;
    case EXPR_POWER:
        if (is_reciprocal(e))
            return LEVEL_PRODUCT;
        return printer->dialect->power_level(node_args(e)[0], node_args(e)[1], number_int(0));
    case EXPR_CALL:
        return printer->dialect->call_level(e);
    case EXPR_SYMBOL:
        return LEVEL_ATOM;
    default:
        return is_negative(e) ? LEVEL_PRODUCT : number_level(printer, number_of(e));
    }
}

/* The pieces of e, in order; without its minus sign where `magnitude` is set. */
static void lay_node(Printer *printer, Expr e, bool magnitude)
{
    switch (e->kind) {
    case EXPR_SUM:
        lay_sum(printer, e);
        break;
    case EXPR_PRODUCT:
        if (!magnitude && is_negative(e))
            say(printer, "-");
        lay_product(printer, e, number_int(1));
        break;
    case EXPR_POWER:
        if (is_reciprocal(e))
            lay_product(printer, e, number_int(1));
        else
            printer->dialect->power(printer, node_args(e)[0], node_args(e)[1], number_int(0));
        break;
    case EXPR_CALL:
        printer->dialect->call(printer, e);
        break;
    case EXPR_SYMBOL:
        printer->dialect->symbol(printer->out, e);
        break;
    default:
        if (!is_negative(e))
            lay_number(printer, number_of(e));
        else {
            if (!magnitude)
                say(printer, "-");
            write_number(printer, number_neg(number_of(e)), LEVEL_PRODUCT);
        }
    }
}

static void lay_piece(Printer *printer, const Piece *piece)
{
    Expr e = piece->e != NULL ? held(piece->e) : NULL;
    const PieceKind kind = piece->kind;

    assert(e != NULL || kind == PIECE_NUMBER);

    Level level = kind == PIECE_NUMBER  ? number_level(printer, piece->number)
                  : kind == PIECE_POWER ? printer->dialect->power_level(e, NULL, piece->number)
                                        : node_level(printer, e);
    bool brackets = level < piece->level;

    /* text that is written at once, not as pieces, must not precede its bracket */
    if (brackets)
        say(printer, printer->dialect->open);
    if (brackets)
        LIST_PUSH(printer->pieces, (Piece){.kind = kind, .e = e, .number = piece->number});
    else if (kind == PIECE_NUMBER)
        lay_number(printer, piece->number);
    else if (kind == PIECE_POWER)
        printer->dialect->power(printer, e, NULL, piece->number);
    else
        lay_node(printer, e, kind == PIECE_MAGNITUDE);
    if (brackets)
        say(printer, printer->dialect->close);
}

void print_with(Text *out, Expr e, const Dialect *dialect)
{
    Printer printer = {.out = out, .dialect = dialect};

    write_node(&printer, e, LEVEL_ANY);
    while (printer.pieces.count > 0) {
        Piece piece = printer.pieces.at[--printer.pieces.count];
        int low = printer.pieces.count;
        int high;

        if (piece.kind == PIECE_TEXT) {
            text_add_n(out, piece.text, piece.length);
            continue;
        }
        lay_piece(&printer, &piece);
        for (high = printer.pieces.count - 1; low < high; low++, high--) {
            Piece other = printer.pieces.at[low];

            printer.pieces.at[low] = printer.pieces.at[high];
            printer.pieces.at[high] = other;
        }
    }
    LIST_FREE(printer.pieces);
}

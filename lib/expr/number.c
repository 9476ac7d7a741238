/* number.c: exact rationals, and doubles where they no longer fit
 *
 * Sums and products of rationals are computed in 128 bits. A result whose numerator or denominator
 * needs more than 63 bits becomes the nearest double. A rational times a power of pi, such as an
 * angle, is exact too. */
#include "expr/expr_impl.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef __int128 NumberWide;

/* digits of a literal from which on it is meant as a double: what a double prints with */
enum { DOUBLE_DIGITS = 16 };

static NumberWide long_gcd(NumberWide a, NumberWide b)
{
    a = a < 0 ? -a : a;
    b = b < 0 ? -b : b;
    while (b != 0) {
        NumberWide rest = a % b;

        a = b;
        b = rest;
        /* most end up small */
        if (a <= INT64_MAX && b <= INT64_MAX) {
            uint64_t x = (uint64_t)a;
            uint64_t y = (uint64_t)b;

            while (y != 0) {
                uint64_t z = x % y;

                x = y;
                y = z;
            }
            return (NumberWide)x;
        }
    }
    return a;
}

/* den > 0 */
static Number long_ratio(NumberWide num, NumberWide den)
{
    if (den != 1) {
        NumberWide common = long_gcd(num, den);

        num /= common;
        den /= common;
    }
    if (num > INT64_MAX || num < -INT64_MAX || den > INT64_MAX)
        return (Number){.real = (double)num / (double)den};
    return (Number){(int64_t)num, (int64_t)den, {0}};
}

/* a double; what cancels or underflows to zero is the exact one, so that terms vanish with it */
static Number number_double(double value)
{
    return value == 0.0 ? (Number){0, 1, {0}} : (Number){.real = value};
}

/* powers of pi that a node can store */
enum { MOST_PI = 100 };

static long double pi_power(int64_t power)
{
    return powl(3.14159265358979323846264338327950288L, (long double)power);
}

/* a, which is no multiple of pi, times a power of it */
static Number times_pi(Number a, int64_t power)
{
    if (a.den == 0 || power > MOST_PI || power < -MOST_PI)
        return number_double((double)(number_value(a) * pi_power(power)));
    if (a.num != 0)
        a.pi = power;
    return a;
}

static Number without_pi(Number a)
{
    return (Number){a.num, a.den, {0}};
}

static bool is_of_pi(Number a)
{
    return a.den != 0 && a.pi != 0;
}

Number number_int(int64_t value)
{
    return (Number){value, 1, {0}};
}

Number number_of(Expr number)
{
    Number n = {0};

    if (number->kind == EXPR_REAL && number->op == 0)
        memcpy(&n.real, number + 1, sizeof n.real);
    else {
        n.num = node_ratio(number)->num;
        n.den = node_ratio(number)->den;
        n.pi = (int8_t)number->op;
    }
    return n;
}

double number_value(Number a)
{
    if (a.den == 0)
        return a.real;
    if (a.pi != 0)
        return (double)((long double)a.num * pi_power(a.pi) / (long double)a.den);
    return (double)a.num / (double)a.den;
}

Number number_add(Number a, Number b)
{
    if (number_is(a, 0))
        return b;
    if (number_is(b, 0))
        return a;
    if (a.den == 0 || b.den == 0 || a.pi != b.pi)
        return number_double(number_value(a) + number_value(b));
    if (a.pi != 0)
        return times_pi(number_add(without_pi(a), without_pi(b)), a.pi);
    if (a.den == 1 && b.den == 1)
        return long_ratio((NumberWide)a.num + b.num, 1);
    return long_ratio((NumberWide)a.num * b.den + (NumberWide)b.num * a.den,
                      (NumberWide)a.den * b.den);
}

/* Doubles result from values of functions and from long products, each rounded by about eps/2:
 * entries of a product of three rotations have an error of some 5 eps/2 relative to 1. */
#define ROUNDED (16 * DBL_EPSILON)

void number_gather(Number *sum, double *size, Number a)
{
    const Number before = *sum;

    *sum = number_add(before, a);
    if (number_is(before, 0)) {
        *size = a.den == 0 ? fabs(a.real) : 0;
        return;
    }
    if (*size == 0 && sum->den != 0)
        return;
    *size += fabs(number_value(a)) + (*size == 0 ? fabs(number_value(before)) : 0);
    if (sum->den == 0 && fabs(sum->real) <= ROUNDED * *size)
        *sum = number_int(0);
}

Number number_mul(Number a, Number b)
{
    if (a.den == 0 || b.den == 0) {
        /* an exact zero remains exact */
        if (number_is(a, 0) || number_is(b, 0))
            return number_int(0);
        return number_double(number_value(a) * number_value(b));
    }
    if ((a.pi | b.pi) != 0)
        return times_pi(number_mul(without_pi(a), without_pi(b)), a.pi + b.pi);
    return long_ratio((NumberWide)a.num * b.num, (NumberWide)a.den * b.den);
}

Number number_neg(Number a)
{
    if (a.den == 0)
        a.real = -a.real;
    else
        a.num = -a.num;
    return a;
}

Number number_power(Number a, int64_t k)
{
    Number power = number_int(1);
    uint64_t left = k < 0 ? -(uint64_t)k : (uint64_t)k;

    if (a.den == 0)
        return (Number){.real = pow(a.real, (double)k)};
    if (a.pi != 0)
        return left <= MOST_PI ? times_pi(number_power(without_pi(a), k), a.pi * k)
                               : (Number){.real = pow(number_value(a), (double)k)};
    if (k < 0)
        a = a.num < 0 ? (Number){-a.den, -a.num, {0}} : (Number){a.den, a.num, {0}};
    if (a.den == 1 && (a.num == 1 || a.num == 0))
        return a;
    if (a.den == 1 && a.num == -1)
        return number_int(left % 2 == 0 ? 1 : -1);
    for (Number square = a; left != 0; left /= 2) {
        if (left % 2 != 0)
            power = number_mul(power, square);
        if (power.den == 0 || square.den == 0)
            return (Number){.real = pow(number_value(a), k < 0 ? -(double)k : (double)k)};
        square = left > 1 ? number_mul(square, square) : square;
    }
    return power;
}

bool number_is(Number a, int64_t value)
{
    return a.den == 1 && a.num == value && a.pi == 0;
}

bool number_is_whole(Number a)
{
    return a.den == 1 && a.pi == 0;
}

bool number_same(Number a, Number b)
{
    return a.den == b.den && (a.den != 0 ? a.num == b.num && a.pi == b.pi : a.real == b.real);
}

int number_sign(Number a)
{
    if (a.den != 0)
        return (a.num > 0) - (a.num < 0);
    return (a.real > 0) - (a.real < 0);
}

/* by value, a rational before a double of the same value, and a multiple of pi before both */
int number_compare(Number a, Number b)
{
    if (a.den != 0 && b.den != 0 && a.pi == b.pi) {
        NumberWide left = (NumberWide)a.num * b.den;
        NumberWide right = (NumberWide)b.num * a.den;

        return (left > right) - (left < right);
    }
    if (number_value(a) != number_value(b))
        return number_value(a) < number_value(b) ? -1 : 1;
    return (a.den == 0) - (b.den == 0) + 2 * (is_of_pi(b) - is_of_pi(a));
}

Expr number_node(Arena *arena, Number a)
{
    if (a.den == 0)
        return expr_real(arena, a.real);
    return a.pi != 0 ? node_pi(arena, a.num, a.den, (int)a.pi) : node_rational(arena, a.num, a.den);
}

/* the exact k-th root of n > 0, or 0 */
static int64_t integer_root(int64_t n, int64_t k)
{
    int64_t guess = (int64_t)llround(pow((double)n, 1.0 / (double)k));

    for (int64_t root = guess - 1; root <= guess + 1; root++) {
        if (root > 0 && number_is(number_power(number_int(root), k), n))
            return root;
    }
    return 0;
}

bool number_root(Number a, int64_t k, Number *root)
{
    int64_t num;
    int64_t den;

    if (a.den == 0 || a.num <= 0 || k < 1 || k > 64 || a.pi % k != 0)
        return false;
    num = integer_root(a.num, k);
    den = integer_root(a.den, k);
    if (num == 0 || den == 0)
        return false;
    *root = (Number){num, den, .pi = a.pi / k};
    return true;
}

/* --- leaves --- */

Expr expr_int(Arena *arena, int64_t value)
{
    if (value == INT64_MIN) /* has no negative */
        return node_real(arena, (double)value);
    return node_rational(arena, value, 1);
}

Expr expr_rational(Arena *arena, int64_t num, int64_t den)
{
    if (den == 0) {
        arena_fail(arena, E_DOMAIN, "division by zero");
        return arena_zero(arena);
    }
    return number_node(arena, den < 0 ? long_ratio(-(NumberWide)num, -(NumberWide)den)
                                      : long_ratio(num, den));
}

Expr expr_real(Arena *arena, double value)
{
    double scaled = value * 1024;

    if (!isfinite(value)) {
        arena_fail(arena, E_DOMAIN, "a number beyond what can be held");
        return arena_zero(arena);
    }
    if (fabs(value) < 0x1p53 && value == floor(value))
        return node_rational(arena, (int64_t)value, 1);
    if (fabs(value) < 0x1p20 && scaled == floor(scaled))
        return expr_rational(arena, (int64_t)scaled, 1024);
    return node_real(arena, value);
}

Expr expr_pi(Arena *arena, int power)
{
    return number_node(arena, times_pi(number_int(1), power));
}

/* value*10 + digit, false where it gets too long */
static bool append_digit(NumberWide *value, int digit)
{
    if (*value > (NumberWide)INT64_MAX * 1000000000)
        return false;
    *value = *value * 10 + digit;
    return true;
}

bool decimal_exact(const char *text, int64_t *num, int64_t *den)
{
    NumberWide digits = 0;
    NumberWide power = 1;
    long exponent = 0;
    int significant = 0;
    bool point = false;
    Number n;

    for (; isdigit((unsigned char)*text) || (*text == '.' && !point); text++) {
        if (*text == '.') {
            point = true;
            continue;
        }
        if (!append_digit(&digits, *text - '0'))
            return false;
        significant += digits != 0;
        exponent -= point;
    }
    if (*text == 'e' || *text == 'E') {
        exponent += strtol(text + 1, NULL, 10);
        point = true;
    }
    if ((point && significant >= DOUBLE_DIGITS) || exponent > 40 || exponent < -40)
        return digits == 0 ? (*num = 0, *den = 1, true) : false;
    for (long i = labs(exponent); i > 0; i--) {
        if (power > (NumberWide)INT64_MAX * 1000000000)
            return false;
        power *= 10;
    }
    if (exponent > 0 && digits > INT64_MAX / power)
        return false;
    n = exponent > 0 ? long_ratio(digits * power, 1) : long_ratio(digits, power);
    *num = n.num;
    *den = n.den;
    return n.den != 0;
}

Expr expr_decimal(Arena *arena, const char *text)
{
    int64_t num;
    int64_t den;

    if (*text == '-')
        return number_node(arena, number_neg(number_of(expr_decimal(arena, text + 1))));
    if (decimal_exact(text, &num, &den))
        return node_rational(arena, num, den);
    return expr_real(arena, strtod(text, NULL));
}

/* --- looking --- */

bool expr_is_number(Expr e)
{
    return is_number(e);
}

double expr_value(Expr number)
{
    return number_value(number_of(number));
}

bool expr_rational_parts(Expr e, int64_t *num, int64_t *den)
{
    if (e->kind != EXPR_RATIONAL)
        return false;
    *num = node_ratio(e)->num;
    *den = node_ratio(e)->den;
    return true;
}

bool expr_integer(Expr e, int64_t *value)
{
    if (e->kind != EXPR_RATIONAL || node_ratio(e)->den != 1)
        return false;
    *value = node_ratio(e)->num;
    return true;
}

bool expr_is(Expr e, int64_t value)
{
    return e->kind == EXPR_RATIONAL && node_ratio(e)->den == 1 && node_ratio(e)->num == value;
}

bool expr_is_zero(Expr e)
{
    return expr_is(e, 0);
}

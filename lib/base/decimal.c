/* decimal.c: the shortest decimal that reads back to a number
 *
 * Seventeen digits are a product with a power of ten that numbers of 64 bits hold exactly, rounded
 * once. What they round to in 15 or 16 reads back if it lies nearer to the value than half way to
 * the next double. Both are known but for a sliver that rounding leaves open, and for numbers that
 * are very large or small; there printf() and strtod() tell. */
#include "base/decimal.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ALWAYS = 15, /* digits that every decimal of no more keeps */
    POWERS = 28, /* of ten, that 64 bits hold but for a power of two */
    PLAIN = -4   /* least exponent that %g writes without one */
};
#define FIFTEEN 1000000000000000U    /* the first number of one more */
#define LEAST   10000000000000000.0L /* of 17 digits */
#define NOISE   0.02 /* of a unit of the seventeenth digit: more than rounding leaves */
#define LOG10_2 0.30102999566398119521

/* The value is (digits + rest) * 10^(exponent - 16). */
typedef struct Decimal {
    uint64_t digits; /* 17 */
    double rest;     /* that they leave, within NOISE */
    int exponent;    /* of the first */
} Decimal;

/* false: not known */
static bool seventeen(double size, Decimal *out)
{
#if LDBL_MANT_DIG >= 64
    static const long double powers[POWERS] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,
                                               1e7L,  1e8L,  1e9L,  1e10L, 1e11L, 1e12L, 1e13L,
                                               1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L, 1e20L,
                                               1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
    int exponent = (int)floor(ilogb(size) * LOG10_2); /* or one more */

    for (int tries = 0; tries < 2; tries++, exponent++) {
        const int shift = DECIMAL_EXACT - 1 - exponent;
        long double scaled;

        if (abs(shift) >= POWERS)
            return false;
        scaled = shift >= 0 ? size * powers[shift] : size / powers[-shift];
        if (scaled >= 10 * LEAST)
            continue;
        out->digits = (uint64_t)scaled;
        out->rest = (double)(scaled - (long double)out->digits);
        if (out->rest > 0.5) {
            out->digits++;
            out->rest--;
        }
        out->exponent = exponent;
        return scaled >= LEAST && 0.5 - fabs(out->rest) > NOISE && (double)out->digits < 1e17;
    }
#else
    (void)size;
    (void)out;
#endif
    return false;
}

/* what it has over a multiple of a unit, in those of the last digit */
static double over(const Decimal *decimal, uint64_t unit)
{
    return (double)(decimal->digits % unit) + decimal->rest;
}

/* Fewest digits, up to `most`, of which it is known that the value reads back from them and not
 * from fewer; 0: not known. */
static int fewest(double size, const Decimal *decimal, int most)
{
    const double up = nextafter(size, HUGE_VAL) - size, down = size - nextafter(size, 0);
    const double reach = up / 2 / size * (double)decimal->digits;

    if (up != down)
        return 0;
    for (int n = ALWAYS; n < most; n++) {
        const uint64_t unit = n == ALWAYS ? 100 : 10;
        const double above = over(decimal, unit);
        const double distance = fabs(above > (double)unit / 2 ? (double)unit - above : above);

        if (fabs(distance - reach) < NOISE)
            return 0;
        if (distance < reach)
            return (double)unit / 2 - distance > NOISE ? n : 0;
    }
    return most == DECIMAL_EXACT ? most : 0;
}

/* as %g does for n digits: the first stands for 10^exponent, zeros at the end are gone */
static void lay_out(char *text, const char *digits, int length, int exponent, int n)
{
    const int point = exponent + 1;

    if (exponent < PLAIN || exponent >= n) {
        *text++ = digits[0];
        if (length > 1)
            *text++ = '.';
        memcpy(text, digits + 1, (size_t)length - 1);
        text += length - 1;
        *text++ = 'e'; /* of two digits: powers that are held have no more */
        *text++ = exponent < 0 ? '-' : '+';
        *text++ = (char)('0' + abs(exponent) / 10);
        *text++ = (char)('0' + abs(exponent) % 10);
        *text = '\0';
        return;
    }
    /* from the digit before the point on, at least */
    for (int i = point < 1 ? point - 1 : 0; i < (length > point ? length : point); i++) {
        *text++ = i >= 0 && i < length ? digits[i] : '0';
        if (i + 1 == point && i + 1 < length)
            *text++ = '.';
    }
    *text = '\0';
}

static void write_digits(char *text, const Decimal *decimal, int n)
{
    const uint64_t unit = n == ALWAYS ? 100 : n < DECIMAL_EXACT ? 10 : 1;
    uint64_t left = decimal->digits / unit + (over(decimal, unit) > (double)unit / 2);
    char digits[DECIMAL_EXACT] = {'0'};
    int exponent = decimal->exponent, length = n;

    if (unit > 1 && left == 100 / unit * FIFTEEN) {
        left /= 10; /* rounded up to one more */
        exponent++;
    }
    for (int i = n - 1; i >= 0; i--, left /= 10)
        digits[i] = (char)('0' + left % 10);
    while (length > 1 && digits[length - 1] == '0')
        length--;
    lay_out(text, digits, length, exponent, n);
}

static void try_digits(char *text, double value, int most)
{
    for (int n = most < ALWAYS ? most : ALWAYS; n <= most; n++) {
        (void)snprintf(text, DECIMAL_SIZE, "%.*g", n < DECIMAL_EXACT ? n : DECIMAL_EXACT, value);
        if (n == most || strtod(text, NULL) == value)
            return;
    }
}

void decimal_print(char text[DECIMAL_SIZE], double value, int most)
{
    const double size = fabs(value);
    Decimal decimal;
    int n = 0;

    most = most < DECIMAL_EXACT ? most : DECIMAL_EXACT;
    if (most > ALWAYS && isnormal(value) && seventeen(size, &decimal))
        n = fewest(size, &decimal, most);
    if (n == 0) {
        try_digits(text, value, most);
        return;
    }
    if (value < 0)
        *text++ = '-';
    write_digits(text, &decimal, n);
}

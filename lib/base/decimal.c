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
#define HIDDEN  ((uint64_t)1 << (DBL_MANT_DIG - 1)) /* the bit of a mantissa that isn't stored */

/* The value is mantissa * 2^(binary - 52), and (digits + rest) * 10^(exponent - 16). */
typedef struct Decimal {
    uint64_t mantissa;
    int binary;
    uint64_t digits; /* 17 */
    double rest;     /* that they leave, within NOISE */
    int exponent;    /* of the first */
} Decimal;

/* of a normal number */
static void take_apart(double size, Decimal *out)
{
    uint64_t bits;

    memcpy(&bits, &size, sizeof bits);
    out->mantissa = HIDDEN | (bits & (HIDDEN - 1));
    out->binary = (int)(bits >> (DBL_MANT_DIG - 1)) + DBL_MIN_EXP - 2;
}

/* floor(binary * log10(2)), right for all doubles */
static int decimal_exponent(int binary)
{
    const int log10_2 = 78913, scale = 1 << 18;

    return (binary * log10_2 - (binary < 0 ? scale - 1 : 0)) / scale;
}

/* false: not known */
static bool seventeen(double size, Decimal *out)
{
#if LDBL_MANT_DIG >= 64
    static const long double powers[POWERS] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,
                                               1e7L,  1e8L,  1e9L,  1e10L, 1e11L, 1e12L, 1e13L,
                                               1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L, 1e20L,
                                               1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
    int exponent = decimal_exponent(out->binary); /* or one more */

    for (int tries = 0; tries < 2; tries++, exponent++) {
        const int shift = DECIMAL_EXACT - 1 - exponent;
        long double scaled;
        int64_t whole;

        if (abs(shift) >= POWERS)
            return false;
        scaled = shift >= 0 ? size * powers[shift] : size / powers[-shift];
        if (scaled >= 10 * LEAST)
            continue;
        whole = (int64_t)scaled;
        out->rest = (double)(scaled - (long double)whole);
        if (out->rest > 0.5) {
            whole++;
            out->rest--;
        }
        out->digits = (uint64_t)whole;
        out->exponent = exponent;
        return scaled >= LEAST && 0.5 - fabs(out->rest) > NOISE && (double)whole < 1e17;
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
    return (double)(int64_t)(decimal->digits % unit) + decimal->rest;
}

/* Fewest digits, up to `most`, of which it is known that the value reads back from them and not
 * from fewer; 0: not known. The next doubles are as far to either side, but for powers of two. */
static int fewest(const Decimal *decimal, int most)
{
    const double reach =
        0.5 * (double)(int64_t)decimal->digits / (double)(int64_t)decimal->mantissa;

    if (decimal->mantissa == HIDDEN)
        return 0;
    for (int n = ALWAYS; n < most; n++) {
        const uint64_t unit = n == ALWAYS ? 100 : 10;
        const double above = n == ALWAYS ? over(decimal, 100) : over(decimal, 10);
        const double distance = fabs(above > (double)unit / 2 ? (double)unit - above : above);

        if (fabs(distance - reach) < NOISE)
            return 0;
        if (distance < reach)
            return (double)unit / 2 - distance > NOISE ? n : 0;
    }
    return most == DECIMAL_EXACT ? most : 0;
}

/* as %g does for n digits: the first stands for 10^exponent, zeros at the end are gone; hands over
 * the end */
static char *lay_out(char *text, const char *digits, int length, int exponent, int n)
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
        return text;
    }
    if (point <= 0) {
        memcpy(text, "0.0000", (size_t)(2 - point));
        text += 2 - point;
        memcpy(text, digits, (size_t)length);
        text += length;
    } else if (length <= point) {
        memcpy(text, digits, (size_t)length);
        memset(text + length, '0', (size_t)(point - length));
        text += point;
    } else {
        memcpy(text, digits, (size_t)point);
        text[point] = '.';
        memcpy(text + point + 1, digits + point, (size_t)(length - point));
        text += length + 1;
    }
    return text;
}

/* `count` digits of a number that has no more, two at a time; a number of 64 bits by its halves */
static void spell_short(char *digits, uint32_t number, int count)
{
    static const char pairs[] = "00010203040506070809101112131415161718192021222324"
                                "25262728293031323334353637383940414243444546474849"
                                "50515253545556575859606162636465666768697071727374"
                                "75767778798081828384858687888990919293949596979899";

    for (; count > 1; count -= 2, number /= 100)
        memcpy(digits + count - 2, pairs + 2 * (number % 100), 2);
    if (count > 0)
        digits[0] = (char)('0' + number % 10);
}

static void spell(char *digits, uint64_t number, int count)
{
    enum { HALF = 8 };
    const uint32_t half = 100000000;

    spell_short(digits + count - HALF, (uint32_t)(number % half), HALF);
    spell_short(digits, (uint32_t)(number / half), count - HALF);
}

static char *write_digits(char *text, const Decimal *decimal, int n)
{
    const uint64_t unit = n == ALWAYS ? 100 : n < DECIMAL_EXACT ? 10 : 1;
    uint64_t left = decimal->digits;
    char digits[DECIMAL_EXACT];
    int exponent = decimal->exponent, length = n;

    if (n == ALWAYS)
        left = left / 100 + (over(decimal, 100) > 50);
    else if (n < DECIMAL_EXACT)
        left = left / 10 + (over(decimal, 10) > 5);
    if (unit > 1 && left == 100 / unit * FIFTEEN) {
        left /= 10; /* rounded up to one more */
        exponent++;
    }
    spell(digits, left, n);
    while (length > 1 && digits[length - 1] == '0')
        length--;
    return lay_out(text, digits, length, exponent, n);
}

static size_t try_digits(char *text, double value, int most)
{
    int length = 0;

    for (int n = most < ALWAYS ? most : ALWAYS; n <= most; n++) {
        length = snprintf(text, DECIMAL_SIZE, "%.*g", n < DECIMAL_EXACT ? n : DECIMAL_EXACT, value);
        if (n == most || strtod(text, NULL) == value)
            break;
    }
    return (size_t)length;
}

size_t decimal_print(char text[DECIMAL_SIZE], double value, int most)
{
    const double size = fabs(value);
    Decimal decimal;
    char *end = text;
    int n = 0;

    most = most < DECIMAL_EXACT ? most : DECIMAL_EXACT;
    if (most > ALWAYS && isnormal(value)) {
        take_apart(size, &decimal);
        if (seventeen(size, &decimal))
            n = fewest(&decimal, most);
    }
    if (n == 0)
        return try_digits(text, value, most);
    if (value < 0)
        *end++ = '-';
    end = write_digits(end, &decimal, n);
    *end = '\0';
    return (size_t)(end - text);
}

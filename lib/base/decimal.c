/* decimal.c: the shortest decimal that reads back to a number
 *
 * A number is scaled to 17 digits before the point by a power of ten of 126 bits, so that the
 * fraction is known to 2^-56. That determines the rounded digits, and whether fewer digits read
 * back: they do if they are nearer to the number than half way to the next double. Where the
 * fraction is too close to a tie to decide, printf() and strtod() are used. (Powers as products of
 * a coarse and a fine one: Jeon, Dragonbox, 2020.) */
#include "base/decimal.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ALWAYS = 15, /* decimals of up to so many digits are preserved */
    PLAIN = -4   /* least exponent that %g writes without one */
};

#ifdef __SIZEOF_INT128__

enum {
    FRACTION_BITS = 56, /* bits of `rest` */
    NOISE = 4,          /* of its last: more than rounding leaves */
    FINE = 28,          /* powers of ten whose odd part fits into 64 bits */
    FIRST = -12,        /* of the coarse ones, in FINE */
    COARSE = 26
};
#define HIDDEN ((uint64_t)1 << (DBL_MANT_DIG - 1)) /* the bit of a mantissa that isn't stored */

typedef unsigned __int128 DecimalWide;

/* digits * 10^(exponent - 16), and a rest of them */
typedef struct Decimal {
    uint64_t digits; /* 17 */
    uint64_t rest;   /* fraction of the last digit, times 2^FRACTION_BITS */
    uint64_t reach;  /* half way to the next double, in the same unit */
    bool is_edge;    /* a power of two: the next smaller double is but half as far */
    int exponent;    /* of the first digit */
} Decimal;

/* 10^n for n = 0, 1 ... */
static const uint64_t tens[] = {1U,
                                10U,
                                100U,
                                1000U,
                                10000U,
                                100000U,
                                1000000U,
                                10000000U,
                                100000000U,
                                1000000000U,
                                10000000000U,
                                100000000000U,
                                1000000000000U,
                                10000000000000U,
                                100000000000000U,
                                1000000000000000U,
                                10000000000000000U,
                                100000000000000000U};

/* floor(log2(10^n)) of all that doubles need */
static int binary_exponent(int n)
{
    enum { LOG2_10 = 1741647, BITS = 19 };

    return n * LOG2_10 >> BITS;
}

/* the first bits of 5^n, and so of 10^n: all that aren't 0 */
static const uint64_t fine_powers[FINE] = {
    /* clang-format off */
    0x8000000000000000, 0xA000000000000000, 0xC800000000000000, 0xFA00000000000000,
    0x9C40000000000000, 0xC350000000000000, 0xF424000000000000, 0x9896800000000000,
    0xBEBC200000000000, 0xEE6B280000000000, 0x9502F90000000000, 0xBA43B74000000000,
    0xE8D4A51000000000, 0x9184E72A00000000, 0xB5E620F480000000, 0xE35FA931A0000000,
    0x8E1BC9BF04000000, 0xB1A2BC2EC5000000, 0xDE0B6B3A76400000, 0x8AC7230489E80000,
    0xAD78EBC5AC620000, 0xD8D726B7177A8000, 0x878678326EAC9000, 0xA968163F0A57B400,
    0xD3C21BCECCEDA100, 0x84595161401484A0, 0xA56FA5B99019A5C8, 0xCECB8F27F4200F3A,
    /* clang-format on */
};

/* The first 126 bits or more of 10^n / 2^(*binary), followed by zeros if it has fewer. */
static DecimalWide power_of_ten(int n, int *binary)
{
    /* of 10^(FINE * (FIRST + i)) the first 128 bits, cut off */
    static const uint64_t coarse[COARSE][2] = {
        {0xE3E27A444D8D98B7, 0xFD1B1B2308169B25}, /* 1e-336 */
        {0xE61ACF033D1A45DF, 0x6FB92487298E33BD}, /* 1e-308 */
        {0xE858AD248F5C22C9, 0xD1B3400F8F9CFF68}, /* 1e-280 */
        {0xEA9C227723EE8BCB, 0x465E15A979C1CADC}, /* 1e-252 */
        {0xECE53CEC4A314EBD, 0xA4F8BF5635246428}, /* 1e-224 */
        {0xEF340A98172AACE4, 0x86FB897116C87C34}, /* 1e-196 */
        {0xF18899B1BC3F8CA1, 0xDC44E6C3CB279AC1}, /* 1e-168 */
        {0xF3E2F893DEC3F126, 0x5A89DBA3C3EFCCFA}, /* 1e-140 */
        {0xF64335BCF065D37D, 0x4D4617B5FF4A16D5}, /* 1e-112 */
        {0xF8A95FCF88747D94, 0x75A44C6397CE912A}, /* 1e-84 */
        {0xFB158592BE068D2E, 0xEED6E2F0F0D56712}, /* 1e-56 */
        {0xFD87B5F28300CA0D, 0x8BCA9D6E188853FC}, /* 1e-28 */
        {0x8000000000000000, 0x0000000000000000}, /* 1e0 */
        {0x813F3978F8940984, 0x4000000000000000}, /* 1e28 */
        {0x82818F1281ED449F, 0xBFF8F10E7A8921A4}, /* 1e56 */
        {0x83C7088E1AAB65DB, 0x792667C6DA79E0FA}, /* 1e84 */
        {0x850FADC09923329E, 0x03E2CF6BC604DDB0}, /* 1e112 */
        {0x865B86925B9BC5C2, 0x0B8A2392BA45A9B2}, /* 1e140 */
        {0x87AA9AFF79042286, 0x90FB44D2F05D0842}, /* 1e168 */
        {0x88FCF317F22241E2, 0x441FECE3BDF81F03}, /* 1e196 */
        {0x8A5296FFE33CC92F, 0x82BD6B70D99AAA6F}, /* 1e224 */
        {0x8BAB8EEFB6409C1A, 0x1AD089B6C2F7548E}, /* 1e252 */
        {0x8D07E33455637EB2, 0xDB0B487B6423E1E8}, /* 1e280 */
        {0x8E679C2F5E44FF8F, 0x570F09EAA7EA7648}, /* 1e308 */
        {0x8FCAC257558EE4E6, 0x213A4F0AA5E8A7B1}, /* 1e336 */
        {0x91315E37DB165AA9, 0x2C0DE8DD3D020C0C}, /* 1e364 */
    };
    const int place = (n - FINE * FIRST) / FINE, fine = n - FINE * (FIRST + place);
    const uint64_t by = fine_powers[fine];

    *binary = binary_exponent(n - fine) + binary_exponent(fine) - 126;
    return (DecimalWide)coarse[place][0] * by +
           (uint64_t)((DecimalWide)coarse[place][1] * by >> 64);
}

/* mantissa * 10^n / 2^(*binary), and the first bits of 10^n / 2^(*binary - 64) */
static DecimalWide scale(uint64_t mantissa, int n, uint64_t *power, int *binary)
{
    if (n >= 0 && n < FINE) {
        *power = fine_powers[n];
        *binary = binary_exponent(n) - 63;
        return (DecimalWide)mantissa * *power;
    }
    const DecimalWide whole = power_of_ten(n, binary);

    *power = (uint64_t)(whole >> 64);
    *binary += 64;
    return (DecimalWide)mantissa * *power + ((DecimalWide)mantissa * (uint64_t)whole >> 64);
}

/* floor(log10) of a normal number, or one off next to a power of ten: log2 is interpolated linearly
 * between powers of two */
static int decimal_exponent(uint64_t bits)
{
    enum { LOG10_2 = 78913, LOG_BITS = 18, TAKEN = 16 /* bits of the mantissa */ };
    const int64_t log2 =
        (int64_t)(bits >> (DBL_MANT_DIG - 1 - TAKEN)) - ((int64_t)(DBL_MAX_EXP - 1) << TAKEN);

    return (int)(log2 * LOG10_2 >> (LOG_BITS + TAKEN));
}

/* of a normal number; false: not known */
static bool take_apart(double size, Decimal *out)
{
    enum { LEADING = 64 - DBL_MANT_DIG };
    uint64_t bits;

    memcpy(&bits, &size, sizeof bits);
    const uint64_t mantissa = HIDDEN | (bits & (HIDDEN - 1));
    const int binary = (int)(bits >> (DBL_MANT_DIG - 1)) - (DBL_MAX_EXP - 1);

    out->is_edge = mantissa == HIDDEN;
    out->exponent = decimal_exponent(bits);
    for (int tries = 0; tries < 3; tries++) {
        uint64_t power;
        int of_power;
        const DecimalWide product =
            scale(mantissa << LEADING, DECIMAL_EXACT - 1 - out->exponent, &power, &of_power);
        /* 69 to 74 of its bits are the fraction */
        const int shift = LEADING + DBL_MANT_DIG - 1 - binary - of_power - 64;
        const uint64_t high = (uint64_t)(product >> 64), low = (uint64_t)product;

        out->digits = high >> shift;
        out->rest = (high << (64 - shift) | low >> shift) >> (64 - FRACTION_BITS);
        out->reach = power >> (shift - (FRACTION_BITS - DBL_MANT_DIG - 1));
        if (out->digits >= tens[DECIMAL_EXACT])
            out->exponent++;
        else if (out->digits < tens[DECIMAL_EXACT - 1])
            out->exponent--;
        else
            return true;
    }
    return false;
}

typedef enum Known { NO, YES, UNKNOWN } Known;

/* The digits in whole units, and what is over. */
typedef struct Rounded {
    uint64_t whole, over, unit;
} Rounded;

/* Whether the multiple of the unit next to the number is nearer than half way to the next doubles.
 */
static Known reads_back(const Decimal *d, const Rounded *r)
{
    const uint64_t above = r->over << FRACTION_BITS | d->rest,
                   below = (r->unit << FRACTION_BITS) - above;
    const uint64_t distance = above < below ? above : below;
    const uint64_t least = d->is_edge ? d->reach / 2 : d->reach;

    if (distance + NOISE < least)
        return YES;
    return distance > d->reach + NOISE ? NO : UNKNOWN;
}

/* to the nearest; false: not known, or it has one more than 17 digits */
static bool round_off(const Decimal *d, Rounded *r)
{
    const uint64_t one = (uint64_t)1 << FRACTION_BITS, half = r->unit / 2;

    if (r->unit == 1) {
        r->whole += d->rest > one / 2;
        return (d->rest > one / 2 + NOISE || d->rest + NOISE < one / 2) &&
               r->whole < tens[DECIMAL_EXACT];
    }
    r->whole += r->over >= half;
    return !(r->over == half && d->rest <= NOISE) &&
           !(r->over + 1 == half && d->rest + NOISE >= one);
}

/* Sixteen digits if the value reads back from them or no more are requested, else all. Without a
 * branch, because both cases are equally likely. */
static int sixteen_or_all(const Decimal *d, int most, uint64_t hundreds, uint64_t over,
                          Rounded *out)
{
    Rounded sixteen = {10 * hundreds + over / 10, over % 10, 10}, all = {d->digits, 0, 1};
    const Known known = reads_back(d, &sixteen);
    const bool short_is_known = round_off(d, &sixteen), all_is_known = round_off(d, &all);
    const bool is_short = known == YES || most == ALWAYS + 1;

    *out = is_short ? sixteen : all;
    if ((known == UNKNOWN && most > ALWAYS + 1) || !(is_short ? short_is_known : all_is_known))
        return 0;
    return is_short ? ALWAYS + 1 : DECIMAL_EXACT;
}

/* The fewest digits, up to `most`, from which the value reads back, or `most`; 0: not known. */
static int find_fewest(const Decimal *d, int most, Rounded *out)
{
    Known known = YES;

    if (most < ALWAYS) {
        const uint64_t unit = tens[DECIMAL_EXACT - most];

        *out = (Rounded){d->digits / unit, d->digits % unit, unit};
        return round_off(d, out) ? most : 0;
    }
    *out = (Rounded){d->digits / 100, d->digits % 100, 100};
    if (most > ALWAYS)
        known = reads_back(d, out);
    if (known == NO)
        return sixteen_or_all(d, most, out->whole, out->over, out);
    return known == YES && round_off(d, out) ? ALWAYS : 0;
}

/* --- written --- */

/* Eight digits, all at once: halves, then quarters, then single ones, each in a byte of its own,
 * the first in the lowest. */
static inline uint64_t eight_digits(uint32_t number)
{
    const uint64_t fours = (number % 10000) * ((uint64_t)1 << 32) + number / 10000;
    const uint64_t hundreds = (fours * 10486 >> 20) & 0x0000007F0000007FU; /* by 100 */
    const uint64_t twos = (fours - 100 * hundreds) << 16 | hundreds;
    const uint64_t over_ten = (twos * 103 >> 10) & 0x000F000F000F000FU; /* by 10 */

    return (twos - 10 * over_ten) << 8 | over_ten;
}

/* Digits as characters, in an integer until they are stored once, at their place: reading as a
 * whole what has just been stored in parts is slow. */
typedef struct Spelled {
    DecimalWide digits; /* sixteen, the first lowest */
    char before;        /* one more, before these */
    int zeros;          /* that end all seventeen */
} Spelled;

/* zeros before a number that has less than 17 */
static Spelled spell(uint64_t number)
{
    const DecimalWide noughts =
        (DecimalWide)0x3030303030303030U << 64 | 0x3030303030303030U; /* '0' each */
    const uint32_t most = 100000000;
    const uint64_t high = number / most;
    const uint64_t last = eight_digits((uint32_t)(number % most));
    const uint64_t middle = eight_digits((uint32_t)(high % most));

    return (Spelled){.digits = ((DecimalWide)last << 64 | middle) + noughts,
                     .before = (char)('0' + high / most),
                     .zeros = last != 0     ? __builtin_clzll(last) / 8
                              : middle != 0 ? 8 + __builtin_clzll(middle) / 8
                                            : 16};
}

/* sixteen characters */
static void put(char *text, DecimalWide digits)
{
    uint64_t halves[2] = {(uint64_t)digits, (uint64_t)(digits >> 64)};

#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    halves[0] = __builtin_bswap64(halves[0]);
    halves[1] = __builtin_bswap64(halves[1]);
#endif
    memcpy(text, halves, sizeof halves);
}

static char *write_exponent(char *text, int exponent)
{
    const int size = abs(exponent);

    *text++ = 'e';
    *text++ = exponent < 0 ? '-' : '+';
    if (size >= 100)
        *text++ = (char)('0' + size / 100);
    *text++ = (char)('0' + size / 10 % 10);
    *text++ = (char)('0' + size % 10);
    return text;
}

/* Format the last n of the converted digits as %g does. `length` of them remain without trailing
 * zeros, and the first one counts 10^exponent. Returns the end of the text; no terminator is
 * written. */
static char *lay_out(char *text, const Spelled *s, int n, int length, int exponent)
{
    const bool is_plain = exponent >= PLAIN && exponent < n;
    const int point = is_plain ? exponent + 1 : 1;
    const DecimalWide first = n == DECIMAL_EXACT ? s->digits << 8 | (unsigned char)s->before
                                                 : s->digits >> 8 * (DECIMAL_EXACT - 1 - n);

    if (point <= 0) {
        memcpy(text, "0.0000", sizeof "0.0000");
        text += 2 - point;
        put(text, first);
        text[DECIMAL_EXACT - 1] = (char)(s->digits >> 120); /* if there are so many */
        return text + length;
    }
    put(text, first);
    text[DECIMAL_EXACT - 1] = (char)(s->digits >> 120);
    if (length <= point) {
        text += point;
    } else {
        text[point] = '.';
        put(text + point + 1, s->digits >> 8 * (DECIMAL_EXACT - 1 - n + point));
        text += length + 1;
    }
    return is_plain ? text : write_exponent(text, exponent);
}

/* false: not known */
static bool print_normal(char *text, double value, int most, size_t *length)
{
    Decimal decimal;
    Rounded rounded;
    Spelled spelled;
    char *end = text;
    int n;

    if (!take_apart(fabs(value), &decimal) || (n = find_fewest(&decimal, most, &rounded)) == 0)
        return false;
    if (rounded.whole == tens[n]) { /* rounded up to one more */
        rounded.whole /= 10;
        decimal.exponent++;
    }
    spelled = spell(rounded.whole);
    *end = '-';
    end = lay_out(end + (value < 0), &spelled, n, n - spelled.zeros, decimal.exponent);
    *end = '\0';
    *length = (size_t)(end - text);
    return true;
}

#else

static bool print_normal(char *text, double value, int most, size_t *length)
{
    (void)text, (void)value, (void)most, (void)length;
    return false;
}

#endif

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
    size_t length;

    most = most < DECIMAL_EXACT ? most : DECIMAL_EXACT;
    if (value == 0 && !signbit(value)) {
        memcpy(text, "0", 2);
        return 1;
    }
    if (most > 0 && isnormal(value) && print_normal(text, value, most, &length))
        return length;
    return try_digits(text, value, most);
}

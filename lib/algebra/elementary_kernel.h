/* elementary_kernel.h: WIDTH numbers at once; included for each width, with a TARGET that has it
 *
 * Polynomials are Chebyshev fits over their range, found with 400 bits; their errors, relative to
 * the result, are below 2^-56. What a reduction rounds away is carried along in a second number. */

#define NAMED_(name, width) name##_##width
#define NAMED(name, width)  NAMED_(name, width)
#define V                   NAMED(Doubles, WIDTH)
#define U                   NAMED(Bits, WIDTH)
#define ALL(number)         ((V){0} + (number))
#define KERNEL(type, name)                                                                         \
    TARGET static inline __attribute__((always_inline)) type NAMED(name, WIDTH)

typedef double V __attribute__((vector_size(WIDTH * sizeof(double))));
typedef uint64_t U __attribute__((vector_size(WIDTH * sizeof(uint64_t))));

KERNEL(V, choose)(U mask, V yes, V no)
{
    return (V)(((U)yes & mask) | ((U)no & ~mask));
}

/* what a + b rounds away (Knuth 1997, 4.2.2) */
KERNEL(V, rest)(V a, V b, V sum)
{
    const V other = sum - a;

    return (a - (sum - other)) + (b - other);
}

/* high + low after `quarters` of a turn, less than an eighth of a turn in size */
KERNEL(void, quarter)(U quarters, V high, V low, V *sine, V *cosine)
{
    const V z = high * high, half = z * 0.5, most = 1 - half;
    const V odd = S3 + z * (S5 + z * (S7 + z * (S9 + z * (S11 + z * S13))));
    const V even = C4 + z * (C6 + z * (C8 + z * (C10 + z * (C12 + z * C14))));
    const V s = high + (low * most + high * z * odd);
    const V c = most + (((1 - most) - half) + (z * z * even - high * low));
    const U swaps = 0 - (quarters & 1);

    *sine = (V)((U)NAMED(choose, WIDTH)(swaps, c, s) ^ (quarters & 2) << 62);
    *cosine = (V)((U)NAMED(choose, WIDTH)(swaps, s, c) ^ ((quarters + 1) & 2) << 62);
}

/* |x| up to NEAR */
KERNEL(void, sincos)(V x, V *sine, V *cosine)
{
    const V count = x * QUARTERS + TO_WHOLE, n = count - TO_WHOLE;
    const V a = x - n * QUARTER_1;
    const V second = n * QUARTER_2, b = a - second;
    const V third = n * QUARTER_3, c = b - third;
    const V tail =
        (NAMED(rest, WIDTH)(a, -second, b) + NAMED(rest, WIDTH)(b, -third, c)) - n * QUARTER_4;
    const V high = c + tail;
    V s;

    NAMED(quarter, WIDTH)((U)count, high, (c - high) + tail, &s, cosine);
    /* what is tiny is its own sine, its sign too where it is 0 */
    *sine = NAMED(choose, WIDTH)((U)(x < TINY) & (U)(x > -TINY), x, s);
}

KERNEL(V, exp)(V x)
{
    x = NAMED(choose, WIDTH)((U)(x > EXP_MOST), ALL(EXP_MOST), x);
    x = NAMED(choose, WIDTH)((U)(x < EXP_LEAST), ALL(EXP_LEAST), x);

    const V count = x * LOG2_E + TO_WHOLE, n = count - TO_WHOLE;
    const V high = x - n * LN2_1, away = n * LN2_2, r = high - away;
    const V low = (high - r) - away, z = r * r, z2 = z * z;
    const V p = ((E3 + r * E4) + z * (E5 + r * E6)) +
                z2 * (((E7 + r * E8) + z * (E9 + r * E10)) + z2 * ((E11 + r * E12) + z * E13));
    const V y = 1 + (r + (low + (z * 0.5 + r * z * p)));
    /* 2^n in two factors: either is in range, and only the second rounds. The whole number stands
     * in the low bits of `count`; with 2048 on top its half is rounded down. */
    const U whole = (U)count - TO_WHOLE_BITS + 2048, half = whole >> 1;
    const V first = (V)((half - 1) << 52), second = (V)((whole - half - 1) << 52);

    return y * first * second;
}

KERNEL(V, log)(V x)
{
    const U small = (U)(x < DBL_MIN);
    const V scaled = NAMED(choose, WIDTH)(small, x * 0x1p54, x);
    /* x = 2^k m with m from sqrt(1/2) to sqrt(2); 1024 on top keeps k positive */
    const U k = ((U)scaled - ROOT_HALF + ((uint64_t)1024 << 52)) >> 52;
    const V m = (V)((U)scaled - ((k - 1024) << 52));
    const V n = ((V)(k + TO_WHOLE_BITS) - TO_WHOLE) -
                NAMED(choose, WIDTH)(small, ALL(1024 + 54), ALL(1024));
    const V f = m - 1, s = f / (2 + f), z = s * s, half = 0.5 * f * f;
    const V p = z * (L1 + z * (L2 + z * (L3 + z * (L4 + z * (L5 + z * (L6 + z * L7))))));
    const V y = n * LN2_1 - ((half - (s * (half + p) + n * LN2_2)) - f);
    const V none = NAMED(choose, WIDTH)((U)(x < 0), ALL((double)NAN), x + x);
    const V odd = NAMED(choose, WIDTH)((U)(x == 0), ALL((double)-INFINITY), none);

    return NAMED(choose, WIDTH)((U)(x > 0) & (U)(x < (double)INFINITY), y, odd);
}

/* --- all of an array, but for what is fewer than WIDTH at its end; how many were done --- */

TARGET static int NAMED(sincos_all, WIDTH)(const double *x, double *sine, double *cosine, int count)
{
    int i = 0;

    for (; i + WIDTH <= count; i += WIDTH) {
        V at, s, c;
        U far;
        uint64_t any = 0;

        memcpy(&at, x + i, sizeof at);
        NAMED(sincos, WIDTH)(at, &s, &c);
        memcpy(sine + i, &s, sizeof s);
        memcpy(cosine + i, &c, sizeof c);
        far = ~((U)(at <= NEAR) & (U)(at >= -NEAR));
        for (int k = 0; k < WIDTH; k++)
            any |= far[k];
        for (int k = i; any != 0 && k < i + WIDTH; k++)
            if (!(fabs(x[k]) <= NEAR))
                sincos_far(x[k], &sine[k], &cosine[k]);
    }
    return i;
}

TARGET static int NAMED(exp_all, WIDTH)(const double *x, double *out, int count)
{
    int i = 0;

    for (; i + WIDTH <= count; i += WIDTH) {
        V at;

        memcpy(&at, x + i, sizeof at);
        at = NAMED(exp, WIDTH)(at);
        memcpy(out + i, &at, sizeof at);
    }
    return i;
}

TARGET static int NAMED(log_all, WIDTH)(const double *x, double *out, int count)
{
    int i = 0;

    for (; i + WIDTH <= count; i += WIDTH) {
        V at;

        memcpy(&at, x + i, sizeof at);
        at = NAMED(log, WIDTH)(at);
        memcpy(out + i, &at, sizeof at);
    }
    return i;
}

#undef V
#undef U
#undef WIDTH
#undef TARGET

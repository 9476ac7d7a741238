/* elementary.c: sine, cosine, exponential and logarithm by polynomials
 *
 * Range reduction first, then a polynomial on a small range. Sine and cosine subtract multiples of
 * pi/2: pi/2 is split into parts so short that their multiples are exact (Cody and Waite 1980).
 * Beyond NEAR, only those digits of 2/pi are used that don't contribute whole turns (Payne and
 * Hanek 1983). Exponential and logarithm split off powers of 2. */
#include "algebra/elementary.h"

#include "algebra/double_double.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#if defined __x86_64__ && defined __GNUC__
#include <immintrin.h>
#endif

/* clang-format off */
#define NEAR      0x1.8p20   /* so far multiples of the parts of a quarter are exact */
#define QUARTERS  0x1.45f306dc9c883p-1 /* 2 / pi */
#define QUARTER_1 0x1.921fb54400000p+0 /* pi / 2 in 33 + 33 + 33 + 53 bits */
#define QUARTER_2 0x1.0b4611a600000p-34
#define QUARTER_3 0x1.3198a2e000000p-69
#define QUARTER_4 0x1.b839a252049c1p-104
#define HALF_PI_1 0x1.921fb54442d18p+0 /* in 53 + 53 + 53 bits */
#define HALF_PI_2 0x1.1a62633145c07p-54
#define HALF_PI_3 -0x1.f1976b7ed8fbcp-110
#define LOG2_E    0x1.71547652b82fep+0
#define LN2_1     0x1.62e42fee00000p-1 /* in 32 + 53 bits */
#define LN2_2     0x1.a39ef35793c76p-33
#define EXP_MOST  710.0  /* infinite from there on */
#define EXP_LEAST -746.0 /* 0 up to there */
#define ROOT_HALF UINT64_C(0x3FE6A09E667F3BCD) /* bits of sqrt(1/2) */

/* a sum with it is rounded to an integer, which is in its low bits */
#define TO_WHOLE      0x1.8p52
#define TO_WHOLE_BITS UINT64_C(0x4338000000000000)

/* sin x = x + x^3 (S3 + S5 x^2 ...), and so on */
#define S3  -0x1.5555555555555p-3
#define S5   0x1.1111111110bb2p-7
#define S7  -0x1.a01a019e83816p-13
#define S9   0x1.71de379654304p-19
#define S11 -0x1.ae600aca92c63p-26
#define S13  0x1.5e0b05bff20a2p-33
#define C4   0x1.5555555555555p-5
#define C6  -0x1.6c16c16c16967p-10
#define C8   0x1.a01a019f4e9b4p-16
#define C10 -0x1.27e4fa17bf137p-22
#define C12  0x1.1eeb68cd22d36p-29
#define C14 -0x1.907d8f29ea76ep-37
#define E3   0x1.5555555555555p-3
#define E4   0x1.5555555555556p-5
#define E5   0x1.1111111111111p-7
#define E6   0x1.6c16c16c162d4p-10
#define E7   0x1.a01a01a019b2ap-13
#define E8   0x1.a01a01a6d889cp-16
#define E9   0x1.71de3a590520ap-19
#define E10  0x1.27e4db646b17ep-22
#define E11  0x1.ae643449fe524p-26
#define E12  0x1.1f730349868cep-29
#define E13  0x1.61b2b7617544bp-33
/* log((1 + s) / (1 - s)) = 2 s + s^3 (L1 + L2 s^2 ...) */
#define L1   0x1.5555555555558p-1
#define L2   0x1.99999999951f5p-2
#define L3   0x1.2492492e0b70cp-2
#define L4   0x1.c71c62c42db88p-3
#define L5   0x1.7462be245eb18p-3
#define L6   0x1.39fd25d62a58ep-3
#define L7   0x1.2b6776a1c2af9p-3

/* 2 / pi, the fraction's bits */
static const uint32_t two_over_pi[] = {
    0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB, 0xDEBBC561,
    0xB7246E3A, 0x424DD2E0, 0x06492EEA, 0x09D1921C, 0xFE1DEB1C, 0xB129A73E, 0xE88235F5, 0x2EBB4484,
    0xE99C7026, 0xB45F7E41, 0x3991D639, 0x835339F4, 0x9C845F8B, 0xBDF9283B, 0x1FF897FF, 0xDE05980F,
    0xEF2F118B, 0x5A0A6D1F, 0x6D367ECF, 0x27CB09B7, 0x4F463F66, 0x9E5FEA2D, 0x7527BAC7, 0xEBE5F17B,
    0x3D0739F7, 0x8A5292EA, 0x6BFB5FB1, 0x1F8D5D08, 0x56033046, 0xFC7B6BAB, 0xF0CFBC20};
/* clang-format on */

static void sincos_far(double x, double *sine, double *cosine);

/* a number that the compiler can't fuse or reorder with its neighbours */
#if defined __x86_64__ && defined __GNUC__
#define APART(number) __asm__("" : "+x"(number))
#else
#define APART(number) (void)(number)
#endif

#define WIDTH 2
#define TAG   2
#define TARGET
#include "algebra/elementary_kernel.def"

/* wider ones where the processor that runs has them; numbers are the same */
#if defined __x86_64__ && defined __GNUC__
#define WIDTH  4
#define TAG    4
#define TARGET __attribute__((target("avx2")))
#include "algebra/elementary_kernel.def"
#define WIDTH  8
#define TAG    8
#define TARGET __attribute__((target("avx512f,avx512dq")))
#include "algebra/elementary_kernel.def"
/* and with fused operations */
#define WIDTH                2
#define TAG                  fused_2
#define TARGET               __attribute__((target("avx2,fma")))
#define FUSED(name, a, b, c) _mm_##name##_pd((__m128d)(a), (__m128d)(b), (__m128d)(c))
#include "algebra/elementary_kernel.def"
#define WIDTH                4
#define TAG                  fused_4
#define TARGET               __attribute__((target("avx2,fma")))
#define FUSED(name, a, b, c) _mm256_##name##_pd((__m256d)(a), (__m256d)(b), (__m256d)(c))
#include "algebra/elementary_kernel.def"
#define WIDTH                8
#define TAG                  fused_8
#define TARGET               __attribute__((target("avx512f,avx512dq,fma")))
#define FUSED(name, a, b, c) _mm512_##name##_pd((__m512d)(a), (__m512d)(b), (__m512d)(c))
#include "algebra/elementary_kernel.def"
#define IN_WIDE(done, count, name, ...)                                                            \
    do {                                                                                           \
        if ((count) >= 8 && __builtin_cpu_supports("avx512f") &&                                   \
            __builtin_cpu_supports("avx512dq"))                                                    \
            (done) = name##_all_8(__VA_ARGS__);                                                    \
        else if ((count) >= 4 && __builtin_cpu_supports("avx2"))                                   \
            (done) = name##_all_4(__VA_ARGS__);                                                    \
    } while (0)
#else
#define IN_WIDE(done, count, name, ...) (void)0
#endif

/* --- angles of very many turns --- */

enum { DIGITS = 7 }; /* 224 bits of 2 / pi are enough for any double */

/* |x| * 2 / pi: whole quarters of a turn (mod 4), and the remainder, half a quarter at most */
static unsigned far_quarters(double x, DoubleDouble *left)
{
    int exponent;
    const uint64_t m = (uint64_t)ldexp(frexp(fabs(x), &exponent), 53);
    const int e = exponent - 53, first = e > 2 ? (e - 2) / 32 : 0;
    const int point = 32 * (first + DIGITS) - e; /* bits of the fraction */
    uint32_t product[DIGITS + 2] = {0};          /* lowest first */
    uint64_t carry = 0;
    unsigned quarters;
    bool up;

    /* m times the digits, which are 2^32 wide */
    for (int half = 0; half < 2; half++, carry = 0) {
        const uint64_t factor = half == 0 ? m & UINT32_MAX : m >> 32;

        for (int i = 0; i < DIGITS; i++) {
            carry += factor * two_over_pi[first + DIGITS - 1 - i] + product[i + half];
            product[i + half] = (uint32_t)carry;
            carry >>= 32;
        }
        product[DIGITS + half] += (uint32_t)carry;
    }
#define BIT(i) (product[(i) / 32] >> (i) % 32 & 1U)
    quarters = BIT(point) | BIT(point + 1) << 1;
    up = BIT(point - 1) != 0; /* the next quarter is nearer */
    *left = dd_of(0);
    for (int i = (point - 1) / 32; i >= 0; i--) {
        uint32_t digit = product[i];

        if (i == point / 32)
            digit &= (1U << point % 32) - 1;
        *left = dd_add(*left, dd_of(ldexp(digit, 32 * i - point)));
        if (i == (point - 1) / 32 && up)
            *left = dd_sub(*left, dd_of(1));
    }
    *left = dd_mul(*left, (DoubleDouble){0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54});
    return quarters + up;
}

static void sincos_far(double x, double *sine, double *cosine)
{
    DoubleDouble left;
    Doubles_2 s, c;
    unsigned quarters;

    if (!isfinite(x)) {
        *sine = *cosine = x - x;
        return;
    }
    quarters = far_quarters(x, &left);
    quarter_2((Bits_2){quarters}, (Doubles_2){left.high}, (Doubles_2){left.low}, &s, &c);
    *sine = x < 0 ? -s[0] : s[0];
    *cosine = c[0];
}

/* --- one, and many --- */

static void sincos_one(double x, double *sine, double *cosine)
{
    Doubles_2 s, c;

    if (!(fabs(x) <= NEAR)) {
        sincos_far(x, sine, cosine);
        return;
    }
    sincos_2((Doubles_2){x, 0}, &s, &c);
    *sine = s[0];
    *cosine = c[0];
}

double elementary_sin(double x)
{
    double sine, cosine;

    sincos_one(x, &sine, &cosine);
    return sine;
}

double elementary_cos(double x)
{
    double sine, cosine;

    sincos_one(x, &sine, &cosine);
    return cosine;
}

double elementary_exp(double x)
{
    return exp_2((Doubles_2){x, 0})[0];
}

double elementary_log(double x)
{
    return log_2((Doubles_2){x, 1})[0];
}

void elementary_sincos_all(const double *x, double *sine, double *cosine, int count)
{
    int done = 0;

#if defined __x86_64__ && defined __GNUC__
    if (count == 3 && __builtin_cpu_supports("avx2")) {
        sincos_three_4(x, sine, cosine);
        return;
    }
#endif
    IN_WIDE(done, count, sincos, x, sine, cosine, count);
    done += sincos_all_2(x + done, sine + done, cosine + done, count - done);
    if (done < count)
        sincos_one(x[done], &sine[done], &cosine[done]);
}

#if defined __x86_64__ && defined __GNUC__

bool elementary_has_fused(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

/* the last, alone */
__attribute__((target("avx2,fma"))) static void sincos_fused_one(double x, double *sine,
                                                                 double *cosine)
{
    Doubles_fused_2 s, c;

    if (!(fabs(x) <= NEAR)) {
        sincos_far(x, sine, cosine);
        return;
    }
    sincos_fused_2((Doubles_fused_2){x, 0}, &s, &c);
    *sine = s[0];
    *cosine = c[0];
}

void elementary_sincos_fused_all(const double *x, double *sine, double *cosine, int count)
{
    int done = 0;

    if (!elementary_has_fused()) {
        elementary_sincos_all(x, sine, cosine, count);
        return;
    }
    if (count == 3) {
        sincos_three_fused_4(x, sine, cosine);
        return;
    }
    if (count >= 8 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        done = sincos_all_fused_8(x, sine, cosine, count);
    else if (count >= 4)
        done = sincos_all_fused_4(x, sine, cosine, count);
    done += sincos_all_fused_2(x + done, sine + done, cosine + done, count - done);
    if (done < count)
        sincos_fused_one(x[done], &sine[done], &cosine[done]);
}

#else

bool elementary_has_fused(void)
{
    return false;
}

void elementary_sincos_fused_all(const double *x, double *sine, double *cosine, int count)
{
    elementary_sincos_all(x, sine, cosine, count);
}

#endif

void elementary_exp_all(const double *x, double *out, int count)
{
    int done = 0;

    IN_WIDE(done, count, exp, x, out, count);
    done += exp_all_2(x + done, out + done, count - done);
    if (done < count)
        out[done] = elementary_exp(x[done]);
}

void elementary_log_all(const double *x, double *out, int count)
{
    int done = 0;

    IN_WIDE(done, count, log, x, out, count);
    done += log_all_2(x + done, out + done, count - done);
    if (done < count)
        out[done] = elementary_log(x[done]);
}

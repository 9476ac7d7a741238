/* test_base.c: pools, names, text */
#include "../random.h"
#include "base/decimal.h"
#include "base/memory.h"
#include "base/names.h"
#include "base/text.h"
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void pool_release_gives_back_to_the_mark(void)
{
    Pool *pool = pool_new(256);
    PoolMark mark;
    char *kept = pool_text(pool, "kept", 4);

    mark = pool_mark(pool);
    for (int i = 0; i < 100; i++)
        memset(pool_alloc(pool, 100), 7, 100);
    pool_release(pool, mark);
    EXPECT_TEXT(kept, "kept");
    EXPECT(pool_bytes(pool) < 512);
    pool_free(pool);
}

static void names_keep_their_numbers(void)
{
    Names *names = names_new();
    char name[16];

    for (int i = 0; i < 1000; i++) {
        snprintf(name, sizeof name, "n%d", i);
        EXPECT(names_add(names, name) == i);
    }
    EXPECT(names_add(names, "n7") == 7);
    EXPECT(names_find(names, "m7") == -1);
    EXPECT_TEXT(names_get(names, 999), "n999");
    EXPECT(names_count(names) == 1000);
    names_free(names);
}

static void distance_counts_slips(void)
{
    EXPECT(text_distance("plot", "plto", 3) == 1);
    EXPECT(text_distance("plot", "plot", 3) == 0);
    EXPECT(text_distance("kitten", "sitting", 3) == 3);
    EXPECT(text_distance("M1", "m1", 3) == 1);
}

static void suggest_takes_the_nearest(void)
{
    Suggest suggest = suggest_for("plto");

    suggest_offer(&suggest, "pilot");
    suggest_offer(&suggest, "plot");
    suggest_offer(&suggest, "print");
    EXPECT_TEXT(suggest.best, "plot");
    suggest = suggest_for("xyzzy");
    suggest_offer(&suggest, "plot");
    EXPECT(suggest.best == NULL);
}

static void numbers_print_with_the_fewest_digits_that_read_back(void)
{
    Text text = {0};

    text_number(&text, 0.1, 17);
    text_char(&text, ' ');
    text_number(&text, 1.0 / 3.0, 17);
    EXPECT_TEXT(text.at, "0.1 0.3333333333333333");
    text_free(&text);
}

/* as the C library prints and reads: a number of `most` digits, fewer from 15 on if they read back
 */
static bool is_as_tried(double value, int most)
{
    char tried[DECIMAL_SIZE], got[DECIMAL_SIZE];
    size_t length;

    for (int n = most < 15 ? most : 15; n <= most; n++) {
        (void)snprintf(tried, sizeof tried, "%.*g", n, value);
        if (n >= 15 && strtod(tried, NULL) == value)
            break;
    }
    length = decimal_print(got, value, most);
    if (length == strlen(got) && strcmp(got, tried) == 0)
        return true;
    printf("# %a in %d digits: %s, not %s\n", value, most, got, tried);
    return false;
}

static double read_decimal(uint64_t digits, const char *behind, int exponent)
{
    char text[DECIMAL_SIZE];

    (void)snprintf(text, sizeof text, "%llu%se%d", (unsigned long long)digits, behind, exponent);
    return strtod(text, NULL);
}

/* any bits, whole numbers, parts of two, short decimals and what is next to them, ties, products as
 * times of rows are */
static double any_decimal(uint64_t *random, int which)
{
    const uint64_t bits = test_random(random);
    const int exponent = (int)(test_random(random) % 600) - 310;
    double value;

    switch (which % 8) {
    case 0:
        memcpy(&value, &bits, sizeof value);
        return value;
    case 1:
        return (double)(int64_t)(bits >> bits % 64);
    case 2:
        return ldexp((double)(bits >> 44), -(int)(bits % 60));
    case 3:
        return read_decimal(bits % 1000000000000000U, "", exponent);
    case 4:
        return nextafter(read_decimal(bits % 1000000000000000U, "", exponent), INFINITY);
    case 5:
        return read_decimal(bits >> bits % 60 >> 4, "5", exponent % 30);
    case 6:
        return (double)(bits % 100000) * 0.01;
    default:
        return copysign(test_decades(random, 1e-30, 1e30), (double)(int64_t)bits);
    }
}

static void decimals_are_those_that_trying_finds(void)
{
    static const double ends[] = {0,      -0.0, INFINITY, -INFINITY, NAN,
                                  5e-324, 1e23, DBL_MIN,  DBL_MAX,   9007199254740993.0};
    uint64_t random = 5;
    bool is_right = true;

    for (int i = 0; i < 200000 && is_right; i++)
        is_right = is_as_tried(any_decimal(&random, i), i / 8 % 3 == 0 ? 1 + i / 8 % 17 : 17);
    EXPECT(is_right);
    for (int e = DBL_MIN_EXP - DBL_MANT_DIG; e < DBL_MAX_EXP && is_right; e++)
        for (int side = -1; side <= 1 && is_right; side++) { /* powers of two and their next */
            const double power = ldexp(1, e);
            const double value = side == 0 ? power : nextafter(power, side < 0 ? 0 : INFINITY);

            is_right = is_as_tried(value, 17) && is_as_tried(-value, 16);
        }
    EXPECT(is_right);
    for (int e = -324; e <= 308 && is_right; e++) /* and of ten */
        for (int side = -1; side <= 1 && is_right; side++) {
            const double power = read_decimal(1, "", e);
            const double value = side == 0 ? power : nextafter(power, side < 0 ? 0 : INFINITY);

            for (int most = 1; most <= 17 && is_right; most++)
                is_right = is_as_tried(value, most);
        }
    EXPECT(is_right);
    for (int i = 0; i < 10 * 17 && is_right; i++)
        is_right = is_as_tried(ends[i / 17], 1 + i % 17);
    EXPECT(is_right);
}

int main(void)
{
    RUN(pool_release_gives_back_to_the_mark);
    RUN(names_keep_their_numbers);
    RUN(distance_counts_slips);
    RUN(suggest_takes_the_nearest);
    RUN(decimals_are_those_that_trying_finds);
    RUN(numbers_print_with_the_fewest_digits_that_read_back);
    return test_end();
}

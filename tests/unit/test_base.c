/* test_base.c: pools, names, text */
#include "../random.h"
#include "base/decimal.h"
#include "base/memory.h"
#include "base/names.h"
#include "base/text.h"
#include "test.h"

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

/* as trying tells: every exponent, powers of two, short decimals, the smallest numbers */
static void decimals_are_those_that_trying_finds(void)
{
    uint64_t random = 5;

    for (int i = 0; i < 100000; i++) {
        const uint64_t bits = test_random(&random);
        size_t length;
        char tried[DECIMAL_SIZE], got[DECIMAL_SIZE];
        double value;
        int most = 13 + i % 5;

        memcpy(&value, &bits, sizeof value);
        if (i % 4 == 1)
            value = ldexp(1, i % 2140 - 1074);
        else if (i % 4 == 2)
            value = (double)(bits >> 50) * pow(10, (double)(i % 40) - 25);
        else if (i % 4 == 3)
            value = copysign(test_decades(&random, 1e-30, 1e30), value);
        for (int n = most < 15 ? most : 15; n <= most; n++) {
            (void)snprintf(tried, sizeof tried, "%.*g", n, value);
            if (strtod(tried, NULL) == value)
                break;
        }
        length = decimal_print(got, value, most);
        EXPECT(length == strlen(got));
        EXPECT_TEXT(got, tried);
    }
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

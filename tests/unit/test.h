/* test.h: the little that unit tests share
 *
 * A test program is a list of functions named for the claim they make, and ends with
 * `return test_end();`, which prints "N passed, N failed, N skipped". */
#ifndef COTREE_TESTS_TEST_H
#define COTREE_TESTS_TEST_H

#include "../random.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((unused)) static int test_passed, test_failed, test_skipped, test_faults;

/* run one claim */
#define RUN(claim)                                                                                 \
    do {                                                                                           \
        test_faults = 0;                                                                           \
        claim();                                                                                   \
        if (test_faults == 0)                                                                      \
            test_passed++;                                                                         \
        else {                                                                                     \
            test_failed++;                                                                         \
            printf("FAILED %s\n", #claim);                                                         \
        }                                                                                          \
    } while (0)

#define SKIP(claim, reason) (test_skipped++, (void)printf("skipped %s: %s\n", claim, reason))

#define EXPECT(condition)                                                                          \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            test_faults++;                                                                         \
            printf("%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                         \
        }                                                                                          \
    } while (0)

#define EXPECT_TEXT(got, wanted)                                                                   \
    do {                                                                                           \
        const char *got_ = (got);                                                                  \
        const char *wanted_ = (wanted);                                                            \
        if (got_ == NULL || strcmp(got_, wanted_) != 0) {                                          \
            test_faults++;                                                                         \
            printf("%s:%d: got    %s\n    wanted %s\n", __FILE__, __LINE__, got_ ? got_ : "NULL",  \
                   wanted_);                                                                       \
        }                                                                                          \
    } while (0)

#define EXPECT_NEAR(got, wanted, tolerance)                                                        \
    do {                                                                                           \
        double got_ = (got);                                                                       \
        double wanted_ = (wanted);                                                                 \
        if (!(fabs(got_ - wanted_) <= (tolerance))) {                                              \
            test_faults++;                                                                         \
            printf("%s:%d: got %.17g, wanted %.17g within %.3g\n", __FILE__, __LINE__, got_,       \
                   wanted_, (double)(tolerance));                                                  \
        }                                                                                          \
    } while (0)

__attribute__((unused)) static int test_end(void)
{
    printf("%d passed, %d failed, %d skipped\n", test_passed, test_failed, test_skipped);
    return test_failed > 0 ? 1 : 0;
}

#endif

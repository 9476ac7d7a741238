/* family.h: random members of a family, each held against an answer that cotree has no part in
 *
 * A program lists its families and ends with `return family_main(families, COUNT(families), argc,
 * argv);`. As a test it runs a fixed number of members from a fixed seed and prints "N passed, N
 * failed, N skipped", one claim a family. `make stress` calls it as
 *
 *     NAME --seed N --seconds S      members until time is over, each family its share
 *     NAME --seed N --members M      M members of each family
 *     NAME --seed N --member M       that one again, with its story
 *
 * and with --only WORD only the families whose names hold that word.
 *
 * A member's random numbers follow from seed and member alone. Under the sanitizers a test takes an
 * eighth of the members: there they show how memory is used, numbers are told elsewhere. */
#ifndef COTREE_TESTS_FAMILY_H
#define COTREE_TESTS_FAMILY_H

#include "../random.h"
#include "base/clock.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* what became of a member: REFUSED is an error or a mark where one may be; it is counted */
typedef enum Verdict { AGREES, REFUSED, DISAGREES } Verdict;

typedef struct Member {
    uint64_t random; /* state for test_random() and test_uniform() */
    int number;
    bool told;         /* --member: print what helps */
    double figure;     /* how much of its bound the worst of it took; 0: nothing is measured */
    char story[16384]; /* what was tried and what came out; printed where it disagrees */
    size_t length;
} Member;

typedef struct Family {
    const char *name; /* the claim */
    int members;      /* in make check, but a third of many (family_members()) */
    double refused;   /* largest part of the members that may be refused */
    double wrong;     /* likewise of those that may disagree; 0 but for a stated bound */
    Verdict (*run)(Member *member);
} Family;

/* add to the story */
__attribute__((format(printf, 2, 3), unused)) static void tell(Member *member, const char *format,
                                                               ...)
{
    va_list arguments;
    const size_t room = sizeof member->story - member->length;

    va_start(arguments, format);
    const int more = vsnprintf(member->story + member->length, room, format, arguments);
    va_end(arguments);
    if (more > 0)
        member->length += (size_t)more < room ? (size_t)more : room - 1;
}

/* an error beside its bound, for the figure that the family prints; whether it keeps it */
__attribute__((unused)) static bool keeps(Member *member, const char *what, double error,
                                          double bound)
{
    if (!(error / bound <= member->figure))
        member->figure = error / bound;
    if (!(error <= bound) || member->told)
        tell(member, "%s: %.3g, bound %.3g\n", what, error, bound);
    return error <= bound;
}

/* --- what a member draws --- */

__attribute__((unused)) static double member_between(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

/* alike in every decade */
__attribute__((unused)) static double member_decades(Member *member, double low, double high)
{
    return exp(member_between(member, log(low), log(high)));
}

/* 0 to count - 1 */
__attribute__((unused)) static int member_one_of(Member *member, int count)
{
    return (int)(test_random(&member->random) % (uint64_t)count);
}

/* In make check: a third of many, so that all families end within seconds; `make stress` takes any
 * number. */
static int family_members(const Family *family)
{
    enum { MANY = 12 };
    const int members = family->members > MANY ? (family->members + 2) / 3 : family->members;

#ifdef __SANITIZE_ADDRESS__
    return (members + 7) / 8;
#else
    return members;
#endif
}

static Verdict family_member(const Family *family, uint64_t seed, int number, Member *member)
{
    const bool told = member->told;

    memset(member, 0, offsetof(Member, story));
    member->told = told;
    member->number = number;
    member->story[0] = '\0';
    member->length = 0;
    member->random = seed * 0x9E3779B97F4A7C15U + (uint64_t)number;
    (void)test_random(&member->random);
    return family->run(member);
}

/* whether the family keeps its claim: over so many members, or for so many seconds */
static bool family_run(const Family *family, uint64_t seed, int members, double seconds)
{
    static Member member;
    const double end = clock_now() + seconds;
    int count[3] = {0}, number = 0;
    double worst = 0;

    for (; seconds > 0 ? clock_now() < end : number < members; number++) {
        const Verdict verdict = family_member(family, seed, number, &member);

        count[verdict]++;
        worst = verdict != REFUSED && !(member.figure <= worst) ? member.figure : worst;
        if (verdict == DISAGREES && count[DISAGREES] <= 3)
            printf("%s: seed %llu, member %d\n%s\n", family->name, (unsigned long long)seed, number,
                   member.story);
    }
    printf("%s: %d agree, %d refused, %d disagree", family->name, count[AGREES], count[REFUSED],
           count[DISAGREES]);
    if (worst > 0)
        printf("; the worst took %.2g of its bound", worst);
    printf("\n");
    /* of few members one may be among those */
    return count[DISAGREES] <= family->wrong * number &&
           count[REFUSED] < family->refused * number + 1 &&
           (family->refused > 0 || count[REFUSED] == 0);
}

/* whether the family is among those asked for */
static bool family_is_meant(const Family *family, const char *only)
{
    return only == NULL || strstr(family->name, only) != NULL;
}

__attribute__((unused)) static int family_main(const Family *families, int count, int argc,
                                               char **argv)
{
    unsigned long long seed = 1;
    const char *only = NULL;
    double seconds = 0;
    int member = -1, members = 0, failed = 0, meant = 0;

    setvbuf(stdout, NULL, _IOLBF, 0);
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "--seed") == 0)
            seed = strtoull(argv[i + 1], NULL, 10);
        else if (strcmp(argv[i], "--seconds") == 0)
            seconds = strtod(argv[i + 1], NULL);
        else if (strcmp(argv[i], "--members") == 0)
            members = atoi(argv[i + 1]);
        else if (strcmp(argv[i], "--member") == 0)
            member = atoi(argv[i + 1]);
        else if (strcmp(argv[i], "--only") == 0)
            only = argv[i + 1];
    }
    for (int i = 0; i < count; i++)
        meant += family_is_meant(&families[i], only);
    for (int i = 0; i < count; i++) {
        if (!family_is_meant(&families[i], only))
            continue;
        if (member >= 0) {
            static Member one;
            static const char *const verdicts[] = {"agrees", "refused", "disagrees"};
            Verdict verdict;

            one.told = true;
            verdict = family_member(&families[i], seed, member, &one);
            printf("%s: member %d %s\n%s\n", families[i].name, member, verdicts[verdict],
                   one.story);
        } else if (!family_run(&families[i], seed,
                               members > 0 ? members : family_members(&families[i]),
                               seconds / meant)) {
            printf("FAILED %s\n", families[i].name);
            failed++;
        }
    }
    if (member < 0)
        printf("%d passed, %d failed, 0 skipped\n", meant - failed, failed);
    return failed > 0 ? 1 : 0;
}

#endif

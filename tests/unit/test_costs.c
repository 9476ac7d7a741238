/* test_costs.c: twice the size costs about four times as much at most, counted in memory asked for
 *
 * What is made is asked for: work that grows faster than that shows in it. The C library's own
 * functions are reached by the names that it has for them. */
#include "cotree.h"
#include "test.h"

#include "base/text.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* builds that look for trouble ask for more */
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(COTREE_SMALL) &&              \
    !defined(COTREE_FAULTS)
#define COUNTS 1
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

static double asked; /* bytes, and some for each call */

void *malloc(size_t size)
{
    asked += (double)size + 16;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    asked += (double)count * (double)size + 16;
    return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    asked += (double)size + 16;
    return __libc_realloc(old, size);
}
#else
#define COUNTS 0
static double asked;
#endif

/* run a text made of `n` pieces in a session of its own; what it asked for */
static double cost_of(void (*write)(Text *text, int n), int n)
{
    Text text = {0};
    ct_session *session = ct_session_new(NULL);
    double before;
    write(&text, n);

    ct_cursor cursor = {.text = text.at, .line = 1};

    before = asked;
    while (text.at[cursor.next] != '\0') {
        ct_statement *statement = NULL;
        ct_error error = {0};
        ct_status status;

        if (ct_parse(&cursor, false, &statement, &error) != CT_OK)
            break;
        if (strcmp(ct_verb(statement), "undo") == 0)
            status = ct_undo(session, &error);
        else if (strcmp(ct_verb(statement), "redo") == 0)
            status = ct_redo(session, &error);
        else
            status = ct_apply(session, statement, &error);
        if (status == CT_NOT_MINE)
            status = ct_run(session, statement, &error);
        EXPECT(status == CT_OK);
        if (status != CT_OK)
            printf("%s: %s\n", ct_statement_text(statement), error.message);
        ct_statement_free(statement);
    }
    ct_session_free(session);
    text_free(&text);
    return asked - before;
}

/* `power`: that of n which the cost may follow */
static void expect_growth(void (*write)(Text *text, int n), int n, double power)
{
    const double once = cost_of(write, n), twice = cost_of(write, 2 * n);

    if (COUNTS && !(twice < 1.3 * pow(2, power) * once))
        printf("%d: %g, %d: %g\n", n, once, 2 * n, twice);
    EXPECT(!COUNTS || twice < 1.3 * pow(2, power) * once);
}

static void write_many(Text *text, const char *form, int n)
{
    for (int i = 0; i < n; i++)
        text_addf(text, form, i, i, i);
}

static void parameters(Text *text, int n)
{
    write_many(text, "p%d = %d\n", n);
}

static void undone_parameters(Text *text, int n)
{
    parameters(text, n);
    write_many(text, "undo\n", n);
    write_many(text, "redo\n", n);
}

static void undone_changes(Text *text, int n)
{
    text_add(text, "body m mass=1 inertia=[1, 1, 1]\np = 0\n");
    write_many(text, "p = %d; set m.mass = 1 + %d\n", n);
    write_many(text, "undo; undo\n", n);
}

static void undone_starts(Text *text, int n)
{
    write_many(text, "body m%d mass=1 inertia=[1, 1, 1]\ninit m%d.x = %d\n", n);
    write_many(text, "undo; undo\n", n);
}

static void chained_laws(Text *text, int n)
{
    text_add(text, "f0(x) = sin(x)\n");
    for (int i = 1; i < n; i++)
        text_addf(text, "f%d(x) = f%d(x) + f%d(x)^2\n", i, i - 1, i - 1);
}

static void free_bodies(Text *text, int n)
{
    write_many(text, "body m%d mass=1 inertia=[1, 2, 3]\n", n);
    text_add(text, "assemble\n");
}

/* bodies that hang one from the other by hinges about these axes in turn */
static void hang_bodies(Text *text, const char *axes, int n)
{
    text_add(text, "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < n; i++) {
        text_addf(text, "body b%d mass=1 inertia=[1, 2, 3]; arm p%d b%d [0, 0, 1]\n", i, i, i);
        text_addf(text, "arm q%d b%d [0, 0, -1]; ", i, i);
        if (i == 0)
            text_addf(text, "revolute h0 ground p0 axis=%c\n", axes[0]);
        else
            text_addf(text, "revolute h%d q%d p%d axis=%c\n", i, i - 1, i,
                      axes[(size_t)i % strlen(axes)]);
    }
}

static void chain_of_bodies(Text *text, int n)
{
    hang_bodies(text, "x", n);
    text_add(text, "tree absolute\nassemble\n");
}

static void moving_chain(Text *text, int n)
{
    hang_bodies(text, "xy", n);
    text_addf(text, "spring s ground b%d k=1\nsimulate 1e-6 every=1e-6\n", n - 1);
}

static void moving_parallel_chain(Text *text, int n)
{
    hang_bodies(text, "x", n);
    text_add(text, "simulate 1e-6 every=1e-6\n");
}

static void swing_with_rows(Text *text, int n)
{
    text_addf(text,
              "scene planar\nbody b mass=1 inertia=1\nrevolute h ground b\nspring k1 h k=4\n"
              "init h = 0.5\nsimulate 10 every=%g\n",
              10.0 / n);
}

static void swing_with_figures(Text *text, int n)
{
    swing_with_rows(text, n);
    text_add(text, "keep A = max(h), B = mean(h), C = settling(h, 0.1), D = period(h)\n");
}

/* pages at and after `next` that a statement may look at, and none before */
#define AHEAD 2

/* Read a text whose pages can be read only about the place of reading: a statement that costs what
 * stands before it, or what is to come, ends the program. */
static void expect_read_in_passing(const char *piece, int n)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), length = strlen(piece) * (size_t)n;
    const size_t pages = length / page + 1;
    char *const at =
        mmap(NULL, pages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ct_cursor cursor = {.text = at, .line = 1};
    ct_error error = {0};

    EXPECT(at != MAP_FAILED);
    if (at == MAP_FAILED)
        return;
    for (int i = 0; i < n; i++)
        memcpy(at + (size_t)i * strlen(piece), piece, strlen(piece));
    while (cursor.next < length) {
        const size_t first = cursor.next / page, last = first + AHEAD;
        ct_statement *statement = NULL;

        EXPECT(mprotect(at, first * page, PROT_NONE) == 0);
        EXPECT(mprotect(at + first * page, ((last < pages ? last : pages) - first) * page,
                        PROT_READ) == 0);
        if (last < pages)
            EXPECT(mprotect(at + last * page, (pages - last) * page, PROT_NONE) == 0);
        if (ct_parse(&cursor, false, &statement, &error) != CT_OK)
            break;
        ct_statement_free(statement);
    }
    EXPECT(cursor.next == length && error.status == CT_OK);
    (void)munmap(at, pages * page);
}

/* it costs its square where lines before are counted for each statement */
static void a_text_is_read_in_passing(void)
{
    static const char *const pieces[] = {";", "a = 1\n", "a = 1 # \r\n\n", "a = \\\n1;"};

    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        expect_read_in_passing(pieces[i], 10000);
}

static void statements_cost_the_same_however_many_there_are(void)
{
    expect_growth(parameters, 2000, 1);
    expect_growth(chained_laws, 100, 2); /* each is put in place in the next */
}

static void going_back_costs_no_more_than_going_forth(void)
{
    expect_growth(undone_parameters, 1000, 1);
    expect_growth(undone_changes, 500, 1);
    expect_growth(undone_starts, 300, 1);
}

static void equations_cost_the_square_of_the_bodies(void)
{
    expect_growth(free_bodies, 40, 2);
    expect_growth(chain_of_bodies, 15, 2);
}

static void chains_of_joints_cost_as_much_as_they_have(void)
{
    expect_growth(moving_chain, 250, 1);
    expect_growth(moving_parallel_chain, 200, 1);
}

/* where rows are dense they determine what figures of a run need: four of them ask for some arrays
 * of the length of the grid, and not for states between its rows */
static void figures_cost_less_than_their_run(void)
{
    const double run = cost_of(swing_with_rows, 4000);

    EXPECT(!COUNTS || cost_of(swing_with_figures, 4000) - run < 5 * run);
}

int main(void)
{
    RUN(a_text_is_read_in_passing);
    RUN(statements_cost_the_same_however_many_there_are);
    RUN(going_back_costs_no_more_than_going_forth);
    RUN(equations_cost_the_square_of_the_bodies);
    RUN(chains_of_joints_cost_as_much_as_they_have);
    RUN(figures_cost_less_than_their_run);
    return test_end();
}

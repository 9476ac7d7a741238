/* test_triangular.c: groups of rows in their own columns, held against rows in full */
#include "algebra/kkt.h"
#include "algebra/triangular.h"

#include "test.h"

enum { MOST = 40, MOST_COLUMNS = 3 * MOST, MOST_ENTRIES = 12 * MOST };

/* rows, of which those in use, and their entries */
typedef struct Rows {
    int m, columns, count;
    int row[MOST_ENTRIES], column[MOST_ENTRIES], at[MOST_ENTRIES], order[2 * MOST];
    double value[MOST_ENTRIES], values[MOST_ENTRIES];
    Pattern pattern;
} Rows;

static void push(Rows *r, int row, int column, double value)
{
    r->row[r->count] = column;
    r->column[r->count] = row;
    r->value[r->count++] = value;
}

static void close_rows(Rows *r)
{
    r->pattern = pattern_of(r->columns, r->m, r->count, r->row, r->column, r->at);
    memset(r->values, 0, sizeof r->values);
    for (int i = 0; i < r->count; i++)
        r->values[r->at[i]] += r->value[i];
    for (int k = 0; k < r->m; k++)
        r->order[k] = k;
}

/* pins between the bodies of a planar tree, numbered at random, and so many pins that close loops
 */
static void draw_tree(uint64_t *seed, int bodies, int loops, Rows *r)
{
    int name[MOST] = {0};

    *r = (Rows){.columns = 3 * bodies};
    for (int i = 0; i < bodies; i++) {
        const int other = (int)test_uniform(seed, 0, i + 1);

        name[i] = name[other];
        name[other] = i;
    }
    for (int i = 0; i < bodies + loops; i++) {
        const bool is_loop = i >= bodies;
        const int body = is_loop ? (int)test_uniform(seed, 1, bodies) : i;
        const int before = is_loop ? body - 1 : i - 1 - (int)test_uniform(seed, 0, i < 4 ? i : 4);

        for (int axis = 0; axis < 2; axis++, r->m++)
            for (int side = 0; side < 2; side++) {
                const int of = side == 0 ? body : before;

                if (of < 0)
                    continue;
                push(r, r->m, 3 * name[of] + axis, side == 0 ? 1 : -1);
                push(r, r->m, 3 * name[of] + 2, test_uniform(seed, -1, 1));
            }
    }
    close_rows(r);
}

static double entry(const Rows *r, int k, int column)
{
    double sum = 0;

    for (int i = 0; i < r->count; i++)
        if (r->column[i] == k && r->row[i] == column)
            sum += r->value[i];
    return sum;
}

/* whether no row of a group behind has it */
static bool is_own(const Rows *r, const Triangular *form, int group, int column)
{
    for (int i = 0; i < r->count; i++)
        if (r->row[i] == column && triangular_group_of(form, r->column[i]) > group)
            return false;
    return true;
}

/* What is left of row k when the rows before it of its group are taken out, in the columns of the
 * group, and when those of all groups behind are, too, in all; squares over norm[k]. */
static double left_of(const Rows *r, const Triangular *form, int k, bool in_full,
                      const double *square, const double *norm)
{
    static double basis[2 * MOST][MOST_COLUMNS];
    const int group = triangular_group_of(form, k);
    double left = 0;
    int count = 0;

    for (int g = in_full ? triangular_groups(form) - 1 : group; g >= group; g--)
        for (int j = 0; j < r->m; j++) {
            double *x = basis[count], size = 0;

            if (triangular_group_of(form, j) != g || (g == group && j > k))
                continue;
            for (int c = 0; c < r->columns; c++)
                x[c] = in_full || is_own(r, form, group, c) ? entry(r, j, c) / sqrt(square[c]) : 0;
            for (int twice = 0; twice < 2; twice++)
                for (int b = 0; b < count; b++) {
                    double product = 0;

                    for (int c = 0; c < r->columns; c++)
                        product += x[c] * basis[b][c];
                    for (int c = 0; c < r->columns; c++)
                        x[c] -= product * basis[b][c];
                }
            for (int c = 0; c < r->columns; c++)
                size += x[c] * x[c];
            left = size;
            for (int c = 0; c < r->columns; c++)
                x[c] /= size > 0 ? sqrt(size) : 1;
            count++;
        }
    return left / norm[k];
}

static void expect_form(uint64_t *seed, const Rows *r, const Triangular *form)
{
    double square[MOST_COLUMNS], norm[2 * MOST], own[2 * MOST], full[2 * MOST];

    for (int c = 0; c < r->columns; c++)
        square[c] = test_uniform(seed, 0.1, 4);
    for (int k = 0; k < r->m; k++)
        norm[k] = test_uniform(seed, 1, 9);
    for (int g = 0; g < 2 * MOST; g++)
        own[g] = full[g] = INFINITY;
    for (int k = 0; k < r->m; k++) {
        const int g = triangular_group_of(form, k);

        EXPECT(g >= 0 && g < triangular_groups(form));
        if (g < 0 || g >= triangular_groups(form))
            continue;
        own[g] = fmin(own[g], left_of(r, form, k, false, square, norm));
        full[g] = fmin(full[g], left_of(r, form, k, true, square, norm));
    }
    for (int g = 0; g < triangular_groups(form); g++) {
        const double rest = triangular_rest(form, g, r->values, square, norm);

        EXPECT_NEAR(rest, own[g], 1e-9 * (1 + own[g]));
        EXPECT(rest <= full[g] * (1 + 1e-9));
        EXPECT(rest > 0);
    }
}

static void rows_of_a_tree_have_the_form(void)
{
    uint64_t seed = 411;

    for (int i = 0; i < 60 && test_faults == 0; i++) {
        static Rows r;
        Triangular *form;

        draw_tree(&seed, 1 + (int)test_uniform(&seed, 0, i % 3 == 0 ? MOST : 8), 0, &r);
        form = triangular_new(&r.pattern, r.order, r.m);
        EXPECT(form != NULL);
        if (form != NULL)
            expect_form(&seed, &r, form);
        triangular_free(form);
        pattern_free(&r.pattern);
    }
}

/* a tree has a speed left a body: where loops take more of them there is no form */
static void loops_have_it_as_long_as_speeds_are_left(void)
{
    uint64_t seed = 412;
    int found = 0, none = 0;

    for (int i = 0; i < 60 && test_faults == 0; i++) {
        const int bodies = 2 + (int)test_uniform(&seed, 0, 8);
        const int loops = 1 + (int)test_uniform(&seed, 0, bodies);
        static Rows r;
        Triangular *form;

        draw_tree(&seed, bodies, loops, &r);
        form = triangular_new(&r.pattern, r.order, r.m);
        if (form != NULL)
            expect_form(&seed, &r, form);
        EXPECT(form == NULL || r.m <= r.columns);
        found += form != NULL;
        none += form == NULL;
        triangular_free(form);
        pattern_free(&r.pattern);
    }
    EXPECT(none > 0 && found > 0);
}

/* G = [[e, 1], [0, 1]], M = 1: its rows come together as e falls. A group is that of one row, and
 * the one that isn't independent comes first, with all of its pivot; what is missing shows at the
 * other. */
static void elimination_is_sound_by_all_groups_or_not(void)
{
    static const int speed[] = {0, 1, 1}, row[] = {0, 0, 1}, order[] = {0, 1};
    int place[3], mass_place[2];
    Pattern rows = pattern_of(2, 2, 3, speed, row, place);
    Pattern mass = pattern_of(2, 2, 2, order, order, mass_place);
    Kkt *kkt = kkt_new(&mass, &rows, order, 2);
    const double masses[] = {1, 1};

    for (double e = 1; e > 1e-3; e /= 1.1) {
        const double phi_u[] = {e, 1, 1}, p = 1 + e * e;
        const double pivot[] = {p, 1 - 1 / p}, taken[] = {p, 1};

        EXPECT(kkt_factor(kkt, masses, phi_u, order));
        EXPECT(kkt_independence(kkt, phi_u, order) > 0);
        if (kkt_is_sound(kkt, pivot, taken, phi_u, order, NULL, 0, false))
            EXPECT(kkt_independence(kkt, phi_u, order) > 0.1);
        if (e > 0.3)
            EXPECT(kkt_is_sound(kkt, pivot, taken, phi_u, order, NULL, 0, false));
        /* where somebody else knows the rows to be independent, rounding alone counts */
        if (e > 1.1e-2 || e < 0.9e-2)
            EXPECT(kkt_is_sound(kkt, pivot, taken, phi_u, order, NULL, 0, true) == (e > 1e-2));
    }
    kkt_free(kkt);
    pattern_free(&rows);
    pattern_free(&mass);
}

/* two rows that are the same leave nothing; what is no number counts as nothing */
static void dependent_rows_leave_nothing(void)
{
    const double square[] = {1, 1}, norm[] = {2, 2};
    static Rows r;

    for (int what = 0; what < 2; what++) {
        Triangular *form;

        r = (Rows){.columns = 2, .m = 2};
        for (int k = 0; k < 4; k++)
            push(&r, k / 2, k % 2, what == 0 ? 1 + k % 2 : NAN);
        close_rows(&r);
        form = triangular_new(&r.pattern, r.order, r.m);
        EXPECT(form != NULL && triangular_groups(form) == 1);
        if (form != NULL)
            EXPECT_NEAR(triangular_rest(form, 0, r.values, square, norm), 0, 1e-30);
        triangular_free(form);
        pattern_free(&r.pattern);
    }
}

int main(void)
{
    RUN(rows_of_a_tree_have_the_form);
    RUN(loops_have_it_as_long_as_speeds_are_left);
    RUN(elimination_is_sound_by_all_groups_or_not);
    RUN(dependent_rows_leave_nothing);
    return test_end();
}

/* family_impacts.c: masses in a row with stops and play, against parabolas between impacts
 *
 * Each mass moves on a line under a constant force. The first may have a wall below, the last one
 * above, and neighbours may have play. The oracle follows the parabolas from one impact to the
 * next: gaps close at roots of quadratics, and an impact of two masses is Newton's, by momentum and
 * the coefficient of restitution. A member ends before two impacts follow each other closely, as of
 * a light mass between a wall and a heavy one, or one is so slow that it may come to rest. */
#include "../unit/session_kit.h"
#include "base/text.h"
#include "family.h"

#include <math.h>

enum { MOST = 4, LIMITS = 2 * MOST + 2, IMPACTS = 60 };

#define TOGETHER 1e-3 /* s: impacts of which the oracle doesn't tell the order */
#define SLOW     0.05 /* m/s */
#define LEAST    1e-9 /* s: after an impact its own root is not looked for */

/* x_a - x_b <= gap; -1: a wall at 0 */
typedef struct Limit {
    int a, b;
    double gap, e;
} Limit;

typedef struct Row {
    int count, limit_count;
    double mass[MOST], force[MOST], x[MOST], v[MOST];
    Limit limits[LIMITS];
    double end, lost;
    int impacts;
} Row;

static double place_of(const Row *row, int mass)
{
    return mass < 0 ? 0 : row->x[mass];
}

static double speed_of(const Row *row, int mass)
{
    return mass < 0 ? 0 : row->v[mass];
}

static double pull_of(const Row *row, int mass)
{
    return mass < 0 ? 0 : row->force[mass] / row->mass[mass];
}

/* the time after which a limit is met while it closes; INFINITY */
static double time_to(const Row *row, const Limit *limit, double least)
{
    const double c = place_of(row, limit->a) - place_of(row, limit->b) - limit->gap;
    const double b = speed_of(row, limit->a) - speed_of(row, limit->b);
    const double a = (pull_of(row, limit->a) - pull_of(row, limit->b)) / 2;
    const double inside = b * b - 4 * a * c;
    double first = INFINITY, roots[2];

    if (a == 0)
        return b > 0 && -c / b > least ? -c / b : INFINITY;
    if (inside < 0)
        return INFINITY;
    roots[0] = (-b - sqrt(inside)) / (2 * a);
    roots[1] = (-b + sqrt(inside)) / (2 * a);
    for (int i = 0; i < 2; i++)
        if (roots[i] > least && 2 * a * roots[i] + b > 0)
            first = fmin(first, roots[i]);
    return first;
}

static void move(Row *row, double time)
{
    for (int i = 0; i < row->count; i++) {
        const double a = row->force[i] / row->mass[i];

        row->x[i] += time * (row->v[i] + a * time / 2);
        row->v[i] += time * a;
    }
}

static void strike(Row *row, const Limit *limit)
{
    const double closing = speed_of(row, limit->a) - speed_of(row, limit->b);
    const double ease =
        (limit->a < 0 ? 0 : 1 / row->mass[limit->a]) + (limit->b < 0 ? 0 : 1 / row->mass[limit->b]);
    const double impulse = (1 + limit->e) * closing / ease;

    if (limit->a >= 0)
        row->v[limit->a] -= impulse / row->mass[limit->a];
    if (limit->b >= 0)
        row->v[limit->b] += impulse / row->mass[limit->b];
    row->lost += (1 - limit->e * limit->e) * closing * closing / ease / 2;
    row->impacts++;
}

static double closing_after(const Row *row, const Limit *limit, double time)
{
    return speed_of(row, limit->a) - speed_of(row, limit->b) +
           time * (pull_of(row, limit->a) - pull_of(row, limit->b));
}

/* To its end, or to where the oracle tells no more, which becomes its end. */
static void follow(Row *row)
{
    double t = 0, last = -INFINITY;

    for (;;) {
        double first = INFINITY, second = INFINITY, left = row->end - t;
        int which = -1;

        for (int i = 0; i < row->limit_count; i++) {
            const double time = time_to(row, &row->limits[i], LEAST);

            second = fmin(second, fmax(time, first));
            if (time < first) {
                second = first;
                first = time;
                which = i;
            }
        }
        if (which < 0 || first > left) {
            move(row, left);
            return;
        }
        if (second - first < TOGETHER || t + first - last < TOGETHER || row->impacts == IMPACTS ||
            closing_after(row, &row->limits[which], first) < SLOW) {
            move(row, first / 2);
            row->end = t + first / 2;
            return;
        }
        move(row, first);
        t += first;
        last = t;
        strike(row, &row->limits[which]);
    }
}

/* --- a member --- */

static bool one_in(Member *member, int count)
{
    return test_random(&member->random) % (uint64_t)count == 0;
}

static void draw(Member *member, Row *row)
{
    *row = (Row){.count = 1 + (int)(test_random(&member->random) % MOST),
                 .end = member_between(member, 0.2, 4)};
    for (int i = 0; i < row->count; i++) {
        row->mass[i] = pow(10, member_between(member, -1.5, 1.5));
        row->force[i] = one_in(member, 3) ? 0 : row->mass[i] * member_between(member, -9, 9);
        row->x[i] = member_between(member, 1, 2) + i;
        row->v[i] = member_between(member, -4, 4);
    }
}

static void add_limit(Row *row, int a, int b, double gap, double e)
{
    row->limits[row->limit_count++] = (Limit){a, b, gap, e};
}

static void write_limits(Member *member, Row *row, Text *out)
{
    for (int i = 0; i < row->count; i++) {
        const double e = one_in(member, 4) ? 1 : member_between(member, 0.3, 1);
        const double far = member_between(member, 0.1, 3);

        if ((i == 0 && one_in(member, 4)) || (i > 0 && one_in(member, 2)))
            continue;
        if (i == 0) {
            const double low = row->x[0] - far, high = row->x[0] + member_between(member, 0.1, 3);

            text_addf(out, "stop w%d s%d low=%.17g high=%.17g e=%.17g\n", i, i, low, high, e);
            add_limit(row, -1, 0, -low, e);
            add_limit(row, 0, -1, high, e);
        } else { /* so far apart that both are between the limits */
            const double gap = 2 * fabs(row->x[i] - row->x[i - 1]) + far;

            text_addf(out, "backlash w%d s%d s%d gap=%.17g e=%.17g\n", i, i, i - 1, gap, e);
            add_limit(row, i, i - 1, gap / 2, e);
            add_limit(row, i - 1, i, gap / 2, e);
        }
    }
}

static void write_row(Member *member, Row *row, Text *out)
{
    text_add(out, "scene planar\n");
    for (int i = 0; i < row->count; i++) {
        text_addf(out, "body b%d mass=%.17g inertia=0.1\nprismatic s%d ground b%d axis=x\n", i,
                  row->mass[i], i, i);
        text_addf(out, "actuator f%d s%d force=%.17g\n", i, i, row->force[i]);
    }
    write_limits(member, row, out);
    if (one_in(member, 2))
        text_add(out, "tree absolute\n");
    if (one_in(member, 3))
        text_add(out, "form embedded\n");
    for (int i = 0; i < row->count; i++)
        text_addf(out, "init s%d = %.17g, s%d' = %.17g\n", i, row->x[i], i, row->v[i]);
}

static Verdict masses_in_a_row(Member *member)
{
    static const char *const methods[] = {"dop853", "radau", "ida", "adams", "auto"};
    Row row;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    draw(member, &row);
    write_row(member, &row, &text);
    follow(&row);
    text_addf(&text, "simulate %.17g rtol=1e-10 atol=1e-12 method=%s\n", row.end,
              methods[test_random(&member->random) % 5]);
    tell(member, "%s%d impacts\n", text.at, row.impacts);
    if (!(row.end > 0.01)) {
        verdict = REFUSED;
    } else if (kit_do(&kit, text.at) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int i = 0; i < row.count && verdict == AGREES; i++) {
        const double bound = 1e-6 * (1 + row.impacts) * (1 + fabs(row.x[i]) + fabs(row.v[i]));
        char name[16];

        (void)snprintf(name, sizeof name, "s%d", i);
        if (!keeps(member, name, fabs(kit_value(&kit, name) - row.x[i]), bound))
            verdict = DISAGREES;
        (void)snprintf(name, sizeof name, "s%d'", i);
        if (!keeps(member, name, fabs(kit_value(&kit, name) - row.v[i]), bound))
            verdict = DISAGREES;
    }
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {{"masses_in_a_row", 120, 0.2, 0, masses_in_a_row}};

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

/* chain_truth.c: where rods are after some time that hang one from the other: chain_truth RODS
 * SECONDS STEPS
 *
 * Rods of 1 m and 1 kg, released level. Forces in their joints are eliminated from the last rod to
 * the first, in absolute angles; the modified midpoint rule, extrapolated to order 20, goes through
 * that many steps, and then through twice as many. Prints the angles at the end, and behind '#' by
 * how much the two differ. Built by races.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 10 };

/* What a rod takes for an acceleration p of its upper end: an angular acceleration of c - k.p. Its
 * joint's force is A p + b; A is symmetric: xx, xy, yy. */
typedef struct Rod {
    long double ex, ey, kx, ky, c;
} Rod;

/* rates of n angles and n speeds */
static void rates(int n, const long double *y, Rod *rods, long double *out)
{
    const long double g = (long double)981 / 100,
                      inertia = (long double)1 / 12 + (long double)1 / 4;
    long double xx = 0, xy = 0, yy = 0, bx = 0, by = 0, px = 0, py = 0;

    for (int i = n - 1; i >= 0; i--) {
        Rod *rod = &rods[i];
        const long double ex = cosl(y[i]), ey = sinl(y[i]), w2 = y[n + i] * y[n + i];
        const long double hx = -xx * ey + xy * ex, hy = -xy * ey + yy * ex; /* A n */
        const long double ax = xx * ex + xy * ey, ay = xy * ex + yy * ey;   /* A e */
        const long double d = inertia - ey * hx + ex * hy, sx = hx - ey / 2, sy = hy + ex / 2;

        rod->ex = ex;
        rod->ey = ey;
        rod->kx = sx / d;
        rod->ky = sy / d;
        rod->c = (-g * ex / 2 + w2 * (-ey * ax + ex * ay) - (-ey * bx + ex * by)) / d;
        bx += rod->c * sx - w2 * (ex / 2 + ax);
        by += rod->c * sy - w2 * (ey / 2 + ay) + g;
        xx += 1 - sx * rod->kx;
        xy -= sx * rod->ky;
        yy += 1 - sy * rod->ky;
    }
    for (int i = 0; i < n; i++) {
        const Rod *rod = &rods[i];
        const long double w2 = y[n + i] * y[n + i], turn = rod->c - rod->kx * px - rod->ky * py;

        out[i] = y[n + i];
        out[n + i] = turn;
        px += -turn * rod->ey - w2 * rod->ex;
        py += turn * rod->ex - w2 * rod->ey;
    }
}

static void *space_of(size_t count, size_t size)
{
    void *space = calloc(count, size);

    if (space == NULL)
        exit(1);
    return space;
}

static void run(int n, long double seconds, int steps, long double *y)
{
    const long double h = seconds / steps;
    const size_t length = 2 * (size_t)n;
    long double *space = space_of((4 + COLUMNS) * length, sizeof *space);
    long double *first = space, *before = space + length, *now = space + 2 * length,
                *rate = space + 3 * length, *table = space + 4 * length;
    Rod *rods = space_of((size_t)n, sizeof *rods);

    for (int step = 0; step < steps; step++) {
        rates(n, y, rods, first);
        for (int j = 0; j < COLUMNS; j++) {
            const int parts = 2 * (j + 1);
            const long double part = h / parts;

            for (size_t i = 0; i < length; i++) {
                before[i] = y[i];
                now[i] = y[i] + part * first[i];
            }
            for (int k = 1; k < parts; k++) {
                rates(n, now, rods, rate);
                for (size_t i = 0; i < length; i++) {
                    const long double next = before[i] + 2 * part * rate[i];

                    before[i] = now[i];
                    now[i] = next;
                }
            }
            rates(n, now, rods, rate);
            for (size_t i = 0; i < length; i++) {
                long double value = (now[i] + before[i] + part * rate[i]) / 2;

                for (int k = 0; k < j; k++) { /* Neville's rule in the square of a part */
                    const long double ratio = (long double)(j + 1) / (j - k),
                                      kept = table[(size_t)k * length + i];

                    table[(size_t)k * length + i] = value;
                    value += (value - kept) / (ratio * ratio - 1);
                }
                table[(size_t)j * length + i] = value;
            }
        }
        memcpy(y, table + (COLUMNS - 1) * length, length * sizeof(long double));
    }
    free(space);
    free(rods);
}

int main(int argc, char **argv)
{
    const int n = argc == 4 ? atoi(argv[1]) : 0, steps = argc == 4 ? atoi(argv[3]) : 0;
    long double *coarse, *fine, off = 0;

    if (n < 1 || steps < 1) {
        fprintf(stderr, "usage: chain_truth RODS SECONDS STEPS\n");
        return 2;
    }
    coarse = space_of(2 * (size_t)n, sizeof *coarse);
    fine = space_of(2 * (size_t)n, sizeof *fine);
    run(n, strtold(argv[2], NULL), steps, coarse);
    run(n, strtold(argv[2], NULL), 2 * steps, fine);
    for (int i = 0; i < n; i++) {
        off = off > fabsl(fine[i] - coarse[i]) ? off : fabsl(fine[i] - coarse[i]);
        printf("%.17g\n", (double)fine[i]);
    }
    printf("# %.3g\n", (double)off);
    free(coarse);
    free(fine);
    return 0;
}

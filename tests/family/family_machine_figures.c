/* family_machine_figures.c: figures taken over runs of machines, and rows that are written of them,
 * against equations of another kind
 *
 * Of machines of machine_draw.h: mean, rms, final, min and max of the motion, the first instant
 * at which something holds, and csv, against Simpson's rule and samples of the oracle of
 * machine.h. Runs have few rows, so that what is of the motion can't be of the rows. */
#include "machine_whole.h"

#include <stdlib.h>

enum { SAMPLES = 160, ROWS_APART = 40, FIGURES = 6 };

#define END 0.4

typedef struct Samples {
    int figure[FIGURES]; /* which of what ask_all() asks */
    char name[FIGURES][48];
    double at[FIGURES][SAMPLES + 1], scale[FIGURES];
} Samples;

static bool take_samples(Member *member, const Drawn *d, Samples *out)
{
    static Asks asks;
    Real y[MOST_STATES];

    memcpy(y, d->y, sizeof y);
    memset(out->scale, 0, sizeof out->scale);
    for (int k = 0; k <= SAMPLES; k++) {
        if (oracle_answers(d, k == 0 ? 0 : END * (k - 1) / SAMPLES, END * k / SAMPLES, y, &asks) !=
            AGREES)
            return false;
        for (int i = 0; i < FIGURES; i++) {
            const Ask *a;

            if (k == 0)
                out->figure[i] = member_one_of(member, asks.count);
            a = &asks.ask[out->figure[i]];
            if (k == 0)
                (void)snprintf(out->name[i], sizeof out->name[i], "%s", a->text);
            out->at[i][k] = a->wanted;
            out->scale[i] = fmax(out->scale[i], fmax(a->scale, fabs(a->wanted)));
        }
    }
    return true;
}

/* the mean of x y, by Simpson's rule over every `apart`-th sample */
static double mean_of(const double *x, const double *y, int apart)
{
    double sum = 0;

    for (int k = 0; k <= SAMPLES; k += apart)
        sum += (k == 0 || k == SAMPLES ? 1
                : k / apart % 2 == 1   ? 4
                                       : 2) *
               x[k] * (y != NULL ? y[k] : 1);
    return sum * apart / (3 * SAMPLES);
}

static bool figure_is(Member *member, Kit *kit, const char *text, double wanted, double scale,
                      double bound)
{
    const double got = kit_value(kit, text);

    if (keeps(member, text, fabs(got - wanted) / scale, bound))
        return true;
    tell(member, "%s is %.12g, wanted %.12g %s\n", text, got, wanted,
         isnan(got) ? kit->error.message : "");
    return false;
}

static bool means_are(Member *member, Kit *kit, const Samples *s, int i, int other)
{
    const double *x = s->at[i], *y = s->at[other];
    const double size = s->scale[i], both = size * s->scale[other];
    const double mean = mean_of(x, NULL, 1), square = mean_of(x, x, 1), product = mean_of(x, y, 1);
    /* what the rule leaves open, as where a limit is met */
    const double open = fabs(mean - mean_of(x, NULL, 2)) / size,
                 open_square = fabs(square - mean_of(x, x, 2)) / (size * size),
                 open_product = fabs(product - mean_of(x, y, 2)) / both;
    char text[140];

    (void)snprintf(text, sizeof text, "mean(%s)", s->name[i]);
    if (!figure_is(member, kit, text, mean, size, 1e-5 + 2 * open))
        return false;
    (void)snprintf(text, sizeof text, "rms(%s)^2", s->name[i]);
    if (!figure_is(member, kit, text, square, size * size, 1e-5 + 2 * open_square))
        return false;
    (void)snprintf(text, sizeof text, "mean(%s*%s)", s->name[i], s->name[other]);
    return figure_is(member, kit, text, product, both, 1e-5 + 2 * open_product);
}

/* The largest of sign times samples of a motion between them: that of the parabolas through each
 * three, and with every second sample alone, which differs by what they leave open. */
static double largest_of(const double *x, double sign, int apart)
{
    double most = fmax(sign * x[0], sign * x[SAMPLES]);

    for (int k = apart; k + apart <= SAMPLES; k += apart) {
        const double a = sign * x[k - apart], b = sign * x[k], c = sign * x[k + apart];

        most = fmax(most, b);
        if (b >= a && b >= c && 2 * b > a + c)
            most = fmax(most, b + (c - a) * (c - a) / (8 * (2 * b - a - c)));
    }
    return most;
}

static bool extremes_are(Member *member, Kit *kit, const Samples *s, int i)
{
    const double *x = s->at[i];
    char text[100];

    for (int sign = -1; sign <= 1; sign += 2) {
        const double most = largest_of(x, sign, 1);
        const double open = fabs(most - largest_of(x, sign, 2)) / s->scale[i];

        (void)snprintf(text, sizeof text, "%s(%s)", sign < 0 ? "min" : "max", s->name[i]);
        if (!figure_is(member, kit, text, sign * most, s->scale[i], 1e-5 + 2 * open))
            return false;
    }
    (void)snprintf(text, sizeof text, "final(%s)", s->name[i]);
    return figure_is(member, kit, text, s->at[i][SAMPLES], s->scale[i], 1e-5);
}

/* when it rises above where it is halfway between its least and its most */
static bool first_is(Member *member, Kit *kit, const Samples *s, int i)
{
    const double *x = s->at[i];
    double least = INFINITY, most = -INFINITY, level, error_floor;
    char text[140];
    double found;
    int k = 0;

    for (int j = 0; j <= SAMPLES; j++) {
        least = fmin(least, x[j]);
        most = fmax(most, x[j]);
    }
    level = least + 0.37 * (most - least);
    error_floor = 1e-5 * s->scale[i];
    if (most - least < 1e-2 * s->scale[i])
        return true;
    while (k <= SAMPLES && !(x[k] > level))
        k++;
    /* one that touches it between samples could be earlier */
    for (int j = 1; j < k; j++)
        if (level - x[j] < 0.02 * (most - least) && x[j] > x[j - 1] && x[j] > x[j + 1])
            return true;
    (void)snprintf(text, sizeof text, "first(%s > %.17g)", s->name[i], level);
    found = kit_value(kit, text) / END * SAMPLES;
    if (fabs(x[k] - level) < error_floor || (k > 0 && fabs(x[k - 1] - level) < error_floor))
        return true;
    if (found <= k && found >= (k > 0 ? k - 1 : 0))
        return true;
    tell(member, "%s is at sample %g, wanted up to %d %s\n", text, found, k,
         isnan(found) ? kit->error.message : "");
    return false;
}

/* rows as they are written */
static bool csv_is(Member *member, Kit *kit, const Samples *s)
{
    char line[500];
    size_t length = (size_t)snprintf(line, sizeof line, "export csv");
    const char *row;
    int rows = 0;

    for (int i = 0; i < FIGURES; i++)
        length += (size_t)snprintf(line + length, sizeof line - length, " %s", s->name[i]);
    (void)snprintf(line + length, sizeof line - length, "\n");
    if (do_told(member, kit, line) != CT_OK || kit->text == NULL)
        return false;
    for (row = strchr(kit->text, '\n'); row != NULL && row[1] != '\0';
         row = strchr(row + 1, '\n'), rows++) {
        char *next;
        const double t = strtod(row + 1, &next), place = t / END * SAMPLES;
        const int k = (int)lround(place);

        if (fabs(place - k) > 1e-9 || k < 0 || k > SAMPLES) {
            tell(member, "a row at %.17g\n", t);
            return false;
        }
        for (int i = 0; i < FIGURES; i++) {
            const double got = strtod(next + 1, &next);

            if (!keeps(member, s->name[i], fabs(got - s->at[i][k]) / s->scale[i], 1e-5)) {
                tell(member, "in the row at %g it is %.12g, wanted %.12g\n", t, got, s->at[i][k]);
                return false;
            }
        }
    }
    if (rows != SAMPLES / ROWS_APART + 1)
        tell(member, "%d rows\n", rows);
    return rows == SAMPLES / ROWS_APART + 1;
}

/* Figures of a run are those of the motion of its parts. */
static Verdict run_has_figures(Member *member)
{
    static Drawn d;
    static Samples s;
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    while (!draw_machine(member, &d) || (d.m.coordinates == 0 && d.m.states == 0))
        ;
    draw_tree(member, &d, member_one_of(member, 3));
    write_line(&d.script, "simulate %g every=%g rtol=1e-9 atol=1e-11 method=%s", END,
               END * ROWS_APART / SAMPLES, draw_method(member));
    if (do_told(member, &kit, d.script.text) != CT_OK || !take_samples(member, &d, &s))
        verdict = REFUSED;
    for (int i = 0; i < FIGURES && verdict == AGREES; i++)
        if (!means_are(member, &kit, &s, i, (i + 1) % FIGURES) ||
            !extremes_are(member, &kit, &s, i) || !first_is(member, &kit, &s, i))
            verdict = DISAGREES;
    if (verdict == AGREES && !csv_is(member, &kit, &s))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"figures of runs are those of the motion", 5, 0.1, 0, run_has_figures},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

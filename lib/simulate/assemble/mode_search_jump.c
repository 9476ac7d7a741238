/* mode_search_jump.c: what jumps where ideal switches go over, and who drives it
 *
 * The states of a step of vanishing length from x0, by the same equations that sides are found
 * from. Its length h is cut until that changes nothing; leaks go with its square, for what they
 * leave of a voltage C R/h of the jump. */
#include "simulate/assemble/mode_search_impl.h"

#include <math.h>
#include <string.h>

#define IMPULSE  1e-3  /* of the largest: more than leaks and what is no impulse */
#define SHORTEST 1e-7  /* of the step, to see impulses by */
#define HALVED   0.2   /* of the largest, that its change with the step has to be */
#define CUTS     20    /* of the step, each to a tenth */
#define MET      1e-6  /* of a state's size: what cuts may still change */
#define ROUNDING 1e-12 /* likewise: no use in less */

void mode_search_calm(ModeSearch *s)
{
    memset(s->known, 0, sizeof s->known);
}

static bool land(ModeSearch *s, double step)
{
    const double share = step / s->at->step;
    bool sound;

    s->step = step;
    s->averages = !s->is_linear;
    mode_search_leak(s, share * share, share * share);
    memset(netsolve_values(s->solve), 0, (size_t)s->l->nx * sizeof(double));
    sound = mode_search_solve(s);
    mode_search_leak(s, 1, 1);
    s->averages = false;
    return sound;
}

/* the largest difference, in sizes */
static double differ(const double *a, const double *b, const double *size, int count)
{
    double largest = 0;

    for (int i = 0; i < count; i++) {
        const double off = fabs(a[i] - b[i]) / fmax(size[i], fabs(a[i]));

        if (!(off <= largest))
            largest = off;
    }
    return largest;
}

/* One after another: x of shorter and shorter steps, less what goes with their length. */
typedef struct Cuts {
    double *now, *last;   /* x of a step */
    double *limit, *next; /* what they tend to */
    double changed;       /* the limit, when it was told last */
    int count;
} Cuts;

/* x of a step of a tenth of the last one's length; how far the limit is off, or INFINITY */
static double cut(Cuts *c, const double *x, const double *size, int nx)
{
    double off = INFINITY, changed;

    memcpy(c->now, x, (size_t)nx * sizeof(double));
    for (int i = 0; i < nx; i++)
        c->next[i] = x[i] + (c->count > 0 ? (x[i] - c->last[i]) / 9 : 0);
    changed = c->count > 1 ? differ(c->next, c->limit, size, nx) : INFINITY;
    if (c->count > 2)
        off = fmax(changed, c->changed); /* by chance two may be alike, but not three */
    c->changed = changed;
    c->count++;
    memcpy(c->last, c->now, (size_t)nx * sizeof(double));
    return off;
}

bool mode_search_jump(ModeSearch *s, const double *from, const double *size, double *x)
{
    const int nx = s->l->nx;
    const size_t bytes = (size_t)nx * sizeof(double);
    double *room = NEW_ARRAY(double, 4 * nx);
    Cuts cuts = {.now = room, .last = room + nx, .limit = room + 2 * nx, .next = room + 3 * nx};
    double least = INFINITY, step = s->at->step, taken = step;

    s->from = from;
    for (int k = 0; k < CUTS && !(least <= ROUNDING); k++, step /= 10) {
        double off;

        if (!land(s, step)) {
            cuts.count = 0;
            continue;
        }
        off = cut(&cuts, s->x, size, nx);
        if (off < least) { /* which is the limit as it was told before */
            least = off;
            taken = step;
            memcpy(x, cuts.limit, bytes);
        }
        memcpy(cuts.limit, cuts.next, bytes);
    }
    s->step = taken;
    s->from = s->at->x;
    mem_free(room);
    return least <= MET;
}

/* across and through variables of all edges behind the step that was solved last */
static void edges_behind(ModeSearch *s, double *out)
{
    const RowValues row = mode_search_row(s, netsolve_values(s->solve));

    memcpy(out, probe_values(s->looks, &row) + (ptrdiff_t)LOOKS * s->count,
           (size_t)(2 * s->edges) * sizeof(double));
}

double mode_search_work(ModeSearch *s, const double *from, const bool *before)
{
    double *was = NEW_ARRAY(double, 2 * s->edges), *is = NEW_ARRAY(double, 2 * s->edges);
    bool *behind = NEW_ARRAY(bool, s->count);
    const size_t bytes = (size_t)s->count * sizeof(bool);
    double work = 0;

    s->from = from;
    memcpy(behind, s->closed, bytes);
    if (!land(s, s->step))
        work = NAN;
    edges_behind(s, is);
    memcpy(s->closed, before, bytes);
    if (!land(s, s->step))
        work = NAN;
    edges_behind(s, was);
    memcpy(s->closed, behind, bytes);
    /* what jumps with an impulse goes straight from one value to the other */
    for (int i = 0; i < s->edges; i++)
        if (s->gives[i])
            work -= s->step / 2 *
                    (was[2 * i] * is[2 * i + 1] + is[2 * i] * was[2 * i + 1] +
                     is[2 * i] * is[2 * i + 1]);
    s->from = s->at->x;
    MEM_FREE(was, is, behind);
    return work;
}

/* --- sources --- */

static bool edges_at(ModeSearch *s, double step, double *out)
{
    s->step = step;
    memset(netsolve_values(s->solve), 0, (size_t)s->l->nx * sizeof(double));
    if (!mode_search_solve(s))
        return false;
    edges_behind(s, out);
    return true;
}

/* An impulse is what halves when its step is doubled. False: there is none. */
static bool find_source(ModeSearch *s, double step, const char **source)
{
    double *longer = NEW_ARRAY(double, 2 * s->edges);
    double *impulse = NEW_ARRAY(double, 2 * s->edges);
    double largest[DOMAIN_COUNT][2] = {{0}}; /* of changes, and of values */
    double whole[DOMAIN_COUNT][2] = {{0}};
    bool found = false;
    const bool sound = edges_at(s, step, impulse) && edges_at(s, 2 * step, longer);

    for (int i = 0; i < 2 * s->edges && sound; i++) {
        const Domain domain = s->domain[s->count + i / 2];

        whole[domain][i % 2] = fmax(whole[domain][i % 2], fabs(impulse[i]));
        impulse[i] = fabs(impulse[i] - longer[i]);
        largest[domain][i % 2] = fmax(largest[domain][i % 2], impulse[i]);
    }
    for (int i = 0; i < 2 * s->edges && sound; i++) {
        const Domain domain = s->domain[s->count + i / 2];

        if (!(largest[domain][i % 2] > HALVED * whole[domain][i % 2]))
            continue;
        found = true;
        if (*source == NULL && impulse[i] > IMPULSE * largest[domain][i % 2])
            *source = s->source[i % 2 == 0 ? i + 1 : i - 1];
    }
    MEM_FREE(longer, impulse);
    return found;
}

/* by shorter steps too, where what is no impulse may hide it */
const char *mode_search_source(ModeSearch *s, double step)
{
    const char *source = NULL;
    double tried = step;

    while (tried > SHORTEST * step && !find_source(s, tried, &source))
        tried /= 10;
    return source;
}

/* gain.c: the first of the Markov parameters d, c b, c A b ... that isn't 0
 *
 * Each has two bounds: of the error from the entries, which decides what can be distinguished from
 * 0 at all, and of the rounding error here, in double-double arithmetic. Where the second is too
 * large and the first isn't, as where entries are exact and cancel, the sums are computed exactly
 * (markov_parameters.h). */
#include "simulate/analyse/gain.h"

#include "algebra/markov_parameters.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"

#include <float.h>

/* A^k b, the bound of its error, and that of rounding */
typedef struct Power {
    DoubleDouble *v;
    double *off, *noise;
} Power;

/* c A^k b likewise */
typedef struct GainValue {
    double at, off, noise;
} GainValue;

typedef struct GainSearch {
    const Siso *s;
    double *a, *a_error; /* in units of time in which A is about 1: its powers don't overflow */
    int unit;
    Power now, next;
    MarkovParameters *exact; /* NULL: not needed yet */
} GainSearch;

static Power power_new(int n)
{
    return (Power){NEW_ARRAY(DoubleDouble, n), NEW_ARRAY(double, n), NEW_ARRAY(double, n)};
}

static void search_open(GainSearch *search, const Siso *s)
{
    const int n = s->n;
    double norm = 0;

    *search = (GainSearch){.s = s,
                           .a = NEW_ARRAY(double, n *n),
                           .a_error = NEW_ARRAY(double, n *n),
                           .now = power_new(n),
                           .next = power_new(n)};
    for (int i = 0; i < n * n; i++)
        norm = fmax(norm, fabs(s->a[i]));
    search->unit = norm > 0 ? ilogb(norm) : 0;
    for (int i = 0; i < n * n; i++) {
        search->a[i] = ldexp(s->a[i], -search->unit);
        search->a_error[i] = ldexp(s->a_error[i], -search->unit);
    }
    for (int i = 0; i < n; i++) {
        search->now.v[i] = dd_of(s->b[i]);
        search->now.off[i] = s->b_error[i];
    }
}

static void search_close(GainSearch *search)
{
    markov_parameters_free(search->exact);
    MEM_FREE(search->a, search->a_error, search->now.v, search->now.off, search->now.noise,
             search->next.v, search->next.off, search->next.noise);
}

/* add a product, whose first factor has an error of `error` */
static inline void add(DoubleDouble *sum, GainValue *bound, double by, double error, const Power *p,
                       int j, int n)
{
    const double size = fabs(p->v[j].high);

    if (by == 0 && error == 0)
        return;
    *sum = dd_add(*sum, dd_times(p->v[j], by));
    bound->off += fabs(by) * p->off[j] + error * (size + p->off[j] + p->noise[j]);
    if (size != 0 || p->noise[j] != 0)
        bound->noise +=
            fmax(fabs(by) * (p->noise[j] + n * DOUBLE_DOUBLE_ROUNDING * size), GAIN_LEAST);
}

/* c times the power */
static GainValue value_of(const GainSearch *search)
{
    const Siso *s = search->s;
    DoubleDouble sum = dd_of(0);
    GainValue out = {0};

    for (int j = 0; j < s->n; j++)
        add(&sum, &out, s->c[j], s->c_error[j], &search->now, j, s->n);
    out.at = dd_double(sum);
    return out;
}

static void step(GainSearch *search)
{
    const int n = search->s->n;
    const Power kept = search->now;

    for (int i = 0; i < n; i++) {
        GainValue bound = {0};

        search->next.v[i] = dd_of(0);
        for (int j = 0; j < n; j++)
            add(&search->next.v[i], &bound, search->a[i * n + j], search->a_error[i * n + j],
                &search->now, j, n);
        search->next.off[i] = bound.off;
        search->next.noise[i] = bound.noise;
    }
    search->now = search->next;
    search->next = kept;
}

/* c A^k b exactly; false: too many digits, or too small for a double */
static bool settle(GainSearch *search, int k, GainValue *value)
{
    const Siso *s = search->s;
    int exponent;

    if (search->exact == NULL)
        search->exact = markov_parameters_new(search->a, s->b, s->c, s->n, s->n);
    if (search->exact == NULL)
        return false;
    value->at = markov_parameters_value(search->exact, k, &exponent);
    value->noise = 0;
    if (value->at != 0 && ilogb(value->at) + exponent < DBL_MIN_EXP)
        return false;
    value->at = ldexp(value->at, exponent);
    return true;
}

static bool is_determined(const GainValue *value)
{
    return fabs(value->at) > value->off + value->noise;
}

/* whether rounding prevents a decision: the bound of the entries alone would allow one */
static bool is_open(const GainValue *value)
{
    return !is_determined(value) && fabs(value->at) + value->noise > value->off;
}

/* converted from the units of time */
static double scaled(double value, int by)
{
    const int size = ilogb(value) + by;

    return size < DBL_MIN_EXP || size >= DBL_MAX_EXP ? INFINITY : ldexp(value, by);
}

bool gain_find(const Siso *s, Gain *out)
{
    GainSearch search;
    GainValue value = {s->d, s->d_error, 0};
    bool sound = true;

    search_open(&search, s);
    *out = (Gain){0};
    while (sound && !is_determined(&value) && out->degree <= s->n) {
        const int k = out->degree++;

        if (k > 0)
            step(&search);
        value = k < s->n ? value_of(&search) : (GainValue){0};
        if (is_open(&value))
            sound = settle(&search, k, &value);
        out->is_open = out->is_open || value.off > 0;
    }
    out->is_open = out->is_open && !is_determined(&value);
    out->value = !is_determined(&value) ? 0
                 : out->degree > 1      ? scaled(value.at, (out->degree - 1) * search.unit)
                                        : value.at;
    search_close(&search);
    return sound;
}

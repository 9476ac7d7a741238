/* result_shares.c: parts that stick and share a load, of which only their sum is determined
 *
 * Signs s of the surfaces that the motion stands on change how these are left by B s. Signs in the
 * null space of B change nothing: they are not determined, and with them the efforts of the parts
 * whose surfaces have a component there. B is scaled to a unit diagonal. */
#include "simulate/run/result_reader_impl.h"

#include "base/memory.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <string.h>

typedef struct SharedLoads {
    int n;       /* signs of surfaces that the motion stands on */
    int *place;  /* of each the surface, among the phase's */
    double *b;   /* n x n; after elimination the null space in its last `open` columns */
    double *p;   /* n x n: projector on the null space */
    int *column; /* order of columns */
    int open;    /* dimension of the null space */
} SharedLoads;

static void shared_loads_free(SharedLoads *s)
{
    MEM_FREE(s->place, s->b, s->p, s->column);
}

/* the same mode with the motion along all surfaces that it stands on; freed by the caller */
static Status slide_along_all(Phase *phase, Phase **out, Diag *diag)
{
    OnSurface *on = NEW_ARRAY(OnSurface, phase->on_count);
    Status status = OK;

    for (int i = 0; i < phase->on_count; i++) {
        on[i] = phase->on[i];
        if (on[i].held)
            on[i] = (OnSurface){.surface = on[i].surface};
    }
    CHECK(compiled_slide(phase->like->numbers, on, diag));
    *out = phase_new_like(phase, phase->closed, system_ideal_count(phase->system), on);
done:
    mem_free(on);
    return status;
}

/* surfaces that the motion stands on */
static int count_rests(const Phase *phase)
{
    int rests = 0;

    for (int i = 0; i < phase->on_count; i++)
        rests += phase->on[i].side == 0 || phase->on[i].held;
    return rests;
}

/* a place for each sign, those of a vector on one surface */
static void place_signs(SharedLoads *s, const VariableIndex *l)
{
    s->n = l->slides;
    s->place = NEW_ARRAY(int, s->n);
    memcpy(s->place, l->slid_surface, (size_t)s->n * sizeof(int));
    s->b = NEW_ARRAY(double, s->n * s->n);
    s->p = NEW_ARRAY(double, s->n * s->n);
    s->column = NEW_ARRAY(int, s->n);
}

static bool find_effects(SharedLoads *s, Phase *along, double t, const double *y)
{
    const int n = s->n;
    double *signs = NEW_ARRAY(double, n), *off = NEW_ARRAY(double, n);
    double *zero = NEW_ARRAY(double, n), *slip = NEW_ARRAY(double, n);
    bool sound = motion_drift(along->motion, t, y, signs, zero, off);

    for (int k = 0; k < n && sound; k++) {
        signs[k] = 0.5;
        sound = motion_drift(along->motion, t, y, signs, slip, off);
        signs[k] = 0;
        for (int i = 0; i < n; i++)
            s->b[i * n + k] = (slip[i] - zero[i]) / 0.5;
    }
    for (int i = 0; i < n; i++)
        off[i] = sqrt(fabs(s->b[i * n + i]));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            s->b[i * n + k] = off[i] > 0 && off[k] > 0 ? s->b[i * n + k] / (off[i] * off[k])
                              : i == k                 ? 1
                                                       : 0;
    MEM_FREE(signs, off, zero, slip);
    return sound;
}

static void exchange(double *a, double *b)
{
    const double kept = *a;

    *a = *b;
    *b = kept;
}

/* Gauss and Jordan with full pivoting: afterwards the first rows are [1, R], and [-R; 1] spans the
 * null space. */
static void eliminate(SharedLoads *s)
{
    const int n = s->n;

    for (int k = 0; k < n; k++)
        s->column[k] = k;
    s->open = n;
    for (int step = 0; step < n; step++) {
        int row = step, column = step;

        for (int i = step; i < n; i++)
            for (int k = step; k < n; k++)
                if (fabs(s->b[i * n + k]) > fabs(s->b[row * n + column])) {
                    row = i;
                    column = k;
                }
        if (!(fabs(s->b[row * n + column]) > SHARES_DEPENDENT))
            return;
        for (int k = 0; k < n; k++)
            exchange(&s->b[row * n + k], &s->b[step * n + k]);
        for (int i = 0; i < n; i++)
            exchange(&s->b[i * n + column], &s->b[i * n + step]);
        row = s->column[column];
        s->column[column] = s->column[step];
        s->column[step] = row;
        for (int k = n - 1; k >= step; k--)
            s->b[step * n + k] /= s->b[step * n + step];
        for (int i = 0; i < n; i++)
            for (int k = n - 1; k >= step && i != step; k--)
                s->b[i * n + k] -= s->b[i * n + step] * s->b[step * n + k];
        s->open--;
    }
}

/* the projector on the null space, by its vectors made orthogonal */
static void find_projector(SharedLoads *s)
{
    const int n = s->n, rank = n - s->open;
    double *v = NEW_ARRAY(double, n * s->open);

    for (int c = 0; c < s->open; c++) {
        double *own = v + (ptrdiff_t)c * n, size = 0;

        for (int i = 0; i < rank; i++)
            own[s->column[i]] = -s->b[i * n + rank + c];
        own[s->column[rank + c]] = 1;
        for (int before = 0; before < c; before++) {
            const double *other = v + (ptrdiff_t)before * n;
            double common = 0;

            for (int i = 0; i < n; i++)
                common += own[i] * other[i];
            for (int i = 0; i < n; i++)
                own[i] -= common * other[i];
        }
        for (int i = 0; i < n; i++)
            size += own[i] * own[i];
        for (int i = 0; i < n; i++)
            own[i] /= sqrt(size);
        for (int i = 0; i < n; i++)
            for (int k = 0; k < n; k++)
                s->p[i * n + k] += own[i] * own[k];
    }
    mem_free(v);
}

/* the place of a part's surface among those that the motion stands on; -1: none */
static int find_surface(const SharedLoads *s, const Phase *phase, const char *part)
{
    int surfaces[2]; /* of two limits one at most is stood on */
    const int count = system_surfaces_of_part(phase->system, part, surfaces, 2);

    for (int i = 0; i < s->n; i++)
        for (int k = 0; k < count && k < 2; k++)
            if (phase->on[s->place[i]].surface == surfaces[k])
                return i;
    return -1;
}

Status result_reader_shares(ResultReader *reader, double t, const char *const *parts, int count,
                            bool *shares, Diag *diag)
{
    mem_keep(reader);
    SharedLoads s = {0};
    Phase *phase = NULL, *along = NULL;
    const double *y = NULL, *driven = NULL;
    int *at = NEW_ARRAY(int, count);
    Status status = OK;

    memset(shares, 0, (size_t)count * (size_t)count * sizeof(bool));
    CHECK(result_reader_at(reader, t, &phase, &y, &driven, diag));
    if (count_rests(phase) > 0) {
        CHECK(slide_along_all(phase, &along, diag));
        phase_enter(along);
        place_signs(&s, along->layout);
        motion_partition(along->motion, t, y);
        if (s.n > 1 && find_effects(&s, along, t, y)) {
            eliminate(&s);
            find_projector(&s);
        }
        phase_enter(phase);
    }
    for (int i = 0; i < count; i++)
        at[i] = find_surface(&s, phase, parts[i]);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < count; k++)
            shares[i * count + k] =
                i != k && at[i] >= 0 && at[k] >= 0 && s.p != NULL &&
                (at[i] == at[k] || fabs(s.p[at[i] * s.n + at[k]]) > SHARES_DEPENDENT);
done:
    phase_free(along);
    shared_loads_free(&s);
    mem_free(at);
    return status;
}

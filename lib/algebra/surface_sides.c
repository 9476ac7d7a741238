/* surface_sides.c: slip around the signs, its complementarity problem, until the sides stay */
#include "algebra/surface_sides.h"

#include <math.h>
#include <string.h>

#define FLAT      1e-12 /* of the largest entry: no influence at all */
#define WRONG     1e-9  /* of the largest: a slip that leads back, and not by rounding */
#define DEPENDENT 1e-9  /* of B_ii: what is left of a row that depends on others */
#define REGULAR   1e-13 /* least pivot over the largest entry */
#define REFINED   8     /* where slip isn't linear in the signs */
#define STILL     1e-8  /* of the state: what is 0 on a surface and so is its rate */
#define SAME      1e-9  /* a change of a cone's sign that is none */

typedef struct Search {
    SurfaceSide *at;
    int n;
    SurfaceSlip at_signs;
    void *context;
    bool insists;
    double size, largest; /* of the state; of a and B */
    double *a, *b, *slip, *other, *signs, *matrix, *q, *low, *high, *z, *earlier, *share, *way,
        *room;
    int *place, *side, *before, *rows, *slips, *load, *integers;
    bool has_cones, has_loads;
} Search;

static double largest_of(const double *v, int n)
{
    double most = 0;

    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(v[i]));
    return most;
}

static bool slip_at(const Search *s, double *out)
{
    if (!s->at_signs(s->context, s->signs, out))
        return false;
    for (int i = 0; i < s->n; i++)
        if (!isfinite(out[i]))
            return false;
    return true;
}

static double low_of(const SurfaceSide *at)
{
    return at->is_unilateral ? 0 : -at->bound;
}

static double high_of(const SurfaceSide *at)
{
    return at->is_unilateral ? INFINITY : at->bound;
}

/* the sign where the surface is left to its side, with a load that of the other signs */
static double left_sign(const Search *s, int i)
{
    const SurfaceSide *at = &s->at[i];

    if (at->is_unilateral)
        return 0;
    return at->load >= 0 ? at->side * at->left * s->signs[at->load] : at->side * at->left;
}

/* column k of B from slip at two values of its sign; a where there is no other */
static bool find_slope(Search *s, int k)
{
    const int n = s->n;
    const double kept = s->signs[k];
    const bool is_all = n == 1 && !s->at[k].is_unilateral;
    const double low = is_all ? low_of(&s->at[k]) : kept - (kept > 0 ? 0.5 : 0);
    const double high = is_all ? high_of(&s->at[k]) : low + 0.5;
    bool sound;

    s->signs[k] = low;
    sound = slip_at(s, s->slip);
    s->signs[k] = high;
    sound = sound && slip_at(s, s->other);
    s->signs[k] = kept;
    for (int i = 0; i < n; i++)
        s->b[i * n + k] = (s->other[i] - s->slip[i]) / (high - low);
    if (n == 1)
        s->a[0] = s->slip[0] - s->b[0] * low;
    return sound;
}

/* a and B around the signs as they are; over the whole interval where there is but one sign */
static bool find_slopes(Search *s)
{
    const int n = s->n;
    bool sound = slip_at(s, s->slip);

    s->largest = largest_of(s->slip, n);
    for (int k = 0; k < n && sound; k++)
        sound = find_slope(s, k);
    sound = sound && (n == 1 || slip_at(s, s->slip));
    for (int i = 0; i < n && n > 1 && sound; i++) {
        s->a[i] = s->slip[i];
        for (int k = 0; k < n; k++)
            s->a[i] -= s->b[i * n + k] * s->signs[k];
    }
    s->largest = fmax(s->largest, largest_of(s->b, n * n));
    return sound;
}

static void begin_surface(Search *s, int i)
{
    SurfaceSide *at = &s->at[i];
    const double own = s->b[i * s->n + i];

    at->is_known = at->side != 0 && (s->insists || !at->ends);
    at->is_unaffected = false;
    if (at->is_known)
        return;
    if (fabs(at->off) > STILL * s->size && !at->settles) { /* it is on its way through */
        at->side = at->off > 0 ? 1 : -1;
        at->is_known = true;
    } else if (fabs(own) <= FLAT * s->largest) {
        at->side = s->a[i] < 0 ? -1 : 1;
        at->is_known = true;
        at->is_unaffected = fabs(s->a[i]) <= WRONG * s->largest;
    } else if (own > 0)
        at->side = s->a[i] < 0 ? -1 : 1;
}

/* `way` of a cone that is left along v, which its signs are where it has no load */
static void point_along(Search *s, int first, const double *v)
{
    const int count = s->at[first].cone;
    double norm = 0;

    for (int i = first; i < first + count; i++)
        norm = hypot(norm, v[i]);
    for (int i = first; i < first + count; i++) {
        s->way[i] = norm > 0 ? v[i] / norm : i == first;
        if (s->at[first].load < 0)
            s->signs[i] = s->way[i];
    }
}

/* The same of a cone: its side is known with a direction, or is 1 with one that is to be found. */
static void begin_cone(Search *s, int first)
{
    SurfaceSide *at = &s->at[first];
    double off = 0, own = 0, left = 0;

    for (int i = first; i < first + at->cone; i++) {
        off = hypot(off, s->at[i].off);
        left = hypot(left, s->a[i]);
        own = fmax(own, fabs(s->b[i * s->n + i]));
        s->earlier[i] = s->at[i].off;
    }
    at->is_known = at->is_unaffected = false;
    at->leaves = at->side != 0 && (s->insists || !at->ends);
    if (off > STILL * s->size) {
        at->is_known = true;
        point_along(s, first, s->earlier);
    } else if (own <= FLAT * s->largest) {
        at->is_known = true;
        at->is_unaffected = left <= WRONG * s->largest;
        point_along(s, first, s->a);
    }
    if (at->is_known)
        at->side = 1;
}

/* what is known before: which sides, and where no sign matters */
static void begin_sides(Search *s)
{
    for (int i = 0; i < s->n; i++) {
        if (s->at[i].cone == 0)
            begin_surface(s, i);
        else if (s->at[i].cone > 0)
            begin_cone(s, i);
    }
    for (int i = 1; i < s->n; i++)
        if (s->at[i].cone < 0) {
            s->at[i].is_known = s->at[i - 1].is_known;
            s->at[i].is_unaffected = s->at[i - 1].is_unaffected;
            s->at[i].side = s->at[i - 1].side;
        }
}

/* Those that aren't fixed, into `place`; the others have their signs. How many. */
static int place_free(Search *s)
{
    int count = 0;

    for (int i = 0; i < s->n; i++) {
        if (!s->at[i].is_fixed)
            s->place[count++] = i;
        else if (s->at[i].cone == 0 && s->at[i].load < 0)
            s->signs[i] = left_sign(s, i);
    }
    return count;
}

/* where among those that aren't fixed surface k is; -1: it is */
static int place_of(const Search *s, int count, int k)
{
    for (int i = 0; i < count; i++)
        if (s->place[i] == k)
            return i;
    return -1;
}

/* the share of surface k's load that its sign is, where it is fixed and that follows the load */
static double following_share(const Search *s, int k)
{
    const SurfaceSide *at = &s->at[k];

    if (!at->is_fixed || at->load < 0 || at->rests)
        return 0;
    return at->cone == 0 ? at->side * at->left : s->way[k] * at->left;
}

/* what fixed signs add to row i of the problem of `count`, whose own row of B is `row` */
static void add_fixed(Search *s, int i, int count, const double *row)
{
    for (int k = 0; k < s->n; k++) {
        const int load = s->at[k].load;

        if (!s->at[k].is_fixed)
            continue;
        if (load < 0)
            s->q[i] -= row[k] * s->signs[k];
        else if (!s->at[load].is_fixed)
            s->matrix[i * count + place_of(s, count, load)] -= row[k] * following_share(s, k);
    }
}

/* With bounds on norms: the signs as they are are first guesses. */
static bool solve_cones(Search *s, const Complementarity *box)
{
    const NormComplementarity problem = {
        .box = *box, .rows = s->rows, .load = s->load, .share = s->share, .slips = s->slips};

    for (int i = 0; i < box->n; i++) {
        const SurfaceSide *at = &s->at[s->place[i]];

        s->rows[i] = at->cone == 0 ? 1 : at->cone > 0 ? at->cone : 0;
        s->slips[i] = at->is_left;
        if (at->is_left)
            s->high[i] = s->share[i] = at->left;
        s->z[i] = s->signs[s->place[i]];
    }
    return norm_complementarity_solve(&problem, s->side, s->z, s->room);
}

static bool solve_in(Search *s, const Complementarity *box)
{
    const LoadComplementarity loaded = {*box, s->load, s->share};

    if (s->has_cones)
        return solve_cones(s, box);
    return s->has_loads ? load_complementarity_solve(&loaded, s->side, s->z, s->room, s->integers)
                        : complementarity_solve(box, s->side, s->z, s->room);
}

/* the sides and signs of those that aren't fixed, with the others as they are; false: none */
static bool solve_sides(Search *s)
{
    const int n = s->n;
    Complementarity problem = {0, s->matrix, s->q, s->low, s->high};

    problem.n = place_free(s);
    for (int i = 0; i < problem.n; i++) {
        const SurfaceSide *at = &s->at[s->place[i]];
        const double *row = s->b + s->place[i] * n;

        s->high[i] = high_of(at);
        s->low[i] = low_of(at);
        s->side[i] = at->side;
        s->load[i] = at->load >= 0 ? place_of(s, problem.n, at->load) : -1;
        s->share[i] = at->bound;
        if (at->load >= 0 && s->load[i] < 0) /* the load's surface is left: there is none */
            s->low[i] = s->high[i] = 0;
        s->q[i] = -s->a[s->place[i]];
        for (int k = 0; k < problem.n; k++)
            s->matrix[i * problem.n + k] = -row[s->place[k]];
        add_fixed(s, i, problem.n, row);
    }
    if (!solve_in(s, &problem))
        return false;
    for (int i = 0; i < problem.n; i++) {
        s->at[s->place[i]].side = s->side[i];
        s->signs[s->place[i]] = s->z[i];
    }
    for (int k = 0; k < n; k++)
        if (s->at[k].is_fixed && s->at[k].load >= 0)
            s->signs[k] = following_share(s, k) * s->signs[s->at[k].load];
    return true;
}

static double slip_of(const Search *s, int i)
{
    double slip = s->a[i];

    for (int k = 0; k < s->n; k++)
        slip += s->b[i * s->n + k] * s->signs[k];
    return slip;
}

/* Whether what is at its bound isn't left: others hold it, and its bound is that at rest. */
static bool is_kept(const Search *s, int first)
{
    const int count = s->at[first].cone > 0 ? s->at[first].cone : 1;

    for (int i = first; i < first + count; i++)
        if (fabs(slip_of(s, i)) > WRONG * s->largest)
            return false;
    return true;
}

/* Surfaces that are left have their kinetic sign. Whether any had another one. */
static bool leave(Search *s)
{
    bool any = false;

    for (int i = 0; i < s->n; i++) {
        SurfaceSide *at = &s->at[i];

        if (at->is_fixed || at->side == 0 || at->cone < 0 || is_kept(s, i))
            continue;
        if (at->cone > 0) { /* its direction is solved for again */
            any = any || (!at->is_left && at->bound != at->left);
            at->is_left = true;
        } else if (at->load >= 0 ? at->bound != at->left : s->signs[i] != left_sign(s, i)) {
            at->is_fixed = any = true;
            s->signs[i] = left_sign(s, i);
        }
    }
    return any;
}

/* Where the kinetic signs of others turn a surface back that was left, it is solved for again
 * beside them. Whether there is any. */
static bool reopen(Search *s)
{
    bool any = false;

    for (int i = 0; i < s->n; i++) {
        SurfaceSide *at = &s->at[i];

        if (!at->is_fixed || at->is_known || at->side * slip_of(s, i) >= -WRONG * s->largest)
            continue;
        at->is_fixed = false;
        at->side = 0;
        any = true;
    }
    return any;
}

static bool solve_problem(Search *s)
{
    bool found = false;

    for (int i = 0; i < s->n; i++) {
        s->at[i].is_fixed = s->at[i].is_known;
        if (s->at[i].cone > 0)
            s->at[i].is_left = s->at[i].is_known || s->at[i].leaves;
    }
    for (int turn = 0;; turn++) {
        do
            found = solve_sides(s);
        while (found && leave(s));
        if (!found || turn == s->n || !reopen(s))
            break;
    }
    return found;
}

/* Whether surface i can't be left while the motion slides along all surfaces of side 0: B_ii less
 * what these take of it, B_iS B_SS^-1 B_Si, is 0. */
static bool is_held(const Search *s, int i)
{
    const int n = s->n;
    double left = s->b[i * n + i];
    int between = 0;

    for (int k = 0, at = 0; k < n; k++) {
        if (s->at[k].side != 0)
            continue;
        s->z[between++] = s->b[k * n + i];
        for (int j = 0; j < n; j++)
            if (s->at[j].side == 0)
                s->matrix[at++] = s->b[k * n + j];
    }
    if (between == 0 || !complementarity_eliminate(s->matrix, between, s->z, REGULAR,
                                                   largest_of(s->matrix, between * between)))
        return false;
    for (int k = 0, at = 0; k < n; k++)
        if (s->at[k].side == 0)
            left -= s->b[i * n + k] * s->z[at++];
    return fabs(left) <= DEPENDENT * fabs(s->b[i * n + i]);
}

/* likewise of a cone: none of its surfaces can be left */
static bool is_cone_held(const Search *s, int first)
{
    const int count = s->at[first].cone > 0 ? s->at[first].cone : 1;

    for (int i = first; i < first + count; i++)
        if (!(s->b[i * s->n + i] < 0) ||
            (!s->at[i].settles && fabs(s->at[i].off) > STILL * s->size) || !is_held(s, i))
            return false;
    return true;
}

static void find_held(const Search *s)
{
    for (int i = 0; i < s->n; i++) {
        SurfaceSide *at = &s->at[i];

        at->held = at->cone < 0 ? s->at[i - 1].held : at->side != 0 && is_cone_held(s, i);
    }
}

/* whether the others are as before, but for what is held as well */
static bool is_as_before(const Search *s, int but)
{
    for (int i = 0; i < s->n; i++)
        if (i != but && s->at[i].side != s->before[i] && !(s->at[i].held && is_kept(s, i)))
            return false;
    return is_kept(s, but);
}

/* Of several parts that may hold a body those have no effort that aren't needed: what rests on its
 * corners isn't braced between them. */
static void ease(Search *s)
{
    for (int i = 0; i < s->n; i++) {
        SurfaceSide *at = &s->at[i];

        if (!at->held || at->load < 0 || at->cone != 0 || at->is_fixed)
            continue;
        for (int k = 0; k < s->n; k++) {
            s->before[k] = s->at[k].side;
            s->earlier[k] = s->signs[k];
        }
        at->rests = at->is_fixed = true;
        s->signs[i] = 0;
        if (solve_sides(s) && is_as_before(s, i))
            continue;
        at->rests = at->is_fixed = false;
        for (int k = 0; k < s->n; k++) {
            s->at[k].side = s->before[k];
            s->signs[k] = s->earlier[k];
        }
    }
}

static double *take(double **room, int count)
{
    double *out = *room;

    *room += count;
    return out;
}

static Search search_in(int n, double *room, int *integers)
{
    Search s = {.n = n};

    s.a = take(&room, n);
    s.b = take(&room, n * n);
    s.slip = take(&room, n);
    s.other = take(&room, n);
    s.signs = take(&room, n);
    s.matrix = take(&room, n * n);
    s.q = take(&room, n);
    s.low = take(&room, n);
    s.high = take(&room, n);
    s.z = take(&room, n);
    s.earlier = take(&room, n);
    s.share = take(&room, n);
    s.way = take(&room, n);
    s.room = room;
    s.place = integers;
    s.side = integers + n;
    s.before = integers + 2 * n;
    s.rows = integers + 3 * n;
    s.slips = integers + 4 * n;
    s.load = integers + 5 * n;
    s.integers = integers + 6 * n;
    return s;
}

bool surface_sides_find(SurfaceSide *at, int n, SurfaceSlip slip, void *context, bool insists,
                        double size, double *room, int *integers)
{
    Search s = search_in(n, room, integers);
    bool is_same = false;

    s.at = at;
    s.at_signs = slip;
    s.context = context;
    s.insists = insists;
    s.size = size;
    for (int i = 0; i < n; i++) {
        s.signs[i] = 0;
        at[i].rests = false;
        s.has_cones = s.has_cones || at[i].cone > 0;
        s.has_loads = s.has_loads || at[i].load >= 0;
    }
    /* the linear problem is formed anew around the signs, until the sides stay */
    for (int turn = 0; turn < REFINED && !is_same; turn++) {
        if (!find_slopes(&s))
            return false;
        if (turn == 0)
            begin_sides(&s);
        is_same = turn > 0;
        for (int i = 0; i < n; i++) {
            s.before[i] = at[i].side;
            s.earlier[i] = s.signs[i];
        }
        if (!solve_problem(&s))
            return false;
        for (int i = 0; i < n; i++)
            is_same = is_same && s.before[i] == at[i].side &&
                      (at[i].cone == 0 ||
                       fabs(s.earlier[i] - s.signs[i]) <= SAME * fmax(1, fabs(s.signs[i])));
        is_same = is_same || n == 1;
    }
    find_held(&s);
    if (is_same && s.has_loads)
        ease(&s);
    for (int i = 0; i < n; i++)
        if (at[i].cone > 0 && at[i].load >= 0 && at[i].side != 0 && !at[i].is_known)
            point_along(&s, i, s.signs);
    for (int i = 0; i < n; i++)
        at[i].sign = at[i].cone != 0 && at[i].load >= 0 && at[i].side != 0 ? s.way[i] : s.signs[i];
    return is_same;
}

/* share.c: charges and fluxes over a jump
 *
 * The states that a phase may have are x = P w + p, w its own. By Tellegen's theorem, impulses that
 * no source takes part in do no work on any change of w: P^T H (x - x0) = 0, H = d^2(energy)/dx^2.
 * Reciprocity is taken for granted in this; a step of vanishing length through the equations
 * themselves, from which sides are found, has to lead to the same states. */
#include "simulate/run/share.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define JUMP     1e-6  /* of the largest of its kind, more than location may change it, */
#define ERRORS   100   /* and of the tolerance: what errors may */
#define AGREE    1e-3  /* of the largest of its kind: the step has a length, and switches leak */
#define LONGEST  10000 /* and tries, up to this many times the step */
#define FREE     1e-9  /* of the largest: a state that its own ones move */
#define GAIN     1e-9  /* of the energy: rounding */
#define TOLD     3     /* times that are told one by one */
#define TOGETHER 6     /* names told of one time */

struct Shares {
    Probe *energy; /* and its second derivatives by states of the whole */
    bool is_known; /* it follows from states */
    int times;
    double lost; /* J */
};

void shares_free(Shares *shares)
{
    if (shares == NULL)
        return;
    probe_free(shares->energy);
    mem_free(shares);
}

/* --- kinds of states --- */

static const char *kind_of(const Layout *whole, int state)
{
    const char *name = system_x(whole->system, state)->name;
    const char *kind = strrchr(name, '.');

    return kind != NULL ? kind + 1 : name;
}

/* the largest voltage or current so far of any edge, as the state is the one or the other */
static double largest_like(const Result *r, const char *kind)
{
    double largest = 0;

    for (Domain domain = 0; domain < DOMAIN_COUNT; domain++) {
        if (strcmp(kind, domain_across(domain)) == 0)
            largest = fmax(largest, sides_largest(r->sides, domain, false));
        if (strcmp(kind, domain_through(domain)) == 0)
            largest = fmax(largest, sides_largest(r->sides, domain, true));
    }
    return largest;
}

bool share_is_jump(const Result *r, int state, double from, double to)
{
    return fabs(to - from) >
           JUMP * fmax(largest_like(r, kind_of(result_whole(r)->layout, state)), fabs(to)) +
               ERRORS * r->tolerance;
}

/* --- energy --- */

static bool open_shares(Result *r)
{
    const Layout *l = result_whole(r)->layout;
    Arena *arena = system_arena(l->system);
    const Expr energy = expr_add(arena, system_kinetic(l->system), system_potential(l->system));
    LIST(Expr) roots = {0};

    if (r->shares != NULL)
        return r->shares->is_known;
    r->shares = NEW(Shares);
    r->shares->is_known = true;
    LIST_PUSH(roots, energy);
    for (int i = 0; i < l->nx; i++) {
        const Expr slope = expr_diff(arena, energy, l->symbols[l->x + i]);

        for (int j = 0; j < l->nx; j++)
            LIST_PUSH(roots, expr_diff(arena, slope, l->symbols[l->x + j]));
    }
    for (int i = 0; i < roots.count; i++)
        if ((expr_kinds(roots.at[i]) & 1U << SYMBOL_ALGEBRAIC) != 0)
            r->shares->is_known = false;
    if (r->shares->is_known)
        r->shares->is_known =
            probe_new(l, &r->parameters, roots.at, roots.count, &r->shares->energy, NULL) == OK;
    LIST_FREE(roots);
    return r->shares->is_known;
}

/* then its second derivatives, row by row; borrowed until the next call */
static const double *energy_at(const Result *r, const Phase *phase, double t, const double *y,
                               const double *x)
{
    const Layout *l = result_whole(r)->layout;
    const RowValues row = {
        .t = t, .near = y + layout_turned(phase->layout), .q = y, .u = y + l->n, .x = x};

    return probe_values(r->shares->energy, &row);
}

/* --- sharing --- */

/* P, a row for each state of the whole, by the phase's own; false: no solution */
static bool find_moves(Phase *phase, double t, double *y, const double *x, int nx, double *moves)
{
    const Layout *l = phase->layout;
    double *moved = NEW_ARRAY(double, nx);
    double *base = NEW_ARRAY(double, nx);
    const double size = fmax(1, vector_largest(x, nx));
    RowValues row;
    bool sound = phase_states(phase, t, y, nx, &row, base);

    for (int j = 0; j < l->nx && sound; j++) {
        double *own = &y[l->n + l->nu + j];
        const double was = *own;

        *own += size;
        sound = phase_states(phase, t, y, nx, &row, moved);
        *own = was;
        for (int i = 0; i < nx; i++)
            moves[i * l->nx + j] = (moved[i] - base[i]) / size;
    }
    mem_free(moved);
    mem_free(base);
    return sound;
}

/* M dw = P^T H (x0 - x), M = P^T H P; states without energy stay */
static bool find_shares(const double *moves, const double *energy, const double *missed, int nx,
                        int own, double *change)
{
    Lu *lu = lu_new(own);
    double *mass = NEW_ARRAY(double, own *own);
    double *scale = NEW_ARRAY(double, own);
    double *held = NEW_ARRAY(double, nx); /* a row of P^T H */
    bool sound;

    for (int j = 0; j < own; j++) {
        memset(held, 0, (size_t)nx * sizeof(double));
        change[j] = 0;
        for (int i = 0; i < nx; i++)
            for (int k = 0; k < nx && moves[i * own + j] != 0; k++)
                held[k] += moves[i * own + j] * energy[i * nx + k];
        for (int k = 0; k < nx; k++) {
            change[j] += held[k] * missed[k];
            for (int i = 0; i < own; i++)
                mass[j * own + i] += held[k] * moves[k * own + i];
        }
    }
    for (int j = 0; j < own; j++)
        scale[j] = mass[j * own + j] > 0 ? 1 / sqrt(mass[j * own + j]) : 0;
    for (int j = 0; j < own; j++)
        for (int i = 0; i < own; i++)
            lu_matrix(lu)[j * own + i] =
                scale[j] > 0 && scale[i] > 0 ? scale[j] * scale[i] * mass[j * own + i] : i == j;
    for (int j = 0; j < own; j++)
        change[j] *= scale[j];
    sound = lu_factor(lu);
    if (sound)
        lu_solve(lu, change);
    for (int j = 0; j < own; j++)
        change[j] *= scale[j];
    lu_free(lu);
    mem_free(mass);
    mem_free(scale);
    mem_free(held);
    return sound && vector_is_finite(change, own);
}

/* whether each state that jumps is moved by others that are stored, not by sources alone */
static bool are_shared(const Result *r, const double *moves, const double *x, const double *now,
                       int own)
{
    const Layout *whole = result_whole(r)->layout;

    for (int i = 0; i < whole->nx; i++)
        if (share_is_jump(r, i, x[i], now[i]) &&
            !(own > 0 && vector_largest(moves + (ptrdiff_t)i * own, own) > FREE))
            return false;
    return true;
}

/* whether the equations lead there within a short time, and no source has a part in it */
static bool is_led_to(const Result *r, double step, const double *x, const double *now)
{
    const Layout *whole = result_whole(r)->layout;
    double *landed = NEW_ARRAY(double, whole->nx);
    double longer = 0.1;
    bool met = false;

    while (longer < LONGEST && !met) {
        longer *= 10;
        met = sides_land(r->sides, longer * step, landed);
        for (int i = 0; i < whole->nx && met; i++) {
            double size = 0;

            for (int k = 0; k < whole->nx; k++)
                if (strcmp(kind_of(whole, k), kind_of(whole, i)) == 0)
                    size = fmax(size, fmax(fabs(x[k]), fabs(now[k])));
            met = fabs(landed[i] - now[i]) <= AGREE * size + ERRORS * r->tolerance;
        }
    }
    mem_free(landed);
    return met && sides_source(r->sides, longer * step) == NULL;
}

/* --- what is said --- */

/* "C1 and C2 share their charge" */
static void tell_sharers(const Result *r, const double *x, const double *now, Text *out)
{
    const Layout *whole = result_whole(r)->layout;
    bool charge = false, flux = false;
    int count = 0, said = 0;

    for (int i = 0; i < whole->nx; i++)
        count += share_is_jump(r, i, x[i], now[i]);
    for (int i = 0; i < whole->nx && said < TOGETHER; i++) {
        const char *name = system_x(whole->system, i)->name;
        const char *kind = kind_of(whole, i);

        if (!share_is_jump(r, i, x[i], now[i]))
            continue;
        charge = charge || strcmp(kind, domain_across(DOMAIN_ELECTRICAL)) == 0;
        flux = flux || strcmp(kind, domain_through(DOMAIN_ELECTRICAL)) == 0;
        text_addf(out, "%s%.*s",
                  said == 0           ? ""
                  : said + 1 == count ? " and "
                                      : ", ",
                  (int)(kind - name - (kind > name)), name);
        said++;
    }
    text_addf(out, "%s share %s", count > said ? " ..." : "",
              charge && !flux   ? "their charge"
              : flux && !charge ? "their flux"
                                : "what they store");
}

static void tell(Result *r, const char *sides, double t, double lost, const double *x,
                 const double *now)
{
    r->shares->lost += lost;
    if (r->shares->times++ >= TOLD)
        return;
    text_addf(&r->remarks, "%s at t = %.9g s: ", sides, t);
    tell_sharers(r, x, now, &r->remarks);
    text_addf(&r->remarks, ", %.6g J are lost\n", lost);
}

void share_tell(Result *r)
{
    if (r->shares != NULL && r->shares->times > TOLD)
        text_addf(&r->remarks, "ideal switches do so %d more times: %.6g J are lost in all\n",
                  r->shares->times - TOLD, r->shares->lost);
}

bool share_stored(Result *r, Phase *phase, double t, double step, const char *sides, double *y,
                  double *x)
{
    const int nx = result_whole(r)->layout->nx, own = phase->layout->nx;
    double *at = y + phase->layout->n + phase->layout->nu;
    double *moves = NEW_ARRAY(double, nx *own);
    double *change = NEW_ARRAY(double, own);
    double *missed = NEW_ARRAY(double, nx);
    double *now = NEW_ARRAY(double, nx);
    double before = 0, behind = 0;
    RowValues row;
    bool met = open_shares(r) && find_moves(phase, t, y, x, nx, moves) &&
               phase_states(phase, t, y, nx, &row, now);

    for (int i = 0; i < nx && met; i++)
        missed[i] = x[i] - now[i];
    met = met && find_shares(moves, energy_at(r, phase, t, y, x) + 1, missed, nx, own, change);
    for (int i = 0; i < own && met; i++)
        at[i] += change[i];
    if (met) {
        before = energy_at(r, phase, t, y, x)[0];
        met = phase_states(phase, t, y, nx, &row, now) && are_shared(r, moves, x, now, own) &&
              is_led_to(r, step, x, now);
        behind = energy_at(r, phase, t, y, now)[0];
        met = met && behind - before <= GAIN * fabs(before);
        if (!met)
            for (int i = 0; i < own; i++)
                at[i] -= change[i];
    }
    if (met) {
        tell(r, sides, t, before - behind, x, now);
        y[phase->length - 1] += behind - before;
        memcpy(x, now, (size_t)nx * sizeof(double));
    }
    mem_free(moves);
    mem_free(change);
    mem_free(missed);
    mem_free(now);
    return met;
}

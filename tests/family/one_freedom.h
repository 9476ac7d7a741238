/* one_freedom.h: the motion of a mechanism of one freedom, from where its masses are
 *
 * Whoever asks places point masses as functions of one variable phi, in closed form. With p' and
 * p'' their derivatives by phi, Lagrange's equation is
 *
 *     (sum m p'.p') phi_tt + (sum m p'.p'') phi_t^2 = sum m g.p'
 *
 * No constraint, no multiplier and no projection occurs. A rod of mass m is three of them: m/6 at
 * its ends, 2m/3 in the middle have its inertia. */
#ifndef COTREE_TESTS_ONE_FREEDOM_H
#define COTREE_TESTS_ONE_FREEDOM_H

#include "extrapolated.h"

/* a value with its first two derivatives by phi */
typedef struct Jet {
    Real v, d, dd;
} Jet;

static inline Jet jet(Real v)
{
    return (Jet){v, 0, 0};
}

static inline Jet plus(Jet a, Jet b)
{
    return (Jet){a.v + b.v, a.d + b.d, a.dd + b.dd};
}

static inline Jet scaled(Real s, Jet a)
{
    return (Jet){s * a.v, s * a.d, s * a.dd};
}

static inline Jet minus(Jet a, Jet b)
{
    return plus(a, scaled(-1, b));
}

static inline Jet times(Jet a, Jet b)
{
    return (Jet){a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}

/* f(a), f given by its value and derivatives at a.v */
static inline Jet chain(Jet a, Real f, Real d, Real dd)
{
    return (Jet){f, d * a.d, dd * a.d * a.d + d * a.dd};
}

static inline Jet jet_sin(Jet a)
{
    return chain(a, sinl(a.v), cosl(a.v), -sinl(a.v));
}

static inline Jet jet_cos(Jet a)
{
    return chain(a, cosl(a.v), -sinl(a.v), -cosl(a.v));
}

static inline Jet jet_sqrt(Jet a)
{
    const Real r = sqrtl(a.v);

    return chain(a, r, 0.5L / r, -0.25L / (r * a.v));
}

static inline Jet over(Jet a, Jet b)
{
    return times(a, chain(b, 1 / b.v, -1 / (b.v * b.v), 2 / (b.v * b.v * b.v)));
}

typedef struct Spot {
    Jet at[3];
} Spot;

static inline Spot spot(Jet x, Jet y)
{
    return (Spot){{x, y, {0, 0, 0}}};
}

/* a + s (b - a) */
static inline Spot part_way(Spot a, Spot b, Real s)
{
    Spot out;

    for (int i = 0; i < 3; i++)
        out.at[i] = plus(scaled(1 - s, a.at[i]), scaled(s, b.at[i]));
    return out;
}

enum { MOST_MASSES = 640 };
typedef struct Masses {
    int count;
    Real mass[MOST_MASSES];
    Spot spot[MOST_MASSES];
} Masses;

static inline void add_mass(Masses *masses, Real mass, Spot at)
{
    masses->mass[masses->count] = mass;
    masses->spot[masses->count++] = at;
}

static inline void add_rod(Masses *masses, Real mass, Spot a, Spot b)
{
    add_mass(masses, mass / 6, a);
    add_mass(masses, mass * 2 / 3, part_way(a, b, 0.5L));
    add_mass(masses, mass / 6, b);
}

typedef struct OneFreedom {
    void (*place)(const void *mechanism, Jet phi, Masses *out);
    const void *mechanism;
    Real gravity[3];
} OneFreedom;

static Real phi_acceleration(const OneFreedom *one, Real phi, Real rate)
{
    static Masses masses;
    Real inertia = 0, bend = 0, force = 0;

    masses.count = 0;
    one->place(one->mechanism, (Jet){phi, 1, 0}, &masses);
    for (int k = 0; k < masses.count; k++)
        for (int i = 0; i < 3; i++) {
            const Jet p = masses.spot[k].at[i];

            inertia += masses.mass[k] * p.d * p.d;
            bend += masses.mass[k] * p.d * p.dd;
            force += masses.mass[k] * one->gravity[i] * p.d;
        }
    return (force - bend * rate * rate) / inertia;
}

static void phi_rates(const void *context, const Real *y, Real *rates)
{
    rates[0] = y[1];
    rates[1] = phi_acceleration(context, y[0], y[1]);
}

/* phi and its rate after `time`, or at the end of the step in which phi has gone `far`, to some
 * 1e-15 a step; the time reached */
static Real one_freedom_run(const OneFreedom *one, Real time, Real far, Real *phi, Real *rate)
{
    const Extrapolation by = {.rates = phi_rates, .context = one, .count = 2, .enough = 1e-15L};
    const Real from = *phi;
    Real y[2] = {*phi, *rate}, at = 0, step = 1e-3L * time;

    while (at < time && fabsl(y[0] - from) < far)
        at += extrapolated_step(&by, time - at, &step, y);
    *phi = y[0];
    *rate = y[1];
    return at;
}

#endif

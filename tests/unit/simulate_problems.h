/* simulate_problems.h: small systems written by hand, for tests of what stands below formulation
 *
 * Each problem_* fills a Problem whose equations run without a model. */
#ifndef COTREE_TESTS_SIMULATE_PROBLEMS_H
#define COTREE_TESTS_SIMULATE_PROBLEMS_H

#include "simulate/equations/motion.h"

#include <math.h>
#include <string.h>

typedef struct Problem {
    Equations eq;
    double phi[8], phi_u[8 * 8], mass[8 * 8], map[8 * 8], q_rate[8], nu_rate[8], gamma[8];
    double network[4], network_rhs[2], force[8], power[1];
    double q[8], u[8], x[2], t;
    int rows[8], network_places[8];
    Pattern row_places, mass_places; /* of full matrices */
    int start[9], row[64], column[64];
} Problem;

static void problem_link(Problem *p, int n, int nu, int m, int nx)
{
    p->eq.n = n;
    p->eq.nu = nu;
    p->eq.m = m;
    p->eq.nx = nx;
    p->eq.context = p;
    p->eq.phi = p->phi;
    p->eq.phi_u = p->phi_u;
    p->eq.mass = p->mass;
    for (int k = 0; k <= nu; k++)
        p->start[k] = k * nu;
    for (int k = 0; k < nu * nu; k++) {
        p->row[k] = k % nu;
        p->column[k] = k / nu;
    }
    p->mass_places = (Pattern){nu, nu, nu * nu, p->start, p->row, p->column};
    p->row_places = (Pattern){nu, m, nu * m, p->start, p->row, p->column};
    p->eq.rows = &p->row_places;
    p->eq.masses = &p->mass_places;
    p->eq.q_rate = p->q_rate;
    p->eq.nu_rate = p->nu_rate;
    p->eq.gamma = p->gamma;
    for (int i = 0; i < nx * nx; i++) {
        p->network_places[i] = i / nx;
        p->network_places[4 + i] = i % nx;
    }
    p->eq.network_entries = nx * nx;
    p->eq.network_row = p->network_places;
    p->eq.network_column = p->network_places + 4;
    p->eq.network = p->network;
    p->eq.network_rhs = p->network_rhs;
    p->eq.force = p->force;
    p->eq.power = p->power;
    for (int k = 0; k < 8; k++)
        p->rows[k] = k;
}

static void keep_position(Problem *p, double t, const double *q)
{
    p->t = t;
    memcpy(p->q, q, (size_t)p->eq.n * sizeof(double));
}

static void keep_velocity(Problem *p, const double *u, const double *x)
{
    memcpy(p->u, u, (size_t)p->eq.nu * sizeof(double));
    if (p->eq.nx > 0)
        memcpy(p->x, x, (size_t)p->eq.nx * sizeof(double));
    if (p->eq.map == NULL)
        memcpy(p->q_rate, u, (size_t)p->eq.n * sizeof(double));
}

static inline void no_network(void *context, const double *solved)
{
    (void)context;
    (void)solved;
}

/* --- y'' = -y, without constraints; q = (y) --- */

static inline void spring_position(void *context, double t, const double *q)
{
    Problem *p = context;

    keep_position(p, t, q);
    p->mass[0] = 1;
}

static inline void spring_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;

    keep_velocity(p, u, x);
    p->force[0] = -p->q[0];
}

static inline void problem_spring(Problem *p)
{
    memset(p, 0, sizeof *p);
    problem_link(p, 1, 1, 0, 0);
    p->eq.position = spring_position;
    p->eq.velocity = spring_velocity;
    p->eq.network_solved = no_network;
}

/* --- pendulum of reference A01 in absolute coordinates: q = (x, y, theta), massless rod of 1 m,
 * 1 kg, pin at the origin; `twice` repeats the first row --- */

static inline void pendulum_position(void *context, double t, const double *q)
{
    Problem *p = context;
    double s = sin(q[2]), c = cos(q[2]);
    const double rows[9] = {1, 0, -c, 0, 1, -s, 1, 0, -c};

    keep_position(p, t, q);
    p->mass[0] = p->mass[4] = 1;
    p->phi[0] = p->phi[2] = q[0] - s;
    p->phi[1] = q[1] + c;
    memcpy(p->phi_u, rows, sizeof rows);
}

static inline void pendulum_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;
    double s = sin(p->q[2]), c = cos(p->q[2]), w2 = u[2] * u[2];

    keep_velocity(p, u, x);
    p->gamma[0] = p->gamma[2] = -s * w2;
    p->gamma[1] = c * w2;
    p->force[1] = -9.81;
    p->power[0] = 0;
}

static inline void problem_pendulum(Problem *p, bool twice)
{
    memset(p, 0, sizeof *p);
    problem_link(p, 3, 3, twice ? 3 : 2, 0);
    p->eq.position = pendulum_position;
    p->eq.velocity = pendulum_velocity;
    p->eq.network_solved = no_network;
}

/* --- one four-bar of reference A02: q = angles of the two cranks from upright and of the coupler
 * --- */

static inline void four_bar_position(void *context, double t, const double *q)
{
    Problem *p = context;
    double s0 = sin(q[0]), c0 = cos(q[0]), s1 = sin(q[1]), c1 = cos(q[1]), sk = sin(q[2]),
           ck = cos(q[2]);
    /* B0 = (-s0, c0), B1 = (1 - s1, c1); B0 + (ck, sk) = B1 */
    const double rows[6] = {-c0, c1, -sk, -s0, s1, ck};

    keep_position(p, t, q);
    p->phi[0] = -s0 + ck - 1 + s1;
    p->phi[1] = c0 + sk - c1;
    memcpy(p->phi_u, rows, sizeof rows);
    /* coupler centre: B0 + (ck, sk)/2 */
    p->mass[0] = 1 / 3.0 + 1;
    p->mass[4] = 1 / 3.0;
    p->mass[8] = 1 / 12.0 + 0.25;
    p->mass[2] = p->mass[6] = 0.5 * (c0 * sk - s0 * ck);
}

static inline void four_bar_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;
    double s0 = sin(p->q[0]), c0 = cos(p->q[0]), s1 = sin(p->q[1]), c1 = cos(p->q[1]),
           sk = sin(p->q[2]), ck = cos(p->q[2]), g = 9.81;
    double a0 = u[0] * u[0], a1 = u[1] * u[1], ak = u[2] * u[2];
    /* acceleration of the coupler's centre that is left without u' */
    double bx = s0 * a0 - 0.5 * ck * ak, by = -c0 * a0 - 0.5 * sk * ak;

    keep_velocity(p, u, x);
    p->gamma[0] = -(s0 * a0 - ck * ak - s1 * a1);
    p->gamma[1] = -(-c0 * a0 - sk * ak + c1 * a1);
    p->force[0] = g * s0 / 2 + g * s0 - (bx * -c0 + by * -s0);
    p->force[1] = g * s1 / 2;
    p->force[2] = -g * ck / 2 - (bx * -sk / 2 + by * ck / 2);
    p->power[0] = 0;
}

static inline void problem_four_bar(Problem *p)
{
    memset(p, 0, sizeof *p);
    problem_link(p, 3, 3, 2, 0);
    p->eq.position = four_bar_position;
    p->eq.velocity = four_bar_velocity;
    p->eq.network_solved = no_network;
}

/* --- a mass pushed by a current: m s'' = i, L i' = v(t) - R i; v is 1 V up to 0.5 s, then -1 V;
 * with L small it is stiff --- */

static inline double coil_voltage(double t)
{
    return t < 0.5 ? 1 : -1;
}

static inline void coil_position(void *context, double t, const double *q)
{
    Problem *p = context;

    keep_position(p, t, q);
    p->mass[0] = 1;
}

static inline void coil_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;

    keep_velocity(p, u, x);
    p->network_rhs[0] = coil_voltage(p->t) - x[0];
}

static inline void coil_solved(void *context, const double *solved)
{
    Problem *p = context;

    (void)solved;
    p->force[0] = p->x[0];
    p->power[0] = p->x[0] * p->u[0];
}

static inline void coil_switches(void *context, double t, const double *q, const double *u,
                                 const double *x, double *out)
{
    (void)context;
    (void)q;
    (void)u;
    (void)x;
    out[0] = t - 0.5;
}

static inline void problem_coil(Problem *p, double inductance)
{
    memset(p, 0, sizeof *p);
    problem_link(p, 1, 1, 0, 1);
    p->network[0] = inductance;
    p->eq.position = coil_position;
    p->eq.velocity = coil_velocity;
    p->eq.network_solved = coil_solved;
    p->eq.switches = coil_switches;
    p->eq.switch_count = p->eq.time_only = 1;
}

/* --- a force that jumps with the place: s'' = -1 above s = 0, +1 below: a bouncing that never
 * loses energy, period 8 sqrt(2 s0) quarters --- */

static inline void valley_velocity(void *context, const double *u, const double *x)
{
    Problem *p = context;

    keep_velocity(p, u, x);
    p->force[0] = p->q[0] > 0 ? -1 : 1;
}

static inline void valley_switches(void *context, double t, const double *q, const double *u,
                                   const double *x, double *out)
{
    (void)context;
    (void)t;
    (void)u;
    (void)x;
    out[0] = q[0];
}

static inline void problem_valley(Problem *p)
{
    memset(p, 0, sizeof *p);
    problem_link(p, 1, 1, 0, 0);
    p->eq.position = coil_position;
    p->eq.velocity = valley_velocity;
    p->eq.network_solved = no_network;
    p->eq.switches = valley_switches;
    p->eq.switch_count = 1;
}

#endif

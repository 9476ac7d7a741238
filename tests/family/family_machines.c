/* family_machines.c: machines of several domains, whole ways through the language, against
 * equations of another kind
 *
 * Random mechanisms in the plane and in space, with loops, springs, dampers, forces, motors and
 * their kin, networks of up to four domains and controllers, in any tree, form and method: what is
 * told of their runs is held against the oracle of machine.h. */
#include "machine_whole.h"

#include <complex.h>
#undef I
#define IMAGINARY _Complex_I

/* what all parts give and take adds up, in joules beside the largest stored energy */
static bool energy_balances(Member *member, const Kit *kit)
{
    ct_figures f;

    if (!ct_run_figures(kit->session, 0, &f))
        return false;
    return keeps(member, "energy drift", f.energy_drift / (1 + f.energy_scale), 1e-6);
}

/* Whether what the session tells at an instant, the run's as it was, is the oracle's, which goes
 * there from *from. */
static Verdict told_at(Member *member, Kit *kit, const Drawn *d, double *from, double at, Real *y)
{
    static Asks asks;

    if (oracle_answers(d, *from, at, y, &asks) != AGREES)
        return REFUSED;
    *from = at;
    return compare(member, kit, &asks, at, 1e-6);
}

/* A run, what goes on from it, and what is asked of it once the trees are others. */
static Verdict machine_moves(Member *member)
{
    static Drawn d;
    Kit kit = kit_new();
    Real y[MOST_STATES];
    double at = 0;
    Verdict verdict = AGREES;

    while (!draw_machine(member, &d))
        ;
    draw_tree(member, &d, member_one_of(member, 3));
    if (chance(member, 0.2))
        write_line(&d.script, "form embedded");
    write_line(&d.script, "simulate 0.5 every=0.1 rtol=1e-9 atol=1e-11 method=%s",
               draw_method(member));
    memcpy(y, d.y, sizeof y);
    if (do_told(member, &kit, d.script.text) != CT_OK)
        verdict = REFUSED;
    else if (!energy_balances(member, &kit))
        verdict = DISAGREES;
    for (int part = 0; part < 3 && verdict == AGREES; part++)
        verdict = told_at(member, &kit, &d, &at, 0.2 * part, y);
    if (verdict == AGREES) {
        d.script.length = 0;
        draw_tree(member, &d, member_one_of(member, 3));
        verdict = do_told(member, &kit, d.script.text) == CT_OK
                      ? told_at(member, &kit, &d, &at, 0.5, y)
                      : REFUSED;
    }
    if (verdict == AGREES && do_told(member, &kit, "resume 0.3\n") == CT_OK)
        verdict = told_at(member, &kit, &d, &at, 0.75, y);
    kit_free(&kit);
    return verdict;
}

/* The largest error of coordinates and their rates at the end of a run; *size becomes the largest
 * of these where that is more. */
static double largest_error(const Machine *m, const Instant *now, Kit *kit, double *size)
{
    double error = 0;

    for (int c = 0; c < m->coordinates; c++) {
        const double rate = coordinate_row(m, now, c).rate;
        char text[40];

        error = fmax(error, fabs(kit_value(kit, m->coordinate[c].name) - now->q[c]));
        (void)snprintf(text, sizeof text, "%s'", m->coordinate[c].name);
        error = fmax(error, fabs(kit_value(kit, text) - rate));
        *size = fmax(*size, fmax(fabs(now->q[c]), fabs(rate)));
    }
    return error;
}

/* What a run says of its own error at a coarse tolerance is not too low. */
static Verdict machine_tells_its_error(Member *member)
{
    static Drawn d;
    static Instant now;
    Kit kit = kit_new();
    Real y[MOST_STATES];
    ct_figures f;
    Verdict verdict = AGREES;
    double error = 0, size = 1;

    while (!draw_machine(member, &d))
        ;
    draw_tree(member, &d, member_one_of(member, 3));
    write_line(&d.script, "simulate 0.8 every=0.1 rtol=%.3g method=%s check=on",
               member_decades(member, 1e-7, 1e-4), draw_method(member));
    memcpy(y, d.y, sizeof y);
    if (do_told(member, &kit, d.script.text) != CT_OK || !oracle_runs(&d, 0, 0.8, y) ||
        !ct_run_figures(kit.session, 0, &f) || isnan(f.global_error))
        verdict = REFUSED;
    unpack(&d.m, y, &now);
    if (verdict == AGREES)
        error = largest_error(&d.m, &now, &kit, &size);
    if (verdict == AGREES &&
        !keeps(member, "error of what is told", error / (f.global_error + 1e-9), 10))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

/* Errors of methods with a history add up from step to step. */
static Verdict history_is_accurate(Member *member)
{
    static const char *const methods[] = {"bdf", "adams", "ida"};
    static Drawn d;
    static Instant now;
    Kit kit = kit_new();
    Real y[MOST_STATES];
    const double rtol = member_decades(member, 1e-8, 1e-5);
    double error = 0, size = 1;
    Verdict verdict = AGREES;

    while (!draw_machine(member, &d))
        ;
    draw_tree(member, &d, member_one_of(member, 3));
    write_line(&d.script, "simulate 0.8 every=0.1 rtol=%.3g method=%s", rtol,
               methods[member_one_of(member, 3)]);
    memcpy(y, d.y, sizeof y);
    if (do_told(member, &kit, d.script.text) != CT_OK || !oracle_runs(&d, 0, 0.8, y))
        verdict = REFUSED;
    unpack(&d.m, y, &now);
    if (verdict == AGREES)
        error = largest_error(&d.m, &now, &kit, &size);
    if (verdict == AGREES && !keeps(member, "error in tolerances", error / (rtol * size), 100))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

/* --- rest --- */

/* what the session tells of a state, at rest */
static void take_rest(const Drawn *d, Kit *kit, Real *y)
{
    const Machine *m = &d->m;
    static const char *const frame[] = {"x", "y", "z", "q0", "q1", "q2", "q3"};
    char text[64];

    memset(y, 0, MOST_STATES * sizeof *y);
    for (int b = 0; b < m->bodies; b++) {
        for (int k = 0; k < 7; k++) {
            (void)snprintf(text, sizeof text, "b%d.%s", b, frame[k]);
            if (!m->planar || k < 2)
                y[13 * b + k] = kit_value(kit, text);
        }
        if (m->planar) {
            (void)snprintf(text, sizeof text, "b%d.theta", b);
            y[13 * b + 3] = cos(kit_value(kit, text) / 2);
            y[13 * b + 6] = sin(kit_value(kit, text) / 2);
        }
    }
    y += 13 * m->bodies;
    for (int i = 0; i < m->coordinates; i++)
        *y++ = kit_value(kit, m->coordinate[i].name);
    for (int i = 0; i < m->elements; i++) {
        const Element *e = &m->element[i];
        static const char *const effort[] = {"v", "w", "v", "p"}, *const flow[] = {"i", "torque",
                                                                                   "force", "flow"};
        const int domain = m->node_domain[e->p];

        if (e->state < 0 || !e->first)
            continue;
        if (e->kind == LAG)
            (void)snprintf(text, sizeof text, "%s.x", e->name);
        else if (e->kind == SPRING_DAMPER)
            (void)snprintf(text, sizeof text, "%s.%s", e->name,
                           domain == SLIDE ? "deflection" : "twist");
        else if (e->kind == CAPACITY || e->kind == PLATE || e->kind == PIEZO)
            (void)snprintf(text, sizeof text, "%s.%s", e->name, effort[domain]);
        else
            (void)snprintf(text, sizeof text, "%s.%s", e->name, flow[domain]);
        y[e->state] = kit_value(kit, text);
    }
}

/* distance from a number to the nearest eigenvalue of J, by inverse iteration */
static double miss(const double *J, int n, double complex number)
{
    static double complex a[STATES][STATES + 1];
    double complex x[STATES];
    double away = INFINITY;

    for (int i = 0; i < n; i++)
        x[i] = 1 + 0.37 * ((i * 7919) % 13) - 0.2 * IMAGINARY * ((i * 104729) % 7);
    for (int sweep = 0; sweep < 6; sweep++) {
        double length = 0;

        for (int i = 0; i < n; i++)
            length += creal(x[i] * conj(x[i]));
        for (int i = 0; i < n; i++) {
            x[i] /= sqrt(length);
            a[i][n] = x[i];
            for (int k = 0; k < n; k++)
                a[i][k] = J[i * n + k] - (i == k ? number : 0);
        }
        for (int c = 0; c < n; c++) {
            int best = c;

            for (int r = c + 1; r < n; r++)
                best = cabs(a[r][c]) > cabs(a[best][c]) ? r : best;
            for (int k = 0; k <= n; k++) {
                const double complex held = a[c][k];

                a[c][k] = a[best][k];
                a[best][k] = held;
            }
            if (a[c][c] == 0)
                return 0;
            for (int r = c + 1; r < n; r++) {
                const double complex factor = a[r][c] / a[c][c];

                for (int k = c; k <= n && factor != 0; k++)
                    a[r][k] -= factor * a[c][k];
            }
        }
        length = 0;
        for (int r = n - 1; r >= 0; r--) {
            for (int k = r + 1; k < n; k++)
                a[r][n] -= a[r][k] * x[k];
            x[r] = a[r][n] / a[r][r];
            length += creal(x[r] * conj(x[r]));
        }
        away = fmin(away, 1 / sqrt(length));
    }
    return away;
}

/* d rates/d y by central differences */
static void slopes(const Drawn *d, const Real *y, double *J, int n)
{
    Real at[MOST_STATES], up[MOST_STATES], down[MOST_STATES];

    memcpy(at, y, sizeof at);
    for (int k = 0; k < n; k++) {
        const Real h = 1e-5L * (1 + fabsl(y[k]));

        at[k] = y[k] + h;
        machine_rates(&d->m, at, up);
        at[k] = y[k] - h;
        machine_rates(&d->m, at, down);
        at[k] = y[k];
        for (int i = 0; i < n; i++)
            J[i * n + k] = (double)((up[i] - down[i]) / (2 * h));
    }
}

/* whether each mode that is told is one of the oracle's */
static Verdict modes_are_known(Member *member, Kit *kit, const Drawn *d, const Real *y)
{
    static double J[STATES * STATES];
    const int n = machine_size(&d->m) - 1;

    if (do_told(member, kit, "modes\n") != CT_OK)
        return REFUSED;
    slopes(d, y, J, n);
    for (int k = 1; k < 12; k++) {
        char text[120];
        double omega, damping;
        double complex root;

        (void)snprintf(text, sizeof text, "modes.omega(%d)", k);
        omega = kit_value(kit, text);
        (void)snprintf(text, sizeof text, "modes.damping(%d)", k);
        damping = kit_value(kit, text);
        if (isnan(omega))
            break;
        if (fabs(damping) > 1 - 1e-6)
            continue; /* one of two real ones */
        root = omega * (-damping + IMAGINARY * sqrt(1 - damping * damping));
        (void)snprintf(text, sizeof text, "mode %d, %.9g %+.9gi", k, creal(root), cimag(root));
        if (!keeps(member, text, miss(J, n, root) / (1 + omega), 1e-5))
            return DISAGREES;
    }
    return AGREES;
}

/* Where a machine rests nothing accelerates, and its modes are among those of the parts. */
static Verdict machine_rests(Member *member)
{
    static Drawn d;
    static Instant now;
    Kit kit = kit_new();
    Real y[MOST_STATES], rates[MOST_STATES];
    Verdict verdict = AGREES;
    double most = 0;
    int n;

    still = true;
    while (!draw_machine(member, &d))
        ;
    still = false;
    n = machine_size(&d.m) - 1;
    draw_tree(member, &d, member_one_of(member, 3));
    write_line(&d.script, "equilibrium");
    if (do_told(member, &kit, d.script.text) != CT_OK) {
        kit_free(&kit);
        return REFUSED;
    }
    take_rest(&d, &kit, y);
    unpack(&d.m, y, &now);
    if (!instant_solve(&d.m, &now)) {
        kit_free(&kit);
        return REFUSED;
    }
    machine_rates(&d.m, y, rates);
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs((double)rates[i]) /
                              (i < n - d.m.states ? 1 : 1 + 1e4 * (fabs((double)y[i]) > 1e2)));
    if (!keeps(member, "rates at rest", most, 1e-6))
        verdict = DISAGREES;
    if (verdict == AGREES)
        verdict = modes_are_known(member, &kit, &d, y);
    kit_free(&kit);
    return verdict;
}

/* --- driven --- */

/* whether the efforts that are told at t make the parts go along their paths */
static Verdict efforts_move(Member *member, Kit *kit, Drawn *d, const Wave *path, double t)
{
    static Instant now;
    static Asks asks;
    Machine *m = &d->m;
    const int loads = m->loads;
    bool solved;

    now.t = t;
    for (int c = 0; c < m->coordinates; c++) {
        const int hinge = m->coordinate[c].hinge, k = c - m->hinge[hinge].coordinate;

        d->q[hinge][k] = now.q[c] = wave(&path[c], t);
        d->rate[hinge][k] = wave_rate(&path[c], t);
    }
    set_out(d, &now);
    for (int c = 0; c < m->coordinates; c++) {
        char text[60];

        (void)snprintf(text, sizeof text, "D%d.effort at %.17g", c, t);
        m->load[m->loads++] =
            (Load){.kind = ALONG, .place = c, .wave[0].low = kit_value(kit, text)};
    }
    solved = instant_solve(m, &now);
    m->loads = loads;
    if (!solved)
        return REFUSED;
    ask_all(m, &now, &asks);
    for (int c = 0; c < m->coordinates; c++)
        ask(&asks, now.second[c], 10, "(%.17g)",
            -path[c].size * path[c].pace * path[c].pace * sin(path[c].pace * t + path[c].phase));
    return compare(member, kit, &asks, t, 1e-7);
}

/* What a driven machine takes makes its parts accelerate as prescribed. */
static Verdict machine_is_driven(Member *member)
{
    static Drawn d;
    Kit kit = kit_new();
    Wave path[TURNS];
    Verdict verdict = AGREES;
    Machine *m = &d.m;

    driven = true;
    while (!draw_machine(member, &d) || m->coordinates == 0)
        ;
    driven = false;
    for (int c = 0; c < m->coordinates; c++) {
        char text[160];

        path[c] = (Wave){some(member, 0.5), some(member, 0.5), member_between(member, 1, 5),
                         some(member, 2)};
        write_line(&d.script, "driver D%d %s = %s", c, m->coordinate[c].name,
                   wave_text(&path[c], 1, text));
    }
    draw_tree(member, &d, member_one_of(member, 2) * 2);
    write_line(&d.script, "inverse 1 every=0.25");
    if (do_told(member, &kit, d.script.text) != CT_OK) {
        kit_free(&kit);
        return REFUSED;
    }
    for (int part = 0; part < 4 && verdict == AGREES; part++)
        verdict = efforts_move(member, &kit, &d, path, 0.31 * part);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"machines move and load their joints as their parts do", 20, 0.1, 0, machine_moves},
    {"machines tell errors that are not too low", 15, 0.4, 0, machine_tells_its_error},
    {"methods with a history are accurate", 24, 0.2, 0, history_is_accurate},
    {"machines rest where nothing accelerates", 40, 0.4, 0, machine_rests},
    {"driven machines take what moves their parts", 40, 0.1, 0, machine_is_driven},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

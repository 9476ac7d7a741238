/* family_stress_motions.c: motions that solvers lose: singular, redundant, fast, long, prescribed
 */
#include "bricard.h"
#include "cranks.h"
#include "jointed.h"
#include "stress.h"

/* --- 1: many four-bars in a row, all of them singular at once --- */

static Verdict long_rows_of_cranks_stay_parallel(Member *member)
{
    static const int rows[] = {1, 10, 1, 1, 10, 10, 40, 100};
    static Trial trial;
    static Cranks c;

    memset(&trial, 0, sizeof trial);
    c = (Cranks){.loops = rows[member->number % COUNT(rows)], .length = 1, .distance = 1};
    for (int i = 0; i <= c.loops; i++)
        c.crank[i] = 1;
    for (int i = 0; i < c.loops; i++)
        c.coupler[i] = 1;
    trial = (Trial){.one = {place_cranks, &c, {0, -9.81L, 0}},
                    .size = 1,
                    .planar = true,
                    .time = draw(member, 1, c.loops > 10 ? 2 : 10),
                    .phi = acosl(0),
                    .rate = -1};
    write_cranks(member, &trial, &c);
    return run_any_way(member, &trial);
}

/* --- 2: Bricard's loop, whichever of its rows is left out --- */

static Verdict bricards_loop_drops_any_row(Member *member)
{
    static Trial trial;
    Bricard b;
    Script *s = &trial.script;
    Spot corners[6], axes[6], rod;

    memset(&trial, 0, sizeof trial);
    trial.time = 2;
    trial.size = 1;
    for (int i = 0; i < 5; i++)
        b.masses[i] = 1;
    trial.one = (OneFreedom){place_bricard, &b, {0, 0, -9.81L}};
    trial.phi = 0.3L + draw(member, 0, 0.9);
    trial.rate = draw(member, -2, 2);
    place_corners((Jet){trial.phi, 1, 0}, corners, axes);
    rod = less(corners[1], corners[0]);
    write_line(s, "gravity [0, 0, -9.81]");
    write_bricard(s, &b, corners, axes, member->number % 6);
    if (member->number / 6 % 7 < 6)
        write_line(s, "cotree h%d", member->number / 6 % 7);
    else
        write_line(s, "tree absolute");
    write_line(s, "expect model.dof == 1\ninit h0 = 0, h0' = %.17g",
               (double)(trial.rate * (rod.at[2].v * rod.at[0].d - rod.at[0].v * rod.at[2].d)));
    for (int i = 0; i < 5; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "b%d", i);
        compare_with(&trial, name, 3 * i + 1);
    }
    (void)one_freedom_run(&trial.one, trial.time, FAR, &trial.phi, &trial.rate);
    write_line(s, "simulate %.17g rtol=1e-8 atol=1e-8", trial.time);
    write_line(s, "expect (max(energy.total) - min(energy.total) <= "
                  "1e-5*(max(energy.potential) - min(energy.potential)))");
    return run_trial(member, &trial, 1e-8);
}

/* --- 3: Andrews' squeezing mechanism against 25 digits --- */

/* at 0.03 s: 33-digit extrapolation and 16th-order collocation in other coordinates agree to 2e-26
 * (the values that the IVP test set prints are good to some 10 digits) */
static const struct {
    const char *name;
    double q, u;
} squeezed[] = {{"beta", 15.810771195153711, 1139.9203022591062},
                {"Theta", -15.756371058411844, -1424.3792951775401},
                {"gamma", 0.040822240119645838, 11.032911910619572},
                {"Phi", -0.53473011634207954, 19.293374105033751},
                {"delta", 0.52440996587995107, 0.57356991482950245},
                {"Omega", 0.53473011634207954, -19.293374105033751},
                {"epsilon", 1.0480807410419379, 0.32317914924916053}};

static Verdict andrews_mechanism_keeps_its_digits(Member *member)
{
    static const char *const trees[] = {"tree absolute", "cotree jE3 jE4 jE6", "cotree jB jG jH",
                                        "cotree jE3 jA5 jH", "form embedded"};
    static const char *const methods[] = {"auto", "dop853", "radau"};
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    const char *method = draw_word(member, methods, COUNT(methods));
    const double tolerance = draw_decades(member, method[0] == 'r' ? -9 : -11, -6);
    static Script s;

    s.length = 0;
    write_line(&s, ANDREWS "%s", draw_word(member, trees, COUNT(trees)));
    write_line(&s, "simulate 0.03 every=0.03 rtol=%.3g atol=%.3g method=%s", tolerance, tolerance,
               method);
    if (do_script(member, &kit, &s) != CT_OK)
        verdict = DISAGREES;
    for (int i = 0; i < COUNT(squeezed) && verdict == AGREES; i++) {
        const double q = squeezed[i].q, u = squeezed[i].u;
        char rate[16];

        (void)snprintf(rate, sizeof rate, "%s'", squeezed[i].name);
        if (!keeps(member, squeezed[i].name,
                   fabs(kit_value(&kit, squeezed[i].name) - q) / fmax(1, fabs(q)),
                   100 * tolerance) ||
            !keeps(member, rate, fabs(kit_value(&kit, rate) - u) / fmax(1, fabs(u)),
                   100 * tolerance))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* --- 4: energy and constraints over a long time --- */

static Verdict a_double_pendulum_keeps_its_energy(Member *member)
{
    static const char *const trees[] = {"tree joint", "tree absolute", "tree absolute",
                                        "cotree h1\ntree absolute\nform embedded"};
    static Script s;
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;
    const double time = member->number % 8 == 7 ? 1000 : draw(member, 20, 100);

    s.length = 0;
    write_line(&s, "scene planar\ngravity [0, -9.81]\nbody a mass=1 inertia=1/12");
    write_line(&s, "body b mass=1 inertia=1/12\narm aa a [0, 0.5]; arm ab a [0, -0.5]");
    write_line(&s, "arm ba b [0, 0.5]\nrevolute h1 ground aa; revolute h2 ab ba");
    write_line(&s, "%s\ninit h1 = %.17g, h2 = %.17g", draw_word(member, trees, COUNT(trees)),
               draw(member, 0.5, 1.6), draw(member, -1.5, 1.5));
    write_line(&s, "simulate %.17g rtol=1e-9 atol=1e-9", time);
    if (do_script(member, &kit, &s) == CT_OK) {
        const double drift = kit_value(&kit, "max(energy.total) - min(energy.total)");
        const double apart = kit_value(&kit, "max(constraint.error)");
        const bool holds = keeps(member, "energy, J", drift, 1e-5);

        verdict = keeps(member, "constraints, m", apart, 1e-12) && holds ? AGREES : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* --- 5: the heavy top, its world turned at random --- */

/* Bruels and Cardona's top: quaternions, 33 digits; agree with another formulation to 4e-27 */
static const struct {
    double t, r[3], w[3]; /* s; m; rad/s, along the axes of a world whose gravity is along -z */
} spun[] = {
    {0.5,
     {-0.70246829705658559, -0.021165184701923327, -0.71140025765173441},
     {-104.19143589744561, 2.4715373560448319, -108.04203284321369}},
    {2,
     {-0.15041682274564176, -0.72416559163689565, -0.67302226956044410},
     {-27.658515525823269, -106.16380414312445, -102.46246380532610}},
};

static bool top_agrees(Member *member, Kit *kit, const double *world, double tolerance)
{
    bool right = true;

    for (int k = 0; k < COUNT(spun); k++) {
        static const char axes[] = "xyz";
        double r[3], w[3];

        carry(world, spun[k].r, r);
        carry(world, spun[k].w, w);
        for (int i = 0; i < 3; i++) {
            char name[40];

            (void)snprintf(name, sizeof name, "top.%c at %g", axes[i], spun[k].t);
            right =
                keeps(member, name, fabs(kit_value(kit, name) - r[i]), 1e3 * tolerance) && right;
            (void)snprintf(name, sizeof name, "top.w%c at %g", axes[i], spun[k].t);
            right = keeps(member, name, fabs(kit_value(kit, name) - w[i]) / 150, 1e3 * tolerance) &&
                    right;
        }
    }
    return right;
}

/* Three angles may be refused where they lose a freedom, by name and with the way out; four
 * parameters never, and they keep their length. */
static Verdict a_heavy_top_turns_as_it_does(Member *member)
{
    static const char *const sequences[] = {"zyx", "zxy", "yxz", "yzx", "xyz", "xzy",
                                            "zxz", "zyz", "xyx", "xzx", "yxy", "yzy"};
    static const double down[3] = {0, 0, -9.81};
    static Script s;
    Kit kit = kit_new();
    const bool angles = draw_one_of(member, 2) == 0, absolute = draw_one_of(member, 2) == 0;
    const double tolerance = draw_decades(member, -11, -6);
    double world[4], g[3];
    char euler[16] = "";
    Verdict verdict = AGREES;

    random_attitude(member, world);
    carry(world, down, g);
    if (angles)
        (void)snprintf(euler, sizeof euler, "euler=%s",
                       draw_word(member, sequences, COUNT(sequences)));
    s.length = 0;
    write_line(&s, "gravity [%.17g, %.17g, %.17g]", g[0], g[1], g[2]);
    write_line(&s, "body top mass=15 inertia=[0.234375, 0.46875, 0.234375] %s", euler);
    write_line(&s, "arm foot top [0, -1, 0]\nspherical s ground foot %s", euler);
    write_line(&s, "tree %s\n%s", absolute ? "absolute" : "joint",
               draw_one_of(member, 3) == 0 ? "form embedded" : "");
    write_line(&s, "init top.q0 = %.17g, top.q1 = %.17g, top.q2 = %.17g, top.q3 = %.17g", world[0],
               world[1], world[2], world[3]);
    write_line(&s, "init top.Wx = 0, top.Wy = 150, top.Wz = -4.61538");
    write_line(&s, "simulate 2 every=0.5 rtol=%.3g atol=%.3g", tolerance, tolerance);
    if (do_script(member, &kit, &s) != CT_OK)
        verdict = angles && strstr(kit.error.message, "critical angle") != NULL &&
                          strstr(kit.error.hint, "euler=") != NULL
                      ? REFUSED
                      : DISAGREES;
    else if (!top_agrees(member, &kit, world, tolerance))
        verdict =
            strstr(ct_remarks(kit.session), " are singular at ") != NULL ? REFUSED : DISAGREES;
    if (verdict == AGREES && !angles) {
        const char *name = absolute ? "top" : "s";
        char square[100];

        (void)snprintf(square, sizeof square, "abs(%s.q0^2 + %s.q1^2 + %s.q2^2 + %s.q3^2 - 1)",
                       name, name, name, name);
        if (!keeps(member, "length of parameters", kit_value(&kit, square), 1e-12))
            verdict = DISAGREES;
    }
    tell(member, "%s", ct_remarks(kit.session));
    kit_free(&kit);
    return verdict;
}

/* --- 8: long chains --- */

enum { MOST_LINKS = MOST_STATES / 2 };

/* Rods of 1 m and 1 kg from their angles to the vertical, x' of the oracle: with c_ij what hangs
 * behind both, sum_j c_ij (cos(a_i - a_j) a_j'' + sin(a_i - a_j) a_j'^2) = -g h_i sin(a_i). */
static void chain_rates(const void *context, const Real *y, Real *rates)
{
    const int n = *(const int *)context;
    static Real m[MOST_LINKS][MOST_LINKS], s[MOST_LINKS], c[MOST_LINKS];
    Real *a = rates + n;

    for (int i = 0; i < n; i++) {
        s[i] = sinl(y[i]);
        c[i] = cosl(y[i]);
        rates[i] = y[n + i];
        a[i] = -9.81L * (n - i - 0.5L) * s[i];
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            const Real hangs = i == j ? n - i - 2 / 3.0L : n - i - 0.5L;

            m[i][j] = hangs * (c[i] * c[j] + s[i] * s[j]);
            a[i] -= hangs * (s[i] * c[j] - c[i] * s[j]) * y[n + j] * y[n + j];
            if (j < i)
                a[j] += hangs * (s[i] * c[j] - c[i] * s[j]) * y[n + i] * y[n + i];
        }
    for (int i = 0; i < n; i++) { /* L D L^T, row by row, and the right-hand side with it */
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < j; k++)
                m[i][j] -= m[i][k] * m[j][k] * m[k][k];
            m[i][j] /= m[j][j];
        }
        for (int k = 0; k < i; k++) {
            m[i][i] -= m[i][k] * m[i][k] * m[k][k];
            a[i] -= m[i][k] * a[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        a[i] /= m[i][i];
        for (int k = i + 1; k < n; k++)
            a[i] -= m[k][i] * a[k];
    }
}

/* where the tip of the chain is after `time` */
static void chain_tip(int n, double angle, double time, double tip[2])
{
    const Extrapolation by = {
        .rates = chain_rates, .context = &n, .count = 2 * n, .enough = 1e-12L};
    static Real y[MOST_STATES];
    Real at = 0, step = 1e-2L;

    for (int i = 0; i < n; i++) {
        y[i] = angle;
        y[n + i] = 0;
    }
    while (at < time)
        at += extrapolated_step(&by, time - at, &step, y);
    tip[0] = tip[1] = 0;
    for (int i = 0; i < n; i++) {
        tip[0] += (double)sinl(y[i]);
        tip[1] -= (double)cosl(y[i]);
    }
}

static void write_chain(Script *s, int n, double angle, const char *tree)
{
    s->length = 0;
    write_line(s, "scene planar\ngravity [0, -9.81]");
    for (int i = 0; i < n; i++) {
        write_line(s, "body b%d mass=1 inertia=1/12", i);
        write_line(s, "arm u%d b%d [0, 0.5]; arm d%d b%d [0, -0.5]", i, i, i, i);
        if (i == 0)
            write_line(s, "revolute h0 ground u0\ninit h0 = %.17g", angle);
        else
            write_line(s, "revolute h%d d%d u%d\ninit h%d = 0", i, i - 1, i, i);
    }
    write_line(s, "%s", tree);
}

/* A chain let go as a straight line swings as one rod would with a wave in it; its steps are as
 * many in every tree. */
static Verdict chains_are_the_same_in_all_trees(Member *member)
{
    static const int lengths[] = {2, 3, 5, 10, 20, 40, 8, 100, 4, 15, 30, 50, 6, 12, 25, 200};
    static const char *const trees[] = {"tree joint", "tree absolute"};
    const int n = lengths[member->number % COUNT(lengths)];
    const double angle = draw(member, 0.3, 1.2), time = n > 50 ? 0.25 : 1;
    static Script s;
    double tip[2], steps[2] = {NAN, NAN};
    Verdict verdict = AGREES;

    chain_tip(n, angle, time, tip);
    for (int i = 0; i < 2 && verdict == AGREES; i++) {
        Kit kit = kit_new();
        const char *at;

        write_chain(&s, n, angle, trees[i]);
        write_line(&s, "simulate %g every=%g rtol=1e-8 atol=1e-8\nshow run", time, time);
        if (do_script(member, &kit, &s) == CT_OK && (at = strstr(kit.text, "\nsteps")) != NULL)
            (void)sscanf(at + strlen("\nsteps"), "%lf", &steps[i]);
        for (int k = 0; k < 2; k++) {
            char name[24];

            (void)snprintf(name, sizeof name, "d%d.%c", n - 1, "xy"[k]);
            if (!keeps(member, name, fabs(kit_value(&kit, name) - tip[k]), 1e-6 * n))
                verdict = DISAGREES;
        }
        kit_free(&kit);
    }
    /* as many as the fastest wave asks for, which is with the square root of the length */
    if (!keeps(member, "steps in absolute coordinates", steps[1], 1.5 * steps[0] + 5) ||
        !keeps(member, "steps in joint coordinates", steps[0], 40 * sqrt(n) * time + 10))
        verdict = DISAGREES;
    return verdict;
}

/* --- 13: free bodies, and motion that is prescribed through singular positions --- */

/* a body that nothing holds flies, and turns evenly where its inertia is the same all ways round */
static Verdict a_free_body_flies_and_turns(Member *member)
{
    static const char *const places[] = {"b.x", "b.y", "b.z"};
    static const char *const parameters[] = {"b.q0", "b.q1", "b.q2", "b.q3"};
    static const char *const trees[] = {"", "tree absolute", "free f ground b"};
    static Script s;
    Kit kit = kit_new();
    const double time = draw(member, 0.5, 5), tolerance = draw_decades(member, -10, -6);
    double v[3], w[3], axis[3], q[4], rate = 0;
    Verdict verdict = AGREES;

    for (int i = 0; i < 3; i++) {
        v[i] = draw(member, -5, 5);
        w[i] = draw(member, -5, 5);
        rate += w[i] * w[i];
    }
    rate = sqrt(rate);
    for (int i = 0; i < 3; i++)
        axis[i] = w[i] / rate;
    s.length = 0;
    write_line(&s, "gravity [0, 0, -9.81]\nbody b mass=%.17g inertia=%.17g*[1, 1, 1]",
               draw_decades(member, -3, 3), draw_decades(member, -3, 3));
    write_line(&s, "%s", draw_word(member, trees, COUNT(trees)));
    write_line(&s, "init b.vx = %.17g, b.vy = %.17g, b.vz = %.17g", v[0], v[1], v[2]);
    write_line(&s, "init b.wx = %.17g, b.wy = %.17g, b.wz = %.17g", w[0], w[1], w[2]);
    write_line(&s, "simulate %.17g every=%.17g rtol=%.3g atol=%.3g", time, time, tolerance,
               tolerance);
    if (do_script(member, &kit, &s) != CT_OK)
        verdict = DISAGREES;
    for (int i = 0; i < 3 && verdict == AGREES; i++) {
        const double flown = v[i] * time - (i == 2 ? 0.5 * 9.81 * time * time : 0);

        if (!keeps(member, places[i], fabs(kit_value(&kit, places[i]) - flown) / (1 + fabs(flown)),
                   1e3 * tolerance))
            verdict = DISAGREES;
    }
    for (int i = 0; i < 4 && verdict == AGREES; i++) {
        q[i] = kit_value(&kit, parameters[i]);
    }
    if (verdict == AGREES &&
        !keeps(member, "attitude", attitude_off(q, turned(axis, rate * time).q), 1e3 * tolerance))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

/* equal cranks driven at their first hinge, past the positions at which the others could turn back
 */
static Verdict drivers_lead_through_flat_positions(Member *member)
{
    static const char *const verbs[] = {"kinematics", "inverse", "simulate"};
    static Trial trial;
    static Cranks c;
    static Masses end;
    Kit kit = kit_new();
    const double rate = draw(member, 1, 6) * (draw_one_of(member, 2) ? 1 : -1);
    const char *verb = verbs[member->number % COUNT(verbs)];
    Verdict verdict = DISAGREES;

    memset(&trial, 0, sizeof trial);
    c = (Cranks){
        .loops = 1 + draw_one_of(member, 3), .length = 1, .distance = draw(member, 0.5, 2)};
    for (int i = 0; i <= c.loops; i++)
        c.crank[i] = draw(member, 0.5, 2);
    for (int i = 0; i < c.loops; i++)
        c.coupler[i] = draw(member, 0.5, 2);
    trial = (Trial){.one = {place_cranks, &c, {0, -9.81L, 0}}, .planar = true};
    trial.phi = draw(member, 0.3, 2.8);
    write_cranks(member, &trial, &c);
    write_line(&trial.script, "init none\ninit h0 = %.17g", (double)trial.phi);
    write_line(&trial.script, "driver D h0 = %.17g + %.17g*t", (double)trial.phi, rate);
    write_line(&trial.script, "%s 3 every=%.17g", verb, draw_decades(member, -2, -1.3));
    trial.phi += 3 * rate;
    end.count = 0;
    place_cranks(&c, jet(trial.phi), &end);
    if (do_script(member, &kit, &trial.script) == CT_OK &&
        keeps(member, "frames", largest_miss(&kit, &trial, &end), 1e-6) &&
        keeps(member, "rows", kit_value(&kit, "max(abs(h1 - h0))"), 1e-6))
        verdict = AGREES;
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        /* 1 */ {"long_rows_of_cranks_stay_parallel", 3, 0, 0, long_rows_of_cranks_stay_parallel},
        /* 2 */ {"bricards_loop_drops_any_row", 2, 0, 0, bricards_loop_drops_any_row},
        /* 3 */ {"andrews_mechanism_keeps_its_digits", 6, 0, 0, andrews_mechanism_keeps_its_digits},
        /* 4 */ {"a_double_pendulum_keeps_its_energy", 4, 0, 0, a_double_pendulum_keeps_its_energy},
        /* 5 */ {"a_heavy_top_turns_as_it_does", 12, 0.2, 0, a_heavy_top_turns_as_it_does},
        /* 8 */ {"chains_are_the_same_in_all_trees", 5, 0, 0, chains_are_the_same_in_all_trees},
        /* 13 */ {"a_free_body_flies_and_turns", 12, 0, 0, a_free_body_flies_and_turns},
        {"drivers_lead_through_flat_positions", 9, 0, 0, drivers_lead_through_flat_positions},
    };

    return family_main(families, COUNT(families), argc, argv);
}

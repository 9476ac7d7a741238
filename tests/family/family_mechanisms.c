/* family_mechanisms.c: mechanisms through positions and past numbers that solvers stumble over
 *
 * Singular positions, overconstrained loops, masses and lengths many decades apart: each is held
 * against the motion of its one freedom in closed form (one_freedom.h), in random trees, forms,
 * methods and tolerances. */
#include "bricard.h"
#include "cranks.h"
#include "mechanisms.h"

/* --- cranks in parallel: singular where they are in line with the couplers --- */

static Verdict cranks_pass_their_flat_positions(Member *member)
{
    Trial trial = {.time = draw(member, 1, 5), .planar = true};
    Cranks c = {.loops = 1 + draw_one_of(member, 4),
                .length = draw(member, 0.5, 1.5),
                .distance = draw(member, 0.5, 1.5)};

    for (int i = 0; i <= c.loops; i++) {
        c.crank[i] = draw(member, 0.5, 2);
        if (i < c.loops)
            c.coupler[i] = draw(member, 0.5, 2);
    }
    trial.one = (OneFreedom){place_cranks, &c, {0, -9.81L, 0}};
    trial.size = (double)c.length;
    trial.phi = draw(member, 0.3, 2.8);
    trial.rate = draw(member, -9, 9);
    write_cranks(member, &trial, &c);
    return run_any_way(member, &trial);
}

/* --- change points: the mechanism could go on in two ways --- */

typedef struct Lengths {
    Real crank, other;
    Real masses[3];
} Lengths;

/* crank and rod of one length: over the middle, the slide could rest while both turn */
static void place_equal_slider(const void *mechanism, Jet phi, Masses *out)
{
    const Lengths *l = mechanism;
    const Jet x = scaled(l->crank, jet_cos(phi));
    const Spot tip = spot(x, scaled(l->crank, jet_sin(phi)));
    const Spot slide = spot(scaled(2, x), jet(0));

    add_rod(out, l->masses[0], (Spot){0}, tip);
    add_rod(out, l->masses[1], tip, slide);
    add_mass(out, l->masses[2], slide);
}

static void write_change_tree(Member *member, Script *script)
{
    static const char *const trees[] = {"", "tree absolute", "cotree h1", "cotree h2", "cotree h3"};

    write_line(script, "%s", trees[draw_one_of(member, COUNT(trees))]);
}

static Verdict an_equal_slider_crank_keeps_its_way(Member *member)
{
    Lengths l = {.crank = draw(member, 0.3, 1)};
    Trial trial = {.time = draw(member, 1, 3), .planar = true, .size = (double)l.crank};
    Script *s = &trial.script;
    static Masses start;

    for (int i = 0; i < 3; i++)
        l.masses[i] = draw(member, 0.5, 2);
    trial.one = (OneFreedom){place_equal_slider, &l, {0, -9.81L, 0}};
    trial.phi = draw(member, -1, 1);
    trial.rate = draw(member, 6, 15) * (draw_one_of(member, 2) ? 1 : -1);
    start.count = 0;
    place_equal_slider(&l, jet(trial.phi), &start);
    write_line(s, "scene planar\ngravity [0, -9.81]");
    write_rod(s, "c", (double)l.masses[0], (double)l.crank);
    write_rod(s, "k", (double)l.masses[1], (double)l.crank);
    write_line(s, "body b mass=%.17g inertia=1", (double)l.masses[2]);
    write_line(s, "revolute h1 ground ca; revolute h2 cb ka; revolute h3 kb b");
    write_line(s, "prismatic s1 ground b axis=x");
    write_change_tree(member, s);
    write_guess(s, "c", start.spot[1], (double)trial.phi);
    write_guess(s, "k", start.spot[4], -(double)trial.phi);
    write_guess(s, "b", start.spot[6], 0);
    write_line(s, "guess h2=%.17g, h3=%.17g", -2 * (double)trial.phi, (double)trial.phi);
    write_line(s, "init h1 = %.17g, h1' = %.17g", (double)trial.phi, (double)trial.rate);
    compare_with(&trial, "c", 1);
    compare_with(&trial, "k", 4);
    compare_with(&trial, "b", 6);
    return run_any_way(member, &trial);
}

/* a crank as long as the ground link, two equal longer rods: where the crank is folded onto the
 * ground, the other two could turn by themselves */
static void place_kite(const void *mechanism, Jet phi, Masses *out)
{
    const Lengths *l = mechanism;
    const Jet half = scaled(0.5L, phi), s = jet_sin(half), c = jet_cos(half);
    const Jet reach =
        jet_sqrt(minus(jet(l->other * l->other), scaled(l->crank * l->crank, times(s, s))));
    const Spot tip = spot(scaled(l->crank, jet_cos(phi)), scaled(l->crank, jet_sin(phi)));
    const Spot foot = spot(jet(l->crank), jet(0));
    Spot top = part_way(tip, foot, 0.5L);

    top.at[0] = plus(top.at[0], times(reach, c));
    top.at[1] = plus(top.at[1], times(reach, s));
    add_rod(out, l->masses[0], (Spot){0}, tip);
    add_rod(out, l->masses[1], tip, top);
    add_rod(out, l->masses[2], foot, top);
}

static double angle_of(const Masses *masses, int rod)
{
    const Spot *a = &masses->spot[3 * rod], *b = a + 2;

    return (double)atan2l(b->at[1].v - a->at[1].v, b->at[0].v - a->at[0].v);
}

/* of the four hinges of a loop: crank, coupler, rocker */
static void write_hinge_guesses(Script *s, double crank, const Masses *start)
{
    const double coupler = angle_of(start, 1), rocker = angle_of(start, 2);

    write_line(s, "guess h2=%.17g, h3=%.17g, h4=%.17g", coupler - crank, rocker, rocker - coupler);
}

/* three rods in a loop with ground, whose far hinge is at x = ground, from where they start */
static void write_loop(Member *member, Trial *trial, Real ground, const Real *lengths,
                       const Real *masses)
{
    static const char *const names[] = {"c", "k", "b"};
    Script *s = &trial->script;
    static Masses start;

    start.count = 0;
    trial->one.place(trial->one.mechanism, jet(trial->phi), &start);
    write_line(s, "scene planar\ngravity [0, -9.81]\narm g ground [%.17g, 0]", (double)ground);
    for (int i = 0; i < 3; i++)
        write_rod(s, names[i], (double)masses[i], (double)lengths[i]);
    write_line(s, "revolute h1 ground ca; revolute h2 cb ka; revolute h3 g ba; revolute h4 kb bb");
    write_change_tree(member, s);
    write_guess(s, "c", start.spot[1], (double)trial->phi);
    write_guess(s, "k", start.spot[4], angle_of(&start, 1));
    write_guess(s, "b", start.spot[7], angle_of(&start, 2));
    write_hinge_guesses(s, (double)trial->phi, &start);
    write_line(s, "init h1 = %.17g, h1' = %.17g", (double)trial->phi, (double)trial->rate);
    for (int i = 0; i < 3; i++)
        compare_with(trial, names[i], 3 * i + 1);
}

static Verdict a_kite_folds_and_opens_again(Member *member)
{
    Lengths l = {.crank = draw(member, 0.3, 1)};
    Trial trial = {.time = draw(member, 1, 3), .planar = true, .size = (double)l.crank};

    l.other = l.crank * draw(member, 1.3, 3);
    for (int i = 0; i < 3; i++)
        l.masses[i] = draw(member, 0.5, 2);
    trial.one = (OneFreedom){place_kite, &l, {0, -9.81L, 0}};
    trial.phi = draw(member, 0.5, 5.5);
    trial.rate = draw(member, 6, 15) * (draw_one_of(member, 2) ? 1 : -1);
    write_loop(member, &trial, l.crank, (Real[]){l.crank, l.other, l.other}, l.masses);
    return run_any_way(member, &trial);
}

/* --- numbers many decades apart --- */

typedef struct FourBar {
    Real ground, crank, coupler, rocker;
    Real masses[3];
} FourBar;

/* the crank turns fully; the coupler's end is where two circles meet, above */
static void place_four_bar(const void *mechanism, Jet phi, Masses *out)
{
    const FourBar *f = mechanism;
    const Spot tip = spot(scaled(f->crank, jet_cos(phi)), scaled(f->crank, jet_sin(phi)));
    const Spot foot = spot(jet(f->ground), jet(0));
    const Jet x = minus(foot.at[0], tip.at[0]), y = minus(foot.at[1], tip.at[1]);
    const Jet square = plus(times(x, x), times(y, y));
    /* along and across the line between the two centres, in parts of their distance */
    const Jet along = scaled(
        0.5L, plus(jet(1), over(jet(f->coupler * f->coupler - f->rocker * f->rocker), square)));
    const Jet across =
        jet_sqrt(minus(over(jet(f->coupler * f->coupler), square), times(along, along)));
    const Spot top = spot(plus(tip.at[0], minus(times(along, x), times(across, y))),
                          plus(tip.at[1], plus(times(along, y), times(across, x))));

    add_rod(out, f->masses[0], (Spot){0}, tip);
    add_rod(out, f->masses[1], tip, top);
    add_rod(out, f->masses[2], foot, top);
}

static Verdict masses_and_lengths_may_be_decades_apart(Member *member)
{
    FourBar f = {.ground = 1};
    Trial trial = {.planar = true, .size = 1};

    f.crank = draw_decades(member, -3, -0.7);
    f.coupler = draw_one_of(member, 2) ? draw(member, 1, 2) : draw_decades(member, 0, 3) * f.crank;
    f.coupler = fmaxl(f.coupler, 1);
    f.rocker = f.coupler + draw(member, -0.6, 0.6);
    for (int i = 0; i < 3; i++)
        f.masses[i] = draw_decades(member, -6, 6);
    f.masses[draw_one_of(member, 6) % 3] *= draw_one_of(member, 2); /* without any mass, too */
    trial.one = (OneFreedom){place_four_bar, &f, {0, -9.81L, 0}};
    trial.phi = draw(member, 0, 6);
    trial.rate = draw(member, 3, 9);
    trial.time = draw(member, 0.3, 1);
    trial.size = fmax(1, (double)f.coupler);
    write_loop(member, &trial, f.ground, (Real[]){f.crank, f.coupler, f.rocker}, f.masses);
    return run_any_way(member, &trial);
}

/* the same in space, of rods that have no inertia about their own axes: M is singular, and three of
 * each hinge's rows repeat others */
static void write_slender_loop(Member *member, Trial *trial, const Real *lengths,
                               const Real *masses)
{
    static const char *const names[] = {"c", "k", "b"};
    Script *s = &trial->script;
    static Masses start;

    start.count = 0;
    trial->one.place(trial->one.mechanism, jet(trial->phi), &start);
    write_line(s, "gravity [0, -9.81, 0]\narm g ground [1, 0, 0]");
    for (int i = 0; i < 3; i++) {
        const double half = (double)lengths[i] / 2, inertia = (double)masses[i] * half * half / 3;

        write_line(s, "body %s mass=%.17g inertia=[0, %.17g, %.17g]", names[i], (double)masses[i],
                   inertia, inertia);
        write_line(s, "arm %sa %s [%.17g, 0, 0]; arm %sb %s [%.17g, 0, 0]", names[i], names[i],
                   -half, names[i], names[i], half);
        compare_with(trial, names[i], 3 * i + 1);
    }
    write_line(s, "revolute h1 ground ca; revolute h2 cb ka; revolute h3 g ba; revolute h4 kb bb");
    write_change_tree(member, s);
    write_hinge_guesses(s, (double)trial->phi, &start);
    write_line(s, "init h1 = %.17g, h1' = %.17g", (double)trial->phi, (double)trial->rate);
}

static Verdict rods_need_no_inertia_about_their_axes(Member *member)
{
    FourBar f = {.ground = 1, .crank = 0.3L, .coupler = 0.9L, .rocker = 0.8L};
    Trial trial = {.size = 1, .time = draw(member, 0.3, 1)};

    for (int i = 0; i < 3; i++)
        f.masses[i] = draw_decades(member, -3, 3);
    trial.one = (OneFreedom){place_four_bar, &f, {0, -9.81L, 0}};
    trial.phi = draw(member, 0, 6);
    trial.rate = draw(member, 3, 9);
    write_slender_loop(member, &trial, (Real[]){f.crank, f.coupler, f.rocker}, f.masses);
    return run_any_way(member, &trial);
}

/* the same mechanism in other lengths, from a tenth of a millimetre to a hundred kilometres, and in
 * the times that go with them */
static Verdict mechanisms_may_be_small_and_large(Member *member)
{
    const Real scale = draw_decades(member, -4, 5);
    FourBar f = {.ground = scale, .crank = scale * draw(member, 0.1, 0.3)};
    Trial trial = {.planar = true, .size = (double)scale, .least_length = (double)scale};

    f.coupler = scale * draw(member, 1, 1.6);
    f.rocker = scale * draw(member, 0.9, 1.6);
    for (int i = 0; i < 3; i++)
        f.masses[i] = draw(member, 0.5, 2) * scale * scale * scale;
    trial.one = (OneFreedom){place_four_bar, &f, {0, -9.81L, 0}};
    trial.phi = draw(member, 0, 6);
    trial.rate = draw(member, 3, 9) / sqrtl(scale);
    trial.time = draw(member, 0.5, 2) * (double)sqrtl(scale);
    write_loop(member, &trial, f.ground, (Real[]){f.crank, f.coupler, f.rocker}, f.masses);
    return run_any_way(member, &trial);
}

/* --- Bricard's loop --- */

static Verdict bricards_loop_keeps_its_accuracy(Member *member)
{
    Bricard b;
    Trial trial = {.time = draw(member, 1, 5), .size = 1};
    Script *s = &trial.script;
    Spot corners[6], axes[6], rod;
    double gravity[3];

    for (int i = 0; i < 5; i++)
        b.masses[i] = draw(member, 0.5, 2);
    trial.one = (OneFreedom){.place = place_bricard, .mechanism = &b};
    for (int i = 0; i < 3; i++)
        trial.one.gravity[i] = gravity[i] = draw(member, -9, 9);
    trial.phi = draw(member, 0.2, 1.3) + draw_one_of(member, 4) * acosl(0);
    trial.rate = draw_one_of(member, 2) ? draw(member, -5, 5) : 0;
    place_corners((Jet){trial.phi, 1, 0}, corners, axes);
    rod = less(corners[1], corners[0]);
    write_line(s, "gravity [%.17g, %.17g, %.17g]", gravity[0], gravity[1], gravity[2]);
    write_bricard(s, &b, corners, axes, draw_one_of(member, 6));
    if (draw_one_of(member, 2))
        write_line(s, "tree absolute");
    else if (draw_one_of(member, 2))
        write_line(s, "cotree h%d", draw_one_of(member, 6));
    /* the first rod turns about y of ground */
    write_line(s, "init h0 = 0, h0' = %.17g",
               (double)(trial.rate * (rod.at[2].v * rod.at[0].d - rod.at[0].v * rod.at[2].d)));
    for (int i = 0; i < 5; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "b%d", i);
        compare_with(&trial, name, 3 * i + 1);
    }
    return run_any_way(member, &trial);
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"cranks_pass_their_flat_positions", 12, 0, 0, cranks_pass_their_flat_positions},
        {"an_equal_slider_crank_keeps_its_way", 20, 0, 0, an_equal_slider_crank_keeps_its_way},
        {"a_kite_folds_and_opens_again", 20, 0, 0, a_kite_folds_and_opens_again},
        /* trees that go through a crank of no mass leave more rounding than some tolerances: told
         */
        {"masses_and_lengths_may_be_decades_apart", 30, 0.1, 0,
         masses_and_lengths_may_be_decades_apart},
        {"rods_need_no_inertia_about_their_axes", 8, 0.02, 0,
         rods_need_no_inertia_about_their_axes},
        {"mechanisms_may_be_small_and_large", 30, 0, 0, mechanisms_may_be_small_and_large},
        {"bricards_loop_keeps_its_accuracy", 4, 0, 0, bricards_loop_keeps_its_accuracy},
    };

    return family_main(families, COUNT(families), argc, argv);
}

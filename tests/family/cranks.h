/* cranks.h: equal cranks in parallel and the couplers between them, singular where they are in line
 */
#ifndef COTREE_TESTS_CRANKS_H
#define COTREE_TESTS_CRANKS_H

#include "mechanisms.h"

enum { MOST_LOOPS = 100 };
typedef struct Cranks {
    int loops;
    Real length, distance;
    Real crank[MOST_LOOPS + 1], coupler[MOST_LOOPS]; /* masses */
} Cranks;

static inline void place_cranks(const void *mechanism, Jet phi, Masses *out)
{
    const Cranks *c = mechanism;
    const Jet x = scaled(c->length, jet_cos(phi)), y = scaled(c->length, jet_sin(phi));
    Spot before = {0};

    for (int i = 0; i <= c->loops; i++) {
        const Spot foot = spot(jet((Real)i * c->distance), jet(0));
        const Spot tip = spot(plus(foot.at[0], x), y);

        add_rod(out, c->crank[i], foot, tip);
        if (i > 0)
            add_rod(out, c->coupler[i - 1], before, tip);
        before = tip;
    }
}

/* which joint of each loop closes it */
static inline void write_tree(Member *member, Script *script, int loops)
{
    static const char *const closing[] = {"l", "r", "h"};

    switch (draw_one_of(member, 3)) {
    case 0:
        return;
    case 1:
        write_line(script, "tree absolute");
        return;
    default:
        write_piece(script, "cotree");
        for (int i = 0; i < loops; i++) {
            const int which = draw_one_of(member, COUNT(closing));

            write_piece(script, " %s%d", closing[which], which == 2 ? i + 1 : i);
        }
        write_line(script, "%s", "");
    }
}

static inline void write_cranks(Member *member, Trial *trial, const Cranks *c)
{
    Script *script = &trial->script;
    static Masses start;
    char name[16];

    write_line(script, "scene planar\ngravity [0, -9.81]");
    start.count = 0;
    place_cranks(c, jet(trial->phi), &start);
    for (int i = 0; i <= c->loops; i++) {
        (void)snprintf(name, sizeof name, "c%d", i);
        write_rod(script, name, (double)c->crank[i], (double)c->length);
        write_line(script, "arm g%d ground [%.17g, 0]", i, (double)i * (double)c->distance);
        write_line(script, "revolute h%d g%d c%da", i, i, i);
    }
    for (int i = 0; i < c->loops; i++) {
        (void)snprintf(name, sizeof name, "k%d", i);
        write_rod(script, name, (double)c->coupler[i], (double)c->distance);
        write_line(script, "revolute l%d c%db k%da", i, i, i);
        write_line(script, "revolute r%d k%db c%db", i, i, i + 1);
    }
    if (draw_one_of(member, 4) == 0)
        write_line(script, "revolute twice c0b k0a"); /* rank lost on purpose */
    write_tree(member, script, c->loops);
    for (int i = 0; i <= c->loops; i++) {
        const int mass = i == 0 ? 1 : 6 * i - 2;

        (void)snprintf(name, sizeof name, "c%d", i);
        compare_with(trial, name, mass);
        write_line(script, "guess h%d=%.17g", i, (double)trial->phi);
        write_guess(script, name, start.spot[mass], (double)trial->phi);
        if (i == 0)
            continue;
        (void)snprintf(name, sizeof name, "k%d", i - 1);
        compare_with(trial, name, mass + 3);
        write_line(script, "guess l%d=%.17g, r%d=%.17g", i - 1, -(double)trial->phi, i - 1,
                   (double)trial->phi);
        write_guess(script, name, start.spot[mass + 3], 0);
    }
    write_line(script, "init h0 = %.17g, h0' = %.17g", (double)trial->phi, (double)trial->rate);
}

#endif

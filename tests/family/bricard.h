/* bricard.h: Bricard's loop, six rods of 1 m with hinges at right angles: one row too many */
#ifndef COTREE_TESTS_BRICARD_H
#define COTREE_TESTS_BRICARD_H

#include "mechanisms.h"

typedef struct Bricard {
    Real masses[5];
} Bricard;

static inline Jet dot3(Spot a, Spot b)
{
    return plus(plus(times(a.at[0], b.at[0]), times(a.at[1], b.at[1])), times(a.at[2], b.at[2]));
}

static inline Spot cross3(Spot a, Spot b)
{
    Spot out;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out.at[i] = minus(times(a.at[j], b.at[k]), times(a.at[k], b.at[j]));
    }
    return out;
}

static inline Spot less(Spot a, Spot b)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = minus(a.at[i], b.at[i]);
    return a;
}

static inline Spot unit(Spot a)
{
    const Jet size = jet_sqrt(dot3(a, a));

    for (int i = 0; i < 3; i++)
        a.at[i] = over(a.at[i], size);
    return a;
}

/* The axis at corner 0 is along (2z, 0, s/2 - r), which vanishes and turns round where the loop
 * lies flat, at phi = pi; over cos(phi/2) it does neither. (root + 3w)(root - 3w) = sin(phi)^2. */
static inline Spot first_axis(Jet phi, Jet w, Jet root)
{
    const Jet half = scaled(0.5L, phi), s = jet_sin(half), c = jet_cos(half);
    const Jet rise = w.v > 0 ? over(plus(root, scaled(3, w)), c)
                             : over(scaled(4, times(times(s, s), c)), minus(root, scaled(3, w)));

    return unit(
        (Spot){{scaled(4 / sqrtl(12), s), {0, 0, 0}, scaled(-0.5L * sqrtl(2.0L / 3), rise)}});
}

/* Corners in turn on two circles of radii r and s about one axis, z above and below its middle: all
 * sides are 1 and neighbouring hinges at right angles where r s = 2/3 and
 * z^2 = 5/12 - (r^2 + s^2)/4. With r/s = exp(2 psi): sinh(psi) = cos(phi)/sqrt(8),
 * z = sin(phi)/sqrt(12). */
static inline void place_corners(Jet phi, Spot corners[6], Spot axes[6])
{
    const Jet w = scaled(1 / sqrtl(8), jet_cos(phi));
    const Jet root = jet_sqrt(plus(jet(1), times(w, w)));
    const Jet radius[2] = {scaled(sqrtl(2.0L / 3), plus(root, w)),
                           scaled(sqrtl(2.0L / 3), minus(root, w))};
    const Jet z = scaled(1 / sqrtl(12), jet_sin(phi));
    Spot x, y;

    for (int i = 0; i < 6; i++) {
        const Real angle = i * acosl(0.5L);

        corners[i] = spot(scaled(cosl(angle), radius[i % 2]), scaled(sinl(angle), radius[i % 2]));
        corners[i].at[2] = i % 2 == 0 ? z : scaled(-1, z);
    }
    for (int i = 0; i < 6; i++)
        axes[i] = unit(
            cross3(less(corners[(i + 1) % 6], corners[i]), less(corners[(i + 5) % 6], corners[i])));
    /* as seen from the side that stands still, which ends in corner 0 */
    x = less(corners[0], corners[5]);
    y = axes[0] = first_axis(phi, w, root);
    for (int pass = 0; pass < 2; pass++) {
        Spot *spots = pass == 0 ? corners : axes;
        const Spot z_axis = cross3(x, y);
        const Spot from = pass == 0 ? corners[0] : (Spot){0};

        for (int i = 0; i < 6; i++) {
            const Spot arm = less(spots[i], from);

            spots[i] = (Spot){{dot3(arm, x), dot3(arm, y), dot3(arm, z_axis)}};
        }
    }
}

static inline void place_bricard(const void *mechanism, Jet phi, Masses *out)
{
    const Bricard *b = mechanism;
    Spot corners[6], axes[6];

    place_corners(phi, corners, axes);
    for (int i = 0; i < 5; i++)
        add_rod(out, b->masses[i], corners[i], corners[i + 1]);
}

/* frames parallel to ground's at the start: all hinges stand at 0 */
static inline void write_bricard(Script *s, const Bricard *b, const Spot *corners, const Spot *axes,
                                 int first)
{
    write_line(s, "arm g ground [-1, 0, 0]");
    for (int i = 0; i < 5; i++) {
        const double m = (double)b->masses[i];
        double d[3], c[3];

        for (int k = 0; k < 3; k++) {
            d[k] = (double)(corners[i + 1].at[k].v - corners[i].at[k].v);
            c[k] = (double)(corners[i + 1].at[k].v + corners[i].at[k].v) / 2;
        }
        write_line(s, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g, %.17g, %.17g, %.17g]", i,
                   m, m / 12 * (d[1] * d[1] + d[2] * d[2]), m / 12 * (d[0] * d[0] + d[2] * d[2]),
                   m / 12 * (d[0] * d[0] + d[1] * d[1]), -m / 12 * d[0] * d[1],
                   -m / 12 * d[0] * d[2], -m / 12 * d[1] * d[2]);
        write_line(s, "arm s%d b%d [%.17g, %.17g, %.17g]", i, i, -d[0] / 2, -d[1] / 2, -d[2] / 2);
        write_line(s, "arm e%d b%d [%.17g, %.17g, %.17g]", i, i, d[0] / 2, d[1] / 2, d[2] / 2);
        write_line(s, "guess b%d.x=%.17g, b%d.y=%.17g, b%d.z=%.17g", i, c[0], i, c[1], i, c[2]);
    }
    for (int n = 0; n < 6; n++) { /* which row is left out depends on the order */
        const int i = (first + n) % 6;
        char tail[8] = "ground", head[8] = "g";

        if (i > 0)
            (void)snprintf(tail, sizeof tail, "e%d", (i - 1) % 5);
        if (i < 5)
            (void)snprintf(head, sizeof head, "s%d", i % 5);
        write_line(s, "revolute h%d %s %s axis=[%.17g, %.17g, %.17g]", i, tail, head,
                   (double)axes[i].at[0].v, (double)axes[i].at[1].v, (double)axes[i].at[2].v);
    }
}

#endif

/* shown_models.h: chains and slider-cranks at random, as scripts, whose equations are shown */
#ifndef COTREE_TESTS_SHOWN_MODELS_H
#define COTREE_TESTS_SHOWN_MODELS_H

#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { MOST_BODIES = 4 };

typedef struct Shape {
    Script script;
    int bodies;
} Shape;

static inline double draw(Member *m, double low, double high)
{
    return member_between(m, low, high);
}

static inline int one_of(Member *m, int count)
{
    return (int)(test_random(&m->random) % (unsigned)count);
}

/* what pulls: weight, a force, a spring or damper at the last joint */
static inline void write_loads(Member *m, Shape *shape, bool planar)
{
    Script *s = &shape->script;
    const int last = shape->bodies - 1;

    if (one_of(m, 4) > 0)
        write_line(s, planar ? "gravity [0, %.3f]" : "gravity [0.3, 0, %.3f]", draw(m, -12, -1));
    if (one_of(m, 2) == 0)
        write_line(s, planar ? "force F1 b%d [%.3f, %.3f]" : "force F1 b%d [%.3f, %.3f, 0.7]", last,
                   draw(m, -5, 5), draw(m, -5, 5));
    if (one_of(m, 2) == 0)
        write_line(s, planar ? "torque T1 b%d %.3f" : "torque T1 b%d [0.2, 0, %.3f]", last,
                   draw(m, -2, 2));
    if (one_of(m, 2) == 0)
        write_line(s, "spring k1 j0 k=%.3f", draw(m, 1, 50));
    if (one_of(m, 3) == 0)
        write_line(s, "damper d1 j%d d=%.3f", last, draw(m, 0.1, 2));
    if (one_of(m, 3) == 0)
        write_line(s, "motor M1 j0 e 0 R=1 L=0.1 Kt=0.5 J=%.3f\nvsource V1 e 0 %.3f",
                   draw(m, 0.01, 0.1), draw(m, -5, 5));
}

static inline void write_body(Member *m, Script *s, int i, bool planar)
{
    if (planar)
        write_line(s, "body b%d mass=%.3f inertia=%.3f", i, draw(m, 0.5, 3), draw(m, 0.01, 0.2));
    else
        write_line(s, "body b%d mass=%.3f inertia=[%.3f, 0.3, 0.25, 0.02, -0.01, 0.03]", i,
                   draw(m, 0.5, 3), draw(m, 0.2, 0.3));
    write_line(s, planar ? "arm p%d b%d [%.3f, %.3f]" : "arm p%d b%d [%.3f, %.3f, 0.05]", i, i,
               draw(m, -0.5, -0.1), draw(m, -0.1, 0.1));
    write_line(s, planar ? "arm q%d b%d [%.3f, %.3f]" : "arm q%d b%d [%.3f, %.3f, -0.04]", i, i,
               draw(m, 0.1, 0.5), draw(m, -0.1, 0.1));
}

/* a chain of turns and slides, in any of the trees */
static inline void write_chain(Member *m, Shape *shape, bool planar)
{
    static const char *const axes[] = {"x", "y", "z", "[0.6, 0, 0.8]"};
    static const char *const trees[] = {"tree joint", "tree absolute", ""};
    Script *s = &shape->script;

    shape->bodies = 1 + one_of(m, planar ? MOST_BODIES : 3);
    write_line(s, "scene %s", planar ? "planar" : "spatial");
    for (int i = 0; i < shape->bodies; i++) {
        const bool slides = one_of(m, 4) == 0;

        char tail[16] = "ground";

        write_body(m, s, i, planar);
        if (i > 0)
            (void)snprintf(tail, sizeof tail, "q%d", i - 1);
        write_line(s, "%s j%d %s p%d axis=%s", slides ? "prismatic" : "revolute", i, tail, i,
                   planar ? (slides ? axes[one_of(m, 2)] : "z") : axes[one_of(m, 4)]);
    }
    write_loads(m, shape, planar);
    write_line(s, "%s", trees[one_of(m, 3)]);
    for (int i = 0; i < shape->bodies; i++)
        write_line(s, "init j%d = %.4f, j%d' = %.4f", i, draw(m, -1, 1), i, draw(m, -2, 2));
}

/* a crank, a rod and a slide, in one tree, in two, or in absolute coordinates */
static inline void write_crank(Member *m, Shape *shape)
{
    static const char *const trees[] = {"tree j0 j2 j3",
                                        "tree translation j0 j1 j2\ntree rotation j0 j2 j3",
                                        "tree absolute", "tree j0 j1 j2"};
    Script *s = &shape->script;

    shape->bodies = 3;
    write_line(s, "scene planar\nL1 = %.3f\nL2 = %.3f", draw(m, 0.05, 0.2), draw(m, 0.25, 0.5));
    for (int i = 0; i < 3; i++)
        write_line(s, "body b%d mass=%.3f inertia=%.3f", i, draw(m, 0.5, 3), draw(m, 0.01, 0.2));
    write_line(s,
               "arm p0 b0 [-L1/2, 0]\narm q0 b0 [L1/2, 0]\narm p1 b1 [L2, 0]\narm q1 b1 [-L2, 0]");
    write_line(s, "revolute j0 ground p0\nrevolute j1 q0 p1\nrevolute j2 b2 q1");
    write_line(s, "prismatic j3 ground b2 axis=x");
    write_loads(m, shape, true);
    write_line(s, "%s", trees[one_of(m, 4)]);
    write_line(s, "init j0 = %.4f, j0' = %.4f", draw(m, 0.3, 1.2), draw(m, -5, 5));
}

#endif

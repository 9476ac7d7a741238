/* vectors.h: vectors, rotation matrices and Euler parameters in numbers, for oracles in space */
#ifndef COTREE_TESTS_FAMILY_VECTORS_H
#define COTREE_TESTS_FAMILY_VECTORS_H

#include <math.h>

#define UNUSED_HERE __attribute__((unused))

typedef struct V {
    double at[3];
} V;

typedef struct M {
    double at[3][3];
} M;

UNUSED_HERE static V plus(V a, double s, V b)
{
    return (V){{a.at[0] + s * b.at[0], a.at[1] + s * b.at[1], a.at[2] + s * b.at[2]}};
}

UNUSED_HERE static double dot(V a, V b)
{
    return a.at[0] * b.at[0] + a.at[1] * b.at[1] + a.at[2] * b.at[2];
}

UNUSED_HERE static V cross(V a, V b)
{
    return (V){{a.at[1] * b.at[2] - a.at[2] * b.at[1], a.at[2] * b.at[0] - a.at[0] * b.at[2],
                a.at[0] * b.at[1] - a.at[1] * b.at[0]}};
}

UNUSED_HERE static V apply(const M *m, V a)
{
    V out;

    for (int i = 0; i < 3; i++)
        out.at[i] = m->at[i][0] * a.at[0] + m->at[i][1] * a.at[1] + m->at[i][2] * a.at[2];
    return out;
}

UNUSED_HERE static V apply_back(const M *m, V a)
{
    V out;

    for (int i = 0; i < 3; i++)
        out.at[i] = m->at[0][i] * a.at[0] + m->at[1][i] * a.at[1] + m->at[2][i] * a.at[2];
    return out;
}

/* about x by the first angle, then about the new y by the second */
UNUSED_HERE static M turned(const double angle[2])
{
    const double c = cos(angle[0]), s = sin(angle[0]), d = cos(angle[1]), e = sin(angle[1]);

    return (M){{{d, 0, e}, {s * e, c, -s * d}, {-c * e, s, c * d}}};
}

UNUSED_HERE static M matrix_of(const double q[4])
{
    const double a = q[0], b = q[1], c = q[2], d = q[3];

    return (M){{{1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)},
                {2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)},
                {2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)}}};
}

/* q after a turn by `angle` in ground axes */
UNUSED_HERE static void turn(const double q[4], V angle, double out[4])
{
    const double size = sqrt(dot(angle, angle)), s = size > 0 ? sin(size / 2) / size : 0.5;
    const double p[4] = {cos(size / 2), s * angle.at[0], s * angle.at[1], s * angle.at[2]};

    out[0] = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
    out[1] = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
    out[2] = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
    out[3] = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
}

#endif

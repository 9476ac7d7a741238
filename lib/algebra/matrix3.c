/* matrix3.c: vectors of three and rotations */
#include "algebra/matrix3.h"

#include "algebra/elementary.h"

#include <math.h>
#include <string.h>

double vector3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void vector3_cross(const double a[3], const double b[3], double out[3])
{
    const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};

    memcpy(out, c, sizeof c);
}

void vector3_across(const double u[3], double out[3])
{
    double e[3] = {0}, length;
    int least = 0;

    for (int i = 1; i < 3; i++)
        if (fabs(u[i]) < fabs(u[least]))
            least = i;
    e[least] = 1;
    vector3_cross(e, u, out);
    length = sqrt(vector3_dot(out, out));
    for (int i = 0; i < 3; i++)
        out[i] /= length;
}

void matrix3_one(double R[9])
{
    for (int i = 0; i < 9; i++)
        R[i] = i % 4 == 0;
}

void matrix3_transpose(const double R[9], double out[9])
{
    const double T[9] = {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]};

    memcpy(out, T, sizeof T);
}

void matrix3_times(const double A[9], const double B[9], double out[9])
{
    double C[9];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
    memcpy(out, C, sizeof C);
}

void matrix3_apply(const double R[9], const double v[3], double out[3])
{
    const double w[3] = {vector3_dot(R, v), vector3_dot(R + 3, v), vector3_dot(R + 6, v)};

    memcpy(out, w, sizeof w);
}

/* the part along the axis, the part across and the axis times it (Rodrigues 1840) */
void matrix3_turn(const double u[3], double angle, double out[9])
{
    const double c = elementary_cos(angle), s = elementary_sin(angle);

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = (i == j ? c : 0) + (1 - c) * u[i] * u[j];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out[3 * k + j] += s * u[i];
        out[3 * j + k] -= s * u[i];
    }
}

void matrix3_of_parameters(const double p[4], double R[9])
{
    const double *e = p + 1;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            R[3 * i + j] = (i == j ? p[0] * p[0] - vector3_dot(e, e) : 0) + 2 * e[i] * e[j];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        R[3 * k + j] += 2 * p[0] * e[i];
        R[3 * j + k] -= 2 * p[0] * e[i];
    }
}

/* from the largest of the four squares (Shepperd 1978) */
void matrix3_parameters(const double R[9], double p[4])
{
    const double trace = R[0] + R[4] + R[8];
    double square[4] = {trace, R[0], R[4], R[8]}, length = 0;
    int best = 0, first = 0;

    for (int i = 1; i < 4; i++)
        if (square[i] > square[best])
            best = i;
    if (best == 0) {
        p[0] = 1 + trace;
        for (int i = 0; i < 3; i++)
            p[1 + i] = R[3 * ((i + 2) % 3) + (i + 1) % 3] - R[3 * ((i + 1) % 3) + (i + 2) % 3];
    } else {
        const int i = best - 1, j = (i + 1) % 3, k = (i + 2) % 3;

        p[0] = R[3 * k + j] - R[3 * j + k];
        p[1 + i] = 1 + R[4 * i] - R[4 * j] - R[4 * k];
        p[1 + j] = R[3 * j + i] + R[3 * i + j];
        p[1 + k] = R[3 * k + i] + R[3 * i + k];
    }
    for (int i = 0; i < 4; i++)
        length += p[i] * p[i];
    while (first < 3 && p[first] == 0)
        first++;
    length = p[first] < 0 ? -sqrt(length) : sqrt(length);
    for (int i = 0; i < 4; i++)
        p[i] /= length;
}

void matrix3_log(const double R[9], double out[3])
{
    double p[4], sine, angle;

    matrix3_parameters(R, p);
    sine = sqrt(p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    angle = 2 * atan2(sine, p[0]);
    for (int i = 0; i < 3; i++)
        out[i] = sine > 0 ? p[1 + i] * (angle / sine) : 0;
}

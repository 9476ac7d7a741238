/* shapes.h: the shapes of a beam and their derivatives, by recurrences */
#ifndef COTREE_TESTS_SHAPES_H
#define COTREE_TESTS_SHAPES_H

#include <math.h>
#include <stdbool.h>

enum { FAMILIES_OF_SHAPES = 4 };

static const char *const bases[] = {"legendre", "taylor", "chebyshev"};
static const char *const letters[FAMILIES_OF_SHAPES] = {"u", "v", "w", "phi"};

typedef struct Shape {
    double value, slope, curve; /* and derivatives by xi */
} Shape;

/* the k-th polynomial of Legendre or Chebyshev over 0..1 */
static Shape orthogonal(bool legendre, int k, double xi)
{
    const double z = 2 * xi - 1;
    Shape before = {1, 0, 0}, now = {z, 2, 0};

    for (int n = 1; n < k; n++) {
        const double a = legendre ? (2 * n + 1.0) / (n + 1) : 2, c = legendre ? n / (n + 1.0) : 1;
        const Shape next = {a * z * now.value - c * before.value,
                            a * (z * now.slope + 2 * now.value) - c * before.slope,
                            a * (z * now.curve + 4 * now.slope) - c * before.curve};

        before = now;
        now = next;
    }
    return k == 0 ? before : now;
}

/* integrals of Legendre's from 0 (Abramowitz and Stegun 8.5) */
static double integral_of(int times, int k, double xi)
{
    if (times == 0)
        return orthogonal(true, k, xi).value;
    if (k == 0)
        return times == 1 ? xi : xi * xi / 2;
    return (integral_of(times - 1, k + 1, xi) - integral_of(times - 1, k - 1, xi)) /
           (2 * (2 * k + 1));
}

/* the k-th of a family: of bending it begins with xi^2, else with xi */
static Shape shape(int basis, bool bends, int k, double xi)
{
    const int order = bends ? 2 : 1, n = k + order;
    Shape own;

    if (basis == 1)
        return (Shape){pow(xi, n), n * pow(xi, n - 1), n > 1 ? n * (n - 1) * pow(xi, n - 2) : 0};
    if (basis == 0)
        return (Shape){integral_of(order, k, xi), integral_of(order - 1, k, xi),
                       bends ? integral_of(0, k, xi) : 0};
    own = orthogonal(false, k, xi);
    return bends ? (Shape){xi * xi * own.value, xi * xi * own.slope + 2 * xi * own.value,
                           xi * xi * own.curve + 4 * xi * own.slope + 2 * own.value}
                 : (Shape){xi * own.value, xi * own.slope + own.value, 0};
}

#endif

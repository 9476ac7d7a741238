/* curve.c: natural cubic splines
 *
 * With h the width of an interval, a = (x1 - x)/h and b = (x - x0)/h,
 *     y = a y0 + b y1 + ((a^3 - a) y0'' + (b^3 - b) y1'') h^2/6
 * and slopes that agree at the points give a tridiagonal system for y''. */
#include "expr/curve.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* second derivatives at the points, 0 at both ends; elimination from the first on (Thomas) */
static void find_curvatures(int count, const double *x, const double *y, double *m)
{
    double *above = NEW_ARRAY(double, count);

    m[0] = 0;
    for (int i = 1; i + 1 < count; i++) {
        const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
        const double pivot = 2 * (left + right) - left * above[i - 1];
        const double bend = (y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left;

        above[i] = right / pivot;
        m[i] = (6 * bend - left * m[i - 1]) / pivot;
    }
    m[count - 1] = 0;
    for (int i = count - 2; i > 0; i--)
        m[i] -= above[i] * m[i + 1];
    mem_free(above);
}

Curve *curve_new(const char *file, const char *column, const double *x, const double *y, int count)
{
    Curve *table = NEW(Curve);

    table->count = count;
    table->data = mem_array((size_t)count * 3, sizeof(double));
    for (int i = 0; i < count; i++) {
        table->data[i] = x[i];
        table->data[count + i] = y[i];
    }
    find_curvatures(count, x, y, table->data + 2 * (ptrdiff_t)count);
    table->file = mem_text(file, strlen(file));
    table->column = mem_text(column, strlen(column));
    return table;
}

Curve *curve_new_law(const char *name, const char *argument)
{
    Curve *table = NEW(Curve);

    table->file = mem_text(name, strlen(name));
    table->column = mem_text(argument, strlen(argument));
    return table;
}

Curve *curve_copy(const Curve *table)
{
    if (curve_is_law(table))
        return curve_new_law(table->file, table->column);
    return curve_new(table->file, table->column, table->data, table->data + table->count,
                     table->count);
}

void curve_free(Curve *table)
{
    if (table == NULL)
        return;
    MEM_FREE(table->data, table->file, table->column, table);
}

/* the interval in which x lies, by halves */
static int interval_of(const Curve *table, double x)
{
    int low = 0, high = table->count - 1;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (x < table->data[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* 2 + sin(a x + b), or a derivative of it; a and b follow from the name */
static double law_value(const Curve *table, double x, int order)
{
    double number = 0, a, wave;

    for (const char *c = table->file; *c != '\0'; c++)
        number = fmod(31 * number + *c, 65521);
    a = 0.7 + fmod(number * 0.6180339887498949, 1);
    wave = sin(a * x + number + order * M_PI_2);
    return order == 0 ? 2 + wave : pow(a, order) * wave;
}

double curve_value(const Curve *table, double x, int order)
{
    if (curve_is_law(table))
        return law_value(table, x, order);

    const int n = table->count;
    const double *xs = table->data, *ys = xs + n, *ms = ys + n;

    if (isnan(x))
        return x;
    if (x < xs[0] || x > xs[n - 1])
        return order > 0 ? 0 : x < xs[0] ? ys[0] : ys[n - 1];

    const int i = interval_of(table, x);
    const double h = xs[i + 1] - xs[i], a = (xs[i + 1] - x) / h, b = (x - xs[i]) / h;

    switch (order) {
    case 0:
        return a * ys[i] + b * ys[i + 1] +
               ((a * a * a - a) * ms[i] + (b * b * b - b) * ms[i + 1]) * h * h / 6;
    case 1:
        return (ys[i + 1] - ys[i]) / h +
               ((3 * b * b - 1) * ms[i + 1] - (3 * a * a - 1) * ms[i]) * h / 6;
    case 2:
        return a * ms[i] + b * ms[i + 1];
    case 3:
        return (ms[i + 1] - ms[i]) / h;
    default:
        return 0;
    }
}

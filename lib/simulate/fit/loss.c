/* loss.c: losses and their derivatives by the square of the residual */
#include "simulate/fit/loss.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

typedef struct LossRow {
    const char *name;
    double tuning;
} LossRow;

static const LossRow rows[LOSSES] = {
    [LOSS_SQUARES] = {"squares", 1},
    [LOSS_HUBER] = {"huber", 1.345},
    [LOSS_CAUCHY] = {"cauchy", 2.385},
    [LOSS_SOFT_L1] = {"soft_l1", 1.345},
};

const char *loss_name(Loss loss)
{
    return rows[loss].name;
}

double loss_tuning(Loss loss)
{
    return rows[loss].tuning;
}

double loss_value(Loss loss, double u)
{
    switch (loss) {
    case LOSS_HUBER:
        return u <= 1 ? u : 2 * sqrt(u) - 1;
    case LOSS_CAUCHY:
        return log1p(u);
    case LOSS_SOFT_L1:
        return 2 * u / (sqrt(1 + u) + 1);
    default:
        return u;
    }
}

double loss_slope(Loss loss, double u)
{
    switch (loss) {
    case LOSS_HUBER:
        return u <= 1 ? 1 : 1 / sqrt(u);
    case LOSS_CAUCHY:
        return 1 / (1 + u);
    case LOSS_SOFT_L1:
        return 1 / sqrt(1 + u);
    default:
        return 1;
    }
}

double loss_curvature(Loss loss, double u)
{
    switch (loss) {
    case LOSS_HUBER:
        return u <= 1 ? 0 : -0.5 / (u * sqrt(u));
    case LOSS_CAUCHY:
        return -1 / ((1 + u) * (1 + u));
    case LOSS_SOFT_L1:
        return -0.5 / ((1 + u) * sqrt(1 + u));
    default:
        return 0;
    }
}

static int compare(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

double loss_deviation(const double *z, int count)
{
    double *sizes = NEW_ARRAY(double, count + 1), median;

    for (int i = 0; i < count; i++)
        sizes[i] = fabs(z[i]);
    qsort(sizes, (size_t)count, sizeof *sizes, compare);
    median = count == 0 ? 0 : (sizes[(count - 1) / 2] + sizes[count / 2]) / 2;
    mem_free(sizes);
    return 1.4826 * median;
}

/* dop853_scale.c: scale of errors in dop853: the tolerance of each entry */
#include "simulate/integrate/dop853_impl.h"

#include "base/four.h"

#include <math.h>

double dop853_norm(const Dop853 *d, const double *v)
{
    double sum = 0;

    for (int i = 0; i < d->n; i++)
        sum += v[i] / d->scale[i] * (v[i] / d->scale[i]);
    return sqrt(sum / (d->n > 0 ? d->n : 1));
}

double dop853_product(const Dop853 *d, const double *v, const double *w)
{
    double sum = 0;

    for (int i = 0; i < d->n; i++)
        sum += v[i] / d->scale[i] * (w[i] / d->scale[i]);
    return sum;
}

/* dop853_choose_scale() for the first entries, four at a time, where nominal values are 1 and there
 * are magnitude bounds; returns how many. */
AS_WIDE_AS_CAN_BE static int choose_many_scales(Dop853 *d, const double *a, const double *b)
{
    const FourTruths size = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX}; /* all but the sign */
    const double *magnitude_bound = d->base.ode->magnitude_bound;
    int i = 0;

    for (; i + 4 <= d->n; i += 4) {
        const FourTruths one = (FourTruths)(*(const Four *)(a + i)) & size;
        const FourTruths other = (FourTruths)(*(const Four *)(b + i)) & size;
        const Four most = *(const Four *)(magnitude_bound + i);
        const FourTruths second = (Four)other > (Four)one;
        const Four larger = (Four)((other & second) | (one & ~second));
        const FourTruths within = larger < most;
        const Four capped = (Four)(((FourTruths)larger & within) | ((FourTruths)most & ~within));

        *(Four *)(d->scale + i) =
            DOP853_AIM * (d->base.control.atol + d->base.control.rtol * capped);
    }
    return i;
}

void dop853_choose_scale(Dop853 *d, const double *a, const double *b)
{
    const Ode *ode = d->base.ode;
    const double *error_floor = ode->error_floor;
    const bool is_plain = error_floor == NULL && ode->unit == NULL && ode->magnitude_bound != NULL;

    for (int i = is_plain ? choose_many_scales(d, a, b) : 0; i < d->n; i++) {
        d->scale[i] = DOP853_AIM * stepper_tolerance(&d->base, i, fmax(fabs(a[i]), fabs(b[i])));
        if (error_floor != NULL)
            d->scale[i] = fmax(d->scale[i], error_floor[i]);
    }
}

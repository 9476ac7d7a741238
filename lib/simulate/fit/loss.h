/* loss.h: what a residual z costs: c^2 rho((z/c)^2), so that outliers count less than by squares */
#ifndef COTREE_SIMULATE_FIT_LOSS_H
#define COTREE_SIMULATE_FIT_LOSS_H

typedef enum Loss { LOSS_SQUARES, LOSS_HUBER, LOSS_CAUCHY, LOSS_SOFT_L1, LOSSES } Loss;

const char *loss_name(Loss loss); /* "huber" */
/* rho(u), u = (z/c)^2 */
double loss_value(Loss loss, double u);
double loss_slope(Loss loss, double u);     /* rho': the weight of the square */
double loss_curvature(Loss loss, double u); /* rho'' */
/* The scale c of residuals with the standard deviation 1: estimates from normal residuals then have
 * 95 % efficiency (Huber 1981; soft_l1 has the constant of huber). */
double loss_tuning(Loss loss);
/* 1.4826 times the median of |z|: the standard deviation of normal residuals, whatever a few others
 * are */
double loss_deviation(const double *z, int count);

#endif

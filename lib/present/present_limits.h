/* present_limits.h: tolerances of what is shown */
#ifndef COTREE_PRESENT_PRESENT_LIMITS_H
#define COTREE_PRESENT_PRESENT_LIMITS_H

/* Powers at an instant, relative to the sum of magnitudes over a domain (1). A power below the
 * first consists of rounding errors, some 1e4 of them: it is a sum over many terms. A sum below the
 * second is 0: accelerations and multipliers are solved for, with the condition of their
 * equations. */
#define POWER_NOISE   1e-12
#define POWER_BALANCE 1e-9

/* The largest entry of Phi_q G relative to its terms (1): entries of G are quotients of
 * determinants of up to three rows, which cancel where Phi_d is nearly singular. */
#define COMPLEMENT_ROUNDING 1e-9

/* of the energies of a run: a smaller loss consists of rounding errors, of a part that sticks */
#define LOSS_NOISE 1e-12

#endif

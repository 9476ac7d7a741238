/* redundant.h: reports constraint rows that others repeat, joint by joint */
#ifndef COTREE_SIMULATE_EQUATIONS_REDUNDANT_H
#define COTREE_SIMULATE_EQUATIONS_REDUNDANT_H

#include "formulate/system/system.h"
#include "simulate/equations/remark.h"

/* A remark for each joint with dependent rows ("redundant: h9 (x, y) repeats h8, h10"), and one
 * about the remaining freedoms and reactions. `phi_u` is m x nu; order and rank are those of
 * rank_rows(). O(nu m^2). */
void redundant_remark(const System *system, const double *phi_u, const int *order, int rank,
                      Remarks *out);

#endif

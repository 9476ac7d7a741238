/* c_step.h: one step of exported C */
#ifndef COTREE_EXPORT_C_STEP_H
#define COTREE_EXPORT_C_STEP_H

#include "export/code.h"

/* The classical Runge-Kutta method on smooth equations, y' = f(t, y), with projection; of sampled
 * models also model_step(), which sets sampled states at whole multiples of their periods. */
void c_step_add(const Code *code, const Language *language, Text *out);
/* likewise model_step() through modes of ideal switches, which is made of that */
void c_step_add_modes(const Code *code, const Language *language, Text *out);

#endif

/* mode_forms.h: Hessenberg forms of linear equations, one per mode of the switches, cached for a
 * run
 *
 * A run returns to most of its modes, and computing a form costs as much as many steps. The oldest
 * forms are discarded where memory would grow without bound. */
#ifndef COTREE_SIMULATE_EQUATIONS_MODE_FORMS_H
#define COTREE_SIMULATE_EQUATIONS_MODE_FORMS_H

#include "algebra/hessenberg_form.h"

typedef struct ModeForms ModeForms;

ModeForms *mode_forms_new(int switches); /* new; free with mode_forms_free() */
void mode_forms_free(ModeForms *forms);  /* NULL is fine */
/* The form of these switch states; borrowed until the next mode_forms_store(). NULL: none is
 * stored. */
const HessenbergForm *mode_forms_find(const ModeForms *forms, const bool *closed);
/* Store `given` for these switch states, for which none is stored. The result is borrowed
 * likewise. */
const HessenbergForm *mode_forms_store(ModeForms *forms, const bool *closed, HessenbergForm *given);

#endif

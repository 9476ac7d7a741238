/* mode_forms.h: Hessenberg forms of linear equations, one a mode of switches, kept for a run
 *
 * A run comes back to most of its modes, and a form costs as much as many steps. Those kept longest
 * are forgotten where memory would grow without bound. */
#ifndef COTREE_SIMULATE_EQUATIONS_MODE_FORMS_H
#define COTREE_SIMULATE_EQUATIONS_MODE_FORMS_H

#include "algebra/hessenberg_form.h"

typedef struct ModeForms ModeForms;

ModeForms *mode_forms_new(int switches); /* new; free with mode_forms_free() */
void mode_forms_free(ModeForms *forms);  /* NULL is fine */
/* The form with the switches on these sides; borrowed until the next mode_forms_store(). NULL: none
 * is kept. */
const HessenbergForm *mode_forms_find(const ModeForms *forms, const bool *closed);
/* Keep `given` for these sides, of which none is kept. The result is borrowed likewise. */
const HessenbergForm *mode_forms_store(ModeForms *forms, const bool *closed, HessenbergForm *given);

#endif

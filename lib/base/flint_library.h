/* flint_library.h: FLINT, loaded where it is first used
 *
 * The dynamic linker binds 7400 symbols of FLINT and NTL when it loads them, which takes as long as
 * the rest of the shell's start. Few sessions need them. */
#ifndef COTREE_BASE_FLINT_LIBRARY_H
#define COTREE_BASE_FLINT_LIBRARY_H

#include "base/diag.h"

#include <gmp.h>

#include <flint/fmpz_mpoly.h>

typedef struct FlintLibrary {
#define FLINT(name) __typeof__(name) *name;
#include "base/flint_functions.def"
#undef FLINT
} FlintLibrary;

/* FLINT's functions; NULL before flint_load() */
extern FlintLibrary flint;

/* Fails with E_MISSING where FLINT can't be loaded. */
MUST_USE Status flint_load(Diag *diag);

#endif

/* four.h: four numbers at a time, as wide as the processor that runs has it: numbers are the same
 */
#ifndef COTREE_BASE_FOUR_H
#define COTREE_BASE_FOUR_H

#include <stdint.h>

typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t FourTruths __attribute__((vector_size(32), aligned(8))); /* -1: so; 0: not so */

/* Attribute of functions that compute with them. Not with the thread sanitizer, which isn't
 * initialised yet when the loader selects one of the two versions. */
#if defined __x86_64__ && defined __GLIBC__ && !defined __clang__ && !defined __SANITIZE_THREAD__
#define AS_WIDE_AS_CAN_BE __attribute__((target_clones("avx2", "default")))
#else
#define AS_WIDE_AS_CAN_BE
#endif

#endif

/* simd_batch.h: a program at several inputs at once
 *
 * Native code computes as many lanes together as the processor supports; the interpreter eight
 * together, fewer one by one. A stage runs again only when one of its inputs has changed. A batch
 * has 1, 2, 4 or 8 lanes. Nothing is allocated after creation. A SimdBatch is used by one thread;
 * the Native, which several may share, is const. */
#ifndef COTREE_COMPILE_SIMD_BATCH_H
#define COTREE_COMPILE_SIMD_BATCH_H

#include "compile/native.h"

typedef struct SimdBatch SimdBatch;

/* Native code for so many lanes; NULL: the interpreter is faster, or this processor isn't
 * supported. New; borrows the program. */
Native *simd_batch_native(const Program *program, int lanes, Evaluator evaluator);
/* The same, where it is made sooner than the interpreter has run so often; NULL elsewhere. */
Native *simd_batch_native_if_it_pays(const Program *program, int lanes, Evaluator evaluator,
                                     long runs);
/* New; simd_batch_free(). Borrows both; `native` was made for as many lanes, or is NULL. Inputs are
 * 0.
 */
SimdBatch *simd_batch_new(const Program *program, const Native *native, int lanes);
void simd_batch_free(SimdBatch *lanes); /* NULL is fine */
/* an input of that stage: one number for each lane */
void simd_batch_set(SimdBatch *lanes, int input, Stage stage, const double *values);
void simd_batch_run(SimdBatch *lanes);
void simd_batch_get(const SimdBatch *lanes, int root, double *out); /* of every lane */
double simd_batch_root(const SimdBatch *lanes, int root, int lane);

#endif

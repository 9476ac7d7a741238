/* jacobian.h: a sparse matrix of derivatives of a program's roots, by its tangents
 *
 * Each column is a direction. Columns that no root feels together are carried together (Curtis,
 * Powell and Reid 1974). */
#ifndef COTREE_COMPILE_JACOBIAN_H
#define COTREE_COMPILE_JACOBIAN_H

#include "algebra/pattern.h"
#include "base/memory.h"
#include "compile/program.h"

typedef struct Jacobian Jacobian;

/* an input that a column moves */
typedef struct ColumnMove {
    int column, input;
} ColumnMove;

typedef LIST(ColumnMove) ColumnMoves;

/* Columns from `first` on move the inputs from `input` on, one each; appended. */
void moves_push(ColumnMoves *moves, int first, int input, int count);

/* Of the first `rows` roots; new, jacobian_free(). Borrows the program, copies `moves`. O(columns
 * times instructions / 64, and entries times their rows). */
Jacobian *jacobian_new(const Program *program, int rows, int columns, const ColumnMove *moves,
                       int count);
void jacobian_free(Jacobian *jacobian); /* NULL is fine */
/* entries that may not be 0; borrowed */
const Pattern *jacobian_pattern(const Jacobian *jacobian);
/* These entries at `inputs`, where each of the moves is `by` as large; NULL: all 1. */
void jacobian_at(Jacobian *jacobian, const double *inputs, const double *by, double *out);

#endif

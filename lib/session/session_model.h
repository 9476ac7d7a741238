/* session_model.h: a model as functions of numbers, compiled: what session_model.c makes and
 * session_evaluator.c evaluates */
#ifndef COTREE_SESSION_SESSION_MODEL_H
#define COTREE_SESSION_SESSION_MODEL_H

#include "compile/simd_batch.h"
#include "cotree.h"
#include "export/code.h"

/* entries by entries of a part, those that aren't 0 */
typedef struct SessionSlopes {
    int count;
    int *row, *column;
    Program *program;
    Native *native;
} SessionSlopes;

enum { DIFFERENTIABLE = CT_OUTPUTS }; /* parts that functions are differentiated by */

typedef struct ModelFunction {
    const char *name;
    int rows, columns;
    Program *program;
    Native *native;
    bool has_slopes;
    SessionSlopes slopes[DIFFERENTIABLE];
} ModelFunction;

typedef struct ModelEntry {
    const char *name, *unit;
} ModelEntry;

struct ct_model {
    Pool *texts;
    LIST(ModelFunction) functions;
    LIST(ModelEntry) entries[CT_OUTPUTS + 1];
    double *start[DIFFERENTIABLE];
    struct ModelInput {
        CodeArray array;
        int place;
        Stage stage;
    } * inputs;
    int input_count;
    CodeGroup groups[2];
    int group_count;
    int n, nu, nx, m, ns;
    int accelerations; /* functions; -1: there is none */
    int residual;
    LIST(int) quaternions; /* first of four */
    bool is_redundant;
    int lanes;
    int largest; /* largest count of results of a function, or of unknowns of a group */
};

int model_function_find(const ct_model *model, const char *name);

#endif

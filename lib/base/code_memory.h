/* code_memory.h: memory that a processor runs
 *
 * It is written while it can't be run, and can't be written from then on. */
#ifndef COTREE_BASE_CODE_MEMORY_H
#define COTREE_BASE_CODE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/* What computes programs: code for this processor with the bits of the interpreter; the same, but
 * that a product and sum may be rounded once; or the interpreter, as where no such code can be
 * run. */
typedef enum Evaluator { EVALUATOR_STRICT, EVALUATOR_NATIVE, EVALUATOR_INTERPRETER } Evaluator;

typedef struct CodeMemory CodeMemory;

/* New, with these bytes; NULL: the system has none, or refuses it. */
CodeMemory *code_memory_new(const void *bytes, size_t size);
void code_memory_free(CodeMemory *memory); /* NULL is fine */
const void *code_memory_at(const CodeMemory *memory);
/* whether programs can be made native here: by this processor, and by this system */
bool code_memory_is_there(void);

#endif

/* linear_entries.h: A of what a script linearizes, in numbers */
#ifndef COTREE_TESTS_LINEAR_ENTRIES_H
#define COTREE_TESTS_LINEAR_ENTRIES_H

#include <stddef.h>

/* A row by row, new, free(); NULL, and why into `reason`, where the script fails. */
double *linear_entries(const char *script, int *states, char *reason, size_t size);

#endif

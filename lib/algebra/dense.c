/* dense.c: GSL vectors and matrices allocated with their numbers in one block */
#include "algebra/dense.h"

#include "base/memory.h"

#include <gsl/gsl_errno.h>
#include <threads.h>

#define HEAD(type) ((sizeof(type) + 15) & ~(size_t)15)

static void switch_off(void)
{
    (void)gsl_set_error_handler_off();
}

void dense_quiet(void)
{
    static once_flag once = ONCE_FLAG_INIT;

    call_once(&once, switch_off);
}

/* `count` numbers of that size after the head of the object. A size that overflows size_t is
 * treated as out of memory. */
static void *numbers_after_head(void **numbers, size_t head, size_t count, size_t size)
{
    char *piece;

    dense_quiet();
    piece = mem_array(count + (head + size - 1) / size, size);

    *numbers = piece + head;
    return piece;
}

gsl_matrix *dense_matrix(size_t rows, size_t columns)
{
    const size_t count =
        columns == 0 || rows <= (SIZE_MAX >> 1) / columns ? rows * columns : SIZE_MAX >> 1;
    void *numbers;
    gsl_matrix *matrix = numbers_after_head(&numbers, HEAD(gsl_matrix), count, sizeof(double));

    *matrix = (gsl_matrix){.size1 = rows, .size2 = columns, .tda = columns, .data = numbers};
    return matrix;
}

gsl_vector *dense_vector(size_t count)
{
    void *numbers;
    gsl_vector *vector = numbers_after_head(&numbers, HEAD(gsl_vector), count, sizeof(double));

    *vector = (gsl_vector){.size = count, .stride = 1, .data = numbers};
    return vector;
}

gsl_permutation *dense_permutation(size_t count)
{
    void *numbers;
    gsl_permutation *order =
        numbers_after_head(&numbers, HEAD(gsl_permutation), count, sizeof(size_t));

    *order = (gsl_permutation){.size = count, .data = numbers};
    return order;
}

/* jacobian.c: which roots depend on which columns, and columns in SIMD batches */
#include "compile/jacobian.h"

#include "base/memory.h"
#include "compile/program_impl.h"
#include "compile/tangents.h"

#include <string.h>

enum { BITS = 64 };

struct Jacobian {
    const Program *program;
    int count;
    ColumnMove *moves;
    Pattern pattern;
    int *first_move; /* of each column, rising, in `by_column`; columns + 1 */
    int *by_column;
    int colours;
    int *colour;        /* of each column */
    Tangents *tangents; /* NULL: not used yet */
};

/* --- pattern --- */

typedef struct JacobianTerms {
    LIST(int) row;
    LIST(int) column;
} JacobianTerms;

/* propagate the bits of inputs to everything computed from them */
static void reach(const Program *program, uint64_t *mask)
{
    for (int r = 0; r < program->runs.count; r++) {
        const OpcodeRun *run = &program->runs.at[r];
        const int operands = code_operands(run->code);
        const int results = run->code == CODE_SINCOS ? 2 : 1;
        const uint32_t *operand = program->tape.at + run->operands;

        for (int i = 0; i < run->count; i++) {
            uint64_t any = 0;

            for (int k = 0; k < operands; k++)
                any |= mask[*operand++];
            for (int k = 0; k < results; k++)
                mask[run->result + results * i + k] = any;
        }
    }
}

static void find_terms(const Jacobian *j, int rows, int first, uint64_t *mask, JacobianTerms *terms)
{
    const Program *program = j->program;

    memset(mask, 0, (size_t)program->slot_count * sizeof *mask);
    for (int k = 0; k < j->count; k++)
        if (j->moves[k].column >= first && j->moves[k].column < first + BITS)
            mask[j->moves[k].input] |= (uint64_t)1 << (j->moves[k].column - first);
    reach(program, mask);
    for (int i = 0; i < program->root_count; i++) {
        const uint64_t felt = mask[program->roots[i].slot];

        for (int bit = 0; bit < BITS && felt >> bit != 0 && program->roots[i].root < rows; bit++)
            if ((felt >> bit & 1) != 0) {
                LIST_PUSH(terms->row, program->roots[i].root);
                LIST_PUSH(terms->column, first + bit);
            }
    }
}

static void find_pattern(Jacobian *j, int rows, int columns)
{
    uint64_t *mask = mem_array((size_t)j->program->slot_count, sizeof *mask);
    JacobianTerms terms = {0};
    int *place;

    for (int first = 0; first < columns; first += BITS)
        find_terms(j, rows, first, mask, &terms);
    place = NEW_ARRAY(int, terms.row.count);
    j->pattern = pattern_of(rows, columns, terms.row.count, terms.row.at, terms.column.at, place);
    LIST_FREE(terms.row);
    LIST_FREE(terms.column);
    MEM_FREE(mask, place);
}

/* --- colours --- */

/* Each column receives the first colour that no row of it has yet. */
static void choose_colours(Jacobian *j)
{
    const Pattern *p = &j->pattern;
    int *place = NEW_ARRAY(int, p->count);
    int *taken = NEW_ARRAY(int, p->columns + 1); /* by which column last; plus 1 */
    Pattern by_row = pattern_of(p->columns, p->rows, p->count, p->column, p->row, place);

    for (int c = 0; c < p->columns; c++) {
        for (int k = p->start[c]; k < p->start[c + 1]; k++)
            for (int i = by_row.start[p->row[k]];
                 i < by_row.start[p->row[k] + 1] && by_row.row[i] < c; i++)
                taken[j->colour[by_row.row[i]]] = c + 1;
        while (taken[j->colour[c]] == c + 1)
            j->colour[c]++;
        if (j->colour[c] >= j->colours)
            j->colours = j->colour[c] + 1;
    }
    pattern_free(&by_row);
    MEM_FREE(place, taken);
}

/* --- a matrix --- */

void moves_push(ColumnMoves *moves, int first, int input, int count)
{
    for (int i = 0; i < count; i++)
        LIST_PUSH(*moves, (ColumnMove){.column = first + i, .input = input + i});
}

static void sort_moves(Jacobian *j, int columns)
{
    j->first_move = NEW_ARRAY(int, columns + 2);
    j->by_column = NEW_ARRAY(int, j->count);
    for (int k = 0; k < j->count; k++)
        j->first_move[j->moves[k].column + 2]++;
    for (int c = 0; c < columns; c++)
        j->first_move[c + 2] += j->first_move[c + 1];
    for (int k = 0; k < j->count; k++)
        j->by_column[j->first_move[j->moves[k].column + 1]++] = k;
}

Jacobian *jacobian_new(const Program *program, int rows, int columns, const ColumnMove *moves,
                       int count)
{
    Jacobian *j = NEW(Jacobian);

    j->program = program;
    j->count = count;
    j->moves = mem_array((size_t)count, sizeof *j->moves);
    if (count > 0)
        memcpy(j->moves, moves, (size_t)count * sizeof *moves);
    sort_moves(j, columns);
    j->colour = NEW_ARRAY(int, columns);
    find_pattern(j, rows, columns);
    choose_colours(j);
    return j;
}

void jacobian_free(Jacobian *j)
{
    if (j == NULL)
        return;
    tangents_free(j->tangents);
    pattern_free(&j->pattern);
    MEM_FREE(j->moves, j->first_move, j->by_column, j->colour, j);
}

const Pattern *jacobian_pattern(const Jacobian *jacobian)
{
    return &jacobian->pattern;
}

/* the columns of a few colours, one lane for each colour */
static void carry(Jacobian *j, int first, const double *by, double *out)
{
    const Pattern *p = &j->pattern;

    tangents_clear(j->tangents);
    for (int c = 0; c < p->columns; c++) {
        const int lane = j->colour[c] - first;

        for (int i = j->first_move[c];
             i < j->first_move[c + 1] && lane >= 0 && lane < TANGENT_BATCH; i++) {
            const int k = j->by_column[i];

            tangents_move(j->tangents, lane, j->moves[k].input, by != NULL ? by[k] : 1, 0);
        }
    }
    tangents_run(j->tangents);
    for (int c = 0; c < p->columns; c++) {
        const int lane = j->colour[c] - first;

        for (int k = p->start[c]; k < p->start[c + 1] && lane >= 0 && lane < TANGENT_BATCH; k++)
            out[k] = tangents_root(j->tangents, p->row[k], lane, NULL);
    }
}

void jacobian_at(Jacobian *j, const double *inputs, const double *by, double *out)
{
    if (j->tangents == NULL)
        j->tangents = tangents_new(j->program);
    tangents_at(j->tangents, inputs, NULL);
    for (int first = 0; first < j->colours; first += TANGENT_BATCH)
        carry(j, first, by, out);
}

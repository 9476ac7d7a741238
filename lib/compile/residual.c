/* residual.c: derivatives of rows by the unknowns in them, and the program of all */
#include "compile/residual.h"

#include "base/memory.h"
#include "compile/program_impl.h"

#include <stdlib.h>
#include <string.h>

struct Residual {
    int uses;  /* number of owners: callers, and the arena */
    Expr *key; /* the order's roots, unknowns and inputs; NULL: not cached */
    int input_count, parts;
    Program *program;
    int row_count, unknown_count;
    int first_slope;
    LIST(Slope) slopes;
    Expr *parameters;
    int parameter_count;
};

typedef LIST(Expr) ResidualRoots;

/* by numbers of symbols: which unknown it is; -1: none */
typedef struct Numbering {
    int *unknown;
    int count;
} Numbering;

static Numbering number_unknowns(const ResidualOrder *order)
{
    Numbering out = {.count = 0};

    for (int i = 0; i < order->unknown_count; i++)
        if (expr_symbol_number(order->unknowns[i]) >= out.count)
            out.count = expr_symbol_number(order->unknowns[i]) + 1;
    out.unknown = NEW_ARRAY(int, out.count);
    for (int i = 0; i < out.count; i++)
        out.unknown[i] = -1;
    for (int i = 0; i < order->unknown_count; i++)
        out.unknown[expr_symbol_number(order->unknowns[i])] = i;
    return out;
}

static int compare(const void *a, const void *b)
{
    const int *one = a, *other = b;

    return (*one > *other) - (*one < *other);
}

/* the unknowns in a row, rising; new */
static int *unknowns_in(Expr row, const Numbering *numbering, int *count)
{
    Expr *symbols;
    const int found = expr_symbols(&row, 1, &symbols);
    int *out = NEW_ARRAY(int, found);

    *count = 0;
    for (int i = 0; i < found; i++) {
        const int number = expr_symbol_number(symbols[i]);

        if (number < numbering->count && numbering->unknown[number] >= 0)
            out[(*count)++] = numbering->unknown[number];
    }
    if (*count > 1)
        qsort(out, (size_t)*count, sizeof(int), compare);
    mem_free(symbols);
    return out;
}

static Status differentiate(const ResidualOrder *order, Residual *r, ResidualRoots *roots)
{
    const Numbering numbering = number_unknowns(order);
    Status status = OK;

    for (int i = 0; i < order->row_count && order->unknown_count > 0 && status == OK; i++) {
        int count;
        int *in_row = unknowns_in(order->roots[i], &numbering, &count);

        for (int k = 0; k < count && status == OK; k++) {
            Expr slope = expr_diff(order->arena, order->roots[i], order->unknowns[in_row[k]]);

            status = monitor_poll(order->watch);
            if (expr_is_zero(slope))
                continue;
            LIST_PUSH(r->slopes, (Slope){i, in_row[k], expr_kinds(slope)});
            LIST_PUSH(*roots, slope);
        }
        mem_free(in_row);
    }
    mem_free(numbering.unknown);
    return status;
}

/* the inputs after those of the order */
static void take_parameters(const ResidualOrder *order, Residual *r, const Lowered *lowered)
{
    r->parameter_count = lowered->input_count - order->input_count;
    r->parameters = NEW_ARRAY(Expr, r->parameter_count);
    if (r->parameter_count > 0)
        memcpy(r->parameters, lowered->inputs + order->input_count,
               (size_t)r->parameter_count * sizeof(Expr));
}

/* --- those made before --- */

/* number of operations from which on compiling takes longer than searching the cache */
enum { WORTH_KEEPING = 2000 };

static uint64_t mix(uint64_t h, const Expr *symbols, int count, uint32_t *newest)
{
    h = (h ^ (uint64_t)count) * 0x9E3779B97F4A7C15U;
    for (int i = 0; i < count; i++) {
        const uint32_t number = expr_number(symbols[i]);

        h = (h ^ number) * 0xFF51AFD7ED558CCDU;
        h ^= h >> 32;
        *newest = number > *newest ? number : *newest;
    }
    return h;
}

static uint64_t hash_order(const ResidualOrder *order, uint32_t *newest)
{
    uint64_t h = mix((uint64_t)order->row_count, order->roots, order->root_count, newest);

    h = mix(h, order->unknowns, order->unknown_count, newest) + (uint64_t)order->blocks.parts;
    return mix(h, order->inputs, order->input_count, newest);
}

static bool same_part(const Expr *key, const Expr *asked, int count)
{
    return count == 0 || memcmp(key, asked, (size_t)count * sizeof(Expr)) == 0;
}

static bool is_of(const void *object, const void *asked)
{
    const Residual *r = object;
    const ResidualOrder *order = asked;
    const Expr *unknowns = r->key + r->first_slope, *inputs = unknowns + r->unknown_count;

    return r->row_count == order->row_count && r->first_slope == order->root_count &&
           r->unknown_count == order->unknown_count && r->input_count == order->input_count &&
           r->parts == order->blocks.parts && same_part(r->key, order->roots, order->root_count) &&
           same_part(unknowns, order->unknowns, order->unknown_count) &&
           same_part(inputs, order->inputs, order->input_count);
}

static int operations(const Program *program)
{
    int sum = 0;

    for (Stage stage = 0; stage < STAGE_COUNT; stage++)
        sum += program_operations(program, stage);
    return sum;
}

static void copy_part(Expr **to, const Expr *from, int count)
{
    if (count > 0)
        memcpy(*to, from, (size_t)count * sizeof(Expr));
    *to += count;
}

static void release(void *residual)
{
    residual_free(residual);
}

static void keep(Residual *r, const ResidualOrder *order, uint64_t hash, uint32_t newest)
{
    const Made made = {
        .hash = hash, .newest = newest, .object = r, .is = is_of, .release = release};
    Expr *to = r->key =
        NEW_ARRAY(Expr, order->root_count + order->unknown_count + order->input_count);

    copy_part(&to, order->roots, order->root_count);
    copy_part(&to, order->unknowns, order->unknown_count);
    copy_part(&to, order->inputs, order->input_count);
    r->uses++;
    arena_add_made(order->arena, &made);
}

/* whether the compiled roots are the present ones */
static bool is_plain(const ResidualOrder *order)
{
    for (int i = 0; order->put != NULL && i < order->root_count; i++)
        if (order->put(order->context, order->roots[i]) != order->roots[i])
            return false;
    return true;
}

/* --- making --- */

/* of the inputs of its program; new */
static int *blocks_of(const ResidualOrder *order, int count)
{
    int *blocks = NEW_ARRAY(int, count);

    for (int i = 0; order->blocks.parts > 1 && i < order->input_count; i++)
        blocks[i] = order->blocks.block[i];
    return blocks;
}

static Status make(const ResidualOrder *order, Residual **out, Diag *diag)
{
    Residual *r = NEW(Residual);
    ResidualRoots roots = {0};
    Lowered lowered = {0};
    int *blocks = NULL;
    Status status = OK;

    r->uses = 1;
    r->row_count = order->row_count;
    r->unknown_count = order->unknown_count;
    r->input_count = order->input_count;
    r->parts = order->blocks.parts;
    r->first_slope = order->root_count;
    for (int i = 0; i < order->root_count; i++)
        LIST_PUSH(roots, order->roots[i]);
    CHECK(differentiate(order, r, &roots));
    for (int i = 0; i < roots.count && order->put != NULL; i++)
        roots.at[i] = order->put(order->context, roots.at[i]);
    CHECK(lowered_make_again(order->arena, roots.at, roots.count, order->inputs, order->input_count,
                             &lowered, diag));
    take_parameters(order, r, &lowered);
    blocks = blocks_of(order, lowered.input_count);
    r->program = program_of(&lowered, &(ProgramBlocks){blocks, order->blocks.parts});
    *out = r;
    r = NULL;
done:
    LIST_FREE(roots);
    mem_free(blocks);
    residual_free(r);
    return status;
}

Status residual_new(const ResidualOrder *order, Residual **out, Diag *diag)
{
    uint32_t newest = 0;
    const uint64_t hash = hash_order(order, &newest);
    Residual *r = arena_find_made(order->arena, hash, is_of, order);
    Status status = OK;

    if (r != NULL && is_plain(order)) {
        mem_keep(r);
        r->uses++;
        *out = r;
        return OK;
    }
    CHECK(make(order, &r, diag));
    if (operations(r->program) >= WORTH_KEEPING && is_plain(order))
        keep(r, order, hash, newest);
    *out = r;
done:
    return status;
}

void residual_free(Residual *r)
{
    if (r == NULL)
        return;
    mem_keep(r);
    if (--r->uses > 0)
        return;
    program_free(r->program);
    LIST_FREE(r->slopes);
    mem_free(r->parameters);
    mem_free(r->key);
    mem_free(r);
}

const Program *residual_program(const Residual *r)
{
    return r->program;
}

const Expr *residual_parameters(const Residual *r, int *count)
{
    *count = r->parameter_count;
    return r->parameters;
}

const Slope *residual_slopes(const Residual *r, int *count)
{
    *count = r->slopes.count;
    return r->slopes.at;
}

int residual_row_count(const Residual *r)
{
    return r->row_count;
}

int residual_first_slope(const Residual *r)
{
    return r->first_slope;
}

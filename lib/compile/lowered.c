/* lowered.c: selects the values that the roots of one program need
 *
 * The arena stores the lowering of a large program. After an edit most equations are the same
 * expressions as before, so that only new ones are lowered. Programs number their inputs and pair
 * sines with cosines; the stored lowering does neither. */
#include "compile/lower_impl.h"
#include "compile/program.h"

#include <stdlib.h>
#include <string.h>

#ifdef COTREE_SMALL
enum { WORTH_KEEPING = 8 };
#else
enum { WORTH_KEEPING = 2000 }; /* values */
#endif
enum { MOST_IDLE = 4 }; /* stored values for each one that the last program needed */

/* --- the inputs of a program --- */

typedef struct Picking {
    const Lowering *low;
    Lowered *out;
    uint32_t *place; /* of each value in `out`: plus 1; 0: no root needs it */
} Picking;

static bool has_operands(const LoweredValue *value)
{
    return value->code < CODES;
}

/* operands precede their users */
static void mark_needed(Picking *picking, const uint32_t *roots, int root_count)
{
    const Lowering *low = picking->low;

    for (int i = 0; i < root_count; i++)
        picking->place[roots[i]] = 1;
    for (int v = low->values.count - 1; v >= 0; v--) {
        const LoweredValue *value = &low->values.at[v];

        if (picking->place[v] == 0 || !has_operands(value))
            continue;
        for (int i = 0; i < code_operands(value->code); i++)
            picking->place[value->args[i]] = 1;
    }
}

static int by_number(const void *a, const void *b)
{
    return expr_symbol_number(*(const Expr *)a) - expr_symbol_number(*(const Expr *)b);
}

static void add_input(Picking *picking, Expr symbol)
{
    const Lowering *low = picking->low;
    const uint32_t number = expr_number(symbol);
    const int place = picking->out->input_count++;
    const Stage stage = stage_of_symbol(expr_symbol_kind(symbol));

    picking->out->inputs[place] = symbol;
    picking->out->values.at[picking->out->values.count++] =
        (LoweredValue){.code = CODE_INPUT, .stage = (uint8_t)stage, .args = {(uint32_t)place}};
    if (number < low->known_count && low->known[number] != 0)
        picking->place[(low->known[number] - 1) / 2] = (uint32_t)place + 1;
}

/* those that a root needs and that aren't inputs; new */
static Expr *find_missing(const Picking *picking, const Expr *inputs, int input_count, int *count)
{
    const Lowering *low = picking->low;
    Expr *missing = NEW_ARRAY(Expr, low->symbols.count);
    bool *is_given = NEW_ARRAY(bool, low->symbols.count);

    *count = 0;
    for (int i = 0; i < input_count; i++) {
        const uint32_t number = expr_number(inputs[i]);

        if (number < low->known_count && low->known[number] != 0)
            is_given[low->values.at[(low->known[number] - 1) / 2].args[0]] = true;
    }
    for (int v = 0; v < low->values.count; v++) {
        const LoweredValue *value = &low->values.at[v];

        if (value->code == CODE_INPUT && picking->place[v] != 0 && !is_given[value->args[0]])
            missing[(*count)++] = low->symbols.at[value->args[0]];
    }
    mem_free(is_given);
    return missing;
}

static Status pick_inputs(Picking *picking, const Expr *inputs, int input_count,
                          bool takes_parameters, Diag *diag)
{
    Lowered *out = picking->out;
    int count;
    Expr *missing = find_missing(picking, inputs, input_count, &count);
    Status status = OK;

    for (int i = 0; i < count && status == OK; i++)
        if (!takes_parameters || expr_symbol_kind(missing[i]) != SYMBOL_PARAMETER) {
            status = diag_set(diag, E_NAME, "%s has no value here", expr_name(missing[i]));
            diag_hint(diag, "it is needed and is none of the inputs");
        }
    if (status == OK) {
        if (count > 1)
            qsort(missing, (size_t)count, sizeof(Expr), by_number);
        out->inputs = NEW_ARRAY(Expr, input_count + count);
        LIST_ROOM(out->values, input_count + picking->low->values.count);
        for (int i = 0; i < input_count; i++)
            add_input(picking, inputs[i]);
        for (int i = 0; i < count; i++)
            add_input(picking, missing[i]);
    }
    mem_free(missing);
    return status;
}

/* --- its values --- */

static LoweredValue picked(const Picking *picking, LoweredValue value)
{
    if (!has_operands(&value))
        return value;
    for (int i = 0; i < code_operands(value.code); i++)
        value.args[i] = picking->place[value.args[i]] - 1;
    if ((value.code == CODE_ADD || value.code == CODE_MUL) && value.args[0] > value.args[1]) {
        const uint32_t second = value.args[0];

        value.args[0] = value.args[1];
        value.args[1] = second;
    }
    return value;
}

static void pick_values(Picking *picking)
{
    const Lowering *low = picking->low;
    Lowered *out = picking->out;

    for (int v = 0; v < low->values.count; v++) {
        if (picking->place[v] == 0 || low->values.at[v].code == CODE_INPUT)
            continue;
        transaction_worked(VALUE_WORK);
        out->values.at[out->values.count] = picked(picking, low->values.at[v]);
        picking->place[v] = (uint32_t)++out->values.count;
    }
}

/* A sine and a cosine of one thing are computed together: the cosine becomes the second result. */
static void pair_sines(const Picking *picking)
{
    const Lowering *low = picking->low;

    for (int v = 0; v < low->values.count; v++) {
        LoweredValue wanted = low->values.at[v];
        LoweredValue *cosine;
        uint32_t sine;

        if (wanted.code != CODE_COS || picking->place[v] == 0)
            continue;
        wanted.code = CODE_SIN;
        sine = low->table[lowering_slot(low, &wanted)];
        if (sine == 0 || picking->place[sine - 1] == 0)
            continue;
        sine = picking->place[sine - 1] - 1;
        cosine = &picking->out->values.at[picking->place[v] - 1];
        picking->out->values.at[sine].code = CODE_SINCOS;
        *cosine = (LoweredValue){.code = CODE_COSINE, .stage = cosine->stage, .args = {sine}};
    }
}

/* all of roots that are lowered; `roots` becomes those of `out` */
static Status pick(const Lowering *low, uint32_t *roots, int root_count, const Expr *inputs,
                   int input_count, bool takes_parameters, Lowered *out, Diag *diag)
{
    Picking picking = {low, out, NEW_ARRAY(uint32_t, low->values.count)};
    Status status = OK;

    *out = (Lowered){.roots = roots, .root_count = root_count};
    mark_needed(&picking, roots, root_count);
    CHECK(pick_inputs(&picking, inputs, input_count, takes_parameters, diag));
    pick_values(&picking);
    pair_sines(&picking);
    for (int i = 0; i < root_count; i++)
        roots[i] = picking.place[roots[i]] - 1;
    for (int i = 0; i < low->tables.count; i++)
        LIST_PUSH(out->tables, low->tables.at[i]);
done:
    mem_free(picking.place);
    if (status != OK)
        lowered_free(out);
    return status;
}

/* --- the stored lowering --- */

static void lowering_end(Lowering *low)
{
    LIST_FREE(low->values);
    LIST_FREE(low->symbols);
    LIST_FREE(low->tables);
    MEM_FREE(low->known, low->table);
}

static void release(void *lowering)
{
    mem_keep(lowering);
    lowering_end(lowering);
    mem_free(lowering);
}

static bool is_any(const void *object, const void *asked)
{
    (void)object;
    (void)asked;
    return true;
}

static void *copied(const void *from, size_t count, size_t size)
{
    void *copy = mem_grow(NULL, count, size);

    if (count > 0)
        memcpy(copy, from, count * size);
    return copy;
}

/* Data is numbered by the tables of a program: it isn't stored. */
static Lowering copy_kept(const Lowering *from)
{
    Lowering low = *from;

    low.values.at = copied(from->values.at, (size_t)from->values.count, sizeof *low.values.at);
    low.values.room = from->values.count;
    low.symbols.at = copied(from->symbols.at, (size_t)from->symbols.count, sizeof(Expr));
    low.symbols.room = from->symbols.count;
    low.known = copied(from->known, from->known_count, sizeof *low.known);
    low.table = copied(from->table, from->table_size, sizeof *low.table);
    return low;
}

/* replaces the stored lowering; takes ownership */
static void keep(Arena *arena, const Lowering *low)
{
    Lowering *kept = NEW(Lowering);
    const Made made = {
        .newest = low->known_count - 1, .object = kept, .is = is_any, .release = release};

    *kept = *low;
    arena_end_made(arena, is_any);
    arena_add_made(arena, &made);
}

Status lowered_make(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                    Lowered *out, Diag *diag)
{
    Lowering low = {0};
    uint32_t *values = lowering_add(&low, roots, root_count);
    const Status status = pick(&low, values, root_count, inputs, input_count, false, out, diag);

    lowering_end(&low);
    return status;
}

Status lowered_make_again(Arena *arena, const Expr *roots, int root_count, const Expr *inputs,
                          int input_count, Lowered *out, Diag *diag)
{
    /* with fewer roots, searching a stored lowering of WORTH_KEEPING values takes longer */
    const bool is_much = root_count >= WORTH_KEEPING / 20;
    const Lowering *kept = is_much ? arena_find_made(arena, 0, is_any, NULL) : NULL;
    Lowering low = kept != NULL ? copy_kept(kept) : (Lowering){0};
    uint32_t *values = lowering_add(&low, roots, root_count);
    const Status status = pick(&low, values, root_count, inputs, input_count, true, out, diag);

    if (status == OK && is_much && low.tables.count == 0 && out->values.count >= WORTH_KEEPING &&
        low.values.count / MOST_IDLE <= out->values.count)
        keep(arena, &low);
    else
        lowering_end(&low);
    return status;
}

void lowered_free(Lowered *lowered)
{
    LIST_FREE(lowered->values);
    LIST_FREE(lowered->tables);
    mem_free(lowered->roots);
    mem_free(lowered->inputs);
    *lowered = (Lowered){.input_count = 0};
}

/* arena.c: nodes, each made once
 *
 * Nodes are allocated in a pool and never move. An open hash table with linear probing finds the
 * node of given contents. Nodes are removed newest first, and a growing table inserts them oldest
 * first. So no probe sequence of a remaining node passes the slot of a removed one, and the slot
 * can simply be emptied. The same applies to stored derivatives. */
#include "expr/expr_impl.h"

#include <assert.h>
#include <string.h>

#ifdef COTREE_SMALL
enum { FIRST_SIZE = 2 };
#else
enum { FIRST_SIZE = 1024 };
#endif

/* some four gigabytes */
#define NODE_LIMIT ((int64_t)1 << 26)

enum { WHOLES = 32 }; /* that are found without a look into the table */

enum { NODE_WORK = 64 }; /* of making or finding one, for transaction_worked() */

typedef struct Slot {
    uint32_t hash; /* slot_hash() of a node, or the hash of a stored result */
    uint32_t id;   /* number + 1; 0: empty */
} Slot;

/* a stored derivative, or another stored result; then `symbol` is a number that distinguishes them:
 * 0 the node without holds, else a result of a tuple */
typedef struct Memory {
    Expr e;
    Expr symbol;
    Expr derivative;
} Memory;

/* what a table is found by; a later one of the same names wins */
typedef struct TableName {
    const char *file, *column; /* in `texts` */
    int table;
} TableName;

struct Arena {
    Pool *pool;
    Pool *texts;          /* of tables, which outlive marks */
    LIST(Curve *) tables; /* so do these */
    LIST(TableName) table_names;
    Slot *slots;
    uint32_t size; /* of slots, a power of two */
    LIST(struct ExprNode *) nodes;
    int symbols;
    LIST(Memory) memories;
    Slot *memory_slots;
    uint32_t memory_size;
    LIST(Made) made; /* the most recently used one at the end */
    Expr zero;
    Expr one;
    Expr whole[WHOLES];   /* integers, as far as they have been used */
    Renamings *renamings; /* NULL: none */
    void (*release_renamings)(Renamings *renamings);
    int touched; /* how often these were changed */
    int64_t limit;
    Status status;
    const char *failure;
    bool halted; /* stopped or full: no more composite nodes */
};

struct ArenaMark {
    PoolMark pool;
    int nodes;
    int symbols;
    int memories;
    int touched;
};

/* a round of the finaliser of MurmurHash3 (Appleby 2011) */
static uint64_t mix(uint64_t h, uint64_t word)
{
    h ^= word;
    h *= 0xFF51AFD7ED558CCDU;
    return h ^ (h >> 32);
}

static uint32_t hash_end(uint64_t h)
{
    h ^= h >> 29;
    return (uint32_t)(h * 0x9E3779B97F4A7C15U >> 32);
}

static uint32_t hash_words(uint64_t start, const void *words, int count)
{
    const unsigned char *at = words;
    uint64_t h = mix(0x9E3779B97F4A7C15U, start);

    for (int i = 0; i < count; i++) {
        uint64_t word;

        memcpy(&word, at + 8 * (size_t)i, 8);
        h = mix(h, word);
    }
    return hash_end(h);
}

static uint32_t hash_args(uint64_t start, const Expr *args, int count)
{
    uint64_t h = mix(0x9E3779B97F4A7C15U, start);

    for (int i = 0; i < count; i++)
        h = mix(h, args[i]->hash);
    return hash_end(h);
}

static inline bool same_words(const void *one, const void *other, int count)
{
    const unsigned char *const a = one, *const b = other;

    for (size_t i = 0; i < 8 * (size_t)count; i += 8) {
        uint64_t left, right;

        memcpy(&left, a + i, 8);
        memcpy(&right, b + i, 8);
        if (left != right)
            return false;
    }
    return true;
}

/* --- tables --- */

/* What the table finds a node by: the hash of its structure, and the numbers of its arguments. The
 * hash alone repeats along a deep chain: x -> x^2/2 + 1 maps 32 bits to 32 bits, so that its hashes
 * run in a circle after some 2^16 levels, and each further node has the hash of thousands. */
static inline uint32_t slot_hash(uint32_t hash, const Expr *args, int count)
{
    uint32_t numbers = 0;

    for (int i = 0; i < count; i++)
        numbers += args[i]->number;
    return hash ^ numbers * 2654435769U;
}

static inline uint32_t node_slot_hash(Expr e)
{
    return slot_hash(e->hash, node_args(e), e->count);
}

static void slots_insert(Slot *slots, uint32_t size, uint32_t hash, uint32_t id)
{
    uint32_t i = hash & (size - 1);

    while (slots[i].id != 0)
        i = (i + 1) & (size - 1);
    slots[i] = (Slot){hash, id};
}

static void slots_drop(Slot *slots, uint32_t size, uint32_t hash, uint32_t id)
{
    uint32_t i = hash & (size - 1);

    while (slots[i].id != id)
        i = (i + 1) & (size - 1);
    slots[i] = (Slot){0, 0};
}

/* entries of nodes and derivatives that aren't there any more */
static void drop_newer(void *object)
{
    Arena *arena = object;

    for (uint32_t i = 0; i < arena->size; i++)
        if (arena->slots[i].id > (uint32_t)arena->nodes.count)
            arena->slots[i] = (Slot){0, 0};
    for (uint32_t i = 0; i < arena->memory_size; i++)
        if (arena->memory_slots[i].id > (uint32_t)arena->memories.count)
            arena->memory_slots[i] = (Slot){0, 0};
}

/* Call this before changing anything of the arena. What an interrupted call has added is undone. */
static inline void arena_keep_whole(Arena *arena)
{
    if (transaction_now == NULL || piece_of(arena)->kept == transaction_now->number)
        return;
    mem_on_failure(drop_newer, arena);
    mem_keep_now(arena);
}

static void table_grow(Arena *arena, uint32_t size)
{
    Slot *slots = NEW_ARRAY(Slot, size);

    for (int i = 0; i < arena->nodes.count; i++) {
        transaction_worked(NODE_WORK);
        slots_insert(slots, size, node_slot_hash(arena->nodes.at[i]), (uint32_t)i + 1);
    }
    mem_free(arena->slots);
    arena->slots = slots;
    arena->size = size;
}

/* --- nodes --- */

/* The slot of the node of these contents, or the empty slot for it; `hash` is its slot_hash(). */
static uint32_t slot_of(const Arena *arena, uint32_t hash, ExprKind kind, unsigned op,
                        const void *words, int count)
{
    const Slot *const slots = arena->slots;
    const uint32_t mask = arena->size - 1;
    uint32_t i = hash & mask;

    for (; slots[i].id != 0; i = (i + 1) & mask) {
        Expr e;

        if (slots[i].hash != hash)
            continue;
        e = arena->nodes.at[slots[i].id - 1];
        if (e->kind == kind && e->op == op && (e->kind <= EXPR_REAL || e->count == count) &&
            same_words(e + 1, words, count))
            break;
    }
    return i;
}

static inline Expr at_slot(const Arena *arena, uint32_t slot)
{
    return arena->slots[slot].id != 0 ? arena->nodes.at[arena->slots[slot].id - 1] : NULL;
}

/* A new node, followed by `size` uninitialised bytes. The table finds it by `found_by`, of which
 * `slot` is the empty slot. */
static inline struct ExprNode *node_new(Arena *arena, uint32_t hash, uint32_t found_by,
                                        uint32_t slot, size_t size)
{
    struct ExprNode *node;

    arena_keep_whole(arena);
    node = pool_room(arena->pool, sizeof(struct ExprNode) + size);
    *node = (struct ExprNode){.number = (uint32_t)arena->nodes.count, .hash = hash};
    if ((uint32_t)arena->nodes.count >= arena->size / 2) {
        table_grow(arena, 2 * arena->size);
        LIST_APPEND(arena->nodes, node);
        slots_insert(arena->slots, arena->size, found_by, node->number + 1);
    } else {
        LIST_APPEND(arena->nodes, node);
        arena->slots[slot] = (Slot){found_by, node->number + 1};
    }
    return node;
}

void arena_expect(Arena *arena, int nodes)
{
    uint32_t size = arena->size;

    while (size / 2 < (uint32_t)nodes && size < UINT32_MAX / 4)
        size *= 2;
    if (size == arena->size)
        return;
    arena_keep_whole(arena);
    table_grow(arena, size);
    if (arena->nodes.count < nodes)
        LIST_ROOM(arena->nodes, nodes - arena->nodes.count);
}

/* whether one more composite node may be made */
static inline bool may_grow(Arena *arena)
{
    if (arena->nodes.count >= arena->limit)
        arena_fail(arena, E_MEMORY, "the expressions grow beyond all bounds");
    return !arena->halted;
}

Expr node_intern(Arena *arena, ExprKind kind, Op op, const Expr *args, int count)
{
    const uint32_t hash = hash_args((uint64_t)kind << 8 | op, args, count);
    const uint32_t found_by = slot_hash(hash, args, count);
    const uint32_t slot = slot_of(arena, found_by, kind, op, args, count);
    const Expr found = at_slot(arena, slot);
    struct ExprNode *node;
    Expr *own;
    unsigned kinds = 0, height = 0;

    transaction_worked(NODE_WORK);
    if (found != NULL)
        return found;
    if (!may_grow(arena))
        return arena->zero;
    node = node_new(arena, hash, found_by, slot, sizeof(Expr) * (size_t)count);
    node->kind = (uint8_t)kind;
    node->op = (uint8_t)op;
    node->count = count;
    own = (Expr *)(node + 1);
    for (int i = 0; i < count; i++) {
        own[i] = args[i];
        kinds |= args[i]->kinds;
        height = args[i]->height > height ? args[i]->height : height;
    }
    node->kinds = (uint16_t)kinds;
    node->height = (uint8_t)(height < TALLEST ? height + 1 : TALLEST + 1) & 31;
    return node;
}

static Expr leaf_intern(Arena *arena, ExprKind kind, uint8_t op, const void *words, int count)
{
    const uint32_t hash = hash_words((uint64_t)kind << 8 | op, words, count);
    const uint32_t slot = slot_of(arena, hash, kind, op, words, count);
    const Expr found = at_slot(arena, slot);
    struct ExprNode *node;

    if (found != NULL)
        return found;
    node = node_new(arena, hash, hash, slot, 8 * (size_t)count);
    node->kind = (uint8_t)kind;
    node->op = op;
    memcpy(node + 1, words, 8 * (size_t)count);
    return node;
}

Expr node_rational(Arena *arena, int64_t num, int64_t den)
{
    const Ratio ratio = {num, den};
    Expr made;

    if (den != 1 || num < 0 || num >= WHOLES)
        return leaf_intern(arena, EXPR_RATIONAL, 0, &ratio, 2);
    if (arena->whole[num] != NULL)
        return arena->whole[num];
    made = leaf_intern(arena, EXPR_RATIONAL, 0, &ratio, 2);
    arena_keep_whole(arena);
    return arena->whole[num] = made;
}

Expr node_real(Arena *arena, double value)
{
    return leaf_intern(arena, EXPR_REAL, 0, &value, 1);
}

Expr node_pi(Arena *arena, int64_t num, int64_t den, int power)
{
    Ratio ratio = {num, den};

    return leaf_intern(arena, EXPR_REAL, (uint8_t)power, &ratio, 2);
}

/* --- symbols --- */

static uint32_t symbol_hash(const char *name, SymbolKind kind)
{
    uint64_t h = 14695981039346656037U + (uint64_t)kind;

    for (const char *c = name; *c != '\0'; c++)
        h = (h ^ (unsigned char)*c) * 1099511628211U; /* FNV-1a */
    return hash_words(EXPR_SYMBOL, &h, 1);
}

/* the slot of a symbol, or the empty slot for it */
static uint32_t symbol_slot(const Arena *arena, uint32_t hash, const char *name, SymbolKind kind)
{
    uint32_t i = hash & (arena->size - 1);

    for (; arena->slots[i].id != 0; i = (i + 1) & (arena->size - 1)) {
        const Expr e = arena->nodes.at[arena->slots[i].id - 1];

        if (arena->slots[i].hash == hash && e->kind == EXPR_SYMBOL &&
            node_symbol(e)->kind == kind && strcmp(node_symbol(e)->name, name) == 0)
            break;
    }
    return i;
}

Expr expr_symbol(Arena *arena, const char *name, SymbolKind kind)
{
    const uint32_t hash = symbol_hash(name, kind);
    const uint32_t slot = symbol_slot(arena, hash, name, kind);
    const Expr found = at_slot(arena, slot);
    struct ExprNode *node;
    SymbolData data = {.kind = kind};

    if (found != NULL)
        return found;
    arena_keep_whole(arena);
    data.number = arena->symbols++;
    node = node_new(arena, hash, hash, slot, sizeof data);
    node->kind = EXPR_SYMBOL;
    node->kinds = (uint16_t)(kind == SYMBOL_TABLE ? 0 : 1U << kind);
    data.name = pool_text(arena->pool, name, strlen(name));
    memcpy(node + 1, &data, sizeof data);
    return node;
}

/* --- data --- */

static Expr table_symbol(Arena *arena, int number)
{
    Text name = {0};
    SymbolData *data;
    Expr symbol;

    text_addf(&name, "_table%d", number + 1);
    symbol = expr_symbol(arena, name.at, SYMBOL_TABLE);
    data = (SymbolData *)(void *)(arena->nodes.at[symbol->number] + 1);
    pool_retain(arena->pool, data, sizeof *data);
    data->table = arena->tables.at[number];
    text_free(&name);
    return symbol;
}

static void name_table(Arena *arena, const char *file, const char *column, int number)
{
    TableName name = {pool_text(arena->texts, file, strlen(file)),
                      pool_text(arena->texts, column, strlen(column)), number};

    LIST_PUSH(arena->table_names, name);
}

Expr arena_add_table(Arena *arena, const char *file, const char *column, const double *x,
                     const double *y, int count)
{
    const size_t bytes = (size_t)count * sizeof(double);
    int number = 0;

    arena_keep_whole(arena);
    for (; number < arena->tables.count; number++) {
        const Curve *table = arena->tables.at[number];

        if (table->count == count && memcmp(table->data, x, bytes) == 0 &&
            memcmp(table->data + count, y, bytes) == 0)
            break;
    }
    if (number == arena->tables.count)
        LIST_PUSH(arena->tables, curve_new(file, column, x, y, count));
    name_table(arena, file, column, number);
    return table_symbol(arena, number);
}

Expr arena_add_law(Arena *arena, const char *name, const char *argument)
{
    const Expr symbol = expr_symbol(arena, name, SYMBOL_TABLE);
    SymbolData *data = (SymbolData *)(void *)(arena->nodes.at[symbol->number] + 1);
    int number = 0;

    arena_keep_whole(arena);
    for (; number < arena->tables.count; number++) {
        const Curve *table = arena->tables.at[number];

        if (curve_is_law(table) && strcmp(table->file, name) == 0 &&
            strcmp(table->column, argument) == 0)
            break;
    }
    if (number == arena->tables.count)
        LIST_PUSH(arena->tables, curve_new_law(name, argument));
    pool_retain(arena->pool, data, sizeof *data);
    data->table = arena->tables.at[number];
    return symbol;
}

Expr arena_find_table(Arena *arena, const char *file, const char *column)
{
    for (int i = arena->table_names.count - 1; i >= 0; i--)
        if (strcmp(arena->table_names.at[i].file, file) == 0 &&
            strcmp(arena->table_names.at[i].column, column) == 0)
            return table_symbol(arena, arena->table_names.at[i].table);
    return NULL;
}

const Curve *expr_data(Expr symbol)
{
    return symbol->kind == EXPR_SYMBOL && node_symbol(symbol)->kind == SYMBOL_TABLE
               ? node_symbol(symbol)->table
               : NULL;
}

/* --- remembered derivatives, and what else follows from a node --- */

static uint32_t memory_hash(Expr e, Expr symbol)
{
    uint64_t key = (uint64_t)e->number << 32 | symbol->number;

    return hash_words(EXPR_CALL, &key, 1);
}

Expr arena_recall(const Arena *arena, Expr e, Expr symbol)
{
    uint32_t hash = memory_hash(e, symbol);

    for (uint32_t i = hash & (arena->memory_size - 1); arena->memory_slots[i].id != 0;
         i = (i + 1) & (arena->memory_size - 1)) {
        const Memory *memory = &arena->memories.at[arena->memory_slots[i].id - 1];

        if (memory->e == e && memory->symbol == symbol)
            return memory->derivative;
    }
    return NULL;
}

void arena_remember(Arena *arena, Expr e, Expr symbol, Expr derivative)
{
    Slot *slots;
    uint32_t size;

    /* what was made after a failure may be anything */
    if (arena->status != OK)
        return;
    arena_keep_whole(arena);
    LIST_APPEND(arena->memories, (Memory){e, symbol, derivative});
    if ((uint32_t)arena->memories.count <= arena->memory_size / 2) {
        slots_insert(arena->memory_slots, arena->memory_size, memory_hash(e, symbol),
                     (uint32_t)arena->memories.count);
        return;
    }
    size = 2 * arena->memory_size;
    slots = NEW_ARRAY(Slot, size);
    for (int i = 0; i < arena->memories.count; i++) {
        transaction_worked(NODE_WORK);
        slots_insert(slots, size,
                     memory_hash(arena->memories.at[i].e, arena->memories.at[i].symbol),
                     (uint32_t)i + 1);
    }
    mem_free(arena->memory_slots);
    arena->memory_slots = slots;
    arena->memory_size = size;
}

/* --- what follows from tuples --- */

Expr expr_tuple(Arena *arena, const Expr *at, int count)
{
    return node_intern(arena, EXPR_TUPLE, 0, at, count);
}

void expr_remember(Arena *arena, Expr tuple, int which, const void *values, size_t size)
{
    const Expr kept = expr_tuple(arena, values, (int)(size / sizeof(Expr)));

    arena_remember(arena, tuple, node_rational(arena, 1 + which, 1), kept);
}

bool expr_recall(Arena *arena, Expr tuple, int which, void *out, size_t size)
{
    const Expr kept = arena_recall(arena, tuple, node_rational(arena, 1 + which, 1));

    if (kept == NULL || out == NULL)
        return kept != NULL;
    assert((size_t)kept->count * sizeof(Expr) == size);
    memcpy(out, node_args(kept), size);
    return true;
}

/* --- what was made of expressions --- */

enum { MOST_MADE = 16 };

/* remove one from the list; the order of the others is unchanged */
static Made take_made(Arena *arena, int i)
{
    const Made taken = arena->made.at[i];

    mem_keep(arena->made.at);
    arena_keep_whole(arena);
    arena->made.count--;
    for (; i < arena->made.count; i++)
        arena->made.at[i] = arena->made.at[i + 1];
    return taken;
}

static void drop_made(Arena *arena, int i)
{
    const Made dropped = take_made(arena, i);

    dropped.release(dropped.object);
}

void arena_add_made(Arena *arena, const Made *made)
{
    if (arena->made.count == MOST_MADE)
        drop_made(arena, 0);
    arena_keep_whole(arena);
    LIST_PUSH(arena->made, *made);
}

void arena_end_made(Arena *arena, bool (*is)(const void *object, const void *asked))
{
    for (int i = arena->made.count - 1; i >= 0; i--)
        if (arena->made.at[i].is == is)
            drop_made(arena, i);
}

void *arena_find_made(Arena *arena, uint64_t hash,
                      bool (*is)(const void *object, const void *asked), const void *asked)
{
    for (int i = arena->made.count - 1; i >= 0; i--)
        if (arena->made.at[i].hash == hash && arena->made.at[i].is == is &&
            is(arena->made.at[i].object, asked)) {
            const Made found = take_made(arena, i);

            LIST_PUSH(arena->made, found);
            return found.object;
        }
    return NULL;
}

Renamings *arena_renamings(const Arena *arena)
{
    return arena->renamings;
}

void arena_add_renamings(Arena *arena, Renamings *renamings, void (*release)(Renamings *))
{
    arena_keep_whole(arena);
    arena->renamings = renamings;
    arena->release_renamings = release;
}

void arena_touch_renamings(Arena *arena)
{
    arena_keep_whole(arena);
    arena->touched++;
}

static void drop_renamings(Arena *arena)
{
    if (arena->renamings != NULL)
        arena->release_renamings(arena->renamings);
    arena->renamings = NULL;
}

/* --- the arena --- */

Arena *arena_new(void)
{
    Arena *arena = NEW(Arena);

    arena->pool = pool_new(0);
    arena->texts = pool_new(1024);
    arena->size = FIRST_SIZE;
    arena->slots = NEW_ARRAY(Slot, arena->size);
    arena->memory_size = FIRST_SIZE;
    arena->memory_slots = NEW_ARRAY(Slot, arena->memory_size);
    arena->limit = NODE_LIMIT;
    arena->zero = node_rational(arena, 0, 1);
    arena->one = node_rational(arena, 1, 1);
    return arena;
}

void arena_free(Arena *arena)
{
    if (arena == NULL)
        return;
    while (arena->made.count > 0)
        drop_made(arena, arena->made.count - 1);
    LIST_FREE(arena->made);
    drop_renamings(arena);
    pool_free(arena->pool);
    pool_free(arena->texts);
    MEM_FREE(arena->slots, arena->memory_slots);
    LIST_FREE(arena->nodes);
    LIST_FREE(arena->memories);
    for (int i = 0; i < arena->tables.count; i++)
        curve_free(arena->tables.at[i]);
    LIST_FREE(arena->tables);
    LIST_FREE(arena->table_names);
    mem_free(arena);
}

Expr arena_zero(const Arena *arena)
{
    return arena->zero;
}

Expr arena_one(const Arena *arena)
{
    return arena->one;
}

Status arena_status(const Arena *arena)
{
    return arena->status;
}

const char *arena_failure(const Arena *arena)
{
    return arena->failure != NULL ? arena->failure : "";
}

void arena_fail(Arena *arena, Status status, const char *message)
{
    arena_keep_whole(arena);
    if (status == E_MEMORY)
        arena->halted = true;
    if (arena->status != OK)
        return;
    arena->status = status;
    arena->failure = message;
}

void arena_reset(Arena *arena)
{
    arena_keep_whole(arena);
    arena->status = OK;
    arena->failure = NULL;
    arena->halted = false;
}

int64_t arena_limit(Arena *arena, int64_t nodes)
{
    const int64_t before = arena->limit;

    arena_keep_whole(arena);
    arena->limit = nodes < NODE_LIMIT ? nodes : NODE_LIMIT;
    return before;
}

ArenaMark *arena_mark(Arena *arena)
{
    ArenaMark *mark = NEW(ArenaMark);

    mark->pool = pool_mark(arena->pool);
    mark->nodes = arena->nodes.count;
    mark->symbols = arena->symbols;
    mark->memories = arena->memories.count;
    mark->touched = arena->touched;
    return mark;
}

/* Remove released nodes from the lists: their addresses may be reused. */
void arena_release(Arena *arena, ArenaMark *mark)
{
    arena_keep_whole(arena);
    for (int i = arena->made.count - 1; i >= 0; i--)
        if (arena->made.at[i].newest >= (uint32_t)mark->nodes)
            drop_made(arena, i);
    if (arena->touched != mark->touched)
        drop_renamings(arena);
    while (arena->memories.count > mark->memories) {
        Memory *memory = &arena->memories.at[arena->memories.count - 1];

        slots_drop(arena->memory_slots, arena->memory_size, memory_hash(memory->e, memory->symbol),
                   (uint32_t)arena->memories.count);
        *memory = (Memory){0};
        arena->memories.count--;
    }
    for (int i = 0; i < WHOLES; i++)
        if (arena->whole[i] != NULL && arena->whole[i]->number >= (uint32_t)mark->nodes)
            arena->whole[i] = NULL;
    while (arena->nodes.count > mark->nodes) {
        slots_drop(arena->slots, arena->size,
                   node_slot_hash(arena->nodes.at[arena->nodes.count - 1]),
                   (uint32_t)arena->nodes.count);
        arena->nodes.at[--arena->nodes.count] = NULL;
    }
    arena->symbols = mark->symbols;
    pool_release(arena->pool, mark->pool);
    mem_free(mark);
}

void arena_retain(Arena *arena, ArenaMark *mark)
{
    (void)arena;
    mem_free(mark);
}

int64_t arena_nodes(const Arena *arena)
{
    return arena->nodes.count;
}

size_t arena_bytes(const Arena *arena)
{
    return pool_bytes(arena->pool) + pool_bytes(arena->texts) +
           ((size_t)arena->size + arena->memory_size) * sizeof(Slot) +
           (size_t)arena->nodes.room * sizeof(Expr) + (size_t)arena->memories.room * sizeof(Memory);
}

/* lib/base/transaction: where memory ends, what a call did is as if it had never been */
#include "base/memory.h"
#include "base/names.h"
#include "base/text.h"
#include "expr/expr.h"
#include "test.h"

#include <stdint.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__
/* too much memory is asked for on purpose */
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "allocator_may_return_null=1";
}
#endif

typedef void Work(void *object);

/* what is being done, until it asks for more than there is; false: it came to its end */
static bool fails(Work *work, void *object, bool asks)
{
    TRANSACTION(true);

    work(object);
    if (asks)
        mem_free(mem_array(SIZE_MAX / 4, 2));
    return false;
}

typedef struct Thing {
    int count;
    char *text;
    Text said;
    LIST(int) numbers;
} Thing;

static void change_all(void *object)
{
    Thing *thing = object;

    mem_keep(thing);
    thing->count++;
    mem_free(thing->text);
    thing->text = mem_text("new", 3);
    text_add(&thing->said, " and more");
    for (int i = 0; i < 100; i++)
        LIST_PUSH(thing->numbers, i);
    mem_keep(thing->numbers.at);
    thing->numbers.at[0] = -1;
}

static Thing *thing_new(void)
{
    Thing *thing = NEW(Thing);

    thing->text = mem_text("old", 3);
    text_add(&thing->said, "this");
    LIST_PUSH(thing->numbers, 7);
    return thing;
}

static void thing_free(Thing *thing)
{
    mem_free(thing->text);
    text_free(&thing->said);
    LIST_FREE(thing->numbers);
    mem_free(thing);
}

static void what_was_kept_comes_back(void)
{
    Thing *thing = thing_new();

    EXPECT(fails(change_all, thing, true));
    EXPECT(thing->count == 0);
    EXPECT_TEXT(thing->text, "old");
    EXPECT_TEXT(thing->said.at, "this");
    EXPECT(thing->numbers.count == 1 && thing->numbers.at[0] == 7);

    EXPECT(!fails(change_all, thing, false));
    EXPECT(thing->count == 1);
    EXPECT_TEXT(thing->text, "new");
    EXPECT_TEXT(thing->said.at, "this and more");
    EXPECT(thing->numbers.count == 101 && thing->numbers.at[0] == -1);
    thing_free(thing);
}

static void add_names(void *object)
{
    Names *names = object;

    names_trim(names, 1);
    for (char name[] = "a"; name[0] <= 'z'; name[0]++)
        (void)names_add(names, name);
}

static void names_find_what_they_found_before(void)
{
    Names *names = names_new();

    (void)names_add(names, "one");
    (void)names_add(names, "two");
    EXPECT(fails(add_names, names, true));
    EXPECT(names_count(names) == 2);
    EXPECT(names_find(names, "two") == 1);
    EXPECT(names_find(names, "a") == -1);
    EXPECT(names_add(names, "b") == 2);
    EXPECT(!fails(add_names, names, false));
    EXPECT(names_find(names, "z") == 26);
    names_free(names);
}

static void build(void *object)
{
    Arena *arena = object;
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < 3000; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "x%d", i);
        sum = expr_add(arena, sum, expr_sin(arena, expr_symbol(arena, name, SYMBOL_PARAMETER)));
    }
}

static void equal_expressions_are_still_one(void)
{
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x7", SYMBOL_PARAMETER), sine = expr_sin(arena, x);
    const int64_t nodes = arena_nodes(arena);

    EXPECT(fails(build, arena, true));
    EXPECT(arena_nodes(arena) == nodes);
    EXPECT(expr_sin(arena, expr_symbol(arena, "x7", SYMBOL_PARAMETER)) == sine);
    EXPECT(!fails(build, arena, false));
    EXPECT(expr_sin(arena, expr_symbol(arena, "x7", SYMBOL_PARAMETER)) == sine);
    arena_free(arena);
}

typedef struct Foreign {
    Cleanup cleanup;
    int *closed;
} Foreign;

static void close_foreign(void *object)
{
    Foreign *foreign = object;

    ++*foreign->closed;
    cleanup_close(&foreign->cleanup);
}

static void open_foreign(void *object)
{
    for (int i = 0; i < 3; i++) {
        Foreign *foreign = NEW(Foreign);

        foreign->closed = object;
        cleanup_open(&foreign->cleanup, close_foreign, foreign);
        if (i == 1) {
            close_foreign(foreign);
            mem_free(foreign);
        }
    }
}

static void what_others_handed_out_is_given_back_once(void)
{
    int closed = 0;

    EXPECT(fails(open_foreign, &closed, true));
    /* a build that tries with failing allocations has opened and closed more of them */
    EXPECT(closed >= 3);
}

static void call_inside(void *object)
{
    Thing *thing = object;

    EXPECT(fails(change_all, thing, true));
    mem_keep(thing);
    thing->count = 5;
}

static void a_call_inside_another_fails_alone(void)
{
    Thing *thing = thing_new();

    EXPECT(!fails(call_inside, thing, false));
    EXPECT(thing->count == 5);
    EXPECT_TEXT(thing->text, "old");
    thing_free(thing);
}

int main(void)
{
    RUN(what_was_kept_comes_back);
    RUN(names_find_what_they_found_before);
    RUN(equal_expressions_are_still_one);
    RUN(what_others_handed_out_is_given_back_once);
    RUN(a_call_inside_another_fails_alone);
    return test_end();
}

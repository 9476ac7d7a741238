/* names.c: open addressing, doubled at three quarters full */
#include "base/names.h"

#include "base/memory.h"

#include <stdint.h>
#include <string.h>

struct Names {
    LIST(char *) list;
    int *slots; /* number + 1, or 0 where free */
    int size;   /* a power of two */
};

/* FNV-1a (Fowler, Noll, Vo) */
static uint32_t hash(const char *name)
{
    uint32_t h = 2166136261U;

    for (; *name != '\0'; name++)
        h = (h ^ (unsigned char)*name) * 16777619U;
    return h ^ (h >> 15);
}

static int slot_of(const Names *names, const char *name)
{
    int slot = (int)(hash(name) & (uint32_t)(names->size - 1));

    while (names->slots[slot] != 0 && strcmp(names->list.at[names->slots[slot] - 1], name) != 0)
        slot = (slot + 1) & (names->size - 1);
    return slot;
}

#ifdef COTREE_SMALL
enum { FIRST_SIZE = 2 };
#else
enum { FIRST_SIZE = 16 };
#endif

static void resize(Names *names, int size)
{
    int *slots = NEW_ARRAY(int, size);

    mem_free(names->slots);
    names->slots = slots;
    names->size = size;
    for (int i = 0; i < names->list.count; i++)
        names->slots[slot_of(names, names->list.at[i])] = i + 1;
}

Names *names_new(void)
{
    Names *names = NEW(Names);

    resize(names, FIRST_SIZE);
    return names;
}

void names_free(Names *names)
{
    if (names == NULL)
        return;
    for (int i = 0; i < names->list.count; i++)
        mem_free(names->list.at[i]);
    LIST_FREE(names->list);
    MEM_FREE(names->slots, names);
}

int names_find(const Names *names, const char *name)
{
    return names->slots[slot_of(names, name)] - 1;
}

static void set_slot(Names *names, int slot, int number)
{
    mem_keep_part(names->slots, &names->slots[slot], sizeof *names->slots);
    names->slots[slot] = number;
}

int names_add(Names *names, const char *name)
{
    int number = names_find(names, name);

    if (number >= 0)
        return number;
    mem_keep(names);
    if ((names->list.count + 1) * 4 > names->size * 3)
        resize(names, names->size * 2);
    LIST_PUSH(names->list, mem_text(name, strlen(name)));
    number = names->list.count - 1;
    set_slot(names, slot_of(names, name), number + 1);
    return number;
}

/* Nobody who came before stepped over the slot of the last one. */
void names_trim(Names *names, int count)
{
    mem_keep(names);
    while (names->list.count > count) {
        char *last = names->list.at[names->list.count - 1];

        set_slot(names, slot_of(names, last), 0);
        names->list.count--;
        mem_free(last);
    }
}

const char *names_get(const Names *names, int number)
{
    return names->list.at[number];
}

int names_count(const Names *names)
{
    return names->list.count;
}

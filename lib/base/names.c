/* names.c: open addressing, doubled at three quarters full */
#include "base/names.h"

#include "base/memory.h"

#include <stdint.h>
#include <string.h>

typedef struct NameEntry {
    const char *text;
    char *own; /* a copy; NULL: it is borrowed */
    uint32_t hash;
} NameEntry;

struct Names {
    bool borrows;
    LIST(NameEntry) list;
    int *slots; /* number + 1, or 0 where free */
    int size;   /* a power of two */
};

/* FNV-1a (Fowler, Noll, Vo) */
static uint32_t hash(const char *name, size_t length)
{
    uint32_t h = 2166136261U;

    for (size_t i = 0; i < length; i++)
        h = (h ^ (unsigned char)name[i]) * 16777619U;
    return h ^ (h >> 15);
}

/* whose it is, or the one where its way ends */
static int slot_of(const Names *names, uint32_t key, const char *name, size_t length)
{
    int slot = (int)(key & (uint32_t)(names->size - 1));

    for (; names->slots[slot] != 0; slot = (slot + 1) & (names->size - 1)) {
        const NameEntry *other = &names->list.at[names->slots[slot] - 1];

        if (other->hash == key && strncmp(other->text, name, length) == 0 &&
            other->text[length] == '\0')
            break;
    }
    return slot;
}

static int free_slot(const Names *names, uint32_t key)
{
    int slot = (int)(key & (uint32_t)(names->size - 1));

    while (names->slots[slot] != 0)
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
        names->slots[free_slot(names, names->list.at[i].hash)] = i + 1;
}

Names *names_new(void)
{
    Names *names = NEW(Names);

    resize(names, FIRST_SIZE);
    return names;
}

Names *names_borrowing(void)
{
    Names *names = names_new();

    names->borrows = true;
    return names;
}

Names *names_borrowing_from(const Names *from, const char *const *texts)
{
    Names *names = NEW(Names);

    names->borrows = true;
    names->size = from->size;
    names->slots = NEW_ARRAY(int, from->size);
    memcpy(names->slots, from->slots, (size_t)from->size * sizeof *names->slots);
    LIST_ROOM(names->list, from->list.count);
    for (int i = 0; i < from->list.count; i++)
        names->list.at[names->list.count++] =
            (NameEntry){.text = texts[i], .hash = from->list.at[i].hash};
    return names;
}

void names_expect(Names *names, int more)
{
    const int count = names->list.count + more;
    int size = names->size;

    while (count * 4 > size * 3)
        size *= 2;
    mem_keep(names);
    if (size > names->size)
        resize(names, size);
    LIST_ROOM(names->list, more);
}

void names_free(Names *names)
{
    if (names == NULL)
        return;
    for (int i = 0; !names->borrows && i < names->list.count; i++)
        mem_free(names->list.at[i].own);
    LIST_FREE(names->list);
    MEM_FREE(names->slots, names);
}

int names_find_part(const Names *names, const char *name, size_t length)
{
    return names->slots[slot_of(names, hash(name, length), name, length)] - 1;
}

int names_find(const Names *names, const char *name)
{
    return names_find_part(names, name, strlen(name));
}

static void set_slot(Names *names, int slot, int number)
{
    mem_keep_part(names->slots, &names->slots[slot], sizeof *names->slots);
    names->slots[slot] = number;
}

int names_add(Names *names, const char *name)
{
    const size_t length = strlen(name);
    const uint32_t key = hash(name, length);
    int slot = slot_of(names, key, name, length);
    NameEntry named = {.text = name, .hash = key};

    if (names->slots[slot] != 0)
        return names->slots[slot] - 1;
    mem_keep(names);
    if ((names->list.count + 1) * 4 > names->size * 3) {
        resize(names, names->size * 2);
        slot = free_slot(names, key);
    }
    if (!names->borrows)
        named.text = named.own = mem_text(name, length);
    LIST_PUSH(names->list, named);
    set_slot(names, slot, names->list.count);
    return names->list.count - 1;
}

/* No earlier name's probe sequence passed the slot of the last one. */
void names_trim(Names *names, int count)
{
    mem_keep(names);
    while (names->list.count > count) {
        const NameEntry last = names->list.at[names->list.count - 1];

        set_slot(names, slot_of(names, last.hash, last.text, strlen(last.text)), 0);
        names->list.count--;
        mem_free(last.own);
    }
}

const char *names_get(const Names *names, int number)
{
    return names->list.at[number].text;
}

int names_count(const Names *names)
{
    return names->list.count;
}

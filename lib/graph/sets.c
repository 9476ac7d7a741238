/* sets.c: disjoint sets; a root stores minus the size of its set, other members store their
 * parent */
#include "graph/sets.h"

#include "base/memory.h"

struct Sets {
    int *link;
};

Sets *sets_new(int count)
{
    Sets *sets = NEW(Sets);

    sets->link = NEW_ARRAY(int, count);
    for (int i = 0; i < count; i++)
        sets->link[i] = -1;
    return sets;
}

void sets_free(Sets *sets)
{
    if (sets == NULL)
        return;
    MEM_FREE(sets->link, sets);
}

int sets_find(Sets *sets, int member)
{
    int *link = sets->link;

    while (link[member] >= 0) {
        if (link[link[member]] >= 0)
            link[member] = link[link[member]];
        member = link[member];
    }
    return member;
}

bool sets_join(Sets *sets, int a, int b)
{
    int *link = sets->link;

    a = sets_find(sets, a);
    b = sets_find(sets, b);
    if (a == b)
        return false;
    if (link[a] > link[b]) {
        int small = a;

        a = b;
        b = small;
    }
    link[a] += link[b];
    link[b] = a;
    return true;
}

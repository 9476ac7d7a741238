/* component_table.c: the table of component types */
#include "component/component_rows.h"

#include <string.h>

static const Component *const rows[] = {
#define TYPE(id) &component_##id,
#include "component/types.def"
#undef TYPE
};

const Component *component_at(int i)
{
    return i >= 0 && i < COUNT(rows) ? rows[i] : NULL;
}

const Component *component_find(const char *name)
{
    for (int i = 0; i < COUNT(rows); i++)
        if (strcmp(rows[i]->name, name) == 0)
            return rows[i];
    return NULL;
}

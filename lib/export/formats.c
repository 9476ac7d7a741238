/* formats.c: the formats of `export`, by name */
#include "export/write.h"

#include "base/memory.h"

#include <string.h>

static const struct {
    const char *name;
    const Format *row;
} formats[] = {
#define FORMAT(word, brief) {#word, &format_##word},
#include "language/formats.def"
};

const Format *format_find(const char *name)
{
    for (int i = 0; i < COUNT(formats); i++)
        if (strcmp(formats[i].name, name) == 0)
            return formats[i].row;
    return NULL;
}

/* importers.c: the table of what can be imported */
#include "export/import.h"

#include <string.h>

static const struct {
    const char *name;
    Importer *importer;
} formats[] = {
#define IMPORTER(word, brief) {#word, importer_##word},
#include "language/importers.def"
#undef IMPORTER
};

Importer *importer_find(const char *format)
{
    for (int i = 0; i < COUNT(formats); i++)
        if (strcmp(formats[i].name, format) == 0)
            return formats[i].importer;
    return NULL;
}

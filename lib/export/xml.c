/* xml.c: the elements of a text in XML, by expat, which uses our allocation functions */
#include "export/xml.h"

#include <expat.h>
#include <string.h>

enum { DEEPEST = 200 };

typedef struct XmlReader {
    Import *import;
    XML_Parser parser;
    Element *root, *open;
    int depth;
} XmlReader;

static void *allocate(size_t size)
{
    return mem_new(size);
}

static void *reallocate(void *piece, size_t size)
{
    return mem_grow(piece, size, 1);
}

static const char *keep(XmlReader *r, const char *text)
{
    return pool_text(r->import->pool, text, strlen(text));
}

static void begin(void *context, const XML_Char *name, const XML_Char **attributes)
{
    XmlReader *r = context;
    Element *element = pool_alloc(r->import->pool, sizeof *element);
    Attribute *own;
    int count = 0;

    while (attributes[2 * count] != NULL)
        count++;
    own = pool_alloc(r->import->pool, (size_t)(count + 1) * sizeof *own);
    for (int i = 0; i < count; i++)
        own[i] = (Attribute){keep(r, attributes[2 * i]), keep(r, attributes[2 * i + 1])};
    *element = (Element){.name = keep(r, name),
                         .line = (int)XML_GetCurrentLineNumber(r->parser),
                         .attributes = own,
                         .parent = r->open};
    if (r->open == NULL)
        r->root = element;
    else if (r->open->last == NULL)
        r->open->first = element;
    else
        r->open->last->next = element;
    if (r->open != NULL)
        r->open->last = element;
    r->open = element;
    if (++r->depth > DEEPEST)
        (void)XML_StopParser(r->parser, XML_FALSE);
}

static void end(void *context, const XML_Char *name)
{
    XmlReader *r = context;

    (void)name;
    r->open = r->open->parent;
    r->depth--;
}

Status xml_read(Import *import, const char *text, size_t length, Element **out, Diag *diag)
{
    const XML_Memory_Handling_Suite memory = {allocate, reallocate, mem_free};
    XmlReader r = {.import = import};
    Status status = OK;

    r.parser = XML_ParserCreate_MM(NULL, &memory, NULL);
    XML_SetUserData(r.parser, &r);
    XML_SetElementHandler(r.parser, begin, end);
    if (XML_Parse(r.parser, text, (int)length, XML_TRUE) != XML_STATUS_OK) {
        const int line = (int)XML_GetCurrentLineNumber(r.parser);
        const enum XML_Error code = XML_GetErrorCode(r.parser);

        status = import_refuse(import, line, diag, "this is no XML: %s",
                               code == XML_ERROR_ABORTED ? "elements within elements, too deep"
                                                         : XML_ErrorString(code));
    }
    XML_ParserFree(r.parser);
    *out = r.root;
    return status;
}

const char *xml_attribute(const Element *element, const char *name)
{
    for (const Attribute *a = element->attributes; a->name != NULL; a++)
        if (strcmp(a->name, name) == 0)
            return a->value;
    return NULL;
}

const Element *xml_child(const Element *element, const char *name)
{
    const Element *child = element->first;

    while (child != NULL && strcmp(child->name, name) != 0)
        child = child->next;
    return child;
}

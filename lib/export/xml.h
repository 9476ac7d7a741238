/* xml.h: the elements of a text in XML, with their attributes; text between them is ignored */
#ifndef COTREE_EXPORT_XML_H
#define COTREE_EXPORT_XML_H

#include "export/import.h"

typedef struct Attribute {
    const char *name;
    const char *value;
} Attribute;

typedef struct Element {
    const char *name;
    int line;
    const Attribute *attributes; /* ended by a NULL name */
    struct Element *parent, *first, *last, *next;
} Element;

/* Read a text; *out, its root, lives as long as the import. Fails with the line number if it is no
 * XML. External entities are not read. */
MUST_USE Status xml_read(Import *import, const char *text, size_t length, Element **out,
                         Diag *diag);
const char *xml_attribute(const Element *element, const char *name); /* NULL: it isn't given */
const Element *xml_child(const Element *element, const char *name);  /* the first; NULL */

#endif

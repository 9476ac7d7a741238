/* spice_value.h: numbers and expressions of SPICE, as texts of ours */
#ifndef COTREE_EXPORT_SPICE_VALUE_H
#define COTREE_EXPORT_SPICE_VALUE_H

#include "export/import.h"

typedef struct SpiceValue {
    const char *text;  /* in brackets if a product or a power needs them */
    const char *alone; /* the same on its own */
    bool is_number;
    double number;
} SpiceValue;

/* Read `4.7k`, `10uF`, `1meg`, `{2*a}`, `'a+b'` or the name of a parameter; names of the file are
 * looked up by import_known() with kind SPICE_PARAMETER. False: the reason is `why`, a text of the
 * import's. */
enum {
    SPICE_PARAMETER = IMPORT_PARAMETER,
    SPICE_NODE = 'n',
    SPICE_PART = 'e',
    SPICE_SUBCIRCUIT = 's'
};
bool spice_value(Import *import, const char *word, SpiceValue *out, const char **why);
SpiceValue spice_of(Import *import, double number);
/* a number with its suffix, followed by letters of a unit; false: it is none */
bool spice_number(const char *word, double *out);
/* calls back for each name in an expression, in lower case */
void spice_names(const char *word, void (*meet)(void *context, const char *name), void *context);

#endif

/* spice_source.h: the time function of a SPICE source, as an expression of ours */
#ifndef COTREE_EXPORT_SPICE_SOURCE_H
#define COTREE_EXPORT_SPICE_SOURCE_H

#include "export/spice_value.h"

/* Times of .tran, which are defaults of sources; text "0": there is none. And those after a PWL as
 * keys; text NULL: not given. */
typedef struct SpiceTimes {
    SpiceValue step, stop;
    SpiceValue delay, repeat;
} SpiceTimes;

/* whether a word starts a function of time */
bool spice_is_source(const char *word);
/* SIN, PULSE, PWL, EXP or SFFM of these numbers. False: the reason is `why`. */
bool spice_source(Import *import, const char *name, const SpiceValue *values, int count,
                  const SpiceTimes *times, const char **out, const char **why);

#endif

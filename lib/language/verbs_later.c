/* verbs_later.c: words of the language whose behaviour comes with later versions
 *
 * They read as they will, and can't be names of parameters, so that what is written
 * today stays right. A word leaves this table when its row arrives. */
#include "language/verbs.h"

#include <string.h>

#define MECHANICAL(word, form, how, what)                                                          \
    {                                                                                              \
        .name = word, .group = GROUP_MECHANICAL, .shape = form, .usage = word " NAME " how,        \
        .brief = what, .later = true                                                               \
    }
#define OTHER(word, of, form, how, what)                                                           \
    {                                                                                              \
        .name = word, .group = of, .shape = form, .usage = word how, .brief = what, .later = true  \
    }

/* clang-format off */
const Verb verbs_later[] = {
    MECHANICAL("beam", "nk", "length=.. mass_per_length=.. EA=.. EIy=.. EIz=.. GJ=..", "flexible beam along x of its root frame"),
    MECHANICAL("friction", "nPVk", "JOINT ..", "friction in a joint"),
    MECHANICAL("stop", "nPVk", "JOINT ..", "end stop of a joint"),
    MECHANICAL("bushing", "nppVk", "TAIL TIP ..", "compliant joint"),
    MECHANICAL("contact", "nppVk", "TAIL TIP ..", "contact between two bodies"),

    OTHER("subsystem", GROUP_VARIABLES, "nk", " NAME frames=[..] terminals=[..]", "starts the definition of a subsystem"),
    OTHER("end", GROUP_VARIABLES, "", "", "ends the definition of a subsystem"),
    OTHER("use", GROUP_VARIABLES, "wn=", " SUBSYSTEM NAME PORT=PLACE... PARAMETER=VALUE...", "makes an instance of a subsystem"),
    OTHER("store", GROUP_VARIABLES, "ws", " SUBSYSTEM \"FILE\"", "keeps a subsystem with its derived equations"),
    OTHER("load", GROUP_VARIABLES, "s", " \"FILE\"", "brings back what store kept"),

    OTHER("sweep", GROUP_RUN, "pk:", " PARAMETER from=.. to=.. steps=.. : STATEMENT", "one run for each value of a parameter"),
    OTHER("montecarlo", GROUP_RUN, "v=:", " RUNS PARAMETER=normal(MEAN, DEVIATION)... : STATEMENT", "runs with random parameters"),
    OTHER("fit", GROUP_RUN, "p*k:", " PARAMETER... to=\"FILE\" : STATEMENT", "parameters that make a run match measured data"),
    OTHER("animate", GROUP_RUN, "k>", "", "moves a drawing of the model through the last run"),
    {.name = NULL},
};
/* clang-format on */

/* keys and words of rows that are here */
static const struct {
    const char *verb;
    const char *key; /* or NULL */
    const char *word;
} parts[] = {{"arm", "at", NULL},          {"simulate", "realtime", NULL},
             {"resume", "realtime", NULL}, {"export", NULL, "fortran"},
             {"export", NULL, "matlab"},   {"export", NULL, "python"},
             {"export", NULL, "fmu"}};

bool key_is_later(const char *verb, const char *key)
{
    for (int i = 0; i < COUNT(parts); i++)
        if (parts[i].key != NULL && strcmp(parts[i].key, key) == 0 &&
            strcmp(parts[i].verb, verb) == 0)
            return true;
    return false;
}

bool word_is_later(const char *verb, const char *word)
{
    for (int i = 0; i < COUNT(parts); i++)
        if (parts[i].word != NULL && strcmp(parts[i].word, word) == 0 &&
            strcmp(parts[i].verb, verb) == 0)
            return true;
    return false;
}

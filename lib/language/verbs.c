/* verbs.c: the rows of verbs: those of the tables, and those derived from components
 *
 * A component's verb follows from its row: its places and values are the pattern, its params the
 * keys, its help the help. */
#include "language/verbs.h"

#include "component/component.h"

#include <assert.h>
#include <string.h>

/* A small model that examples start from: a pendulum, 1 m long. */
#define PENDULUM                                                                                   \
    "scene planar\n"                                                                               \
    "gravity [0, -9.81]\n"                                                                         \
    "body m1 mass=1 inertia=0.1\n"                                                                 \
    "arm p1 m1 [0, 1]\n"                                                                           \
    "revolute h1 ground p1\n"

#define KEY(word)                                                                                  \
    {                                                                                              \
        .name = word                                                                               \
    }
#define KEY_OF(word, from)                                                                         \
    {                                                                                              \
        .name = word, .offers = from                                                               \
    }
#define KEY_WORDS(word, those)                                                                     \
    {                                                                                              \
        .name = word, .words = those                                                               \
    }
#define KEYS(...) ((const VerbKey[]){__VA_ARGS__, {.name = NULL}})

static const char *const formats[] = {
#define FORMAT(word, brief) #word,
#include "language/formats.def"
    NULL};
static const char *const imported_formats[] = {
#define IMPORTER(word, brief) #word,
#include "language/importers.def"
#undef IMPORTER
    NULL};

/* clang-format off */
static const Verb table[] = {
#define EVERY_VERB(word, where, ...)                                                               \
    {.name = #word, .number = VERB_##word, .room = where, __VA_ARGS__},
#include "language/verbs.def"
};
/* clang-format on */

/* by Places: what follows the name */
static const struct {
    const char *pattern;
    const char *usage;
} places[] = {
    [PLACES_NONE] = {"nVk", ""},
    [PLACES_FROM] = {"npVk", " FRAME"},
    [PLACES_FRAMES] = {"nppVk", " TAIL TIP"},
    [PLACES_ON] = {"npVk", " FRAME"},
    [PLACES_LINK] = {"npPVk", " TAIL TIP|JOINT"},
    [PLACES_JOINT] = {"npPVk", " JOINT|PLUS MINUS"},
    [PLACES_JOINTS] = {"nppVk", " JOINT JOINT|PLUS MINUS"},
    [PLACES_COORDINATE] = {"n=", " COORDINATE = EXPR"},
    [PLACES_TERMINALS] = {"nppVk", " PLUS MINUS"},
    [PLACES_TRANSDUCER] = {"npppVk", " JOINT PLUS MINUS"},
    [PLACES_SENSED] = {"nvppVk", " VARIABLE PLUS MINUS"},
    [PLACES_PARTS] = {"nppVk", " PART PART"},
};

/* by number of terminals, where the parts's places are those alone */
static const char *const terminal_patterns[] = {[2] = "nppVk", [3] = "npppVk", [4] = "nppppVk"};

static const char *component_pattern(const Component *row)
{
    return row->places == PLACES_TERMINALS ? terminal_patterns[component_terminals(row)]
                                           : places[row->places].pattern;
}

static VerbGroup component_group(const Component *row)
{
    return row->family >= FAMILY_SCALAR ? GROUP_ELECTRICAL : GROUP_MECHANICAL;
}

static Verb component_verb(const Component *row)
{
    return (Verb){.name = row->name,
                  .number = -1,
                  .room = ROOM_MODEL,
                  .changes = CHANGES_MODEL,
                  .group = component_group(row),
                  .pattern = component_pattern(row),
                  .brief = row->brief,
                  .help = row->help,
                  .example = row->example,
                  .see = row->see,
                  .component = row};
}

Verb verb_row(int number)
{
    return table[number];
}

bool verb_find(const char *name, Verb *verb)
{
    const Component *row = component_find(name);

    if (row != NULL) {
        *verb = component_verb(row);
        return true;
    }
    for (int i = 0; i < COUNT(table); i++)
        if (strcmp(table[i].name, name) == 0) {
            *verb = table[i];
            return true;
        }
    return false;
}

bool verb_any(int i, Verb *verb)
{
    for (int n = 0; component_at(n) != NULL; n++)
        if (i-- == 0) {
            *verb = component_verb(component_at(n));
            return true;
        }
    if (i >= 0 && i < COUNT(table))
        *verb = table[i];
    return i >= 0 && i < COUNT(table);
}

bool verb_at(int i, Verb *verb)
{
    for (VerbGroup group = GROUP_SCENE; group <= GROUP_SESSION; group++) {
        const Component *row;

        for (int n = 0; (row = component_at(n)) != NULL; n++)
            if (component_group(row) == group && i-- == 0) {
                *verb = component_verb(row);
                return true;
            }
        for (int n = 0; n < COUNT(table); n++)
            if (table[n].group == group && i-- == 0) {
                *verb = table[n];
                return true;
            }
    }
    return false;
}

/* the key that names a joint's coordinates; NULL: it has none */
static const char *coordinate_key(const Component *row)
{
    if (row->family != FAMILY_JOINT || row->coord_count == 0)
        return NULL;
    return row->coord_count == 1 ? "coord" : "coords";
}

const char *verb_key(const Verb *verb, int i)
{
    const Component *row = verb->component;
    int n = 0;

    if (row == NULL) {
        while (verb->keys != NULL && verb->keys[n].name != NULL && n < i)
            n++;
        return verb->keys != NULL ? verb->keys[n].name : NULL;
    }
    if (row->places == PLACES_COORDINATE)
        return i == 0 && row->family == FAMILY_DRIVER ? "by" : NULL;
    if (i < row->param_count)
        return row->params[i].name;
    return i == row->param_count ? coordinate_key(row) : NULL;
}

/* [in=ground|body]; of a long list only its start */
static void add_words(Text *text, const Param *param)
{
    enum { LONG = 30 };

    assert(param->fallback != NULL); /* it lists the words */

    size_t first = strcspn(param->fallback, "|");

    if (strlen(param->fallback) < LONG)
        text_addf(text, " [%s=%s]", param->name, param->fallback);
    else
        text_addf(text, " [%s=%.*s|...]", param->name, (int)first, param->fallback);
}

void verb_usage(Text *text, const Verb *verb)
{
    const Component *row = verb->component;

    if (row == NULL) {
        text_add(text, verb->usage != NULL ? verb->usage : verb->name);
        return;
    }
    text_addf(text, "%s NAME%s", row->name,
              row->terminal_usage != NULL ? row->terminal_usage : places[row->places].usage);
    if (row->family == FAMILY_DRIVER)
        text_add(text, " [by=SOURCE]");
    for (int i = 0; row->places != PLACES_COORDINATE && i < row->param_count; i++) {
        const Param *param = &row->params[i];
        bool must = param->fallback == NULL;

        if ((param->use & POSITIONAL) != 0)
            text_addf(text, must ? " %s" : " [%s]", param->name);
        else if (param->kind == PARAM_WORD)
            add_words(text, param);
        else
            text_addf(text, must ? " %s=.." : " [%s=..]", param->name);
    }
    if (coordinate_key(row) != NULL)
        text_addf(text, " [%s=..]", coordinate_key(row));
}

bool words_hold(const char *const *words, const char *word)
{
    while (words != NULL && *words != NULL && strcmp(*words, word) != 0)
        words++;
    return words != NULL && *words != NULL;
}

const char *group_title(VerbGroup group)
{
    static const char *const titles[] = {
        [GROUP_SCENE] = "Scene",
        [GROUP_MECHANICAL] = "Mechanical components",
        [GROUP_ELECTRICAL] = "Electrical and mechatronic components",
        [GROUP_VARIABLES] = "Variables and subsystems",
        [GROUP_TREES] = "Trees",
        [GROUP_LOOK] = "Queries",
        [GROUP_RUN] = "Runs and results",
        [GROUP_SESSION] = "Sessions",
    };
    return titles[group];
}

/* model_along.c: quantities along a flexible part: deflections and section loads, b1.v(x) */
#include "model/model_impl.h"

#include <string.h>

const Instance *part_along(const State *state, const char *text, const char **member)
{
    static const char *const members[] = {"u", "v", "w", "phi"};
    const Instance *part = state_owner(state, text, member);

    if (part == NULL || !instance_bends(part))
        return NULL;
    for (int i = 0; i < (state->setup.planar ? 2 : COUNT(members)); i++)
        if (strcmp(*member, members[i]) == 0)
            return part;
    return part->row->deforming->section(state->setup.planar, *member) != NULL ? part : NULL;
}

const char *place_unit(const State *state, const char *text)
{
    const char *member;
    const Instance *part = part_along(state, text, &member);
    const SectionPart *section =
        part != NULL ? part->row->deforming->section(state->setup.planar, member) : NULL;

    if (part == NULL)
        return NULL;
    if (section != NULL)
        return section->moment ? "N*m" : "N";
    return strcmp(member, "phi") == 0 ? "rad" : "m";
}

bool place_has_rate(const State *state, const char *name)
{
    enum { HIGHEST = 2 };
    const char *end = strrchr(name, ')');
    const Instance *part;
    const char *member;
    bool has = false;
    Text owner = {0};

    text_add_n(&owner, name, strcspn(name, "("));
    part = part_along(state, owner.at, &member);
    if (part != NULL && end != NULL)
        has = part->row->deforming->section(state->setup.planar, member) == NULL &&
              strlen(end + 1) < HIGHEST;
    text_free(&owner);
    return has;
}

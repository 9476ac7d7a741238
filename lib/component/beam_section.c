/* beam_section.c: names of forces and moments in a section: the load of the part beyond it on the
 * part before it, along the axes of the section */
#include "component/beam.h"

#include <string.h>

static const SectionPart sections[] = {
    {"axial", true, true, false, 0},   {"bending", true, false, true, 2},
    {"shear", true, false, false, 1},  {"bendingz", false, true, true, 2},
    {"sheary", false, true, false, 1}, {"bendingy", false, true, true, 1},
    {"shearz", false, true, false, 2}, {"torsion", false, true, true, 0},
};

const SectionPart *beam_section(bool planar, const char *name)
{
    const size_t length = strcspn(name, "(");

    for (int i = 0; i < COUNT(sections); i++)
        if ((planar ? sections[i].in_plane : sections[i].in_space) &&
            strncmp(sections[i].name, name, length) == 0 && sections[i].name[length] == '\0')
            return &sections[i];
    return NULL;
}

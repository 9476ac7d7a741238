/* component_rows.h: the rows of types.def by name, for the files of this folder */
#ifndef COTREE_COMPONENT_COMPONENT_ROWS_H
#define COTREE_COMPONENT_COMPONENT_ROWS_H

#include "base/memory.h"
#include "component/component.h"

#define TYPE(id) extern const Component component_##id;
#include "component/types.def"
#undef TYPE

#endif

/* session.c: the public face of the library */
#include "cotree.h"

#include "base/memory.h"
#include "config.h"

const char *ct_version(void)
{
    return PACKAGE_VERSION;
}

void ct_free(void *piece)
{
    mem_free(piece);
}

/* flint_library.c: FLINT, loaded where it is first used */
#include "base/flint_library.h"

#include <config.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>

FlintLibrary flint;

static char failure[200]; /* why it can't be loaded; "": it is */

static void load(void)
{
    static const struct {
        const char *name;
        size_t at; /* in FlintLibrary */
    } functions[] = {
#define FLINT(name) {#name, offsetof(FlintLibrary, name)},
#include "base/flint_functions.def"
#undef FLINT
    };
    void *library = dlopen(FLINT_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
    void *function = library;

    for (size_t i = 0; i < sizeof functions / sizeof functions[0] && function != NULL; i++) {
        function = dlsym(library, functions[i].name);
        *(void **)((char *)&flint + functions[i].at) = function;
    }
    if (function == NULL) {
        const char *why = dlerror();

        (void)snprintf(failure, sizeof failure, "%s",
                       why != NULL ? why : FLINT_LIBRARY " lacks a function");
    }
}

Status flint_load(Diag *diag)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    (void)pthread_once(&once, load);
    if (failure[0] == '\0')
        return OK;
    (void)diag_set(diag, E_MISSING, "FLINT, the library for polynomials, can't be loaded: %s",
                   failure);
    diag_hint(diag, "install its package (libflint-dev or libflint17)");
    return E_MISSING;
}

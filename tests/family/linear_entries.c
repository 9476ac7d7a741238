/* linear_entries.c: through a session, whose last linearisation is looked into */
#include "linear_entries.h"

#include "../unit/session_kit.h"
#include "session/session_impl.h"

double *linear_entries(const char *script, int *states, char *reason, size_t size)
{
    Kit kit = kit_new();
    const bool is_done = kit_do(&kit, script) == CT_OK;
    const Linear *linear = kit.session->linear;
    double *out = NULL;

    (void)snprintf(reason, size, "%s", is_done ? "" : kit.error.message);
    if (is_done && linear != NULL) {
        const size_t count = (size_t)linear->states * (size_t)linear->states;

        out = malloc((count + 1) * sizeof *out);
        if (out != NULL)
            memcpy(out, linear->a, count * sizeof *out);
        *states = linear->states;
    }
    kit_free(&kit);
    return out;
}

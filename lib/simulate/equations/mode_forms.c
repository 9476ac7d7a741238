/* mode_forms.c: Hessenberg forms by switch states */
#include "simulate/equations/mode_forms.h"

#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <stdint.h>
#include <string.h>

typedef struct Kept {
    uint64_t hash;
    bool *closed;
    HessenbergForm *form;
} Kept;

struct ModeForms {
    int switches;
    double bytes;
    LIST(Kept) kept;
    int oldest; /* when memory is full: the form that is replaced next */
};

ModeForms *mode_forms_new(int switches)
{
    ModeForms *f = NEW(ModeForms);

    f->switches = switches;
    return f;
}

void mode_forms_free(ModeForms *f)
{
    if (f == NULL)
        return;
    for (int i = 0; i < f->kept.count; i++) {
        mem_free(f->kept.at[i].closed);
        hessenberg_form_free(f->kept.at[i].form);
    }
    LIST_FREE(f->kept);
    mem_free(f);
}

/* key of a mode: FNV-1a hash of the sides of all switches */
static uint64_t hash_of(const ModeForms *f, const bool *closed)
{
    uint64_t hash = 14695981039346656037U;

    for (int i = 0; i < f->switches; i++)
        hash = (hash ^ closed[i]) * 1099511628211U;
    return hash;
}

const HessenbergForm *mode_forms_find(const ModeForms *f, const bool *closed)
{
    uint64_t hash = hash_of(f, closed);

    for (int i = 0; i < f->kept.count; i++)
        if (f->kept.at[i].hash == hash &&
            memcmp(f->kept.at[i].closed, closed, (size_t)f->switches * sizeof(bool)) == 0)
            return f->kept.at[i].form;
    return NULL;
}

const HessenbergForm *mode_forms_store(ModeForms *f, const bool *closed, HessenbergForm *given)
{
    double bytes = (double)hessenberg_form_bytes(given);
    Kept *kept;

    if (f->kept.count == 0 || f->bytes + bytes <= MODE_FORMS_MOST_BYTES) {
        LIST_PUSH(f->kept, (Kept){.closed = NEW_ARRAY(bool, f->switches)});
        kept = &f->kept.at[f->kept.count - 1];
        f->bytes += bytes;
    } else {
        kept = &f->kept.at[f->oldest];
        f->oldest = (f->oldest + 1) % f->kept.count;
        hessenberg_form_free(kept->form);
    }
    kept->hash = hash_of(f, closed);
    kept->form = given;
    memcpy(kept->closed, closed, (size_t)f->switches * sizeof(bool));
    return given;
}

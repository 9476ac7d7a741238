/* identity.c: keys made of identities, and what is stored under them */
#include "formulate/kinematics/identity.h"

#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <string.h>

Key key_of(Expr identity)
{
    return (Key){.at = {identity}, .count = 1, .is_determined = identity != NULL};
}

void key_add(Key *key, const void *entries, size_t size)
{
    const int count = (int)(size / sizeof(Expr));

    /* with more entries the result is derived anew each time */
    if (count > MOST_KEY - key->count) {
        key->is_determined = false;
        return;
    }
    memcpy(key->at + key->count, entries, size);
    for (int i = 0; i < count; i++)
        key->is_determined = key->is_determined && key->at[key->count + i] != NULL;
    key->count += count;
}

Expr key_end(const System *system, const Key *key)
{
    return key->is_determined ? expr_tuple(system->arena, key->at, key->count) : NULL;
}

void key_add_turn(Key *key, const OrientationClass *chain)
{
    if (chain->is_free) {
        key_add(key, &chain->matrix, sizeof chain->matrix);
        key_add(key, chain->parameter, sizeof chain->parameter);
    } else {
        key_add(key, &chain->axis, sizeof chain->axis);
        key_add(key, &chain->angle, sizeof chain->angle);
    }
}

/* key of the turns from one orientation class to another one beyond it, or of both classes as they
 * are */
static Expr turn_key(const System *system, int from, int to)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    Expr turns = chains[0].identity;

    if (to < from || chains[to].first < chains[from].first || chains[to].first > chains[from].last)
        return expr_tuple(system->arena, (Expr[]){chains[from].identity, chains[to].identity}, 2);
    for (int c = to; c != from; c = chains[c].parent) {
        /* several turns about one line add up from the first of them */
        const Expr is_whole =
            expr_int(system->arena,
                     chains[c].parent == from || chains[chains[c].run].depth > chains[from].depth);
        Key key = key_of(turns);

        key_add_turn(&key, &chains[c]);
        key_add(&key, &is_whole, sizeof is_whole);
        turns = key_end(system, &key);
    }
    return turns;
}

Expr key_passed(const System *system, int node, Expr beyond)
{
    const Frame *frames = system->kinematics->frames, *frame = &frames[node];
    Key key = key_of(beyond);
    Expr turns;

    if (beyond == NULL || frame->identity == NULL)
        return NULL;
    turns = turn_key(system, frames[frame->parent].chain, frame->chain);
    key_add(&key, &turns, sizeof turns);
    key_add(&key, &frame->step, sizeof frame->step);
    return key_end(system, &key);
}

Expr key_join(const System *system, Expr identity, Expr own, Passed how, Expr passed)
{
    if (identity == NULL || passed == NULL)
        return own;
    return expr_tuple(system->arena,
                      (Expr[]){own != NULL ? own : identity, expr_int(system->arena, how), passed},
                      3);
}

Expr key_of_inertia(const System *system, const Mass *mass)
{
    Key key = key_of(system->kinematics->frames[mass->node].identity);

    key_add(&key, &mass->mass, sizeof mass->mass);
    key_add(&key, &mass->inertia, sizeof mass->inertia);
    key_add(&key, &system->origin->gravity, sizeof system->origin->gravity);
    return key_end(system, &key);
}

bool derived_is_kept(const System *system, Expr key, Derived which)
{
    return key != NULL && expr_recall(system->arena, key, which, NULL, 0);
}

bool derived_recall(const System *system, Expr key, Derived which, void *out, size_t size)
{
    return key != NULL && expr_recall(system->arena, key, which, out, size);
}

void derived_store(const System *system, Expr key, Derived which, const void *values, size_t size)
{
    if (key != NULL)
        expr_remember(system->arena, key, which, values, size);
}

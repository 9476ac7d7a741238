/* isomorphic.h: instances of one definition: what was derived of the first, the others take over
 *
 * Where the frames and masses of an instance are those of an earlier one with its own names in the
 * place of the other's, it *follows* that one: its motion, composite bodies, forces and ways come
 * from the first's by renaming, as long as nothing else stands in them. An instance that the tree
 * enters another way, or whose numbers differ, is derived by itself. Only while a System is made.
 */
#ifndef COTREE_FORMULATE_KINEMATICS_ISOMORPHIC_H
#define COTREE_FORMULATE_KINEMATICS_ISOMORPHIC_H

#include "formulate/kinematics/identity.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"
#include "graph/tree.h"

typedef struct Follower Follower; /* an instance that follows another one */

/* behind the frames and masses, before anything follows from them; what system_instanced() tells */
void isomorphic_build(System *system);
void isomorphic_free(struct IsomorphicSubsystems *alike); /* NULL is fine */

/* Whose it is, and its counterpart in the first; NULL: it follows none. */
Follower *isomorphic_node(const System *system, int node, int *first);
Follower *isomorphic_chain(const System *system, int chain, int *first);
Follower *isomorphic_speed(const System *system, int speed, int *first);
const int *isomorphic_members(const Follower *follower, int *count); /* its nodes */
/* The counterpart of a chain that is inside, or itself where it is outside of both (-1: none);
 * false: it is inside the first. */
bool isomorphic_chain_for(const System *system, const Follower *follower, int chain, int *out);

bool isomorphic_is_first(const System *system, const Follower *follower,
                         int node);                         /* in the first */
bool isomorphic_is_outside(const System *system, int node); /* of all */

/* What the ways through a first instance sum up to, kept for all that follow it. */
typedef struct FirstWay {
    int node, chain, axes;
    Vec sum; /* from where the instance hangs to the node, as far as the chain turns it */
} FirstWay;
bool isomorphic_find_way(const Follower *follower, FirstWay *way); /* false: not kept yet */
void isomorphic_keep_way(const Follower *follower, const FirstWay *way);
/* where it hangs moves as `to`, where the first hangs as `from`: the motion inside is taken over */
bool isomorphic_hangs(Follower *follower, Vec from, Vec to);
bool isomorphic_moves(const Follower *follower); /* it could be, so far */
/* nothing but its own hangs on it or on the first */
bool isomorphic_ends(const Follower *follower);

/* From now on a symbol becomes that in what it takes over; false: something else became of it. */
bool isomorphic_fill(const Follower *follower, Expr hole, Expr value);
Expr isomorphic_take(const Follower *follower, Expr e);
Vec isomorphic_vec(const Follower *follower, Vec v);

/* What is taken over needs no key: it is found by the first's. But whoever comes first where that
 * one is gone, the heir, has it kept under keys of its own. */
bool isomorphic_is_heir(const Follower *follower);
void isomorphic_keep(const System *system, const Follower *follower, Expr key, Derived which,
                     const void *values, size_t size);

/* How many first ones lie behind a node: that of its instance, that of whose this is, ... */
int isomorphic_level(const System *system, int node);

/* The nodes of a tree inward, each behind all of the instance that its own takes its loads over
 * from: new, mem_free() */
int *isomorphic_inward(const System *system, TreeKind kind, int *count);

#endif

/* isomorphic.h: instances of one definition reuse the results derived for the first
 *
 * Where the frames and masses of an instance equal those of an earlier one with its own names
 * substituted, it *follows* that one: its motion, composite bodies, forces and paths come from the
 * first by renaming, as long as they contain nothing else. An instance that the tree enters another
 * way, or whose numbers differ, is derived by itself. Exists only while a System is built. */
#ifndef COTREE_FORMULATE_KINEMATICS_ISOMORPHIC_H
#define COTREE_FORMULATE_KINEMATICS_ISOMORPHIC_H

#include "formulate/kinematics/identity.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"
#include "graph/tree.h"

typedef struct Follower Follower; /* an instance that follows another one */

/* after the frames and masses, before identities and results; the data that system_instanced()
 * returns */
void isomorphic_build(System *system);
/* finds instances that an earlier System has derived; after identities, before any results */
void isomorphic_find_recalled(System *system);
void isomorphic_free(struct IsomorphicSubsystems *alike); /* NULL is fine */

/* The follower that a node belongs to, and its counterpart in the first; NULL: it follows none. */
Follower *isomorphic_node(const System *system, int node, int *first);
Follower *isomorphic_chain(const System *system, int chain, int *first);
Follower *isomorphic_speed(const System *system, int speed, int *first);
const int *isomorphic_members(const Follower *follower, int *count); /* its nodes */
/* The counterpart of an orientation class that is inside, or the class itself where it is outside
 * of both (-1: none); false: it is inside the first. */
bool isomorphic_chain_for(const System *system, const Follower *follower, int chain, int *out);

bool isomorphic_is_first(const System *system, const Follower *follower,
                         int node);                         /* in the first */
bool isomorphic_is_outside(const System *system, int node); /* of all instances */

/* Sums along the paths through a first instance, stored for all instances that follow it. */
typedef struct FirstWay {
    int node, chain, axes;
    /* from where the instance hangs to the node, as far as the orientation class turns it */
    Vec sum;
} FirstWay;
bool isomorphic_find_way(const Follower *follower, FirstWay *way); /* false: not stored yet */
void isomorphic_keep_way(const Follower *follower, const FirstWay *way);
/* the follower's attachment moves as `to`, the first's as `from`: takes over the motion inside */
bool isomorphic_hangs(Follower *follower, Vec from, Vec to);
bool isomorphic_moves(const Follower *follower); /* possible so far */
/* whether no part outside is connected to the nodes inside it or inside the first instance */
bool isomorphic_ends(const Follower *follower);

/* From now on `hole` becomes `value` in what it takes over; false: another value was set before. */
bool isomorphic_fill(const Follower *follower, Expr hole, Expr value);
Expr isomorphic_take(const Follower *follower, Expr e);
Vec isomorphic_vec(const Follower *follower, Vec v);

/* How many first instances precede a node: that of its instance, that of the first's instance,
 * ... */
int isomorphic_level(const System *system, int node);

/* The nodes of a tree inward, each after all nodes of the instance that its own takes its loads
 * over from: new, mem_free() */
int *isomorphic_inward(const System *system, TreeKind kind, int *count);

#endif

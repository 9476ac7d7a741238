/* isomorphic.c: which instances follow which
 *
 * Names pair the parts that two instances of one definition made. Two instances are isomorphic when
 * each pair of frames, turns and masses is equal except for the names in it: motion, composites and
 * forces follow from these alone. Both must hang from the same orientation class outside. The
 * motion of that class is paired when it is known. */
#include "formulate/kinematics/isomorphic.h"

#include "base/names.h"
#include "formulate/kinematics/identity.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <stdlib.h>
#include <string.h>

typedef LIST(int) IntList;

typedef struct Inside { /* what an instance made, including the instances inside it */
    int use;
    char *prefix; /* "leg1." */
    int begin;    /* position of its first node in the tree's order */
    IntList nodes, chains, speeds, masses;
    bool is_open; /* something else hangs on it */
    LIST(FirstWay) ways;
} Inside;

struct Follower {
    const Inside *own;
    Inside *first;
    Renaming *renaming;
    bool moves;
};

struct IsomorphicSubsystems {
    Arena *arena; /* owns the renamings */
    int count;    /* number of instances */
    Inside *inside;
    int *use_of_node, *use_of_chain; /* the innermost instance; -1: none */
    int *place;                      /* position of a node in the tree's order */
    Follower **of;                   /* instances; NULL: it follows none */
    Follower **of_node, **of_chain, **of_speed;
    int *node, *chain, *speed; /* counterparts */
};

/* --- contents of instances --- */

static int innermost(const Names *uses, const char *name)
{
    int found = -1;

    for (const char *dot = strchr(name, '.'); dot != NULL; dot = strchr(dot + 1, '.')) {
        const int use = names_find_part(uses, name, (size_t)(dot - name));

        if (use >= 0)
            found = use;
    }
    return found;
}

static const char *node_name(const System *system, int node)
{
    return graph_node(system->origin->graph, node)->name;
}

static void gather_frames(const System *system, const Names *uses, IsomorphicSubsystems *alike)
{
    const Instanced *made = system->origin->uses;
    int count;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &count);

    for (int i = 0; i < graph_node_count(system->origin->graph); i++)
        alike->use_of_node[i] = -1;
    for (int i = 0; i < count; i++) {
        int use = alike->use_of_node[order[i]] = innermost(uses, node_name(system, order[i]));

        alike->place[order[i]] = i;
        for (; use >= 0; use = made[use].outer) {
            if (alike->inside[use].nodes.count == 0)
                alike->inside[use].begin = i;
            LIST_PUSH(alike->inside[use].nodes, order[i]);
        }
    }
}

static void gather(const System *system, const Names *uses, IsomorphicSubsystems *alike)
{
    const Instanced *made = system->origin->uses;
    const Kinematics *kinematics = system->kinematics;

    gather_frames(system, uses, alike);
    for (int j = 0; j < kinematics->u.count; j++)
        for (int use = innermost(uses, kinematics->u.at[j].name); use >= 0; use = made[use].outer)
            LIST_PUSH(alike->inside[use].speeds, j);
    alike->use_of_chain[0] = -1;
    for (int c = 1; c < kinematics->chains.count; c++) {
        const char *name = kinematics->u.at[kinematics->chains.at[c].speed].name;
        int use = alike->use_of_chain[c] = innermost(uses, name);

        for (; use >= 0; use = made[use].outer)
            LIST_PUSH(alike->inside[use].chains, c);
    }
    for (int i = 0; i < system->dynamics->masses.count; i++) {
        int use = alike->use_of_node[system->dynamics->masses.at[i].node];

        for (; use >= 0; use = made[use].outer)
            LIST_PUSH(alike->inside[use].masses, i);
    }
}

/* `use` is the instance `around`, or inside it */
static bool is_within(const System *system, int use, int around)
{
    while (use >= 0 && use != around)
        use = system->origin->uses[use].outer;
    return use == around;
}

/* a node that hangs on another one */
static void hang(const System *system, IsomorphicSubsystems *alike, int node, int on)
{
    for (int use = on < 0 ? -1 : alike->use_of_node[on];
         use >= 0 && !is_within(system, alike->use_of_node[node], use);
         use = system->origin->uses[use].outer)
        alike->inside[use].is_open = true;
}

static void find_open(const System *system, IsomorphicSubsystems *alike)
{
    int count;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &count);

    for (int i = 1; i < count; i++) {
        hang(system, alike, order[i], system->kinematics->frames[order[i]].parent);
        hang(system, alike, order[i], system->kinematics->frames[order[i]].base);
        hang(system, alike, order[i], tree_parent(system->origin->trees[TREE_ROTATION], order[i]));
    }
}

/* --- whether two are isomorphic --- */

typedef struct Pairing {
    const System *system;
    const IsomorphicSubsystems
        *alike; /* counterparts of those of `own`, as far as they were compared */
    const Inside *own;
    Inside *first;
    Renaming *renaming;
} Pairing;

static bool is_vec(const Pairing *p, Vec own, Vec first)
{
    for (int i = 0; i < 3; i++)
        if (renaming_of(p->renaming, first.at[i]) != own.at[i])
            return false;
    return true;
}

static bool is_rotation(const Pairing *p, const Rotation *own, const Rotation *first)
{
    for (int i = 0; i < 9; i++)
        if (own->at[i] != first->at[i] && renaming_of(p->renaming, first->at[i]) != own->at[i])
            return false;
    return true;
}

static bool same_names(const Pairing *p)
{
    const Variable *u = p->system->kinematics->u.at;
    const size_t own = strlen(p->own->prefix), first = strlen(p->first->prefix);

    if (p->own->nodes.count != p->first->nodes.count ||
        p->own->speeds.count != p->first->speeds.count ||
        p->own->chains.count != p->first->chains.count ||
        p->own->masses.count != p->first->masses.count)
        return false;
    for (int k = 0; k < p->own->speeds.count; k++) {
        const int j = p->own->speeds.at[k], i = p->first->speeds.at[k];

        if (strcmp(u[j].name + own, u[i].name + first) != 0)
            return false;
        p->alike->speed[j] = i;
    }
    return true;
}

/* Pairs the nodes of two instances by their names. False where names differ, or a node does not
 * come after its pair in the order of the tree (that order may differ among siblings). */
static bool pair_nodes(const Pairing *p)
{
    const size_t prefix = strlen(p->first->prefix), own = strlen(p->own->prefix);
    Names *names = names_borrowing();
    bool same = true;

    for (int k = 0; k < p->first->nodes.count; k++)
        (void)names_add(names, node_name(p->system, p->first->nodes.at[k]) + prefix);
    for (int k = 0; same && k < p->own->nodes.count; k++) {
        const int node = p->own->nodes.at[k];
        const int place = names_find(names, node_name(p->system, node) + own);
        const int first = place >= 0 ? p->first->nodes.at[place] : -1;

        same = place >= 0 && p->alike->place[first] < p->alike->place[node];
        p->alike->node[node] = first;
    }
    names_free(names);
    return same;
}

/* a speed, orientation class or node that is outside is the same for both */
static bool is_speed(const Pairing *p, int own, int first)
{
    const Instance *owner =
        &p->system->origin->instances[p->system->kinematics->u.at[own].instance];

    if (strncmp(owner->name, p->own->prefix, strlen(p->own->prefix)) != 0)
        return own == first;
    return p->alike->speed[own] == first;
}

static bool is_chain(const Pairing *p, int own, int first)
{
    if (!is_within(p->system, p->alike->use_of_chain[own], p->own->use))
        return own == first;
    return p->alike->chain[own] == first;
}

/* the frame that it hangs from may be another one outside */
static bool is_node(const Pairing *p, int own, int first)
{
    if (own < 0 || first < 0)
        return own == first;
    if (is_within(p->system, p->alike->use_of_node[own], p->own->use))
        return p->alike->node[own] == first;
    return !is_within(p->system, p->alike->use_of_node[first], p->first->use) &&
           p->system->kinematics->frames[own].chain == p->system->kinematics->frames[first].chain;
}

static bool same_chain(const Pairing *p, int own, int first)
{
    const OrientationClass *a = &p->system->kinematics->chains.at[own];
    const OrientationClass *b = &p->system->kinematics->chains.at[first];

    if (first > own || !is_chain(p, a->parent, b->parent) || a->is_free != b->is_free ||
        !is_speed(p, a->speed, b->speed))
        return false;
    p->alike->chain[own] = first;
    if (a->is_free)
        return is_rotation(p, &a->matrix, &b->matrix);
    return is_vec(p, a->axis, b->axis) && renaming_of(p->renaming, b->angle) == a->angle;
}

static bool same_frame(const Pairing *p, int own, int first)
{
    const Frame *a = &p->system->kinematics->frames[own];
    const Frame *b = &p->system->kinematics->frames[first];
    const Tree *rotation = p->system->origin->trees[TREE_ROTATION];
    bool same = is_chain(p, a->chain, b->chain) && is_chain(p, a->step_chain, b->step_chain) &&
                is_node(p, a->parent, b->parent) && is_node(p, a->base, b->base) &&
                is_node(p, tree_parent(rotation, own), tree_parent(rotation, first)) &&
                is_rotation(p, &a->zero, &b->zero) && is_vec(p, a->shift, b->shift) &&
                a->slide_count == b->slide_count;

    for (int k = 0; same && k < a->slide_count; k++)
        same = is_speed(p, a->slide[k].speed, b->slide[k].speed) &&
               is_vec(p, a->slide[k].axis, b->slide[k].axis);
    return same;
}

static bool same_mass(const Pairing *p, const Mass *own, const Mass *first)
{
    return is_node(p, own->node, first->node) && own->has_inertia == first->has_inertia &&
           renaming_of(p->renaming, first->mass) == own->mass &&
           is_rotation(p, &own->inertia, &first->inertia);
}

static bool are_isomorphic(const Pairing *p)
{
    const Mass *masses = p->system->dynamics->masses.at;

    if (!same_names(p) || !pair_nodes(p))
        return false;
    for (int k = 0; k < p->own->chains.count; k++)
        if (!same_chain(p, p->own->chains.at[k], p->first->chains.at[k]))
            return false;
    for (int k = 0; k < p->own->nodes.count; k++)
        if (!same_frame(p, p->own->nodes.at[k], p->alike->node[p->own->nodes.at[k]]))
            return false;
    for (int k = 0; k < p->own->masses.count; k++)
        if (!same_mass(p, &masses[p->own->masses.at[k]], &masses[p->first->masses.at[k]]))
            return false;
    return true;
}

/* --- which instance follows which --- */

static void follow(IsomorphicSubsystems *alike, const Pairing *p, int use)
{
    Follower *follower = NEW(Follower);

    *follower = (Follower){p->own, p->first, p->renaming, true};
    alike->of[use] = follower;
    for (int k = 0; k < p->own->nodes.count; k++)
        alike->of_node[p->own->nodes.at[k]] = follower;
    for (int k = 0; k < p->own->chains.count; k++)
        alike->of_chain[p->own->chains.at[k]] = follower;
    for (int k = 0; k < p->own->speeds.count; k++) {
        alike->of_speed[p->own->speeds.at[k]] = follower;
        alike->speed[p->own->speeds.at[k]] = p->first->speeds.at[k];
    }
}

/* whether an instance, or one that contains it, already follows another */
static bool is_taken(const System *system, const IsomorphicSubsystems *alike, int use)
{
    for (; use >= 0; use = system->origin->uses[use].outer)
        if (alike->of[use] != NULL)
            return true;
    return false;
}

/* searches those that precede it in the tree */
static void look_for_first(const System *system, IsomorphicSubsystems *alike, const int *order,
                           int at)
{
    Instanced *made = system->origin->uses;
    const int use = order[at];
    bool is_new;

    for (int k = 0; k < at; k++) {
        const int first = order[k];
        Pairing p = {.system = system,
                     .alike = alike,
                     .own = &alike->inside[use],
                     .first = &alike->inside[first]};

        if (strcmp(made[first].definition, made[use].definition) != 0 ||
            is_taken(system, alike, first))
            continue;
        p.renaming = renaming_kept(system->arena, p.first->prefix, p.own->prefix, &is_new);
        if (are_isomorphic(&p)) {
            follow(alike, &p, use);
            made[use].first = first;
            made[use].is_recalled = !is_new; /* until isomorphic_find_recalled() */
            return;
        }
        if (is_new)
            renaming_forget(system->arena);
    }
}

static int by_begin(const void *a, const void *b)
{
    const Inside *const *one = a, *const *other = b;
    const int off = (*one)->begin - (*other)->begin;

    return off != 0 ? off : (*one)->use - (*other)->use; /* an outer one first */
}

/* instances with frames, in the order of the tree; room for all */
static int in_order(const IsomorphicSubsystems *alike, int *order)
{
    const Inside **inside = NEW_ARRAY(const Inside *, alike->count);
    int count = 0;

    for (int i = 0; i < alike->count; i++)
        if (alike->inside[i].nodes.count > 0)
            inside[count++] = &alike->inside[i];
    qsort(inside, (size_t)count, sizeof *inside, by_begin);
    for (int i = 0; i < count; i++)
        order[i] = inside[i]->use;
    mem_free(inside);
    return count;
}

static IsomorphicSubsystems *isomorphic_new(const System *system)
{
    const int nodes = graph_node_count(system->origin->graph),
              chains = system->kinematics->chains.count, speeds = system->kinematics->speed_count;
    IsomorphicSubsystems *alike = NEW(IsomorphicSubsystems);

    alike->arena = system->arena;
    alike->count = system->origin->use_count;
    alike->inside = NEW_ARRAY(Inside, alike->count);
    alike->of = NEW_ARRAY(Follower *, alike->count);
    alike->use_of_node = NEW_ARRAY(int, nodes);
    alike->place = NEW_ARRAY(int, nodes);
    alike->use_of_chain = NEW_ARRAY(int, chains);
    alike->of_node = NEW_ARRAY(Follower *, nodes);
    alike->of_chain = NEW_ARRAY(Follower *, chains);
    alike->of_speed = NEW_ARRAY(Follower *, speeds);
    alike->node = NEW_ARRAY(int, nodes);
    alike->chain = NEW_ARRAY(int, chains);
    alike->speed = NEW_ARRAY(int, speeds);
    return alike;
}

void isomorphic_build(System *system)
{
    const Origin *origin = system->origin;
    IsomorphicSubsystems *alike;
    Names *uses;
    int *order, count;

    if (origin->use_count < 1 || origin->trees[TREE_TRANSLATION] == NULL ||
        system->kinematics->dependents.count > 0)
        return;
    alike = system->alike = isomorphic_new(system);
    uses = names_borrowing();
    for (int i = 0; i < origin->use_count; i++) {
        Text prefix = {0};

        (void)names_add(uses, origin->uses[i].name);
        alike->inside[i].use = i;
        text_addf(&prefix, "%s.", origin->uses[i].name);
        alike->inside[i].prefix = text_done(&prefix);
    }
    gather(system, uses, alike);
    names_free(uses);
    find_open(system, alike);
    order = NEW_ARRAY(int, origin->use_count);
    count = in_order(alike, order);
    for (int i = 1; i < count; i++)
        if (!is_taken(system, alike, order[i]))
            look_for_first(system, alike, order, i);
    mem_free(order);
}

/* whether an earlier System derived its motion and its masses; this one has derived none yet. What
 * follows another instance is renamed. */
static bool is_recalled(const System *system, const Inside *inside)
{
    const IsomorphicSubsystems *alike = system->alike;
    const Kinematics *kinematics = system->kinematics;
    bool known = inside->nodes.count > 0;

    for (int k = 0; known && k < inside->chains.count; k++)
        known = alike->of_chain[inside->chains.at[k]] != NULL ||
                derived_is_kept(system, kinematics->chains.at[inside->chains.at[k]].identity,
                                DERIVED_TURN);
    for (int k = 0; known && k < inside->nodes.count; k++)
        known =
            alike->of_node[inside->nodes.at[k]] != NULL ||
            derived_is_kept(system, kinematics->frames[inside->nodes.at[k]].identity, DERIVED_STEP);
    for (int k = 0; known && k < inside->masses.count; k++) {
        const Mass *mass = &system->dynamics->masses.at[inside->masses.at[k]];

        known = alike->of_node[mass->node] != NULL ||
                derived_is_kept(system, key_of_inertia(system, mass), DERIVED_INERTIA);
    }
    return known;
}

void isomorphic_find_recalled(System *system)
{
    Instanced *uses = system->origin->uses;

    if (system->alike == NULL)
        return;
    for (int i = 0; i < system->origin->use_count; i++)
        if (!is_taken(system, system->alike, i))
            uses[i].is_recalled = is_recalled(system, &system->alike->inside[i]);
    for (int i = 0; i < system->origin->use_count; i++)
        if (uses[i].first >= 0)
            uses[i].is_recalled = uses[i].is_recalled && uses[uses[i].first].is_recalled;
}

void isomorphic_free(IsomorphicSubsystems *alike)
{
    if (alike == NULL)
        return;
    renamings_end(alike->arena);
    for (int i = 0; i < alike->count; i++) {
        Inside *inside = &alike->inside[i];

        LIST_FREE(inside->nodes);
        LIST_FREE(inside->chains);
        LIST_FREE(inside->speeds);
        LIST_FREE(inside->masses);
        LIST_FREE(inside->ways);
        mem_free(inside->prefix);
        mem_free(alike->of[i]);
    }
    MEM_FREE(alike->inside, alike->of, alike->use_of_node, alike->use_of_chain, alike->place,
             alike->of_node, alike->of_chain, alike->of_speed, alike->node, alike->chain,
             alike->speed);
    mem_free(alike);
}

/* --- queries --- */

Follower *isomorphic_node(const System *system, int node, int *first)
{
    if (system->alike == NULL || system->alike->of_node[node] == NULL)
        return NULL;
    *first = system->alike->node[node];
    return system->alike->of_node[node];
}

Follower *isomorphic_chain(const System *system, int chain, int *first)
{
    if (system->alike == NULL || system->alike->of_chain[chain] == NULL)
        return NULL;
    *first = system->alike->chain[chain];
    return system->alike->of_chain[chain];
}

Follower *isomorphic_speed(const System *system, int speed, int *first)
{
    if (system->alike == NULL || system->alike->of_speed[speed] == NULL)
        return NULL;
    *first = system->alike->speed[speed];
    return system->alike->of_speed[speed];
}

const int *isomorphic_members(const Follower *follower, int *count)
{
    *count = follower->own->nodes.count;
    return follower->own->nodes.at;
}

bool isomorphic_chain_for(const System *system, const Follower *follower, int chain, int *out)
{
    const int use = chain > 0 ? system->alike->use_of_chain[chain] : -1;

    *out = is_within(system, use, follower->own->use) ? system->alike->chain[chain] : chain;
    return *out != chain || !is_within(system, use, follower->first->use);
}

bool isomorphic_find_way(const Follower *follower, FirstWay *way)
{
    for (int i = 0; i < follower->first->ways.count; i++) {
        const FirstWay *kept = &follower->first->ways.at[i];

        if (kept->node == way->node && kept->chain == way->chain && kept->axes == way->axes) {
            way->sum = kept->sum;
            return true;
        }
    }
    return false;
}

void isomorphic_keep_way(const Follower *follower, const FirstWay *way)
{
    LIST_PUSH(follower->first->ways, *way);
}

bool isomorphic_hangs(Follower *follower, Vec from, Vec to)
{
    for (int i = 0; i < 3; i++)
        follower->moves = follower->moves &&
                          expr_is_number(from.at[i]) == expr_is_number(to.at[i]) &&
                          renaming_pair(follower->renaming, from.at[i], to.at[i]);
    return follower->moves;
}

bool isomorphic_is_first(const System *system, const Follower *follower, int node)
{
    return is_within(system, system->alike->use_of_node[node], follower->first->use);
}

bool isomorphic_is_outside(const System *system, int node)
{
    return system->alike->use_of_node[node] < 0;
}

bool isomorphic_fill(const Follower *follower, Expr hole, Expr value)
{
    return renaming_pair(follower->renaming, hole, value);
}

bool isomorphic_moves(const Follower *follower)
{
    return follower->moves;
}

bool isomorphic_ends(const Follower *follower)
{
    return !follower->own->is_open && !follower->first->is_open;
}

Expr isomorphic_take(const Follower *follower, Expr e)
{
    return renaming_of(follower->renaming, e);
}

Vec isomorphic_vec(const Follower *follower, Vec v)
{
    for (int i = 0; i < 3; i++)
        v.at[i] = renaming_of(follower->renaming, v.at[i]);
    return v;
}

int isomorphic_level(const System *system, int node)
{
    int level = 0;

    while (isomorphic_node(system, node, &node) != NULL)
        level++;
    return level;
}

/* --- an order inward --- */

typedef struct Inward {
    const IsomorphicSubsystems *alike;
    const int *order; /* of the tree, outward */
    int nodes, count;
    bool *is_listed; /* a node */
    int *list;
} Inward;

/* Lists a node after all nodes that hang on it, and after the whole instance that its own follows:
 * the recursion is as deep as definitions are nested. */
static void list_node(Inward *inward, int node);

static void list_inside(Inward *inward, const Inside *inside)
{
    for (int i = inward->nodes - 1; i > 0; i--)
        for (int k = 0; k < inside->nodes.count; k++)
            if (inside->nodes.at[k] == inward->order[i])
                list_node(inward, inward->order[i]);
}

static void list_node(Inward *inward, int node)
{
    const Follower *follower = inward->alike != NULL ? inward->alike->of_node[node] : NULL;

    if (inward->is_listed[node])
        return;
    if (follower != NULL && isomorphic_ends(follower) &&
        !inward->is_listed[inward->alike->node[node]])
        list_inside(inward, follower->first);
    inward->is_listed[node] = true;
    inward->list[inward->count++] = node;
}

int *isomorphic_inward(const System *system, TreeKind kind, int *count)
{
    Inward inward = {.alike = system->alike};

    inward.order = tree_nodes(system->origin->trees[kind], &inward.nodes);
    inward.is_listed = NEW_ARRAY(bool, graph_node_count(system->origin->graph));
    inward.list = NEW_ARRAY(int, inward.nodes);
    for (int i = inward.nodes - 1; i > 0; i--)
        list_node(&inward, inward.order[i]);
    mem_free(inward.is_listed);
    *count = inward.count;
    return inward.list;
}

/* initial_place.c: assembly starts with frames placed along the joints
 *
 * Frames are placed along trees that assembly chooses by what is known: first edges whose
 * coordinates are given, then those that are guessed, then joints before bodies. A coordinate
 * without a given value starts at its guess, or at 0. Loops and given values of other coordinates
 * are solved for by Levenberg-Marquardt in the coordinates of these trees. So the poses of frames
 * depend on the model and on the given values, and not on the user's trees. A new assembly in the
 * middle of a run works in the same way. */
#include "simulate/assemble/initial_place_impl.h"

#include "algebra/matrix3.h"
#include "simulate/assemble/assemble_limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 300 }; /* of bodies' coordinates: the cost is their number cubed */

/* --- initial point --- */

/* initial values of the coordinates of a half of a link that are neither given nor guessed */
static void begin_half(Placing *p, int link, bool rotation)
{
    const Link *l = &p->s->links[link];
    const Instance *instance = l->instance;

    for (int k = 0; k < instance->pose_count; k++)
        if (instance->coord_rotation[k] == rotation && !isfinite(p->begun[place_at(link, k)]))
            p->begun[place_at(link, k)] = l->has_parameters && k == l->first_parameter ? 1 : 0;
    if (rotation && l->has_parameters)
        initial_unit(p->begun + place_at(link, l->first_parameter));
}

static void begin(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++) {
        /* a screw's turn determines its shift */
        if (place_turns(p, i) || (p->s->links[i].is_tied && place_shifts(p, i)))
            begin_half(p, i, true);
        if (place_shifts(p, i))
            begin_half(p, i, false);
        for (int k = 0; k < POSE_COORDS; k++)
            p->c[place_at(i, k)] = isnan(p->begun[place_at(i, k)]) ? 0 : p->begun[place_at(i, k)];
    }
}

/* --- results --- */

/* A body that joints place has no coordinates of its own whose turns matter. */
static bool is_asked(const Placing *p, const Instance *instance)
{
    if (instance->row->family != FAMILY_BODY)
        return true;
    for (int k = 0; k < instance->pose_count; k++)
        if (system_coordinate(p->s->system, instance, k) >= 0)
            return true;
    return false;
}

/* Whether the whole turns of coordinate k come from no given value and from no run that continues:
 * the search may have added turns. Those of a screw are a displacement. */
static bool is_within_half_a_turn(const Placing *p, int link, int k)
{
    const Link *l = &p->s->links[link];

    return p->known[place_at(link, k)] == KNOWN_NOT && !l->is_tied &&
           l->instance->coord_kind[k] == COORDINATE_ANGLE && !p->goes_on;
}

/* Coordinates of a link at the current poses of its frames: angles within half a turn of their
 * given or guessed value, or of 0. A given value that places frames is unchanged. */
static void read_link(Placing *p, int link)
{
    const Link *l = &p->s->links[link];
    double read[POSE_COORDS];
    Pose relative;

    if (is_asked(p, l->instance)) {
        begin_half(p, link, true);
        begin_half(p, link, false);
    }
    for (int k = 0; k < POSE_COORDS; k++)
        if (isnan(p->begun[place_at(link, k)]) ||
            (k < l->instance->pose_count && is_within_half_a_turn(p, link, k)))
            p->begun[place_at(link, k)] = 0;
    memcpy(read, p->begun + place_at(link, 0), sizeof read);
    pose_between(&p->poses[l->tail], &p->poses[l->head], &relative);
    link_read(l, &relative, read);
    for (int k = 0; k < l->instance->pose_count; k++)
        p->c[place_at(link, k)] = p->known[place_at(link, k)] == KNOWN_GIVEN &&
                                          l->instance->coord_kind[k] != COORDINATE_PARAMETER
                                      ? p->begun[place_at(link, k)]
                                      : read[k];
}

/* where the value of a coordinate is stored after assembly */
typedef struct Outlet {
    int link, k;
    double *to;
} Outlet;

typedef LIST(Outlet) Outlets;

/* the angle of the chord with that name is stored at the outlet */
static void push_named(const Placing *p, const char *name, Outlet outlet, Outlets *outlets)
{
    const VariableReferent referent = system_referent(p->s->system, name);

    if (referent.kind != REFERENT_COORDINATE)
        return;
    outlet.link = p->s->link_at[referent.instance->edge];
    outlet.k = referent.which;
    LIST_PUSH(*outlets, outlet);
}

/* q and references of angles */
static void list_outlets(const Placing *p, Outlets *outlets)
{
    const VariableIndex *l = p->a->l;

    for (int i = 0; i < p->s->link_count; i++)
        for (int k = 0; k < p->s->links[i].instance->pose_count; k++) {
            const int place = system_coordinate(l->system, p->s->links[i].instance, k);

            if (place >= 0)
                LIST_PUSH(*outlets, (Outlet){i, k, &p->a->y[place]});
        }
    for (int i = 0; i < l->multi_turns; i++)
        push_named(p, system_multi_turn(l->system, i)->name,
                   (Outlet){.to = &p->a->y[variable_index_references(l) + i]}, outlets);
}

static void fill_outlets(Placing *p, const Outlets *outlets)
{
    int read = -1;

    for (int i = 0; i < outlets->count; i++) {
        const Outlet *outlet = &outlets->at[i];

        if (outlet->link != read)
            read_link(p, outlet->link);
        read = outlet->link;
        *outlet->to = p->c[place_at(outlet->link, outlet->k)];
    }
}

/* store those, and the angles that are sums */
static Status hand_out(Placing *p, Diag *diag)
{
    const System *system = p->a->l->system;
    const int sums = system_whole_turns_count(system);
    double *angles = NEW_ARRAY(double, sums);
    Outlets outlets = {0};
    Status status;

    list_outlets(p, &outlets);
    for (int i = 0; i < sums; i++)
        if (system_whole_turns(system, i)->name != NULL)
            push_named(p, system_whole_turns(system, i)->name, (Outlet){.to = &angles[i]},
                       &outlets);
    fill_outlets(p, &outlets);
    status = initial_whole_turns(p->a, angles, diag);
    LIST_FREE(outlets);
    mem_free(angles);
    return status;
}

/* --- second attempt --- */

static Status choose_bodies(Placing *p, TreeKind kind, Diag *diag)
{
    const Graph *graph = system_graph(p->s->system);
    int *branches = NEW_ARRAY(int, p->s->link_count);
    TreeChoice choice = {.branches = branches};
    Status status;

    for (int i = 0; i < p->s->link_count; i++)
        if (p->s->links[i].instance->row->family == FAMILY_BODY &&
            graph_branching(graph, p->s->links[i].edge, kind) != BRANCH_NEVER)
            branches[choice.branch_count++] = p->s->links[i].edge;
    status = tree_complete(graph, kind, &choice, true, &p->trees[kind], diag);
    mem_free(branches);
    return status;
}

/* Loops that can't be closed in coordinates of joints may close in those of bodies, where frames
 * move straight to each other. The search starts from the current poses, which become `from`. */
static Status close_by_bodies(Placing *p, double *from, bool *closed, Diag *diag)
{
    const size_t bytes = (size_t)(p->s->link_count * POSE_COORDS) * sizeof(double);
    Tree *trees[2] = {p->trees[0], p->trees[1]};
    double *kept = NEW_ARRAY(double, p->s->link_count *POSE_COORDS);
    double *begun = NEW_ARRAY(double, p->s->link_count *POSE_COORDS);
    Status status = OK;

    memcpy(kept, p->c, bytes);
    place_poses(p, from);
    p->trees[0] = p->trees[1] = NULL;
    CHECK(choose_bodies(p, TREE_ROTATION, diag));
    CHECK(choose_bodies(p, TREE_TRANSLATION, diag));
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];
        double *c = p->c + place_at(i, 0);
        Pose relative;

        pose_between(&p->poses[l->tail], &p->poses[l->head], &relative);
        link_read(l, &relative, c);
        for (int k = 0; k < l->instance->pose_count; k++)
            if (p->known[place_at(i, k)] == KNOWN_GIVEN)
                c[k] = p->begun[place_at(i, k)];
    }
    p->columns.count = 0;
    place_columns(p);
    memcpy(begun, p->c, bytes);
    *closed = p->columns.count <= MOST_COLUMNS && place_search(p, false);
    if (*closed)
        memcpy(from, begun, bytes);
    for (int kind = 0; kind < 2 && !*closed; kind++) {
        tree_free(p->trees[kind]);
        p->trees[kind] = trees[kind];
        trees[kind] = NULL;
    }
    if (!*closed)
        memcpy(p->c, kept, bytes);
done:
    tree_free(trees[0]);
    tree_free(trees[1]);
    MEM_FREE(begun, kept);
    return status;
}

/* reports coordinates without a given value that moved far */
static void remark_moved(Placing *p, const double *from)
{
    int link = -1, which = 0;
    double furthest = PLACE_FAR, to = 0;

    for (int i = 0; i < p->s->link_count; i++)
        for (int k = 0; k < p->s->links[i].instance->pose_count; k++) {
            const Instance *instance = p->s->links[i].instance;
            const double begun = from[place_at(i, k)], now = p->c[place_at(i, k)];
            double moved = fabs(now - begun);

            if (!place_has(p, i, k) || instance->coord_kind[k] == COORDINATE_PARAMETER)
                continue;
            if (instance->coord_kind[k] == COORDINATE_ANGLE)
                moved = fabs(remainder(now - begun, 2 * M_PI));
            if (moved > furthest) {
                furthest = moved;
                link = i;
                which = k;
                to = now;
            }
        }
    if (link >= 0)
        remarks_add(&p->a->out->remarks, (Remark){.kind = REMARK_ASSEMBLED_FAR,
                                                  .what = p->s->links[link].instance->coord[which],
                                                  .size = from[place_at(link, which)],
                                                  .to = to});
}

void placing_free(Placing *p)
{
    tree_free(p->trees[TREE_TRANSLATION]);
    tree_free(p->trees[TREE_ROTATION]);
    MEM_FREE(p->c, p->begun, p->known, p->poses, p->turned, p->shifted, p->groups);
    LIST_FREE(p->guess_list);
    LIST_FREE(p->columns);
    LIST_FREE(p->asks);
}

static void open_placing(Placing *p)
{
    const int size = p->s->link_count * POSE_COORDS;

    p->c = NEW_ARRAY(double, size);
    p->begun = NEW_ARRAY(double, size);
    p->known = NEW_ARRAY(Knowledge, size);
    p->poses = NEW_ARRAY(Pose, p->s->node_count);
    p->turned = NEW_ARRAY(double, 3 * p->s->node_count);
    p->shifted = NEW_ARRAY(double, 3 * p->s->node_count);
    for (int i = 0; i < size; i++)
        p->begun[i] = NAN;
}

/* coordinates without a given value start from y */
static void begin_as_it_stands(Placing *p, const Outlets *outlets)
{
    Pose *poses = kinematic_tree_poses_at(p->s, p->a->y);

    for (int i = 0; i < outlets->count; i++) {
        double *begun = &p->begun[place_at(outlets->at[i].link, outlets->at[i].k)];

        *begun = isnan(*begun) ? *outlets->at[i].to : *begun;
    }
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];
        double c[POSE_COORDS];
        Pose relative;

        for (int k = 0; k < POSE_COORDS; k++)
            c[k] = isnan(p->begun[place_at(i, k)]) ? 0 : p->begun[place_at(i, k)];
        pose_between(&poses[l->tail], &poses[l->head], &relative);
        link_read(l, &relative, c);
        for (int k = 0; k < POSE_COORDS; k++)
            if (isnan(p->begun[place_at(i, k)]))
                p->begun[place_at(i, k)] = c[k];
    }
    mem_free(poses);
}

Status initial_place_again(const NewPlaces *places, double *y, Diag *diag)
{
    static const StartValue given; /* without a guess */
    const SimulationInput setting = {0};
    Assembled out = {0};
    Assembly a = {.l = places->layout,
                  .parameters = places->parameters,
                  .eq = places->equations,
                  .setting = &setting,
                  .kinematic_tree = places->kinematic_tree,
                  .out = &out,
                  .t = places->t};
    Placing p = {.a = &a, .s = a.kinematic_tree, .goes_on = true};
    Outlets outlets = {0};
    Status status = OK;

    a.y = y;
    a.given = NEW_ARRAY(GivenValue, places->count);
    for (; a.given_count < places->count; a.given_count++)
        a.given[a.given_count] = (GivenValue){.value = &given,
                                              .referent = places->referents[a.given_count],
                                              .target = places->values[a.given_count],
                                              .group = -1};
    initial_group(&a);
    open_placing(&p);
    CHECK(place_read_guesses(&p, diag));
    place_mark_known(&p);
    list_outlets(&p, &outlets);
    begin_as_it_stands(&p, &outlets);
    CHECK(place_choose_trees(&p, diag));
    begin(&p);
    place_columns(&p);
    (void)place_search(&p, true);
    place_poses(&p, p.c);
    fill_outlets(&p, &outlets);
done:
    LIST_FREE(outlets);
    placing_free(&p);
    mem_free(a.given);
    remarks_free(&out.remarks);
    return status;
}

Status initial_place(Assembly *a, bool *closed, Diag *diag)
{
    Placing p = {.a = a, .s = a->kinematic_tree};
    double *from = NULL; /* initial point of the search without guesses */
    int size;
    Status status = OK;

    *closed = true;
    if (p.s == NULL)
        return OK;
    size = p.s->link_count * POSE_COORDS;
    open_placing(&p);
    CHECK(place_read_guesses(&p, diag));
    place_mark_known(&p);
    CHECK(place_choose_trees(&p, diag));
    begin(&p);
    place_columns(&p);
    place_by_guesses(&p);
    from = NEW_ARRAY(double, size);
    memcpy(from, p.c, (size_t)size * sizeof(double));
    *closed = place_search(&p, false);
    if (!*closed)
        CHECK(close_by_bodies(&p, from, closed, diag));
    place_poses(&p, p.c);
    remark_moved(&p, from);
    place_remark_guesses(&p);
    CHECK(hand_out(&p, diag));
done:
    mem_free(from);
    placing_free(&p);
    return status;
}

/* start_place.c: assembly begins along the joints
 *
 * Frames are placed along trees of its own making, chosen by what is known: edges whose coordinates
 * are given, then those that are guessed, then joints before bodies. What isn't given starts at its
 * guess, at the value of an earlier start, or at 0. Loops and given values elsewhere are closed by
 * Levenberg-Marquardt in the coordinates of these trees. So where the frames stand follows from the
 * model and from what was said about it, and from no tree of the user's. */
#include "simulate/start_impl.h"

#include "base/random.h"
#include "simulate/matrix3.h"
#include "simulate/skeleton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TOLERANCE 1e-12 /* of scaled residuals */
#define CLOSED    1e-13 /* m, rad: what rounding leaves of residuals */
#define TRIES     24    /* other starts, when the first leads nowhere */
#define FAR       2.0   /* rad or m: a coordinate that moved further is spoken of */

typedef enum Known { KNOWN_NOT, KNOWN_GUESSED, KNOWN_GIVEN } Known;

/* a value that was told, of a coordinate or of a frame against the datum */
typedef struct Wish {
    int link; /* number; -1: of a frame, */
    int head; /* this node */
    int k;    /* coordinate of the link */
    double value;
    bool is_guess;
    int group; /* of Euler parameters told together; -1 */
} Wish;

typedef enum ColumnKind { COLUMN_SLIDE, COLUMN_TURN, COLUMN_FREE } ColumnKind;

typedef struct Column { /* an unknown of the search */
    int link;
    ColumnKind kind;
    int k; /* shift or turn; axis of a free rotation */
} Column;

typedef enum AskKind { ASK_SHIFT, ASK_TURN, ASK_TIE, ASK_WISH } AskKind;

typedef struct Ask { /* rows of the search */
    AskKind kind;
    int link; /* or wish */
} Ask;

typedef struct Placing {
    Assembly *a;
    const Skeleton *s;
    Tree *trees[2]; /* translation, rotation */
    double *c;      /* links x MAX_COORDS */
    double *begun;  /* likewise: where what isn't given starts, NAN: not asked yet */
    Known *known;   /* likewise */
    Pose *poses;
    LIST(Wish) wishes;
    double *groups; /* x MAX_COORDS: what was told of each, the rest 0 */
    LIST(Column) columns;
    LIST(Ask) asks;
    int row_count;
    double *turned, *shifted; /* nodes x 3: what a unit of a column does to them */
    WarmValue warm;
    void *warm_context;
} Placing;

static int at(int link, int k)
{
    return link * MAX_COORDS + k;
}

/* --- what is known --- */

static void wish(Placing *p, const Stand *stand, double value, bool is_guess, int group)
{
    Wish wish = {
        .link = -1, .head = stand->node, .value = value, .is_guess = is_guess, .group = group};

    if (stand->kind == STANDS_COORDINATE || stand->kind == STANDS_SHIFT) {
        wish.link = p->s->link_at[stand->instance->edge];
        wish.k = stand->which;
        if (stand->kind == STANDS_SHIFT)
            wish.value /= p->s->links[wish.link].shift[0].scale;
    } else if (stand->kind == STANDS_POSITION) {
        wish.k = stand->which;
    } else {
        wish.k = p->s->frame.shift_count + stand->which;
    }
    LIST_PUSH(p->wishes, wish);
}

/* signs of Euler parameters are told by all that belong together */
static void gather_groups(Placing *p)
{
    p->groups = NEW_ARRAY(double, p->a->group_count *MAX_COORDS);
    for (int i = 0; i < p->wishes.count; i++)
        if (p->wishes.at[i].group >= 0)
            p->groups[at(p->wishes.at[i].group, p->wishes.at[i].k)] = p->wishes.at[i].value;
}

/* a plane has no parameters of its frames in these */
static bool is_told(const Placing *p, const Stand *stand)
{
    return stand->kind != STANDS_NOT &&
           !(stand->kind == STANDS_PARAMETER && !p->s->frame.has_parameters) &&
           !(stand->kind == STANDS_POSITION && stand->which >= p->s->frame.shift_count);
}

/* Guesses, drivers, given values: what comes later has the last word. */
static Status take_wishes(Placing *p, Diag *diag)
{
    Assembly *a = p->a;
    Status status = OK;

    for (int guesses = 1; guesses >= 0; guesses--) {
        for (int k = 0; k < a->l->m && guesses == 0; k++) {
            Stand stand = {.kind = STANDS_COORDINATE};
            Expr prescribed = system_driven(a->l->system, k, &stand.instance, &stand.which);
            double value;

            if (prescribed == NULL)
                continue;
            CHECK(start_driven(a->l, a->parameters, prescribed, &value, diag));
            wish(p, &stand, value, false, -1);
        }
        for (int i = 0; i < a->given_count; i++) {
            const Given *given = &a->given[i];

            if (given->stand.kind != STANDS_NOT && is_told(p, &given->stand) &&
                given->value->is_guess == (guesses == 1))
                wish(p, &given->stand, given->target, guesses == 1, given->group);
        }
    }
    gather_groups(p);
done:
    return status;
}

/* Given parameters that leave nothing to the others: those are 0. */
static void complete_parameters(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];
        double left = 1;

        for (int k = 0; l->has_parameters && k < 4; k++)
            if (p->known[at(i, l->first_parameter + k)] == KNOWN_GIVEN)
                left -= p->begun[at(i, l->first_parameter + k)] *
                        p->begun[at(i, l->first_parameter + k)];
        for (int k = 0; l->has_parameters && fabs(left) < 1e-15 && k < 4; k++)
            if (p->known[at(i, l->first_parameter + k)] != KNOWN_GIVEN) {
                p->known[at(i, l->first_parameter + k)] = KNOWN_GIVEN;
                p->begun[at(i, l->first_parameter + k)] = 0;
            }
    }
}

/* the link by which a frame is made: a body's own edge, or an arm; -1 */
static int maker_of(const Placing *p, int node)
{
    for (int i = 0; i < p->s->link_count; i++) {
        const Family family = p->s->links[i].instance->row->family;

        if (p->s->links[i].head == node && (family == FAMILY_BODY || family == FAMILY_ARM))
            return i;
    }
    return -1;
}

/* the body of a frame, and where the frame stands in it; -1: it is one of ground */
static int body_of(const Placing *p, int node, Pose *in_body)
{
    const double none[MAX_COORDS] = {0};
    int link;

    *in_body = (Pose){.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    while ((link = maker_of(p, node)) >= 0) {
        Pose step, sum;

        if (p->s->links[link].instance->row->family == FAMILY_BODY)
            return link;
        link_pose(&p->s->links[link], none, &step);
        matrix3_times(step.R, in_body->R, sum.R);
        matrix3_apply(step.R, in_body->p, sum.p);
        for (int k = 0; k < 3; k++)
            sum.p[k] += step.p[k];
        *in_body = sum;
        node = p->s->links[link].tail;
    }
    return -1;
}

static bool is_half_told(const Placing *p, int link, bool rotation)
{
    const Instance *instance = p->s->links[link].instance;

    for (int k = 0; k < instance->coord_count; k++)
        if (instance->coord_rotation[k] == rotation && p->known[at(link, k)] != KNOWN_NOT)
            return true;
    return false;
}

static void know_half(Placing *p, int link, bool rotation, const double *c, Known known)
{
    const Instance *instance = p->s->links[link].instance;

    for (int k = 0; k < instance->coord_count; k++)
        if (instance->coord_rotation[k] == rotation) {
            p->begun[at(link, k)] = c[k];
            p->known[at(link, k)] = known;
        }
}

/* A frame of which all is told says where its body stands: its attitude, and with that its place.
 */
static void place_body(Placing *p, int node, const double *told, Known known)
{
    const int shifts = p->s->frame.shift_count;
    double c[MAX_COORDS] = {0}, back[9];
    bool whole = true;
    Pose in_body, stands;
    int body = body_of(p, node, &in_body);

    for (int k = shifts; k < shifts + (p->s->frame.has_parameters ? 4 : 1); k++)
        whole = whole && !isnan(told[k]);
    if (body < 0 || !whole || is_half_told(p, body, true))
        return;
    memcpy(c, told, sizeof c);
    link_pose(&p->s->frame, c, &stands);
    matrix3_transpose(in_body.R, back);
    matrix3_times(stands.R, back, stands.R);
    matrix3_apply(stands.R, in_body.p, in_body.p);
    for (int k = 0; k < 3; k++) {
        whole = whole && (k >= shifts || !isnan(told[k]));
        stands.p[k] = whole ? stands.p[k] - in_body.p[k] : 0;
    }
    memset(c, 0, sizeof c);
    if (!p->s->frame.has_parameters)
        c[shifts] = told[shifts]; /* of a plane: with its turns */
    link_read(&p->s->links[body], &stands, c);
    know_half(p, body, true, c, known);
    if (whole && !is_half_told(p, body, false))
        know_half(p, body, false, c, known);
}

/* frames that were told as a whole */
static void place_bodies(Placing *p, bool guesses)
{
    double *told = NEW_ARRAY(double, p->s->node_count *MAX_COORDS);

    for (int i = 0; i < p->s->node_count * MAX_COORDS; i++)
        told[i] = NAN;
    for (int i = 0; i < p->wishes.count; i++) {
        const Wish *wish = &p->wishes.at[i];

        if (wish->is_guess != guesses)
            continue;
        if (wish->link < 0)
            told[at(wish->head, wish->k)] = wish->value;
        /* places of bodies in Cartesian coordinates are named as their coordinates are */
        else if (p->s->links[wish->link].instance->row->family == FAMILY_BODY &&
                 wish->k < p->s->frame.shift_count)
            told[at(p->s->links[wish->link].head, wish->k)] = wish->value;
    }
    for (int node = 0; node < p->s->node_count; node++)
        if (!isnan(told[at(node, p->s->frame.shift_count)]))
            place_body(p, node, told + at(node, 0), guesses ? KNOWN_GUESSED : KNOWN_GIVEN);
    mem_free(told);
}

static void mark_known(Placing *p)
{
    for (int i = 0; i < p->wishes.count; i++) {
        const Wish *told = &p->wishes.at[i];
        Known known = told->is_guess ? KNOWN_GUESSED : KNOWN_GIVEN;

        if (told->link < 0)
            continue;
        p->begun[at(told->link, told->k)] = told->value;
        if (known > p->known[at(told->link, told->k)])
            p->known[at(told->link, told->k)] = known;
    }
    complete_parameters(p);
    place_bodies(p, false);
    place_bodies(p, true);
}

/* --- the trees --- */

enum { OPEN = 16 }; /* above the number of coordinates of a link */

/* how little is known of a half of a link: freedoms that are open, then guessed ones */
static int ignorance(const Placing *p, int link, TreeKind kind)
{
    const Link *l = &p->s->links[link];
    int sum = 0, parameters = 0;

    if (l->is_tied && kind == TREE_TRANSLATION && tree_has(p->trees[TREE_ROTATION], l->edge))
        return 0; /* its turn tells */
    for (int k = 0; kind == TREE_TRANSLATION && k < l->shift_count; k++) {
        Known known = p->known[at(link, l->shift[k].coordinate)];

        sum += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    for (int k = 0; kind == TREE_ROTATION && k < l->turn_count; k++) {
        Known known = p->known[at(link, l->turn[k].coordinate)];

        sum += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    for (int k = 0; kind == TREE_ROTATION && l->has_parameters && k < 4; k++) {
        Known known = p->known[at(link, l->first_parameter + k)];

        parameters += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    return sum + (parameters >= OPEN ? 3 * OPEN : parameters);
}

/* A virtual joint's claim is no constraint. It places frames where the user's trees take it at its
 * word, or where it leaves every freedom, and all of it is known. */
static bool may_place(const Placing *p, int link, TreeKind kind)
{
    const Link *l = &p->s->links[link];
    const bool is_loose =
        kind == TREE_TRANSLATION ? l->shift_count == 3 : l->has_parameters || l->turn_count == 3;

    return !l->instance->is_virtual ||
           ((is_loose || tree_has(system_tree(p->s->system, kind), l->edge)) &&
            ignorance(p, link, kind) < OPEN);
}

typedef struct Candidate { /* for a branch */
    int edge;
    int ignorance, preference;
} Candidate;

/* what is known best, then as completion prefers, then in order of making */
static int by_preference(const void *left, const void *right)
{
    const Candidate *a = left, *b = right;

    if (a->ignorance != b->ignorance)
        return a->ignorance < b->ignorance ? -1 : 1;
    if (a->preference != b->preference)
        return a->preference < b->preference ? -1 : 1;
    return (a->edge > b->edge) - (a->edge < b->edge);
}

static int root_of(int *above, int node)
{
    while (above[node] != node)
        node = above[node] = above[above[node]];
    return node;
}

/* Kruskal (1956), virtual joints among the rest, which completion puts behind all others */
static Status choose_tree(Placing *p, TreeKind kind, Diag *diag)
{
    const Graph *graph = system_graph(p->s->system);
    Candidate *candidates = NEW_ARRAY(Candidate, p->s->link_count);
    int *above = NEW_ARRAY(int, p->s->node_count);
    int *branches = NEW_ARRAY(int, p->s->link_count);
    TreeChoice choice = {.branches = branches};
    int count = 0;
    Status status;

    for (int i = 0; i < p->s->link_count; i++) {
        const int edge = p->s->links[i].edge;

        if (graph_branching(graph, edge, kind) != BRANCH_NEVER && may_place(p, i, kind))
            candidates[count++] =
                (Candidate){edge, ignorance(p, i, kind),
                            graph_edge(graph, edge)->preference[kind == TREE_ROTATION]};
    }
    qsort(candidates, (size_t)count, sizeof *candidates, by_preference);
    for (int node = 0; node < p->s->node_count; node++)
        above[node] = node;
    for (int i = 0; i < count; i++) {
        const Edge *edge = graph_edge(graph, candidates[i].edge);
        const int tail = root_of(above, edge->tail), head = root_of(above, edge->head);

        if (tail != head)
            branches[choice.branch_count++] = candidates[i].edge;
        above[tail] = head;
    }
    status = tree_complete(graph, kind, &choice, true, &p->trees[kind], diag);
    mem_free(candidates);
    mem_free(above);
    mem_free(branches);
    return status;
}

static bool turns_here(const Placing *p, int link)
{
    return tree_has(p->trees[TREE_ROTATION], p->s->links[link].edge);
}

static bool shifts_here(const Placing *p, int link)
{
    return tree_has(p->trees[TREE_TRANSLATION], p->s->links[link].edge);
}

/* the coordinate places frames, as one of a branch of these trees */
static bool places(const Placing *p, int link, int k)
{
    return p->s->links[link].instance->coord_rotation[k] ? turns_here(p, link)
                                                         : shifts_here(p, link);
}

/* --- where it begins --- */

static double recall(const Placing *p, const char *name)
{
    return p->warm != NULL ? p->warm(p->warm_context, name) : NAN;
}

/* attitude of a frame at the earlier start; false: not known */
static bool recall_attitude(const Placing *p, int node, double R[9])
{
    double q[4];

    matrix3_one(R);
    for (int i = 0; i < 4 && node != p->s->datum; i++) {
        Text name = {0};

        text_addf(&name, "%s.q%d", graph_node(system_graph(p->a->l->system), node)->name, i);
        q[i] = recall(p, name.at);
        text_free(&name);
        if (!isfinite(q[i]))
            return false;
    }
    if (node != p->s->datum)
        matrix3_of_parameters(q, R);
    return true;
}

/* three turns of a chord are told by its frames alone */
static void recall_turns(Placing *p, int link)
{
    const Link *l = &p->s->links[link];
    double c[MAX_COORDS] = {0};
    Pose tail = {0}, head = {0}, relative;

    if (p->warm == NULL || !recall_attitude(p, l->tail, tail.R) ||
        !recall_attitude(p, l->head, head.R))
        return;
    pose_between(&tail, &head, &relative);
    link_read(l, &relative, c);
    for (int k = 0; k < 3; k++)
        p->begun[at(link, l->turn[k].coordinate)] = c[l->turn[k].coordinate];
}

/* where the coordinates of a half of a link start that nobody told */
static void begin_half(Placing *p, int link, bool rotation)
{
    const Link *l = &p->s->links[link];
    const Instance *instance = l->instance;
    bool open = false;

    for (int k = 0; k < instance->coord_count; k++) {
        double *begun = &p->begun[at(link, k)];

        if (instance->coord_rotation[k] == rotation && isnan(*begun)) {
            *begun = recall(p, instance->coord[k]);
            open = open || !isfinite(*begun);
        }
    }
    if (open && rotation && l->turn_count == 3)
        recall_turns(p, link);
    for (int k = 0; k < instance->coord_count; k++)
        if (instance->coord_rotation[k] == rotation && !isfinite(p->begun[at(link, k)]))
            p->begun[at(link, k)] = l->has_parameters && k == l->first_parameter ? 1 : 0;
    if (rotation && l->has_parameters)
        start_unit(p->begun + at(link, l->first_parameter));
}

static void begin(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++) {
        if (turns_here(p, i))
            begin_half(p, i, true);
        if (shifts_here(p, i))
            begin_half(p, i, false);
        for (int k = 0; k < MAX_COORDS; k++)
            p->c[at(i, k)] = isnan(p->begun[at(i, k)]) ? 0 : p->begun[at(i, k)];
    }
}

static void pose_all(Placing *p, const double *c)
{
    skeleton_poses(p->s, p->trees[TREE_ROTATION], p->trees[TREE_TRANSLATION], c, p->poses);
}

/* --- the search: unknowns --- */

static void turn_columns(Placing *p, int link)
{
    const Link *l = &p->s->links[link];
    int given = 0;

    for (int k = 0; k < l->turn_count; k++)
        given += p->known[at(link, l->turn[k].coordinate)] == KNOWN_GIVEN;
    for (int k = 0; l->has_parameters && k < 4; k++)
        given += p->known[at(link, l->first_parameter + k)] == KNOWN_GIVEN;
    if ((l->has_parameters && given < 4) || (l->turn_count == 3 && given == 0)) {
        for (int k = 0; k < 3; k++)
            LIST_PUSH(p->columns, (Column){link, COLUMN_FREE, k});
        return;
    }
    for (int k = 0; k < l->turn_count; k++)
        if (p->known[at(link, l->turn[k].coordinate)] != KNOWN_GIVEN)
            LIST_PUSH(p->columns, (Column){link, COLUMN_TURN, k});
}

static void list_columns(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];

        if (turns_here(p, i))
            turn_columns(p, i);
        if (!shifts_here(p, i) || (l->is_tied && turns_here(p, i)))
            continue;
        for (int k = 0; k < l->shift_count; k++)
            if (p->known[at(i, l->shift[k].coordinate)] != KNOWN_GIVEN)
                LIST_PUSH(p->columns, (Column){i, COLUMN_SLIDE, k});
    }
}

/* axis of its turn and direction of its shift per unit, ground axes: of the head against the tail
 */
static void column_motion(const Placing *p, const double *c, const Column *column, double turn[3],
                          double shift[3])
{
    const Link *l = &p->s->links[column->link];
    const double *R = p->poses[l->tail].R, *own = c + at(column->link, 0);
    double E[9], axis[3] = {0};

    memset(turn, 0, 3 * sizeof(double));
    memset(shift, 0, 3 * sizeof(double));
    if (column->kind == COLUMN_TURN)
        link_turn_axis(l, own, R, column->k, turn);
    if (column->kind == COLUMN_FREE) {
        link_attitude(l, own, E);
        matrix3_times(R, E, E);
        axis[column->k] = 1;
        matrix3_apply(E, axis, turn);
    }
    if (column->kind == COLUMN_SLIDE ||
        (l->is_tied && column->kind == COLUMN_TURN && shifts_here(p, column->link))) {
        matrix3_apply(R, l->shift[column->k].axis, shift);
        for (int i = 0; i < 3; i++)
            shift[i] *= l->shift[column->k].scale;
    }
}

/* What a unit of a column does to every node: turns along the rotation tree; along the other one
 * each step turns with the tail of its edge. */
static void move_nodes(Placing *p, const double *c, const Column *column)
{
    const Tree *rotation = p->trees[TREE_ROTATION], *translation = p->trees[TREE_TRANSLATION];
    const Link *l = &p->s->links[column->link];
    double turn[3], shift[3];
    int count;
    const int *nodes = tree_nodes(translation, &count);
    const bool turns = column->kind != COLUMN_SLIDE;
    const bool slides = tree_has(translation, l->edge);
    double sense = 0;

    column_motion(p, c, column, turn, shift);
    if (turns)
        sense = tree_is_forward(rotation, tree_far_node(rotation, l->edge)) ? 1 : -1;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            p->turned[3 * nodes[i] + k] =
                turns && tree_is_beyond(rotation, l->edge, nodes[i]) ? sense * turn[k] : 0;
    memset(p->shifted + (ptrdiff_t)3 * p->s->datum, 0, 3 * sizeof(double));
    for (int i = 1; i < count; i++) {
        const int node = nodes[i], parent = tree_parent(translation, node);
        const int edge = tree_parent_edge(translation, node);
        const int base = p->s->links[p->s->link_at[edge]].tail;
        const double way = tree_is_forward(translation, node) ? 1 : -1;
        double step[3], carried[3];

        for (int k = 0; k < 3; k++)
            step[k] = p->poses[node].p[k] - p->poses[parent].p[k];
        vector3_cross(p->turned + (ptrdiff_t)3 * base, step, carried);
        for (int k = 0; k < 3; k++)
            p->shifted[3 * node + k] = p->shifted[3 * parent + k] + carried[k] +
                                       (slides && edge == l->edge ? way * shift[k] : 0);
    }
}

static void move_columns(void *context, double *v, const double *step)
{
    const Placing *p = context;

    for (int j = 0; j < p->columns.count; j++) {
        const Column *column = &p->columns.at[j];
        const Link *l = &p->s->links[column->link];
        double *own = v + at(column->link, 0);

        if (column->kind == COLUMN_SLIDE)
            own[l->shift[column->k].coordinate] += step[j];
        if (column->kind == COLUMN_TURN)
            own[l->turn[column->k].coordinate] += step[j];
        if (column->kind == COLUMN_FREE && column->k == 0)
            link_turn_by(l, own, step + j);
    }
}

/* --- the search: rows --- */

static void ask(Placing *p, AskKind kind, int link)
{
    const Pose nothing = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    LinkRow rows[LINK_ROWS];

    LIST_PUSH(p->asks, (Ask){kind, link});
    p->row_count += kind == ASK_SHIFT  ? link_shift_rows(&p->s->links[link], &nothing, rows)
                    : kind == ASK_TURN ? link_turn_rows(&p->s->links[link], &nothing, rows)
                                       : 1;
}

static void list_asks(Placing *p, bool guesses)
{
    p->asks.count = p->row_count = 0;
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];

        if (!l->holds)
            continue;
        if (!shifts_here(p, i))
            ask(p, ASK_SHIFT, i);
        if (!turns_here(p, i))
            ask(p, ASK_TURN, i);
        if (l->is_tied && !(shifts_here(p, i) && turns_here(p, i)))
            ask(p, ASK_TIE, i);
    }
    for (int i = 0; i < p->wishes.count; i++) {
        const Wish *told = &p->wishes.at[i];
        const bool is_held = told->link >= 0 && places(p, told->link, told->k) &&
                             (told->group < 0 || p->known[at(told->link, told->k)] != KNOWN_GIVEN ||
                              ignorance(p, told->link, TREE_ROTATION) == 0);

        if ((guesses || !told->is_guess) && !is_held)
            ask(p, ASK_WISH, i);
    }
}

static int ask_rows(const Placing *p, const Ask *asked, LinkRow *rows, int *tail, int *head)
{
    const Wish *told = asked->kind == ASK_WISH ? &p->wishes.at[asked->link] : NULL;
    const int number = told != NULL ? told->link : asked->link;
    const Link *link = number >= 0 ? &p->s->links[number] : &p->s->frame;
    double near[MAX_COORDS] = {0};
    Pose relative;

    *tail = link->tail;
    *head = number >= 0 ? link->head : told->head;
    pose_between(&p->poses[*tail], &p->poses[*head], &relative);
    switch (asked->kind) {
    case ASK_SHIFT:
        return link_shift_rows(link, &relative, rows);
    case ASK_TURN:
        return link_turn_rows(link, &relative, rows);
    case ASK_TIE:
        link_tie_row(link, &relative, rows);
        return 1;
    case ASK_WISH:
        if (told->group >= 0)
            memcpy(near, p->groups + at(told->group, 0), sizeof near);
        near[told->k] = told->value;
        link_value_row(link, &relative, near, told->k, told->value, rows);
        return 1;
    }
    return 0;
}

typedef struct Search {
    Placing *p;
    LinkRow *rows;
    int *tails, *heads;
} Search;

static double row_slope(const Search *s, int row)
{
    const Placing *p = s->p;
    const int t = s->tails[row], h = s->heads[row];
    double turn[3], shift[3], d[3], carried[3], back[9];

    for (int i = 0; i < 3; i++) {
        turn[i] = p->turned[3 * h + i] - p->turned[3 * t + i];
        d[i] = p->poses[h].p[i] - p->poses[t].p[i];
    }
    vector3_cross(p->turned + (ptrdiff_t)3 * t, d, carried);
    for (int i = 0; i < 3; i++)
        shift[i] = p->shifted[3 * h + i] - p->shifted[3 * t + i] - carried[i];
    matrix3_transpose(p->poses[t].R, back);
    matrix3_apply(back, turn, turn);
    matrix3_apply(back, shift, shift);
    return vector3_dot(s->rows[row].by_turn, turn) + vector3_dot(s->rows[row].by_shift, shift);
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    Search *s = context;
    Placing *p = s->p;
    int count = 0;

    pose_all(p, v);
    for (int i = 0; i < p->asks.count; i++) {
        int tail = 0, head = 0;
        const int more = ask_rows(p, &p->asks.at[i], s->rows + count, &tail, &head);

        for (int k = 0; k < more; k++) {
            residual[count] = s->rows[count].value;
            s->tails[count] = tail;
            s->heads[count++] = head;
        }
    }
    for (int j = 0; jacobian != NULL && j < p->columns.count; j++) {
        move_nodes(p, v, &p->columns.at[j]);
        for (int i = 0; i < count; i++)
            jacobian[(ptrdiff_t)i * p->columns.count + j] = row_slope(s, i);
    }
}

static void move(void *context, double *v, const double *step)
{
    move_columns(((Search *)context)->p, v, step);
}

static void open_search(Search *s, Placing *p)
{
    *s = (Search){.p = p,
                  .rows = NEW_ARRAY(LinkRow, p->row_count + LINK_ROWS),
                  .tails = NEW_ARRAY(int, p->row_count + LINK_ROWS),
                  .heads = NEW_ARRAY(int, p->row_count + LINK_ROWS)};
}

static void close_search(Search *s)
{
    mem_free(s->rows);
    mem_free(s->tails);
    mem_free(s->heads);
}

/* Columns that no row which is missed feels stay where they are. */
static void keep_unconcerned(const Placing *p, const Rows *rows, const bool *missed, double *step)
{
    double *residual = NEW_ARRAY(double, rows->rows);
    double *jacobian = NEW_ARRAY(double, (size_t)rows->rows *(size_t)rows->columns);

    rows->evaluate(rows->context, p->c, residual, jacobian);
    for (int j = 0; j < rows->columns; j++) {
        bool concerned = false;

        for (int i = 0; i < rows->rows; i++)
            concerned = concerned || (missed[i] && jacobian[(ptrdiff_t)i * rows->columns + j] != 0);
        step[j] = concerned ? step[j] : 0;
    }
    mem_free(residual);
    mem_free(jacobian);
}

/* Other starts about the first one; the nearest solution wins at the smallest disturbance. Rows
 * that are missed say what takes part. */
static bool try_around(Placing *p, const Rows *rows, const double *from, const bool *missed)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *step = NEW_ARRAY(double, rows->columns);
    uint64_t seed = 1;
    bool met = false;

    for (int k = 0; k < TRIES && !met; k++) {
        double size = k < TRIES / 3 ? 0.1 : k < 2 * TRIES / 3 ? 0.5 : 1.5;

        for (int j = 0; j < rows->columns; j++)
            step[j] = size * random_unit(&seed);
        memcpy(p->c, from, bytes);
        move_columns(p, p->c, step);
        keep_unconcerned(p, rows, missed, step);
        memcpy(p->c, from, bytes);
        move_columns(p, p->c, step);
        met = least_solve(rows, NULL, NULL, TOLERANCE, p->c, NULL);
        if (met)
            text_addf(&p->a->out->remarks,
                      "warning: assembled from a start moved by up to %g; guesses make sure "
                      "that it is the assembly meant\n",
                      size);
    }
    mem_free(step);
    return met;
}

/* From the start, then from others around it. */
static bool solve(Placing *p, const Rows *rows, double *residual, bool once)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *from = NEW_ARRAY(double, rows->length);
    bool *missed = NEW_ARRAY(bool, rows->rows);
    bool met;

    memcpy(from, p->c, bytes);
    met = least_solve(rows, NULL, NULL, TOLERANCE, p->c, residual);
    for (int i = 0; i < rows->rows; i++)
        missed[i] = fabs(residual[i]) > CLOSED;
    if (!met && !once) {
        double *best = NEW_ARRAY(double, rows->length);

        memcpy(best, p->c, bytes);
        met = try_around(p, rows, from, missed);
        if (!met)
            memcpy(p->c, best, bytes);
        mem_free(best);
    }
    mem_free(from);
    mem_free(missed);
    return met;
}

/* Close what the trees leave open; false: nothing was found that does. */
static bool search(Placing *p, bool guesses)
{
    Search s;
    Rows rows;
    double *residual;
    bool met = true;

    list_asks(p, guesses);
    if (p->row_count == 0)
        return true;
    open_search(&s, p);
    rows = (Rows){.rows = p->row_count,
                  .columns = p->columns.count,
                  .length = p->s->link_count * MAX_COORDS,
                  .context = &s,
                  .evaluate = evaluate,
                  .move = move};
    residual = NEW_ARRAY(double, rows.rows);
    evaluate(&s, p->c, residual, NULL);
    for (int i = 0; i < rows.rows; i++)
        met = met && fabs(residual[i]) <= CLOSED;
    if (!met && rows.columns > 0)
        met = solve(p, &rows, residual, guesses);
    mem_free(residual);
    close_search(&s);
    return met;
}

static bool is_guessed_elsewhere(const Placing *p)
{
    for (int i = 0; i < p->wishes.count; i++)
        if (p->wishes.at[i].is_guess &&
            (p->wishes.at[i].link < 0 || !places(p, p->wishes.at[i].link, p->wishes.at[i].k)))
            return true;
    return false;
}

/* --- what came out --- */

/* A body that joints place has no coordinates whose turns would be looked up. */
static bool is_asked(const Placing *p, const Instance *instance)
{
    if (instance->row->family != FAMILY_BODY)
        return true;
    for (int k = 0; k < instance->coord_count; k++)
        if (system_coordinate(p->s->system, instance, k) >= 0)
            return true;
    return false;
}

/* Coordinates of a link where its frames stand now: angles within half a turn of where they began,
 * or of what they were given as. What places frames and was given stays as it is. */
static void read_link(Placing *p, int link)
{
    const Link *l = &p->s->links[link];
    double read[MAX_COORDS];
    Pose relative;

    if (is_asked(p, l->instance)) {
        begin_half(p, link, true);
        begin_half(p, link, false);
    }
    for (int k = 0; k < MAX_COORDS; k++)
        if (isnan(p->begun[at(link, k)]))
            p->begun[at(link, k)] = 0;
    memcpy(read, p->begun + at(link, 0), sizeof read);
    pose_between(&p->poses[l->tail], &p->poses[l->head], &relative);
    link_read(l, &relative, read);
    for (int k = 0; k < l->instance->coord_count; k++)
        p->c[at(link, k)] = p->known[at(link, k)] == KNOWN_GIVEN &&
                                    l->instance->coord_kind[k] != COORDINATE_PARAMETER
                                ? p->begun[at(link, k)]
                                : read[k];
}

/* a place for the value of a coordinate among what a start hands out */
typedef struct Outlet {
    int link, k;
    double *to;
} Outlet;

typedef LIST(Outlet) Outlets;

/* where the angle of a chord goes that has that name */
static void push_named(const Placing *p, const char *name, double *to, Outlets *outlets)
{
    const Stand stand = system_stand(p->s->system, name);

    if (stand.kind == STANDS_COORDINATE)
        LIST_PUSH(*outlets, (Outlet){p->s->link_at[stand.instance->edge], stand.which, to});
}

/* q, references of angles, and the angles that are sums */
static Status hand_out(Placing *p, Diag *diag)
{
    const Layout *l = p->a->l;
    const int sums = system_whole_turns_count(l->system);
    double *angles = NEW_ARRAY(double, sums);
    Outlets outlets = {0};
    int read = -1;
    Status status;

    for (int i = 0; i < p->s->link_count; i++)
        for (int k = 0; k < p->s->links[i].instance->coord_count; k++) {
            const int place = system_coordinate(l->system, p->s->links[i].instance, k);

            if (place >= 0)
                LIST_PUSH(outlets, (Outlet){i, k, &p->a->y[place]});
        }
    for (int i = 0; i < l->turned; i++)
        push_named(p, system_turned(l->system, i)->name, &p->a->y[layout_turned(l) + i], &outlets);
    for (int i = 0; i < sums; i++)
        if (system_whole_turns(l->system, i)->name != NULL)
            push_named(p, system_whole_turns(l->system, i)->name, &angles[i], &outlets);
    for (int i = 0; i < outlets.count; i++) {
        const Outlet *outlet = &outlets.at[i];

        if (outlet->link != read)
            read_link(p, outlet->link);
        read = outlet->link;
        *outlet->to = p->c[at(outlet->link, outlet->k)];
    }
    status = start_whole_turns(p->a, angles, diag);
    LIST_FREE(outlets);
    mem_free(angles);
    return status;
}

/* what nobody gave and that moved far */
static void remark_moved(Placing *p)
{
    int link = -1, which = 0;
    double furthest = FAR, to = 0;

    for (int i = 0; i < p->s->link_count; i++)
        for (int k = 0; k < p->s->links[i].instance->coord_count; k++) {
            const Instance *instance = p->s->links[i].instance;
            const double begun = p->begun[at(i, k)], now = p->c[at(i, k)];
            double moved = fabs(now - begun);

            if (!places(p, i, k) || instance->coord_kind[k] == COORDINATE_PARAMETER)
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
        text_addf(&p->a->out->remarks,
                  "warning: assembled far from where it began: %s went from %.4g to %.4g; a guess "
                  "chooses "
                  "another assembly\n",
                  p->s->links[link].instance->coord[which], p->begun[at(link, which)], to);
}

static void placing_free(Placing *p)
{
    tree_free(p->trees[TREE_TRANSLATION]);
    tree_free(p->trees[TREE_ROTATION]);
    mem_free(p->c);
    mem_free(p->begun);
    mem_free(p->known);
    mem_free(p->poses);
    mem_free(p->turned);
    mem_free(p->shifted);
    mem_free(p->groups);
    LIST_FREE(p->wishes);
    LIST_FREE(p->columns);
    LIST_FREE(p->asks);
}

Status start_place(Assembly *a, WarmValue warm, void *context, bool *closed, Diag *diag)
{
    Placing p = {.a = a, .warm = warm, .warm_context = context};
    int size;
    Status status = OK;

    *closed = true;
    p.s = a->skeleton;
    if (p.s == NULL)
        return OK;
    size = p.s->link_count * MAX_COORDS;
    p.c = NEW_ARRAY(double, size);
    p.begun = NEW_ARRAY(double, size);
    p.known = NEW_ARRAY(Known, size);
    p.poses = NEW_ARRAY(Pose, p.s->node_count);
    p.turned = NEW_ARRAY(double, 3 * p.s->node_count);
    p.shifted = NEW_ARRAY(double, 3 * p.s->node_count);
    for (int i = 0; i < size; i++)
        p.begun[i] = NAN;
    CHECK(take_wishes(&p, diag));
    mark_known(&p);
    CHECK(choose_tree(&p, TREE_ROTATION, diag));
    CHECK(choose_tree(&p, TREE_TRANSLATION, diag));
    begin(&p);
    list_columns(&p);
    if (is_guessed_elsewhere(&p))
        (void)search(&p, true);
    *closed = search(&p, false);
    pose_all(&p, p.c);
    remark_moved(&p);
    CHECK(hand_out(&p, diag));
done:
    placing_free(&p);
    return status;
}

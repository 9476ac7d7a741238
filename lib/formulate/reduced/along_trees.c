/* along_trees.c: motion outward, articulated inertia inward, accelerations outward
 *
 * First comes the motion of each group at u' = 0. All unknowns are then differences from that
 * motion, and the remaining terms are loads b. Inward, each group adds its body to what came from
 * beyond.
 *
 * A turn about one of the axes is eliminated alone where its row is decoupled. The rate at which
 * the group turns about that axis is then an unknown of its own, and what is passed on to the
 * parent has no row for it. A speed with delayed elimination is an unknown besides the motion until
 * it is eliminated. */
#include "formulate/reduced/along_trees.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/kinematics/frames.h"

#include "formulate/kinematics/section_frames.h"
#include "formulate/reduced/resistance.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

typedef struct GroupDynamics { /* of a group, in the axes of orientation class `axes` */
    int axes;
    Vec axis, way;   /* way: vector from the parent's origin, in the parent's axes */
    Vec w, alpha, a; /* at u' = 0 or at given u', minus gravity */
    Expr turning[9]; /* alpha x + w x (w x */
    /* which components of the parent's motion move the joint, in these axes */
    bool reaches[MOTION];
    bool moves[MOTION];
    int own; /* the component of the motion that its speed alone moves; -1: none */
    Resistance beyond;
    Vec x[2]; /* alpha and a, minus those at u' = 0 */
} GroupDynamics;

typedef struct TreeElimination {
    const System *system;
    Arena *arena;
    const Group *groups;
    int count;
    const EliminationOrder *way;
    const Expr *applied;
    GroupDynamics *work;
    LIST(Yield) yields;
    int *at; /* the group of each elimination */
} TreeElimination;

/* --- axes --- */

static bool is_parallel(const TreeElimination *c, Vec a, Vec b)
{
    return vec_same(a, b) || vec_same(a, vec_neg(c->arena, b));
}

/* the turn of a group continues that of the orientation class before */
static bool goes_on(const TreeElimination *c, int g)
{
    const OrientationClass *chains = c->system->kinematics->chains.at;
    const int chain = c->groups[g].chain, before = chains[chain].parent;

    return before > 0 && !chains[before].is_free &&
           is_parallel(c, chains[chain].axis, chains[before].axis);
}

static int run_begins(const TreeElimination *c, int chain)
{
    const OrientationClass *chains = c->system->kinematics->chains.at;

    while (chains[chain].parent > 0 &&
           is_parallel(c, chains[chain].axis, chains[chains[chain].parent].axis))
        chain = chains[chain].parent;
    return chains[chain].parent;
}

static void choose_axes(TreeElimination *c)
{
    bool *is_run = NEW_ARRAY(bool, c->system->kinematics->chains.count);
    bool *is_tail = NEW_ARRAY(bool, c->system->kinematics->chains.count);

    for (int g = 1; g < c->count; g++) {
        const int before = c->system->kinematics->chains.at[c->groups[g].chain].parent;

        if (c->groups[g].slides)
            continue;
        is_tail[before] = true;
        if (goes_on(c, g))
            is_run[before] = true;
    }
    for (int g = 1; g < c->count; g++) {
        const int chain = c->groups[g].chain;
        const bool ends = !is_tail[chain] && c->way->ends_merged;

        c->work[g].axes =
            chain > 0 && c->way->merges && (is_run[chain] || ends) ? run_begins(c, chain) : chain;
    }
    MEM_FREE(is_run, is_tail);
}

/* --- motion at u' = 0 --- */

static Vec express(const TreeElimination *c, Vec v, int from, int to)
{
    return vec_carry_held(c->system, v, from, to);
}

static Vec turning_times(const TreeElimination *c, const GroupDynamics *work, Vec r)
{
    Rotation U;

    for (int i = 0; i < 9; i++)
        U.at[i] = work->turning[i];
    return rotation_apply(c->arena, &U, r);
}

/* w w' - w.w 1 + alpha x */
static void find_turning(const TreeElimination *c, GroupDynamics *work)
{
    Arena *arena = c->arena;
    Expr square[3];

    for (int i = 0; i < 3; i++)
        square[i] = expr_name_temporary(arena, expr_square(arena, work->w.at[i]));
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Expr product =
            expr_name_temporary(arena, expr_mul(arena, work->w.at[i], work->w.at[j]));

        work->turning[4 * i] =
            expr_name_temporary(arena, expr_neg(arena, expr_add(arena, square[j], square[k])));
        work->turning[3 * i + j] =
            expr_name_temporary(arena, expr_sub(arena, product, work->alpha.at[k]));
        work->turning[3 * j + i] =
            expr_name_temporary(arena, expr_add(arena, product, work->alpha.at[k]));
    }
}

static void mark(Vec v, bool *moves)
{
    for (int i = 0; i < 3; i++)
        moves[i] = moves[i] || !expr_is_zero(v.at[i]);
}

static Vec unit(Arena *arena, int i)
{
    Vec v = vec_zero(arena);

    v.at[i] = expr_int(arena, 1);
    return v;
}

static void find_reach(const TreeElimination *c, const GroupDynamics *parent, GroupDynamics *work)
{
    bool before[MOTION];

    for (int i = 0; i < MOTION; i++)
        before[i] = parent->moves[i];
    for (int i = 0; i < 3; i++)
        if (before[i])
            mark(vec_cross(c->arena, unit(c->arena, i), work->way), before + SHIFT);
    for (int i = 0; i < MOTION; i++)
        if (before[i])
            mark(vec_carry(c->system, unit(c->arena, i % SHIFT), parent->axes, work->axes),
                 work->reaches + i / SHIFT * SHIFT);
}

/* the only component that the speed moves, by a factor of 1 or -1; -1: there is no such one */
static int own_component(const Group *group, Vec axis)
{
    int found = -1;

    for (int i = 0; i < 3; i++) {
        if (expr_is_zero(axis.at[i]))
            continue;
        if (found >= 0 || (!expr_is(axis.at[i], 1) && !expr_is(axis.at[i], -1)))
            return -1;
        found = i;
    }
    return group->slides ? SHIFT + found : found;
}

/* with this u', or with NULL at u' = 0 */
static void move(TreeElimination *c, int g, const Expr *acceleration)
{
    Arena *arena = c->arena;
    const Group *group = &c->groups[g];
    GroupDynamics *work = &c->work[g];
    const GroupDynamics *parent = &c->work[group->parent];
    const Expr u = speed_rate(c->system, group->speed);
    Vec turned, *moved = group->slides ? &work->a : &work->alpha;
    Vec a;

    work->axis = express(c, group->axis, group->chain, work->axes);
    work->way = express(c, group->way, c->groups[group->parent].chain, parent->axes);
    a = vec_add(arena, parent->a, turning_times(c, parent, work->way));
    work->a = express(c, vec_hold(arena, a), parent->axes, work->axes);
    work->w = express(c, parent->w, parent->axes, work->axes);
    work->alpha = express(c, parent->alpha, parent->axes, work->axes);
    turned = vec_hold(arena, vec_cross(arena, work->w, vec_scale(arena, u, work->axis)));
    find_reach(c, parent, work);
    for (int i = 0; i < MOTION; i++)
        work->moves[i] = work->reaches[i];
    mark(work->axis, work->moves + (group->slides ? SHIFT : 0));
    if (group->slides) {
        work->a =
            vec_hold(arena, vec_add(arena, work->a, vec_scale(arena, expr_int(arena, 2), turned)));
    } else {
        work->w = vec_hold(arena, vec_add(arena, work->w, vec_scale(arena, u, work->axis)));
        work->alpha = vec_hold(arena, vec_add(arena, work->alpha, turned));
    }
    if (acceleration != NULL)
        *moved = vec_hold(arena, vec_add(arena, *moved,
                                         vec_scale(arena, acceleration[group->speed], work->axis)));
    work->own = own_component(group, work->axis);
    find_turning(c, work);
}

/* all groups, outward */
static void move_all(TreeElimination *c, const Expr *acceleration)
{
    c->work[0].w = c->work[0].alpha = vec_zero(c->arena);
    for (int i = 0; i < 3; i++)
        c->work[0].a.at[i] = expr_neg(c->arena, c->system->origin->gravity.at[i]);
    choose_axes(c);
    find_turning(c, &c->work[0]);
    for (int g = 1; g < c->count; g++)
        move(c, g, acceleration);
}

/* --- articulated inertia --- */

/* loads of a body with the motion at u' = 0 */
static void load_body(const TreeElimination *c, const GroupDynamics *work, const Group *body,
                      Resistance *r)
{
    Arena *arena = c->arena;
    const Vec force =
        vec_add(arena, vec_scale(arena, body->mass, work->a), turning_times(c, work, body->moment));
    const Vec spin = vec_hold(arena, rotation_apply(arena, &body->inertia, work->w));
    Vec moment = vec_add(arena, rotation_apply(arena, &body->inertia, work->alpha),
                         vec_cross(arena, work->w, spin));

    moment = vec_add(arena, moment, vec_cross(arena, body->moment, work->a));
    for (int i = 0; i < 3; i++) {
        r->b[i] = expr_name_temporary(arena, expr_neg(arena, moment.at[i]));
        r->b[SHIFT + i] = expr_name_temporary(arena, expr_neg(arena, force.at[i]));
    }
}

/* the body's inertia in other axes, as the articulated inertia uses them */
static Group in_axes(const TreeElimination *c, const Group *group, int axes)
{
    Group body = *group;
    Resistance r;

    if (axes == group->chain)
        return body;
    resistance_init(c->arena, &r);
    resistance_add_body(c->arena, &r, group);
    resistance_turn(c->system, &r, group->chain, axes);
    for (int i = 0; i < 3; i++) {
        body.moment.at[i] = r.A[(i + 2) % 3 * MOTION + SHIFT + (i + 1) % 3];
        for (int j = 0; j < 3; j++)
            body.inertia.at[3 * i + j] = r.A[i * MOTION + j];
    }
    resistance_free(&r);
    return body;
}

static void begin(TreeElimination *c, int g)
{
    GroupDynamics *work = &c->work[g];
    Resistance own;
    const Group body = in_axes(c, &c->groups[g], work->axes);

    resistance_init(c->arena, &own);
    resistance_add_body(c->arena, &own, &body);
    load_body(c, work, &body, &own);
    resistance_add(c->arena, &own, &work->beyond);
    work->beyond = own;
    resistance_confine(c->arena, &work->beyond, work->moves);
}

static bool yield(TreeElimination *c, int g, int unknown)
{
    Yield one;

    if (!resistance_yield(c->arena, &c->work[g].beyond, unknown, &one))
        return false;
    LIST_PUSH(c->yields, one);
    c->at[c->yields.count - 1] = g;
    return true;
}

/* inertia that a part adds to the speed itself */
static Expr share_of(const TreeElimination *c, int speed)
{
    Expr sum = expr_int(c->arena, 0);
    const Entry *share;

    for (int i = 0; (share = system_mass_share(c->system, i)) != NULL; i++)
        if (share->row == speed)
            sum = expr_add(c->arena, sum, share->value);
    return sum;
}

static bool waits(const TreeElimination *c, int g)
{
    return c->way->delay == DELAY_ALL ||
           (c->way->delay == DELAY_RUN && !c->groups[g].slides && goes_on(c, g));
}

/* eliminates the delayed speeds whose delay ends here: those of this group's coaxial group */
static bool yield_waiting(TreeElimination *c, int g)
{
    Resistance *r = &c->work[g].beyond;

    if (waits(c, g))
        return true;
    while (r->count > MOTION)
        if (!yield(c, g, MOTION))
            return false;
    return true;
}

static bool meet(TreeElimination *c, int g)
{
    const Group *group = &c->groups[g];
    GroupDynamics *work = &c->work[g];
    Resistance *r = &work->beyond;
    const Expr push = c->applied[group->speed], share = share_of(c, group->speed);
    const Vec none = vec_zero(c->arena);

    if (work->own >= 0 && !waits(c, g) && expr_is_zero(share)) {
        /* along the axis itself, whatever its sign; the parent receives the reaction */
        const Expr along = expr_mul(c->arena, work->axis.at[work->own % SHIFT], push);

        r->b[work->own] = expr_name_temporary(c->arena, expr_add(c->arena, r->b[work->own], along));
        if (!yield(c, g, work->own))
            return false;
        r->b[work->own] = expr_neg(c->arena, along);
    } else {
        const int place = r->count;

        resistance_add_speed(c->arena, r, group->speed, group->slides ? none : work->axis,
                             group->slides ? work->axis : none);
        r->b[place] = expr_name_temporary(c->arena, expr_add(c->arena, r->b[place], push));
        r->A[place * r->count + place] = expr_name_temporary(
            c->arena, expr_add(c->arena, r->A[place * r->count + place], share));
        if (!waits(c, g) && !yield(c, g, place))
            return false;
    }
    resistance_confine(c->arena, r, work->reaches);
    return true;
}

static bool pass_on(TreeElimination *c, int g)
{
    GroupDynamics *work = &c->work[g], *parent = &c->work[c->groups[g].parent];

    begin(c, g);
    if (!yield_waiting(c, g) || !meet(c, g))
        return false;
    resistance_turn(c->system, &work->beyond, work->axes, parent->axes);
    resistance_shift(c->arena, &work->beyond, work->way);
    resistance_add(c->arena, &parent->beyond, &work->beyond);
    return true;
}

/* --- accelerations --- */

/* x of an eliminated unknown, once the motion is known */
static Expr found(const TreeElimination *c, const Yield *yield, const Vec x[2],
                  const Expr *acceleration)
{
    Arena *arena = c->arena;
    Expr sum = expr_name_temporary(arena, expr_mul(arena, yield->inverse, yield->right));

    for (int i = 0; i < yield->count; i++) {
        const Expr other =
            i < MOTION ? x[i / SHIFT].at[i % SHIFT] : acceleration[yield->speeds[i - MOTION]];

        if (i != yield->unknown)
            sum = expr_sub(arena, sum, expr_mul(arena, yield->factor[i], other));
    }
    return expr_name_temporary(arena, sum);
}

static void find_own(TreeElimination *c, int g, const Yield *own, Expr *acceleration)
{
    Arena *arena = c->arena;
    const Group *group = &c->groups[g];
    GroupDynamics *work = &c->work[g];
    Vec *half = &work->x[group->slides];
    Expr u;

    if (own != NULL && own->unknown < MOTION) {
        const int i = own->unknown % SHIFT;
        const Expr all = found(c, own, work->x, acceleration);

        u = expr_mul(arena, work->axis.at[i], expr_sub(arena, all, half->at[i]));
        half->at[i] = all;
        acceleration[group->speed] = expr_name_temporary(arena, u);
        return;
    }
    if (own != NULL)
        acceleration[group->speed] = found(c, own, work->x, acceleration);
    u = acceleration[group->speed];
    *half = vec_hold(arena, vec_add(arena, *half, vec_scale(arena, u, work->axis)));
}

/* Back-substitutes the eliminations of a group, in reverse order: that of its own speed came last,
 * and uses the motion of the joint; those before use the motion of the group. */
static void accelerate(TreeElimination *c, int g, int *next, Expr *acceleration)
{
    const Group *group = &c->groups[g];
    GroupDynamics *work = &c->work[g];
    const GroupDynamics *parent = &c->work[group->parent];
    const Vec step = vec_cross(c->arena, parent->x[0], work->way);
    const Yield *own = NULL;

    work->x[0] = express(c, parent->x[0], parent->axes, work->axes);
    work->x[1] = express(c, vec_hold(c->arena, vec_add(c->arena, parent->x[1], step)), parent->axes,
                         work->axes);
    if (!waits(c, g))
        own = &c->yields.at[(*next)--];
    find_own(c, g, own, acceleration);
    for (; *next >= 0 && c->at[*next] == g; (*next)--) {
        const Yield *yield = &c->yields.at[*next];
        const int speed = yield->speeds[yield->unknown - MOTION];

        acceleration[speed] = found(c, yield, work->x, acceleration);
    }
}

static void bound_excess(const TreeElimination *c, Expr *excess)
{
    for (int g = 1; g < c->count; g++) {
        const Group *group = &c->groups[g];
        const Expr all = group->slides ? group->carried : group->spread;

        excess[group->speed] =
            expr_name_temporary(c->arena, expr_add(c->arena, all, share_of(c, group->speed)));
    }
    for (int k = 0; k < c->yields.count; k++) {
        const Yield *yield = &c->yields.at[k];
        const int speed = yield->unknown < MOTION ? c->groups[c->at[k]].speed
                                                  : yield->speeds[yield->unknown - MOTION];

        excess[speed] = expr_mul(c->arena, excess[speed], yield->inverse);
    }
}

bool accelerations_along(const System *system, const Groups *groups, const EliminationOrder *way,
                         const Expr *applied, Expr *acceleration, Expr *excess)
{
    TreeElimination c = {.system = system,
                         .arena = system->arena,
                         .groups = groups->all.at,
                         .count = groups->all.count,
                         .way = way,
                         .applied = applied};
    bool sound = true;
    int next;

    c.work = NEW_ARRAY(GroupDynamics, c.count);
    c.at = NEW_ARRAY(int, c.count);
    c.work[0].x[0] = c.work[0].x[1] = vec_zero(c.arena);
    move_all(&c, NULL);
    for (int g = 0; g < c.count; g++)
        resistance_init(c.arena, &c.work[g].beyond);
    for (int g = c.count - 1; g > 0 && sound; g--)
        sound = pass_on(&c, g);
    while (sound && c.work[0].beyond.count > MOTION)
        sound = yield(&c, 0, MOTION);
    next = c.yields.count - 1;
    for (; sound && next >= 0 && c.at[next] == 0; next--) {
        const Yield *last = &c.yields.at[next];

        acceleration[last->speeds[last->unknown - MOTION]] =
            found(&c, last, c.work[0].x, acceleration);
    }
    for (int g = 1; g < c.count && sound; g++)
        accelerate(&c, g, &next, acceleration);
    if (sound)
        bound_excess(&c, excess);
    for (int g = 0; g < c.count; g++)
        resistance_free(&c.work[g].beyond);
    for (int k = 0; k < c.yields.count; k++)
        yield_free(&c.yields.at[k]);
    LIST_FREE(c.yields);
    MEM_FREE(c.work, c.at);
    return sound;
}

/* --- efforts of a known motion --- */

/* load along the group's speed that the group and all beyond it need; the rest is passed to the
 * parent */
static Expr take(TreeElimination *c, int g)
{
    Arena *arena = c->arena;
    const Group *group = &c->groups[g];
    const Group body = in_axes(c, group, c->work[g].axes);
    GroupDynamics *work = &c->work[g], *parent = &c->work[group->parent];
    const int first = group->slides ? SHIFT : 0;
    Resistance load;
    Expr along;

    resistance_init(arena, &load);
    load_body(c, work, &body, &load);
    resistance_confine(arena, &load, work->moves);
    resistance_add(arena, &load, &work->beyond);
    along =
        vec_dot(arena, work->axis, (Vec){{load.b[first], load.b[first + 1], load.b[first + 2]}});
    resistance_confine(arena, &load, work->reaches);
    resistance_turn(c->system, &load, work->axes, parent->axes);
    resistance_shift(arena, &load, work->way);
    resistance_add(arena, &parent->beyond, &load);
    return expr_neg(arena, along);
}

void efforts_along(const System *system, const Groups *groups, const EliminationOrder *way,
                   const Expr *acceleration, Expr *effort)
{
    TreeElimination c = {.system = system,
                         .arena = system->arena,
                         .groups = groups->all.at,
                         .count = groups->all.count,
                         .way = way};

    c.work = NEW_ARRAY(GroupDynamics, c.count);
    move_all(&c, acceleration);
    for (int g = 0; g < c.count; g++)
        resistance_init(c.arena, &c.work[g].beyond);
    for (int g = c.count - 1; g > 0; g--) {
        const int speed = c.groups[g].speed;

        effort[speed] = expr_add(c.arena, take(&c, g),
                                 expr_mul(c.arena, share_of(&c, speed), acceleration[speed]));
    }
    resistance_free(&c.work[0].beyond);
    mem_free(c.work);
}

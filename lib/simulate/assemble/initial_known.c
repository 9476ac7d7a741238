/* initial_known.c: what is known of the poses of frames, before any is placed */
#include "simulate/assemble/initial_place_impl.h"

#include "algebra/matrix3.h"

#include <math.h>
#include <string.h>

static void add_guess(Placing *p, const VariableReferent *referent, double value, const char *guess,
                      int group)
{
    InitialGuess initial_guess = {.link = -1,
                                  .head = referent->node,
                                  .value = value,
                                  .is_guess = guess != NULL,
                                  .group = group,
                                  .name = guess};

    if (referent->kind == REFERENT_COORDINATE || referent->kind == REFERENT_SHIFT) {
        initial_guess.link = p->s->link_at[referent->instance->edge];
        initial_guess.k = referent->which;
        if (referent->kind == REFERENT_SHIFT)
            initial_guess.value /= p->s->links[initial_guess.link].shift[0].scale;
    } else if (referent->kind == REFERENT_POSITION) {
        initial_guess.k = referent->which;
    } else {
        initial_guess.k = p->s->frame.shift_count + referent->which;
    }
    LIST_PUSH(p->guess_list, initial_guess);
}

/* all Euler parameters of an attitude together determine its sign */
static void gather_groups(Placing *p)
{
    p->groups = NEW_ARRAY(double, p->a->group_count *POSE_COORDS);
    for (int i = 0; i < p->guess_list.count; i++)
        if (p->guess_list.at[i].group >= 0)
            p->groups[place_at(p->guess_list.at[i].group, p->guess_list.at[i].k)] =
                p->guess_list.at[i].value;
}

/* a frame in a plane has no Euler parameters */
static bool is_known_referent(const Placing *p, const VariableReferent *referent)
{
    return referent->kind != REFERENT_NONE &&
           !(referent->kind == REFERENT_PARAMETER && !p->s->frame.has_parameters) &&
           !(referent->kind == REFERENT_POSITION && referent->which >= p->s->frame.shift_count);
}

Status place_read_guesses(Placing *p, Diag *diag)
{
    Assembly *a = p->a;

    for (int guesses = 1; guesses >= 0; guesses--) {
        for (int k = 0; k < a->l->m && guesses == 0; k++) {
            VariableReferent referent = {.kind = REFERENT_COORDINATE};
            Expr prescribed = system_driven(a->l->system, k, &referent.instance, &referent.which);
            double value;

            if (prescribed == NULL)
                continue;
            TRY(initial_driven(a, prescribed, &value, diag));
            add_guess(p, &referent, value, NULL, -1);
        }
        for (int i = 0; i < a->given_count; i++) {
            const GivenValue *given = &a->given[i];

            if (given->referent.kind != REFERENT_NONE && is_known_referent(p, &given->referent) &&
                given->value->is_guess == (guesses == 1))
                add_guess(p, &given->referent, given->target,
                          guesses == 1 ? given->value->name : NULL, given->group);
        }
    }
    gather_groups(p);
    return OK;
}

/* Complete four Euler parameters of which some are known (NAN: not). The others are 0 where the
 * known ones have unit length. A last one has one of two signs, that of `sign`. Returns how well
 * all four are known then: not, guessed, or as well as the known ones. */
static Knowledge complete_four(double q[4], double sign)
{
    double left = 1;
    int missing = 0, last = 0;

    for (int k = 0; k < 4; k++)
        if (isnan(q[k])) {
            last = k;
            missing++;
        } else {
            left -= q[k] * q[k];
        }
    if (fabs(left) < 1e-15) {
        for (int k = 0; k < 4; k++)
            q[k] = isnan(q[k]) ? 0 : q[k];
        return KNOWN_GIVEN;
    }
    if (missing == 1 && left > 0)
        q[last] = copysign(sqrt(left), sign);
    return missing == 0 ? KNOWN_GIVEN : missing == 1 && left > 0 ? KNOWN_GUESSED : KNOWN_NOT;
}

static Knowledge lesser(Knowledge a, Knowledge b)
{
    return a < b ? a : b;
}

/* complete from the parameters that are known at least so well */
static void complete_attitude(Placing *p, int link, Knowledge least)
{
    const int first = place_at(link, p->s->links[link].first_parameter);
    double q[4], sign = 1;
    Knowledge known;

    for (int k = 0; k < 4; k++) {
        q[k] = p->known[first + k] >= least ? p->begun[first + k] : NAN;
        if (isnan(q[k]) && !isnan(p->begun[first + k]))
            sign = p->begun[first + k];
    }
    known = lesser(complete_four(q, sign), least);
    for (int k = 0; k < 4; k++)
        if (known > p->known[first + k]) {
            p->known[first + k] = known;
            p->begun[first + k] = q[k];
        }
}

static void complete_parameters(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++)
        if (p->s->links[i].has_parameters) {
            complete_attitude(p, i, KNOWN_GIVEN);
            complete_attitude(p, i, KNOWN_GUESSED);
        }
}

/* for each frame the link that defines it: a body's own edge, or an arm; -1 */
static int *makers_of(const KinematicTree *s)
{
    int *maker = NEW_ARRAY(int, s->node_count);

    for (int node = 0; node < s->node_count; node++)
        maker[node] = -1;
    for (int i = s->link_count - 1; i >= 0; i--) {
        const Family family = s->links[i].instance->row->family;

        if (family == FAMILY_BODY || family == FAMILY_ARM)
            maker[s->links[i].head] = i;
    }
    return maker;
}

/* the body of a frame, and the pose of the frame in it; -1: a frame of ground */
static int body_of(const Placing *p, const int *maker, int node, Pose *in_body)
{
    const double none[POSE_COORDS] = {0};
    int link;

    *in_body = (Pose){.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    while ((link = maker[node]) >= 0) {
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

static bool is_half_determined(const Placing *p, int link, bool rotation)
{
    const Instance *instance = p->s->links[link].instance;

    for (int k = 0; k < instance->pose_count; k++)
        if (instance->coord_rotation[k] == rotation && p->known[place_at(link, k)] != KNOWN_NOT)
            return true;
    return false;
}

static void know_half(Placing *p, int link, bool rotation, const double *c, Knowledge known)
{
    const Instance *instance = p->s->links[link].instance;

    for (int k = 0; k < instance->pose_count; k++)
        if (instance->coord_rotation[k] == rotation) {
            p->begun[place_at(link, k)] = c[k];
            p->known[place_at(link, k)] = known;
        }
}

/* A frame whose pose is completely known determines the attitude of its body, and with that its
 * position. */
static void place_body(Placing *p, const int *maker, int node, const double *wanted,
                       Knowledge known)
{
    const int shifts = p->s->frame.shift_count;
    double c[POSE_COORDS] = {0}, back[9];
    bool whole = true;
    Pose in_body, referents;
    int body = body_of(p, maker, node, &in_body);

    memcpy(c, wanted, sizeof c);
    if (p->s->frame.has_parameters)
        known = lesser(known, complete_four(c + shifts, 1));
    else if (isnan(wanted[shifts]))
        known = KNOWN_NOT;
    if (body < 0 || known == KNOWN_NOT || is_half_determined(p, body, true))
        return;
    link_pose(&p->s->frame, c, &referents);
    matrix3_transpose(in_body.R, back);
    matrix3_times(referents.R, back, referents.R);
    matrix3_apply(referents.R, in_body.p, in_body.p);
    for (int k = 0; k < 3; k++) {
        whole = whole && (k >= shifts || !isnan(wanted[k]));
        referents.p[k] = whole ? referents.p[k] - in_body.p[k] : 0;
    }
    memset(c, 0, sizeof c);
    if (!p->s->frame.has_parameters)
        c[shifts] = wanted[shifts]; /* in a plane: with its turns */
    link_read(&p->s->links[body], &referents, c);
    know_half(p, body, true, c, known);
    if (whole && !is_half_determined(p, body, false))
        know_half(p, body, false, c, known);
}

/* place bodies by frames whose pose is completely known */
static void place_bodies(Placing *p, bool guesses)
{
    double *wanted = NEW_ARRAY(double, p->s->node_count *POSE_COORDS);
    int *maker = makers_of(p->s);

    for (int i = 0; i < p->s->node_count * POSE_COORDS; i++)
        wanted[i] = NAN;
    for (int i = 0; i < p->guess_list.count; i++) {
        const InitialGuess *initial_guess = &p->guess_list.at[i];

        if (initial_guess->is_guess != guesses)
            continue;
        if (initial_guess->link < 0)
            wanted[place_at(initial_guess->head, initial_guess->k)] = initial_guess->value;
        /* positions of bodies in Cartesian coordinates have the names of their coordinates */
        else if (p->s->links[initial_guess->link].instance->row->family == FAMILY_BODY &&
                 initial_guess->k < p->s->frame.shift_count)
            wanted[place_at(p->s->links[initial_guess->link].head, initial_guess->k)] =
                initial_guess->value;
    }
    for (int node = 0; node < p->s->node_count; node++)
        place_body(p, maker, node, wanted + place_at(node, 0),
                   guesses ? KNOWN_GUESSED : KNOWN_GIVEN);
    MEM_FREE(wanted, maker);
}

void place_mark_known(Placing *p)
{
    for (int i = 0; i < p->guess_list.count; i++) {
        const InitialGuess *wanted = &p->guess_list.at[i];
        Knowledge known = wanted->is_guess ? KNOWN_GUESSED : KNOWN_GIVEN;

        if (wanted->link < 0)
            continue;
        p->begun[place_at(wanted->link, wanted->k)] = wanted->value;
        if (known > p->known[place_at(wanted->link, wanted->k)])
            p->known[place_at(wanted->link, wanted->k)] = known;
    }
    complete_parameters(p);
    place_bodies(p, false);
    place_bodies(p, true);
}

int place_ignorance(const Placing *p, int link, TreeKind kind)
{
    const Link *l = &p->s->links[link];
    int sum = 0, parameters = 0;

    if (l->is_tied && kind == TREE_TRANSLATION && tree_has(p->trees[TREE_ROTATION], l->edge))
        return 0; /* its turn determines its shift */
    for (int k = 0; kind == TREE_TRANSLATION && k < l->shift_count; k++) {
        Knowledge known = p->known[place_at(link, l->shift[k].coordinate)];

        sum += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    for (int k = 0; kind == TREE_ROTATION && k < l->turn_count; k++) {
        Knowledge known = p->known[place_at(link, l->turn[k].coordinate)];

        sum += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    for (int k = 0; kind == TREE_ROTATION && l->has_parameters && k < 4; k++) {
        Knowledge known = p->known[place_at(link, l->first_parameter + k)];

        parameters += known == KNOWN_NOT ? OPEN : known == KNOWN_GUESSED;
    }
    return sum + (parameters >= OPEN ? 3 * OPEN : parameters);
}

/* model_rest.c: frames at rest: ground, and arms on it, also through other arms */
#include "model/model_given.h"

#include <string.h>

static const Instance *frame_maker(const State *state, const char *frame)
{
    const Instance *part = state_part(state, frame);

    return part != NULL && part->row->family == FAMILY_ARM ? part : NULL;
}

/* R v + r */
static void move(Arena *arena, const Expr R[9], const Expr *v, Expr r[3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            r[i] = expr_add(arena, r[i], expr_mul(arena, R[3 * i + k], v[k]));
}

static void turn(Arena *arena, Expr R[9], const Expr *by)
{
    Expr product[9];

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            product[3 * i + k] = expr_int(arena, 0);
            for (int j = 0; j < 3; j++)
                product[3 * i + k] = expr_add(arena, product[3 * i + k],
                                              expr_mul(arena, R[3 * i + j], by[3 * j + k]));
        }
    memcpy(R, product, sizeof product);
}

/* its position and rotation against ground, along arms; false: the path contains another part */
static bool place_frame(const State *state, const char *frame, Expr r[3], Expr R[9])
{
    const Instance *arm = frame_maker(state, frame);

    if (strcmp(frame, "ground") == 0) {
        for (int i = 0; i < 9; i++)
            R[i] = expr_int(state->arena, i % 4 == 0);
        for (int i = 0; i < 3; i++)
            r[i] = expr_int(state->arena, 0);
        return true;
    }
    if (arm == NULL || instance_value(arm, "at")->given ||
        !place_frame(state, graph_node(state->graph, arm->tail)->name, r, R))
        return false;
    move(state->arena, R, instance_value(arm, "position")->at, r);
    turn(state->arena, R, instance_value(arm, "rotation")->at);
    return true;
}

bool given_rests(const State *state, const char *frame, Expr pose[GIVEN_POSE])
{
    Expr R[9];

    if (!place_frame(state, frame, pose, R))
        return false;
    pose[3] = expr_call2(state->arena, OP_ATAN2, R[3], R[0]);
    return true;
}

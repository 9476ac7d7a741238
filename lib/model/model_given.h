/* model_given.h: what the files of given equations share */
#ifndef COTREE_MODEL_MODEL_GIVEN_H
#define COTREE_MODEL_MODEL_GIVEN_H

#include "component/equation_block.h"
#include "model/model_draft.h"

enum { GIVEN_EFFORTS = 6 };
extern const char *const given_motions[GIVEN_POSE];    /* "x", "y", "z", "theta" */
extern const char *const given_efforts[GIVEN_EFFORTS]; /* "fx" ... "tz" */

typedef enum EquationKind { EQUATION_UNKNOWN, EQUATION_INTERNAL, EQUATION_GIVES } EquationKind;

typedef struct BlockEquation {
    EquationKind kind;
    Instance *part; /* of an unknown that moves nothing; that hands out what is given, or NULL */
    int port;
    bool is_motion;
    int member; /* of given_motions or given_efforts; of a terminal 0 for its current, 1 for its
                   voltage */
    const Syntax *value;
    Place place;
    Expr e; /* the value, once all lines are read */
    struct BlockEquation *next;
} BlockEquation;

struct BlockEquations {
    BlockEquation *first, *last;
    const char **moving; /* names of unknowns that move frames, in order; then those of free ones */
    int moving_count;
    int free_count; /* of unknowns that are the motion of a frame itself */
    int *frames;    /* ports whose motion is given, or free */
    int frame_count;
    Instance *block; /* NULL until the first unknown */
    bool has_parts;  /* lines made some */
};

/* Whether frames of the scene have the motion: one of given_motions. */
bool given_moves(const State *state, int motion);
/* "leg1.NAME", and "leg1.A_x" of the motion A.x; in the state's pool */
const char *given_name(State *state, const Use *use, const char *name);
/* Whether a frame rests: where it stands then, over parameters. */
bool given_rests(const State *state, const char *frame, Expr pose[GIVEN_POSE]);

#endif

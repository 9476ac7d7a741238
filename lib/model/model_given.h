/* model_given.h: shared by the files of given equations */
#ifndef COTREE_MODEL_MODEL_GIVEN_H
#define COTREE_MODEL_MODEL_GIVEN_H

#include "component/equation_block.h"
#include "model/model_draft.h"

enum { GIVEN_EFFORTS = 6 };
extern const char *const given_motions[GIVEN_POSE];    /* "x", "y", "z", "theta" */
extern const char *const given_efforts[GIVEN_EFFORTS]; /* "fx" ... "tz" */
extern const int given_effort_of[GIVEN_POSE];          /* the effort that works on a motion */

typedef enum EquationKind { EQUATION_UNKNOWN, EQUATION_INTERNAL, EQUATION_GIVES } EquationKind;

typedef struct BlockEquation {
    EquationKind kind;
    /* of an unknown that moves nothing, or the part that applies what is given; or NULL */
    Instance *part;
    int port;
    bool is_motion;
    /* index in given_motions or given_efforts; for a terminal 0 for its current, 1 for its
     * voltage */
    int member;
    const Syntax *value;
    Place place;
    Expr e; /* its value, after all lines have been read */
    struct BlockEquation *next;
} BlockEquation;

struct BlockEquations {
    BlockEquation *first, *last;
    /* names of unknowns that move frames, in order, followed by those of free frames */
    const char **moving;
    int moving_count;
    int free_count; /* number of unknowns that are the motion of a frame itself */
    int *frames;    /* ports whose motion is given, or that are free */
    int frame_count;
    Instance *block; /* NULL until the first unknown */
    bool has_parts;  /* lines have made some */
};

/* What is given of a port: that motion or effort of a frame, current or voltage of a terminal.
 * member -1: any. NULL: nothing is. */
const BlockEquation *given_find(const BlockEquations *equations, int port, bool is_motion,
                                int member);
/* Whether frames of the scene have that motion, one of given_motions. */
bool given_moves(const State *state, int motion);
/* "leg1.NAME", and "leg1.A_x" for the motion A.x; in the state's pool */
const char *given_name(State *state, const Use *use, const char *name);
/* Whether a frame is at rest, and then its pose, over parameters. */
bool given_rests(const State *state, const char *frame, Expr pose[GIVEN_POSE]);

#endif

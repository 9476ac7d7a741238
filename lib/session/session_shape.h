/* session_shape.h: a mode as a shape of what is drawn */
#ifndef COTREE_SESSION_SHAPE_H
#define COTREE_SESSION_SHAPE_H

#include "present/mechanism.h"
#include "session/session_impl.h"

/* by how much each item of a mechanism moves, at phases 0 and a quarter of the period */
typedef struct ModeShape {
    double *cosine, *sine;
    double period; /* s; of one that doesn't swing 1 */
    char caption[48];
} ModeShape;

/* Of the mode of that number about an instant of a run; shape_free() in any case. Fails as
 * linearize() and modes_find() do, with E_VALUE if there is no such mode, or it moves nothing that
 * is drawn. */
MUST_USE Status shape_find(ct_session *session, Run *run, double at, const Mechanism *mechanism,
                           int number, ModeShape *out, Diag *diag);
void shape_free(ModeShape *shape);
/* from where the items are at rest to a phase, rad */
void shape_move(const ModeShape *shape, int count, double phase, double *values);

#endif

/* mechanism.h: bodies, joints, springs and forces at an instant
 *
 * A Mechanism lists the variables that it is drawn from. The owner of a run passes their values,
 * one row for each instant, and gets a picture of each. All pictures of an animation have one
 * scale. */
#ifndef COTREE_PRESENT_MECHANISM_H
#define COTREE_PRESENT_MECHANISM_H

#include "present/picture.h"
#include "present/view.h"

typedef enum Look { LOOK_ISO, LOOK_XY, LOOK_XZ, LOOK_YZ } Look;

typedef struct MechanismOptions {
    Look look;           /* of a spatial scene */
    bool reactions;      /* of joints, as arrows */
    const char *caption; /* in the place of the time; NULL */
} MechanismOptions;

/* A force or moment on a frame, as an arrow. */
typedef struct Load {
    const Instance *owner;
    int node;
    bool in_body;  /* its components are in the frame's axes */
    bool reaction; /* of a joint, on its tip */
    int first;     /* of its items: three of the force, three of the moment */
} Load;

/* A beam: points of its axis, as spots after those of the nodes. */
typedef struct Bent {
    const Instance *part;
    int first; /* of its spots */
} Bent;

/* An ellipse about a node, in the axes of its frame: of a wheel or a ball. */
typedef struct Rim {
    const Instance *part;
    double first[3], second[3]; /* m */
} Rim;

enum { BENT_SPOTS = 13 };

/* The name of a part, next to the end of a load's arrow or a node: at the same side in all pictures
 * of an animation. */
typedef struct Name {
    const Instance *part;
    int load; /* which; -1: none */
    int side; /* one of those that mechanism_names.c lists */
} Name;

typedef struct Mechanism {
    const View *view;
    MechanismOptions options;
    LIST(Expr) items; /* what it is drawn from, over the user's variables */
    LIST(Load) loads;
    LIST(Bent) bents;
    LIST(Rim) rims;
    LIST(Name) names; /* those that choose first first */
    int nodes, spots; /* nodes, then the points of beams */
    int *place;       /* of a spot's first item; -1: ground, or not drawn */
    int *body;        /* that a node is fixed in, by the node of its frame; -1: of another domain */
    int ground;
    double axes[3][3]; /* to the right, up, and towards who looks */
    double scale;      /* px a metre */
    double left, top;  /* px: of the origin */
    double width, height;
    double newton, moment; /* px a newton and a newton metre; 0: no such load */
} Mechanism;

/* Fails with E_MISSING where there are no bodies. mechanism_close() in any case. */
MUST_USE Status mechanism_open(Mechanism *mechanism, const View *view, MechanismOptions options,
                               Diag *diag);
/* Choose the scale for all instants: `values` is rows x items. Fails with E_VALUE where a place is
 * undefined. */
MUST_USE Status mechanism_fit(Mechanism *mechanism, const double *values, int rows, Diag *diag);
/* picture_close() */
void mechanism_draw(const Mechanism *mechanism, const double *values, double t, Picture *out);
/* how many items a spot has: where it is, and of a frame how it is turned */
int mechanism_spot_items(const Mechanism *mechanism, int spot);
void mechanism_close(Mechanism *mechanism);

#endif

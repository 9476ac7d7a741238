/* mechanism_impl.h: a mechanism on the sheet, for the files that draw its parts */
#ifndef COTREE_PRESENT_MECHANISM_IMPL_H
#define COTREE_PRESENT_MECHANISM_IMPL_H

#include "present/mechanism.h"

/* One instant being drawn. */
typedef struct Sheet {
    const Mechanism *mechanism;
    const double *values; /* of the items */
    Picture *picture;
} Sheet;

#define INK_DARK   "#222222"
#define INK_SOFT   "#777777"
#define INK_SPRING "#8a6d00"
#define INK_FORCE  "#c00000"
#define INK_REACT  "#6a3d9a"
#define LINK_HALF  7.0 /* px: half the width of a link */
#define JOINT_SIZE 5.0

/* where a spot is, m, and an axis of a node's frame turned to ground */
void mechanism_place(const Mechanism *mechanism, const double *values, int spot, double out[3]);
void mechanism_turn(const Mechanism *mechanism, const double *values, int node, const double in[3],
                    double out[3]);
/* on paper, and how near it is */
Point mechanism_point(const Mechanism *mechanism, const double at[3], double *depth);
Point sheet_node(const Sheet *sheet, int spot, double *depth);
/* a direction on paper, y down, as long as it is seen: 1 across the look */
Point mechanism_direction(const Mechanism *mechanism, const double direction[3]);

/* a load's force as it is drawn, px, and its moment in ground axes */
Point mechanism_load(const Mechanism *mechanism, const double *values, const Load *load,
                     double moment[3]);
/* how near the middle of a node's body is; that of ground: farther than anything */
double sheet_depth(const Sheet *sheet, int node);
/* which colour a node's body has */
int mechanism_color(const Mechanism *mechanism, int node);

void sheet_joint(Sheet *sheet, const Instance *joint);
/* a spring, damper or actuator */
void sheet_link(Sheet *sheet, const Instance *link);
void sheet_contact(Sheet *sheet, const Instance *contact);
void sheet_bushing(Sheet *sheet, const Instance *bushing);
void sheet_rim(Sheet *sheet, const Rim *rim);
void sheet_load(Sheet *sheet, const Load *load);
void sheet_corner(Sheet *sheet, double t); /* axes, scale, time, title */
void sheet_names(Sheet *sheet);
/* All but the names; picture_close(). */
void mechanism_draw_parts(const Mechanism *mechanism, const double *values, double t, Picture *out);
/* which parts have names, and where these cover least in all instants: `values` is rows x items */
void mechanism_call(Mechanism *mechanism);
void mechanism_settle_names(Mechanism *mechanism, const double *values, int rows);

#endif

/* origin.h: what the equations are formed from: a copy of the scene, which may change later */
#ifndef COTREE_FORMULATE_SYSTEM_ORIGIN_H
#define COTREE_FORMULATE_SYSTEM_ORIGIN_H

#include "base/memory.h"
#include "base/names.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"
#include "model/scene.h"

typedef struct GivenParameter {
    Expr symbol; /* a parameter */
    double value;
} GivenParameter;

typedef struct CoordinateOwner {
    int instance;
    int coordinate;
} CoordinateOwner;

typedef struct Origin {
    uint64_t revision;
    bool planar;
    Vec gravity;
    Form form;
    const char **independent;
    int independent_count;

    Instance *instances;
    int instance_count;
    Names *instance_names;   /* in the order of the instances */
    Names *coordinate_names; /* of all instances, */
    LIST(CoordinateOwner) coordinate_owners;
    Graph *graph;
    Tree *trees[TREE_KINDS];
    const char **output_names;
    Expr *outputs;
    int output_count;
    Instanced *uses;
    int use_count;
    Expr *rests; /* as in SystemOptions */
    int rest_count;
    /* as at the time of the build: the user's, then lifted constants */
    LIST(GivenParameter) parameters;
    int lifted_count; /* the last ones */
    /* lifted constants are wanted: a scene has them if it is large enough */
    bool wants_lifted, is_small;
} Origin;

#endif

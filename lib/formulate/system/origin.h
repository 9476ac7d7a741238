/* origin.h: what the equations are formed from: the scene, copied, since it may change later */
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
    Names *instance_names;   /* numbered as the instances */
    Names *coordinate_names; /* of all instances, */
    LIST(CoordinateOwner) coordinate_owners;
    Graph *graph;
    Tree *trees[TREE_KINDS];
    const char **output_names;
    Expr *outputs;
    int output_count;
    Instanced *uses;
    int use_count;
    LIST(GivenParameter) parameters; /* as they were: the user's, then literals */
    int literals;
    bool asks_literals, is_small; /* it has them where the scene is large enough */
} Origin;

#endif

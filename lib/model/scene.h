/* scene.h: the input of formulation: a graph, its trees, and instances of components
 *
 * All of it is borrowed from the maker of the scene, until that changes, except for the two
 * lists. */
#ifndef COTREE_MODEL_SCENE_H
#define COTREE_MODEL_SCENE_H

#include "component/component.h"
#include "graph/tree.h"

typedef enum Form { FORM_AUGMENTED, FORM_EMBEDDED } Form;

/* Which equations of scalar networks are integrated: state form, by a normal tree in any case; or
 * those that follow from the user's trees. */
typedef enum NetworkForm { NETWORK_STATE, NETWORK_TREE } NetworkForm;

typedef struct SceneParameter {
    Expr symbol;  /* SYMBOL_PARAMETER */
    double value; /* current value, SI */
} SceneParameter;

typedef struct SceneOutput {
    const char *name;
    Expr body; /* over variables, t and parameters */
} SceneOutput;

typedef struct SceneUse { /* an instance of a subsystem; names of what it made start with "name." */
    const char *name, *definition;
    int outer; /* the instance in which it was made; -1 */
} SceneUse;

typedef struct Scene {
    Arena *arena;
    uint64_t revision; /* changes whenever equations may have changed; never reused */
    bool planar;
    const Expr *gravity; /* three components, ground axes, m/s^2 */
    const Graph *graph;
    const Tree *trees[TREE_KINDS]; /* NULL: no edge is of that kind */
    const Instance *const *instances;
    int instance_count;
    Form form;
    const char *const *independent; /* coordinates; count 0: chosen by pivoting */
    int independent_count;
    NetworkForm network_form;
    LIST(SceneParameter) parameters;
    LIST(SceneOutput) outputs;
    LIST(SceneUse) uses;                           /* outer ones before those inside */
    double (*number)(const void *context, Expr e); /* value of an expression of parameters */
    const void *context;
} Scene;

void scene_free(Scene *scene); /* its lists */

/* Makes the current scene, for callers that may need equations later. */
typedef struct SceneSource {
    Status (*make)(const void *context, Scene *out, Diag *diag);
    const void *context;
} SceneSource;

#endif

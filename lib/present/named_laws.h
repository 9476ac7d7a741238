/* named_laws.h: laws that equations call by name, written once below them
 *
 * A diode's current needs a line of its own. Equations contain D1.law(D1.v), and the definition
 * follows below: D1.law(v) = ... With `set laws named` the same holds for the laws of the user. */
#ifndef COTREE_PRESENT_NAMED_LAWS_H
#define COTREE_PRESENT_NAMED_LAWS_H

#include "formulate/system/system.h"
#include "model/model.h"

/* calls of the user's laws, and of their derivatives, that were defined on the page already */
typedef LIST(Expr) DefinedLaws;

typedef struct LawView {
    const Model *model;
    System *system; /* of its equations; NULL: there are none */
    Notation notation;
    DefinedLaws *defined; /* grows; NULL: the user's laws are not called by name */
} LawView;

typedef struct LawDefinition {
    char *name; /* D1.law(v) of the notation, also "D1.law(v) = D2.law(v)" of equal ones */
    Expr value;
} LawDefinition;
typedef LIST(LawDefinition) LawDefinitions;

/* Replace laws of parts by calls in `roots`, and add the definitions to `out`, in the order of the
 * parts; nothing without equations. Those of the user's laws that are called follow. Free with
 * named_laws_free(). O(nodes) for each part with such a law. */
void named_laws(const LawView *view, Expr *roots, int count, LawDefinitions *out);
void named_laws_free(LawDefinitions *laws);

#endif

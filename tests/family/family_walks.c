/* family_walks.c: where a run begins follows from the text of the model alone
 *
 * A random walk of edits, looks, undos, redos, tree changes, runs and equilibria ends with a run.
 * The same walk without its looks ends with the same run, and so does the text that `save` writes
 * at the end, in a session of its own: bit for bit. */
#include "family.h"

#include "../unit/session_kit.h"

#include "base/memory.h"

enum { STEPS = 8, MOST = 12 };

/* a model, its edits, and what is asked of its run */
typedef struct Place {
    const char *model;
    const char *edits[MOST], *asked[MOST];
} Place;

static const Place places[] = {
    /* a four-bar: two assemblies for each angle of the crank */
    {"scene planar\ngravity [0, -9.81]\nbody a mass=1 inertia=0.1\nbody b mass=1 inertia=0.1\n"
     "body c mass=1 inertia=0.1\narm a1 a [-0.2, 0]\narm a2 a [0.2, 0]\narm b1 b [-0.5, 0]\n"
     "arm b2 b [0.5, 0]\narm c1 c [-0.4, 0]\narm c2 c [0.4, 0]\narm g ground [0.9, 0]\n"
     "revolute h1 ground a1\nrevolute h2 a2 b1\nrevolute h3 b2 c1\nrevolute h4 g c2\n",
     {"init h1 = 1", "init h1 = -2, h1' = 3", "guess h4 = 2", "guess h4 = -2", "guess h2 = -1",
      "init none", "guess none", "tree absolute", "tree joint", "tree h1 h2 h4", "set a.mass = 2",
      "spring k h1 k=9"},
     {"a.x", "c.theta", "h1", "h3", "h4'"}},
    /* a body on a spherical joint that may be a chord */
    {"gravity [0, 0, -9.81]\nbody m mass=1 inertia=[1, 2, 2.5]\n"
     "arm a ground [0, 0, 0] rotation=z(90 deg)\narm e m [0, 0, 0.3]\nspherical j a e\n",
     {"init j.q0 = 0.5, j.q1 = 0.5, j.q2 = 0.5, j.q3 = 0.5", "init j.q1' = 1", "init m.wz = 2",
      "guess j.q0 = -1", "init none", "guess none", "tree absolute", "tree joint",
      "tree rotation m; tree translation j", "set m.mass = 3", "guess m.q3 = 0.8",
      "init j.q2' = -1"},
     {"m.x", "m.wz", "m.Wx", "j.q0", "m.q3"}},
    /* diodes: the network is solved from a guess */
    {"vsource V a 0 5\nresistor R1 a b 1000\ndiode D1 b c\ndiode D2 c 0\ncapacitor C1 c 0 1 uF\n"
     "inductor L1 b d 1 mH\nresistor R2 d 0 2000\n",
     {"init C1.v = 0.3", "init L1.i = 1e-3", "guess D1.i = 1e-3", "init none", "guess none",
      "set R1.R = 500", "op", "equilibrium", "resistor R3 c 0 5000", "tree electrical V D1",
      "tree electrical V C1 R1", "init C1.v = 0.1"},
     {"C1.v", "D1.i", "L1.i", "R1.v", "D2.v"}},
    /* subsystems that rest on springs, one with its own start */
    {"scene planar\ngravity [0, -9.81]\nsubsystem leg frames=[A]\nbody l mass=1 inertia=0.1\n"
     "arm r l [-0.4, 0]\nrevolute h A r\nspring k h k=9\ninit h = 0.3\nend\n"
     "arm g ground [1, 0]\nuse leg p A=ground\nuse leg q A=g\nspring s p.l q.l k=3 length=1\n",
     {"init p.h = 1", "init q.h' = 2", "guess p.h = -1", "init none", "guess none", "equilibrium",
      "tree absolute", "tree joint", "set p.l.mass = 2", "delete s", "equilibrium", "init q.h = 7"},
     {"p.l.x", "q.h", "p.h'", "q.l.y"}}};

static const char *const looks[] = {"print 1", "assemble",  "modes",     "check",
                                    "count",   "draw",      "show init", "show equations",
                                    "info",    "linearize", "show state"};

static Verdict walks_leave_no_trace(Member *member)
{
    const Place *place = &places[member_one_of(member, COUNT(places))];
    static const char *const end = "simulate 1e-3 every=1e-3\n";
    Kit walked = kit_new(), blind = kit_new(), fresh = kit_new();
    Kit *const kits[] = {&walked, &blind, &fresh};
    Verdict verdict = AGREES;
    bool runs[3];
    char *saved;

    tell(member, "%s", place->model);
    (void)kit_do(&walked, place->model);
    (void)kit_do(&blind, place->model);
    for (int i = 0; i < STEPS; i++) {
        const char *look = looks[member_one_of(member, COUNT(looks))];
        const int draw = member_one_of(member, 10);
        const char *edit = draw < 2   ? "undo"
                           : draw < 3 ? "redo"
                           : draw < 4 ? end
                                      : place->edits[member_one_of(member, MOST)];

        tell(member, "%s\n%s\n", look, edit);
        (void)kit_do(&walked, look);
        (void)kit_value(&walked, place->asked[0]);
        (void)kit_do(&walked, edit);
        (void)kit_do(&blind, edit);
    }
    saved = ct_save(walked.session);
    tell(member, "saved:\n%s", saved);
    if (kit_do(&fresh, saved) != CT_OK) {
        tell(member, "%s\n", fresh.error.message);
        verdict = DISAGREES;
    }
    ct_free(saved);
    for (int k = 0; k < 3; k++)
        runs[k] = kit_do(kits[k], end) == CT_OK;
    for (int i = 0; runs[0] && i < MOST && place->asked[i] != NULL; i++) {
        const double value = kit_value(&walked, place->asked[i]);

        for (int k = 1; k < 3; k++) {
            const double other = kit_value(kits[k], place->asked[i]);

            if ((value != other || signbit(value) != signbit(other)) &&
                !(isnan(value) && isnan(other))) {
                tell(member, "%s: %a, %s %a\n", place->asked[i], value,
                     k == 1 ? "without looks" : "from the saved text", other);
                verdict = DISAGREES;
            }
        }
    }
    if (runs[0] != runs[1] || runs[0] != runs[2]) {
        tell(member, "runs: %d %d %d\n", runs[0], runs[1], runs[2]);
        verdict = DISAGREES;
    }
    kit_free(&walked);
    kit_free(&blind);
    kit_free(&fresh);
    return verdict == AGREES && !runs[0] ? REFUSED : verdict;
}

static const Family families[] = {
    {"a run after a walk is that of the saved text, with looks and without", 40, 0.4, 0,
     walks_leave_no_trace}};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}

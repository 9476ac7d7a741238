/* verbs_build.c: rows of what builds a model beside its components */
#include "language/verbs.h"

const Verb verbs_build[] = {
    {.name = "scene",
     .group = GROUP_SCENE,
     .shape = "w",
     .words = WORDS("planar", "spatial"),
     .usage = "scene planar|spatial",
     .brief = "whether everything moves in the xy-plane",
     .help = "In a planar scene frames move in the xy-plane and turn about z; bodies have x, y and "
             "theta, an inertia is one number, and vectors may have two components. Spatial is "
             "what holds when nothing is said. It comes before the first component.",
     .example = "scene planar\nbody m1 mass=2 inertia=0.1\nshow coordinates",
     .see = "gravity body"},
    {.name = "gravity",
     .group = GROUP_SCENE,
     .shape = "v",
     .usage = "gravity [gx, gy]|[gx, gy, gz]",
     .brief = "uniform gravity, in ground axes",
     .help = "The acceleration of free fall in ground axes, in m/s^2. There is none until it is "
             "given. Entries may use parameters.",
     .example = "scene planar\ng = 9.81 [m/s^2]\ngravity [0, -g]\nbody m1 mass=2 inertia=0.1\n"
                "init m1.vy = 3\nsimulate 1\nprint m1.y",
     .see = "scene body"},
    {.name = "title",
     .group = GROUP_SCENE,
     .shape = "s",
     .usage = "title \"TEXT\"",
     .brief = "a title for plots and exports",
     .help = "The text stands over plots and in the head of what is exported.",
     .example = "title \"falling body\"\nbody m1 mass=2\nshow nodes",
     .see = "plot export"},
    {.name = "virtual",
     .group = GROUP_MECHANICAL,
     .shape = "",
     .usage = "virtual JOINT NAME TAIL TIP key=..",
     .brief = "a joint without constraint or force, for indirect coordinates",
     .help =
         "In front of a joint's keyword: the joint then constrains nothing and carries no "
         "force, but it has coordinates. As a branch of a tree it brings them into the "
         "equations (indirect coordinates, such as the absolute angle of a body in a chain); "
         "as a chord it shows how one frame moves seen from another. Every kind of joint can "
         "be virtual. A tree is never completed with one; it enters where it is named, and "
         "only trees in which it has freedom. One that leaves out a motion which the real joints "
         "allow is refused when the start is assembled.",
     .example = PENDULUM "body m2 mass=1 inertia=0.1\n"
                         "arm p2 m2 [0, 1]\n"
                         "revolute h2 m1 p2\n"
                         "virtual revolute a2 ground m2\n"
                         "tree rotation + a2 - h2\n"
                         "show coordinates",
     .see = "revolute tree"},
    {.name = "output",
     .group = GROUP_VARIABLES,
     .shape = "=",
     .usage = "output NAME = EXPR",
     .brief = "names an expression of variables",
     .help = "An output can be asked for like any variable: plotted, printed, exported, also after "
             "the run. A parameter holds a number and a law depends on its arguments; what depends "
             "on variables of the model is an output.",
     .example = PENDULUM "output pull = sqrt(h1.fx^2 + h1.fy^2)\n"
                         "init h1 = 60 deg\n"
                         "simulate 1\n"
                         "print max(pull)",
     .see = "print plot show"},
    {.name = "tree",
     .group = GROUP_TREES,
     .shape = "t>",
     .words = WORDS("translation", "rotation", "electrical", "hydraulic", "shaft", "slide",
                    "thermal", "joint", "absolute", "best"),
     .usage = "tree [translation|rotation|electrical] EDGE...|+ EDGE - EDGE...|joint|absolute|best",
     .brief = "shows the trees, sets or changes them",
     .help = "The branches of the trees decide which variables the equations are written in. Alone "
             "it shows the trees. With names it makes these edges branches: of both mechanical "
             "trees, or of the tree of their domain; 'tree rotation ...' and the like set one tree "
             "alone. What is left open is completed, and reported: joints of fewest coordinates "
             "first, then bodies; voltage sources, capacitors, resistors, inductors, current "
             "sources. Arms are always branches.\n"
             "With signs it changes what is there: 'tree + a - b' takes a in and b out. An edge "
             "leaves only a tree that another edge enters. A set that is no tree is refused whole, "
             "with the circuit that its edges close or the nodes that they leave out.\n"
             "'tree joint' prefers joints everywhere, 'tree absolute' bodies. A name that is also "
             "one of these words stands in brackets.\n"
             "'tree best' searches for the cheapest equations and prints the table that it "
             "compared. It starts from the trees as they are, from 'tree joint' and from 'tree "
             "absolute', and exchanges one branch for one chord of whose circuit it is part, in "
             "one tree or both, as long as that is cheaper. Virtual revolute joints between frames "
             "that can only turn about one axis against each other take part; one that is chosen "
             "becomes a statement of the model. A price is the cost of one evaluation of the "
             "accelerations: each addition and multiplication 1, each function 20, after common "
             "subexpressions are shared, and 2/3 N^3 + 2 N^2 for solving N equations, one a speed "
             "and one a constraint. The search ends after 200 choices or 10 seconds; Ctrl-C ends "
             "it with the best so far. 'undo' takes back the trees and the joints.",
     .example = PENDULUM "tree h1\nshow coordinates\ntree m1\nshow coordinates\ntree best\ntree",
     .see = "cotree form show count virtual"},
    {.name = "cotree",
     .group = GROUP_TREES,
     .shape = "p*",
     .usage = "cotree EDGE...",
     .brief = "keeps edges out of every tree",
     .help = "These edges stay chords from now on, whatever completes the trees, until a 'tree' "
             "statement names them again.",
     .example = PENDULUM "cotree h1\ntree\nshow constraints",
     .see = "tree"},
    {.name = "form",
     .group = GROUP_TREES,
     .shape = "wk",
     .words = WORDS("augmented", "embedded"),
     .keys = WORDS("independent"),
     .usage = "form augmented|embedded [independent=[h8]]",
     .brief = "which dynamic equations are shown and integrated",
     .help = "The augmented form has all coordinates, with a multiplier for each constraint. The "
             "embedded form has one equation for each degree of freedom: the constraints' speeds "
             "are eliminated. Its independent coordinates are chosen by pivoting, or are those "
             "that independent= names.",
     .example = PENDULUM "tree m1\nform embedded independent=[m1.theta]\nshow equations",
     .see = "tree show simulate"},
    {.name = NULL},
};

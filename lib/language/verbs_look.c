/* verbs_look.c: rows of what looks at a model */
#include "language/verbs.h"

const Verb verbs_look[] = {
    {.name = "show",
     .group = GROUP_LOOK,
     .shape = "xa>",
     .words = WORDS("graph", "nodes", "edges", "tree", "incidence", "circuits", "cutsets",
                    "coordinates", "constraints", "velocity", "acceleration", "jacobian", "mass",
                    "forces", "equations", "network", "state", "linear", "transfer", "derivation",
                    "outputs", "params", "structure", "run", "events", "settings", "program"),
     .usage = "show TOPIC|VARIABLE|NAME [ENTRY...|EDGE...] [as latex|c|matlab|tree]",
     .brief = "prints the graph, its matrices or the equations",
     .help =
         "The topics:\n"
         "  graph nodes edges tree        what the model is made of\n"
         "  incidence circuits cutsets    matrices of the graph, tree edges first\n"
         "  coordinates                   what the equations are written in, in their order\n"
         "  constraints                   also 'constraints velocity', 'constraints acceleration'\n"
         "  jacobian mass forces          of the constraints; of the motion\n"
         "  equations network             of the motion; of the circuit\n"
         "  outputs params settings       what has been given a name or a value\n"
         "  structure program             of the equations; of what computes them\n"
         "  run events                    the last run's report and what happened in it\n"
         "  derivation                    the steps that led to the equations\n"
         "  state linear transfer         of a linear network; of what was linearized\n"
         "Numbers behind a topic pick entries (show mass 2 3), names of edges rows (show cutsets "
         "h8), names of an output and an input one transfer function (show transfer h8 V1). "
         "Anything "
         "else is a variable, shown as the formula it is computed by (show h9.fx), "
         "or the name of a part, of which 'show R1' tells what 'info R1' does, as it does of a "
         "variable that no formula stands behind. 'as' gives another notation. Topics win over "
         "names: a variable called mass is shown by 'show (mass)'.",
     .example =
         PENDULUM "show edges\nshow cutsets\nshow mass 1 1\nshow forces as latex\nshow h1.fx",
     .see = "count check info tree print"},
    {.name = "count",
     .group = GROUP_LOOK,
     .shape = "x>",
     .words = WORDS("mass", "forces", "constraints", "jacobian", "network", "trees"),
     .usage = "count [BLOCK...|trees]",
     .brief = "additions, multiplications and functions of the equations",
     .help = "Prints for each block of the equations how many additions, multiplications and "
             "function calls it takes: as written, and after common parts are computed once. "
             "'count trees' puts the trees tried so far side by side.",
     .example = PENDULUM "count\ntree m1\ncount trees",
     .see = "tree show"},
    {.name = "check",
     .group = GROUP_LOOK,
     .shape = ">",
     .usage = "check",
     .brief = "degrees of freedom, redundant constraints, what can't be solved and why",
     .help = "Tells the degrees of freedom, which joints repeat constraints that others imply, "
             "which components nothing is connected to, and what stands in the way of a solution.",
     .example = PENDULUM "check",
     .see = "show info"},
    {.name = "draw",
     .group = GROUP_LOOK,
     .shape = ">",
     .usage = "draw [> \"FILE.svg\"]",
     .brief = "draws the linear graph",
     .help = "Draws nodes and edges, branches of the trees marked, as text. Into a file whose name "
             "ends in .svg goes a drawing, into one that ends in .dot the graph for Graphviz.",
     .example = PENDULUM "draw",
     .see = "show export"},
    {.name = "info",
     .group = GROUP_LOOK,
     .shape = "p>",
     .usage = "info NAME",
     .brief = "ends, direction, signs, variables of a component",
     .help = "Tells what a name stands for: of a component its two ends and which way its edge "
             "points, what a positive value means, whether it is a branch or a chord, its values, "
             "and every variable that can be asked for.",
     .example = PENDULUM "info h1\ninfo m1",
     .see = "show help"},
    {.name = NULL},
};

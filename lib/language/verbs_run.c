/* verbs_run.c: rows of what runs a model and looks at runs */
#include "language/verbs.h"

#define RUN_KEYS WORDS("every", "rtol", "atol", "method", "step", "maxstep", "check")
#define SWING    PENDULUM "init h1 = 60 deg\n"

const Verb verbs_run[] = {
    {.name = "init",
     .group = GROUP_RUN,
     .shape = "W=",
     .words = WORDS("none"),
     .usage = "init VARIABLE = VALUE, ...|none",
     .brief = "initial values",
     .help =
         "Gives values at the start: of coordinates and their rates (h8 = 30 deg, h8' = 10), of "
         "bodies (m1.x, m1.vx), of the circuit's states (C2.v, L3.i), whatever the trees are. "
         "What is given is kept, what depends on it is solved for, and a conflict is reported. "
         "A later line adds to the values or replaces them; 'init none' forgets them all. "
         "Values are kept when the model or its trees change.",
     .example = PENDULUM "init h1 = 30 deg, h1' = 2\nassemble\nprint m1.x, m1.vx",
     .see = "guess assemble simulate"},
    {.name = "guess",
     .group = GROUP_RUN,
     .shape = "W=",
     .words = WORDS("none"),
     .usage = "guess VARIABLE = VALUE, ...|none",
     .brief = "where the search for initial values starts",
     .help = "A mechanism can often be assembled in several ways. A guess picks the one nearby: it "
             "is where the search starts, and unlike what 'init' gives it need not be kept.",
     .example = PENDULUM "tree m1\ninit m1.x = 0.5\nguess m1.y = -1, m1.theta = 0.5\nassemble",
     .see = "init assemble"},
    {.name = "assemble",
     .group = GROUP_RUN,
     .shape = ">",
     .usage = "assemble",
     .brief = "solves the constraints for the initial configuration",
     .help =
         "Finds positions and speeds that satisfy all constraints from the values of 'init' and "
         "'guess', prints them, and says what had to be assumed. Runs do it by themselves.",
     .example = PENDULUM "init h1 = 30 deg\nassemble",
     .see = "init guess check"},
    {.name = "simulate",
     .group = GROUP_RUN,
     .shape = "vk>",
     .keys = RUN_KEYS,
     .usage = "simulate TIME [every=..] [rtol=..] [atol=..] [method=..] [step=..] [maxstep=..] "
              "[check=on]",
     .brief = "forward dynamics",
     .help =
         "Integrates the equations from 0 to TIME, in seconds, and keeps the result as run1, run2 "
         "and so on.\n"
         "  every=     distance of the points that are kept\n"
         "  rtol=      relative tolerance of a step\n"
         "  atol=      absolute tolerance of a step\n"
         "  method=    auto, or dop853 radau bdf adams ida rk4: 'help methods'\n"
         "  step=      the step of methods that have a fixed one\n"
         "  maxstep=   the largest step of any method, in seconds\n"
         "  check=on   estimates the error of the whole run\n"
         "Ctrl-C stops a run and keeps what it has; 'resume' goes on.",
     .example = SWING "simulate 2 every=0.01 rtol=1e-8 atol=1e-10 method=auto\nprint h1, h1'",
     .see = "init resume plot print table show"},
    {.name = "resume",
     .group = GROUP_RUN,
     .shape = "vk>",
     .keys = RUN_KEYS,
     .usage = "resume TIME [every=..]",
     .brief = "goes on where the last run ended or was stopped",
     .help =
         "Continues the last run by TIME, with the values that parameters have now. What is not "
         "said again is as in that run.",
     .example = SWING "simulate 1\nresume 1\nprint h1",
     .see = "simulate"},
    {.name = "kinematics",
     .group = GROUP_RUN,
     .shape = "vk>",
     .keys = RUN_KEYS,
     .usage = "kinematics TIME [every=..]",
     .brief = "motion that drivers prescribe",
     .help = "Solves the constraints together with the drivers at each instant: positions, speeds "
             "and accelerations, without masses or forces. The drivers must leave no freedom.",
     .example = PENDULUM "driver D1 h1 = 2*pi*t\nkinematics 1 every=0.1\nprint m1.x, m1.ax",
     .see = "driver inverse simulate"},
    {.name = "inverse",
     .group = GROUP_RUN,
     .shape = "vk>",
     .keys = RUN_KEYS,
     .usage = "inverse TIME [every=..]",
     .brief = "what a prescribed motion takes",
     .help = "Solves for the efforts that make the drivers' motion happen, and for all reactions. "
             "A driver with by= takes it from a coordinate or a source elsewhere, such as a "
             "motor's voltage.",
     .example = PENDULUM "driver D1 h1 = 0.5*sin(2*t)\ninverse 1 every=0.01\nprint max(D1.effort)",
     .see = "driver kinematics simulate"},
    {.name = "event",
     .group = GROUP_RUN,
     .shape = "n=",
     .keys = WORDS("when", "do"),
     .usage = "event NAME when=CONDITION [do=stop|mark|VARIABLE=VALUE ...]",
     .brief = "what happens when a condition becomes true",
     .help =
         "During a run the instant is located at which the condition becomes true; it may hold t, "
         "any variables and parameters, and && || !. It becomes a row of the result.\n"
         "  do=stop    the run ends there; 'resume' goes on\n"
         "  do=mark    the time is reported ('show events'), and the run goes on\n"
         "  s11'=-0.8*s11'   new values: coordinates, rates, voltages and currents of storage "
         "elements. Right-hand sides are what they were just before, all at once. What isn't "
         "named stays, but for what the constraints ask.\n"
         "A condition that holds already must have been false before it can become true; an event "
         "that stops ends such a run at its start. Events belong to the model: 'save' writes them, "
         "the same name again replaces one, 'delete' removes it. In 'kinematics' and 'inverse' "
         "they can mark and stop.",
     .example = "scene planar\ngravity [0, -9.81]\nbody m1 mass=1\nprismatic s1 ground m1 axis=y\n"
                "init s1 = 1\nevent hit when=s1 < 0 s1'=-0.8*s1'\nevent top when=s1' < 0 do=mark\n"
                "event end when=t > 1.9 && s1 < 0.1 do=stop\nsimulate 3\nshow events\n"
                "print t, s1",
     .see = "simulate show resume expect"},
    {.name = "equilibrium",
     .group = GROUP_RUN,
     .shape = ">",
     .usage = "equilibrium",
     .brief = "statics: where everything rests",
     .help =
         "Finds where all rates are zero, with sources and drivers as they are at t = 0: "
         "positions, "
         "reactions, voltages and currents. The search begins at the assembled start, so 'init' "
         "and "
         "'guess' choose which of several equilibria it is; stable or not makes no difference. "
         "First by Newton's method with line search, beside mechanics once more after the network "
         "has settled with positions held; where that fails, gravity, forces and sources grow from "
         "nothing; then a conductance beside each part whose current is an expression of its "
         "voltage shrinks to nothing; then everything creeps until it rests. What is found is "
         "printed, and is where the next runs start, until 'init' or 'assemble'.",
     .example = PENDULUM "spring k1 h1 k=2 rest=60 deg\nequilibrium\nmodes",
     .see = "op linearize modes assemble"},
    {.name = "op",
     .group = GROUP_RUN,
     .shape = ">",
     .usage = "op",
     .brief = "operating point: the same as equilibrium",
     .help =
         "The operating point of a circuit is its equilibrium; see there. Capacitors are open "
         "and inductors short. What nothing determines at rest, as a node between capacitors, is "
         "named. 'init' of capacitors and inductors chooses one of several states.",
     .example = "vsource E1 a 0 10\nresistor R1 a b 1 kohm\ncapacitor C1 b 0 1 uF\nop\nprint C1.v",
     .see = "equilibrium"},
    {.name = "linearize",
     .group = GROUP_RUN,
     .shape = "k>",
     .keys = WORDS("at", "inputs", "outputs"),
     .usage = "linearize [at=TIME] [inputs=[V1, ..]] [outputs=[h8, ..]]",
     .brief = "linear equations about the start or an instant of the last run",
     .help =
         "Finds y' = A y + B w, v = C y + D w for small deviations, about the assembled start or "
         "equilibrium, or with at= about an instant of the last run, and prints them. The states y "
         "are independent coordinates (those of 'form embedded independent=', else chosen by "
         "pivoting), their speeds, and the states of the circuit. Where a rotation is in Euler "
         "parameters, the deviation is a small turn about each axis (m1.turnX). Inputs are "
         "sources, "
         "actuators and parameters; outputs any variables or expressions. All entries are exact "
         "derivatives; one that rounding can't tell from 0 is 0. 'show linear' prints them again, "
         "linear.A(1,2) is one entry.",
     .example =
         SWING "actuator a1 h1 torque=0\nequilibrium\nlinearize inputs=[a1] outputs=[h1, m1.ax]\n"
               "print linear.A(2,1)",
     .see = "equilibrium modes bode show form"},
    {.name = "modes",
     .group = GROUP_RUN,
     .shape = "k>",
     .keys = WORDS("at"),
     .usage = "modes [at=TIME]",
     .brief = "eigenvalues, and which parts move",
     .help =
         "Eigenvalues of the linear equations about the assembled start or equilibrium, or with "
         "at= "
         "about an instant of the last run. A pair of conjugates is one mode: its natural "
         "frequency "
         "omega, its damping ratio, and what moves, the largest first and as 1; a minus is half a "
         "turn behind. Digits are those that are known, six at most; 0? says that rounding leaves "
         "open whether it grows or fades. modes.omega(1) and modes.damping(1) are figures of the "
         "slowest; 'export csv modes' writes them all, with the error of each eigenvalue.",
     .example = PENDULUM "equilibrium\nmodes\nexpect modes.omega(1) ~ sqrt(9.81/1.1) within 1e-9\n"
                         "export csv modes",
     .see = "equilibrium linearize"},
    {.name = "bode",
     .group = GROUP_RUN,
     .shape = "Ik>",
     .keys = WORDS("from", "to", "points"),
     .usage = "bode [OUTPUT...] [from=..] [to=..] [points=..] [> \"FILE.png\"]",
     .brief = "frequency response of what was linearized",
     .help =
         "Gain in dB and phase in degrees over the frequency in Hz: of each output against each "
         "input of the last 'linearize', or of the outputs named. It is drawn as 'plot' draws, in "
         "two panels: in a window, without a display in the terminal, into a file with '>'; a name "
         "that ends in csv gets the table instead.\n"
         "  from= to=  the range, in Hz, or with a unit of its own: from=1 [rad/s]; without them "
         "a decade about all poles and zeros\n"
         "  points=    how many, evenly on the logarithmic axis (200)\n"
         "The phase goes on where it passes half a turn.",
     .example = "vsource E1 a 0 0\nresistor R1 a b 1 kohm\ncapacitor C1 b 0 1 uF\n"
                "linearize inputs=[E1] outputs=[C1.v]\nshow transfer\n"
                "bode C1.v from=1 to=100 kHz",
     .see = "linearize show plot"},
    {.name = "plot",
     .group = GROUP_RUN,
     .shape = "iy>",
     .words = WORDS("last"),
     .usage = "plot ITEM... [vs ITEM] [> \"FILE.png\"]",
     .brief = "draws variables of runs",
     .help = "Draws with gnuplot: in a window, without a display in the terminal, into a file with "
             "'>' (png, svg, pdf). Each item is a variable, a call or an expression in brackets; a "
             "unit in brackets behind it says what to draw it in; without one it is in SI, and "
             "the axis says which where that is known. A bare name means the last run, "
             "run2.h8 another one. 'plot last' draws the last plot again.",
     .example = SWING "simulate 2 every=0.01\nplot h1 [deg] (h1'/2) vs t",
     .see = "simulate print table export"},
    {.name = "print",
     .group = GROUP_RUN,
     .shape = "e@>",
     .usage = "print EXPR [[UNIT]], ... [at TIME]",
     .brief = "values of expressions",
     .help = "Prints expressions of variables, parameters and laws: at the end of the last run, at "
             "an instant of it with 'at', or at the assembled start when 'init' or a change came "
             "later. min, max, mean and rms of one argument are taken over the run. A unit in "
             "brackets says what to print in. Comparisons stand in brackets, since '>' writes to a "
             "file.",
     .example = SWING "simulate 2 every=0.01\nprint h1 [deg], h1' at 1\nprint max(h1) [deg]",
     .see = "table plot show expect"},
    {.name = "table",
     .group = GROUP_RUN,
     .shape = "Ik>",
     .keys = WORDS("every"),
     .usage = "table [ITEM...] [every=..]",
     .brief = "values of the last run, in columns",
     .help = "Prints time and the items in columns, at the points that the run kept or at those of "
             "every=. Without items: all coordinates and speeds.",
     .example = SWING "simulate 1 every=0.01\ntable h1 h1' every=0.1",
     .see = "print plot export"},
    {.name = "export",
     .group = GROUP_RUN,
     .shape = "wI>",
     .words = WORDS("csv", "c", "latex", "dot"),
     .usage = "export csv [ITEM...]|c|latex|dot [> \"FILE\"]",
     .brief = "numbers, equations or code for other programs",
     .help =
         "'export csv' writes the last run: first column t, then the items as they are written, "
         "17 digits; without items all coordinates and speeds; 'export csv modes' the modes. '>>' "
         "adds rows to a file that is "
         "there, without a second header. The other words write the equations: as code in that "
         "language, as LaTeX, or the graph for Graphviz (dot). Without a file it goes to the "
         "screen.",
     .example = SWING "simulate 1 every=0.1\nexport csv h1 h1' m1.x\nexport latex",
     .see = "table plot show"},
    {.name = "expect",
     .group = GROUP_RUN,
     .shape = "C@",
     .usage = "expect CONDITION [at TIME]|EXPR ~ EXPR within TOL [at TIME]",
     .brief = "ends a script when something does not hold",
     .help = "Says nothing when it holds. Otherwise the two values are printed and a script ends "
             "with status 3. 'a ~ b within tol' holds when a and b differ by no more than tol.",
     .example = SWING "simulate 1 rtol=1e-10 atol=1e-12\n"
                      "expect energy.total ~ -1*9.81*cos(60 deg) within 1e-6\n"
                      "expect model.dof == 1",
     .see = "print check"},
    {.name = NULL},
};

/* test_model_wrong.c: every wrong statement is refused with its message, at its place, and
 * leaves the model as it was */
#include "test_model.h"

static const char base[] =
    "scene planar\nL = 0.2; k1 = 3; k2 = 2*k1\nf(x) = k1*x\ng(t) = f(t)\n"
    "body m1 mass=1 inertia=0.1\nbody m2 mass=1 inertia=0.1\narm r1 m1 [L, 0]\narm r2 m2 [-L, 0]\n"
    "revolute h1 ground m1 coord=phi\nrevolute h2 r1 r2\nplanarjoint P ground m2\n"
    "virtual prismatic v m1 m2 axis=x\nweld w r1 m2\nspring s h1 k=2\nforce F m1 [1, 0]\n"
    "vsource E a 0 g(t)\nresistor R a b 1\ncapacitor C b 0 1 uF\nmotor M h1 b 0 R=1 Kt=1\n"
    "driver D h2 = t\noutput p = h1\ntree h1 h2\ninit phi = 1\n";

typedef struct Wrong {
    const char *text;
    int column;
    const char *message; /* a part of it */
    const char *hint;    /* a part of it; "" none */
} Wrong;

/* clang-format off */
static const Wrong wrong[] = {
    /* names */
    {"body h1 mass=1",               6, "'h1' is already a revolute", "delete h1 first"},
    {"body phi mass=1",              6, "'phi' is already a coordinate of h1", ""},
    {"revolute k1 m1 m2",           10, "'k1' is already a parameter", "take another name"},
    {"body f mass=1",                6, "'f' is already a law", ""},
    {"body a mass=1",                6, "'a' is already a terminal", ""},
    {"revolute h3 m1 m2 coord=h2",  25, "'h2' is already a revolute", ""},
    {"revolute h3 m1 m2 coord=t",   25, "'t' has a meaning of its own", ""},
    {"revolute h3 m1 m2 coord=run3", 25, "'run3' has a meaning of its own", ""},
    {"revolute h3 m1 m2 coord=a",   25, "'a' is already a terminal", ""},
    {"revolute h3 m1 m2 coord=2",   25, "a new name is expected", ""},
    {"h1 = 3",                       1, "'h1' is already a revolute", ""},
    {"p = 3",                        1, "'p' is already an output", "delete p"},
    {"k1(x) = x",                    1, "'k1' is already a parameter", ""},
    {"a(x) = x",                     1, "'a' is already a terminal", ""},
    {"output k1 = h1",               8, "'k1' is already a parameter", ""},
    {"output m1.x = h1",             8, "no dot", ""},
    {"planarjoint Q m1 m2 coords=[c1, c2, c1]", 37, "'c1' is named twice", ""},
    {"planarjoint Q m1 m2 coords=[Q, b1, c1]", 29, "'Q' is the name of the joint", ""},
    {"planarjoint Q m1 m2 coords=[b1, c1]", 28, "planarjoint has 3 coordinates, 2 named", "coords="},
    {"revolute h3 m1 m2 coord=c1 coords=[c2]", 28, "'revolute' has no key 'coords'", "coord"},
    /* frames and places */
    {"revolute h3 m1 r22",          16, "unknown frame 'r22'", "did you mean 'r2'?"},
    {"revolute h3 m1 h2",           16, "h2 is a revolute, not a frame", ""},
    {"revolute h3 m1 k1",           16, "k1 is a parameter, not a frame", ""},
    {"revolute h3 m1 m1",           16, "both ends of h3 are m1", ""},
    {"arm q nowhere [1, 0]",         7, "unknown frame 'nowhere'", "frames are ground"},
    {"force G ground [1, 0]",        9, "ground doesn't move", ""},
    {"spring q m1.x k=1",           10, "spring acts on a joint, and m1 is none", ""},
    {"spring q h9 k=1",             10, "unknown name 'h9'", "did you mean 'h1'?"},
    {"resistor Q ground b 1",       12, "ground is the mechanical reference frame", "0 or gnd"},
    {"resistor Q m1 b 1",           12, "'m1' is a body, not a terminal", ""},
    {"resistor Q Q b 1",            12, "'Q' is the name of this resistor", ""},
    {"resistor Q b b 1",            14, "both ends of Q are b", ""},
    {"resistor Q model b 1",        12, "'model' has a meaning of its own", ""},
    {"resistor Q m1.x b 1",         12, "a terminal is expected", ""},
    {"motor N P a 0 R=1 Kt=1",       9, "P is no variable: P has several", "P.s1, P.s2, P.theta"},
    {"driver Q h2 = t",             10, "h2 is already driven by D", ""},
    {"driver Q h1' = t",            10, "prescribes the coordinate itself", "integrate"},
    {"driver Q h1.fx = t",          10, "h1.fx is no coordinate", "coordinates are those"},
    {"driver Q h1 = phi",           15, "a prescribed motion can't depend on phi", "only t"},
    {"driver Q h1 = t by=R",        20, "R is a resistor, not a source", "vsource or isource"},
    {"driver Q h1 = t by=2",        20, "by= names a coordinate or a source", ""},
    {"driver Q h1 = t by=h99",      20, "unknown name 'h99'", ""},
    {"driver Q h1 = t speed=2",     17, "a driver takes one coordinate, and by=", "supplies"},
    {"driver Q h1 = 1 kg",          17, "rad expected for value, got kg", ""},
    {"virtual body q mass=1",        9, "'body' can't be virtual", "only joints"},
    /* values and keys */
    {"body q",                       7, "body q needs mass=", "mass: mass"},
    {"body q mass'=1",               8, "a key has no primes", ""},
    {"body q mas=1",                 8, "'body' has no key 'mas'", "did you mean 'mass'?"},
    {"body q mass=2 s",             15, "kg expected for mass, got s", "taken as SI"},
    {"body q mass=-1",               13, "the mass of q is negative", ""},
    {"body q mass=1 inertia=-1",     23, "a moment of inertia of q is negative", ""},
    {"body q mass=1 inertia=[1, 2, 3]", 23, "one number is expected here, not a vector", "one number, about z"},
    {"body q mass=t",               13, "this value can't depend on t", "numbers and parameters"},
    {"body q mass=m1.x",            13, "this value can't depend on m1.x", ""},
    {"body q mass=q.x",             13, "this value can't depend on q.x", ""},
    {"body q mass=g",               13, "g is a law", "g(t)"},
    {"body q mass=1/0",             14, "division by zero", ""},
    {"arm q m1 [1, 2, 3]",          10, "position leaves the plane", "[x, y]"},
    {"arm q m1 [1]",                10, "position has 2 components, not 1", ""},
    {"arm q m1 3",                  10, "a vector is expected here", ""},
    {"arm q m1 [1 s, 0]",           13, "m expected for position, got s", ""},
    {"arm q m1 [1, 0] [kg]",        17, "m expected for position, got [kg]", ""},
    {"arm q m1 [1, 0] position=[1, 0]", 17, "position is given twice", ""},
    {"arm q m1 [1, 0] rotation=x(1)", 26, "a turn about x leaves the plane", "about z"},
    {"arm q m1 [1, 0] rotation=k1", 26, "a rotation is a product of turns", "z(90 deg)"},
    {"arm q m1 [1, 0] rotation=z(1 kg)", 30, "rad expected for an angle, got kg", ""},
    {"prismatic q m1 m2",            1, "prismatic q leaves the plane", "axis=x"},
    {"revolute q m1 m2 axis=x",     23, "revolute q leaves the plane", "turns about z"},
    {"prismatic q m1 m2 axis=[0, 0]", 24, "axis is zero", ""},
    {"prismatic q m1 m2 axis=w",    24, "a vector is expected here", "an axis is x, y, z"},
    {"prismatic q m1 m2 axis=[1, 2, 3, 4]", 24, "axis has 3 components, not 4", ""},
    {"prismatic q m1 m2 length=2",  19, "'prismatic' has no key 'length'", "axis coord"},
    {"force G m1 [1, 0] in=world",  22, "in= is one of ground|body", ""},
    {"torque G m1 [1, 0, 0]",       13, "one number is expected", "about z"},
    {"force G m1 3",                12, "a vector is expected here", ""},
    {"spring q m1 m2 k=1 rest=2",    25, "rest= is for a spring on a joint", "length="},
    {"spring q h1 k=1 length=2",     24, "length= is for a spring between two frames", "rest="},
    {"spring q h1 k=1 N",           17, "N*m expected for k, got N", ""},
    {"spring q h1 k=1 [N/m]",       17, "N*m expected for k, got [N/m]", ""},
    {"spring q m1 m2 k=1 [N*m]",    20, "N/m expected for k, got [N*m]", ""},
    {"actuator q h1 force=2",        21, "force= does not fit: q acts on an angle", "torque="},
    {"actuator q m1 m2 torque=2",    25, "torque= does not fit: q acts on the line", "force="},
    {"actuator q v torque=2",        21, "torque= does not fit: q acts on a length", "force="},
    {"actuator q h1",                1, "q needs torque=", "2*sin(t)"},
    {"resistor Q a b 0",             16, "R of Q is zero", "a wire"},
    {"capacitor Q a b -1",           17, "C of Q is negative", "positive"},
    {"inductor Q a b 0",             16, "L of Q is zero", ""},
    {"resistor Q a b",              15, "resistor Q needs R", "resistance"},
    {"resistor Q a b 1 V",          18, "ohm expected for R, got V", ""},
    {"motor N h1 a 0 R=1",           1, "motor N needs Kt= or Kv=", ""},
    {"motor N h1 a 0 R=-1 Kt=1",     18, "R of N is negative", ""},
    {"motor N h1 a 0 R=1 Kt=1 ratio=0", 31, "the gear ratio of N is zero", ""},
    /* expressions */
    {"k3 = h1",                      6, "a parameter can't depend on h1", "output NAME"},
    {"k3 = t",                       6, "a parameter can't depend on t", "f(t) = ..."},
    {"k3 = k9",                      6, "unknown name 'k9'", "did you mean 'k1'?"},
    {"k3 = p",                       6, "a parameter can't depend on p", "output"},
    {"k1 = k2",                      1, "k1 would depend on itself: k1, k2, k1", ""},
    {"k1 = k1 + 1",                  1, "k1 would depend on itself", ""},
    {"k3 = sqrt(-1)",                6, "k3 has no finite value", ""},
    {"k3 = [1, 2]",                  6, "not a vector", ""},
    {"k3 = sin(1, 2)",               6, "sin takes 1 argument, got 2", ""},
    {"k3 = max(1)",                  6, "max of one argument is taken over a run", ""},
    {"k3 = sni(1)",                  6, "unknown function 'sni'", "did you mean 'sin'?"},
    {"k3 = k1(2)",                   6, "k1 is no law and no function", "k1*(...)"},
    {"k3 = h1(2)",                   6, "h1 is a revolute, not a law", "h1*(...)"},
    {"k3 = f(1, 2)",                 6, "f takes 1 argument, got 2", ""},
    {"k3 = k1'",                     6, "k1 is a parameter: it has no derivative", ""},
    {"k3 = pi'",                     6, "pi is a number", ""},
    {"k3 = table(\"x.csv\", 1)",    12, "can't read 'x.csv'", "the folder of the script"},
    {"k3 = pulse(1, 2)",             6, "pulse does not take 2 arguments", "pulse(t, low"},
    {"k3 = pulse(1, 0, 1, -1, 0, 0, 1)", 21, "times of a pulse aren't negative", ""},
    {"k3 = pulse(1, 0, 1, 1, 0, 0, 1, 0)", 33, "the period is zero", ""},
    {"k3 = pwl(1, 0, 1, 2)",         6, "pwl does not take 4 arguments", ""},
    {"k3 = pwl(1, 5, 1, 4, 2)",     19, "the times of pwl have to grow", ""},
    {"k3 = mass(1, 2)",              6, "mass can be printed, but nothing can depend on it", ""},
    {"k3 = \"x\"",                   6, "not a text", ""},
    {"q(x) = x*t",                  10, "a law can't depend on t", "argument"},
    {"q(x) = x + h1",               12, "a law can't depend on h1", ""},
    {"q(x) = x'",                    8, "x is an argument: it has no derivative", ""},
    {"q(x) = sin(x)'",               8, "the rate of x isn't known here", ""},
    {"f(x) = g(x)",                  1, "f would depend on itself: f, g, f", ""},
    {"f(x, y) = x + y",              1, "what uses f would fail: f takes 2 arguments, got 1", ""},
    {"vsource Q a 0 model.n",       15, "model.n can be printed, but nothing can depend on it", ""},
    {"vsource Q a 0 run1.h1",       15, "run1.h1 is of a run", ""},
    {"vsource Q a 0 m1",            15, "m1 is no variable: m1 has several", "m1.x, m1.y, m1.theta"},
    {"vsource Q a 0 w",             15, "w is no variable", "w.fx"},
    {"vsource Q a 0 h1'''",         15, "h1 has no derivative of order 3", "h1''"},
    {"vsource Q a 0 h1.fx'",        15, "h1.fx has no derivative of order 1", "without primes"},
    {"vsource Q a 0 t'",            15, "t is time itself", ""},
    {"vsource Q a 0 b",             15, "b is a terminal", "b.v"},
    {"vsource Q a 0 b.i",           15, "terminal b has no variable 'i'", "b.v"},
    {"vsource Q a 0 h1.fq",         15, "revolute h1 has no variable 'fq'", "did you mean 'h1.fx'?"},
    {"vsource Q a 0 F.effort",      15, "force F has no variable 'effort'", ""},
    {"vsource Q a 0 energy.totla",  15, "unknown variable 'energy.totla'", "did you mean 'energy.total'?"},
    {"vsource Q a 0 linear.x",      15, "unknown variable 'linear.x'", "such as"},
    {"output q = lambda(1, 2)",     12, "lambda takes 1 number, got 2", ""},
    {"output q = lambda(0)",        19, "picked by whole numbers from 1", ""},
    {"output q = mean(h1)",         12, "mean of one argument is taken over a run", ""},
    {"output p = p + 1",             8, "p would depend on itself", ""},
    {"output q = (h1)'''''",        12, "a derivative of order 5 is too high", ""},
    {"output q = run1.h1",          12, "run1.h1 is of a run", ""},
    {"output q = lambda(1)'",       12, "the rate of lambda(1) isn't known here", ""},
    {"arm q m1 [1, 0]*[1, 0]",      16, "'*' is not between two vectors", ""},
    {"arm q m1 [1, 0] + [1, 0, 0]", 17, "vectors of 2 and 3 entries", ""},
    {"arm q m1 1/[1, 0]",           11, "'/' is not between a vector and a number", ""},
    {"arm q m1 [1,2,3,4,5,6,7,8,9,10]", 10, "position has 2 components, not 10", ""},
    {"arm q m1 ([1, 0])'",          10, "can't be done with a vector", ""},
    /* scene, starts, form */
    {"scene spatial",                7, "the scene can't become spatial any more", "before the first part"},
    {"gravity [0, 0, -9.81]",        9, "gravity leaves the plane", ""},
    {"gravity 9.81",                 9, "a vector is expected here", ""},
    {"gravity [0, -9.81] [m/s]",    20, "m/s^2 expected for gravity, got [m/s]", ""},
    {"init h1.fx = 1",               6, "h1.fx can't be given", "positions, rates"},
    {"init h1'' = 1",                6, "h1'' can't be given", ""},
    {"init h9 = 1",                  6, "unknown name 'h9'", "did you mean"},
    {"init p = 1",                   6, "p is an output, no variable", ""},
    {"init h1 = 1 m",               13, "rad expected for h1, got m", ""},
    {"init h1' = 1 rad",            14, "rad/s expected for h1, got rad", ""},
    {"init C.v = 1 A",              14, "V expected for C.v, got A", ""},
    {"init b.v = 1 A",              14, "V expected for b.v, got A", ""},
    {"init h1 = h2",                11, "an initial value can't depend on h2", ""},
    {"form augmented independent=[h1]", 16, "no independent coordinates", "form embedded"},
    {"form embedded independent=[2]", 28, "independent= names coordinates", ""},
    {"form embedded independent=[h9]", 28, "unknown name 'h9'", ""},
    /* trees */
    {"tree h1 h9",                   9, "unknown edge 'h9'", "did you mean 'h1'?"},
    {"tree h1 P.s1",                 9, "unknown edge 'P.s1'", ""},
    {"tree h1 h2 h1",               12, "h1 is named twice", ""},
    {"tree h1 F",                    9, "edge F has no across relation", "only bodies"},
    {"tree translation E",          18, "E has no edge in the translation graph", ""},
    {"tree rotation v",             15, "v has no freedom there", ""},
    {"tree h1 P w",                  6, "circuit", ""},
    {"tree + m1 - r1",              -1, "arm r1 can't be a chord", "weld"},
    {"tree joint h1",               12, "'joint' stands alone", ""},
    {"tree rotation best",          15, "searches both mechanical trees", "tree best"},
    {"tree rotation",                1, "no edge is named", ""},
    {"cotree r1",                    8, "arm r1 can't be a chord", ""},
    {"cotree E R C M",               8, "nodes a, b cannot be reached from 0", "to the tree"},
    /* set and delete */
    {"set m9.mass = 1",              5, "unknown part 'm9'", "did you mean 'm1'?"},
    {"set m1.mas = 1",               5, "'body' has no key 'mas'", "did you mean 'mass'?"},
    {"set m1 = 1",                   5, "'set' changes a key of a part", "set NAME.KEY"},
    {"set m1.mass = -1",             15, "the mass of m1 is negative", ""},
    {"set m1.mass = 3, m2.mass = -1", 28, "negative", ""},
    {"set h1.axis = x",             15, "revolute h1 leaves the plane", ""},
    {"set D.value = h1",            15, "a prescribed motion can't depend on h1", ""},
    {"delete m9",                    8, "unknown name 'm9'", "did you mean 'm1'?"},
    {"delete b",                     8, "b is a terminal", "last component"},
    {"delete phi",                   8, "phi is a coordinate of h1", "delete h1"},
    {"delete m1",                    8, "m1 is used by r1, h1, h2, v, w, s and 4 more", "first"},
    {"delete h1",                    8, "h1 is used by s, M, p", ""},
    {"delete k1",                    8, "k1 is used by k2, f, g, E", ""},
    {"delete f",                     8, "f is used by g, E", ""},
};
/* clang-format on */

static void check_wrong(Model *model, const Wrong *w, const char *saved, const char *graph)
{
    Diag diag = {0};
    uint64_t revision = model_revision(model);
    Status status = apply_text(model, w->text, &diag);
    char *after = model_save(model);
    char *graph_after = graph_text(model);
    bool told = status != OK && strstr(diag.message, w->message) != NULL &&
                strstr(diag.hint, w->hint) != NULL &&
                (w->column < 0 || diag.place.column == w->column) && diag.place.line == 1;

    if (!told) {
        test_faults++;
        printf("%s\n    got %d:%d: %s (%s)\n    wanted %d: %s (%s)\n", w->text, diag.place.line,
               diag.place.column, diag.message, diag.hint, w->column, w->message, w->hint);
    }
    if (strcmp(after, saved) != 0 || strcmp(graph_after, graph) != 0 ||
        model_revision(model) != revision) {
        test_faults++;
        printf("%s: has changed the model\n", w->text);
    }
    if (status == OK)
        EXPECT(model_undo(model, NULL) == OK);
    EXPECT_TEXT(model_remarks(model), "");
    mem_free(after);
    mem_free(graph_after);
}

static void wrong_statements_say_why_and_change_nothing(void)
{
    Model *model = model_of(base);
    char *saved = model_save(model);
    char *graph = graph_text(model);

    for (int i = 0; i < COUNT(wrong); i++)
        check_wrong(model, &wrong[i], saved, graph);
    mem_free(saved);
    mem_free(graph);
    model_free(model);
}

static void spatial_scenes_have_mistakes_of_their_own(void)
{
    static const Wrong spatial[] = {
        {"gravity [0, -9.81]", 9, "gravity has 3 components, not 2", "scene planar"},
        {"body q mass=1 inertia=2", 23, "a vector is expected", "[Ixx, Iyy, Izz]"},
        {"body q mass=1 inertia=[1, 2]", 23, "inertia has 3 or 6 entries, not 2", "Ixy"},
        {"body q mass=1 inertia=[1, -1, 1]", 23, "moment of inertia of q is negative: -1 about y",
         "zero or positive"},
        {"body q mass=1 inertia=[1, 1, 1, 2, 0, 0]", 23, "no body has the inertia of q", "tensor"},
        {"body q mass=-mu inertia=[1, 1, 1]", 13, "the mass of q is negative: -3", "positive"},
        {"mu = -1", 6, "mu = -1 is refused: the mass of m is negative: -0.5", "positive"},
        {"nu = -mu", 6, "nu = -3 is refused: a moment of inertia of m is negative: -3 about x", ""},
        {"f(x) = x - 9", 1, "what uses f would fail: the mass of m2 is negative: -6", "positive"},
        {"set m.mass = mu - 4", 14, "the mass of m is negative: -1", "positive"},
        {"mu = 0", 6, "mass of w has no finite value", ""},
        {"driver Q m.q1 = t", 10, "m.q1 is an Euler parameter", ""},
        {"scene planar", 7, "the scene can't become planar any more", ""},
        {"torque T m 3", 12, "a vector is expected", ""},
    };
    Model *model = model_of("mu = 3\nnu = 2\nhalf = mu/2\nf(x) = x\n"
                            "body m mass=half inertia=[nu, nu, nu]\nbody m2 mass=f(mu)\n"
                            "body w mass=1/mu\n");
    char *saved = model_save(model);
    char *graph = graph_text(model);

    for (int i = 0; i < COUNT(spatial); i++)
        check_wrong(model, &spatial[i], saved, graph);
    mem_free(saved);
    mem_free(graph);
    model_free(model);
}

/* massless links and rods are bodies; what no rigid body has is told and taken */
static void zero_and_unlikely_inertia_is_taken(void)
{
    Model *model = model_of("mu = 1\nbody m mass=mu inertia=[mu, mu, 0]\n");
    Diag diag = {0};

    EXPECT(apply_text(model, "mu = 0", &diag) == OK);
    EXPECT_TEXT(model_remarks(model), "");
    EXPECT(apply_text(model, "body n mass=0 inertia=[0, mu, mu]", &diag) == OK);
    EXPECT(apply_text(model, "body rod mass=1 inertia=[0.5, 0.5, 1, 0.5, 0, 0]", &diag) == OK);
    EXPECT_TEXT(model_remarks(model), "");
    EXPECT(apply_text(model, "body q mass=1 inertia=[1, 1, 9]", &diag) == OK);
    EXPECT(strstr(model_remarks(model), "no rigid body has the inertia of q") != NULL);
    EXPECT(apply_text(model, "set n.inertia = [1, 1, 2 + mu]", &diag) == OK);
    EXPECT_TEXT(model_remarks(model), "");
    EXPECT(apply_text(model, "mu = 1", &diag) == OK);
    EXPECT(strstr(model_remarks(model), "no rigid body has the inertia of n") != NULL);
    model_free(model);
}

static void an_empty_model_refuses_too(void)
{
    Model *model = model_of("gravity [0, 0, -9.81]");
    Diag diag = {0};

    EXPECT(apply_text(model, "scene planar", &diag) == E_VALUE);
    EXPECT(strstr(diag.message, "gravity leaves the plane") != NULL);
    EXPECT(model_undo(model, &diag) == OK);
    EXPECT(model_undo(model, &diag) == E_MISSING);
    EXPECT_TEXT(diag.message, "there is nothing to undo");
    EXPECT(model_redo(model, &diag) == OK);
    EXPECT(model_redo(model, &diag) == E_MISSING);
    EXPECT_TEXT(diag.message, "there is nothing to redo");
    model_free(model);
}

static void a_scene_that_what_was_said_forbids_is_refused(void)
{
    Model *model = model_of("scene planar\ngravity [0, -9.81]\nscene planar");
    Diag diag = {0};
    char *saved;

    EXPECT(apply_text(model, "scene spatial", &diag) == E_VALUE);
    EXPECT(strstr(diag.message, "can't become spatial any more: gravity has 3") != NULL);
    saved = model_save(model);
    EXPECT_TEXT(saved, "scene planar\ngravity [0, -9.81]\n");
    mem_free(saved);
    EXPECT(apply_text(model, "gravity [0, -9.81, 0]\nscene spatial", &diag) == OK);
    EXPECT(!model_is_planar(model));
    model_free(model);
}

static void a_tree_that_the_graph_outgrew_is_refused_later(void)
{
    Model *model = model_of("scene planar\nbody m1 mass=1\nbody m2 mass=1\nresistor R a b 1\n");
    const Tree *trees[TREE_KINDS];
    Diag diag = {0};

    EXPECT(model_trees(model, trees, &diag) == E_UNREACHED);
    EXPECT(apply_text(model, "tree electrical R", &diag) == OK);
    EXPECT(strstr(model_remarks(model), "when the graph hangs together") != NULL);
    EXPECT(apply_text(model, "resistor Q b 0 1", &diag) == OK);
    EXPECT(model_trees(model, trees, &diag) == OK);
    model_free(model);
}

/* of several equations in one line, the first were kept when a later one was refused */
static void a_wrong_line_of_a_definition_leaves_its_equations(void)
{
    static const char *const refused[] = {"give B.x = s, B.Ron = 0", "unknown q, s", "unknown s, B",
                                          "give B.x = s, B.x = 2*s", "body m mass=1"};
    Model *model = model_of("scene planar\n");
    Model *direct = model_of("scene planar\nsubsystem slide frames=[B]\nunknown s\n"
                             "internal 2*s'' + B.fx\ngive B.x = s, B.y = 0, B.theta = 0\nend\n");
    Diag diag = {0};
    char *wanted = model_save(direct), *saved;

    EXPECT(apply_text(model, "subsystem slide frames=[B]\nbody", &diag) != OK);
    EXPECT(apply_text(model, "body m mass=[1, 2]", &diag) != OK);
    EXPECT(apply_text(model, "unknown s\ninternal 2*s'' + B.fx", &diag) == OK);
    for (int i = 0; i < COUNT(refused); i++)
        EXPECT(apply_text(model, refused[i], &diag) != OK);
    EXPECT(apply_text(model, "give B.x = s, B.y = 0, B.theta = 0\nend", &diag) == OK);
    saved = model_save(model);
    EXPECT_TEXT(saved, wanted);
    mem_free(saved);
    mem_free(wanted);
    model_free(direct);
    model_free(model);
}

int main(void)
{
    RUN(wrong_statements_say_why_and_change_nothing);
    RUN(spatial_scenes_have_mistakes_of_their_own);
    RUN(zero_and_unlikely_inertia_is_taken);
    RUN(an_empty_model_refuses_too);
    RUN(a_scene_that_what_was_said_forbids_is_refused);
    RUN(a_tree_that_the_graph_outgrew_is_refused_later);
    RUN(a_wrong_line_of_a_definition_leaves_its_equations);
    return test_end();
}

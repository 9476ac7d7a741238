/* help_topics.c: help on what is neither a verb nor a component */
#include "present/help.h"

#include "language/functions.h"
#include "present/show.h"
#include "simulate/run/run.h"

#include <string.h>

enum { TOPIC_WIDTH = 78 };

static void write_units(Text *out)
{
    Table table = table_for("lll");
    const char *name;

    layout_words(out, TOPIC_WIDTH, "",
                 "A unit may directly follow a number or vector (5 mm, 30 deg, 10 kohm, 60 "
                 "rpm), with or without an SI prefix. A compound unit needs brackets (1 [kN/m], "
                 "[0, -9.81] [m/s^2]). Values are stored in SI; a plain number is taken as SI. "
                 "In a list of plot, print, table and export, brackets after an item select its "
                 "unit: print h8 [deg].");
    text_char(out, '\n');
    for (int i = 0; (name = unit_name(i)) != NULL; i++) {
        Text dimension = {0}, factor = {0};
        Unit unit;

        if (!unit_find(name, &unit))
            continue;
        dimension_print(&dimension, unit.dimension);
        text_number(&factor, unit.factor, 10);
        table_cells(&table, "%s\t= %s\t%s", name, factor.at,
                    dimension.at != NULL ? dimension.at : "");
        text_free(&dimension);
        text_free(&factor);
    }
    table_finish(out, &table, 2);
}

static void write_functions(Text *out)
{
    static const char *const letters = "xyz";
    Function row;
    Text names = {0};

    for (int i = 0; function_at(i, &row); i++) {
        if (row.kind != FUNCTION_OPERATION)
            continue;
        text_addf(&names, "%s%s(", names.length > 0 ? " " : "", row.name);
        for (int k = 0; k < row.least; k++)
            text_addf(&names, "%s%c", k > 0 ? "," : "", letters[k]);
        text_char(&names, ')');
    }
    layout_words(out, TOPIC_WIDTH, "  ", names.at);
    text_free(&names);
    text_char(out, '\n');
    layout_words(
        out, TOPIC_WIDTH, "",
        "Angles are in radians. stick(x, r) is the sign of x; while a run holds x at 0 it is "
        "between -r and r, as static friction is. direction(v, n, r) is the component v of a "
        "vector "
        "over its norm n; while a run holds the vector at rest it is one of a vector whose norm is "
        "up to r; its norm is best written hypot(x, y). unilateral(x, e) is the effort that holds "
        "x at 0 "
        "or below, with impacts of the coefficient of restitution e. coulomb(v, n, b) is the "
        "friction b*v/abs(n), with n = v or the norm of a vector with the component v; while a run "
        "holds n at 0 it is an effort of up to b. step(x) is 0 for x < 0 and 1 "
        "otherwise, ramp(x) "
        "is x*step(x), "
        "and if(c, a, b) is a if c holds and b otherwise. unwrap(y, x, a) is the angle atan2(y, "
        "x) plus the full turns that bring it nearest to a. Functions of time: pulse(t, low, "
        "high, delay, rise, fall, width, period), pwl(t, t0, v0, t1, v1, ...).\n"
        "table(\"file.csv\", x, column) is a smooth curve through the data of a file. The first "
        "column is x. The third argument selects another column, by its number or its name in "
        "quotes; the default is the second. A head such as h [deg] sets the unit of its column. "
        "Outside the data the value is that of the nearest end. A number after the column "
        "selects that derivative with respect to x.\n"
        "Functions of the last run, of the continuous motion and not of its rows: min(x) max(x) "
        "mean(x) rms(x) final(x) period(x), settling(x, band), first(condition); 'keep' defines "
        "parameters with them. d(x)/d(L) is the derivative of x by a parameter ('help "
        "sensitivities'). "
        "spectrum(x) is for 'plot' and 'table'. Entries of the equations: "
        "mass(1,2), forces(1), lambda(1). Operators: + - * / ^, < <= > >= == != && || !. A "
        "prime is a time derivative (h8', h8'').");
}

static void write_pairs(Text *out, const char *const (*rows)[2], int count)
{
    Table table = table_for("ll");

    for (int i = 0; i < count; i++)
        table_cells(&table, "%s\t%s", rows[i][0], rows[i][1]);
    table_wrap(out, &table, 2, TOPIC_WIDTH);
    table_free(&table);
}

static void write_methods(Text *out)
{
    Table table = table_for("ll");
    const char *name, *brief;

    layout_words(out, TOPIC_WIDTH, "", "simulate 10 method=WORD takes one of these:");
    for (int i = 0; (name = run_method(i, &brief)) != NULL; i++)
        table_cells(&table, "%s\t%s", name, brief);
    table_wrap(out, &table, 2, TOPIC_WIDTH);
    table_free(&table);
}

static void write_notations(Text *out)
{
    Table table = table_for("ll");

    layout_words(out, TOPIC_WIDTH, "", "show mass as WORD takes one of these:");
    for (Notation i = NOTATION_TEXT; i < NOTATIONS; i++)
        if (notation_row(i)->word != NULL)
            table_cells(&table, "%s\t%s", notation_row(i)->word, notation_row(i)->brief);
    table_wrap(out, &table, 2, TOPIC_WIDTH);
    table_free(&table);
}

static void write_formats(Text *out)
{
    static const char *const rows[][2] = {
#define FORMAT(word, brief) {#word, brief},
#include "language/formats.def"
    };

    layout_words(out, TOPIC_WIDTH, "", "export WORD takes one of these:");
    write_pairs(out, rows, COUNT(rows));
}

static void write_imports(Text *out)
{
    static const char *const rows[][2] = {
#define IMPORTER(word, brief) {#word, brief},
#include "language/importers.def"
#undef IMPORTER
    };

    layout_words(out, TOPIC_WIDTH, "", "import WORD \"FILE\" takes one of these:");
    write_pairs(out, rows, COUNT(rows));
}

static void write_sensitivities(Text *out)
{
    layout_words(
        out, TOPIC_WIDTH, "",
        "d(h)/d(L) is the derivative of h along the last run by the parameter L, in 'print', "
        "'plot', 'table', 'export csv', 'expect', 'keep=' and figures, such as max(d(h)/d(L)): how "
        "far h(t) would move if L had another value from the start on. h is any variable or an "
        "expression of variables; initial values and values of parts are parameters by a name.\n"
        "The run is integrated once more with its variational equations, S' = f_y S + f_p, under "
        "its tolerances, whose derivatives are exact. At an instant that depends on L, where a "
        "source, a switch, a diode or a condition of the equations switches, S jumps. Constraints "
        "hold for S, too; in 'kinematics' they alone determine it.\n"
        "The new values of events and friction that sticks are followed, too. There are no "
        "sensitivities of 'inverse', of sampled states (period=), after impacts of stops, after "
        "what "
        "sticks in several directions begins to slip, and where ideal switches change the number "
        "of "
        "states. Each is refused with its instant.\n"
        "  L = 0.5 m; A = 0.1; scene planar; gravity [0, -9.81]\n"
        "  body b mass=1; arm p b [0, L]; revolute h ground p; init h = A\n"
        "  simulate 2; print d(h)/d(L) at 1, d(h')/d(A); plot d(h)/d(L)");
}

static void write_counting(Text *out)
{
    layout_words(
        out, TOPIC_WIDTH, "",
        "A sum of n terms is n-1 additions, a product of n factors n-1 multiplications. x^k "
        "with an integer k > 1 is k-1 multiplications. Each call of a function counts as one "
        "function, and so does a power with another exponent. A coefficient other than 1 and -1 "
        "is a factor. Negation is free, a division counts as a multiplication. Operations in "
        "the arguments of functions count. Both triangles of symmetric matrices count. The "
        "first three figures are those of the entries as 'show' writes them, without sharing. "
        "The others are those of the program that a run evaluates. It computes each common "
        "subexpression once, also if it is only a part of several sums or products. It computes "
        "the sine or cosine of a sum of angles from those of the parts if a block needs these "
        "anyway.");
}

static void write_variables(Text *out)
{
    /* clang-format off */
    static const char *const rows[][2] = {
        {"h8  h8'  h8''", "a joint's coordinate, its speed and acceleration"},
        {"m1.x  r5.vy", "motion of a body or frame, in the axes of ground"},
        {"h9.fx  h9.tz", "force and moment of a joint on its tip; capitals: axes of its tail"},
        {"R1.v  R1.i  M7.torque", "of circuits and transducers; a.v is a terminal's potential"},
        {"energy.kinetic  .potential  .total", "of the whole model, J"},
        {"f1.lost  energy.lost", "lost in dry friction since the run began, J; f1.loss: power"},
        {"constraint.error", "largest constraint residual"},
        {"model.n  model.m  model.dof", "coordinates, constraints, degrees of freedom"},
        {"count.mass.add  .mul  .fun", "operations of a block; count.shared.mass.add after sharing"},
        {"mass(1,2)  forces(1)  lambda(1)", "entries of the equations, multipliers"},
        {"run2.h8", "a variable of an earlier run"},
        {"min(h8)  max  mean  rms", "over the last run"},
    };
    /* clang-format on */

    write_pairs(out, rows, COUNT(rows));
    text_char(out, '\n');
    layout_words(out, TOPIC_WIDTH, "",
                 "A bare name refers to the last run. 'at T' selects an instant of it. Without "
                 "'at', the value is that at its end or, if an initial value or the model "
                 "changed later, that at the assembled start. 'info NAME' lists the members of "
                 "a component.");
}

static void write_topics(Text *out)
{
    Table table = table_for("ll");

    text_add(out, "Topics:\n");
    for (int i = 0; topic_at(i) != NULL; i++)
        if (topic_at(i)->show != NULL)
            table_cells(&table, "%s\t%s", topic_at(i)->name, topic_at(i)->brief);
    table_finish(out, &table, 2);
}

static void write_keys(Text *out)
{
    /* clang-format off */
    static const char *const rows[][2] = {
        {"Tab", "complete the word; twice: list what fits"},
        {"Ctrl-C", "leave the line, or stop a computation and keep its results so far"},
        {"Ctrl-D", "exit, on an empty line"},
        {"Ctrl-R", "search the history"},
        {"Up, Down", "earlier and later lines"},
    };
    /* clang-format on */

    write_pairs(out, rows, COUNT(rows));
}

static void write_language(Text *out)
{
    layout_words(
        out, TOPIC_WIDTH, "",
        "One statement per line; ';' separates statements, '#' starts a comment, '\\' at the "
        "end continues a line. KEYWORD NAME PLACE... VALUE key=value... adds a component; other "
        "keywords query or compute. NAME = expr defines a parameter, f(x) = expr a law. > "
        "\"file\" after a statement that prints writes to the file, >> appends. Keywords may be "
        "shortened at the prompt, never in a script. Names are case-sensitive.");
}

/* clang-format off */
static const HelpTopic topics[] = {
    {"language", "the syntax of statements",                 write_language,  NULL},
    {"units", "units of numbers, and their syntax", write_units,     NULL},
    {"functions", "functions and operators of expressions",     write_functions, NULL},
    {"variables", "what can be printed, plotted and expected",  write_variables, NULL},
    {"topics", "the topics of show",                         write_topics,    NULL},
    {"methods",   "integration methods of simulate",            write_methods,   "simulate"},
    {"notations", "notations of show",                          write_notations, "show"},
    {"formats", "the formats of export",                         write_formats,   "export"},
    {"imports", "the formats of import",                          write_imports,   "import"},
    {"sensitivities", "derivatives of a run by parameters, d(h)/d(L)", write_sensitivities, "print"},
    {"counting",  "the rule by which operations are counted",   write_counting,  "count"},
    {"keys",      "keys at the prompt",                         write_keys,      NULL},
};
/* clang-format on */

const HelpTopic *help_topic_at(int i)
{
    return i >= 0 && i < COUNT(topics) ? &topics[i] : NULL;
}

const HelpTopic *help_topic_find(const char *name)
{
    for (int i = 0; i < COUNT(topics); i++)
        if (strcmp(topics[i].name, name) == 0)
            return &topics[i];
    return NULL;
}

/* what a model has as a whole, and its members; those of count are its blocks */
static const struct {
    const char *base;
    const char *members[6];
} wholes[] = {
    {"energy", {"kinetic", "potential", "total", "loss", "lost", NULL}},
    {"model", {"n", "m", "dof", NULL}},
    {"constraint", {"error", NULL}},
    {"count", {NULL}},
    {"modes", {"omega(", "damping(", NULL}},
    {"linear", {"A(", "B(", "C(", "D(", NULL}},
};

const char *whole_name(int i)
{
    return i >= 0 && i < COUNT(wholes) ? wholes[i].base : NULL;
}

const char *whole_member(int i, int k)
{
    return wholes[i].members[k];
}

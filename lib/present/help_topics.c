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
                 "One unit may stand directly behind a number or vector (5 mm, 30 deg, 10 kohm, "
                 "60 rpm), with an SI prefix or without; a compound one stands in brackets (1 "
                 "[kN/m], [0, -9.81] [m/s^2]). Values are held in SI; a plain number is taken as "
                 "SI. In a list of plot, print, table and export, brackets behind an item show it "
                 "in that unit: print h8 [deg].");
    text_char(out, '\n');
    for (int i = 0; (name = unit_name(i)) != NULL; i++) {
        Text dimension = {0}, factor = {0};
        Unit unit;

        if (!unit_find(name, &unit))
            continue;
        dimension_print(&dimension, unit.dimension);
        text_number(&factor, unit.factor, 10);
        table_cell(&table, name);
        table_cellf(&table, "= %s", factor.at);
        table_cell(&table, dimension.at != NULL ? dimension.at : "");
        text_free(&dimension);
        text_free(&factor);
    }
    table_print(out, &table, 2);
    table_free(&table);
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
        "Angles are in radians. step is 0 below 0 and 1 from there on, ramp(x) is "
        "x*step(x), if(c, a, b) is a where c holds and else b; unwrap(y, x, a) is the "
        "angle of (x, y) as atan2(y, x) gives it, but in the turn in which it is nearest "
        "to a. Of time: pulse(t, low, "
        "high, delay, rise, fall, width, period), pwl(t, t0, v0, t1, v1, ...). "
        "table(\"file.csv\", x, column) is a smooth curve through the data of a file: the "
        "first column is x, another is picked by its number or its name in quotes, the "
        "second if none is; a head such as h [deg] sets the unit of what is below; outside the "
        "data the value stays that of the end; a number "
        "behind the column asks for that derivative by x. Over the "
        "last run, of the motion and not of its rows: min(x) max(x) mean(x) rms(x) final(x) "
        "period(x), "
        "first(condition), settling(x, band); 'keep' makes parameters of them; spectrum(x) is for "
        "'plot' and 'table'. Entries of the "
        "equations: mass(1,2), forces(1), lambda(1). Operators: + - * / ^, < <= > >= == "
        "!= && || !; a prime is a time derivative (h8', h8'').");
}

static void write_pairs(Text *out, const char *const (*rows)[2], int count)
{
    Table table = table_for("ll");

    for (int i = 0; i < count; i++) {
        table_cell(&table, rows[i][0]);
        table_cell(&table, rows[i][1]);
    }
    table_wrap(out, &table, 2, TOPIC_WIDTH);
    table_free(&table);
}

static void write_methods(Text *out)
{
    Table table = table_for("ll");
    const char *name, *brief;

    layout_words(out, TOPIC_WIDTH, "", "simulate 10 method=WORD takes one of these:");
    for (int i = 0; (name = run_method(i, &brief)) != NULL; i++) {
        table_cell(&table, name);
        table_cell(&table, brief);
    }
    table_wrap(out, &table, 2, TOPIC_WIDTH);
    table_free(&table);
}

static void write_notations(Text *out)
{
    Table table = table_for("ll");

    layout_words(out, TOPIC_WIDTH, "", "show mass as WORD takes one of these:");
    for (Notation i = NOTATION_TEXT; i < NOTATIONS; i++)
        if (notation_row(i)->word != NULL) {
            table_cell(&table, notation_row(i)->word);
            table_cell(&table, notation_row(i)->brief);
        }
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

static void write_counting(Text *out)
{
    layout_words(
        out, TOPIC_WIDTH, "",
        "A sum of n terms is n-1 additions, a product of n factors n-1 multiplications. x^k with a "
        "whole k > 1 is k-1 multiplications. Each call of a function is one function, a "
        "power that isn't whole too. A coefficient other than 1 and -1 is a factor. Negation is "
        "free, a division counts as a multiplication. Operations inside the arguments of "
        "functions count. Matrices are counted over all their entries, both triangles. The first "
        "three figures are those of the entries as 'show' writes them, nothing shared; the others "
        "those of what a run evaluates, where each common subexpression is computed once, also one "
        "that is only a part of several sums or products, and a sine or cosine of a sum of angles "
        "follows from those of the parts where a block needs these anyway.");
}

static void write_variables(Text *out)
{
    /* clang-format off */
    static const char *const rows[][2] = {
        {"h8  h8'  h8''", "a joint's coordinate, its speed and acceleration"},
        {"m1.x  r5.vy", "motion of a body or frame, ground axes"},
        {"h9.fx  h9.tz", "force and moment of a joint on its tip; capitals: axes of its tail"},
        {"R1.v  R1.i  M7.torque", "of circuits and transducers; a.v is a terminal's potential"},
        {"energy.kinetic  .potential  .total", "of the whole model, J"},
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
                 "A bare name means the last run. 'at T' takes an instant of it; without, a value "
                 "is that of its end or, when an initial value or the model changed later, of the "
                 "assembled start. 'info NAME' lists the members of a component.");
}

static void write_topics(Text *out)
{
    Table table = table_for("ll");

    text_add(out, "Topics:\n");
    for (int i = 0; topic_at(i) != NULL; i++)
        if (topic_at(i)->show != NULL) {
            table_cell(&table, topic_at(i)->name);
            table_cell(&table, topic_at(i)->brief);
        }
    table_print(out, &table, 2);
    table_free(&table);
}

static void write_keys(Text *out)
{
    Table table = table_for("ll");
    /* clang-format off */
    static const char *const rows[][2] = {
        {"Tab", "complete the word; twice: show what fits"},
        {"Ctrl-C", "leave the line, or stop what is going on and keep what was computed"},
        {"Ctrl-D", "leave, on an empty line"},
        {"Ctrl-R", "search the history"},
        {"Up, Down", "earlier and later lines"},
    };
    /* clang-format on */

    for (int i = 0; i < COUNT(rows); i++) {
        table_cell(&table, rows[i][0]);
        table_cell(&table, rows[i][1]);
    }
    table_print(out, &table, 2);
    table_free(&table);
}

static void write_language(Text *out)
{
    layout_words(
        out, TOPIC_WIDTH, "",
        "One statement a line; ';' separates statements, '#' starts a comment, a line goes on "
        "after '\\' at its end. KEYWORD NAME PLACE... VALUE key=value... builds; other keywords "
        "ask or run. NAME = expr makes a parameter, f(x) = expr a law. > \"file\" behind a "
        "statement that prints writes there, >> appends. Keywords may be shortened at the prompt, "
        "never in a script. Upper and lower case differ.");
}

/* clang-format off */
static const HelpTopic topics[] = {
    {"language",  "how statements are written",                 write_language,  NULL},
    {"units",     "units of numbers, and how they are written", write_units,     NULL},
    {"functions", "functions and operators of expressions",     write_functions, NULL},
    {"variables", "what can be printed, plotted and expected",  write_variables, NULL},
    {"topics",    "what show can show",                         write_topics,    NULL},
    {"methods",   "integration methods of simulate",            write_methods,   "simulate"},
    {"notations", "notations of show",                          write_notations, "show"},
    {"formats",   "what export writes",                         write_formats,   "export"},
    {"imports",   "what import reads",                          write_imports,   "import"},
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
    const char *members[5];
} wholes[] = {
    {"energy", {"kinetic", "potential", "total", NULL}},
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

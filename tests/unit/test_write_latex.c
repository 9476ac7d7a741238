/* Documents of LaTeX and graphs for Graphviz: what opens closes, and every part is in the figure.
 * LaTeX and Graphviz themselves read them in tests/doc/. */
#include "session_kit.h"

#include "base/memory.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MACHINE                                                                                    \
    "scene planar\nbody crank mass=1 inertia=0.1\narm tip crank [1,0]\n"                           \
    "body rod mass=1 inertia=0.1\narm end rod [2,0]\nrevolute h_1 ground crank\n"                  \
    "revolute h_2 tip rod\nbody slide mass=1 inertia=1\nrevolute h_3 end slide\n"                  \
    "prismatic rail ground slide axis=x\n"
#define NETWORK                                                                                    \
    "vsource V1 a 0 5\nresistor R_load a b 10\ncapacitor C1 b 0 C=1e-6\nresistor R2 b 0 5\n"
#define FIRST_OF(text) (text), sizeof(text) - 1

/* of environments and of braces that no backslash takes their meaning */
static bool is_balanced(const char *text)
{
    enum { DEEPEST = 32 };
    const char *open[DEEPEST];
    int depth = 0, braces = 0;

    for (; *text != '\0'; text++) {
        if (*text == '%') { /* a remark */
            text += strcspn(text, "\n");
            continue;
        }
        braces += *text == '{';
        braces -= *text == '}';
        if (braces < 0)
            return false;
        if (*text != '\\')
            continue;
        if (strncmp(text, FIRST_OF("\\begin{")) == 0 && depth < DEEPEST)
            open[depth++] = text + sizeof "\\begin" - 1;
        if (strncmp(text, FIRST_OF("\\end{")) == 0) {
            const char *name = text + sizeof "\\end" - 1;

            if (depth == 0 || strncmp(name, open[depth - 1], strcspn(name, "}") + 1) != 0)
                return false;
            depth--;
        }
        text += text[1] == '{' || text[1] == '}' || text[1] == '\\' || text[1] == '%';
    }
    return braces == 0 && depth == 0;
}

static int times(const char *text, const char *word)
{
    int count = 0;

    if (text == NULL)
        return -1;
    for (const char *at = strstr(text, word); at != NULL; at = strstr(at + 1, word))
        count++;
    return count;
}

/* what a checker of balance has to notice */
static void balance_is_told_from_its_lack(void)
{
    EXPECT(is_balanced("\\begin{a}\\begin{b}{\\}}\\end{b}\\end{a}"));
    EXPECT(!is_balanced("\\begin{a}\\begin{b}\\end{a}\\end{b}"));
    EXPECT(!is_balanced("{"));
    EXPECT(!is_balanced("\\begin{a}"));
    EXPECT(!is_balanced("}{"));
}

/* every edge once in each tree that it is in, branches bold */
static void document_shows_the_graph(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MACHINE);
    EXPECT_DONE(&kit, "tree translation h_1 h_2 h_3\ntree rotation h_1 h_2 h_3\nexport latex");
    EXPECT(is_balanced(kit.text));
    EXPECT_HOLDS(kit.text, "\\usepackage{tikz}");
    EXPECT(times(kit.text, "\\begin{tikzpicture}") == 1);
    EXPECT(times(kit.text, "% branch h\\_1") == 0); /* as it is in remarks, */
    EXPECT(times(kit.text, "% branch h_1\n") == 1);
    EXPECT(times(kit.text, "% branch h_2\n") == 1);
    EXPECT(times(kit.text, "% branch h_3\n") == 1);
    EXPECT(times(kit.text, "% chord rail\n") == 1);
    EXPECT(times(kit.text, "% chord h_3\n") == 0);
    EXPECT(times(kit.text, "{h\\_1};") == 1); /* and as LaTeX wants it */
    EXPECT(times(kit.text, "{rail};") == 1);
    EXPECT(times(kit.text, "{branch};") == 1);
    EXPECT(times(kit.text, "{chord};") == 1);
    kit_free(&kit);
}

/* a panel each where the two trees differ; lines of branches are bolder than those of chords */
static void each_tree_has_its_panel(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MACHINE);
    EXPECT_DONE(&kit, "tree translation h_1 h_2 h_3\ntree rotation h_1 h_2 rail\nexport latex");
    EXPECT(is_balanced(kit.text));
    EXPECT_HOLDS(kit.text, "{translation tree};");
    EXPECT_HOLDS(kit.text, "{rotation tree};");
    EXPECT(times(kit.text, "% branch rail\n") == 1);
    EXPECT(times(kit.text, "% chord rail\n") == 1);

    double branch = 0, chord = 0;
    const char *at = strstr(kit.text, "% branch rail\n"),
               *other = strstr(kit.text, "% chord rail\n");

    EXPECT(sscanf(strstr(at, "line width="), "line width=%lf", &branch) == 1);
    EXPECT(sscanf(strstr(other, "line width="), "line width=%lf", &chord) == 1);
    EXPECT(branch > 2 * chord && chord > 0);
    kit_free(&kit);
}

static void network_and_title_come_out(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "title \"50% of {a_b} & c\"\n" NETWORK "export latex");
    EXPECT(is_balanced(kit.text));
    EXPECT_HOLDS(kit.text, "50\\% of \\{a\\_b\\} \\& c");
    EXPECT_HOLDS(kit.text, "{R\\_load};");
    EXPECT_HOLDS(kit.text, "{electrical tree};");
    kit_free(&kit);
}

/* a graph that no page holds is told so, and the rest is there */
static void large_graph_is_left_out(void)
{
    Kit kit = kit_new();
    char line[64];

    EXPECT_DONE(&kit, "vsource V1 n0 0 5\ncapacitor C1 n120 0 C=1e-6");
    for (int i = 0; i < 120; i++) {
        snprintf(line, sizeof line, "resistor R%d n%d n%d 10", i, i, i + 1);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "export latex");
    EXPECT(is_balanced(kit.text));
    EXPECT_HOLDS(kit.text, "too large for a page");
    EXPECT(strstr(kit.text, "tikzpicture") == NULL);
    EXPECT_HOLDS(kit.text, "subsection*{Network}");
    kit_free(&kit);
}

/* nodes are told before the edges between them, each edge once */
static void dot_has_every_edge_between_its_nodes(void)
{
    static const char *const edges[] = {"V1", "R_load", "C1", "R2"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, NETWORK "export dot");
    EXPECT(is_balanced(kit.text));
    EXPECT(kit.text != NULL && strncmp(kit.text, FIRST_OF("digraph ")) == 0);
    EXPECT(times(kit.text, " -> ") == COUNT(edges));
    for (int i = 0; i < COUNT(edges); i++) {
        char label[64], node[64];
        const char *at;
        int tail = -1, head = -1;

        snprintf(label, sizeof label, "[label=\"%s\", style=", edges[i]);
        EXPECT(times(kit.text, label) == 1);
        at = kit.text != NULL ? strstr(kit.text, label) : NULL;
        while (at != NULL && at > kit.text && at[-1] != '\n')
            at--;
        EXPECT(at != NULL && sscanf(at, " n%d -> n%d", &tail, &head) == 2);
        snprintf(node, sizeof node, "\n  n%d [label=", tail);
        EXPECT(times(kit.text, node) == 1);
        snprintf(node, sizeof node, "\n  n%d [label=", head);
        EXPECT(times(kit.text, node) == 1);
    }
    kit_free(&kit);
}

int main(void)
{
    RUN(balance_is_told_from_its_lack);
    RUN(document_shows_the_graph);
    RUN(each_tree_has_its_panel);
    RUN(network_and_title_come_out);
    RUN(large_graph_is_left_out);
    RUN(dot_has_every_edge_between_its_nodes);
    return test_end();
}

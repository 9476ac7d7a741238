/* write_latex.c: a model as a document: its linear graph, and every equation */
#include "export/write.h"
#include "present/graph_picture.h"
#include "present/latex_lines.h"
#include "present/show.h"

/* pt, of an article: what a figure leaves room for its caption in */
#define PAGE_WIDTH  340.0
#define PAGE_HEIGHT 480.0
#define EASY        0.5  /* pt per px, which is tried for: letters of 6 pt */
#define SMALLEST    0.25 /* what still can be read */

static void add_figure(const Picture *picture, Text *out)
{
    text_add(out, "\n\\subsection*{Linear graph}\n");
    if (picture == NULL || picture->width * SMALLEST > PAGE_WIDTH ||
        picture->height * SMALLEST > PAGE_HEIGHT) {
        text_add(out, "The graph is too large for a page.\n");
        return;
    }
    text_add(out, "\\begin{figure}[htbp]\n\\centering\n");
    picture_tikz(picture, PAGE_WIDTH, PAGE_HEIGHT, out);
    text_add(out,
             "\\caption{The linear graph. Branches of a tree are bold, its chords thin; an edge "
             "points from its tail to its head, and the datum is filled.}\n\\end{figure}\n");
}

static Status add_graph(const View *view, Text *out, Diag *diag)
{
    Picture picture = {0};
    Diag why;
    const Status status = graph_picture(view, PAGE_WIDTH / EASY, LIT_NOTHING, NULL, &picture, &why);

    if (status == OK) {
        add_figure(&picture, out);
        picture_close(&picture);
    } else if (status == E_VALUE) {
        add_figure(NULL, out);
    } else if (status != E_MISSING) {
        *diag = why;
        return status;
    }
    return OK;
}

/* a document of all equations that compiles with amsmath and tikz alone */
static Status write(const Exported *what, Text *out, Diag *diag)
{
    const View *view = &what->view;
    static const struct {
        const char *title;
        ShowFunction *show;
        bool constraints; /* only where there are some */
        bool motion;      /* only where something moves */
        bool network;     /* only where there is a network */
    } sections[] = {
        {"Constraints", show_constraints, true, false, false},
        {"Jacobian of the constraints", show_jacobian, true, false, false},
        {"Mass matrix", show_mass, false, true, false},
        {"Forces", show_forces, false, true, false},
        {"Network", show_network, false, false, true},
    };
    const Selection all = {.number_count = 0};
    View latex = *view;
    const char *title = model_title(view->model);

    latex.page.notation = NOTATION_LATEX;
    text_add(out, "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage{tikz}\n"
                  "\\allowdisplaybreaks\n\\begin{document}\n\\section*{");
    latex_text(out, title != NULL && title[0] != '\0' ? title : "Equations");
    text_add(out, "}\n");
    TRY(add_graph(view, out, diag));
    for (int i = 0; i < COUNT(sections); i++) {
        if ((sections[i].constraints && system_m(view->system) == 0) ||
            (sections[i].motion && system_nu(view->system) == 0) ||
            (sections[i].network && system_network_count(view->system) == 0))
            continue;
        text_addf(out, "\n\\subsection*{%s}\n", sections[i].title);
        TRY(sections[i].show(&latex, &all, out, diag));
    }
    text_add(out, "\\end{document}\n");
    return OK;
}

const Format format_latex = {.need = NEED_SYSTEM, .write = write};

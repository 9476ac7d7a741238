/* write_latex.c: every equation of a model as a document */
#include "export/write.h"
#include "present/show.h"

static void add_escaped(Text *out, const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '\\')
            text_add(out, "\\textbackslash{}");
        else if (*text == '~' || *text == '^')
            text_addf(out, "\\%c{}", *text);
        else {
            if (*text == '#' || *text == '$' || *text == '%' || *text == '&' || *text == '_' ||
                *text == '{' || *text == '}')
                text_char(out, '\\');
            text_char(out, *text);
        }
    }
}

/* a document of all equations that compiles with amsmath alone */
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
    text_add(out, "\\documentclass{article}\n\\usepackage{amsmath}\n"
                  "\\allowdisplaybreaks\n\\begin{document}\n\\section*{");
    add_escaped(out, title != NULL && title[0] != '\0' ? title : "Equations");
    text_add(out, "}\n");
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

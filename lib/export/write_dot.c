/* write_dot.c: the linear graph for Graphviz */
#include "export/write.h"

#include "present/info.h"

static Status write(const Exported *what, Text *out, Diag *diag)
{
    (void)diag;
    draw_dot(&what->view, out);
    return OK;
}

const Format format_dot = {.need = NEED_MODEL, .write = write};

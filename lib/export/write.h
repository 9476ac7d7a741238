/* write.h: files in other formats */
#ifndef COTREE_EXPORT_WRITE_H
#define COTREE_EXPORT_WRITE_H

#include "present/view.h"
#include "simulate/analyse/linearize.h"

/* numbers row by row, 17 digits; names quoted where they hold a comma or a quote (RFC 4180) */
void write_csv(Text *out, const char *const *names, const double *values, int rows, int columns,
               bool with_header);
/* a row a mode, with the amplitude and phase of every part */
void write_modes_csv(const Modes *modes, bool with_header, Text *out);

/* a document of all equations that compiles with amsmath alone */
MUST_USE Status write_latex(const View *view, Text *out, Diag *diag);

/* C source: a function a block (M, F, Phi, Phi_u, gamma ...), straight-line, each common
 * subexpression computed once; needs math.h alone */
MUST_USE Status write_c(const View *view, Text *out, Diag *diag);

#endif

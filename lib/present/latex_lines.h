/* latex_lines.h: formulas of LaTeX broken to the width of a page, with text between them */
#ifndef COTREE_PRESENT_LATEX_LINES_H
#define COTREE_PRESENT_LATEX_LINES_H

#include "base/text.h"

/* The approximate width of a formula, in widths of a digit; text width of an article: 69. */
double latex_width(const char *formula);

/* The formula in rows of an align, broken before + and -, outside brackets rather than inside.
 * `room`, in digits, is that of each row. */
void latex_wrap(Text *out, const char *formula, double room);

/* Text that isn't a formula, its special characters as such. */
void latex_text(Text *out, const char *text);

#endif

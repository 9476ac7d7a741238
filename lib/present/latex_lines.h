/* latex_lines.h: formulas of LaTeX on lines that a page holds, and text among them */
#ifndef COTREE_PRESENT_LATEX_LINES_H
#define COTREE_PRESENT_LATEX_LINES_H

#include "base/text.h"

/* About how wide a formula comes out, in digits of its size; text width of an article: 69. */
double latex_width(const char *formula);

/* The formula in rows of an align, broken before + and -, outside brackets rather than inside.
 * `room`, in digits, is that of each row. */
void latex_wrap(Text *out, const char *formula, double room);

/* Text that isn't a formula, its special characters as such. */
void latex_text(Text *out, const char *text);

#endif

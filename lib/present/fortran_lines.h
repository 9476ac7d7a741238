/* fortran_lines.h: source code of Fortran on lines that its standard allows */
#ifndef COTREE_PRESENT_FORTRAN_LINES_H
#define COTREE_PRESENT_FORTRAN_LINES_H

#include "base/text.h"

/* Break lines of more than 132 columns, from offset `from` of the text on, which is the start of a
 * line. Statements continue after an `&`, comments in another comment (ISO/IEC 1539-1:2018, 6.3.2).
 * Lines of the preprocessor are unchanged. */
void fortran_wrap(Text *text, size_t from);

#endif

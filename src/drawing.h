/* drawing.h: pictures by gnuplot, or with characters, on any output
 *
 * The caller passes a function that writes gnuplot's commands, data included, and one that draws
 * with characters. This file chooses the function and the terminal by the file's name, the display
 * and `set terminal`. */
#ifndef COTREE_SRC_DRAWING_H
#define COTREE_SRC_DRAWING_H

#include "command.h"

typedef struct Drawing {
    void (*put)(FILE *out, const struct Drawing *drawing); /* gnuplot's commands */
    /* new, ct_free(): the same with characters; NULL: gnuplot draws that, too */
    char *(*text)(const struct Drawing *drawing, int columns, int rows, bool unicode);
    const void *of; /* what is drawn */
    const char *title;
    double width, height; /* px; 0: as plots are */
    double interval;      /* s between pictures of an animation; 0: a single picture */
} Drawing;

/* The file after `>`, NULL if there is none; an error unless its type is that of a picture. */
ct_status drawing_check(const Call *call, const char **path, ct_error *error);
/* whether pictures without a file are shown in a window, rather than on the terminal as text */
bool drawing_in_window(const Call *call);
/* Draw, to `path` or (NULL) into a window or on the terminal. */
ct_status drawing_make(Call *call, const Drawing *drawing, const char *path, ct_error *error);

/* a string of gnuplot's, in quotes */
void write_quoted(FILE *out, const char *text);
/* `set title`, where there is a title */
void write_title(FILE *out, const char *title);
/* of the i-th curve: "#0072b2"; where colours repeat the dashes, 1 and on, differ */
const char *drawing_color(int i);
int drawing_dash(int i);

#endif

/* picture_tikz.c: a picture as an environment of TikZ, made small enough for a page */
#include "present/picture.h"

#include "present/latex_lines.h"

#include <math.h>
#include <string.h>

#define LARGEST 0.75 /* pt per px: as a screen has it */
#define FONT    10.0 /* pt: of the text around the picture */

/* the name of a colour is a prefix and its components */
static void write_colors(Text *out, const Picture *picture)
{
    LIST(const char *) known = {0};

    for (int i = 0; i < 2 * picture->shapes.count; i++) {
        const Ink *ink = &picture->shapes.at[i / 2].ink;
        const char *color = i % 2 == 0 ? ink->stroke : ink->fill;
        int k = 0;

        while (color != NULL && k < known.count && strcmp(known.at[k], color) != 0)
            k++;
        if (color == NULL || k < known.count)
            continue;
        text_addf(out, "\\definecolor{ink%s}{HTML}{%s}\n", color + 1, color + 1);
        LIST_PUSH(known, color);
    }
    LIST_FREE(known);
}

static void write_ink(Text *out, const Ink *ink, double scale)
{
    static const char *const dashes[] = {"solid", "dashed", "dotted", "dash dot"};

    if (ink->stroke != NULL)
        text_addf(out, "draw=ink%s,line width=%.2fpt,%s", ink->stroke + 1, scale * ink->width,
                  dashes[ink->dash]);
    if (ink->fill != NULL)
        text_addf(out, "%sfill=ink%s", ink->stroke != NULL ? "," : "", ink->fill + 1);
}

static void write_shape(Text *out, const Picture *picture, const Shape *shape, double scale)
{
    static const char *const anchors[] = {"base west", "base", "base east"};
    const Point *points = picture->points.at + shape->first;

    if (shape->kind == SHAPE_TEXT) {
        text_addf(out,
                  "\\node[anchor=%s,scale=%.3f,text=ink%s,fill=white,fill opacity=0.8,"
                  "text opacity=1,inner sep=0.5pt] at (%.2f,%.2f) {",
                  anchors[shape->anchor], scale * shape->size / FONT, shape->ink.stroke + 1,
                  points[0].x, points[0].y);
        latex_text(out, shape->text);
        text_add(out, "};\n");
        return;
    }
    text_add(out, "\\path[");
    write_ink(out, &shape->ink, scale);
    text_char(out, ']');
    for (int i = 0; i < shape->count; i++)
        text_addf(out, "%s(%.2f,%.2f)", i > 0 ? "--" : " ", points[i].x, points[i].y);
    if (shape->kind == SHAPE_AREA)
        text_add(out, "--cycle");
    if (shape->kind == SHAPE_CIRCLE)
        text_addf(out, " circle [radius=%.2fpt]", scale * shape->size);
    text_add(out, ";\n");
}

/* The subject of a shape is a comment above it. */
void picture_tikz(const Picture *picture, double width, double height, Text *out)
{
    const double scale = fmin(LARGEST, fmin(width / picture->width, height / picture->height));
    const char *what = "";

    write_colors(out, picture);
    text_addf(out, "\\begin{tikzpicture}[x=%.4fpt,y=-%.4fpt,line cap=round,line join=round]\n",
              scale, scale);
    for (int i = 0; i < picture->shapes.count; i++) {
        const Shape *shape = &picture->shapes.at[i];

        if (strcmp(what, shape->what) != 0)
            text_addf(out, "%% %s\n", shape->what);
        what = shape->what;
        write_shape(out, picture, shape, scale);
    }
    text_add(out, "\\end{tikzpicture}\n");
}

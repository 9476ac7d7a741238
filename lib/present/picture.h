/* picture.h: a drawing as a list of shapes on a sheet, independent of the output format
 *
 * The caller adds shapes, in px, x to the right and y down; later ones cover earlier ones of the
 * same depth. The writers (SVG, characters, gnuplot's commands, TikZ) don't depend on the
 * subject. */
#ifndef COTREE_PRESENT_PICTURE_H
#define COTREE_PRESENT_PICTURE_H

#include "base/memory.h"
#include "base/text.h"

typedef enum Dash { DASH_NONE, DASH_LONG, DASH_DOTS, DASH_CENTRE } Dash;

typedef struct Ink {
    const char *stroke; /* "#rrggbb"; NULL: no line */
    const char *fill;   /* NULL: not filled */
    double width;       /* of the line, px */
    Dash dash;
} Ink;

typedef struct Point {
    double x, y;
} Point;

typedef enum Anchor { ANCHOR_START, ANCHOR_MIDDLE, ANCHOR_END } Anchor;

typedef enum ShapeKind { SHAPE_LINE, SHAPE_AREA, SHAPE_CIRCLE, SHAPE_TEXT } ShapeKind;

typedef struct Shape {
    ShapeKind kind;
    const char *what; /* "body m1": a class and the name of the part; the picture's; never NULL */
    int first, count; /* of its points; a circle and a text have one */
    double size;      /* radius of a circle, height of a text */
    double depth;     /* larger is nearer: drawn later */
    int order;        /* of making, among those of one depth */
    Ink ink;          /* of a text its stroke */
    Anchor anchor;
    const char *text;
} Shape;

typedef struct Picture {
    double width, height;
    LIST(Point) points;
    LIST(Shape) shapes;
    const char *what; /* of the following shapes */
    double depth;
    Pool *pool;
} Picture;

void picture_open(Picture *picture, double width, double height);
void picture_close(Picture *picture);
/* The subject of the following shapes, for readers of the file: "body m1". */
void picture_of(Picture *picture, const char *what, const char *name);
void picture_line(Picture *picture, Ink ink, const Point *points, int count);
void picture_area(Picture *picture, Ink ink, const Point *points, int count);
void picture_circle(Picture *picture, Ink ink, Point centre, double radius);
void picture_text(Picture *picture, const char *color, Point at, double size, Anchor anchor,
                  const char *text);
/* with a head at its end */
void picture_arrow(Picture *picture, Ink ink, Point from, Point to);
/* the far ones first */
void picture_sort(Picture *picture);
/* Colours that can be distinguished with colour blindness too (Okabe and Ito 2008); lighter ones,
 * for filling. */
const char *picture_color(int i);
const char *picture_tint(int i);

/* --- writers --- */

/* Frames of an animation have equal durations; `seconds` is that of the whole. A single picture
 * doesn't move. */
typedef struct Animation {
    const Picture *pictures;
    const double *times; /* s, of the motion; NULL: not shown */
    int count;
    double seconds;
    const char *title;
} Animation;

void picture_svg(const Animation *film, Text *out);
/* a page that plays the animation, without external files */
void picture_html(const Animation *film, Text *out);
/* on a screen of characters: braille where it has Unicode */
void picture_characters(const Picture *picture, int columns, int rows, bool unicode, Text *out);
/* commands that draw it on any of gnuplot's terminals that is as wide to its height */
void picture_gnuplot(const Picture *picture, Text *out);
/* an environment of TikZ no larger than so many pt, in a document that loads tikz */
void picture_tikz(const Picture *picture, double width, double height, Text *out);

#endif

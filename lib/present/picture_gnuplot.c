/* picture_gnuplot.c: a picture as gnuplot's commands
 *
 * Every shape is a curve over a block of points, so that later ones lie over earlier ones. */
#include "present/picture.h"

#include <math.h>

enum {
    ROUND = 32, /* corners of a circle */
    HALO = 8    /* copies of a text behind it */
};

#define HALO_WIDTH 1.5 /* px */

static void write_points(Text *out, const Picture *picture, const Shape *shape)
{
    const Point at = picture->points.at[shape->first];

    if (shape->kind == SHAPE_CIRCLE)
        for (int i = 0; i <= ROUND; i++)
            text_addf(out, "%.1f %.1f\n", at.x + shape->size * cos(2 * M_PI * i / ROUND),
                      at.y + shape->size * sin(2 * M_PI * i / ROUND));
    for (int i = 0; shape->kind != SHAPE_CIRCLE && i < shape->count; i++)
        text_addf(out, "%.1f %.1f\n", picture->points.at[shape->first + i].x,
                  picture->points.at[shape->first + i].y);
    if (shape->kind == SHAPE_AREA)
        text_addf(out, "%.1f %.1f\n", at.x, at.y);
    text_add(out, "\n\n");
}

/* in single quotes only the quote itself means something */
static void write_string(Text *out, const char *text)
{
    text_char(out, '\'');
    for (; *text != '\0'; text++)
        text_add_n(out, *text == '\'' ? "''" : text, *text == '\'' ? 2 : 1);
    text_char(out, '\'');
}

static void write_curve(Text *out, const Shape *shape, int index)
{
    static const char *const dashes[] = {"1", "'- '", "'. '", "'_. '"};

    if (shape->ink.fill != NULL)
        text_addf(out, ", $picture index %d with filledcurves closed linecolor rgb '%s' notitle",
                  index, shape->ink.fill);
    if (shape->ink.stroke != NULL)
        text_addf(out,
                  ", $picture index %d with lines linecolor rgb '%s' linewidth %.3g dashtype %s "
                  "notitle",
                  index, shape->ink.stroke, shape->ink.width, dashes[shape->ink.dash]);
}

static void write_text(Text *out, const Shape *shape, double x, double y, const char *color)
{
    static const char *const anchors[] = {"left", "center", "right"};

    text_add(out, "set label ");
    write_string(out, shape->text);
    text_addf(out, " at %.1f,%.1f %s noenhanced textcolor rgb '%s' font ',%.3g' front\n", x,
              y - 0.35 * shape->size, anchors[shape->anchor], color, 0.75 * shape->size);
}

/* A text, and behind it itself in white to all sides, or lines run through it. */
static void write_label(Text *out, const Picture *picture, const Shape *shape)
{
    const Point at = picture->points.at[shape->first];

    for (int i = 0; i < HALO; i++)
        write_text(out, shape, at.x + HALO_WIDTH * cos(2 * M_PI * i / HALO),
                   at.y + HALO_WIDTH * sin(2 * M_PI * i / HALO), "#ffffff");
    write_text(out, shape, at.x, at.y, shape->ink.stroke);
}

void picture_gnuplot(const Picture *picture, Text *out)
{
    int index = 0;

    text_addf(
        out,
        "unset label\nunset border\nunset tics\nunset key\nset size noratio\nset margins 0,0,0,0\n"
        "set xrange [0:%g]\nset yrange [%g:0]\n$picture << end\n",
        picture->width, picture->height);
    for (int i = 0; i < picture->shapes.count; i++)
        if (picture->shapes.at[i].kind != SHAPE_TEXT)
            write_points(out, picture, &picture->shapes.at[i]);
    text_add(out, "end\n");
    for (int i = 0; i < picture->shapes.count; i++)
        if (picture->shapes.at[i].kind == SHAPE_TEXT)
            write_label(out, picture, &picture->shapes.at[i]);

    /* an empty picture is allowed, too */
    text_add(out, "plot NaN notitle");
    for (int i = 0; i < picture->shapes.count; i++)
        if (picture->shapes.at[i].kind != SHAPE_TEXT)
            write_curve(out, &picture->shapes.at[i], index++);
    text_char(out, '\n');
}

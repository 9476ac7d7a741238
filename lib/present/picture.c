/* picture.c: the shapes of a drawing */
#include "present/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *color, *tint;
} colors[] = {
    {"#0072b2", "#cfe5f3"}, {"#d55e00", "#f8dfcc"}, {"#009e73", "#cdeee4"}, {"#cc79a7", "#f5e3ed"},
    {"#e69f00", "#fbecc8"}, {"#56b4e9", "#ddf0fb"}, {"#555555", "#e2e2e2"},
};

const char *picture_color(int i)
{
    return colors[i % COUNT(colors)].color;
}

const char *picture_tint(int i)
{
    return colors[i % COUNT(colors)].tint;
}

void picture_open(Picture *picture, double width, double height)
{
    *picture = (Picture){.width = width, .height = height, .what = "", .pool = pool_new(0)};
}

void picture_close(Picture *picture)
{
    LIST_FREE(picture->points);
    LIST_FREE(picture->shapes);
    pool_free(picture->pool);
    picture->pool = NULL;
}

void picture_of(Picture *picture, const char *what, const char *name)
{
    Text text = {0};

    text_addf(&text, "%s %s", what, name);
    picture->what = pool_text(picture->pool, text.at, text.length);
    text_free(&text);
}

static Shape *add(Picture *picture, ShapeKind kind, Ink ink, const Point *points, int count)
{
    const Shape shape = {.kind = kind,
                         .what = picture->what,
                         .first = picture->points.count,
                         .count = count,
                         .depth = picture->depth,
                         .order = picture->shapes.count,
                         .ink = ink};

    for (int i = 0; i < count; i++)
        LIST_PUSH(picture->points, points[i]);
    LIST_PUSH(picture->shapes, shape);
    return &picture->shapes.at[picture->shapes.count - 1];
}

void picture_line(Picture *picture, Ink ink, const Point *points, int count)
{
    ink.fill = NULL;
    (void)add(picture, SHAPE_LINE, ink, points, count);
}

void picture_area(Picture *picture, Ink ink, const Point *points, int count)
{
    (void)add(picture, SHAPE_AREA, ink, points, count);
}

void picture_circle(Picture *picture, Ink ink, Point centre, double radius)
{
    add(picture, SHAPE_CIRCLE, ink, &centre, 1)->size = radius;
}

void picture_text(Picture *picture, const char *color, Point at, double size, Anchor anchor,
                  const char *text)
{
    const char *kept = pool_text(picture->pool, text, strlen(text));
    Shape *shape = add(picture, SHAPE_TEXT, (Ink){.stroke = color}, &at, 1);

    shape->size = size;
    shape->anchor = anchor;
    shape->text = kept;
}

void picture_arrow(Picture *picture, Ink ink, Point from, Point to)
{
    const double dx = to.x - from.x, dy = to.y - from.y, length = hypot(dx, dy);
    const double head = fmin(4 + 3 * ink.width, 0.6 * length);

    if (!(length > 0))
        return;

    const double ux = dx / length * head, uy = dy / length * head;
    const Point foot = {to.x - ux, to.y - uy};

    picture_line(picture, ink, (Point[]){from, foot}, 2);
    picture_area(picture, (Ink){.stroke = ink.stroke, .fill = ink.stroke, .width = 0.5},
                 (Point[]){to,
                           {foot.x - 0.38 * uy, foot.y + 0.38 * ux},
                           {foot.x + 0.38 * uy, foot.y - 0.38 * ux}},
                 3);
}

static int compare_depth(const void *a, const void *b)
{
    const Shape *left = a, *right = b;

    if (left->depth != right->depth)
        return left->depth < right->depth ? -1 : 1;
    return left->order - right->order;
}

void picture_sort(Picture *picture)
{
    if (picture->shapes.count > 1)
        qsort(picture->shapes.at, (size_t)picture->shapes.count, sizeof *picture->shapes.at,
              compare_depth);
}

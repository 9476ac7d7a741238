/* mechanism_names.c: placement of the names of parts with the least overlap
 *
 * A name is placed at one of several sides of its point, the same throughout an animation, or it
 * would flicker. Names are placed one after the other, at the side where, over all instants, they
 * cover the fewest names already placed, points of parts, lines, and edges of the sheet. */
#include "present/mechanism_impl.h"

#include <math.h>

enum {
    COVERS_NAME = 8, /* what each costs, at an instant */
    COVERS_EDGE = 8,
    COVERS_POINT = 1,
    COVERS_LINE = 1,
    FIRST_FAR = 6,      /* of the sides: one that costs a little */
    MOST_INSTANTS = 60, /* that are looked at */
    MOST_LOOKS = 6000   /* of them times names: of very large mechanisms fewer instants */
};

#define BODY_TEXT  14.0 /* px */
#define OTHER_TEXT 12.0
#define LETTER     0.58 /* a letter's width, of its size */

/* offset of the left top corner, in widths and heights of the text, plus px */
static const double sides[][4] = {
    {0, -1, 9, -8},   {0, 0, 9, 8},       {-1, -1, -9, -8},   {-1, 0, -9, 8},  {-0.5, -1, 0, -13},
    {-0.5, 0, 0, 13}, {0, -1, 16, -20},   {-1, 0, -16, 22},   {0, 0, 16, 24},  {-1, -1, -16, -24},
    {0, -0.5, 18, 0}, {-1, -0.5, -18, 0}, {-0.5, -1, 0, -24}, {-0.5, 0, 0, 26}};

typedef struct Box {
    Point low, high;
} Box;

static bool is_body(const Name *name)
{
    return name->part->row->family == FAMILY_BODY;
}

static double size_of(const Name *name)
{
    return is_body(name) ? BODY_TEXT : OTHER_TEXT;
}

/* The point that a name belongs to; false: it isn't visible. */
static bool find_point(const Sheet *sheet, const Name *name, Point *out)
{
    const Mechanism *mechanism = sheet->mechanism;

    if (name->load < 0) {
        *out = sheet_node(sheet, name->part->head, NULL);
        return true;
    }

    const Load *load = &mechanism->loads.at[name->load];
    double moment[3];
    const Point at = sheet_node(sheet, load->node, NULL);
    const Point d = mechanism_load(mechanism, sheet->values, load, moment);

    *out = (Point){at.x + d.x, at.y + d.y};
    return hypot(d.x, d.y) > 1;
}

static Box box_at(const Name *name, int side, Point at)
{
    const double width = LETTER * size_of(name) * text_width(name->part->name);
    const double height = 0.8 * size_of(name);
    const Point low = {at.x + sides[side][0] * width + sides[side][2],
                       at.y + sides[side][1] * height + sides[side][3]};

    return (Box){low, {low.x + width, low.y + height}};
}

static bool overlap(const Box *a, const Box *b)
{
    return a->low.x < b->high.x && b->low.x < a->high.x && a->low.y < b->high.y &&
           b->low.y < a->high.y;
}

static bool holds(const Box *box, Point p)
{
    return p.x > box->low.x && p.x < box->high.x && p.y > box->low.y && p.y < box->high.y;
}

/* --- which, and where --- */

void mechanism_call(Mechanism *mechanism)
{
    const Model *model = mechanism->view->model;

    for (int i = 0; i < mechanism->loads.count; i++)
        if (!mechanism->loads.at[i].reaction)
            LIST_PUSH(mechanism->names, ((Name){mechanism->loads.at[i].owner, i, 0}));
    for (int joints = 0; joints < 2; joints++)
        for (int i = 0; i < model_count(model); i++) {
            const Instance *part = model_instance(model, i);

            if (part->row->family == (joints == 1 ? FAMILY_JOINT : FAMILY_BODY) &&
                !part->is_virtual)
                LIST_PUSH(mechanism->names, ((Name){part, -1, 0}));
        }
}

/* points and boxes of the names at the instants that are looked at, and all else that is there */
typedef struct Looks {
    const Mechanism *mechanism;
    int instants;
    Point *points; /* instants x names; NAN: not seen */
    Box *boxes;    /* of the names that have chosen */
    Picture *pictures;
    Box **shapes; /* bounding boxes of each picture's shapes */
} Looks;

/* does the segment have a point in the box? (Liang and Barsky 1984) */
static bool crosses(const Box *box, Point a, Point b)
{
    const double p[4] = {a.x - b.x, b.x - a.x, a.y - b.y, b.y - a.y};
    const double q[4] = {a.x - box->low.x, box->high.x - a.x, a.y - box->low.y, box->high.y - a.y};
    double from = 0, to = 1;

    for (int i = 0; i < 4; i++) {
        if (p[i] == 0 && q[i] < 0)
            return false;
        if (p[i] < 0)
            from = fmax(from, q[i] / p[i]);
        if (p[i] > 0)
            to = fmin(to, q[i] / p[i]);
    }
    return from <= to;
}

/* box of a text */
static Box box_of_text(const Shape *shape, Point at)
{
    const double width = LETTER * shape->size * text_width(shape->text);
    const double left = at.x - width / 2 * shape->anchor;

    return (Box){{left, at.y - 0.8 * shape->size}, {left + width, at.y}};
}

static Box box_of_shape(const Picture *picture, const Shape *shape)
{
    const Point *points = picture->points.at + shape->first;
    const double radius = shape->kind == SHAPE_CIRCLE ? shape->size : 0;
    Box box = {points[0], points[0]};

    if (shape->kind == SHAPE_TEXT)
        return box_of_text(shape, points[0]);
    for (int i = 1; i < shape->count; i++) {
        box.low = (Point){fmin(box.low.x, points[i].x), fmin(box.low.y, points[i].y)};
        box.high = (Point){fmax(box.high.x, points[i].x), fmax(box.high.y, points[i].y)};
    }
    return (Box){{box.low.x - radius, box.low.y - radius},
                 {box.high.x + radius, box.high.y + radius}};
}

/* Of a line or an edge; what is filled may lie below a name, the edge may not. */
static int cost_of_shape(const Picture *picture, const Shape *shape, const Box *box)
{
    const Point *points = picture->points.at + shape->first;

    if (shape->kind == SHAPE_TEXT)
        return COVERS_NAME;
    if (shape->kind == SHAPE_CIRCLE)
        return COVERS_LINE;
    for (int i = shape->kind == SHAPE_AREA ? 0 : 1; i < shape->count; i++)
        if (crosses(box, points[(i + shape->count - 1) % shape->count], points[i]))
            return COVERS_LINE;
    return 0;
}

static int cost_of(const Looks *looks, int number, int side)
{
    const Mechanism *mechanism = looks->mechanism;
    const int count = mechanism->names.count;
    int cost = 0;

    for (int r = 0; r < looks->instants; r++) {
        const Point *points = looks->points + (ptrdiff_t)r * count;
        const Box *boxes = looks->boxes + (ptrdiff_t)r * count;

        if (isnan(points[number].x))
            continue;

        const Box box = box_at(&mechanism->names.at[number], side, points[number]);

        cost += side >= FIRST_FAR;
        cost += COVERS_EDGE * (box.low.x < 0 || box.low.y < 0 || box.high.x > mechanism->width ||
                               box.high.y > mechanism->height);
        for (int i = 0; i < looks->pictures[r].shapes.count; i++)
            if (overlap(&box, &looks->shapes[r][i]))
                cost += cost_of_shape(&looks->pictures[r], &looks->pictures[r].shapes.at[i], &box);
        for (int i = 0; i < count; i++)
            cost +=
                (i < number && !isnan(points[i].x) && overlap(&box, &boxes[i]) ? COVERS_NAME : 0) +
                (i != number && holds(&box, points[i]) ? COVERS_POINT : 0);
    }
    return cost;
}

static void choose(const Looks *looks, Name *names, int number)
{
    int least = -1;

    for (int side = 0; side < COUNT(sides) && least != 0; side++) {
        const int cost = cost_of(looks, number, side);

        if (least >= 0 && cost >= least)
            continue;
        least = cost;
        names[number].side = side;
    }
    for (int r = 0; r < looks->instants; r++) {
        const ptrdiff_t at = (ptrdiff_t)r * looks->mechanism->names.count + number;

        looks->boxes[at] = box_at(&names[number], names[number].side, looks->points[at]);
    }
}

static void look_at(Looks *looks, int r, const double *values)
{
    Picture *picture = &looks->pictures[r];

    mechanism_draw_parts(looks->mechanism, values, 0, picture);
    looks->shapes[r] = NEW_ARRAY(Box, picture->shapes.count);
    for (int i = 0; i < picture->shapes.count; i++)
        looks->shapes[r][i] = box_of_shape(picture, &picture->shapes.at[i]);
}

void mechanism_settle_names(Mechanism *mechanism, const double *values, int rows)
{
    const int count = mechanism->names.count;
    const int most =
        count > 0 && MOST_LOOKS / count < MOST_INSTANTS ? MOST_LOOKS / count + 1 : MOST_INSTANTS;
    Looks looks = {.mechanism = mechanism, .instants = rows < most ? rows : most};

    looks.points = NEW_ARRAY(Point, looks.instants * count);
    looks.boxes = NEW_ARRAY(Box, looks.instants * count);
    looks.pictures = NEW_ARRAY(Picture, looks.instants);
    looks.shapes = NEW_ARRAY(Box *, looks.instants);
    for (int r = 0; r < looks.instants; r++) {
        const ptrdiff_t row =
            looks.instants > 1 ? (ptrdiff_t)r * (rows - 1) / (looks.instants - 1) : 0;
        const Sheet sheet = {.mechanism = mechanism,
                             .values = values + row * mechanism->items.count};

        look_at(&looks, r, sheet.values);
        for (int i = 0; i < count; i++) {
            Point *point = &looks.points[(ptrdiff_t)r * count + i];

            if (!find_point(&sheet, &mechanism->names.at[i], point))
                *point = (Point){NAN, NAN};
        }
    }
    for (int i = 0; i < count; i++)
        choose(&looks, mechanism->names.at, i);
    for (int r = 0; r < looks.instants; r++) {
        picture_close(&looks.pictures[r]);
        mem_free(looks.shapes[r]);
    }
    MEM_FREE(looks.points, looks.boxes, looks.pictures, looks.shapes);
}

/* names lie over everything */
void sheet_names(Sheet *sheet)
{
    const Mechanism *mechanism = sheet->mechanism;

    picture_of(sheet->picture, "names", "of parts");
    for (int i = 0; i < mechanism->names.count; i++) {
        const Name *name = &mechanism->names.at[i];
        Point at;

        if (!find_point(sheet, name, &at))
            continue;

        const Box box = box_at(name, name->side, at);
        const char *color = name->load >= 0 ? INK_FORCE
                            : is_body(name)
                                ? picture_color(mechanism_color(mechanism, name->part->head))
                                : INK_DARK;

        picture_text(sheet->picture, color, (Point){box.low.x, box.high.y}, size_of(name),
                     ANCHOR_START, name->part->name);
    }
}

/* mechanism_sheet.c: one instant on the sheet: bodies, what joins them, what pulls at them */
#include "present/mechanism_impl.h"

#include <math.h>
#include <stdlib.h>

static int compare_points(const void *a, const void *b)
{
    const Point *p = a, *q = b;

    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->y < q->y ? -1 : p->y > q->y;
}

static double turn_of(Point a, Point b, Point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* the convex hull (Andrew 1979); `points` is sorted, `hull` has room for one more */
static int find_hull(Point *points, int count, Point *hull)
{
    int size = 0;

    qsort(points, (size_t)count, sizeof *points, compare_points);
    for (int pass = 0; pass < 2; pass++) {
        const int least = size + (pass == 0 ? 2 : 1);

        for (int k = pass; k < count; k++) {
            const Point p = points[pass == 0 ? k : count - 1 - k];

            while (size >= least && turn_of(hull[size - 2], hull[size - 1], p) <= 0)
                size--;
            hull[size++] = p;
        }
    }
    return size > 1 ? size - 1 : size;
}

/* A disc about each frame, and the hull of them all: a link, a plate, or a ball. */
static void draw_hull(Sheet *sheet, const Point *centres, int count, Ink ink)
{
    enum { CORNERS = 24 };
    Point *points = NEW_ARRAY(Point, count * CORNERS);
    Point *hull = NEW_ARRAY(Point, count * CORNERS + 1);

    for (int i = 0; i < count; i++)
        for (int k = 0; k < CORNERS; k++)
            points[i * CORNERS + k] =
                (Point){centres[i].x + LINK_HALF * cos(2 * M_PI * k / CORNERS),
                        centres[i].y + LINK_HALF * sin(2 * M_PI * k / CORNERS)};
    picture_area(sheet->picture, ink, hull, find_hull(points, count * CORNERS, hull));
    MEM_FREE(points, hull);
}

static void draw_centre(Sheet *sheet, Point at, const char *color)
{
    picture_circle(sheet->picture, (Ink){.stroke = color, .fill = "#ffffff", .width = 1}, at, 3.5);
    picture_circle(sheet->picture, (Ink){.fill = color}, at, 1.5);
}

/* what is beside a beam's axis: arms that don't end on it */
static void draw_brackets(Sheet *sheet, const Instance *beam, Ink ink)
{
    const Model *model = sheet->mechanism->view->model;

    for (int i = 0; i < model_count(model); i++) {
        const Instance *arm = model_instance(model, i);

        if (arm->row->family == FAMILY_ARM && !instance_value(arm, "at")->given &&
            sheet->mechanism->body[arm->head] == beam->head)
            draw_hull(
                sheet,
                (Point[]){sheet_node(sheet, arm->tail, NULL), sheet_node(sheet, arm->head, NULL)},
                2, ink);
    }
}

/* A beam as wide as a link: along one side of its axis, round the end, and back. */
static void draw_bent(Sheet *sheet, const Bent *bent, Ink ink)
{
    enum { CAP = 8 };
    Point edge[2 * (BENT_SPOTS + CAP)], d = {1, 0};
    int count = 0;

    for (int k = 0; k < 2 * BENT_SPOTS; k++) {
        const int side = k < BENT_SPOTS ? 1 : -1;
        const int spot = side > 0 ? k : 2 * BENT_SPOTS - 1 - k;
        const int before = spot > 0 ? spot - 1 : 0;
        const int after = spot < BENT_SPOTS - 1 ? spot + 1 : spot;
        const Point at = sheet_node(sheet, bent->first + spot, NULL);
        const Point a = sheet_node(sheet, bent->first + before, NULL);
        const Point b = sheet_node(sheet, bent->first + after, NULL);
        const double length = hypot(b.x - a.x, b.y - a.y);
        const bool ends = k % BENT_SPOTS == BENT_SPOTS - 1;

        if (length > 1e-6) /* px; seen from its end it has the direction before */
            d = (Point){(b.x - a.x) / length, (b.y - a.y) / length};
        for (int c = 0; c <= (ends ? CAP : 0); c++) {
            const double along = LINK_HALF * side * sin(M_PI * c / CAP);
            const double across = LINK_HALF * side * cos(M_PI * c / CAP);

            edge[count++] =
                (Point){at.x - across * d.y + along * d.x, at.y + across * d.x + along * d.y};
        }
    }
    picture_area(sheet->picture, ink, edge, count);
}

static const Bent *find_bent(const Mechanism *mechanism, const Instance *body)
{
    for (int i = 0; i < mechanism->bents.count; i++)
        if (mechanism->bents.at[i].part == body)
            return &mechanism->bents.at[i];
    return NULL;
}

static void draw_body(Sheet *sheet, const Instance *body)
{
    const Bent *bent = find_bent(sheet->mechanism, body);
    const Mechanism *mechanism = sheet->mechanism;
    const int number = mechanism_color(mechanism, body->head);
    const Ink ink = {.stroke = picture_color(number), .fill = picture_tint(number), .width = 1.6};
    LIST(Point) frames = {0};

    picture_of(sheet->picture, "body", body->name);
    sheet->picture->depth = sheet_depth(sheet, body->head);
    if (bent != NULL) {
        draw_brackets(sheet, body, ink);
        draw_bent(sheet, bent, ink);
        return;
    }
    for (int n = 0; n < mechanism->nodes; n++)
        if (mechanism->body[n] == body->head)
            LIST_PUSH(frames, sheet_node(sheet, n, NULL));
    draw_hull(sheet, frames.at, frames.count, ink);
    draw_centre(sheet, sheet_node(sheet, body->head, NULL), ink.stroke);
    LIST_FREE(frames);
}

static void draw_parts(Sheet *sheet)
{
    const Model *model = sheet->mechanism->view->model;

    for (int i = 0; i < model_count(model); i++)
        if (model_instance(model, i)->row->family == FAMILY_BODY)
            draw_body(sheet, model_instance(model, i));
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        if (instance->row->family == FAMILY_JOINT && !instance->is_virtual)
            sheet_joint(sheet, instance);
        else if (instance->row->places == PLACES_LINK)
            sheet_link(sheet, instance);
    }
    picture_sort(sheet->picture);
}

void mechanism_draw_parts(const Mechanism *mechanism, const double *values, double t, Picture *out)
{
    Sheet sheet = {.mechanism = mechanism, .values = values, .picture = out};

    picture_open(out, mechanism->width, mechanism->height);
    draw_parts(&sheet);
    for (int i = 0; i < mechanism->loads.count; i++)
        sheet_load(&sheet, &mechanism->loads.at[i]);
    sheet_corner(&sheet, t);
}

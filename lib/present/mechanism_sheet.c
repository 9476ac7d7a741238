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

/* links off a beam's axis: arms that don't end on it */
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

enum { SMOOTH = 4, AXIS_POINTS = (BENT_SPOTS - 1) * SMOOTH + 1 }; /* lines between two spots */

/* the curve through the spots of a beam, by cubics that pass each along the line of its neighbours
 */
static void smooth_axis(Sheet *sheet, const Bent *bent, Point *axis)
{
    Point spots[BENT_SPOTS + 2]; /* one before and one after, in line with the curve's end */
    Point *const at = spots + 1;

    for (int k = 0; k < BENT_SPOTS; k++)
        at[k] = sheet_node(sheet, bent->first + k, NULL);
    at[-1] = (Point){3 * (at[0].x - at[1].x) + at[2].x, 3 * (at[0].y - at[1].y) + at[2].y};
    at[BENT_SPOTS] = (Point){
        3 * (at[BENT_SPOTS - 1].x - at[BENT_SPOTS - 2].x) + at[BENT_SPOTS - 3].x,
        3 * (at[BENT_SPOTS - 1].y - at[BENT_SPOTS - 2].y) + at[BENT_SPOTS - 3].y,
    };
    for (int i = 0; i < AXIS_POINTS; i++) {
        const int k = i < AXIS_POINTS - 1 ? i / SMOOTH : BENT_SPOTS - 2;
        const double s = (double)(i - k * SMOOTH) / SMOOTH;
        const double share[] = {s * (s * (2 - s) - 1) / 2, (s * s * (3 * s - 5) + 2) / 2,
                                s * (s * (4 - 3 * s) + 1) / 2, s * s * (s - 1) / 2};

        axis[i] = (Point){0, 0};
        for (int n = 0; n < 4; n++) {
            axis[i].x += share[n] * at[k - 1 + n].x;
            axis[i].y += share[n] * at[k - 1 + n].y;
        }
    }
}

/* A beam as wide as a link: along one side of its axis, round the end, and back. */
static void draw_bent(Sheet *sheet, const Bent *bent, Ink ink)
{
    enum { CAP = 8 };
    Point edge[2 * (AXIS_POINTS + CAP)], axis[AXIS_POINTS], d = {1, 0};
    int count = 0;

    smooth_axis(sheet, bent, axis);
    for (int k = 0; k < 2 * AXIS_POINTS; k++) {
        const int side = k < AXIS_POINTS ? 1 : -1;
        const int spot = side > 0 ? k : 2 * AXIS_POINTS - 1 - k;
        const Point at = axis[spot];
        const Point a = axis[spot > 0 ? spot - 1 : 0];
        const Point b = axis[spot < AXIS_POINTS - 1 ? spot + 1 : spot];
        const double length = hypot(b.x - a.x, b.y - a.y);
        const bool ends = k % AXIS_POINTS == AXIS_POINTS - 1;

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
        else if (instance->row->places == PLACES_LINK || instance->row->places == PLACES_JOINT ||
                 instance->row->places == PLACES_JOINTS)
            sheet_link(sheet, instance);
        else if (instance->row->restore != NULL)
            sheet_bushing(sheet, instance);
        else if (instance->row->family == FAMILY_CONTACT && instance->row->rings == NULL)
            sheet_contact(sheet, instance);
    }
    for (int i = 0; i < sheet->mechanism->rims.count; i++)
        sheet_rim(sheet, &sheet->mechanism->rims.at[i]);
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

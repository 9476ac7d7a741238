/* mechanism_parts.c: joints by what their steps leave free, springs, forces, axes and scale */
#include "present/mechanism_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- small geometry, on paper --- */

static Point plus(Point a, double s, Point d)
{
    return (Point){a.x + s * d.x, a.y + s * d.y};
}

/* a direction of length 1; for a vector normal to the sheet, the given one instead */
static Point unit(Point d, Point instead)
{
    const double length = hypot(d.x, d.y);

    return length > 1e-6 ? (Point){d.x / length, d.y / length} : instead;
}

static Point across(Point d)
{
    return (Point){-d.y, d.x};
}

/* a rectangle about a centre, `half` along d and `wide` across */
static void draw_box(Picture *picture, Ink ink, Point c, Point d, double half, double wide)
{
    const Point n = across(d);
    const Point a = plus(c, half, d), b = plus(c, -half, d);

    picture_area(
        picture, ink,
        (Point[]){plus(a, wide, n), plus(b, wide, n), plus(b, -wide, n), plus(a, -wide, n)}, 4);
}

static double nice(double x)
{
    const double ten = pow(10, floor(log10(x)));

    return x / ten >= 5 ? 5 * ten : x / ten >= 2 ? 2 * ten : ten;
}

/* --- joints --- */

/* what a joint leaves free, by its steps */
typedef struct Freedom {
    int shifts, turns;
    bool is_screw;
    bool has_axis;
    double axis[3]; /* of the first step, in the tail's axes */
} Freedom;

static Freedom freedom_of(const Instance *joint, const View *view)
{
    Steps steps;
    Freedom out = {0};
    const Step *first;

    joint->row->steps(joint, model_arena(view->model), model_is_planar(view->model), &steps);
    out.shifts = steps.shift_count;
    out.turns = steps.quaternion ? 3 : steps.turn_count;
    out.is_screw = steps.shift_count == 1 && steps.turn_count == 1 &&
                   steps.shift[0].coordinate == steps.turn[0].coordinate;
    first = steps.shift_count > 0 ? &steps.shift[0] : steps.turn_count > 0 ? &steps.turn[0] : NULL;
    out.has_axis = first != NULL && out.shifts <= 1 && out.turns <= 2;
    for (int i = 0; out.has_axis && i < 3; i++)
        out.axis[i] = model_number(view->model, first->axis[i]);
    return out;
}

/* a hatched support on the ground */
static void draw_footing(Sheet *sheet, Point at)
{
    const Ink ink = {.stroke = INK_SOFT, .width = 1.2};
    const double half = 11, down = 15;

    picture_area(sheet->picture, (Ink){.stroke = INK_SOFT, .fill = "#eeeeee", .width = 1.2},
                 (Point[]){at, {at.x - half, at.y + down}, {at.x + half, at.y + down}}, 3);
    picture_line(sheet->picture, ink,
                 (Point[]){{at.x - half - 5, at.y + down}, {at.x + half + 5, at.y + down}}, 2);
    for (int i = -2; i <= 3; i++)
        picture_line(
            sheet->picture, ink,
            (Point[]){{at.x + 5.0 * i, at.y + down}, {at.x + 5.0 * i - 5, at.y + down + 5}}, 2);
}

/* the line of a slider, hatched if it is fixed to the ground */
static void draw_rail(Sheet *sheet, Point tail, Point tip, Point d, bool grounded)
{
    const Ink ink = {.stroke = INK_SOFT, .width = 1.4, .dash = grounded ? DASH_NONE : DASH_CENTRE};
    const double reach = 34, offset = grounded ? 10 : 0;
    const double at = (tail.x - tip.x) * d.x + (tail.y - tip.y) * d.y;
    const double low = fmin(at, 0) - reach, high = fmax(at, 0) + reach;
    Point n = across(d);

    if (n.y < 0)
        n = (Point){-n.x, -n.y};

    const Point base = plus(tip, offset, n);

    picture_line(sheet->picture, ink, (Point[]){plus(base, low, d), plus(base, high, d)}, 2);
    for (double s = low; grounded && s <= high; s += 8) {
        const Point p = plus(base, s, d);

        picture_line(sheet->picture, (Ink){.stroke = INK_SOFT, .width = 1},
                     (Point[]){p, plus(plus(p, 5, n), -5, d)}, 2);
    }
}

/* the axis of a joint, where it isn't seen end on */
static void draw_axis(Sheet *sheet, Point at, Point d)
{
    if (hypot(d.x, d.y) < 0.2)
        return;
    picture_line(sheet->picture, (Ink){.stroke = INK_SOFT, .width = 1, .dash = DASH_CENTRE},
                 (Point[]){plus(at, -24, d), plus(at, 24, d)}, 2);
}

static void draw_slider(Sheet *sheet, const Freedom *freedom, Point tip, Point d, Ink box)
{
    draw_box(sheet->picture, box, tip, d, 15, 9);
    if (freedom->turns > 0)
        picture_circle(sheet->picture, box, tip, JOINT_SIZE - 1);
    for (int i = -1; freedom->is_screw && i <= 1; i++)
        picture_line(sheet->picture, box,
                     (Point[]){plus(plus(tip, 8.0 * i - 3, d), -9, across(d)),
                               plus(plus(tip, 8.0 * i + 3, d), 9, across(d))},
                     2);
}

static void draw_pivot(Sheet *sheet, const Freedom *freedom, Point tip)
{
    const Ink ring = {.stroke = INK_DARK, .fill = "#ffffff", .width = 1.6};
    Picture *picture = sheet->picture;

    switch (freedom->turns) {
    case 0: /* a weld */
        draw_box(picture, (Ink){.stroke = INK_DARK, .fill = INK_DARK, .width = 1}, tip,
                 (Point){1, 0}, 4, 4);
        break;
    case 1:
        picture_circle(picture, ring, tip, JOINT_SIZE);
        break;
    case 2:
        picture_circle(picture, ring, tip, JOINT_SIZE + 1);
        picture_line(picture, ring, (Point[]){{tip.x - 6, tip.y}, {tip.x + 6, tip.y}}, 2);
        picture_line(picture, ring, (Point[]){{tip.x, tip.y - 6}, {tip.x, tip.y + 6}}, 2);
        break;
    default: /* a ball in its socket */
        picture_circle(picture, ring, tip, JOINT_SIZE + 2);
        picture_circle(picture, (Ink){.fill = INK_DARK}, tip, JOINT_SIZE - 1);
    }
}

/* A joint lies over the bodies that it joins. */
void sheet_joint(Sheet *sheet, const Instance *joint)
{
    const Mechanism *mechanism = sheet->mechanism;
    const Freedom freedom = freedom_of(joint, mechanism->view);
    const bool grounded = mechanism->body[joint->tail] == mechanism->ground ||
                          mechanism->body[joint->head] == mechanism->ground;
    double axis[3] = {0, 0, 0};
    const Point tail = sheet_node(sheet, joint->tail, NULL);
    const Point tip = sheet_node(sheet, joint->head, NULL);
    Point d;

    if (freedom.shifts + freedom.turns > 4) /* free */
        return;
    if (freedom.has_axis)
        mechanism_turn(mechanism, sheet->values, joint->tail, freedom.axis, axis);
    d = mechanism_direction(mechanism, axis);
    picture_of(sheet->picture, joint->row->name, joint->name);
    sheet->picture->depth =
        fmax(sheet_depth(sheet, joint->tail), sheet_depth(sheet, joint->head)) + 1;
    if (freedom.shifts == 1) {
        /* what turns on a slider lies over it */
        sheet->picture->depth -= 0.5;

        const int color = mechanism_color(mechanism, joint->head);

        d = unit(d, (Point){1, 0});
        draw_rail(sheet, tail, tip, d, grounded);
        draw_slider(sheet, &freedom, tip, d,
                    (Ink){picture_color(color), picture_tint(color), 1.6, DASH_NONE});
        return;
    }
    if (grounded)
        draw_footing(sheet, tip);
    if (freedom.has_axis && freedom.turns == 1)
        draw_axis(sheet, tip, d);
    if (freedom.shifts == 2)
        draw_box(sheet->picture, (Ink){.stroke = INK_DARK, .fill = "#ffffff", .width = 1.5}, tip,
                 (Point){1, 0}, 7, 7);
    else
        draw_pivot(sheet, &freedom, tip);
}

/* --- springs, dampers, actuators --- */

static void draw_spring(Picture *picture, Ink ink, Point a, Point b)
{
    enum { MOST = 15 };
    const double length = hypot(b.x - a.x, b.y - a.y);
    const Point d = unit((Point){b.x - a.x, b.y - a.y}, (Point){1, 0}), n = across(d);
    const double lead = fmax(fmin(12, length / 5), 0.15 * length), body = length - 2 * lead;
    const int turns = (int)fmax(5, fmin(MOST, body / 14));
    Point points[2 * MOST + 4];
    int count = 0;

    points[count++] = a;
    points[count++] = plus(a, lead, d);
    for (int i = 0; i < 2 * turns; i++)
        points[count++] =
            plus(plus(a, lead + body * (i + 0.5) / (2 * turns), d), i % 2 ? -7 : 7, n);
    points[count++] = plus(b, -lead, d);
    points[count++] = b;
    picture_line(picture, ink, points, count);
}

static void draw_damper(Picture *picture, Ink ink, Point a, Point b)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    const Point d = unit((Point){b.x - a.x, b.y - a.y}, (Point){1, 0}), n = across(d);
    const double half = fmin(14, length / 4);
    const Point middle = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    const Point left = plus(middle, -half, d), right = plus(middle, half, d);

    picture_line(picture, ink, (Point[]){a, left}, 2);
    picture_line(
        picture, ink,
        (Point[]){plus(right, 7, n), plus(left, 7, n), plus(left, -7, n), plus(right, -7, n)}, 4);
    picture_line(picture, ink, (Point[]){plus(middle, 5, n), plus(middle, -5, n)}, 2);
    picture_line(picture, ink, (Point[]){middle, b}, 2);
}

static void draw_actuator(Picture *picture, Ink ink, Point a, Point b)
{
    const Point d = unit((Point){b.x - a.x, b.y - a.y}, (Point){1, 0});
    const Ink box = {.stroke = ink.stroke, .fill = "#ffffff", .width = ink.width};

    picture_line(picture, ink, (Point[]){a, b}, 2);
    draw_box(picture, box, plus(a, 0.35, (Point){b.x - a.x, b.y - a.y}), d,
             fmin(20, 0.3 * hypot(b.x - a.x, b.y - a.y)), 6);
}

/* a spring about a hinge: a spiral */
static void draw_spiral(Picture *picture, Ink ink, Point c)
{
    enum { STEPS = 40 };
    Point points[STEPS + 1];

    for (int i = 0; i <= STEPS; i++) {
        const double angle = 4 * M_PI * i / STEPS, radius = JOINT_SIZE + 3 + 10.0 * i / STEPS;

        points[i] = (Point){c.x + radius * cos(angle), c.y + radius * sin(angle)};
    }
    picture_line(picture, ink, points, STEPS + 1);
}

/* where something is fixed in the ground: a wall across what leads there along d */
static void draw_wall(Picture *picture, Point at, Point d)
{
    enum { HATCHES = 4 };
    const double half = 11, step = 2 * half / HATCHES;
    const Point n = across(d);

    picture_line(picture, (Ink){.stroke = INK_SOFT, .width = 1.4},
                 (Point[]){plus(at, -half, n), plus(at, half, n)}, 2);
    for (int i = 1; i <= HATCHES; i++) {
        const Point p = plus(at, i * step - half, n);

        picture_line(picture, (Ink){.stroke = INK_SOFT, .width = 1},
                     (Point[]){p, plus(plus(p, 5, d), -5, n)}, 2);
    }
}

/* what a link's ends are fixed in, where that is the ground and no joint draws it */
static void draw_ends(Sheet *sheet, const Instance *link, Point a, Point b)
{
    const Mechanism *mechanism = sheet->mechanism;
    const Point d = unit((Point){b.x - a.x, b.y - a.y}, (Point){1, 0});

    if (mechanism->body[link->tail] == mechanism->ground)
        draw_wall(sheet->picture, a, (Point){-d.x, -d.y});
    if (mechanism->body[link->head] == mechanism->ground)
        draw_wall(sheet->picture, b, d);
}

void sheet_link(Sheet *sheet, const Instance *link)
{
    const Ink ink = {.stroke = INK_SPRING, .width = 1.4};
    double far, near;
    Point a = sheet_node(sheet, link->tail, &far), b = sheet_node(sheet, link->head, &near);

    picture_of(sheet->picture, link->row->name, link->name);
    sheet->picture->depth = (far + near) / 2;
    if (link->joint >= 0 && link->on_angle) {
        draw_spiral(sheet->picture, ink, b);
        return;
    }
    if (link->joint >= 0) { /* next to the rail */
        const Point n = across(unit((Point){b.x - a.x, b.y - a.y}, (Point){1, 0}));

        a = plus(a, link->row->potential != NULL ? 18 : -18, n);
        b = plus(b, link->row->potential != NULL ? 18 : -18, n);
    }
    draw_ends(sheet, link, a, b);
    if (link->row->potential != NULL)
        draw_spring(sheet->picture, ink, a, b);
    else if (component_param(link->row, "d") >= 0)
        draw_damper(sheet->picture, ink, a, b);
    else
        draw_actuator(sheet->picture, ink, a, b);
}

/* a rod with its eyes, a coupling of two shafts, or the point that is guided */
void sheet_contact(Sheet *sheet, const Instance *contact)
{
    const Ink line = {.stroke = INK_DARK, .width = 2.4}, thin = {.stroke = INK_DARK, .width = 1.4};
    const Ink eye = {.stroke = INK_DARK, .fill = "#ffffff", .width = 1.4};
    double far, near;
    const Point tail = sheet_node(sheet, contact->tail, &far),
                head = sheet_node(sheet, contact->head, &near);

    picture_of(sheet->picture, contact->row->name, contact->name);
    sheet->picture->depth = near;
    if (contact->row->joins) {
        sheet->picture->depth = (far + near) / 2;
        picture_line(sheet->picture, line, (Point[]){tail, head}, 2);
        picture_circle(sheet->picture, eye, tail, JOINT_SIZE - 1);
    }
    if (contact->row->turns)
        picture_circle(sheet->picture, thin, head, JOINT_SIZE + 4);
    picture_circle(sheet->picture, eye, head, JOINT_SIZE - 1);
}

/* a ring of rubber about the pin that it holds */
void sheet_bushing(Sheet *sheet, const Instance *bushing)
{
    const Ink ring = {.stroke = INK_SPRING, .width = 4}, pin = {.stroke = INK_SPRING, .width = 1.4};
    double far, near;
    const Point tail = sheet_node(sheet, bushing->tail, &far),
                head = sheet_node(sheet, bushing->head, &near);

    picture_of(sheet->picture, bushing->row->name, bushing->name);
    sheet->picture->depth = (far + near) / 2;
    picture_circle(sheet->picture, ring, tail, JOINT_SIZE + 5);
    picture_line(sheet->picture, pin, (Point[]){tail, head}, 2);
    picture_circle(sheet->picture, pin, head, JOINT_SIZE);
}

/* --- wheels and balls --- */

/* a rim, and a spoke that shows how it turns */
void sheet_rim(Sheet *sheet, const Rim *rim)
{
    enum { CORNERS = 48 };
    const Mechanism *mechanism = sheet->mechanism;
    const int node = rim->part->head;
    const Ink ink = {.stroke = picture_color(mechanism_color(mechanism, node)), .width = 1.4};
    const Point centre = sheet_node(sheet, node, NULL);
    double first[3], second[3];
    Point points[CORNERS + 1], a, b;

    mechanism_turn(mechanism, sheet->values, node, rim->first, first);
    mechanism_turn(mechanism, sheet->values, node, rim->second, second);
    a = mechanism_direction(mechanism, first);
    b = mechanism_direction(mechanism, second);
    for (int i = 0; i <= CORNERS; i++) {
        const double angle = 2 * M_PI * i / CORNERS;

        points[i] =
            plus(plus(centre, mechanism->scale * cos(angle), a), mechanism->scale * sin(angle), b);
    }
    picture_of(sheet->picture, rim->part->row->name, rim->part->name);
    sheet->picture->depth = sheet_depth(sheet, node);
    picture_line(sheet->picture, ink, points, CORNERS + 1);
    picture_line(sheet->picture, ink, (Point[]){centre, points[0]}, 2);
}

/* --- loads --- */

/* a moment about the look, as far as it has one: an arc, with the clock or against it */
static void draw_moment(Sheet *sheet, Ink ink, Point c, double about)
{
    enum { STEPS = 24 };
    const double share = about * sheet->mechanism->moment;
    const double sweep = (about > 0 ? -1 : 1) * (0.6 + fabs(share)) * M_PI;
    Point points[STEPS + 1];

    if (fabs(share) < 1e-3)
        return;
    for (int i = 0; i <= STEPS; i++)
        points[i] = (Point){c.x + 20 * cos(sweep * i / STEPS), c.y + 20 * sin(sweep * i / STEPS)};
    picture_line(sheet->picture, ink, points, STEPS);
    picture_arrow(sheet->picture, ink, points[STEPS - 3], points[STEPS]);
}

void sheet_load(Sheet *sheet, const Load *load)
{
    const Mechanism *mechanism = sheet->mechanism;
    const Ink ink = {.stroke = load->reaction ? INK_REACT : INK_FORCE, .width = 2};
    const Point at = sheet_node(sheet, load->node, NULL);
    double moment[3];
    const Point d = mechanism_load(mechanism, sheet->values, load, moment);

    picture_of(sheet->picture, load->reaction ? "reaction" : load->owner->row->name,
               load->owner->name);
    if (!isfinite(d.x) || !isfinite(d.y))
        return;
    if (hypot(d.x, d.y) > 1)
        picture_arrow(sheet->picture, ink, at, plus(at, 1, d));
    draw_moment(sheet, ink, at,
                moment[0] * mechanism->axes[2][0] + moment[1] * mechanism->axes[2][1] +
                    moment[2] * mechanism->axes[2][2]);
}

/* --- in the corners --- */

static void draw_triad(Sheet *sheet, Point at)
{
    static const char *const names[] = {"x", "y", "z"};
    Picture *picture = sheet->picture;

    picture_of(picture, "axes", "of ground");
    for (int i = 0; i < 3; i++) {
        const double axis[3] = {i == 0, i == 1, i == 2};
        const Point d = mechanism_direction(sheet->mechanism, axis);
        const Point end = plus(at, 26, d), name = plus(at, 34, d);

        if (hypot(d.x, d.y) < 0.1)
            continue;
        picture_arrow(picture, (Ink){.stroke = INK_SOFT, .width = 1.2}, at, end);
        picture_text(picture, INK_SOFT, (Point){name.x, name.y + 4}, 12, ANCHOR_MIDDLE, names[i]);
    }
}

/* a bar of a round length, and an arrow of a round force */
static void draw_scales(Sheet *sheet, Point at)
{
    const Mechanism *mechanism = sheet->mechanism;
    const double length = nice(100 / mechanism->scale), bar = length * mechanism->scale;
    const Ink ink = {.stroke = INK_DARK, .width = 1.5};
    char text[64];

    picture_of(sheet->picture, "scale", "of lengths and forces");
    picture_line(
        sheet->picture, ink,
        (Point[]){{at.x, at.y - 4}, {at.x, at.y}, {at.x + bar, at.y}, {at.x + bar, at.y - 4}}, 4);
    (void)snprintf(text, sizeof text, length < 0.01 ? "%g mm" : "%g m",
                   length < 0.01 ? length * 1000 : length);
    picture_text(sheet->picture, INK_DARK, (Point){at.x + bar / 2, at.y - 6}, 12, ANCHOR_MIDDLE,
                 text);
    if (mechanism->newton > 0) {
        const double force = nice(70 / mechanism->newton);
        const Point from = {at.x + bar + 30, at.y};

        (void)snprintf(text, sizeof text, "%g N", force);
        picture_arrow(
            sheet->picture,
            (Ink){.stroke = mechanism->options.reactions ? INK_REACT : INK_FORCE, .width = 2}, from,
            (Point){from.x + force * mechanism->newton, from.y});
        picture_text(sheet->picture, INK_DARK,
                     (Point){from.x + force * mechanism->newton / 2, from.y - 6}, 12, ANCHOR_MIDDLE,
                     text);
    }
}

static void draw_gravity(Sheet *sheet, Point at)
{
    const Model *model = sheet->mechanism->view->model;
    const Expr *gravity = model_gravity(model);
    double g[3], size;

    for (int i = 0; i < 3; i++)
        g[i] = model_number(model, gravity[i]);
    size = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (!(size > 0))
        return;
    for (int i = 0; i < 3; i++)
        g[i] /= size;

    const Point d = mechanism_direction(sheet->mechanism, g);

    if (hypot(d.x, d.y) < 0.1)
        return;
    picture_of(sheet->picture, "gravity", "of the scene");
    picture_arrow(sheet->picture, (Ink){.stroke = INK_SOFT, .width = 1.6}, at, plus(at, 30, d));
    picture_text(sheet->picture, INK_SOFT, plus((Point){at.x + 7, at.y + 4}, 15, d), 13,
                 ANCHOR_START, "g");
}

void sheet_corner(Sheet *sheet, double t)
{
    const Mechanism *mechanism = sheet->mechanism;
    const double width = mechanism->width, height = mechanism->height;
    const char *title = model_title(mechanism->view->model);
    char text[48];

    draw_triad(sheet, (Point){44, height - 40});
    draw_scales(sheet, (Point){100, height - 18});
    draw_gravity(sheet, (Point){width - 34, 36});
    picture_of(sheet->picture, "head", "of the picture");
    (void)snprintf(text, sizeof text, "t = %.4g s", t);
    if (title != NULL && *title != '\0')
        picture_text(sheet->picture, INK_DARK, (Point){16, 24}, 15, ANCHOR_START, title);
    picture_text(sheet->picture, INK_DARK, (Point){width - 60, 24}, 13, ANCHOR_END,
                 mechanism->options.caption != NULL ? mechanism->options.caption : text);
}

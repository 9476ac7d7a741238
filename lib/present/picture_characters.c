/* picture_characters.c: a picture on a screen of characters
 *
 * A cell has 2 x 4 dots (columns x rows) with braille characters (Unicode 2800), else 1 x 2.
 * Lightly filled areas are erased, so that they hide what is behind them; texts are drawn over the
 * dots. */
#include "present/picture.h"

#include <math.h>
#include <string.h>

typedef struct Screen {
    int columns, rows; /* of cells */
    int across, down;  /* dots of a cell */
    double scale;      /* dots a px */
    bool *dots;
    char (*over)[5]; /* the character over a cell, in UTF-8; "" none */
} Screen;

static int width_of(const Screen *screen)
{
    return screen->columns * screen->across;
}

static int height_of(const Screen *screen)
{
    return screen->rows * screen->down;
}

static void set_dot(Screen *screen, int x, int y, bool on)
{
    if (x >= 0 && y >= 0 && x < width_of(screen) && y < height_of(screen))
        screen->dots[y * width_of(screen) + x] = on;
}

static void draw_line(Screen *screen, Point a, Point b)
{
    const double far = fmax(fabs(b.x - a.x), fabs(b.y - a.y));
    const int steps = far < 1e4 ? (int)ceil(far) : 10000;

    for (int i = 0; i <= steps; i++) {
        const double s = steps > 0 ? (double)i / steps : 0;

        set_dot(screen, (int)floor(a.x + s * (b.x - a.x)), (int)floor(a.y + s * (b.y - a.y)), true);
    }
}

/* every line of dots between the sides that it crosses, by the even-odd rule */
static void fill(Screen *screen, const Point *corners, int count, bool on)
{
    for (int y = 0; y < height_of(screen); y++) {
        const double level = y + 0.5;

        for (int x = 0; x < width_of(screen); x++) {
            bool inside = false;

            for (int i = 0, j = count - 1; i < count; j = i++)
                if ((corners[i].y > level) != (corners[j].y > level) &&
                    x + 0.5 < corners[i].x + (level - corners[i].y) *
                                                 (corners[j].x - corners[i].x) /
                                                 (corners[j].y - corners[i].y))
                    inside = !inside;
            if (inside)
                set_dot(screen, x, y, on);
        }
    }
}

/* dark enough to be seen as ink */
static bool is_dark(const char *color)
{
    return color[1] < 'b' || color[3] < 'b';
}

static void draw_area(Screen *screen, const Shape *shape, const Point *corners, int count)
{
    if (shape->ink.fill != NULL)
        fill(screen, corners, count, is_dark(shape->ink.fill));
    if (shape->ink.stroke == NULL)
        return;
    for (int i = 0; i < count; i++)
        draw_line(screen, corners[i], corners[(i + 1) % count]);
}

static Point on_screen(const Screen *screen, Point p)
{
    return (Point){p.x * screen->scale, p.y * screen->scale};
}

static void draw_circle(Screen *screen, const Shape *shape, Point centre)
{
    enum { CORNERS = 24 };
    Point corners[CORNERS];
    /* a smaller one would be no circle */
    const double radius = fmax(shape->size * screen->scale, 1.5);

    for (int i = 0; i < CORNERS; i++)
        corners[i] = (Point){centre.x + radius * cos(2 * M_PI * i / CORNERS),
                             centre.y + radius * sin(2 * M_PI * i / CORNERS)};
    draw_area(screen, shape, corners, CORNERS);
}

static int character_length(const char *text)
{
    int length = 1;

    while (length < 4 && ((unsigned char)text[length] & 0xC0) == 0x80)
        length++;
    return length;
}

static void draw_text(Screen *screen, const Shape *shape, Point at)
{
    const int row = (int)floor(at.y / screen->down - 0.01);
    const int width = text_width(shape->text);
    int column = (int)floor(at.x / screen->across) - (shape->anchor == ANCHOR_MIDDLE ? width / 2
                                                      : shape->anchor == ANCHOR_END  ? width
                                                                                     : 0);

    for (const char *c = shape->text; *c != '\0'; column++) {
        const int length = character_length(c);

        if (row >= 0 && row < screen->rows && column >= 0 && column < screen->columns)
            memcpy(screen->over[row * screen->columns + column], c, (size_t)length);
        c += length;
    }
}

static void draw_shape(Screen *screen, const Picture *picture, const Shape *shape)
{
    Point *points = NEW_ARRAY(Point, shape->count);

    for (int i = 0; i < shape->count; i++)
        points[i] = on_screen(screen, picture->points.at[shape->first + i]);
    if (shape->kind == SHAPE_CIRCLE)
        draw_circle(screen, shape, points[0]);
    else if (shape->kind == SHAPE_AREA)
        draw_area(screen, shape, points, shape->count);
    else if (shape->kind == SHAPE_TEXT)
        draw_text(screen, shape, points[0]);
    for (int i = 1; shape->kind == SHAPE_LINE && i < shape->count; i++)
        draw_line(screen, points[i - 1], points[i]);
    mem_free(points);
}

static bool dot(const Screen *screen, int column, int row, int x, int y)
{
    return screen->dots[(row * screen->down + y) * width_of(screen) + column * screen->across + x];
}

/* dots of braille count down the left, down the right, and then the lowest two */
static void write_braille(Text *out, const Screen *screen, int column, int row)
{
    static const unsigned char bits[4][2] = {
        {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    unsigned cell = 0;

    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 2; x++)
            cell |= dot(screen, column, row, x, y) ? bits[y][x] : 0U;
    if (cell == 0) {
        text_char(out, ' ');
        return;
    }
    text_char(out, (char)0xE2);
    text_char(out, (char)(0xA0 | cell >> 6));
    text_char(out, (char)(0x80 | (cell & 0x3F)));
}

static void write_cell(Text *out, const Screen *screen, int column, int row)
{
    const char *over = screen->over[row * screen->columns + column];

    if (over[0] != '\0')
        text_add(out, over);
    else if (screen->across == 2)
        write_braille(out, screen, column, row);
    else
        text_char(out, " '.:"[dot(screen, column, row, 0, 0) + 2 * dot(screen, column, row, 0, 1)]);
}

void picture_characters(const Picture *picture, int columns, int rows, bool unicode, Text *out)
{
    Screen screen = {.across = unicode ? 2 : 1, .down = unicode ? 4 : 2};

    screen.scale =
        fmin(columns * screen.across / picture->width, rows * screen.down / picture->height);
    screen.columns = columns;
    screen.rows = (int)ceil(picture->height * screen.scale / screen.down);
    screen.dots = NEW_ARRAY(bool, width_of(&screen) * height_of(&screen));
    screen.over = mem_array((size_t)screen.columns * (size_t)screen.rows, sizeof *screen.over);
    for (int i = 0; i < picture->shapes.count; i++)
        draw_shape(&screen, picture, &picture->shapes.at[i]);
    for (int row = 0; row < screen.rows; row++) {
        for (int column = 0; column < screen.columns; column++)
            write_cell(out, &screen, column, row);
        while (out->length > 0 && out->at[out->length - 1] == ' ')
            out->length--;
        text_char(out, '\n');
    }
    MEM_FREE(screen.dots, screen.over);
}

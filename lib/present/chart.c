/* chart.c: a chart as a picture whose px are dots, so that texts fall on cells */
#include "present/chart.h"

#include "present/picture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_TICKS = 30, TICK_TEXT = 24, LEAST_COLUMNS = 20, LEAST_ROWS = 8 };
enum { ROWS_A_TICK = 3, COLUMNS_A_TICK = 11, LEAST_PARTS = 2 };

typedef struct Axis {
    double low, high; /* of log: their logarithms to the base 10 */
    bool is_log;
    int count;
    double ticks[MOST_TICKS];
    char texts[MOST_TICKS][TICK_TEXT];
} Axis;

/* positions, in cells */
typedef struct ChartSheet {
    Picture *picture;
    const Chart *chart;
    bool unicode;
    int across, down; /* dots of a cell */
    int columns, rows;
    int left, right, top, bottom; /* of the area of curves: first, and one after the last */
    Axis x, y[2];
} ChartSheet;

/* --- axes --- */

static double on_axis(const Axis *axis, double value)
{
    return axis->is_log ? value > 0 ? log10(value) : NAN : value;
}

static void widen(Axis *axis, double value)
{
    const double at = on_axis(axis, value);

    if (!isfinite(at))
        return;
    axis->low = fmin(axis->low, at);
    axis->high = fmax(axis->high, at);
}

/* an interval to draw, if there are no values or a constant */
static void open_up(Axis *axis)
{
    if (axis->low > axis->high)
        axis->low = axis->high = 0;
    if (axis->high - axis->low <= 1e-9 * fmax(fabs(axis->low), fabs(axis->high))) {
        const double room = axis->low != 0 && !axis->is_log ? 0.1 * fabs(axis->low) : 1;

        axis->low -= room;
        axis->high += room;
    }
}

/* 1, 2 or 5 times a power of ten: about `parts` of them in the span */
static double step_of(double span, int parts)
{
    const double raw = span / (parts > 1 ? parts : 1);
    const double power = pow(10, floor(log10(raw)));
    const double part = raw / power;

    return power * (part <= 1.001 ? 1 : part <= 2.001 ? 2 : part <= 5.001 ? 5 : 10);
}

static void add_tick(Axis *axis, double at, double value, double step)
{
    const double most = fmax(fabs(axis->low), fabs(axis->high));
    int digits = axis->is_log ? 6 : (int)ceil(log10(most / step)) + 1;

    if (axis->count == MOST_TICKS)
        return;
    digits = digits < 6 ? 6 : digits > 12 ? 12 : digits;
    axis->ticks[axis->count] = at;
    (void)snprintf(axis->texts[axis->count++], TICK_TEXT, "%.*g", digits,
                   fabs(value) < 1e-9 * step ? 0.0 : value);
}

static void add_log_ticks(Axis *axis, int parts)
{
    static const int factors[] = {1, 2, 5};
    const double decades = axis->high - axis->low;
    const int step = (int)ceil(decades / (parts > 1 ? parts : 1));
    const int few = decades < 2 ? 3 : 1;

    for (int d = (int)floor(axis->low); d <= axis->high; d += step > 1 ? step : 1)
        for (int f = 0; f < few; f++) {
            const double value = factors[f] * pow(10, d);

            if (log10(value) >= axis->low - 1e-9 && log10(value) <= axis->high + 1e-9)
                add_tick(axis, log10(value), value, 0);
        }
}

static void add_ticks(Axis *axis, int parts)
{
    if (axis->is_log) {
        add_log_ticks(axis, parts);
        return;
    }

    const double step = step_of(axis->high - axis->low, parts);

    for (double k = ceil(axis->low / step - 1e-9); k * step <= axis->high + 1e-9 * step; k++)
        add_tick(axis, k * step, k * step, step);
}

/* to whole steps, so that no curve lies on the frame */
static void round_out(Axis *axis, int parts)
{
    const double step = axis->is_log ? 1 : step_of(axis->high - axis->low, parts);

    axis->low = step * floor(axis->low / step + 1e-9);
    axis->high = step * ceil(axis->high / step - 1e-9);
}

static void set_range(Axis *axis, const double range[2])
{
    axis->low = on_axis(axis, range[0]);
    axis->high = on_axis(axis, range[1]);
    if (!isfinite(axis->low)) /* a logarithmic axis that was to start at 0 */
        axis->low = axis->high - 6;
}

static bool is_seen(const ChartSheet *sheet, double x)
{
    const double at = on_axis(&sheet->x, x);

    return at >= sheet->x.low - DBL_EPSILON * fabs(at) &&
           at <= sheet->x.high + DBL_EPSILON * fabs(at);
}

static void find_ranges(ChartSheet *sheet, int parts)
{
    const Chart *chart = sheet->chart;

    sheet->x = (Axis){INFINITY, -INFINITY, .is_log = chart->x_is_log};
    for (int i = 0; i < chart->count; i++)
        for (int k = 0; k < chart->curves[i].count; k++)
            widen(&sheet->x, chart->curves[i].x[(ptrdiff_t)k * chart->curves[i].stride] *
                                 chart->curves[i].x_scale);
    if (!isnan(chart->x[0]))
        set_range(&sheet->x, chart->x);
    open_up(&sheet->x);
    for (int side = 0; side < 2; side++) {
        Axis *axis = &sheet->y[side];

        *axis = (Axis){INFINITY, -INFINITY, .is_log = chart->y_is_log};
        for (int i = 0; i < chart->count; i++) {
            const ChartCurve *curve = &chart->curves[i];

            for (int k = 0; curve->is_right == (side == 1) && k < curve->count; k++)
                if (is_seen(sheet, curve->x[(ptrdiff_t)k * curve->stride] * curve->x_scale))
                    widen(axis, curve->y[(ptrdiff_t)k * curve->stride]);
        }
        open_up(axis);
        if (side == 0 && !isnan(chart->y[0]))
            set_range(axis, chart->y);
        else
            round_out(axis, parts);
    }
    if (isnan(chart->x[0]) && !chart->fits_x)
        round_out(&sheet->x, 2 * parts);
}

/* A length along x is as long along y: the shorter range grows. Dots are square. */
static void make_equal(ChartSheet *sheet)
{
    Axis *x = &sheet->x, *y = &sheet->y[0];
    const double a = (x->high - x->low) / ((sheet->right - sheet->left) * sheet->across);
    const double b = (y->high - y->low) / ((sheet->bottom - sheet->top) * sheet->down);
    Axis *grown = a < b ? x : y;
    const double more = (fmax(a, b) / fmin(a, b) - 1) * (grown->high - grown->low) / 2;

    grown->low -= more;
    grown->high += more;
}

/* --- the frame --- */

static void put(const ChartSheet *sheet, int column, int row, Anchor anchor, const char *text)
{
    picture_text(sheet->picture, "#000000",
                 (Point){(double)column * sheet->across, (row + 1.0) * sheet->down}, 1, anchor,
                 text);
}

static int widest(const Axis *axis)
{
    int width = 0;

    for (int i = 0; i < axis->count; i++)
        width = text_width(axis->texts[i]) > width ? text_width(axis->texts[i]) : width;
    return width;
}

/* position of a value, in dots */
static double place_x(const ChartSheet *sheet, double at)
{
    const double width = (double)(sheet->right - sheet->left) * sheet->across - 1;

    return sheet->left * sheet->across + 0.5 +
           (at - sheet->x.low) / (sheet->x.high - sheet->x.low) * width;
}

static double place_y(const ChartSheet *sheet, const Axis *axis, double at)
{
    const double height = (double)(sheet->bottom - sheet->top) * sheet->down - 1;

    return sheet->bottom * sheet->down - 0.5 - (at - axis->low) / (axis->high - axis->low) * height;
}

static bool has_right(const Chart *chart)
{
    for (int i = 0; i < chart->count; i++)
        if (chart->curves[i].is_right)
            return true;
    return false;
}

static void write_upright(const ChartSheet *sheet, int side)
{
    const Axis *axis = &sheet->y[side];
    const int column = side == 0 ? sheet->left - 1 : sheet->right;
    const char *const line = sheet->unicode ? "│" : "|";
    const char *const tick = !sheet->unicode ? "+" : side == 0 ? "┤" : "├";

    for (int row = sheet->top; row < sheet->bottom; row++)
        put(sheet, column, row, ANCHOR_START, line);
    for (int i = 0; i < axis->count; i++) {
        const int row = (int)floor(place_y(sheet, axis, axis->ticks[i]) / sheet->down);

        put(sheet, column, row, ANCHOR_START, tick);
        put(sheet, side == 0 ? column - 1 : column + 2, row, side == 0 ? ANCHOR_END : ANCHOR_START,
            axis->texts[i]);
    }
}

static void write_base(const ChartSheet *sheet)
{
    const Chart *chart = sheet->chart;
    int free_from = 0; /* the first column without text */

    put(sheet, sheet->left - 1, sheet->bottom, ANCHOR_START, sheet->unicode ? "└" : "+");
    for (int column = sheet->left; column < sheet->right; column++)
        put(sheet, column, sheet->bottom, ANCHOR_START, sheet->unicode ? "─" : "-");
    if (has_right(chart))
        put(sheet, sheet->right, sheet->bottom, ANCHOR_START, sheet->unicode ? "┘" : "+");
    for (int i = 0; i < sheet->x.count; i++) {
        const int width = text_width(sheet->x.texts[i]);
        const int column = (int)floor(place_x(sheet, sheet->x.ticks[i]) / sheet->across);
        int start = column - width / 2;

        start = start + width > sheet->columns ? sheet->columns - width : start;
        put(sheet, column, sheet->bottom, ANCHOR_START, sheet->unicode ? "┴" : "+");
        if (start < free_from)
            continue;
        put(sheet, start, sheet->bottom + 1, ANCHOR_START, sheet->x.texts[i]);
        free_from = start + width + 1;
    }
    put(sheet, (sheet->left + sheet->right) / 2, sheet->bottom + 2, ANCHOR_MIDDLE, chart->x_label);
}

/* --- curves --- */

static void letter_of(int curve, char letter[2])
{
    letter[0] = (char)('a' + curve % 26);
    letter[1] = '\0';
}

/* Liang and Barsky (1984): the part of a to b inside the area; false: none */
static bool clip(const ChartSheet *sheet, Point *a, Point *b)
{
    const double x[2] = {(double)sheet->left * sheet->across, (double)sheet->right * sheet->across};
    const double y[2] = {(double)sheet->top * sheet->down, (double)sheet->bottom * sheet->down};
    const Point d = {b->x - a->x, b->y - a->y}, from = *a;
    const double p[4] = {-d.x, d.x, -d.y, d.y};
    const double q[4] = {a->x - x[0], x[1] - 0.01 - a->x, a->y - y[0], y[1] - 0.01 - a->y};
    double first = 0, last = 1;

    for (int i = 0; i < 4; i++) {
        if (p[i] == 0 && q[i] < 0)
            return false;
        if (p[i] < 0)
            first = fmax(first, q[i] / p[i]);
        else if (p[i] > 0)
            last = fmin(last, q[i] / p[i]);
    }
    *a = (Point){from.x + first * d.x, from.y + first * d.y};
    *b = (Point){from.x + last * d.x, from.y + last * d.y};
    return first <= last;
}

static bool is_inside(const ChartSheet *sheet, Point p)
{
    Point same = p;

    return clip(sheet, &p, &same);
}

static void write_letter(const ChartSheet *sheet, Point at, const char *letter)
{
    put(sheet, (int)floor(at.x / sheet->across), (int)floor(at.y / sheet->down), ANCHOR_START,
        letter);
}

static void draw_curve(const ChartSheet *sheet, int number)
{
    static const Ink ink = {"#000000", NULL, 1, DASH_NONE};
    const Chart *chart = sheet->chart;
    const ChartCurve *curve = &chart->curves[number];
    const Axis *axis = &sheet->y[curve->is_right];
    /* the letter of each curve about six times along the width, those of different curves offset */
    const double spacing = (sheet->right - sheet->left) * sheet->across / 6.0;
    double travelled = spacing * (number + 0.5) / chart->count;
    Point last = {NAN, NAN};
    char letter[2];

    letter_of(number, letter);
    for (int k = 0; k < curve->count; k++) {
        const ptrdiff_t at = (ptrdiff_t)k * curve->stride;
        const Point p = {place_x(sheet, on_axis(&sheet->x, curve->x[at] * curve->x_scale)),
                         place_y(sheet, axis, on_axis(axis, curve->y[at]))};
        const double way = hypot(p.x - last.x, p.y - last.y);

        if (curve->is_points && isfinite(p.x) && isfinite(p.y) && is_inside(sheet, p))
            write_letter(sheet, p, chart->count > 1 ? letter : "o");
        if (curve->is_points || way < 0.3)
            continue;

        Point ends[2] = {last, p};

        last = p;
        if (!isfinite(way) || !clip(sheet, &ends[0], &ends[1]))
            continue;
        picture_line(sheet->picture, ink, ends, 2);
        travelled += hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y);
        if (chart->count > 1 && travelled >= spacing) {
            write_letter(sheet, ends[1], letter);
            travelled = 0;
        }
    }
}

static void draw_marks(const ChartSheet *sheet)
{
    static const Ink ink = {"#000000", NULL, 1, DASH_NONE};
    const Chart *chart = sheet->chart;

    for (int i = 0; i < chart->mark_count; i++) {
        const Point at = {place_x(sheet, on_axis(&sheet->x, chart->marks[i].x)),
                          sheet->top * sheet->down};

        if (!is_inside(sheet, at))
            continue;
        for (int y = sheet->top * sheet->down; y < sheet->bottom * sheet->down; y += 3) {
            const Point dot[2] = {{at.x, y}, {at.x, y}};

            picture_line(sheet->picture, ink, dot, 2);
        }
        put(sheet, (int)floor(at.x / sheet->across) + 1, sheet->top, ANCHOR_START,
            chart->marks[i].name);
    }
}

/* --- the legend --- */

/* Entries "a h1 [deg]", as many in a line as fit; how many lines. `row` -1 counts alone. */
static int write_legend(const ChartSheet *sheet, int row)
{
    const Chart *chart = sheet->chart;
    int column = 0, lines = 1;

    for (int i = 0; chart->count > 1 && i < chart->count; i++) {
        const char *right = chart->curves[i].is_right ? " (right)" : "";
        const int width = text_width(chart->curves[i].label) + (int)strlen(right) + 2;
        Text entry = {0};
        char letter[2];

        if (column > 0 && column + width > sheet->columns) {
            column = 0;
            lines++;
        }
        letter_of(i, letter);
        text_addf(&entry, "%s %s%s", letter, chart->curves[i].label, right);
        if (row >= 0)
            put(sheet, column, row + lines - 1, ANCHOR_START, entry.at);
        text_free(&entry);
        column += width + 3;
    }
    return chart->count > 1 ? lines : 0;
}

/* --- a chart --- */

/* width of ticks, left and right */
static void measure(ChartSheet *sheet, int *left, int *right)
{
    const Chart *chart = sheet->chart;

    sheet->top =
        (chart->title[0] != '\0') + (chart->y_label[0][0] != '\0' || chart->y_label[1][0] != '\0');
    sheet->bottom = sheet->rows - 2 - (chart->x_label[0] != '\0') - write_legend(sheet, -1);
    if (sheet->bottom < sheet->top + 2)
        sheet->bottom = sheet->top + 2;

    const int fitting = (sheet->bottom - sheet->top) / ROWS_A_TICK;
    const int parts = fitting < LEAST_PARTS ? LEAST_PARTS : fitting;

    find_ranges(sheet, parts);
    for (int side = 0; side < 2; side++)
        add_ticks(&sheet->y[side], parts);
    *left = widest(&sheet->y[0]) + 2 > *left ? widest(&sheet->y[0]) + 2 : *left;
    if (has_right(chart) && widest(&sheet->y[1]) + 3 > *right)
        *right = widest(&sheet->y[1]) + 3;
}

static void draw(ChartSheet *sheet)
{
    const Chart *chart = sheet->chart;
    const int labels = chart->title[0] != '\0';

    if (chart->has_equal_scales) {
        make_equal(sheet);
        sheet->y[0].count = 0;
        add_ticks(&sheet->y[0], (sheet->bottom - sheet->top) / ROWS_A_TICK);
    }
    add_ticks(&sheet->x, (sheet->right - sheet->left) / COLUMNS_A_TICK);
    put(sheet, (sheet->left + sheet->right) / 2, 0, ANCHOR_MIDDLE, chart->title);
    put(sheet, 0, labels, ANCHOR_START, chart->y_label[0]);
    put(sheet, sheet->columns, labels, ANCHOR_END, chart->y_label[1]);
    draw_marks(sheet);
    for (int i = 0; i < chart->count; i++)
        draw_curve(sheet, i);
    write_upright(sheet, 0);
    if (has_right(chart))
        write_upright(sheet, 1);
    write_base(sheet);
    (void)write_legend(sheet, sheet->bottom + 2 + (chart->x_label[0] != '\0'));
}

void chart_text(const Chart *charts, int count, int columns, int rows, bool unicode, Text *out)
{
    ChartSheet *sheets = NEW_ARRAY(ChartSheet, count);
    int left = 0, right = 1;

    columns = columns < LEAST_COLUMNS ? LEAST_COLUMNS : columns;
    rows = rows / (count > 0 ? count : 1);
    for (int i = 0; i < count; i++) {
        sheets[i] = (ChartSheet){.chart = &charts[i],
                                 .unicode = unicode,
                                 .across = unicode ? 2 : 1,
                                 .down = unicode ? 4 : 2,
                                 .columns = columns,
                                 .rows = rows < LEAST_ROWS ? LEAST_ROWS : rows};
        measure(&sheets[i], &left, &right);
    }
    for (int i = 0; i < count; i++) {
        ChartSheet *sheet = &sheets[i];
        Picture picture;

        sheet->left = left;
        sheet->right = columns - right > left + 4 ? columns - right : left + 4;
        picture_open(&picture, (double)columns * sheet->across, (double)sheet->rows * sheet->down);
        sheet->picture = &picture;
        draw(sheet);
        picture_characters(&picture, columns, sheet->rows, unicode, out);
        picture_close(&picture);
    }
    mem_free(sheets);
}

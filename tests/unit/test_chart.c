/* test_chart.c: a plot of characters, read as a person reads it
 *
 * Ticks and their numbers tell what a column and a row stand for; the dots of the curve have to lie
 * where the function has its values. */
#include "session_kit.h"

#include <math.h>
#include <stddef.h>

enum { MOST_LINES = 80, MOST_COLUMNS = 240 };

typedef struct Grid {
    int lines;
    int columns[MOST_LINES];
    unsigned cell[MOST_LINES][MOST_COLUMNS]; /* Unicode */
} Grid;

static void read_grid(const char *text, Grid *out)
{
    *out = (Grid){0};
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0';) {
        const int length = *c < 0x80 ? 1 : *c < 0xE0 ? 2 : *c < 0xF0 ? 3 : 4;
        unsigned code = length == 1 ? *c : *c & (0x7FU >> length);

        for (int i = 1; i < length; i++)
            code = code << 6 | (c[i] & 0x3FU);
        c += length;
        if (code == '\n')
            out->lines++;
        else if (out->lines < MOST_LINES && out->columns[out->lines] < MOST_COLUMNS)
            out->cell[out->lines][out->columns[out->lines]++] = code;
    }
}

static unsigned at(const Grid *grid, int line, int column)
{
    return line < grid->lines && column >= 0 && column < grid->columns[line]
               ? grid->cell[line][column]
               : ' ';
}

/* the number around a column, or that ends before it */
static double number_at(const Grid *grid, int line, int column)
{
    char text[40] = "";
    int start = column, length = 0;

    while (start > 0 && at(grid, line, start - 1) != ' ')
        start--;
    while (length < 39 && at(grid, line, start + length) != ' ') {
        text[length] = (char)at(grid, line, start + length);
        length++;
    }
    return strtod(text, NULL);
}

/* what a column or a row stands for: straight through the first and the last tick */
typedef struct Scale {
    double first, last; /* cells, from the middle of one */
    double values[2];
    int count;
} Scale;

static void add_tick(Scale *scale, double cell, double value, bool is_log)
{
    const int place = scale->count++ > 0;

    *(place == 0 ? &scale->first : &scale->last) = cell;
    scale->values[place] = is_log ? log10(value) : value;
}

static double value_at(const Scale *scale, double cell)
{
    return scale->values[0] + (cell - scale->first) / (scale->last - scale->first) *
                                  (scale->values[1] - scale->values[0]);
}

static double a_cell(const Scale *scale)
{
    return fabs((scale->values[1] - scale->values[0]) / (scale->last - scale->first));
}

/* the mean place of the dots of a cell, from its upper left corner; false: it has none */
static bool dots_of(unsigned code, double *x, double *y)
{
    static const unsigned bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    int count = 0;

    *x = *y = 0;
    for (int row = 0; code > 0x2800 && code <= 0x28FF && row < 4; row++)
        for (int column = 0; column < 2; column++)
            if ((code & bits[row][column]) != 0) {
                *x += (column + 0.5) / 2;
                *y += (row + 0.5) / 4;
                count++;
            }
    if (code == '\'' || code == '.' || code == ':') {
        *x = 0.5;
        *y = code == '\'' ? 0.25 : code == '.' ? 0.75 : 0.5;
        count = 1;
    }
    *x /= count > 0 ? count : 1;
    *y /= count > 0 ? count : 1;
    return count > 0;
}

/* the line of the axis below, the column of the one at the left */
static bool find_frame(const Grid *grid, bool unicode, int *base, int *left)
{
    for (*base = 0; *base < grid->lines; ++*base)
        for (*left = 0; *left < grid->columns[*base]; ++*left) {
            const unsigned code = at(grid, *base, *left), next = at(grid, *base, *left + 2);

            if (unicode ? code == 0x2514 : code == '+' && next == '-')
                return true;
        }
    return false;
}

typedef double Curve(double x);

/* every dot lies on the curve, and every column has one; how many dots are off */
static int count_faults(const ct_chart *chart, Curve *curve, int columns, int rows, bool unicode)
{
    char *text = ct_chart_text(chart, 1, columns, rows, unicode);
    Grid grid;
    Scale x = {0}, y = {0};
    int base = 0, left = 0, faults = 0, seen = 0;

    read_grid(text, &grid);
    EXPECT(grid.lines == rows);
    if (!find_frame(&grid, unicode, &base, &left)) {
        ct_free(text);
        return 1000;
    }
    for (int row = 0; row < base; row++)
        if (at(&grid, row, left) == (unicode ? 0x2524 : '+'))
            add_tick(&y, row + 0.5, number_at(&grid, row, left - 1), chart->y_is_log);
    for (int c = left + 1; c < grid.columns[base]; c++)
        if (at(&grid, base, c) == (unicode ? 0x2534 : '+') && at(&grid, base + 1, c) != ' ')
            add_tick(&x, c + 0.5, number_at(&grid, base + 1, c), chart->x_is_log);
    EXPECT(x.count > 1 && y.count > 1);
    for (int c = left + 1; c < columns; c++) {
        bool has = false;

        for (int row = 0; row < base; row++) {
            double dx, dy;

            if (!dots_of(at(&grid, row, c), &dx, &dy))
                continue;

            /* ticks stand in the middle of their cells, half a cell off at worst at either end */
            const double px = value_at(&x, c + dx), py = value_at(&y, row + dy);
            double low = INFINITY, high = -INFINITY;

            for (int k = -8; k <= 8; k++) {
                const double q = px + k * a_cell(&x) / 5;
                const double v = curve(chart->x_is_log ? pow(10, q) : q);

                low = fmin(low, chart->y_is_log ? log10(v) : v);
                high = fmax(high, chart->y_is_log ? log10(v) : v);
            }
            faults += py < low - 1.3 * a_cell(&y) || py > high + 1.3 * a_cell(&y);
            has = true;
        }
        seen += has;
    }
    EXPECT(seen >= columns - left - 4);
    ct_free(text);
    return faults;
}

static double wave(double x)
{
    return 3 * sin(2 * x) - 20;
}

static double tiny(double x)
{
    return 1e-7 * (x - 1) * (x - 2);
}

static double power(double x)
{
    return 0.01 * x * x * x;
}

enum { ROWS = 400 };

static ct_chart chart_of(ct_curve *curve)
{
    return (ct_chart){.title = "",
                      .x_label = "t [s]",
                      .left_label = "x [m]",
                      .right_label = "",
                      .x = {NAN, NAN},
                      .y = {NAN, NAN},
                      .fits_x = true,
                      .curves = curve,
                      .count = 1};
}

static void dots_lie_where_the_function_has_its_values(void)
{
    static Curve *const curves[] = {wave, tiny, power};
    static const int sizes[][2] = {{60, 20}, {79, 30}, {200, 38}, {120, 12}};
    static double values[ROWS][2];
    ct_curve curve = {values[0], values[0] + 1, ROWS, 2, 1, "x [m]", false, false};

    for (size_t f = 0; f < sizeof curves / sizeof curves[0]; f++)
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
            for (int kind = 0; kind < 4; kind++) {
                const bool is_log = kind >= 2 && curves[f] == power;
                ct_chart chart = chart_of(&curve);

                chart.x_is_log = chart.y_is_log = is_log;
                for (int i = 0; i < ROWS; i++) {
                    const double u = i / (ROWS - 1.0);

                    values[i][0] = is_log ? pow(10, 3 * u - 1) : 5 * u;
                    values[i][1] = curves[f](values[i][0]);
                }

                const int faults =
                    count_faults(&chart, curves[f], sizes[s][0], sizes[s][1], kind % 2 == 0);

                if (faults > 0) {
                    test_faults++;
                    printf("curve %zu, %d x %d, kind %d: %d dots are off\n", f, sizes[s][0],
                           sizes[s][1], kind, faults);
                }
            }
}

/* whatever is asked for: no line wider than that, no curve over the labels */
static void strange_charts_are_drawn(void)
{
    static const double nothing[2] = {NAN, INFINITY}, level[2] = {7, 7}, times[2] = {0, 1},
                        huge[2] = {-1e300, 1e300};
    static const double *const all[] = {nothing, level, times, huge};

    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 16; k++) {
            ct_curve curves[2] = {
                {all[i], all[k % 4], 2, 1, 1, "a long name of a curve", false, false},
                {times, all[i], 2, 1, 1, "b", k % 3 == 0, k % 2 == 0}};
            ct_chart chart = chart_of(curves);

            chart.count = k / 8 + 1;
            chart.x_is_log = k % 5 == 0;
            chart.has_equal_scales = k % 7 == 0;
            chart.x[0] = k == 3 ? -1 : NAN;
            chart.x[1] = k == 3 ? 0.5 : NAN;

            char *text = ct_chart_text(&chart, 1, 10 + 5 * k, k, k % 2 == 0);
            Grid grid;

            read_grid(text, &grid);
            EXPECT(grid.lines >= 8);
            for (int line = 0; line < grid.lines; line++)
                EXPECT(grid.columns[line] <= (10 + 5 * k < 20 ? 20 : 10 + 5 * k));
            ct_free(text);
        }
}

/* each of several curves carries its letter, and the legend says what it is */
static void several_curves_carry_letters(void)
{
    static double values[ROWS][4];
    ct_curve curves[3];
    ct_chart chart = chart_of(curves);
    int found[3] = {0};
    char *text;
    Grid grid;

    for (int i = 0; i < ROWS; i++) {
        values[i][0] = i;
        for (int k = 1; k < 4; k++)
            values[i][k] = 10.0 * k + 1e-3 * i;
    }
    for (int k = 0; k < 3; k++)
        curves[k] = (ct_curve){values[0], values[0] + k + 1, ROWS, 4, 1, "curve", false, k == 2};
    chart.count = 3;
    chart.right_label = "right [N]";
    text = ct_chart_text(&chart, 1, 79, 24, true);
    EXPECT_HOLDS(text, "a curve   b curve   c curve (right)");
    EXPECT_HOLDS(text, "right [N]\n");
    read_grid(text, &grid);
    for (int line = 1; line < 20; line++)
        for (int c = 6; c < grid.columns[line]; c++)
            for (int k = 0; k < 3; k++)
                found[k] += at(&grid, line, c) == (unsigned)('a' + k);
    for (int k = 0; k < 3; k++)
        EXPECT(found[k] >= 4);
    ct_free(text);
}

int main(void)
{
    RUN(dots_lie_where_the_function_has_its_values);
    RUN(strange_charts_are_drawn);
    RUN(several_curves_carry_letters);
    return test_end();
}

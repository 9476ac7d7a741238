/* grid.c: rows of a run */
#include "simulate/run/grid.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

void grid_add(Grid *grid, double t, int phase, const double *y, int length)
{
    if (grid->count == grid->room) {
        size_t room = grid->room < 256 ? 512 : 2 * (size_t)grid->room;

        grid->room = (int)room;
        grid->times = mem_grow(grid->times, room, sizeof(double));
        grid->phase = mem_grow(grid->phase, room, sizeof(int));
        grid->steps = mem_grow(grid->steps, room, sizeof(int));
        grid->first = mem_grow(grid->first, room, sizeof(ptrdiff_t));
    }
    if (grid->used + length > grid->capacity) {
        grid->capacity = 2 * grid->capacity + 64 * (ptrdiff_t)length;
        grid->states = mem_grow(grid->states, (size_t)grid->capacity, sizeof(double));
    }
    grid->times[grid->count] = t;
    grid->phase[grid->count] = phase;
    grid->steps[grid->count] = 0;
    grid->first[grid->count++] = grid->used;
    memcpy(grid->states + grid->used, y, (size_t)length * sizeof(double));
    grid->used += length;
}

void grid_append(Grid *grid, const Grid *more)
{
    for (int i = 0; i < more->count; i++) {
        grid_add(grid, more->times[i], more->phase[i], grid_row(more, i), grid_length(more, i));
        grid->steps[grid->count - 1] = more->steps[i];
    }
}

int grid_length(const Grid *grid, int row)
{
    const ptrdiff_t end = row + 1 < grid->count ? grid->first[row + 1] : grid->used;

    return (int)(end - grid->first[row]);
}

double *grid_row(const Grid *grid, int row)
{
    return grid->states + grid->first[row];
}

void grid_free(Grid *grid)
{
    MEM_FREE(grid->times, grid->phase, grid->steps, grid->first, grid->states);
    *grid = (Grid){0};
}

int grid_rows(double from, double to, double every)
{
    double whole = floor((to - from) / every * (1 + 1e-12) + 1e-9);

    if (from + whole * every >= to - 1e-9 * every)
        return (int)whole;
    return (int)whole + 1; /* the end is between two multiples */
}

double grid_time(double from, double to, double every, int rows, int k)
{
    double t = from + k * every;

    return k >= rows || t > to ? to : t;
}

/* embedded.c: J, G, G^T M and G^T F in symbols, for up to three constraints
 *
 * G = [J; 1] with J = -Phi_d^-1 Phi_i by minors (Cramer), so that every column of G has the
 * determinant of Phi_d below it once. Phi excludes drivers, and driven coordinates are independent:
 * the equations contain the efforts of the drivers instead (theory 6). Beyond three rows a run
 * solves with Phi_d numerically. */
#include "formulate/expanded/embedded.h"
#include "formulate/expanded/expanded.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <math.h>
#include <string.h>

enum { MOST_ROWS = 3 };

typedef struct Partition {
    int m;
    int row[MOST_ROWS];       /* of Phi */
    int dependent[MOST_ROWS]; /* speeds */
    Expr determinant;         /* of Phi_d */
} Partition;

static Expr phi_entry(System *system, int k, int j, Diag *diag, Status *status)
{
    Expr entry = expr_int(system->arena, 0);

    if (*status == OK)
        *status = expanded_entry(system, BLOCK_JACOBIAN, k, j, &entry, diag);
    return entry;
}

/* determinant of the m x m matrix of the partition's rows and the speeds columns[] */
static Expr determinant(System *system, const Partition *part, const int *columns, Diag *diag,
                        Status *status)
{
    Arena *arena = system->arena;
    Expr a[MOST_ROWS][MOST_ROWS];
    Expr terms[6];
    int count = 0;

    for (int i = 0; i < part->m; i++)
        for (int j = 0; j < part->m; j++)
            a[i][j] = phi_entry(system, part->row[i], columns[j], diag, status);
    if (part->m == 0)
        return expr_int(arena, 1);
    if (part->m == 1)
        return a[0][0];
    if (part->m == 2)
        return expr_sub(arena, expr_mul(arena, a[0][0], a[1][1]),
                        expr_mul(arena, a[0][1], a[1][0]));
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3;
        int q = (j + 2) % 3;

        terms[count++] = expr_product(arena, (Expr[]){a[0][j], a[1][p], a[2][q]}, 3);
        terms[count++] =
            expr_neg(arena, expr_product(arena, (Expr[]){a[0][j], a[1][q], a[2][p]}, 3));
    }
    return expr_sum(arena, terms, count);
}

/* whether a name is that of a speed, or of the coordinate whose rate it is */
static bool is_speed(const char *name, const char *speed)
{
    const size_t length = strlen(name);

    return strncmp(name, speed, length) == 0 &&
           (speed[length] == '\0' || strcmp(speed + length, "'") == 0);
}

/* the user's independent coordinates, or the driven ones */
static bool is_independent(const System *system, int j)
{
    for (int i = 0; i < system->origin->independent_count; i++)
        if (is_speed(system->origin->independent[i], system->kinematics->u.at[j].name))
            return true;
    for (int k = 0; k < system->constraints->rows.count && system->origin->independent_count == 0;
         k++) {
        const Row *row = &system->constraints->rows.at[k];

        if (row->kind == ROW_DRIVER && system->kinematics->speed[row->owner][row->coordinate] == j)
            return true;
    }
    return false;
}

/* the next choice of m among `count` places, counted like an odometer; false after the last */
static bool next_choice(int *place, int m)
{
    int i = 0;

    while (i < m && place[i] == i)
        i++;
    if (i == m)
        return false;
    place[i]--;
    for (int k = i - 1; k >= 0; k--)
        place[k] = place[k + 1] - 1;
    return true;
}

/* checks that the names given by the user are coordinates of these trees */
static Status check_named(const System *system, Diag *diag)
{
    for (int i = 0; i < system->origin->independent_count; i++) {
        const char *name = system->origin->independent[i];
        bool found = false;
        Text list = {0};

        for (int j = 0; j < system->kinematics->u.count; j++) {
            found = found || is_speed(name, system->kinematics->u.at[j].name);
            text_addf(&list, "%s%.*s", j > 0 ? ", " : "",
                      (int)strcspn(system->kinematics->u.at[j].name, "'"),
                      system->kinematics->u.at[j].name);
        }
        if (!found) {
            (void)diag_set(diag, E_MODEL,
                           "independent= names %s, which is no coordinate of these trees", name);
            diag_hint(diag, "their coordinates are %s; another tree has others", list.at);
        }
        text_free(&list);
        if (!found)
            return E_MODEL;
    }
    return OK;
}

/* chooses the dependent speeds: the last permissible ones with a determinant that is not 0 */
static Status choose(System *system, Partition *part, Diag *diag)
{
    LIST(int) free = {0};
    int place[MOST_ROWS] = {0};
    Status status = OK;

    CHECK(check_named(system, diag));
    for (int j = 0; j < system->kinematics->u.count; j++)
        if (!is_independent(system, j))
            LIST_PUSH(free, j);
    if (free.count < part->m || (system->origin->independent_count > 0 && free.count > part->m)) {
        status = diag_set(diag, E_MODEL, "%d independent coordinates are named, but %d %s needed",
                          system->kinematics->u.count - free.count,
                          system->kinematics->u.count - part->m,
                          system->kinematics->u.count - part->m == 1 ? "is" : "are");
        goto done;
    }
    for (int i = 0; i < part->m; i++)
        place[i] = free.count - part->m + i;
    do {
        for (int i = 0; i < part->m && free.at != NULL; i++)
            part->dependent[i] = free.at[place[i]];
        part->determinant =
            expr_fold(system->arena, determinant(system, part, part->dependent, diag, &status));
    } while (status == OK && expr_is_zero(part->determinant) && next_choice(place, part->m));
    if (status == OK && expr_is_zero(part->determinant)) {
        status = diag_set(diag, E_SINGULAR, "no coordinates follow from the others here");
        diag_hint(diag, "form embedded independent=[...] names others, `check` shows more");
    }
done:
    LIST_FREE(free);
    return status;
}

static Status partition(System *system, Partition *part, Diag *diag)
{
    *part = (Partition){0};
    for (int k = 0; k < system->constraints->rows.count; k++) {
        if (system->constraints->rows.at[k].kind == ROW_DRIVER)
            continue;
        if (part->m == MOST_ROWS) {
            (void)diag_set(diag, E_MISSING,
                           "the embedded form is written out for up to %d constraints; here are %d",
                           MOST_ROWS, system->constraints->rows.count);
            diag_hint(diag, "runs use it at any size; `show mass` and `show jacobian` in the "
                            "augmented form");
            return E_MISSING;
        }
        part->row[part->m++] = k;
    }
    return choose(system, part, diag);
}

/* the speed that a row of the embedded equations belongs to */
static int independent_speed(const System *system, const Partition *part, int row)
{
    for (int j = 0; j < system->kinematics->u.count; j++) {
        bool follows = false;

        for (int i = 0; i < part->m; i++)
            follows = follows || part->dependent[i] == j;
        if (!follows && row-- == 0)
            return j;
    }
    return -1;
}

/* J of a dependent speed: minus the minor with the independent column at its position, divided by
 * the determinant */
static Expr follow(System *system, const Partition *part, int which, int independent, Diag *diag,
                   Status *status)
{
    Arena *arena = system->arena;
    int swapped[MOST_ROWS];
    Expr minor;

    memcpy(swapped, part->dependent, sizeof swapped);
    swapped[which] = independent;
    minor = determinant(system, part, swapped, diag, status);
    minor = expanded_tidy(system, minor);
    return expr_neg(arena, expr_div(arena, minor, part->determinant));
}

/* row `row` of G^T times a column of a block */
static Status project(System *system, int row, Block block, int column, Expr *out, Diag *diag)
{
    Partition part;
    int independent;
    Expr sum;
    Status status = OK;

    CHECK(partition(system, &part, diag));
    independent = independent_speed(system, &part, row);
    CHECK(expanded_entry(system, block, independent, column, &sum, diag));
    for (int i = 0; i < part.m; i++) {
        Expr ratio = follow(system, &part, i, independent, diag, &status);
        Expr entry;

        CHECK(status);
        CHECK(expanded_entry(system, block, part.dependent[i], column, &entry, diag));
        sum = expr_add(system->arena, sum, expr_mul(system->arena, ratio, entry));
    }
    *out = sum;
done:
    return status;
}

Status embedded_mass(System *system, int row, int column, Expr *out, Diag *diag)
{
    return project(system, row, BLOCK_MASS, column, out, diag);
}

Status embedded_force(System *system, int row, int column, Expr *out, Diag *diag)
{
    (void)column;
    return project(system, row, BLOCK_FORCES, 0, out, diag);
}

/* of the dependent speeds in ascending order, by independent ones in ascending order */
Status embedded_dependent_rate(System *system, int row, int column, Expr *out, Diag *diag)
{
    Partition part;
    Status status = OK;
    Expr rate;

    CHECK(partition(system, &part, diag));
    rate = follow(system, &part, row, independent_speed(system, &part, column), diag, &status);
    CHECK(status);
    *out = rate;
done:
    return status;
}

Status embedded_complement(System *system, int row, int column, Expr *out, Diag *diag)
{
    const int dependent = system->kinematics->u.count - embedded_rows(system);

    if (row < dependent)
        return embedded_dependent_rate(system, row, column, out, diag);
    *out = expr_int(system->arena, row - dependent == column);
    return OK;
}

Status system_partition(System *system, int **speeds, int *dependent, Diag *diag)
{
    const int nu = system->kinematics->u.count;
    Partition part;

    system_touch(system);
    TRY(partition(system, &part, diag));
    *speeds = NEW_ARRAY(int, nu);
    for (int i = 0; i < part.m; i++)
        (*speeds)[i] = part.dependent[i];
    for (int i = 0; i < nu - part.m; i++)
        (*speeds)[part.m + i] = independent_speed(system, &part, i);
    *dependent = part.m;
    return OK;
}

/* --- Phi_q G = 0, in numbers --- */

enum { SAMPLES = 8 };

/* a number of a symbol, between 0.3 and 1.7, another one at each place */
static double sample_value(void *context, Expr symbol)
{
    const double at = (double)(expr_symbol_number(symbol) + 1) * 0.6180339887498949 +
                      (double)*(const int *)context * 0.7548776662466927;

    return 0.3 + 1.4 * (at - floor(at));
}

/* row k of Phi_q times column `column` of G, at a place */
static Status complement_error(System *system, const Partition *part, int k, int column, int place,
                               double *out, Diag *diag)
{
    const int nu = system->kinematics->u.count;
    double sum = 0, size = 0;

    for (int row = 0; row < nu; row++) {
        const int speed =
            row < part->m ? part->dependent[row] : independent_speed(system, part, row - part->m);
        Expr phi, g;
        double term;

        TRY(expanded_entry(system, BLOCK_JACOBIAN, part->row[k], speed, &phi, diag));
        TRY(entry_formed(system, BLOCK_COMPLEMENT, embedded_complement, row, column, &g, diag));
        if (expr_is_zero(phi) || expr_is_zero(g))
            continue;
        term = expr_evaluate(phi, sample_value, &place) * expr_evaluate(g, sample_value, &place);
        sum += term;
        size += fabs(term);
    }
    *out = size > 0 ? fabs(sum) / size : 0;
    return OK;
}

Status system_complement_error(System *system, double *out, Diag *diag)
{
    const int f = embedded_rows(system);
    Partition part;
    double most = NAN;

    system_touch(system);
    TRY(partition(system, &part, diag));
    for (int place = 0; place < SAMPLES; place++)
        for (int k = 0; k < part.m; k++)
            for (int column = 0; column < f; column++) {
                double error;

                TRY(complement_error(system, &part, k, column, place, &error, diag));
                most = fmax(most, error);
            }
    *out = most;
    return OK;
}

/* effort = (G^T (M u' - F)) / (G^T B), B the direction of the driven coordinate */
Status embedded_effort(System *system, const Row *driver, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *owner = &system->origin->instances[driver->owner];
    Partition part;
    int independent;
    Expr direction;
    Expr sum;
    Expr s;
    Status status = OK;

    CHECK(partition(system, &part, diag));
    independent = independent_speed(system, &part, 0);
    CHECK(coordinate_value(system, owner, driver->coordinate, 0, &s, diag));
    direction = speed_partial(system, s, independent);
    for (int i = 0; i < part.m; i++) {
        Expr ratio = follow(system, &part, i, independent, diag, &status);

        CHECK(status);
        direction = expr_add(arena, direction,
                             expr_mul(arena, ratio, speed_partial(system, s, part.dependent[i])));
    }
    CHECK(embedded_force(system, 0, 0, &sum, diag));
    sum = expr_neg(arena, sum);
    for (int k = 0; k < system->kinematics->u.count; k++) {
        Expr entry;

        CHECK(embedded_mass(system, 0, k, &entry, diag));
        sum = expr_add(arena, sum, expr_mul(arena, entry, system->kinematics->accelerations[k]));
    }
    *out = expr_div(arena, sum, direction);
done:
    return status;
}

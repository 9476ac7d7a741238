/* initial_search.c: Levenberg-Marquardt in the coordinates of the trees that place frames
 *
 * The rows are the conditions of joints that are no branches of these trees, and given values that
 * aren't of the trees' own coordinates. A column moves everything beyond its branch. */
#include "simulate/assemble/initial_place_impl.h"

#include "algebra/matrix3.h"
#include "base/random.h"
#include "simulate/assemble/assemble_limits.h"

#include <math.h>
#include <string.h>

/* --- unknowns --- */

static void turn_columns(Placing *p, int link)
{
    const Link *l = &p->s->links[link];
    int given = 0;

    for (int k = 0; k < l->turn_count; k++)
        given += p->known[place_at(link, l->turn[k].coordinate)] == KNOWN_GIVEN;
    for (int k = 0; l->has_parameters && k < 4; k++)
        given += p->known[place_at(link, l->first_parameter + k)] == KNOWN_GIVEN;
    if ((l->has_parameters && given < 4) || (l->turn_count == 3 && given == 0)) {
        for (int k = 0; k < 3; k++)
            LIST_PUSH(p->columns, (PlaceColumn){link, COLUMN_FREE, k});
        return;
    }
    for (int k = 0; k < l->turn_count; k++)
        if (p->known[place_at(link, l->turn[k].coordinate)] != KNOWN_GIVEN)
            LIST_PUSH(p->columns, (PlaceColumn){link, COLUMN_TURN, k});
}

void place_columns(Placing *p)
{
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];

        if (place_turns(p, i))
            turn_columns(p, i);
        if (!place_shifts(p, i) || (l->is_tied && place_turns(p, i)))
            continue;
        for (int k = 0; k < l->shift_count; k++)
            if (p->known[place_at(i, l->shift[k].coordinate)] != KNOWN_GIVEN)
                LIST_PUSH(p->columns, (PlaceColumn){i, COLUMN_SLIDE, k});
    }
}

/* axis of its turn and direction of its shift per unit, in axes of the datum: of the head relative
 * to the tail */
static void column_motion(const Placing *p, const double *c, const PlaceColumn *column,
                          double turn[3], double shift[3])
{
    const Link *l = &p->s->links[column->link];
    const double *R = p->poses[l->tail].R, *own = c + place_at(column->link, 0);
    double E[9], axis[3] = {0};

    memset(turn, 0, 3 * sizeof(double));
    memset(shift, 0, 3 * sizeof(double));
    if (column->kind == COLUMN_TURN)
        link_turn_axis(l, own, R, column->k, turn);
    if (column->kind == COLUMN_FREE) {
        link_attitude(l, own, E);
        matrix3_times(R, E, E);
        axis[column->k] = 1;
        matrix3_apply(E, axis, turn);
    }
    if (column->kind == COLUMN_SLIDE ||
        (l->is_tied && column->kind == COLUMN_TURN && place_shifts(p, column->link))) {
        matrix3_apply(R, l->shift[column->k].axis, shift);
        for (int i = 0; i < 3; i++)
            shift[i] *= l->shift[column->k].scale;
    }
}

static bool is_nothing(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Effect of a unit of a column on each node: turns along the rotation tree; along the translation
 * tree each shift turns with the tail of its edge. */
static void move_nodes(Placing *p, const double *c, const PlaceColumn *column)
{
    const Tree *rotation = p->trees[TREE_ROTATION], *translation = p->trees[TREE_TRANSLATION];
    const Link *l = &p->s->links[column->link];
    double turn[3], shift[3];
    int count;
    const int *nodes = tree_nodes(translation, &count);
    const bool turns = column->kind != COLUMN_SLIDE;
    const bool slides = tree_has(translation, l->edge);
    double sense = 0;

    column_motion(p, c, column, turn, shift);
    if (turns)
        sense = tree_is_forward(rotation, tree_far_node(rotation, l->edge)) ? 1 : -1;
    for (int i = 0; i < count; i++) {
        const bool is_turned = turns && tree_is_beyond(rotation, l->edge, nodes[i]);

        for (int k = 0; k < 3; k++)
            p->turned[3 * nodes[i] + k] = is_turned ? sense * turn[k] : 0;
    }
    memset(p->shifted + (ptrdiff_t)3 * p->s->datum, 0, 3 * sizeof(double));
    for (int i = 1; i < count; i++) {
        const int node = nodes[i], parent = tree_parent(translation, node);
        const int edge = tree_parent_edge(translation, node);
        const int base = p->s->links[p->s->link_at[edge]].tail;
        const double way = tree_is_forward(translation, node) ? 1 : -1;
        const double *turned = p->turned + (ptrdiff_t)3 * base;
        double step[3], carried[3] = {0};

        for (int k = 0; k < 3; k++)
            step[k] = p->poses[node].p[k] - p->poses[parent].p[k];
        if (!is_nothing(turned))
            vector3_cross(turned, step, carried);
        for (int k = 0; k < 3; k++)
            p->shifted[3 * node + k] = p->shifted[3 * parent + k] + carried[k] +
                                       (slides && edge == l->edge ? way * shift[k] : 0);
    }
}

static void move_columns(void *context, double *v, const double *step)
{
    const Placing *p = context;

    for (int j = 0; j < p->columns.count; j++) {
        const PlaceColumn *column = &p->columns.at[j];
        const Link *l = &p->s->links[column->link];
        double *own = v + place_at(column->link, 0);

        if (column->kind == COLUMN_SLIDE)
            own[l->shift[column->k].coordinate] += step[j];
        if (column->kind == COLUMN_TURN)
            own[l->turn[column->k].coordinate] += step[j];
        if (column->kind == COLUMN_FREE && column->k == 0)
            link_turn_by(l, own, step + j);
    }
}

/* --- rows --- */

static void ask(Placing *p, QueryKind kind, int link)
{
    const Pose nothing = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    LinkRow rows[LINK_ROWS];

    LIST_PUSH(p->asks, (Query){kind, link});
    p->row_count += kind == QUERY_SHIFT  ? link_shift_rows(&p->s->links[link], &nothing, rows)
                    : kind == QUERY_TURN ? link_turn_rows(&p->s->links[link], &nothing, rows)
                                         : 1;
}

/* whether coordinates of the trees have this given value themselves */
static bool is_held(const Placing *p, const InitialGuess *wanted)
{
    return !wanted->is_guess && wanted->link >= 0 && place_has(p, wanted->link, wanted->k) &&
           (wanted->group < 0 || p->known[place_at(wanted->link, wanted->k)] != KNOWN_GIVEN ||
            place_ignorance(p, wanted->link, TREE_ROTATION) == 0);
}

/* list the rows: of joints, given values, guesses */
static void list_asks(Placing *p, bool guesses)
{
    p->asks.count = p->row_count = p->guess_count = 0;
    for (int i = 0; i < p->s->link_count; i++) {
        const Link *l = &p->s->links[i];

        if (!l->holds)
            continue;
        if (!place_shifts(p, i))
            ask(p, QUERY_SHIFT, i);
        if (!place_turns(p, i))
            ask(p, QUERY_TURN, i);
        if (l->is_tied && !(place_shifts(p, i) && place_turns(p, i)))
            ask(p, QUERY_TIE, i);
    }
    for (int i = 0; i < p->guess_list.count; i++)
        if (!p->guess_list.at[i].is_guess && !is_held(p, &p->guess_list.at[i]))
            ask(p, QUERY_GUESS, i);
    for (int i = 0; i < p->guess_list.count && guesses; i++)
        if (p->guess_list.at[i].is_guess) {
            ask(p, QUERY_GUESS, i);
            p->guess_count++;
        }
}

static int ask_rows(const Placing *p, const Query *asked, LinkRow *rows, int *tail, int *head)
{
    const InitialGuess *wanted = asked->kind == QUERY_GUESS ? &p->guess_list.at[asked->link] : NULL;
    const int number = wanted != NULL ? wanted->link : asked->link;
    const Link *link = number >= 0 ? &p->s->links[number] : &p->s->frame;
    double near[POSE_COORDS] = {0};
    Pose relative;

    *tail = link->tail;
    *head = number >= 0 || wanted == NULL ? link->head : wanted->head;
    pose_between(&p->poses[*tail], &p->poses[*head], &relative);
    switch (asked->kind) {
    case QUERY_SHIFT:
        return link_shift_rows(link, &relative, rows);
    case QUERY_TURN:
        return link_turn_rows(link, &relative, rows);
    case QUERY_TIE:
        link_tie_row(link, &relative, rows);
        return 1;
    case QUERY_GUESS:
        if (wanted == NULL)
            return 0;
        if (wanted->group >= 0)
            memcpy(near, p->groups + place_at(wanted->group, 0), sizeof near);
        near[wanted->k] = wanted->value;
        link_value_row(link, &relative, near, wanted->k, wanted->value, rows);
        return 1;
    }
    return 0;
}

/* Whether the column that moved the nodes has no effect on this one, as is true of most nodes of
 * other limbs. */
static bool referents(const Placing *p, int node)
{
    return is_nothing(p->turned + (ptrdiff_t)3 * node) &&
           is_nothing(p->shifted + (ptrdiff_t)3 * node);
}

static double row_slope(const PlaceSearch *s, int row)
{
    const Placing *p = s->p;
    const int t = s->tails[row], h = s->heads[row];
    double turn[3], shift[3], d[3], carried[3], back[9];

    if (referents(p, t) && referents(p, h))
        return 0;
    for (int i = 0; i < 3; i++) {
        turn[i] = p->turned[3 * h + i] - p->turned[3 * t + i];
        d[i] = p->poses[h].p[i] - p->poses[t].p[i];
    }
    vector3_cross(p->turned + (ptrdiff_t)3 * t, d, carried);
    for (int i = 0; i < 3; i++)
        shift[i] = p->shifted[3 * h + i] - p->shifted[3 * t + i] - carried[i];
    matrix3_transpose(p->poses[t].R, back);
    matrix3_apply(back, turn, turn);
    matrix3_apply(back, shift, shift);
    return vector3_dot(s->link_rows[row].by_turn, turn) +
           vector3_dot(s->link_rows[row].by_shift, shift);
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    PlaceSearch *s = context;
    Placing *p = s->p;
    int count = 0;

    place_poses(p, v);
    for (int i = 0; i < p->asks.count; i++) {
        int tail = 0, head = 0;
        const int more = ask_rows(p, &p->asks.at[i], s->link_rows + count, &tail, &head);

        for (int k = 0; k < more; k++) {
            residual[count] = s->link_rows[count].value;
            s->tails[count] = tail;
            s->heads[count++] = head;
        }
    }
    for (int j = 0; jacobian != NULL && j < p->columns.count; j++) {
        move_nodes(p, v, &p->columns.at[j]);
        for (int i = 0; i < count; i++)
            jacobian[(ptrdiff_t)i * p->columns.count + j] = row_slope(s, i);
    }
}

static void move(void *context, double *v, const double *step)
{
    move_columns(((PlaceSearch *)context)->p, v, step);
}

double place_missed(Placing *p, int number, bool *is_length)
{
    const Query asked = {QUERY_GUESS, number};
    LinkRow rows[LINK_ROWS] = {0};
    int tail, head;

    (void)ask_rows(p, &asked, rows, &tail, &head);
    *is_length = vector3_dot(rows[0].by_shift, rows[0].by_shift) > 0;
    return rows[0].value;
}

void place_open_search(PlaceSearch *s, Placing *p, bool guesses)
{
    list_asks(p, guesses);
    *s = (PlaceSearch){.p = p,
                       .link_rows = NEW_ARRAY(LinkRow, p->row_count + LINK_ROWS),
                       .tails = NEW_ARRAY(int, p->row_count + LINK_ROWS),
                       .heads = NEW_ARRAY(int, p->row_count + LINK_ROWS),
                       .rows = {.rows = p->row_count,
                                .columns = p->columns.count,
                                .length = p->s->link_count * POSE_COORDS,
                                .context = s,
                                .watch = p->a->setting->watch,
                                .evaluate = evaluate,
                                .move = move}};
}

void place_close_search(PlaceSearch *s)
{
    MEM_FREE(s->link_rows, s->tails, s->heads);
}

/* Hold columns that have no effect on a violated row. */
static void keep_unconcerned(const Placing *p, const Rows *rows, const bool *missed, double *step)
{
    double *residual = NEW_ARRAY(double, rows->rows);
    double *jacobian = NEW_ARRAY(double, (size_t)rows->rows *(size_t)rows->columns);

    rows->evaluate(rows->context, p->c, residual, jacobian);
    for (int j = 0; j < rows->columns; j++) {
        bool concerned = false;

        for (int i = 0; i < rows->rows; i++)
            concerned = concerned || (missed[i] && jacobian[(ptrdiff_t)i * rows->columns + j] != 0);
        step[j] = concerned ? step[j] : 0;
    }
    MEM_FREE(residual, jacobian);
}

static double size_of_try(int k)
{
    return k < SEARCH_AT_ONE_DISTANCE       ? 0.1
           : k < 2 * SEARCH_AT_ONE_DISTANCE ? 0.5
           : k < SEARCH_TRIES || k % 2 == 0 ? 1.5
                                            : 3;
}

/* Further initial guesses about the first one; of those at the smallest distance that converge the
 * nearest solution is used. The violated rows determine which columns take part. */
static bool try_around(Placing *p, const Rows *rows, const double *from, const bool *missed)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *step = NEW_ARRAY(double, rows->columns);
    uint64_t seed = 1;
    int tries = SEARCH_WORK / rows->columns;
    bool met = false;

    tries = tries < SEARCH_TRIES        ? SEARCH_TRIES
            : tries > SEARCH_MOST_TRIES ? SEARCH_MOST_TRIES
                                        : tries;
    for (int k = 0; k < tries && !met && monitor_poll(rows->watch) == OK; k++) {
        const double size = size_of_try(k);

        for (int j = 0; j < rows->columns; j++)
            step[j] = size * random_unit(&seed);
        memcpy(p->c, from, bytes);
        move_columns(p, p->c, step);
        keep_unconcerned(p, rows, missed, step);
        memcpy(p->c, from, bytes);
        move_columns(p, p->c, step);
        met = initial_meet(rows, NULL, p->c, NULL);
        if (met)
            remarks_add(&p->a->out->remarks,
                        (Remark){.kind = REMARK_ASSEMBLED_AROUND, .size = size});
    }
    mem_free(step);
    return met;
}

/* From the initial point, then from others around it. */
static bool solve(Placing *p, const Rows *rows, double *residual)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *from = NEW_ARRAY(double, rows->length);
    bool *missed = NEW_ARRAY(bool, rows->rows);
    bool met;

    memcpy(from, p->c, bytes);
    met = initial_meet(rows, NULL, p->c, residual);
    for (int i = 0; i < rows->rows; i++)
        missed[i] = initial_misses(residual[i]);
    if (!met) {
        double *best = NEW_ARRAY(double, rows->length);

        memcpy(best, p->c, bytes);
        met = try_around(p, rows, from, missed);
        if (!met)
            memcpy(p->c, best, bytes);
        mem_free(best);
    }
    MEM_FREE(from, missed);
    return met;
}

double place_size(const Placing *p)
{
    double size = 0;

    for (int i = 0; i < p->s->node_count; i++) {
        double way[3];

        for (int k = 0; k < 3; k++)
            way[k] = p->poses[i].p[k] - p->poses[p->s->datum].p[k];
        size = fmax(size, sqrt(vector3_dot(way, way)));
    }
    return size > 0 ? size : 1;
}

void place_row_scales(const PlaceSearch *s, double size, double guesses, double *scale)
{
    for (int i = 0; i < s->rows.rows; i++) {
        const double *shift = s->link_rows[i].by_shift;

        scale[i] = vector3_dot(shift, shift) > 0 ? 1 / size : 1;
        if (i >= s->rows.rows - s->p->guess_count)
            scale[i] *= guesses;
    }
}

/* To the least sum of squares of all guesses and loops, with equal weights. */
static void approach(PlaceSearch *s)
{
    double *scale = NEW_ARRAY(double, s->rows.rows);

    place_row_scales(s, place_size(s->p), 1, scale);
    (void)levenberg_marquardt_solve(&s->rows, NULL, scale, PLACE_APPROACHED, s->p->c, NULL);
    mem_free(scale);
}

bool place_search(Placing *p, bool guesses)
{
    PlaceSearch s;
    double *residual;
    bool met = true;

    place_open_search(&s, p, guesses);
    residual = NEW_ARRAY(double, s.rows.rows);
    evaluate(&s, p->c, residual, NULL);
    for (int i = 0; i < s.rows.rows; i++)
        met = met && !initial_misses(residual[i]);
    if (!met && s.rows.columns > 0 && guesses)
        approach(&s);
    else if (!met && s.rows.columns > 0)
        met = solve(p, &s.rows, residual);
    mem_free(residual);
    place_close_search(&s);
    return met;
}

/* test_residual.c: rows with their derivatives, held against closed forms and difference quotients
 */
#include "compile/jacobian.h"
#include "compile/residual.h"
#include "compile/tangents.h"

#include "algebra/pattern.h"
#include "base/memory.h"

#include "test.h"

enum { UNKNOWNS = 7, INPUTS = UNKNOWNS + 1, PARAMETERS = 2, ROWS = 12, NODES = 25, DRAWS = 150 };

/* --- random smooth rows over some of the unknowns, t and parameters --- */

typedef struct Draw {
    Arena *arena;
    Expr inputs[INPUTS]; /* unknowns, t */
    Expr parameters[PARAMETERS];
    Expr rows[ROWS];
    double values[INPUTS], given[PARAMETERS];
} Draw;

static Expr smooth(Arena *arena, Expr a, Expr b, int what)
{
    switch (what) {
    case 0:
        return expr_add(arena, a, b);
    case 1:
        return expr_mul(arena, a, b);
    case 2:
        return expr_call1(arena, OP_SIN, a);
    case 3:
        return expr_call1(arena, OP_EXP, expr_call1(arena, OP_COS, a));
    case 4:
        return expr_call1(arena, OP_ATAN, expr_sub(arena, a, b));
    default:
        return expr_pow(arena,
                        expr_add(arena, expr_int(arena, 1), expr_pow(arena, a, expr_int(arena, 2))),
                        expr_rational(arena, -1, 2));
    }
}

static void draw_open(Draw *d, uint64_t *seed)
{
    static const SymbolKind kinds[UNKNOWNS] = {
        SYMBOL_COORDINATE, SYMBOL_SPEED,      SYMBOL_STATE,     SYMBOL_STATE_RATE,
        SYMBOL_ALGEBRAIC,  SYMBOL_COORDINATE, SYMBOL_MULTIPLIER};
    char name[16];

    d->arena = arena_new();
    for (int i = UNKNOWNS - 1; i >= 0; i--) { /* their numbers fall as their places rise */
        (void)snprintf(name, sizeof name, "w%d", i);
        d->inputs[i] = expr_symbol(d->arena, name, kinds[i]);
    }
    d->inputs[UNKNOWNS] = expr_symbol(d->arena, "t", SYMBOL_TIME);
    for (int i = 0; i < PARAMETERS; i++) {
        (void)snprintf(name, sizeof name, "p%d", i);
        d->parameters[i] = expr_symbol(d->arena, name, SYMBOL_PARAMETER);
        d->given[i] = test_uniform(seed, -1, 1);
    }
    for (int i = 0; i < INPUTS; i++)
        d->values[i] = test_uniform(seed, -1, 1);
    for (int r = 0; r < ROWS; r++) {
        Expr nodes[NODES];
        int count = 0;

        for (int i = 0; i < 4; i++) {
            const int which = (int)(test_random(seed) % (INPUTS + PARAMETERS));

            nodes[count++] = which < INPUTS ? d->inputs[which] : d->parameters[which - INPUTS];
        }
        while (count < NODES) {
            const Expr a = nodes[test_random(seed) % (uint64_t)count];
            const Expr b = nodes[count - 1];

            nodes[count++] = smooth(d->arena, b, a, (int)(test_random(seed) % 6));
        }
        d->rows[r] = nodes[NODES - 1];
    }
}

static double value_in(void *context, Expr symbol)
{
    const Draw *d = context;

    for (int i = 0; i < INPUTS; i++)
        if (d->inputs[i] == symbol)
            return d->values[i];
    return symbol == d->parameters[0] ? d->given[0] : d->given[1];
}

/* d row/d w_j by differences of order 4 */
static double quotient(Draw *d, int row, int j, double h)
{
    const double was = d->values[j];
    double at[4];
    static const int steps[] = {-2, -1, 1, 2};

    for (int k = 0; k < 4; k++) {
        d->values[j] = was + steps[k] * h;
        at[k] = expr_evaluate(d->rows[row], value_in, d);
    }
    d->values[j] = was;
    return (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * h);
}

static Residual *compile(const Draw *d, int rows)
{
    const ResidualOrder order = {.arena = d->arena,
                                 .roots = d->rows,
                                 .root_count = ROWS,
                                 .row_count = rows,
                                 .unknowns = d->inputs,
                                 .unknown_count = UNKNOWNS,
                                 .inputs = d->inputs,
                                 .input_count = INPUTS};
    Residual *r = NULL;
    Diag diag = {0};

    EXPECT(residual_new(&order, &r, &diag) == OK);
    EXPECT_TEXT(diag.message, "");
    return r;
}

static Workspace *evaluate(const Draw *d, const Residual *r)
{
    Workspace *workspace = workspace_new(residual_program(r));
    double *inputs = workspace_inputs(workspace);
    int count;
    const Expr *own = residual_parameters(r, &count);

    memcpy(inputs, d->values, sizeof d->values);
    for (int i = 0; i < count; i++)
        inputs[INPUTS + i] = own[i] == d->parameters[0] ? d->given[0] : d->given[1];
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    return workspace;
}

/* the derivatives as a matrix of rows x unknowns */
static void full_jacobian(const Residual *r, int unknowns, const double *roots, double *out)
{
    int count;
    const Slope *slopes = residual_slopes(r, &count);

    for (int i = 0; i < residual_row_count(r) * unknowns; i++)
        out[i] = 0;
    for (int k = 0; k < count; k++)
        out[slopes[k].row * unknowns + slopes[k].unknown] = roots[residual_first_slope(r) + k];
}

/* --- claims --- */

static void derivatives_agree_with_difference_quotients(void)
{
    uint64_t seed = 5;
    int checked = 0;

    for (int k = 0; k < DRAWS; k++) {
        Draw d;
        double full[ROWS * UNKNOWNS];

        draw_open(&d, &seed);
        Residual *r = compile(&d, ROWS);
        Workspace *workspace = evaluate(&d, r);

        full_jacobian(r, UNKNOWNS, workspace_roots(workspace), full);
        for (int i = 0; i < ROWS; i++) {
            EXPECT(workspace_roots(workspace)[i] == expr_evaluate(d.rows[i], value_in, &d));
            for (int j = 0; j < UNKNOWNS; j++) {
                const double wide = quotient(&d, i, j, 2e-3), near = quotient(&d, i, j, 1e-3);
                const double size = 1 + fabs(near);

                if (fabs(wide - near) > 1e-3 * size) /* too bent for quotients */
                    continue;
                EXPECT_NEAR(full[i * UNKNOWNS + j], near, 1e-9 * size + fabs(wide - near));
                checked++;
            }
        }
        workspace_free(workspace);
        residual_free(r);
        arena_free(d.arena);
    }
    EXPECT(checked > DRAWS * ROWS * UNKNOWNS / 2);
}

static void slopes_stand_in_order_and_only_where_a_row_holds_the_unknown(void)
{
    uint64_t seed = 6;

    for (int k = 0; k < DRAWS; k++) {
        Draw d;
        int count, at = 0;

        draw_open(&d, &seed);
        Residual *r = compile(&d, ROWS - 2);
        const Slope *slopes = residual_slopes(r, &count);

        EXPECT(residual_row_count(r) == ROWS - 2 && residual_first_slope(r) == ROWS);
        EXPECT(program_root_count(residual_program(r)) == ROWS + count);
        for (int i = 0; i < ROWS - 2; i++)
            for (int j = 0; j < UNKNOWNS; j++) {
                const Expr slope = expr_diff(d.arena, d.rows[i], d.inputs[j]);

                if (expr_is_zero(slope))
                    continue;
                EXPECT(at < count && slopes[at].row == i && slopes[at].unknown == j);
                EXPECT(at < count && slopes[at].kinds == expr_kinds(slope));
                at++;
            }
        EXPECT(at == count);
        residual_free(r);
        arena_free(d.arena);
    }
}

/* the derivative of each row by an unknown a lane, and its bound */
static void tangents_are_derivatives_within_their_bounds(void)
{
    const double exact_inputs[INPUTS + PARAMETERS] = {0};
    uint64_t seed = 7;

    for (int k = 0; k < DRAWS; k++) {
        Draw d;
        double full[ROWS * UNKNOWNS];

        draw_open(&d, &seed);
        Residual *symbols = compile(&d, ROWS), *plain = compile(&d, 0);
        Workspace *workspace = evaluate(&d, symbols), *at = evaluate(&d, plain);
        Tangents *tangents = tangents_new(residual_program(plain));

        full_jacobian(symbols, UNKNOWNS, workspace_roots(workspace), full);
        for (int bounded = 0; bounded < 2; bounded++) {
            tangents_at(tangents, workspace_inputs(at), bounded != 0 ? exact_inputs : NULL);
            for (int j = 0; j < UNKNOWNS; j++)
                tangents_move(tangents, j, j, 1, 0);
            tangents_run(tangents);
            for (int i = 0; i < ROWS; i++) {
                EXPECT(tangents_value(tangents, i, NULL) == workspace_roots(at)[i]);
                for (int j = 0; j < UNKNOWNS; j++) {
                    double error, wanted = full[i * UNKNOWNS + j];
                    double got = tangents_root(tangents, i, j, &error);

                    EXPECT_NEAR(got, wanted, 1e-12 * (1 + fabs(wanted)) + 100 * error);
                    EXPECT(error <= 1e-9 * (1 + fabs(wanted)));
                    EXPECT(bounded != 0 || error == 0);
                }
            }
        }
        tangents_free(tangents);
        workspace_free(workspace);
        workspace_free(at);
        residual_free(symbols);
        residual_free(plain);
        arena_free(d.arena);
    }
}

/* sqrt(x) + y; if(x > 0, log(x), y^2); atan2(y, x): by x and by y, a lane each */
static void a_lane_does_not_feel_what_only_others_move(void)
{
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x", SYMBOL_STATE), y = expr_symbol(arena, "y", SYMBOL_STATE);
    const Expr zero = expr_int(arena, 0), inputs[] = {x, y};
    const Expr rows[] = {expr_add(arena, expr_call1(arena, OP_SQRT, x), y),
                         expr_call(arena, OP_IF,
                                   (Expr[]){expr_call(arena, OP_LT, (Expr[]){zero, x}),
                                            expr_call1(arena, OP_LOG, x), expr_mul(arena, y, y)}),
                         expr_call(arena, OP_ATAN2, (Expr[]){y, x})};
    const double at[] = {0, 3}, off[] = {0, 0};
    Program *program = NULL;
    Tangents *tangents;
    double error;

    EXPECT(program_new(rows, 3, inputs, 2, &program, NULL) == OK);
    tangents = tangents_new(program);
    tangents_at(tangents, at, off);
    tangents_move(tangents, 0, 0, 1, 0);
    tangents_move(tangents, 1, 1, 1, 0);
    tangents_run(tangents);
    EXPECT(!isfinite(tangents_root(tangents, 0, 0, NULL)));
    EXPECT(tangents_root(tangents, 0, 1, &error) == 1 && error == 0);
    EXPECT(tangents_root(tangents, 1, 0, &error) == 0 && error == 0);
    EXPECT(tangents_root(tangents, 1, 1, &error) == 6 && error == 0);
    EXPECT_NEAR(tangents_root(tangents, 2, 0, NULL), -1.0 / 3, 1e-15);
    /* twice as far, and of what moves no longer nothing is left */
    tangents_clear(tangents);
    tangents_move(tangents, 5, 1, 2, 0.125);
    tangents_run(tangents);
    EXPECT(tangents_root(tangents, 1, 5, &error) == 12 && error >= 0.75);
    EXPECT(tangents_root(tangents, 1, 1, &error) == 0 && error == 0);
    tangents_free(tangents);
    program_free(program);
    arena_free(arena);
}

/* Columns may move several inputs, by any amount: here each of the unknowns, the first together
 * with its neighbour. */
static void columns_are_derivatives_along_what_they_move(void)
{
    uint64_t seed = 8;

    for (int k = 0; k < DRAWS; k++) {
        Draw d;
        ColumnMove moves[UNKNOWNS + 1];
        double by[UNKNOWNS + 1], full[ROWS * UNKNOWNS];

        draw_open(&d, &seed);
        Residual *symbols = compile(&d, ROWS), *plain = compile(&d, 0);
        Workspace *workspace = evaluate(&d, symbols), *at = evaluate(&d, plain);

        for (int j = 0; j < UNKNOWNS; j++) {
            moves[j] = (ColumnMove){.column = UNKNOWNS - 1 - j, .input = j};
            by[j] = test_uniform(&seed, 0.5, 2);
        }
        moves[UNKNOWNS] = (ColumnMove){.column = UNKNOWNS - 1, .input = 1};
        by[UNKNOWNS] = -3;

        Jacobian *jacobian =
            jacobian_new(residual_program(plain), ROWS, UNKNOWNS, moves, COUNT(moves));
        const Pattern *p = jacobian_pattern(jacobian);
        double *values = NEW_ARRAY(double, p->count), *got;

        jacobian_at(jacobian, workspace_inputs(at), by, values);
        got = pattern_spread(p, values);
        full_jacobian(symbols, UNKNOWNS, workspace_roots(workspace), full);
        for (int i = 0; i < ROWS; i++)
            for (int j = 0; j < UNKNOWNS; j++) {
                const double *row = full + i * UNKNOWNS;
                const double wanted = by[j] * row[j] + (j == 0 ? by[UNKNOWNS] * row[1] : 0);

                EXPECT_NEAR(got[(UNKNOWNS - 1 - j) * ROWS + i], wanted,
                            1e-11 * (1 + fabs(wanted) + fabs(row[j]) + fabs(row[1])));
            }
        jacobian_at(jacobian, workspace_inputs(at), NULL, values);
        if (p->count > 0)
            EXPECT(isfinite(values[0]));
        mem_free(values);
        mem_free(got);
        jacobian_free(jacobian);
        workspace_free(workspace);
        workspace_free(at);
        residual_free(symbols);
        residual_free(plain);
        arena_free(d.arena);
    }
}

/* x_i^2 x_(i+1): two entries a row, so that a few directions do for any number of columns */
static void sparse_columns_share_lanes_and_stay_apart(void)
{
    enum { N = 100 };
    Arena *arena = arena_new();
    Expr x[N], rows[N];
    ColumnMove moves[N];
    double at[N], *values;
    Program *program = NULL;
    Jacobian *jacobian;
    const Pattern *p;

    for (int i = 0; i < N; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "x%d", i);
        x[i] = expr_symbol(arena, name, SYMBOL_STATE);
        moves[i] = (ColumnMove){.column = i, .input = i};
        at[i] = i % 7 - 3;
    }
    for (int i = 0; i < N; i++)
        rows[i] = expr_product(arena, (Expr[]){x[i], x[i], x[(i + 1) % N]}, 3);
    EXPECT(program_new(rows, N, x, N, &program, NULL) == OK);
    jacobian = jacobian_new(program, N, N, moves, N);
    p = jacobian_pattern(jacobian);
    EXPECT(p->count == 2 * N);
    values = NEW_ARRAY(double, p->count);
    jacobian_at(jacobian, at, NULL, values);
    for (int c = 0; c < N; c++)
        for (int k = p->start[c]; k < p->start[c + 1]; k++) {
            const int i = p->row[k];

            EXPECT(i == c || (i + 1) % N == c);
            EXPECT(values[k] == (i == c ? 2 * at[i] * at[(i + 1) % N] : at[i] * at[i]));
        }
    mem_free(values);
    jacobian_free(jacobian);
    program_free(program);
    arena_free(arena);
}

/* a quadratic form: its derivatives are known */
static void a_quadratic_form_has_its_closed_derivatives(void)
{
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x", SYMBOL_STATE), y = expr_symbol(arena, "y", SYMBOL_STATE);
    const Expr k = expr_symbol(arena, "k", SYMBOL_PARAMETER);
    /* k x^2 + 3 x y; y */
    const Expr rows[] = {expr_add(arena, expr_mul(arena, k, expr_mul(arena, x, x)),
                                  expr_mul(arena, expr_int(arena, 3), expr_mul(arena, x, y))),
                         y};
    const Expr unknowns[] = {y, x};
    const ResidualOrder order = {.arena = arena,
                                 .roots = rows,
                                 .root_count = 2,
                                 .row_count = 2,
                                 .unknowns = unknowns,
                                 .unknown_count = 2,
                                 .inputs = unknowns,
                                 .input_count = 2};
    Residual *r = NULL;
    double full[4];
    int count;

    EXPECT(residual_new(&order, &r, NULL) == OK);
    (void)residual_slopes(r, &count);
    EXPECT(count == 3);
    EXPECT(residual_parameters(r, &count)[0] == k && count == 1);

    Workspace *one = workspace_new(residual_program(r)),
              *other = workspace_new(residual_program(r));
    const double at[2][3] = {{7, 2, 0.5}, {-1, 4, -3}}; /* y, x, k */

    memcpy(workspace_inputs(one), at[0], sizeof at[0]);
    memcpy(workspace_inputs(other), at[1], sizeof at[1]);
    workspace_run(one, STAGE_PARAMETER, STAGE_ACCELERATION);
    workspace_run(other, STAGE_PARAMETER, STAGE_ACCELERATION); /* leaves the first as it is */
    for (int w = 0; w < 2; w++) {
        full_jacobian(r, 2, workspace_roots(w == 0 ? one : other), full);
        EXPECT(full[0] == 3 * at[w][1]);
        EXPECT(full[1] == 2 * at[w][2] * at[w][1] + 3 * at[w][0]);
        EXPECT(full[2] == 1 && full[3] == 0);
    }
    workspace_free(one);
    workspace_free(other);
    residual_free(r);
    arena_free(arena);
}

static Expr square(const void *context, Expr e)
{
    Arena *const *arena = context;

    return expr_mul(*arena, e, e);
}

static void what_is_put_is_put_behind_the_derivative(void)
{
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x", SYMBOL_STATE);
    const Expr row = expr_mul(arena, expr_int(arena, 3), x);
    const ResidualOrder order = {.arena = arena,
                                 .roots = &row,
                                 .root_count = 1,
                                 .row_count = 1,
                                 .unknowns = &x,
                                 .unknown_count = 1,
                                 .inputs = &x,
                                 .input_count = 1,
                                 .put = square,
                                 .context = &arena};
    Residual *r = NULL;

    EXPECT(residual_new(&order, &r, NULL) == OK);

    Workspace *workspace = workspace_new(residual_program(r));

    workspace_inputs(workspace)[0] = 2;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    EXPECT(workspace_roots(workspace)[0] == 36 && workspace_roots(workspace)[1] == 9);
    workspace_free(workspace);
    residual_free(r);
    arena_free(arena);
}

static void a_symbol_that_is_no_input_is_named(void)
{
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x", SYMBOL_STATE),
               z = expr_symbol(arena, "lost", SYMBOL_STATE);
    const Expr row = expr_mul(arena, x, z);
    const ResidualOrder order = {.arena = arena,
                                 .roots = &row,
                                 .root_count = 1,
                                 .row_count = 1,
                                 .unknowns = &x,
                                 .unknown_count = 1,
                                 .inputs = &x,
                                 .input_count = 1};
    Residual *r = NULL;
    Diag diag = {0};

    EXPECT(residual_new(&order, &r, &diag) == E_NAME);
    EXPECT(r == NULL);
    EXPECT(strstr(diag.message, "lost") != NULL);
    arena_free(arena);
}

static void nothing_at_all_is_a_residual(void)
{
    Arena *arena = arena_new();
    const ResidualOrder order = {.arena = arena};
    Residual *r = NULL;
    int count;

    EXPECT(residual_new(&order, &r, NULL) == OK);
    (void)residual_slopes(r, &count);
    EXPECT(count == 0);
    residual_free(r);
    residual_free(NULL);
    arena_free(arena);
}

static void patterns_hold_each_place_once_by_columns(void)
{
    uint64_t seed = 8;

    for (int draw = 0; draw < 300; draw++) {
        enum { MOST = 60 };
        const int rows = 1 + (int)(test_random(&seed) % 9),
                  columns = 1 + (int)(test_random(&seed) % 9);
        const int count = (int)(test_random(&seed) % MOST);
        int row[MOST], column[MOST], place[MOST], at = 0;

        for (int k = 0; k < count; k++) {
            row[k] = (int)(test_random(&seed) % (uint64_t)rows);
            column[k] = (int)(test_random(&seed) % (uint64_t)columns);
        }
        Pattern p = pattern_of(rows, columns, count, row, column, place);

        for (int k = 0; k < count; k++)
            EXPECT(p.row[place[k]] == row[k] && p.column[place[k]] == column[k]);
        for (int c = 0; c < columns; c++) {
            EXPECT(p.start[c] == at);
            for (int r = 0; r < rows; r++) {
                bool held = false;

                for (int k = 0; k < count; k++)
                    held = held || (row[k] == r && column[k] == c);
                if (!held)
                    continue;
                EXPECT(at < p.count && p.row[at] == r && p.column[at] == c);
                at++;
            }
        }
        EXPECT(at == p.count && p.start[columns] == p.count);
        pattern_free(&p);
    }
}

int main(void)
{
    RUN(derivatives_agree_with_difference_quotients);
    RUN(slopes_stand_in_order_and_only_where_a_row_holds_the_unknown);
    RUN(tangents_are_derivatives_within_their_bounds);
    RUN(a_lane_does_not_feel_what_only_others_move);
    RUN(columns_are_derivatives_along_what_they_move);
    RUN(sparse_columns_share_lanes_and_stay_apart);
    RUN(a_quadratic_form_has_its_closed_derivatives);
    RUN(what_is_put_is_put_behind_the_derivative);
    RUN(a_symbol_that_is_no_input_is_named);
    RUN(nothing_at_all_is_a_residual);
    RUN(patterns_hold_each_place_once_by_columns);
    return test_end();
}

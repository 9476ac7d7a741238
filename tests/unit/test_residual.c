/* test_residual.c: rows with their derivatives, held against closed forms and difference quotients
 */
#include "compile/residual.h"

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

        residual_jacobian(r, workspace_roots(workspace), full);
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
        residual_jacobian(r, workspace_roots(w == 0 ? one : other), full);
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
    residual_jacobian(r, NULL, NULL);
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
    RUN(a_quadratic_form_has_its_closed_derivatives);
    RUN(what_is_put_is_put_behind_the_derivative);
    RUN(a_symbol_that_is_no_input_is_named);
    RUN(nothing_at_all_is_a_residual);
    RUN(patterns_hold_each_place_once_by_columns);
    return test_end();
}

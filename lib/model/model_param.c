/* model_param.c: the values in a part's statement, by the kind in its row
 *
 * Vectors have three entries, also in a planar scene (the third is 0). Axes become unit vectors u /
 * |u|,
 * with an exact |u| where the entries are exact. */
#include "model/model_impl.h"

#include <math.h>
#include <string.h>

typedef Status Read(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                    Diag *diag);

/* a direction has no unit: [3 mm, 4 mm, 0] is one */
static Status check_axes(const Scope *scope, const Wanted *wanted, const Syntax *syntax, Diag *diag)
{
    Text what = {0};
    Status status = OK;

    text_addf(&what, "components of %s", wanted->param->name);
    if (wanted->param->kind == PARAM_AXIS)
        CHECK(unit_check_alike(scope, syntax, what.at, diag));
    for (int i = 0; wanted->param->kind == PARAM_AXES && i < syntax->count; i++)
        CHECK(unit_check_alike(scope, syntax->args[i], what.at, diag));
done:
    text_free(&what);
    return status;
}

static Status check_unit(const Scope *scope, const Wanted *wanted, const Syntax *syntax, Diag *diag)
{
    ParamKind kind = wanted->param->kind;
    char *unit;
    Status status;

    if (kind == PARAM_LIST_LAWS)
        return unit_check_alike(scope, syntax, "added", diag);
    if (wanted->param->unit == NULL || kind == PARAM_ROTATION)
        return OK;
    if (kind == PARAM_AXIS || kind == PARAM_AXES)
        return check_axes(scope, wanted, syntax, diag);
    unit = param_unit(wanted->param, wanted->on_angle);
    status = unit_check(scope, syntax, unit, wanted->param->name, diag);
    mem_free(unit);
    return status;
}

static void make_room(const State *state, Value *out, int count)
{
    out->count = count;
    out->at = pool_alloc(state->pool, (size_t)count * sizeof *out->at);
}

static Status read_scalar(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                          Diag *diag)
{
    (void)wanted;
    make_room(scope->state, out, 1);
    return scope_expression(scope, syntax, &out->at[0], diag);
}

/* [a, b, c], or one number for a list of one */
static Status read_list(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                        Diag *diag)
{
    if (syntax->kind != SYNTAX_VECTOR)
        return read_scalar(scope, wanted, syntax, out, diag);
    return scope_vector(scope, syntax, &out->at, &out->count, diag);
}

/* --- vectors --- */

static Status read_vector(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                          Diag *diag)
{
    bool planar = scope->state->setup.planar;
    int count = 0;
    Status status = OK;

    CHECK(scope_vector(scope, syntax, &out->at, &count, diag));
    if (planar && count == 2)
        out->at[count++] = expr_int(scope->state->arena, 0);
    if (count != 3) {
        status = diag_at(diag, E_VALUE, syntax->place, "%s has %d components, not %d",
                         wanted->param->name, planar ? 2 : 3, count);
        if (!planar && count == 2)
            diag_hint(diag, "two are enough in a planar scene: scene planar, before the parts");
        goto done;
    }
    if (planar && !expr_is_zero(out->at[2])) {
        status = diag_at(diag, E_VALUE, syntax->place, "%s leaves the plane", wanted->param->name);
        diag_hint(diag, "the scene is planar: write [x, y]");
        goto done;
    }
    out->count = 3;
done:
    return status;
}

static Status read_moment(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                          Diag *diag)
{
    Status status;

    if (!scope->state->setup.planar)
        return read_vector(scope, wanted, syntax, out, diag);
    status = read_scalar(scope, wanted, syntax, out, diag);
    if (status == E_VALUE)
        diag_hint(diag, "in a planar scene a torque is one number, about z");
    return status;
}

static Status read_inertia(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                           Diag *diag)
{
    Status status;
    int count = 0;

    if (scope->state->setup.planar) {
        status = read_scalar(scope, wanted, syntax, out, diag);
        if (status == E_VALUE)
            diag_hint(diag, "in a planar scene it is one number, about z");
        return status;
    }
    status = scope_vector(scope, syntax, &out->at, &count, diag);
    if (status == OK && count != 3 && count != 6)
        status = diag_at(diag, E_VALUE, syntax->place, "%s has 3 or 6 entries, not %d",
                         wanted->param->name, count);
    if (status == E_VALUE)
        diag_hint(diag,
                  "[Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]; in a planar scene (scene "
                  "planar) one number");
    out->count = count;
    return status;
}

/* --- axes --- */

/* x y z -x -y -z; false: something else */
static bool axis_letter(const Syntax *syntax, int *axis, int *sign)
{
    const char *name;

    *sign = 1;
    if (syntax->kind == SYNTAX_UNARY && strcmp(syntax->text, "!") != 0) {
        *sign = syntax->text[0] == '-' ? -1 : 1;
        syntax = syntax->args[0];
    }
    name = syntax->kind == SYNTAX_VARIABLE && syntax->primes == 0 ? syntax->text : NULL;
    if (name == NULL || name[0] < 'x' || name[0] > 'z' || name[1] != '\0')
        return false;
    *axis = name[0] - 'x';
    return true;
}

static void set_axis(Arena *arena, int axis, int sign, Expr out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = expr_int(arena, i == axis ? sign : 0);
}

static Status normalise(const Scope *scope, const Wanted *wanted, Place place, Expr u[3],
                        Diag *diag)
{
    Arena *arena = scope->state->arena;
    Expr length = expr_int(arena, 0);

    for (int i = 0; i < 3; i++)
        length = expr_add(arena, length, expr_square(arena, u[i]));
    length = expr_fold(arena, length);
    if (expr_is_zero(length))
        return diag_at(diag, E_VALUE, place, "%s is zero: it has no direction",
                       wanted->param->name);
    length = expr_sqrt(arena, length);
    for (int i = 0; i < 3; i++)
        u[i] = expr_div(arena, u[i], length);
    return OK;
}

static Status read_axis_at(Scope *scope, const Wanted *wanted, const Syntax *syntax, Expr out[3],
                           Diag *diag)
{
    Arena *arena = scope->state->arena;
    Expr *u;
    int count = 0;
    int axis;
    int sign;
    Status status = OK;

    if (axis_letter(syntax, &axis, &sign)) {
        set_axis(arena, axis, sign, out);
        return OK;
    }
    status = scope_vector(scope, syntax, &u, &count, diag);
    if (status == E_VALUE)
        diag_hint(diag, "an axis is x, y, z, -x, -y, -z, or a vector [a, b, c]");
    if (status != OK)
        return status;
    if (count == 2 && scope->state->setup.planar)
        u[count++] = expr_int(arena, 0);
    if (count != 3)
        return diag_at(diag, E_VALUE, syntax->place, "%s has 3 components, not %d",
                       wanted->param->name, count);
    CHECK(normalise(scope, wanted, syntax->place, u, diag));
    memcpy(out, u, 3 * sizeof *out);
done:
    return status;
}

static Status read_axis(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                        Diag *diag)
{
    make_room(scope->state, out, 3);
    return read_axis_at(scope, wanted, syntax, out->at, diag);
}

static Status read_axes(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                        Diag *diag)
{
    Status status = OK;

    if (syntax->kind != SYNTAX_VECTOR || syntax->count != 2) {
        status = diag_at(diag, E_VALUE, syntax->place, "%s are two axes", wanted->param->name);
        diag_hint(diag, "as in %s=[x, y]", wanted->param->name);
        return status;
    }
    make_room(scope->state, out, 6);
    for (int i = 0; i < 2; i++)
        CHECK(read_axis_at(scope, wanted, syntax->args[i], &out->at[(ptrdiff_t)3 * i], diag));
done:
    return status;
}

/* --- rotations --- */

/* sine or cosine: a number for a number */
static Expr on_circle(Arena *arena, Op op, Expr angle)
{
    Expr value = expr_call1(arena, op, angle);

    return expr_is_number(angle) && !expr_is_number(value)
               ? expr_real(arena, expr_evaluate(value, NULL, NULL))
               : value;
}

/* cosine and sine, exact at quarter turns, otherwise as doubles */
static void circle(Arena *arena, Expr angle, Expr *c, Expr *s)
{
    static const int cosines[] = {1, 0, -1, 0};
    double quarters = expr_is_number(angle) ? expr_value(angle) / M_PI_2 : (double)NAN;
    double whole = nearbyint(quarters);

    if (fabs(quarters - whole) < 1e-12 && fabs(whole) < 1e6) {
        int quarter = (int)(((long long)whole % 4 + 4) % 4);

        *c = expr_int(arena, cosines[quarter]);
        *s = expr_int(arena, cosines[(quarter + 3) % 4]);
        return;
    }
    *c = on_circle(arena, OP_COS, angle);
    *s = on_circle(arena, OP_SIN, angle);
}

static void turn_matrix(Arena *arena, int axis, Expr angle, Expr R[9])
{
    int j = (axis + 1) % 3;
    int k = (axis + 2) % 3;
    Expr c;
    Expr s;

    circle(arena, angle, &c, &s);
    for (int i = 0; i < 9; i++)
        R[i] = expr_int(arena, i == 4 * axis);
    R[3 * j + j] = R[3 * k + k] = c;
    R[3 * k + j] = s;
    R[3 * j + k] = expr_neg(arena, s);
}

static void multiply(Arena *arena, const Expr A[9], const Expr B[9], Expr out[9])
{
    for (int i = 0; i < 9; i++) {
        Expr terms[3];

        for (int k = 0; k < 3; k++)
            terms[k] = expr_mul(arena, A[i / 3 * 3 + k], B[3 * k + i % 3]);
        out[i] = expr_fold(arena, expr_sum(arena, terms, 3));
    }
}

/* turns from left to right: about z, then about the new x */
static Status rotation(Scope *scope, const Syntax *syntax, Expr R[9], Diag *diag)
{
    Expr left[9] = {NULL};
    Expr right[9] = {NULL};
    Expr angle = NULL;
    Status status = OK;

    if (syntax->kind == SYNTAX_BINARY && strcmp(syntax->text, "*") == 0) {
        CHECK(rotation(scope, syntax->args[0], left, diag));
        CHECK(rotation(scope, syntax->args[1], right, diag));
        multiply(scope->state->arena, left, right, R);
        goto done;
    }
    if (syntax->kind != SYNTAX_CALL || syntax->count != 1 || syntax->primes > 0 ||
        syntax->text[1] != '\0' || syntax->text[0] < 'x' || syntax->text[0] > 'z') {
        status = diag_at(diag, E_VALUE, syntax->place, "a rotation is a product of turns");
        diag_hint(diag, "as in z(90 deg)*x(a)");
        goto done;
    }
    if (scope->state->setup.planar && syntax->text[0] != 'z') {
        status =
            diag_at(diag, E_VALUE, syntax->place, "a turn about %s leaves the plane", syntax->text);
        diag_hint(diag, "the scene is planar: turn about z");
        goto done;
    }
    CHECK(scope_expression(scope, syntax->args[0], &angle, diag));
    CHECK(unit_check(scope, syntax->args[0], "rad", "an angle", diag));
    turn_matrix(scope->state->arena, syntax->text[0] - 'x', angle, R);
done:
    return status;
}

static Status read_rotation(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                            Diag *diag)
{
    (void)wanted;
    make_room(scope->state, out, 9);
    return rotation(scope, syntax, out->at, diag);
}

/* --- words --- */

/* length of the word between bars that begins at `text` */
static size_t word_length(const char *text)
{
    return strcspn(text, "|");
}

static Status read_word(Scope *scope, const Wanted *wanted, const Syntax *syntax, Value *out,
                        Diag *diag)
{
    const char *given = syntax_name(syntax);
    const char *words = wanted->param->fallback;

    for (const char *word = words; given != NULL; word += word_length(word) + 1) {
        if (strlen(given) == word_length(word) && strncmp(word, given, strlen(given)) == 0) {
            out->word = pool_text(scope->state->pool, word, word_length(word));
            return OK;
        }
        if (word[word_length(word)] == '\0')
            break;
    }
    (void)diag_at(diag, E_VALUE, syntax->place, "%s= is one of %s", wanted->param->name, words);
    return E_VALUE;
}

static Read *const readers[] = {
    [PARAM_SCALAR] = read_scalar, [PARAM_LAW] = read_scalar,      [PARAM_VECTOR] = read_vector,
    [PARAM_LAWS] = read_vector,   [PARAM_INERTIA] = read_inertia, [PARAM_MOMENT] = read_moment,
    [PARAM_AXIS] = read_axis,     [PARAM_AXES] = read_axes,       [PARAM_ROTATION] = read_rotation,
    [PARAM_LIST] = read_list,     [PARAM_LIST_LAWS] = read_list,  [PARAM_WORD] = read_word,
};

static bool is_law(ParamKind kind)
{
    return kind == PARAM_LAW || kind == PARAM_LAWS || kind == PARAM_MOMENT ||
           kind == PARAM_LIST_LAWS;
}

Status param_read(Scope *scope, Wanted wanted, const Syntax *syntax, Value *out, Diag *diag)
{
    static const char *const place[] = {"x"};

    scope->arguments = place;
    scope->argument_count = (wanted.param->use & ALONG) != 0 ? COUNT(place) : 0;
    if (scope->kind != SCOPE_DRIVE)
        scope->kind = is_law(wanted.param->kind) ? SCOPE_EFFORT : SCOPE_NUMBER;
    TRY(readers[wanted.param->kind](scope, &wanted, syntax, out, diag));
    TRY(check_unit(scope, &wanted, syntax, diag));
    if ((wanted.param->use & ALIKE) != 0) {
        Measure *measure = pool_alloc(scope->state->pool, sizeof *measure);

        TRY(measure_of(scope, syntax, measure, diag));
        out->measure = measure;
    }
    out->given = true;
    return OK;
}

Status param_check_alike(const Component *row, const Value *values, int index, const Syntax *syntax,
                         Diag *diag)
{
    const Measure *own = values[index].measure;
    Measure joined;

    for (int i = 0; i < row->param_count; i++) {
        const Measure *other = values[i].measure;

        /* a ratio is a number, and that is taken as SI */
        if (i == index || own == NULL || other == NULL || measure_is_plain(*own) ||
            measure_is_plain(*other))
            continue;
        TRY(measures_join(*other, *own, syntax, syntax, "subtracted", &joined, diag));
    }
    return OK;
}

/* number of entries of a default */
static int fallback_count(const State *state, ParamKind kind, const char *fallback)
{
    switch (kind) {
    case PARAM_WORD:
        return 0;
    case PARAM_AXES:
        return 6;
    case PARAM_ROTATION:
        return 9;
    case PARAM_AXIS:
    case PARAM_VECTOR:
    case PARAM_LAWS:
        return 3;
    case PARAM_INERTIA:
    case PARAM_MOMENT:
        return state->setup.planar ? 1 : 3;
    case PARAM_LIST:
    case PARAM_LIST_LAWS:
        return fallback[0] != '\0';
    default:
        return 1;
    }
}

void param_fallback(State *state, const Param *param, Value *out)
{
    Arena *arena = state->arena;
    const char *fallback = param->fallback != NULL ? param->fallback : "0";

    make_room(state, out, fallback_count(state, param->kind, fallback));
    if (param->kind == PARAM_WORD)
        out->word = pool_text(state->pool, fallback, word_length(fallback));
    for (int i = 0; i < out->count; i++)
        out->at[i] = param->kind == PARAM_ROTATION ? expr_int(arena, i % 4 == 0)
                     : param->kind == PARAM_AXIS || param->kind == PARAM_AXES
                         ? expr_int(arena, fallback[i / 3 * 2] - 'x' == i % 3)
                         : expr_decimal(arena, fallback);
}

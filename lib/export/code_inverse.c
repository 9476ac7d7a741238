/* code_inverse.c: efforts of drivers as a function of motion
 *
 * A driver's law f(t) becomes r + v (t - now) + a (t - now)^2/2, with its motion r, v, a as inputs:
 * at t = now what is prescribed is r, its rate v, its second rate a, whatever the constraints make
 * of them. In finished formulas `now` is t. */
#include "export/code.h"

#include "model/model.h"

/* the replacement of a driver's law */
static Expr follow(Inverse *inverse, Arena *arena, const char *name, Expr law)
{
    const Expr t = expr_symbol(arena, "t", SYMBOL_TIME), past = expr_sub(arena, t, inverse->now);
    Text text = {0};
    InverseMotion motion;

    text_addf(&text, "%s.motion", name);
    for (int i = 0; i < MOTIONS; i++, text_char(&text, '\'')) {
        motion.symbol[i] = expr_symbol(arena, text.at, SYMBOL_PARAMETER);
        motion.law[i] = i == 0 ? law : expr_diff(arena, motion.law[i - 1], t);
    }
    text_free(&text);
    LIST_PUSH(inverse->motions, motion);
    return expr_add(
        arena, motion.symbol[0],
        expr_add(arena, expr_mul(arena, motion.symbol[1], past),
                 expr_mul(arena, expr_mul(arena, expr_rational(arena, 1, 2), motion.symbol[2]),
                          expr_mul(arena, past, past))));
}

static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    Inverse *inverse = context;

    (void)param;
    if (instance == NULL || instance->row->family != FAMILY_DRIVER)
        return value;
    return follow(inverse, inverse->arena, instance->name, value);
}

Status inverse_new(const View *view, Inverse **out, Diag *diag)
{
    const System *system = view->system;
    Arena *arena = system_arena(view->system);
    Inverse *inverse = NEW(Inverse);
    const SystemOptions options = {.form = system_network_form(system),
                                   .vary = vary,
                                   .context = inverse,
                                   .watch = view->watch};
    Scene scene = {0};
    Status status = OK;

    inverse->arena = arena;
    inverse->now = expr_symbol(arena, "driver.now", SYMBOL_PARAMETER);
    if (system_drive_count(system) == 0) {
        status = diag_set(diag, E_MODEL, "there is no driver whose effort could be determined");
        diag_hint(diag, "'driver D h1 = 0' prescribes the motion of h1");
        goto done;
    }
    if (system_position_rows(system) < system_m(system)) {
        status = diag_set(diag, E_MODEL,
                          "positions under velocity rows depend on the way there, "
                          "which code of inverse motion doesn't follow");
        diag_hint(diag, "'inverse' follows it here; exported equations of motion do");
        goto done;
    }
    CHECK(model_scene(view->model, &scene, diag));
    CHECK(system_new_view(&scene, &options, &inverse->system, diag));
    *out = inverse;
    inverse = NULL;
done:
    scene_free(&scene);
    inverse_free(inverse);
    return status;
}

void inverse_free(Inverse *inverse)
{
    if (inverse == NULL)
        return;
    system_free(inverse->system);
    LIST_FREE(inverse->motions);
    mem_free(inverse);
}

/* The coordinate that a row of Phi drives, where it is that alone; -1. */
static int driven(const Code *code, int row)
{
    const VariableIndex *l = code->layout;
    const Expr t = l->symbols[l->t];
    const Inverse *inverse = code->inverse;
    const Expr phi =
        expr_substitute(code->arena, system_run(l->system)->phi[row], &inverse->now, &t, 1);

    for (int k = 0; k < inverse->motions.count; k++)
        for (int i = 0; i < l->n; i++)
            if (phi ==
                    expr_sub(code->arena, l->symbols[l->q + i], inverse->motions.at[k].symbol[0]) &&
                system_q_rate(l->system, i) == l->symbols[l->u + i])
                return i;
    return -1;
}

/* The coordinate of each driver, if each coordinate has a driver of its own. Then the drivers'
 * motion is the state, and no system has to be solved for it. */
void code_find_direct(Code *code)
{
    const VariableIndex *l = code->layout;

    code->is_direct = l->m == l->nu && l->n == l->nu && l->m == code->inverse->motions.count;
    for (int k = 0; k < l->m && code->is_direct; k++)
        code->is_direct = driven(code, k) >= 0;
    for (int k = 0; k < code->inverse->motions.count && code->is_direct; k++)
        LIST_PUSH(code->direct, driven(code, system_drive(l->system, k)->constraint));
}

/* in what is finished */
void code_write_now(Code *code)
{
    const Expr t = code->layout->symbols[code->layout->t];

    for (int i = 0; i < code->roots.count; i++)
        code->roots.at[i] =
            expr_substitute(code->arena, code->roots.at[i], &code->inverse->now, &t, 1);
}

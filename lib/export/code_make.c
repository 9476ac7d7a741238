/* code_make.c: what is in exported code: inputs, functions, groups of unknowns */
#include "export/code.h"

#include "base/names.h"
#include "compile/program.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/accelerations.h"
#include "formulate/reduced/prescribed.h"
#include "model/model.h"
#include "present/count.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* --- identifiers --- */

/* Fortran and Matlab know 63 letters, and something may be added */
enum { LONGEST_NAME = 48 };

/* what no identifier may be in one of the languages, or what their files use themselves; in small
 * letters, since Fortran knows no others */
static const char reserved[] =
    "p t y s r a b d h i j k m n v w out wp np real model step asm auto bool break case catch char "
    "class const continue default delete do double else enum explicit export extern false float "
    "for "
    "friend goto if inline int long mutable namespace new operator private protected public "
    "register "
    "restrict return short signed sizeof static struct switch template this throw true try typedef "
    "typename union unsigned using virtual void volatile while and or not xor bitand bitor compl "
    "and_eq "
    "or_eq xor_eq not_eq y0 y1 yn j0 j1 jn gamma lgamma tgamma signgam erf erfc sin cos tan asin "
    "acos "
    "atan atan2 sinh cosh tanh exp log log10 log2 sqrt cbrt abs fabs pow fmin fmax min max floor "
    "ceil "
    "round rint trunc fmod hypot sign sum dot index remainder time clock div main program module "
    "subroutine function end endif enddo call contains implicit none integer logical character "
    "complex "
    "parameter intent allocatable dimension type then where elseif stop print read write merge "
    "dble "
    "anint aint nint mod present size shape reshape matmul transpose spread pack unpack maxval "
    "minval "
    "any all count result use only save data common block external intrinsic select cycle exit "
    "open "
    "close include elemental pure recursive target pointer associate critical global persistent "
    "otherwise parfor spmd classdef methods properties events feval zeros ones eye pi inf nan eps "
    "ans e numel length isempty isnan isfinite num2str disp error ppval mkpp def del elif except "
    "finally from import in is lambda nonlocal pass raise with yield as assert async await list "
    "dict "
    "set len range map str tuple object id sys math self input "
    "table ramp unwrap null stdin stdout stderr errno huge tiny";

static bool is_reserved(const char *name)
{
    const size_t length = strlen(name);

    for (const char *c = strstr(reserved, name); c != NULL; c = strstr(c + 1, name))
        if ((c == reserved || c[-1] == ' ') && (c[length] == ' ' || c[length] == '\0'))
            return true;
    /* v12 is one of ours */
    return name[0] == 'v' && strspn(name + 1, "0123456789") == length - 1;
}

/* letters, digits and _ of the name; a prime becomes _d; unique, also where case doesn't count */
static const char *identifier(Pool *pool, Names *taken, const char *name)
{
    Text text = {0};
    char *small;
    int count = 1;

    for (const char *c = name; *c != '\0' && text.length < LONGEST_NAME; c++)
        if (*c == '\'')
            text_add(&text, "_d");
        else if (isascii((unsigned char)*c) && isalnum((unsigned char)*c))
            text_char(&text, *c);
        else if (*c != ')' && text.length > 0)
            text_char(&text, '_');
    if (text.length == 0) {
        text_addf(&text, "x_%d", names_count(taken) + 1);
    } else if (isdigit((unsigned char)text.at[0]) || strncasecmp(text.at, "model_", 6) == 0) {
        Text own = {0};

        text_addf(&own, "own_%s", text.at);
        text_free(&text);
        text = own;
    }
    for (const size_t length = text.length;; text.length = length, text_addf(&text, "_%d", count)) {
        small = mem_text(text.at, text.length);
        for (char *c = small; *c != '\0'; c++)
            *c = (char)tolower((unsigned char)*c);
        if (!is_reserved(small) && names_find(taken, small) < 0)
            break;
        mem_free(small);
        count++;
    }
    (void)names_add(taken, small);
    mem_free(small);
    name = pool_text(pool, text.at, text.length);
    text_free(&text);
    return name;
}

/* --- inputs: parameters, then the symbols of the layout --- */

static void add_parameters(Code *code)
{
    const Model *model = code->view->model;
    Expr *symbols = NULL;
    int count;

    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;

        LIST_PUSH(code->parameters, model_parameter(model, i, &definition));
    }
    /* values of all drivers, then rates, then second rates */
    for (int k = 0; code->inverse != NULL && k < MOTIONS * code->inverse->motions.count; k++)
        LIST_PUSH(code->parameters, code->inverse->motions.at[k % code->inverse->motions.count]
                                        .symbol[k / code->inverse->motions.count]);
    /* those of no model: whole turns of sums of angles */
    count = expr_symbols(code->roots.at, code->roots.count, &symbols);
    for (int i = 0; i < count; i++) {
        bool known = expr_symbol_kind(symbols[i]) != SYMBOL_PARAMETER;

        for (int k = 0; !known && k < code->live.sides.count; k++)
            known = code->live.sides.at[k].surface.sign == symbols[i];
        for (int k = 0; !known && k < code->modes.ideals.count; k++)
            known = code->modes.ideals.at[k].closed == symbols[i];
        for (int k = 0; !known && k < code->parameters.count; k++)
            known = code->parameters.at[k] == symbols[i];
        if (!known)
            LIST_PUSH(code->parameters, symbols[i]);
    }
    mem_free(symbols);
    code->modes.first = code->parameters.count;
    for (int k = 0; k < code->modes.ideals.count; k++)
        LIST_PUSH(code->parameters, code->modes.ideals.at[k].closed);
    code->live.first = code->parameters.count;
    for (int k = 0; k < code->live.sides.count; k++)
        LIST_PUSH(code->parameters, code->live.sides.at[k].surface.sign);
}

static void add_inputs(Code *code)
{
    const VariableIndex *l = code->layout;
    Names *taken = names_new();
    const struct {
        int first, count;
        CodeArray array;
        int place;
    } parts[] = {{l->q, l->n, CODE_Y, 0},
                 {l->u, l->nu, CODE_Y, l->n},
                 {l->x, l->nx, CODE_Y, l->n + l->nu},
                 {l->references, l->multi_turns, CODE_Y, l->n + l->nu + l->nx},
                 {l->rates, l->nx, CODE_S, 0},
                 {l->z, l->nz, CODE_S, l->nx},
                 {l->acceleration, l->nu, CODE_S, l->nx + l->nz},
                 {l->multipliers, l->m, CODE_S, l->nx + l->nz + l->nu}};

    for (int i = 0; i < code->parameters.count; i++)
        LIST_PUSH(code->inputs,
                  (CodeInput){identifier(code->texts, taken, expr_name(code->parameters.at[i])),
                              CODE_P, i});
    for (int i = 0; i < l->count; i++)
        LIST_PUSH(code->inputs, (CodeInput){.array = CODE_T, .place = -1});
    code->inputs.at[code->parameters.count + l->t].place = 0;
    for (int part = 0; part < COUNT(parts); part++)
        for (int i = 0; i < parts[part].count; i++) {
            const int at = parts[part].first + i;

            code->inputs.at[code->parameters.count + at] =
                (CodeInput){identifier(code->texts, taken, expr_name(l->symbols[at])),
                            parts[part].array, parts[part].place + i};
        }
    for (int i = 0; i < code->live.seed_count; i++)
        LIST_PUSH(code->inputs,
                  (CodeInput){identifier(code->texts, taken, expr_name(code->live.seeds[i])),
                              CODE_S, code->ns + i});
    names_free(taken);
}

/* --- functions --- */

static int add_matrix(Code *code, const char *name, const char *what, const Expr *entries, int rows,
                      int columns)
{
    const int function = code_add_function(code, name, what, entries, rows, columns);

    code->functions.at[function].is_matrix = true;
    return function;
}

static void add_blocks(Code *code)
{
    const VariableIndex *l = code->layout;
    System *system = l->system;
    const EquationForm *r = system_run(system);
    Expr *map = NEW_ARRAY(Expr, l->n * l->nu);

    for (int i = 0; i < l->n * l->nu; i++)
        map[i] = system_n_entry(system, i / l->nu, i % l->nu);
    code_add_function(code, "constraints", "the constraints Phi", r->phi, l->m, 1);
    add_matrix(code, "jacobian", "the Jacobian Phi_u of the constraints", r->phi_u, l->m, l->nu);
    code_add_function(code, "velocity", "the right side nu of Phi_u u = nu", r->nu, l->m, 1);
    code_add_function(code, "gamma", "the right side gamma of Phi_u u' = gamma", r->gamma, l->m, 1);
    add_matrix(code, "mass", "the mass matrix M", r->mass, l->nu, l->nu);
    code_add_function(code, "forces", "the right side F", r->force, l->nu, 1);
    add_matrix(code, "map", "N in q' = N u", map, l->n, l->nu);
    mem_free(map);
}

/* the speeds of the rows: "h1', h2'" */
static Status embedded_rows_named(System *system, Text *out, Diag *diag)
{
    int *speeds, dependent;

    TRY(system_partition(system, &speeds, &dependent, diag));
    for (int i = dependent; i < system_nu(system); i++)
        layout_item(out, system_u(system, speeds[i])->name);
    mem_free(speeds);
    return OK;
}

static Status add_embedded_block(Code *code, Block block, const char *what, Diag *diag)
{
    System *system = code->layout->system;
    int rows, columns;
    Expr *entries;
    Status status = OK;

    system_block_size(system, block, &rows, &columns);
    entries = NEW_ARRAY(Expr, rows * columns);
    for (int i = 0; i < rows * columns; i++)
        CHECK(system_show_alone(system, block, i / columns, i % columns, &entries[i], diag));
    if (block == BLOCK_EMBEDDED_MASS)
        add_matrix(code, block_name(block), what, entries, rows, columns);
    else
        code_add_function(code, block_name(block), what, entries, rows, columns);
done:
    mem_free(entries);
    return status;
}

/* With `form embedded`, as far as it can be written out: Mt = G^T M and Ft = G^T F, with Mt u' = Ft
 * but for drivers. */
static Status add_embedded(Code *code, Diag *diag)
{
    System *system = code->layout->system;
    const char *const *independent;
    int count;
    Text names = {0}, mass = {0}, forces = {0};
    Status status = OK;

    if (code->layout->m == 0 ||
        model_form(code->view->model, &independent, &count) != FORM_EMBEDDED)
        return OK;
    code->is_augmented = form_written(system, FORM_EMBEDDED) != FORM_EMBEDDED;
    if (code->is_augmented)
        return OK;
    CHECK(embedded_rows_named(system, &names, diag));
    text_addf(&mass, "the mass matrix G^T M of the embedded form, rows %s", names.at);
    text_addf(&forces, "the right side G^T F of the embedded form, rows %s", names.at);
    CHECK(add_embedded_block(code, BLOCK_EMBEDDED_MASS,
                             pool_text(code->texts, mass.at, mass.length), diag));
    CHECK(add_embedded_block(code, BLOCK_EMBEDDED_FORCES,
                             pool_text(code->texts, forces.at, forces.length), diag));
done:
    text_free(&names);
    text_free(&mass);
    text_free(&forces);
    return status;
}

static Status add_derivative(Code *code, Diag *diag)
{
    const VariableIndex *l = code->layout;
    LIST(Expr) rates = {0};
    Status status = OK;

    for (int i = 0; i < l->n; i++)
        LIST_PUSH(rates, system_run(l->system)->q_rate[i]);
    for (int i = 0; i < l->nu; i++)
        LIST_PUSH(rates, l->symbols[l->acceleration + i]);
    for (int i = 0; i < l->nx; i++)
        LIST_PUSH(rates, l->symbols[l->rates + i]);
    for (int i = 0; i < l->multi_turns; i++) {
        Expr rate;

        CHECK(system_multi_turn_rate(l->system, i, &rate, diag));
        LIST_PUSH(rates, rate);
    }
    code_add_function(code, "derivative", "the rates of y", rates.at, rates.count, 1);
done:
    LIST_FREE(rates);
    return status;
}

/* the angles that references lie next to */
static void add_angles(Code *code)
{
    const VariableIndex *l = code->layout;
    Expr *angles = NEW_ARRAY(Expr, l->multi_turns);

    for (int i = 0; i < l->multi_turns; i++)
        angles[i] = system_multi_turn(l->system, i)->angle;
    code_add_function(code, "angles", "angles over full turns", angles, l->multi_turns, 1);
    mem_free(angles);
}

/* --- what is solved for --- */

static void add_linear_network(Code *code)
{
    const VariableIndex *l = code->layout;
    const EquationForm *r = system_run(l->system);
    const int count = l->nx + l->nz, width = count + 1;
    Expr *rows = NEW_ARRAY(Expr, count * width);

    for (int i = 0; i < count * width; i++)
        rows[i] = expr_int(code->arena, 0);
    for (int e = 0; e < r->network_entries; e++)
        rows[r->network[e].row * width + r->network[e].column] = r->network[e].value;
    for (int i = 0; i < count; i++)
        rows[i * width + count] = r->network_rhs[i];
    code->groups[code->group_count++] = (CodeGroup){
        0, count,
        code_add_function(code, "network", "rows of [A | b] in A [x'; z] = b", rows, count, width),
        false};
    mem_free(rows);
}

/* Where each speed is prescribed by a row of its own. */
static bool add_prescribed(Code *code)
{
    const VariableIndex *l = code->layout;
    Expr *rows = NEW_ARRAY(Expr, 2 * l->nu);

    code->is_explicit = l->m == l->nu && system_prescribed(l->system, rows, rows + l->nu);
    if (code->is_explicit)
        code_add_function(code, "accelerations", "u', which is prescribed, and lambda", rows,
                          2 * l->nu, 1);
    mem_free(rows);
    return code->is_explicit;
}

static void add_mechanics(Code *code)
{
    const VariableIndex *l = code->layout;
    const EquationForm *r = system_run(l->system);
    const int nu = l->nu, count = nu + l->m, width = count + 1;
    Expr *rows;

    if (count == 0 || add_prescribed(code))
        return;
    rows = NEW_ARRAY(Expr, 3 * nu);
    code->is_explicit =
        l->m == 0 && system_pushes(l->system, rows + 2 * nu, NULL) == OK &&
        system_accelerations(l->system, r->force, rows + 2 * nu, rows, rows + nu) != ELIMINATED_NOT;
    if (code->is_explicit)
        code_add_function(code, "accelerations", "u', M u' = F eliminated", rows, nu, 1);
    mem_free(rows);
    if (code->is_explicit)
        return;
    rows = NEW_ARRAY(Expr, count * width);
    for (int i = 0; i < count * width; i++)
        rows[i] = expr_int(code->arena, 0);
    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nu; j++)
            rows[i * width + j] = r->mass[i * nu + j];
        rows[i * width + count] = r->force[i];
    }
    for (int k = 0; k < l->m; k++) {
        for (int j = 0; j < nu; j++)
            rows[(nu + k) * width + j] = rows[j * width + nu + k] = r->phi_u[k * nu + j];
        rows[(nu + k) * width + count] = r->gamma[k];
    }
    code->groups[code->group_count++] =
        (CodeGroup){l->nx + l->nz, count,
                    code_add_function(code, "motion", "rows of [A | b] in A [u'; lambda] = b", rows,
                                      count, width),
                    false};
    mem_free(rows);
}

void code_residual(const Code *code, Expr *rows)
{
    Arena *arena = code->arena;
    const VariableIndex *l = code->layout;
    const EquationForm *r = system_run(l->system);
    const int k = l->nx + l->nz, nu = l->nu;
    const Expr *du = l->symbols + l->acceleration, *lambda = l->symbols + l->multipliers;

    for (int i = 0; i < k; i++)
        rows[i] = r->network_residual[i];
    code_sided_rows(code, rows);
    for (int i = 0; i < nu; i++) {
        rows[k + i] = expr_neg(arena, r->force[i]);
        for (int j = 0; j < nu; j++)
            rows[k + i] = expr_add(arena, rows[k + i], expr_mul(arena, r->mass[i * nu + j], du[j]));
        for (int c = 0; c < l->m; c++)
            rows[k + i] =
                expr_add(arena, rows[k + i], expr_mul(arena, r->phi_u[c * nu + i], lambda[c]));
    }
    for (int c = 0; c < l->m; c++) {
        rows[k + nu + c] = expr_neg(arena, r->gamma[c]);
        for (int j = 0; j < nu; j++)
            rows[k + nu + c] =
                expr_add(arena, rows[k + nu + c], expr_mul(arena, r->phi_u[c * nu + j], du[j]));
    }
}

/* everything at once, where the network reads what moves */
static void add_joint(Code *code)
{
    Expr *rows = NEW_ARRAY(Expr, code->ns);

    code_residual(code, rows);
    code_add_newton(code, rows, code->ns, "equations");
    mem_free(rows);
}

/* the whole solution, if constraints of ideal switches may involve speeds */
static Status add_modes(Code *code, Diag *diag)
{
    const VariableIndex *l = code->layout;
    const unsigned moving = 1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED |
                            1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;
    Expr *rows = NEW_ARRAY(Expr, code->ns);
    unsigned kinds = 0;
    Status status;

    code_residual(code, rows);
    for (int i = 0; i < l->nx + l->nz; i++)
        kinds |= expr_kinds(rows[i]);
    if ((kinds & moving) != 0)
        status = code_add_modes(code, rows, code->ns, diag);
    else {
        status = code_add_modes(code, rows, l->nx + l->nz, diag);
        add_mechanics(code);
    }
    mem_free(rows);
    return status;
}

static void add_groups(Code *code)
{
    const VariableIndex *l = code->layout;
    const EquationForm *r = system_run(l->system);
    const unsigned moved = 1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;
    unsigned kinds = 0;

    for (int i = 0; i < l->nx + l->nz; i++)
        kinds |= expr_kinds(r->network_residual[i]);
    if ((kinds & moved) != 0) {
        add_joint(code);
        return;
    }
    if (l->nx + l->nz > 0 && r->network_nonlinear)
        code_add_newton(code, r->network_residual, l->nx + l->nz, "network");
    else if (l->nx + l->nz > 0)
        add_linear_network(code);
    add_mechanics(code);
}

/* --- outputs and conditions --- */

static void add_efforts(Code *code)
{
    System *system = code->layout->system;
    LIST(Expr) efforts = {0};

    for (int i = 0; i < system_drive_count(system); i++)
        LIST_PUSH(efforts, system_drive(system, i)->effort);
    code_add_function(code, "efforts", "what the drivers take", efforts.at, efforts.count, 1);
    LIST_FREE(efforts);
}

static Status add_outputs(Code *code, const Exported *what, Diag *diag)
{
    const Model *model = code->view->model;
    LIST(Expr) list = {0};
    Status status = OK;

    for (int i = 0; i < what->item_count; i++) {
        Expr e;

        CHECK(code_resolve(code, what->items[i], &e, what->names[i], diag));
        LIST_PUSH(list, e);
        LIST_PUSH(code->outputs, mem_text(what->names[i], strlen(what->names[i])));
    }
    for (int i = 0; what->item_count == 0 && i < model_output_count(model); i++) {
        const char *name;
        Expr e = model_output(model, i, &name);

        CHECK(code_resolve(code, e, &e, name, diag));
        LIST_PUSH(list, e);
        LIST_PUSH(code->outputs, mem_text(name, strlen(name)));
    }
    code_add_function(code, "outputs", "what was asked for", list.at, list.count, 1);
done:
    LIST_FREE(list);
    return status;
}

/* conditions of events are 1 while true; those of switches change their sign */
static Status add_conditions(Code *code, Diag *diag)
{
    const Model *model = code->view->model;
    LIST(Expr) list = {0};
    const Switch *switches;
    int time_only;
    const int count = system_switches(code->layout->system, &switches, &time_only);
    Status status = OK;

    for (int i = 0; i < model_event_count(model); i++) {
        const Event *event = model_event(model, i);
        Text words = {0};
        Expr e;

        CHECK(code_resolve(code, event->when, &e, event->name, diag));
        LIST_PUSH(list, e);
        text_addf(&words, "1 while %s holds, of event %s", event->condition, event->name);
        LIST_PUSH(code->conditions, text_done(&words));
    }
    for (int i = 0; i < count; i++) {
        char *words = expr_text(switches[i].condition);
        const unsigned unknown = 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;

        if (!code_is_side(code, switches[i].call) &&
            (expr_kinds(switches[i].condition) & unknown) == 0) {
            LIST_PUSH(list, switches[i].condition);
            LIST_PUSH(code->conditions, words);
        } else
            mem_free(words);
    }
    code_add_function(code, "conditions", "what changes its sign where equations jump or bend",
                      list.at, list.count, 1);
done:
    LIST_FREE(list);
    return status;
}

/* Steps of exported code know no new values: an event that sets some is refused by its name. */
static Status check_events(const Code *code, Diag *diag)
{
    const Model *model = code->view->model;

    for (int i = 0; i < model_event_count(model); i++) {
        const Event *event = model_event(model, i);

        if (event->action != EVENT_SET)
            continue;
        (void)diag_set(diag, E_MODEL,
                       "event %s sets new values, which a step of exported code doesn't do",
                       event->name);
        diag_hint(diag, "export fmu does; or without it: delete %s", event->name);
        return E_MODEL;
    }
    return OK;
}

/* --- the whole --- */

/* operations on parameters alone that later ones use */
static void find_derived(Code *code)
{
    const Lowered *low = &code->lowered;
    bool *wanted = NEW_ARRAY(bool, low->values.count);

    code->derived = NEW_ARRAY(int, low->values.count);
    for (int v = 0; v < low->values.count; v++)
        for (int i = 0; i < code_operands(low->values.at[v].code); i++)
            if (low->values.at[v].stage != STAGE_PARAMETER)
                wanted[low->values.at[v].args[i]] = true;
    for (int i = 0; i < low->root_count; i++)
        wanted[low->roots[i]] = true;
    for (int v = 0; v < low->values.count; v++) {
        const LoweredValue *value = &low->values.at[v];

        code->derived[v] = -1;
        if (wanted[v] && value->stage == STAGE_PARAMETER && value->code != CODE_INPUT &&
            value->code != CODE_CONSTANT)
            code->derived[v] = code->parameters.count + code->derived_count++;
    }
    mem_free(wanted);
}

static Status lower(Code *code, Diag *diag)
{
    const VariableIndex *l = code->layout;
    const int own = code->parameters.count + l->count;
    const int seeds = code->live.seed_count;
    Expr *inputs = NEW_ARRAY(Expr, own + seeds);
    Status status;

    for (int i = 0; i < code->parameters.count; i++)
        inputs[i] = code->parameters.at[i];
    memcpy(inputs + code->parameters.count, l->symbols, (size_t)l->count * sizeof(Expr));
    for (int i = 0; i < seeds; i++)
        inputs[own + i] = code->live.seeds[i];
    status =
        lowered_make(code->roots.at, code->roots.count, inputs, own + seeds, &code->lowered, diag);
    mem_free(inputs);
    return status;
}

Status code_form(const Exported *what, Code *code, Diag *diag)
{
    System *system = what->inverse != NULL ? what->inverse->system : what->view.system;
    const VariableIndex *l;
    Status status = OK;

    code->view = &what->view;
    code->arena = system_arena(system);
    code->texts = pool_new(0);
    code->inverse = what->inverse;
    CHECK(system_form_mass(system, diag));
    code->layout = variable_index_new(system);
    l = code->layout;
    if (l->ne > 0) {
        status = diag_set(diag, E_MODEL, "a driver with by= is for inverse runs: %s is not known",
                          expr_name(l->symbols[l->efforts]));
        goto done;
    }
    code->ny = l->n + l->nu + l->nx + l->multi_turns;
    code->ns = l->nx + l->nz + l->nu + l->m;
    if (code->ny + code->ns == 0) {
        status = diag_set(diag, E_MISSING, "the model has no equations yet, so there is no code");
        diag_hint(diag, "code is of a model with bodies and joints, or a network");
        goto done;
    }
    CHECK(code_find_modes(code, diag));
    add_blocks(code);
    if (!code->live.is_wanted && code->inverse == NULL)
        CHECK(add_embedded(code, diag));
    CHECK(add_derivative(code, diag));
    add_angles(code);
    if (code_has_modes(code))
        CHECK(add_modes(code, diag));
    else
        add_groups(code);
    CHECK(add_outputs(code, what, diag));
    if (code->live.is_wanted) {
        code->is_redundant = l->m > 0; /* it may become so elsewhere */
        CHECK(code_live_events(code, diag));
        code_live_tangents(code);
        code_live_relations(code);
    } else {
        CHECK(add_conditions(code, diag));
        if (code->inverse == NULL) {
            CHECK(check_events(code, diag));
            CHECK(code_add_samples(code, diag));
        }
    }
    if (code->inverse != NULL) {
        add_efforts(code);
        code_write_now(code);
        code_find_direct(code);
    }
    if (arena_status(code->arena) != OK) {
        status = diag_set(diag, arena_status(code->arena), "the code is too large: %s",
                          arena_failure(code->arena));
        arena_reset(code->arena);
        goto done;
    }
    CHECK(monitor_poll(what->view.watch));
    add_parameters(code);
    add_inputs(code);
done:
    return status;
}

Status code_new(const Exported *what, bool is_live, Code **out, Diag *diag)
{
    Code *code = NEW(Code);
    Status status = OK;

    code->live.is_wanted = is_live;
    CHECK(code_form(what, code, diag));
    CHECK(lower(code, diag));
    find_derived(code);
    CHECK(code_add_states(code, what, CODE_STATES, diag));
    *out = code;
    code = NULL;
done:
    code_free(code);
    return status;
}

void code_free(Code *code)
{
    if (code == NULL)
        return;
    for (int i = 0; i < code->states.count; i++)
        MEM_FREE(code->states.at[i].y, code->states.at[i].s, code->states.at[i].sums,
                 code->states.at[i].size);
    LIST_FREE(code->states);
    for (int i = 0; i < code->outputs.count; i++)
        mem_free(code->outputs.at[i]);
    for (int i = 0; i < code->conditions.count; i++)
        mem_free(code->conditions.at[i]);
    LIST_FREE(code->direct);
    LIST_FREE(code->outputs);
    LIST_FREE(code->conditions);
    LIST_FREE(code->parameters);
    LIST_FREE(code->inputs);
    LIST_FREE(code->roots);
    LIST_FREE(code->functions);
    lowered_free(&code->lowered);
    code_live_free(&code->live);
    code_modes_free(&code->modes);
    variable_index_free(code->layout);
    pool_free(code->texts);
    MEM_FREE(code->derived, code);
}

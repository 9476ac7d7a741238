/* show_program.c: what a run evaluates, and what it is spared */
#include "present/show.h"
#include "simulate/equations/compiled_equations.h"

#include <math.h>

/* operations of a run's programs, as they are reached */
typedef struct ProgramListing {
    int hoisted;                    /* of parameters alone */
    int position, velocity, solved; /* with t and q; u and x; what is solved for */
    int asked;                      /* of M and F, if they are requested separately */
    int rates;                      /* of rates alone, which then replace the others */
} ProgramListing;

static ProgramListing work_of(const CompiledEquations *numbers)
{
    ProgramListing work = {0};

    for (int part = 0; part < COMPILED_PARTS; part++) {
        const Program *p = compiled_program(numbers, (CompiledPart)part);
        const bool is_asked = part == COMPILED_MASS;

        if (p == NULL)
            continue;
        if (part == COMPILED_RATES) {
            for (int stage = STAGE_TIME; stage < STAGE_COUNT; stage++)
                work.rates += program_operations(p, (Stage)stage);
            continue;
        }
        work.hoisted += program_operations(p, STAGE_PARAMETER);
        for (int stage = STAGE_TIME; stage < STAGE_COUNT; stage++)
            *(is_asked                  ? &work.asked
              : stage <= STAGE_POSITION ? &work.position
              : stage == STAGE_VELOCITY ? &work.velocity
                                        : &work.solved) += program_operations(p, (Stage)stage);
    }
    return work;
}

static int zeros(const Expr *entries, int count)
{
    int zero = 0;

    for (int i = 0; i < count; i++)
        zero += expr_is_zero(entries[i]);
    return zero;
}

static bool are_constant(const Expr *entries, int count)
{
    for (int i = 0; i < count; i++)
        if (stage_of(entries[i]) > STAGE_PARAMETER)
            return false;
    return count > 0;
}

static void add_line(const View *view, Text *out, const char *lead, Text *line)
{
    layout_words(out, view->page.columns, lead, line->at);
    text_free(line);
}

static void add_zeros(const View *view, Text *out, const char *name, const Expr *entries, int count)
{
    const int zero = zeros(entries, count);
    Text line = {0};

    if (zero == 0)
        return;
    text_addf(&line, "%d of %d entries of %s, which are 0", zero, count, name);
    add_line(view, out, "skipped  ", &line);
}

static void add_kept(const View *view, Text *out, const Equations *eq, const ProgramListing *work)
{
    const int nu = system_nu(view->system), all = work->position + work->velocity + work->solved;
    Text line = {0};

    layout_count(&line, work->hoisted, "operation", "operations");
    text_addf(&line, " of %d, of parameters alone: done once a run", work->hoisted + all);
    add_line(view, out, "hoisted  ", &line);
    layout_count(&line, work->position, "operation", "operations");
    text_addf(&line,
              " of t and coordinates, %d of speeds and states, %d of what is solved for: each is "
              "done again when what it reads has changed",
              work->velocity, work->solved);
    add_line(view, out, "kept     ", &line);
    if (eq->bring_mass == NULL && are_constant(system_run(view->system)->mass, nu * nu)) {
        text_add(&line, "M, which is constant: put together once");
        add_line(view, out, "kept     ", &line);
    }
    if (eq->network_is_constant && system_run(view->system)->network_entries > 0) {
        text_add(&line, "the matrix of the network, which is constant: factored once");
        add_line(view, out, "kept     ", &line);
    }
}

/* With all rows in use: redundant ones are known only at the start of a run. */
static Status eliminate(const View *view, const Equations *eq, Diag *diag)
{
    const char *const *independent;
    int count, *rows;
    Status status;

    if (eq->eliminate == NULL || model_form(view->model, &independent, &count) == FORM_EMBEDDED)
        return OK;
    rows = NEW_ARRAY(int, eq->m);
    for (int k = 0; k < eq->m; k++)
        rows[k] = k;
    status = eq->eliminate(eq->context, rows, eq->m, INFINITY, diag);
    mem_free(rows);
    return status;
}

static void add_eliminated(const View *view, Text *out, const Equations *eq,
                           const ProgramListing *work)
{
    Text line = {0};

    if (eq->eliminated == NULL)
        return;
    text_add(&line, "factoring the matrix of accelerations and ");
    layout_count(&line, eq->m, "multiplier", "multipliers");
    text_addf(&line,
              ", which these operations eliminate in a run that needs it more than %d times, "
              "wherever no singular position is near",
              MOTION_FACTORS_PAID);
    if (work->rates > 0) {
        text_add(&line, "; rates alone then take ");
        layout_count(&line, work->rates, "operation", "operations");
    }
    add_line(view, out, "skipped  ", &line);
}

static void add_skipped(const View *view, Text *out, const Equations *eq,
                        const ProgramListing *work)
{
    const EquationForm *r = system_run(view->system);
    const int nu = system_nu(view->system), m = system_m(view->system);
    const char *const *independent;
    int count;
    Text line = {0};

    add_zeros(view, out, "Phi_u", r->phi_u, m * nu);
    add_eliminated(view, out, eq, work);
    if (eq->bring_mass == NULL) {
        add_zeros(view, out, "M", r->mass, nu * nu);
    } else {
        text_add(&line, "M, which accelerations do without");
        if (work->asked > 0) {
            text_add(&line, ": ");
            layout_count(&line, work->asked, "operation", "operations");
        }
        add_line(view, out, "skipped  ", &line);
    }
    if (m > 0 && model_form(view->model, &independent, &count) == FORM_EMBEDDED) {
        layout_count(&line, m, "multiplier", "multipliers");
        text_add(&line, ", which the embedded form does without");
        add_line(view, out, "skipped  ", &line);
    }
    text_add(&line,
             "solving at rows of t, coordinates, speeds and states: they are read as they are");
    add_line(view, out, "skipped  ", &line);
}

/* blocks on several threads, where that is set */
static void add_apart(const View *view, Text *out, const CompiledEquations *numbers)
{
    const int threads = 1 + model_setting_value(view->model, SETTING_JOBS);
    int most = 1, all = 0;
    Text line = {0};

    for (int part = 0; part < COMPILED_RATES; part++) { /* they are in the others, too */
        const Program *p = compiled_program(numbers, (CompiledPart)part);
        int own = 0;
        const int parts = p != NULL ? program_parts(p, &own) : 1;

        most = parts > most ? parts : most;
        all += own;
    }
    if (threads == 1)
        return;
    if (most > 1) {
        layout_count(&line, all, "operation", "operations");
        text_addf(&line, " of instances, in %d parts at the same time, on %d threads at most", most,
                  threads);
    } else {
        text_addf(&line, "nothing: no instances have so many operations that %d threads would pay",
                  threads);
    }
    add_line(view, out, "apart    ", &line);
}

static void print_programs(const CompiledEquations *numbers, Text *out)
{
    static const char *const names[COMPILED_PARTS] = {"equations",
                                                      "network",
                                                      "conditions",
                                                      "slip on surfaces",
                                                      "M and F, where they are asked for",
                                                      "rates, where constraints are eliminated"};

    for (int part = 0; part < COMPILED_PARTS; part++) {
        const Program *p = compiled_program(numbers, (CompiledPart)part);

        if (p == NULL || program_count(p).add + program_count(p).mul + program_count(p).fun == 0)
            continue;
        text_addf(out, "%s:\n", names[part]);
        program_print(out, p);
    }
}

Status show_program(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    Threads *threads = threads_new();
    Parameters parameters = {.threads = threads}; /* whatever their values are */
    VariableIndex *layout = variable_index_new(view->system);
    CompiledEquations *numbers = NULL;
    const Equations *eq;
    Status status;
    ProgramListing work;

    (void)selection;
    threads_set(threads, 1 + model_setting_value(view->model, SETTING_JOBS));
    CHECK(compiled_new(layout, &parameters, &numbers, diag));
    eq = compiled_equations(numbers);
    CHECK(eliminate(view, eq, diag));
    work = work_of(numbers);
    if (eq->bring_mass == NULL)
        CHECK(system_form_mass(view->system, diag));
    print_programs(numbers, out);
    add_kept(view, out, eq, &work);
    add_skipped(view, out, eq, &work);
    add_apart(view, out, numbers);
done:
    compiled_free(numbers);
    variable_index_free(layout);
    parameters_free(&parameters);
    threads_free(threads);
    return status;
}

/* bench_edit.c: a chain of 100 links formed anew, and after an edit of its middle
 *
 * Both up to the programs that a run steps with. */
#include "formulate/system.h"
#include "simulate/equations/numbers.h"

#include "../random.h"
#include "../unit/form.h"
#include "bench.h"
#include "bench_model.h"

#include <math.h>
#include <string.h>

enum { LINKS = 100, TRIES = 4 };

static void add_link(Text *text, int i, bool planar, uint64_t *random)
{
    const char *z = planar ? "" : ", 0.1";

    text_addf(text, "body b%d mass=%.3f inertia=", i, test_uniform(random, 0.5, 2.0));
    if (planar)
        text_addf(text, "%.3f\n", test_uniform(random, 0.3, 0.5));
    else
        text_addf(text, "[%.3f, %.3f, %.3f, 0.01, -0.02, 0.03]\n", test_uniform(random, 0.3, 0.5),
                  test_uniform(random, 0.3, 0.5), test_uniform(random, 0.3, 0.5));
    text_addf(text, "arm h%d b%d [%.3f, 0%s]\n", i, i, test_uniform(random, -0.6, -0.3), z);
    if (i > 0)
        text_addf(text, "arm t%d b%d [%.3f, 0.2%s]\n", i, i - 1, test_uniform(random, 0.3, 0.6), z);
    text_addf(text, "revolute j%d ", i);
    if (i == 0)
        text_add(text, "ground h0");
    else
        text_addf(text, "t%d h%d", i, i);
    if (!planar)
        text_addf(text, " axis=[%.3f, %.3f, 1]", test_uniform(random, -1.0, 1.0),
                  test_uniform(random, -1.0, 1.0));
    text_char(text, '\n');
}

static char *chain_text(bool planar, const char *tree)
{
    Text text = {0};
    uint64_t random = 1993;

    text_add(&text, planar ? "scene planar\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < LINKS; i++)
        add_link(&text, i, planar, &random);
    text_addf(&text, "tree %s\n", tree);
    return text_done(&text);
}

static double parameter(void *context, Expr symbol)
{
    return model_number(context, symbol);
}

/* The equations and the programs that a run steps with: seconds. */
static double form(Model *model)
{
    const double began = bench_now();
    System *system = NULL;
    Layout *layout = NULL;
    Parameters parameters = {.value = parameter, .context = model};
    Numbers *numbers = NULL;
    Diag diag = {0};
    double took;
    Status status = form_system(model, &system, &diag);

    if (status == OK) {
        layout = layout_new(system);
        status = numbers_new(layout, &parameters, &numbers, &diag);
    }
    took = bench_now() - began;
    if (status != OK)
        printf("# %s\n", diag.message);
    numbers_free(numbers);
    parameters_free(&parameters);
    layout_free(layout);
    system_free(system);
    return took;
}

static void edit(Model *model, const char *line)
{
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag = {0};

    if (statement_parse(line, 1, (SyntaxOptions){0}, &next, &statement, &diag) != OK ||
        model_apply(model, statement, &diag) != OK)
        printf("# %s\n", diag.message);
    statement_free(statement);
}

static void chain_line(bool planar, const char *tree, const char *what, double seconds)
{
    Text name = {0};

    text_addf(&name, "edit.%s_%s_%d_%s", planar ? "planar" : "spatial", tree, LINKS, what);
    bench_line(name.at, 1e3 * seconds, "ms");
    text_free(&name);
}

static void bench_chain(bool planar, const char *tree)
{
    static const struct {
        const char *what, *one, *other;
    } edits[] = {
        {"mass", "set b50.mass = 1.25", "set b50.mass = 1.75"},
        {"length", "set h50.position = [-0.5, 0, 0.2]", "set h50.position = [-0.4, 0, 0.1]"},
        {"joint", "set j50.axis = [0.5, 0.25, 1]", "set j50.axis = [0.25, 0.5, 1]"},
    };
    char *text = chain_text(planar, tree);
    double least = 1e300;
    Model *model = NULL;

    for (int i = 0; i < TRIES; i++) {
        model_free(model);
        model = bench_model(text);
        least = fmin(least, form(model));
    }
    chain_line(planar, tree, "anew", least);
    for (int k = 0; k < (planar ? 1 : COUNT(edits)); k++) {
        least = 1e300;
        for (int i = 0; i < TRIES; i++) {
            edit(model, i % 2 == 0 ? edits[k].one : edits[k].other);
            least = fmin(least, form(model));
        }
        chain_line(planar, tree, edits[k].what, least);
    }
    model_free(model);
    mem_free(text);
}

int main(void)
{
    static const char *const trees[] = {"joint", "absolute"};

    for (int i = 0; i < COUNT(trees); i++) {
        bench_chain(true, trees[i]);
        bench_chain(false, trees[i]);
    }
    return 0;
}

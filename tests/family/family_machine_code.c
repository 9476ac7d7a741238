/* family_machine_code.c: what the C code of a machine computes, against equations of another kind
 *
 * Machines of machine_draw.h, some numbers of theirs parameters, are exported as C, compiled by the
 * compiler of this machine and loaded; its outputs, at the start and behind steps of its own
 * integrator, with parameters changed in the code, are held against the oracle of machine.h. Those
 * of machine_hybrid_draw.h have sampled control, switches, diodes and events. */
#include "machine_hybrid_draw.h"
#include "machine_inputs.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <unistd.h>

enum { ITEMS = 16, STEPS = 400 };

#define STEP 2.5e-4

/* what the code has */
typedef struct Code {
    void *library;
    int (*sizes)(int *);
    void (*parameters)(double *), (*prepare)(double *), (*start)(double *, double *);
    int (*rates)(const double *, double, const double *, double *, double *, double *);
    int (*step)(const double *, double, double, double *, double *, double *);
    void (*outputs)(const double *, double, const double *, const double *, double *);
    double *p, *y, *s, *work, *yy;
    char folder[40];
} Code;

static void find_symbol(const Code *code, const char *name, void *out)
{
    void *found = dlsym(code->library, name);

    memcpy(out, &found, sizeof found);
}

/* compiled and loaded; false: it can't be */
static bool code_open(Code *code, const char *text)
{
    char path[80], command[300];
    int size[5] = {0};
    FILE *file;

    *code = (Code){.folder = "/tmp/machine_XXXXXX"};
    if (mkdtemp(code->folder) == NULL)
        return false;
    (void)snprintf(path, sizeof path, "%s/m.c", code->folder);
    file = fopen(path, "w");
    if (file == NULL)
        return false;
    (void)fprintf(file,
                  "%s\nint model_sizes(int *out);\nint model_sizes(int *out) { out[0] = MODEL_P; "
                  "out[1] = MODEL_Y; out[2] = MODEL_S; out[3] = MODEL_WORK; return 0; }\n",
                  text);
    if (fclose(file) != 0)
        return false;
    (void)snprintf(command, sizeof command,
                   "cc -std=c99 -O0 -w -shared -fPIC -o %s/m.so %s -lm >%s/said 2>&1", code->folder,
                   path, code->folder);
    if (system(command) != 0) /* NOLINT(cert-env33-c): the compiler of this machine */
        return false;
    (void)snprintf(path, sizeof path, "%s/m.so", code->folder);
    code->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (code->library == NULL)
        return false;
    find_symbol(code, "model_sizes", &code->sizes);
    find_symbol(code, "model_parameters", &code->parameters);
    find_symbol(code, "model_prepare", &code->prepare);
    find_symbol(code, "model_start", &code->start);
    find_symbol(code, "model_rates", &code->rates);
    find_symbol(code, "model_step", &code->step);
    find_symbol(code, "model_outputs", &code->outputs);
    (void)code->sizes(size);
    code->p = calloc((size_t)size[0] + 1, sizeof(double));
    code->y = calloc((size_t)size[1] + 1, sizeof(double));
    code->yy = calloc((size_t)size[1] + 1, sizeof(double));
    code->s = calloc((size_t)size[2] + 1, sizeof(double));
    code->work = calloc((size_t)size[3] + 1, sizeof(double));
    return code->p != NULL && code->y != NULL && code->yy != NULL && code->s != NULL &&
           code->work != NULL;
}

static void code_close(Code *code)
{
    static const char *const files[] = {"m.c", "m.so", "said"};
    char path[80];

    if (code->library != NULL)
        (void)dlclose(code->library);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        (void)snprintf(path, sizeof path, "%s/%s", code->folder, files[i]);
        (void)remove(path);
    }
    (void)rmdir(code->folder);
    free(code->p);
    free(code->y);
    free(code->yy);
    free(code->s);
    free(code->work);
}

/* --- members --- */

static bool is_of(const double *number, const void *first, size_t size)
{
    return (const char *)number >= (const char *)first &&
           (const char *)number < (const char *)first + size;
}

/* another value of each parameter that moves no frame, in the code and for the oracle */
static void change_parameters(Member *member, Code *code, const char *text, Slopes *s)
{
    const Machine *m = &s->d->m;

    for (int i = 0; i < s->inputs; i++) {
        SlopeInput *in = &s->input[i];
        char line[40];
        const char *found;
        int place;

        if (is_of(in->number, m->place, sizeof m->place) ||
            is_of(in->number, m->hinge, sizeof m->hinge))
            continue;
        for (place = 0; place < 2 * INPUTS; place++) {
            (void)snprintf(line, sizeof line, "p[%d]  %s = ", place, in->name);
            found = strstr(text, line);
            if (found == NULL)
                continue;
            *in->number *= member_between(member, 0.7, 1.4);
            code->p[place] = *in->number;
            tell(member, "%s becomes %.17g\n", in->name, *in->number);
            break;
        }
    }
    code->prepare(code->p);
}

static Verdict compare_items(Member *member, Code *code, const Slopes *s, const Asks *asks,
                             double t, double bound)
{
    double out[ITEMS];

    if (code->rates(code->p, t, code->y, code->s, code->work, code->yy) != 0)
        return REFUSED;
    code->outputs(code->p, t, code->y, code->s, out);
    for (int i = 0; i < s->outputs; i++) {
        const Ask *a = &asks->ask[s->output[i]];

        if (!keeps(member, a->text, fabs(out[i] - a->wanted) / a->scale, bound)) {
            tell(member, "%s at %g is %.12g, wanted %.12g\n", a->text, t, out[i], a->wanted);
            return DISAGREES;
        }
    }
    return AGREES;
}

static Verdict code_agrees(Member *member, Code *code, Slopes *s, const char *text)
{
    static Asks asks;
    Real y[MOST_STATES];
    Verdict verdict;

    code->parameters(code->p);
    code->start(code->y, code->s);
    change_parameters(member, code, text, s);
    memcpy(y, s->d->y, sizeof y);
    if (oracle_answers(s->d, 0, 0, y, &asks) != AGREES)
        return REFUSED;
    verdict = compare_items(member, code, s, &asks, 0, 1e-8);
    for (int k = 0; k < STEPS && verdict == AGREES; k++)
        if (code->step(code->p, k * STEP, STEP, code->y, code->s, code->work) != 0)
            verdict = REFUSED;
    if (verdict == AGREES)
        verdict = oracle_answers(s->d, 0, STEPS * STEP, y, &asks);
    return verdict == AGREES ? compare_items(member, code, s, &asks, STEPS * STEP, 1e-5) : verdict;
}

static void write_export(Member *member, Slopes *s, char *line, size_t room)
{
    static Asks asks;
    static Instant now;
    size_t length = (size_t)snprintf(line, room, "export c");

    memset(&now, 0, sizeof now);
    for (int b = 0; b < BODIES; b++)
        now.R[b] = turn_about(vec(0, 0, 1), 0);
    ask_all(&s->d->m, &now, &asks);
    for (s->outputs = 0; s->outputs < OUTPUTS; s->outputs++) {
        s->output[s->outputs] = member_one_of(member, asks.count);
        length += (size_t)snprintf(line + length, room - length, " %s",
                                   asks.ask[s->output[s->outputs]].text);
    }
    (void)snprintf(line + length, room - length, "\n");
}

/* Code of a machine moves it as its parts move, with parameters that are changed in the code. */
static Verdict code_moves(Member *member)
{
    static Drawn d;
    static Slopes s;
    Kit kit = kit_new();
    Code code = {0};
    char line[600];
    Verdict verdict = REFUSED;

    while (!draw_machine(member, &d) || (d.m.coordinates == 0 && d.m.states == 0))
        ;
    s = (Slopes){.d = &d};
    draw_inputs(member, &s);
    draw_tree(member, &d, member_one_of(member, 3));
    write_export(member, &s, line, sizeof line);
    if (do_told(member, &kit, d.script.text) == CT_OK && do_told(member, &kit, line) == CT_OK) {
        if (code_open(&code, kit.text))
            verdict = code_agrees(member, &code, &s, kit.text);
        else
            tell(member, "the code isn't compiled\n");
        code_close(&code);
    }
    kit_free(&kit);
    return verdict;
}

/* all values at `to`; false: the oracle isn't sure, or something jumps there */
static bool hybrid_answers(Hybrid *h, double to, Asks *asks)
{
    Real y[MOST_STATES];
    double at = 0;

    memcpy(y, h->d.y, sizeof y);
    return hybrid_starts(h, y) && !h->unsure && hybrid_asks(h, &at, to, y, asks) == HYBRID_ANSWERS;
}

/* Code of a machine takes samples, switches and turns diodes off as its parts do, or is refused. */
static Verdict hybrid_code_moves(Member *member)
{
    static Hybrid h;
    static Slopes s;
    static Asks asks;
    Kit kit = kit_new();
    Code code = {0};
    char line[600];
    Verdict verdict = REFUSED;

    while (!draw_hybrid(member, &h, false))
        ;
    s = (Slopes){.d = &h.d};
    draw_tree(member, &h.d, member_one_of(member, 3));
    write_export(member, &s, line, sizeof line);
    if (do_told(member, &kit, h.d.script.text) == CT_OK && do_told(member, &kit, line) == CT_OK &&
        code_open(&code, kit.text)) {
        code.parameters(code.p);
        code.prepare(code.p);
        code.start(code.y, code.s);
        verdict = AGREES;
        for (int k = 0; k < STEPS && verdict == AGREES; k++)
            if (code.step(code.p, k * STEP, STEP, code.y, code.s, code.work) != 0)
                verdict = REFUSED;
        if (verdict == AGREES && !hybrid_answers(&h, STEPS * STEP, &asks))
            verdict = REFUSED;
        if (verdict == AGREES)
            verdict = compare_items(member, &code, &s, &asks, STEPS * STEP, 1e-4);
    }
    code_close(&code);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"code of machines moves them as their parts do", 6, 0.1, 0, code_moves},
    {"code of machines samples and switches as their parts do", 6, 0.9, 0, hybrid_code_moves},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

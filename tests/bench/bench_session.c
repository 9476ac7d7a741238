/* bench_session.c: what a user waits for: the shell's start, equations, a whole script
 *
 * bench_session SCRIPTS PROGRAM; each script of SCRIPTS/paper and SCRIPTS/reference that this
 * version can read is formulated and replayed. */
#include "base/decimal.h"
#include "formulate/system/system.h"

#include "../unit/form.h"
#include "../unit/session_kit.h"
#include "bench.h"
#include "bench_model.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char *file_text(const char *path)
{
    Text text = {0};
    char piece[4096];
    FILE *file = fopen(path, "r");

    if (file == NULL)
        return NULL;
    while (fgets(piece, sizeof piece, file) != NULL)
        text_add(&text, piece);
    fclose(file);
    return text_done(&text);
}

/* what a script builds, up to where it clears that; NULL: it can't be */
static Model *model_of(const char *path)
{
    char *text = file_text(path);
    char *cleared = text != NULL ? strstr(text, "\nclear\n") : NULL;
    Model *model;

    if (cleared != NULL)
        cleared[1] = '\0';
    model = text != NULL ? bench_model(text) : NULL;

    mem_free(text);
    return model;
}

/* Seconds to formulate a script's model: trees, constraints, dynamics, the recursive form. The
 * arena is new each time. Negative: it can't be. */
static double formulate(const char *path)
{
    double least = 1e300;

    for (int i = 0; i < 5; i++) {
        Model *model = model_of(path);
        System *system = NULL;
        Diag diag;
        double began = clock_now();
        bool made =
            model != NULL && form_system(model, &system, &diag) == OK && system_run(system) != NULL;
        double took = clock_now() - began;

        system_free(system);
        model_free(model);
        if (!made)
            return -1;
        least = took < least ? took : least;
    }
    return least;
}

/* Seconds until the program has done what its arguments say; negative: it failed. */
static double program_time(const char *program, const char *flag, const char *what)
{
    double began;
    int ended;
    pid_t child;

    (void)fflush(stdout); /* or the child prints what is pending once more */
    began = clock_now();
    child = fork();
    if (child == 0) {
        if (freopen("/dev/null", "w", stdout) != NULL && freopen("/dev/null", "w", stderr) != NULL)
            execl(program, program, flag, what, (char *)NULL);
        _exit(127);
    }
    if (child < 0 || waitpid(child, &ended, 0) != child || ended != 0)
        return -1;
    return clock_now() - began;
}

static int compare_times(const void *a, const void *b)
{
    double one = *(const double *)a;
    double other = *(const double *)b;

    return (one > other) - (one < other);
}

/* the median of twenty runs: what a user waits */
static double program_median(const char *program, const char *flag, const char *what)
{
    double took[20];

    for (int i = 0; i < COUNT(took); i++) {
        took[i] = program_time(program, flag, what);
        if (took[i] < 0)
            return took[i];
    }
    qsort(took, COUNT(took), sizeof *took, compare_times);
    return 0.5 * (took[COUNT(took) / 2 - 1] + took[COUNT(took) / 2]);
}

static int is_script(const struct dirent *entry)
{
    const char *ending = strrchr(entry->d_name, '.');

    return ending != NULL && strcmp(ending, ".ct") == 0;
}

static void folder_bench(const char *folder, const char *program)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, is_script, alphasort);

    for (int i = 0; i < count; i++) {
        Text path = {0}, name = {0};
        double took;

        text_addf(&path, "%s/%s", folder, entries[i]->d_name);
        took = formulate(path.at);
        if (took >= 0) {
            text_addf(&name, "formulate.%.*s", (int)strlen(entries[i]->d_name) - 3,
                      entries[i]->d_name);
            bench_line(name.at, took * 1e3, "ms");
            text_free(&name);
            took = program_time(program, "-q", path.at);
            if (took >= 0) {
                text_addf(&name, "replay.%.*s", (int)strlen(entries[i]->d_name) - 3,
                          entries[i]->d_name);
                bench_line(name.at, took * 1e3, "ms");
                text_free(&name);
            }
        }
        text_free(&path);
        free(entries[i]);
    }
    free(entries);
}

/* Seconds to apply the statements that make `links` links; negative: one was refused. */
static double apply(int links)
{
    Text text = {0};
    double took;

    text_add(&text, "scene planar\nL = 1\n");
    for (int i = 0; i < links; i++) {
        text_addf(&text, "k%d = %d*L\nbody b%d mass=k%d\narm p%d b%d [L, 0]\n", i, i, i, i, i, i);
        text_addf(&text, i > 0 ? "revolute h%d p%d b%d\n" : "revolute h%d ground b%d\n", i,
                  i > 0 ? i - 1 : i, i);
        text_addf(&text, "init h%d = 0.1\n", i);
    }
    took = clock_now();
    Model *model = bench_model(text.at);

    took = model != NULL ? clock_now() - took : -1;
    model_free(model);
    text_free(&text);
    return took;
}

/* Seconds of a run of two rods with its csv, at so many rows; negative: it failed. */
static double rows_time(Kit *kit, const char *every)
{
    Text text = {0};
    double least = 1e300;
    bool done = true;

    text_addf(&text, "simulate 10 rtol=1e-8 every=%s\nexport csv h1 h2 h1' h2'\n", every);
    for (int i = 0; i < 50 && done; i++) {
        const double began = clock_now();

        done = kit_do(kit, text.at) == CT_OK;
        least = fmin(least, clock_now() - began);
    }
    text_free(&text);
    return done ? least : -1;
}

/* nanoseconds of a decimal that reads back, of numbers as results are */
static double decimal_time(void)
{
    enum { MANY = 20000 };
    double *values = NEW_ARRAY(double, MANY), seconds;
    char text[DECIMAL_SIZE];

    for (int i = 0; i < MANY; i++)
        values[i] = 3 * sin(1.7 * i * i);
    BENCH_LEAST(50, seconds,
                for (int i = 0; i < MANY; i++)(void) decimal_print(text, values[i], DECIMAL_EXACT));
    mem_free(values);
    return 1e9 * seconds / MANY;
}

/* what rows cost, beside the run that they are of */
static void bench_rows(void)
{
    Kit kit = kit_new();
    double few = -1, many = -1;

    if (kit_do(&kit, "scene planar\ngravity [0, -9.81]\nbody r1 mass=1 inertia=0.1\n"
                     "body r2 mass=1 inertia=0.1\narm c1 r1 [-1, 0]\narm c2 r2 [-1, 0]\n"
                     "revolute h1 ground c1\nrevolute h2 r1 c2\n") == CT_OK) {
        few = rows_time(&kit, "10");
        many = rows_time(&kit, "0.01");
    }
    kit_free(&kit);
    if (few < 0 || many < 0) {
        printf("# rows: a run of two rods failed\n");
        return;
    }
    bench_line("rows.decimal", decimal_time(), "ns");
    bench_line("rows.2_with_csv", few * 1e3, "ms");
    bench_line("rows.1001_with_csv", many * 1e3, "ms");
    bench_line("rows.1001_over_2", many / few, "times");
}

/* a run of three rods, with 13 parameters; derivatives of a coordinate by `count` of them */
static double sensitivities_time(Kit *kit, int count)
{
    Text text = {0};
    double seconds;
    bool done = true;

    text_add(&text, "export csv");
    for (int i = 0; i < count; i++)
        text_addf(&text, " d(h3)/d(%c%d)", "LmcA"[i / 3], i % 3 + 1);
    BENCH_LEAST(5, seconds, done = done && kit_do(kit, text.at) == CT_OK);
    text_free(&text);
    return done ? seconds : -1;
}

/* d(h)/d(p) beside the run, and beside two runs for each parameter */
static void bench_sensitivities(void)
{
    Kit kit = kit_new();
    Text text = {0};
    double run, one, all;
    bool done;

    text_add(&text, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= 3; i++) {
        text_addf(&text, "L%d = 1; m%d = 1; c%d = 0.1; A%d = 0.3\nbody b%d mass=m%d inertia=0.1\n",
                  i, i, i, i, i, i);
        text_addf(&text, "arm p%d b%d [-L%d/2, 0]; arm r%d b%d [L%d/2, 0]\n", i, i, i, i, i, i);
        text_addf(&text, i > 1 ? "revolute h%d r%d p%d\n" : "revolute h%d ground p1\n", i, i - 1,
                  i);
        text_addf(&text, "damper D%d h%d d=c%d\n", i, i, i);
        text_addf(&text, "init h%d = A%d\n", i, i);
    }
    done = kit_do(&kit, text.at) == CT_OK;
    BENCH_LEAST(5, run, done = done && kit_do(&kit, "simulate 10 rtol=1e-8 every=0.1") == CT_OK);
    one = sensitivities_time(&kit, 1);
    all = sensitivities_time(&kit, 12);
    text_free(&text);
    kit_free(&kit);
    if (!done || one < 0 || all < 0) {
        printf("# sensitivities: a run of three rods failed\n");
        return;
    }
    bench_line("sensitivities.run", run * 1e3, "ms");
    bench_line("sensitivities.by_1", one * 1e3, "ms");
    bench_line("sensitivities.by_12", all * 1e3, "ms");
    bench_line("sensitivities.by_12_over_24_runs", all / (24 * run), "times");
}

int main(int argc, char **argv)
{
    static const char *const folders[] = {"paper", "reference"};

    if (argc != 3) {
        fprintf(stderr, "usage: bench_session SCRIPTS PROGRAM\n");
        return 2;
    }
    bench_line("shell.start", program_median(argv[2], "-e", "quit") * 1e3, "ms");
    bench_line("apply.500_links", apply(500) * 1e3, "ms");
    bench_line("apply.4000_links", apply(4000) * 1e3, "ms");
    bench_rows();
    bench_sensitivities();
    for (int i = 0; i < COUNT(folders); i++) {
        Text folder = {0};

        text_addf(&folder, "%s/%s", argv[1], folders[i]);
        folder_bench(folder.at, argv[2]);
        text_free(&folder);
    }
    return 0;
}

/* main.c: options, and which lines are run: files, -e, standard input, the prompt */
#include "command.h"
#include "copy.h"
#include "file.h"
#include "interrupt.h"
#include "line_edit.h"
#include "replay.h"
#include "report_error.h"
#include "shell.h"

#include <errno.h>
#include <getopt.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* exit statuses */
enum { DONE = 0, FAILED = 1, WRONG_USAGE = 2, UNMET = 3, UNSOLVED = 4 };

enum {
    OPTION_SEED = 256,
    OPTION_VERSION,
    OPTION_HELP,
    OPTION_REFERENCE,
    OPTION_NO_INIT,
    OPTION_SAFE
};

static const struct option long_options[] = {
    {"define", required_argument, NULL, 'D'},
    {"execute", required_argument, NULL, 'e'},
    {"interactive", no_argument, NULL, 'i'},
    {"keep-going", no_argument, NULL, 'k'},
    {"quiet", no_argument, NULL, 'q'},
    {"no-init", no_argument, NULL, OPTION_NO_INIT},
    {"safe", no_argument, NULL, OPTION_SAFE},
    {"seed", required_argument, NULL, OPTION_SEED},
    {"reference", required_argument, NULL, OPTION_REFERENCE},
    {"version", no_argument, NULL, OPTION_VERSION},
    {"help", no_argument, NULL, OPTION_HELP},
    {NULL, 0, NULL, 0},
};

static const char usage[] =
    "usage: cotree [OPTION]... [FILE]...\n"
    "Model mechatronic multibody systems as linear graphs. Executes the files and the\n"
    "-e statements in their order; without any, reads standard input.\n"
    "\n"
    "  -D, --define NAME=VALUE  a parameter's value that wins over the files'; repeatable\n"
    "  -e, --execute STATEMENT  execute a statement; repeatable\n"
    "  -i, --interactive        continue at the prompt afterwards\n"
    "  -k, --keep-going         continue after a statement that failed\n"
    "  -q, --quiet              no banner and no remarks; warnings remain\n"
    "      --no-init            don't read the start-up file\n"
    "      --safe               write no file, and read none outside the script's folder\n"
    "      --seed N             seed of random numbers\n"
    "      --reference FORMAT   print the reference of the language: texinfo, man or words\n"
    "      --version            print the version\n"
    "      --help               print this\n"
    "\n"
    "Exit status: 0 success, 1 a statement failed or was stopped, 2 wrong usage,\n"
    "3 an `expect` did not hold, 4 a computation failed (no start, no step, no\n"
    "convergence).\n"
    "Environment: GNUPLOT, PAGER, XDG_CONFIG_HOME (cotree/init.ct), XDG_STATE_HOME\n"
    "(cotree/history, cotree/unsaved).\n";

/* The options of the command line; sources in their order. */
typedef struct Invocation {
    struct {
        const char *text; /* a file's name, or lines: those of neighbouring -e together */
        bool is_file;
    } * sources;
    int count;
    const char **defined; /* NAME=VALUE; of argv */
    int defined_count;
    bool interactive;
    bool keep_going;
    bool quiet;
    bool no_init;
    bool safe;
    const char *seed;
} Invocation;

static void add_file(Invocation *request, const char *name)
{
    request->sources[request->count].is_file = true;
    request->sources[request->count++].text = copy_text(name);
}

static void add_statement(Invocation *request, const char *text)
{
    int last = request->count - 1;

    if (last >= 0 && !request->sources[last].is_file) {
        char *joined = copy_format("%s\n%s", request->sources[last].text, text);

        free((char *)request->sources[last].text);
        request->sources[last].text = joined;
        return;
    }
    request->sources[request->count++].text = copy_text(text);
}

static void request_free(Invocation *request)
{
    for (int i = 0; i < request->count; i++)
        free((char *)request->sources[i].text);
    free(request->sources);
    free(request->defined);
}

static int write_usage(const char *format, const char *what)
{
    fputs("cotree: ", stderr);
    fprintf(stderr, format, what);
    fputs("\ncotree --help shows the usage\n", stderr);
    return WRONG_USAGE;
}

static int print_and_leave(const char *text)
{
    fputs(text, stdout);
    return fflush(stdout) == 0 ? DONE : FAILED;
}

static int print_reference(const char *format)
{
    char *text = ct_reference(format);

    if (text == NULL)
        return write_usage("there is no reference as '%s': texinfo, man or words", format);

    int status = print_and_leave(text);

    ct_free(text);
    return status;
}

/* -1: go on; else leave with that status */
static int read_options(Invocation *request, int argc, char **argv)
{
    int option;

    request->sources = check_allocated(calloc((size_t)argc + 1, sizeof *request->sources));
    request->defined = check_allocated(calloc((size_t)argc + 1, sizeof *request->defined));
    opterr = 0;

    /* "-" makes getopt return files in place, so that their order among -e is preserved */
    while ((option = getopt_long(argc, argv, "-:D:e:ikq", long_options, NULL)) != -1) {
        switch (option) {
        case 1:
            add_file(request, optarg);
            break;
        case 'D':
            request->defined[request->defined_count++] = optarg;
            break;
        case 'e':
            add_statement(request, optarg);
            break;
        case 'i':
            request->interactive = true;
            break;
        case 'k':
            request->keep_going = true;
            break;
        case 'q':
            request->quiet = true;
            break;
        case OPTION_NO_INIT:
            request->no_init = true;
            break;
        case OPTION_SAFE:
            request->safe = true;
            break;
        case OPTION_SEED:
            request->seed = optarg;
            break;
        case OPTION_REFERENCE:
            return print_reference(optarg);
        case OPTION_VERSION:
            printf("cotree %s\n", ct_version());
            return print_and_leave("");
        case OPTION_HELP:
            return print_and_leave(usage);
        case ':':
            return write_usage("option '%s' needs a value", argv[optind - 1]);
        default:
            return write_usage("unknown option '%s'", argv[optind - 1]);
        }
    }
    for (; optind < argc; optind++)
        add_file(request, argv[optind]);

    /* nothing is run if a later file is missing */
    for (int i = 0; i < request->count; i++) {
        const char *name = request->sources[i].text;

        if (request->sources[i].is_file && strcmp(name, "-") != 0 && access(name, R_OK) != 0) {
            fprintf(stderr, "cotree: can't read '%s': %s\n", name, strerror(errno));
            return WRONG_USAGE;
        }
    }
    return -1;
}

/* --- the prompt --- */

static void run_init_file(Shell *shell)
{
    char *path = file_in_home("XDG_CONFIG_HOME", ".config", "init.ct", false);
    ct_error error;

    if (path != NULL && access(path, R_OK) == 0 && replay_file(shell, path, &error) == CT_FAILED &&
        error.message[0] != '\0')
        remark("%s", error.message);
    free(path);
}

static void report_leftovers(void)
{
    int count;
    Leftover *leftovers = autosave_find(&count);
    const int statements = count > 0 ? leftovers[0].statements : 0;

    if (count > 0)
        remark("left unsaved on %s: a model of %d statement%s; recover brings it back",
               leftovers[0].when, statements, statements == 1 ? "" : "s");
    if (count > 1)
        remark("recover list shows all %d", count);
    autosave_drop_all(leftovers, count, false);
}

static void run_prompt(Shell *shell, bool no_init)
{
    if (!shell->quiet)
        printf("cotree %s: linear graphs, trees, equations, runs\n"
               "help lists the commands, help WORD explains one; Tab completes, Ctrl-C stops\n"
               "Ctrl-D or quit leaves. This is free software without any warranty (GPL 3+)\n",
               ct_version());
    if (!no_init)
        run_init_file(shell);
    shell->unsaved = autosave_open(shell->session);
    if (!shell->quiet)
        report_leftovers();
    line_edit_open(shell->session);
    replay(shell, reader_of_prompt());
    line_edit_close();
    if (autosave_is_kept(shell->unsaved) && !shell->quiet)
        remark("the model was not saved: it is kept, and recover brings it back");
}

/* --- all of it --- */

static void run_sources(Shell *shell, const Invocation *request)
{
    for (int i = 0; i < request->count && !shell->quitting; i++) {
        const char *text = request->sources[i].text;
        ct_error error = {.status = CT_OK};
        ct_status status = request->sources[i].is_file ? replay_file(shell, text, &error)
                                                       : replay(shell, reader_of_text(text, "-e"));

        if (status != CT_OK && error.message[0] != '\0') {
            remark("cotree: %s", error.message);
            shell->failed++;
        }
        if (status == CT_STOPPED || (status != CT_OK && !shell->keep_going))
            break;
    }
}

/* 0, or an exit status after a message */
static int define_parameters(Shell *shell, const Invocation *request)
{
    for (int i = 0; i < request->defined_count; i++) {
        ct_error error;

        if (ct_override(shell->session, request->defined[i], &error) == CT_OK)
            continue;
        fprintf(stderr, "cotree: -D %s: %s\n", request->defined[i], error.message);
        if (error.hint[0] != '\0')
            fprintf(stderr, "    hint: %s\n", error.hint);
        return WRONG_USAGE;
    }
    return 0;
}

/* A mistyped name would otherwise go unnoticed. */
static void check_defined(Shell *shell)
{
    const char *unused = ct_override_unused(shell->session);

    if (unused == NULL || shell->failed > 0)
        return;
    remark("cotree: -D %s: there is no such parameter", unused);
    shell->failed++;
}

static int run(const Invocation *request)
{
    Shell shell;
    bool typed = isatty(STDIN_FILENO) && (request->count == 0 || request->interactive);
    bool piped = !typed && (request->count == 0 || request->interactive);
    ct_error error;

    if (request->safe)
        file_confine(NULL);
    interrupt_setup(typed);
    shell_open(&shell, command_find);
    shell.interactive = typed;
    shell.quiet = request->quiet;
    shell.keep_going = request->keep_going;

    bool bad_seed = request->seed != NULL &&
                    settings_set(&shell.settings, "seed", request->seed, &error) != CT_OK;

    if (bad_seed) {
        shell_close(&shell);
        return write_usage("--seed: %s", error.message);
    }
    const int refused = define_parameters(&shell, request);

    if (refused != 0) {
        shell_close(&shell);
        return refused;
    }
    run_sources(&shell, request);
    if (request->count > 0 && !piped)
        check_defined(&shell);
    if (typed && !shell.quitting)
        run_prompt(&shell, request->no_init || request->safe);
    else if (piped && !shell.quitting && (shell.failed + shell.unmet == 0 || shell.keep_going))
        replay_file(&shell, "-", &error);
    if (piped)
        check_defined(&shell);

    int status = typed                           ? DONE
                 : shell.failed > shell.unsolved ? FAILED
                 : shell.unsolved > 0            ? UNSOLVED
                 : shell.unmet > 0               ? UNMET
                                                 : DONE;

    shell_close(&shell);
    return status;
}

int main(int argc, char **argv)
{
    Invocation request = {0};

    /* characters as the user's, numbers as everybody's */
    setlocale(LC_ALL, "");
    setlocale(LC_NUMERIC, "C");

    int status = read_options(&request, argc, argv);

    if (status < 0)
        status = run(&request);
    request_free(&request);

    /* whoever ended us shall see that it worked */
    if (interrupt_ending() != 0) {
        signal(interrupt_ending(), SIG_DFL);
        raise(interrupt_ending());
    }
    return status;
}

/* gnuplot.c: one living gnuplot, spoken to over pipes
 *
 * After each exchange it prints a mark to both of its streams, and its error number: so we know
 * when it is done and whether it was content, without waiting for a time. */
#include "gnuplot.h"

#include "config.h"
#include "process.h"
#include "report_error.h"

#include <stdlib.h>
#include <string.h>

static const char MARK[] = "cotree: done";
static const char CLOSING[] = "\nunset output\n"
                              "set print '-'\n"
                              "print 'cotree: done'\n"
                              "set print\n"
                              "print sprintf('cotree: errors %d', GPVAL_ERRNO)\n"
                              "print 'cotree: done'\n";
static const char COUNT[] = "cotree: errors ";

struct Gnuplot {
    Process process;
    char *terminals; /* their names, between blanks */
};

static const char *find_program(void)
{
    const char *wanted = getenv("GNUPLOT");

    return wanted != NULL && *wanted != '\0' ? wanted : GNUPLOT;
}

ct_status gnuplot_start(Gnuplot **gnuplot, ct_error *error)
{
    if (*gnuplot != NULL && process_lives(&(*gnuplot)->process))
        return CT_OK;
    gnuplot_close(*gnuplot);
    *gnuplot = NULL;

    Gnuplot *new = check_allocated(calloc(1, sizeof *new));
    char *program = copy_text(find_program());
    char *argv[] = {program, NULL};
    char *printed = NULL, *warnings = NULL;
    ct_status status = process_start(&new->process, argv, error);

    free(program);
    if (status != CT_OK) {
        error_hint(error, "apt install gnuplot-nox, or name another one in $GNUPLOT");
        free(new);
        return status;
    }
    status = gnuplot_do(new, "set encoding utf8\nset print '-'\nprint GPVAL_TERMINALS", &printed,
                        &warnings, error);
    free(warnings);
    new->terminals = printed;
    if (status != CT_OK) {
        gnuplot_close(new);
        return status;
    }
    *gnuplot = new;
    return CT_OK;
}

bool gnuplot_has_terminal(const Gnuplot *gnuplot, const char *terminal)
{
    size_t length = strlen(terminal);

    for (const char *at = gnuplot->terminals; (at = strstr(at, terminal)) != NULL; at++)
        if ((at == gnuplot->terminals || at[-1] == ' ') && strchr(" \n", at[length]) != NULL)
            return true;
    return false;
}

/* The number after COUNT on the last line, which is removed. */
static int take_errors(char *said)
{
    char *at = NULL;

    for (char *next = strstr(said, COUNT); next != NULL; next = strstr(next + 1, COUNT))
        at = next;
    if (at == NULL)
        return 1;

    int count = (int)strtol(at + strlen(COUNT), NULL, 10);

    *at = '\0';
    return count;
}

/* Gnuplot echoes its input, with a caret; the message is on a line of its own after "line N:". The
 * first one is the cause. */
static char *find_message(const char *said)
{
    const char *at = strstr(said, "line ");
    const char *colon = at != NULL ? strchr(at, ':') : NULL;

    if (colon == NULL)
        return copy_text("it failed without a word");
    colon++;
    colon += strspn(colon, " ");
    return copy_piece(colon, strcspn(colon, "\n"));
}

/* its warnings, without blank lines and indentation */
static char *gather_warnings(const char *said)
{
    OutputBuffer paper;

    output_buffer_open(&paper);
    while (*said != '\0') {
        said += strspn(said, " \t\n");

        size_t length = strcspn(said, "\n");

        if (length > 0)
            fprintf(paper.out, "%s%.*s", ftell(paper.out) > 0 ? "\n" : "", (int)length, said);
        said += length;
    }
    return output_buffer_close(&paper);
}

ct_status gnuplot_do(Gnuplot *gnuplot, const char *commands, char **printed, char **warnings,
                     ct_error *error)
{
    char *all = copy_format("reset errors\n%s%s", commands, CLOSING);
    OutputBuffer out, err;
    ct_error why;

    output_buffer_open(&out);
    output_buffer_open(&err);

    ct_status status =
        process_exchange(&gnuplot->process, all, strlen(all), MARK, &out, &err, &why);
    char *said = output_buffer_close(&err);

    *printed = output_buffer_close(&out);
    *warnings = NULL;
    free(all);
    if (status == CT_FAILED) {
        error_set(error, "gnuplot: %s", why.message);
        error_hint(error, "the next plot starts another one");
    } else if (status != CT_OK) {
        /* it was in the middle of something: start afresh */
        process_end(&gnuplot->process, 0);
        *error = why;
    } else if (take_errors(said) != 0) {
        char *message = find_message(said);

        status = error_set(error, "gnuplot: %s", message);
        free(message);
    } else {
        *warnings = gather_warnings(said);
    }
    free(said);
    if (status != CT_OK) {
        free(*printed);
        *printed = NULL;
    }
    return status;
}

void gnuplot_close(Gnuplot *gnuplot)
{
    if (gnuplot == NULL)
        return;
    process_end(&gnuplot->process, 1000);
    free(gnuplot->terminals);
    free(gnuplot);
}

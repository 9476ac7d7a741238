/* units.h: families that export Functional Mock-up Units and run them in tests/fmu/master.c */
#ifndef COTREE_TESTS_UNITS_H
#define COTREE_TESTS_UNITS_H

#include "family.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct Work {
    char folder[40], script[64], unit[64], numbers[64], said[64];
} Work;

static bool work_open(Work *w)
{
    *w = (Work){.folder = "/tmp/machine_XXXXXX"};
    if (mkdtemp(w->folder) == NULL)
        return false;
    (void)snprintf(w->script, sizeof w->script, "%s/m.ct", w->folder);
    (void)snprintf(w->unit, sizeof w->unit, "%s/m.fmu", w->folder);
    (void)snprintf(w->numbers, sizeof w->numbers, "%s/m.csv", w->folder);
    (void)snprintf(w->said, sizeof w->said, "%s/said", w->folder);
    return true;
}

static void work_close(const Work *w)
{
    (void)remove(w->script);
    (void)remove(w->unit);
    (void)remove(w->numbers);
    (void)remove(w->said);
    (void)rmdir(w->folder);
}

static void report_said(Member *member, const Work *w)
{
    char line[300];
    FILE *file = fopen(w->said, "r");

    while (file != NULL && fgets(line, sizeof line, file) != NULL)
        tell(member, "%s", line);
    if (file != NULL)
        (void)fclose(file);
}

/* whether a program of this build is content */
static bool does(const char *program, const char *arguments, const Work *w)
{
    const char *build = getenv("TOP_BUILDDIR");
    char command[1000];

    (void)snprintf(command, sizeof command, "%s/%s %s >%s 2>&1", build != NULL ? build : ".",
                   program, arguments, w->said);
    return system(command) == 0; /* NOLINT(cert-env33-c): of this build */
}

#endif

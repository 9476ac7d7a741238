/* run_session.c: scripts run by the real program, and what they print compared
 *
 *     run-session [DIRECTORY...]        tests/session if none is given
 *
 * A case is NAME.ct, run as `cotree NAME.ct`, or NAME.sh, a shell script that finds `cotree` in
 * its PATH. It runs in an empty folder to which NAME.* were copied. Beside it may stand
 *
 *     NAME.expected  its standard output     NAME.errors  its standard error
 *     NAME.status    its exit status, 0 where there is none
 *
 * Text compares exactly, but for the number of blanks in a row; numbers compare within a
 * tolerance, 1e-5 relative to the larger unless the case has a comment "# tolerance 1e-8". Exit
 * status 77 skips a case, its first line says why. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATIENCE = 120, SKIPPED = 77 }; /* s a case may take; exit status */

static int passed, failed, skipped;

static const double NEARLY_ZERO = 1e-10; /* two numbers below it are the same */

/* --- files --- */

/* new: a whole file; NULL: there is none */
static char *read_file(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = NULL;
    size_t length = 0, room = 0, got;

    if (file == NULL)
        return NULL;
    do {
        room = 2 * room + 4096;
        text = realloc(text, room);
        if (text == NULL)
            abort();
        got = fread(text + length, 1, room - length - 1, file);
        length += got;
    } while (got > 0);
    text[length] = '\0';
    fclose(file);
    return text;
}

static void copy_file(const char *from, const char *to)
{
    char *text = read_file(from);
    FILE *file = fopen(to, "w");

    if (text != NULL && file != NULL)
        fputs(text, file);
    if (file != NULL)
        fclose(file);
    free(text);
}

/* the folder's files NAME.* to the current one */
static void copy_case(const char *directory, const char *name)
{
    size_t length = strlen(name);
    struct dirent **entries;
    int count = scandir(directory, &entries, NULL, alphasort);

    for (int i = 0; i < count; i++) {
        const char *file = entries[i]->d_name;

        if (strncmp(file, name, length) == 0 && file[length] == '.') {
            char *path;

            if (asprintf(&path, "%s/%s", directory, file) < 0)
                abort();
            copy_file(path, file);
            free(path);
        }
        free(entries[i]);
    }
    if (count >= 0)
        free(entries);
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

static void remove_folder(const char *path)
{
    if (nftw(path, remove_one, 8, FTW_DEPTH | FTW_PHYS) != 0)
        printf("%s stays behind\n", path);
}

/* --- comparing --- */

/* whether a number starts here: not in the middle of a name or of another number */
static bool is_number(const char *start, const char *at)
{
    const char *digits = at + (*at == '-' || *at == '+');

    if (at > start && (isalnum((unsigned char)at[-1]) || at[-1] == '_' || at[-1] == '.'))
        return false;
    return isdigit((unsigned char)*digits) || (*digits == '.' && isdigit((unsigned char)digits[1]));
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* 0: the same; else the line of the first difference */
static int compare(const char *got, const char *wanted, double tolerance)
{
    const char *got_start = got, *wanted_start = wanted;
    int line = 1;

    while (*got != '\0' || *wanted != '\0') {
        if (is_number(got_start, got) && is_number(wanted_start, wanted)) {
            char *got_end, *wanted_end;
            double a = strtod(got, &got_end), b = strtod(wanted, &wanted_end);

            if (!(fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b)) + NEARLY_ZERO))
                return line;
            got = got_end;
            wanted = wanted_end;
            continue;
        }
        if ((is_blank(*got) || got == got_start || got[-1] == '\n') &&
            (is_blank(*wanted) || wanted == wanted_start || wanted[-1] == '\n') &&
            (is_blank(*got) || is_blank(*wanted))) {
            got += strspn(got, " \t");
            wanted += strspn(wanted, " \t");
            continue;
        }
        if (*got != *wanted)
            return line;
        line += *got == '\n';
        got++;
        wanted++;
    }
    return 0;
}

static void print_line(const char *what, const char *text, int line)
{
    while (--line > 0 && strchr(text, '\n') != NULL)
        text = strchr(text, '\n') + 1;
    printf("    %s: %.*s\n", what, (int)strcspn(text, "\n"), text);
}

static bool check_stream(const char *name, const char *stream, const char *file, double tolerance)
{
    char path[PATH_MAX];

    snprintf(path, sizeof path, "%s.%s", name, file);

    char *wanted = read_file(path);
    char *got = read_file(stream);
    int line = wanted != NULL && got != NULL ? compare(got, wanted, tolerance) : 0;

    if (line > 0) {
        printf("%s: line %d of %s is another\n", name, line, stream);
        print_line("got   ", got, line);
        print_line("wanted", wanted, line);
    }
    free(wanted);
    free(got);
    return line == 0;
}

/* --- running --- */

static double find_tolerance(const char *script)
{
    char *text = read_file(script);
    const char *at = text != NULL ? strstr(text, "# tolerance ") : NULL;
    double tolerance = at != NULL ? strtod(at + strlen("# tolerance "), NULL) : 1e-5;

    free(text);
    return tolerance;
}

/* run it with its streams in files; its exit status, or 1000 + the signal that ended it */
static int run(const char *script, bool is_shell)
{
    pid_t pid = fork();
    int status = 0;

    if (pid == 0) {
        alarm(PATIENCE);
        if (freopen("/dev/null", "r", stdin) == NULL || freopen("stdout", "w", stdout) == NULL ||
            freopen("stderr", "w", stderr) == NULL)
            _exit(126);
        if (is_shell)
            execlp("sh", "sh", script, (char *)NULL);
        else
            execlp("cotree", "cotree", script, (char *)NULL);
        _exit(127);
    }
    while (pid > 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR)
        continue;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/* where a case failed, all that was said helps */
static void print_stream(const char *stream)
{
    char *text = read_file(stream);

    if (text != NULL && *text != '\0')
        printf("--- %s\n%.4000s---\n", stream, text);
    free(text);
}

static void run_case(const char *directory, const char *file)
{
    char name[NAME_MAX + 1], home[PATH_MAX], folder[] = "/tmp/cotree-session-XXXXXX";
    bool is_shell = strcmp(strrchr(file, '.'), ".sh") == 0;

    snprintf(name, sizeof name, "%.*s", (int)(strrchr(file, '.') - file), file);
    if (getcwd(home, sizeof home) == NULL || mkdtemp(folder) == NULL || chdir(folder) != 0) {
        printf("%s: no place to run it: %s\n", name, strerror(errno));
        failed++;
        return;
    }
    copy_case(directory, name);

    char status_file[NAME_MAX + 10];

    snprintf(status_file, sizeof status_file, "%s.status", name);

    char *wanted = read_file(status_file);
    int wanted_status = wanted != NULL ? (int)strtol(wanted, NULL, 10) : 0;
    double tolerance = find_tolerance(file);
    int status = run(file, is_shell);
    bool good = status == wanted_status;

    free(wanted);
    if (status == SKIPPED) {
        char *why = read_file("stdout");

        printf("skipped %s: %.*s\n", name, (int)strcspn(why, "\n"), why);
        free(why);
        skipped++;
    } else {
        if (!good)
            printf("%s: exit status %d, wanted %d\n", name, status, wanted_status);
        good = check_stream(name, "stdout", "expected", tolerance) && good;
        good = check_stream(name, "stderr", "errors", tolerance) && good;
        if (!good) {
            print_stream("stdout");
            print_stream("stderr");
            printf("FAILED %s\n", name);
        }
        *(good ? &passed : &failed) += 1;
    }
    if (chdir(home) == 0)
        remove_folder(folder);
}

static int is_case(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');

    return dot != NULL && (strcmp(dot, ".ct") == 0 || strcmp(dot, ".sh") == 0);
}

static void run_directory(const char *directory)
{
    char path[PATH_MAX];
    struct dirent **entries;
    int count =
        realpath(directory, path) != NULL ? scandir(path, &entries, is_case, alphasort) : -1;

    if (count < 0) {
        printf("can't read %s\n", directory);
        failed++;
        return;
    }
    for (int i = 0; i < count; i++) {
        run_case(path, entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
}

/* The program is the one in the current folder, or $COTREE; nothing of the user's own comes in. */
static void set_environment(void)
{
    const char *program = getenv("COTREE");
    char here[PATH_MAX], *path;

    if (getcwd(here, sizeof here) == NULL)
        abort();
    if (program != NULL && strrchr(program, '/') != NULL)
        snprintf(here, sizeof here, "%.*s", (int)(strrchr(program, '/') - program), program);
    if (asprintf(&path, "%s:%s", here, getenv("PATH")) < 0)
        abort();
    setenv("PATH", path, 1);
    free(path);
    setenv("LC_ALL", "C.UTF-8", 1);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
}

int main(int argc, char **argv)
{
    const char *source = getenv("TOP_SRCDIR");
    char *path;

    set_environment();
    setvbuf(stdout, NULL, _IOLBF, 0);
    for (int i = 1; i < argc; i++)
        run_directory(argv[i]);
    if (argc == 1) {
        if (asprintf(&path, "%s/tests/session", source != NULL ? source : ".") < 0)
            abort();
        run_directory(path);
        free(path);
    }
    printf("%d passed, %d failed, %d skipped\n", passed, failed, skipped);
    return failed > 0 ? 1 : 0;
}

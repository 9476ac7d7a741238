/* autosave.c: unsaved statements, in a file that outlives the session */
#include "autosave.h"

#include "copy.h"
#include "file.h"
#include "out_of_memory.h"
#include "report_error.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const char FOLDER[] = "# in ";
static const char TITLE[] = "# typed in cotree and not saved\n";

typedef struct Written {
    int number; /* of the statement */
    off_t end;  /* of it in the file */
} Written;

struct Autosave {
    char *folder; /* of all such files */
    char *path;   /* of ours; NULL: there is none */
    int file;
    char *in; /* last folder written to the file; NULL */
    Written *written;
    int count, room;
    int first;     /* the first step in the file */
    int settled;   /* number of the last step that is saved; 0: none */
    time_t synced; /* when it was last seen to that the file is on the disk */
    bool failed;   /* it was reported that nothing can be stored */
};

enum { SYNC_EVERY = 1 }; /* s: a pasted block doesn't wait for the disk at each of its lines */

/* --- writing --- */

static void forget(Autosave *unsaved)
{
    if (unsaved->path == NULL)
        return;
    unlink(unsaved->path);
    close(unsaved->file);
    free(unsaved->path);
    free(unsaved->in);
    unsaved->path = NULL;
    unsaved->in = NULL;
    unsaved->count = 0;
    out_of_memory_note(false);
}

static void fail(Autosave *unsaved)
{
    if (!unsaved->failed)
        remark("what is typed can't be kept in '%s': %s", unsaved->folder, strerror(errno));
    unsaved->failed = true;
    forget(unsaved);
}

static bool put(Autosave *unsaved, const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t put = write(unsaved->file, text, length);

        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        text += put;
        length -= (size_t)put;
    }
    return true;
}

/* a file that no other session has, by the second and the process */
static bool make_file(Autosave *unsaved)
{
    char second[32];
    const time_t now = time(NULL);
    struct tm parts;

    strftime(second, sizeof second, "%Y%m%d-%H%M%S", localtime_r(&now, &parts));
    for (int i = 0; i < 100; i++) {
        char *path = copy_format("%s/%s-%d-%d.ct", unsaved->folder, second, (int)getpid(), i);

        unsaved->file = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (unsaved->file >= 0 && flock(unsaved->file, LOCK_EX | LOCK_NB) == 0) {
            unsaved->path = path;
            out_of_memory_note(true);
            return put(unsaved, TITLE, strlen(TITLE));
        }
        free(path);

        /* a session that looks for leftovers may have been quicker */
        if (unsaved->file >= 0)
            close(unsaved->file);
        else if (errno != EEXIST)
            break;
    }
    return false;
}

/* new: where a script's names of files are meant from */
static char *folder_of(const char *script)
{
    const char *slash = script != NULL ? strrchr(script, '/') : NULL;
    char *name = slash == NULL ? copy_text(".") : copy_piece(script, (size_t)(slash - script) + 1);
    char *real = realpath(name, NULL);

    free(name);
    return real != NULL ? real : copy_text("/");
}

/* write the folder if it has changed */
static bool write_folder(Autosave *unsaved, const char *script)
{
    char *folder = folder_of(script);

    if (unsaved->in != NULL && strcmp(unsaved->in, folder) == 0) {
        free(folder);
        return true;
    }

    char *line = copy_format("%s%s\n", FOLDER, folder);
    const bool good = put(unsaved, line, strlen(line));

    free(line);
    free(unsaved->in);
    unsaved->in = folder;
    return good;
}

static bool write_step(Autosave *unsaved, const char *text, int number)
{
    char *line = copy_format("%s\n", text);
    const bool good = put(unsaved, line, strlen(line));

    free(line);
    if (unsaved->count == unsaved->room) {
        unsaved->room = 2 * unsaved->room + 64;
        unsaved->written = check_allocated(
            realloc(unsaved->written, (size_t)unsaved->room * sizeof *unsaved->written));
    }
    unsaved->written[unsaved->count++] = (Written){number, lseek(unsaved->file, 0, SEEK_CUR)};
    return good;
}

/* Written data survives the session; syncing to disk makes it survive a crash of the machine
 * too. */
static void sync_file(Autosave *unsaved, bool now)
{
    const time_t second = time(NULL);

    if (unsaved->path == NULL || (!now && second - unsaved->synced < SYNC_EVERY))
        return;
    (void)fdatasync(unsaved->file); /* what is written is there in any case */
    unsaved->synced = second;
}

/* --- following --- */

static int number_of(const ct_session *session, int step)
{
    int number = 0;

    (void)ct_step(session, step, &number);
    return number;
}

/* no unsaved statements: no model, or the saved one */
static bool is_settled(const Autosave *unsaved, const ct_session *session)
{
    const int count = ct_step_count(session);

    return count == 0 || ct_step_clears(session, count - 1) ||
           number_of(session, count - 1) == unsaved->settled;
}

/* Truncate undone statements; the rest of the file is a prefix of the model's statements. */
static bool cut(Autosave *unsaved, const ct_session *session)
{
    const int steps = ct_step_count(session);
    int count = unsaved->count;

    while (count > 0 &&
           (unsaved->first + count > steps ||
            unsaved->written[count - 1].number != number_of(session, unsaved->first + count - 1)))
        count--;
    if (count == unsaved->count)
        return true;
    if (count == 0) {
        forget(unsaved);
        return true;
    }
    unsaved->count = count;
    free(unsaved->in);
    unsaved->in = NULL; /* its line may be removed too */
    return ftruncate(unsaved->file, unsaved->written[count - 1].end) == 0 &&
           lseek(unsaved->file, 0, SEEK_END) >= 0;
}

static bool begin(Autosave *unsaved, const ct_session *session)
{
    unsaved->first = ct_step_count(session);
    while (unsaved->first > 0 && !ct_step_clears(session, unsaved->first - 1))
        unsaved->first--;
    return make_file(unsaved);
}

void autosave_follow(Autosave *unsaved, const ct_session *session, const char *script)
{
    if (unsaved == NULL || unsaved->failed)
        return;
    if (is_settled(unsaved, session)) {
        forget(unsaved);
        return;
    }

    bool good = unsaved->path == NULL || cut(unsaved, session);

    if (good && unsaved->path == NULL)
        good = begin(unsaved, session);
    if (good && unsaved->first + unsaved->count < ct_step_count(session))
        good = write_folder(unsaved, script);
    while (good && unsaved->first + unsaved->count < ct_step_count(session)) {
        int number;
        const char *text = ct_step(session, unsaved->first + unsaved->count, &number);

        good = write_step(unsaved, text, number);
    }
    if (!good)
        fail(unsaved);
    sync_file(unsaved, false);
}

void autosave_settle(Autosave *unsaved, const ct_session *session)
{
    if (unsaved == NULL)
        return;

    const int count = ct_step_count(session);

    unsaved->settled = count > 0 ? number_of(session, count - 1) : 0;
    forget(unsaved);
}

bool autosave_is_kept(const Autosave *unsaved)
{
    return unsaved != NULL && unsaved->path != NULL;
}

/* new: the folder of such files; NULL: there is no home */
static char *find_folder(bool make)
{
    char *probe = file_in_home("XDG_STATE_HOME", ".local/state", "unsaved/x", make);

    if (probe != NULL)
        *strrchr(probe, '/') = '\0';
    return probe;
}

Autosave *autosave_open(const ct_session *session)
{
    char *folder = file_is_confined() ? NULL : find_folder(true);

    if (folder == NULL)
        return NULL;

    Autosave *unsaved = check_allocated(calloc(1, sizeof *unsaved));

    unsaved->folder = folder;
    autosave_settle(unsaved, session);
    return unsaved;
}

void autosave_close(Autosave *unsaved)
{
    if (unsaved == NULL)
        return;
    sync_file(unsaved, true);
    if (unsaved->path != NULL)
        close(unsaved->file);
    out_of_memory_note(false);
    free(unsaved->path);
    free(unsaved->in);
    free(unsaved->folder);
    free(unsaved->written);
    free(unsaved);
}

/* --- files of ended sessions --- */

static int count_statements(int file)
{
    FILE *in = fdopen(dup(file), "r");
    int count = 0;
    bool starts = true, counts = false;
    int c;

    if (in == NULL)
        return 0;
    while ((c = getc(in)) != EOF) {
        if (starts)
            counts = c != '#';
        starts = c == '\n';
        count += starts && counts;
    }
    fclose(in);
    return count;
}

/* Whether no session locks the file; then we have locked it. */
static bool take(const char *folder, const char *name, Leftover *leftover)
{
    struct stat info;
    struct tm parts;
    const size_t length = strlen(name);

    if (length < 4 || strcmp(name + length - 3, ".ct") != 0)
        return false;
    *leftover = (Leftover){.path = copy_format("%s/%s", folder, name)};
    leftover->file = open(leftover->path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (leftover->file >= 0 && flock(leftover->file, LOCK_EX | LOCK_NB) == 0 &&
        fstat(leftover->file, &info) == 0 && S_ISREG(info.st_mode) && info.st_nlink > 0) {
        leftover->written = info.st_mtim;
        strftime(leftover->when, sizeof leftover->when, "%Y-%m-%d %H:%M",
                 localtime_r(&info.st_mtime, &parts));
        leftover->statements = count_statements(leftover->file);
        return true;
    }
    autosave_drop(leftover, false);
    return false;
}

static int newest_first(const void *a, const void *b)
{
    const struct timespec *x = &((const Leftover *)a)->written,
                          *y = &((const Leftover *)b)->written;

    if (x->tv_sec != y->tv_sec)
        return x->tv_sec < y->tv_sec ? 1 : -1;
    return (x->tv_nsec < y->tv_nsec) - (x->tv_nsec > y->tv_nsec);
}

Leftover *autosave_find(int *count)
{
    char *folder = file_is_confined() ? NULL : find_folder(false);
    struct dirent **entries = NULL;
    const int found = folder != NULL ? scandir(folder, &entries, NULL, alphasort) : 0;
    Leftover *all = check_allocated(calloc((size_t)(found > 0 ? found : 0) + 1, sizeof *all));

    *count = 0;
    for (int i = 0; entries != NULL && i < found; i++) {
        if (take(folder, entries[i]->d_name, &all[*count])) {
            if (all[*count].statements > 0)
                (*count)++;
            else
                autosave_drop(&all[*count], true);
        }
        free(entries[i]);
    }
    free(entries);
    free(folder);
    qsort(all, (size_t)*count, sizeof *all, newest_first);
    return all;
}

void autosave_drop(Leftover *leftover, bool remove)
{
    if (leftover->path == NULL)
        return;
    if (remove)
        unlink(leftover->path);
    if (leftover->file >= 0)
        close(leftover->file);
    free(leftover->path);
    *leftover = (Leftover){.path = NULL};
}

void autosave_drop_all(Leftover *leftovers, int count, bool remove)
{
    for (int i = 0; i < count; i++)
        autosave_drop(&leftovers[i], remove);
    free(leftovers);
}

const char *autosave_folder(const char *line)
{
    return strncmp(line, FOLDER, strlen(FOLDER)) == 0 ? line + strlen(FOLDER) : NULL;
}

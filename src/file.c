/* file.c: whole files, written at once or not at all; names of files */
#include "file.h"

#include "copy.h"
#include "report_error.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static ct_status say(ct_error *error, const char *what, const char *path)
{
    error_set(error, "can't %s '%s': %s", what, path, strerror(errno));
    return CT_FAILED;
}

/* --- what may be read and written --- */

static struct {
    bool on;
    char *folder; /* without links; NULL: it is not there */
} confined;

void file_confine(const char *script)
{
    const char *slash = script != NULL ? strrchr(script, '/') : NULL;
    char *folder = slash == NULL     ? copy_text(".")
                   : slash == script ? copy_text("/")
                                     : copy_piece(script, (size_t)(slash - script));

    free(confined.folder);
    confined.on = true;
    confined.folder = realpath(folder, NULL);
    free(folder);
}

bool file_is_confined(void)
{
    return confined.on;
}

/* whether a path without links leads to something below the folder */
static bool is_below(const char *path, const char *folder)
{
    const size_t length = strlen(folder);

    return strcmp(folder, "/") == 0 || (strncmp(path, folder, length) == 0 && path[length] == '/');
}

ct_status file_may_read(const char *path, ct_error *error)
{
    if (!confined.on)
        return CT_OK;

    char *real = realpath(path, NULL);
    ct_status status = CT_OK;

    if (real == NULL) {
        status = say(error, "read", path);
    } else if (confined.folder == NULL || !is_below(real, confined.folder)) {
        status =
            error_set(error, "'%s' may not be read: it lies outside the script's folder", path);
        error_hint(error, "--safe keeps to that folder");
    }
    free(real);
    return status;
}

ct_status file_may_write(const char *path, ct_error *error)
{
    if (!confined.on)
        return CT_OK;
    error_set(error, "'%s' is not written: this is a --safe session", path);
    return CT_FAILED;
}

/* --- whole files --- */

static bool is_replaceable(const char *path)
{
    struct stat info;

    return stat(path, &info) != 0 || S_ISREG(info.st_mode);
}

ct_status file_place(const char *path, char **place, ct_error *error)
{
    if (file_may_write(path, error) != CT_OK)
        return CT_FAILED;
    if (!is_replaceable(path)) {
        *place = copy_text(path);
        return CT_OK;
    }

    /* the file that a link leads to is the one to replace */
    char *real = realpath(path, NULL);
    char *name = copy_format("%s.XXXXXX", real != NULL ? real : path);

    free(real);

    int file = mkstemp(name);

    if (file < 0) {
        free(name);
        return say(error, "write", path);
    }

    /* as a new file would be made, or as the old one was */
    struct stat old;
    mode_t mask = umask(0);

    umask(mask);
    if (fchmod(file, stat(path, &old) == 0 ? old.st_mode & 0777 : 0666 & ~mask) != 0) {
        /* it remains private: the right file all the same */
    }
    close(file);
    *place = name;
    return CT_OK;
}

/* The new file is synced to disk before it replaces the old one: otherwise a crash of the machine
 * may lose both. */
static bool reach_disk(const char *place)
{
    const int file = open(place, O_RDONLY | O_CLOEXEC);
    const bool reached = file >= 0 && (fsync(file) == 0 || errno == EINVAL || errno == EROFS);
    const int why = errno;

    if (file >= 0)
        close(file);
    errno = why;
    return reached;
}

ct_status file_settle(const char *place, const char *path, bool keep, ct_error *error)
{
    if (strcmp(place, path) == 0)
        return CT_OK;
    if (!keep) {
        unlink(place);
        return CT_OK;
    }

    char *real = realpath(path, NULL);
    int failed = reach_disk(place) ? rename(place, real != NULL ? real : path) : -1;

    free(real);
    if (failed != 0) {
        ct_status status = say(error, "write", path);

        unlink(place);
        return status;
    }
    return CT_OK;
}

static ct_status write_all(const char *place, const char *mode, const char *path, const char *text,
                           size_t length, ct_error *error)
{
    FILE *file = fopen(place, mode);

    if (file == NULL)
        return say(error, "write", path);

    /* a full disk may be reported only when the last piece is written */
    bool good = fwrite(text, 1, length, file) == length && fflush(file) == 0;
    ct_status status = good ? CT_OK : say(error, "write", path);

    if (fclose(file) != 0 && good)
        status = say(error, "write", path);
    return status;
}

ct_status file_write(const char *path, const char *text, size_t length, bool append,
                     ct_error *error)
{
    char *place = NULL;

    if (file_may_write(path, error) != CT_OK)
        return CT_FAILED;
    if (append)
        return write_all(path, "ae", path, text, length, error);

    ct_status status = file_place(path, &place, error);

    if (status != CT_OK)
        return status;
    status = write_all(place, "we", path, text, length, error);
    if (status != CT_OK)
        file_settle(place, path, false, NULL);
    else
        status = file_settle(place, path, true, error);
    free(place);
    return status;
}

ct_status file_read(const char *path, char **text, ct_error *error)
{
    FILE *file = fopen(path, "re");
    size_t length = 0, room = 0, got = 1;
    char *at = NULL;

    if (file == NULL)
        return say(error, "read", path);
    while (got > 0) {
        if (room - length < BUFSIZ)
            at = check_allocated(realloc(at, (room = 2 * room + BUFSIZ) + 1));
        got = fread(at + length, 1, room - length, file);
        length += got;
    }
    at[length] = '\0';
    *text = at;

    ct_status status = ferror(file) ? say(error, "read", path) : CT_OK;

    fclose(file);
    return status;
}

bool file_has_content(const char *path)
{
    struct stat info;

    return stat(path, &info) == 0 && info.st_size > 0;
}

char *file_first_line(const char *path)
{
    FILE *file = fopen(path, "re");
    char *line = NULL;
    size_t room = 0;

    if (file == NULL)
        return NULL;
    if (getline(&line, &room, file) < 0) {
        free(line);
        line = copy_text("");
    }
    fclose(file);
    line[strcspn(line, "\r\n")] = '\0';
    return line;
}

char *file_next_to(const char *from, const char *name)
{
    const char *slash = from != NULL ? strrchr(from, '/') : NULL;

    if (slash == NULL || name[0] == '/')
        return copy_text(name);

    char *path = copy_format("%.*s/%s", (int)(slash - from), from, name);

    if (access(path, F_OK) != 0) {
        free(path);
        return copy_text(name);
    }
    return path;
}

const char *file_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');

    return dot != NULL ? dot + 1 : "";
}

static void make_folders(char *path)
{
    for (char *slash = strchr(path + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0700);
        *slash = '/';
    }
}

char *file_in_home(const char *variable, const char *home, const char *name, bool make_folder)
{
    const char *base = getenv(variable), *user = getenv("HOME");
    char *path = NULL;

    /* the XDG rules: a relative folder counts as none */
    if (base != NULL && base[0] == '/')
        path = copy_format("%s/cotree/%s", base, name);
    else if (user != NULL && user[0] == '/')
        path = copy_format("%s/%s/cotree/%s", user, home, name);
    if (path != NULL && make_folder)
        make_folders(path);
    return path;
}

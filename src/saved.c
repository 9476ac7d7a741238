/* saved.c: files that `save` writes, and knows again */
#include "saved.h"

#include "copy.h"
#include "file.h"
#include "report_error.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char HEAD[] = "# saved by cotree, unedited: ";
enum { NUMBER = 16, LONGEST = 120 }; /* hexadecimal digits of the checksum; length of such a line */

typedef struct Kind {           /* of files that are ours */
    const char *verb, *operand; /* that writes them, and its operand before the file */
    const char *head;           /* the first line, up to its number */
    size_t length;
} Kind;

/* FNV-1a (Fowler, Noll, Vo) */
static uint64_t hash(uint64_t from, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        from = (from ^ (unsigned char)text[i]) * UINT64_C(1099511628211);
    return from;
}

static const uint64_t EMPTY = UINT64_C(14695981039346656037); /* hash of no text */

/* whether the file starts with our line, with the right checksum of the rest */
static bool is_ours(FILE *file, const Kind *kind)
{
    char line[LONGEST] = "", wanted[NUMBER + 2], piece[4096];
    uint64_t number = EMPTY;
    size_t got;

    if (fgets(line, sizeof line, file) == NULL || strncmp(line, kind->head, kind->length) != 0)
        return false;
    while ((got = fread(piece, 1, sizeof piece, file)) > 0)
        number = hash(number, piece, got);
    (void)snprintf(wanted, sizeof wanted, "%0*" PRIx64 "\n", NUMBER, number);
    return strcmp(line + kind->length, wanted) == 0;
}

static ct_status check_replaceable(const char *path, const Kind *kind, ct_error *error)
{
    struct stat info;

    /* pipes and devices are written to, not replaced */
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0)
        return CT_OK;

    FILE *file = fopen(path, "re");

    if (file == NULL)
        return error_set(error, "can't see what '%s' holds: %s", path, strerror(errno));

    const bool ours = is_ours(file, kind);

    fclose(file);
    if (ours)
        return CT_OK;
    error_set(error, "'%s' is there, and is not as '%s' wrote it", path, kind->verb);
    error_hint(error, "%s%s \"%s\" overwrite=on replaces it", kind->verb, kind->operand, path);
    return CT_FAILED;
}

static ct_status write_whole(const char *path, const char *text, const Kind *kind, bool overwrite,
                             ct_error *error)
{
    ct_status status = file_may_write(path, error);

    if (status == CT_OK && !overwrite)
        status = check_replaceable(path, kind, error);
    return status == CT_OK ? file_write(path, text, strlen(text), false, error) : status;
}

ct_status saved_write(const char *path, const char *script, bool overwrite, ct_error *error)
{
    const Kind kind = {"save", "", HEAD, strlen(HEAD)};
    char *text = copy_format("%s%0*" PRIx64 "\n%s", HEAD, NUMBER,
                             hash(EMPTY, script, strlen(script)), script);
    const ct_status status = write_whole(path, text, &kind, overwrite, error);

    free(text);
    return status;
}

ct_status stored_write(const char *path, const char *text, bool overwrite, ct_error *error)
{
    const Kind kind = {"store", " NAME", text, strcspn(text, "\n") - NUMBER};

    return write_whole(path, text, &kind, overwrite, error);
}

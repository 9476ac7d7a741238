/* saved.c: files that `save` writes, and knows again */
#include "saved.h"

#include "complain.h"
#include "copy.h"
#include "file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char HEAD[] = "# saved by cotree, unedited: ";
enum { NUMBER = 16 }; /* hexadecimal digits behind it */

/* FNV-1a (Fowler, Noll, Vo) */
static uint64_t hash(uint64_t from, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        from = (from ^ (unsigned char)text[i]) * UINT64_C(1099511628211);
    return from;
}

static const uint64_t EMPTY = UINT64_C(14695981039346656037); /* hash of no text */

/* whether the file begins with our line, and its number is that of what follows */
static bool is_ours(FILE *file)
{
    char line[sizeof HEAD + NUMBER + 1] = "", wanted[NUMBER + 2], piece[4096];
    uint64_t number = EMPTY;
    size_t got;

    if (fgets(line, sizeof line, file) == NULL || strncmp(line, HEAD, strlen(HEAD)) != 0)
        return false;
    while ((got = fread(piece, 1, sizeof piece, file)) > 0)
        number = hash(number, piece, got);
    (void)snprintf(wanted, sizeof wanted, "%0*" PRIx64 "\n", NUMBER, number);
    return strcmp(line + strlen(HEAD), wanted) == 0;
}

static ct_status check_replaceable(const char *path, ct_error *error)
{
    struct stat info;

    /* pipes and devices are written to, not replaced */
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0)
        return CT_OK;

    FILE *file = fopen(path, "re");

    if (file == NULL)
        return error_say(error, "can't see what '%s' holds: %s", path, strerror(errno));

    const bool ours = is_ours(file);

    fclose(file);
    if (ours)
        return CT_OK;
    error_say(error, "'%s' is there, and is not as 'save' wrote it", path);
    error_hint(error, "save \"%s\" overwrite=on replaces it", path);
    return CT_FAILED;
}

ct_status saved_write(const char *path, const char *script, bool overwrite, ct_error *error)
{
    ct_status status = file_may_write(path, error);

    if (status == CT_OK && !overwrite)
        status = check_replaceable(path, error);
    if (status != CT_OK)
        return status;

    char *text = copy_format("%s%0*" PRIx64 "\n%s", HEAD, NUMBER,
                             hash(EMPTY, script, strlen(script)), script);

    status = file_write(path, text, strlen(text), false, error);
    free(text);
    return status;
}

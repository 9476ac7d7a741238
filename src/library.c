/* library.c: the binary of an exported archive: its sources go to a folder of their own, and the
 * compiler of $CC, or cc, makes one of them */
#include "library.h"

#include "copy.h"
#include "file.h"
#include "process.h"
#include "report_error.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SOURCES = 24, PATIENCE = 100 }; /* ms */

typedef struct LibraryBuilder {
    char *folder;
    char *paths[SOURCES]; /* of files in it */
    int count;
} LibraryBuilder;

static ct_status write_file(const char *path, const char *bytes, size_t length, ct_error *error)
{
    FILE *file = fopen(path, "wb");
    bool is_written = file != NULL && fwrite(bytes, 1, length, file) == length;

    if (file != NULL)
        is_written = fclose(file) == 0 && is_written;
    return is_written ? CT_OK : error_set(error, "can't write '%s': %s", path, strerror(errno));
}

static ct_status write_sources(LibraryBuilder *making, const ct_archive *archive, ct_error *error)
{
    static const char below[] = "sources/";
    const char *name, *bytes;
    size_t length;
    ct_status status = CT_OK;

    for (int i = 0; status == CT_OK && making->count < SOURCES &&
                    ct_archive_file(archive, i, &name, &bytes, &length);
         i++) {
        if (strncmp(name, below, strlen(below)) != 0)
            continue;
        making->paths[making->count] = copy_format("%s/%s", making->folder, name + strlen(below));
        status = write_file(making->paths[making->count++], bytes, length, error);
    }
    return status;
}

/* CT_OK with *made false: there is no compiler */
static ct_status compile(const LibraryBuilder *making, char *target, bool *made, ct_error *error)
{
    static const char *const options[] = {"-std=c99",          "-O2",     "-fPIC",
                                          "-ffp-contract=off", "-shared", "-fvisibility=hidden"};
    const char *asked = getenv("CC"), *compiler = asked != NULL && *asked != '\0' ? asked : "cc";
    char *argv[SOURCES + 16];
    char ending[40];
    int count = 0;
    Process process = {0};
    OutputBuffer out, err;
    ct_error unused;
    ct_status status;

    argv[count++] = copy_text(compiler);
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        argv[count++] = copy_text(options[i]);
    for (int i = 0; i < making->count; i++)
        if (strcmp(file_extension(making->paths[i]), "c") == 0)
            argv[count++] = copy_text(making->paths[i]);
    argv[count++] = copy_text("-lm");
    argv[count++] = copy_text("-o");
    argv[count++] = copy_text(target);
    argv[count] = NULL;
    *made = process_start(&process, argv, &unused) == CT_OK;
    status = CT_OK;
    if (*made) {
        output_buffer_open(&out);
        output_buffer_open(&err);
        status = process_exchange(&process, "", 0, NULL, &out, &err, error);
        process_end(&process, PATIENCE);
        free(output_buffer_close(&out));
        char *said = output_buffer_close(&err);

        if (status == CT_OK && process.ended != 0)
            status = error_set(error, "the compiler '%s' failed (%s): %.200s", compiler,
                               process_ending(process.ended, ending), said);
        free(said);
    }
    for (int i = 0; i < count; i++)
        free(argv[i]);
    return status;
}

static ct_status read_file(const char *path, char **bytes, size_t *length, ct_error *error)
{
    FILE *file = fopen(path, "rb");
    struct stat about = {0};
    ct_status status = CT_OK;

    if (file == NULL || fstat(fileno(file), &about) != 0)
        status = error_set(error, "can't read '%s': %s", path, strerror(errno));
    if (status == CT_OK) {
        *length = (size_t)about.st_size;
        *bytes = check_allocated(malloc(*length + 1));
        if (fread(*bytes, 1, *length, file) != *length)
            status = error_set(error, "can't read '%s'", path);
    }
    if (file != NULL)
        fclose(file);
    return status;
}

ct_status library_of(const ct_archive *archive, char **bytes, size_t *length, ct_error *error)
{
    const char *folder = getenv("TMPDIR");
    LibraryBuilder making = {.folder =
                                 copy_format("%s/cotree-XXXXXX", folder != NULL ? folder : "/tmp")};
    char *target = NULL;
    bool made = false;
    ct_status status = CT_OK;

    if (ct_archive_binary(archive) == NULL) {
        fputs("the file holds sources alone: the format has no name for this machine\n", stderr);
        goto done;
    }
    if (mkdtemp(making.folder) == NULL) {
        status = error_set(error, "can't make '%s': %s", making.folder, strerror(errno));
        goto done;
    }
    target = copy_format("%s/library.so", making.folder);
    status = write_sources(&making, archive, error);
    if (status == CT_OK)
        status = compile(&making, target, &made, error);
    if (status == CT_OK && made)
        status = read_file(target, bytes, length, error);
    if (status == CT_OK && !made)
        fputs("the file holds sources alone: there is no C compiler here ('cc', or $CC)\n", stderr);
    for (int i = 0; i < making.count; i++)
        unlink(making.paths[i]);
    unlink(target);
    rmdir(making.folder);
done:
    for (int i = 0; i < making.count; i++)
        free(making.paths[i]);
    free(target);
    free(making.folder);
    return status;
}

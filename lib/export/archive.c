/* archive.c: a zip, by libzip, in memory */
#include "export/archive.h"

#include "base/transaction.h"

#include <string.h>
#include <zip.h>

#define EARLIEST                                                                                   \
    315532800 /* 1980-01-01, where the time of zips begins: the same bytes each day                \
               */

void archive_free(Archive *archive)
{
    if (archive == NULL)
        return;
    for (int i = 0; i < archive->files.count; i++)
        MEM_FREE(archive->files.at[i].name, archive->files.at[i].bytes);
    LIST_FREE(archive->files);
    mem_free(archive);
}

/* NOLINTNEXTLINE(readability-non-const-parameter): it is the archive's from now on */
void archive_add(Archive *archive, const char *name, char *bytes, size_t length)
{
    LIST_PUSH(archive->files, ((ArchiveFile){mem_text(name, strlen(name)), bytes, length}));
}

/* what libzip owns */
typedef struct Zip {
    Cleanup cleanup;
    zip_source_t *place;
    zip_t *zip; /* NULL: closed */
} Zip;

static void pack_end(void *object)
{
    Zip *z = object;

    if (z->zip != NULL)
        zip_discard(z->zip);
    zip_source_free(z->place); /* NULL is fine */
    cleanup_close(&z->cleanup);
}

static bool pack_begin(Zip *z)
{
    zip_error_t error;

    cleanup_open(&z->cleanup, pack_end, z);
    zip_error_init(&error);
    z->place = zip_source_buffer_create(NULL, 0, 0, &error);
    z->zip = z->place != NULL ? zip_open_from_source(z->place, ZIP_TRUNCATE, &error) : NULL;
    if (z->zip != NULL)
        zip_source_keep(z->place);
    zip_error_fini(&error);
    return z->zip != NULL;
}

static bool pack_add(Zip *z, const char *name, const char *bytes, size_t length)
{
    zip_source_t *source = zip_source_buffer(z->zip, bytes, length, 0);
    zip_int64_t place;

    if (source == NULL)
        return false;
    place = zip_file_add(z->zip, name, source, ZIP_FL_ENC_UTF_8);
    if (place < 0) {
        zip_source_free(source);
        return false;
    }
    return zip_file_set_mtime(z->zip, (zip_uint64_t)place, EARLIEST, 0) == 0;
}

static bool pack_read(const Zip *z, char **bytes, size_t *length)
{
    zip_stat_t stat;
    bool whole;

    zip_stat_init(&stat);
    if (zip_source_open(z->place) != 0)
        return false;
    whole = zip_source_stat(z->place, &stat) == 0;
    *length = whole ? (size_t)stat.size : 0;
    *bytes = mem_new(*length + 1);
    whole = whole && zip_source_read(z->place, *bytes, *length) == (zip_int64_t)*length;
    return zip_source_close(z->place) == 0 && whole;
}

Status archive_pack(const Archive *archive, const char *binary, size_t binary_length, char **bytes,
                    size_t *length, Diag *diag)
{
    Zip z = {.zip = NULL};
    bool whole;

    if (archive->is_plain) {
        *length = archive->files.at[0].length;
        *bytes = mem_text(archive->files.at[0].bytes, *length);
        return OK;
    }
    whole = pack_begin(&z);

    *bytes = NULL;
    for (int i = 0; whole && i < archive->files.count; i++)
        whole = pack_add(&z, archive->files.at[i].name, archive->files.at[i].bytes,
                         archive->files.at[i].length);
    whole = whole && (binary == NULL || pack_add(&z, archive->binary, binary, binary_length)) &&
            zip_close(z.zip) == 0;
    if (whole)
        z.zip = NULL;
    whole = whole && pack_read(&z, bytes, length);
    pack_end(&z);
    if (whole)
        return OK;
    mem_free(*bytes);
    *bytes = NULL;
    return diag_set(diag, E_MEMORY, "the files can't be packed");
}

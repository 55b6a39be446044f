/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The archive of .npz: a zip, read with libzip. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>
#include <zlib.h>

struct NpzArchive {
    zip_t *zip;
    char *path;
};

/* Deflate cannot exceed this ratio, so a member that claims more is invalid. */
enum { DEFLATE_BEST_RATIO = 1032 };

/* libzip reports a lack of memory in three ways: by a code of its own, as zlib's, and, where it counts as damage of the
   directory or as no error at all, only by errno. */
static int system_cause(const zip_error_t *cause) {
    const int code = zip_error_code_zip(cause), below = zip_error_code_system(cause), left = errno;
    const int type = zip_error_system_type(cause);
    if (code == ZIP_ER_MEMORY || (type == ZIP_ET_ZLIB && below == Z_MEM_ERROR)) return ENOMEM;
    if (type == ZIP_ET_SYS && below != 0) return below;
    return cause_is_system(left) ? left : 0;
}

/* Sets the error for a failure of libzip at this array, and returns false. */
static bool refuse_damaged(const NpzArchive *archive, const char *name, zip_error_t *cause, Error *error) {
    const int system = system_cause(cause);
    if (system != 0) return cause_error(system, archive->path, error);
    return error_input(error, archive->path, "array '%s' is damaged: %s", name, zip_error_strerror(cause));
}

/* Before any data is inflated, the file and its directory are checked. libzip reads every directory that the last 64
   KiB point to, with all entries; a malicious file costs it minutes and gigabytes (tests/base/test_npz_hostile.c). */

/* The end record (its size, and the longest comment that may follow it), and the locator before it in a zip64. */
enum { END_SIZE = 22, COMMENT_MAX = 65535, LOCATOR_SIZE = 20, TAIL_MAX = LOCATOR_SIZE + END_SIZE + COMMENT_MAX };

/* Twice the size of 256 entries with names of 64 bytes. */
enum { DIRECTORY_MAX = 65536 };

/* Compressed data looks like an end record once in 65,000 files; more of them are an attack. */
enum { ENDS_MAX = 3 };

static uint32_t little_endian(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool check_tail(const unsigned char *tail, size_t length, uint64_t size, const char *path, Error *error) {
    int ends = 0;
    for (size_t i = 0; i + END_SIZE <= length; i++) {
        if (memcmp(tail + i, "PK\5\6", 4) != 0) continue;
        uint64_t directory = little_endian(tail + i + 12), position = size - length + i;
        bool zip64 = i >= LOCATOR_SIZE && memcmp(tail + i - LOCATOR_SIZE, "PK\6\7", 4) == 0;
        /* libzip refuses a directory that begins before the file. */
        if (zip64 || (directory > DIRECTORY_MAX && directory <= position) || ++ends > ENDS_MAX)
            return error_input(error, path, "not .npz: its directory is too large");
    }
    return ends > 0 || error_input(error, path, "not .npz, or cut off");
}

/* Whether the open file ends with the directory of one small zip. */
static bool check_directory(int descriptor, uint64_t size, const char *path, Error *error) {
    size_t length = size < TAIL_MAX ? (size_t)size : TAIL_MAX, used = 0;
    unsigned char *tail = malloc(TAIL_MAX);
    if (tail == NULL) return error_memory(error, path);
    bool done = true;
    while (done && used < length) {
        ssize_t got = pread(descriptor, tail + used, length - used, (off_t)(size - length + used));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) done = error_system(error, path, "cannot read: %s", strerror(errno));
        if (got == 0) done = error_input(error, path, "not .npz, or cut off");
        if (got > 0) used += (size_t)got;
    }
    done = done && check_tail(tail, length, size, path, error);
    free(tail);
    return done;
}

/* Opens the file and checks that it is safe to pass to libzip. */
static int open_checked(const char *path, uint64_t *size, Error *error) {
    /* Without O_NONBLOCK, opening a FIFO waits for a writer. */
    int descriptor =
        path_is_standard(path) ? standard_input_open(error) : open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat status;
    if (descriptor < 0 && errno == ENOENT && file_elsewhere != NULL)
        descriptor = open(file_elsewhere(path), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) {
        file_open_error(path, error);
        return -1;
    }
    bool done;
    if (fstat(descriptor, &status) != 0)
        done = error_system(error, path, "cannot read: %s", strerror(errno));
    else if (!S_ISREG(status.st_mode))
        done = error_input(error, path, "not a regular file");
    else if ((uint64_t)status.st_size > NPZ_MAX_BYTES)
        done = error_input(error, path, "larger than 2 GiB");
    else {
        char start[64];
        ssize_t got;
        do got = pread(descriptor, start, sizeof start, 0);
        while (got < 0 && errno == EINTR);
        done = (got >= 0 || error_system(error, path, "cannot read: %s", strerror(errno))) &&
               lfs_pointer_refuse(start, (size_t)got, path, error) &&
               check_directory(descriptor, (uint64_t)status.st_size, path, error);
    }
    if (done) trace_line("read %s, %jd bytes", path, (intmax_t)status.st_size);
    *size = done ? (uint64_t)status.st_size : 0;
    if (done) return descriptor;
    close(descriptor);
    return -1;
}

static bool open_zip(NpzArchive *archive, uint64_t *size, Error *error) {
    int descriptor = open_checked(archive->path, size, error), code;
    if (descriptor < 0) return false;
    errno = 0;
    archive->zip = zip_fdopen(descriptor, 0, &code);
    if (archive->zip != NULL) return true;
    const int system = code == ZIP_ER_MEMORY ? ENOMEM : errno;
    zip_error_t reason;
    zip_error_init_with_code(&reason, code);
    if (cause_is_system(system))
        cause_error(system, archive->path, error);
    else
        error_input(error, archive->path, "not an intact .npz: %s", zip_error_strerror(&reason));
    zip_error_fini(&reason);
    close(descriptor);
    return false;
}

NpzArchive *npz_archive_open(const char *path, uint64_t *size, Error *error) {
    NpzArchive *archive = calloc(1, sizeof *archive);
    if (archive != NULL) archive->path = strdup(path);
    if (archive == NULL || archive->path == NULL)
        error_memory(error, path);
    else if (open_zip(archive, size, error))
        return archive;
    npz_archive_close(archive);
    return NULL;
}

void npz_archive_close(NpzArchive *archive) {
    if (archive == NULL) return;
    if (archive->zip != NULL) zip_discard(archive->zip);
    free(archive->path);
    free(archive);
}

int64_t npz_archive_count(const NpzArchive *archive) { return zip_get_num_entries(archive->zip, 0); }

const char *npz_archive_name(NpzArchive *archive, int64_t index, Error *error) {
    errno = 0;
    const char *name = zip_get_name(archive->zip, (zip_uint64_t)index, 0);
    if (name == NULL) refuse_damaged(archive, "?", zip_get_error(archive->zip), error);
    return name;
}

bool npz_archive_check(NpzArchive *archive, int64_t index, const char *array, uint64_t *size, Error *error) {
    zip_stat_t status;
    errno = 0;
    if (zip_stat_index(archive->zip, (zip_uint64_t)index, 0, &status) != 0)
        return refuse_damaged(archive, array, zip_get_error(archive->zip), error);
    if (status.encryption_method != ZIP_EM_NONE)
        return error_input(error, archive->path, "array '%s' is encrypted", array);
    if (status.comp_method != ZIP_CM_STORE && status.comp_method != ZIP_CM_DEFLATE)
        return error_input(error, archive->path, "array '%s' is neither stored nor deflated", array);
    if (status.size / DEFLATE_BEST_RATIO > status.comp_size)
        return error_input(error, archive->path, "array '%s' is damaged: it cannot hold %" PRIu64 " bytes", array,
                           (uint64_t)status.size);
    *size = status.size;
    return true;
}

/* NULL with error set. */
static zip_file_t *open_member(NpzArchive *archive, int64_t index, const char *array, Error *error) {
    errno = 0;
    zip_file_t *member = zip_fopen_index(archive->zip, (zip_uint64_t)index, 0);
    if (member == NULL) refuse_damaged(archive, array, zip_get_error(archive->zip), error);
    return member;
}

int64_t npz_archive_begin(NpzArchive *archive, int64_t index, const char *array, char *text, size_t size,
                          Error *error) {
    zip_file_t *member = open_member(archive, index, array, error);
    if (member == NULL) return -1;
    const zip_int64_t got = zip_fread(member, text, size);
    if (got < 0) refuse_damaged(archive, array, zip_file_get_error(member), error);
    zip_fclose(member);
    return got;
}

bool npz_archive_read(NpzArchive *archive, int64_t index, const char *array, size_t head, void *data, uint64_t size,
                      Error *error) {
    zip_file_t *member = open_member(archive, index, array, error);
    if (member == NULL) return false;
    /* To the end of the member: libzip compares the checksum only there. */
    char skipped[NPY_HEAD_MAX], more;
    const zip_int64_t before = zip_fread(member, skipped, head), got = before < 0 ? -1 : zip_fread(member, data, size),
                      after = got < 0 ? -1 : zip_fread(member, &more, 1);
    const bool done = (uint64_t)got == size && after == 0;
    if (after < 0)
        refuse_damaged(archive, array, zip_file_get_error(member), error);
    else if (!done)
        error_input(error, archive->path, "array '%s' is damaged: %s", array, after > 0 ? "too long" : "cut off");
    zip_fclose(member);
    return done;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Opening .npz: the file and its directory are checked before any data is inflated. */
#include "npz/npz_file.h"

#include "common/cause.h"
#include "common/file.h"
#include "common/lfs_pointer.h"
#include "common/standard_io.h"
#include "common/trace.h"
#include "npz/zip_directory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

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

bool npz_failed(const NpzFile *file, const char *name, zip_error_t *cause, Error *error) {
    const int system = system_cause(cause);
    if (system != 0) return cause_error(system, file->path, error);
    return error_input(error, file->path, "array '%s' is damaged: %s", name, zip_error_strerror(cause));
}

const StoredArray *npz_find(const NpzFile *file, const char *name) {
    for (zip_uint64_t i = 0; i < file->count; i++)
        if (strcmp(file->arrays[i].name, name) == 0) return &file->arrays[i];
    return NULL;
}

/* The member's name without ".npy". Only letters, digits, '_', '-' and '.', since messages print it on a terminal. */
static bool take_name(NpzFile *file, const char *member, char name[NPZ_NAME_SIZE], Error *error) {
    size_t length = strlen(member);
    bool plain = length > 4 && length - 4 < NPZ_NAME_SIZE;
    for (size_t i = 0; plain && i < length; i++) plain = isalnum((unsigned char)member[i]) || strchr("_-.", member[i]);
    if (!plain || strcmp(member + length - 4, ".npy") != 0)
        return error_input(error, file->path, "holds a member that is not a named .npy array");
    memcpy(name, member, length - 4);
    if (npz_find(file, name) != NULL) return error_input(error, file->path, "holds array '%s' twice", name);
    return true;
}

/* Before any data is inflated, the directory's entry of a member must agree with its header. */
static bool check_member(const NpzFile *file, const StoredArray *array, const zip_stat_t *status, Error *error) {
    if (status->encryption_method != ZIP_EM_NONE)
        return error_input(error, file->path, "array '%s' is encrypted", array->name);
    if (status->comp_method != ZIP_CM_STORE && status->comp_method != ZIP_CM_DEFLATE)
        return error_input(error, file->path, "array '%s' is neither stored nor deflated", array->name);
    if (status->size / DEFLATE_BEST_RATIO > status->comp_size)
        return error_input(error, file->path, "array '%s' is damaged: it cannot hold %" PRIu64 " bytes", array->name,
                           (uint64_t)status->size);
    return true;
}

static bool read_head(NpzFile *file, zip_uint64_t index, StoredArray *array, uint64_t declared, Error *error) {
    errno = 0;
    zip_file_t *member = zip_fopen_index(file->archive, index, 0);
    if (member == NULL) return npz_failed(file, array->name, zip_get_error(file->archive), error);
    char text[NPY_HEAD_MAX], reason[NPY_REASON_SIZE];
    zip_int64_t size = zip_fread(member, text, sizeof text);
    bool done;
    if (size < 0)
        done = npz_failed(file, array->name, zip_file_get_error(member), error);
    else if (!npy_parse_head(&array->head, text, (size_t)size, reason))
        done = error_input(error, file->path, "'%s' is %s", array->name, reason);
    else if (array->head.head_size + array->head.data_size != declared)
        done = error_input(error, file->path, "array '%s' is damaged: %" PRIu64 " bytes instead of %" PRIu64,
                           array->name, declared, array->head.head_size + array->head.data_size);
    else
        done = true;
    zip_fclose(member);
    return done;
}

static bool read_directory(NpzFile *file, Error *error) {
    zip_int64_t count = zip_get_num_entries(file->archive, 0);
    if (count < 1 || count > NPZ_MAX_ARRAYS)
        return error_input(error, file->path, "holds %" PRId64 " arrays; expected 1 to %d", (int64_t)count,
                           NPZ_MAX_ARRAYS);
    for (; file->count < (zip_uint64_t)count; file->count++) {
        StoredArray *array = &file->arrays[file->count];
        zip_stat_t status;
        errno = 0;
        if (zip_stat_index(file->archive, file->count, 0, &status) != 0)
            return npz_failed(file, "?", zip_get_error(file->archive), error);
        if (!take_name(file, status.name, array->name, error) || !check_member(file, array, &status, error) ||
            !read_head(file, file->count, array, status.size, error))
            return false;
    }
    return true;
}

uint64_t npz_budget(uint64_t size) {
    const uint64_t budget = NPZ_ALWAYS + NPZ_RATIO * size;
    return budget < NPZ_MAX_BYTES ? budget : NPZ_MAX_BYTES;
}

/* A bomb is refused here, whatever reads it. */
static bool check_budget(NpzFile *file, Error *error) {
    uint64_t total = 0;
    for (zip_uint64_t i = 0; i < file->count; i++) total += file->arrays[i].head.data_size;
    file->budget = npz_budget(file->size);
    if (total <= file->budget) return true;
    if (total > NPZ_MAX_BYTES) return error_input(error, file->path, "its arrays are larger than 2 GiB together");
    return error_input(error, file->path,
                       "its arrays take %" PRIu64 " bytes; expected at most %" PRIu64
                       " (%d MiB and %d times the size of the file); store them with less compression",
                       total, file->budget, (int)(NPZ_ALWAYS >> 20), (int)NPZ_RATIO);
}

static bool refuse_pointer(int descriptor, const char *path, Error *error) {
    char start[64];
    ssize_t size = -1;
    do size = pread(descriptor, start, sizeof start, 0);
    while (size < 0 && errno == EINTR);
    return size < 0 ? error_system(error, path, "cannot read: %s", strerror(errno))
                    : lfs_pointer_refuse(start, (size_t)size, path, error);
}

/* Opens the file and checks that it is safe to pass to libzip. */
static int open_checked(const char *path, uint64_t *size, Error *error) {
    /* Without O_NONBLOCK, opening a FIFO waits for a writer. */
    int descriptor =
        path_is_standard(path) ? standard_input_open(error) : open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat status;
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
    else
        done = refuse_pointer(descriptor, path, error) &&
               zip_directory_check(descriptor, (uint64_t)status.st_size, path, error);
    if (done) trace_line("read %s, %jd bytes", path, (intmax_t)status.st_size);
    *size = done ? (uint64_t)status.st_size : 0;
    if (done) return descriptor;
    close(descriptor);
    return -1;
}

static bool open_archive(NpzFile *file, Error *error) {
    int descriptor = open_checked(file->path, &file->size, error), code;
    if (descriptor < 0) return false;
    errno = 0;
    file->archive = zip_fdopen(descriptor, 0, &code);
    if (file->archive != NULL) return true;
    const int system = code == ZIP_ER_MEMORY ? ENOMEM : errno;
    zip_error_t reason;
    zip_error_init_with_code(&reason, code);
    if (cause_is_system(system))
        cause_error(system, file->path, error);
    else
        error_input(error, file->path, "not an intact .npz: %s", zip_error_strerror(&reason));
    zip_error_fini(&reason);
    close(descriptor);
    return false;
}

NpzFile *npz_open(const char *path, Error *error) {
    NpzFile *file = calloc(1, sizeof *file);
    if (file != NULL) file->path = strdup(path);
    if (file == NULL || file->path == NULL)
        error_memory(error, path);
    else if (open_archive(file, error) && read_directory(file, error) && check_budget(file, error))
        return file;
    npz_close(file);
    return NULL;
}

void npz_close(NpzFile *file) {
    if (file == NULL) return;
    if (file->archive != NULL) zip_discard(file->archive);
    free(file->path);
    free(file);
}

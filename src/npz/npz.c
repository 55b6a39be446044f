/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading .npz. */
#include "npz/npz.h"

#include "npz/npy.h"
#include "common/utf8.h"
#include "common/file.h"
#include "common/lfs_pointer.h"
#include "common/standard_io.h"
#include "common/trace.h"
#include "npz/zip_directory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

enum { MAX_ARRAYS = 256, NAME_SIZE = 64 };

/* Deflate cannot exceed this ratio, so a member that claims more is invalid. */
enum { DEFLATE_BEST_RATIO = 1032 };

typedef struct StoredArray {
    char name[NAME_SIZE]; /* without .npy */
    NpyHead head;
} StoredArray;

struct NpzFile {
    zip_t *archive;
    char *path;
    uint64_t bytes_read; /* inflated so far, against NPZ_MAX_BYTES */
    bool converts;
    zip_uint64_t count;
    StoredArray arrays[MAX_ARRAYS]; /* in the order of the archive */
};

/* Errors of libzip are input errors, except these two. */
static bool zip_failed(const NpzFile *file, const char *name, zip_error_t *cause, Error *error) {
    int code = zip_error_code_zip(cause);
    if (code == ZIP_ER_MEMORY) return error_memory(error, file->path);
    if (code == ZIP_ER_READ) return error_system(error, file->path, "cannot read: %s", zip_error_strerror(cause));
    return error_input(error, file->path, "array '%s' is damaged: %s", name, zip_error_strerror(cause));
}

static const StoredArray *find(const NpzFile *file, const char *name) {
    for (zip_uint64_t i = 0; i < file->count; i++)
        if (strcmp(file->arrays[i].name, name) == 0) return &file->arrays[i];
    return NULL;
}

/* The member's name without ".npy". Only letters, digits, '_', '-' and '.', since messages print it on a terminal. */
static bool take_name(NpzFile *file, const char *member, char name[NAME_SIZE], Error *error) {
    size_t length = strlen(member);
    bool plain = length > 4 && length - 4 < NAME_SIZE;
    for (size_t i = 0; plain && i < length; i++) plain = isalnum((unsigned char)member[i]) || strchr("_-.", member[i]);
    if (!plain || strcmp(member + length - 4, ".npy") != 0)
        return error_input(error, file->path, "holds a member that is not a named .npy array");
    memcpy(name, member, length - 4);
    if (find(file, name) != NULL) return error_input(error, file->path, "holds array '%s' twice", name);
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
    zip_file_t *member = zip_fopen_index(file->archive, index, 0);
    if (member == NULL) return zip_failed(file, array->name, zip_get_error(file->archive), error);
    char text[NPY_HEAD_MAX], reason[NPY_REASON_SIZE];
    zip_int64_t size = zip_fread(member, text, sizeof text);
    bool done;
    if (size < 0)
        done = zip_failed(file, array->name, zip_file_get_error(member), error);
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
    if (count < 1 || count > MAX_ARRAYS)
        return error_input(error, file->path, "holds %" PRId64 " arrays; expected 1 to %d", (int64_t)count, MAX_ARRAYS);
    for (; file->count < (zip_uint64_t)count; file->count++) {
        StoredArray *array = &file->arrays[file->count];
        zip_stat_t status;
        if (zip_stat_index(file->archive, file->count, 0, &status) != 0)
            return zip_failed(file, "?", zip_get_error(file->archive), error);
        if (!take_name(file, status.name, array->name, error) || !check_member(file, array, &status, error) ||
            !read_head(file, file->count, array, status.size, error))
            return false;
    }
    return true;
}

static bool refuse_pointer(int descriptor, const char *path, Error *error) {
    char start[64];
    ssize_t size = pread(descriptor, start, sizeof start, 0);
    return size < 0 ? error_system(error, path, "cannot read: %s", strerror(errno))
                    : lfs_pointer_refuse(start, (size_t)size, path, error);
}

/* Opens the file and checks that it is safe to pass to libzip. */
static int open_checked(const char *path, Error *error) {
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
    if (done) return descriptor;
    close(descriptor);
    return -1;
}

static bool open_archive(NpzFile *file, Error *error) {
    int descriptor = open_checked(file->path, error), cause;
    if (descriptor < 0) return false;
    file->archive = zip_fdopen(descriptor, 0, &cause);
    if (file->archive != NULL) return true;
    zip_error_t reason;
    zip_error_init_with_code(&reason, cause);
    if (cause == ZIP_ER_MEMORY)
        error_memory(error, file->path);
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
    else if (open_archive(file, error) && read_directory(file, error))
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

void npz_convert(NpzFile *file) { file->converts = true; }

const char *npz_name(const NpzFile *file, size_t index) {
    return index < file->count ? file->arrays[index].name : NULL;
}

const char *npz_path(const NpzFile *file) { return file->path; }

bool npz_has(const NpzFile *file, const char *name) { return find(file, name) != NULL; }

static bool is_stored_as(const NpyHead *head, NpzType type, int rank) {
    return head->type == type && head->rank == rank && !head->big_endian && !(head->fortran && rank > 1);
}

/* Whether npz_read() can make an array of this type and rank of it. */
static bool is_convertible(const NpyHead *head, NpzType type, int rank) {
    bool one_number = rank == 0 && head->rank == 1 && head->shape[0] == 1;
    return (head->type == NPZ_TEXT) == (type == NPZ_TEXT) && (head->rank == rank || one_number);
}

static const StoredArray *find_of(const NpzFile *file, const char *name, NpzType type, int rank, Error *error) {
    const StoredArray *array = find(file, name);
    if (array == NULL) {
        error_input(error, file->path, "has no array '%s'", name);
        return NULL;
    }
    const NpyHead *head = &array->head;
    if (is_stored_as(head, type, rank) || (file->converts && is_convertible(head, type, rank))) return array;
    error_input(error, file->path, "array '%s' is %s of %d dimensions%s%s; expected %s of %d", name,
                npy_type_name(head->type), head->rank, head->big_endian ? ", big-endian" : "",
                head->fortran ? ", in Fortran order" : "", npy_type_name(type), rank);
    return NULL;
}

bool npz_shape(const NpzFile *file, const char *name, NpzType type, int rank, int64_t *shape, Error *error) {
    const StoredArray *array = find_of(file, name, type, rank, error);
    for (int i = 0; array != NULL && i < rank; i++) shape[i] = array->head.shape[i];
    return array != NULL;
}

/* "(3, 2)" */
static const char *shape_text(char text[96], int rank, const int64_t *shape) {
    int used = 0;
    for (int i = 0; i < rank; i++)
        used += snprintf(text + used, 96 - (size_t)used, "%s%" PRId64, i == 0 ? "(" : ", ", shape[i]);
    snprintf(text + used, 96 - (size_t)used, ")");
    return text;
}

/* Reads the data up to the end of the member: libzip compares the checksum only there. */
static bool inflate_data(NpzFile *file, const StoredArray *array, zip_file_t *member, char *data, Error *error) {
    char skipped[NPY_HEAD_MAX], more;
    zip_int64_t head = zip_fread(member, skipped, array->head.head_size);
    zip_int64_t size = head < 0 ? -1 : zip_fread(member, data, array->head.data_size);
    zip_int64_t after = size < 0 ? -1 : zip_fread(member, &more, 1);
    if (after < 0) return zip_failed(file, array->name, zip_file_get_error(member), error);
    if ((uint64_t)size == array->head.data_size && after == 0) return true;
    return error_input(error, file->path, "array '%s' is damaged: %s", array->name, after > 0 ? "too long" : "cut off");
}

static void *read_data(NpzFile *file, const StoredArray *array, Error *error) {
    uint64_t size = array->head.data_size;
    if (size > NPZ_MAX_BYTES - file->bytes_read) {
        error_input(error, file->path, "its arrays are larger than 2 GiB together");
        return NULL;
    }
    file->bytes_read += size;
    char *data = malloc(size > 0 ? size : 1);
    if (data == NULL) {
        error_memory(error, file->path);
        return NULL;
    }
    zip_file_t *member = zip_fopen_index(file->archive, (zip_uint64_t)(array - file->arrays), 0);
    bool done = member != NULL ? inflate_data(file, array, member, data, error)
                               : zip_failed(file, array->name, zip_get_error(file->archive), error);
    if (member != NULL) zip_fclose(member);
    if (done && array->head.big_endian) npy_swap(&array->head, data);
    if (done) return data;
    free(data);
    return NULL;
}

/* Replaces `data`, which it frees, by a block of the type. */
static void *convert(NpzFile *file, const StoredArray *array, void *data, NpzType type, Error *error) {
    size_t size = npy_count(&array->head) * npy_type_size(type);
    char reason[NPY_REASON_SIZE];
    bool small = size <= NPZ_MAX_BYTES;
    void *converted = small ? malloc(size > 0 ? size : 1) : NULL;
    bool done = false;
    if (!small)
        error_input(error, file->path, "array '%s' is larger than 2 GiB as %s", array->name, npy_type_name(type));
    else if (converted == NULL)
        error_memory(error, file->path);
    else if (!npy_convert(&array->head, data, type, converted, reason))
        error_input(error, file->path, "array '%s': %s", array->name, reason);
    else
        done = true;
    free(data);
    if (done) return converted;
    free(converted);
    return NULL;
}

void *npz_read(NpzFile *file, const char *name, NpzType type, int rank, const int64_t *shape, Error *error) {
    const StoredArray *array = find_of(file, name, type, rank, error);
    if (array == NULL) return NULL;
    for (int i = 0; i < rank; i++) {
        if (array->head.shape[i] == shape[i]) continue;
        char found[96], wanted[96];
        error_input(error, file->path, "array '%s' has shape %s; expected %s", name,
                    shape_text(found, rank, array->head.shape), shape_text(wanted, rank, shape));
        return NULL;
    }
    void *data = read_data(file, array, error);
    return data == NULL || is_stored_as(&array->head, type, array->head.rank) ? data
                                                                              : convert(file, array, data, type, error);
}

/* Appends one character; false if it is not one (NUL, surrogate, too large), or has no room with a NUL behind it. */
static bool append(uint32_t character, char *text, size_t *used, size_t size) {
    char bytes[4];
    if (character == 0 || character > 0x10ffff || (character >= 0xd800 && character < 0xe000)) return false;
    size_t length = utf8_encode(bytes, character);
    if (*used + length >= size) return false;
    memcpy(text + *used, bytes, length);
    *used += length;
    return true;
}

bool npz_read_text(NpzFile *file, const char *name, char *text, size_t size, Error *error) {
    const StoredArray *array = find_of(file, name, NPZ_TEXT, 0, error);
    if (array == NULL) return false;
    int64_t count = array->head.characters;
    if ((uint64_t)count > size)
        return error_input(error, file->path, "text '%s' is longer than %zu bytes", name, size - 1);
    uint32_t *characters = read_data(file, array, error);
    if (characters == NULL) return false;
    /* NumPy pads a text with zeros. */
    while (count > 0 && characters[count - 1] == 0) count--;
    size_t used = 0;
    bool done = true;
    for (int64_t i = 0; done && i < count; i++) done = append(characters[i], text, &used, size);
    text[used] = '\0';
    free(characters);
    return done || error_input(error, file->path, "text '%s' is damaged, or longer than %zu bytes", name, size - 1);
}

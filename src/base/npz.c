/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads .npz: opens and checks an archive, then inflates and converts its arrays. */
#include "base/npz.h"

#include "base/base.h"
#include "base/file.h"

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
#include <zlib.h>

enum { NPZ_MAX_ARRAYS = 256, NPZ_NAME_SIZE = 64 };

typedef struct StoredArray {
    char name[NPZ_NAME_SIZE]; /* without .npy */
    NpyHead head;
} StoredArray;

struct NpzFile {
    zip_t *archive;
    char *path;
    uint64_t size;       /* of the file, bytes */
    uint64_t budget;     /* bytes that its arrays may take in memory, see npz.h */
    uint64_t bytes_read; /* of that so far */
    bool converts;
    zip_uint64_t count;
    StoredArray arrays[NPZ_MAX_ARRAYS]; /* in the order of the archive */
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
static bool refuse_damaged(const NpzFile *file, const char *name, zip_error_t *cause, Error *error) {
    const int system = system_cause(cause);
    if (system != 0) return cause_error(system, file->path, error);
    return error_input(error, file->path, "array '%s' is damaged: %s", name, zip_error_strerror(cause));
}

/* NULL if no array has this name. */
static const StoredArray *find(const NpzFile *file, const char *name) {
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
    errno = 0;
    zip_file_t *member = zip_fopen_index(file->archive, index, 0);
    if (member == NULL) return refuse_damaged(file, array->name, zip_get_error(file->archive), error);
    char text[NPY_HEAD_MAX], reason[NPY_REASON_SIZE];
    zip_int64_t size = zip_fread(member, text, sizeof text);
    bool done;
    if (size < 0)
        done = refuse_damaged(file, array->name, zip_file_get_error(member), error);
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
            return refuse_damaged(file, "?", zip_get_error(file->archive), error);
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

/* Before any data is inflated, the file and its directory are checked. libzip reads every directory that the last 64 KiB
   point to, with all entries; a malicious file costs it minutes and gigabytes (tests/base/test_npz_hostile.c). */

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
               check_directory(descriptor, (uint64_t)status.st_size, path, error);
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
    if ((uint64_t)size == array->head.data_size && after == 0) return true;
    if (after < 0)
        refuse_damaged(file, array->name, zip_file_get_error(member), error);
    else
        error_input(error, file->path, "array '%s' is damaged: %s", array->name, after > 0 ? "too long" : "cut off");
    return false;
}

/* Counts memory against the file's budget. */
static bool spend(NpzFile *file, uint64_t size, Error *error) {
    if (size > file->budget - file->bytes_read)
        return error_input(error, file->path, "its arrays take more than %" PRIu64 " bytes together", file->budget);
    file->bytes_read += size;
    return true;
}

static void *read_data(NpzFile *file, const StoredArray *array, Error *error) {
    uint64_t size = array->head.data_size;
    if (!spend(file, size, error)) return NULL;
    char *data = malloc(size > 0 ? size : 1);
    if (data == NULL) {
        error_memory(error, file->path);
        return NULL;
    }
    errno = 0;
    zip_file_t *member = zip_fopen_index(file->archive, (zip_uint64_t)(array - file->arrays), 0);
    bool done = member != NULL && inflate_data(file, array, member, data, error);
    if (member != NULL)
        zip_fclose(member);
    else
        refuse_damaged(file, array->name, zip_get_error(file->archive), error);
    if (done && array->head.big_endian) npy_swap(&array->head, data);
    if (done) return data;
    free(data);
    return NULL;
}

/* Replaces `data`, which it frees, by a block of the type. */
static void *convert(NpzFile *file, const StoredArray *array, void *data, NpzType type, Error *error) {
    size_t size = npy_count(&array->head) * npy_type_size(type);
    char reason[NPY_REASON_SIZE];
    void *converted = malloc(size > 0 ? size : 1);
    bool done = false;
    if (converted == NULL)
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

/* The array, if it has this type, rank and shape. */
static const StoredArray *find_shaped(const NpzFile *file, const char *name, NpzType type, int rank,
                                      const int64_t *shape, Error *error) {
    const StoredArray *array = find_of(file, name, type, rank, error);
    for (int i = 0; array != NULL && i < rank; i++) {
        if (array->head.shape[i] == shape[i]) continue;
        char found[96], wanted[96];
        error_input(error, file->path, "array '%s' has shape %s; expected %s", name,
                    shape_text(found, rank, array->head.shape), shape_text(wanted, rank, shape));
        return NULL;
    }
    return array;
}

bool npz_expect(const NpzFile *file, const NpzArray *arrays, size_t count, Error *error) {
    for (size_t i = 0; i < count; i++)
        if (find_shaped(file, arrays[i].name, arrays[i].type, arrays[i].rank, arrays[i].shape, error) == NULL)
            return false;
    return true;
}

void *npz_read(NpzFile *file, const char *name, NpzType type, int rank, const int64_t *shape, Error *error) {
    const StoredArray *array = find_shaped(file, name, type, rank, shape, error);
    if (array == NULL) return NULL;
    const uint64_t converted = npy_count(&array->head) * npy_type_size(type), stored = array->head.data_size;
    if (converted > stored && !spend(file, converted - stored, error)) return NULL;
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

bool npz_read_name(NpzFile *file, const char *name, char *text, size_t size, Error *error) {
    if (!npz_read_text(file, name, text, size, error)) return false;
    const unsigned control = control_in_text(text);
    return control == 0 ||
           error_input(error, file->path, "the name of the %s has the control character U+%04X", name, control);
}

bool npz_read_scalar(NpzFile *file, const char *name, NpzType type, void *value, size_t size, Error *error) {
    void *data = npz_read(file, name, type, 0, NULL, error);
    if (data != NULL) memcpy(value, data, size);
    free(data);
    return data != NULL;
}

bool npz_check_kind(NpzFile *file, const char *kind, int32_t version, Error *error) {
    char found[64];
    int32_t stored;
    if (!npz_has(file, "kind") || !npz_read_text(file, "kind", found, sizeof found, error) || strcmp(found, kind) != 0)
        return error_input(error, file->path, "not a file of kind '%s'", kind);
    if (!npz_read_scalar(file, "version", NPZ_INT32, &stored, sizeof stored, error)) return false;
    return stored == version ||
           error_input(error, file->path, "%s of version %d; expected version %d", kind, (int)stored, (int)version);
}

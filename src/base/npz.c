/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the arrays of an .npz, whose archive another file reads (npz_zip.c). */
#include "base/npz.h"

#include "base/base.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NPZ_MAX_ARRAYS = 256, NPZ_NAME_SIZE = 64 };

typedef struct StoredArray {
    char name[NPZ_NAME_SIZE]; /* without .npy */
    NpyHead head;
    char reason[NPY_REASON_SIZE]; /* why it cannot be read, if head.is_foreign */
} StoredArray;

struct NpzFile {
    NpzArchive *archive;
    char *path;
    uint64_t size;       /* of the file, bytes */
    uint64_t budget;     /* bytes that its arrays may take in memory, see npz.h */
    uint64_t bytes_read; /* of that so far */
    bool converts;
    int64_t count;
    StoredArray arrays[NPZ_MAX_ARRAYS]; /* in the order of the archive */
};

/* NULL if no array has this name. */
static const StoredArray *npz_find(const NpzFile *file, const char *name) {
    for (int64_t i = 0; i < file->count; i++)
        if (strcmp(file->arrays[i].name, name) == 0) return &file->arrays[i];
    return NULL;
}

/* Names have only letters, digits, '_', '-' and '.', since messages print them on a terminal. */
static bool read_directory(NpzFile *file, Error *error) {
    const int64_t count = npz_archive_count(file->archive);
    if (count < 1 || count > NPZ_MAX_ARRAYS)
        return error_input(error, file->path, "holds %" PRId64 " arrays; expected 1 to %d", count, NPZ_MAX_ARRAYS);
    for (int64_t k = 0; k < count; k++) {
        StoredArray *array = &file->arrays[k];
        const char *member = npz_archive_name(file->archive, k, error);
        if (member == NULL) return false;
        const size_t length = strlen(member);
        bool plain = length > 4 && length - 4 < NPZ_NAME_SIZE;
        for (size_t i = 0; plain && i < length; i++)
            plain = isalnum((unsigned char)member[i]) || strchr("_-.", member[i]);
        if (!plain || strcmp(member + length - 4, ".npy") != 0)
            return error_input(error, file->path, "holds a member that is not a named .npy array");
        memcpy(array->name, member, length - 4);
        if (npz_find(file, array->name) != NULL)
            return error_input(error, file->path, "holds array '%s' twice", array->name);
        char text[NPY_HEAD_MAX];
        uint64_t declared;
        if (!npz_archive_check(file->archive, k, array->name, &declared, error)) return false;
        const int64_t size = npz_archive_begin(file->archive, k, array->name, text, sizeof text, error);
        if (size < 0) return false;
        const bool known = npy_parse_head(&array->head, text, (size_t)size, array->reason);
        if (!known && !array->head.is_foreign)
            return error_input(error, file->path, "'%s' is %s", array->name, array->reason);
        const uint64_t whole = array->head.head_size + array->head.data_size;
        if (known && whole != declared)
            return error_input(error, file->path, "array '%s' is damaged: %" PRIu64 " bytes instead of %" PRIu64,
                               array->name, declared, whole);
        file->count++;
    }
    return true;
}

uint64_t npz_budget(uint64_t size) {
    const uint64_t budget = NPZ_ALWAYS + NPZ_RATIO * size;
    return budget < NPZ_MAX_BYTES ? budget : NPZ_MAX_BYTES;
}

NpzFile *npz_open(const char *path, Error *error) {
    NpzFile *file = calloc(1, sizeof *file);
    uint64_t total = 0;
    if (file != NULL) file->path = strdup(path);
    bool ok = (file != NULL && file->path != NULL) || error_memory(error, path);
    ok = ok && (file->archive = npz_archive_open(path, &file->size, error)) != NULL && read_directory(file, error);
    if (ok) {
        /* A bomb is refused here, whatever reads it. */
        for (int64_t i = 0; i < file->count; i++) total += file->arrays[i].head.data_size;
        file->budget = npz_budget(file->size);
        if (total <= file->budget) return file;
        if (total > NPZ_MAX_BYTES)
            error_input(error, path, "its arrays are larger than 2 GiB together");
        else
            error_input(error, path,
                        "its arrays take %" PRIu64 " bytes; expected at most %" PRIu64
                        " (%d MiB and %d times the size of the file); store them with less compression",
                        total, file->budget, (int)(NPZ_ALWAYS >> 20), (int)NPZ_RATIO);
    }
    npz_close(file);
    return NULL;
}

void npz_close(NpzFile *file) {
    if (file == NULL) return;
    npz_archive_close(file->archive);
    free(file->path);
    free(file);
}

void npz_convert(NpzFile *file) { file->converts = true; }

const char *npz_name(const NpzFile *file, size_t index) {
    return index < (size_t)file->count ? file->arrays[index].name : NULL;
}

const char *npz_path(const NpzFile *file) { return file->path; }

bool npz_has(const NpzFile *file, const char *name) { return npz_find(file, name) != NULL; }

bool npz_is_wide(const NpzFile *file, const char *name) {
    const StoredArray *array = npz_find(file, name);
    return array != NULL && !array->head.is_foreign && array->head.type > NPZ_FLOAT32 && array->head.type < NPZ_UINT8;
}

static bool is_stored_as(const NpyHead *head, NpzType type, int rank) {
    return head->type == type && head->rank == rank && !head->big_endian && !(head->fortran && rank > 1);
}

static const StoredArray *find_of(const NpzFile *file, const char *name, NpzType type, int rank, Error *error) {
    const StoredArray *array = npz_find(file, name);
    if (array == NULL) return error_input(error, file->path, "has no array '%s'", name), NULL;
    const NpyHead *head = &array->head;
    if (head->is_foreign) return error_input(error, file->path, "'%s' is %s", name, array->reason), NULL;
    const bool one_number = rank == 0 && head->rank == 1 && head->shape[0] == 1;
    const bool converts = file->converts && (head->type == NPZ_TEXT) == (type == NPZ_TEXT);
    if (is_stored_as(head, type, rank) || (converts && (head->rank == rank || one_number))) return array;
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
    if (data == NULL) return error_memory(error, file->path), NULL;
    const bool done =
        npz_archive_read(file->archive, array - file->arrays, array->name, array->head.head_size, data, size, error);
    if (done && array->head.big_endian) npy_swap(&array->head, data);
    if (done) return data;
    free(data);
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
    if (data == NULL || is_stored_as(&array->head, type, array->head.rank)) return data;
    char reason[NPY_REASON_SIZE];
    void *block = malloc(converted > 0 ? (size_t)converted : 1);
    bool done = block != NULL || error_memory(error, file->path);
    if (done && !npy_convert(&array->head, data, type, block, reason))
        done = error_input(error, file->path, "array '%s': %s", array->name, reason);
    free(data);
    if (done) return block;
    free(block);
    return NULL;
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
    for (int64_t i = 0; done && i < count; i++) {
        /* A NUL, a surrogate or a number that is too large is no character; one needs room with a NUL behind it. */
        const uint32_t c = characters[i];
        char bytes[4];
        done = c != 0 && c <= 0x10ffff && (c < 0xd800 || c >= 0xe000);
        const size_t length = done ? utf8_put(bytes, c) : 0;
        done = done && used + length < size;
        if (done) memcpy(text + used, bytes, length);
        if (done) used += length;
    }
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading the arrays of .npz. */
#include "npz/npz_file.h"

#include "common/utf8.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void npz_convert(NpzFile *file) { file->converts = true; }

const char *npz_name(const NpzFile *file, size_t index) {
    return index < file->count ? file->arrays[index].name : NULL;
}

const char *npz_path(const NpzFile *file) { return file->path; }

bool npz_has(const NpzFile *file, const char *name) { return npz_find(file, name) != NULL; }

static bool is_stored_as(const NpyHead *head, NpzType type, int rank) {
    return head->type == type && head->rank == rank && !head->big_endian && !(head->fortran && rank > 1);
}

/* Whether npz_read() can make an array of this type and rank of it. */
static bool is_convertible(const NpyHead *head, NpzType type, int rank) {
    bool one_number = rank == 0 && head->rank == 1 && head->shape[0] == 1;
    return (head->type == NPZ_TEXT) == (type == NPZ_TEXT) && (head->rank == rank || one_number);
}

static const StoredArray *find_of(const NpzFile *file, const char *name, NpzType type, int rank, Error *error) {
    const StoredArray *array = npz_find(file, name);
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
        npz_failed(file, array->name, zip_file_get_error(member), error);
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
        npz_failed(file, array->name, zip_get_error(file->archive), error);
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

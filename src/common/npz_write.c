/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writing .npz: the archive is built in memory, then written atomically. */
#include "common/file.h"
#include "common/npy.h"
#include "common/utf8.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

/* Noon of 1980-01-01 in local time. libzip converts to the machine's time zone and back, which would change hours that
   a zone skips at night. */
enum { DOS_TIME = 12 << 11, DOS_DATE = 1 << 5 | 1 };

/* zlib's default. libzip's is 9, which made a file of positions no smaller. */
enum { DEFLATE_LEVEL = 6 };

/* From this size on, floats are stored uncompressed: deflate takes a second per 30 MB to halve a dataset. */
enum { STORED_SIZE = 1 << 24 };

enum { MEMBER_NAME_SIZE = 72 };

/* libzip reads this when it closes the archive, so it must live until then. */
typedef struct Member {
    char head[NPY_HEAD_MAX];
    uint32_t *characters; /* of a text, in UTF-32 */
    zip_buffer_fragment_t fragments[2];
} Member;

/* NumPy has no text of length 0, so an empty text is stored as one zero. */
static bool decode_text(Member *member, NpyHead *head, const NpzArray *array, const char *path, Error *error) {
    const char *text = array->data;
    size_t length, left = strlen(text);
    member->characters = calloc(left + 1, sizeof *member->characters);
    if (member->characters == NULL) return error_memory(error, path);
    int64_t count = 0;
    for (; left > 0; text += length, left -= length) {
        length = utf8_decode(text, left, &member->characters[count++]);
        if (length == 0) return error_input(error, path, "cannot store '%s': its text is not UTF-8", array->name);
    }
    head->characters = count > 0 ? count : 1;
    return true;
}

static bool prepare(Member *member, const NpzArray *array, const char *path, Error *error) {
    NpyHead head = {.type = array->type, .rank = array->rank};
    assert(array->rank <= NPZ_MAX_RANK && (array->type != NPZ_TEXT || array->rank == 0));
    memcpy(head.shape, array->shape, sizeof head.shape);
    if (array->type == NPZ_TEXT && !decode_text(member, &head, array, path, error)) return false;
    if (!npy_measure(&head)) return error_input(error, path, "cannot store '%s': larger than 2 GiB", array->name);
    npy_write_head(&head, member->head);
    const void *data = array->type == NPZ_TEXT ? member->characters : array->data;
    member->fragments[0] = (zip_buffer_fragment_t){(zip_uint8_t *)member->head, head.head_size};
    member->fragments[1] = (zip_buffer_fragment_t){(zip_uint8_t *)data, head.data_size};
    return true;
}

static bool zip_failed(const char *path, zip_t *archive, Error *error) {
    return error_system(error, path, "cannot write: %s", zip_strerror(archive));
}

static zip_int32_t compression(const NpzArray *array, const Member *member) {
    return array->type == NPZ_FLOAT32 && member->fragments[1].length >= STORED_SIZE ? ZIP_CM_STORE : ZIP_CM_DEFLATE;
}

static bool add(zip_t *archive, const NpzArray *array, const Member *member, const char *path, Error *error) {
    char member_name[MEMBER_NAME_SIZE];
    int length = snprintf(member_name, sizeof member_name, "%s.npy", array->name);
    assert(length > 0 && length < MEMBER_NAME_SIZE);
    (void)length;
    zip_uint64_t fragments = member->fragments[1].length > 0 ? 2 : 1;
    zip_source_t *source = zip_source_buffer_fragment(archive, member->fragments, fragments, 0);
    if (source == NULL) return zip_failed(path, archive, error);
    zip_int64_t index = zip_file_add(archive, member_name, source, 0);
    if (index < 0) {
        zip_source_free(source);
        return zip_failed(path, archive, error);
    }
    zip_int32_t method = compression(array, member);
    if (zip_set_file_compression(archive, (zip_uint64_t)index, method, DEFLATE_LEVEL) != 0 ||
        zip_file_set_dostime(archive, (zip_uint64_t)index, DOS_TIME, DOS_DATE, 0) != 0)
        return zip_failed(path, archive, error);
    return true;
}

/* Writes the finished archive into `source`. */
static bool build(zip_source_t *source, Member *members, const NpzArray *arrays, size_t count, const char *path,
                  Error *error) {
    zip_error_t cause;
    zip_error_init(&cause);
    zip_t *archive = zip_open_from_source(source, ZIP_CREATE | ZIP_TRUNCATE, &cause);
    if (archive == NULL) {
        error_system(error, path, "cannot write: %s", zip_error_strerror(&cause));
        zip_error_fini(&cause);
        return false;
    }
    /* Closing or discarding the archive releases the source, which the caller still needs. */
    zip_source_keep(source);
    bool done = true;
    for (size_t i = 0; done && i < count; i++)
        done = prepare(&members[i], &arrays[i], path, error) && add(archive, &arrays[i], &members[i], path, error);
    if (done && zip_close(archive) == 0) return true;
    if (done) zip_failed(path, archive, error);
    zip_discard(archive);
    return false;
}

static bool put(zip_source_t *source, const char *path, Error *error) {
    zip_stat_t status;
    if (zip_source_stat(source, &status) != 0 || zip_source_open(source) != 0)
        return error_system(error, path, "cannot write: %s", zip_error_strerror(zip_source_error(source)));
    char *data = malloc(status.size);
    bool done = data != NULL;
    if (!done) error_memory(error, path);
    if (done && zip_source_read(source, data, status.size) != (zip_int64_t)status.size)
        done = error_system(error, path, "cannot write: %s", zip_error_strerror(zip_source_error(source)));
    zip_source_close(source);
    if (done) done = file_write(path, data, status.size, error);
    free(data);
    return done;
}

bool npz_write(const char *path, const NpzArray *arrays, size_t count, Error *error) {
    assert(count > 0);
    Member *members = calloc(count, sizeof *members);
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    bool done = members != NULL && source != NULL;
    if (!done) error_memory(error, path);
    done = done && build(source, members, arrays, count, path, error) && put(source, path, error);
    for (size_t i = 0; members != NULL && i < count; i++) free(members[i].characters);
    free(members);
    if (source != NULL) zip_source_free(source);
    return done;
}

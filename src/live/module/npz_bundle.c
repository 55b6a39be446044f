/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The archive of an .npz that a bundle has, in place of base/npz_zip.c. Its members are stored, and the page has no
   damaged disk: they have no checksum. */
#include "base/base.h"
#include "base/npz.h"
#include "live/bundle.h"

#include <stdlib.h>
#include <string.h>

struct NpzArchive {
    Bundle members;
    int64_t count;
};

static Bundle bundle_in_use;

void bundle_use(Bundle bundle) { bundle_in_use = bundle; }

NpzArchive *npz_archive_open(const char *path, uint64_t *size, Error *error) {
    Bundle members;
    BundlePiece piece;
    if (!bundle_find(bundle_in_use, path, &members) || !bundle_is_whole(members)) {
        error_input(error, path, "the page does not have this network, or it is damaged");
        return NULL;
    }
    NpzArchive *archive = malloc(sizeof *archive);
    if (archive == NULL) {
        error_memory(error, path);
        return NULL;
    }
    *archive = (NpzArchive){.members = members};
    while (bundle_next(&members, &piece)) archive->count++;
    *size = archive->members.left;
    return archive;
}

void npz_archive_close(NpzArchive *archive) { free(archive); }

int64_t npz_archive_count(const NpzArchive *archive) { return archive->count; }

static BundlePiece member_at(const NpzArchive *archive, int64_t index) {
    Bundle members = archive->members;
    BundlePiece piece = {.name = ""};
    for (int64_t i = 0; i <= index; i++) bundle_next(&members, &piece);
    return piece;
}

const char *npz_archive_name(NpzArchive *archive, int64_t index, Error *error) {
    (void)error;
    return member_at(archive, index).name;
}

bool npz_archive_check(NpzArchive *archive, int64_t index, const char *array, uint64_t *size, Error *error) {
    (void)array, (void)error;
    *size = member_at(archive, index).data.left;
    return true;
}

int64_t npz_archive_begin(NpzArchive *archive, int64_t index, const char *array, char *text, size_t size,
                          Error *error) {
    (void)array, (void)error;
    const Bundle data = member_at(archive, index).data;
    const size_t length = data.left < size ? data.left : size;
    memcpy(text, data.at, length);
    return (int64_t)length;
}

bool npz_archive_read(NpzArchive *archive, int64_t index, const char *array, size_t head, void *data, uint64_t size,
                      Error *error) {
    const Bundle member = member_at(archive, index).data;
    if (head > member.left || size != member.left - head)
        return error_input(error, "bundle", "array '%s' is damaged: it has another size", array);
    memcpy(data, member.at + head, (size_t)size);
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of pieces, which other machines may have written. */
#include "fuzz.h"

#include "base/file.h"
#include "runs/pieces.h"

#include <stdlib.h>
#include <string.h>

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context, (void)piece;
    strcpy(info->name, "stack_height 1-3");
}

/* The key, the number and the name are those of the first stored input. */
void fuzz_piece(const uint8_t *data, size_t size) {
    Error error = {0};
    const PiecePlan plan = {.count = 8, .describe = describe};
    Pieces pieces = {.key = 0x0123456789abcdef, .plan = &plan};
    char path[PIECES_PATH_SIZE];
    const char *beside = fuzz_file("piece", data, size);
    size_t taken;
    snprintf(pieces.folder, sizeof pieces.folder, "%s-folder/parts", beside);
    if (!pieces_path(&pieces, 7, path, &error)) fuzz_fail("%s", error.message);
    snprintf(pieces.folder + strlen(pieces.folder), 8, "/0000");
    if (!file_make_directory(pieces.folder, &error) || !file_write_soon(path, data, size, &error))
        fuzz_fail("%s", error.message);
    *strrchr(pieces.folder, '/') = '\0';
    fuzz_begin();
    char *results = pieces_read(&pieces, 7, &taken, NULL, &error);
    fuzz_end(results != NULL, &error, path);
    if (results != NULL && taken > size) fuzz_fail("%zu bytes of %zu", taken, size);
    free(results);
}

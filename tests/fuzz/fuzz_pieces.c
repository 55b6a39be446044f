/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What shards leave for each other: run.json, and the files of pieces. */
#include "fuzz.h"

#include "base/file.h"
#include "runs/pieces.h"

#include <stdlib.h>
#include <string.h>

/* The head that the file must have has the key, the number and the name of the first stored input. */
void fuzz_piece(const uint8_t *data, size_t size) {
    Error error = {0};
    PieceHead head = {.key = 0x0123456789abcdef, .number = 7, .name = "stack_height 1-3"};
    const char *path = fuzz_file("piece", data, size);
    size_t taken;
    fuzz_begin();
    char *results = piece_file_read(path, &head, &taken, &error);
    fuzz_end(results != NULL, &error, path);
    if (results == NULL) return;
    if (!piece_file_write(path, &head, results, taken, &error)) fuzz_fail("%s", error.message);
    size_t again;
    char *written = file_read(path, size, &again, &error);
    if (written == NULL || again != size || memcmp(written, data, size) != 0)
        fuzz_fail("a piece that is read is written in another way");
    free(written);
    free(results);
}

void fuzz_record(const uint8_t *data, size_t size) {
    Error error = {0};
    StudyRecord record;
    Shard shard;
    const ShardRequest request = {.shard = {1, 2}, .array = {.first = 0, .step = 1, .id = 5}};
    const char *path = fuzz_file("run.json", data, size);
    fuzz_begin();
    const bool ok = study_record_read(&record, path, &error);
    fuzz_end(ok, &error, path);
    if (ok && study_record_shard(&record, path, &request, &shard, &error) &&
        (shard.number < 1 || shard.number > shard.count))
        fuzz_fail("shard %d of %d", shard.number, shard.count);
    study_record_free(&record);
}

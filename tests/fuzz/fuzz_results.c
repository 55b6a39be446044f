/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results of pieces that hold binary numbers: rows of a dataset, and samples of scene-net. Their files have a
   hash, so these bytes would have been written with it. */
#include "fuzz.h"

#include "base/file.h"
#include "learning/dataset.h"
#include "learning/scene_training.h"

#include <stdlib.h>
#include <string.h>

/* What was read is written as the same bytes. */
static void compare(FILE *out, char *const *written, const size_t *length, const uint8_t *data, size_t size) {
    if (out == NULL || fclose(out) != 0) fuzz_fail("memory is short");
    if (*length != size || (size > 0 && memcmp(*written, data, size) != 0))
        fuzz_fail("%zu bytes are read, and written as %zu others", size, *length);
    free(*written);
}

/* Rows of the launches 5 to 9 of ten; the first byte has the view, the target and whether there is context. */
void fuzz_rows(const uint8_t *data, size_t size) {
    Error error = {0};
    if (size == 0) return;
    const uint8_t choice = data[0];
    Dataset launches = {.view = (PairView)(choice % PAIR_VIEWS),
                        .target = (PairTarget)(choice / PAIR_VIEWS % PAIR_TARGETS),
                        .launches = 10,
                        .scene_count = 1};
    const DatasetOptions options = {.context = choice >= 128};
    DatasetPieces pieces = {.recording = {.options = &options, .dataset = &launches}};
    piece_ranges_add(&pieces.launches, launches.launches, 2);
    const size_t left = size - 1;
    fuzz_begin();
    int64_t unconverged;
    const int64_t rows = dataset_piece_rows(&pieces, 1, (const char *)data + 1, left, &unconverged, "rows", &error);
    fuzz_end(rows >= 0, &error, "rows");
    if (rows >= 0 && unconverged < 0) fuzz_fail("%lld unconverged steps", (long long)unconverged);
    if (rows > 0 && (left - DATASET_PIECE_HEAD) % (size_t)rows != 0)
        fuzz_fail("%zu bytes are %lld rows", left, (long long)rows);
}

/* The first byte has the number of bodies. */
void fuzz_samples(const uint8_t *data, size_t size) {
    Error error = {0};
    SlotSamples samples = {0};
    if (size == 0) return;
    const int bodies = data[0];
    const size_t left = size - 1;
    char *written = NULL;
    size_t length = 0;
    fuzz_begin();
    const bool ok = slot_samples_read(&samples, (const char *)data + 1, left, bodies, "samples", &error);
    fuzz_end(ok, &error, "samples");
    FILE *out = ok ? memory_stream(&written, &length) : NULL;
    if (out != NULL) slot_samples_write(&samples, out);
    if (ok) compare(out, &written, &length, data + 1, left);
    slot_samples_free(&samples);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/pieces_missing.h"

#include "common/memory_stream.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void pieces_missing_add(PiecesMissing *missing, const PieceInfo *info) {
    const int shards = missing->pieces->shard.count;
    if (missing->count < MISSING_NAMED) memcpy(missing->names[missing->count], info->name, PIECE_NAME_SIZE);
    missing->count++;
    if (missing->shards == NULL) missing->shards = calloc((size_t)shards, 1);
    if (missing->shards != NULL) missing->shards[piece_shard(info, missing->plan->count, shards) - 1] = 1;
}

void pieces_missing_free(PiecesMissing *missing) { free(missing->shards); }

static void print_list(FILE *out, const unsigned char *shards, int count, const JobArray *array) {
    const int64_t first = array->step > 0 ? array->first : 1, step = array->step > 0 ? array->step : 1;
    const char *comma = "";
    for (int i = 0; i < count; i++) {
        int last = i;
        if (!shards[i]) continue;
        while (last + 1 < count && shards[last + 1]) last++;
        fprintf(out, "%s%" PRId64, comma, first + i * step);
        if (last > i) fprintf(out, "-%" PRId64, first + last * step);
        if (last > i && step > 1) fprintf(out, ":%" PRId64, step);
        comma = ",";
        i = last;
    }
}

char *pieces_shard_list(const unsigned char *shards, int count, const JobArray *array) {
    char *text = NULL;
    size_t size;
    FILE *out = memory_stream(&text, &size);
    if (out == NULL) return NULL;
    print_list(out, shards, count, array);
    const bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}

bool pieces_missing_refuse(const PiecesMissing *missing, Error *error) {
    const Pieces *pieces = missing->pieces;
    enum { SHOWN = 800 };
    if (missing->count == 0) return true;
    char *list =
        missing->shards != NULL ? pieces_shard_list(missing->shards, pieces->shard.count, &pieces->array) : NULL;
    if (list == NULL) return error_memory(error, pieces->folder);
    error_incomplete(error, pieces->folder, "%" PRId64 " of %" PRId64 " pieces are missing: ", missing->count,
                     missing->plan->count);
    for (int i = 0; i < missing->count && i < MISSING_NAMED; i++)
        error_add(error, "%s%s", i > 0 ? ", " : "", missing->names[i]);
    error_add(error, "%s; run their shards (of %d) again: --array=%.*s%s",
              missing->count > MISSING_NAMED ? ", ..." : "", pieces->shard.count, SHOWN, list,
              strlen(list) > SHOWN ? "..." : "");
    if (pieces->run != NULL && pieces->run->shards != NULL)
        *pieces->run->shards = list;
    else
        free(list);
    return false;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* join_pieces FOLDER COUNT make|merge: the pieces of a study that is as large as wanted, each with the rows of a cell
   of a map for four methods; or the tables that they give. */
#include "studies/piece_tables.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { METHODS = 4, SHARDS = 2 };

typedef struct CellRow {
    const char *method;
    int x, y;
    double held, settled;
} CellRow;

static const CsvColumn columns[] = {{"method", CSV_NAME, .offset = offsetof(CellRow, method)},
                                    {"x", CSV_INTEGER, .offset = offsetof(CellRow, x), .maximum = 1e6},
                                    {"y", CSV_INTEGER, .offset = offsetof(CellRow, y), .maximum = 1e6},
                                    {"held", CSV_NUMBER, .offset = offsetof(CellRow, held), .maximum = 1},
                                    {"settled", CSV_OPTIONAL, .offset = offsetof(CellRow, settled), .maximum = 1e6}};
static const CsvLayout layout = CSV_LAYOUT("cells", columns, CellRow, .min_rows = 1, .max_rows = 1000000000);
static const CsvLayout *const layouts[] = {&layout};

/* How fast a disk keeps files is not what is measured, and a million waits for it take an hour. */
int fsync(int file) {
    (void)file;
    return 0;
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "cell %lld", (long long)piece);
    info->weight = 1;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    static const char *const methods[METHODS] = {"engine", "momentum", "pair-net", "interior"};
    (void)context;
    (void)progress;
    for (int i = 0; i < METHODS; i++) {
        const CellRow row = {methods[i], (int)(piece % 1000), (int)(piece / 1000), 1.0 / (double)(piece + i + 1),
                             (double)((piece + i) % 97) / 60};
        if (!piece_tables_print(results, &layout, i, &row, error)) return false;
    }
    return true;
}

/* shard 0: a merge. */
static bool run(const char *folder, int64_t count, int shard, Error *error) {
    char *arguments[] = {(char[]){"join_pieces"}, (char[]){"cells"}};
    const PiecesRun how = {.request = {.shard = {shard, SHARDS}}, .merge = shard == 0, .argc = 2, .argv = arguments};
    const PiecePlan plan = {.count = count, .describe = describe, .work = work};
    const PieceGroup group = {0, count, METHODS};
    StudyKey key;
    Pieces pieces = {0};
    const bool done = study_key_begin(&key, error) && pieces_open(&pieces, folder, &key, &how, error) &&
                      pieces_do(&pieces, &plan, NULL, error) &&
                      (shard > 0 || piece_tables_write(&pieces, folder, layouts, 1, &group, 1, error));
    study_key_free(&key);
    return done;
}

int main(int argc, char **argv) {
    Error error = {0};
    if (argc != 4) {
        fputs("Usage: join_pieces FOLDER COUNT make|merge\n", stderr);
        return 2;
    }
    const bool merge = strcmp(argv[3], "merge") == 0;
    bool ok = true;
    for (int shard = merge ? 0 : 1; ok && shard <= (merge ? 0 : SHARDS); shard++)
        ok = run(argv[1], atoll(argv[2]), shard, &error);
    if (!ok) fprintf(stderr, "%s\n", error.message);
    return ok ? 0 : 3;
}

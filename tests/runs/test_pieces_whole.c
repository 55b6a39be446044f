/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces that write files beside their results: a piece counts as done only while its file is as the results say. */
#include "owned.h"

#include "base/file.h"
#include "runs/pieces.h"

enum { COUNT = 6, SHARDS = 2 };

typedef struct Files {
    const char *folder;
    int done[COUNT];
    bool fails;
} Files;

static void file_of(char path[PIECES_PATH_SIZE], const Files *files, int64_t piece) {
    snprintf(path, PIECES_PATH_SIZE, "%s/file-%d", files->folder, (int)piece);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "file %d", (int)piece);
    info->timed = true;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    Files *files = context;
    char path[PIECES_PATH_SIZE], text[16];
    (void)progress;
#pragma omp atomic
    files->done[piece]++;
    snprintf(text, sizeof text, "content %d", (int)piece);
    file_of(path, files, piece);
    fprintf(results, "%s", text);
    return file_write(path, text, strlen(text), error);
}

static bool whole(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error) {
    const Files *files = context;
    char path[PIECES_PATH_SIZE];
    size_t found;
    Error ignored = {0};
    file_of(path, files, piece);
    FREED char *text = file_read(path, 100, &found, &ignored);
    *there = text != NULL && found == size && memcmp(text, results, size) == 0;
    return !files->fails || error_system(error, path, "cannot be read");
}

static char *arguments[] = {(char[]){"twinbox files"}, (char[]){"--seed"}};

/* shard 0: a merge. */
static bool run_study(Files *files, Pieces *pieces, PiecePlan *plan, int shard, Error *error) {
    StudyKey key;
    const PiecesRun run = {.request = {.shard = {shard, SHARDS}}, .merge = shard == 0, .argc = 2, .argv = arguments};
    *plan = (PiecePlan){.count = COUNT, .describe = describe, .work = work, .whole = whole, .context = files};
    const bool ok = study_key_begin(&key, error) && pieces_open(pieces, files->folder, &key, &run, error) &&
                    pieces_do(pieces, plan, NULL, error);
    study_key_free(&key);
    return ok;
}

static void change(const Files *files, int piece, const char *text) {
    Error error = {0};
    char path[PIECES_PATH_SIZE];
    file_of(path, files, piece);
    if (text == NULL)
        assert_int_equal(unlink(path), 0);
    else
        assert_ok(file_write(path, text, strlen(text), &error), error);
}

TEST(a_piece_whose_file_is_gone_or_altered_is_missing_and_done_again) {
    const char *folder = printed("%s", temporary_path("files"));
    Files files = {.folder = folder};
    Pieces pieces;
    PiecePlan plan;
    for (int shard = 1; shard <= SHARDS; shard++) assert_ok(run_study(&files, &pieces, &plan, shard, &error), error);
    assert_ok(run_study(&files, &pieces, &plan, 0, &error), error);
    change(&files, 1, NULL);
    change(&files, 4, "content 5");
    assert_false(run_study(&files, &pieces, &plan, 0, &error));
    assert_error(error, ERROR_INCOMPLETE, "2 of 6 pieces are missing: file 1, file 4; run their shards (of 2) again");
    error = (Error){0};
    for (int shard = 1; shard <= SHARDS; shard++) {
        int64_t open = 0;
        for (int i = 1; i <= 4; i += 3) open += shard_of(i, COUNT, SHARDS) == shard;
        assert_ok(run_study(&files, &pieces, &plan, shard, &error), error);
        assert_int_equal(pieces.own - pieces.kept, open);
    }
    for (int i = 0; i < COUNT; i++) assert_int_equal(files.done[i], i == 1 || i == 4 ? 2 : 1);
    assert_ok(run_study(&files, &pieces, &plan, 0, &error), error);
    /* A disk that fails is not a piece that is missing. */
    files.fails = true;
    for (int shard = 0; shard <= SHARDS; shard++) {
        error = (Error){0};
        assert_false(run_study(&files, &pieces, &plan, shard, &error));
        assert_error(error, ERROR_SYSTEM, "cannot be read");
    }
}

TEST(a_piece_is_found_with_its_processor) {
    char folder[300], cpu[CPU_NAME_SIZE], own[CPU_NAME_SIZE];
    snprintf(folder, sizeof folder, "%s", temporary_path("found"));
    Files files = {.folder = folder};
    Pieces pieces;
    PiecePlan plan;
    bool done;
    cpu_name(own);
    assert_ok(run_study(&files, &pieces, &plan, 1, &error), error);
    for (int i = 0; i < COUNT; i++) {
        const bool mine = shard_of(i, COUNT, SHARDS) == 1;
        assert_ok(pieces_find(&pieces, i, &done, cpu, &error), error);
        assert_true(done == mine);
        assert_string_equal(cpu, mine ? own : "");
        if (!mine) continue;
        change(&files, i, "other");
        assert_ok(pieces_find(&pieces, i, &done, cpu, &error), error);
        assert_false(done);
        assert_string_equal(cpu, "");
    }
}

RUN_TESTS(NULL, NULL)

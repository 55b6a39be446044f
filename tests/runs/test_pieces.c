/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study whose pieces are numbers, each with a file beside its results: whole, stopped, in shards, damaged. */
#include "owned.h"

#include "base/file.h"
#include "runs/pieces.h"

enum { COUNT = 23, NEEDED = 2 };

typedef struct Study {
    int done[COUNT];            /* how often each piece was done */
    int alone_from, timed_from; /* pieces from there on; the former need piece NEEDED */
    bool fails;                 /* what the disk does */
    const char *folder;
    Pieces pieces;
    PiecePlan plan;
} Study;

static void file_of(char path[PIECES_PATH_SIZE], const Study *study, int64_t piece) {
    snprintf(path, PIECES_PATH_SIZE, "%s/file-%d", study->folder, (int)piece);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const Study *study = context;
    snprintf(info->name, sizeof info->name, "number-%d", (int)piece);
    info->weight = 1;
    info->alone = piece >= study->alone_from;
    info->timed = piece >= study->timed_from;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    Study *study = context;
    char path[PIECES_PATH_SIZE], text[16];
#pragma omp atomic
    study->done[piece]++;
    snprintf(text, sizeof text, "%d\n", (int)(piece * piece));
    fputs(text, results);
    file_of(path, study, piece);
    if (!file_make_directory(study->folder, error) || !file_write(path, text, strlen(text), error)) return false;
    return progress_report(progress, 1, 2) || error_interrupted(error, "work", "stopped");
}

static bool ready(void *context, int64_t piece) {
    const Study *study = context;
    Error error = {0};
    bool done = true;
    return piece < study->alone_from || piece == NEEDED || (pieces_find(&study->pieces, NEEDED, &done, &error) && done);
}

static bool whole(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error) {
    const Study *study = context;
    char path[PIECES_PATH_SIZE];
    size_t found;
    file_of(path, study, piece);
    FREED char *text = file_read(path, 100, &found, &(Error){0});
    *there = text != NULL && found == size && memcmp(text, results, size) == 0;
    return !study->fails || error_system(error, path, "cannot be read");
}

static Study new_study(const char *name) {
    return (Study){.alone_from = COUNT, .timed_from = COUNT, .folder = printed("%s", temporary_path(name))};
}

static bool run_study(Study *study, Shard shard, uint64_t seed, const Progress *progress, Error *error) {
    StudyKey key;
    memset(study->done, 0, sizeof study->done);
    study->plan = (PiecePlan){
        .count = COUNT, .describe = describe, .work = work, .ready = ready, .whole = whole, .context = study};
    if (!study_key_begin(&key, error)) return false;
    study_key_add(&key, &seed, sizeof seed);
    return pieces_open(&study->pieces, study->folder, &key, &shard, error) &&
           pieces_do(&study->pieces, &study->plan, progress, error);
}

static void assert_results(const Study *study) {
    for (int64_t i = 0; i < COUNT; i++) {
        Error error = {0};
        char cpu[CPU_NAME_SIZE], own[CPU_NAME_SIZE];
        size_t size;
        FREED char *text = pieces_read(&study->pieces, i, &size, cpu, &error);
        assert_ok(text != NULL, error);
        assert_int_equal(atoi(text), i * i);
        assert_int_equal(size, strlen(text));
        cpu_name(own);
        assert_string_equal(cpu, i >= study->timed_from ? own : "");
    }
}

static const Shard all = {0};

TEST(a_whole_study_does_every_piece_once_and_leaves_nothing) {
    Study study = new_study("whole");
    assert_ok(run_study(&study, all, 1, NULL, &error), error);
    for (int i = 0; i < COUNT; i++) assert_int_equal(study.done[i], 1);
    assert_int_equal(study.pieces.own, COUNT);
    assert_results(&study);
    assert_ok(pieces_end(&study.pieces, &error), error);
    assert_int_equal(access(study.pieces.folder, F_OK), -1);
}

TEST(shards_do_every_nth_piece_and_the_study_the_rest) {
    Study study = new_study("shards");
    study.timed_from = 18;
    study.alone_from = 16;
    for (int shard = 4; shard >= 2; shard--) { /* the first, which has piece NEEDED = 2, is the third of four */
        assert_ok(run_study(&study, (Shard){shard, 4}, 1, NULL, &error), error);
        for (int i = 0; i < COUNT; i++) {
            const bool possible = i < study.alone_from || (i < study.timed_from && shard == 2);
            assert_int_equal(study.done[i], i % 4 == shard - 1 && possible);
        }
        assert_true(study.pieces.left > 0);
    }
    assert_ok(run_study(&study, (Shard){2, 4}, 1, NULL, &error), error); /* again */
    for (int i = 0; i < COUNT; i++) assert_int_equal(study.done[i], 0);
    assert_ok(run_study(&study, all, 9, NULL, &error), error); /* another study, whose pieces are its own */
    for (int i = 0; i < COUNT; i++) assert_int_equal(study.done[i], 1);
    assert_ok(run_study(&study, all, 1, NULL, &error), error);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(study.done[i], i % 4 == 0 || i >= study.timed_from || (i >= study.alone_from && i % 4 != 1));
    assert_results(&study);
}

static bool stop_after(void *context, double done, double total) {
    (void)total;
    return done < *(const double *)context;
}

TEST(a_stopped_shard_continues) {
    Study study = new_study("stopped");
    double most = 3.2;
    study.alone_from = 0; /* one at a time */
    assert_false(run_study(&study, (Shard){3, 4}, 1, &(Progress){stop_after, &most}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped; finished pieces are kept");
    error = (Error){0};
    assert_ok(run_study(&study, (Shard){3, 4}, 1, NULL, &error), error);
    assert_int_equal(study.pieces.kept, 3);
    assert_int_equal(study.pieces.own, 6);
}

TEST(a_piece_whose_file_is_gone_or_altered_is_done_again) {
    Study study = new_study("files");
    char path[PIECES_PATH_SIZE];
    assert_ok(run_study(&study, all, 1, NULL, &error), error);
    file_of(path, &study, 1);
    assert_int_equal(unlink(path), 0);
    file_of(path, &study, 4);
    assert_ok(file_write(path, "17\n", 3, &error), error);
    assert_ok(run_study(&study, all, 1, NULL, &error), error);
    for (int i = 0; i < COUNT; i++) assert_int_equal(study.done[i], i == 1 || i == 4);
    /* A disk that fails is not a piece that is missing. */
    study.fails = true;
    assert_false(run_study(&study, all, 1, NULL, &error));
    assert_error(error, ERROR_SYSTEM, "cannot be read");
}

TEST(a_damaged_piece_is_refused_by_name) {
    static const struct {
        size_t cut;
        const char *from, *to, *message;
    } rows[] = {{1, "", "", "is damaged or cut off"},
                {0, "25\n", "26\n", "is damaged or cut off"},
                {0, "number 5", "number 6", "is damaged or cut off"},
                {0, "name number-5", "name number-6", "is the piece 'number-6', not 'number-5'"},
                {0, "key ", "key 0", "is a piece of another study"},
                {0, "twinbox piece 1", "twinbox pieces", "is not a piece of a study"}};
    Study study = new_study("damaged");
    char path[PIECES_PATH_SIZE];
    size_t size;
    assert_ok(run_study(&study, all, 1, NULL, &error) && pieces_path(&study.pieces, 5, path, &error), error);
    FREED char *text = file_read(path, 1000, &size, &error);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *at = strstr(text, rows[i].from);
        const size_t before = (size_t)(at - text);
        FREED char *other = malloc(size + 20);
        const int length = sprintf(other, "%.*s%s%s", (int)before, text, rows[i].to, at + strlen(rows[i].from));
        error = (Error){0};
        assert_ok(file_write(path, other, (size_t)length - rows[i].cut, &error), error);
        assert_refused(run_study(&study, all, 1, NULL, &error), rows[i].message);
        for (int k = 0; k < COUNT; k++) assert_int_equal(study.done[k], 0);
    }
}

RUN_TESTS(NULL, NULL)

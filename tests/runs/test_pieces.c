/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study whose pieces are numbers: done whole, in shards, cut off, merged, and with damaged files. */
#include "owned.h"

#include "base/file.h"
#include "runs/pieces.h"

enum { COUNT = 23 };

typedef struct Numbers {
    int done[COUNT]; /* how often each piece was done */
    int alone_from;  /* these are done alone */
    int needs;       /* those done alone need this piece; -1: no other */
    bool timed;
    const Pieces *pieces;
} Numbers;

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const Numbers *numbers = context;
    snprintf(info->name, sizeof info->name, "number-%d", (int)piece);
    info->weight = 1;
    info->alone = piece >= numbers->alone_from;
    info->timed = numbers->timed;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    Numbers *numbers = context;
    (void)error;
#pragma omp atomic
    numbers->done[piece]++;
    fprintf(results, "%d\n", (int)(piece * piece));
    return progress_report(progress, 1, 2) || error_interrupted(error, "work", "stopped");
}

static bool ready(void *context, int64_t piece) {
    const Numbers *numbers = context;
    char path[PIECES_PATH_SIZE];
    Error error = {0};
    bool there;
    return piece < numbers->alone_from || numbers->needs < 0 ||
           (pieces_path(numbers->pieces, numbers->needs, path, &error) && file_find(path, &there, &error) && there);
}

static char *arguments[] = {(char[]){"twinbox numbers"}, (char[]){"--seed"}, (char[]){"1"}};

typedef struct Study {
    Numbers numbers;
    Pieces pieces;
    PiecePlan plan;
    char *missing;
} Study;

/* shard 0: the whole; -1: a merge. */
static bool run_study(Study *study, const char *folder, int shard, int count, uint64_t seed, const Progress *progress,
                      Error *error) {
    StudyKey key;
    const PiecesRun run = {.request = {.shard = {shard > 0 ? shard : 1, count}},
                           .merge = shard < 0,
                           .argc = 3,
                           .argv = arguments,
                           .shards = &study->missing};
    study->plan =
        (PiecePlan){.count = COUNT, .describe = describe, .work = work, .ready = ready, .context = &study->numbers};
    study->numbers.pieces = &study->pieces;
    bool ok = study_key_begin(&key, error);
    study_key_add(&key, &seed, sizeof seed);
    ok = ok && pieces_open(&study->pieces, folder, &key, shard == 0 ? NULL : &run, error) &&
         pieces_do(&study->pieces, &study->plan, progress, error);
    study_key_free(&key);
    return ok;
}

static Study new_study(void) { return (Study){.numbers = {.alone_from = COUNT, .needs = -1}}; }

static const char *folder_of(const char *name) {
    static char folder[300];
    snprintf(folder, sizeof folder, "%s", temporary_path(name));
    return folder;
}

static void assert_results(const Study *study) {
    for (int64_t i = 0; i < COUNT; i++) {
        Error error = {0};
        size_t size;
        FREED char *text = pieces_read(&study->pieces, i, &size, NULL, &error);
        assert_ok(text != NULL, error);
        assert_int_equal(atoi(text), i * i);
        assert_int_equal(size, strlen(text));
    }
}

TEST(a_whole_study_does_every_piece_once_and_leaves_nothing) {
    const char *folder = folder_of("whole");
    Study study = new_study();
    assert_ok(run_study(&study, folder, 0, 1, 1, NULL, &error), error);
    for (int i = 0; i < COUNT; i++) assert_int_equal(study.numbers.done[i], 1);
    assert_int_equal(study.pieces.own, COUNT);
    assert_results(&study);
    assert_ok(pieces_end(&study.pieces, &error), error);
    assert_int_equal(access(study.pieces.folder, F_OK), -1);
}

TEST(shards_share_the_pieces_and_are_merged) {
    const char *folder = folder_of("shards");
    int done[COUNT] = {0};
    for (int shard = 1; shard <= 4; shard++) {
        Study study = new_study(), merge = new_study();
        error = (Error){0};
        assert_false(run_study(&merge, folder, -1, 1, 1, NULL, &error));
        if (shard > 1) assert_error(error, ERROR_INCOMPLETE, shard == 4 ? "--array=4" : "-4");
        free(merge.missing);
        error = (Error){0};
        assert_ok(run_study(&study, folder, shard, 4, 1, NULL, &error), error);
        assert_int_equal(study.pieces.mode, PIECES_SHARD);
        for (int i = 0; i < COUNT; i++) done[i] += study.numbers.done[i];
        assert_ok(pieces_end(&study.pieces, &error), error);
    }
    for (int i = 0; i < COUNT; i++) assert_int_equal(done[i], 1);
    for (int again = 0; again < 2; again++) {
        Study merge = new_study();
        assert_ok(run_study(&merge, folder, -1, 1, 1, NULL, &error), error);
        for (int i = 0; i < COUNT; i++) assert_int_equal(merge.numbers.done[i], 0);
        assert_results(&merge);
        assert_ok(pieces_end(&merge.pieces, &error), error);
    }
    /* Nothing is left to do for a shard that is started again. */
    Study again = new_study();
    assert_ok(run_study(&again, folder, 2, 4, 1, NULL, &error), error);
    assert_int_equal(again.pieces.kept, again.pieces.own);
    for (int i = 0; i < COUNT; i++) assert_int_equal(again.numbers.done[i], 0);
}

static bool stop_after(void *context, double done, double total) {
    (void)total;
    return done < *(const double *)context;
}

TEST(a_stopped_shard_continues) {
    const char *folder = folder_of("stopped");
    int done[COUNT] = {0};
    double most = 3.2;
    Study first = new_study(), second = new_study();
    first.numbers.alone_from = 0; /* one at a time */
    assert_false(run_study(&first, folder, 1, 2, 1, &(Progress){stop_after, &most}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped; finished pieces are kept");
    error = (Error){0};
    second.numbers.alone_from = 0;
    assert_ok(run_study(&second, folder, 1, 2, 1, NULL, &error), error);
    assert_int_equal(second.pieces.kept, 3);
    for (int i = 0; i < COUNT; i++) done[i] = first.numbers.done[i] + second.numbers.done[i];
    for (int i = 0; i < COUNT; i++) assert_true(done[i] <= 2 && (done[i] > 0) == (shard_of(i, COUNT, 2) == 1));
}

TEST(a_piece_waits_for_those_that_it_needs) {
    const char *folder = folder_of("waiting");
    const int needed = 2, shard = shard_of(needed, COUNT, 2), other = 3 - shard;
    for (int round = 0; round < 2; round++) {
        Study study = new_study();
        study.numbers.alone_from = COUNT - 4;
        study.numbers.needs = needed;
        assert_ok(run_study(&study, folder, other, 2, 1, NULL, &error), error);
        assert_true((study.pieces.waiting > 0) == (round == 0));
        study = new_study();
        study.numbers.alone_from = COUNT - 4;
        study.numbers.needs = needed;
        assert_ok(run_study(&study, folder, shard, 2, 1, NULL, &error), error);
        assert_int_equal(study.pieces.waiting, 0);
    }
    Study merge = new_study();
    assert_ok(run_study(&merge, folder, -1, 1, 1, NULL, &error), error);
}

TEST(what_differs_is_refused) {
    const char *folder = folder_of("differs");
    Study study = new_study();
    assert_ok(run_study(&study, folder, 1, 2, 1, NULL, &error), error);
    static const struct {
        int shard, count;
        uint64_t seed;
        const char *message;
    } rows[] = {{2, 3, 1, "the study was begun in 2 shards, and this is one of 3"},
                {2, 2, 9, "shards of another study: the hash of options and inputs is "},
                {-1, 1, 9, "shards of another study: the hash of options and inputs is "},
                {0, 1, 1, "belongs to shards of a study: merge them (twinbox merge "},
                {1, 1, 1, "belongs to shards of a study"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Study other = new_study();
        assert_refused(run_study(&other, folder, rows[i].shard, rows[i].count, rows[i].seed, NULL, &error),
                       rows[i].message);
        for (int k = 0; k < COUNT; k++) assert_int_equal(other.numbers.done[k], 0);
    }
}

/* Puts another processor's name into a piece, as another machine would have written it. */
static void measure_elsewhere(const Study *study, int64_t piece) {
    Error error = {0};
    char path[PIECES_PATH_SIZE];
    PieceHead head;
    size_t size;
    FREED char *results = pieces_read(&study->pieces, piece, &size, NULL, &error);
    assert_ok(results != NULL && pieces_path(&study->pieces, piece, path, &error), error);
    pieces_head(&study->pieces, piece, &head);
    snprintf(head.cpu, sizeof head.cpu, "another processor");
    assert_ok(piece_file_write(path, &head, results, size, &error), error);
}

TEST(times_of_two_processors_are_not_mixed) {
    const char *folder = folder_of("processors");
    for (int shard = 1; shard <= 2; shard++) {
        Study study = new_study();
        study.numbers.timed = true;
        assert_ok(run_study(&study, folder, shard, 2, 1, NULL, &error), error);
        if (shard == shard_of(5, COUNT, 2)) measure_elsewhere(&study, 5);
    }
    Study merge = new_study();
    merge.numbers.timed = true;
    assert_refused(run_study(&merge, folder, -1, 1, 1, NULL, &error), "times were measured on different processors");
    assert_true(merge.pieces.cpus_differ);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Datasets in pieces: the file is that of a dataset in memory, for any targets and views; damaged pieces are refused. */
#include "testing.h"
#include "files.h"

#include "learning/dataset.h"
#include "in_shards.h"

static const char *const both[] = {SOURCE_DIR "/scenes/single.yaml", SOURCE_DIR "/scenes/stack.yaml"};

static DatasetOptions options_for(DatasetOptions options) {
    options.scenes = both;
    options.scene_count = 2;
    options.seed = 3;
    assert_true(parse_range("-5:5:2", 10, &options.bomb_x));
    return options;
}

static void assert_equal_files(const char *path, const char *other) {
    size_t sizes[2];
    char *one = read_whole(path, &sizes[0]), *two = read_whole(other, &sizes[1]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(one, two, sizes[0]);
    free(one);
    free(two);
}

static void same_file(DatasetOptions options, const char *name) {
    Error error = {0};
    DatasetPieces pieces;
    Pieces done;
    int64_t rows, unconverged;
    const char *merged = temporary_path(name), *whole = temporary_path("whole.npz");
    Dataset *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    assert_ok(dataset_write(dataset, whole, &error), error);
    assert_ok(dataset_pieces_make(&pieces, &options, &error), error);
    assert_in_range(pieces.plan.count, 2, 2 * 6);
    in_shards(&done, &pieces.plan, merged, 3);
    assert_ok(dataset_pieces_write(&pieces, &done, merged, &rows, &unconverged, NULL, &error), error);
    assert_int_equal(rows, dataset->rows);
    assert_int_equal(unconverged, dataset->unconverged);
    assert_equal_files(merged, whole);
    pieces_close(&done);
    dataset_pieces_free(&pieces);
    dataset_destroy(dataset);
}

TEST(pieces_give_the_file_of_memory) {
    same_file(options_for((DatasetOptions){.target = TARGET_PAIR, .context = true}), "pair.npz");
    same_file(options_for((DatasetOptions){.target = TARGET_PAIR, .every = 7}), "every.npz");
    same_file(options_for((DatasetOptions){.target = TARGET_NET, .view = PAIR_RAW, .labels = DATASET_BY_REFERENCE}),
              "net.npz");
    same_file(options_for((DatasetOptions){.target = TARGET_IMPULSE, .view = PAIR_CONTACT}), "impulse.npz");
    same_file(options_for((DatasetOptions){.target = TARGET_POINTS, .view = PAIR_NEIGHBOURS, .random = 2}),
              "points.npz");
}

static bool stop(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

TEST(a_merge_that_is_stopped_writes_nothing) {
    DatasetPieces pieces;
    Pieces done;
    int64_t rows, unconverged;
    bool there;
    const DatasetOptions options = options_for((DatasetOptions){.target = TARGET_PAIR});
    const char *path = temporary_path("stopped.npz");
    assert_ok(dataset_pieces_make(&pieces, &options, &error), error);
    in_shards(&done, &pieces.plan, path, 2);
    assert_false(dataset_pieces_write(&pieces, &done, path, &rows, &unconverged, &(Progress){stop, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped; finished pieces are kept");
    assert_true(file_find(path, &there, &error) && !there);
    pieces_close(&done);
    dataset_pieces_free(&pieces);
}

/* Rows of other launches, half a row, and less than the count of steps. */
TEST(damaged_rows_are_refused) {
    DatasetPieces pieces;
    const DatasetOptions options = options_for((DatasetOptions){.target = TARGET_PAIR});
    assert_ok(dataset_pieces_make(&pieces, &options, &error), error);
    int64_t first, end;
    piece_ranges_find(&pieces.launches, 0, &first, &end);
    enum { LAUNCH = PAIR_INPUTS + PAIR_CHANGES, ROW = LAUNCH + 1 + 1 + 2 };
    struct {
        int64_t unconverged;
        int32_t row[ROW];
    } piece = {.unconverged = 7};
    const struct {
        int64_t launch;
        size_t size;
        int64_t rows;
    } cases[] = {{first, sizeof piece, 1},
                 {end - 1, sizeof piece, 1},
                 {end, sizeof piece, -1},
                 {first - 1, sizeof piece, -1},
                 {first, sizeof piece - 1, -1},
                 {first, sizeof piece.unconverged, 0},
                 {first, 7, -1},
                 {first, 0, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        error = (Error){0};
        int64_t unconverged;
        piece.row[LAUNCH] = (int32_t)cases[i].launch;
        assert_int_equal(
            dataset_piece_rows(&pieces, 0, (const char *)&piece, cases[i].size, &unconverged, "piece", &error),
            cases[i].rows);
        if (cases[i].rows >= 0) assert_int_equal(unconverged, 7);
        if (cases[i].rows < 0) assert_error(error, ERROR_INPUT, "piece: error: does not have the rows of the launches");
    }
    dataset_pieces_free(&pieces);
}

RUN_TESTS(NULL, NULL)

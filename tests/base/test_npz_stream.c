/* SPDX-License-Identifier: GPL-3.0-or-later */
/* .npz whose arrays grow: the same bytes as those of whole arrays, however the rows come; large arrays come back, and
   are deflated only where that pays; nothing is left of a stream that is not finished. */
#include "made.h"

#include "files.h"

#include <sys/stat.h>

enum { ROWS = 1500000, SMALL = 1000 };

static uint32_t *noise;
static uint32_t *zeros;

static int make_numbers(void **state) {
    (void)state;
    noise = calloc(2 * ROWS, sizeof *noise);
    zeros = calloc(2 * ROWS, sizeof *zeros);
    if (noise == NULL || zeros == NULL) return -1;
    uint64_t seed = 1;
    /* Half of the floats cannot be deflated, half are equal: blocks of both kinds in one array. */
    for (int i = 0; i < ROWS; i++) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        noise[i] = (uint32_t)(seed >> 33);
    }
    return 0;
}

FIXTURE(free_numbers) {
    free(noise);
    free(zeros);
}

static size_t file_size(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

/* Rows in pieces of rising size, from 0 on. */
static void append_in_pieces(NpzStream *stream, int array, const void *data, size_t row_size, int64_t rows) {
    Error error = {0};
    int64_t piece = 0;
    for (int64_t at = 0; at < rows; at += piece, piece = 2 * piece + 1) {
        if (piece > rows - at) piece = rows - at;
        assert_ok(npz_stream_append(stream, array, (const char *)data + (size_t)at * row_size, piece, &error), error);
    }
}

TEST(rows_give_the_bytes_of_the_whole) {
    const NpzArray whole[] = {
        {"noise", NPZ_FLOAT32, 2, {ROWS, 2}, noise},    {"zeros", NPZ_INT32, 2, {ROWS, 2}, zeros},
        {"small", NPZ_FLOAT32, 1, {SMALL}, noise},      {"none", NPZ_INT64, 1, {0}, noise},
        {"scalar", NPZ_UINT64, 0, {0}, noise},          {"name", NPZ_TEXT, 0, {0}, "z\xc3\xa4h"},
        {"mebibyte", NPZ_UINT8, 1, {NPZ_LARGE}, noise}, {"less", NPZ_UINT8, 1, {NPZ_LARGE - 1}, noise},
        {"more", NPZ_UINT8, 1, {NPZ_LARGE + 1}, zeros},
    };
    enum { ARRAYS = sizeof whole / sizeof *whole };
    static const size_t row_size[ARRAYS] = {8, 8, 4, 8, 0, 0, 1, 1, 1};
    const char *expected = temporary_path("whole.npz"), *path = temporary_path("rows.npz");
    assert_ok(npz_write(expected, whole, ARRAYS, &error), error);
    NpzStream *stream = npz_stream_create(path, ARRAYS, &error);
    assert_ok(stream != NULL, error);
    for (int i = 0; i < ARRAYS; i++) {
        NpzArray growing = whole[i];
        if (row_size[i] > 0) {
            growing.data = NULL;
            growing.shape[0] = 0;
        }
        assert_int_equal(npz_stream_add(stream, &growing, &error), i);
    }
    for (int i = 0; i < ARRAYS; i++) append_in_pieces(stream, i, whole[i].data, row_size[i], whole[i].shape[0]);
    assert_ok(npz_stream_finish(stream, &error), error);
    npz_stream_destroy(stream);
    assert_same_file(path, expected);

    OWN(NpzFile) *file = npz_of(path);
    for (int i = 0; i < ARRAYS; i++) {
        if (row_size[i] == 0) continue;
        FREED void *read = npz_read(file, whole[i].name, whole[i].type, whole[i].rank, whole[i].shape, &error);
        assert_ok(read != NULL, error);
        assert_memory_equal(read, whole[i].data, (size_t)whole[i].shape[0] * row_size[i]);
    }
}

TEST(blocks_are_deflated_where_that_pays) {
    const char *path = temporary_path("blocks.npz");
    const size_t half = ROWS * sizeof *noise;
    const NpzArray arrays[] = {{"both", NPZ_FLOAT32, 1, {2 * ROWS}, noise},
                               {"zeros", NPZ_FLOAT32, 1, {2 * ROWS}, zeros}};
    assert_ok(npz_write(path, &arrays[0], 1, &error), error);
    assert_in_range(file_size(path), half, half + half / 50);
    assert_ok(npz_write(path, &arrays[1], 1, &error), error);
    assert_in_range(file_size(path), 1, half / 50);
}

TEST(an_unfinished_stream_leaves_nothing) {
    const char *folder = printed("%s", temporary_path("unfinished"));
    assert_int_equal(mkdir(folder, 0777), 0);
    NpzStream *stream = npz_stream_create(printed("%s/run.npz", folder), 1, &error);
    assert_ok(stream != NULL, error);
    const int array = npz_stream_add(stream, &(NpzArray){"noise", NPZ_UINT32, 1, {0}, NULL}, &error);
    assert_ok(npz_stream_append(stream, array, noise, 2 * ROWS, &error), error);
    assert_int_equal(count_files(folder, ""), 0); /* so a program that is killed leaves nothing either */
    npz_stream_destroy(stream);
    assert_int_equal(count_files(folder, ""), 0);
    assert_null(npz_stream_create(temporary_path("nowhere/run.npz"), 1, &error));
    assert_error(error, ERROR_SYSTEM, "nowhere/run.npz: error: cannot write: ");
}

RUN_TESTS(make_numbers, free_numbers)

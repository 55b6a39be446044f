/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are larger than a piece: they give what whole files give, and a change of a file never looks like
   success. */
#include "owned.h"

#include "base/file.h"
#include "base/hash.h"
#include "pixels/png.h"

enum { WIDTH = 600, HEIGHT = 400 }; /* of noise: three pieces */

/* The rows from `changed` on differ by 1 from those of another number. */
static Image *noise(int changed) {
    Image *image = image_create(WIDTH, HEIGHT, &(Error){0});
    uint32_t seed = 1;
    assert_non_null(image);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++) {
        seed = seed * 1664525 + 1013904223;
        image->pixels[i] = i % 4 == 3 ? 255 : (uint8_t)((seed >> 24) ^ (i / 4 / WIDTH >= (size_t)changed));
    }
    return image;
}

static const char *write_noise(const char *name, int changed) {
    static char paths[4][PATH_MAX];
    static int turn;
    char *path = paths[turn++ % 4];
    Error error = {0};
    OWN(Image) *image = noise(changed);
    snprintf(path, PATH_MAX, "%s", temporary_path(name));
    assert_ok(image_write_png(image, path, &(ImageText){"key", "value"}, 1, &error), error);
    return path;
}

static void open_both(PngFile files[2], const char *a, const char *b) {
    Error error = {0};
    assert_ok(png_file_open(&files[0], a, IMAGE_MAX_PIXELS, &error), error);
    assert_ok(png_file_open(&files[1], b, IMAGE_MAX_PIXELS, &error), error);
    assert_true(files[0].rows != NULL && files[1].rows != NULL);
}

static void close_both(PngFile files[2]) {
    png_file_close(&files[0]);
    png_file_close(&files[1]);
}

typedef struct Rows {
    uint8_t row[2][4 * WIDTH];
    const Image *wanted[2];
    int differing;
} Rows;

static bool begin(void *context, int width, int height) {
    return context != NULL && width == WIDTH && height == HEIGHT;
}

static uint8_t *place(void *context, int side, int y) {
    (void)y;
    return ((Rows *)context)->row[side];
}

static void take(void *context, int y, const uint8_t *a, const uint8_t *b) {
    Rows *rows = context;
    const size_t at = (size_t)y * sizeof rows->row[0];
    assert_memory_equal(a, rows->wanted[0]->pixels + at, sizeof rows->row[0]);
    assert_memory_equal(b, rows->wanted[1]->pixels + at, sizeof rows->row[0]);
    rows->differing += a != b;
}

static bool scan(PngFile files[2], int changed, bool threads, int *differing) {
    OWN(Image) *a = noise(HEIGHT), *b = noise(changed);
    Rows rows = {.wanted = {a, b}};
    const RowSink sink = {begin, place, take, &rows, ROWS_ALL};
    const bool ok = png_files_scan(files, threads, &sink);
    *differing = rows.differing;
    return ok;
}

/* Equal up to a row: there, the files part. */
TEST(pieces_give_the_rows_of_whole_files) {
    static const int changes[] = {0, 1, 150, 399, HEIGHT};
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        PngFile files[2];
        int differing;
        open_both(files, write_noise("a.png", HEIGHT), write_noise("b.png", changes[i]));
        assert_int_equal(png_files_are_same(files), changes[i] == HEIGHT);
        assert_true(scan(files, changes[i], i % 2 == 0, &differing));
        assert_int_equal(differing, HEIGHT - changes[i]);
        close_both(files);
    }
}

TEST(hash_and_texts_are_those_of_the_file) {
    PngFile files[2];
    size_t size;
    char value[8];
    const char *path = write_noise("a.png", HEIGHT);
    FREED uint8_t *data = image_load_png(path, &size, &error);
    open_both(files, path, path);
    assert_true(size > 700000 && files[0].size < 200 && files[0].hash == hash_xxh3(data, size));
    assert_ok(image_find_text(files[0].data, files[0].size, "key", value, sizeof value, &error), error);
    assert_string_equal(value, "value");
    assert_ok(png_file_load(&files[0], &error), error);
    assert_int_equal(files[0].size, size);
    assert_memory_equal(files[0].data, data, size);
    close_both(files);
}

/* Replaces what the open file has, not its name. */
static void overwrite(const char *path, const void *data, size_t size) {
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(ftruncate(fileno(file), (off_t)size), 0);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* The open file gets another byte in its text, which leaves its pixels as they are, or bytes behind it, or less. */
static void check_change(uint8_t mask, int more) {
    PngFile files[2];
    Error error = {0};
    size_t size;
    int differing;
    const char *a = write_noise("a.png", HEIGHT), *b = write_noise("b.png", 200);
    FREED uint8_t *data = (uint8_t *)file_read(b, 1 << 24, &size, &error), *longer = calloc(size + 8, 1);
    memcpy(longer, data, size);
    for (size_t at = 0; at < 200; at++)
        if (memcmp(data + at, "value", 5) == 0) longer[at] ^= mask;
    open_both(files, a, b);
    overwrite(b, longer, (size_t)((long)size + more));
    assert_false(scan(files, 200, false, &differing));
    assert_true(files[1].damaged && !files[0].damaged);
    assert_refused(png_file_load(&files[1], &error), "changed while it was compared");
    close_both(files);
}

TEST(a_file_that_changes_is_no_success) {
    check_change(1, 0);
    check_change(0, 8);
    check_change(0, -8);
}

RUN_TESTS(NULL, NULL)

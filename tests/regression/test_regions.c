/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions against a flood fill, and on the pictures that make most of them. */
#include "testing.h"

#include "regression/image_compare.h"

#include <math.h>

static uint64_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 6364136223846793005U + 1442695040888963407U;
    return (uint32_t)(random_state >> 33);
}

static int any_below(int count) { return (int)(random_bits() % (uint32_t)count); }

typedef struct Pair {
    Image *a, *b;
} Pair;

static Pair make_pair(int width, int height) {
    Error error = {0};
    Pair pair = {image_create(width, height, &error), image_create(width, height, &error)};
    assert_ok(pair.a != NULL && pair.b != NULL, error);
    return pair;
}

static void free_pair(Pair *pair) {
    image_destroy(pair->a);
    image_destroy(pair->b);
}

static void change(const Pair *pair, int x, int y) {
    pair->b->pixels[4 * ((size_t)y * (size_t)pair->b->width + (size_t)x) + 1] = 9;
}

static ImageRegions regions_of(const Pair *pair, const uint8_t *masked) {
    Error error = {0};
    ImageDifference difference;
    ImageRegions regions;
    image_compare_masked(pair->a, pair->b, masked, 0, &difference);
    assert_ok(image_regions_find(pair->a, pair->b, masked, &difference, &regions, &error), error);
    return regions;
}

static void assert_region(const ImageRegion *region, int64_t pixels, int left, int top, int right, int bottom) {
    assert_int_equal(region->pixels, pixels);
    assert_int_equal(region->left, left);
    assert_int_equal(region->top, top);
    assert_int_equal(region->right, right);
    assert_int_equal(region->bottom, bottom);
}

TEST(neighbours_within_the_gap_are_one_region) {
    Pair pair = make_pair(64, 48); /* gap 4 */
    change(&pair, 10, 10);
    change(&pair, 14, 14);
    change(&pair, 40, 10);
    change(&pair, 45, 10);
    ImageRegions regions = regions_of(&pair, NULL);
    assert_int_equal(regions.count, 3);
    assert_region(&regions.list[0], 2, 10, 10, 15, 15);
    assert_int_equal(regions.list[0].largest, 9);
    assert_region(&regions.list[1], 1, 40, 10, 41, 11);
    assert_region(&regions.list[2], 1, 45, 10, 46, 11);
    uint8_t masked[64 * 48] = {[14 * 64 + 14] = 1};
    regions = regions_of(&pair, masked);
    assert_int_equal(regions.count, 3);
    assert_region(&regions.list[0], 1, 10, 10, 11, 11);
    free_pair(&pair);
}

/* Its two arms meet in the last row. */
TEST(arms_that_meet_below_are_one_region) {
    Pair pair = make_pair(64, 48);
    for (int y = 5; y < 30; y++) change(&pair, 10, y), change(&pair, 40, y);
    assert_int_equal(regions_of(&pair, NULL).count, 2);
    for (int x = 10; x < 40; x++) change(&pair, x, 29);
    ImageRegions regions = regions_of(&pair, NULL);
    assert_int_equal(regions.count, 1);
    assert_region(&regions.list[0], 25 + 25 + 29, 10, 5, 41, 30);
    free_pair(&pair);
}

TEST(equal_pictures_have_none) {
    Pair pair = make_pair(5, 3);
    assert_int_equal(regions_of(&pair, NULL).count, 0);
    assert_int_equal(regions_of(&pair, NULL).kept, 0);
    free_pair(&pair);
}

/* Marks the region of a pixel and returns its number of pixels. */
static int64_t flood(uint8_t *differs, int width, int height, int start, int gap) {
    int *stack = malloc((size_t)width * (size_t)height * sizeof *stack), depth = 0;
    int64_t pixels = 0;
    assert_non_null(stack);
    stack[depth++] = start;
    differs[start] = 0;
    while (depth > 0) {
        int at = stack[--depth];
        pixels++;
        for (int y = at / width - gap; y <= at / width + gap; y++)
            for (int x = at % width - gap; x <= at % width + gap; x++) {
                if (x < 0 || y < 0 || x >= width || y >= height || differs[y * width + x] == 0) continue;
                differs[y * width + x] = 0;
                stack[depth++] = y * width + x;
            }
    }
    free(stack);
    return pixels;
}

static int descending(const void *a, const void *b) {
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x < y) - (x > y);
}

/* One pixel in `rarity` differs. */
static void compare_with_flood_fill(int width, int height, uint32_t rarity) {
    Pair pair = make_pair(width, height);
    uint8_t *differs = calloc((size_t)width * (size_t)height, 1);
    int64_t *sizes = calloc((size_t)width * (size_t)height + 1, sizeof *sizes), count = 0;
    assert_true(differs != NULL && sizes != NULL);
    for (int i = 0; i < width * height; i++)
        if (random_bits() % rarity == 0) differs[i] = 1, change(&pair, i % width, i / width);
    ImageRegions regions = regions_of(&pair, NULL);
    for (int i = 0; i < width * height; i++)
        if (differs[i] != 0) sizes[count++] = flood(differs, width, height, i, REGION_GAP);
    qsort(sizes, (size_t)count, sizeof *sizes, descending);
    assert_int_equal(regions.count, count);
    assert_int_equal(regions.kept, count < IMAGE_REGIONS_MAX ? count : IMAGE_REGIONS_MAX);
    for (int i = 0; i < regions.kept; i++) assert_int_equal(regions.list[i].pixels, sizes[i]);
    free(differs);
    free(sizes);
    free_pair(&pair);
}

TEST(regions_are_those_of_a_flood_fill) {
    static const uint32_t rarities[] = {1, 5, 30, 60, 90, 200, 1000};
    for (size_t i = 0; i < sizeof rarities / sizeof rarities[0]; i++)
        for (int repeat = 0; repeat < 4; repeat++) {
            compare_with_flood_fill(120, 90, rarities[i]);
            compare_with_flood_fill(1, 200, rarities[i]);
            compare_with_flood_fill(300, 2, rarities[i]);
            compare_with_flood_fill(7, 7, rarities[i]);
        }
}

/* As many regions as possible: single pixels just too far apart. */
TEST(a_grid_of_pixels_is_counted) {
    Pair pair = make_pair(1000, 500);
    for (int y = 0; y < 500; y += 5)
        for (int x = 0; x < 1000; x += 5) change(&pair, x, y);
    ImageRegions regions = regions_of(&pair, NULL);
    assert_int_equal(regions.count, 200 * 100);
    assert_int_equal(regions.kept, IMAGE_REGIONS_MAX);
    assert_region(&regions.list[1], 1, 5, 0, 6, 1);
    free_pair(&pair);
}

/* A disc with smooth edges on a pattern, by its place. */
static void draw_disc(const Image *image, double x, double y) {
    for (int i = 0; i < image->width * image->height; i++) {
        const double far = hypot(i % image->width + 0.5 - x, i / image->width + 0.5 - y); /* NOLINT: whole numbers */
        const double share = fmin(fmax(12.5 - far, 0), 1);
        const int ground = i / image->width < 20 ? 230 : 250;
        const uint8_t alpha = i % image->width < 40 ? 255 : 200;
        const uint8_t value = (uint8_t)(ground + share * (40 - ground));
        memcpy(image->pixels + 4 * i, (const uint8_t[]){value, value, (uint8_t)ground, alpha}, 4);
    }
}

/* What row by row is found without rows that are far from differences is what whole pictures have: counts, regions,
   largest differences, edges. Of a disc that moved by a fraction of a pixel, all are edges; by two pixels, few. */
TEST(rows_give_what_whole_pictures_give) {
    static const double moves[] = {0.3, 2, 0, 9};
    for (int i = 0; i < 24; i++) {
        Pair pair = make_pair(90 + i % 5, 60 + i);
        draw_disc(pair.a, 45, 30);
        draw_disc(pair.b, 45 + moves[i % 4], 30);
        for (int k = 0; k < i % 4 * i; k++) /* some of them in the first and the last row */
            change(&pair, any_below(pair.b->width),
                   k % 2 == 0 ? any_below(pair.b->height) : k % 3 * (pair.b->height - 1) / 2);
        ImageDifference difference;
        RowCompare rows;
        const ImageRegions whole = regions_of(&pair, NULL);
        const size_t bytes = 4 * (size_t)pair.a->width;
        image_compare_masked(pair.a, pair.b, NULL, 3, &difference);
        assert_true(row_compare_begin(&rows, pair.a->width, pair.a->height, 3, NULL));
        for (int y = 0; y < pair.a->height; y++) {
            bool near = false;
            for (int at = y - ROWS_AROUND; at <= y + ROWS_AROUND && !near; at++)
                near = at >= 0 && at < pair.a->height &&
                       memcmp(pair.a->pixels + bytes * (size_t)at, pair.b->pixels + bytes * (size_t)at, bytes) != 0;
            const uint8_t *a = pair.a->pixels + bytes * (size_t)y, *b = pair.b->pixels + bytes * (size_t)y;
            const bool differs = memcmp(a, b, bytes) != 0;
            if (!near) continue;
            memcpy(edge_rows_place(&rows.sides[0], y), a, bytes);
            if (differs) memcpy(edge_rows_place(&rows.sides[1], y), b, bytes);
            row_compare_row(&rows, y, differs);
        }
        assert_true(row_compare_end(&rows));
        assert_memory_equal(&rows.difference, &difference, sizeof difference);
        assert_memory_equal(&rows.regions, &whole, sizeof whole);
        if (i % 4 == 0) assert_true(whole.edges == difference.pixels && difference.pixels > 20);
        if (i == 1) assert_true(whole.edges < difference.pixels / 2);
        row_compare_free(&rows);
        free_pair(&pair);
    }
}

RUN_TESTS(NULL, NULL)

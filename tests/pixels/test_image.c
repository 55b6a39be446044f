/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison and hash of synthetic pictures. */
#include "made.h"

#include "regression/image_compare.h"

static Image *a, *b;

FIXTURE(make) {
    a = image_sized(4, 3);
    b = image_sized(4, 3);
}

FIXTURE(destroy) {
    image_destroy(a);
    image_destroy(b);
}

static uint8_t *channel(Image *image, int x, int y, int c) { return &image->pixels[(y * image->width + x) * 4 + c]; }

TEST_WITH(equal_pictures_have_no_difference, make, destroy) {
    ImageDifference d;
    *channel(a, 1, 1, 2) = *channel(b, 1, 1, 2) = 9;
    image_compare_masked(a, b, NULL, 0, &d);
    assert_true(d.equal && d.same_size);
    assert_true(d.pixels == 0 && d.largest == 0 && d.first_x == -1 && d.first_y == -1);
    assert_true(image_hash(a) == image_hash(b));
}

TEST_WITH(differences_are_counted_by_pixel, make, destroy) {
    ImageDifference d;
    *channel(a, 3, 1, 0) = 5;
    *channel(a, 3, 1, 1) = 20;
    *channel(b, 0, 2, 3) = 200;
    image_compare_masked(a, b, NULL, 0, &d);
    assert_false(d.equal);
    assert_true(d.same_size);
    assert_int_equal(d.pixels, 2);
    assert_int_equal(d.largest, 200);
    assert_int_equal(d.first_x, 3);
    assert_int_equal(d.first_y, 1);
}

TEST_WITH(one_bit_changes_the_hash, make, destroy) {
    *channel(a, 3, 2, 3) = 1;
    assert_true(image_hash(a) != image_hash(b));
}

TEST_WITH(the_shape_counts, make, destroy) {
    ImageDifference d;
    OWN(Image) *turned = image_sized(3, 4);
    image_compare_masked(a, turned, NULL, 0, &d);
    assert_false(d.equal);
    assert_false(d.same_size);
    assert_true(image_hash(a) != image_hash(turned));
}

/* Only rows flagged as changed are read. */
TEST_WITH(the_hash_of_a_sequence_is_that_of_its_pictures, make, destroy) {
    uint64_t rows[3];
    assert_true(image_hash_next(a, NULL, rows) == image_hash(a));
    *channel(a, 1, 0, 0) = 7;
    *channel(a, 2, 2, 1) = 8;
    assert_true(image_hash_next(a, (const bool[]){true, false, true}, rows) == image_hash(a));
    uint64_t before = image_hash(a);
    *channel(a, 0, 1, 2) = 9;
    assert_true(image_hash_next(a, (const bool[]){true, false, true}, rows) == before);
    assert_true(image_hash_next(a, NULL, rows) == image_hash(a));
}

TEST_WITH(rows_that_change_places_change_the_hash, make, destroy) {
    *channel(a, 1, 0, 0) = 7;
    *channel(b, 1, 1, 0) = 7;
    assert_true(image_hash(a) != image_hash(b));
}

RUN_TESTS(NULL, NULL)

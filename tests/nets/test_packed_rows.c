/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "engine/uniform.h"
#include "nets/kernels.h"

#include <float.h>

enum { COUNT = 40, WIDTH = 48 };

static float unpacked(const PackedRows *packed, int row, int column) {
    return packed->units[row] * (float)packed->numbers[row * packed->width + column];
}

/* Rows of many sizes. */
static void fill_rows(float *rows, uint32_t *seed) {
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < WIDTH; k++) rows[i * WIDTH + k] = ldexpf(uniform(seed, -1, 1), 4 * (i - COUNT / 2));
}

/* The caller frees its units, which begin the block. */
static PackedRows pack(const float *rows, int count, int width) {
    void *block = malloc(packed_rows_bytes(count, width));
    assert_non_null(block);
    PackedRows packed = packed_rows_in(block, count, width);
    packed_rows_fill(&packed, rows);
    return packed;
}

/* Of the row's largest number, which stays itself. */
TEST(a_number_moves_by_half_a_step_at_most) {
    static float rows[COUNT * WIDTH];
    uint32_t seed = 1;
    fill_rows(rows, &seed);
    const PackedRows packed = pack(rows, COUNT, WIDTH);
    for (int i = 0; i < COUNT; i++) {
        float most = 0, farthest = 0;
        for (int k = 0; k < WIDTH; k++) {
            most = fmaxf(most, fabsf(rows[i * WIDTH + k]));
            farthest = fmaxf(farthest, fabsf(unpacked(&packed, i, k) - rows[i * WIDTH + k]));
        }
        assert_true(packed.units[i] == most / 127);
        assert_true(farthest <= packed.units[i] * 0.5001f);
        assert_true(farthest > packed.units[i] * 0.25f); /* else nothing would have been rounded */
    }
    free(packed.units);
}

TEST(what_is_packed_already_stays) {
    static float rows[COUNT * WIDTH];
    uint32_t seed = 2;
    fill_rows(rows, &seed);
    const PackedRows first = pack(rows, COUNT, WIDTH);
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < WIDTH; k++) rows[i * WIDTH + k] = unpacked(&first, i, k);
    const PackedRows second = pack(rows, COUNT, WIDTH);
    assert_memory_equal(first.numbers, second.numbers, COUNT * WIDTH);
    free(first.units);
    free(second.units);
}

/* Nothing at all, next to nothing, and the largest there is. */
TEST(the_ends_of_the_range_are_met) {
    const float rows[4 * 2] = {0, -0.0f, FLT_TRUE_MIN, -FLT_MIN, FLT_MAX, -FLT_MAX, 1, 127};
    const PackedRows packed = pack(rows, 4, 2);
    const int8_t expected[4 * 2] = {0, 0, 0, 0, 127, -127, 1, 127};
    assert_memory_equal(packed.numbers, expected, sizeof expected);
    assert_true(packed.units[0] == 0 && packed.units[1] == 0 && packed.units[2] == FLT_MAX / 127);
    assert_true(packed.units[3] == 1);
    free(packed.units);
}

RUN_TESTS(NULL, NULL)

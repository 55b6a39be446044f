/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain kernels are the loops that RowKernels tells of, and those of every instruction set have their bits.
   Arrays have the size that they need and no number more, so that the sanitizers see a step beyond them; they begin at
   no multiple of a register's size. */
#include "testing.h"

#include "engine/uniform.h"
#include "nets/nets.h"
#include "nets/kernels.h"

enum { PAIRS = 6, ROWS = 2 * PAIRS, COUNTS = 5, LARGEST = 11 };

static const int widths[] = {16, 32, 48, 128, 144}, counts[COUNTS] = {0, 1, 2, 7, LARGEST};

/* Falls and rises, and has some twice; all below PAIRS. */
static const int32_t some[LARGEST] = {5, 0, 3, 3, 1, 4, 0, 2, 5, 1, 3};

/* Numbers of many sizes, zeros of both signs among them: no two orders of a sum have the same bits for long. */
static float any_number(uint32_t *seed) {
    const float kind = uniform(seed, 0, 1), number = uniform(seed, -1, 1);
    if (kind < 0.1f) return kind < 0.05f ? 0.0f : -0.0f;
    return kind < 0.5f ? 100 * number : number;
}

/* Begins one number behind what malloc() gives. */
static float *numbers_of(int count, uint32_t *seed) {
    float *block = malloc(((size_t)count + 1) * sizeof *block);
    assert_non_null(block);
    for (int i = 0; i <= count; i++) block[i] = any_number(seed);
    return block + 1;
}

static float *copy_of(const float *numbers, int count) {
    float *block = malloc(((size_t)count + 1) * sizeof *block);
    assert_non_null(block);
    memcpy(block + 1, numbers, (size_t)count * sizeof *block);
    return block + 1;
}

static void drop(float *numbers) { free(numbers - 1); }

/* Bytes and units of all sizes; the bytes begin behind what malloc() gives, too. */
static PackedRows rows_of(int count, int width, uint32_t *seed) {
    const size_t size = (size_t)count * (size_t)width;
    int8_t *bytes = malloc(size + 1);
    assert_non_null(bytes);
    for (size_t i = 0; i <= size; i++) bytes[i] = (int8_t)uniform(seed, -127.9f, 127.9f);
    return (PackedRows){count, width, bytes + 1, numbers_of(count, seed)};
}

static void drop_rows(PackedRows *rows) {
    free(rows->numbers - 1);
    drop(rows->units);
}

static void assert_bits(const float *found, const float *expected, int count, const Kernels *kernels, const char *what,
                        int width) {
    for (int i = 0; i < count; i++)
        if (memcmp(&found[i], &expected[i], sizeof *found) != 0)
            fail_msg("%s %s, width %d: number %d is %a, not %a", kernels->name, what, width, i, (double)found[i],
                     (double)expected[i]);
}

static int row_at(const int32_t *index, int i) { return index != NULL ? index[i] : i; }

static float byte_at(const PackedRows *rows, int row, int column) { return rows->numbers[row * rows->width + column]; }

static void add(float *sums, const PackedRows *rows, const int32_t *index, const float *numbers, int count) {
    for (int c = 0; c < rows->width; c++) {
        float four[4] = {sums[c]};
        for (int i = 0; i < count; i++) {
            const int row = row_at(index, i);
            const float number = numbers[i] * rows->units[row];
            four[i % 4] += number * byte_at(rows, row, c);
        }
        sums[c] = (four[0] + four[1]) + (four[2] + four[3]);
    }
}

static float product(const PackedRows *rows, int row, const float *vector) {
    float sums[ROW_LANES] = {0};
    for (int c = 0; c < rows->width; c++) sums[c % ROW_LANES] += byte_at(rows, row, c) * vector[c];
    for (int half = ROW_LANES / 2; half > 0; half /= 2)
        for (int l = 0; l < half; l++) sums[l] += sums[l + half];
    return rows->units[row] * sums[0];
}

static void multiply(float *products, const PackedRows *rows, const int32_t *index, const float *vector, int count) {
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) products[2 * i + k] = product(rows, 2 * row_at(index, i) + k, vector);
}

static void spread(float *rows, int width, const int32_t *index, const float *numbers, const float *vector, int count) {
    for (int i = 0; i < count; i++)
        for (int c = 0; c < width; c++) rows[index[i] * width + c] += numbers[i] * vector[c];
}

static void check_add(const Kernels *kernels, int width, const int32_t *index, int count, uint32_t *seed) {
    PackedRows rows = rows_of(ROWS, width, seed);
    float *numbers = numbers_of(count, seed), *found = numbers_of(width, seed), *expected = copy_of(found, width);
    kernels->rows.add(found, &rows, index, numbers, count);
    add(expected, &rows, index, numbers, count);
    assert_bits(found, expected, width, kernels, "add", width);
    drop_rows(&rows), drop(numbers), drop(found), drop(expected);
}

/* As `add`, of floats: in four sums. */
static void combine(float *sums, const float *rows, int width, const float *numbers, int count) {
    for (int c = 0; c < width; c++) {
        float held[4] = {sums[c]};
        for (int i = 0; i < count; i++) held[i % 4] += numbers[i] * rows[i * width + c];
        sums[c] = (held[0] + held[1]) + (held[2] + held[3]);
    }
}

static void check_combine(const Kernels *kernels, int width, const int32_t *index, int count, uint32_t *seed) {
    (void)index;
    float *rows = numbers_of(count * width, seed), *numbers = numbers_of(count, seed), *found = numbers_of(width, seed),
          *expected = copy_of(found, width);
    kernels->rows.combine(found, rows, width, numbers, count);
    combine(expected, rows, width, numbers, count);
    assert_bits(found, expected, width, kernels, "combine", width);
    drop(rows), drop(numbers), drop(found), drop(expected);
}

static void check_multiply(const Kernels *kernels, int width, const int32_t *index, int count, uint32_t *seed) {
    if (index == NULL && count > PAIRS) count = PAIRS;
    PackedRows rows = rows_of(ROWS, width, seed);
    float *vector = numbers_of(width, seed), *found = numbers_of(2 * count, seed),
          *expected = numbers_of(2 * count, seed);
    kernels->rows.multiply(found, &rows, index, vector, count);
    multiply(expected, &rows, index, vector, count);
    assert_bits(found, expected, 2 * count, kernels, "multiply", width);
    drop_rows(&rows), drop(vector), drop(found), drop(expected);
}

static void check_spread(const Kernels *kernels, int width, const int32_t *index, int count, uint32_t *seed) {
    float *found = numbers_of(PAIRS * width, seed), *expected = copy_of(found, PAIRS * width),
          *numbers = numbers_of(count, seed), *vector = numbers_of(width, seed);
    kernels->rows.spread(found, width, index, numbers, vector, count);
    spread(expected, width, index, numbers, vector, count);
    assert_bits(found, expected, PAIRS * width, kernels, "spread", width);
    drop(found), drop(expected), drop(numbers), drop(vector);
}

/* Every kernel, width and count. */
static void for_all(void (*check)(const Kernels *kernels, int width, const int32_t *index, int count, uint32_t *seed),
                    const int32_t *index) {
    const Kernels *list[KERNELS_MAX + 1];
    uint32_t seed = 1;
    kernels_list(list);
    for (int k = 0; list[k] != NULL; k++)
        for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++)
            for (int c = 0; c < COUNTS; c++) check(list[k], widths[w], index, counts[c], &seed);
}

TEST(rows_are_added_in_four_sums) {
    for_all(check_add, some);
    for_all(check_add, NULL);
}

TEST(floats_are_added_in_four_sums) { for_all(check_combine, NULL); }

TEST(rows_are_multiplied_in_lanes_and_halves) {
    for_all(check_multiply, some);
    for_all(check_multiply, NULL);
}

TEST(a_vector_is_spread_over_rows) { for_all(check_spread, some); }

TEST(every_number_is_bent) {
    const Kernels *list[KERNELS_MAX + 1];
    uint32_t seed = 2;
    kernels_list(list);
    for (int k = 0; list[k] != NULL; k++)
        for (int count = 0; count < 70; count++) {
            float *found = numbers_of(count, &seed), *expected = copy_of(found, count);
            list[k]->rows.apply_tanh(found, count);
            for (int i = 0; i < count; i++) expected[i] = tanh_float(expected[i]);
            assert_bits(found, expected, count, list[k], "apply_tanh", count);
            drop(found), drop(expected);
        }
}

/* Widest first, plain last, which any processor has. */
TEST(the_best_is_the_first) {
    const Kernels *list[KERNELS_MAX + 1];
    int count = 0;
    kernels_list(list);
    while (list[count] != NULL) count++;
    assert_in_range(count, 1, KERNELS_MAX);
    assert_ptr_equal(list[count - 1], &kernels_scalar);
    assert_ptr_equal(kernels_best(), list[0]);
}

RUN_TESTS(NULL, NULL)

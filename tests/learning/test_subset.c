/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "learning/dataset.h"

enum { LAUNCHES = 20, ROWS = 400 };

/* Launch of row r: (7 r) mod 19, so launch 19 has no rows; 3, 8, 13 and 18 are held out. Numbers tell row and
   column. */
static Dataset *make_dataset(bool context) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    assert_non_null(dataset);
    assert_true(dataset_make_launches(dataset, LAUNCHES) && dataset_make_rows(dataset, ROWS, context));
    for (int r = 0; r < ROWS; r++) {
        dataset->launch[r] = 7 * r % 19;
        dataset->frame[r] = r;
        dataset->bodies[2 * r] = r, dataset->bodies[2 * r + 1] = r + 1;
        for (int k = 0; k < PAIR_INPUTS; k++) dataset->inputs[r * PAIR_INPUTS + k] = (float)(100 * r + k);
        for (int k = 0; k < PAIR_CHANGES; k++) dataset->changes[r * PAIR_CHANGES + k] = (float)(-100 * r - k);
        for (int k = 0; context && k < PAIR_CONTEXT; k++) dataset->context[r * PAIR_CONTEXT + k] = (float)(r - k);
    }
    for (int i = 0; i < LAUNCHES; i++) {
        dataset->launch_x[i] = (float)i;
        dataset->launch_test[i] = i % 5 == 3;
    }
    return dataset;
}

/* Every row of the subset is that row of the whole; returns which launches it has. */
static unsigned check_rows(const Dataset *subset) {
    unsigned found = 0;
    int last = -1;
    for (int64_t r = 0; r < subset->rows; r++) {
        const int from = subset->frame[r];
        assert_true(from > last && subset->launch[r] == 7 * from % 19);
        assert_true(subset->bodies[2 * r] == from && subset->bodies[2 * r + 1] == from + 1);
        for (int k = 0; k < PAIR_INPUTS; k++)
            assert_true(subset->inputs[r * PAIR_INPUTS + k] == (float)(100 * from + k));
        for (int k = 0; k < PAIR_CHANGES; k++)
            assert_true(subset->changes[r * PAIR_CHANGES + k] == (float)(-100 * from - k));
        for (int k = 0; subset->context != NULL && k < PAIR_CONTEXT; k++)
            assert_true(subset->context[r * PAIR_CONTEXT + k] == (float)(from - k));
        found |= 1u << subset->launch[r];
        last = from;
    }
    return found;
}

static const unsigned held_out = 1u << 3 | 1u << 8 | 1u << 13 | 1u << 18;

TEST(a_subset_has_the_rows_of_its_launches) {
    for (int context = 0; context < 2; context++) {
        OWN(Dataset) *dataset = make_dataset(context == 1);
        const bool keep[LAUNCHES] = {[0] = true, [8] = true, [17] = true, [19] = true};
        OWN(Dataset) *subset = dataset_subset(dataset, keep, &error);
        assert_ok(subset != NULL, error);
        assert_true((subset->context != NULL) == (context == 1));
        assert_int_equal(check_rows(subset), held_out | 1u << 0 | 1u << 17);
        int64_t rows = 0;
        for (int r = 0; r < ROWS; r++) {
            const int launch = dataset->launch[r];
            rows += keep[launch] || dataset->launch_test[launch];
        }
        assert_true(subset->rows == rows && subset->launches == LAUNCHES);
        assert_memory_equal(subset->launch_x, dataset->launch_x, LAUNCHES * sizeof(float));
        assert_memory_equal(subset->launch_test, dataset->launch_test, LAUNCHES);
    }
}

static int count_bits(unsigned bits) {
    int count = 0;
    for (; bits != 0; bits &= bits - 1) count++;
    return count;
}

/* More launches contain fewer; another seed draws others; 19 launches have rows, 4 of them held out. */
TEST(launches_are_drawn_by_the_seed) {
    OWN(Dataset) *dataset = make_dataset(false);
    unsigned last = held_out, first_of_seed[3];
    for (int count = 1; count <= 15; count++) {
        OWN(Dataset) *subset = dataset_draw_subset(dataset, count, 5, &error);
        assert_ok(subset != NULL, error);
        const unsigned found = check_rows(subset);
        assert_true((found & last) == last && count_bits(found) == count + 4);
        last = found;
    }
    for (uint64_t seed = 0; seed < 3; seed++) {
        OWN(Dataset) *subset = dataset_draw_subset(dataset, 5, seed + 1, &error);
        assert_ok(subset != NULL, error);
        first_of_seed[seed] = check_rows(subset);
    }
    assert_true(first_of_seed[0] != first_of_seed[1] && first_of_seed[1] != first_of_seed[2]);
}

TEST(what_would_leave_nothing_is_refused) {
    OWN(Dataset) *dataset = make_dataset(false);
    assert_refused(dataset_subset(dataset, (const bool[LAUNCHES]){[3] = true, [19] = true}, &error),
                   "no rows are left to train on");
    for (int count = -1; count <= 16; count += count == 0 ? 16 : 1) {
        assert_refused(dataset_draw_subset(dataset, count, 1, &error), "training launches requested; expected 1 to 15");
    }
}

RUN_TESTS(NULL, NULL)

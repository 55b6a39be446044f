/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "dataset/dataset_thin.h"

enum { ROWS = 8 };

/* Row r holds r in every place; of 8 rows every third is 0, 3, 6. */
static void every_third_row_stays_whole(void **state) {
    (void)state;
    Dataset dataset = {.rows = ROWS, .target = TARGET_POINTS, .view = PAIR_CONTACT};
    enum { IN = 20, OUT = PAIR_POINT_CHANGES };
    float inputs[ROWS * IN], changes[ROWS * OUT];
    int32_t launch[ROWS], frame[ROWS], bodies[2 * ROWS];
    for (int i = 0; i < ROWS * IN; i++) inputs[i] = (float)(i / IN);
    for (int i = 0; i < ROWS * OUT; i++) changes[i] = (float)(i / OUT);
    for (int r = 0; r < ROWS; r++) launch[r] = frame[r] = bodies[2 * r] = bodies[2 * r + 1] = r;
    dataset.inputs = inputs, dataset.changes = changes;
    dataset.launch = launch, dataset.frame = frame, dataset.bodies = bodies;
    dataset_thin(&dataset, 3);
    assert_int_equal(dataset.rows, 3);
    for (int r = 0; r < 3; r++) {
        for (int i = 0; i < IN; i++) assert_near(inputs[r * IN + i], 3 * r, 0);
        for (int i = 0; i < OUT; i++) assert_near(changes[r * OUT + i], 3 * r, 0);
        assert_int_equal(launch[r], 3 * r);
        assert_int_equal(frame[r], 3 * r);
        assert_int_equal(bodies[2 * r] + bodies[2 * r + 1], 6 * r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_third_row_stays_whole)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include <float.h>

static void assert_refused(const Dataset *dataset, TrainingOptions options, const char *text) {
    Error error = {0};
    assert_null(training_run(dataset, &options, NULL, &error));
    assert_error(error, ERROR_INPUT, text);
}

static void what_cannot_be_trained_is_refused(void **state) {
    (void)state;
    Dataset *dataset = make_taught_dataset(100);
    TrainingOptions options = small("magic", 1);
    assert_refused(dataset, options, "\"magic\"; known are adam, bfgs, lm");
    options = small("adam", -1);
    assert_refused(dataset, options, "iterations: error: -1");
    options = small("adam", 1);
    options.widths[0] = 9;
    assert_refused(dataset, options, "the first width is 9");
    options = small("adam", 1);
    options.widths[2] = 3;
    assert_refused(dataset, options, "the last width is 3");
    options = small("adam", 1);
    options.widths[1] = 0;
    assert_refused(dataset, options, "width 0");
    options = small("adam", 1);
    options.layers = 0;
    assert_refused(dataset, options, "0 layers");
    options = small("lm", 1);
    options.widths[1] = 20; /* 262 parameters, 80 rows of 2 */
    assert_refused(dataset, options, "160 numbers to fit with 262 weights");
    options.widths[1] = 200;
    assert_refused(dataset, options, "2602 weights; at most 2000");
    Error error = {0};
    Network *start = network_create(2, (const int[]){PAIR_INPUTS, 5, 2}, &error);
    assert_ok(start != NULL, error);
    options = small("adam", 0);
    options.start = start;
    assert_refused(dataset, options, "other widths");
    network_destroy(start);
    dataset->launch_test[4] = 0;
    assert_refused(dataset, small("adam", 1), "100 rows to train on and 0 to test on");
    dataset_destroy(dataset);
}

/* The change of b relative to a overflows float32. */
static void leaving_the_finite_numbers_is_an_error(void **state) {
    (void)state;
    Dataset *dataset = make_taught_dataset(100);
    dataset->changes[0] = -FLT_MAX, dataset->changes[3] = FLT_MAX;
    assert_refused(dataset, small("adam", 3), "iteration 0");
    assert_refused(dataset, small("bfgs", 3), "iteration 0");
    assert_refused(dataset, small("lm", 3), "iteration 0");
    dataset_destroy(dataset);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_cannot_be_trained_is_refused),
        cmocka_unit_test(leaving_the_finite_numbers_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

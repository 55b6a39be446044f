/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training_internal.h"

#include <float.h>

static void refuse(const Dataset *dataset, TrainingOptions options, const char *text) {
    Error error = {0};
    assert_refused(training_run(dataset, &options, NULL, &error), text);
}

/* What depends on the dataset or on a start network; the words of options: cli/refused. */
TEST(options_that_do_not_fit_are_refused) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    TrainingOptions options = small("lm", 1);
    options.widths[1] = 20;
    refuse(dataset, options, "as many target values as weights (got 160 and 262)"); /* 80 rows of 2 */
    options.widths[1] = 200;
    refuse(dataset, options, "at most 2000 weights (got 2602)");
    Network *start = network_sized(2, (const int[]){PAIR_INPUTS, 5, 2});
    options = small("adam", 0);
    options.start = start;
    refuse(dataset, options, "trained on other inputs");
    strcpy(start->inputs, pair_views[PAIR_RELATIVE].inputs);
    strcpy(start->target, "net");
    refuse(dataset, options, "trained for another target (net)");
    strcpy(start->target, "pair");
    refuse(dataset, options, "other widths");
    network_destroy(start);
    dataset->launch_test[4] = 0;
    refuse(dataset, small("adam", 1), "one training row and one test row (got 100 and 0)");
}

/* The change of b relative to a overflows float32. */
TEST(infinite_loss_is_an_error) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    dataset->changes[0] = -FLT_MAX, dataset->changes[3] = FLT_MAX;
    for (int i = 0; optimizers[i] != NULL; i++) refuse(dataset, small(optimizers[i]->name, 3), "iteration 0");
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network has its name only when it is whole, and its figures are numbers. */
#include "owned.h"

#include "paper/paper_internal.h"

static const PaperDataSize size = {.swept = "-2:2:1"};
static PaperNetwork network;
static PaperPlan plan = {.networks = &network, .network_count = 1};
static PaperPart part = {.index = 0, .seed = 1};

FIXTURE(begin) {
    assert_ok(paper_datasets_begin(&plan.datasets, SOURCE_DIR "/scenes", &size, 1, &error), error);
    network = paper_network(0);
    network.iterations = 20;
    strcpy(plan.networks_folder, temporary_path("."));
}

FIXTURE(end) { paper_datasets_free(&plan.datasets); }

static const char *network_path(void) { return temporary_path("baseline-1.npz"); }

typedef struct Limit {
    int reports, most;
} Limit;

static bool stop_after(void *context, double done, double total) {
    (void)done, (void)total;
    Limit *limit = context;
    return ++limit->reports <= limit->most;
}

/* Trains until the report after the first `most` stops it. */
static bool train(int most, Limit *limit, Error *error) {
    FREED char *lines = NULL;
    size_t used;
    FILE *out = open_memstream(&lines, &used);
    *limit = (Limit){.most = most};
    const Progress progress = {stop_after, limit};
    const bool done = paper_training_write(&plan, &part, out, &progress, error);
    assert_int_equal(fclose(out), 0);
    if (done) assert_null(strstr(lines, "nan"));
    return done;
}

TEST(a_training_that_is_stopped_leaves_no_network) {
    Limit limit;
    assert_ok(train(1 << 20, &limit, &error), error);
    assert_int_equal(access(network_path(), F_OK), 0);
    assert_int_equal(remove(network_path()), 0);
    const int all = limit.reports;
    assert_true(all >= 3);
    for (int most = 0; most < all; most += all / 3) {
        error = (Error){0};
        assert_false(train(most, &limit, &error));
        assert_int_not_equal(error.kind, ERROR_NONE);
        assert_int_not_equal(access(network_path(), F_OK), 0);
    }
}

TEST(lines_know_their_network) {
    FREED char *lines = NULL;
    size_t used;
    bool there;
    FILE *out = open_memstream(&lines, &used);
    assert_ok(paper_training_write(&plan, &part, out, NULL, &error), error);
    assert_int_equal(fclose(out), 0);
    assert_ok(paper_training_whole(&plan, &part, lines, &there, &error), error);
    assert_true(there);
    part.seed++;
    out = fopen("/dev/null", "w");
    assert_ok(paper_training_write(&plan, &part, out, NULL, &error), error);
    part.seed--;
    assert_int_equal(fclose(out), 0);
    assert_int_equal(rename(temporary_path("baseline-2.npz"), network_path()), 0);
    assert_ok(paper_training_whole(&plan, &part, lines, &there, &error), error);
    assert_false(there);
    assert_int_equal(remove(network_path()), 0);
    assert_ok(paper_training_whole(&plan, &part, lines, &there, &error), error);
    assert_false(there);
}

/* What the lines say is recomputed from the stored network, row by row, on another split than the recording's. */
TEST(errors_are_those_of_the_split_and_of_each_scene) {
    FREED char *lines = NULL;
    size_t used;
    SplitDataset split;
    part.seed = 3;
    FILE *out = open_memstream(&lines, &used);
    assert_ok(paper_training_write(&plan, &part, out, NULL, &error), error);
    assert_int_equal(fclose(out), 0);
    const Dataset *whole = paper_dataset(&plan.datasets, &network, &error);
    assert_ok(split_begin(&split, whole, part.seed, &error), error);
    assert_memory_not_equal(split.test, whole->launch_test, (size_t)whole->launches);
    OWN(Network) *trained = network_read(temporary_path("baseline-3.npz"), &error);
    assert_ok(trained != NULL, error);
    const Dataset *dataset = &split.dataset;
    double squares[2][3] = {{0}}, rows[3] = {0}, mean[2] = {0}, least[2] = {1e9, 1e9}, most[2] = {-1e9, -1e9};
    for (int pass = 0; pass < 2; pass++)
        for (int64_t row = 0; row < dataset->rows; row++) {
            const int kind = dataset_is_test(dataset, row) ? dataset->launch_scene[dataset->launch[row]] : 2;
            const float *changes = dataset->changes + row * PAIR_CHANGES;
            float output[2], scratch[2 * 64];
            network_predict(trained, dataset->inputs + row * PAIR_INPUTS, scratch, output);
            rows[kind] += pass;
            for (int k = 0; k < 2; k++) {
                const double y = (double)(changes[3 + k] - changes[k]), range = most[k] - least[k];
                if (pass == 0 && kind == 2) {
                    mean[k] += y;
                    least[k] = fmin(least[k], y);
                    most[k] = fmax(most[k], y);
                }
                squares[0][kind] += pass == 0 ? 0 : pow(((double)output[k] - y) / range, 2) / 2;
                squares[1][kind] += pass == 0 ? 0 : pow((mean[k] - y) / range, 2) / 2;
            }
            if (pass == 0 && row == dataset->rows - 1) {
                double trained_on = 0;
                for (int64_t i = 0; i < dataset->rows; i++) trained_on += !dataset_is_test(dataset, i);
                for (int k = 0; k < 2; k++) mean[k] /= trained_on;
            }
        }
    const char *numbers = strstr(lines, ",132,");
    assert_non_null(numbers);
    double test, train, constant, ratio, single, stack;
    assert_int_equal(sscanf(numbers, ",132,%lf,%lf,%lf,%lf,%lf,%lf", &test, &train, &constant, &ratio, &single, &stack),
                     6);
    const double held_out = rows[0] + rows[1], of_mean = squares[1][0] + squares[1][1];
    assert_near(test * held_out / (squares[0][0] + squares[0][1]), 1, 1e-4);
    assert_near(train * rows[2] / squares[0][2], 1, 1e-4);
    assert_near(constant * held_out / of_mean, 1, 1e-4);
    assert_near(ratio / ((squares[0][0] + squares[0][1]) / of_mean), 1, 1e-4);
    assert_near(single / (squares[0][0] / squares[1][0]), 1, 1e-4);
    assert_near(stack / (squares[0][1] / squares[1][1]), 1, 1e-4);
    split_free(&split);
    part.seed = 1;
}

RUN_TESTS(begin, end)

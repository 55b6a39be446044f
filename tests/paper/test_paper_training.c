/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network has its name only when it is whole, and its figures are numbers. */
#include "owned.h"

#include "paper/paper_internal.h"

static const PaperDataSize size = {.swept = "-2:2:1"};
static PaperNetwork network;
static PaperPlan plan = {.networks = &network, .network_count = 1};
static const PaperPart part = {.index = 0};

FIXTURE(begin) {
    assert_ok(paper_datasets_begin(&plan.datasets, SOURCE_DIR "/scenes", &size, 1, &error), error);
    network = paper_network(0);
    network.iterations = 20;
    strcpy(plan.networks_folder, temporary_path("."));
}

FIXTURE(end) { paper_datasets_free(&plan.datasets); }

static const char *network_path(void) { return temporary_path("baseline.npz"); }

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
    plan.datasets.seed++;
    out = fopen("/dev/null", "w");
    assert_ok(paper_training_write(&plan, &part, out, NULL, &error), error);
    plan.datasets.seed--;
    assert_int_equal(fclose(out), 0);
    assert_ok(paper_training_whole(&plan, &part, lines, &there, &error), error);
    assert_false(there);
    assert_int_equal(remove(network_path()), 0);
    assert_ok(paper_training_whole(&plan, &part, lines, &there, &error), error);
    assert_false(there);
}

RUN_TESTS(begin, end)

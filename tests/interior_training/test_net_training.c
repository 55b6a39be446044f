/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small complete trainings: the same bits for any number of threads and however often they are interrupted. */
#include "testing.h"

#include "interior_training/net_training.h"

#include <math.h>
#include <omp.h>
#include <unistd.h>

static NetTraining small_training(const char *state_path) {
    return (NetTraining){
        .scenes = 14, .rounds = 2, .epochs = 3, .seed = 4, .command = "small", .state_path = state_path};
}

static void note(void *context, const NetScore *score) { *(NetScore *)context = *score; }

static void same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    Error error = {0};
    InteriorNet nets[2];
    NetScore scores[2];
    const int threads = omp_get_max_threads();
    const char *path = temporary_path("threads.part");
    for (int i = 0; i < 2; i++) {
        NetTraining training = small_training(path);
        training.on_score = note;
        training.context = &scores[i];
        omp_set_num_threads(1 + i);
        assert_ok(net_training_run(&training, &nets[i], NULL, &error), error);
        assert_int_equal(unlink(path), 0);
    }
    omp_set_num_threads(threads);
    assert_memory_equal(nets[0].weights, nets[1].weights, sizeof nets[0].weights);
    assert_memory_equal(&scores[0], &scores[1], sizeof scores[0]);
    assert_int_equal(scores[0].round, 1);
    assert_true(scores[0].with.mean[3] != scores[0].without.mean[3]);
}

/* Stops at the given report. */
static bool stop_at(void *context, double done, double total) {
    (void)done, (void)total;
    return --*(int *)context > 0;
}

static void an_interrupted_training_ends_with_the_same_bits(void **state) {
    (void)state;
    Error error = {0};
    InteriorNet whole, parts;
    NetTraining training = small_training(temporary_path("whole.part"));
    assert_ok(net_training_run(&training, &whole, NULL, &error), error);
    const char *path = training.state_path = temporary_path("parts.part");
    int stops = 0;
    for (int reports = 20;; reports += 3, stops++) {
        int left = reports;
        Error failure = {0};
        const Progress progress = {stop_at, &left};
        const bool ok = net_training_run(&training, &parts, &progress, &failure);
        assert_int_equal(access(path, F_OK), 0);
        if (ok) break;
        assert_int_equal(failure.kind, ERROR_INTERRUPTED);
    }
    assert_in_range(stops, 4, 40);
    assert_memory_equal(whole.weights, parts.weights, sizeof whole.weights);
}

static void damaged_and_foreign_states(void **state) {
    (void)state;
    Error error = {0};
    NetState made = {.command = "other", .round = 1}, found = {.round = 0};
    const char *path = temporary_path("state.part");
    assert_ok(net_state_write(&made, path, &error), error);
    assert_false(net_state_read(&found, path, "mine", &error));
    assert_int_equal(error.kind, ERROR_NONE);
    assert_true(net_state_read(&found, path, "other", &error));
    assert_memory_equal(&found, &made, sizeof made);
    made.round = NET_ROUNDS_MAX;
    assert_ok(net_state_write(&made, path, &error), error);
    assert_refused(net_state_read(&found, path, "other", &error), "round 8");
    made.round = 0;
    made.weights[3] = NAN;
    assert_ok(net_state_write(&made, path, &(Error){0}), error);
    assert_refused(net_state_read(&found, path, "other", &error), "weights: number 3");
}

static void a_folder_that_does_not_exist_is_refused_before_any_work(void **state) {
    (void)state;
    Error error = {0};
    InteriorNet net;
    int left = 1; /* any report would stop it with another error */
    const Progress progress = {stop_at, &left};
    const NetTraining training = small_training("/nowhere/net.part");
    assert_false(net_training_run(&training, &net, &progress, &error));
    assert_error(error, ERROR_SYSTEM, "/nowhere/net.part");
    assert_int_equal(left, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits_for_any_number_of_threads),
                                       cmocka_unit_test(an_interrupted_training_ends_with_the_same_bits),
                                       cmocka_unit_test(damaged_and_foreign_states),
                                       cmocka_unit_test(a_folder_that_does_not_exist_is_refused_before_any_work)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

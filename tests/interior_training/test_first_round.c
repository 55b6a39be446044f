/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random scenes that shards have recorded: the problems are those that the training records itself, and damaged ones are
   refused. */
#include "testing.h"

#include "common/memory_stream.h"
#include "equal_problems.h"
#include "in_shards.h"
#include "interior_training/first_round.h"

/* More than a piece has. */
static const NetTraining training = {.scenes = 14, .rounds = 2, .epochs = 1, .seed = 4, .command = "small"};

static void assert_equal_recordings(const ImpactProblems *problems, const ImpactProblems *others) {
    assert_int_equal(problems->count, others->count);
    for (size_t i = 0; i < problems->count; i++) {
        const ImpactProblem *one = &problems->items[i], *two = &others->items[i];
        const size_t bodies = (size_t)one->problem.body_count;
        assert_int_equal(one->impact, two->impact);
        assert_equal_problems(&one->problem, &two->problem);
        assert_memory_equal(one->reference, two->reference, bodies * sizeof *one->reference);
    }
}

static void shards_record_what_the_training_runs(void **state) {
    (void)state;
    Error error = {0};
    FirstRound round;
    Pieces pieces;
    NetTraining reading = training;
    reading.recorded = &pieces;
    first_round_make(&round, &training);
    assert_int_equal(round.plan.count, 3); /* 3 and 14 scenes */
    in_shards(&pieces, &round.plan, temporary_path("net.npz"), 2);
    for (int set = 0; set < FIRST_SETS; set++) {
        ImpactProblems run = {0}, read = {0};
        assert_ok(first_round_take(&round, (FirstSet)set, &run, NULL, &error), error);
        round.training = &reading;
        assert_ok(first_round_take(&round, (FirstSet)set, &read, NULL, &error), error);
        round.training = &training;
        assert_in_range(run.count, 5, 10000);
        assert_equal_recordings(&read, &run);
        impact_problems_free(&run);
        impact_problems_free(&read);
    }
    pieces_close(&pieces);
}

static bool stop(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

/* The same network, and reading can be stopped. */
static void the_training_reads_them(void **state) {
    (void)state;
    Error error = {0};
    FirstRound round;
    Pieces pieces;
    InteriorNet nets[2];
    const char *path = temporary_path("state.part");
    first_round_make(&round, &training);
    in_shards(&pieces, &round.plan, temporary_path("read.npz"), 2);
    for (int i = 0; i < 2; i++) {
        NetTraining each = training;
        each.state_path = path;
        each.recorded = i == 0 ? NULL : &pieces;
        assert_ok(net_training_run(&each, &nets[i], NULL, &error), error);
        assert_int_equal(unlink(path), 0);
    }
    assert_memory_equal(nets[0].weights, nets[1].weights, sizeof nets[0].weights);
    ImpactProblems problems = {0};
    NetTraining reading = training;
    reading.recorded = &pieces;
    round.training = &reading;
    assert_false(first_round_take(&round, FIRST_TRAINED, &problems, &(Progress){stop, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "interior-net: error: stopped");
    impact_problems_free(&problems);
    pieces_close(&pieces);
}

static void damaged_problems_are_refused(void **state) {
    (void)state;
    ProblemBody bodies[2] = {{.size = {1, 1}}, {.size = {1, 1}, .inv_mass = 1}};
    ContactPoint contact = {.a = 0, .b = 1};
    ReferenceVelocity velocities[2] = {{1, 2, 3}, {4, 5, 6}};
    ImpactProblem item = {{2, 1, 1, 0.5f, bodies, &contact}, velocities, true};
    const ImpactProblems one = {&item, 1, 1};
    char *bytes = NULL;
    size_t size;
    FILE *out = memory_stream(&bytes, &size);
    assert_non_null(out);
    impact_problems_write(&one, out);
    assert_int_equal(fclose(out), 0);
    for (size_t cut = 1; cut <= size; cut++) {
        Error error = {0};
        ImpactProblems read = {0};
        char *copy = malloc(cut);
        assert_non_null(copy);
        memcpy(copy, bytes, cut);
        assert_int_equal(impact_problems_read(&read, copy, cut, "piece", &error), cut == size);
        if (cut < size) assert_error(error, ERROR_INPUT, "piece: error: has damaged results");
        if (cut == size) assert_equal_recordings(&read, &one);
        impact_problems_free(&read);
        free(copy);
    }
    Error error = {0};
    ImpactProblems read = {0};
    bytes[0] = 2; /* neither an impact nor none */
    assert_false(impact_problems_read(&read, bytes, size, "piece", &error));
    impact_problems_free(&read);
    free(bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shards_record_what_the_training_runs),
        cmocka_unit_test(the_training_reads_them),
        cmocka_unit_test(damaged_problems_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

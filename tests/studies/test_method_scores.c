/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scores of launches as bytes: what was written is read back and put together, and what is damaged is refused. */
#include "owned.h"

#include "base/file.h"
#include "studies/chart_table.h"
#include "studies/launch_scores.h"
#include "studies/rollout.h"

enum { METHODS = 3, LAUNCHES = 2 };

/* Of a launch, a method and a step: all different. */
static double error_of(int launch, int method, int protocol, int phase, int step) {
    return launch + 0.1 * method + 0.01 * protocol + 0.001 * phase + 10 * step;
}

/* The method 1 has no step after the impact. */
static int steps_of(int launch, int method, int phase) { return method == 1 && phase > 0 ? 0 : 2 + launch + phase; }

static LaunchScores make_scores(int launch, int method) {
    LaunchScores scores = {.unconverged = method,
                           .measures = {.penetration = {1, 2, 3}, .energy = {4, 5, NAN}, .drift = launch, .moved = 7}};
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            StepScores *steps = &scores.steps[protocol][phase];
            steps->count = steps_of(launch, method, phase);
            /* The method 2 has no impulses. */
            if (method < 2) steps->criteria = (CriteriaSum){launch + 1, 2, 10 * phase, steps->count / 2};
            steps->error = malloc((size_t)steps->count * sizeof(double) + 1);
            steps->share = malloc((size_t)steps->count * sizeof(double) + 1);
            assert_true(steps->error != NULL && steps->share != NULL);
            for (int i = 0; i < steps->count; i++) {
                steps->error[i] = error_of(launch, method, protocol, phase, i);
                steps->share[i] = 1.0 / (1 + i);
            }
        }
    return scores;
}

/* A launch without a measure does not count in its mean. */
TEST(means_are_over_launches_that_have_the_measure) {
    const RunMeasures measures[] = {{.energy = {4, 4, 4}, .drift = 3, .moved = NAN, .penetration = {1, 1, 1}},
                                    {.energy = {NAN, NAN, NAN}, .drift = 5, .moved = 7, .penetration = {2, 2, 0}}};
    ChartRow row = {.phase = PHASE_REST};
    scene_row_measures(&row, measures, 2);
    assert_true(row.energy == 4 && row.drift == 4 && row.moved == 7 && row.penetration_max == 1);
}

static char *write_launch(int launch, size_t *size) {
    LaunchScores scores[METHODS];
    char *bytes = NULL;
    FILE *stream = memory_stream(&bytes, size);
    assert_non_null(stream);
    for (int i = 0; i < METHODS; i++) scores[i] = make_scores(launch, i);
    LaunchSteps steps = {.unconverged = 5 + launch, .run_unconverged = 3 * launch};
    steps.floors[PROTOCOL_FROZEN][PHASE_AFTER] = (FloorSum){0.25 + launch, 4};
    launch_scores_write(stream, scores, METHODS, &steps);
    assert_int_equal(fclose(stream), 0);
    for (int i = 0; i < METHODS; i++) launch_scores_free(&scores[i]);
    return bytes;
}

static void assert_whole(const MethodScores *scores, int method) {
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            const PhaseScores *steps = &scores->steps[protocol][phase];
            int at = 0;
            for (int launch = 0; launch < LAUNCHES; launch++)
                for (int i = 0; i < steps_of(launch, method, phase); i++, at++) {
                    assert_true(steps->error[at] == error_of(launch, method, protocol, phase, i));
                    assert_true(steps->share[at] == 1.0 / (1 + i));
                }
            assert_int_equal(steps->count, at);
            const int by = at / 2; /* steps that have them */
            ChartRow row = {.signorini = NAN};
            scene_row_errors(&row, steps);
            if (method == 2 || at == 0)
                assert_true(isnan(row.signorini));
            else
                assert_true(row.signorini == 3. / by && row.cone == 4. / by && row.dissipation == 20. * phase / by);
        }
}

TEST(launches_are_put_together) {
    MethodScores scores[METHODS] = {0};
    for (int launch = 0; launch < LAUNCHES; launch++) {
        size_t size;
        StoredScores stored;
        FREED char *bytes = write_launch(launch, &size);
        assert_ok(stored_scores_open(&stored, "launch", bytes, size, METHODS, &error), error);
        assert_int_equal(stored.steps.unconverged, 5 + launch);
        assert_int_equal(stored.steps.run_unconverged, 3 * launch);
        assert_true(stored.steps.floors[PROTOCOL_FROZEN][PHASE_AFTER].sum == 0.25 + launch);
        assert_int_equal(stored.steps.floors[PROTOCOL_FROZEN][PHASE_AFTER].steps, 4);
        for (int i = 0; i < METHODS; i++) assert_ok(method_scores_add(&scores[i], &stored, i, &error), error);
    }
    for (int i = 0; i < METHODS; i++) {
        assert_whole(&scores[i], i);
        assert_int_equal(scores[i].launches, LAUNCHES);
        assert_true(scores[i].measures[1].drift == 1 && isnan(scores[i].measures[0].energy[2]));
        assert_int_equal(scores[i].unconverged, LAUNCHES * i);
    }
    /* The later launch is worse: its mean over three steps of the impact, 10 m/s apart. */
    assert_true(fabs(scores[2].worst[PHASE_IMPACT] - (error_of(1, 2, PROTOCOL_CLOSED, PHASE_IMPACT, 0) + 10)) < 1e-9);
    assert_true(isnan(scores[1].worst[PHASE_REST]));
    for (int i = 0; i < METHODS; i++) method_scores_free(&scores[i]);
}

/* Squares of 0 to 100 m/s: the median is 50^2, 95% are at most 95^2, and the mean is 100 (2 100 + 1) / 6. */
TEST(a_row_has_mean_median_and_95th_percentile) {
    double errors[101], shares[101];
    const PhaseScores scores = {.count = 101, .error = errors, .share = shares};
    ChartRow row;
    for (int i = 0; i <= 100; i++) {
        errors[i * 37 % 101] = i * i;
        shares[i] = i < 25 ? 1 : 0;
    }
    scene_row_errors(&row, &scores);
    assert_near(row.error_mean, 3350, 1e-9);
    assert_near(row.error_median, 2500, 1e-9);
    assert_near(row.error_p95, 9025, 1e-9);
    assert_near(row.share_right, 25.0 / 101, 1e-12);
}

/* Whether all methods of these bytes are read. */
static bool are_read(const char *bytes, size_t size, int methods) {
    Error error = {0};
    StoredScores stored;
    MethodScores scores = {0};
    FREED char *copy = malloc(size + 1); /* the sanitizers see what is read behind it */
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    bool ok = stored_scores_open(&stored, "launch", copy, size, methods, &error);
    for (int i = 0; ok && i < methods; i++) ok = method_scores_add(&scores, &stored, i, &error);
    if (!ok) assert_error(error, ERROR_INPUT, "launch: error: is no result of a launch; delete it");
    method_scores_free(&scores);
    return ok;
}

TEST(damaged_results_are_refused) {
    size_t size;
    FREED char *bytes = write_launch(0, &size);
    assert_true(are_read(bytes, size, METHODS));
    assert_false(are_read(bytes, size, METHODS + 1));
    assert_false(are_read(bytes, size, METHODS - 1));
    assert_false(are_read(bytes, 0, METHODS));
    for (size_t cut = 1; cut < size; cut++) assert_false(are_read(bytes, cut, METHODS));
    /* The number of methods, the index and the head of the first part; a few more steps may have been left out. */
    const size_t steps = sizeof(int64_t), index = steps + sizeof(LaunchSteps), part = index + METHODS * sizeof(int64_t),
                 counts = part + sizeof(int64_t), criteria = counts + sizeof(int32_t[PROTOCOLS][PHASES]),
                 values = criteria + sizeof(CriteriaSum[PROTOCOLS][PHASES]) + sizeof(RunMeasures);
    for (size_t at = 0; at < criteria; at++) {
        if ((at >= steps && at < index) || (at >= part && at < part + 3)) continue;
        for (int bit = 0; bit < 8; bit++) {
            bytes[at] = (char)(bytes[at] ^ 1 << bit);
            if (are_read(bytes, size, METHODS)) fail_msg("bit %d of byte %d", bit, (int)at);
            bytes[at] = (char)(bytes[at] ^ 1 << bit);
        }
    }
    const double wrong[] = {-1, 1.5}; /* an error below 0; a share above 1 */
    for (int i = 0; i < 2; i++) {
        char kept[sizeof(double)];
        char *at = bytes + values + (size_t)i * 2 * sizeof(double); /* two errors, two shares */
        memcpy(kept, at, sizeof kept);
        memcpy(at, &wrong[i], sizeof kept);
        assert_false(are_read(bytes, size, METHODS));
        memcpy(at, kept, sizeof kept);
    }
    const FloorSum floors[] = {{-1, 1}, {NAN, 1}, {INFINITY, 1}, {0, -1}};
    for (size_t i = 0; i < sizeof floors / sizeof *floors; i++) {
        char kept[sizeof *floors], *at = bytes + steps + offsetof(LaunchSteps, floors);
        memcpy(kept, at, sizeof kept);
        memcpy(at, &floors[i], sizeof kept);
        assert_false(are_read(bytes, size, METHODS));
        memcpy(at, kept, sizeof kept);
    }
    const CriteriaSum sums[] = {{-1, 0, 0, 1}, {0, NAN, 0, 1}, {0, 0, -1, 1}, {0, 0, 0, 3}, {0, 0, 0, -1}};
    for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) { /* two steps were scored */
        char kept[sizeof *sums];
        memcpy(kept, bytes + criteria, sizeof kept);
        memcpy(bytes + criteria, &sums[i], sizeof kept);
        assert_false(are_read(bytes, size, METHODS));
        memcpy(bytes + criteria, kept, sizeof kept);
    }
    assert_true(are_read(bytes, size, METHODS));
}

RUN_TESTS(NULL, NULL)

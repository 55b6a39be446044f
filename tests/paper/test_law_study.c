/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "paper/paper_internal.h"

static Dataset *record(bool context) {
    Error error = {0};
    const char *const scenes[] = {SOURCE_DIR "/scenes/single.yaml"};
    DatasetOptions options = {.scenes = scenes, .scene_count = 1, .context = context, .seed = 1};
    assert_true(parse_range("-2:2:1", 10, &options.bomb_x));
    Dataset *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    return dataset;
}

static LawRow run(const Dataset *dataset, const char *laws, double weight, uint64_t seed) {
    Error error = {0};
    LawRow result = {0};
    const LawStudy study = {.laws = laws, .weight = weight, .seed = seed, .iterations = 60};
    assert_ok(law_study_run(dataset, &study, &result, NULL, &error), error);
    return result;
}

/* The engine's impulses are equal and opposite and within the cone, by construction. */
TEST(the_engine_keeps_what_it_keeps) {
    OWN(Dataset) *dataset = record(true);
    LawRow labels;
    assert_ok(law_study_run(dataset, &(LawStudy){.laws = NULL}, &labels, NULL, &error), error);
    assert_int_equal(labels.laws, LAW_SET_ENGINE);
    assert_true(isnan(labels.test) && isnan(labels.constant));
    assert_near(labels.violation[LAW_MOMENTUM], 0, 1e-3);
    assert_near(labels.violation[LAW_CONE], 0, 1e-3);
    assert_true(labels.violation[LAW_ENERGY] >= 0 && labels.violation[LAW_APPROACH] >= 0);
}

TEST(a_heavy_law_is_broken_less) {
    OWN(Dataset) *dataset = record(true);
    const LawRow none = run(dataset, "none", 10, 1), cone = run(dataset, "cone", 10, 1),
                 again = run(dataset, "cone", 10, 1), other = run(dataset, "cone", 10, 2);
    assert_true(cone.violation[LAW_CONE] < 0.7 * none.violation[LAW_CONE]);
    assert_true(none.constant == cone.constant && none.constant > 0);
    assert_true(none.test > 0 && none.test < 2 * none.constant);
    assert_memory_equal(&cone, &again, sizeof cone);
    assert_true(cone.test != other.test);
}

static bool stop(void *context, double done, double total) {
    (void)context;
    return done < total / 2;
}

TEST(what_is_not_whole_does_not_count) {
    LawRow result;
    OWN(Dataset) *dataset = record(true), *without = record(false);
    const Progress progress = {stop, NULL};
    LawStudy study = {.laws = "all", .weight = 1, .seed = 1, .iterations = 60};
    assert_false(law_study_run(dataset, &study, &result, &progress, &error));
    assert_error(error, ERROR_INTERRUPTED, "training: error: stopped");
    assert_refused(law_study_run(without, &study, &result, NULL, &error), "--context");
    study.laws = "gravity";
    assert_refused(law_study_run(dataset, &study, &result, NULL, &error), "'gravity' is not a law");
}

RUN_TESTS(NULL, NULL)

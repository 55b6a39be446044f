/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "learning/dataset.h"
#include "paper/paper_internal.h"

static Dataset *record(const char *scene, PairView view) {
    Error error = {0};
    DatasetOptions options = {.scenes = &scene, .scene_count = 1, .view = view, .seed = 1};
    assert_true(parse_range("-2:2:1", 10, &options.bomb_x));
    Dataset *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    return dataset;
}

/* The stack replaces the pyramid: the study needs only its launches. */
static const char *const single = SOURCE_DIR "/scenes/single.yaml", *const stack = SOURCE_DIR "/scenes/stack.yaml";

static TransferRow run(const Dataset *const data[TRANSFER_SCENES], TransferStudy study) {
    Error error = {0};
    TransferRow result = {0};
    assert_ok(transfer_study_run(data, &study, &result, NULL, &error), error);
    return result;
}

/* Mean squared distance of the test rows' relative changes from the mean of the training rows, computed directly. */
static double constant_by_hand(const Dataset *dataset) {
    double sum[2][2] = {{0}}, count[2] = {0}, squares = 0;
    for (int64_t r = 0; r < dataset->rows; r++) {
        const int test = dataset_is_test(dataset, r);
        const float *c = dataset->changes + r * PAIR_CHANGES;
        count[test]++;
        for (int k = 0; k < 2; k++) sum[test][k] += (double)(c[3 + k] - c[k]);
    }
    for (int64_t r = 0; r < dataset->rows; r++) {
        const float *c = dataset->changes + r * PAIR_CHANGES;
        for (int k = 0; k < 2 && dataset_is_test(dataset, r); k++)
            squares += pow((double)(c[3 + k] - c[k]) - sum[0][k] / count[0], 2);
    }
    return sqrt(squares / (2 * count[1]));
}

TEST(errors_stand_beside_the_constant) {
    OWN(Dataset) *pyramid = record(single, PAIR_CONTACT), *drawn = dataset_draw_subset(pyramid, 2, 3, &error);
    assert_ok(drawn != NULL, error);
    const Dataset *const data[] = {NULL, NULL, pyramid};
    /* An untrained network predicts anything; a trained one, with inputs of the contact, beats the constant
       predictor. */
    const TransferRow begun = run(data, (TransferStudy){.seed = 3, .launches = 2});
    const TransferRow trained = run(data, (TransferStudy){.seed = 3, .launches = 2, .iterations = 40});
    assert_near(begun.constant, constant_by_hand(drawn), 1e-9);
    assert_true(begun.constant == trained.constant);
    if (!(trained.error < 0.9 * begun.error && trained.error < begun.constant))
        fail_msg("%g to %g, %g", begun.error, trained.error, begun.constant);
}

/* After 0 iterations, a network with transfer differs from one from scratch only by its normalisation, which is that of
   its first stage. It does not differ if that stage had the same rows. */
TEST(the_first_stage_decides_the_units) {
    OWN(Dataset) *elsewhere = record(single, PAIR_RELATIVE), *pyramid = record(stack, PAIR_RELATIVE);
    OWN(Dataset) *drawn = dataset_draw_subset(pyramid, 2, 5, &error);
    assert_ok(drawn != NULL, error);
    const Dataset *const same[] = {drawn, elsewhere, pyramid}, *const other[] = {elsewhere, drawn, pyramid};
    TransferStudy study = {.seed = 5, .launches = 2};
    const TransferRow scratch = run(same, study);
    study.transfer = true;
    const TransferRow from_same = run(same, study), from_other = run(other, study);
    assert_true(from_same.error == scratch.error && from_same.constant == scratch.constant);
    assert_true(from_other.error != scratch.error && from_other.constant == scratch.constant);
}

/* By any view; the same again, and something else for each way of getting there. */
TEST(stages_follow_each_other) {
    for (int i = 0; i < 2; i++) {
        const PairView view = i == 0 ? PAIR_RELATIVE : PAIR_CONTACT;
        OWN(Dataset) *first = record(single, view), *pyramid = record(stack, view);
        const Dataset *const data[] = {first, pyramid, pyramid}, *const changed[] = {first, first, pyramid};
        TransferStudy study = {.seed = 2, .launches = 4, .iterations = 20};
        const TransferRow scratch = run(data, study);
        study.transfer = true;
        const TransferRow transfer = run(data, study), again = run(data, study), other = run(changed, study);
        assert_memory_equal(&transfer, &again, sizeof again);
        assert_true(transfer.error != scratch.error && transfer.error != other.error);
        assert_true(transfer.constant == scratch.constant);
    }
}

static bool stop(void *context, double done, double total) {
    int *stages = context;
    *stages += done == total;
    return *stages < 2;
}

TEST(what_cannot_be_run_is_refused) {
    OWN(Dataset) *pyramid = record(stack, PAIR_RELATIVE), *other = record(single, PAIR_RAW);
    const Dataset *const data[] = {pyramid, pyramid, pyramid}, *const mixed[] = {other, pyramid, pyramid};
    TransferRow result;
    int stages = 0;
    const Progress progress = {stop, &stages};
    TransferStudy study = {.transfer = true, .seed = 1, .launches = 5, .iterations = 3};
    assert_refused(transfer_study_run(data, &study, &result, NULL, &error),
                   "5 training launches requested; expected 1 to 4");
    error = (Error){0};
    study.launches = 1;
    assert_false(transfer_study_run(data, &study, &result, &progress, &error));
    assert_error(error, ERROR_INTERRUPTED, "training: error: stopped");
    assert_refused(transfer_study_run(mixed, &study, &result, NULL, &error), "trained on other inputs");
}

RUN_TESTS(NULL, NULL)

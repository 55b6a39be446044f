/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws' terms in the loss and their effect on training. */
#include "datasets.h"

#include "learning/pair_training_internal.h"

enum { ROWS = 2000 };

/* A network without hidden layers and with weights 0: it predicts its biases for every row. */
static Network *make_constant(const Dataset *dataset) {
    Network *network = network_sized(1, (const int[]){PAIR_INPUTS, PAIR_CHANGES});
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    samples_fit_normalisation(dataset, SCALE_STANDARD, network);
    return network;
}

/* The mean of what laws of weight 1 add, and half its slope, for given predictions [rows, 6]. */
static double added(const Dataset *dataset, const Network *network, const char *laws, const float *predictions,
                    double half_slopes[PAIR_CHANGES * BLOCK_ROWS]) {
    Error error = {0};
    LawNumbers weights;
    assert_ok(law_weights_named(laws, 1, &weights, &error), error);
    assert_ok(laws_check(dataset, PAIR_CHANGES, &weights, &error), error);
    Laws *made = laws_create(dataset, network, &weights, &error);
    NetworkBlock *block = network_block_create(network, &error);
    assert_ok(made != NULL && block != NULL, error);
    double sum = 0;
    int rows = 0;
    for (int64_t r = 0, in_block = 0; r < dataset->rows; r++) {
        if (!dataset_is_test(dataset, r)) {
            for (int k = 0; k < PAIR_CHANGES; k++)
                block->values[1][k * BLOCK_ROWS + in_block] =
                    ((double)predictions[r * PAIR_CHANGES + k] - (double)network->output.offset[k]) *
                    (double)network->output.scale[k];
            rows++;
            in_block++;
        }
        if (in_block < BLOCK_ROWS && r + 1 < dataset->rows) continue;
        memset(half_slopes, 0, PAIR_CHANGES * BLOCK_ROWS * sizeof *half_slopes);
        sum += laws_add(made, block, (rows - 1) / BLOCK_ROWS, (int)in_block, half_slopes);
        in_block = 0;
    }
    network_block_destroy(block);
    laws_destroy(made);
    return sum / rows / PAIR_CHANGES;
}

TEST(predicting_the_labels_adds_nothing) {
    OWN(Dataset) *dataset = make_pushed_dataset(ROWS);
    /* Labels that violate every law, as with position correction and other pairs. */
    for (int r = 0; r < ROWS; r += 2)
        for (int k = 0; k < PAIR_CHANGES; k++) dataset->changes[r * PAIR_CHANGES + k] *= k < 3 ? -3.0f : -5.0f;
    OWN(Network) *network = make_constant(dataset);
    double half_slopes[PAIR_CHANGES * BLOCK_ROWS];
    assert_true(added(dataset, network, "all", dataset->changes, half_slopes) < 1e-10);
}

/* Predictions that are multiples of the label: the violations are known multiples of the labels' own size. */
TEST(a_weight_of_one_makes_the_labels_own_size_one) {
    OWN(Dataset) *dataset = make_pushed_dataset(ROWS);
    for (int r = 0; r < ROWS; r++) { /* no static bodies, no spin */
        float *context = dataset->context + r * PAIR_CONTEXT, *change = dataset->changes + r * PAIR_CHANGES;
        const float j[2] = {context[CONTEXT_NORMAL], context[CONTEXT_NORMAL + 1]};
        context[CONTEXT_INV_MASS_A] = 0.25f, context[CONTEXT_INV_MASS_B] = 0.5f;
        context[CONTEXT_INV_INERTIA_A] = context[CONTEXT_INV_INERTIA_B] = 1;
        for (int k = 0; k < 3; k++) {
            context[CONTEXT_VELOCITIES + k] = context[CONTEXT_VELOCITIES + 3 + k] = 0;
            change[k] = k < 2 ? -0.25f * (float)(r % 4 + 1) * j[k] : 0;
            change[3 + k] = k < 2 ? 0.5f * (float)(r % 4 + 1) * j[k] : 0;
        }
    }
    OWN(Network) *network = make_constant(dataset);
    FREED float *predictions = calloc(ROWS * PAIR_CHANGES, sizeof *predictions);
    assert_non_null(predictions);
    double half_slopes[PAIR_CHANGES * BLOCK_ROWS];
    /* Only b changes: a momentum of J is missing. */
    for (int i = 0; i < ROWS * PAIR_CHANGES; i++) predictions[i] = i % 6 < 3 ? 0 : dataset->changes[i];
    assert_near(added(dataset, network, "momentum", predictions, half_slopes), 1, 1e-5);
    /* The bodies pull with J. From rest a pull adds as much energy as the label's push: no excess. */
    for (int i = 0; i < ROWS * PAIR_CHANGES; i++) predictions[i] = -dataset->changes[i];
    assert_near(added(dataset, network, "cone", predictions, half_slopes), 1, 1e-5);
    assert_near(added(dataset, network, "approach", predictions, half_slopes), 1, 1e-5);
    assert_near(added(dataset, network, "energy", predictions, half_slopes), 0, 1e-5);
    /* Twice the impulse, four times the energy: an excess of three times the label's. */
    for (int i = 0; i < ROWS * PAIR_CHANGES; i++) predictions[i] = 2 * dataset->changes[i];
    assert_near(added(dataset, network, "energy", predictions, half_slopes), 9, 1e-4);
}

/* A prediction of 0 changes no velocity: approaching pairs violate `approach`; no other law is violated. */
TEST(violations_are_measured_on_the_test_rows) {
    OWN(Dataset) *dataset = make_pushed_dataset(ROWS);
    OWN(Network) *network = make_constant(dataset);
    for (int k = 0; k < PAIR_CHANGES; k++)
        network->biases[0][k] = -network->output.offset[k] * network->output.scale[k];
    double expected = 0, slope[PAIR_CHANGES];
    int rows = 0;
    for (int r = 0; r < ROWS; r++) {
        if (!dataset_is_test(dataset, r)) continue;
        const LawPair pair = law_pair(dataset->context + r * PAIR_CONTEXT);
        expected += laws_known[LAW_APPROACH].violation(&pair, (const double[PAIR_CHANGES]){0}, slope);
        rows++;
    }
    LawNumbers nothing, labels;
    assert_ok(laws_measure(dataset, network, &nothing, &error), error);
    assert_ok(laws_measure(dataset, NULL, &labels, &error), error);
    assert_near(nothing.of[LAW_APPROACH], expected / rows, 1e-5);
    assert_true(expected / rows > 0.1 && labels.of[LAW_APPROACH] < expected / rows);
    for (int law = 0; law < LAWS; law++) {
        if (law != LAW_APPROACH) assert_near(nothing.of[law], 0, 1e-5);
        if (law == LAW_MOMENTUM || law == LAW_CONE) assert_near(labels.of[law], 0, 1e-5); /* by construction */
    }
    strcpy(network->inputs, "x");
    assert_refused(laws_measure(dataset, network, &nothing, &error), "laws: error: the network has other inputs (x)");
    dataset->launch_test[4] = 0;
    assert_refused(laws_measure(dataset, NULL, &nothing, &error), "the dataset has no test rows");
}

static void keep_score(void *context, const TrainingScore *score) { *(TrainingScore *)context = *score; }

static Network *train(const Dataset *dataset, const char *laws, int iterations, TrainingScore *score) {
    Error error = {0};
    TrainingOptions options = small("adam", iterations);
    options.widths[2] = PAIR_CHANGES;
    options.on_score = keep_score;
    options.context = score;
    assert_ok(law_weights_named(laws, 10, &options.laws, &error), error);
    Network *network = training_run(dataset, &options, NULL, &error);
    assert_ok(network != NULL, error);
    return network;
}

TEST(a_law_in_the_loss_is_violated_less) {
    OWN(Dataset) *dataset = make_pushed_dataset(ROWS);
    TrainingScore score;
    LawNumbers without, with;
    Network *network = train(dataset, "none", 30, &score);
    assert_ok(laws_measure(dataset, network, &without, &error), error);
    network_destroy(network);
    for (int law = 0; law < LAWS; law++) {
        network = train(dataset, laws_known[law].name, 30, &score);
        assert_ok(laws_measure(dataset, network, &with, &error), error);
        if (!(with.of[law] < 0.9 * without.of[law]))
            fail_msg("%s: %g with it, %g without", laws_known[law].name, with.of[law], without.of[law]);
        network_destroy(network);
    }
}

/* Scores exclude the laws, so that networks with and without them can be compared. */
TEST(scores_exclude_the_laws) {
    OWN(Dataset) *dataset = make_pushed_dataset(ROWS);
    TrainingScore with, without, again;
    network_destroy(train(dataset, "none", 0, &without));
    OWN(Network) *network = train(dataset, "all", 0, &with);
    assert_near(with.train, without.train, 1e-12);
    assert_near(with.test, without.test, 1e-12);
    assert_true(with.constant_test == without.constant_test);
    assert_ok(training_score(dataset, network, NULL, &again, &error), error);
    assert_true(again.test == with.test && again.train == without.train);
    assert_ok(training_score(dataset, network, "smooth-l1", &again, &error), error);
    assert_true(again.test < with.test && again.constant_test < with.constant_test);
    assert_refused(training_score(dataset, network, "l3", &again, &error), "'l3' is not a valid value");
}

RUN_TESTS(NULL, NULL)

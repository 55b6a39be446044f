/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training.h"

#include <omp.h>

enum { MAX_SCORES = 32 };

typedef struct Scores {
    int count;
    TrainingScore items[MAX_SCORES];
} Scores;

static void keep_score(void *context, const TrainingScore *score) {
    Scores *scores = context;
    assert_true(scores->count < MAX_SCORES);
    scores->items[scores->count++] = *score;
}

static const TrainingScore *last_score(const Scores *scores) { return &scores->items[scores->count - 1]; }

static Network *train(const Dataset *dataset, TrainingOptions options, Scores *scores) {
    Error error = {0};
    *scores = (Scores){0};
    options.on_score = keep_score;
    options.context = scores;
    Network *network = training_run(dataset, &options, NULL, &error);
    assert_ok(network != NULL, error);
    return network;
}

/* Mean squared error of the normalised outputs, by network_predict(). */
static double error_of(const Network *network, const Dataset *dataset, bool test) {
    double sum = 0;
    int count = 0;
    for (int64_t r = 0; r < dataset->rows; r++) {
        if ((dataset->launch_test[dataset->launch[r]] != 0) != test) continue;
        float scratch[2 * 64], output[2];
        const float *changes = dataset->changes + r * PAIR_CHANGES;
        network_predict(network, dataset->inputs + r * PAIR_INPUTS, scratch, output);
        for (int k = 0; k < 2; k++) {
            double e = (double)(output[k] - (changes[k + 3] - changes[k])) * (double)network->output.scale[k];
            sum += e * e;
            count++;
        }
    }
    return sum / count;
}

static void check_learns(const char *optimizer, int iterations, double factor) {
    OWN(Dataset) *dataset = make_taught_dataset(2000);
    Scores scores;
    OWN(Network) *network = train(dataset, small(optimizer, iterations), &scores);
    const TrainingScore *first = &scores.items[0], *last = last_score(&scores);
    if (!(last->train < first->train / factor && last->test < first->test / factor &&
          last->test < last->constant_test / factor))
        fail_msg("%s: test %g -> %g, train %g -> %g, constant %g", optimizer, first->test, last->test, first->train,
                 last->train, last->constant_test);
    assert_near(error_of(network, dataset, false), last->train, 0.01 * last->train);
    assert_near(error_of(network, dataset, true), last->test, 0.01 * last->test);
}

TEST(every_optimizer_learns_a_networks_outputs) {
    check_learns("adam", 1000, 100);
    check_learns("bfgs", 200, 100);
    check_learns("lm", 20, 100);
    check_learns("gd", 2000, 2);
}

/* Without a hidden layer and with linear outputs the loss is quadratic. Its minimum is 0 here, up to the rounding of
   targets to float32; Levenberg-Marquardt reaches it in a few steps and then stops without an error. */
TEST(linear_problems_are_solved) {
    OWN(Dataset) *dataset = make_dataset(1000);
    for (int i = 0; i < 1000 * PAIR_CHANGES; i++) {
        const float *x = dataset->inputs + i / PAIR_CHANGES * PAIR_INPUTS;
        dataset->changes[i] = 2 * x[i % PAIR_CHANGES] - 3 * x[i % PAIR_CHANGES + 4] + 7;
    }
    Scores scores;
    const char *const names[] = {"lm", "bfgs"};
    for (int i = 0; i < 2; i++) {
        OWN(Network) *network =
            train(dataset,
                  (TrainingOptions){
                      .layers = 1, .widths = {PAIR_INPUTS, PAIR_CHANGES}, .optimizer = names[i], .iterations = 1000},
                  &scores);
        assert_true(last_score(&scores)->train < 1e-12 && last_score(&scores)->test < 1e-12);
        assert_true(last_score(&scores)->iteration < 200);
        /* The weight from x_0 to output 0, in the units of the data. */
        double slope =
            (double)network->weights[0][0] * (double)network->input.scale[0] / (double)network->output.scale[0];
        assert_near(slope, 2, 1e-4);
        assert_int_equal(network->activations[0], ACTIVATION_LINEAR);
    }
}

/* Row i of a launch has x = i mod 4 in its inputs, and y = x^2 in training, so 0, 1, 4, 9: mean 3.5 (the middle is
   4.5), variance 12.25. Held-out rows have y = x^2 + 3.5. A layer of linear outputs fits the line 3 x - 1 with the
   squares 1, 1, 1, 1; its held-out errors are those of +-1 - 3.5, of squares 6.25 or 20.25; those of the mean 3.5 are
   y. */
TEST(errors_constant_and_split_are_those_of_the_closed_form) {
    OWN(Dataset) *dataset = make_dataset(1000);
    for (int r = 0; r < 1000; r++) {
        const float x = (float)(r / 5 % 4);
        for (int i = 0; i < PAIR_INPUTS; i++) dataset->inputs[r * PAIR_INPUTS + i] = x;
        for (int k = 0; k < PAIR_CHANGES; k++) dataset->changes[r * PAIR_CHANGES + k] = x * x + (r % 5 == 4 ? 3.5f : 0);
    }
    const double variance = 12.25;
    const TrainingOptions options = {
        .layers = 1, .widths = {PAIR_INPUTS, PAIR_CHANGES}, .optimizer = "lm", .iterations = 100};
    Scores scores;
    OWN(Network) *network = train(dataset, options, &scores);
    const TrainingScore *last = last_score(&scores);
    assert_near(network->output_mean[0], 3.5, 1e-6);
    assert_near(last->train * variance, 1, 1e-4);
    assert_near(last->constant_train, 1, 1e-6);
    assert_near(last->test * variance, (6.25 + 20.25) / 2, 1e-3);
    assert_near(last->constant_test * variance, (0 + 1 + 16 + 81) / 4.0, 1e-3);

    /* Another split by launch: a fifth of them, drawn with the seed. */
    dataset->scene_count = 1;
    uint8_t test[5];
    bool differ = false;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        assert_ok(dataset_split(dataset, seed, test, &(Error){0}), error);
        assert_int_equal(test[0] + test[1] + test[2] + test[3] + test[4], 1);
        differ |= test[4] == 0;
    }
    assert_true(differ);
}

/* Labels of held-out rows are the opposite of those trained on, so the first step raises their error; and it ends a
   training after its patience. */
TEST(a_training_ends_when_its_held_out_error_does_not_fall) {
    OWN(Dataset) *dataset = make_dataset(1000);
    for (int r = 0; r < 1000; r++)
        for (int k = 0; k < PAIR_CHANGES; k++)
            dataset->changes[r * PAIR_CHANGES + k] = dataset->inputs[r * PAIR_INPUTS + k] * (r % 5 == 4 ? -1.0f : 1.0f);
    TrainingOptions options = {
        .layers = 1, .widths = {PAIR_INPUTS, PAIR_CHANGES}, .optimizer = "gd", .iterations = 500, .patience = 40};
    Scores scores;
    OWN(Network) *start = NULL;
    {
        TrainingOptions none = options;
        none.iterations = 0;
        start = train(dataset, none, &scores);
    }
    for (int p = 0; p < network_parameter_count(start); p++) start->weights[0][p] = 0;
    options.start = start;
    network_destroy(train(dataset, options, &scores));
    assert_int_equal(last_score(&scores)->iteration, 40);
    for (int r = 0; r < 1000; r++)
        for (int k = 0; k < PAIR_CHANGES; k++)
            dataset->changes[r * PAIR_CHANGES + k] = dataset->inputs[r * PAIR_INPUTS + k];
    options.patience = 200; /* the error falls for long */
    network_destroy(train(dataset, options, &scores));
    assert_true(last_score(&scores)->iteration > 200);
}

TEST(networks_name_their_inputs_and_outputs) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    Scores scores;
    OWN(Network) *two = train(dataset, small("adam", 0), &scores);
    assert_string_equal(two->inputs, pair_views[PAIR_RELATIVE].inputs);
    assert_string_equal(two->outputs, "dvx dvy");
    assert_true(two->activations[0] == ACTIVATION_SIGMOID && two->activations[1] == ACTIVATION_SIGMOID);
    TrainingOptions options = small("adam", 0);
    options.widths[2] = PAIR_CHANGES;
    OWN(Network) *six = train(dataset, options, &scores);
    assert_string_equal(six->outputs, pair_output_names(PAIR_RELATIVE, TARGET_PAIR, PAIR_CHANGES));
    assert_true(six->activations[0] == ACTIVATION_SIGMOID && six->activations[1] == ACTIVATION_LINEAR);
}

static bool same_numbers(const Network *a, const Network *b) {
    return memcmp(a->weights[0], b->weights[0], (size_t)network_parameter_count(a) * sizeof(float)) == 0;
}

/* No hidden layer, weights 0, inputs and outputs of mean 0: d loss / d bias = 2/6 bias for each of the six outputs, so
   a step at rate 1/2 leaves 5/6 of it. */
TEST(gradient_descent_steps_at_its_rate) {
    OWN(Dataset) *dataset = make_dataset(1000);
    uint32_t sequence = 9;
    for (int i = 0; i < 1000 * PAIR_CHANGES; i++) dataset->changes[i] = next_number(&sequence);
    Scores scores;
    TrainingOptions options = {.layers = 1, .widths = {PAIR_INPUTS, PAIR_CHANGES}, .optimizer = "gd"};
    OWN(Network) *start = train(dataset, options, &scores);
    for (int i = 0; i < PAIR_INPUTS * PAIR_CHANGES; i++) start->weights[0][i] = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) start->biases[0][k] = 1;
    options.start = start;
    options.iterations = 3;
    OWN(Network) *network = train(dataset, options, &scores);
    for (int k = 0; k < PAIR_CHANGES; k++) assert_near(network->biases[0][k], 125.0 / 216, 1e-5);
}

TEST(options_set_activations_and_scaling) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    const char *const hidden[] = {"sigmoid", "tanh", "relu"};
    const Activation expected[] = {ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU};
    Scores scores;
    OWN(Network) *plain = train(dataset, small("adam", 5), &scores);
    for (int h = 0; h < 3; h++)
        for (int form = 0; form < 3; form++) {
            TrainingOptions options = small("adam", 5);
            options.hidden = hidden[h];
            options.output_activation = form == 0 ? "sigmoid" : "linear";
            options.scale = form == 2 ? "standard" : "minmax";
            OWN(Network) *network = train(dataset, options, &scores);
            assert_int_equal(network->activations[0], expected[h]);
            assert_int_equal(network->activations[1], form == 0 ? ACTIVATION_SIGMOID : ACTIVATION_LINEAR);
            /* The constant predictor's error is 1 only if the outputs are standardised. */
            assert_true((fabs(last_score(&scores)->constant_train - 1) < 1e-4) == (form == 2));
            assert_memory_equal(network->output_mean, plain->output_mean, 2 * sizeof(float));
            assert_true(same_numbers(network, plain) == (h == 0 && form == 0));
        }
    TrainingOptions options = small("adam", 5);
    options.output_activation = "linear"; /* implies standard */
    network_destroy(train(dataset, options, &scores));
    assert_near(last_score(&scores)->constant_train, 1, 1e-4);
}

/* Glorot: |weight| <= limit, variance limit^2 / 3; biases 0. */
TEST(first_weights_are_glorots) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    Scores scores;
    TrainingOptions options = small("adam", 0);
    options.widths[1] = 200;
    OWN(Network) *network = train(dataset, options, &scores);
    double limit = sqrt(6.0 / 210), sum = 0, squares = 0;
    for (int i = 0; i < 2000; i++) {
        double weight = (double)network->weights[0][i];
        assert_true(fabs(weight) <= limit);
        sum += weight;
        squares += weight * weight;
    }
    /* Four standard errors: limit / sqrt(3 * 2000) for the mean, limit^2 * sqrt(4 / 45 / 2000) for the mean square. */
    assert_near(sum / 2000, 0, 4 * limit / sqrt(6000));
    assert_near(squares / 2000, limit * limit / 3, 4 * limit * limit * sqrt(4.0 / 45 / 2000));
    for (int j = 0; j < 200; j++) assert_true(network->biases[0][j] == 0);
}

/* Enough rows for several threads. */
TEST(same_seed_same_bits) {
    OWN(Dataset) *dataset = make_taught_dataset(6000);
    Scores scores;
    const char *const names[] = {"adam", "bfgs", "gd", "lm"};
    int threads = omp_get_max_threads();
    for (int i = 0; i < 4; i++) {
        TrainingOptions options = small(names[i], 8);
        omp_set_num_threads(1);
        OWN(Network) *first = train(dataset, options, &scores);
        omp_set_num_threads(2);
        OWN(Network) *same = train(dataset, options, &scores);
        options.seed = 2;
        OWN(Network) *other = train(dataset, options, &scores);
        options.seed = UINT64_C(1) << 32;
        OWN(Network) *high = train(dataset, options, &scores);
        options.seed = 0;
        OWN(Network) *zero = train(dataset, options, &scores);
        assert_true(same_numbers(first, same));
        assert_false(same_numbers(first, other));
        assert_false(same_numbers(high, zero));
    }
    omp_set_num_threads(threads);
}

TEST(scores_are_reported_as_in_the_papers_table) {
    OWN(Dataset) *dataset = make_taught_dataset(100);
    Scores scores;
    const int expected[] = {0, 10, 50, 100, 1000, 2000, 5000, 5001};
    network_destroy(train(dataset, small("adam", 5001), &scores));
    assert_int_equal(scores.count, 8);
    for (int i = 0; i < 8; i++) assert_int_equal(scores.items[i].iteration, expected[i]);
    network_destroy(train(dataset, small("adam", 0), &scores));
    assert_int_equal(scores.count, 1);
    network_destroy(train(dataset, small("lm", 10), &scores));
    assert_int_equal(scores.count, 2);
}

/* Stops the training when iteration `context` is done. */
static bool stop_at(void *context, double done, double total) {
    (void)total;
    return done < *(const int *)context;
}

TEST(stopped_training_returns_the_best_so_far) {
    OWN(Dataset) *dataset = make_taught_dataset(500);
    const char *const names[] = {"adam", "bfgs", "gd", "lm"};
    for (int i = 0; i < 4; i++) {
        Scores scores = {0};
        int stop = 7;
        const Progress progress = {stop_at, &stop};
        TrainingOptions options = small(names[i], 5000);
        options.on_score = keep_score;
        options.context = &scores;
        OWN(Network) *network = training_run(dataset, &options, &progress, &error);
        assert_ok(network != NULL, error);
        assert_int_equal(last_score(&scores)->iteration, 7);
        assert_true(error_of(network, dataset, false) <= 1.0001 * last_score(&scores)->train);
        assert_true(last_score(&scores)->train < scores.items[0].train);
    }
}

TEST(training_continues_from_a_start_network) {
    OWN(Dataset) *dataset = make_taught_dataset(500), *wider = make_taught_dataset(500);
    for (int i = 0; i < 500 * PAIR_INPUTS; i++) wider->inputs[i] *= 2;
    Scores scores;
    OWN(Network) *start = train(dataset, small("lm", 5), &scores);
    double reached = last_score(&scores)->train;
    TrainingOptions options = small("lm", 5);
    options.start = start;
    network_destroy(train(dataset, options, &scores));
    assert_near(scores.items[0].train, reached, 1e-3 * reached);
    assert_true(last_score(&scores)->train < reached);
    OWN(Network) *elsewhere = train(wider, options, &scores);
    assert_memory_equal(elsewhere->input.scale, start->input.scale, PAIR_INPUTS * sizeof(float));
    assert_memory_equal(elsewhere->output.offset, start->output.offset, 2 * sizeof(float));
}

RUN_TESTS(NULL, NULL)

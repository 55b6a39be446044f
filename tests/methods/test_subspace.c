/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Projection, prediction and reconstruction in closed form. */
#include "owned.h"

#include "engine/uniform.h"
#include "subspace_nets.h"

static const float launch[SUBSPACE_LAUNCH] = {3, 0, 0, 50};

static Subspace begin(const SubspaceNet *net, int predictor, bool corrects) {
    Subspace subspace;
    Error error = {0};
    assert_ok(subspace_make(&subspace, net, &net->predictors[predictor], corrects, &error), error);
    return subspace;
}

static void fill(float *numbers, int count, uint32_t *seed) {
    for (int i = 0; i < count; i++) numbers[i] = uniform(seed, -1, 1);
}

/* Of a turned basis: its rows are orthonormal, so all components give all numbers back. */
TEST(all_components_lose_nothing) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    uint32_t seed = 3;
    float numbers[TEST_NUMBERS];
    for (int k = 0; k < TEST_NUMBERS; k += 2) {
        float *x = net->basis + k * subspace_lanes(TEST_NUMBERS), *y = x + subspace_lanes(TEST_NUMBERS);
        x[k] = y[k + 1] = 0.6f;
        x[k + 1] = 0.8f, y[k] = -0.8f;
    }
    fill(net->rest, TEST_NUMBERS, &seed);
    fill(numbers, TEST_NUMBERS, &seed);
    OWN(Subspace) subspace = begin(net, 1, true);
    subspace_start(&subspace, numbers, numbers);
    assert_near(subspace.now[0], 0.6 * (double)(numbers[0] - net->rest[0]) + 0.8 * (double)(numbers[1] - net->rest[1]),
                1e-6);
    subspace_reconstruct(&subspace);
    for (int j = 0; j < TEST_NUMBERS; j++) assert_near(subspace.numbers[j], numbers[j], 1e-6);
}

TEST(few_components_keep_their_share) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const float numbers[TEST_NUMBERS] = {1, 2, 3, 4, 5, 6, 7, 8};
    OWN(Subspace) subspace = begin(net, 0, true);
    subspace_start(&subspace, numbers, numbers);
    subspace_reconstruct(&subspace);
    for (int j = 0; j < TEST_NUMBERS; j++) assert_near(subspace.numbers[j], j < 4 ? j + 1 : 0, 0);
}

TEST(the_linear_term_goes_on) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const float last[TEST_NUMBERS] = {0}, now[TEST_NUMBERS] = {1, -2, 0.5f, 4, 0, 0, 0.25f, 1};
    OWN(Subspace) subspace = begin(net, 1, false);
    subspace_start(&subspace, last, now);
    for (int step = 2; step <= 9; step++) {
        const SubspaceReport report = subspace_step(&subspace, launch);
        assert_int_equal(report.beyond + report.not_finite, 0);
        for (int k = 0; k < TEST_NUMBERS; k++) assert_near(subspace.now[k], (float)step * now[k], 1e-5);
    }
}

static void random_weights(SubspaceNet *net, const SubspacePredictor *predictor) {
    uint32_t seed = 7;
    fill(predictor->first.rows, predictor->first.from * predictor->first.lanes, &seed);
    fill(predictor->second.rows, predictor->second.from * predictor->second.lanes, &seed);
    fill(predictor->last.rows, predictor->last.from * predictor->last.lanes, &seed);
    fill(predictor->first.biases, net->shape.hidden, &seed);
    fill(predictor->second.biases, net->shape.hidden, &seed);
    fill(predictor->last.biases, predictor->components, &seed);
}

/* out[to] = biases + sum of in[i] * rows[i], in double. */
static void layer(const SubspaceLayer *from, const double *in, double *out, bool bent) {
    for (int j = 0; j < from->lanes; j++) {
        out[j] = (double)from->biases[j];
        for (int i = 0; i < from->from; i++) out[j] += (double)from->rows[i * from->lanes + j] * in[i];
        if (bent) out[j] = tanh(out[j]);
    }
}

TEST(the_network_is_its_equation) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const SubspacePredictor *predictor = &net->predictors[1];
    const float last[TEST_NUMBERS] = {0.1f, 0.2f, 0.3f}, now[TEST_NUMBERS] = {0.4f, -0.1f, 0.2f};
    double in[2 * TEST_NUMBERS + SUBSPACE_LAUNCH], first[ROW_LANES], second[ROW_LANES], out[ROW_LANES];
    random_weights(net, predictor);
    for (int k = 0; k < TEST_NUMBERS; k++) {
        in[k] = (double)now[k];
        in[TEST_NUMBERS + k] = (double)now[k] - (double)last[k];
    }
    for (int j = 0; j < SUBSPACE_LAUNCH; j++) in[2 * TEST_NUMBERS + j] = (double)launch[j];
    layer(&predictor->first, in, first, true);
    layer(&predictor->second, first, second, true);
    layer(&predictor->last, second, out, false);
    OWN(Subspace) subspace = begin(net, 1, true);
    subspace_start(&subspace, last, now);
    subspace_step(&subspace, launch);
    for (int k = 0; k < TEST_NUMBERS; k++)
        assert_near(subspace.now[k], 2 * (double)now[k] - (double)last[k] + out[k], 1e-4);
}

/* A network of zeros has the bits of its twin. */
TEST(without_a_correction_both_are_one) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const float last[TEST_NUMBERS] = {0.1f, 0.2f, 0.3f, 7, 11}, now[TEST_NUMBERS] = {0.4f, -0.1f, 0.2f, 7.1f, 11.3f};
    OWN(Subspace) with = begin(net, 1, true), without = begin(net, 1, false);
    subspace_start(&with, last, now);
    subspace_start(&without, last, now);
    for (int i = 0; i < 20; i++) {
        subspace_step(&with, launch);
        subspace_step(&without, launch);
        assert_memory_equal(with.now, without.now, TEST_NUMBERS * sizeof *with.now);
    }
}

TEST(components_stay_in_their_range) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const float last[TEST_NUMBERS] = {0}, now[TEST_NUMBERS] = {1, -1};
    net->high[0] = 2.5f;
    net->low[1] = -1.5f;
    OWN(Subspace) subspace = begin(net, 1, true);
    subspace_start(&subspace, last, now);
    SubspaceReport report = subspace_step(&subspace, launch);
    assert_int_equal(report.beyond, 1);
    assert_near(subspace.now[1], -1.5, 0);
    report = subspace_step(&subspace, launch);
    assert_int_equal(report.beyond, 2);
    assert_near(subspace.now[0], 2.5, 0);
}

TEST(what_is_not_finite_stays) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    const float last[TEST_NUMBERS] = {0}, now[TEST_NUMBERS] = {1, 2};
    SubspacePredictor *predictor = &net->predictors[1];
    predictor->last.biases[0] = 3e38f;
    predictor->linear[0] = 3e38f;
    OWN(Subspace) subspace = begin(net, 1, true);
    subspace_start(&subspace, last, now);
    const SubspaceReport report = subspace_step(&subspace, launch);
    assert_int_equal(report.not_finite, 1);
    assert_near(subspace.now[0], 1, 0);
    assert_near(subspace.now[1], 4, 0);
}

TEST(a_predictor_of_at_most_so_many_is_chosen) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(0);
    assert_int_equal(subspace_net_choose(net, 2)->components, 4);
    assert_int_equal(subspace_net_choose(net, 7)->components, 4);
    assert_int_equal(subspace_net_choose(net, 8)->components, 8);
    assert_int_equal(subspace_net_choose(net, 128)->components, 8);
}

RUN_TESTS(NULL, NULL)

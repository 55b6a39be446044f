/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates with known values: the engine agrees with itself, a network that predicts zero has the warm start's rates, one
   that predicts the mean has the constant predictor's. */
#include "methods/pair_networks.h"

#include "paper/paper_internal.h"

static const Sampling sampling = {.after = 20, .rest = 60};

/* Sampled from one launch of the stack. */
static Scene *scene;
static SnapshotList list;

FIXTURE(sample_stack) {
    scene = scene_named("stack");
    scene->frames = 150;
    assert_ok(snapshots_add(&list, scene, &sampling, &error), error);
}

FIXTURE(free_stack) {
    snapshots_free(&list);
    scene_destroy(scene);
}

/* Without hidden layers and with weights 0: it always predicts `mean`. */
static const char *write_constant(PairView view, PairTarget target, int outputs, const float *mean) {
    Network *network = make_pair_network(view, target, outputs);
    for (int k = 0; k < outputs; k++) network->biases[0][k] = network->output_mean[k] = mean[k];
    return write_pair_network(network);
}

static PairRates measure(const char *path) {
    Error error = {0};
    PairRates rates;
    assert_ok(pair_rates_measure(path, scene, &list, 1, &sampling, &rates, &error), error);
    return rates;
}

TEST(the_engine_agrees_with_itself) {
    PairRates rates = measure(NULL);
    for (int phase = 0; phase < RATE_PHASES; phase++) {
        assert_near(rates.share[RATE_RANGE][phase][RATE_ENGINE10], 1, 0);
        assert_near(rates.share[RATE_ABSOLUTE][phase][RATE_ENGINE10], 1, 0);
        assert_true(isnan(rates.share[RATE_RANGE][phase][RATE_CONSTANT]));
        assert_true(isnan(rates.share[RATE_BODIES][phase][RATE_CONSTANT]));
    }
    /* At the impact one sweep is not ten, and ten are not converged. */
    assert_true(rates.share[RATE_ABSOLUTE][PHASE_IMPACT][RATE_ENGINE1] < 0.9);
    assert_true(rates.share[RATE_BODIES][PHASE_IMPACT][RATE_ENGINE10] < 0.9);
}

TEST(a_contact_net_that_says_nothing_is_the_warm_start) {
    const PairRates warm = measure(NULL);
    const char *path = write_constant(PAIR_NEIGHBOURS, TARGET_POINTS, PAIR_POINT_CHANGES, (const float[4]){0});
    const PairRates rates = measure(path);
    for (int definition = 0; definition < RATE_DEFINITIONS; definition++)
        for (int phase = 0; phase < RATE_PHASES; phase++)
            assert_near(rates.share[definition][phase][RATE_NETWORK], warm.share[definition][phase][RATE_NETWORK], 0);
}

/* For every target: such a network has the rates of its constant predictor. */
TEST(a_network_that_predicts_the_mean_has_the_constants_rates) {
    static const struct {
        PairView view;
        PairTarget target;
        int outputs;
    } kinds[] = {{PAIR_RELATIVE, TARGET_PAIR, 2},   {PAIR_RELATIVE, TARGET_PAIR, 6},
                 {PAIR_RAW, TARGET_NET, 2},         {PAIR_CONTACT, TARGET_PAIR, 2},
                 {PAIR_NEIGHBOURS, TARGET_NET, 2},  {PAIR_RELATIVE, TARGET_IMPULSE, 2},
                 {PAIR_CONTACT, TARGET_IMPULSE, 2}, {PAIR_CONTACT, TARGET_POINTS, 4}};
    const float mean[6] = {0.125f, 0.25f, 0, 0.375f, 0.5f, 0};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        const char *path = write_constant(kinds[i].view, kinds[i].target, kinds[i].outputs, mean);
        const PairRates rates = measure(path);
        for (int definition = 0; definition < RATE_DEFINITIONS; definition++) {
            double network = rates.share[definition][RATE_ALL][RATE_NETWORK];
            double constant = rates.share[definition][RATE_ALL][RATE_CONSTANT];
            bool no_step = definition == RATE_BODIES && kinds[i].target == TARGET_IMPULSE && i == 6;
            if (no_step)
                assert_true(isnan(network) && isnan(constant));
            else
                assert_near(network, constant, 1e-12);
        }
    }
}

/* all = (impact + 20 after + 60 rest) / (their counts, weighted alike), of bodies that move. */
TEST(sampled_phases_weigh_as_all_their_steps) {
    const PairRates rates = measure(NULL);
    const double(*share)[RATE_COLUMNS] = rates.share[RATE_BODIES];
    static const double weights[PHASES] = {1, 20, 60};
    double right = 0, all = 0;
    for (int i = 0; i < list.count; i++) {
        const World *world = list.items[i].world;
        const Phase phase = list.items[i].phase;
        for (int body = 0; body < world_body_count(world); body++)
            if (world_bodies(world)[body].inv_mass > 0) {
                right += weights[phase] * share[phase][RATE_ENGINE1];
                all += weights[phase];
            }
    }
    assert_near(share[RATE_ALL][RATE_ENGINE1], right / all, 1e-12);
}

/* A value between its parts. */
TEST(all_lies_between_the_phases) {
    const PairRates rates = measure(NULL);
    const double(*share)[RATE_COLUMNS] = rates.share[RATE_ABSOLUTE];
    double least = 1, most = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        least = fmin(least, share[phase][RATE_ENGINE1]);
        most = fmax(most, share[phase][RATE_ENGINE1]);
    }
    assert_true(least < share[RATE_ALL][RATE_ENGINE1] && share[RATE_ALL][RATE_ENGINE1] < most);
}

RUN_TESTS(sample_stack, free_stack)

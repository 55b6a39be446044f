/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits to a few impacts of the stack. */
#include "impacts.h"

#include <omp.h>

enum { LAUNCHES = 3, SAMPLES = 24, SWEEPS = 6 };

/* Followed by sweeps without momentum. */
static SceneNet *begin_with(SceneNetSamples *samples, int launches) {
    *samples = labelled_impacts(launches);
    SceneNet *network = network_for(samples);
    network->sweeps = SWEEPS;
    return network;
}

static SceneNet *begin(SceneNetSamples *samples) {
    SceneNet *network = begin_with(samples, LAUNCHES);
    assert_in_range(samples->count, SAMPLES / 2, SAMPLES);
    return network;
}

static void end(SceneNetSamples *samples, SceneNet *network) {
    scene_net_destroy(network);
    scene_net_samples_free(samples);
}

static SceneNetFit fit_of(int impulse_epochs, int epochs, double rate, bool factors) {
    return (SceneNetFit){.impulse_weight = 0.1,
                         .impulse_epochs = impulse_epochs,
                         .epochs = epochs,
                         .rate = rate,
                         .learn_factors = factors,
                         .seed = 1};
}

static void fit_to(SceneNet *network, const SceneNetSamples *samples, SceneNetFit fit) {
    Error error = {0};
    assert_ok(scene_net_fit(network, samples, &fit, NULL, &error), error);
}

static double mean_error(const SceneNet *network, const SceneNetSamples *samples) {
    Error error = {0};
    double mean;
    assert_ok(scene_net_error(network, samples, &mean, &error), error);
    return mean;
}

TEST(a_few_samples_are_learned) {
    SceneNetSamples samples;
    SceneNet *network = begin(&samples);
    const double before = mean_error(network, &samples);
    fit_to(network, &samples, fit_of(60, 200, 0.02, true));
    const double after = mean_error(network, &samples);

    assert_true(after < before / 3);
    assert_true(network->factors[0] == 0);
    bool learned = false;
    for (int s = 0; s < SWEEPS; s++) {
        assert_true(network->factors[s] >= 0 && network->factors[s] <= 2);
        learned |= network->factors[s] > 0;
    }
    assert_true(learned);
    end(&samples, network);
}

/* Only the velocity loss has a gradient with respect to the factors. */
TEST(factors_change_only_if_learned) {
    SceneNetSamples samples;
    SceneNet *network = begin(&samples);
    for (int s = 1; s < SWEEPS; s++) network->factors[s] = 0.5f;
    fit_to(network, &samples, fit_of(0, 3, 0.01, false));
    for (int s = 1; s < SWEEPS; s++) assert_true(network->factors[s] == 0.5f);
    fit_to(network, &samples, fit_of(3, 3, 0.01, true));
    for (int s = 1; s < SWEEPS; s++) assert_true(network->factors[s] == 0.5f);
    fit_to(network, &samples, fit_of(0, 3, 0.01, true));
    for (int s = 1; s < SWEEPS; s++) assert_true(network->factors[s] != 0.5f);
    end(&samples, network);
}

/* Adam's first step has the size of the rate for every parameter with a gradient. */
TEST(the_first_step_has_the_size_of_the_rate) {
    SceneNetSamples samples;
    SceneNet *network = begin(&samples);
    float *before = malloc(network->parameter_count * sizeof *before);
    assert_non_null(before);
    memcpy(before, network->parameters, network->parameter_count * sizeof *before);
    fit_to(network, &samples, fit_of(0, 1, 0.01, false));
    int moved = 0;
    for (size_t p = 0; p < network->parameter_count; p++) {
        const double step = fabs((double)(network->parameters[p] - before[p]));
        assert_true(step < 0.01 + 1e-6);
        moved += step > 0.0099;
    }
    assert_true(2 * (size_t)moved > network->parameter_count);
    free(before);
    end(&samples, network);
}

TEST(a_loss_of_nan_is_an_error_naming_the_epoch) {
    SceneNetSamples samples;
    SceneNet *network = begin(&samples);
    const SceneNetFit fit = fit_of(2, 9, 0.01, false);
    /* The velocity loss starts in the third epoch. */
    samples.items[7].step.velocities[3].x = NAN;
    assert_refused(scene_net_fit(network, &samples, &fit, NULL, &error), "diverged in epoch 3");
    end(&samples, network);
    error = (Error){0};
    network = begin(&samples);
    samples.items[7].step.impulses[samples.items[7].view.contacts[0]].normal = INFINITY;
    assert_refused(scene_net_fit(network, &samples, &fit, NULL, &error), "diverged in epoch 1");
    end(&samples, network);
}

static bool stop_after_three(void *context, double done, double total) {
    (void)total;
    ++*(int *)context;
    return done < 3;
}

TEST(a_stopped_fit_keeps_its_parameters) {
    SceneNetSamples samples;
    SceneNet *network = begin(&samples);
    int epochs = 0;
    const Progress progress = {stop_after_three, &epochs};
    const double before = mean_error(network, &samples);
    const SceneNetFit fit = fit_of(0, 90, 4e-3, true);
    assert_ok(scene_net_fit(network, &samples, &fit, &progress, &error), error);
    assert_int_equal(epochs, 3);
    for (size_t p = 0; p < network->parameter_count; p++) assert_true(isfinite(network->parameters[p]));
    assert_true(mean_error(network, &samples) < before);
    assert_true(network->factors[1] > 0 || network->factors[2] > 0);
    end(&samples, network);
}

int main(void) {
    /* With so little work, two threads would mostly wait for each other. */
    omp_set_num_threads(1);
    return _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loss of scene-net on impacts of the stack, and its gradient against finite differences. */
#include "impacts.h"
#include "owned.h"

#include "engine/uniform.h"
#include "methods/reference.h"

enum { LAUNCHES = 4, SWEEPS = 6, OF_EACH_BLOCK = 6 };

static const double hand_tuned[SWEEPS] = {0, 0.3, 0.5, 0.6, 0.7, 0.8}, no_momentum[SWEEPS] = {0};

/* A network and the sample that its loss is evaluated on. */
typedef struct Trial {
    SceneNetSamples samples;
    SceneNet *network;
    const SceneNetSample *sample;
    SceneNetLoss loss;
    SceneNetTask task;
    double factors[SWEEPS];
} Trial;

/* Outputs as large as the scales, and nonzero biases. */
static void begin(Trial *trial) {
    uint32_t seed = 4;
    *trial = (Trial){.samples = labelled_impacts(LAUNCHES)};
    SceneNet *network = trial->network = network_for(&trial->samples);
    const int hidden = scene_net_hidden(network), outputs = 2 * network->slot_count;
    for (int i = 0; i < hidden; i++) network->first.biases[i] = uniform(&seed, -0.5f, 0.5f);
    for (int i = 0; i < hidden; i++) network->second.biases[i] = uniform(&seed, -0.5f, 0.5f);
    for (int i = 0; i < hidden * outputs; i++) network->rows[i] *= 5;
    for (int i = 0; i < outputs; i++) network->biases[i] = uniform(&seed, -0.5f, 0.5f);
    scene_net_pack(network);
}

static void end(Trial *trial) {
    scene_net_loss_free(&trial->loss);
    scene_net_destroy(trial->network);
    scene_net_samples_free(&trial->samples);
}

static void choose(Trial *trial, int sample, double impulse_weight, double velocity_weight, const double *factors) {
    memcpy(trial->factors, factors, sizeof trial->factors);
    trial->sample = &trial->samples.items[sample];
    trial->task = (SceneNetTask){impulse_weight, velocity_weight, SWEEPS, trial->factors};
}

static double loss_of(Trial *trial) {
    SceneNetErrors score;
    assert_true(scene_net_loss(&trial->loss, trial->network, trial->sample, &trial->task, NULL, NULL, &score));
    return score.loss;
}

/* The pieces that the sweeps took. If they differ between two evaluations, there is a kink between these. */
static uint8_t *pieces_of(const Trial *trial) {
    const size_t count = (SWEEPS + 1) * (size_t)trial->sample->step.problem.contact_count;
    uint8_t *pieces = malloc(count + 1);
    assert_non_null(pieces);
    memcpy(pieces, trial->loss.unrolled.pieces, count);
    return pieces;
}

typedef struct Tally {
    int checked, kinks, moved;
} Tally;

/* Compares the change of the loss between two steps with the gradient's prediction. The tolerance covers the single
   precision of the outputs. */
static void compare(Trial *trial, double ahead, const uint8_t *taken, double behind, double expected, double unit,
                    Tally *tally) {
    const size_t count = (SWEEPS + 1) * (size_t)trial->sample->step.problem.contact_count;
    if (trial->task.velocity_weight > 0 && memcmp(taken, trial->loss.unrolled.pieces, count) != 0) {
        tally->kinks++;
        return;
    }
    assert_near(expected, ahead - behind, unit + 0.02 * fabs(ahead - behind));
    tally->checked++;
    tally->moved += fabs(ahead - behind) > 10 * unit;
}

/* Steps a block along its gradient (only < 0) or one number of it. */
static void check_block(Trial *trial, float *block, const float *gradient, int count, int only, double step,
                        Tally *tally) {
    double length = 0, expected = 0;
    for (int i = 0; i < count; i++) length = hypot(length, (double)gradient[i]);
    float *kept = malloc((size_t)count * sizeof *kept);
    assert_non_null(kept);
    memcpy(kept, block, (size_t)count * sizeof *kept);
    double loss[2];
    uint8_t *taken = NULL;
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < count; i++) {
            const double share = only < 0 ? (double)gradient[i] / length : i == only;
            block[i] = (float)((double)kept[i] + (side == 0 ? step : -step) * share);
            expected += (side == 0 ? 1 : -1) * (double)gradient[i] * (double)(block[i] - kept[i]);
        }
        loss[side] = loss_of(trial);
        if (side == 0) taken = pieces_of(trial);
    }
    memcpy(block, kept, (size_t)count * sizeof *kept);
    compare(trial, loss[0], taken, loss[1], expected, 1e-6 * (1 + loss[0]), tally);
    free(taken);
    free(kept);
}

/* Steps one number of packed rows by its unit. */
static void check_byte(Trial *trial, const PackedRows *packed, const float *gradient, int64_t place, Tally *tally) {
    const int8_t kept = packed->numbers[place];
    if (kept == INT8_MAX || kept == -INT8_MAX) return;
    packed->numbers[place] = (int8_t)(kept + 1);
    const double ahead = loss_of(trial);
    FREED uint8_t *taken = pieces_of(trial);
    packed->numbers[place] = (int8_t)(kept - 1);
    const double behind = loss_of(trial);
    packed->numbers[place] = kept;
    const double expected = 2 * (double)packed->units[place / packed->width] * (double)gradient[place];
    compare(trial, ahead, taken, behind, expected, 1e-6 * (1 + ahead), tally);
}

static void check_rows(Trial *trial, const PackedRows *packed, const float *gradient, uint32_t *seed, Tally *tally) {
    float *by_units = calloc((size_t)packed->count, sizeof *by_units);
    assert_non_null(by_units);
    for (int i = 0; i < packed->count; i++)
        for (int64_t k = i * packed->width; k < (i + 1) * packed->width; k++)
            by_units[i] += gradient[k] * (float)packed->numbers[k];
    check_block(trial, packed->units, by_units, packed->count, -1, 2e-5, tally);
    free(by_units);
    for (int i = 0; i < OF_EACH_BLOCK; i++)
        check_byte(trial, packed, gradient, (int64_t)uniform(seed, 0, (float)(packed->count * packed->width) - 1),
                   tally);
}

static void check_biases(Trial *trial, float *biases, const float *gradient, int count, uint32_t *seed, Tally *tally) {
    const float *part = gradient + (biases - trial->network->parameters);
    check_block(trial, biases, part, count, -1, 2e-3, tally);
    for (int i = 0; i < OF_EACH_BLOCK; i++)
        check_block(trial, biases, part, count, (int)uniform(seed, 0, (float)count - 0.01f), 2e-3, tally);
}

static void check_parameters(Trial *trial, const float *gradient, uint32_t *seed, Tally tallies[6]) {
    SceneNet *network = trial->network;
    const int hidden = scene_net_hidden(network), outputs = 2 * network->slot_count;
    check_rows(trial, &network->first.packed, gradient + (network->first.rows - network->parameters), seed,
               &tallies[0]);
    check_rows(trial, &network->second.packed, gradient + (network->second.rows - network->parameters), seed,
               &tallies[1]);
    check_rows(trial, &network->packed, gradient + (network->rows - network->parameters), seed, &tallies[2]);
    check_biases(trial, network->first.biases, gradient, hidden, seed, &tallies[3]);
    check_biases(trial, network->second.biases, gradient, hidden, seed, &tallies[4]);
    check_biases(trial, network->biases, gradient, outputs, seed, &tallies[5]);
}

static void check_factors(Trial *trial, const double *by_factors, Tally *tally) {
    const double step = 1e-3;
    for (int s = 1; s < SWEEPS; s++) {
        const double kept = trial->factors[s];
        trial->factors[s] = kept + step;
        const double ahead = loss_of(trial);
        FREED uint8_t *taken = pieces_of(trial);
        trial->factors[s] = kept - step;
        compare(trial, ahead, taken, loss_of(trial), 2 * step * by_factors[s], 1e-9, tally);
        trial->factors[s] = kept;
    }
}

/* Gradients are added to the given array. Kinks and numbers without effect must be few, or errors would go
   unnoticed. */
static void assert_gradient(double impulse_weight, double velocity_weight, const double *factors) {
    Trial trial;
    Tally parameters[6] = {{0}}, of_factors = {0};
    uint32_t seed = 8;
    begin(&trial);
    const size_t count = trial.network->parameter_count;
    float *gradient = calloc(count, sizeof *gradient);
    assert_non_null(gradient);
    for (int i = 0; i < trial.samples.count; i += 3) {
        double by_factors[SWEEPS];
        SceneNetErrors score;
        choose(&trial, i, impulse_weight, velocity_weight, factors);
        for (size_t p = 0; p < count; p++) gradient[p] = 1;
        for (int s = 0; s < SWEEPS; s++) by_factors[s] = 7;
        assert_true(
            scene_net_loss(&trial.loss, trial.network, trial.sample, &trial.task, gradient, by_factors, &score));
        assert_true(score.loss == loss_of(&trial));
        for (size_t p = 0; p < count; p++) gradient[p] -= 1;
        for (int s = 0; s < SWEEPS; s++) by_factors[s] -= 7;
        check_parameters(&trial, gradient, &seed, parameters);
        if (velocity_weight > 0) check_factors(&trial, by_factors, &of_factors);
    }
    for (int b = 0; b < 6; b++) {
        assert_true(parameters[b].kinks * 4 < parameters[b].checked);
        assert_true(parameters[b].moved >= 5);
    }
    assert_true(of_factors.kinks * 4 < of_factors.checked || velocity_weight == 0);
    assert_true(of_factors.moved * 2 > of_factors.checked || velocity_weight == 0);
    free(gradient);
    end(&trial);
}

TEST(impulse_loss_has_the_gradient_of_differences) { assert_gradient(1, 0, hand_tuned); }

TEST(velocity_loss_has_the_gradient_of_differences) {
    assert_gradient(0, 1, no_momentum);
    assert_gradient(0, 1, hand_tuned);
}

TEST(both_have_the_gradient_of_differences) { assert_gradient(0.4, 2, hand_tuned); }

/* The error is that of solution_error(); the loss is nearly quadratic for small errors. */
TEST(the_error_is_that_of_the_studies) {
    Trial trial;
    begin(&trial);
    for (int i = 0; i < trial.samples.count; i++) {
        choose(&trial, i, 0, 3, hand_tuned);
        SceneNetErrors score;
        assert_true(scene_net_loss(&trial.loss, trial.network, trial.sample, &trial.task, NULL, NULL, &score));
        BodyVelocity velocities[16];
        assert_in_range(trial.sample->step.problem.body_count, 2, 16);
        for (int k = 0; k < trial.sample->step.problem.body_count; k++) {
            const double *v = trial.loss.unrolled.velocities + 3 * k;
            velocities[k] = (BodyVelocity){vec2((float)v[0], (float)v[1]), (float)v[2]};
        }
        assert_near(score.error,
                    solution_error(&trial.sample->step.problem, velocities, trial.sample->step.velocities).rms, 1e-5);
        assert_near(score.loss, 3 * hypot(score.error, 0.01), 1e-12 * (1 + score.loss));
    }
    end(&trial);
}

/* With outputs of 0 the impulses are those of the base. */
TEST(impulse_loss_is_a_mean_over_slots) {
    Trial trial;
    int linear = 0, quadratic = 0;
    begin(&trial);
    SceneNet *network = trial.network;
    memset(network->rows, 0,
           (network->parameter_count - (size_t)(network->rows - network->parameters)) * sizeof(float));
    scene_net_pack(network);
    for (int i = 0; i < trial.samples.count; i++) {
        choose(&trial, i, 2, 0, no_momentum);
        const SceneView *view = &trial.sample->view;
        double sum = 0;
        for (int k = 0; k < view->slots.slot_count; k++) {
            const ContactImpulse base = view->base[view->contacts[k]],
                                 goal = trial.sample->step.impulses[view->contacts[k]];
            const double scale = (double)network->scale[view->slots.slots[k]];
            const double apart[2] = {fabs((double)base.normal - (double)goal.normal) / scale,
                                     fabs((double)base.tangent - (double)goal.tangent) / scale};
            for (int c = 0; c < 2; c++) {
                sum += apart[c] < 0.3 ? apart[c] * apart[c] / 0.6 : apart[c] - 0.15;
                linear += apart[c] >= 0.3;
                quadratic += apart[c] < 0.3;
            }
        }
        assert_near(loss_of(&trial), 2 * sum / view->slots.slot_count, 1e-9 * sum);
    }
    assert_true(linear > 50 && quadratic > 50);
    end(&trial);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/scene_training.h"

#include "impact_training/scene_recording.h"
#include "impact_training/slot_fit.h"
#include "solvers/momentum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double impulse_weight = 0.02, first_rate = 3e-3;

typedef struct Trainer {
    const Scene *scene;
    const SceneTraining *training;
    SceneRecording recording;
    SlotSamples samples, held_out;
    SlotNetwork *network;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static void next_stage(Trainer *trainer, double share) {
    trainer->stage.begin += trainer->stage.share;
    trainer->stage.share = share;
}

static bool take(Trainer *trainer, SceneSet set, SlotSamples *samples, double share, Error *error) {
    next_stage(trainer, share);
    return scene_recording_take(&trainer->recording, set, samples, &trainer->progress, error);
}

/* The range of each input over the samples, with a margin. */
static void find_bounds(SlotNetwork *network, const SlotSamples *samples) {
    const float margin = 0.1f;
    for (int k = 0; k < slot_network_inputs(network); k++) {
        float low = samples->items[0].inputs[k], high = low;
        for (int i = 1; i < samples->count; i++) {
            low = fminf(low, samples->items[i].inputs[k]);
            high = fmaxf(high, samples->items[i].inputs[k]);
        }
        network->low[k] = low - margin * (high - low) - 1e-6f;
        network->high[k] = high + margin * (high - low) + 1e-6f;
    }
}

static bool first_round(Trainer *trainer, Error *error) {
    const SceneTraining *training = trainer->training;
    if (!take(trainer, SCENE_BY_MOMENTUM, &trainer->samples, 0.1, error) ||
        !take(trainer, SCENE_BY_REFERENCE, &trainer->samples, 0.1, error))
        return false;
    trainer->network = slot_network_from_samples(&trainer->samples, &training->widths, training->seed, error);
    if (trainer->network == NULL) return false;
    SlotNetwork *network = trainer->network;
    snprintf(network->scene, sizeof network->scene, "%s", trainer->scene->name);
    network->gate = SCENE_RECORDING_GATE;
    network->bomb_inv_mass = trainer->samples.items[0].problem.bodies[network->bomb].inv_mass;
    network->sweeps = training->sweeps;
    for (int s = 0; s < training->sweeps && training->momentum; s++)
        network->factors[s] = momentum_factor_tuned(s, training->sweeps);
    return true;
}

static bool next_round(Trainer *trainer, double share, Error *error) {
    const int had = trainer->samples.count;
    next_stage(trainer, share);
    return scene_recording_next(&trainer->recording, trainer->network, &trainer->samples, &trainer->progress, error) &&
           slot_samples_compute_inputs(&trainer->samples, had, trainer->network, error);
}

static bool score(const Trainer *trainer, int round, Error *error) {
    SceneNetScore result = {.round = round};
    if (!scene_net_score(trainer->network, &trainer->samples, &trainer->held_out, &result, error)) return false;
    if (trainer->training->on_score != NULL) trainer->training->on_score(trainer->training->context, &result);
    return true;
}

static bool fit_round(Trainer *trainer, int round, double share, Error *error) {
    const SceneTraining *training = trainer->training;
    const int epochs = round == 0 ? training->epochs : (training->epochs + 1) / 2;
    const SlotFit fit = {.impulse_weight = impulse_weight,
                         .impulse_epochs = round == 0 ? epochs / 12 : 0,
                         .epochs = epochs,
                         .rate = round == 0 ? first_rate : first_rate / 2,
                         .learn_factors = training->momentum,
                         .seed = training->seed + (uint64_t)round};
    next_stage(trainer, share);
    if (!slot_fit(trainer->network, &trainer->samples, &fit, &trainer->progress, error)) return false;
    find_bounds(trainer->network, &trainer->samples);
    return score(trainer, round, error);
}

static bool train(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds;
    const double share = 0.78 / rounds;
    if (!scene_recording_begin(&trainer->recording, trainer->scene, trainer->training, error) ||
        !take(trainer, SCENE_HELD_OUT, &trainer->held_out, 0.02, error) || !first_round(trainer, error) ||
        !slot_samples_compute_inputs(&trainer->held_out, 0, trainer->network, error) ||
        !fit_round(trainer, 0, share, error))
        return false;
    for (int round = 1; round < rounds && !trainer->stage.stopped; round++) {
        Error failure = {0};
        if (next_round(trainer, 0.3 * share, &failure)) {
            if (!fit_round(trainer, round, 0.7 * share, error)) return false;
        } else if (!trainer->stage.stopped) {
            *error = failure;
            return false;
        }
    }
    return true;
}

SlotNetwork *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress,
                                Error *error) {
    Trainer trainer = {.scene = scene, .training = training, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    bool ok = train(&trainer, error);
    if (ok && training->verdict != NULL)
        ok = scene_net_verdict(trainer.network, &trainer.held_out, training->verdict, error);
    scene_recording_end(&trainer.recording);
    slot_samples_free(&trainer.samples);
    slot_samples_free(&trainer.held_out);
    if (ok) return trainer.network;
    slot_network_destroy(trainer.network);
    return NULL;
}

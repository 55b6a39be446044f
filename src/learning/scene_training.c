/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of scene-net: rounds of recording and fitting, scores, and the verdict against momentum at equal time. */
#include "learning/scene_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/scene_training_internal.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

/* Sweeps of the timed rivals, between which time is linear; most sweeps; turns of all rivals. */
enum { FEW_SWEEPS = 10, MANY_SWEEPS = 60, MOST_SWEEPS = 200, PASSES = 7 };

/* No sweeps follow by the stopping rule. */
static const float never = 1e9f; /* m/s */

/* Solves all samples. s: the time of the solver alone, if shorter than before. m/s: the mean error. */
static bool solve_all(ContactSolver *solver, const SceneNetSamples *samples, PairMoment *space, double *seconds,
                      double *mean, Error *error) {
    double sum = 0, passed = 0;
    for (int i = 0; i < samples->count; i++) {
        const SceneNetSample *sample = &samples->items[i];
        if (!pair_moment_reserve(space, &sample->problem)) return error_memory(error, "scene-net");
        ContactSolution solution = pair_moment_solution(space);
        const double begin = clock_seconds();
        if (!solver->kind->solve(solver->state, &sample->problem, &solution, error)) return false;
        passed += clock_seconds() - begin;
        sum += solution_error(&sample->problem, solution.velocities, sample->reference).rms;
    }
    if (passed < *seconds) *seconds = passed;
    *mean = sum / samples->count;
    return true;
}

static bool make_momentum(ContactSolver *solver, int sweeps, Error *error) {
    char text[16];
    snprintf(text, sizeof text, "k=%d", sweeps);
    return solver_with(solver, &solver_momentum, text, error);
}

static bool momentum_error(const SceneNetSamples *samples, int sweeps, PairMoment *space, double *mean, Error *error) {
    ContactSolver solver = {0};
    double unused = INFINITY;
    const bool ok = make_momentum(&solver, sweeps, error) && solve_all(&solver, samples, space, &unused, mean, error);
    solver_destroy(&solver);
    return ok;
}

/* The number of sweeps whose time is nearest. */
static int sweeps_of(double seconds, double few, double many) {
    const double sweep = (many - few) / (MANY_SWEEPS - FEW_SWEEPS);
    const double sweeps = sweep > 0 ? round(FEW_SWEEPS + (seconds - few) / sweep) : MOST_SWEEPS;
    return (int)fmin(fmax(sweeps, 1), MOST_SWEEPS);
}

static bool scene_training_measure(ContactSolver rivals[3], const SceneNetSamples *samples, PairMoment *space,
                                   SceneNetVerdict *verdict, Error *error) {
    double seconds[3] = {INFINITY, INFINITY, INFINITY}, mean[3];
    for (int pass = 0; pass < PASSES; pass++)
        for (int i = 0; i < 3; i++)
            if (!solve_all(&rivals[i], samples, space, &seconds[i], &mean[i], error)) return false;
    verdict->samples = samples->count;
    verdict->network = mean[0];
    verdict->microseconds = 1e6 * seconds[0] / samples->count;
    verdict->sweeps = sweeps_of(seconds[0], seconds[1], seconds[2]);
    return momentum_error(samples, verdict->sweeps, space, &verdict->at_equal_time, error) &&
           momentum_error(samples, 20, space, &verdict->at_20, error);
}

/* Solves the samples by the method scene-net and by momentum, in turns, and keeps the shortest time of each. The errors
   are the same on every machine; `sweeps` depends on it. */
static bool scene_net_verdict(const SceneNet *network, const SceneNetSamples *held_out, SceneNetVerdict *verdict,
                              Error *error) {
    ContactSolver rivals[3] = {{0}};
    PairMoment space = {0};
    *verdict = (SceneNetVerdict){.samples = 0};
    bool ok = held_out->count == 0 ||
              (scene_net_make(&rivals[0], network, never, error) && make_momentum(&rivals[1], FEW_SWEEPS, error) &&
               make_momentum(&rivals[2], MANY_SWEEPS, error) &&
               scene_training_measure(rivals, held_out, &space, verdict, error));
    for (int i = 0; i < 3; i++) solver_destroy(&rivals[i]);
    pair_moment_free(&space);
    return ok;
}

/* Mean error of the network and its sweeps. */
static bool network_error(const SceneNet *network, const SceneNetSamples *samples, double *result, Error *error) {
    double *errors = malloc(((size_t)samples->count + 1) * sizeof *errors), sum = 0;
    bool ok = errors != NULL || error_memory(error, "scene-net");
    ok = ok && slot_errors(network, samples, 0, errors, error);
    for (int i = 0; ok && i < samples->count; i++) sum += errors[i];
    *result = samples->count > 0 ? sum / samples->count : NAN;
    free(errors);
    return ok;
}

/* Fills all except `round`; NaN for an empty set. Both sets have the network's inputs
   (scene_net_samples_compute_inputs). */
static bool scene_net_score(const SceneNet *network, const SceneNetSamples *samples, const SceneNetSamples *held_out,
                            SceneNetScore *score, Error *error) {
    PairMoment space = {0};
    score->samples = samples->count;
    const bool ok = network_error(network, samples, &score->train, error) &&
                    network_error(network, held_out, &score->held_out, error) &&
                    momentum_error(held_out, 20, &space, &score->momentum, error);
    pair_moment_free(&space);
    return ok;
}

static const double impulse_weight = 0.02, first_rate = 3e-3;

typedef struct Trainer {
    const Scene *scene;
    const SceneTraining *training;
    SceneRecording recording;
    SceneNetSamples samples, held_out;
    SceneNet *network;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static bool scene_training_take(Trainer *trainer, SceneSet set, SceneNetSamples *samples, double share, Error *error) {
    progress_next_stage(&trainer->stage, share);
    return scene_recording_take(&trainer->recording, set, samples, &trainer->progress, error);
}

/* The range of each input over the samples, with a margin. */
static void find_bounds(SceneNet *network, const SceneNetSamples *samples) {
    const float margin = 0.1f;
    for (int k = 0; k < scene_net_inputs(network); k++) {
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
    if (!scene_training_take(trainer, SCENE_BY_MOMENTUM, &trainer->samples, 0.1, error) ||
        !scene_training_take(trainer, SCENE_BY_REFERENCE, &trainer->samples, 0.1, error))
        return false;
    trainer->network = scene_net_from_samples(&trainer->samples, &training->widths, training->seed, error);
    if (trainer->network == NULL) return false;
    SceneNet *network = trainer->network;
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
    progress_next_stage(&trainer->stage, share);
    return scene_recording_next(&trainer->recording, trainer->network, &trainer->samples, &trainer->progress, error) &&
           scene_net_samples_compute_inputs(&trainer->samples, had, trainer->network, error);
}

static bool scene_training_score(const Trainer *trainer, int round, Error *error) {
    SceneNetScore result = {.round = round,
                            .unconverged = trainer->samples.unconverged + trainer->held_out.unconverged};
    if (!scene_net_score(trainer->network, &trainer->samples, &trainer->held_out, &result, error)) return false;
    if (trainer->training->on_score != NULL) trainer->training->on_score(trainer->training->context, &result);
    return true;
}

static bool fit_round(Trainer *trainer, int round, double share, Error *error) {
    const SceneTraining *training = trainer->training;
    const int epochs = round == 0 ? training->epochs : (training->epochs + 1) / 2;
    const SceneNetFit fit = {.impulse_weight = impulse_weight,
                             .impulse_epochs = round == 0 ? epochs / 12 : 0,
                             .epochs = epochs,
                             .rate = round == 0 ? first_rate : first_rate / 2,
                             .learn_factors = training->momentum,
                             .seed = training->seed + (uint64_t)round};
    progress_next_stage(&trainer->stage, share);
    if (!scene_net_fit(trainer->network, &trainer->samples, &fit, &trainer->progress, error)) return false;
    find_bounds(trainer->network, &trainer->samples);
    return scene_training_score(trainer, round, error);
}

static bool scene_training_train(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds;
    const double share = 0.78 / rounds;
    if (!scene_recording_begin(&trainer->recording, trainer->scene, trainer->training, error) ||
        !scene_training_take(trainer, SCENE_HELD_OUT, &trainer->held_out, 0.02, error) ||
        !first_round(trainer, error) ||
        !scene_net_samples_compute_inputs(&trainer->held_out, 0, trainer->network, error) ||
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

SceneNet *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress,
                             Error *error) {
    Trainer trainer = {.scene = scene, .training = training, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    bool ok = scene_training_train(&trainer, error);
    if (ok && training->verdict != NULL)
        ok = scene_net_verdict(trainer.network, &trainer.held_out, training->verdict, error);
    scene_recording_end(&trainer.recording);
    scene_net_samples_free(&trainer.samples);
    scene_net_samples_free(&trainer.held_out);
    if (ok) return trainer.network;
    scene_net_destroy(trainer.network);
    return NULL;
}

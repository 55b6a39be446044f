/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of scene-net: rounds of recording and fitting, and scores. */
#include "learning/scene_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/residual.h"
#include "methods/scene_net.h"
#include "methods/sweeps.h"
#include "nets/kinds.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

/* STEPS_AFTER: steps after the scene's impact frames that are samples too. */
enum { STEPS_AFTER = 2, HELD_OUT_LAUNCHES = 60, HELD_OUT_SEED = 7919 };

/* RMS residual of the warm start over the contacts, m/s: below it at rest, above it during a shock. Only the latter are
   samples. */
static const float recording_gate = 0.3f;

static const float recording_near = 0.05f; /* m/s: the setting `near` of scene-net in the runs that are recorded */

static const double impulse_weight = 0.02, first_rate = 3e-3;

typedef struct Trainer {
    const Scene *scene;
    const SceneTraining *training;
    gsl_rng *generator;
    Launch *launches; /* [training->launches] of the round */
    int round;
    bool by_reference; /* the launches that are recorded are run by the reference, or by momentum */
    SceneNetSamples samples, held_out;
    SceneNet *network; /* runs the launches of later rounds */
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

/* m/s: the mean error of momentum with 20 sweeps. */
static bool momentum_error(const SceneNetSamples *samples, double *mean, Error *error) {
    ContactSolver solver = {0};
    PairMoment space = {0};
    double sum = 0;
    bool ok = solver_with(&solver, &solver_momentum, "k=20", error);
    for (int i = 0; ok && i < samples->count; i++) {
        const RecordedStep *step = &samples->items[i].step;
        ok = pair_moment_reserve(&space, &step->problem) || error_memory(error, "scene-net");
        if (!ok) break;
        ContactSolution solution = pair_moment_solution(&space);
        ok = solver.kind->solve(solver.state, &step->problem, &solution, error);
        sum += ok ? solution_error(&step->problem, solution.velocities, step->velocities).rms : 0;
    }
    *mean = sum / samples->count;
    solver_destroy(&solver);
    pair_moment_free(&space);
    return ok;
}

/* Draws the launches of a round: every second one has a random rotation and spin. The mass is the scene's: a network is
   for one mass. */
static bool draw_launches(Trainer *trainer, int count, Error *error) {
    const Scene *scene = trainer->scene;
    for (int i = 0; i < count; i++) {
        Launch *launch = &trainer->launches[i];
        *launch = launch_of(scene);
        launch->x = scene_span_at(&scene->bomb.x, gsl_rng_uniform(trainer->generator));
        if (i % 2 == 0) continue;
        const double rotation = gsl_rng_uniform(trainer->generator), spin = gsl_rng_uniform(trainer->generator);
        launch_turn(launch, scene, rotation, spin);
    }
    return launches_check(scene, trainer->launches, count, error);
}

static bool make_driver(void *context, int i, ContactSolver *solver, Error *error) {
    const Trainer *trainer = context;
    (void)i;
    if (trainer->round > 0) return scene_net_make(solver, trainer->network, recording_near, error);
    return trainer->by_reference ? solver_with(solver, &solver_reference, "", error)
                                 : solver_with(solver, &solver_momentum, "k=20", error);
}

static bool keep_impact(void *context, const LaunchStep *step, Error *error) {
    (void)context;
    Sweeps sweeps = {0};
    if (step->phase != PHASE_IMPACT) return true;
    const bool begun = sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), step->problem);
    const bool reached = begun && residual_reaches(&sweeps, step->problem->contact_count, recording_gate);
    sweeps_free(&sweeps);
    if (!begun) return error_memory(error, "scene-net");
    return !reached || (reference_solve(step->reference, step->problem, NULL, error) &&
                        launch_step_record(step, reference_converged(step->reference), error));
}

/* Runs launches first to end - 1 of the round, and appends their impacts. */
static bool record(Trainer *trainer, int first, int end, double share, SceneNetSamples *samples, Error *error) {
    const LaunchWatch watch = {.scene = trainer->scene,
                               .launches = trainer->launches + first,
                               .count = end - first,
                               .first = trainer->round * trainer->training->launches + first,
                               .impact_frames = trainer->scene->bomb.impact_frames + STEPS_AFTER,
                               .may_fail = trainer->round > 0,
                               .make = make_driver,
                               .see = keep_impact,
                               .context = trainer};
    RecordedSteps steps = {0};
    progress_next_stage(&trainer->stage, share);
    const bool ok = launches_observe(&watch, &steps, &trainer->progress, error) &&
                    (scene_net_samples_take(samples, &steps) || error_memory(error, "scene-net"));
    recorded_steps_free(&steps);
    return ok;
}

/* Fits the network to all samples so far, finds the ranges of its inputs, and scores it. */
static bool fit_round(Trainer *trainer, double share, Error *error) {
    const SceneTraining *training = trainer->training;
    const SceneNetSamples *samples = &trainer->samples;
    SceneNet *network = trainer->network;
    const int round = trainer->round, epochs = round == 0 ? training->epochs : (training->epochs + 1) / 2;
    const SceneNetFit fit = {.impulse_weight = impulse_weight,
                             .impulse_epochs = round == 0 ? epochs / 12 : 0,
                             .epochs = epochs,
                             .rate = round == 0 ? first_rate : first_rate / 2,
                             .learn_factors = training->momentum,
                             .seed = training->seed + (uint64_t)round};
    progress_next_stage(&trainer->stage, share);
    if (!scene_net_fit(network, samples, &fit, &trainer->progress, error)) return false;

    scene_net_set_ranges(network, samples);
    SceneNetScore score = {.round = round,
                           .samples = samples->count,
                           .unconverged = (int)(samples->unconverged + trainer->held_out.unconverged)};
    const bool ok = scene_net_error(network, samples, &score.train, error) &&
                    scene_net_error(network, &trainer->held_out, &score.held_out, error) &&
                    momentum_error(&trainer->held_out, &score.momentum, error);
    if (ok && training->on_score != NULL) training->on_score(training->context, &score);
    return ok;
}

/* The held-out launches have their own random seed. The launches of all rounds are checked first: those of the last
   must not be the first to be refused. */
static bool begin(Trainer *trainer, Error *error) {
    const Scene *scene = trainer->scene;
    const SceneTraining *training = trainer->training;
    if (!scene->bomb.present) return error_input(error, scene->name, "has no bomb to launch");
    if (!scene_span_varies(&scene->bomb.x))
        return error_input(error, scene->name, "the bomb has one x; write a family of launches, x: {from: A, to: B}");
    gsl_set_error_handler_off(); /* its default aborts */
    trainer->generator = gsl_rng_alloc(gsl_rng_mt19937);
    trainer->launches = malloc((size_t)training->launches * sizeof *trainer->launches);
    if (trainer->generator == NULL || trainer->launches == NULL) return error_memory(error, "scene-net");
    gsl_rng_set(trainer->generator, (unsigned long)training->seed);
    for (int round = 0; round < training->rounds; round++)
        if (!draw_launches(trainer, training->launches, error)) return false;
    const int held_out = training->launches < HELD_OUT_LAUNCHES ? training->launches : HELD_OUT_LAUNCHES;
    gsl_rng_set(trainer->generator, (unsigned long)training->seed + HELD_OUT_SEED);
    return draw_launches(trainer, held_out, error) && record(trainer, 0, held_out, 0.02, &trainer->held_out, error);
}

/* Half of the launches are run by momentum, half by the reference. */
static bool first_round(Trainer *trainer, Error *error) {
    const SceneTraining *training = trainer->training;
    const int half = training->launches / 2;
    gsl_rng_set(trainer->generator, (unsigned long)training->seed);
    if (!draw_launches(trainer, training->launches, error) || !record(trainer, 0, half, 0.1, &trainer->samples, error))
        return false;
    trainer->by_reference = true;
    if (!record(trainer, half, training->launches, 0.1, &trainer->samples, error)) return false;
    SceneNet *network = trainer->network =
        scene_net_from_samples(&trainer->samples, &training->widths, training->seed, error);
    if (network == NULL) return false;
    snprintf(network->scene, sizeof network->scene, "%s", trainer->scene->name);
    network->gate = recording_gate;
    network->bomb_inv_mass = trainer->samples.items[0].step.problem.bodies[network->bomb].inv_mass;
    network->sweeps = training->sweeps;
    for (int s = 0; s < training->sweeps && training->momentum; s++) network->factors[s] = momentum_factor(s);
    return scene_net_samples_look(&trainer->held_out, 0, network, error);
}

static bool train(Trainer *trainer, Error *error) {
    const SceneTraining *training = trainer->training;
    const double share = 0.78 / training->rounds;
    if (!begin(trainer, error) || !first_round(trainer, error) || !fit_round(trainer, share, error)) return false;
    while (++trainer->round < training->rounds && !trainer->stage.stopped) {
        Error failure = {0};
        const int had = trainer->samples.count;
        if (!draw_launches(trainer, training->launches, &failure) ||
            !record(trainer, 0, training->launches, 0.3 * share, &trainer->samples, &failure) ||
            !scene_net_samples_look(&trainer->samples, had, trainer->network, &failure))
            return trainer->stage.stopped || (*error = failure, false); /* a stopped training keeps its network */
        if (!fit_round(trainer, 0.7 * share, error)) return false;
    }
    return true;
}

SceneNet *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress,
                             Error *error) {
    Trainer trainer = {.scene = scene, .training = training, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    const bool ok = train(&trainer, error);
    if (trainer.generator != NULL) gsl_rng_free(trainer.generator);
    free(trainer.launches);
    scene_net_samples_free(&trainer.samples);
    scene_net_samples_free(&trainer.held_out);
    if (ok) return trainer.network;
    scene_net_destroy(trainer.network);
    return NULL;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/scene_training.h"

#include "impact_training/slot_fit.h"
#include "impact_training/slot_rollout.h"
#include "simulate/launch_check.h"
#include "solvers/momentum.h"
#include "solvers/scene_net.h"
#include "solvers/solvers.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* STEPS_AFTER: steps after the scene's impact frames that are samples too. */
enum { STEPS_AFTER = 2, HELD_OUT_LAUNCHES = 60, HELD_OUT_SEED = 7919 };

/* Of turned launches, unless the scene has a family of them; rad, rad/s. */
static const SceneSpan turned = {0, -1.5f, 1.5f}, spinning = {0, -20, 20};
/* RMS residual of the warm start over the contacts: below it at rest, above it during a shock. */
static const float gate = 0.3f; /* m/s */
/* The setting `near` (residual) of scene-net in the runs that record training samples. */
static const float rollout_near = 0.05f; /* m/s */
static const double impulse_weight = 0.02, first_rate = 3e-3;

typedef struct Trainer {
    const Scene *scene;
    const SceneTraining *training;
    Launch *launches; /* [launches] of the round */
    gsl_rng *generator;
    SlotSamples samples, held_out;
    SlotNetwork *network;
    int launches_done;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static float draw(Trainer *trainer, const SceneSpan *span, const SceneSpan *otherwise) {
    return scene_span_at(scene_span_varies(span) ? span : otherwise, gsl_rng_uniform(trainer->generator));
}

/* Every second launch has a random rotation and spin. The mass is the scene's: a network is for one mass. */
static void draw_launches(Trainer *trainer, int count) {
    const SceneBomb *bomb = &trainer->scene->bomb;
    for (int i = 0; i < count; i++) {
        Launch launch = launch_of(trainer->scene);
        launch.x = draw(trainer, &bomb->x, &bomb->x);
        if (i % 2 == 1) {
            launch.rotation = draw(trainer, &bomb->rotation, &turned);
            launch.spin = draw(trainer, &bomb->spin, &spinning);
        }
        trainer->launches[i] = launch;
    }
}

typedef enum Driver { BY_MOMENTUM, BY_REFERENCE, BY_NETWORK } Driver;

typedef struct DriverContext {
    Driver driver;
    const SlotNetwork *network;
} DriverContext;

static bool make_driver(void *context, ContactSolver *solver, Error *error) {
    const DriverContext *run = context;
    if (run->driver == BY_NETWORK) return scene_net_make(solver, run->network, rollout_near, error);
    Settings settings;
    const ContactSolverKind *kind = run->driver == BY_MOMENTUM ? &solver_momentum : &solver_reference;
    if (!settings_parse(&settings, run->driver == BY_MOMENTUM ? "k=20" : "", kind->description.settings,
                        kind->description.name, error))
        return false;
    void *state = kind->create(&settings, error);
    if (state == NULL) return false;
    *solver = (ContactSolver){kind, state};
    return true;
}

static void next_stage(Trainer *trainer, double share) {
    trainer->stage.begin += trainer->stage.share;
    trainer->stage.share = share;
}

/* Runs launches first .. first + count - 1 of the round with a driver and labels their samples. */
static bool record(Trainer *trainer, SlotSamples *samples, Driver driver, int first, int count, Error *error) {
    DriverContext run = {driver, trainer->network};
    const SlotRollout rollout = {.scene = trainer->scene,
                                 .launches = trainer->launches + first,
                                 .launch_count = count,
                                 .first_launch = trainer->launches_done,
                                 .steps = trainer->scene->bomb.impact_frames + STEPS_AFTER,
                                 .gate = gate,
                                 .make_solver = make_driver,
                                 .context = &run};
    const int had = samples->count;
    trainer->launches_done += count;
    return slot_rollout(&rollout, samples, NULL, error) && slot_samples_label(samples, had, &trainer->progress, error);
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
    const int half = training->launches / 2;
    next_stage(trainer, 0.1);
    if (!record(trainer, &trainer->samples, BY_MOMENTUM, 0, half, error)) return false;
    next_stage(trainer, 0.1);
    if (!record(trainer, &trainer->samples, BY_REFERENCE, half, training->launches - half, error)) return false;
    trainer->network = slot_network_from_samples(&trainer->samples, &training->widths, training->seed, error);
    if (trainer->network == NULL) return false;
    SlotNetwork *network = trainer->network;
    snprintf(network->scene, sizeof network->scene, "%s", trainer->scene->name);
    network->gate = gate;
    network->bomb_inv_mass = trainer->samples.items[0].problem.bodies[network->bomb].inv_mass;
    network->sweeps = training->sweeps;
    for (int s = 0; s < training->sweeps && training->momentum; s++)
        network->factors[s] = momentum_factor_tuned(s, training->sweeps);
    return true;
}

static bool next_round(Trainer *trainer, double share, Error *error) {
    const int had = trainer->samples.count;
    draw_launches(trainer, trainer->training->launches);
    next_stage(trainer, share);
    return record(trainer, &trainer->samples, BY_NETWORK, 0, trainer->training->launches, error) &&
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

/* Held-out launches have their own random seed and are run by momentum. */
static bool hold_out(Trainer *trainer, Error *error) {
    gsl_rng_set(trainer->generator, (unsigned long)trainer->training->seed + HELD_OUT_SEED);
    const int count = trainer->training->launches < HELD_OUT_LAUNCHES ? trainer->training->launches : HELD_OUT_LAUNCHES;
    draw_launches(trainer, count);
    trainer->stage.share = 0.02;
    return launches_check(trainer->scene, trainer->launches, count, error) &&
           record(trainer, &trainer->held_out, BY_MOMENTUM, 0, count, error);
}

/* Draws the launches of all rounds once before the work: the last round must not be the first to be refused. */
static bool check_rounds(Trainer *trainer, Error *error) {
    const SceneTraining *training = trainer->training;
    gsl_rng_set(trainer->generator, (unsigned long)training->seed);
    bool ok = true;
    for (int round = 0; ok && round < training->rounds; round++) {
        draw_launches(trainer, training->launches);
        ok = launches_check(trainer->scene, trainer->launches, training->launches, error);
    }
    return ok;
}

static bool train(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds;
    const double share = 0.78 / rounds;
    if (!check_rounds(trainer, error) || !hold_out(trainer, error)) return false;
    gsl_rng_set(trainer->generator, (unsigned long)trainer->training->seed);
    draw_launches(trainer, trainer->training->launches);
    if (!first_round(trainer, error) || !slot_samples_compute_inputs(&trainer->held_out, 0, trainer->network, error))
        return false;
    if (!fit_round(trainer, 0, share, error)) return false;
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
    if (!scene->bomb.present) {
        error_input(error, scene->name, "has no bomb to launch");
        return NULL;
    }
    if (!scene_span_varies(&scene->bomb.x)) {
        error_input(error, scene->name, "the bomb has one x; write a family of launches, x: {from: A, to: B}");
        return NULL;
    }
    Trainer trainer = {.scene = scene, .training = training, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    const int launches = training->launches > HELD_OUT_LAUNCHES ? training->launches : HELD_OUT_LAUNCHES;
    trainer.launches = malloc((size_t)launches * sizeof *trainer.launches);
    gsl_set_error_handler_off(); /* its default aborts */
    trainer.generator = gsl_rng_alloc(gsl_rng_mt19937);
    bool ok = trainer.launches != NULL && trainer.generator != NULL;
    ok = ok ? train(&trainer, error) : error_memory(error, "scene-net");
    if (ok && training->verdict != NULL)
        ok = scene_net_verdict(trainer.network, &trainer.held_out, training->verdict, error);
    free(trainer.launches);
    if (trainer.generator != NULL) gsl_rng_free(trainer.generator);
    slot_samples_free(&trainer.samples);
    slot_samples_free(&trainer.held_out);
    if (ok) return trainer.network;
    slot_network_destroy(trainer.network);
    return NULL;
}

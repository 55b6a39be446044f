/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: recorded steps, samples of them, and the rounds. */
#include "learning/sain_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

/* Every so many frames after the impact and at rest; they differ little. */
enum { AFTER_STEP = 6, REST_EVERY = 30, FACTORIZATIONS_MAX = 120 /* 95% of the impacts on pyramids take fewer */ };

static const double converged = 1e-6; /* m/s */
static const double first_rate = 0.003;

static bool make_solver(void *context, int i, ContactSolver *solver, Error *error) {
    const SainLaunches *launches = context;
    if (launches->network != NULL) return sain_make(solver, launches->network, error);
    return i % 2 == 0 ? solver_with(solver, &solver_engine, SAIN_ENGINE_SETTINGS, error)
                      : solver_with(solver, &solver_momentum, "k=50", error);
}

static bool keep_some(void *context, const LaunchStep *step, Error *error) {
    (void)context;
    const bool wanted = step->phase == PHASE_IMPACT ||
                        (step->phase == PHASE_AFTER ? step->since % AFTER_STEP : step->frame % REST_EVERY) == 0;
    return !wanted || step->problem->contact_count == 0 ||
           (reference_solve_to(step->reference, step->problem, converged, true, FACTORIZATIONS_MAX, error) &&
            launch_step_record(step, step->reference->residual <= converged, error));
}

bool sain_launches_record(const SainLaunches *launches, RecordedSteps *steps, const Progress *progress, Error *error) {
    const int count = launches->launches, all = launches->rounds * count;
    Launch *list = malloc((size_t)all * sizeof *list);
    bool ok = list != NULL || error_memory(error, "sain");
    for (int s = 0; ok && s < launches->scene_count; s++) {
        const Scene *scene = launches->scenes[s];
        const LaunchWatch watch = {.scene = scene,
                                   .launches = list,
                                   .count = count,
                                   .impact_frames = scene->bomb.impact_frames,
                                   .after_frames = AFTER_FRAMES,
                                   .may_fail = launches->network != NULL,
                                   .from_start = true,
                                   .make = make_solver,
                                   .see = keep_some,
                                   .context = (void *)launches};
        ok = (launches->held_out ? launches_for_scoring : launches_for_training)(scene, all, list, error);
        /* Launches rise along the family: a round takes one in `rounds`, so that each covers the family. */
        for (int i = 0; ok && i < count; i++) list[i] = list[i * launches->rounds + launches->round];
        ok = ok && launches_check(scene, list, count, error) && launches_observe(&watch, steps, progress, error);
    }
    free(list);
    return ok;
}

void sain_samples_free(SainSamples *samples) {
    free(samples->items);
    free(samples->rows);
    *samples = (SainSamples){.count = 0};
}

/* The receivers in a view, and their corrections to the converged velocities. */
static bool add_view(SainSamples *samples, const SainView *view, const ReferenceVelocity *velocities) {
    if (!array_reserve((void **)&samples->items, &samples->item_capacity, samples->count + (size_t)view->body_count + 1,
                       sizeof *samples->items) ||
        !array_reserve((void **)&samples->rows, &samples->row_capacity,
                       samples->row_count + (size_t)view->row_count + 1, sizeof *samples->rows))
        return false;
    for (int b = 0; b < view->body_count; b++) {
        const SainBody *body = &view->bodies[b];
        const ReferenceVelocity *velocity = &velocities[body->body];
        SainSample *sample = &samples->items[samples->count++];
        double target[SAIN_OUTPUTS];
        *sample = (SainSample){.first = (int)samples->row_count, .rows = body->rows, .scale = body->scale};
        sain_target(body, velocity->x, velocity->y, velocity->spin, target);
        for (int o = 0; o < SAIN_OUTPUTS; o++) sample->target[o] = (float)target[o];
        for (int i = 0; i < SAIN_BODY_INPUTS; i++) sample->body[i] = view->body_inputs[i * view->body_count + b];
        for (int r = body->first; r < body->first + body->rows; r++, samples->row_count++)
            for (int i = 0; i < SAIN_PAIR_INPUTS; i++)
                samples->rows[samples->row_count].numbers[i] = view->pair_inputs[i * view->row_count + r];
    }
    samples->problems += view->body_count > 0;
    return true;
}

bool sain_samples_add(SainSamples *samples, const RecordedSteps *steps, bool impacts_only, Error *error) {
    ContactSolver engine = {0};
    PairMoment moment = {0};
    SainView view = {0};
    samples->unconverged += steps->unconverged;
    bool ok = solver_with(&engine, &solver_engine, SAIN_ENGINE_SETTINGS, error);
    for (size_t i = 0; ok && i < steps->count; i++) {
        const RecordedStep *step = &steps->items[i];
        if (impacts_only && !step->impact) continue;
        ok = pair_moment_reserve(&moment, &step->problem) || error_memory(error, "sain");
        if (!ok) break;
        ContactSolution solution = pair_moment_solution(&moment);
        ok = solver_engine.solve(engine.state, &step->problem, &solution, error) &&
             ((sain_view_make(&view, &step->problem, solution.velocities) &&
               add_view(samples, &view, step->velocities)) ||
              error_memory(error, "sain"));
    }
    solver_destroy(&engine);
    pair_moment_free(&moment);
    sain_view_free(&view);
    return ok;
}

enum { REPORT_EVERY = 100 }; /* steps */

typedef struct Trainer {
    const SainTraining *training;
    SainNetwork *network;
    Adam adam;
    SainSamples samples, held_out;
    SainFit batches;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

/* Records a round and adds its samples; ranges, and in the first round the normalisation, follow from the samples. */
static bool record_round(Trainer *trainer, int round, Error *error) {
    const SainTraining *training = trainer->training;
    SainNetwork *network = trainer->network;
    RecordedSteps steps = {0}, held_out = {0};
    const SainLaunches launches = {.scenes = training->scenes,
                                   .scene_count = training->scene_count,
                                   .launches = training->launches,
                                   .rounds = training->rounds,
                                   .round = round,
                                   .network = round > 0 ? network : NULL},
                       others = {.scenes = training->scenes,
                                 .scene_count = training->scene_count,
                                 .launches = training->launches / 4 + 1,
                                 .rounds = 1,
                                 .held_out = true};
    bool ok = sain_launches_record(&launches, &steps, &trainer->progress, error);
    if (round == 0)
        ok = ok && sain_launches_record(&others, &held_out, &trainer->progress, error) &&
             sain_samples_add(&trainer->held_out, &held_out, true, error);
    ok = ok && sain_samples_add(&trainer->samples, &steps, false, error);
    recorded_steps_free(&steps);
    recorded_steps_free(&held_out);
    if (ok && trainer->samples.count == 0) return error_input(error, "sain", "no box is touched: more launches needed");
    if (ok && round == 0) sain_normalise(network, &trainer->samples);
    if (ok) sain_set_ranges(network, &trainer->samples);
    return ok;
}

/* Fits the samples so far, and scores the result. The rate falls from the first to 0 in equal steps; each round begins
   with half that of the round before, and without moments, as its loss is another. */
static bool fit_round(Trainer *trainer, int round, Error *error) {
    const SainTraining *training = trainer->training;
    SainNetwork *network = trainer->network;
    Adam *adam = &trainer->adam;
    const uint64_t seed = training->seed + (uint64_t)(round + 1) * 1000003;
    double loss, sum = 0;
    int in_sum = 0;
    SainScore score = {.round = round,
                       .problems = trainer->samples.problems,
                       .bodies = trainer->samples.count,
                       .unconverged = trainer->samples.unconverged + trainer->held_out.unconverged};
    bool ok = sain_fit_begin(&trainer->batches, network, &trainer->samples, training->batch, error);
    adam_restart(adam);
    for (int done = 0, all = training->steps; ok && done < all; done++) {
        if (done % REPORT_EVERY == 0) {
            if (!progress_report(&trainer->progress, done, all)) break;
            sum = in_sum = 0;
        }
        const double rate = first_rate / (1 << round) * (1 - (double)done / all);
        ok = sain_fit_step(&trainer->batches, adam, seed, done, rate, &loss, error);
        sum += loss;
        in_sum++;
    }
    sain_set_weights(network, adam->weights);
    if (ok && !trainer->stage.stopped && training->on_score != NULL) {
        ok = sain_fit_errors(&trainer->batches, adam->weights, &trainer->held_out, &score.held_out, error);
        score.loss = sum / in_sum;
        if (ok) training->on_score(training->context, &score);
    }
    sain_fit_free(&trainer->batches);
    return ok;
}

static bool run(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds;
    if (!sain_network_create(trainer->network, error) ||
        !adam_create(&trainer->adam, sain_weight_count(trainer->network), error))
        return false;
    sain_first_weights(trainer->network, trainer->training->seed, trainer->adam.weights);
    for (int round = 0; round < rounds; round++) {
        progress_next_stage(&trainer->stage, 0.2 / rounds);
        bool ok = record_round(trainer, round, error);
        progress_next_stage(&trainer->stage, 0.8 / rounds);
        ok = ok && fit_round(trainer, round, error);
        if (!ok && (error->kind != ERROR_INTERRUPTED || round == 0)) return false;
        if (trainer->stage.stopped) break;
    }
    *error = (Error){0}; /* a later round that was stopped leaves the network of the one before */
    return true;
}

bool sain_training_run(const SainTraining *training, SainNetwork *network, const Progress *progress, Error *error) {
    Trainer trainer = {.training = training, .network = network, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    *network = (SainNetwork){0};
    const bool ok = run(&trainer, error);
    adam_free(&trainer.adam);
    sain_samples_free(&trainer.samples);
    sain_samples_free(&trainer.held_out);
    return ok;
}

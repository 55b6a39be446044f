/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Impacts of the stack, recorded and as training samples of scene-net. */
#pragma once
#include "trainings.h"
#include "methods/residuals.h"

#include "learning/launches.h"
#include "learning/scene_training.h"

enum { IMPACT_STEPS = 8 };

static const float impact_gate = 2; /* m/s */
static const SceneNetWidths small_widths = {16, 16, 16, 32};

static inline bool make_momentum(void *context, int i, ContactSolver *solver, Error *error) {
    (void)context, (void)i;
    return solver_with(solver, &solver_momentum, "k=20", error);
}

static inline bool keep_impact(void *context, const LaunchStep *step, Error *error) {
    (void)context;
    if (step->phase != PHASE_IMPACT || residual_of(step->problem) < (double)impact_gate) return true;
    return reference_solve(step->reference, step->problem, NULL, error) &&
           launch_step_record(step, reference_converged(step->reference), error);
}

/* Over the midpoints of the paper's grid; every second one rotated. */
static inline void throw_over_grid(const Scene *scene, int count, Launch *launches) {
    Error error = {0};
    assert_ok(launches_for_scoring(scene, count, launches, &error), error);
    for (int i = 1; i < count; i += 2) launches[i].rotation = 0.4f;
}

static inline void record_impacts(RecordedSteps *steps, int launches, int first) {
    Error error = {0};
    Scene *scene = scene_named("stack");
    Launch table[200];
    assert_in_range(launches, 1, 200);
    throw_over_grid(scene, launches, table);
    const LaunchWatch watch = {.scene = scene,
                               .launches = table,
                               .count = launches,
                               .first = first,
                               .impact_frames = IMPACT_STEPS,
                               .make = make_momentum,
                               .see = keep_impact};
    assert_ok(launches_observe(&watch, steps, NULL, &error), error);
    scene_destroy(scene);
}

static inline SceneNetSamples labelled_impacts(int launches) {
    SceneNetSamples samples = {0};
    RecordedSteps steps = {0};
    record_impacts(&steps, launches, 0);
    assert_true(scene_net_samples_take(&samples, &steps));
    recorded_steps_free(&steps);
    return samples;
}

static inline SceneNet *network_for(SceneNetSamples *samples) {
    Error error = {0};
    SceneNet *network = scene_net_from_samples(samples, &small_widths, 1, &error);
    assert_ok(network != NULL, error);
    return network;
}

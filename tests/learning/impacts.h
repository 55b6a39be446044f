/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Impacts of the stack as training samples of scene-net. */
#pragma once
#include "trainings.h"

#include "learning/scene_training_internal.h"
#include "learning/scene_training.h"

enum { IMPACT_STEPS = 8 };

static const float impact_gate = 2; /* m/s */
static const SceneNetWidths small_widths = {16, 16, 16, 32};

static inline bool make_momentum(void *context, ContactSolver *solver, Error *error) {
    (void)context;
    Settings settings;
    if (!settings_parse(&settings, "k=20", solver_momentum.description.settings, "momentum", error)) return false;
    *solver = (ContactSolver){&solver_momentum, solver_momentum.create(&settings, error)};
    return solver->state != NULL;
}

/* Over the midpoints of the paper's grid; every second one rotated. */
static inline void throw_over_grid(const Scene *scene, int count, Launch *launches) {
    Error error = {0};
    assert_ok(launches_for_scoring(scene, count, launches, &error), error);
    for (int i = 1; i < count; i += 2) launches[i].rotation = 0.4f;
}

static inline void record_impacts(SceneNetSamples *samples, int launches, int first) {
    Error error = {0};
    Scene *scene = scene_named("stack");
    Launch table[200];
    assert_in_range(launches, 1, 200);
    throw_over_grid(scene, launches, table);
    const SceneNetRollout rollout = {.scene = scene,
                                     .launches = table,
                                     .launch_count = launches,
                                     .first_launch = first,
                                     .steps = IMPACT_STEPS,
                                     .gate = impact_gate,
                                     .make_solver = make_momentum};
    assert_ok(scene_net_rollout(&rollout, samples, NULL, &error), error);
    scene_destroy(scene);
}

static inline SceneNetSamples labelled_impacts(int launches) {
    SceneNetSamples samples = {0};
    Error error = {0};
    record_impacts(&samples, launches, 0);
    assert_ok(scene_net_samples_label(&samples, 0, NULL, &error), error);
    return samples;
}

static inline SceneNet *network_for(SceneNetSamples *samples) {
    Error error = {0};
    SceneNet *network = scene_net_from_samples(samples, &small_widths, 1, &error);
    assert_ok(network != NULL, error);
    return network;
}

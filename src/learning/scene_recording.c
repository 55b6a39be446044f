/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What scene-net and sain learn from: problems with their references, and the launches of scene-net's rounds. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/scene_training.h"
#include "learning/scene_training_internal.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

void impact_problems_free(ImpactProblems *problems) {
    for (size_t i = 0; i < problems->count; i++) {
        problem_copy_free(&problems->items[i].problem);
        free(problems->items[i].reference);
    }
    free(problems->items);
    *problems = (ImpactProblems){0};
}

bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact) {
    if (!array_reserve((void **)&problems->items, &problems->capacity, problems->count + 1, sizeof *problems->items))
        return false;
    const size_t bodies = (size_t)problem->body_count;
    ImpactProblem *item = &problems->items[problems->count++];
    *item = (ImpactProblem){.reference = malloc((bodies + 1) * sizeof *item->reference), .impact = impact};
    if (!problem_copy(&item->problem, problem) || item->reference == NULL) return false;
    memcpy(item->reference, reference, bodies * sizeof *reference);
    return true;
}

bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from) {
    const bool ok = array_reserve((void **)&problems->items, &problems->capacity, problems->count + from->count,
                                  sizeof *problems->items);
    if (ok && from->count > 0)
        memcpy(problems->items + problems->count, from->items, from->count * sizeof *from->items);
    if (ok) {
        problems->count += from->count;
        problems->unconverged += from->unconverged;
        from->count = 0;
    }
    impact_problems_free(from);
    return ok;
}

/* STEPS_AFTER: steps after the scene's impact frames that are samples too. */
enum { STEPS_AFTER = 2, HELD_OUT_LAUNCHES = 60, HELD_OUT_SEED = 7919 };

/* The setting `near` (residual) of scene-net in the runs that record training samples. */
static const float rollout_near = 0.05f; /* m/s */

/* Every second launch has a random rotation and spin. The mass is the scene's: a network is for one mass. */
static void draw_launches(const SceneRecording *recording, Launch *launches, int count) {
    const Scene *scene = recording->scene;
    for (int i = 0; i < count; i++) {
        launches[i] = launch_of(scene);
        launches[i].x = scene_span_at(&scene->bomb.x, gsl_rng_uniform(recording->generator));
        if (i % 2 == 0) continue;
        const double rotation = gsl_rng_uniform(recording->generator), spin = gsl_rng_uniform(recording->generator);
        launch_turn(&launches[i], scene, rotation, spin);
    }
}

static Launch *round_launches(const SceneRecording *recording) {
    return recording->launches + recording->first[SCENE_BY_MOMENTUM];
}

bool solver_with(ContactSolver *solver, const ContactSolverKind *kind, const char *text, Error *error) {
    Settings settings;
    if (!settings_parse(&settings, text, kind->description.settings, kind->description.name, error)) return false;
    void *state = kind->create(&settings, error);
    if (state != NULL) *solver = (ContactSolver){kind, state};
    return state != NULL;
}

void solver_destroy(ContactSolver *solver) {
    if (solver->kind != NULL) solver->kind->destroy(solver->state);
    *solver = (ContactSolver){0};
}

typedef struct Driver {
    SceneSet set;
    const SceneNet *network; /* or NULL: that of the set */
} Driver;

static bool make_driver(void *context, ContactSolver *solver, Error *error) {
    const Driver *driver = context;
    if (driver->network != NULL) return scene_net_make(solver, driver->network, rollout_near, error);
    return driver->set != SCENE_BY_REFERENCE ? solver_with(solver, &solver_momentum, "k=20", error)
                                             : solver_with(solver, &solver_reference, "", error);
}

/* Runs launches first to end - 1 and labels their samples. */
static bool scene_recording_run(const SceneRecording *recording, Driver driver, int first, int end,
                                SceneNetSamples *samples, const Progress *progress, Error *error) {
    const SceneNetRollout rollout = {.scene = recording->scene,
                                     .launches = recording->launches + first,
                                     .launch_count = end - first,
                                     .first_launch = first + recording->round * recording->training->launches,
                                     .steps = recording->scene->bomb.impact_frames + STEPS_AFTER,
                                     .gate = SCENE_RECORDING_GATE,
                                     .make_solver = make_driver,
                                     .context = &driver};
    const int had = samples->count;
    return scene_net_rollout(&rollout, samples, NULL, error) && scene_net_samples_label(samples, had, progress, error);
}

bool scene_recording_take(const SceneRecording *recording, SceneSet set, SceneNetSamples *samples,
                          const Progress *progress, Error *error) {
    return scene_recording_run(recording, (Driver){set, NULL}, recording->first[set], recording->first[set + 1],
                               samples, progress, error);
}

bool scene_recording_next(SceneRecording *recording, const SceneNet *network, SceneNetSamples *samples,
                          const Progress *progress, Error *error) {
    const int first = recording->first[SCENE_BY_MOMENTUM];
    recording->round++;
    draw_launches(recording, round_launches(recording), recording->training->launches);
    return scene_recording_run(recording, (Driver){SCENE_BY_MOMENTUM, network}, first, recording->first[SCENE_SETS],
                               samples, progress, error);
}

static bool check_scene(const Scene *scene, Error *error) {
    if (!scene->bomb.present) return error_input(error, scene->name, "has no bomb to launch");
    return scene_span_varies(&scene->bomb.x) ||
           error_input(error, scene->name, "the bomb has one x; write a family of launches, x: {from: A, to: B}");
}

/* Held-out launches have their own random seed. */
static bool draw_held_out(const SceneRecording *recording, Error *error) {
    const int count = recording->first[SCENE_BY_MOMENTUM];
    gsl_rng_set(recording->generator, (unsigned long)recording->training->seed + HELD_OUT_SEED);
    draw_launches(recording, recording->launches, count);
    return launches_check(recording->scene, recording->launches, count, error);
}

static bool check_rounds(const SceneRecording *recording, Error *error) {
    const SceneTraining *training = recording->training;
    gsl_rng_set(recording->generator, (unsigned long)training->seed);
    for (int round = 0; round < training->rounds; round++) {
        draw_launches(recording, round_launches(recording), training->launches);
        if (!launches_check(recording->scene, round_launches(recording), training->launches, error)) return false;
    }
    return true;
}

static void count_launches(SceneRecording *recording) {
    const int launches = recording->training->launches,
              held_out = launches < HELD_OUT_LAUNCHES ? launches : HELD_OUT_LAUNCHES;
    recording->first[SCENE_BY_MOMENTUM] = held_out;
    recording->first[SCENE_BY_REFERENCE] = held_out + launches / 2;
    recording->first[SCENE_SETS] = held_out + launches;
}

bool scene_recording_begin(SceneRecording *recording, const Scene *scene, const SceneTraining *training, Error *error) {
    *recording = (SceneRecording){.scene = scene, .training = training};
    if (!check_scene(scene, error)) return false;
    count_launches(recording);
    gsl_set_error_handler_off(); /* its default aborts */
    recording->generator = gsl_rng_alloc(gsl_rng_mt19937);
    recording->launches = malloc((size_t)recording->first[SCENE_SETS] * sizeof *recording->launches);
    if (recording->generator == NULL || recording->launches == NULL) return error_memory(error, "scene-net");
    if (!check_rounds(recording, error) || !draw_held_out(recording, error)) return false;
    gsl_rng_set(recording->generator, (unsigned long)training->seed);
    draw_launches(recording, round_launches(recording), training->launches);
    return true;
}

void scene_recording_end(SceneRecording *recording) {
    if (recording->generator != NULL) gsl_rng_free(recording->generator);
    free(recording->launches);
    *recording = (SceneRecording){.scene = NULL};
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation_training/relation_recording.h"

#include "common/parallel.h"
#include "simulate/phases.h"

#include <stdlib.h>

/* Every so many frames after the impact and at rest; they differ little. */
enum { AFTER_STEP = 6, REST_EVERY = 30, FACTORIZATIONS_MAX = 120 /* 95% of the impacts on pyramids take fewer */ };

static const double converged = 1e-6; /* m/s */

typedef struct Runs {
    const RelationRecording *recording;
    ImpactProblems *of; /* [launches] */
} Runs;

/* One launch. */
typedef struct Run {
    ImpactProblems *problems;
    Reference reference;
    PhaseTracker tracker;
} Run;

static bool keep(Run *run, const ContactProblem *problem, int frame, Error *error) {
    const Phase phase = phase_next(&run->tracker, problem, frame);
    const bool wanted = phase == PHASE_IMPACT ||
                        (phase == PHASE_AFTER ? (frame - run->tracker.touch) % AFTER_STEP : frame % REST_EVERY) == 0;
    if (!wanted || problem->contact_count == 0) return true;
    if (!reference_solve_to(&run->reference, problem, converged, FACTORIZATIONS_MAX, error)) return false;
    if (run->reference.residual > converged) return true;
    return impact_problems_add(run->problems, problem, run->reference.velocities, phase == PHASE_IMPACT) ||
           error_memory(error, "recording");
}

static bool is_over(const Run *run, int frame) {
    return run->tracker.touch > 0 && frame >= run->tracker.touch + run->tracker.impact_frames + AFTER_FRAMES;
}

static bool run_world(Run *run, const Scene *scene, World *world, const ContactSolver *solver, Error *error) {
    for (int frame = 1; frame <= scene->frames && !is_over(run, frame); frame++) {
        Error failure = {0};
        if (!world_step(world, solver->kind->solve, solver->state, scene->dt, &failure))
            return failure.kind == ERROR_INPUT || (*error = failure, false);
        if (!keep(run, world_problem(world), frame, error)) return false;
        if (frame == scene->bomb.frame && !scene_add_bomb(scene, world, error)) return false;
    }
    return true;
}

static bool piece(void *context, int i, Error *error) {
    const Runs *runs = context;
    const RelationRecording *recording = runs->recording;
    const Scene launched = launch_scene(recording->scene, &recording->launches[i]);
    ContactSolver solver = {0};
    Run run = {.problems = &runs->of[i], .tracker = {.impact_frames = launched.bomb.impact_frames}};
    World *world = scene_world(&launched, error);
    const bool ok = world != NULL && recording->make_solver(recording->context, i, &solver, error) &&
                    run_world(&run, &launched, world, &solver, error);
    world_destroy(world);
    if (solver.kind != NULL) solver.kind->destroy(solver.state);
    reference_free(&run.reference);
    return ok;
}

bool relation_record(const RelationRecording *recording, ImpactProblems *problems, const Progress *progress,
                     Error *error) {
    Runs runs = {recording, calloc((size_t)recording->count + 1, sizeof *runs.of)};
    if (runs.of == NULL) return error_memory(error, "recording");
    const ParallelWork work = {piece, &runs};
    bool ok = parallel_for(&work, recording->count, "launches", progress, error);
    for (int i = 0; i < recording->count; i++)
        if (ok)
            ok = impact_problems_move(problems, &runs.of[i]) || error_memory(error, "recording");
        else
            impact_problems_free(&runs.of[i]);
    free(runs.of);
    return ok;
}

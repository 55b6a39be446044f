/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/recording.h"

#include "common/parallel.h"
#include "interior_training/random_scene.h"
#include "simulate/phases.h"
#include "solvers/interior_net.h"
#include "solvers/residual.h"

#include <stdlib.h>

/* Every so many frames after the impact and at rest. */
enum { AFTER_EVERY = 20, REST_EVERY = 45 };

static const double converged = 1e-6; /* m/s */

typedef struct Runs {
    const Recording *recording;
    ImpactProblems *of; /* [scenes] */
} Runs;

/* One run. */
typedef struct Run {
    ImpactProblems *problems;
    Reference reference;
    PhaseTracker tracker;
} Run;

static bool wanted(Run *run, const ContactProblem *problem, int frame, bool *impact) {
    const Phase phase = phase_next(&run->tracker, problem, frame);
    *impact = phase == PHASE_IMPACT;
    if (!residual_motion_reaches(problem, INTERIOR_REST_BELOW)) return false;
    if (phase == PHASE_AFTER) return (frame - run->tracker.touch) % AFTER_EVERY == 0;
    return *impact || frame % REST_EVERY == 0;
}

static bool keep(Run *run, const ContactProblem *problem, bool impact, Error *error) {
    if (!reference_solve(&run->reference, problem, NULL, error)) return false;
    if (run->reference.residual > converged) return true;
    return impact_problems_add(run->problems, problem, run->reference.velocities, impact) ||
           error_memory(error, "recording");
}

/* Until the 60 frames after the impact are over, or the scene's frames. A body that reaches NaN or infinity ends the
   run: what it recorded before counts. */
static bool run_world(Run *run, const Scene *scene, World *world, const ContactSolver *solver, Error *error) {
    for (int frame = 1; frame <= scene->frames; frame++) {
        Error failure = {0};
        if (!world_step(world, solver->kind->solve, solver->state, scene->dt, &failure))
            return failure.kind == ERROR_INPUT || (*error = failure, false);
        bool impact;
        const ContactProblem *problem = world_problem(world);
        if (wanted(run, problem, frame, &impact) && !keep(run, problem, impact, error)) return false;
        if (run->tracker.touch > 0 && frame >= run->tracker.touch + run->tracker.impact_frames + AFTER_FRAMES)
            return true;
        if (frame == scene->bomb.frame && !scene_add_bomb(scene, world, error)) return false;
    }
    return true;
}

static bool piece(void *context, int i, Error *error) {
    const Runs *runs = context;
    const int number = runs->recording->first + i;
    RandomScene random;
    random_scene_make(&random, runs->recording->seed, number);
    ContactSolver solver = {0};
    Run run = {.problems = &runs->of[i], .tracker = {.impact_frames = random.scene.bomb.impact_frames}};
    World *world = scene_world(&random.scene, error);
    const bool ok = world != NULL && runs->recording->make_solver(runs->recording->context, number, &solver, error) &&
                    run_world(&run, &random.scene, world, &solver, error);
    world_destroy(world);
    if (solver.kind != NULL) solver.kind->destroy(solver.state);
    reference_free(&run.reference);
    return ok;
}

bool recording_run(const Recording *recording, ImpactProblems *problems, const Progress *progress, Error *error) {
    Runs runs = {recording, calloc((size_t)recording->scenes, sizeof *runs.of)};
    if (runs.of == NULL) return error_memory(error, "recording");
    const ParallelWork work = {piece, &runs};
    bool ok = parallel_for(&work, recording->scenes, "random scenes", progress, error);
    for (int i = 0; i < recording->scenes; i++)
        if (ok)
            ok = impact_problems_move(problems, &runs.of[i]) || error_memory(error, "recording");
        else
            impact_problems_free(&runs.of[i]);
    free(runs.of);
    return ok;
}

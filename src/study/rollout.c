/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/rollout.h"

#include "common/array.h"
#include "reference/solution_error.h"
#include "simulate/simulate.h"

#include <math.h>
#include <stdlib.h>

void step_scores_free(StepScores *scores) {
    free(scores->error);
    free(scores->share);
    free(scores->place);
    *scores = (StepScores){0};
}

bool step_scores_add(StepScores *scores, int frame, const ContactProblem *problem, const BodyVelocity *velocities,
                     const ReferenceVelocity *reference) {
    size_t wanted = (size_t)scores->count + 1;
    if (!array_reserve((void **)&scores->error, &scores->error_capacity, wanted, sizeof *scores->error) ||
        !array_reserve((void **)&scores->share, &scores->share_capacity, wanted, sizeof *scores->share) ||
        !array_reserve((void **)&scores->place, &scores->place_capacity, wanted, sizeof *scores->place))
        return false;
    SolutionError found = solution_error(problem, velocities, reference);
    scores->error[scores->count] = found.rms;
    scores->place[scores->count] = (StepPlace){frame, found.worst};
    scores->share[scores->count++] = found.counted > 0 ? (double)found.right / found.counted : 1;
    return true;
}

bool sampling_takes(const Sampling *sampling, Phase phase, const PhaseTracker *tracker, int frame) {
    if (phase == PHASE_IMPACT) return true;
    if (phase == PHASE_AFTER) return (frame - tracker->touch - tracker->impact_frames) % sampling->after == 0;
    return frame % sampling->rest == 0;
}

void rollout_free(Rollout *rollout) {
    world_destroy(rollout->world);
    converged_step_free(&rollout->converged);
    run_log_free(&rollout->log);
    *rollout = (Rollout){0};
}

static bool score(Rollout *rollout, int frame, bool push_out, StepScores *scores, Error *error) {
    const ContactProblem *problem = world_problem(rollout->world);
    const Reference *reference = &rollout->converged.reference;
    if (!converged_step_solve(&rollout->converged, problem, push_out, error)) return false;
    rollout->solves++;
    rollout->unconverged += reference->residual > SOLVE_CONVERGED;
    if (step_scores_add(scores, frame, problem, world_solution(rollout->world)->velocities, reference->velocities))
        return true;
    return error_memory(error, "study");
}

static bool begin(Rollout *rollout, const Scene *launched, Error *error) {
    world_destroy(rollout->world);
    rollout->world = scene_world(launched, error);
    if (rollout->world == NULL) return false;
    return run_log_begin(&rollout->log, launched, rollout->world) || error_memory(error, "study");
}

bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error) {
    if (!begin(rollout, launched, error)) return false;
    const bool push_out = !stepper_describe(stepper)->no_push_out;
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    for (int frame = 1; frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame};
        Error failure = {0};
        if (!simulate_step(stepper, rollout->world, &step, &failure)) {
            /* An input error during the run means that the state became NaN or infinite. That is a valid result. */
            if (failure.kind == ERROR_INPUT) return true;
            *error = failure;
            return false;
        }
        Phase phase = phase_next(&tracker, world_problem(rollout->world), frame);
        run_log_step(&rollout->log, launched, rollout->world, frame, phase);
        if (scores != NULL && sampling_takes(sampling, phase, &tracker, frame) &&
            !score(rollout, frame, push_out, &scores[phase], error))
            return false;
    }
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs in closed loop: their logs and measures, and the scores of their steps; steps of the engine, which all methods
   solve, and the scores of a method on them. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/criteria.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void converged_step_free(ConvergedStep *converged) {
    reference_free(&converged->reference);
    reference_free(&converged->other);
    free(converged->contacts);
    *converged = (ConvergedStep){0};
}

/* Solves to REFERENCE_TOLERANCE. push_out: with the bias of overlapping contacts. False when memory is short. */
static bool converged_step_solve(ConvergedStep *converged, const ContactProblem *problem, bool push_out, Error *error) {
    ContactProblem solved = *problem;
    if (!push_out) { /* a negative bias lets a gap close; it stays */
        const size_t count = (size_t)problem->contact_count;
        if (!array_reserve((void **)&converged->contacts, &converged->contact_capacity, count, sizeof(ContactPoint)))
            return error_memory(error, "study");
        if (count > 0) memcpy(converged->contacts, problem->contacts, count * sizeof(ContactPoint));
        for (size_t i = 0; i < count; i++)
            if (converged->contacts[i].bias > 0) converged->contacts[i].bias = 0;
        solved.contacts = converged->contacts;
    }
    return reference_solve(&converged->reference, &solved, NULL, error);
}

/* In walls, piles and pyramids three starts find nine tenths of the floor that seven find. */
enum { FLOOR_STARTS = 3 };

/* Of the problem that was solved last. */
static bool add_floor(ConvergedStep *converged, const ContactProblem *problem, FloorSum *sum, Error *error) {
    double floor;
    if (!converged_step_found(converged)) return true;
    if (!reference_floor(&converged->other, problem, &converged->reference, FLOOR_STARTS, &floor, error)) return false;
    sum->sum += floor;
    sum->steps++;
    return true;
}

static const double moved_distance = 0.5; /* m: half a box */
static const double moved_after = 5;      /* s */

void run_log_free(RunLog *log) {
    free(log->position);
    free(log->at);
    *log = (RunLog){0};
}

bool run_log_begin(RunLog *log, const Scene *scene, const World *world) {
    size_t rows = (size_t)scene->frames + 1;
    log->bodies = scene->body_count;
    log->touch = log->fallen_back = log->unconverged = log->first_unconverged = 0;
    log->momentum_error = 0;
    log->launch_frame = scene->bomb.frame < scene->frames ? scene->bomb.frame : scene->frames;
    double end = log->launch_frame + moved_after / (double)scene->dt;
    log->end_frame = end < scene->frames ? (int)lround(end) : scene->frames;
    if (!array_reserve((void **)&log->position, &log->position_capacity, rows * (size_t)log->bodies, sizeof(Vec2)) ||
        !array_reserve((void **)&log->at, &log->at_capacity, rows, sizeof *log->at))
        return false;
    run_log_step(log, scene, world, 0, PHASE_REST);
    return true;
}

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase) {
    log->frames = frame;
    if (phase == PHASE_IMPACT && log->touch == 0) log->touch = frame;
    for (int i = 0; i < log->bodies; i++)
        log->position[(size_t)frame * (size_t)log->bodies + (size_t)i] = world_bodies(world)[i].position;
    log->at[frame] = (LoggedFrame){
        .energy = world_energy(world, scene->gravity),
        .penetration = world_penetration(world),
        .phase = phase,
        .bomb = world_body_count(world) > log->bodies ? world_bodies(world)[log->bodies].position : vec2(0, 0)};
    log->momentum_error += (double)world_solution(world)->momentum_error;
    const Fallbacks *fallbacks = &world_solution(world)->fallbacks;
    log->fallen_back += fallbacks->not_finite + fallbacks->beyond_training + fallbacks->by_sweeps > 0;
    if (frame == 0 || fallbacks->not_converged == 0) return;
    if (log->unconverged++ == 0) log->first_unconverged = frame;
}

static double distance_apart(const RunLog *log, const RunLog *other, int frame) {
    const size_t row = (size_t)frame * (size_t)log->bodies;
    double apart = vec2_distance(log->at[frame].bomb, other->at[frame].bomb);
    for (int i = 0; i < log->bodies; i++)
        apart = fmax(apart, vec2_distance(log->position[row + (size_t)i], other->position[row + (size_t)i]));
    return apart;
}

int run_log_apart(const RunLog *log, const RunLog *other, double limit, int frames) {
    for (int frame = 1; frame <= frames; frame++)
        if (frame > log->frames || (frame <= other->frames && distance_apart(log, other, frame) > limit)) return frame;
    return frames;
}

double run_log_moved(const RunLog *log, const Scene *scene) {
    int moved = 0;
    const Vec2 *before = log->position + (size_t)log->launch_frame * (size_t)log->bodies;
    const Vec2 *after = log->position + (size_t)log->end_frame * (size_t)log->bodies;
    for (int i = 0; i < log->bodies; i++) {
        if (scene->bodies[i].fixed) continue;
        moved += log->frames < log->end_frame || vec2_distance(before[i], after[i]) > moved_distance;
    }
    return moved;
}

/* The distance of bodies, or its square, over whole frames first .. last. */
static double mean_apart(const RunLog *log, const RunLog *other, const Scene *scene, int first, int last,
                         bool squared) {
    double sum = 0;
    int64_t count = 0;
    for (int frame = first; frame <= last; frame++)
        for (int i = 0; i < log->bodies; i++) {
            const size_t at = (size_t)frame * (size_t)log->bodies + (size_t)i;
            const double apart = vec2_distance(log->position[at], other->position[at]);
            if (scene->bodies[i].fixed) continue;
            sum += squared ? apart * apart : apart;
            count++;
        }
    return count > 0 ? sum / (double)count : NAN;
}

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene) {
    RunMeasures measures = {.drift = NAN, .moved = run_log_moved(log, scene)};
    int frames[PHASES] = {0}, compared[PHASES] = {0};
    const int last = log->frames < converged->frames ? log->frames : converged->frames;
    const int known = converged->first_unconverged > 0 ? converged->first_unconverged - 1 : converged->frames;
    double energy[PHASES] = {0};
    for (int frame = 1; frame <= last; frame++) {
        Phase phase = log->at[frame].phase;
        if (frame <= known) energy[phase] += log->at[frame].energy - converged->at[frame].energy;
        compared[phase] += frame <= known;
        frames[phase]++;
        if (log->at[frame].penetration > measures.penetration[phase])
            measures.penetration[phase] = log->at[frame].penetration;
    }
    for (int phase = 0; phase < PHASES; phase++) {
        measures.energy[phase] = compared[phase] > 0 ? energy[phase] / compared[phase] : NAN;
        if (frames[phase] == 0) measures.penetration[phase] = NAN;
    }
    int rest = converged->touch > 0 ? converged->touch - 1 : last;
    if (log->touch > 0 && log->touch - 1 < rest) rest = log->touch - 1;
    if (rest > 0 && rest <= last && rest <= known)
        measures.drift = mean_apart(log, converged, scene, rest, rest, false);
    const int whole = known < converged->frames ? known : converged->frames;
    measures.rollout_mse = last >= whole ? mean_apart(log, converged, scene, 1, whole, true) / 2 : NAN;
    return measures;
}

void step_scores_free(StepScores *scores) {
    free(scores->error);
    free(scores->share);
    free(scores->place);
    *scores = (StepScores){0};
}

static bool reserve_scores(StepScores *scores, size_t count) {
    return array_reserve((void **)&scores->error, &scores->error_capacity, count, sizeof *scores->error) &&
           array_reserve((void **)&scores->share, &scores->share_capacity, count, sizeof *scores->share) &&
           array_reserve((void **)&scores->place, &scores->place_capacity, count, sizeof *scores->place);
}

/* Adds the step to `frame`, given its solution. push_out: as contact_criteria(). False if out of memory. */
static bool step_scores_add(StepScores *scores, int frame, const ContactProblem *problem,
                            const ContactSolution *solution, const ReferenceVelocity *reference, bool push_out) {
    if (!reserve_scores(scores, (size_t)scores->count + 1)) return false;
    const SolutionError found = solution_error(problem, solution->velocities, reference);
    const ContactCriteria criteria = contact_criteria(problem, solution, push_out);
    CriteriaSum *sum = &scores->criteria;
    if (problem->contact_count > 0 && !isnan(criteria.signorini)) { /* else there is no law to break */
        sum->signorini += criteria.signorini;
        sum->cone += criteria.cone;
        sum->dissipation += criteria.dissipation;
        sum->steps++;
    }
    scores->error[scores->count] = found.rms;
    scores->place[scores->count] = (StepPlace){frame, found.worst};
    scores->share[scores->count++] = found.counted > 0 ? (double)found.right / found.counted : 1;
    return true;
}

static bool takes(const Sampling *sampling, Phase phase, const PhaseTracker *tracker, int frame) {
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

void shared_steps_free(SharedSteps *shared) {
    rollout_free(&shared->rollout);
    step_memory_free(&shared->memory);
    for (int phase = 0; phase < PHASES; phase++) step_scores_free(&shared->scores[phase]);
    shared->ended = false;
}

/* The log has begun, so it has room. */
static void copy_log(RunLog *to, const RunLog *from) {
    const size_t rows = (size_t)from->frames + 1;
    memcpy(to->position, from->position, rows * (size_t)from->bodies * sizeof *to->position);
    memcpy(to->at, from->at, rows * sizeof *to->at);
    to->frames = from->frames;
    to->touch = from->touch;
    to->momentum_error = from->momentum_error;
    to->fallen_back = from->fallen_back;
    to->unconverged = from->unconverged;
    to->first_unconverged = from->first_unconverged;
}

static bool copy_scores(StepScores *to, const StepScores *from) {
    const size_t count = (size_t)from->count;
    if (count == 0) return true;
    if (!reserve_scores(to, count)) return false;
    memcpy(to->error, from->error, count * sizeof *to->error);
    memcpy(to->share, from->share, count * sizeof *to->share);
    memcpy(to->place, from->place, count * sizeof *to->place);
    to->count = from->count;
    to->criteria = from->criteria;
    return true;
}

static bool copy_shared(Rollout *rollout, Stepper *stepper, StepScores scores[PHASES], Error *error) {
    const SharedSteps *shared = rollout->shared;
    if (!world_copy(rollout->world, shared->rollout.world, error) || !stepper_recall(stepper, &shared->memory, error))
        return false;
    copy_log(&rollout->log, &shared->rollout.log);
    rollout->unconverged = shared->rollout.unconverged;
    for (int phase = 0; scores != NULL && phase < PHASES; phase++)
        if (!copy_scores(&scores[phase], &shared->scores[phase])) return error_memory(error, "study");
    return true;
}

bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error) {
    world_destroy(rollout->world);
    rollout->world = scene_world(launched, error);
    if (rollout->world == NULL) return false;
    if (!run_log_begin(&rollout->log, launched, rollout->world)) return error_memory(error, "study");
    if (rollout->shared != NULL && !copy_shared(rollout, stepper, scores, error)) return false;
    if (rollout->shared != NULL && rollout->shared->ended) return true;
    const bool push_out = !stepper_describe(stepper)->no_push_out;
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    for (int frame = rollout->log.frames + 1; frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame, .engine_step = rollout->engine_contacts};
        Error failure = {0};
        if (!simulate_step(stepper, rollout->world, &step, &failure)) {
            if (failure.failure != FAILURE_NONE) return true; /* a valid result */
            *error = failure;
            return false;
        }
        Phase phase = phase_next(&tracker, world_problem(rollout->world), frame);
        run_log_step(&rollout->log, launched, rollout->world, frame, phase);
        const bool used = sampling != NULL && (scores != NULL || rollout->floors != NULL);
        if (!used || !takes(sampling, phase, &tracker, frame)) continue;
        const ContactProblem *problem = world_problem(rollout->world);
        if (!converged_step_solve(&rollout->converged, problem, push_out, error)) return false;
        const bool found = converged_step_found(&rollout->converged);
        rollout->unconverged += !found;
        if (rollout->floors != NULL && !add_floor(&rollout->converged, problem, &rollout->floors[phase], error))
            return false;
        if (found && scores != NULL &&
            !step_scores_add(&scores[phase], frame, problem, world_solution(rollout->world),
                             rollout->converged.reference.velocities, push_out))
            return error_memory(error, "study");
    }
    return true;
}

bool shared_steps_run(SharedSteps *shared, Stepper *stepper, const Scene *launched, int steps, const Sampling *sampling,
                      Error *error) {
    if (shared->rollout.world != NULL) return true;
    Scene first = *launched;
    first.frames = steps;
    const bool ok =
        rollout_run(&shared->rollout, stepper, &first, sampling, sampling != NULL ? shared->scores : NULL, error) &&
        stepper_remember(stepper, &shared->memory, error);
    converged_step_free(&shared->rollout.converged);
    shared->ended = shared->rollout.log.frames < steps;
    return ok;
}

static void snapshot_free(Snapshot *snapshot) {
    world_destroy(snapshot->world);
    free(snapshot->reference);
    free(snapshot->no_push_out);
}

void snapshots_free(SnapshotList *list) {
    for (int i = 0; i < list->count; i++) snapshot_free(&list->items[i]);
    free(list->items);
    *list = (SnapshotList){0};
}

static World *empty_world(const Scene *scene, Error *error) {
    Scene empty = *scene;
    empty.body_count = 0;
    empty.bomb.present = false;
    return scene_world(&empty, error);
}

/* *velocities: a copy of the converged velocities of a step, or NULL if the solve has not converged. */
static bool converged_velocities(ConvergedStep *converged, const ContactProblem *problem, bool push_out,
                                 ReferenceVelocity **velocities, Error *error) {
    const size_t size = (size_t)problem->body_count * sizeof **velocities;
    if (!converged_step_solve(converged, problem, push_out, error)) return false;
    if (!converged_step_found(converged)) return true;
    *velocities = malloc(size + 1);
    if (*velocities == NULL) return error_memory(error, "study");
    if (size > 0) memcpy(*velocities, converged->reference.velocities, size);
    return true;
}

bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error) {
    Method method;
    if (!method_parse(&method, "engine", error)) return false;
    Stepper *engine = stepper_create(&method, launched, error);
    World *world = scene_world(launched, error), *before = empty_world(launched, error);
    ConvergedStep converged = {0};
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    bool ok = engine != NULL && world != NULL && before != NULL;
    for (int frame = 1; ok && frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame};
        ok = world_copy(before, world, error) && simulate_step(engine, world, &step, error);
        if (!ok) break;
        const Phase phase = phase_next(&tracker, world_problem(world), frame);
        if (!takes(sampling, phase, &tracker, frame)) continue;
        /* The state before the step, and the step's converged velocities, if there are any. */
        ok = array_reserve((void **)&list->items, &list->capacity, (size_t)list->count + 1, sizeof *list->items) ||
             error_memory(error, "study");
        if (!ok) break;
        const ContactProblem *problem = world_problem(world);
        Snapshot *snapshot = &list->items[list->count];
        *snapshot = (Snapshot){.scene = launched, .frame = frame, .phase = phase};
        ok = converged_velocities(&converged, problem, true, &snapshot->reference, error) &&
             (list->floors == NULL || add_floor(&converged, problem, &list->floors[phase], error));
        if (ok && list->no_push_out)
            ok = converged_velocities(&converged, problem, false, &snapshot->no_push_out, error);
        if (ok && (snapshot->reference == NULL || (list->no_push_out && snapshot->no_push_out == NULL))) {
            snapshot_free(snapshot);
            list->unconverged++;
            continue;
        }
        list->count++;
        if (ok) snapshot->world = empty_world(launched, error);
        ok = ok && snapshot->world != NULL && world_copy(snapshot->world, before, error);
    }
    stepper_destroy(engine);
    world_destroy(world);
    world_destroy(before);
    converged_step_free(&converged);
    return ok;
}

bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES],
                     Error *error) {
    const bool push_out = !stepper_describe(stepper)->no_push_out;
    assert(push_out || list->no_push_out);
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        Error failure = {0};
        if (!world_copy(world, snapshot->world, error)) return false;
        if (!stepper_step(stepper, world, &step, &failure)) {
            if (failure.failure == FAILURE_ADAPTER) return true; /* as in closed loop */
            *error = failure;
            return false;
        }
        if (!step_scores_add(&scores[snapshot->phase], snapshot->frame, world_problem(world), world_solution(world),
                             push_out ? snapshot->reference : snapshot->no_push_out, push_out))
            return error_memory(error, "study");
    }
    return true;
}

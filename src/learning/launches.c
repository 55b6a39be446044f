/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over launches of all learners that need contact problems, and recorded poses for those that need none. */
#include "learning/launches.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool problem_copy(ContactProblem *copy, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    ProblemBody *block = malloc(bodies * sizeof *problem->bodies + contacts * sizeof *problem->contacts + 1);
    *copy = *problem;
    copy->bodies = block;
    copy->contacts = block != NULL ? (ContactPoint *)(block + bodies) : NULL;
    if (block == NULL) return false;
    memcpy(block, problem->bodies, bodies * sizeof *problem->bodies);
    if (contacts > 0) memcpy(block + bodies, problem->contacts, contacts * sizeof *problem->contacts);
    return true;
}

void problem_copy_free(ContactProblem *copy) { free((void *)copy->bodies); }

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

void recorded_steps_free(RecordedSteps *steps) {
    for (size_t i = 0; i < steps->count; i++) {
        problem_copy_free(&steps->items[i].problem);
        free(steps->items[i].velocities);
    }
    free(steps->items);
    *steps = (RecordedSteps){0};
}

bool recorded_steps_move(RecordedSteps *steps, RecordedSteps *from) {
    if (!array_reserve((void **)&steps->items, &steps->capacity, steps->count + from->count + 1, sizeof *steps->items))
        return false;
    for (size_t i = 0; i < from->count; i++) steps->items[steps->count++] = from->items[i];
    steps->unconverged += from->unconverged;
    free(from->items);
    *from = (RecordedSteps){0};
    return true;
}

bool launch_step_record(const LaunchStep *step, bool converged, Error *error) {
    RecordedSteps *steps = step->steps;
    const Reference *reference = step->reference;
    const ContactProblem *problem = step->problem;
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!converged) {
        steps->unconverged++;
        return true;
    }
    if (!array_reserve((void **)&steps->items, &steps->capacity, steps->count + 1, sizeof *steps->items))
        return error_memory(error, "recording");
    RecordedStep *copy = &steps->items[steps->count++];
    *copy = (RecordedStep){.launch = step->launch, .since = step->since, .impact = step->phase == PHASE_IMPACT};
    copy->velocities = malloc(bodies * sizeof *copy->velocities + contacts * sizeof *copy->impulses + 1);
    if (!problem_copy(&copy->problem, problem) || copy->velocities == NULL) return error_memory(error, "recording");
    copy->impulses = (ContactImpulse *)(copy->velocities + bodies);
    memcpy(copy->velocities, reference->velocities, bodies * sizeof *copy->velocities);
    for (size_t k = 0; k < contacts; k++)
        copy->impulses[k] =
            (ContactImpulse){(float)reference->impulses[k].normal, (float)reference->impulses[k].tangent};
    return true;
}

/* *finite: false if the new state is NaN or infinite, which is no error. */
static bool take_step(World *world, const Scene *scene, const ContactSolver *solver, bool *finite, Error *error) {
    Error failure = {0};
    *finite = world_step(world, solver->kind->solve, solver->state, scene->dt, &failure);
    if (*finite || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

/* A world without the bomb, also if that is there from the start. */
static World *quiet_world(const Scene *scene, Error *error) {
    Scene quiet = *scene;
    quiet.bomb.present = false;
    return scene_world(&quiet, error);
}

World *launches_past(const Scene *scene, const ContactSolver *solver, Error *error) {
    World *world = quiet_world(scene, error);
    bool ok = world != NULL, finite = true;
    for (int frame = 1; ok && frame <= scene->bomb.frame; frame++)
        ok = take_step(world, scene, solver, &finite, error) &&
             (finite || error_input(error, scene->name, "a body's state is NaN or infinite before the bomb is added"));
    if (ok) return world;
    world_destroy(world);
    return NULL;
}

typedef struct Observing {
    const LaunchWatch *watch;
    const World *past;
    RecordedSteps *steps; /* [launches] */
} Observing;

static bool observe(void *context, int i, Error *error) {
    const Observing *observing = context;
    const LaunchWatch *watch = observing->watch;
    const Scene launched = launch_scene(watch->scene, &watch->launches[i]);
    ContactSolver solver = {0};
    Reference reference = {0};
    PhaseTracker tracker = {.impact_frames = watch->impact_frames};
    World *world = quiet_world(&launched, error);
    LaunchStep step = {.launch = watch->first + i, .steps = &observing->steps[i], .reference = &reference};
    bool ok = world != NULL && (observing->past == NULL || world_copy(world, observing->past, error)) &&
              watch->make(watch->context, i, &solver, error);
    for (int frame = observing->past != NULL ? launched.bomb.frame : 0; ok && frame < launched.frames;) {
        bool finite = true;
        if (frame == launched.bomb.frame && !(ok = scene_add_bomb(&launched, world, error))) break;
        frame++;
        if (tracker.touch > 0 && frame >= tracker.touch + watch->impact_frames + watch->after_frames) break;
        ok = take_step(world, &launched, &solver, &finite, error);
        if (ok && !finite && !watch->may_fail)
            ok = error_input(error, launched.name, "a body's state is NaN or infinite in frame %d of launch %d", frame,
                             step.launch);
        if (!ok || !finite) break;
        step.problem = world_problem(world);
        step.phase = phase_next(&tracker, step.problem, frame);
        step.frame = frame;
        step.since = frame - tracker.touch;
        ok = watch->see(watch->context, &step, error);
    }
    world_destroy(world);
    solver_destroy(&solver);
    reference_free(&reference);
    return ok;
}

bool launches_observe(const LaunchWatch *watch, RecordedSteps *steps, const Progress *progress, Error *error) {
    World *past = NULL;
    Observing observing = {watch, watch->past, calloc((size_t)watch->count + 1, sizeof *observing.steps)};
    bool ok = observing.steps != NULL || error_memory(error, "launches");
    if (ok && !watch->from_start && watch->past == NULL) {
        ContactSolver solver = {0};
        past = watch->make(watch->context, 0, &solver, error) ? launches_past(watch->scene, &solver, error) : NULL;
        solver_destroy(&solver);
        observing.past = past;
        ok = past != NULL;
    }
    ok = ok && parallel_for(&(ParallelWork){observe, &observing}, watch->count, "launches", progress, error);
    for (int i = 0; observing.steps != NULL && i < watch->count; i++) {
        if (ok && steps != NULL)
            ok = recorded_steps_move(steps, &observing.steps[i]) || error_memory(error, "launches");
        recorded_steps_free(&observing.steps[i]);
    }
    free(observing.steps);
    world_destroy(past);
    return ok;
}

enum { LAUNCH_RUNS_MAX_BYTES = 1 << 30 };

typedef struct PoseWork {
    LaunchRuns *runs;
    const Scene *scene;
    const Method *method;
} PoseWork;

/* The run of a launch whose poses are kept. */
typedef struct PoseRun {
    int bodies;
    BodyPose *poses; /* [frames, bodies] */
} PoseRun;

static bool keep_poses(void *context, int frame, const World *world, Error *error) {
    (void)error;
    const PoseRun *run = context;
    const Body *bodies = world_bodies(world);
    const int count = world_body_count(world);
    for (int i = 0; i < run->bodies; i++)
        run->poses[frame * run->bodies + i] =
            i < count ? (BodyPose){bodies[i].position, bodies[i].angle} : (BodyPose){{NAN, NAN}, NAN};
    return true;
}

static bool run_launch(void *context, int i, Error *error) {
    const PoseWork *work = context;
    const LaunchRuns *runs = work->runs;
    PoseRun run = {runs->bodies, runs->poses + (size_t)i * (size_t)runs->frames * (size_t)runs->bodies};
    const Scene launched = launch_scene(work->scene, &runs->launches[i]);
    World *start = scene_world(&launched, error);
    if (start == NULL) return false;
    keep_poses(&run, 0, start, error);
    world_destroy(start);
    return simulate_observed(&launched, work->method, &(StepObserver){keep_poses, &run}, error);
}

bool launch_runs_record(LaunchRuns *runs, const Scene *scene, const Method *method, const Launch *launches, int count,
                        const Progress *progress, Error *error) {
    *runs = (LaunchRuns){.count = count, .frames = scene->frames + 1, .bodies = scene->body_count + 1};
    if (!scene->bomb.present) return error_input(error, scene->name, "the scene has no bomb, so it has no launches");
    const double bytes = (double)count * runs->frames * runs->bodies * (double)sizeof *runs->poses;
    if (bytes > LAUNCH_RUNS_MAX_BYTES)
        return error_input(error, scene->name, "%d launches take %.0f MiB of poses; at most 1024 MiB are allowed",
                           count, bytes / (1 << 20));
    runs->launches = malloc((size_t)count * sizeof *runs->launches);
    runs->poses = malloc((size_t)bytes);
    if (runs->launches == NULL || runs->poses == NULL) return error_memory(error, scene->name);
    memcpy(runs->launches, launches, (size_t)count * sizeof *launches);
    PoseWork work = {runs, scene, method};
    return parallel_for(&(ParallelWork){run_launch, &work}, count, "launches", progress, error);
}

void launch_runs_free(LaunchRuns *runs) {
    free(runs->launches);
    free(runs->poses);
    *runs = (LaunchRuns){0};
}

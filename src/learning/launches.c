/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over launches of all learners, and what they record: steps with their solutions, or poses. */
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

/* A world without the bomb, also if that is there from the start. */
static World *quiet_world(const Scene *scene, Error *error) {
    Scene quiet = *scene;
    quiet.bomb.present = false;
    return scene_world(&quiet, error);
}

World *launches_past(const Scene *scene, const ContactSolver *solver, Error *error) {
    World *world = quiet_world(scene, error);
    for (int frame = 1; world != NULL && frame <= scene->bomb.frame; frame++) {
        if (world_step(world, solver->kind->solve, solver->state, scene->dt, error)) continue;
        world_destroy(world);
        world = NULL;
    }
    return world;
}

typedef struct Observing {
    const LaunchWatch *watch;
    const World *past;    /* or NULL: launches begin with the scene */
    RecordedSteps *steps; /* [launches] */
} Observing;

/* The world in which a launch begins. */
static World *begin(const Observing *observing, const Scene *launched, Error *error) {
    if (observing->past == NULL) return scene_world(launched, error);
    World *world = quiet_world(launched, error);
    if (world != NULL && world_copy(world, observing->past, error) && scene_add_bomb(launched, world, error))
        return world;
    world_destroy(world);
    return NULL;
}

static bool observe(void *context, int i, Error *error) {
    const Observing *observing = context;
    const LaunchWatch *watch = observing->watch;
    const Scene launched = launch_scene(watch->scene, &watch->launches[i]);
    Reference reference = {0};
    PairMoment now = {0}, labels = {0};
    PhaseTracker tracker = {.impact_frames = watch->impact_frames};
    ContactSolver solver = {0};
    Stepper *stepper = watch->method != NULL ? stepper_create(watch->method, &launched, error)
                       : watch->make(watch->context, i, &solver, error) ? stepper_of_solver(&solver, error)
                                                                        : NULL;
    World *world = stepper != NULL ? begin(observing, &launched, error) : NULL;
    LaunchStep step = {.scene = &launched,
                       .world = world,
                       .launch = watch->first + i,
                       .steps = &observing->steps[i],
                       .reference = &reference,
                       .now = &now,
                       .labels = &labels};
    bool ok = world != NULL && (!watch->whole || watch->see(watch->context, &step, error));
    for (int frame = observing->past != NULL ? launched.bomb.frame + 1 : 1; ok && frame <= launched.frames; frame++) {
        const bool ends = tracker.touch > 0 && frame >= tracker.touch + watch->impact_frames + watch->after_frames;
        Error failure = {0};
        if (ends && !watch->whole) break;
        if (!simulate_step(stepper, world,
                           &(Step){.scene = &launched, .frame = frame, .engine_step = watch->method == NULL},
                           &failure)) {
            ok = watch->may_fail && failure.failure != FAILURE_NONE;
            if (!ok) *error = failure, error_add(error, ", launch %d", step.launch);
            break;
        }
        step.problem = world_problem(world);
        step.phase = phase_next(&tracker, step.problem, frame);
        step.frame = frame;
        step.since = frame - tracker.touch;
        ok = watch->see == NULL || watch->see(watch->context, &step, error);
    }
    world_destroy(world);
    stepper_destroy(stepper);
    reference_free(&reference);
    pair_moment_free(&now);
    pair_moment_free(&labels);
    return ok;
}

bool launches_observe(const LaunchWatch *watch, RecordedSteps *steps, const Progress *progress, Error *error) {
    World *past = NULL;
    Observing observing = {watch, watch->past, calloc((size_t)watch->count + 1, sizeof *observing.steps)};
    bool ok = observing.steps != NULL || error_memory(error, "launches");
    if (ok && !watch->from_start && watch->make != NULL && watch->past == NULL) {
        ContactSolver solver = {0};
        past = watch->make(watch->context, 0, &solver, error) ? launches_past(watch->scene, &solver, error) : NULL;
        solver_destroy(&solver);
        observing.past = past;
        ok = past != NULL;
    }
    ok = ok && parallel_for(&(ParallelWork){observe, &observing}, watch->count, "launches", progress, error);
    for (int i = 0; observing.steps != NULL && i < watch->count; i++) {
        RecordedSteps *from = &observing.steps[i];
        if (ok && steps != NULL)
            ok = array_reserve((void **)&steps->items, &steps->capacity, steps->count + from->count + 1,
                               sizeof *steps->items) ||
                 error_memory(error, "launches");
        if (ok && steps != NULL) {
            for (size_t k = 0; k < from->count; k++) steps->items[steps->count++] = from->items[k];
            steps->unconverged += from->unconverged;
            from->count = 0;
        }
        recorded_steps_free(from);
    }
    free(observing.steps);
    world_destroy(past);
    return ok;
}

enum { LAUNCH_RUNS_MAX_BYTES = 1 << 30 };

static bool keep_poses(void *context, const LaunchStep *step, Error *error) {
    const LaunchRuns *runs = context;
    const Body *bodies = world_bodies(step->world);
    const int count = world_body_count(step->world);
    BodyPose *poses =
        runs->poses + ((size_t)step->launch * (size_t)runs->frames + (size_t)step->frame) * (size_t)runs->bodies;
    (void)error;
    for (int i = 0; i < runs->bodies; i++)
        poses[i] = i < count ? (BodyPose){bodies[i].position, bodies[i].angle} : (BodyPose){{NAN, NAN}, NAN};
    return true;
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
    const LaunchWatch watch = {.scene = scene,
                               .launches = launches,
                               .count = count,
                               .impact_frames = scene->bomb.impact_frames,
                               .whole = true,
                               .method = method,
                               .see = keep_poses,
                               .context = runs};
    return launches_observe(&watch, NULL, progress, error);
}

void launch_runs_free(LaunchRuns *runs) {
    free(runs->launches);
    free(runs->poses);
    *runs = (LaunchRuns){0};
}

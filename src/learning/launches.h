/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches that trainings learn from: their steps with converged solutions, and their poses.

       RecordedSteps steps = {0};
       const LaunchWatch watch = {scene, launches, count, .impact_frames = 10, .make = make, .see = see};
       bool ok = launches_observe(&watch, &steps, progress, error); ... recorded_steps_free(&steps); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "scenes/scenes.h"

/* A contact problem of a step, with its converged solution. */
typedef struct RecordedStep {
    ContactProblem problem; /* a copy */
    int launch, since;      /* steps since the bomb's first touch */
    bool impact;
    ReferenceVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses;      /* [contact_count] */
} RecordedStep;

/* Zero-initialise. */
typedef struct RecordedSteps {
    RecordedStep *items;
    size_t count, capacity;
    size_t unconverged; /* left out, as the reference did not converge */
} RecordedSteps;

void recorded_steps_free(RecordedSteps *steps);

/* A step of a launch, taken. */
typedef struct LaunchStep {
    const Scene *scene; /* with the launch */
    const World *world;
    const ContactProblem *problem; /* NULL at the start, which is frame 0 */
    Phase phase;
    int launch, frame, since; /* since: steps since the bomb's first touch */
    RecordedSteps *steps;     /* of this launch */
    Reference *reference;     /* work space of this launch, as the next */
    PairMoment *now, *labels;
} LaunchStep;

/* Appends the step with the solution of the last solve of step->reference; or counts it, if that has not converged. */
bool launch_step_record(const LaunchStep *step, bool converged, Error *error);

typedef struct LaunchWatch {
    const Scene *scene;
    const Launch *launches; /* [count] the bomb's frame is the scene's in all of them */
    int count, first;       /* first: number of the first of them, in LaunchStep */
    int impact_frames;      /* of the phase */
    int after_frames;       /* that are seen after it; then the launch ends */
    bool may_fail;          /* a launch that comes to a NaN or infinite state ends there; otherwise that is an error */
    bool from_start;      /* each launch begins with the scene; otherwise with the bomb, after a past that all share */
    bool whole;           /* a launch does not end after its impact, and its start is seen, too */
    const Method *method; /* runs the launches from their start, as in a run of the scene. Or NULL: */
    /* Makes the solver of launch i of the list, which is destroyed after it; its contacts are Box2D-Lite's. */
    bool (*make)(void *context, int i, ContactSolver *solver, Error *error);
    bool (*see)(void *context, const LaunchStep *step, Error *error); /* or NULL */
    void *context;
    World *past; /* NULL: is made. A caller that observes one launch after the other keeps that of launches_past() */
} LaunchWatch;

/* Runs the launches on all threads; `steps`, or NULL, receives what was recorded, in the order of launches and steps.
   The same for any number of threads. */
bool launches_observe(const LaunchWatch *watch, RecordedSteps *steps, const Progress *progress, Error *error);

/* The world of the scene just before the bomb is added. NULL with error set. */
World *launches_past(const Scene *scene, const ContactSolver *solver, Error *error);

/* A copy with bodies and contacts of its own, in one block. False when memory is short; free it in any case. */
bool problem_copy(ContactProblem *copy, const ContactProblem *problem);
void problem_copy_free(ContactProblem *copy);

/* A solver with the settings of the text, "k=20". */
bool solver_with(ContactSolver *solver, const ContactSolverKind *kind, const char *text, Error *error);

/* Does nothing with one that was zero-initialised and not made. */
void solver_destroy(ContactSolver *solver);

/* Poses of launches of a scene, run by a method. */
typedef struct LaunchRuns {
    int count;        /* of launches */
    int frames;       /* of each: steps + 1 */
    int bodies;       /* with the bomb, the last */
    Launch *launches; /* [count] */
    BodyPose *poses;  /* [count, frames, bodies] NaN while the bomb does not exist */
} LaunchRuns;

/* Runs the launches [count] of a scene with a bomb, in parallel; the same bits for any number of threads. False with
   error set if a run fails, the poses take more than 1 GiB, or progress requests a stop. Free it in any case. */
bool launch_runs_record(LaunchRuns *runs, const Scene *scene, const Method *method, const Launch *launches, int count,
                        const Progress *progress, Error *error);
void launch_runs_free(LaunchRuns *runs);

/* The poses[bodies] of a frame; frame 0 is the state before the first step. */
static inline const BodyPose *launch_runs_frame(const LaunchRuns *runs, int launch, int frame) {
    return runs->poses + ((size_t)launch * (size_t)runs->frames + (size_t)frame) * (size_t)runs->bodies;
}

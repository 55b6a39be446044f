/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two protocols of the speed-accuracy study: a run in closed loop, with its log, its measures and the scores of its
   steps; and steps that are frozen, which every method solves. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/steppers.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The converged solution that a step is scored against. For most methods it is that of the step's contact problem. A
   method that moves overlapping bodies apart without giving them a velocity (no_push_out in its description) solves
   another problem: the same one without the bias that pushes bodies apart. */

/* Zero-initialise. */
typedef struct ConvergedStep {
    Reference reference; /* of the last solve: velocities, residual */
    Reference other;     /* from other starts */
    ContactPoint *contacts;
    size_t contact_capacity;
} ConvergedStep;

/* Whether the last solve converged. What a bad method made explode does not, and neither do some impacts on hundreds of
   boxes; against that no error is measured. */
static inline bool converged_step_found(const ConvergedStep *converged) {
    return converged->reference.residual <= REFERENCE_TOLERANCE;
}

/* The floors (methods/reference.h) of the steps of a phase that converged. */
typedef struct FloorSum {
    double sum; /* m/s */
    int64_t steps;
} FloorSum;

/* Log of a run, for comparison with another run of the same launch. */

typedef struct LoggedFrame {
    double energy;      /* J: mechanical energy of all dynamic bodies */
    double penetration; /* m: deepest contact of the step; 0 without contacts */
    Phase phase;        /* of the step */
    Vec2 bomb;          /* m: the bomb's position; 0 before it is there */
} LoggedFrame;

/* Zero-initialise; arrays grow and are reused. Bodies exclude the bomb. */
typedef struct RunLog {
    int bodies, frames;          /* frames: index of the last logged frame */
    int touch;                   /* first step in which the bomb touches; 0: none */
    int launch_frame, end_frame; /* the bomb's frame, and 5 s later: displaced boxes are counted between them */
    Vec2 *position;              /* [frames + 1, bodies] m */
    LoggedFrame *at;             /* [frames + 1] */
    double momentum_error;       /* N s: momentum created by steps (ContactSolution), sum */
    int fallen_back;             /* steps with discarded outputs, beyond training or solved by sweeps */
    int unconverged;             /* steps that did not converge, of the reference */
    int first_unconverged;       /* the first of them, from which on the log is no yardstick; 0: none */
    size_t position_capacity, at_capacity;
} RunLog;

void run_log_free(RunLog *log);

/* Begins the log of a run of the scene. False if out of memory. */
bool run_log_begin(RunLog *log, const Scene *scene, const World *world);

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase);

/* The first frame in which a body, the bomb included, is more than `limit` m from its place in another run of the same
   launch; if the log ended early (NaN or infinite), at the latest the frame after its last; `frames` if never. */
int run_log_apart(const RunLog *log, const RunLog *other, double limit, int frames);

/* Boxes that moved more than 0.5 m in the 5 s after the launch; all if the log ended early. */
double run_log_moved(const RunLog *log, const Scene *scene);

/* A run compared with the converged run of the same launch; NaN if a phase does not occur. Energy and drift are
   compared before the converged run's first step that did not converge. */
typedef struct RunMeasures {
    double penetration[PHASES]; /* m: largest of the phase */
    double energy[PHASES];      /* J: excess over the converged run at the same frame, mean over the phase */
    double drift; /* m: mean distance of the boxes from the converged run, just before the bomb touches in either run */
    double moved; /* boxes that moved more than 0.5 m in the 5 s after the launch */
    /* m^2: squared distance from the converged run, mean over frames, boxes and both coordinates; NaN if the state
       became NaN or infinite before that run did not converge */
    double rollout_mse;
} RunMeasures;

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene);

/* A closed-loop run of a method; each step is scored against its own converged solution. */

/* Where the error of a scored step is largest. */
typedef struct StepPlace {
    int frame, body; /* body -1: none */
} StepPlace;

/* The laws of contact (methods/criteria.h), summed over the scored steps with impulses. */
typedef struct CriteriaSum {
    double signorini, cone, dissipation; /* J, N s, J */
    int64_t steps;
} CriteriaSum;

/* Errors of the scored steps. Zero-initialise; free with step_scores_free(). */
typedef struct StepScores {
    int count;
    double *error;    /* [count] m/s, RMS over the dynamic bodies */
    double *share;    /* [count] share of bodies that are right (methods/reference.h) */
    StepPlace *place; /* [count] */
    CriteriaSum criteria;
    size_t error_capacity, share_capacity, place_capacity;
} StepScores;

void step_scores_free(StepScores *scores);

/* All impact frames are scored; of the frames after and at rest, every n-th: reference solves dominate the run time. */
typedef struct Sampling {
    int after, rest;
} Sampling;

/* One thread's run in progress; zero-initialise, free with rollout_free. */
typedef struct Rollout {
    World *world;
    ConvergedStep converged;
    RunLog log;
    int unconverged;                  /* steps that are not scored (converged_step_found()) */
    bool engine_contacts;             /* set by the caller: its steps have the contacts that the engine's have (Step) */
    const struct SharedSteps *shared; /* set by the caller: how the run begins; or NULL */
    FloorSum *floors; /* [PHASES] set by the caller: of the sampled steps that it does not share; NULL: not measured */
} Rollout;

void rollout_free(Rollout *rollout);

/* Runs a launched scene and adds the sampled steps to scores[PHASES] (NULL: none) and to its floors. If the state
   becomes NaN or infinite, the run ends early and its log is shorter. False with error set if out of memory. */
bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error);

/* The first steps of several launches, before the bomb appears. Zero-initialise; free with shared_steps_free(). */
typedef struct SharedSteps {
    Rollout rollout;
    StepMemory memory; /* after them */
    StepScores scores[PHASES];
    bool ended; /* one of them failed */
} SharedSteps;

/* Takes them with one of the launches, once. The runs that begin so have the same stepper and sampling. */
bool shared_steps_run(SharedSteps *shared, Stepper *stepper, const Scene *launched, int steps, const Sampling *sampling,
                      Error *error);
void shared_steps_free(SharedSteps *shared);

/* The frozen protocol: every method solves the same steps, sampled from engine runs. */

typedef struct Snapshot {
    const Scene *scene; /* launched; owned by the caller */
    World *world;       /* before the step */
    int frame;          /* of the step */
    Phase phase;
    ReferenceVelocity *reference;   /* [bodies] converged velocities after the step */
    ReferenceVelocity *no_push_out; /* [bodies] the same for methods of that description; or NULL */
} Snapshot;

/* Zero-initialise. */
typedef struct SnapshotList {
    int count;
    Snapshot *items; /* [count] */
    size_t capacity;
    bool no_push_out; /* set by the caller: methods of that description will be scored, too */
    int unconverged;  /* steps that were left out (converged_step_found()) */
    FloorSum *floors; /* [PHASES] set by the caller; NULL: not measured */
} SnapshotList;

/* Adds sampled steps of the engine's run of a launched scene; the scene must outlive the list. */
bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error);
void snapshots_free(SnapshotList *list);

/* Scores a method on every step. world: scratch space for a copy. A method of the description no_push_out needs a list
   with that flag. */
bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES], Error *error);

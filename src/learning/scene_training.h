/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of scene-net: recorded impacts, first weights, loss through unrolled sweeps, scores. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/reference.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Differentiable momentum sweeps (methods/momentum.h, in colour order) in double: reverse-mode derivatives of a loss of
   the final velocities with respect to the start impulses and the momentum factors. A network that predicts the start
   of a solve can thus be trained on the result of the solve.

   A sweep is piecewise linear. The backward pass uses the piece that each visit took in the forward pass, so the
   derivative is exact, except at a kink, where it is that of one of the two pieces. Sources: Griewank and Walther,
   "Evaluating Derivatives" (2008), chapter 3 (reverse mode); Monga, Li, Eldar, "Algorithm Unrolling" (2021) (training
   through an unrolled solver).

   by_x denotes the derivative of the loss with respect to x. */

/* One contact point. `normal` and `tangent` are Jacobian rows: linear part for b (negated for a), angular part for a
   and for b. Their product with the velocities is the relative velocity of the contact point of b along the
   direction. */
typedef struct UnrolledContact {
    int a, b;
    double normal[4], tangent[4];     /* x, y, -cross(arm_a, direction), cross(arm_b, direction) */
    double mass_normal, mass_tangent; /* kg */
    double friction;
    double bias;     /* m/s */
    double coupling; /* tangential m/s caused by a normal impulse of 1 N s */
} UnrolledContact;

typedef struct UnrolledProblem {
    int body_count, contact_count;
    UnrolledContact *contacts; /* [contact_count] */
    int32_t *visits;           /* [contact_count] contacts in colour order */
    double *inv_mass;          /* [body_count] 1/kg */
    double *inv_inertia;       /* [body_count] 1/(kg m^2) */
    double *free;              /* [3 body_count] velocity x, y (m/s) and spin (rad/s) before any impulse */
} UnrolledProblem;

/* Free with unrolled_problem_free(). False if out of memory. */
bool unrolled_problem_make(UnrolledProblem *unrolled, const ContactProblem *problem);
void unrolled_problem_free(UnrolledProblem *problem);

/* Work space of a thread. Zero-initialise; arrays grow and are reused. A state is velocities [3 body_count], then
   impulses [2 contact_count]. */
typedef struct Unrolled {
    double *velocities; /* [3 body_count] result of unrolled_run(), in `states` */
    double *impulses;   /* [2 contact_count] N s, normal and tangent of each contact, in `states` */
    int sweeps;
    double *states;   /* [sweeps + 1, state] the start, and after each sweep */
    uint8_t *pieces;  /* [sweeps + 1, contact_count] pieces of the start's projection and of each visit */
    double *factors;  /* [sweeps] */
    double *adjoints; /* [2, state] */
    size_t state_capacity, piece_capacity, factor_capacity, adjoint_capacity;
} Unrolled;

void unrolled_free(Unrolled *unrolled);

/* Projects start[2 contact_count] (N s, normal and tangent of each contact) into the friction cone (Pn = max(Pn, 0),
   Pt = clamp(Pt, -mu Pn, mu Pn)), then runs sweeps >= 0 sweeps. factors[s] extrapolates before sweep s; factors[0] is
   ignored. False if out of memory. */
bool unrolled_run(Unrolled *unrolled, const UnrolledProblem *problem, const double *start, const double *factors,
                  int sweeps);

/* Backward pass, after unrolled_run() of the same problem; may be repeated. by_velocity[3 body_count] refers to the
   final velocities. Writes by_start[2 contact_count] and adds to by_factors[sweeps], if by_factors != NULL. */
void unrolled_back(Unrolled *unrolled, const UnrolledProblem *problem, const double *by_velocity, double *by_start,
                   double *by_factors);

/* A copy with bodies and contacts of its own, in one block. False when memory is short; free it in any case. */
bool problem_copy(ContactProblem *copy, const ContactProblem *problem);
void problem_copy_free(ContactProblem *copy);

/* A solver with the settings of the text, "k=20". */
bool solver_with(ContactSolver *solver, const ContactSolverKind *kind, const char *text, Error *error);

/* Does nothing with one that was zero-initialised and not made. */
void solver_destroy(ContactSolver *solver);

/* Training samples of scene-net: contact problems of impacts with their converged solutions. */

typedef struct SceneNetSample {
    ContactProblem problem; /* owns its arrays */
    int launch, since;      /* number of the launch; steps since the bomb's first touch */
    /* After scene_net_samples_label: */
    ReferenceVelocity *reference; /* [body_count] */
    ContactImpulse *goal;         /* [contact_count] impulses of the reference */
    UnrolledProblem unrolled;
    /* After scene_net_samples_compute_inputs: */
    SceneView view;
    float *inputs; /* [scene_net_inputs] */
} SceneNetSample;

/* Zero-initialise. */
typedef struct SceneNetSamples {
    SceneNetSample *items;
    int count;
    int unconverged; /* samples that scene_net_samples_label() left out */
    size_t capacity;
} SceneNetSamples;

void scene_net_samples_free(SceneNetSamples *samples);

/* Appends a copy of a problem. False if out of memory. */
bool scene_net_samples_add(SceneNetSamples *samples, const ContactProblem *problem, int launch, int since);

/* Moves all of `from` to the end of the samples. False if out of memory. */
bool scene_net_samples_move(SceneNetSamples *samples, SceneNetSamples *from);

/* Solves the samples from index `first` by the reference, and leaves out those that do not converge. */
bool scene_net_samples_label(SceneNetSamples *samples, int first, const Progress *progress, Error *error);

/* Computes the view and the network inputs of the samples from index `first`. The inputs are valid only if the network
   has projections. */
bool scene_net_samples_compute_inputs(SceneNetSamples *samples, int first, const SceneNet *network, Error *error);

/* Errors of a scene network and of its untrained baseline. */

typedef struct SceneNetScore {
    int round, samples;
    int unconverged;        /* impacts left out so far, as the reference did not converge */
    double train, held_out; /* m/s: mean error of network + sweeps on training and on held-out launches */
    double momentum;        /* m/s: mean error of momentum with 20 sweeps and warm start, held-out launches */
} SceneNetScore;

/* A trained scene network beside momentum in the same time, on held-out launches. */

typedef struct SceneNetVerdict {
    int samples;
    double network;       /* m/s: mean error of the network and its sweeps, without sweeps by the stopping rule */
    double at_equal_time; /* m/s: of momentum with `sweeps` */
    double at_20;         /* m/s: of momentum with 20 sweeps */
    int sweeps;           /* of momentum, that take as long as the network and its sweeps: 1 .. 200 */
    double microseconds;  /* of a step by the network and its sweeps */
} SceneNetVerdict;

/* Initialises scene-net's network from samples of a scene: slots, input projections, output scales, random weights. */

typedef struct SceneNetWidths {
    int state, present, warm; /* number of input components of each projection */
    int hidden;
} SceneNetWidths;

/* Makes an untrained network for labelled samples and computes their inputs. Slots are the contacts that occur in at
   least 3 samples. NULL with error set: no samples, memory, or a shape out of bounds (scene_net_create). */
SceneNet *scene_net_from_samples(SceneNetSamples *samples, const SceneNetWidths *widths, uint64_t seed, Error *error);

/* Trains a network for the impacts of one scene (methods/scene_net.c). The first round runs launches, solves their
   impacts by the reference and fits the network through the sweeps that follow it. Later rounds run launches with the
   network and fit it to the aggregated impacts (DAgger). Source: Ross, Gordon, Bagnell, "A Reduction of Imitation
   Learning and Structured Prediction to No-Regret Online Learning" (2011). */

typedef struct SceneTraining {
    int launches;  /* per round, drawn from the scene's family; half of them with a random rotation and spin */
    int rounds;    /* the first is run by momentum and by the reference, the others by the network */
    int epochs;    /* of the first round; later rounds have half as many */
    int sweeps;    /* after the network */
    bool momentum; /* learn momentum factors for the sweeps */
    SceneNetWidths widths;
    uint64_t seed;
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const SceneNetScore *score);
    void *context;
    SceneNetVerdict *verdict; /* on the network that is returned; or NULL */
} SceneTraining;

/* NULL with error set: a scene without a bomb or with one x, launches that touch nothing, memory, a loss that is NaN
   or infinite. If progress stops the training after the first network was made, returns the network as it is.
   `command` is left empty. Same bits for any number of threads. */
SceneNet *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress, Error *error);

/* Contact problems that runs have recorded, with their converged velocities. */

typedef struct ImpactProblem {
    ContactProblem problem; /* owns its arrays */
    ReferenceVelocity *reference;
    bool impact;
} ImpactProblem;

typedef struct ImpactProblems {
    ImpactProblem *items;
    size_t count, capacity;
    size_t unconverged; /* not appended, as the reference did not converge */
} ImpactProblems;

void impact_problems_free(ImpactProblems *problems);

/* Appends a copy. reference: [body_count]. False when memory is short. */
bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact);

/* Appends the items of `from`, which is empty afterwards. False when memory is short. */
bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from);

/* The launches of a training of a scene network. Those that are held out, and those of the first round, do not depend
   on the network. */

/* RMS residual of the warm start over the contacts, m/s: below it at rest, above it during a shock. Only the latter are
   samples. */
#define SCENE_RECORDING_GATE 0.3f

/* Launches by who runs them. */
typedef enum SceneSet { SCENE_HELD_OUT, SCENE_BY_MOMENTUM, SCENE_BY_REFERENCE, SCENE_SETS } SceneSet;

/* scene_recording_end(). */
typedef struct SceneRecording {
    const Scene *scene;
    const SceneTraining *training;
    gsl_rng *generator; /* of the next round */
    int round;
    Launch *launches;          /* of the sets, in their order; the last two are the round's */
    int first[SCENE_SETS + 1]; /* launch of each set, then the end */
} SceneRecording;

/* Draws the launches of the first round, and checks those of all rounds: the last round must not be the first to be
   refused. ERROR_INPUT also for a scene without a bomb or with one x. All pointers must outlive the recording, which
   must stay where it is. */
bool scene_recording_begin(SceneRecording *recording, const Scene *scene, const SceneTraining *training, Error *error);
void scene_recording_end(SceneRecording *recording);

/* Runs the launches of a set and appends their labelled samples, in the order of launches. */
bool scene_recording_take(const SceneRecording *recording, SceneSet set, SceneNetSamples *samples,
                          const Progress *progress, Error *error);

/* Draws the launches of the next round, runs them with the network and appends their labelled samples. */
bool scene_recording_next(SceneRecording *recording, const SceneNet *network, SceneNetSamples *samples,
                          const Progress *progress, Error *error);

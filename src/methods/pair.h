/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A touching pair as a pair network sees it. */
#pragma once
#include "engine/engine.h"

#include <stdbool.h>
#include <stddef.h>

/* The state within a step between two sweeps: velocities and impulses so far, and one Jacobi sweep from there. */

/* Zero-initialise; arrays grow and are reused. */
typedef struct PairMoment {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count] so far */
    /* filled by pair_moment_jacobi(): */
    ContactImpulse *alone; /* [contact_count] added by each contact alone */
    BodyVelocity *pushes;  /* [body_count] change of each body by all of these */
    ArrayBlock arrays;
} PairMoment;

void pair_moment_free(PairMoment *moment);

/* Reserves memory for a problem; the caller fills velocities and impulses. False when memory is short. */
bool pair_moment_reserve(PairMoment *moment, const ContactProblem *problem);

/* The velocities and impulses as a solution for a solver to fill. */
ContactSolution pair_moment_solution(const PairMoment *moment);

/* One Jacobi sweep: visits every contact once, all from the same velocities. */
void pair_moment_jacobi(PairMoment *moment, const ContactProblem *problem);

/* Of `pushes`, the part by other pairs than the one whose contacts begin at `first`, on one of its two bodies. */
BodyVelocity pair_moment_others(const PairMoment *moment, const ContactProblem *problem, int first, int body);

/* A touching pair as input and target of the paper's network (Avatavului, Ifrim, Voncila 2023, section 3.1). */

/* The inputs of a network for one pair. The paper names ten inputs: positions, velocities and angular velocities
   (section 3), or rotations too (3.1), with absolute or relative positions. That permits these readings:

     relative     10: position of b relative to a, velocities, angular velocities, rotations
     raw          12: positions, velocities, angular velocities, rotations
     raw-unturned 10: positions, velocities, angular velocities

   Beyond the paper there are two views in the frame of the contact (normal, tangent), with the quantities of sequential
   impulses:

     contact      20: for each of two points velocity of b's point relative to a's, bias, impulses so far (as the
                      change of relative velocity that they make), both arms; then a's share of the inverse masses, and
                      1 where there is a second point (0, and zeros for the point, where not)
     neighbours   32: the same, and of a, then of b, velocity (2) and spin (1): what other pairs would change next if
                      each contact were alone, and what has changed since the step began */
typedef enum PairView {
    PAIR_RELATIVE,
    PAIR_RAW,
    PAIR_RAW_UNTURNED,
    PAIR_CONTACT,
    PAIR_NEIGHBOURS,
    PAIR_VIEWS
} PairView;

enum { PAIR_INPUTS = 10, PAIR_INPUTS_MAX = 32, PAIR_CHANGES = 6, PAIR_POINTS = 2, PAIR_POINT_CHANGES = 4 };

typedef struct PairViewInfo {
    const char *name;
    int count;
    bool by_contact;    /* in the contact frame, after the warm start */
    const char *inputs; /* names of the inputs, separated by spaces */
} PairViewInfo;

extern const PairViewInfo pair_views[PAIR_VIEWS];

/* The target of a network for one pair; the paper does not specify it. */
typedef enum PairTarget {
    TARGET_PAIR,    /* the change by the pair's own impulses over the step */
    TARGET_NET,     /* the change of its two bodies by all impulses over the step */
    TARGET_IMPULSE, /* the change by one visit of the pair in one sweep */
    TARGET_POINTS,  /* beyond the paper, for PAIR_CONTACT: impulses at its points less the warm start */
    PAIR_TARGETS
} PairTarget;

extern const char *const pair_target_names[PAIR_TARGETS + 1]; /* ends in NULL */

/* Finds the view by its inputs; false if no view has them. */
bool pair_view_of_inputs(const char *inputs, PairView *view);

/* Fills inputs[pair_views[view].count] of the pair whose contacts begin at `first`. now: velocities and impulses so
   far, for PAIR_NEIGHBOURS after pair_moment_jacobi(); NULL for a view that is not by contact. */
void pair_inputs(const ContactProblem *problem, const PairMoment *now, int first, PairView view, float *inputs);

/* Velocity of b's point relative to a's, along normal and tangent. */
Vec2 pair_point_velocity(const ContactPoint *contact, const BodyVelocity *a, const BodyVelocity *b);

/* The sum of the inverse masses of two bodies, 1/kg. */
float pair_inverse_mass(const ContactProblem *problem, int first);

/* The number of contacts, from `first` on, that belong to the same pair. */
int pair_contact_count(const ContactProblem *problem, int first);

/* The number of values of a target: 4 for points (normal and tangent of each), else 6. */
int pair_change_count(PairTarget target);

/* Names of the `outputs` values of a network with this view and target, separated by spaces; NULL for an impossible
   number. All changes, or for 2 the change of the velocity of b relative to a: along x and y or, in contact views,
   along normal and tangent. */
const char *pair_output_names(PairView view, PairTarget target, int outputs);

/* The change by the pair's own impulses over the step: velocity (2) and angular velocity (1) of a, then of b. first,
   count: the pair's contacts in the problem. */
void pair_changes(const ContactProblem *problem, const ContactSolution *solution, int first, int count,
                  float changes[PAIR_CHANGES]);

/* The impulses [contact_count] of the pair's points less the warm start, as changes of the relative velocity, m/s. */
void pair_point_changes(const ContactProblem *problem, const ContactImpulse *impulses, int first,
                        float changes[PAIR_POINT_CHANGES]);

/* The target values (not of TARGET_IMPULSE) of a network with this view, from a solution of the step, for the pair
   whose contacts begin at `first`. */
void pair_step_changes(const ContactProblem *problem, const ContactSolution *solution, int first, PairView view,
                       PairTarget target, float changes[PAIR_CHANGES]);

/* Rotates the velocities in a pair's changes from world axes to its contact frame, and back. */
void pair_to_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]);
void pair_from_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]);

/* The data of a touching pair that the laws of physics (learning/pair_training.h) need, beyond the inputs of a
   network. */

/* Indices into a pair's context. Vectors in world axes. */
enum {
    CONTEXT_INV_MASS_A,    /* 1/kg, 0 for a static body */
    CONTEXT_INV_INERTIA_A, /* 1/(kg m^2) */
    CONTEXT_INV_MASS_B,
    CONTEXT_INV_INERTIA_B,
    CONTEXT_NORMAL,          /* (2) unit, from a to b */
    CONTEXT_FRICTION = 6,    /* coefficient */
    CONTEXT_ARM_A,           /* (2) m, from the centre of a to the middle of the pair's points */
    CONTEXT_ARM_B = 9,       /* (2) */
    CONTEXT_VELOCITIES = 11, /* (6) before the step's impulses: velocity, angular velocity of a, then of b */
    PAIR_CONTEXT = 17
};

/* Fills the context of the pair whose contacts begin at `first`. */
void pair_context(const ContactProblem *problem, int first, float context[PAIR_CONTEXT]);

/* Returns why a context of finite numbers is invalid, or NULL. */
const char *pair_context_fault(const float context[PAIR_CONTEXT]);

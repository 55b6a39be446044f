/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A touching pair as the paper's network meets it (Avatavului, Ifrim, Voncila 2023, section 3.1): what the solver
   saw, and what it did to that pair. */
#pragma once
#include "pair/pair_moment.h"

#include <stdbool.h>

/* How a network sees a pair. The paper has ten inputs, made of positions, velocities and angular velocities (section 3)
   or with rotations too (3.1), first as they are and then with the difference of the positions; so it can be read as

     relative     10: position of b relative to a, velocities, angular velocities, rotations
     raw          12: positions, velocities, angular velocities, rotations
     raw-unturned 10: positions, velocities, angular velocities

   and, beyond the paper, as sequential impulses meet it, in the frame of the contact (normal, tangent):

     contact      20: for each of two points velocity of b's point as seen from a's, bias, impulses so far (as the
                      change of relative velocity that they make), both arms; then a's share of the inverse masses, and
                      1 where there is a second point (0, and zeros for the point, where not)
     neighbours   32: the same, and of a, then of b, velocity (2) and spin (1): what other pairs would change next if
                      each contact were alone (pair_moment.h), and what has changed since the step began */
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
    bool by_contact;    /* in the frame of the contact, and of the moment after the warm start */
    const char *inputs; /* names of the numbers, separated by spaces */
} PairViewInfo;

extern const PairViewInfo pair_views[PAIR_VIEWS];

/* What a network may be asked about a pair; the paper leaves it open. */
typedef enum PairTarget {
    TARGET_PAIR,    /* what the pair's own impulses changed over the step */
    TARGET_NET,     /* what all impulses changed of its two bodies over the step */
    TARGET_IMPULSE, /* what one visit of the pair in one sweep changed, from the velocities that it then had */
    TARGET_POINTS, /* beyond the paper, for PAIR_CONTACT: how far the impulses at its points went beyond the warm start */
    PAIR_TARGETS
} PairTarget;

extern const char *const pair_target_names[PAIR_TARGETS + 1]; /* ends in NULL */

/* The view of that name, or of those inputs; false where there is none. */
bool pair_view_find(const char *name, PairView *view);
bool pair_view_of_inputs(const char *inputs, PairView *view);

/* inputs[pair_views[view].count] of the pair whose contacts begin at `first`. now: the moment to show, for
   PAIR_NEIGHBOURS after pair_moment_look(); NULL, where the view is not by contact: before the warm start. */
void pair_inputs(const ContactProblem *problem, const PairMoment *now, int first, PairView view, float *inputs);

/* Velocity of b's point as seen from a's, along normal and tangent. */
Vec2 pair_point_velocity(const ContactPoint *contact, const BodyVelocity *a, const BodyVelocity *b);

/* m/s of relative velocity of their centres that an impulse of 1 N s between two bodies makes, 1/kg. */
float pair_inverse_mass(const ContactProblem *problem, int first);

/* The number of contacts, from `first` on, that belong to the same pair. */
int pair_contact_count(const ContactProblem *problem, int first);

/* Numbers in the changes of a target: 4 for points (normal and tangent of each), else 6. */
int pair_change_count(PairTarget target);

/* Names of the `outputs` numbers that a network of this view and target gives, separated by spaces; NULL where it cannot
   give so many. All changes, or for 2 those of the velocity of b relative to a: along x and y or, by the contact view,
   along normal and tangent. */
const char *pair_output_names(PairView view, PairTarget target, int outputs);

/* What the pair's own impulses did over the step: change of velocity (2) and angular velocity (1) of a, then of b.
   first, count: the pair's contacts in the problem. */
void pair_changes(const ContactProblem *problem, const ContactSolution *solution, int first, int count,
                  float changes[PAIR_CHANGES]);

/* How far impulses [contact_count] of the pair's points went beyond the warm start, as changes of the relative
   velocity, m/s. */
void pair_point_changes(const ContactProblem *problem, const ContactImpulse *impulses, int first,
                        float changes[PAIR_POINT_CHANGES]);

/* What a solution of the step did to the pair whose contacts begin at `first`, as a network of this view and target
   (not TARGET_IMPULSE) is to say it. */
void pair_step_changes(const ContactProblem *problem, const ContactSolution *solution, int first, PairView view,
                       PairTarget target, float changes[PAIR_CHANGES]);

/* Turns the velocities in changes of a pair from world axes into those of its contact, and back. */
void pair_to_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]);
void pair_from_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]);

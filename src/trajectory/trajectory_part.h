/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Why two trajectories part: the first frame in which any bit differs, and what the step that leads there did.

   Contacts of step k come from the poses of frame k - 1. Where all states of frame k - 1 are equal, so are the contacts
   unless collision detection differs, and what differs in frame k is the solver's work - or what no state shows: the
   impulses that the step before hands on as a warm start. Those are recorded with the contacts. */
#pragma once
#include "trajectory/trajectory_states.h"

/* The contacts of one step of two runs; the same contact is one of the same bodies and feature. */
typedef struct ContactDifference {
    int count_a, count_b;
    int only_a, only_b;                     /* which the other does not have */
    int moved;                              /* the same, but with another point or normal */
    int changed;                            /* the same, but with another impulse */
    TrajectoryContact only;                 /* the first that one run only has, where there is one: */
    bool only_first_a;                      /* a, or b */
    TrajectoryContact largest_a, largest_b; /* whose impulses differ most, where any do; of equals the first */
} ContactDifference;

/* Of those that touch the body (-1: of all). Contacts count in the order of bodies a, b and feature. False with error set
   when memory is short. */
bool contact_difference(const Trajectory *a, const Trajectory *b, int step, int body, ContactDifference *difference,
                        Error *error);
bool contacts_differ(const ContactDifference *difference);

/* What made the first frame differ in which any bit does. */
typedef enum PartCause {
    PART_NONE,     /* no state differs */
    PART_START,    /* it is frame 0 */
    PART_LAUNCH,   /* only bodies that were not there before */
    PART_HIDDEN,   /* contacts of an earlier step differ, though no state does: `step` */
    PART_CONTACTS, /* from equal states, other contacts: collision detection */
    PART_SOLVER,   /* from equal states and contacts, other impulses */
    PART_ELSEWHERE /* from equal states, equal contacts and impulses */
} PartCause;

typedef struct PartedBody {
    int frame, body; /* -1, -1: nowhere. Of the bodies of a frame the first */
    int bodies;      /* how many part in that frame */
    StateDifference by;
} PartedBody;

typedef struct TrajectoryParting {
    int frames;                        /* that both have */
    PartedBody first;                  /* any bit of pose or velocity */
    PartedBody beyond;                 /* positions farther apart than the tolerance, or in one run only */
    PartCause cause;                   /* of the first */
    int step;                          /* the first whose contacts differ, -1: none up to the first frame */
    ContactDifference contacts;        /* of that step */
    ContactDifference beyond_contacts; /* of the step that leads beyond the tolerance, with that body */
} TrajectoryParting;

/* tolerance in m; with 0 any bit counts, and beyond is first. The two are of worlds that do not differ. False with error
   set when memory is short. */
bool trajectory_part(const Trajectory *a, const Trajectory *b, double tolerance, TrajectoryParting *parting,
                     Error *error);

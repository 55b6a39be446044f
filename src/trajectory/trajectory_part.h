/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Why two trajectories diverge: the first frame in which any bit differs, and the step that leads to it.

   Contacts of step k follow from the poses of frame k - 1. If all states of frame k - 1 are equal, so are the contacts,
   unless collision detection differs. A difference in frame k then comes from the solver, or from the warm start: the
   impulses of the previous step, which are recorded with its contacts. */
#pragma once
#include "trajectory/trajectory_states.h"

/* The contacts of one step of two runs, matched by bodies and feature. */
typedef struct ContactDifference {
    int count_a, count_b;
    int only_a, only_b;                     /* that the other does not have */
    int moved;                              /* matched, with another point or normal */
    int changed;                            /* matched, with another impulse */
    TrajectoryContact only;                 /* the first that exists in one run only, if any: */
    bool only_first_a;                      /* a, or b */
    TrajectoryContact largest_a, largest_b; /* with the largest difference of impulses, if any; the first of equals */
} ContactDifference;

/* Compares the contacts of a body (-1: all), in the order of bodies a, b and feature. False with error set when memory
   is short. */
bool contact_difference(const Trajectory *a, const Trajectory *b, int step, int body, ContactDifference *difference,
                        Error *error);
bool contacts_differ(const ContactDifference *difference);

/* The cause of the first difference in any bit. */
typedef enum PartCause {
    PART_NONE,      /* no state differs */
    PART_START,     /* frame 0 differs */
    PART_LAUNCH,    /* only bodies that did not exist before */
    PART_HIDDEN,    /* contacts of an earlier step differ, but no state: `step` */
    PART_CONTACTS,  /* equal states, different contacts: collision detection */
    PART_SOLVER,    /* equal states and contacts, different impulses */
    PART_ELSEWHERE, /* equal states, contacts and impulses */
    PART_UNKNOWN    /* equal states; one of the runs does not have its contacts */
} PartCause;

typedef struct PartedBody {
    int frame, body; /* -1, -1: none. The first body of the frame */
    int bodies;      /* number of bodies that differ in that frame */
    StateDifference by;
} PartedBody;

typedef struct TrajectoryParting {
    int frames;                        /* that both have */
    bool poses_only;                   /* the velocities of one or both are unknown */
    PartedBody first;                  /* any bit of pose or velocity */
    PartedBody beyond;                 /* distance above the tolerance, or in one run only */
    PartCause cause;                   /* of the first */
    int step;                          /* the first whose contacts differ; -1: none up to the first frame */
    ContactDifference contacts;        /* of that step */
    ContactDifference beyond_contacts; /* of the step that exceeds the tolerance, with that body */
} TrajectoryParting;

/* tolerance in m; with 0 any bit counts, and beyond is first. The two must be of the same world
   (trajectory_different_worlds). False with error set when memory is short. */
bool trajectory_part(const Trajectory *a, const Trajectory *b, double tolerance, TrajectoryParting *parting,
                     Error *error);

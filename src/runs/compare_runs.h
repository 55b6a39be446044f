/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two runs differ, and why they part:

     TrajectoryDifference difference;
     trajectory_compare(a, b, &difference);
     if (!difference.equal) printf("body %d in frame %d\n", difference.body, difference.frame); */
#pragma once
#include "base/base.h"
#include "runs/trajectory.h"

/* Where two trajectories differ. */
typedef struct TrajectoryDifference {
    bool equal;      /* every bit of every pose and velocity */
    bool poses_only; /* the velocities of one or both are unknown, and not compared */
    /* a difference without a distance: "bodies: 12 and 67", "frames: 301 and 481", or a body that exists in one of the
       two only; else empty */
    char what[256];
    int frame, body;         /* the first that differ; -1, -1 if only `what` differs */
    double distance;         /* m, between the two positions there */
    double angle;            /* rad */
    double speed;            /* m/s, between the two velocities there; 0 if poses_only */
    int max_frame, max_body; /* where the distance is largest in the frames of both; -1, -1 if nowhere */
    double max_distance;     /* m */
    /* m^2: squared difference of positions, mean over the frames of both, the dynamic bodies that both have there, and
       both coordinates, as learned simulators state the error of a rollout (Sanchez-Gonzalez et al. 2020, section 4.4);
       NaN: no such body */
    double rollout_mse;
} TrajectoryDifference;

/* Compares all poses, and velocities if both have them, bit by bit in the frames of both; NaN: the body does not exist.
   Contacts and names do not count. */
void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *difference);

/* Largest distance (m) between the bodies of two trajectories in one frame, for bodies that exist in both. */
double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame);

/* Comparison of one body in one frame of two trajectories. */

/* True if the velocities of both are known; else only poses are compared. */
bool trajectory_both_move(const Trajectory *a, const Trajectory *b);

/* True if both have hashes of states. */
bool trajectory_both_hashed(const Trajectory *a, const Trajectory *b);

/* True if both state float64; else numbers are compared as float32. */
bool trajectory_both_exact(const Trajectory *a, const Trajectory *b);

/* What the two are compared by, and nothing else: "every bit of float64 poses". */
typedef struct ComparedText {
    char text[96];
} ComparedText;
ComparedText trajectory_compared(const Trajectory *a, const Trajectory *b);

/* States of a body in two frames, equal bit by bit. 0 and -0 differ: the runs have computed differently. A body that
   exists in neither is equal. NaN is equal to NaN. */
bool trajectory_same_states(const Trajectory *a, int of_a, const Trajectory *b, int of_b, int body);

/* Zeros unless the body exists in both; speed and spin are 0 if the velocities of one are unknown. */
typedef struct StateDifference {
    bool in_a, in_b;
    double distance; /* m, between the two positions */
    double angle;    /* rad */
    double speed;    /* m/s, between the two velocities */
    double spin;     /* rad/s */
} StateDifference;

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body);

/* True, with a description, if the worlds differ: number, sizes or kinds of bodies, or dt. A trace may lack each. */
bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size);

/* The two parts of it; of runs of different steps, frames can be compared. */
bool trajectory_different_bodies(const Trajectory *a, const Trajectory *b, char *what, size_t size);
bool trajectory_different_steps(const Trajectory *a, const Trajectory *b);

/* Modes of contacts (trajectory.h) in two runs of one world. A contact is known by its bodies and feature, and where a
   run does not have it, it is open. */

/* The first run of the converged method, if all are runs of its world; -1: none, or nothing to compare it with. */
int trajectory_reference(const Trajectory *const *runs, int count);

/* Whether a contact of the step of `a`, by its index, has the same mode in the step of `b`. */
bool trajectory_same_mode(const Trajectory *a, int step_a, int64_t contact, const Trajectory *b, int step_b);

/* Of the contacts that either run has. */
typedef struct ModeCount {
    int same, of;
} ModeCount;
ModeCount trajectory_same_modes(const Trajectory *a, int step_a, const Trajectory *b, int step_b);

/* Why two trajectories diverge: the first frame in which any bit differs, and the step that leads to it.

   Contacts of step k follow from the poses of frame k - 1. If all states of frame k - 1 are equal, so are the contacts,
   unless collision detection differs. A difference in frame k then comes from the solver, or from the warm start: the
   impulses of the previous step, which are recorded with its contacts. */

/* The contacts of one step of two runs, matched by bodies and feature. */
typedef struct ContactDifference {
    int count_a;                            /* in the first run */
    int only_a, only_b;                     /* that the other does not have */
    int moved;                              /* matched, with another point or normal */
    int changed;                            /* matched, with another impulse */
    bool reordered;                         /* all are matched, but recorded in another order */
    TrajectoryContact only;                 /* the first that exists in one run only, if any: */
    bool only_first_a;                      /* a, or b */
    TrajectoryContact largest_a, largest_b; /* with the largest difference of impulses, if any; the first of equals */
} ContactDifference;

/* The cause of the first difference in any bit. */
typedef enum PartCause {
    PART_NONE,      /* no state differs */
    PART_START,     /* frame 0 differs */
    PART_LAUNCH,    /* only bodies that did not exist before */
    PART_HIDDEN,    /* impulses of an earlier step differ, but no state: `step` */
    PART_CONTACTS,  /* equal states, different contacts: collision detection */
    PART_SOLVER,    /* equal states and contacts, different impulses */
    PART_ELSEWHERE, /* equal states, contacts and impulses */
    PART_UNKNOWN    /* equal states and contacts; impulses are unknown, or one of the runs does not have its contacts */
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
    PartedBody beyond;                 /* above the tolerance, or in one run only */
    int equal, within;                 /* frames: equal in every bit; else within the tolerance */
    bool no_contacts;                  /* those of one or both are unknown */
    bool no_impulses;                  /* those of one or both are unknown, and not compared */
    PartCause cause;                   /* of the first */
    int step;                          /* the first whose contacts differ; -1: none up to the first frame */
    ContactDifference contacts;        /* of that step */
    ContactDifference beyond_contacts; /* of the step that exceeds the tolerance, with that body */
} TrajectoryParting;

/* How far apart a body may be in two runs. */
typedef struct PoseTolerance {
    bool given;      /* or any bit counts */
    double distance; /* m, of its centre */
    double angle;    /* rad; whole turns do not count; INFINITY: any */
} PoseTolerance;

/* Without a tolerance, beyond is first. The two must be of the same world (trajectory_different_worlds). False with
   error set when memory is short. */
bool trajectory_part(const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                     TrajectoryParting *parting, Error *error);

/* What kind of difference it is, in words that begin with one of: "frames" (an offset), "a body", "a hash", "not
   finite", "x", "y", "angle" (mirrored, or in other units), "a mass", "whole turns", "what numbers do not show", "an
   order", "roundings", "a step", "motion". Empty if no state differs. */
typedef struct PartingKind {
    char text[160];
} PartingKind;
PartingKind trajectory_part_kind(const Trajectory *a, const Trajectory *b, const TrajectoryParting *parting);

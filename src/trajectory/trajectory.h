/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recorded run: pose and velocity of every body in every frame, and the contacts of every step. Frame 0 is the state
   before the first step, frame k the state after k steps. Self-contained: rendering it needs no scene file. SI units,
   radians, y up. */
#pragma once
#include "common/error.h"
#include "common/vec2.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TRAJECTORY_VERSION = 1, TRAJECTORY_NAME_SIZE = 128, TRAJECTORY_VERDICT_SIZE = 256 };

/* Readers accept files of at most 2 GiB, so no larger trajectory is made. */
#define TRAJECTORY_MAX_BYTES 2147483648.0

typedef struct TrajectoryContact {
    int32_t a, b;          /* body indices, a < b */
    uint32_t feature;      /* four edge bytes (collision/manifold.h) */
    Vec2 point, normal;    /* world; unit normal from a to b */
    float normal_impulse;  /* N s, accumulated over the step */
    float tangent_impulse; /* N s, along normal turned a quarter clockwise */
} TrajectoryContact;

typedef struct Trajectory {
    char scene[TRAJECTORY_NAME_SIZE];  /* name, without folder and ending */
    char method[TRAJECTORY_NAME_SIZE]; /* as on the command line: "engine", "pair-net:network=..." */
    uint64_t scene_hash;               /* of the scene's contents: equal physics, equal hash */
    int iterations;                    /* the scene's sweeps per step, unless the method sets its own; 0: unknown */
    float dt;                          /* s */
    int frames;                        /* T: steps + 1 */
    int bodies;                        /* N, static bodies and the bomb included */
    int bomb;                          /* index of the bomb, or -1 */
    Vec2 camera_center;                /* m; the view that the scene sets */
    Vec2 camera_size;                  /* m, width and height; 0, 0: chosen by the renderer */
    Vec2 *size;                        /* [N] full width and height, m */
    uint8_t *fixed;                    /* [N] 1: static */
    Vec2 *position;                    /* [T, N]; NaN while the body does not exist, as in the next three */
    float *angle;                      /* [T, N] */
    Vec2 *velocity;                    /* [T, N] m/s */
    float *angular_velocity;           /* [T, N] rad/s */
    bool no_velocities;                /* both are unknown: all NaN; files do not have them */
    bool no_contacts;                  /* contacts were not recorded: none are here, nor in files */
    int64_t *contact_start;      /* [T + 1]: contacts of step k are contact_start[k] .. [k+1]-1; step 0 has none */
    TrajectoryContact *contacts; /* [contact_start[T]] */
    char verdict
        [TRAJECTORY_VERDICT_SIZE];   /* how the run ended: "falls at 4.22 s (body 7, 0.53 m lower)"; empty: unknown */
    int verdict_frame, verdict_body; /* where that was decided; -1: nowhere, or unknown */
    size_t contact_capacity;
    int last_step; /* while contacts are added: contact_start is valid up to the end of this step */
} Trajectory;

/* All poses NaN, no contacts, contact_start all 0. NULL with error set when memory is short or the trajectory exceeds
   the 2 GiB limit of files; trajectory_add_contact() fails for the same reasons. */
Trajectory *trajectory_create(int frames, int bodies, Error *error);
void trajectory_destroy(Trajectory *trajectory);

/* Sets the verdict; longer words are cut. It is no part of hashes and comparisons. */
void trajectory_judge(Trajectory *trajectory, const char *words, int frame, int body);

/* True if the body exists in this frame. */
bool trajectory_has(const Trajectory *trajectory, int frame, int body);

/* Bytes of all arrays in a file. */
double trajectory_bytes(const Trajectory *trajectory);

/* Appends a contact of step `frame` (from 1); frames in rising order. */
bool trajectory_add_contact(Trajectory *trajectory, int frame, const TrajectoryContact *contact, Error *error);

/* Appends `count` contacts and returns the first, to be filled. NULL with error set. */
TrajectoryContact *trajectory_add_contacts(Trajectory *trajectory, int frame, int count, Error *error);

/* Removes all contacts. Contacts of frame 0 can be added then: the trajectory is a part of a longer run. */
void trajectory_restart_contacts(Trajectory *trajectory);

/* Call after the last contact: fills the rest of contact_start. */
void trajectory_end_contacts(Trajectory *trajectory);

/* The first step in which the bomb touches a dynamic body; -1: none. */
int trajectory_impact(const Trajectory *trajectory);

/* FNV-1a 64 over the little-endian bytes of x, y, angle, vx, vy, omega of each dynamic body that exists, by rising
   index: the hash of the reference trajectories. */
uint64_t trajectory_frame_hash(const Trajectory *trajectory, int frame);

/* XXH3 over all that a picture can show: bodies, view, states and contacts of all frames; names do not count. */
uint64_t trajectory_hash(const Trajectory *trajectory);

/* A copy with every step'th frame from frame 0 on, dt multiplied by step, and the contacts of the steps that end in
   these frames; its verdict is in the first of them from the verdict's frame on. The caller destroys it. step >= 1. */
Trajectory *trajectory_every(const Trajectory *trajectory, int step, Error *error);

/* .npz: version, scene, method, scene_hash, iterations, dt, bomb, camera[2,2], size[N,2], fixed[N], position[T,N,2],
   angle[T,N], velocity[T,N,2], angular_velocity[T,N], contact_start[T+1], contact_bodies[C,2],
   contact_feature[C], contact_point[C,2], contact_normal[C,2], contact_impulse[C,2], verdict, verdict_frame, verdict_body.
   Without the velocities, the contacts or the verdict where they are unknown. */
bool trajectory_write(const Trajectory *trajectory, const char *path, Error *error);

/* Of other programs' files only position, angle, size and dt are needed; README.md states what the absence of the others
   means. Other types of numbers are converted (npz_convert).
   NULL with error set (ERROR_INPUT, naming the file) for a file that is damaged, of another version or inconsistent:
   an array whose name looks like a mistyped one,
   shapes that do not match, contacts out of range or of bodies that did not exist before the step, infinite poses, a
   body that reappears after it was removed, a static body that is removed, dt or a size not positive, a verdict on a frame
   or body that the run does not have. */
Trajectory *trajectory_read(const char *path, Error *error);

/* False with error set, naming `path`, if a trajectory from outside is inconsistent (trajectory_read). */
bool trajectory_check(const Trajectory *trajectory, const char *path, Error *error);

/* Sets `fixed` of a run that does not state it: bodies that are there from frame 0 to the end in one pose are static; in a
   run of one frame, none. */
void trajectory_guess_fixed(Trajectory *trajectory);

/* `frame,body,x,y,angle,vx,vy,omega`, numbers as %.9g (float32 round-trips), existing dynamic bodies only. */
bool trajectory_write_csv(const Trajectory *trajectory, const char *path, Error *error);

/* `frame,hash` for every frame, hashes as 16 hex digits. */
bool trajectory_write_hashes(const Trajectory *trajectory, const char *path, Error *error);

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
} TrajectoryDifference;

/* Compares all poses, and velocities if both have them, bit by bit in the frames of both; NaN: the body does not exist. Contacts and names
   do not count. */
void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *difference);

/* Largest distance (m) between the bodies of two trajectories in one frame, for bodies that exist in both. */
double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame);

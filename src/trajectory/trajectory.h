/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run, recorded: the pose and velocity of every body in every frame, and the contacts of every step. Frame 0
   is the state before the first step, frame k the state after k steps. Self-contained: a picture of it needs no
   scene file. SI units, radians, y up. */
#pragma once
#include "common/error.h"
#include "common/vec2.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TRAJECTORY_VERSION = 1, TRAJECTORY_NAME_SIZE = 128 };

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
    float dt;                          /* s */
    int frames;                        /* T: steps + 1 */
    int bodies;                        /* N, static bodies and the bomb included */
    int bomb;                          /* index of the bomb, or -1 */
    Vec2 camera_center;                /* m; what the scene asks to see */
    Vec2 camera_size;                  /* m, width and height; 0, 0 where the scene leaves it to the renderer */
    Vec2 *size;                        /* [N] full width and height, m */
    uint8_t *fixed;                    /* [N] 1: static */
    Vec2 *position;                    /* [T, N]; NaN while a body is not there, as are the next three */
    float *angle;                      /* [T, N] */
    Vec2 *velocity;                    /* [T, N] m/s */
    float *angular_velocity;           /* [T, N] rad/s */
    int64_t *contact_start;      /* [T + 1]: contacts of step k are contact_start[k] .. [k+1]-1; step 0 has none */
    TrajectoryContact *contacts; /* [contact_start[T]] */
    size_t contact_capacity;
    int last_step; /* while contacts are added: contact_start is right up to the end of this step */
} Trajectory;

/* All poses NaN, no contacts, contact_start all 0. NULL with error set when memory is short or the whole would be
   larger than the 2 GiB that a file may hold; trajectory_add_contact fails there, too. */
Trajectory *trajectory_create(int frames, int bodies, Error *error);
void trajectory_destroy(Trajectory *trajectory);

/* True where the body is there in this frame. */
bool trajectory_has(const Trajectory *trajectory, int frame, int body);

/* Appends a contact of step `frame` (from 1); frames in rising order. */
bool trajectory_add_contact(Trajectory *trajectory, int frame, const TrajectoryContact *contact, Error *error);

/* To be called after the last contact: fills the rest of contact_start. */
void trajectory_end_contacts(Trajectory *trajectory);

/* The first step in which the bomb touches a body that can move; -1: there is none. */
int trajectory_impact(const Trajectory *trajectory);

/* FNV-1a 64 over the little-endian bytes of x, y, angle, vx, vy, omega of each dynamic body that is there, by
   rising index: the definition of the reference trajectories. */
uint64_t trajectory_frame_hash(const Trajectory *trajectory, int frame);

/* Every step'th frame from frame 0 on, dt as much longer, with the contacts of the steps that led to these frames. The
   caller destroys it. step >= 1. */
Trajectory *trajectory_every(const Trajectory *trajectory, int step, Error *error);

/* .npz: version, scene, method, scene_hash, dt, bomb, camera[2,2], size[N,2], fixed[N], position[T,N,2],
   angle[T,N], velocity[T,N,2], angular_velocity[T,N], contact_start[T+1], contact_bodies[C,2],
   contact_feature[C], contact_point[C,2], contact_normal[C,2], contact_impulse[C,2]. */
bool trajectory_write(const Trajectory *trajectory, const char *path, Error *error);

/* Refuses (ERROR_INPUT, naming the file) what is damaged, of another version, or inconsistent: shapes that do
   not fit each other, contacts out of range or of bodies that were not there before the step, a body that is there
   with an infinite pose or comes back after it has gone, a static one that goes, dt or a size not positive. */
Trajectory *trajectory_read(const char *path, Error *error);

/* `frame,body,x,y,angle,vx,vy,omega`, numbers as %.9g (float32 round-trips), dynamic bodies that are there only. */
bool trajectory_write_csv(const Trajectory *trajectory, const char *path, Error *error);

/* `frame,hash` for every frame, hashes as 16 hex digits. */
bool trajectory_write_hashes(const Trajectory *trajectory, const char *path, Error *error);

/* Where two trajectories part. */
typedef struct TrajectoryDifference {
    bool equal;      /* every bit of every pose and velocity */
    char what[256];  /* a difference that no distance tells: "bodies: 12 and 67", "frames: 301 and 481", or a body
                           that only one of the two has in that frame; else empty */
    int frame, body; /* the first that differ (-1, -1 where `what` says it all) */
    double distance; /* m, between the two positions there */
    double angle;    /* rad */
    double speed;    /* m/s, between the two velocities there */
    int max_frame, max_body; /* where the two are farthest apart over the frames of both; -1, -1 if nowhere */
    double max_distance;     /* m */
} TrajectoryDifference;

/* Compares all poses and velocities bit by bit over the frames of both, NaN as not there. Contacts and names do
   not count. */
void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *difference);

/* Largest distance (m) between the bodies of two trajectories in one frame, over the bodies that both have. */
double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recorded run: pose and velocity of every body in every frame, and the contacts of every step. Frame 0 is the state
   before the first step, frame k the state after k steps. Self-contained: rendering it needs no scene file. SI units,
   radians, y up.

     Trajectory *run = trajectory_read("engine.npz", &error);
     for (int frame = 0; run != NULL && frame < run->frames; frame++)
         printf("%g\n", (double)run->position[trajectory_at(run, frame, 1)].y);
     trajectory_destroy(run); */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TRAJECTORY_VERSION = 1, TRAJECTORY_NAME_SIZE = 128, TRAJECTORY_VERDICT_SIZE = 256 };

/* Readers accept files of at most 2 GiB, so no larger trajectory is made. */
#define TRAJECTORY_MAX_BYTES 2147483648.0

typedef struct TrajectoryContact {
    int32_t a, b;          /* body indices, a < b */
    uint32_t feature;      /* four edge bytes (engine/engine.h) */
    Vec2 point, normal;    /* world; unit normal from a to b */
    float normal_impulse;  /* N s, accumulated over the step */
    float tangent_impulse; /* N s, along normal turned a quarter clockwise */
} TrajectoryContact;

typedef struct Trajectory {
    char scene[TRAJECTORY_NAME_SIZE];   /* name, without folder and ending */
    char method[TRAJECTORY_NAME_SIZE];  /* as on the command line: "engine", "pair-net:network=..." */
    char program[TRAJECTORY_NAME_SIZE]; /* of the method exec: name and version that the program states; else empty */
    uint64_t scene_hash;                /* of the scene's contents: equal physics, equal hash */
    uint64_t network_hash;              /* XXH3 of the file of the method's network; 0: none, or unknown */
    int iterations;                     /* the scene's sweeps per step, unless the method sets its own; 0: unknown */
    float dt;                           /* s */
    int frames;                         /* T: steps + 1 */
    int bodies;                         /* N, static bodies and the bomb included */
    int bomb;                           /* index of the bomb, or -1 */
    Vec2 camera_center;                 /* m; the view that the scene sets */
    Vec2 camera_size;                   /* m, width and height; 0, 0: chosen by the renderer */
    Vec2 *size;                         /* [N] full width and height, m */
    float *mass;                        /* [N] kg; NaN, in all or none: unknown; of static ones: any */
    BodyName *name;                     /* [N]; NULL: no body has a name */
    uint8_t *fixed;                     /* [N] 1: static */
    bool fixed_guessed;                 /* nothing states `fixed`: files do not have it (trajectory_guess_fixed()) */
    Vec2 *position;                     /* [T, N]; NaN while the body does not exist, as in the next three */
    float *angle;                       /* [T, N] */
    Vec2 *velocity;                     /* [T, N] m/s */
    float *angular_velocity;            /* [T, N] rad/s */
    bool no_velocities;                 /* both are unknown: all NaN; files do not have them */
    double *exact; /* these four in float64, of which they are the roundings: [T, N, 2], [T, N], [T, N, 2], [T, N], one
                      behind the other; NULL: the run states float32, as twinbox's own do */
    /* Of a trace (run_files.h) only, else NULL: */
    uint8_t *there;              /* [T, N] 1: the file states the body in this frame, if only as NaN */
    uint64_t *hash;              /* [T, N] of each state, as the other program made it; NULL: none */
    bool no_poses;               /* only hashes are known */
    bool no_contacts;            /* contacts were not recorded: none are here, nor in files */
    bool no_impulses;            /* contacts were found later (trajectory_find_contacts): impulses are unknown, 0 */
    int64_t *contact_start;      /* [T + 1]: contacts of step k are contact_start[k] .. [k+1]-1; step 0 has none */
    TrajectoryContact *contacts; /* [contact_start[T]] */
    char verdict
        [TRAJECTORY_VERDICT_SIZE];   /* how the run ended: "falls at 4.22 s (body 7, 0.53 m lower)"; empty: unknown */
    int verdict_frame, verdict_body; /* where that was decided; -1: nowhere, or unknown */
    size_t contact_capacity;
    int last_step; /* while contacts are added: contact_start is valid up to the end of this step */
} Trajectory;

/* .npz: version, scene, method, scene_hash, iterations, dt, bomb, camera[2,2], size[N,2], fixed[N], mass[N],
   body_name[N,32], position[T,N,2], angle[T,N], velocity[T,N,2], angular_velocity[T,N] (these four in float64 if the
   run has it), contact_start[T+1], contact_bodies[C,2], contact_feature[C], contact_point[C,2], contact_normal[C,2],
   contact_impulse[C,2], program, network_hash, verdict, verdict_frame, verdict_body. Without the masses, the names, the
   velocities, the contacts, the program, the network_hash or the verdict where they are unknown. */
bool trajectory_write(const Trajectory *trajectory, const char *path, Error *error);

/* Of other programs' files only position, angle, size and dt are needed; README.md states what the absence of the
   others means. Other types of numbers are converted (npz_convert).
   NULL with error set (ERROR_INPUT, naming the file) for a file that is damaged, of another version or inconsistent:
   an array whose name looks like a mistyped one,
   shapes that do not match, contacts out of range or of bodies that did not exist before the step, infinite poses, a
   name that cannot be shown, a body that reappears after it was removed, a static body that is removed, dt or a size
   not positive, a verdict on a frame or body that the run does not have. */
Trajectory *trajectory_read(const char *path, Error *error);

/* The index of a body's state in a frame: of position, angle, velocity, angular_velocity. */
static inline size_t trajectory_at(const Trajectory *trajectory, int64_t frame, int body) {
    return (size_t)frame * (size_t)trajectory->bodies + (size_t)body;
}

/* Columns of a state: x, y, angle, vx, vy, omega. */
enum { STATE_COLUMNS = 6 };

/* Where `exact` has a column of the state with index i. */
static inline size_t trajectory_exact_at(const Trajectory *trajectory, size_t i, int column) {
    const size_t states = (size_t)trajectory->frames * (size_t)trajectory->bodies;
    const size_t vector = column < 2 ? 0 : column == 2 ? 2 : column < 5 ? 3 : 5;
    return vector * states + (column == 2 || column == 5 ? i : 2 * i + (size_t)(column % 3));
}

/* A number of the state with index i, as precise as the run states it. */
double trajectory_number(const Trajectory *trajectory, size_t i, int column);

/* True if the body exists in this frame. */
static inline bool trajectory_has(const Trajectory *t, int frame, int body) {
    Vec2 position = t->position[trajectory_at(t, frame, body)];
    return isfinite(position.x) && isfinite(position.y);
}

/* True if the run states the body in this frame: of a trace, also as NaN; false beyond its frames and bodies. */
static inline bool trajectory_there(const Trajectory *t, int frame, int body) {
    if (frame >= t->frames || body >= t->bodies) return false;
    return t->there != NULL ? t->there[trajectory_at(t, frame, body)] != 0 : trajectory_has(t, frame, body);
}

/* The step whose contacts a picture of a frame shows: they result from its poses; in the last frame, the last step. */
static inline int trajectory_contact_step(const Trajectory *trajectory, int frame) {
    return frame + 1 < trajectory->frames ? frame + 1 : frame;
}

/* The first step in which the bomb touches a dynamic body; -1: none. */
int trajectory_impact(const Trajectory *trajectory);

/* What a contact does in a step: it does not push; or it pushes, and its bodies do not slide along it; or they slide.
   Its normal impulse and the velocities after the step decide, alike for every method. Runs have no friction, and none
   is needed: what slides is at the cone's bound, and what does not slide sticks, also at the bound. */
typedef enum ContactMode { CONTACT_OPEN, CONTACT_STICKS, CONTACT_SLIPS, CONTACT_MODES } ContactMode;

/* m/s: slower is creep, which methods leave that do not converge. */
#define CONTACT_SLIDING 0.01

/* The mode of a contact of the step, by its index in `contacts`. */
ContactMode trajectory_mode(const Trajectory *trajectory, int step, int64_t contact);

/* FNV-1a 64 over the little-endian bytes of x, y, angle, vx, vy, omega of each dynamic body that exists, by rising
   index: the hash of the reference trajectories. */
uint64_t trajectory_frame_hash(const Trajectory *trajectory, int frame);

/* XXH3 over all that a picture can show: bodies and their names, view, states and contacts of all frames; the names of
   scene and method do not count. */
uint64_t trajectory_hash(const Trajectory *trajectory);

/* Names of runs from files, and the file names of runs that are stored beside the pictures of them. */

enum { TRAJECTORY_FILE_NAME_SIZE = 2 * TRAJECTORY_NAME_SIZE + 24 };

/* The file name of run `index` of these: SCENE-METHOD.npz, with the method_name() and '_' for what does not belong in a
   file name. A second run of that name gets SCENE-METHOD-2.npz, and so on. */
void trajectory_file_name(const Trajectory *const *runs, int index, char name[TRAJECTORY_FILE_NAME_SIZE]);

/* What scene and method are called in a run that does not state it: the file's name without folder and ending. Bytes
   that a name must not have become '_'. */
void trajectory_name_from_path(const char *path, char name[TRAJECTORY_NAME_SIZE]);

/* Making a trajectory. */

/* All poses NaN, no contacts, contact_start all 0. NULL with error set when memory is short or the trajectory exceeds
   the 2 GiB limit of files; trajectory_add_contacts() fails for the same reasons. */
Trajectory *trajectory_create(int frames, int bodies, Error *error);
void trajectory_destroy(Trajectory *trajectory);

/* Sets the verdict; longer words are cut. It is no part of hashes and comparisons. */
void trajectory_judge(Trajectory *trajectory, const char *words, int frame, int body);

/* Whether the masses of all bodies that are not static are known. */
bool trajectory_has_masses(const Trajectory *trajectory);

/* Call after the last contact: fills the rest of contact_start. */
void trajectory_end_contacts(Trajectory *trajectory);

/* Replaces the contacts by those that collision detection finds between the poses, without impulses (no_impulses).
   False with error set. */
bool trajectory_find_contacts(Trajectory *trajectory, Error *error);

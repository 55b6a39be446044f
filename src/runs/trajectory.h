/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recorded run: pose and velocity of every body in every frame, and the contacts of every step. Frame 0 is the state
   before the first step, frame k the state after k steps. Self-contained: rendering it needs no scene file. SI units,
   radians, y up. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

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
    Vec2 *position;                     /* [T, N]; NaN while the body does not exist, as in the next three */
    float *angle;                       /* [T, N] */
    Vec2 *velocity;                     /* [T, N] m/s */
    float *angular_velocity;            /* [T, N] rad/s */
    bool no_velocities;                 /* both are unknown: all NaN; files do not have them */
    bool no_contacts;                   /* contacts were not recorded: none are here, nor in files */
    bool no_impulses;            /* contacts were found later (trajectory_find_contacts): impulses are unknown, 0 */
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

/* The index of a body's state in a frame: of position, angle, velocity, angular_velocity. */
static inline size_t trajectory_at(const Trajectory *trajectory, int64_t frame, int body) {
    return (size_t)frame * (size_t)trajectory->bodies + (size_t)body;
}

/* True if the body exists in this frame. */
bool trajectory_has(const Trajectory *trajectory, int frame, int body);

/* Whether the masses of all bodies that are not static are known. */
bool trajectory_has_masses(const Trajectory *trajectory);

/* Makes room for names, all empty. False with error set. */
bool trajectory_make_names(Trajectory *trajectory, Error *error);

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

/* Replaces the contacts by those that collision detection finds between the poses, without impulses (no_impulses).
   False with error set. */
bool trajectory_find_contacts(Trajectory *trajectory, Error *error);

/* The first step in which the bomb touches a dynamic body; -1: none. */
int trajectory_impact(const Trajectory *trajectory);

/* FNV-1a 64 over the little-endian bytes of x, y, angle, vx, vy, omega of each dynamic body that exists, by rising
   index: the hash of the reference trajectories. */
uint64_t trajectory_frame_hash(const Trajectory *trajectory, int frame);

/* XXH3 over all that a picture can show: bodies and their names, view, states and contacts of all frames; the names of
   scene and method do not count. */
uint64_t trajectory_hash(const Trajectory *trajectory);

/* A copy with every step'th frame from frame 0 on, dt multiplied by step, and the contacts of the steps that end in
   these frames; its verdict is in the first of them from the verdict's frame on. The caller destroys it. step >= 1. */
Trajectory *trajectory_every(const Trajectory *trajectory, int step, Error *error);

/* .npz: version, scene, method, scene_hash, iterations, dt, bomb, camera[2,2], size[N,2], fixed[N], mass[N],
   body_name[N,32], position[T,N,2], angle[T,N], velocity[T,N,2], angular_velocity[T,N], contact_start[T+1],
   contact_bodies[C,2], contact_feature[C], contact_point[C,2], contact_normal[C,2], contact_impulse[C,2], program,
   verdict, verdict_frame, verdict_body. Without the masses, the names, the velocities, the contacts, the program or the
   verdict where they are unknown. */
bool trajectory_write(const Trajectory *trajectory, const char *path, Error *error);

/* Of other programs' files only position, angle, size and dt are needed; README.md states what the absence of the
   others means. Other types of numbers are converted (npz_convert).
   NULL with error set (ERROR_INPUT, naming the file) for a file that is damaged, of another version or inconsistent:
   an array whose name looks like a mistyped one,
   shapes that do not match, contacts out of range or of bodies that did not exist before the step, infinite poses, a
   name that cannot be shown, a body that reappears after it was removed, a static body that is removed, dt or a size
   not positive, a verdict on a frame or body that the run does not have. */
Trajectory *trajectory_read(const char *path, Error *error);

/* False with error set, naming `path`, if a trajectory from outside is inconsistent (trajectory_read). */
bool trajectory_check(const Trajectory *trajectory, const char *path, Error *error);

/* Sets `fixed` of a run that does not state it: bodies that are there from frame 0 to the end in one pose are static;
   in a run of one frame, none. */
void trajectory_guess_fixed(Trajectory *trajectory);

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

/* Runs for other programs. */

/* One object, without what is unknown: README.md lists its keys. */
bool json_run_write(const Trajectory *run, const char *path, Error *error);

/* Names of runs from files, and the file names of runs that are stored beside the pictures of them. */

enum { TRAJECTORY_FILE_NAME_SIZE = 2 * TRAJECTORY_NAME_SIZE + 24 };

/* The file name of run `index` of these: SCENE-METHOD.npz, with the method_name() and '_' for what does not belong in a
   file name. A second run of that name gets SCENE-METHOD-2.npz, and so on. */
void trajectory_file_name(const Trajectory *const *runs, int index, char name[TRAJECTORY_FILE_NAME_SIZE]);

/* What scene and method are called in a run that does not state it: the file's name without folder and ending. Bytes
   that a name must not have become '_'. */
void trajectory_name_from_path(const char *path, char name[TRAJECTORY_NAME_SIZE]);

/* Comparison of one body in one frame of two trajectories. */

/* True if the velocities of both are known; else only poses are compared. */
bool trajectory_both_move(const Trajectory *a, const Trajectory *b);

/* Equal bit by bit. 0 and -0 differ: the runs have computed differently. A body that exists in neither is equal. */
bool trajectory_same_state(const Trajectory *a, const Trajectory *b, int frame, int body);

/* Zeros unless the body exists in both; speed and spin are 0 if the velocities of one are unknown. */
typedef struct StateDifference {
    bool in_a, in_b;
    double distance; /* m, between the two positions */
    double angle;    /* rad */
    double speed;    /* m/s, between the two velocities */
    double spin;     /* rad/s */
} StateDifference;

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body);

/* True, with a description, if the worlds differ: number, sizes or kinds of bodies, or dt. */
bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size);

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
    TrajectoryContact only;                 /* the first that exists in one run only, if any: */
    bool only_first_a;                      /* a, or b */
    TrajectoryContact largest_a, largest_b; /* with the largest difference of impulses, if any; the first of equals */
} ContactDifference;

/* Compares the contacts of a body (-1: all), in the order of bodies a, b and feature. False with error set when memory
   is short. */
bool contact_difference(const Trajectory *a, const Trajectory *b, int step, int body, ContactDifference *difference,
                        Error *error);

/* The cause of the first difference in any bit. */
typedef enum PartCause {
    PART_NONE,      /* no state differs */
    PART_START,     /* frame 0 differs */
    PART_LAUNCH,    /* only bodies that did not exist before */
    PART_HIDDEN,    /* contacts of an earlier step differ, but no state: `step` */
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

/* Runs as CSV: comments with what does not change, then a row for each body in each frame. README.md has the format. */

typedef struct CsvRunOptions {
    const char *name;  /* scene and method where the file does not state them */
    const char *sizes; /* CSV of body,width,height and perhaps static; NULL: the file's comments have the sizes */
    float dt;          /* s; 0: the file states it */
    bool degrees;      /* angles and angular velocities of the file are in degrees */
} CsvRunOptions;

/* What the reader assumed: a line each. */
enum { CSV_RUN_NOTES_MAX = 16, CSV_RUN_NOTE_SIZE = 200 };
typedef struct CsvRunNotes {
    int count;
    char lines[CSV_RUN_NOTES_MAX][CSV_RUN_NOTE_SIZE];
} CsvRunNotes;

/* path "-": standard input.
   NULL with error set ("path:line:column: error: ..."): a frame without rows, a body that is missing in a frame between
   two of its own, two rows of a body in a frame, bodies without a size or without rows, anything that is not a finite
   number, times that are not equidistant, or a file above 1 GiB. */
Trajectory *csv_run_read(const char *path, const CsvRunOptions *options, CsvRunNotes *notes, Error *error);

/* Writes what csv_run_read() gives back bit by bit: all but contacts and verdict. */
bool csv_run_write(const Trajectory *run, const char *path, Error *error);

/* Writes a run while it is made, in bounded memory. A part of a run is a Trajectory whose frame 0 is the frame after
   the last one of the part before, with the contacts of the steps that end in its frames. The parts do not show in the
   file. */

typedef struct TrajectoryStream TrajectoryStream;

typedef enum TrajectoryFormat {
    TRAJECTORY_NPZ,
    TRAJECTORY_CSV, /* frame,body,x,y,angle,vx,vy,omega; %.9g keeps every float32; the dynamic bodies that are there */
    TRAJECTORY_HASHES /* frame,hash: 16 hexadecimal digits */
} TrajectoryFormat;

/* A stream for a run of `frames` frames; names, sizes and all else that does not change are those of `head`, which may
   be its first part and must outlive the stream. Program and verdict are read when it is finished. NULL with error set
   if no file can be written at `path`. */
TrajectoryStream *trajectory_stream_create(const Trajectory *head, int frames, TrajectoryFormat format,
                                           const char *path, Error *error);
bool trajectory_stream_add(TrajectoryStream *stream, const Trajectory *part, Error *error);

/* Writes the file, atomically, when all frames have been added. */
bool trajectory_stream_finish(TrajectoryStream *stream, Error *error);

/* Discards what trajectory_stream_finish() has not written. */
void trajectory_stream_destroy(TrajectoryStream *stream);

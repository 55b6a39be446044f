/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs: a scene stepped with a method and recorded; checks of launches; problem files; growth of distances. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/contact_set.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdbool.h>

/* A run in progress, step by step. */

typedef struct Simulation {
    const Scene *scene;
    World *world;
    Stepper *stepper;
} Simulation;

/* The world before the first step. The scene outlives the run. On failure there is nothing to end. ERROR_INPUT also if
   the bomb would start inside a body. */
bool simulation_begin(Simulation *run, const Scene *scene, const Method *method, Error *error);

/* Step `frame`: 1, 2, ... in order. */
bool simulation_step(Simulation *run, int frame, Error *error);
void simulation_end(Simulation *run);

/* One step of a run. Then adds the bomb or removes the last body, if the scene does so after this step. On failure the
   error names scene and step. */
bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* Runs a scene with a method and records the trajectory. */

/* Called with the world after every step; frame: number of the step, 1 .. frames. */
typedef struct StepObserver {
    bool (*observe)(void *context, int frame, const World *world, Error *error);
    void *context;
} StepObserver;

typedef struct Recorder Recorder; /* below */

/* Who follows a run, in this order; zero-initialise what is left out. */
typedef struct RunWatch {
    Recorder *recorder;            /* of this scene and method */
    const StepObserver *observers; /* [observer_count] */
    int observer_count;
    Fallbacks *fallbacks; /* those of all steps are added */
    const Progress *progress;
} RunWatch;

/* Runs the scene. False with error set if the method cannot be created, a body's state becomes NaN or infinite, an
   observer fails, or progress requests a stop. */
bool simulate_watched(const Scene *scene, const Method *method, const RunWatch *watch, Error *error);

/* The same with one observer. */
bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error);

/* Runs the scene and records it in memory (a Recorder also records to files). NULL with error set for the same
   reasons, or if memory is short. */
Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error);

/* Writes the scene as JSON, with patterns and parameters written out: src/runs/README.md lists the keys. */
bool scene_flat_write(const Scene *scene, const char *path, Error *error);

/* What reading a scene does not check: its launches, its networks, and its parameters at their ends. */

/* The launch of a single run and those of training and scoring: none puts the bomb inside a body. */
bool scene_check_launches(const Scene *scene, Error *error);

/* Reads each network that the scene names and runs one step with it, with the bomb and without. */
bool scene_check_networks(const Scene *scene, Error *error);

/* Reads the scene at `path` with each parameter at either end, the others as in the file, and checks the launches. The
   error ends with the parameter: "(with height = 20, an end of its range)". */
bool scene_check_ends(const char *path, const Scene *scene, Error *error);

/* A trajectory of a scene and a method in memory, with room for this many frames; none is filled. NULL, error set. */
Trajectory *trajectory_of_scene(const Scene *scene, const Method *method, int frames, Error *error);

/* Fills a frame from the world; the contacts are those of the step that led to it, in rising order of frames. */
void trajectory_set_bodies(Trajectory *trajectory, int frame, const World *world);
bool trajectory_set_contacts(Trajectory *trajectory, int frame, const World *world, Error *error);

/* Contacts between boxes in given poses, as the engine's collision detection finds them: for runs that do not state
   theirs. Zero-initialise; free with contact_finder_free(). */
typedef struct ContactFinder {
    SortAndSweep broad_phase;
    PairList pairs;
    Box *boxes;
    Bounds *bounds;
    bool *fixed;
    size_t box_capacity, bound_capacity, fixed_capacity;
    ContactSet set; /* positions, normals, separations and feature ids of the last search */
} ContactFinder;

void contact_finder_free(ContactFinder *finder);

/* Boxes that are apart by less than 2 `skin` (m) touch, too: separation > 0. ERROR_INPUT: too many pairs. */
bool contact_finder_find(ContactFinder *finder, const Body *bodies, int count, float skin, Error *error);

/* Records a run: into a trajectory in memory, or into files while the run is made, in bounded memory. Files are written
   by a second thread. */

/* The limit of bodies times frames of a trajectory: 24 bytes each, 1.2 GB. */
enum { SIMULATE_MAX_STATES = 50000000, RECORDER_OUTPUTS_MAX = 2 };

typedef struct RecorderOutput {
    const char *path;
    TrajectoryFormat format;
} RecorderOutput;

/* Records all frames in memory. Scene and method must last as long as the recorder. NULL with error set if the run is
   too long or memory is short. */
Recorder *recorder_create(const Scene *scene, const Method *method, Error *error);

/* Records to files (none is allowed). no_contacts leaves them out. NULL with error set also if a file cannot be
   written. */
Recorder *recorder_create_to(const Scene *scene, const Method *method, const RecorderOutput *outputs, int count,
                             bool no_contacts, Error *error);

/* Discards the files that recorder_finish() has not written. */
void recorder_destroy(Recorder *recorder);

/* Records a frame; 0: before the first step. Frames in rising order, without gaps. RunWatch does it. */
bool recorder_record(Recorder *recorder, int frame, const World *world, Error *error);

/* After the run, before recorder_finish() or recorder_take(): what its program states (method_program), and the verdict
   on it (trajectory_judge). */
void recorder_name_program(Recorder *recorder, const Method *method);
void recorder_judge(Recorder *recorder, const char *words, int frame, int body);

/* After the run: the files are written. */
bool recorder_finish(Recorder *recorder, Error *error);

/* After the run: the trajectory of a recorder in memory, which the caller destroys. */
Trajectory *recorder_take(Recorder *recorder);

/* Bodies of the run, and after it the hash of its last frame (trajectory_frame_hash). */
int recorder_bodies(const Recorder *recorder);
uint64_t recorder_state_hash(const Recorder *recorder);

/* Refuses bombs that would start inside a body. */

/* Checks the launches of a scene with a bomb: none starts inside a body by more than SCENE_OVERLAP when it is added.
   Bodies are then where the engine has them: runs the scene once, without the bomb, up to the last launch's frame. A
   scene that allows overlaps needs no run. ERROR_INPUT names the launch, the body and the x that are free. */
bool launches_check(const Scene *scene, const Launch *launches, int count, Error *error);

/* True if the scene's bomb, added to this world now, would start inside none of its bodies. */
bool launch_is_free(const Scene *scene, const World *world);

/* The first step in which the bomb of this launch touches a box that can move, as the method has it; 0 if it does not,
   or if the method fails before (MethodFailure). */
bool launch_find_touch(const Scene *launched, const char *method, int *touch, Error *error);

/* Checks that the bomb strikes a box that can move, by the engine, in one launch at least of those for training: what
   learns from impacts needs one. A scene without a bomb passes. */
bool scene_check_strike(const Scene *scene, Error *error);

/* The ERROR_INPUT of launches that all miss. */
bool launches_refuse_misses(const Scene *scene, const Launch *launches, int count, Error *error);

/* Launches of the scene's family, spread evenly, that touch no box that can move, by the engine. */

enum { LAUNCH_TRIES = 41 };

typedef struct LaunchMisses {
    int tried, missed; /* fewer than LAUNCH_TRIES in large scenes, down to 0; without a family 1 */
    OverlapSpan spans[LAUNCH_TRIES / 2 + 1]; /* [span_count] of x, rising: launches tried in them miss, one and all */
    int span_count;
} LaunchMisses;

/* The scene must have a bomb. */
bool launches_find_misses(const Scene *scene, LaunchMisses *misses, Error *error);

/* The file of one contact problem: .npz with the members of ContactProblem as arrays: kind, version, scene, frame, dt,
   fall (0 in a file without it), bomb; per body position[N,2], angle[N], size[N,2], inv_mass[N], inv_inertia[N],
   velocity[N,2], angular_velocity[N]; per contact contact_bodies[C,2], contact_feature[C], contact_position[C,2],
   contact_normal[C,2], contact_arm_a[C,2], contact_arm_b[C,2], contact_separation[C], contact_mass[C,2],
   contact_friction[C], contact_bias[C], contact_warm[C,2]. Arrays with two columns hold x, y or normal, tangent. */

enum { PROBLEM_VERSION = 1, PROBLEM_NAME_SIZE = 128, PROBLEM_MAX_BODIES = 100000, PROBLEM_MAX_CONTACTS = 1000000 };

typedef struct StoredProblem {
    char scene[PROBLEM_NAME_SIZE]; /* the scene that it was recorded from */
    int frame;                     /* number of the step; the first is 1 */
    ContactProblem problem;        /* its arrays are the two below */
    ProblemBody *bodies;
    ContactPoint *contacts;
} StoredProblem;

bool problem_write(const ContactProblem *problem, const char *scene, int frame, const char *path, Error *error);

/* NULL with error set (ERROR_INPUT, naming the file) for a file that is damaged, of another version or not a contact
   problem: inconsistent shapes, NaN or infinite numbers, sizes, masses or dt not positive, pairs that are out of range,
   not sorted or of two static bodies, normals that are not of unit length. */
StoredProblem *problem_read(const char *path, Error *error);
void problem_destroy(StoredProblem *stored);

/* How fast two runs diverge: the slope of the logarithm of their distance over time. Where the distance grows by a
   constant factor per frame, this is the largest Lyapunov exponent. */

/* Above this distance, a tenth of a box, growth is saturated and frames do not count. */
#define GROWTH_SATURATED 0.1 /* m */

enum { GROWTH_MIN_FRAMES = 10 };

/* Rates within this factor count as equal: the choice of frames changes them by as much. */
#define GROWTH_ALIKE 2.0

typedef struct Growth {
    int first, last; /* frames of the fit, from the first distance above 0 on; -1, -1: none */
    int count;       /* of distances above 0 in them; below GROWTH_MIN_FRAMES there is no rate */
    int end;         /* the end of the frames considered: the last one, */
    bool saturated;  /* or one with a distance of at least GROWTH_SATURATED */
    double from, to; /* m, in frames first and last */
    double rate;     /* 1/s, by least squares; NAN without a fit */
    double scatter;  /* RMS of the logarithm about the line */
} Growth;

/* distance[from .. end - 1] in m, one per frame of dt seconds; 0 and NAN (unknown) are left out. False with error set
   when memory is short. */
bool growth_measure(const double *distance, int from, int end, double dt, Growth *growth, Error *error);

/* Number of frames in which the distance doubles; negative: halves. */
double growth_doubling(const Growth *growth, double dt);

/* A growth compared with that after a tiny shift, in the same frames. A distance grows if it at least doubles. */
typedef enum GrowthVerdict { GROWTH_UNKNOWN, GROWTH_NEITHER, GROWTH_SAME, GROWTH_FASTER, GROWTH_SLOWER } GrowthVerdict;
GrowthVerdict growth_compare(const Growth *growth, const Growth *shifted, double dt);

/* `frame,time,distance,shifted_distance`; shifted NULL, or NAN: that field is empty. */
typedef struct DistanceTable {
    int frames;
    double dt;                        /* s */
    const double *distance, *shifted; /* [frames] m */
} DistanceTable;
bool distance_table_write(const DistanceTable *table, const char *path, Error *error);

/* Sensitivity to the initial state: runs a scene twice with one method, the second time with one body shifted by a
   micrometre, and measures how fast the runs diverge. */

#define CHAOS_SHIFT 1e-6f /* m, in x; at least one ulp of the position */

typedef struct Chaos {
    int body;          /* the shifted body */
    double shift;      /* m, as represented in float32 */
    int rerun_differs; /* first frame in which the unshifted run differs from the given run; -1: none */
    int frames;
    double *distance; /* [frames] m, the largest of all bodies; NaN from where the shifted run is NaN or infinite */
} Chaos;

/* The body to shift, given that two runs diverge in this frame at body `diverged` (-1, -1: nowhere): the bomb or,
   without a bomb, the last dynamic body. If the bomb has touched nothing by that frame its shift cannot grow, so
   `diverged` is returned. -1: no dynamic body. */
int chaos_body(const Trajectory *run, int diverged, int frame);

/* Reads the scene at `path`, checks its hash against the run's, and runs `frames` frames with the run's method. `body`
   must be dynamic. ERROR_INPUT for another scene or an unavailable method. */
bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error);
void chaos_free(Chaos *chaos);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a scene with a method, and records the run:

     Method method;
     Scene *scene = scene_read("scenes/stack.yaml", &error);
     Trajectory *run = scene != NULL && method_parse(&method, "engine", &error)
                           ? simulate(scene, &method, NULL, &error) : NULL;

   A Recorder records to files while the run is made; a Simulation goes step by step. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

/* Runs the scene and records it in memory. NULL with error set if the method cannot be created, a body's state becomes
   NaN or infinite, progress requests a stop, or memory is short. */
Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error);

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

/* Runs the scene. False with error set for the same reasons, or if an observer fails. */
bool simulate_watched(const Scene *scene, const Method *method, const RunWatch *watch, Error *error);

/* The same with one observer. */
bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error);

/* Records a run: into a trajectory in memory, or into files while the run is made, in bounded memory. Files are written
   by a second thread. */

/* The limit of bodies times frames of a trajectory: 24 bytes each, 1.2 GB. */
enum { SIMULATE_MAX_STATES = 50000000, RECORDER_OUTPUTS_MAX = 2 };

typedef enum TrajectoryFormat {
    TRAJECTORY_NPZ,
    TRAJECTORY_CSV, /* frame,body,x,y,angle,vx,vy,omega; %.9g keeps every float32; the dynamic bodies that are there */
    TRAJECTORY_HASHES /* frame,hash: 16 hexadecimal digits */
} TrajectoryFormat;

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

/* After the run, before recorder_finish() or recorder_take(): what made it (program and network_hash of Trajectory),
   and the verdict on it (trajectory_judge). */
bool recorder_name_maker(Recorder *recorder, const Scene *scene, const Method *method, Error *error);
void recorder_judge(Recorder *recorder, const char *words, int frame, int body);

/* After the run: the files are written. */
bool recorder_finish(Recorder *recorder, Error *error);

/* After the run: the trajectory of a recorder in memory, which the caller destroys. */
Trajectory *recorder_take(Recorder *recorder);

/* Bodies of the run, and after it the hash of its last frame (trajectory_frame_hash). */
int recorder_bodies(const Recorder *recorder);
uint64_t recorder_state_hash(const Recorder *recorder);

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

/* What a recorder makes a trajectory of. */

/* A trajectory of a scene and a method in memory, with room for this many frames; none is filled. NULL, error set. */
Trajectory *trajectory_of_scene(const Scene *scene, const Method *method, int frames, Error *error);

/* Fills a frame from the world; the contacts are those of the step that led to it, in rising order of frames. */
void trajectory_set_bodies(Trajectory *trajectory, int frame, const World *world);
bool trajectory_set_contacts(Trajectory *trajectory, int frame, const World *world, Error *error);

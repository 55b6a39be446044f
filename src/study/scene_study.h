/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One scene of the speed-accuracy study: its launches and the methods that are scored on them. */
#pragma once
#include "study/contenders.h"
#include "study/launch_choice.h"
#include "study/rollout.h"
#include "study/stepper_pool.h"

typedef struct StudySize {
    int launches;            /* unless a table of launches is given */
    Sampling closed, frozen; /* steps to score */
    int timed_launches, repetitions;
} StudySize;

typedef struct SceneStudy {
    Scene *scene;
    int launch_count, contender_count;
    Launch *launches;             /* [launch_count] */
    const Contender **contenders; /* [contender_count] available for this scene */
    StepperPool steppers;         /* of the contenders */
    bool no_push_out;             /* one of them is scored against converged velocities without push-out */
    StudySize size;
} SceneStudy;

/* Reads the scene and its launches. `size` is for scenes of up to 110 bodies; larger ones have fewer launches. */
bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error);
void scene_study_end(SceneStudy *study);

/* The scene with a launch of the study, as launch_scene(). */
Scene scene_study_launch(const SceneStudy *study, int launch);

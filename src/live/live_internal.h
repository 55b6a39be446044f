/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of this room. */
#pragma once
#include "base/base.h"
#include "base/yaml.h"
#include "live/bundle.h"
#include "live/live.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

struct LiveScene {
    void *bytes; /* of the bundle */
    Bundle bundle;
    YamlTree tree;
};

/* The error of the next call, empty. */
Error *live_new_error(void);

/* The scene with these settings; NULL with error set. */
Scene *live_scene(LiveScene *scene, const char *settings, Error *error);

/* The frames of a run. */
const Trajectory *live_trajectory(const LiveRun *run);

/* The verdict on the run so far, which shares the run's memory: not to be freed. False where live_verdict() is NULL. */
bool live_verdict_of(const LiveRun *run, SimulateVerdict *verdict);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches: start conditions of the bomb, and tables of them for training and studies. */
#pragma once
#include "common/csv.h"
#include "scene/scene.h"

enum { LAUNCHES_MAX = 10000, LAUNCH_COLUMNS = 5 };

typedef struct Launch {
    float x, rotation, spin, mass; /* m, rad, rad/s, kg */
    int frame;                     /* step after which the bomb is added */
} Launch;

/* The scene's own launch. The scene must have a bomb. */
Launch launch_of(const Scene *scene);

/* The scene with this launch: a shallow copy that shares the bodies with the scene; do not destroy it. A bomb with a
   velocity law (scene_bomb_body) gets its velocity from the new position. */
Scene launch_scene(const Scene *scene, const Launch *launch);

/* A table of launches. */
typedef struct LaunchTable {
    Csv csv;
    int count;
    int column[LAUNCH_COLUMNS]; /* column of x, rotation, spin, mass, frame; -1: missing */
    Launch *launches;           /* [count], 0 for a missing column */
} LaunchTable;

/* Reads a CSV whose header names any of x, rotation, spin, mass, frame in any order, with 1 to LAUNCHES_MAX lines.
   Numbers have the ranges of a scene file. On failure error is "path:line:column: error: reason" and the table needs no
   free. path must outlive the table. */
bool launches_read(LaunchTable *table, const char *path, Error *error);
void launches_free(LaunchTable *table);

/* Writes the table's launches for one scene to out[count]; missing columns have the scene's values. Refused: a scene
   without a bomb, a bomb after the scene's last frame, a bomb that would start too fast. */
bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error);

/* `count` launches of the scene spread evenly over the paper's grid, x = -5 to 5 m in steps of 0.05 (201 positions,
   then they repeat). */
void launches_for_training(const Scene *scene, int count, Launch *out);

/* The same over the midpoints of that grid, x = -4.975 to 4.975 m (200 positions): all are held-out, and none is 0,
   where a bomb on a stack is an exact tie. */
void launches_for_scoring(const Scene *scene, int count, Launch *out);

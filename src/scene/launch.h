/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches: start conditions of the bomb, and tables of them for training and studies. */
#pragma once
#include "common/csv_table.h"
#include "scene/scene.h"

enum { LAUNCHES_MAX = 10000 };

typedef struct Launch {
    float x, rotation, spin, mass; /* m, rad, rad/s, kg */
    int frame;                     /* step after which the bomb is added */
} Launch;

/* The scene's own launch. The scene must have a bomb. */
Launch launch_of(const Scene *scene);

/* The scene with this launch: a shallow copy that shares the bodies with the scene; do not destroy it. A bomb with a
   velocity law (scene_bomb_body) gets its velocity from the new position. */
Scene launch_scene(const Scene *scene, const Launch *launch);

typedef struct LaunchTable {
    CsvTable csv; /* rows of Launch */
    int count;
} LaunchTable;

/* Reads a CSV file with any of the columns x, rotation, spin, mass, frame in any order, and 1 to LAUNCHES_MAX rows.
   Numbers have the ranges of a scene file. On failure error is "path:line:column: error: reason" and nothing is to be
   freed. */
bool launches_read(LaunchTable *table, const char *path, Error *error);
void launches_free(LaunchTable *table);

/* The table's launches for one scene into out[count]; values of missing columns are the scene's. Refused: a scene
   without a bomb, a bomb after the scene's last frame, a bomb that would start too fast. */
bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error);

/* `count` launches of the scene spread evenly over the paper's grid, x = -5 to 5 m in steps of 0.05 (201 positions,
   then they repeat). */
void launches_for_training(const Scene *scene, int count, Launch *out);

/* The same over the midpoints of that grid, x = -4.975 to 4.975 m (200 positions): all are held-out, and none is 0,
   where a bomb on a stack is an exact tie. */
void launches_for_scoring(const Scene *scene, int count, Launch *out);

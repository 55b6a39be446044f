/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches: start conditions of the bomb, and tables of them for training and studies. */
#pragma once
#include "csv/csv_table.h"
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

/* True if some number of the bomb varies from launch to launch. */
bool launch_has_family(const Scene *scene);

/* `count` launches spread evenly over the scene's family: x over a grid of LAUNCH_GRID positions with both ends (then
   they repeat), rotation, spin and mass between their ends. ERROR_INPUT if the bomb has no family. */
enum { LAUNCH_GRID = 201 };
bool launches_for_training(const Scene *scene, int count, Launch *out, Error *error);

/* The same over the midpoints of that grid, and other rotations, spins and masses: all launches are held-out. Over x = -5
   to 5 m none is 0, where a bomb on a stack is an exact tie. */
bool launches_for_scoring(const Scene *scene, int count, Launch *out, Error *error);

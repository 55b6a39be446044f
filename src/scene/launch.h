/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a scene's bomb is thrown: tables of launches to train and to score on. */
#pragma once
#include "common/csv.h"
#include "scene/scene.h"

enum { LAUNCHES_MAX = 10000, LAUNCH_COLUMNS = 5 };

typedef struct Launch {
    float x, rotation, spin, mass; /* m, rad, rad/s, kg */
    int frame;                     /* step after which the bomb is put in */
} Launch;

/* The scene's own launch. The scene has a bomb. */
Launch launch_of(const Scene *scene);

/* The scene with its bomb thrown so: a shallow copy, which shares the bodies with the scene and is not to be destroyed.
   A bomb that aims (scene_bomb_body) gets its velocity from the new place. */
Scene launch_scene(const Scene *scene, const Launch *launch);

/* A table of launches. */
typedef struct LaunchTable {
    Csv csv;
    int count;
    int column[LAUNCH_COLUMNS]; /* where x, rotation, spin, mass, frame are, -1: not there */
    Launch *launches;           /* [count], 0 where a column is not there */
} LaunchTable;

/* Reads a CSV whose header names any of x, rotation, spin, mass, frame in any order, with 1 to LAUNCHES_MAX lines.
   Numbers have the ranges of a scene file. On failure error is "path:line:column: error: reason" and nothing is to be
   freed. path must outlive the table. */
bool launches_read(LaunchTable *table, const char *path, Error *error);
void launches_free(LaunchTable *table);

/* The table's launches for one scene into out[count]; what the table leaves out is as in the scene. Refused: a scene
   without a bomb, a bomb after the scene's last frame, one that would start too fast. */
bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error);

/* `count` launches of the scene spread evenly over the paper's grid, x = -5 to 5 m in steps of 0.05 (of 201 places:
   beyond that they repeat). */
void launches_for_training(const Scene *scene, int count, Launch *out);

/* The same over the midpoints of that grid, x = -4.975 to 4.975 m (200 places): never one that was trained on, and
   never 0, where a bomb on a stack is an exact tie. */
void launches_for_scoring(const Scene *scene, int count, Launch *out);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene: what there is before the first step, and the bomb that comes. Read from YAML (libfyaml); constant
   while worlds run. SI units, radians, y up. */
#pragma once
#include "common/error.h"
#include "dynamics/world.h"

#include <stdint.h>

enum {
    SCENE_NAME_SIZE = 128,
    SCENE_PATH_SIZE = 512,
    SCENE_MAX_BODIES = 10000,
    SCENE_MAX_FRAMES = 1000000,
    SCENE_MAX_ITERATIONS = 1000000,
    SCENE_MAX_NETWORKS = 8,
    SCENE_MAX_PARAMETERS = 4,
    SCENE_PARAMETER_SIZE = 32, /* of a parameter's name and of its unit, with the NUL */
    SCENE_IMPACT_FRAMES = 6    /* where a file does not say */
};

#define SCENE_MAX_POSITION 1e6f /* m, either way along each axis */
#define SCENE_MIN_DT 1e-5f      /* s */
#define SCENE_MAX_DT 1.0f       /* s */

/* The bomb: a box put in after step `frame` (so it is in that frame's state; 0: from the start). */
typedef struct SceneBomb {
    bool present;
    int frame;
    BodyDef body;                /* velocity: only where the law below is off (scene_bomb_body) */
    bool velocity_from_position; /* velocity = velocity_factor * position */
    float velocity_factor;       /* 1/s */
    int impact_frames;           /* from its first touch on, in studies */
} SceneBomb;

/* Which trained network a method of this scene uses. */
typedef struct SceneNetwork {
    char method[SCENE_NAME_SIZE];
    char path[SCENE_PATH_SIZE]; /* resolved against the folder of the scene file */
} SceneNetwork;

/* A number that the scene leaves open within bounds: $name in its file. */
typedef struct SceneParameter {
    char name[SCENE_PARAMETER_SIZE], unit[SCENE_PARAMETER_SIZE];
    double value, from, to; /* from <= value <= to; the value is the setting's where there is one */
    bool whole;             /* whole numbers only */
} SceneParameter;

/* A value for a parameter, instead of the file's. */
typedef struct SceneSetting {
    char name[SCENE_PARAMETER_SIZE];
    double value;
} SceneSetting;

typedef struct Scene {
    char name[SCENE_NAME_SIZE]; /* file name without folder and ending */
    Vec2 gravity;               /* m/s^2 */
    float dt;                   /* s */
    int iterations;             /* of sequential impulses, per step */
    bool warm_starting, accumulate_impulses, position_correction;
    int frames;                      /* steps to run */
    Vec2 camera_center, camera_size; /* m; size 0, 0: fitted to what happens */
    int body_count;
    BodyDef *bodies;     /* [body_count], patterns written out, in the order of the file */
    int last_body_until; /* the last body is taken out after this step; 0: it stays. Never beside a bomb */
    SceneBomb bomb;
    int network_count;
    SceneNetwork networks[SCENE_MAX_NETWORKS];
    int parameter_count;
    SceneParameter
        parameters[SCENE_MAX_PARAMETERS]; /* in the order of the file; their values are in all of the above */
} Scene;

/* NULL with error set: "path:line:column: error: what", the line of the file, a caret below. Never takes more
   than 0.1 s or some 20 MB, whatever the file holds: the limits are in source.h and yaml_tree.h. The format
   is described at the head of scenes/pyramid_settled.yaml. */
Scene *scene_read(const char *path, Error *error);

/* The same with values for some of its parameters. A setting that is unknown, there twice, out of its parameter's
   bounds or not whole where it must be is refused: "path: error: what". */
Scene *scene_read_with(const char *path, const SceneSetting *settings, int count, Error *error);

void scene_destroy(Scene *scene);

/* A world with the scene's bodies (and the bomb if its frame is 0). NULL with error set when memory is short.
 */
World *scene_world(const Scene *scene, Error *error);

/* The bomb as it is put in: with the velocity that its law gives at its position. */
BodyDef scene_bomb_body(const Scene *scene);

/* Adds the bomb to a world of this scene, and tells the world which body it is. */
bool scene_add_bomb(const Scene *scene, World *world, Error *error);

/* XXH3 of all that decides a run: equal physics, equal hash, whatever the file looks like. Gravity, dt,
   iterations, switches, bodies (and when the last one goes) and bomb (with the velocity that it gets) count; name,
   frames, camera, networks and impact_frames do not, nor does what parameters made of it. */
uint64_t scene_hash(const Scene *scene);

/* Path of the network that the scene names for a method, or NULL. */
const char *scene_network(const Scene *scene, const char *method);

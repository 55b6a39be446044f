/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes: bodies, bomb, launches, parameters; worlds made from them; the phases of a run.

     Scene *scene = scene_read("scenes/stack.yaml", &error);
     World *world = scene != NULL ? scene_world(scene, &error) : NULL; */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "engine/engine.h"

#include <stdint.h>

/* A scene: the state before the first step, and the bomb. Read from YAML (libyaml); constant while worlds run. SI
   units, radians, y up. */

enum {
    SCENE_NAME_SIZE = 128,
    SCENE_PATH_SIZE = 512,
    SCENE_MAX_BODIES = 25000,
    SCENE_MAX_FRAMES = 1000000,
    SCENE_MAX_ITERATIONS = 1000000,
    SCENE_MAX_NETWORKS = 16,
    SCENE_MAX_PARAMETERS = 4,
    SCENE_PARAMETER_SIZE = 32, /* of a parameter's name and of its unit, with the NUL */
    SCENE_BODY_NAME_SIZE = 32, /* of a body's name, with the NUL */
    SCENE_IMPACT_FRAMES = 6    /* default of a file */
};

/* m: bodies that start deeper inside one another are refused. The slop, and what decimals of a file are off by. */
#define SCENE_OVERLAP (1.01 * (double)CONTACT_SLOP)
#define SCENE_MAX_POSITION 1e6f /* m, either way along each axis */
#define SCENE_MIN_DT 1e-5f      /* s */
#define SCENE_MAX_DT 1.0f       /* s */

/* A number of the bomb: what the scene runs with, and the ends of its family of launches, from which others draw a
   value; from = to if all launches have the same. */
typedef struct SceneSpan {
    float value, from, to;
} SceneSpan;

static inline bool scene_span_varies(const SceneSpan *span) { return span->from < span->to; }

/* The value at a share of the way from one end to the other. */
static inline float scene_span_at(const SceneSpan *span, double share) {
    return (float)((double)span->from + share * ((double)span->to - (double)span->from));
}

/* The bomb: a box that is added after step `frame` (so it is in that frame's state; 0: from the start). A number has
   this place only: settings, options and launch_scene() write it here, and scene_bomb_body() makes the body of it. */
typedef struct SceneBomb {
    bool present;
    int frame;
    SceneSpan x, rotation, spin, mass; /* m, rad, rad/s, kg */
    float y;                           /* m */
    Vec2 size;                         /* m */
    float friction;
    Vec2 velocity;               /* m/s: only without the law below */
    bool velocity_from_position; /* velocity = velocity_factor * position */
    float velocity_factor;       /* 1/s */
    float own_mass;              /* kg: the file's, by which networks know the scene whatever the launch's mass */
    int impact_frames;           /* from its first touch on, in studies */
} SceneBomb;

/* The trained network of a method for this scene. */
typedef struct SceneNetwork {
    char method[SCENE_NAME_SIZE];
    char path[SCENE_PATH_SIZE]; /* resolved against the folder of the scene file */
} SceneNetwork;

/* A parameter of the scene, within bounds: $name in its file. */
typedef struct SceneParameter {
    char name[SCENE_PARAMETER_SIZE], unit[SCENE_PARAMETER_SIZE];
    double value, from, to; /* from <= value <= to; value is the setting's if there is one */
    bool whole;             /* whole numbers only */
    bool common;            /* every scene has it: from and to are no bounds, but what studies vary by default */
} SceneParameter;

/* What every scene has, and settings and studies take beside its parameters: iterations, dt (the run and the time of
   the bomb stay as long, in seconds), friction of all boxes; and in a scene with a bomb its position, mass and speed as
   bomb_x, bomb_y, bomb_mass and bomb_speed. A parameter of the scene with such a name goes before. */
enum { SCENE_COMMON_MAX = 7 };

/* The name of a body in pictures, UTF-8; empty: it has none. */
typedef struct BodyName {
    char text[SCENE_BODY_NAME_SIZE];
} BodyName;

/* A value for a parameter, instead of the file's. */
typedef struct SceneSetting {
    char name[SCENE_PARAMETER_SIZE];
    double value;
} SceneSetting;

/* Values for several. Has room for one more than a scene can have, which the scene then refuses. */
enum { SCENE_SETTINGS_MAX = SCENE_MAX_PARAMETERS + SCENE_COMMON_MAX + 1 };

typedef struct SceneSettings {
    int count;
    SceneSetting items[SCENE_SETTINGS_MAX];
} SceneSettings;

/* Adds "NAME=VALUE". False if it is no such text; of more settings than there is room for, none is added. */
bool scene_settings_add(SceneSettings *settings, const char *text);

typedef struct Scene {
    char name[SCENE_NAME_SIZE]; /* file name without folder and ending */
    Vec2 gravity;               /* m/s^2 */
    float dt;                   /* s */
    int iterations;             /* of sequential impulses, per step */
    bool warm_starting, accumulate_impulses, position_correction;
    int frames;                      /* steps to run */
    Vec2 camera_center, camera_size; /* m; size 0, 0: fitted to the run */
    int body_count;
    BodyDef *bodies;       /* [body_count], patterns written out, in the order of the file */
    BodyName *names;       /* [body_count]; NULL: no body has a name */
    bool overlaps_allowed; /* bodies may start inside one another by more than SCENE_OVERLAP */
    int last_body_until;   /* the last body is removed after this step; 0: never. 0 with a bomb */
    SceneBomb bomb;
    int network_count;
    SceneNetwork networks[SCENE_MAX_NETWORKS];
    int parameter_count;
    SceneParameter parameters[SCENE_MAX_PARAMETERS]; /* in the order of the file; the members above have their values */
} Scene;

/* NULL with error set: "path:line:column: error: what", the line of the file, a caret below. Takes at most 0.1 s and 20
   MB for any file: the limits are in base/yaml.h. Only long thin boxes whose bounds all overlap take
   longer to check, 4 s for 25,000. The format is described at the head of scenes/pyramid_settled.yaml. */
Scene *scene_read(const char *path, Error *error);

/* The same with values for some of its parameters, or of what every scene has. Refuses settings that are unknown, given
   twice, out of their parameter's bounds or not whole where they must be: "path: error: what". */
Scene *scene_read_with(const char *path, const SceneSetting *settings, int count, Error *error);

/* The same from the tree of a file, which stays the caller's and may be read again. */
struct YamlTree;
Scene *scene_of_tree(struct YamlTree *tree, const SceneSetting *settings, int count, Error *error);

void scene_destroy(Scene *scene);

/* What settings may change: the parameters of the file, then what every scene has, with the value of now. */
typedef struct SceneParameters {
    int count;
    SceneParameter items[SCENE_MAX_PARAMETERS + SCENE_COMMON_MAX];
} SceneParameters;
SceneParameters scene_parameters(const Scene *scene);

/* The first with this name, the one that a setting changes; NULL: none. */
const SceneParameter *scene_parameter(const SceneParameters *all, const char *name);

/* The unit of scene_parameter(); empty if it has none, or no parameter has this name. */
const char *scene_parameter_unit(const Scene *scene, const char *name);

/* A world with the scene's bodies (and the bomb if its frame is 0). NULL with error set when memory is short.
 */
World *scene_world(const Scene *scene, Error *error);

/* Whether a run of the scene gets a bomb before it ends. */
static inline bool scene_has_launch(const Scene *scene) {
    return scene->bomb.present && scene->bomb.frame <= scene->frames;
}

/* The bomb as a body, with its start velocity: the velocity law applied to its position. */
BodyDef scene_bomb_body(const Scene *scene);

/* Adds the bomb to a world of this scene and marks it. */
bool scene_add_bomb(const Scene *scene, World *world, Error *error);

/* XXH3 of everything that determines a run: equal physics, equal hash. Gravity, dt, iterations, switches, bodies (and
   when the last is removed) and bomb (with its start velocity) count; names, frames, camera, networks, impact_frames,
   overlaps and parameters do not. */
uint64_t scene_hash(const Scene *scene);

/* Path of the scene's network for a method, or NULL. */
const char *scene_network(const Scene *scene, const char *method);

/* Launches: start conditions of the bomb, and tables of them for training and studies. */

enum { LAUNCHES_MAX = 10000 };

/* Values for those numbers of the bomb in which runs of a scene differ: drawn, or read from a table. */
typedef struct Launch {
    float x, rotation, spin, mass; /* m, rad, rad/s, kg */
    int frame;                     /* step after which the bomb is added */
} Launch;

/* The scene's own launch. The scene must have a bomb. */
Launch launch_of(const Scene *scene);

/* The scene with this launch: a shallow copy that shares the bodies with the scene; do not destroy it. A bomb with a
   velocity law (scene_bomb_body) gets its velocity from the new position. */
Scene launch_scene(const Scene *scene, const Launch *launch);

/* Turns a launch for training: rotation and spin at these shares of the scene's families; where it has none, of -1.5
   to 1.5 rad and -20 to 20 rad/s. */
void launch_turn(Launch *launch, const Scene *scene, double rotation_share, double spin_share);

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

/* The same over the midpoints of that grid, and other rotations, spins and masses: all launches are held-out. Over x =
   -5 to 5 m none is 0, where a bomb on a stack is an exact tie. */
bool launches_for_scoring(const Scene *scene, int count, Launch *out, Error *error);

/* The phases of a run, counted from the step in which the bomb first touches a box that can move: impact (the scene
   sets the number of frames), the 60 frames after, and all other frames. */

typedef enum Phase { PHASE_IMPACT, PHASE_AFTER, PHASE_REST } Phase;

enum { PHASES = PHASE_REST + 1, AFTER_FRAMES = 60 };

typedef struct PhaseTracker {
    int impact_frames; /* the scene's */
    int touch;         /* number of the first step in which the bomb touches; 0: not yet */
} PhaseTracker;

/* The phase of step `frame`, which has this contact problem. Call it for all steps in order. */
Phase phase_next(PhaseTracker *tracker, const ContactProblem *problem, int frame);

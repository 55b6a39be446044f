/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/launch.h"

#include "common/parse.h"
#include "scene/fields.h"

#include <math.h>

/* Columns of a table, in this order in CsvTable.fields. */
enum { X, ROTATION, SPIN, MASS, FRAME, LAUNCH_COLUMNS };

Launch launch_of(const Scene *scene) {
    const BodyDef *bomb = &scene->bomb.body;
    return (Launch){bomb->position.x, bomb->angle, bomb->angular_velocity, bomb->mass, scene->bomb.frame};
}

Scene launch_scene(const Scene *scene, const Launch *launch) {
    Scene launched = *scene;
    BodyDef *bomb = &launched.bomb.body;
    bomb->position.x = launch->x;
    bomb->angle = launch->rotation;
    bomb->angular_velocity = launch->spin;
    bomb->mass = launch->mass;
    launched.bomb.frame = launch->frame;
    return launched;
}

static CsvColumn number(const char *name, size_t offset, const Range *range) {
    return (CsvColumn){name, CSV_FLOAT, offset, .minimum = (double)range->minimum, .maximum = (double)range->maximum};
}

bool launches_read(LaunchTable *table, const char *path, Error *error) {
    const CsvColumn columns[LAUNCH_COLUMNS] = {
        [X] = number("x", offsetof(Launch, x), &range_position),
        [ROTATION] = number("rotation", offsetof(Launch, rotation), &range_angle),
        [SPIN] = number("spin", offsetof(Launch, spin), &range_spin),
        [MASS] = number("mass", offsetof(Launch, mass), &range_mass),
        [FRAME] = {"frame", CSV_INTEGER, offsetof(Launch, frame), .maximum = SCENE_MAX_FRAMES}};
    const CsvLayout layout =
        CSV_LAYOUT("launches", columns, Launch, .min_rows = 1, .max_rows = LAUNCHES_MAX, .header = CSV_SUBSET);
    *table = (LaunchTable){.count = 0};
    if (!csv_table_read(&table->csv, path, &layout, error)) return false;
    table->count = table->csv.count;
    return true;
}

void launches_free(LaunchTable *table) {
    csv_table_free(&table->csv);
    *table = (LaunchTable){.count = 0};
}

/* Row i, completed by the scene's own launch. */
static Launch complete(const LaunchTable *table, int i, const Scene *scene) {
    const int *fields = table->csv.fields;
    const Launch *row = (const Launch *)table->csv.rows + i;
    Launch launch = launch_of(scene);
    if (fields[X] >= 0) launch.x = row->x;
    if (fields[ROTATION] >= 0) launch.rotation = row->rotation;
    if (fields[SPIN] >= 0) launch.spin = row->spin;
    if (fields[MASS] >= 0) launch.mass = row->mass;
    if (fields[FRAME] >= 0) launch.frame = row->frame;
    return launch;
}

/* The checks of a scene file that need the scene. */
static bool fits(const LaunchTable *table, int i, const Scene *scene, const Launch *launch, Error *error) {
    if (launch->frame > scene->frames)
        return csv_table_error(&table->csv, i, FRAME, error,
                               "the bomb would come in frame %d, after the last of %s (frames: %d)", launch->frame,
                               scene->name, scene->frames);
    Scene launched = launch_scene(scene, launch);
    Vec2 velocity = scene_bomb_body(&launched).velocity;
    if (fmaxf(fabsf(velocity.x), fabsf(velocity.y)) <= range_speed.maximum) return true;
    return csv_table_error(&table->csv, i, X, error, "the bomb of %s would start with (%g, %g) m/s, above %g",
                           scene->name, (double)velocity.x, (double)velocity.y, (double)range_speed.maximum);
}

bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error) {
    if (!scene->bomb.present)
        return error_input(error, table->csv.csv.path, "the scene %s has no bomb to launch", scene->name);
    for (int i = 0; i < table->count; i++) {
        out[i] = complete(table, i, scene);
        if (!fits(table, i, scene, &out[i], error)) return false;
    }
    return true;
}

static void spread(const Scene *scene, const FloatRange *places, int count, Launch *out) {
    for (int i = 0; i < count; i++) {
        out[i] = launch_of(scene);
        out[i].x = range_value(places, (int)((i + 0.5) * places->count / count));
    }
}

void launches_for_training(const Scene *scene, int count, Launch *out) {
    static const FloatRange grid = {-5, 0.05, 201};
    spread(scene, &grid, count, out);
}

void launches_for_scoring(const Scene *scene, int count, Launch *out) {
    static const FloatRange midpoints = {-4.975, 0.05, 200};
    spread(scene, &midpoints, count, out);
}

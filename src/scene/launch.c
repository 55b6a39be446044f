/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/launch.h"

#include "common/parse.h"
#include "scene/scene_fields.h"

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

/* Irrational steps whose multiples, modulo 1, fill the cube of rotation, spin and mass evenly: powers of 1/g, where
   g^4 = g + 1. Source: Roberts, The unreasonable effectiveness of quasirandom sequences (2018). */
static const double even_rotation = 0.8191725133961645, even_spin = 0.671043606703789, even_mass = 0.5497004779019703;

/* Sets *value to number i of values that fill the span evenly, if it varies; `start` tells training from scoring. */
static void spread_evenly(const SceneSpan *span, double step, double start, int i, float *value) {
    const double share = fmod(start + step * (i + 1), 1);
    if (scene_span_varies(span)) *value = scene_span_at(span, share);
}

bool launch_has_family(const Scene *scene) {
    const SceneBomb *bomb = &scene->bomb;
    return scene_span_varies(&bomb->x) || scene_span_varies(&bomb->rotation) || scene_span_varies(&bomb->spin) ||
           scene_span_varies(&bomb->mass);
}

static bool spread(const Scene *scene, bool scoring, int count, Launch *out, Error *error) {
    const SceneBomb *bomb = &scene->bomb;
    if (!launch_has_family(scene))
        return error_input(
            error, scene->name,
            "the bomb has one launch and no family: write its x as {from: A, to: B}, or choose launches");
    const double width = ((double)bomb->x.to - (double)bomb->x.from) / (LAUNCH_GRID - 1), start = scoring ? 0.5 : 0;
    const FloatRange places = {(double)bomb->x.from + start * width, width, scoring ? LAUNCH_GRID - 1 : LAUNCH_GRID};
    for (int i = 0; i < count; i++) {
        out[i] = launch_of(scene);
        if (scene_span_varies(&bomb->x)) out[i].x = range_value(&places, (int)((i + 0.5) * places.count / count));
        spread_evenly(&bomb->rotation, even_rotation, start, i, &out[i].rotation);
        spread_evenly(&bomb->spin, even_spin, start, i, &out[i].spin);
        spread_evenly(&bomb->mass, even_mass, start, i, &out[i].mass);
    }
    return true;
}

bool launches_for_training(const Scene *scene, int count, Launch *out, Error *error) {
    return spread(scene, false, count, out, error);
}

bool launches_for_scoring(const Scene *scene, int count, Launch *out, Error *error) {
    return spread(scene, true, count, out, error);
}

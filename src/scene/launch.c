/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/launch.h"

#include "common/parse.h"
#include "scene/fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A line of five numbers has some 60 bytes; twenty times as many are enough for any way to write them. */
enum { TABLE_MAX_SIZE = LAUNCHES_MAX * 1200 };

enum { FRAME = LAUNCH_COLUMNS - 1 };

_Static_assert(sizeof(int) == sizeof(float), "launches_for copies members of either type");

typedef struct Column {
    const char *name;
    size_t offset;
    const Range *range; /* NULL: a frame */
} Column;

static const Column columns[LAUNCH_COLUMNS] = {{"x", offsetof(Launch, x), &range_position},
                                               {"rotation", offsetof(Launch, rotation), &range_angle},
                                               {"spin", offsetof(Launch, spin), &range_spin},
                                               {"mass", offsetof(Launch, mass), &range_mass},
                                               {"frame", offsetof(Launch, frame), NULL}};

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

static int find_column(const char *name) {
    for (int i = 0; i < LAUNCH_COLUMNS; i++)
        if (strcmp(columns[i].name, name) == 0) return i;
    return -1;
}

static bool read_header(LaunchTable *table, Error *error) {
    for (int i = 0; i < LAUNCH_COLUMNS; i++) table->column[i] = -1;
    for (int field = 0; field < table->csv.width; field++) {
        const char *name = csv_text(&table->csv, 0, field);
        int i = find_column(name);
        if (i < 0)
            return csv_error(&table->csv, 0, field, error,
                             "unknown column '%s'; launches have: x, rotation, spin, mass, frame", csv_show(name).text);
        if (table->column[i] >= 0)
            return csv_error(&table->csv, 0, field, error, "column '%s' is there twice", columns[i].name);
        table->column[i] = field;
    }
    return true;
}

static bool read_number(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    const Range *range = column->range;
    float value;
    if (!parse_float(text, &value))
        return csv_error(csv, row, field, error, "%s must be a number (got %s)", column->name, csv_show(text).text);
    if (range->minimum > 0 && value <= 0)
        return csv_error(csv, row, field, error, "%s must be greater than 0 (got %s)", column->name,
                         csv_show(text).text);
    if (value < range->minimum || value > range->maximum)
        return csv_error(csv, row, field, error, "%s must be from %g to %g%s (got %s)", column->name,
                         (double)range->minimum, (double)range->maximum, range->unit, csv_show(text).text);
    *(float *)member = value;
    return true;
}

static bool read_frame(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    int64_t value;
    if (!parse_int(text, 0, SCENE_MAX_FRAMES, &value))
        return csv_error(csv, row, field, error, "%s must be a whole number from 0 to %d (got %s)", column->name,
                         SCENE_MAX_FRAMES, csv_show(text).text);
    *(int *)member = (int)value;
    return true;
}

static bool read_launches(LaunchTable *table, Error *error) {
    if (!read_header(table, error)) return false;
    table->count = table->csv.rows - 1;
    table->launches = calloc((size_t)table->count, sizeof *table->launches);
    if (table->launches == NULL) return error_memory(error, table->csv.path);
    for (int row = 1; row < table->csv.rows; row++)
        for (int i = 0; i < LAUNCH_COLUMNS; i++) {
            if (table->column[i] < 0) continue;
            void *member = (char *)&table->launches[row - 1] + columns[i].offset;
            if (!(i == FRAME ? read_frame : read_number)(&table->csv, row, table->column[i], &columns[i], member,
                                                         error))
                return false;
        }
    return true;
}

bool launches_read(LaunchTable *table, const char *path, Error *error) {
    *table = (LaunchTable){.count = 0};
    if (!csv_read(&table->csv, path, TABLE_MAX_SIZE, 1, LAUNCHES_MAX, error)) return false;
    if (read_launches(table, error)) return true;
    launches_free(table);
    return false;
}

void launches_free(LaunchTable *table) {
    csv_free(&table->csv);
    free(table->launches);
    table->launches = NULL;
}

/* What only the scene can tell: the same checks as its file's. */
static bool fits(const LaunchTable *table, int i, const Scene *scene, const Launch *launch, Error *error) {
    int frame_field = table->column[FRAME], x_field = table->column[0];
    if (launch->frame > scene->frames)
        return csv_error(&table->csv, i + 1, frame_field < 0 ? 0 : frame_field, error,
                         "the bomb would come in frame %d, after the last of %s (frames: %d)", launch->frame,
                         scene->name, scene->frames);
    Scene launched = launch_scene(scene, launch);
    Vec2 velocity = scene_bomb_body(&launched).velocity;
    if (fmaxf(fabsf(velocity.x), fabsf(velocity.y)) <= range_speed.maximum) return true;
    return csv_error(&table->csv, i + 1, x_field < 0 ? 0 : x_field, error,
                     "the bomb of %s would start with (%g, %g) m/s, above %g", scene->name, (double)velocity.x,
                     (double)velocity.y, (double)range_speed.maximum);
}

bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error) {
    if (!scene->bomb.present)
        return error_input(error, table->csv.path, "the scene %s has no bomb to launch", scene->name);
    for (int i = 0; i < table->count; i++) {
        Launch launch = launch_of(scene);
        for (int k = 0; k < LAUNCH_COLUMNS; k++)
            if (table->column[k] >= 0)
                memcpy((char *)&launch + columns[k].offset, (const char *)&table->launches[i] + columns[k].offset,
                       sizeof(float));
        if (!fits(table, i, scene, &launch, error)) return false;
        out[i] = launch;
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

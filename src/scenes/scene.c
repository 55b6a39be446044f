/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes once read: overlaps at the start, launches, tables of them. */
#include "base/base.h"
#include "base/csv.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "scenes/scenes_internal.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool field_overlaps(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    const bool allowed = *(bool *)member = strcmp(text, "allowed") == 0;
    return allowed || strcmp(text, "refused") == 0 ||
           yaml_error(tree, node, error, "%s must be refused or allowed (got %s)", field->key,
                      yaml_show(tree, node).text);
}

bool overlaps_check(const YamlTree *tree, int bodies, int bomb, const Scene *scene, Error *error) {
    const bool with_bomb = scene->bomb.present && scene->bomb.frame == 0;
    const int count = scene->body_count + with_bomb;
    Box *boxes = malloc((size_t)count * sizeof *boxes);
    bool *fixed = malloc((size_t)count * sizeof *fixed);
    BodyPair pair = {-1, -1};
    for (int i = 0; boxes != NULL && fixed != NULL && i < count; i++) {
        const BodyDef body = i < scene->body_count ? scene->bodies[i] : scene_bomb_body(scene);
        boxes[i] = box_make(body.position, body.size, body.angle);
        fixed[i] = body.fixed;
    }
    bool ok = boxes != NULL && fixed != NULL && overlap_find(boxes, fixed, count, SCENE_OVERLAP, &pair);
    if (!ok)
        error_memory(error, tree->source.path);
    else if (pair.a >= 0) {
        const int other = bodies_entry(tree, bodies, pair.a);
        char what[32] = "the bomb";
        if (pair.b < scene->body_count) snprintf(what, sizeof what, "body %d", pair.b);
        ok = yaml_error(tree, pair.b < scene->body_count ? bodies_entry(tree, bodies, pair.b) : bomb, error,
                        "%s starts %.3g m inside body %d (line %d), more than the slop of %g m; move one of them, or "
                        "write 'overlaps: allowed'",
                        what, overlap_depth(&boxes[pair.a], &boxes[pair.b]), pair.a, tree->nodes[other].place.line + 1,
                        (double)CONTACT_SLOP);
    }
    free(boxes);
    free(fixed);
    return ok;
}

/* Columns of a table, in this order in CsvTable.fields. */
enum { X, ROTATION, SPIN, MASS, FRAME, LAUNCH_COLUMNS };

Launch launch_of(const Scene *scene) {
    const SceneBomb *bomb = &scene->bomb;
    return (Launch){bomb->x.value, bomb->rotation.value, bomb->spin.value, bomb->mass.value, bomb->frame};
}

Scene launch_scene(const Scene *scene, const Launch *launch) {
    Scene launched = *scene;
    SceneBomb *bomb = &launched.bomb;
    bomb->x.value = launch->x;
    bomb->rotation.value = launch->rotation;
    bomb->spin.value = launch->spin;
    bomb->mass.value = launch->mass;
    bomb->frame = launch->frame;
    return launched;
}

void launch_turn(Launch *launch, const Scene *scene, double rotation_share, double spin_share) {
    static const SceneSpan turned = {0, -1.5f, 1.5f}, spinning = {0, -20, 20};
    const SceneSpan *rotation = &scene->bomb.rotation, *spin = &scene->bomb.spin;
    launch->rotation = scene_span_at(scene_span_varies(rotation) ? rotation : &turned, rotation_share);
    launch->spin = scene_span_at(scene_span_varies(spin) ? spin : &spinning, spin_share);
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

bool launches_for(const LaunchTable *table, const Scene *scene, Launch *out, Error *error) {
    const int *fields = table->csv.fields;
    if (!scene->bomb.present)
        return error_input(error, table->csv.csv.path, "the scene %s has no bomb to launch", scene->name);
    for (int i = 0; i < table->count; i++) {
        /* The row, completed by the scene's own launch. */
        const Launch *row = (const Launch *)table->csv.rows + i;
        Launch launch = launch_of(scene);
        if (fields[X] >= 0) launch.x = row->x;
        if (fields[ROTATION] >= 0) launch.rotation = row->rotation;
        if (fields[SPIN] >= 0) launch.spin = row->spin;
        if (fields[MASS] >= 0) launch.mass = row->mass;
        if (fields[FRAME] >= 0) launch.frame = row->frame;
        out[i] = launch;
        /* The checks of a scene file that need the scene. */
        if (launch.frame > scene->frames)
            return csv_table_error(&table->csv, i, FRAME, error,
                                   "the bomb would come in frame %d, after the last of %s (frames: %d)", launch.frame,
                                   scene->name, scene->frames);
        const Scene launched = launch_scene(scene, &launch);
        const Vec2 velocity = scene_bomb_body(&launched).velocity;
        if (fmaxf(fabsf(velocity.x), fabsf(velocity.y)) > range_speed.maximum)
            return csv_table_error(&table->csv, i, X, error, "the bomb of %s would start with (%g, %g) m/s, above %g",
                                   scene->name, (double)velocity.x, (double)velocity.y, (double)range_speed.maximum);
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

Phase phase_next(PhaseTracker *tracker, const ContactProblem *problem, int frame) {
    for (int i = 0; tracker->touch == 0 && problem->bomb >= 0 && i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const bool bomb = contact->a == problem->bomb || contact->b == problem->bomb;
        if (bomb && problem->bodies[contact->a].inv_mass > 0 && problem->bodies[contact->b].inv_mass > 0)
            tracker->touch = frame;
    }
    if (tracker->touch == 0) return PHASE_REST;
    int since = frame - tracker->touch;
    if (since < tracker->impact_frames) return PHASE_IMPACT;
    return since < tracker->impact_frames + AFTER_FRAMES ? PHASE_AFTER : PHASE_REST;
}

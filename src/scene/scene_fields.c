/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The types of values that the tables of a scene share. */
#include "scene/scene_fields.h"

#include "common/parse.h"
#include "common/vec2.h"
#include "scene/chain.h"
#include "scene/scene.h"

#include <math.h>
#include <stdint.h>

const Range range_size = {1e-3f, 1e4f, " m"};
const Range range_mass = {1e-6f, 1e9f, " kg"};
const Range range_position = {-SCENE_MAX_POSITION, SCENE_MAX_POSITION, " m"};
const Range range_angle = {-1e4f, 1e4f, " rad"};
const Range range_speed = {-1e4f, 1e4f, " m/s"};
const Range range_spin = {-1e4f, 1e4f, " rad/s"};
const Range range_friction = {0, 10, ""};
const Range range_gravity = {-1e4f, 1e4f, " m/s^2"};
const Range range_dt = {SCENE_MIN_DT, SCENE_MAX_DT, " s"};
const Range range_rate = {-1e4f, 1e4f, " 1/s"};

static bool is_scalar(const YamlTree *tree, int node) { return tree->nodes[node].kind == YAML_SCALAR; }

bool field_number(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    float value;
    double full;
    const Range *range = field->range;
    /* A decimal and a fraction of two are rounded as everywhere else; a chain is rounded once, at its end. */
    if (is_scalar(tree, node) && parse_float(yaml_text(tree, node), &value))
        full = (double)value;
    else if (chain_read(tree, node, field->key, &full, error))
        value = (float)full;
    else
        return false;
    if (range->minimum > 0 && value <= 0)
        return yaml_error(tree, node, error, "%s must be greater than 0 (got %s)", field->key,
                          chain_show(tree, node, full).text);
    if (value < range->minimum || value > range->maximum)
        return yaml_error(tree, node, error, "%s must be from %g to %g%s (got %s)", field->key, (double)range->minimum,
                          (double)range->maximum, range->unit, chain_show(tree, node, full).text);
    *(float *)member = value;
    return true;
}

bool field_vector(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    if (tree->nodes[node].kind != YAML_SEQUENCE)
        return yaml_error(tree, node, error, "%s must be a list of two numbers (got %s)", field->key,
                          yaml_show(tree, node).text);
    if (tree->nodes[node].count != 2)
        return yaml_error(tree, node, error, "%s must be a list of two numbers (got %d)", field->key,
                          tree->nodes[node].count);
    Vec2 *vector = member;
    int x = node + 1, y = tree->nodes[x].end;
    return field_number(tree, x, field, &vector->x, error) && field_number(tree, y, field, &vector->y, error);
}

static bool not_whole(const YamlTree *tree, int node, const Field *field, const char *got, Error *error) {
    return yaml_error(tree, node, error, "%s must be a whole number from %d to %d (got %s)", field->key,
                      (int)field->range->minimum, (int)field->range->maximum, got);
}

bool field_int(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    int64_t value, minimum = (int64_t)field->range->minimum, maximum = (int64_t)field->range->maximum;
    double full;
    if (is_scalar(tree, node) && parse_int(yaml_text(tree, node), minimum, maximum, &value)) {
        *(int *)member = (int)value;
        return true;
    }
    if (!chain_is(tree, node)) return not_whole(tree, node, field, yaml_show(tree, node).text, error);
    if (!chain_read(tree, node, field->key, &full, error)) return false;
    if (full != floor(full) || full < (double)minimum || full > (double)maximum)
        return not_whole(tree, node, field, chain_show(tree, node, full).text, error);
    *(int *)member = (int)full;
    return true;
}

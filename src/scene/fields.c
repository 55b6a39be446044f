/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads mappings by tables of keys, and the types of values that the tables share. */
#include "scene/fields.h"

#include "common/names.h"
#include "scene/scene.h"

#include "common/parse.h"
#include "common/vec2.h"
#include "scene/chain.h"
#include "scene/nearest.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

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

/* The known key that is nearest to a mistyped one, or NULL. */
static const char *nearest_key(const Field *fields, const char *key) {
    const char *keys[FIELDS_MAX];
    int count = 0;
    for (const Field *field = fields; field->key != NULL; field++) keys[count++] = field->key;
    return nearest_word(key, keys, count);
}

static bool unknown_key(const YamlTree *tree, int node, const char *what, const Field *fields, Error *error) {
    YamlShown shown = yaml_show(tree, node);
    const char *nearest = nearest_key(fields, yaml_text(tree, node));
    if (nearest != NULL)
        return yaml_error(tree, node, error, "'%s' is not a key of %s; did you mean '%s'?", shown.text, what, nearest);
    NameList known = {0};
    for (const Field *field = fields; field->key != NULL; field++) name_list_add(&known, field->key);
    return yaml_error(tree, node, error, "'%s' is not a key of %s; known: %s", shown.text, what, known.text);
}

static const Field *find_field(const Field *fields, const char *key) {
    while (fields->key != NULL && strcmp(fields->key, key) != 0) fields++;
    return fields->key == NULL ? NULL : fields;
}

int fields_node(const Field *fields, const int nodes[FIELDS_MAX], const char *key) {
    return nodes[find_field(fields, key) - fields];
}

static bool all_there(const YamlTree *tree, int node, const char *what, const Field *fields, const int *nodes,
                      Error *error) {
    for (int i = 0; fields[i].key != NULL; i++)
        if (fields[i].required && nodes[i] == 0)
            return yaml_error(tree, node, error, "%s needs the key '%s'", what, fields[i].key);
    return true;
}

bool fields_read(const YamlTree *tree, int node, const char *what, const Field *fields, void *target,
                 int nodes[FIELDS_MAX], Error *error) {
    memset(nodes, 0, FIELDS_MAX * sizeof *nodes);
    if (tree->nodes[node].kind != YAML_MAPPING)
        return yaml_error(tree, node, error, "%s must be a mapping of keys to values (got %s)", what,
                          yaml_show(tree, node).text);
    for (int key = node + 1; key < tree->nodes[node].end;) {
        if (tree->nodes[key].kind != YAML_SCALAR || yaml_text(tree, key)[0] == '\0')
            return yaml_error(tree, key, error, "a key must be a word");
        int value = key + 1;
        const Field *field = find_field(fields, yaml_text(tree, key));
        if (field == NULL) return unknown_key(tree, key, what, fields, error);
        if (nodes[field - fields] != 0) return yaml_error(tree, key, error, "key '%s' is given twice", field->key);
        nodes[field - fields] = value;
        if (!field->parse(tree, value, field, (char *)target + field->offset, error)) return false;
        key = tree->nodes[value].end;
    }
    return all_there(tree, node, what, fields, nodes, error);
}

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

bool field_switch(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes"};
    for (size_t i = 0; is_scalar(tree, node) && i < sizeof words / sizeof *words; i++) {
        if (strcmp(yaml_text(tree, node), words[i]) != 0) continue;
        *(bool *)member = i % 2 == 1;
        return true;
    }
    return yaml_error(tree, node, error, "%s must be on or off (got %s)", field->key, yaml_show(tree, node).text);
}

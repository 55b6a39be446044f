/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the list of bodies: single bodies and patterns. */
#include "scene/scene_bodies.h"

#include "common/array.h"
#include "scene/pattern.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

static bool field_pattern(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    bool scalar = tree->nodes[node].kind == YAML_SCALAR;
    for (const PatternKind *const *kind = pattern_kinds; scalar && *kind != NULL; kind++) {
        if (strcmp(yaml_text(tree, node), (*kind)->name) != 0) continue;
        *(const PatternKind **)member = *kind;
        return true;
    }
    return yaml_error(tree, node, error, "%s must be row, stack or pyramid (got %s)", field->key,
                      yaml_show(tree, node).text);
}

static const Range range_count = {1, SCENE_MAX_BODIES, ""};
static const Range range_until = {1, SCENE_MAX_FRAMES, ""};

enum { SIZE, STATIC, MASS, POSITION, ANGLE, VELOCITY, SPIN, UNTIL, FRICTION, PATTERN, COUNT, SPACING };

static const Field body_fields[] = {
    [SIZE] = {"size", field_vector, offsetof(Pattern, first.size), &range_size, true},
    [STATIC] = {"static", field_switch, offsetof(Pattern, first.fixed), NULL, false},
    [MASS] = {"mass", field_number, offsetof(Pattern, first.mass), &range_mass, false},
    [POSITION] = {"position", field_vector, offsetof(Pattern, first.position), &range_position, true},
    [ANGLE] = {"angle", field_number, offsetof(Pattern, first.angle), &range_angle, false},
    [VELOCITY] = {"velocity", field_vector, offsetof(Pattern, first.velocity), &range_speed, false},
    [SPIN] = {"spin", field_number, offsetof(Pattern, first.angular_velocity), &range_spin, false},
    [UNTIL] = {"until", field_int, offsetof(Pattern, until), &range_until, false},
    [FRICTION] = {"friction", field_number, offsetof(Pattern, first.friction), &range_friction, false},
    [PATTERN] = {"pattern", field_pattern, offsetof(Pattern, kind), NULL, false},
    [COUNT] = {"count", field_int, offsetof(Pattern, count), &range_count, false},
    [SPACING] = {"spacing", field_vector, offsetof(Pattern, spacing), &range_position, false},
    {NULL, NULL, 0, NULL, false}};

/* Checks that involve several keys. */
static bool check_keys(const YamlTree *tree, int node, const Pattern *pattern, const int *nodes, Error *error) {
    bool fixed = pattern->first.fixed, mass = nodes[MASS] != 0;
    if (fixed && mass) return yaml_error(tree, nodes[MASS], error, "a static body must not have a mass");
    if (!fixed && !mass) return yaml_error(tree, node, error, "a body needs the key 'mass', or 'static: true'");
    for (int moving = VELOCITY; fixed && moving <= UNTIL; moving++)
        if (nodes[moving] != 0)
            return yaml_error(tree, nodes[moving], error, "a static body must not have the key '%s'",
                              body_fields[moving].key);
    if (pattern->kind != NULL && nodes[UNTIL] != 0)
        return yaml_error(tree, nodes[UNTIL], error, "until is only for a single body, not for a pattern");
    for (int key = COUNT; key <= SPACING; key++) {
        if (pattern->kind == NULL && nodes[key] != 0)
            return yaml_error(tree, nodes[key], error, "%s needs the key 'pattern' beside it", body_fields[key].key);
        if (pattern->kind != NULL && nodes[key] == 0)
            return yaml_error(tree, node, error, "a pattern needs the key '%s'", body_fields[key].key);
    }
    return true;
}

static bool read_entry(const YamlTree *tree, int node, Pattern *pattern, int *nodes, Error *error) {
    *pattern = (Pattern){.first.friction = DEFAULT_FRICTION};
    return fields_read(tree, node, "a body", body_fields, pattern, nodes, error) &&
           check_keys(tree, node, pattern, nodes, error);
}

static bool within(float value) { return fabsf(value) <= range_position.maximum; }

/* Appends the entry's bodies. `place` is the node for errors: too many bodies, or too far away. */
static bool add_bodies(const YamlTree *tree, int place, const Pattern *pattern, Scene *scene, size_t *capacity,
                       Error *error) {
    int64_t count = pattern_body_count(pattern);
    if (count > SCENE_MAX_BODIES - scene->body_count)
        return yaml_error(tree, place, error, "a scene must have at most %d bodies (got %lld)", SCENE_MAX_BODIES,
                          (long long)scene->body_count + count);
    void *bodies = scene->bodies;
    bool room = array_reserve(&bodies, capacity, (size_t)(scene->body_count + count), sizeof *scene->bodies);
    scene->bodies = bodies;
    if (!room) return error_memory(error, tree->source.path);
    for (int64_t i = 0; i < count; i++) {
        BodyDef body = pattern_body(pattern, i);
        if (!within(body.position.x) || !within(body.position.y))
            return yaml_error(tree, place, error, "body %lld of the pattern is at (%g, %g), beyond %g m", (long long)i,
                              (double)body.position.x, (double)body.position.y, (double)range_position.maximum);
        scene->bodies[scene->body_count++] = body;
    }
    return true;
}

bool field_bodies(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const YamlNode *list = &tree->nodes[node];
    if (list->kind != YAML_SEQUENCE || list->count == 0)
        return yaml_error(tree, node, error, "%s must be a list of at least one body (got %s)", field->key,
                          list->kind == YAML_SEQUENCE ? "none" : yaml_show(tree, node).text);
    size_t capacity = 0;
    for (int entry = node + 1; entry < list->end; entry = tree->nodes[entry].end) {
        Pattern pattern;
        int nodes[FIELDS_MAX];
        if (!read_entry(tree, entry, &pattern, nodes, error)) return false;
        if (pattern.until > 0 && tree->nodes[entry].end < list->end)
            return yaml_error(tree, nodes[UNTIL], error, "only the last body may have an until");
        ((Scene *)member)->last_body_until = pattern.until;
        int place = nodes[COUNT] != 0 ? nodes[COUNT] : entry;
        if (!add_bodies(tree, place, &pattern, member, &capacity, error)) return false;
    }
    return true;
}

/* The value's node of a key of the last body. */
static int last_body_node(const YamlTree *tree, int node, const char *key) {
    int entry = node + 1;
    while (tree->nodes[entry].end < tree->nodes[node].end) entry = tree->nodes[entry].end;
    int at = entry + 1;
    while (strcmp(yaml_text(tree, at), key) != 0) at = tree->nodes[at + 1].end;
    return at + 1;
}

bool bodies_check_until(const YamlTree *tree, int node, const Scene *scene, Error *error) {
    int until = last_body_node(tree, node, body_fields[UNTIL].key);
    if (scene->bomb.present) return yaml_error(tree, until, error, "until cannot be combined with a bomb");
    return scene->last_body_until <= scene->frames ||
           yaml_error(tree, until, error, "until %d is after the last frame (frames: %d)", scene->last_body_until,
                      scene->frames);
}

int bodies_entry(const YamlTree *tree, int node, int index) {
    int entry = node + 1;
    for (int64_t last = -1;; entry = tree->nodes[entry].end) {
        Pattern pattern;
        int nodes[FIELDS_MAX];
        Error none = {0};
        if (!read_entry(tree, entry, &pattern, nodes, &none)) return entry;
        last += pattern_body_count(&pattern);
        if (index <= last || tree->nodes[entry].end == tree->nodes[node].end) return entry;
    }
}

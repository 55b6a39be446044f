/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the bomb and its family of launches. */
#include "scene/scene_bomb.h"

#include "scene/scene.h"
#include "scene/scene_bodies.h"

#include <math.h>

static const Range range_impact_frames = {1, SCENE_MAX_FRAMES, ""};
static const Range range_bomb_frame = {0, SCENE_MAX_FRAMES, ""};

/* Either [vx, vy] or the mapping {times_position: 1/s}. */
static bool field_bomb_velocity(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const Field law[] = {
        {"times_position", field_number, offsetof(SceneBomb, velocity_factor), &range_rate, true},
        {NULL, NULL, 0, NULL, false}};
    SceneBomb *bomb = member;
    bomb->velocity_from_position = tree->nodes[node].kind == YAML_MAPPING;
    int nodes[FIELDS_MAX];
    if (bomb->velocity_from_position) return fields_read(tree, node, "a velocity law", law, bomb, nodes, error);
    return field_vector(tree, node, field, &bomb->body.velocity, error);
}

/* SceneSpan: a number, or the mapping {from: A, to: B, value: V}; the default of V is the middle. */
static bool field_span(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    enum { FROM, TO, VALUE };
    const Field fields[] = {[FROM] = {"from", field_number, offsetof(SceneSpan, from), field->range, true},
                            [TO] = {"to", field_number, offsetof(SceneSpan, to), field->range, true},
                            [VALUE] = {"value", field_number, offsetof(SceneSpan, value), field->range, false},
                            {NULL, NULL, 0, NULL, false}};
    SceneSpan *span = member;
    int nodes[FIELDS_MAX];
    if (tree->nodes[node].kind != YAML_MAPPING) {
        if (!field_number(tree, node, field, &span->value, error)) return false;
        span->from = span->to = span->value;
        return true;
    }
    if (!fields_read(tree, node, "a family of launches", fields, span, nodes, error)) return false;
    if (!(span->from < span->to))
        return yaml_error(tree, nodes[FROM], error, "%s: from must be less than to (got %g and %g)", field->key,
                          (double)span->from, (double)span->to);
    if (nodes[VALUE] == 0) span->value = (float)(0.5 * ((double)span->from + (double)span->to));
    if (span->from <= span->value && span->value <= span->to) return true;
    return yaml_error(tree, nodes[VALUE], error, "%s: value must be from %g to %g (got %g)", field->key,
                      (double)span->from, (double)span->to, (double)span->value);
}

static const Field bomb_fields[] = {
    {"x", field_span, offsetof(SceneBomb, x), &range_position, true},
    {"y", field_number, offsetof(SceneBomb, body.position.y), &range_position, true},
    {"size", field_vector, offsetof(SceneBomb, body.size), &range_size, true},
    {"mass", field_span, offsetof(SceneBomb, mass), &range_mass, true},
    {"friction", field_number, offsetof(SceneBomb, body.friction), &range_friction, false},
    {"rotation", field_span, offsetof(SceneBomb, rotation), &range_angle, false},
    {"spin", field_span, offsetof(SceneBomb, spin), &range_spin, false},
    {"frame", field_int, offsetof(SceneBomb, frame), &range_bomb_frame, false},
    {"velocity", field_bomb_velocity, 0, &range_speed, false},
    {"impact_frames", field_int, offsetof(SceneBomb, impact_frames), &range_impact_frames, false},
    {NULL, NULL, 0, NULL, false}};

/* The start velocity of the launches is largest at an end of x. */
static bool check_velocity(const YamlTree *tree, int node, Scene scene, Error *error) {
    const float ends[] = {scene.bomb.x.value, scene.bomb.x.from, scene.bomb.x.to};
    for (int i = 0; i < 3; i++) {
        scene.bomb.body.position.x = ends[i];
        const Vec2 velocity = scene_bomb_body(&scene).velocity;
        if (fmaxf(fabsf(velocity.x), fabsf(velocity.y)) > range_speed.maximum)
            return yaml_error(tree, node, error,
                              "the bomb's start velocity is (%g, %g) m/s; the largest allowed component is %g",
                              (double)velocity.x, (double)velocity.y, (double)range_speed.maximum);
    }
    return true;
}

bool field_bomb(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    (void)field;
    Scene *scene = member;
    SceneBomb *bomb = &scene->bomb;
    *bomb = (SceneBomb){.present = true, .body.friction = DEFAULT_FRICTION, .impact_frames = SCENE_IMPACT_FRAMES};
    int nodes[FIELDS_MAX];
    if (!fields_read(tree, node, "a bomb", bomb_fields, bomb, nodes, error)) return false;
    bomb->body.position.x = bomb->x.value;
    bomb->body.angle = bomb->rotation.value;
    bomb->body.angular_velocity = bomb->spin.value;
    bomb->body.mass = bomb->mass.value;
    return check_velocity(tree, fields_node(bomb_fields, nodes, "velocity"), *scene, error);
}

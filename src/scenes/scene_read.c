/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a scene from YAML: all its keys. */
#include "base/base.h"
#include "base/file.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "scenes/scenes_internal.h"
#include "scenes/scenes.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_FRICTION 0.2f /* of Box2D-Lite */

/* The types of values that the tables of a scene share. */

static const Range range_size = {1e-3f, 1e4f, " m"};
const Range range_mass = {1e-6f, 1e9f, " kg"};
const Range range_position = {-SCENE_MAX_POSITION, SCENE_MAX_POSITION, " m"};
const Range range_angle = {-1e4f, 1e4f, " rad"};
const Range range_speed = {-1e4f, 1e4f, " m/s"};
const Range range_spin = {-1e4f, 1e4f, " rad/s"};
static const Range range_friction = {0, 10, ""};
static const Range range_gravity = {-1e4f, 1e4f, " m/s^2"};
static const Range range_dt = {SCENE_MIN_DT, SCENE_MAX_DT, " s"};
static const Range range_rate = {-1e4f, 1e4f, " 1/s"};

static bool is_scalar(const YamlTree *tree, int node) { return tree->nodes[node].kind == YAML_SCALAR; }

/* float; float32 nearest to the decimal, a fraction such as 1/60, or an expression. */
static bool field_number(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    float value;
    double full;
    const Range *range = field->range;
    /* A decimal and a fraction of two are rounded as everywhere else; an expression is rounded once, at its end. */
    if (is_scalar(tree, node) && parse_float(yaml_text(tree, node), &value))
        full = (double)value;
    else if (expression_read(tree, node, field->key, &full, error))
        value = (float)full;
    else
        return false;
    if (range->minimum > 0 && value <= 0)
        return yaml_error(tree, node, error, "%s must be greater than 0 (got %s)", field->key,
                          expression_show(tree, node, full, range->unit).text);
    if (value < range->minimum || value > range->maximum)
        return yaml_error(tree, node, error, "%s must be from %g to %g%s (got %s)", field->key, (double)range->minimum,
                          (double)range->maximum, range->unit, expression_show(tree, node, full, range->unit).text);
    *(float *)member = value;
    return true;
}

/* Vec2: a list of two numbers. */
static bool field_vector(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
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

/* int; digits, or an expression whose value is whole. */
static bool field_int(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    int64_t value, minimum = (int64_t)field->range->minimum, maximum = (int64_t)field->range->maximum;
    double full;
    if (is_scalar(tree, node) && parse_int(yaml_text(tree, node), minimum, maximum, &value)) {
        *(int *)member = (int)value;
        return true;
    }
    if (!expression_is(tree, node)) return not_whole(tree, node, field, yaml_show(tree, node).text, error);
    if (!expression_read(tree, node, field->key, &full, error)) return false;
    if (full != floor(full) || full < (double)minimum || full > (double)maximum)
        return not_whole(tree, node, field, expression_show(tree, node, full, "").text, error);
    *(int *)member = (int)full;
    return true;
}

/* Reads the list of bodies: single bodies and patterns. */

typedef enum PatternKind { ONE_BODY, ROW, STACK, PYRAMID } PatternKind;

/* One entry of a scene's bodies: a single body, or a pattern of equal bodies. */
typedef struct Pattern {
    PatternKind kind;
    int count;     /* bodies of a row or a stack, rows of a pyramid */
    Vec2 spacing;  /* m */
    int until;     /* the step after which a single body is removed; 0: never */
    BodyDef first; /* the first body; the others differ from it by their position only */
    BodyName name; /* of each; may be empty */
} Pattern;

static int64_t count_bodies(const Pattern *pattern) {
    const int64_t count = pattern->count;
    return pattern->kind == ONE_BODY ? 1 : pattern->kind == PYRAMID ? count * (count + 1) / 2 : count;
}

/* Every position is computed in float32 from the first one and not from its neighbour, so that rounding does not add
   up. A pyramid goes row by row from below, each from left to right; a row has one body less than the row below it and
   begins half a spacing further right. */
static BodyDef pattern_body(const Pattern *pattern, int64_t i) {
    BodyDef body = pattern->first;
    const Vec2 first = body.position, spacing = pattern->spacing;
    int row = 0;
    if (pattern->kind == PYRAMID) {
        for (; i >= pattern->count - row; row++) i -= pattern->count - row;
        body.position =
            vec2(first.x + 0.5f * spacing.x * (float)row + spacing.x * (float)i, first.y + spacing.y * (float)row);
    } else if (pattern->kind != ONE_BODY) {
        body.position = vec2(first.x + spacing.x * (float)i, first.y + spacing.y * (float)i);
    }
    return body;
}

static bool field_body_name(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = is_scalar(tree, node) ? yaml_text(tree, node) : "";
    if (text[0] == '\0' || strlen(text) >= SCENE_BODY_NAME_SIZE || control_in_text(text) != 0)
        return yaml_error(tree, node, error, "%s must be a text of 1 to %d bytes without control characters (got %s)",
                          field->key, SCENE_BODY_NAME_SIZE - 1, yaml_show(tree, node).text);
    strcpy(((BodyName *)member)->text, text);
    return true;
}

static bool field_pattern(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const char *const names[] = {[ROW] = "row", [STACK] = "stack", [PYRAMID] = "pyramid"};
    PatternKind *kind = member;
    for (*kind = ROW; is_scalar(tree, node) && *kind <= PYRAMID; (*kind)++)
        if (strcmp(yaml_text(tree, node), names[*kind]) == 0) return true;
    return yaml_error(tree, node, error, "%s must be row, stack or pyramid (got %s)", field->key,
                      yaml_show(tree, node).text);
}

static const Range range_count = {1, SCENE_MAX_BODIES, ""};
static const Range range_until = {1, SCENE_MAX_FRAMES, ""};

enum { SIZE, STATIC, MASS, POSITION, ANGLE, VELOCITY, SPIN, UNTIL, FRICTION, NAME, PATTERN, COUNT, SPACING };

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
    [NAME] = {"name", field_body_name, offsetof(Pattern, name), NULL, false},
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
    if (pattern->kind != ONE_BODY && nodes[UNTIL] != 0)
        return yaml_error(tree, nodes[UNTIL], error, "until is only for a single body, not for a pattern");
    for (int key = COUNT; key <= SPACING; key++) {
        if (pattern->kind == ONE_BODY && nodes[key] != 0)
            return yaml_error(tree, nodes[key], error, "%s needs the key 'pattern' beside it", body_fields[key].key);
        if (pattern->kind != ONE_BODY && nodes[key] == 0)
            return yaml_error(tree, node, error, "a pattern needs the key '%s'", body_fields[key].key);
    }
    return true;
}

static bool read_entry(const YamlTree *tree, int node, Pattern *pattern, int *nodes, Error *error) {
    *pattern = (Pattern){.first.friction = DEFAULT_FRICTION};
    return fields_read(tree, node, "a body", body_fields, pattern, nodes, error) &&
           check_keys(tree, node, pattern, nodes, error);
}

static bool is_within(float value) { return fabsf(value) <= range_position.maximum; }

/* Appends the entry's bodies. `place` is the node for errors: too many bodies, or too far away. */
static bool add_bodies(const YamlTree *tree, int place, const Pattern *pattern, Scene *scene, size_t *capacity,
                       Error *error) {
    int64_t count = count_bodies(pattern);
    if (count > SCENE_MAX_BODIES - scene->body_count)
        return yaml_error(tree, place, error, "a scene must have at most %d bodies (got %lld)", SCENE_MAX_BODIES,
                          (long long)scene->body_count + count);
    void *bodies = scene->bodies;
    bool room = array_reserve(&bodies, capacity, (size_t)(scene->body_count + count), sizeof *scene->bodies);
    scene->bodies = bodies;
    if (!room) return error_memory(error, tree->source.path);
    for (int64_t i = 0; i < count; i++) {
        BodyDef body = pattern_body(pattern, i);
        if (!is_within(body.position.x) || !is_within(body.position.y))
            return yaml_error(tree, place, error, "body %lld of the pattern is at (%g, %g), beyond %g m", (long long)i,
                              (double)body.position.x, (double)body.position.y, (double)range_position.maximum);
        scene->bodies[scene->body_count++] = body;
    }
    if (scene->names == NULL && pattern->name.text[0] == '\0') return true;
    /* The names, which begin with the first that is given. And one more: realloc() to nothing may return NULL. */
    const int first = scene->body_count - (int)count;
    BodyName *names = realloc(scene->names, ((size_t)scene->body_count + 1) * sizeof *names);
    if (names == NULL) return error_memory(error, tree->source.path);
    if (scene->names == NULL) memset(names, 0, (size_t)first * sizeof *names);
    scene->names = names;
    for (int i = first; i < scene->body_count; i++) names[i] = pattern->name;
    return true;
}

/* Fills bodies and body_count of the Scene that member points to. */
static bool field_bodies(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
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

int bodies_entry(const YamlTree *tree, int node, int index) {
    int entry = node + 1;
    for (int64_t last = -1;; entry = tree->nodes[entry].end) {
        Pattern pattern;
        int nodes[FIELDS_MAX];
        Error none = {0};
        if (!read_entry(tree, entry, &pattern, nodes, &none)) return entry;
        last += count_bodies(&pattern);
        if (index <= last || tree->nodes[entry].end == tree->nodes[node].end) return entry;
    }
}

/* Reads the bomb and its family of launches. */

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
    return field_vector(tree, node, field, &bomb->velocity, error);
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
    {"y", field_number, offsetof(SceneBomb, y), &range_position, true},
    {"size", field_vector, offsetof(SceneBomb, size), &range_size, true},
    {"mass", field_span, offsetof(SceneBomb, mass), &range_mass, true},
    {"friction", field_number, offsetof(SceneBomb, friction), &range_friction, false},
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
        scene.bomb.x.value = ends[i];
        const Vec2 velocity = scene_bomb_body(&scene).velocity;
        if (fmaxf(fabsf(velocity.x), fabsf(velocity.y)) > range_speed.maximum)
            return yaml_error(tree, node, error,
                              "the bomb's start velocity is (%g, %g) m/s; the largest allowed component is %g",
                              (double)velocity.x, (double)velocity.y, (double)range_speed.maximum);
    }
    return true;
}

/* Fills the bomb of the Scene that member points to. */
static bool field_bomb(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    (void)field;
    Scene *scene = member;
    SceneBomb *bomb = &scene->bomb;
    *bomb = (SceneBomb){.present = true, .friction = DEFAULT_FRICTION, .impact_frames = SCENE_IMPACT_FRAMES};
    int nodes[FIELDS_MAX];
    if (!fields_read(tree, node, "a bomb", bomb_fields, bomb, nodes, error)) return false;
    bomb->own_mass = bomb->mass.value;
    return check_velocity(tree, fields_node(bomb_fields, nodes, "velocity"), *scene, error);
}

/* Reads a scene from YAML by tables of keys. */

static const Range range_iterations = {1, SCENE_MAX_ITERATIONS, ""};
static const Range range_frames = {1, SCENE_MAX_FRAMES, ""};

static bool field_camera(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    (void)field;
    static const Field fields[] = {{"center", field_vector, offsetof(Scene, camera_center), &range_position, true},
                                   {"size", field_vector, offsetof(Scene, camera_size), &range_size, true},
                                   {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    return fields_read(tree, node, "a camera", fields, member, nodes, error);
}

static bool field_networks(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Scene *scene = member;
    if (tree->nodes[node].kind != YAML_MAPPING)
        return yaml_error(tree, node, error, "%s must be a mapping of methods to files (got %s)", field->key,
                          yaml_show(tree, node).text);
    for (int key = node + 1; key < tree->nodes[node].end;) {
        int value = tree->nodes[key].end;
        if (scene->network_count == SCENE_MAX_NETWORKS)
            return yaml_error(tree, key, error, "a scene must have at most %d networks", SCENE_MAX_NETWORKS);
        SceneNetwork *network = &scene->networks[scene->network_count];
        /* Letters, digits and dashes, as in all methods' names. */
        const char *method = is_scalar(tree, key) ? yaml_text(tree, key) : "";
        const size_t length = strspn(method, "abcdefghijklmnopqrstuvwxyz0123456789-");
        if (length == 0 || method[length] != '\0' || length >= SCENE_NAME_SIZE)
            return yaml_error(tree, key, error, "a method's name must consist of a-z, 0-9 and - (got %s)",
                              yaml_show(tree, key).text);
        memcpy(network->method, method, length + 1);
        const char *file = is_scalar(tree, value) ? yaml_text(tree, value) : "";
        bool plain = file[0] != '\0';
        for (const char *c = file; plain && *c != '\0'; c++) plain = (unsigned char)*c >= 0x20 && *c != 0x7f;
        if (!plain)
            return yaml_error(tree, value, error, "a network must be the path of a file (got %s)",
                              yaml_show(tree, value).text);
        const int folder = file[0] == '/' ? 0 : (int)file_folder_length(tree->source.path);
        const int size = snprintf(network->path, SCENE_PATH_SIZE, "%.*s%s", folder, tree->source.path, file);
        if (size < 0 || size >= SCENE_PATH_SIZE)
            return yaml_error(tree, value, error, "the path of a network must have at most %d bytes",
                              SCENE_PATH_SIZE - 1);
        if (scene_network(scene, network->method) != NULL)
            return yaml_error(tree, key, error, "key '%s' is given twice", network->method);
        scene->network_count++;
        key = tree->nodes[value].end;
    }
    return true;
}

/* They are read first, because other numbers may use them. */
static bool field_parameters(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    (void)node, (void)field, (void)error;
    Scene *scene = member;
    const Parameters *parameters = tree->context;
    scene->parameter_count = parameters->count;
    memcpy(scene->parameters, parameters->items, sizeof scene->parameters);
    return true;
}

static const Field scene_fields[] = {
    {"gravity", field_vector, offsetof(Scene, gravity), &range_gravity, true},
    {"dt", field_number, offsetof(Scene, dt), &range_dt, true},
    {"iterations", field_int, offsetof(Scene, iterations), &range_iterations, true},
    {"warm_starting", field_switch, offsetof(Scene, warm_starting), NULL, false},
    {"accumulate_impulses", field_switch, offsetof(Scene, accumulate_impulses), NULL, false},
    {"position_correction", field_switch, offsetof(Scene, position_correction), NULL, false},
    {"frames", field_int, offsetof(Scene, frames), &range_frames, true},
    {"overlaps", field_overlaps, offsetof(Scene, overlaps_allowed), NULL, false},
    {"camera", field_camera, 0, NULL, false},
    {"bodies", field_bodies, 0, NULL, true},
    {"bomb", field_bomb, 0, NULL, false},
    {"networks", field_networks, 0, NULL, false},
    {"parameters", field_parameters, 0, NULL, false},
    {NULL, NULL, 0, NULL, false}};

static bool read_tree(YamlTree *tree, Scene *scene, const SceneSetting *settings, int count, Error *error) {
    Parameters parameters;
    int nodes[FIELDS_MAX];
    if (!parameters_read(&parameters, tree, error) ||
        !parameters_set(&parameters, tree->source.path, settings, count, error))
        return false;
    tree->context = &parameters;
    if (!fields_read(tree, 0, "a scene", scene_fields, scene, nodes, error) ||
        !common_set(scene, tree->source.path, settings, count, error))
        return false;
    const int bodies = fields_node(scene_fields, nodes, "bodies"), bomb = fields_node(scene_fields, nodes, "bomb");
    if (scene->last_body_until > 0) {
        /* The body is removed within the run, and there is no bomb, which would take its index. */
        int entry = bodies + 1;
        while (tree->nodes[entry].end < tree->nodes[bodies].end) entry = tree->nodes[entry].end;
        int key = entry + 1;
        while (strcmp(yaml_text(tree, key), body_fields[UNTIL].key) != 0) key = tree->nodes[key + 1].end;
        if (scene->bomb.present) return yaml_error(tree, key + 1, error, "until cannot be combined with a bomb");
        if (scene->last_body_until > scene->frames)
            return yaml_error(tree, key + 1, error, "until %d is after the last frame (frames: %d)",
                              scene->last_body_until, scene->frames);
    }
    if (scene->bomb.present && scene->bomb.frame > scene->frames)
        return yaml_error(tree, bomb, error, "the bomb's frame %d is after the last (frames: %d)", scene->bomb.frame,
                          scene->frames);
    return (scene->overlaps_allowed || overlaps_check(tree, bodies, bomb, scene, error)) &&
           parameters_all_used(&parameters, tree, error);
}

Scene *scene_read(const char *path, Error *error) { return scene_read_with(path, NULL, 0, error); }

static const char *on(bool value) { return value ? "on" : "off"; }

static void trace(const Scene *scene) {
    trace_line("scene %s: %d bodies%s, %d steps of %g s, %d iterations, warm starting %s, accumulated impulses %s, "
               "position correction %s, hash %016" PRIx64,
               scene->name, scene->body_count, scene->bomb.present ? " and a bomb" : "", scene->frames,
               (double)scene->dt, scene->iterations, on(scene->warm_starting), on(scene->accumulate_impulses),
               on(scene->position_correction), scene_hash(scene));
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        trace_line("scene %s: %s=%g%s%s", scene->name, parameter->name, parameter->value,
                   parameter->unit[0] != '\0' ? " " : "", parameter->unit);
    }
}

Scene *scene_of_tree(YamlTree *tree, const SceneSetting *settings, int count, Error *error) {
    const char *path = tree->source.path;
    char file[NAME_MAX + 1];
    Scene *scene = calloc(1, sizeof *scene);
    if (scene == NULL) return error_memory(error, path), NULL;
    scene->warm_starting = scene->accumulate_impulses = scene->position_correction = true;
    /* The name is used in captions and file names, so it must be printable. */
    snprintf(file, sizeof file, "%s", path_is_standard(path) ? "stdin" : path + file_folder_length(path));
    char *ending = strrchr(file, '.');
    if (ending != NULL && ending != file) *ending = '\0';
    source_printable(scene->name, sizeof scene->name, file);
    const bool ok = read_tree(tree, scene, settings, count, error);
    tree->context = NULL;
    if (ok) {
        trace(scene);
        return scene;
    }
    scene_destroy(scene);
    return NULL;
}

Scene *scene_read_with(const char *path, const SceneSetting *settings, int count, Error *error) {
    YamlTree tree;
    if (!yaml_read(&tree, path, error)) return NULL;
    Scene *scene = scene_of_tree(&tree, settings, count, error);
    yaml_tree_free(&tree);
    return scene;
}

void scene_destroy(Scene *scene) {
    if (scene == NULL) return;
    free(scene->bodies);
    free(scene->names);
    free(scene);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a scene from YAML by tables of keys. */
#include "scene/scene.h"

#include "common/file.h"
#include "common/standard_io.h"
#include "common/trace.h"
#include "scene/parameters.h"
#include "scene/scene_bodies.h"
#include "scene/scene_bomb.h"
#include "scene/scene_overlaps.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Letters, digits and dashes, as in all methods' names. */
static bool copy_method(const YamlTree *tree, int node, char *method, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789-");
    if (length == 0 || text[length] != '\0' || length >= SCENE_NAME_SIZE)
        return yaml_error(tree, node, error, "a method's name must consist of a-z, 0-9 and - (got %s)",
                          yaml_show(tree, node).text);
    memcpy(method, text, length + 1);
    return true;
}

static bool has_control_character(const char *text) {
    for (; *text != '\0'; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f) return true;
    return false;
}

static bool copy_path(const YamlTree *tree, int node, char *path, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    if (text[0] == '\0' || has_control_character(text))
        return yaml_error(tree, node, error, "a network must be the path of a file (got %s)",
                          yaml_show(tree, node).text);
    int folder = text[0] == '/' ? 0 : (int)file_folder_length(tree->source.path);
    int length = snprintf(path, SCENE_PATH_SIZE, "%.*s%s", folder, tree->source.path, text);
    return (length >= 0 && length < SCENE_PATH_SIZE) ||
           yaml_error(tree, node, error, "the path of a network must have at most %d bytes", SCENE_PATH_SIZE - 1);
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
        if (!copy_method(tree, key, network->method, error) || !copy_path(tree, value, network->path, error))
            return false;
        if (scene_network(scene, network->method) != NULL)
            return yaml_error(tree, key, error, "key '%s' is given twice", network->method);
        scene->network_count++;
        key = tree->nodes[value].end;
    }
    return true;
}

/* Parameters are read first, because other numbers may use them. */
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

static bool read_fields(const YamlTree *tree, Scene *scene, Error *error) {
    int nodes[FIELDS_MAX];
    if (!fields_read(tree, 0, "a scene", scene_fields, scene, nodes, error)) return false;
    const int bodies = fields_node(scene_fields, nodes, "bodies"), bomb = fields_node(scene_fields, nodes, "bomb");
    if (scene->last_body_until > 0 && !bodies_check_until(tree, bodies, scene, error)) return false;
    if (scene->bomb.present && scene->bomb.frame > scene->frames)
        return yaml_error(tree, bomb, error, "the bomb's frame %d is after the last (frames: %d)", scene->bomb.frame,
                          scene->frames);
    return scene->overlaps_allowed || overlaps_check(tree, bodies, bomb, scene, error);
}

static bool read_tree(YamlTree *tree, Scene *scene, const SceneSetting *settings, int count, Error *error) {
    Parameters parameters;
    if (!parameters_read(&parameters, tree, error) ||
        !parameters_set(&parameters, tree->source.path, settings, count, error))
        return false;
    tree->context = &parameters;
    bool ok = read_fields(tree, scene, error) && parameters_all_used(&parameters, tree, error);
    tree->context = NULL;
    return ok;
}

/* The name is used in captions and file names, so it must be printable. */
static void name_scene(Scene *scene, const char *path) {
    char file[NAME_MAX + 1];
    snprintf(file, sizeof file, "%s", path_is_standard(path) ? "stdin" : path + file_folder_length(path));
    char *ending = strrchr(file, '.');
    if (ending != NULL && ending != file) *ending = '\0';
    source_printable(scene->name, sizeof scene->name, file);
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

Scene *scene_read_with(const char *path, const SceneSetting *settings, int count, Error *error) {
    YamlTree tree;
    if (!yaml_read(&tree, path, error)) return NULL;
    Scene *scene = calloc(1, sizeof *scene);
    if (scene == NULL) {
        error_memory(error, path);
    } else {
        scene->warm_starting = scene->accumulate_impulses = scene->position_correction = true;
        name_scene(scene, path);
        if (!read_tree(&tree, scene, settings, count, error)) {
            scene_destroy(scene);
            scene = NULL;
        }
    }
    yaml_tree_free(&tree);
    if (scene != NULL) trace(scene);
    return scene;
}

void scene_destroy(Scene *scene) {
    if (scene == NULL) return;
    free(scene->bodies);
    free(scene);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/yaml.h"
#include "scenes/internal.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool field_bound(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    return chain_read(tree, node, field->key, member, error);
}

/* The longest text that source_printable() never cuts. */
enum { UNIT_LENGTH = SCENE_PARAMETER_SIZE - 8 };

static bool field_unit(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    if (text[0] == '\0' || strlen(text) > UNIT_LENGTH)
        return yaml_error(tree, node, error, "%s must be a text of at most %d bytes (got %s)", field->key, UNIT_LENGTH,
                          yaml_show(tree, node).text);
    source_printable(member, SCENE_PARAMETER_SIZE, text);
    return true;
}

enum { VALUE, FROM, TO };

static const Field fields[] = {[VALUE] = {"value", field_bound, offsetof(SceneParameter, value), NULL, true},
                               [FROM] = {"from", field_bound, offsetof(SceneParameter, from), NULL, true},
                               [TO] = {"to", field_bound, offsetof(SceneParameter, to), NULL, true},
                               {"unit", field_unit, offsetof(SceneParameter, unit), NULL, false},
                               {"whole", field_switch, offsetof(SceneParameter, whole), NULL, false},
                               {NULL, NULL, 0, NULL, false}};

static bool copy_name(const YamlTree *tree, int node, char *name, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    size_t length = strspn(text, PARAMETER_LETTERS);
    if (length == 0 || text[length] != '\0' || length >= SCENE_PARAMETER_SIZE)
        return yaml_error(tree, node, error,
                          "a parameter's name must have 1 to %d characters of a-z, 0-9 and _ (got %s)",
                          SCENE_PARAMETER_SIZE - 1, yaml_show(tree, node).text);
    memcpy(name, text, length + 1);
    return true;
}

static bool is_whole(double value) { return value == floor(value); }

/* Checks that involve several keys. */
static bool check(const YamlTree *tree, const int *nodes, const SceneParameter *parameter, Error *error) {
    const double numbers[] = {parameter->value, parameter->from, parameter->to};
    for (int i = VALUE; i <= TO; i++)
        if (parameter->whole && !is_whole(numbers[i]))
            return yaml_error(tree, nodes[i], error, "%s must be a whole number, because whole is on (got %s)",
                              fields[i].key, chain_show(tree, nodes[i], numbers[i]).text);
    return (parameter->value >= parameter->from && parameter->value <= parameter->to) ||
           yaml_error(tree, nodes[VALUE], error, "value must be from %.9g to %.9g (got %s)", parameter->from,
                      parameter->to, chain_show(tree, nodes[VALUE], parameter->value).text);
}

static SceneParameter *find(Parameters *parameters, const char *name) {
    for (int i = 0; i < parameters->count; i++)
        if (strcmp(parameters->items[i].name, name) == 0) return &parameters->items[i];
    return NULL;
}

static bool read_one(Parameters *parameters, const YamlTree *tree, int key, int value, Error *error) {
    if (parameters->count == SCENE_MAX_PARAMETERS)
        return yaml_error(tree, key, error, "a scene must have at most %d parameters", SCENE_MAX_PARAMETERS);
    SceneParameter parameter = {.whole = false};
    int nodes[FIELDS_MAX];
    if (!copy_name(tree, key, parameter.name, error)) return false;
    if (find(parameters, parameter.name) != NULL)
        return yaml_error(tree, key, error, "key '%s' is given twice", parameter.name);
    if (!fields_read(tree, value, "a parameter", fields, &parameter, nodes, error) ||
        !check(tree, nodes, &parameter, error))
        return false;
    parameters->nodes[parameters->count] = key;
    parameters->items[parameters->count++] = parameter;
    return true;
}

/* The value's node of the key `parameters`, 0 if it is missing. The scene's table refuses a second one. */
static int find_node(const YamlTree *tree) {
    bool mapping = tree->nodes[0].kind == YAML_MAPPING;
    for (int key = 1; mapping && key < tree->nodes[0].end;) {
        int value = tree->nodes[key].end;
        if (tree->nodes[key].kind == YAML_SCALAR && strcmp(yaml_text(tree, key), "parameters") == 0) return value;
        key = tree->nodes[value].end;
    }
    return 0;
}

bool parameters_read(Parameters *parameters, const YamlTree *tree, Error *error) {
    *parameters = (Parameters){.count = 0};
    int node = find_node(tree);
    if (node == 0) return true;
    if (tree->nodes[node].kind != YAML_MAPPING)
        return yaml_error(tree, node, error, "parameters must be a mapping of names to values (got %s)",
                          yaml_show(tree, node).text);
    for (int key = node + 1; key < tree->nodes[node].end;) {
        int value = tree->nodes[key].end;
        if (!read_one(parameters, tree, key, value, error)) return false;
        key = tree->nodes[value].end;
    }
    return true;
}

static bool set(Parameters *parameters, const char *path, const SceneSetting *setting, Error *error) {
    SceneParameter *parameter = find(parameters, setting->name);
    if (parameter == NULL)
        return error_input(error, path, "'%s' is not a parameter; %s", setting->name,
                           parameters_hint(parameters, setting->name).text);
    if (!(setting->value >= parameter->from && setting->value <= parameter->to))
        return error_input(error, path, "%s must be from %.9g to %.9g%s%s (set to %.9g)", parameter->name,
                           parameter->from, parameter->to, parameter->unit[0] != '\0' ? " " : "", parameter->unit,
                           setting->value);
    if (parameter->whole && !is_whole(setting->value))
        return error_input(error, path, "%s must be a whole number (set to %.9g)", parameter->name, setting->value);
    parameter->value = setting->value;
    return true;
}

bool parameters_set(Parameters *parameters, const char *path, const SceneSetting *settings, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < i; k++)
            if (strcmp(settings[i].name, settings[k].name) == 0)
                return error_input(error, path, "the parameter '%s' is set twice", settings[i].name);
        if (!set(parameters, path, &settings[i], error)) return false;
    }
    return true;
}

bool parameters_all_used(const Parameters *parameters, const YamlTree *tree, Error *error) {
    for (int i = 0; i < parameters->count; i++)
        if (!parameters->used[i])
            return yaml_error(tree, parameters->nodes[i], error, "no number of the scene uses the parameter '$%s'",
                              parameters->items[i].name);
    return true;
}

ParametersHint parameters_hint(const Parameters *parameters, const char *name) {
    ParametersHint hint;
    NameList known = {0};
    const char *names[SCENE_MAX_PARAMETERS];
    for (int i = 0; i < parameters->count; i++) names[i] = parameters->items[i].name;
    const char *nearest = nearest_word(name, names, parameters->count);
    if (nearest != NULL) {
        snprintf(hint.text, sizeof hint.text, "did you mean '%s'?", nearest);
        return hint;
    }
    for (int i = 0; i < parameters->count; i++) name_list_add(&known, names[i]);
    snprintf(hint.text, sizeof hint.text, "known: %.*s", (int)sizeof hint.text - 8,
             known.used > 0 ? known.text : "none");
    return hint;
}

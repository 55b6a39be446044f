/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key `parameters` of a scene. */
#pragma once
#include "scene/scene.h"
#include "yaml/yaml_tree.h"

#define PARAMETER_LETTERS "abcdefghijklmnopqrstuvwxyz0123456789_"

/* The parameters ($names) of a scene file. */
typedef struct Parameters {
    int count;
    SceneParameter items[SCENE_MAX_PARAMETERS];
    int nodes[SCENE_MAX_PARAMETERS]; /* of their names */
    bool used[SCENE_MAX_PARAMETERS]; /* a number of the file uses it (chain.h) */
} Parameters;

/* Reads the tree's parameters, wherever the key is; a scene may have none. */
bool parameters_read(Parameters *parameters, const YamlTree *tree, Error *error);

/* Sets their values; see scene_read_with(). */
bool parameters_set(Parameters *parameters, const char *path, const SceneSetting *settings, int count, Error *error);

/* Refuses a parameter that no number uses, because setting it would have no effect. */
bool parameters_all_used(const Parameters *parameters, const YamlTree *tree, Error *error);

/* The end of a message on an unknown name: "did you mean 'height'?", "known: height, rate" or "known: none". */
typedef struct ParametersHint {
    char text[SCENE_MAX_PARAMETERS * (SCENE_PARAMETER_SIZE + 2) + 16];
} ParametersHint;
ParametersHint parameters_hint(const Parameters *parameters, const char *name);

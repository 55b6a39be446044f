/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key `parameters` of a scene. */
#pragma once
#include "scene/scene.h"
#include "scene/yaml_tree.h"

#define PARAMETER_LETTERS "abcdefghijklmnopqrstuvwxyz0123456789_"

/* What the $names of a file stand for. */
typedef struct Parameters {
    int count;
    SceneParameter items[SCENE_MAX_PARAMETERS];
    int nodes[SCENE_MAX_PARAMETERS]; /* of their names */
    bool used[SCENE_MAX_PARAMETERS]; /* the file's numbers have it (chain.h) */
} Parameters;

/* Reads what the tree says of its parameters, wherever it does; none is not wrong. */
bool parameters_read(Parameters *parameters, const YamlTree *tree, Error *error);

/* Gives them the values of the settings; see scene_read_with. */
bool parameters_set(Parameters *parameters, const char *path, const SceneSetting *settings, int count, Error *error);

/* Refuses one that no number is made of: it would promise what it does not do. */
bool parameters_all_used(const Parameters *parameters, const YamlTree *tree, Error *error);

/* The end of a message on an unknown name: "did you mean 'height'?", "known: height, rate" or "known: none". */
typedef struct ParametersHint {
    char text[SCENE_MAX_PARAMETERS * (SCENE_PARAMETER_SIZE + 2) + 16];
} ParametersHint;
ParametersHint parameters_hint(const Parameters *parameters, const char *name);

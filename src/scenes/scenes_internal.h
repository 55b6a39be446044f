/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reading of scene files: expressions, parameters, overlaps. */
#pragma once
#include "base/base.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

/* The ranges keep a scene within what float32 can compute: no product of them is infinite, and no inverse. */
extern const Range range_mass, range_position, range_angle, range_speed, range_spin;

/* Expressions: numbers of a scene file made of decimals and $names of the scene's parameters by + - * / and
   parentheses, such as $height + 0.25, with blanks where one likes. Products go before sums, else from left to right.
   The tree's context is the scene's Parameters, or NULL for a scene without. */

/* A file of 1.5 MB has room for 750,000 parentheses. */
enum { EXPRESSION_MAX_PARTS = 32, EXPRESSION_SHOWN_SIZE = 320 };

/* True if the node's text is more than a decimal: it has an operator, a '$' or a parenthesis. */
bool expression_is(const YamlTree *tree, int node);

/* The value of a scalar, in double; a decimal is an expression, too. Refused, with its place: text that is no
   expression, unknown names, more than EXPRESSION_MAX_PARTS numbers, signs and parentheses, division by 0 and infinite
   intermediate results. Names in it are marked as used. */
bool expression_read(const YamlTree *tree, int node, const char *what, double *value, Error *error);

/* A node's number for a message: its text "-1", or "0 kg, from 0*$ratio with ratio = 10". unit: " kg", or "". */
typedef struct ExpressionShown {
    char text[EXPRESSION_SHOWN_SIZE];
} ExpressionShown;
ExpressionShown expression_show(const YamlTree *tree, int node, double value, const char *unit);

/* The key `bodies` of a scene. */

/* The entry of the list `node` that body `index` of the scene comes from. The list must have been read. */
int bodies_entry(const YamlTree *tree, int node, int index);

/* The key `parameters` of a scene. */

#define PARAMETER_LETTERS "abcdefghijklmnopqrstuvwxyz0123456789_"

/* The parameters ($names) of a scene file. */
typedef struct Parameters {
    int count;
    SceneParameter items[SCENE_MAX_PARAMETERS];
    int nodes[SCENE_MAX_PARAMETERS]; /* of their names */
    bool used[SCENE_MAX_PARAMETERS]; /* a number of the file uses it */
} Parameters;

/* Reads the tree's parameters, wherever the key is; a scene may have none. */
bool parameters_read(Parameters *parameters, const YamlTree *tree, Error *error);

/* Sets their values; see scene_read_with(). Leaves what common_set() then sets in the scene that is read. */
bool parameters_set(Parameters *parameters, const char *path, const SceneSetting *settings, int count, Error *error);
bool common_set(Scene *scene, const char *path, const SceneSetting *settings, int count, Error *error);

/* Refuses a parameter that no number uses, because setting it would have no effect. */
bool parameters_all_used(const Parameters *parameters, const YamlTree *tree, Error *error);

/* Refuses bodies that start inside one another. */

/* bool: true for `allowed`, false for `refused`. */
FieldParser field_overlaps;

/* Checks the bodies, and the bomb if it is there from the start. Nodes: the list of bodies, and the bomb (0: none). The
   error is at the entry of the later one, with its index and that of the other. Takes some ms for a structure of 10,000
   boxes. */
bool overlaps_check(const YamlTree *tree, int bodies, int bomb, const Scene *scene, Error *error);

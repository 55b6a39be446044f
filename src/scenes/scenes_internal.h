/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reading of scene files: fields, patterns, expressions, bodies, overlaps. */
#pragma once
#include "base/base.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

/* The types of values in scene files; base/yaml.h reads the mappings. */

/* The ranges keep a scene within what float32 can compute: no product of them is infinite, and no inverse. */
extern const Range range_size, range_mass, range_position, range_angle, range_speed, range_spin, range_friction,
    range_gravity, range_dt, range_rate;

/* float; float32 nearest to the decimal, a fraction such as 1/60, or an expression. */
FieldParser field_number;
/* Vec2: a list of two numbers. */
FieldParser field_vector;
/* int; digits, or an expression whose value is whole. */
FieldParser field_int;

/* One entry of a scene's bodies: a single body, or a pattern of equal bodies. */

/* A kind of pattern. */
typedef struct PatternKind {
    const char *name;
    int64_t (*body_count)(int count);
    Vec2 (*position)(Vec2 first, Vec2 spacing, int count, int64_t i); /* of body i */
} PatternKind;

typedef struct Pattern {
    const PatternKind *kind; /* NULL: one body */
    int count;               /* bodies of a row or a stack, rows of a pyramid */
    Vec2 spacing;            /* m */
    int until;               /* the step after which a single body is removed; 0: never */
    BodyDef first;           /* the first body; the others differ from it by their position only */
    BodyName name;           /* of each; may be empty */
} Pattern;

/* Ended by NULL. */
extern const PatternKind *const pattern_kinds[];

int64_t pattern_body_count(const Pattern *pattern);

BodyDef pattern_body(const Pattern *pattern, int64_t i);

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

/* Default of Box2D-Lite. */
#define DEFAULT_FRICTION 0.2f

/* Fills bodies and body_count of the Scene that member points to. */
FieldParser field_bodies;

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

/* The end of a message on an unknown name: "did you mean 'height'?", "known: height, rate" or "known: none". */
typedef struct ParametersHint {
    char text[SCENE_MAX_PARAMETERS * (SCENE_PARAMETER_SIZE + 2) + 96]; /* and of what every scene has */
} ParametersHint;
ParametersHint parameters_hint(const Parameters *parameters, const char *name);

/* Refuses bodies that start inside one another. */

/* bool: true for `allowed`, false for `refused`. */
FieldParser field_overlaps;

/* Checks the bodies, and the bomb if it is there from the start. Nodes: the list of bodies, and the bomb (0: none). The
   error is at the entry of the later one, with its index and that of the other. Takes some ms for a structure of 10,000
   boxes. */
bool overlaps_check(const YamlTree *tree, int bodies, int bomb, const Scene *scene, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key `bodies` of a scene. */
#pragma once
#include "scene/scene_fields.h"
#include "scene/scene.h"

/* Default of Box2D-Lite. */
#define DEFAULT_FRICTION 0.2f

/* Fills bodies and body_count of the Scene that member points to. */
FieldParser field_bodies;

/* Checks that a body with `until` is removed within the run, and that there is no bomb, which would take its index.
   node: of the bodies. */
bool bodies_check_until(const YamlTree *tree, int node, const Scene *scene, Error *error);

/* The entry of the list `node` that body `index` of the scene comes from. The list must have been read. */
int bodies_entry(const YamlTree *tree, int node, int index);

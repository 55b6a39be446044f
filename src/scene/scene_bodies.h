/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key `bodies` of a scene. */
#pragma once
#include "scene/fields.h"
#include "scene/scene.h"

/* Box2D-Lite's, for bodies that name none. */
#define DEFAULT_FRICTION 0.2f

/* Fills bodies and body_count of the Scene that member points to. */
FieldParser field_bodies;

/* Whether the body that goes does so within the run, and without a bomb, which would take its index. node: of the
   bodies. */
bool bodies_check_until(const YamlTree *tree, int node, const Scene *scene, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refuses bodies that start inside one another. */
#pragma once
#include "collision/overlap.h"
#include "scene/scene_fields.h"
#include "scene/scene.h"

/* bool: true for `allowed`, false for `refused`. */
FieldParser field_overlaps;

/* Checks the bodies, and the bomb if it is there from the start. Nodes: the list of bodies, and the bomb (0: none). The
   error is at the entry of the later one, with its index and that of the other. Takes some ms for a structure of 10,000
   boxes. */
bool overlaps_check(const YamlTree *tree, int bodies, int bomb, const Scene *scene, Error *error);

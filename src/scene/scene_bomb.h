/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key `bomb` of a scene. */
#pragma once
#include "scene/scene_fields.h"

/* Fills the bomb of the Scene that member points to. */
FieldParser field_bomb;

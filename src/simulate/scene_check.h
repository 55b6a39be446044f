/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What reading a scene does not check: its launches, its networks, and its parameters at their ends. */
#pragma once
#include "scene/scene.h"

/* The launch of a single run and those of training and scoring: none puts the bomb inside a body (launch_check.h). */
bool scene_check_launches(const Scene *scene, Error *error);

/* Reads each network that the scene names and runs one step with it, with the bomb and without. */
bool scene_check_networks(const Scene *scene, Error *error);

/* Reads the scene at `path` with each parameter at either end, the others as in the file, and checks the launches. The
   error ends with the parameter: "(with height = 20, an end of its range)". */
bool scene_check_ends(const char *path, const Scene *scene, Error *error);

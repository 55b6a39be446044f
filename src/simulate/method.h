/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method: how a scene is advanced by one step. So far each is a contact solver in the standard step. */
#pragma once
#include "common/settings.h"
#include "dynamics/contact_solver.h"
#include "scene/scene.h"

enum { METHOD_TEXT_SIZE = 128 };

typedef struct Method {
    char text[METHOD_TEXT_SIZE]; /* as given: "engine:k=20" */
    const ContactSolverKind *solver;
    Settings settings;
} Method;

/* Parses `name` or `name:key=value,...`. ERROR_INPUT lists the names or keys there are. */
bool method_parse(Method *method, const char *text, Error *error);

/* Creates the solver of a method for a scene: what the settings leave open, the scene says (iterations,
   accumulated impulses, its network). */
bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error);

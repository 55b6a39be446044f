/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method: how a scene is advanced by one step. Most are a contact solver in the standard step; the others step in
   another way (stepping.h). */
#pragma once
#include "common/settings.h"
#include "simulate/stepping.h"

enum { METHOD_TEXT_SIZE = 128 };

typedef struct Method {
    char text[METHOD_TEXT_SIZE];     /* as given: "engine:k=20" */
    const ContactSolverKind *solver; /* or NULL */
    const SteppingKind *stepping;    /* where solver is NULL */
    Settings settings;
} Method;

/* Parses `name` or `name:key=value,...`. ERROR_INPUT lists the names or keys there are. */
bool method_parse(Method *method, const char *text, Error *error);

/* The method of that name with a network, whatever is in the path. ERROR_INPUT: no such method, or the path is too long. */
bool method_with_network(Method *method, const char *name, const char *path, Error *error);

/* What there is to choose from. */
typedef struct MethodInfo {
    const char *name, *summary;
    const SettingSpec *settings;
} MethodInfo;

/* Method i, counted from 0; false where there are no more. */
bool method_info(int i, MethodInfo *info);

/* Creates the contact solver of a method for a scene: what the settings leave open, the scene says (sweeps,
   accumulated impulses, its network). ERROR_INPUT where the method is none. */
bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error);

/* True where the method needs a network, and neither its settings nor the scene name one. */
bool method_lacks_network(const Method *method, const Scene *scene);

/* A method in use: steps worlds of one scene, whatever the launch, one after the other. */
typedef struct Stepper Stepper;

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error);
void stepper_destroy(Stepper *stepper);

/* Advances the world by the scene's dt; on failure it is unchanged. The step's contact problem and its solution are
   world_problem() and world_solution() then. */
bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error);

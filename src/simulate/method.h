/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method: how a scene is advanced by one step. Most are a contact solver in the standard step; the others step in
   another way (stepping.h). */
#pragma once
#include "simulate/stepping.h"

enum { METHOD_TEXT_SIZE = 128 };

/* A method that can be chosen by name. */
typedef struct MethodKind {
    const MethodDescription *description;
    const ContactSolverKind *solver; /* in the standard step; or NULL */
    const SteppingKind *stepping;    /* if solver is NULL */
} MethodKind;

/* The registry, in the order of lists and charts; ended by a NULL description. */
extern const MethodKind method_kinds[];

/* Its entries, from the list METHODS of solvers/solvers.h. */
#define METHOD_KIND_SOLVER(name) {&solver_##name.description, &solver_##name, NULL},
#define METHOD_KIND_STEPPING(name) {&stepping_##name.description, NULL, &stepping_##name},

/* The description of the method in `name` or `name:key=value,...`; NULL if there is no method of that name. */
const MethodDescription *method_describe(const char *text);

typedef struct Method {
    char text[METHOD_TEXT_SIZE]; /* as given: "engine:k=20" */
    const MethodKind *kind;
    Settings settings;
} Method;

/* Parses `name` or `name:key=value,...`. ERROR_INPUT lists the names or keys there are. */
bool method_parse(Method *method, const char *text, Error *error);

/* The method of that name with a network, whatever is in the path. ERROR_INPUT: no such method, or the path is too long. */
bool method_with_network(Method *method, const char *name, const char *path, Error *error);

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

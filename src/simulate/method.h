/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method: how a scene is advanced by one step. Most methods are a contact solver in the standard step; the others are
   steppers (stepping.h). */
#pragma once
#include "simulate/stepping.h"

enum { METHOD_TEXT_SIZE = 128 };

/* An entry of the registry. */
typedef struct MethodKind {
    const MethodDescription *description;
    const ContactSolverKind *solver; /* used in the standard step; or NULL */
    const SteppingKind *stepping;    /* if solver is NULL */
} MethodKind;

/* The registry, in the order of lists and charts; ended by a NULL description. */
extern const MethodKind method_kinds[];

/* An entry for each line of the list METHODS (solvers/solvers.h). */
#define METHOD_KIND_SOLVER(name) {&solver_##name.description, &solver_##name, NULL},
#define METHOD_KIND_STEPPING(name) {&stepping_##name.description, NULL, &stepping_##name},

/* The description of the method in `name` or `name:key=value,...`; NULL if there is no method of that name. */
const MethodDescription *method_describe(const char *text);

/* The settings of `name:key=value,...`, and what holds where it gives none: k of the scene, whose iterations are 0 if
   they are unknown, or the method's own. False for a text that is no method. */
bool method_all_settings(Settings *settings, const char *text, int iterations);

typedef struct Method {
    char text[METHOD_TEXT_SIZE]; /* as given: "engine:k=20" */
    const MethodKind *kind;
    Settings settings;
} Method;

/* Parses `name` or `name:key=value,...`. ERROR_INPUT: an unknown name or key, with the known ones. */
bool method_parse(Method *method, const char *text, Error *error);

/* The method of that name with a network; the path may contain any character. ERROR_INPUT: unknown method, or the path
   is too long. */
bool method_with_network(Method *method, const char *name, const char *path, Error *error);

/* Creates the contact solver of a method for a scene. The scene sets what the settings leave open: sweeps, accumulated
   impulses, the network. ERROR_INPUT if the method has no contact solver. */
bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error);

/* True if the method needs a network and neither its settings nor the scene name one. */
bool method_lacks_network(const Method *method, const Scene *scene);

/* A method in use. It steps worlds of one scene, with any launch, one world after the other. */
typedef struct Stepper Stepper;

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error);
void stepper_destroy(Stepper *stepper);

/* The description of its method. */
const MethodDescription *stepper_describe(const Stepper *stepper);

/* Advances the world by the scene's dt; on failure the world is unchanged. Afterwards world_problem() and
   world_solution() are those of the step. */
bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/method.h"

#include "common/names.h"
#include "solvers/solvers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const SteppingKind *const stepping_kinds[] = {&stepping_substepping, &stepping_playback, NULL};

bool method_info(int i, MethodInfo *info) {
    int solvers = 0, others = 0;
    for (; solver_kinds[solvers] != NULL; solvers++)
        if (solvers == i) {
            const ContactSolverKind *kind = solver_kinds[i];
            *info = (MethodInfo){kind->name, kind->summary, kind->settings};
            return true;
        }
    for (; stepping_kinds[others] != NULL; others++)
        if (solvers + others == i) {
            const SteppingKind *kind = stepping_kinds[others];
            *info = (MethodInfo){kind->name, kind->summary, kind->settings};
            return true;
        }
    return false;
}

static const SteppingKind *stepping_find(const char *name) {
    for (int i = 0; stepping_kinds[i] != NULL; i++)
        if (strcmp(stepping_kinds[i]->name, name) == 0) return stepping_kinds[i];
    return NULL;
}

static bool unknown_method(const char *text, Error *error) {
    NameList known = {0};
    MethodInfo info;
    for (int i = 0; method_info(i, &info); i++) name_list_add(&known, info.name);
    return error_unknown(error, "method", text, "a method", &known);
}

bool method_parse(Method *method, const char *text, Error *error) {
    if (strlen(text) >= sizeof method->text)
        return error_input(error, text, "a method's text has at most %zu characters", sizeof method->text - 1);
    strcpy(method->text, text);
    size_t length = strcspn(text, ":");
    char name[METHOD_TEXT_SIZE];
    memcpy(name, text, length);
    name[length] = '\0';
    method->solver = solver_find(name);
    method->stepping = stepping_find(name);
    if (method->solver == NULL && method->stepping == NULL) return unknown_method(name, error);
    const SettingSpec *known = method->solver != NULL ? method->solver->settings : method->stepping->settings;
    return settings_parse(&method->settings, text[length] == ':' ? text + length + 1 : "", known, name, error);
}

bool method_with_network(Method *method, const char *name, const char *path, Error *error) {
    return method_parse(method, name, error) && (settings_default(&method->settings, "network", path) ||
                                                 error_input(error, path, "the name is too long for a setting"));
}

static bool has_setting(const ContactSolverKind *kind, const char *key) {
    for (const SettingSpec *spec = kind->settings; spec->key != NULL; spec++)
        if (strcmp(spec->key, key) == 0) return true;
    return false;
}

bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error) {
    if (method->solver == NULL)
        return error_input(error, method->text, "no contact solver, but another way of stepping");
    const ContactSolverKind *kind = method->solver;
    Settings settings = method->settings;
    char iterations[16];
    snprintf(iterations, sizeof iterations, "%d", scene->iterations);
    const struct {
        const char *key, *value;
    } scene_settings[] = {{"k", iterations},
                          {"accumulate", scene->accumulate_impulses ? "on" : "off"},
                          {"network", scene_network(scene, kind->name)}};
    for (size_t i = 0; i < sizeof scene_settings / sizeof scene_settings[0]; i++) {
        if (scene_settings[i].value == NULL || !has_setting(kind, scene_settings[i].key)) continue;
        if (!settings_default(&settings, scene_settings[i].key, scene_settings[i].value))
            return error_input(error, scene->name, "%s does not fit a setting", scene_settings[i].key);
    }
    solver->kind = kind;
    solver->state = kind->create(&settings, error);
    return solver->state != NULL;
}

bool method_lacks_network(const Method *method, const Scene *scene) {
    return method->solver != NULL && has_setting(method->solver, "network") &&
           settings_get(&method->settings, "network") == NULL && scene_network(scene, method->solver->name) == NULL;
}

struct Stepper {
    ContactSolver solver;         /* in the standard step, */
    const SteppingKind *stepping; /* or another way of stepping */
    void *state;
};

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error) {
    Stepper *stepper = calloc(1, sizeof *stepper);
    if (stepper == NULL) {
        error_memory(error, method->text);
        return NULL;
    }
    stepper->stepping = method->stepping;
    if (method->stepping != NULL) {
        stepper->state = method->stepping->create(&method->settings, scene, error);
        if (stepper->state != NULL) return stepper;
    } else if (method_create_solver(method, scene, &stepper->solver, error)) {
        return stepper;
    }
    free(stepper);
    return NULL;
}

void stepper_destroy(Stepper *stepper) {
    if (stepper == NULL) return;
    if (stepper->stepping != NULL)
        stepper->stepping->destroy(stepper->state);
    else
        stepper->solver.kind->destroy(stepper->solver.state);
    free(stepper);
}

/* A contact solver whose cost a step meters. */
typedef struct MeteredSolver {
    const ContactSolver *solver;
    const Step *step;
} MeteredSolver;

static bool solve_metered(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    const MeteredSolver *metered = state;
    step_solving_begins(metered->step);
    bool solved = metered->solver->kind->solve(metered->solver->state, problem, solution, error);
    step_solving_ends(metered->step);
    return solved;
}

static const ContactSolverKind metered_kind = {.name = "metered", .solve = solve_metered};

bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error) {
    if (stepper->stepping != NULL) return stepper->stepping->step(stepper->state, world, step, error);
    MeteredSolver metered = {&stepper->solver, step};
    return world_step(world, &(ContactSolver){&metered_kind, &metered}, step->scene->dt, error);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods by name: the registry, solvers and steppers made from their settings (methods/methods.h). */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The method in `name` or `name:key=value,...`, or NULL. */
static const MethodKind *method_find(const char *text) {
    size_t length = strcspn(text, ":");
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (strlen(kind->description->name) == length && strncmp(kind->description->name, text, length) == 0)
            return kind;
    return NULL;
}

const MethodDescription *method_describe(const char *text) {
    const MethodKind *kind = method_find(text);
    return kind != NULL ? kind->description : NULL;
}

bool method_parse(Method *method, const char *text, Error *error) {
    if (strlen(text) >= sizeof method->text)
        return error_input(error, text, "a method's text has at most %zu characters", sizeof method->text - 1);
    strcpy(method->text, text);
    method->kind = method_find(text);
    if (method->kind == NULL) {
        char name[METHOD_TEXT_SIZE];
        NameList known = {0};
        snprintf(name, sizeof name, "%.*s", (int)strcspn(text, ":"), text);
        for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
            name_list_add(&known, kind->description->name);
        return error_unknown(error, "method", name, "a method", &known);
    }
    const MethodDescription *description = method->kind->description;
    const char *name = description->name, *rest = text + strlen(name); /* "" or ":..." */
    if (!description->external) {
        if (strcmp(rest, ":") == 0) return error_input(error, "method", "'%s' has no setting behind ':'", text);
        return settings_parse(&method->settings, rest + (*rest == ':'), description->settings, name, error);
    }
    /* ":node planck.mjs,k=8": the words before the settings are those of a command. */
    char all[METHOD_TEXT_SIZE + sizeof "program="];
    if (rest[strspn(rest, ": ")] == '\0' || rest[strspn(rest, ": ")] == ',')
        return error_input(error, name, "needs a program, as in '%s:python3 mine.py,name=Mine'", name);
    snprintf(all, sizeof all, "program=%s", rest + 1);
    return settings_parse(&method->settings, all, description->settings, name, error);
}

static bool add_defaults(Settings *settings, const MethodDescription *method, const char *defaults) {
    Settings own;
    Error ignored = {0};
    if (!settings_parse(&own, defaults, method->settings, method->name, &ignored)) return false;
    for (int i = 0; i < own.count; i++)
        if (!settings_default(settings, own.items[i].key, own.items[i].value)) return false;
    return true;
}

bool method_all_settings(Settings *settings, const char *text, int iterations) {
    Method method;
    Error ignored = {0};
    char sweeps[24] = "";
    if (!method_parse(&method, text, &ignored)) return false;
    const MethodDescription *description = method.kind->description;
    *settings = method.settings;
    if (description->own_settings != NULL) return add_defaults(settings, description, description->own_settings);
    if (iterations > 0 && settings_known(description->settings, "k"))
        snprintf(sweeps, sizeof sweeps, "k=%d", iterations);
    return add_defaults(settings, description, sweeps);
}

bool method_with_network(Method *method, const char *name, const char *path, Error *error) {
    return method_parse(method, name, error) && (settings_default(&method->settings, "network", path) ||
                                                 error_input(error, path, "the name is too long for a setting"));
}

bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error) {
    const ContactSolverKind *kind = method->kind->solver;
    if (kind == NULL) return error_input(error, method->text, "is not a contact solver; this needs one");
    Settings settings = method->settings;
    char iterations[16];
    snprintf(iterations, sizeof iterations, "%d", scene->iterations);
    const struct {
        const char *key, *value;
    } scene_settings[] = {{"k", iterations},
                          {"accumulate", scene->accumulate_impulses ? "on" : "off"},
                          {"network", scene_network(scene, kind->description.name)}};
    for (size_t i = 0; i < sizeof scene_settings / sizeof scene_settings[0]; i++) {
        if (scene_settings[i].value == NULL || !settings_known(kind->description.settings, scene_settings[i].key))
            continue;
        if (!settings_default(&settings, scene_settings[i].key, scene_settings[i].value))
            return error_input(error, scene->name, "%s does not fit a setting", scene_settings[i].key);
    }
    char text[1024] = "";
    for (int i = 0; i < settings.count; i++)
        text_add(text, sizeof text, "%s%s=%s", i > 0 ? "," : ":", settings.items[i].key, settings.items[i].value);
    trace_line("method %s%s", kind->description.name, text);
    solver->kind = kind;
    solver->state = kind->create(&settings, error);
    return solver->state != NULL;
}

bool method_lacks_network(const Method *method, const Scene *scene) {
    const MethodDescription *description = method->kind->description;
    return description->needs_network && settings_get(&method->settings, "network") == NULL &&
           scene_network(scene, description->name) == NULL;
}

const char *method_network(const Settings *settings, const Scene *scene, const char *name, Error *error) {
    const char *path = settings_get(settings, "network");
    if (path == NULL && scene != NULL) path = scene_network(scene, name);
    if (path == NULL) error_input(error, name, "the scene names no network for it: use %s:network=FILE", name);
    return path;
}

struct Stepper {
    const MethodDescription *description;
    ContactSolver solver;         /* in the standard step */
    const SteppingKind *stepping; /* or NULL */
    void *state;
    float keep; /* m */
};

/* Of the step of any method that has KEEP_SETTING in its table. */
static const SettingSpec step_settings[] = {{"keep", NULL, SETTING_FLOAT(Stepper, keep, 0, 1)}, {0}};

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error) {
    Stepper *stepper = calloc(1, sizeof *stepper);
    if (stepper == NULL) {
        error_memory(error, method->text);
        return NULL;
    }
    stepper->description = method->kind->description;
    stepper->stepping = method->kind->stepping;
    const bool read = stepper->description->external || settings_read(&method->settings, step_settings, stepper, error);
    if (read && stepper->stepping != NULL) {
        stepper->state = stepper->stepping->create(&method->settings, scene, error);
        if (stepper->state != NULL) return stepper;
    } else if (read && method_create_solver(method, scene, &stepper->solver, error)) {
        return stepper;
    }
    free(stepper);
    return NULL;
}

Stepper *stepper_of_solver(const ContactSolver *solver, Error *error) {
    Stepper *stepper = calloc(1, sizeof *stepper);
    if (stepper != NULL)
        *stepper = (Stepper){.description = &solver->kind->description, .solver = *solver};
    else
        error_memory(error, solver->kind->description.name), solver->kind->destroy(solver->state);
    return stepper;
}

void stepper_destroy(Stepper *stepper) {
    if (stepper == NULL) return;
    if (stepper->stepping != NULL)
        stepper->stepping->destroy(stepper->state);
    else
        stepper->solver.kind->destroy(stepper->solver.state);
    free(stepper);
}

/* NULL: the world is enough. */
static StepMemory *memory_of(const Stepper *stepper) {
    const SteppingKind *stepping = stepper->stepping;
    return stepping != NULL && stepping->memory != NULL ? stepping->memory(stepper->state) : NULL;
}

bool stepper_remember(const Stepper *stepper, StepMemory *memory, Error *error) {
    const StepMemory *own = memory_of(stepper);
    return own == NULL || step_memory_copy(memory, own) || error_memory(error, stepper->description->name);
}

bool stepper_recall(Stepper *stepper, const StepMemory *memory, Error *error) {
    StepMemory *own = memory_of(stepper);
    return own == NULL || step_memory_copy(own, memory) || error_memory(error, stepper->description->name);
}

const MethodDescription *stepper_describe(const Stepper *stepper) { return stepper->description; }

bool stepper_mends(const Stepper *stepper) {
    const MethodDescription *method = stepper->description;
    return stepper->keep > 0 || !(method->lite_contacts || method->needs_network);
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
    if (metered->step->meter != NULL && metered->solver->kind->reported != NULL)
        metered->step->meter->reported = metered->solver->kind->reported(metered->solver->state);
    return solved;
}

bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error) {
    const bool mend = stepper_mends(stepper) && !step->engine_step;
    world_set_contacts(world, (ContactRules){.keep = stepper->keep, .mend = mend});
    if (stepper->stepping != NULL) return stepping_step(stepper->stepping, stepper->state, world, step, error);
    MeteredSolver metered = {&stepper->solver, step};
    return world_step(world, solve_metered, &metered, step->scene->dt, error);
}

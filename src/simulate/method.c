/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/method.h"

#include "solvers/solvers.h"

#include <stdio.h>
#include <string.h>

static bool unknown_method(const char *text, Error *error) {
    char names[512] = "";
    for (int i = 0; solver_kinds[i] != NULL; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "", solver_kinds[i]->name);
    }
    return error_input(error, text, "no such method; there are %s", names);
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
    if (method->solver == NULL) return unknown_method(name, error);
    const char *settings = text[length] == ':' ? text + length + 1 : "";
    return settings_parse(&method->settings, settings, method->solver->settings, name, error);
}

static bool has_setting(const ContactSolverKind *kind, const char *key) {
    for (const SettingSpec *spec = kind->settings; spec->key != NULL; spec++)
        if (strcmp(spec->key, key) == 0) return true;
    return false;
}

bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error) {
    Settings settings = method->settings;
    char iterations[16];
    snprintf(iterations, sizeof iterations, "%d", scene->iterations);
    const struct {
        const char *key, *value;
    } scene_settings[] = {{"k", iterations},
                          {"accumulate", scene->accumulate_impulses ? "on" : "off"},
                          {"network", scene_network(scene, method->solver->name)}};
    for (size_t i = 0; i < sizeof scene_settings / sizeof scene_settings[0]; i++) {
        if (scene_settings[i].value == NULL || !has_setting(method->solver, scene_settings[i].key)) continue;
        if (!settings_default(&settings, scene_settings[i].key, scene_settings[i].value))
            return error_input(error, scene->name, "%s does not fit a setting", scene_settings[i].key);
    }
    solver->kind = method->solver;
    solver->state = method->solver->create(&settings, error);
    return solver->state != NULL;
}

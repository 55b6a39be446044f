/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The studies of one scene file, from the texts of --vary. */
#include "base/base.h"
#include "base/csv.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/stability.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ends of a range further apart make it logarithmic: 2 to 40 boxes are not, a mass ratio of 1 to 100 is. */
static const double linear_ratio = 20;

enum { SCAN_POINTS = 13, SCAN_QUICK_POINTS = 5, MAP_POINTS = 10, MAP_QUICK_POINTS = 4 };

static bool is_whole(double value) { return value == floor(value); }

/* What every scene has is checked when the scene is read. */
static bool check_range(const SceneParameter *parameter, const char *text, double from, double to, Error *error) {
    const char *space = parameter->unit[0] != '\0' ? " " : "";
    if (!(from < to)) return error_input(error, "--vary", "'%s' is not NAME=FROM:TO with FROM less than TO", text);
    if (!parameter->common && (from < parameter->from || to > parameter->to))
        return error_input(error, "--vary", "'%s' is not within the scene's bounds of %s: %.9g to %.9g%s%s", text,
                           parameter->name, parameter->from, parameter->to, space, parameter->unit);
    if (parameter->whole && (!is_whole(from) || !is_whole(to)))
        return error_input(error, "--vary", "%s must be a whole number ('%s')", parameter->name, text);
    for (const char *c = parameter->unit; *c != '\0'; c += csv_plain_length(c))
        if (csv_plain_length(c) == 0)
            return error_input(error, "--vary",
                               "the unit '%s' of %s cannot stand in a table: only letters, digits, spaces and "
                               "-_.,:=+/()*[]",
                               parameter->unit, parameter->name);
    return true;
}

/* The end of a range with the 4 digits that scans have, rounded towards the inside. */
static double rounded_inward(double value, int direction) {
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    const double rounded = strtod(text, NULL);
    if (direction * (rounded - value) >= 0) return rounded;
    snprintf(text, sizeof text, "%.4g", rounded + direction * pow(10, floor(log10(fabs(rounded))) - 3));
    return strtod(text, NULL);
}

/* Every value from FROM to TO, in steps. */
static bool make_steps(const SceneParameter *parameter, const char *text, double from, double to, double step,
                       BorderScan *scan, Error *error) {
    const double count = round((to - from) / step);
    if (fabs(from + count * step - to) > 1e-6 * step)
        return error_input(error, "--vary", "'%s': TO is not a whole number of steps from FROM", text);
    if (count + 1 > BORDER_POINTS_MAX)
        return error_input(error, "--vary", "'%s' has %.0f values; at most %d are allowed", text, count + 1,
                           BORDER_POINTS_MAX);
    if (parameter->whole && !is_whole(step))
        return error_input(error, "--vary", "'%s': the steps of %s must be whole numbers", text, parameter->name);
    *scan = (BorderScan){.from = from, .to = to, .points = (int)count + 1, .whole = parameter->whole, .either = true};
    return true;
}

/* "NAME", "NAME=FROM:TO" or "NAME=FROM:TO:STEP", which sets the number of points. */
static bool read_text(const Scene *scene, const char *text, char name[SCENE_PARAMETER_SIZE], BorderScan *scan,
                      Error *error) {
    const size_t length = strcspn(text, "=");
    snprintf(name, SCENE_PARAMETER_SIZE, "%.*s", (int)length, text);
    const SceneParameters all = scene_parameters(scene);
    const SceneParameter *parameter = scene_parameter(&all, name);
    if (parameter == NULL) {
        NameList known = {0};
        for (int i = 0; i < all.count; i++) name_list_add(&known, all.items[i].name);
        return error_unknown(error, "--vary", name, "a parameter of the scene", &known);
    }
    double from = parameter->from, to = parameter->to, step = 0;
    const char *rest;
    if (text[length] == '=' && !(parse_leading_double(text + length + 1, &from, &rest) && *rest == ':' &&
                                 parse_leading_double(rest + 1, &to, &rest) &&
                                 (*rest == '\0' || (*rest == ':' && parse_double(rest + 1, &step) && step > 0))))
        return error_input(error, "--vary", "'%s' is not NAME=FROM:TO or NAME=FROM:TO:STEP", text);
    if (!check_range(parameter, text, from, to, error)) return false;
    if (step > 0) return make_steps(parameter, text, from, to, step, scan, error);
    from = rounded_inward(from, 1);
    to = rounded_inward(to, -1);
    *scan = (BorderScan){.from = from,
                         .to = to,
                         .logarithmic = from > 0 && to / from > linear_ratio,
                         .whole = parameter->whole,
                         .either = true};
    return true;
}

/* Letters that file names and tables can have; a long name of the scene is cut. */
static void make_name(char name[STABILITY_OWN_NAME_SIZE], const char *scene, const char *rest) {
    char whole[SCENE_NAME_SIZE + 2 * SCENE_PARAMETER_SIZE];
    const int room = STABILITY_OWN_NAME_SIZE - 2 - (int)strlen(rest);
    snprintf(whole, sizeof whole, "%.*s_%s", room, scene, rest);
    snprintf(name, STABILITY_OWN_NAME_SIZE, "%.*s", STABILITY_OWN_NAME_SIZE - 1, whole);
    for (char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && *c != '-') *c = '_';
}

/* Whether the parameter sets nothing but the number of iterations: methods that set their own do not depend on it. */
static bool sets_iterations(Scene *low, Scene *high) {
    if (low->iterations == high->iterations) return false;
    low->iterations = high->iterations;
    return scene_hash(low) == scene_hash(high);
}

static Scene *read_at(const char *path, const SceneSetting *settings, int count, Error *error) {
    Scene *scene = scene_read_with(path, settings, count, error);
    if (scene != NULL) return scene;
    if (count > 0) error_add(error, "\nthis is the scene for --vary with ");
    for (int i = 0; i < count; i++)
        error_add(error, "%s%s = %.9g", i == 0 ? "" : ", ", settings[i].name, settings[i].value);
    return NULL;
}

/* Reads the scene at each value of the coarse scan, so that a refused one is found before the work. */
static bool try_values(const char *path, const char *name, const BorderScan *scan, bool *iterations, Error *error) {
    double values[BORDER_POINTS_MAX];
    const int count = border_scan_values(scan, values);
    Scene *first = NULL;
    SceneSetting setting = {.value = 0};
    snprintf(setting.name, sizeof setting.name, "%s", name);
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        setting.value = values[i];
        Scene *scene = read_at(path, &setting, 1, error);
        ok = scene != NULL;
        if (ok && i > 0 && i == count - 1) *iterations = sets_iterations(first, scene);
        if (i == 0)
            first = scene;
        else
            scene_destroy(scene);
    }
    scene_destroy(first);
    return ok;
}

/* The same for the cells of a map. */
static bool try_map(const StabilityMap *map, Error *error) {
    double x[BORDER_POINTS_MAX], y[BORDER_POINTS_MAX];
    const int columns = border_scan_values(&map->x.scan, x), rows = border_scan_values(&map->y.scan, y);
    SceneSetting settings[2];
    snprintf(settings[0].name, sizeof settings[0].name, "%s", map->x.parameter);
    snprintf(settings[1].name, sizeof settings[1].name, "%s", map->y.parameter);
    for (int cell = 0; cell < rows * columns; cell++) {
        settings[0].value = x[cell % columns];
        settings[1].value = y[cell / columns];
        Scene *scene = read_at(map->file, settings, 2, error);
        if (scene == NULL) return false;
        scene_destroy(scene);
    }
    return true;
}

static bool add_study(StabilityOwn *own, const Scene *scene, const char *path, const char *text, bool quick,
                      Error *error) {
    const int i = own->study_count;
    char *name = own->parameters[i];
    BorderScan scan = {0};
    if (!read_text(scene, text, name, &scan, error)) return false;
    if (i > 0 && strcmp(name, own->parameters[0]) == 0)
        return error_input(error, "--vary", "the parameter '%s' is given twice", name);
    own->stepped[i] = scan.points > 0;
    if (!own->stepped[i]) scan.points = quick ? SCAN_QUICK_POINTS : SCAN_POINTS;
    bool iterations = false;
    if (!try_values(path, name, &scan, &iterations, error)) return false;
    make_name(own->names[i], scene->name, name);
    text_add(own->titles[i], sizeof own->titles[i], "Scene %s, by %s", scene->name, name);
    own->studies[own->study_count++] = (StabilityStudy){.name = own->names[i],
                                                        .title = own->titles[i],
                                                        .scene = own->names[i],
                                                        .parameter = name,
                                                        .scan = scan,
                                                        .stands = !verdict_is_struck(scene),
                                                        .iterations = iterations,
                                                        .weight = scan.points + 16,
                                                        .file = path};
    return true;
}

static StabilityAxis axis_of(const StabilityOwn *own, int i) {
    BorderScan scan = own->studies[i].scan;
    if (!own->stepped[i]) scan.points = MAP_POINTS;
    return (StabilityAxis){own->studies[i].parameter, scan, own->stepped[i] ? scan.points : MAP_QUICK_POINTS};
}

static void add_map(StabilityOwn *own, const char *scene_name, const char *path) {
    char both[2 * SCENE_PARAMETER_SIZE];
    snprintf(both, sizeof both, "%.12s_%.12s", own->parameters[0], own->parameters[1]);
    make_name(own->names[STABILITY_MAX_VARY], scene_name, both);
    const StabilityAxis x = axis_of(own, 0), y = axis_of(own, 1);
    own->maps[own->map_count++] = (StabilityMap){.name = own->names[STABILITY_MAX_VARY],
                                                 .scene = own->names[STABILITY_MAX_VARY],
                                                 .x = x,
                                                 .y = y,
                                                 .stands = own->studies[0].stands,
                                                 .iterations = own->studies[0].iterations || own->studies[1].iterations,
                                                 .weight = x.scan.points * y.scan.points,
                                                 .file = path};
}

bool stability_own_make(StabilityOwn *own, const char *path, const char *const *texts, int count, bool quick,
                        Error *error) {
    *own = (StabilityOwn){.study_count = 0};
    if (count > STABILITY_MAX_VARY)
        return error_input(error, "--vary", "at most %d parameters can be varied at a time", STABILITY_MAX_VARY);
    Scene *scene = scene_read(path, error);
    bool ok = scene != NULL;
    for (int i = 0; ok && i < count; i++) ok = add_study(own, scene, path, texts[i], quick, error);
    if (ok && count == 2) add_map(own, scene->name, path);
    if (ok && count == 2) ok = try_map(&own->maps[0], error);
    scene_destroy(scene);
    return ok;
}

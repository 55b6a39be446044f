/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs in a picture, and what their steps cost. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pixels/type.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"

#include <math.h>
#include <string.h>

int panels_last_frame(const Panels *panels) {
    int frames = 0;
    for (int i = 0; i < panels->count; i++)
        if (panels->runs[i]->frames > frames) frames = panels->runs[i]->frames;
    return frames - 1;
}

static bool is_of(const ChartRow *row, const Trajectory *run) {
    size_t length = strcspn(run->method, ":");
    return strncmp(row->method, run->method, length) == 0 && row->method[length] == '\0';
}

/* All settings of `some` are in `all` with the same value; a network only has to be if `all` has one. */
static bool contains(const Settings *all, const Settings *some) {
    for (int i = 0; i < some->count; i++) {
        const char *key = some->items[i].key, *value = settings_get(all, key);
        if (value == NULL ? strcmp(key, "network") != 0 : strcmp(value, some->items[i].value) != 0) return false;
    }
    return true;
}

/* In any order, and whether given or not: "engine" is "engine:k=10" in a scene with 10 iterations. The chart has no
   setting for the network that the scene names. */
static bool has_settings(const ChartRow *row, const Trajectory *run) {
    char text[METHOD_TEXT_SIZE];
    Settings charted, own;
    if (snprintf(text, sizeof text, "%s%s%s", row->method, row->setting[0] != '\0' ? ":" : "", row->setting) >=
            (int)sizeof text ||
        !method_all_settings(&charted, text, run->iterations) ||
        !method_all_settings(&own, run->method, run->iterations))
        return false;
    return contains(&charted, &own) && contains(&own, &charted);
}

/* The row with the settings of the run. A run without settings that does not state its scene's iterations is the only
   row of its method. NULL if there is no row. */
static const ChartRow *find_cost(const CsvTable *table, const Trajectory *run) {
    const ChartRow *found = NULL;
    int fitting = 0;
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = chart_row(table, i);
        if (strcmp(row->scene, run->scene) != 0 || row->protocol != PROTOCOL_CLOSED || row->phase != PHASE_IMPACT ||
            isnan(row->us_solver) || !is_of(row, run))
            continue;
        if (has_settings(row, run)) return row;
        found = row;
        fitting++;
    }
    return strchr(run->method, ':') == NULL && run->iterations == 0 && fitting == 1 ? found : NULL;
}

bool panel_costs_read(PanelCosts *costs, const char *path, const Panels *panels, RenderLook *look, Error *error) {
    CsvTable table;
    if (!csv_table_read(&table, path, &chart_layout, error)) return false;
    int found = 0;
    for (int i = 0; i < panels->count; i++) {
        const ChartRow *row = find_cost(&table, panels->runs[i]);
        if (row == NULL) continue;
        const int decimals = row->us_solver < 1 ? 2 : row->us_solver < 100 ? 1 : 0;
        snprintf(costs->texts[i], sizeof costs->texts[i], "%.*f \xC2\xB5s a step at the impact", decimals,
                 row->us_solver);
        look->costs[i] = costs->texts[i];
        found++;
    }
    csv_table_free(&table);
    return found > 0 || error_input(error, path, "has no closed-loop time at the impact for any of these runs");
}

static bool panels_add(Panels *panels, Trajectory *run, const char *input, Error *error) {
    if (run == NULL) return false;
    if (!type_check(run->scene, input, error) || !type_check(run->method, input, error)) {
        trajectory_destroy(run);
        return false;
    }
    if (panels->count == RENDER_PANELS_MAX) {
        trajectory_destroy(run);
        return error_input(error, input, "more than %d panels", RENDER_PANELS_MAX);
    }
    panels->inputs[panels->count] = input;
    panels->runs[panels->count++] = run;
    return true;
}

bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error) {
    return panels_add_watched(panels, scene, method_name, input, NULL, error);
}

bool panels_add_watched(Panels *panels, const Scene *scene, const char *method_name, const char *input,
                        const Progress *progress, Error *error) {
    Method method;
    if (!method_parse(&method, method_name, error)) return false;
    if (progress != NULL) return panels_add(panels, simulate_judged(scene, &method, progress, error), input, error);
    char what[2 * SCENE_NAME_SIZE + 8];
    snprintf(what, sizeof what, "%s by %s", scene->name, method_name);
    Trajectory *run = simulate_judged(scene, &method, progress_bar_begin(what), error);
    progress_bar_end();
    return panels_add(panels, run, input, error);
}

/* Why a scene has one panel, and the commands that give it a second one. */
static void note_engine_only(const char *input, const Scene *scene) {
    const bool trained = scene->network_count > 0;
    char train[1024] = "";
    if (!trained && !(scene->bomb.present && scene_span_varies(&scene->bomb.x))) {
        note_print(
            "%s names no network, so only the engine is drawn; to train one for it, give it a bomb with a family of "
            "launches, x: {from: A, to: B}",
            input);
        return;
    }
    if (!trained) snprintf(train, sizeof train, "    twinbox train --kind scene-net %s -o net.npz\n", input);
    note_print("%s names no %s, so only the engine is drawn. To %sdraw a network beside it:\n%s"
               "    twinbox render %s --method engine --method %s -o DIR",
               input, trained ? "pair-net" : "network", trained ? "" : "train and ", train, input,
               trained ? scene->networks[0].method : "scene-net:network=net.npz");
}

static bool add_runs(Panels *panels, const Scene *scene, const char *input, const PanelMethods *methods, Error *error) {
    static const PanelMethods both = {{"engine", "pair-net"}, 2}, engine = {{"engine"}, 1};
    const bool chosen = methods->count > 0, network = scene_network(scene, "pair-net") != NULL;
    if (!chosen) methods = network ? &both : &engine;
    for (int i = 0; i < methods->count; i++)
        if (!panels_add_run(panels, scene, methods->texts[i], input, error)) return false;
    if (!chosen && !network) note_engine_only(input, scene);
    return true;
}

bool panels_add_scene(Panels *panels, const char *input, const SceneSettings *set, const PanelMethods *methods,
                      Error *error) {
    Scene *scene = scene_read_with(input, set->items, set->count, error);
    const bool ok =
        scene != NULL && type_check(scene->name, input, error) && add_runs(panels, scene, input, methods, error);
    scene_destroy(scene);
    return ok;
}

static bool is_stored(const char *input) {
    const char *ending = strrchr(input, '.');
    if (path_is_standard(input)) return standard_input_is_zip();
    return ending != NULL && strcmp(ending, ".npz") == 0;
}

bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set,
                 const PanelMethods *methods, Error *error) {
    int scenes = 0;
    for (int i = 0; i < input_count; i++) scenes += !is_stored(inputs[i]);
    if (set->count > 0 && scenes != 1) return error_input(error, "--set", "needs exactly one scene (got %d)", scenes);
    if (methods->count > 0 && scenes == 0)
        return error_input(error, "--method", "needs a scene; a run (.npz) is shown as it was simulated");
    for (int i = 0; i < input_count; i++) {
        bool ok = is_stored(inputs[i]) ? panels_add(panels, trajectory_read(inputs[i], error), inputs[i], error)
                                       : panels_add_scene(panels, inputs[i], set, methods, error);
        if (!ok) return false;
    }
    return true;
}

void panels_free(Panels *panels) {
    for (int i = 0; i < panels->count; i++) trajectory_destroy(panels->runs[i]);
    panels->count = 0;
}

bool panels_store(const Panels *panels, const char *directory, Error *error) {
    for (int i = 0; i < panels->count; i++) {
        char name[TRAJECTORY_FILE_NAME_SIZE], path[4096];
        trajectory_file_name((const Trajectory *const *)panels->runs, i, name);
        if (!file_path(path, sizeof path, error, "%s/%s", directory, name) ||
            !trajectory_write(panels->runs[i], path, error))
            return false;
    }
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability.h"

#include "common/file.h"
#include "common/names.h"
#include "stability/stability_grid.h"
#include "stability/stability_scan.h"
#include "stability/stability_table.h"
#include "study/study_key.h"
#include "study/study_parts.h"

#include <stdio.h>
#include <string.h>

typedef struct Run {
    const StabilityOptions *options;
    ContenderList methods;
    StudyParts parts;
} Run;

static bool is_named(const StabilityOptions *options, const char *name, bool quick) {
    for (int i = 0; i < options->name_count; i++)
        if (strcmp(options->names[i], name) == 0) return true;
    return options->name_count == 0 && (quick || !options->quick);
}

static bool does_study(const Run *run, int i) {
    return is_named(run->options, stability_studies[i].name, stability_studies[i].quick);
}

static bool does_map(const Run *run, int i) {
    return is_named(run->options, stability_maps[i].name, stability_maps[i].quick);
}

static bool is_known(const char *name) {
    for (int i = 0; i < stability_map_count; i++)
        if (strcmp(stability_maps[i].name, name) == 0) return true;
    return stability_study_find(name) != NULL;
}

static bool refuse_name(const char *name, Error *error) {
    NameList known = {0};
    for (int i = 0; i < stability_study_count; i++) name_list_add(&known, stability_studies[i].name);
    for (int i = 0; i < stability_map_count; i++) name_list_add(&known, stability_maps[i].name);
    return error_unknown(error, "stability", name, "a study or map", &known);
}

static bool know_names(const StabilityOptions *options, Error *error) {
    for (int i = 0; i < options->name_count; i++)
        if (!is_known(options->names[i])) return refuse_name(options->names[i], error);
    return true;
}

/* Hashes the scene and its networks. A missing network is an error only of the method that needs it. */
static bool add_scene_to_key(const Run *run, const char *name, uint64_t *key, Error *error) {
    char path[STABILITY_PATH_SIZE];
    const StabilityPlace place = {run->options->scenes, name};
    if (!stability_path(path, &place, error)) return false;
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

/* Hashes everything that determines the result: the program, the options, the scenes. */
static bool find_key(const Run *run, uint64_t *key, Error *error) {
    const StabilityOptions *options = run->options;
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    for (int i = 0; i < stability_study_count; i++)
        if (does_study(run, i) && !add_scene_to_key(run, stability_studies[i].scene, key, error)) return false;
    for (int i = 0; i < stability_map_count; i++)
        if (does_map(run, i) && !add_scene_to_key(run, stability_maps[i].scene, key, error)) return false;
    return true;
}

/* In a quick run, the weight of a map is proportional to its number of cells. */
static double map_weight(const Run *run, const StabilityMap *map) {
    double share = (double)(map->x.quick_points * map->y.quick_points) / (map->x.scan.points * map->y.scan.points);
    return run->options->quick ? map->weight * share : map->weight;
}

static bool do_parts(Run *run, Error *error) {
    for (int i = 0; i < stability_study_count; i++) {
        StabilityScan scan = {&stability_studies[i], run->options->scenes, &run->methods};
        const StudyPart part = {scan.study->name, scan.study->weight, stability_scan_write, &scan};
        if (does_study(run, i) && !study_parts_do(&run->parts, &part, error)) return false;
    }
    for (int i = 0; i < stability_map_count; i++) {
        StabilityGrid grid = {&stability_maps[i], run->options->scenes, &run->methods, run->options->quick};
        const StudyPart part = {grid.map->name, map_weight(run, grid.map), stability_grid_write, &grid};
        if (does_map(run, i) && !study_parts_do(&run->parts, &part, error)) return false;
    }
    return true;
}

static bool write_tables(const Run *run, Error *error) {
    static const CsvLayout *const layouts[] = {&border_layout, &map_layout, &refusal_layout, &fallback_layout,
                                               &rest_layout};
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (!study_parts_table(&run->parts, run->options->folder, layouts[i], error)) return false;
    return true;
}

bool stability_run(const StabilityOptions *options, const Progress *progress, Error *error) {
    Run run = {.options = options, .parts = {.progress = progress}};
    uint64_t key;
    if (!know_names(options, error) || !contenders_parse(&run.methods, options->methods, STUDY_STABILITY, error))
        return false;
    for (int i = 0; i < stability_study_count; i++)
        if (does_study(&run, i)) run.parts.total += stability_studies[i].weight;
    for (int i = 0; i < stability_map_count; i++)
        if (does_map(&run, i)) run.parts.total += map_weight(&run, &stability_maps[i]);
    bool ok = find_key(&run, &key, error) && file_make_directory(options->folder, error) &&
              study_parts_open(&run.parts, options->folder, key, error) && do_parts(&run, error) &&
              write_tables(&run, error);
    ok = ok && study_parts_remove(&run.parts, error);
    study_parts_close(&run.parts);
    contenders_free(&run.methods);
    return ok;
}

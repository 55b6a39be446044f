/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability.h"

#include "common/folder_reserve.h"
#include "common/names.h"
#include "stability/stability_grid.h"
#include "stability/stability_scan.h"
#include "stability/stability_table.h"
#include "study/study_key.h"
#include "study/study_parts.h"

#include <stdio.h>
#include <string.h>

/* The parts of the run: [study_count] and [map_count], from the table or of one scene file. */
typedef struct Run {
    const StabilityOptions *options;
    const StabilityStudy *studies;
    const StabilityMap *maps;
    int study_count, map_count;
    ContenderList methods;
    StudyParts parts;
} Run;

static bool is_named(const StabilityOptions *options, const char *name, bool quick) {
    if (options->own != NULL) return true;
    for (int i = 0; i < options->name_count; i++)
        if (strcmp(options->names[i], name) == 0) return true;
    return options->name_count == 0 && (quick || !options->quick);
}

static bool does_study(const Run *run, int i) {
    return is_named(run->options, run->studies[i].name, run->studies[i].quick);
}

static bool does_map(const Run *run, int i) { return is_named(run->options, run->maps[i].name, run->maps[i].quick); }

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
static bool add_scene_to_key(const StabilityPlace *place, uint64_t *key, Error *error) {
    char path[STABILITY_PATH_SIZE];
    if (!stability_path(path, place, error)) return false;
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

/* Hashes a range that is not in the program. */
static void add_scan_to_key(const char *parameter, const BorderScan *scan, uint64_t *key) {
    const double numbers[] = {scan->from, scan->to, scan->points};
    study_key_add(key, parameter, strlen(parameter) + 1);
    study_key_add(key, numbers, sizeof numbers);
}

static bool add_study_to_key(const Run *run, const StabilityStudy *study, uint64_t *key, Error *error) {
    const StabilityPlace place = {run->options->scenes, study->scene, study->file};
    add_scan_to_key(study->parameter, &study->scan, key);
    return add_scene_to_key(&place, key, error);
}

static bool add_map_to_key(const Run *run, const StabilityMap *map, uint64_t *key, Error *error) {
    const StabilityPlace place = {run->options->scenes, map->scene, map->file};
    add_scan_to_key(map->x.parameter, &map->x.scan, key);
    add_scan_to_key(map->y.parameter, &map->y.scan, key);
    return add_scene_to_key(&place, key, error);
}

/* Hashes everything that determines the result: the program, the options, the scenes. */
static bool find_key(const Run *run, uint64_t *key, Error *error) {
    const StabilityOptions *options = run->options;
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    for (int i = 0; i < run->study_count; i++)
        if (does_study(run, i) && !add_study_to_key(run, &run->studies[i], key, error)) return false;
    for (int i = 0; i < run->map_count; i++)
        if (does_map(run, i) && !add_map_to_key(run, &run->maps[i], key, error)) return false;
    return true;
}

/* In a quick run, the weight of a map is proportional to its number of cells. */
static double map_weight(const Run *run, const StabilityMap *map) {
    double share = (double)(map->x.quick_points * map->y.quick_points) / (map->x.scan.points * map->y.scan.points);
    return run->options->quick ? map->weight * share : map->weight;
}

static bool do_parts(Run *run, Error *error) {
    for (int i = 0; i < run->study_count; i++) {
        StabilityScan scan = {&run->studies[i], run->options->scenes, &run->methods};
        const StudyPart part = {scan.study->name, scan.study->weight, stability_scan_write, &scan};
        if (does_study(run, i) && !study_parts_do(&run->parts, &part, error)) return false;
    }
    for (int i = 0; i < run->map_count; i++) {
        StabilityGrid grid = {&run->maps[i], run->options->scenes, &run->methods, run->options->quick};
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
    Run run = {.options = options,
               .studies = options->own != NULL ? options->own->studies : stability_studies,
               .maps = options->own != NULL ? options->own->maps : stability_maps,
               .study_count = options->own != NULL ? options->own->study_count : stability_study_count,
               .map_count = options->own != NULL ? options->own->map_count : stability_map_count,
               .parts = {.progress = progress}};
    uint64_t key;
    if (!know_names(options, error) || !contenders_parse(&run.methods, options->methods, STUDY_STABILITY, error))
        return false;
    for (int i = 0; i < run.study_count; i++)
        if (does_study(&run, i)) run.parts.total += run.studies[i].weight;
    for (int i = 0; i < run.map_count; i++)
        if (does_map(&run, i)) run.parts.total += map_weight(&run, &run.maps[i]);
    bool ok = find_key(&run, &key, error) && folder_reserve(options->folder, error) &&
              study_parts_open(&run.parts, options->folder, key, error) && do_parts(&run, error) &&
              write_tables(&run, error);
    ok = ok && (options->draw == NULL || options->draw(options->draw_context, key, error)) &&
         study_parts_remove(&run.parts, error);
    study_parts_close(&run.parts);
    contenders_free(&run.methods);
    return ok;
}

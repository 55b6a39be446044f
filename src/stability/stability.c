/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability.h"

#include "common/folder_reserve.h"
#include "common/names.h"
#include "stability/stability_plan.h"
#include "stability/stability_table.h"

#include <stdlib.h>
#include <string.h>

/* The studies and maps of the run, from the table or of one scene file. */
typedef struct Run {
    const StabilityOptions *options;
    const StabilityStudy **studies; /* [study_count] */
    const StabilityMap **maps;      /* [map_count] */
    int study_count, map_count;
    ContenderList methods;
    StabilityPlan plan;
} Run;

static bool is_named(const StabilityOptions *options, const char *name, bool quick) {
    if (options->own != NULL) return true;
    for (int i = 0; i < options->name_count; i++)
        if (strcmp(options->names[i], name) == 0) return true;
    return options->name_count == 0 && (quick || !options->quick);
}

/* What is named, or all that belongs to a run of this size. */
static bool choose(Run *run, Error *error) {
    const StabilityOptions *options = run->options;
    const StabilityOwn *own = options->own;
    const StabilityStudy *studies = own != NULL ? own->studies : stability_studies;
    const StabilityMap *maps = own != NULL ? own->maps : stability_maps;
    const int study_count = own != NULL ? own->study_count : stability_study_count,
              map_count = own != NULL ? own->map_count : stability_map_count;
    run->studies = malloc(((size_t)study_count + 1) * sizeof *run->studies);
    run->maps = malloc(((size_t)map_count + 1) * sizeof *run->maps);
    if (run->studies == NULL || run->maps == NULL) return error_memory(error, "stability");
    for (int i = 0; i < study_count; i++)
        if (is_named(options, studies[i].name, studies[i].quick)) run->studies[run->study_count++] = &studies[i];
    for (int i = 0; i < map_count; i++)
        if (is_named(options, maps[i].name, maps[i].quick)) run->maps[run->map_count++] = &maps[i];
    return true;
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
static bool add_scene_to_key(const StabilityPlace *place, StudyKey *key, Error *error) {
    char path[STABILITY_PATH_SIZE];
    if (!stability_path(path, place, error)) return false;
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

/* Hashes a range that is not in the program. */
static void add_scan_to_key(const char *name, const char *parameter, const BorderScan *scan, StudyKey *key) {
    const double numbers[] = {scan->from, scan->to, scan->points};
    study_key_add(key, name, strlen(name) + 1);
    study_key_add(key, parameter, strlen(parameter) + 1);
    study_key_add(key, numbers, sizeof numbers);
}

static bool add_study_to_key(const Run *run, const StabilityStudy *study, StudyKey *key, Error *error) {
    const StabilityPlace place = {run->options->scenes, study->scene, study->file};
    add_scan_to_key(study->name, study->parameter, &study->scan, key);
    return add_scene_to_key(&place, key, error);
}

static bool add_map_to_key(const Run *run, const StabilityMap *map, StudyKey *key, Error *error) {
    const StabilityPlace place = {run->options->scenes, map->scene, map->file};
    add_scan_to_key(map->name, map->x.parameter, &map->x.scan, key);
    add_scan_to_key(map->name, map->y.parameter, &map->y.scan, key);
    return add_scene_to_key(&place, key, error);
}

/* Hashes everything that determines the result: the program, the options, the scenes. */
static bool find_key(const Run *run, StudyKey *key, Error *error) {
    const StabilityOptions *options = run->options;
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    for (int i = 0; i < run->study_count; i++)
        if (!add_study_to_key(run, run->studies[i], key, error)) return false;
    for (int i = 0; i < run->map_count; i++)
        if (!add_map_to_key(run, run->maps[i], key, error)) return false;
    return true;
}

static bool write_tables(const Run *run, const Pieces *pieces, Error *error) {
    static const CsvLayout *const layouts[] = {&border_layout, &map_layout, &refusal_layout, &fallback_layout,
                                               &rest_layout};
    return piece_tables_write(pieces, run->options->folder, layouts, sizeof layouts / sizeof *layouts, run->plan.pieces,
                              run->plan.count, error);
}

/* What follows from the pieces, once all are there. */
static bool finish(const Run *run, const Pieces *pieces, Error *error) {
    const StabilityOptions *options = run->options;
    return folder_reserve(options->folder, error) && write_tables(run, pieces, error) &&
           (options->draw == NULL || options->draw(options->draw_context, pieces->key, error)) &&
           pieces_end(pieces, error);
}

/* Shards share a folder; a whole study has it to itself. */
static bool do_pieces(Run *run, Pieces *pieces, const StudyKey *key, const Progress *progress, Error *error) {
    const StabilityOptions *options = run->options;
    if (!pieces_open(pieces, options->folder, false, key, options->run, error)) return false;
    if (pieces->mode == PIECES_WHOLE && !folder_reserve(options->folder, error)) return false;
    return pieces_do(pieces, &run->plan.plan, progress, error) &&
           (pieces->mode == PIECES_SHARD || finish(run, pieces, error));
}

static bool begin(Run *run, const StabilityOptions *options, Error *error) {
    *run = (Run){.options = options};
    return know_names(options, error) && contenders_parse(&run->methods, options->methods, STUDY_STABILITY, error) &&
           choose(run, error) &&
           stability_plan_make(&run->plan, run->studies, run->study_count, run->maps, run->map_count, options->scenes,
                               &run->methods, options->quick, error);
}

static void end(Run *run) {
    stability_plan_free(&run->plan);
    contenders_free(&run->methods);
    free(run->studies);
    free(run->maps);
}

bool stability_run(const StabilityOptions *options, Pieces *pieces, const Progress *progress, Error *error) {
    Run run;
    StudyKey key = {0};
    const bool ok =
        begin(&run, options, error) && find_key(&run, &key, error) && do_pieces(&run, pieces, &key, progress, error);
    pieces->plan = NULL;
    study_key_free(&key);
    end(&run);
    return ok;
}

bool stability_estimate(const StabilityOptions *options, PiecesEstimate *estimate, const Progress *progress,
                        Error *error) {
    Run run;
    const bool ok = begin(&run, options, error) && pieces_estimate(estimate, &run.plan.plan, progress, error);
    end(&run);
    return ok;
}

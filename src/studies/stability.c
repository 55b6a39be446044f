/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability study in pieces (runs/pieces.h): some methods of a study along one parameter, or some cells of a
   map. */
#include "studies/stability.h"

#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "runs/pieces.h"
#include "studies/contenders.h"
#include "studies/piece_tables.h"
#include "studies/stability_internal.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A study or a map, and its pieces. */
typedef struct StabilityGroup {
    StabilityScan scan; /* study NULL: a map */
    StabilityGrid grid;
    const char *name;
    int items;     /* methods or cells */
    double weight; /* of each piece */
    bool begun;
    ScanContext scanned;
    GridContext mapped;
} StabilityGroup;

/* groups and pieces have the same number. */
typedef struct StabilityPlan {
    StabilityGroup *groups;
    PieceGroup *pieces;
    int count;
    PiecePlan plan;
} StabilityPlan;

/* A piece takes about this long on one core: less would make more files, more would lose more when it is cut off. */
static const double piece_seconds = 4;

/* Cells of a scene file take an unknown time. */
enum { MOST_PIECES = 4096 };

/* A piece's group, and its items first .. *end - 1. */
static int find_items(const StabilityPlan *plan, int64_t piece, int *first, int *end) {
    int group = 0;
    while (piece >= plan->pieces[group].first + plan->pieces[group].count) group++;
    const int64_t i = piece - plan->pieces[group].first, count = plan->pieces[group].count;
    *first = (int)(plan->groups[group].items * i / count);
    *end = (int)(plan->groups[group].items * (i + 1) / count);
    return group;
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const StabilityPlan *plan = context;
    int first, end;
    const StabilityGroup *group = &plan->groups[find_items(plan, piece, &first, &end)];
    snprintf(info->name, sizeof info->name, "%s %d-%d", group->name, first + 1, end);
    info->weight = group->weight;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const StabilityPlan *plan = context;
    int first, end;
    StabilityGroup *group = &plan->groups[find_items(plan, piece, &first, &end)];
    const bool scans = group->scan.study != NULL;
    bool ok = true;
    /* The context of a group is made by the first of its pieces. */
#pragma omp critical(stability_group)
    if (!group->begun) {
        ok = scans ? stability_scan_begin(&group->scanned, &group->scan, error)
                   : stability_grid_begin(&group->mapped, &group->grid, error);
        group->begun = ok;
        if (!ok) stability_scan_end(&group->scanned);
        if (!ok) stability_grid_end(&group->mapped);
    }
    if (!ok) return false;
    return scans ? stability_scan_write(&group->scanned, first, end, results, progress, error)
                 : stability_grid_write(&group->mapped, first, end, results, progress, error);
}

/* weight: seconds on two cores, of the whole group. */
static void add_group(StabilityPlan *plan, StabilityGroup group, double weight, bool known, int sections) {
    const double wanted = known ? ceil(2 * weight / piece_seconds) : MOST_PIECES;
    const int count = wanted < group.items ? (int)wanted : group.items;
    group.weight = 2 * weight / count;
    plan->groups[plan->count] = group;
    plan->pieces[plan->count++] = (PieceGroup){plan->plan.count, count, sections};
    plan->plan.count += count;
}

/* The studies and maps that are to be done, in their order. All pointers must outlive the plan. */
static bool make_plan(StabilityPlan *plan, const StabilityStudy *const *studies, int study_count,
                      const StabilityMap *const *maps, int map_count, const char *scenes, const ContenderList *methods,
                      bool quick, Error *error) {
    const size_t count = (size_t)study_count + (size_t)map_count;
    *plan = (StabilityPlan){.plan = {.describe = describe, .work = work, .context = plan}};
    plan->groups = calloc(count + 1, sizeof *plan->groups);
    plan->pieces = calloc(count + 1, sizeof *plan->pieces);
    if (plan->groups == NULL || plan->pieces == NULL) return error_memory(error, "stability");
    for (int i = 0; i < study_count; i++) {
        assert(studies[i] != NULL);
        add_group(
            plan,
            (StabilityGroup){.scan = {studies[i], scenes, methods}, .name = studies[i]->name, .items = methods->count},
            studies[i]->weight, studies[i]->file == NULL, 0);
    }
    for (int i = 0; i < map_count; i++) {
        assert(maps[i] != NULL);
        const int cells = stability_grid_cells(maps[i], quick), all = stability_grid_cells(maps[i], false);
        add_group(plan,
                  (StabilityGroup){.grid = {maps[i], scenes, methods, quick}, .name = maps[i]->name, .items = cells},
                  maps[i]->weight * cells / all, maps[i]->file == NULL, methods->count);
    }
    return true;
}

/* What rigid boxes do; the scenes state the laws. */
static double rigid_staircase(void) { return 1.0 / 10; }                          /* 1 / boxes */
static double rigid_tip(void) { return 1.0 / 5; }                                 /* width / height */
static double rigid_kick(void) { return 5 * sqrt(3 * 10 * (sqrt(26) - 5) / 26); } /* 1 m x 5 m, g = 10 m/s^2 */
static double rigid_ledge(void) { return 0; }
static double rigid_slope(void) { return 0.2; }                     /* friction */
static double rigid_seams(void) { return sqrt(2 * 0.3 * 10 * 10); } /* 2 x friction x g x the way to the edge */

/* clang-format off */
/* from, to, points */
#define LINEAR(...) \
    { __VA_ARGS__, .whole = false }
#define WHOLE(...) \
    { __VA_ARGS__, .whole = true }
#define LOGARITHMIC(...) \
    { __VA_ARGS__, .logarithmic = true }
#define WHOLE_LOGARITHMIC(...) \
    { __VA_ARGS__, .logarithmic = true, .whole = true }

const StabilityStudy stability_studies[] = {
    {"stack_height", "Stack", "stack_height", "height", WHOLE(2, 40, 14), .stands = true, .quick = true, .weight = 18},
    {"stack_cold", "Stack, no warm start", "stack_cold", "height", WHOLE(2, 40, 14), .stands = true, .weight = 18},
    {"iterations", "Stack of ten boxes", "stack_height", "iterations",
     WHOLE_LOGARITHMIC(1, 100, 12, .fails_low = true), .stands = true, .iterations = true, .quick = true, .weight = 4},
    {"iterations_cold", "Ten, no warm start", "stack_cold", "iterations",
     WHOLE_LOGARITHMIC(1, 100, 12, .fails_low = true), .stands = true, .iterations = true, .weight = 5},
    {"time_step", "Stack at long steps", "time_step", "rate", WHOLE_LOGARITHMIC(20, 480, 10, .fails_low = true),
     .stands = true, .weight = 17},
    {"pyramid_rows", "Pyramid", "pyramid_rows", "rows", WHOLE(4, 30, 9), .stands = true, .weight = 69},
    {"pyramid_rate", "Pyramid at long steps", "pyramid_rows", "rate",
     WHOLE_LOGARITHMIC(10, 480, 10, .fails_low = true), .stands = true, .weight = 47},
    {"heavy_on_one", "Heavy box on one", "heavy_on_one", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true,
     .quick = true, .weight = 2},
    {"heavy_on_five", "Heavy box on five", "heavy_on_five", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true,
     .weight = 9},
    {"heavy_on_nine", "Heavy box on nine", "heavy_on_nine", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true,
     .weight = 18},
    {"plate", "Plate on two boxes", "plate", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 3},
    {"gate", "Beam on two stacks", "gate", "mass", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 12},
    {"top_removed", "Load taken away", "top_removed", "ratio", LOGARITHMIC(1, 200, 12), .stands = true, .weight = 5},
    {"tilted_stack", "Tilted stack", "tilted_stack", "shift", LINEAR(0, 0.2, 11), .stands = true, .weight = 7,
     .rigid = rigid_staircase},
    {"tip", "Tall box on a slope", "tip", "slope", LINEAR(0, 0.4, 9), .stands = true, .weight = 1, .rigid = rigid_tip},
    {"kick", "Kicked tall box", "kick", "kick", LINEAR(0, 4, 9), .stands = true, .weight = 1, .rigid = rigid_kick},
    {"ledge", "Box past an edge", "ledge", "past", LINEAR(-0.1, 0.1, 9), .stands = true, .weight = 1,
     .rigid = rigid_ledge},
    {"seams", "Box over seams", "seams", "speed", LINEAR(2, 20, 10), .stands = true, .weight = 1,
     .rigid = rigid_seams},
    {"overlap", "Overlap at the start", "overlap", "spacing", LINEAR(0.4, 1, 13, .fails_low = true), .stands = true,
     .weight = 8},
    {"card_house", "Card house", "card_house", "friction", LINEAR(0.1, 1, 10, .fails_low = true), .stands = true,
     .weight = 8},
    {"arch", "Flat arch", "arch", "friction", LINEAR(0.2, 1, 9, .fails_low = true), .stands = true, .weight = 3},
    {"double_domino", "Two rows of dominoes", "double_domino", "push", LINEAR(0, 3, 7), .weight = 5},
    {"friction_ramp", "Box on a slope", "friction_ramp", "slope", LINEAR(0, 0.6, 13), .stands = true, .quick = true,
     .weight = 1, .rigid = rigid_slope},
    {"far_from_origin", "Far from the origin", "far_from_origin", "distance", LOGARITHMIC(1, 1e6, 13), .stands = true,
     .unshifted = true, .quick = true, .weight = 2},
    {"at_rest", "Stack at rest", "at_rest", "height", WHOLE(1, 20, 10), .stands = true, .rests = true, .weight = 13},
    {"bomb_speed", "Bomb on a thin slab", "bomb_speed", "speed", LOGARITHMIC(5, 200, 12), .quick = true, .weight = 0.5},
    {"bomb_speed_thick", "Bomb on a thick slab", "bomb_speed", "speed", LOGARITHMIC(5, 200, 12),
     .fixed = {"thickness", 1}, .weight = 0.5},
    {"bomb_mass", "Heavy bomb", "random_bombs", "mass", LOGARITHMIC(1, 1000, 13), .weight = 2},
    {"bomb_spin", "Spinning bomb", "random_bombs", "spin", LINEAR(0, 20, 11), .weight = 1},
    {"beyond_x", "Farther than trained", "beyond_training", "x", LINEAR(0, 15, 16), .weight = 1},
    {"beyond_mass", "Heavier than trained", "beyond_training", "mass", LOGARITHMIC(5, 1000, 13), .weight = 1}};

#define ITERATIONS {"iterations", WHOLE_LOGARITHMIC(1, 100, 10), 4}

const StabilityMap stability_maps[] = {
    {.name = "height_iterations", .scene = "stack_height", .x = {"height", WHOLE(2, 40, 10), 4}, .y = ITERATIONS,
     .stands = true, .iterations = true, .quick = true, .weight = 44},
    {.name = "ratio_iterations", .scene = "heavy_on_one", .x = {"ratio", LOGARITHMIC(1, 1000, 10), 4}, .y = ITERATIONS,
     .stands = true, .iterations = true, .quick = true, .weight = 4},
    {.name = "rate_height", .scene = "time_step", .x = {"rate", WHOLE_LOGARITHMIC(20, 480, 8), 3},
     .y = {"height", WHOLE(2, 40, 8), 3}, .stands = true, .weight = 300},
    {.name = "speed_thickness", .scene = "bomb_speed", .x = {"speed", LOGARITHMIC(5, 200, 12), 5},
     .y = {"thickness", LOGARITHMIC(0.1, 2, 10), 4}, .quick = true, .weight = 3},
    {.name = "spin_x", .scene = "random_bombs", .x = {"spin", LINEAR(0, 20, 11), 4}, .y = {"x", LINEAR(-5, 5, 11), 4},
     .quick = true, .weight = 10},
    {.name = "speed_friction", .scene = "seams", .x = {"speed", LINEAR(1, 20, 10), 4},
     .y = {"friction", LINEAR(0.05, 0.95, 10), 4}, .stands = true, .weight = 2},
    /* The grid avoids the border, where the slope equals the friction. */
    {.name = "slope_friction", .scene = "friction_ramp", .x = {"slope", LINEAR(0.025, 0.575, 12), 4},
     .y = {"friction", LINEAR(0.05, 0.6, 12), 4}, .stands = true, .weight = 2}};
/* clang-format on */

const int stability_study_count = sizeof stability_studies / sizeof stability_studies[0];
const int stability_map_count = sizeof stability_maps / sizeof stability_maps[0];

const StabilityStudy *stability_study_find(const char *name) {
    for (int i = 0; i < stability_study_count; i++)
        if (strcmp(stability_studies[i].name, name) == 0) return &stability_studies[i];
    return NULL;
}

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
    run->studies = calloc((size_t)study_count + 1, sizeof *run->studies);
    run->maps = calloc((size_t)map_count + 1, sizeof *run->maps);
    if (run->studies == NULL || run->maps == NULL) return error_memory(error, "stability");
    for (int i = 0; i < study_count; i++)
        if (is_named(options, studies[i].name, studies[i].quick)) run->studies[run->study_count++] = &studies[i];
    for (int i = 0; i < map_count; i++)
        if (is_named(options, maps[i].name, maps[i].quick)) run->maps[run->map_count++] = &maps[i];
    return true;
}

static bool know_names(const StabilityOptions *options, Error *error) {
    for (int i = 0; i < options->name_count; i++) {
        NameList known = {0};
        bool found = stability_study_find(options->names[i]) != NULL;
        for (int k = 0; k < stability_study_count; k++) name_list_add(&known, stability_studies[k].name);
        for (int k = 0; k < stability_map_count; k++) {
            name_list_add(&known, stability_maps[k].name);
            found = found || strcmp(stability_maps[k].name, options->names[i]) == 0;
        }
        if (!found) return error_unknown(error, "stability", options->names[i], "a study or map", &known);
    }
    return true;
}

/* Adds a range that is not in the program. */
static void add_scan_to_key(const char *name, const char *parameter, const BorderScan *scan, StudyKey *key) {
    const double numbers[] = {scan->from, scan->to, scan->points};
    study_key_add(key, name, strlen(name) + 1);
    study_key_add(key, parameter, strlen(parameter) + 1);
    study_key_add(key, numbers, sizeof numbers);
}

static bool add_place_to_key(const StabilityPlace *place, StudyKey *key, Error *error) {
    char path[STABILITY_PATH_SIZE];
    return stability_path(path, place, error) && study_key_add_scene(key, path, error);
}

/* Hashes everything that determines the result: the program, the options, the scenes. */
static bool find_key(const Run *run, StudyKey *key, Error *error) {
    const StabilityOptions *options = run->options;
    if (!study_key_begin(key, error) || !contenders_add_to_key(&run->methods, key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    for (int i = 0; i < run->study_count; i++) {
        const StabilityStudy *study = run->studies[i];
        add_scan_to_key(study->name, study->parameter, &study->scan, key);
        if (!add_place_to_key(&(StabilityPlace){options->scenes, study->scene, study->file}, key, error)) return false;
    }
    for (int i = 0; i < run->map_count; i++) {
        const StabilityMap *map = run->maps[i];
        add_scan_to_key(map->name, map->x.parameter, &map->x.scan, key);
        add_scan_to_key(map->name, map->y.parameter, &map->y.scan, key);
        if (!add_place_to_key(&(StabilityPlace){options->scenes, map->scene, map->file}, key, error)) return false;
    }
    return true;
}

/* A live page for each scene, and the tables that link to them. */
static bool write_pages(const Run *run, Error *error) {
    const StabilityOptions *options = run->options;
    const int count = run->study_count + run->map_count;
    StudyPlace *places = calloc((size_t)count + 1, sizeof *places);
    bool ok = places != NULL || error_memory(error, "stability");
    for (int i = 0; ok && i < count; i++) {
        const StabilityStudy *study = i < run->study_count ? run->studies[i] : NULL;
        const StabilityMap *map = study == NULL ? run->maps[i - run->study_count] : NULL;
        const StabilityPlace where = study != NULL ? (StabilityPlace){options->scenes, study->scene, study->file}
                                                   : (StabilityPlace){options->scenes, map->scene, map->file};
        StudyPlace *place = &places[i];
        place->name = study != NULL ? study->name : map->name;
        place->fixed = study != NULL ? &study->fixed : NULL;
        ok = stability_path(place->path, &where, error);
        int same = 0;
        while (ok && strcmp(places[same].path, place->path) != 0) same++;
        if (same < i)
            place->page = places[same].page;
        else
            ok = ok && study_page_write(&place->page, place->path, &run->methods, options->folder, error);
    }
    ok = ok && stability_html_write(options->folder, places, error);
    free(places);
    return ok;
}

/* What follows from the pieces, once all are there. */
static bool finish(const Run *run, const Pieces *pieces, Error *error) {
    static const CsvLayout *const layouts[] = {&border_layout, &map_layout,         &refusal_layout, &fallback_layout,
                                               &rest_layout,   &unconverged_layout, &engine_layout};
    const StabilityOptions *options = run->options;
    bool external = false;
    for (int i = 0; i < run->methods.count; i++) external |= run->methods.items[i].method.kind->description->external;
    const int count = (int)(sizeof layouts / sizeof *layouts) - !external;
    return piece_tables_write(pieces, options->folder, layouts, count, run->plan.pieces, run->plan.count, error) &&
           (options->draw == NULL || options->draw(options, error)) && write_pages(run, error) &&
           pieces_end(pieces, error);
}

bool stability_run(const StabilityOptions *options, Pieces *pieces, const Progress *progress, Error *error) {
    Run run = {.options = options};
    StudyKey key = {0};
    const bool ok = know_names(options, error) &&
                    contenders_parse(&run.methods, options->methods, STUDY_STABILITY, error) && choose(&run, error) &&
                    make_plan(&run.plan, run.studies, run.study_count, run.maps, run.map_count, options->scenes,
                              &run.methods, options->quick, error) &&
                    find_key(&run, &key, error) && pieces_open(pieces, options->folder, &key, &options->shard, error) &&
                    pieces_do(pieces, &run.plan.plan, progress, error) &&
                    (options->shard.count > 0 || finish(&run, pieces, error));
    pieces->plan = NULL;
    for (int i = 0; i < run.plan.count; i++) {
        stability_scan_end(&run.plan.groups[i].scanned);
        stability_grid_end(&run.plan.groups[i].mapped);
    }
    free(run.plan.groups);
    free(run.plan.pieces);
    contenders_free(&run.methods);
    free(run.studies);
    free(run.maps);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/gns_study.h"

#include "common/parallel.h"
#include "paper/figures/plot_parts.h"
#include "paper/systems/gns_cost.h"
#include "paper/systems/gns_rollout.h"
#include "study/piece_tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const char *const gns_measure_words[GNS_MEASURES + 1] = {"rollout", "large", "cost"};

const GnsVariant gns_variants[GNS_VARIANTS] = {{"M = 5", "gns.npz", "", 5},
                                               {"M = 2", "gns-m2.npz", "", 2},
                                               {"M = 1", "gns-m1.npz", "", 1},
                                               {"without noise", "gns-no-noise.npz", "", 5},
                                               {"rigid=off", "gns.npz", "rigid=off", 5}};

static const CsvColumn columns[] = {
    {"measure", CSV_WORD, .offset = offsetof(GnsRow, measure), .words = gns_measure_words, .key = true},
    {"variant", CSV_NAME, .offset = offsetof(GnsRow, variant), .key = true},
    {"scene", CSV_NAME, .offset = offsetof(GnsRow, scene), .key = true},
    {"seconds", CSV_OPTIONAL, .offset = offsetof(GnsRow, seconds), .maximum = 1e6, .key = true},
    {"boxes", CSV_OPTIONAL, .offset = offsetof(GnsRow, boxes), .maximum = 1e6},
    {"error", CSV_OPTIONAL, .offset = offsetof(GnsRow, error), .maximum = 1e30},
    {"shape", CSV_OPTIONAL, .offset = offsetof(GnsRow, shape), .maximum = 1e30},
    {"moved", CSV_OPTIONAL, .offset = offsetof(GnsRow, moved), .maximum = 1e6},
    {"moved_engine", CSV_OPTIONAL, .offset = offsetof(GnsRow, moved_engine), .maximum = 1e6},
    {"ms_step", CSV_OPTIONAL, .offset = offsetof(GnsRow, ms_step), .maximum = 1e12},
    {"ms_gradient", CSV_OPTIONAL, .offset = offsetof(GnsRow, ms_gradient), .maximum = 1e12},
    {"hours", CSV_OPTIONAL, .offset = offsetof(GnsRow, hours), .maximum = 1e12},
};
const CsvLayout gns_table_layout = CSV_LAYOUT("system_gns", columns, GnsRow, .min_rows = 1, .max_rows = GNS_MAX_ROWS);

static const GnsRow empty_row = {.seconds = NAN,
                                 .boxes = NAN,
                                 .error = NAN,
                                 .shape = NAN,
                                 .moved = NAN,
                                 .moved_engine = NAN,
                                 .ms_step = NAN,
                                 .ms_gradient = NAN,
                                 .hours = NAN};

/* Scenes of the rollouts, and of large piles: file below the folder of scenes, name in the table. */
typedef struct Place {
    const char *file, *name;
    int launches, quick_launches;
} Place;

static const Place rollouts[] = {
    {"single.yaml", "single", 8, 1}, {"stack.yaml", "stack", 8, 1}, {"pyramid_settled.yaml", "pyramid_settled", 4, 0}};
static const Place large[] = {{"pyramid.yaml", "pyramid", 2, 1}, {"families/pyramid_18.yaml", "pyramid_18", 4, 0}};

enum { PATH_SIZE = 4096 };

static bool join(char path[PATH_SIZE], const char *folder, const char *name, Error *error) {
    return snprintf(path, PATH_SIZE, "%s/%s", folder, name) < PATH_SIZE ||
           error_input(error, folder, "the name is too long");
}

static Scene *read_scene(const SystemStudy *study, const Place *place, Error *error) {
    char path[PATH_SIZE];
    return join(path, study->scenes, place->file, error) ? scene_read(path, error) : NULL;
}

/* Rollouts of all variants, each launch. */
typedef struct Rollouts {
    const SystemStudy *study;
    const Scene *scene;
    const Launch *launches;
    int launch_count;
    GnsRollout *rollouts; /* [GNS_VARIANTS, launch_count] */
} Rollouts;

static bool roll(const SystemStudy *study, const Scene *scene, const Launch *launch, const GnsVariant *variant,
                 GnsRollout *rollout, Error *error) {
    char folder[PATH_SIZE], path[PATH_SIZE];
    const Scene launched = launch_scene(scene, launch);
    return join(folder, study->scenes, "networks", error) && join(path, folder, variant->network, error) &&
           gns_rollout_run(rollout, &launched, path, variant->settings, error);
}

static bool roll_one(void *context, int i, Error *error) {
    const Rollouts *all = context;
    return roll(all->study, all->scene, &all->launches[i % all->launch_count], &gns_variants[i / all->launch_count],
                &all->rollouts[i], error);
}

static bool print_rollouts(const Rollouts *all, const char *scene, int variant, FILE *lines, Error *error) {
    const GnsRollout *runs = all->rollouts + (ptrdiff_t)variant * all->launch_count;
    for (int t = 0; t < GNS_TIMES; t++) {
        GnsRow row = empty_row;
        row.measure = GNS_ROLLOUT;
        row.variant = gns_variants[variant].name;
        row.scene = scene;
        row.seconds = gns_times[t];
        row.boxes = runs[0].boxes;
        row.error = row.shape = 0;
        for (int i = 0; i < all->launch_count; i++) {
            row.error += runs[i].error[t] / all->launch_count;
            row.shape += runs[i].shape[t] / all->launch_count;
        }
        if (!piece_tables_print(lines, &gns_table_layout, -1, &row, error)) return false;
    }
    return true;
}

static bool write_rollouts(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Place *place = &rollouts[index];
    const int count = study->quick ? place->quick_launches : place->launches;
    if (count == 0) return true;
    Scene *scene = read_scene(study, place, error);
    Launch *launches = calloc((size_t)count, sizeof *launches);
    Rollouts all = {study, scene, launches, count, calloc((size_t)count * GNS_VARIANTS, sizeof *all.rollouts)};
    bool ok = scene != NULL && ((launches != NULL && all.rollouts != NULL) || error_memory(error, place->name)) &&
              launches_for_scoring(scene, count, launches, error) &&
              parallel_for(&(ParallelWork){roll_one, &all}, count * GNS_VARIANTS, place->name, progress, error);
    for (int v = 0; ok && v < GNS_VARIANTS; v++) ok = print_rollouts(&all, place->name, v, lines, error);
    free(all.rollouts);
    free(launches);
    scene_destroy(scene);
    return ok;
}

/* One after the other, as steps are timed. */
static bool write_large(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Place *place = &large[index];
    const int count = study->quick ? place->quick_launches : place->launches;
    if (count == 0) return true;
    Scene *scene = read_scene(study, place, error);
    Launch *launches = calloc((size_t)count, sizeof *launches);
    bool ok = scene != NULL && (launches != NULL || error_memory(error, place->name)) &&
              launches_for_scoring(scene, count, launches, error);
    GnsRow row = empty_row;
    row.measure = GNS_LARGE;
    row.variant = gns_variants[GNS_SHIPPED].name;
    row.scene = place->name;
    row.seconds = gns_times[GNS_TIMES - 1];
    row.error = row.moved = row.moved_engine = row.ms_step = 0;
    for (int i = 0; ok && i < count; i++) {
        GnsRollout run = {.boxes = 0};
        ok = roll(study, scene, &launches[i], &gns_variants[GNS_SHIPPED], &run, error);
        row.boxes = run.boxes;
        row.error += run.error[GNS_TIMES - 1] / count;
        row.moved += run.moved / count;
        row.moved_engine += run.moved_teacher / count;
        row.ms_step += 1e3 * run.seconds_a_step / count;
        if (ok && !progress_report(progress, i + 1, count)) ok = error_interrupted(error, place->name, "stopped");
    }
    ok = ok && piece_tables_print(lines, &gns_table_layout, -1, &row, error);
    free(launches);
    scene_destroy(scene);
    return ok;
}

static bool write_cost(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    static const int widths[] = {16, 128}, rounds[] = {5, 10};
    static const Place place = {"pyramid_settled.yaml", "pyramid_settled", 1, 1};
    GnsCost costs[2];
    char path[PATH_SIZE], name[CSV_NAME_SIZE];
    (void)index;
    if (!join(path, study->scenes, place.file, error) ||
        !gns_cost_measure(path, widths, rounds, 2, study->quick ? 1 : 10, costs, progress, error))
        return false;
    for (int i = 0; i < 2; i++) {
        GnsRow row = empty_row;
        snprintf(name, sizeof name, "width %d, M = %d", widths[i], rounds[i]);
        row.measure = GNS_COST;
        row.variant = name;
        row.scene = place.name;
        row.boxes = costs[i].boxes;
        row.ms_step = 1e3 * costs[i].seconds_a_pass;
        row.ms_gradient = 1e3 * costs[i].seconds_a_gradient;
        row.hours = costs[i].hours;
        if (!piece_tables_print(lines, &gns_table_layout, -1, &row, error)) return false;
    }
    return true;
}

static const SystemPart parts[] = {{"rollouts-single", .weight = 2, .quick_weight = 0.3, .write = write_rollouts},
                                   {"rollouts-stack", 10, 0.7, 1, write_rollouts, false},
                                   {"rollouts-pyramid", 30, 0, 2, write_rollouts, false},
                                   {"large-66", 8, 0.5, 0, write_large, true},
                                   {"large-171", 8, 0, 1, write_large, true},
                                   {"cost", 8, 0.5, 0, write_cost, true},
                                   {0}};

const PaperSystem system_gns = {.name = "gns",
                                .methods = SYSTEM_METHODS("gns", "gns:rigid=off", "gns:net=off"),
                                .table = &gns_table_layout,
                                .parts = parts,
                                .claim = gns_claims,
                                .plot = plot_gns};

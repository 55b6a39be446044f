/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole study: its sizes and aims, what its parts share, and its tables from the parts. */
#include "paper/paper.h"

#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "paper/paper_internal.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/piece_tables.h"

#include <stdlib.h>

const PaperSize paper_whole_size = {
    .data = {.swept = "-5:5:0.05",
             .mixed = "-5:5:0.1",
             .transfer = "-5:5:0.5",
             .random = 201,
             .mixed_random = 100,
             .every = 17,
             .dense_every = 3,
             .impulse_every = 173,
             .impulse_dense_every = 31},
    .splits = 8,
    .scored_splits = 5,
    .constant_splits = 100,
    .iterations = 2000,
    .rate_launches = 20,
    .closed_launches = 5,
    .repetitions = 7,
    .sampling = {.after = 6, .rest = 30},
    .seeds = 5,
    .law_iterations = 300,
    .transfer_iterations = 300,
    .weights = {0.01, 0.1, 1, 10},
    .launches = {1, 2, 4, 8, 16},
    .system_launches = 10,
    .system_timed_frames = 90,
    .system_repetitions = 3,
};

const PaperSize paper_quick_size = {
    .data = {.swept = "-5:5:1",
             .mixed = "-5:5:2",
             .transfer = "-5:5:2",
             .random = 11,
             .mixed_random = 5,
             .every = 17,
             .dense_every = 11,
             .impulse_every = 173,
             .impulse_dense_every = 113},
    .splits = 2,
    .scored_splits = 2,
    .constant_splits = 3,
    .iterations = 100,
    .rate_launches = 2,
    .closed_launches = 1,
    .repetitions = 3,
    .sampling = {.after = 20, .rest = 120},
    .seeds = 2,
    .law_iterations = 30,
    .transfer_iterations = 30,
    .weights = {1},
    .launches = {1, 4},
    .system_launches = 1,
    .system_frames = 60,
    .system_timed_frames = 20,
    .system_repetitions = 2,
};

void launched_free(Launched *launched) {
    for (int i = 0; launched->states != NULL && i < launched->count; i++) snapshots_free(&launched->states[i]);
    free(launched->states);
    free(launched->launches);
    scene_destroy(launched->scene);
    *launched = (Launched){0};
}

bool launched_begin(Launched *launched, const char *path, int count, Error *error) {
    *launched = (Launched){.scene = scene_read(path, error), .count = count};
    if (launched->scene == NULL) return false;
    Launch *launches = malloc((size_t)count * sizeof *launches);
    launched->launches = malloc((size_t)count * sizeof *launched->launches);
    launched->states = calloc((size_t)count, sizeof *launched->states);
    bool ok = launches != NULL && launched->launches != NULL && launched->states != NULL;
    if (!ok) error_memory(error, path);
    if (ok && !launched->scene->bomb.present) ok = error_input(error, path, "the scene has no bomb");
    ok = ok && launches_for_scoring(launched->scene, count, launches, error);
    for (int i = 0; ok && i < count; i++) launched->launches[i] = launch_scene(launched->scene, &launches[i]);
    free(launches);
    if (!ok) launched_free(launched);
    return ok;
}

static bool write_tables(const PaperPlan *plan, Error *error) {
    static const CsvLayout *const layouts[] = {
        &paper_score_layout,       &paper_trained_layout, &paper_constant_layout, &paper_rate_layout,
        &paper_closed_loop_layout, &paper_law_layout,     &paper_transfer_layout, &system_score_layout};
    const char *folder = plan->options->folder;
    const PaperSize *size = plan->size;
    const struct {
        const char *key;
        double value;
    } numbers[] = {{"seed", (double)plan->options->seed},
                   {"networks", plan->network_count},
                   {"splits", size->splits},
                   {"splits_rated_and_in_closed_loop", size->scored_splits},
                   {"splits_of_the_constant", size->constant_splits},
                   {"seeds_of_laws_and_transfer", size->seeds},
                   {"iterations", size->iterations},
                   {"launches_random", size->data.random},
                   {"rows_kept_one_in", size->data.every},
                   {"rows_kept_one_in_dense", size->data.dense_every},
                   {"rows_of_impulses_kept_one_in", size->data.impulse_every},
                   {"rows_of_impulses_kept_one_in_dense", size->data.impulse_dense_every},
                   {"launches_rated", size->rate_launches},
                   {"launches_in_closed_loop", size->closed_launches}};
    enum { NUMBERS = sizeof numbers / sizeof *numbers, WORDS = 2 };
    char texts[NUMBERS][24], path[CSV_PATH_SIZE];
    FactRow facts[WORDS + NUMBERS] = {{"quick", plan->options->quick ? "on" : "off"},
                                      {"launches_swept", size->data.swept}};
    for (int i = 0; i < NUMBERS; i++) {
        snprintf(texts[i], sizeof texts[i], "%.0f", numbers[i].value);
        facts[WORDS + i] = (FactRow){numbers[i].key, texts[i]};
    }
    return piece_tables_write(plan->pieces, folder, layouts, sizeof layouts / sizeof *layouts, NULL, 0, error) &&
           csv_table_path(path, folder, &paper_fact_layout, error) &&
           csv_table_write(path, &paper_fact_layout, facts, sizeof facts / sizeof *facts, error);
}

bool paper_run(const PaperOptions *options, Pieces *pieces, const Progress *progress, Error *error) {
    PaperPlan *plan = malloc(sizeof *plan);
    StudyKey key = {0};
    if (plan == NULL) return error_memory(error, "paper");
    bool ok = paper_plan_make(plan, options, error);
    plan->pieces = pieces;
    /* A hash of all that decides the result: the program, the options, the scenes. */
    ok = ok && study_key_begin(&key, error);
    if (ok) {
        study_key_add(&key, &options->quick, sizeof options->quick);
        study_key_add(&key, &options->seed, sizeof options->seed);
    }
    for (int i = 0; ok && i < PAPER_SCENES; i++) ok = study_key_add_file(&key, plan->datasets.scenes[i], error);
    ok = ok && pieces_open(pieces, options->folder, &key, &options->shard, error) &&
         file_make_directory(plan->networks_folder, error) && pieces_do(pieces, &plan->plan, progress, error);
    /* What follows from the parts, once all are there. */
    if (options->shard.count == 0)
        ok = ok && write_tables(plan, error) && options->draw(options, error) && pieces_end(pieces, error);
    pieces->plan = NULL;
    paper_plan_free(plan);
    free(plan);
    return ok;
}

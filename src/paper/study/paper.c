/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper.h"

#include "common/file.h"
#include "common/folder_reserve.h"
#include "paper/study/paper_plan.h"
#include "paper/study/paper_tables.h"
#include "study/piece_tables.h"

#include <stdlib.h>

/* The study's parameters, for the report. */
static bool write_facts(const PaperPlan *plan, Error *error) {
    const PaperSize *size = plan->size;
    const double values[] = {(double)plan->options->seed, plan->network_count, size->iterations,
                             size->data.random,           size->rate_launches, size->closed_launches};
    char numbers[sizeof values / sizeof *values][24], path[CSV_PATH_SIZE];
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        snprintf(numbers[i], sizeof numbers[i], "%.0f", values[i]);
    const FactRow facts[] = {{"quick", plan->options->quick ? "on" : "off"},
                             {"seed", numbers[0]},
                             {"networks", numbers[1]},
                             {"iterations", numbers[2]},
                             {"launches_swept", size->data.swept},
                             {"launches_swept_finely", size->data.fine},
                             {"launches_swept_most_finely", size->data.finest},
                             {"launches_swept_as_in_the_paper", size->data.paper},
                             {"launches_random", numbers[3]},
                             {"launches_rated", numbers[4]},
                             {"launches_in_closed_loop", numbers[5]}};
    return csv_table_path(path, plan->options->folder, &paper_fact_layout, error) &&
           csv_table_write(path, &paper_fact_layout, facts, sizeof facts / sizeof *facts, error);
}

static bool write_tables(const PaperPlan *plan, Error *error) {
    enum { TABLES_MAX = 32 };
    const char *folder = plan->options->folder;
    const CsvLayout *layouts[TABLES_MAX] = {&paper_score_layout,       &paper_trained_layout, &paper_rate_layout,
                                            &paper_closed_loop_layout, &paper_law_layout,     &paper_transfer_layout,
                                            &system_score_layout};
    int count = 7;
    for (int i = 0; paper_systems[i] != NULL; i++) layouts[count++] = paper_systems[i]->table;
    return piece_tables_write(plan->pieces, folder, layouts, count, NULL, 0, error) &&
           system_claims_write(paper_systems, folder, error) && write_facts(plan, error);
}

/* A hash of all that decides the result: the program, the options, the scenes. */
static bool find_key(const PaperPlan *plan, StudyKey *key, Error *error) {
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &plan->options->quick, sizeof plan->options->quick);
    study_key_add(key, &plan->options->seed, sizeof plan->options->seed);
    for (int i = 0; i < PAPER_SCENES; i++)
        if (!study_key_add_file(key, plan->datasets.scenes[i], error)) return false;
    return true;
}

/* A report whose columns of times are partly empty would state what it did not measure. */
static bool check_times(const Pieces *pieces, Error *error) {
    return !pieces->cpus_differ || pieces->mode != PIECES_MERGE ||
           error_input(error, pieces->folder,
                       "times were measured on different processors, on %s and on others; a report needs times of one: "
                       "delete those pieces, and run their shard again",
                       pieces->cpu);
}

/* What follows from the parts, once all are there. */
static bool finish(const PaperPlan *plan, Error *error) {
    const PaperOptions *options = plan->options;
    return check_times(plan->pieces, error) && folder_reserve(options->folder, error) && write_tables(plan, error) &&
           options->draw(options, error) && pieces_end(plan->pieces, error);
}

/* Shards share a folder; a whole study has it to itself. */
static bool do_parts(PaperPlan *plan, Pieces *pieces, const StudyKey *key, const Progress *progress, Error *error) {
    const PaperOptions *options = plan->options;
    plan->pieces = pieces;
    return pieces_open(pieces, options->folder, false, key, options->run, error) &&
           (pieces->mode != PIECES_WHOLE || folder_reserve(options->folder, error)) &&
           (pieces->mode == PIECES_MERGE || file_make_directory(plan->networks_folder, error)) &&
           pieces_do(pieces, &plan->plan, progress, error) && (pieces->mode == PIECES_SHARD || finish(plan, error));
}

bool paper_run(const PaperOptions *options, Pieces *pieces, const Progress *progress, Error *error) {
    PaperPlan *plan = malloc(sizeof *plan);
    StudyKey key = {0};
    if (plan == NULL) return error_memory(error, "paper");
    const bool ok = paper_plan_make(plan, options, error) && find_key(plan, &key, error) &&
                    do_parts(plan, pieces, &key, progress, error);
    pieces->plan = NULL;
    study_key_free(&key);
    paper_plan_free(plan);
    free(plan);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper.h"

#include "common/file.h"
#include "common/folder_reserve.h"
#include "paper/study/paper_outlook.h"
#include "paper/study/paper_scores.h"
#include "paper/study/paper_size.h"
#include "paper/study/paper_tables.h"
#include "paper/study/paper_training.h"
#include "paper/systems/system.h"
#include "study/study_key.h"
#include "study/study_parts.h"

#include <stdlib.h>
#include <string.h>

static const char *const law_names[] = {"all", "momentum", "energy", "approach", "cone"};

enum { LAW_SETS = sizeof law_names / sizeof law_names[0], PART_NAME_SIZE = 128 };

/* The study in progress. */
typedef struct Run {
    const PaperOptions *options;
    const PaperSize *size;
    bool counting; /* only add up the weights of the parts */
    StudyParts parts;
    PaperDatasets datasets;
    PaperOutlook outlook;
    char networks_folder[PAPER_PATH_SIZE];
    PaperNetwork *networks; /* [network_count] of this study */
    int network_count;
} Run;

static bool do_part(Run *run, const StudyPart *part, Error *error) {
    if (!run->counting) return study_parts_do(&run->parts, part, error);
    run->parts.total += part->weight;
    return true;
}

static void choose_networks(Run *run) {
    for (int i = 0; i < paper_network_count; i++) {
        PaperNetwork network = paper_network(i);
        if (run->options->quick && !network.quick) continue;
        if (network.iterations > run->size->iterations) network.iterations = run->size->iterations;
        run->networks[run->network_count++] = network;
    }
}

/* About the seconds on two cores for 2000 iterations. */
static double training_weight(const PaperNetwork *network) {
    static const double of_data[PAPER_DATA] = {
        [DATA_SWEPT] = 2, [DATA_RANDOM] = 2, [DATA_MIXED] = 2, [DATA_FINE] = 8, [DATA_FINEST] = 10, [DATA_PAPER] = 16};
    double weight = of_data[network->data];
    if (strcmp(network->optimizer, "lm") == 0) weight *= 35;
    if (strcmp(network->optimizer, "bfgs") == 0) weight *= 3;
    if (pair_views[network->view].by_contact) weight *= network->target == TARGET_POINTS ? 8 : 4;
    return weight * network->iterations / 2000;
}

static bool train_networks(Run *run, Error *error) {
    for (int i = 0; i < run->network_count; i++) {
        char name[PART_NAME_SIZE];
        PaperTraining training = {&run->datasets, run->networks[i], run->networks_folder, run->options->seed};
        snprintf(name, sizeof name, "network-%s", training.network.name);
        const StudyPart part = {name, training_weight(&training.network), paper_training_write, &training};
        if (!do_part(run, &part, error)) return false;
    }
    return true;
}

static bool score_networks(Run *run, Error *error) {
    for (int i = 0; i < PAPER_SCENES; i++) {
        char rates[PART_NAME_SIZE], closed[PART_NAME_SIZE];
        PaperScoring scoring = {.scene = i,
                                .path = run->datasets.scenes[i],
                                .folder = run->networks_folder,
                                .networks = run->networks,
                                .count = run->network_count,
                                .rate_launches = run->size->rate_launches,
                                .closed_launches = run->size->closed_launches,
                                .sampling = run->size->sampling,
                                .repetitions = run->size->repetitions};
        const double weight = i < PAPER_TRAINING_SCENES ? 2 : 10;
        snprintf(rates, sizeof rates, "rates-%s", paper_scene_names[i]);
        snprintf(closed, sizeof closed, "closed-loop-%s", paper_scene_names[i]);
        const StudyPart rating = {rates, weight, paper_rates_write, &scoring};
        const StudyPart closing = {closed, weight, paper_closed_loop_write, &scoring};
        if (!do_part(run, &rating, error) || !do_part(run, &closing, error)) return false;
    }
    return true;
}

static bool train_with_laws(Run *run, const char *laws, double law_weight, Error *error) {
    for (int seed = 0; seed < (laws == NULL ? 1 : run->size->seeds); seed++) {
        char name[PART_NAME_SIZE];
        PaperLaws own = {&run->outlook,
                         {laws, law_weight, run->options->seed + (uint64_t)seed, run->size->law_iterations}};
        snprintf(name, sizeof name, "laws-%s-%g-%d", laws == NULL ? "engine" : laws, law_weight, seed);
        const StudyPart part = {name, laws == NULL ? 0.1 : 2, paper_laws_write, &own};
        if (!do_part(run, &part, error)) return false;
    }
    return true;
}

static bool study_laws(Run *run, Error *error) {
    if (!train_with_laws(run, NULL, 0, error) || !train_with_laws(run, "none", 0, error)) return false;
    for (int law = 0; law < LAW_SETS; law++)
        for (int w = 0; w < PAPER_WEIGHTS && run->size->weights[w] > 0; w++)
            if (!train_with_laws(run, law_names[law], run->size->weights[w], error)) return false;
    return true;
}

static bool study_transfer(Run *run, Error *error) {
    for (int transfer = 0; transfer < 2; transfer++)
        for (int seed = 0; seed < run->size->seeds; seed++)
            for (int n = 0; n < PAPER_LAUNCHES && run->size->launches[n] > 0; n++) {
                char name[PART_NAME_SIZE];
                PaperTransfer own = {&run->outlook,
                                     {.transfer = transfer == 1,
                                      .seed = run->options->seed + (uint64_t)seed,
                                      .launches = run->size->launches[n],
                                      .iterations = run->size->transfer_iterations}};
                snprintf(name, sizeof name, "transfer-%d-%d-%d", transfer, seed, own.study.launches);
                const StudyPart part = {name, own.study.launches + 2 * transfer, paper_transfer_write, &own};
                if (!do_part(run, &part, error)) return false;
            }
    return true;
}

/* About the seconds on two cores. */
static double scoring_weight(const PaperSize *size, int scene) {
    const double run = scene < PAPER_TRAINING_SCENES ? 1 : 8, whole_frames = 300;
    return size->system_launches * run * (size->system_frames > 0 ? size->system_frames / whole_frames : 1);
}

static bool score_systems(Run *run, Error *error) {
    const PaperSize *size = run->size;
    for (int i = 0; i < PAPER_SCENES; i++) {
        char name[PART_NAME_SIZE];
        SystemScoring scoring = {.systems = paper_systems,
                                 .scene = i,
                                 .path = run->datasets.scenes[i],
                                 .launches = size->system_launches,
                                 .frames = size->system_frames,
                                 .timed_frames = size->system_timed_frames,
                                 .repetitions = size->system_repetitions};
        snprintf(name, sizeof name, "systems-%s", paper_scene_names[i]);
        const StudyPart part = {name, scoring_weight(size, i), system_scores_write, &scoring};
        if (!do_part(run, &part, error)) return false;
    }
    return true;
}

static bool study_systems(Run *run, Error *error) {
    const SystemStudy study = {run->options->scenes, run->options->quick, run->options->seed};
    for (int i = 0; paper_systems[i] != NULL; i++)
        for (const SystemPart *own = paper_systems[i]->parts; own->name != NULL; own++) {
            char name[PART_NAME_SIZE];
            SystemWork work = {&study, own};
            snprintf(name, sizeof name, "system-%s-%s", paper_systems[i]->name, own->name);
            const StudyPart part = {name, study.quick ? own->quick_weight : own->weight, system_part_write, &work};
            if (!do_part(run, &part, error)) return false;
        }
    return score_systems(run, error);
}

static bool all_parts(Run *run, Error *error) {
    return train_networks(run, error) && score_networks(run, error) && study_laws(run, error) &&
           study_transfer(run, error) && study_systems(run, error);
}

/* The study's parameters, for the report. */
static bool write_facts(const Run *run, Error *error) {
    const PaperSize *size = run->size;
    const double values[] = {(double)run->options->seed, run->network_count,  size->iterations,
                             size->data.random,          size->rate_launches, size->closed_launches};
    char numbers[sizeof values / sizeof *values][24], path[CSV_PATH_SIZE];
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        snprintf(numbers[i], sizeof numbers[i], "%.0f", values[i]);
    const FactRow facts[] = {{"quick", run->options->quick ? "on" : "off"},
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
    return csv_table_path(path, run->options->folder, &paper_fact_layout, error) &&
           csv_table_write(path, &paper_fact_layout, facts, sizeof facts / sizeof *facts, error);
}

static bool write_tables(const Run *run, Error *error) {
    static const CsvLayout *const layouts[] = {&paper_score_layout,       &paper_trained_layout, &paper_rate_layout,
                                               &paper_closed_loop_layout, &paper_law_layout,     &paper_transfer_layout,
                                               &system_score_layout};
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (!study_parts_table(&run->parts, run->options->folder, layouts[i], error)) return false;
    for (int i = 0; paper_systems[i] != NULL; i++)
        if (!study_parts_table(&run->parts, run->options->folder, paper_systems[i]->table, error)) return false;
    return system_claims_write(paper_systems, run->options->folder, error) && write_facts(run, error);
}

/* A hash of all that decides the result: the program, the options, the scenes. */
static bool find_key(const Run *run, uint64_t *key, Error *error) {
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &run->options->quick, sizeof run->options->quick);
    study_key_add(key, &run->options->seed, sizeof run->options->seed);
    for (int i = 0; i < PAPER_SCENES; i++)
        if (!study_key_add_file(key, run->datasets.scenes[i], error)) return false;
    return true;
}

static bool begin(Run *run, Error *error) {
    uint64_t key;
    if (!file_path(run->networks_folder, sizeof run->networks_folder, error, "%s/networks", run->options->folder))
        return false;
    run->networks = malloc((size_t)paper_network_count * sizeof *run->networks);
    if (run->networks == NULL) return error_memory(error, "paper");
    choose_networks(run);
    for (int i = 0; i < 3; i++) run->outlook.bomb_x[i] = run->size->transfer_x[i];
    run->outlook.datasets = &run->datasets;
    return paper_datasets_begin(&run->datasets, run->options->scenes, &run->size->data, run->options->seed, error) &&
           find_key(run, &key, error) && folder_reserve(run->options->folder, error) &&
           file_make_directory(run->networks_folder, error) &&
           study_parts_open(&run->parts, run->options->folder, key, error);
}

bool paper_run(const PaperOptions *options, const Progress *progress, Error *error) {
    Run run = {.options = options, .size = options->quick ? &paper_quick_size : &paper_whole_size, .counting = true};
    run.parts.progress = progress;
    bool ok = begin(&run, error) && all_parts(&run, error);
    run.counting = false;
    ok = ok && all_parts(&run, error) && write_tables(&run, error);
    ok = ok && options->draw(options, error) && study_parts_remove(&run.parts, error);
    study_parts_close(&run.parts);
    paper_outlook_free(&run.outlook);
    paper_datasets_free(&run.datasets);
    free(run.networks);
    return ok;
}

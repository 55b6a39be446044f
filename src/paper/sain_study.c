/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of sain: trainings on few launches of the stack, scored on held-out ones of two scenes. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "learning/learning.h"
#include "learning/sain_training.h"
#include "learning/scene_training.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"
#include "studies/piece_tables.h"
#include "studies/statistics.h"

#include <stdlib.h>

enum { SEEDS = 3, STEPS = 500, QUICK_STEPS = 40, BATCH = 256, PATH_SIZE = 4096 };

/* Held-out launches. */
static const int held_out[SAIN_SCENES] = {24, 5}, quick_held_out[SAIN_SCENES] = {3, 1};

static const double first_rate = 0.003;

/* Scene files without .yaml. */
static const char *const sain_scene_words[SAIN_SCENES + 1] = {"stack", "pyramid_settled", NULL};

static const CsvColumn columns[] = {
    {"scene", CSV_WORD, offsetof(SainRow, scene), .words = sain_scene_words, .key = true},
    {"engine", CSV_WORD, offsetof(SainRow, form), .words = sain_form_names, .key = true},
    {"launches", CSV_INTEGER, offsetof(SainRow, launches), .minimum = 1, .maximum = SAIN_MAX_LAUNCHES, .key = true},
    {"seed", CSV_INTEGER, offsetof(SainRow, seed), .minimum = 1, .maximum = 1000000, .key = true},
    {"error", CSV_NUMBER, offsetof(SainRow, error), .maximum = 1e9},
    {"engine_error", CSV_NUMBER, offsetof(SainRow, engine), .maximum = 1e9},
    {"constant_error", CSV_NUMBER, offsetof(SainRow, constant), .maximum = 1e9},
};
const CsvLayout sain_layout = CSV_LAYOUT("system_sain", columns, SainRow, .min_rows = 1, .max_rows = 5000);

/* What the trainings of a part share. */
typedef struct Data {
    const SystemStudy *study;
    int launches, seeds;
    ImpactProblems trained, scored[SAIN_SCENES];
    SainRow *rows; /* [SAIN_FORMS, seeds, SAIN_SCENES] */
} Data;

static bool sain_study_record(const SystemStudy *study, SainScene scene, int launches, bool scoring,
                              ImpactProblems *problems, const Progress *progress, Error *error) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s.yaml", study->scenes, sain_scene_words[scene]);
    Scene *read = scene_read(path, error);
    const SainLaunches from = {&read, 1, launches, 1, 0, scoring, NULL};
    const bool ok = read != NULL && sain_launches_record(&from, problems, progress, error);
    scene_destroy(read);
    return ok;
}

/* A training in memory. */
typedef struct Learner {
    SainNetwork network;
    SainSamples samples;
    SainFit fit;
    Adam adam;
} Learner;

static void free_learner(Learner *learner) {
    sain_fit_free(&learner->fit);
    adam_free(&learner->adam);
    sain_samples_free(&learner->samples);
    sain_network_destroy(&learner->network);
}

static bool sain_study_learn(Learner *learner, const Data *data, uint64_t seed, Error *error) {
    const int steps = data->study->quick ? QUICK_STEPS : STEPS;
    double loss;
    if (!sain_network_create(&learner->network, error) ||
        !sain_samples_add(&learner->samples, &data->trained, false, error) ||
        !adam_create(&learner->adam, sain_weight_count(&learner->network), ADAM_SQUARE_DECAY, error))
        return false;
    if (learner->samples.count == 0) return error_input(error, "sain", "no box is touched");
    sain_normalise(&learner->network, &learner->samples);
    sain_set_ranges(&learner->network, &learner->samples);
    sain_first_weights(&learner->network, seed, learner->adam.weights);
    if (!sain_fit_begin(&learner->fit, &learner->network, &learner->samples, BATCH, error)) return false;
    for (int step = 0; step < steps; step++)
        if (!sain_fit_step(&learner->fit, &learner->adam, seed, step, first_rate * (1 - (double)step / steps), &loss,
                           error))
            return false;
    return true;
}

/* The engine alone is what the form that knows it would correct. */
static bool sain_study_score(Learner *learner, const Data *data, SainScene scene, SainRow *row, Error *error) {
    SainSamples samples = {.form = learner->samples.form}, engine = {.form = SAIN_WITH_ENGINE};
    SainErrors errors = {0}, of_engine = {0};
    bool ok = sain_samples_add(&samples, &data->scored[scene], true, error) &&
              sain_samples_add(&engine, &data->scored[scene], true, error);
    if (ok && samples.count == 0) ok = error_input(error, "sain", "no held-out launch has an impact");
    ok = ok && sain_fit_errors(&learner->fit, learner->adam.weights, &samples, &errors, error) &&
         sain_fit_errors(&learner->fit, learner->adam.weights, &engine, &of_engine, error);
    row->error = errors.with;
    row->constant = errors.constant;
    row->engine = of_engine.without;
    sain_samples_free(&samples);
    sain_samples_free(&engine);
    return ok;
}

/* Training i: a form and a seed. */
static bool train_one(void *context, int i, Error *error) {
    const Data *data = context;
    const int form = i / data->seeds, seed = i % data->seeds;
    Learner learner = {.samples = {.form = (SainForm)form}};
    bool ok = sain_study_learn(&learner, data, data->study->seed + (uint64_t)seed * 7919, error);
    for (SainScene scene = 0; ok && scene < SAIN_SCENES; scene++) {
        SainRow *row = &data->rows[i * SAIN_SCENES + (int)scene];
        *row = (SainRow){(int)scene, form, data->launches, seed + 1, 0, 0, 0};
        ok = sain_study_score(&learner, data, scene, row, error);
    }
    free_learner(&learner);
    return ok;
}

static bool record_all(Data *data, const Progress *progress, Error *error) {
    const int *counts = data->study->quick ? quick_held_out : held_out;
    for (SainScene scene = 0; scene < SAIN_SCENES; scene++)
        if (!sain_study_record(data->study, scene, counts[scene], true, &data->scored[scene], progress, error))
            return false;
    return sain_study_record(data->study, SAIN_STACK, data->launches, false, &data->trained, progress, error);
}

/* One part for each number of launches; the quick study has the first and one more. */
static bool write_launches(const SystemStudy *study, int launches, FILE *lines, const Progress *progress,
                           Error *error) {
    Data data = {.study = study, .launches = launches, .seeds = study->quick ? 1 : SEEDS};
    if (study->quick && launches != 1 && launches != SAIN_LITTLE) return true;
    const int trainings = SAIN_FORMS * data.seeds, count = trainings * SAIN_SCENES;
    data.rows = calloc((size_t)count, sizeof *data.rows);
    ProgressStage recording = {progress, 0, 0.2, false}, training = {progress, 0.2, 0.8, false};
    const Progress of_recording = {progress_stage, &recording}, of_training = {progress_stage, &training};
    bool ok = data.rows != NULL || error_memory(error, "sain");
    ok = ok && record_all(&data, &of_recording, error) &&
         parallel_for(&(ParallelWork){train_one, &data}, trainings, "trainings", &of_training, error);
    for (int i = 0; ok && i < count; i++) ok = piece_tables_print(lines, &sain_layout, -1, &data.rows[i], error);
    for (SainScene scene = 0; scene < SAIN_SCENES; scene++) impact_problems_free(&data.scored[scene]);
    impact_problems_free(&data.trained);
    free(data.rows);
    return ok;
}

double sain_error(const SainRow *row) { return row->error; }

double sain_engine_error(const SainRow *row) { return row->engine; }

double sain_constant_error(const SainRow *row) { return row->constant; }

double sain_median(const CsvTable *table, SainScene scene, SainForm form, int launches, SainNumber *of) {
    enum { MOST = 64 };
    const SainRow *rows = table->rows;
    double numbers[MOST];
    int count = 0;
    for (int i = 0; i < table->count && count < MOST; i++)
        if (rows[i].scene == (int)scene && rows[i].form == (int)form && rows[i].launches == launches)
            numbers[count++] = of(&rows[i]);
    return statistics_quantile(numbers, count, 0.5);
}

int sain_most_launches(const CsvTable *table) {
    const SainRow *rows = table->rows;
    int most = 0;
    for (int i = 0; i < table->count; i++) most = rows[i].launches > most ? rows[i].launches : most;
    return most;
}

static const SystemPart parts[] = {
    {"launches-1", 7, 0.6, 1, write_launches, false},   {"launches-2", 7, 0.1, 2, write_launches, false},
    {"launches-4", 7, 0.1, 4, write_launches, false},   {"launches-8", 7, 0.1, 8, write_launches, false},
    {"launches-16", 8, 0.8, 16, write_launches, false}, {"launches-32", 8, 0.1, 32, write_launches, false},
    {"launches-64", 9, 0.1, 64, write_launches, false}, {0}};

const PaperSystem system_sain = {.name = "sain",
                                 .methods =
                                     SYSTEM_METHODS("sain", "sain:engine=off", "sain:engine=shuffled", "sain:net=off"),
                                 .table = &sain_layout,
                                 .parts = parts,
                                 .claims = sain_claims,
                                 .plot = plot_sain};

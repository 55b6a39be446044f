/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/hybrid_study.h"

#include "paper/systems/hybrid_times.h"
#include "study/piece_tables.h"
#include "tabulation_training/online_net.h"
#include "tabulation_training/tabulation_training.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A family changes after CHANGE launches; in the quick study after QUICK_CHANGE. */
enum {
    LAUNCHES = 1000,
    CHANGE = 500,
    QUICK_LAUNCHES = 60,
    QUICK_CHANGE = 50,
    ONLINE_ENTRIES = 5000,
    IMPACT_STEPS = 14,
    ALL_STEPS = 66,
    MEMORY_LIMIT = 64 << 20
};

static const int checkpoints[] = {TABULATION_FIRST, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000};
enum { CHECKPOINTS = sizeof checkpoints / sizeof *checkpoints };

#define HYBRID_NUMBER(member) \
    { #member, CSV_OPTIONAL, .offset = offsetof(HybridRow, member), .minimum = -1e9, .maximum = 1e9 }

static const CsvColumn columns[] = {
    {"scene", CSV_WORD, .offset = offsetof(HybridRow, scene), .words = paper_scene_names},
    {"tolerance", CSV_NUMBER, .offset = offsetof(HybridRow, tolerance), .minimum = 1e-6, .maximum = 1000},
    {"changes", CSV_INTEGER, .offset = offsetof(HybridRow, changes), .maximum = 1},
    {"turned", CSV_INTEGER, .offset = offsetof(HybridRow, turned), .maximum = 1},
    {"launches", CSV_NUMBER, .offset = offsetof(HybridRow, launches), .minimum = 1, .maximum = TABULATION_LAUNCHES_MAX},
    {"share", CSV_OPTIONAL, .offset = offsetof(HybridRow, share), .maximum = 1},
    {"share_all", CSV_OPTIONAL, .offset = offsetof(HybridRow, share_all), .maximum = 1},
    HYBRID_NUMBER(error),
    HYBRID_NUMBER(error_95),
    HYBRID_NUMBER(us_answer),
    HYBRID_NUMBER(us_solve),
    HYBRID_NUMBER(us_question),
    HYBRID_NUMBER(us_step),
    HYBRID_NUMBER(us_step_solve),
    HYBRID_NUMBER(online_error),
    HYBRID_NUMBER(online_us),
    HYBRID_NUMBER(entries),
    HYBRID_NUMBER(kib),
    HYBRID_NUMBER(learning_ms),
    HYBRID_NUMBER(saved_ms),
    HYBRID_NUMBER(paid),
};
const CsvLayout hybrid_layout =
    CSV_LAYOUT("system_hybrid", columns, HybridRow, .min_rows = 1, .max_rows = HYBRID_ROWS_MAX);

typedef struct Learning {
    int scene;
    float tolerance;
    int steps;
    bool changes, online;
} Learning;

/* Steps that a scene's launches are followed for: a pyramid has few impacts after the first steps. The tolerances are
   compared on the stack; there the second form learns, too, from the first ONLINE_ENTRIES entries of the whole study. */
static const Learning learnings[] = {
    {0, 0.1f, ALL_STEPS, false, false},    {1, 0.1f, ALL_STEPS, false, true},   {2, 0.1f, IMPACT_STEPS, false, false},
    {3, 0.1f, IMPACT_STEPS, false, false}, {0, 0.1f, ALL_STEPS, true, false},   {1, 0.1f, ALL_STEPS, true, false},
    {3, 0.1f, IMPACT_STEPS, true, false},  {1, 0.02f, ALL_STEPS, false, false}, {1, 0.5f, ALL_STEPS, false, false}};

/* A learning in progress. */
typedef struct Run {
    const SystemStudy *study;
    const Learning *learning;
    const Scene *scene;
    FILE *lines;
    int launches, change;
    HybridTimes *times;
    TabulationLaunch since[LAUNCHES]; /* [count] since the last row */
    int count;
    double learned, saved; /* s */
    double paid;           /* NAN: not yet */
    OnlineNet *online;     /* or NULL */
    double online_error, online_seconds;
    int online_steps, online_entries; /* since the last row; in all */
} Run;

static bool is_checkpoint(const Run *run, int launch) {
    if (launch == run->launches) return true;
    for (int i = 0; i < CHECKPOINTS; i++)
        if (checkpoints[i] == launch) return true;
    return run->study->quick && launch == run->change;
}

static double or_zero(double x) { return isnan(x) ? 0 : x; }

/* Adds up the launches since the last row, in seconds. */
static void account(Run *run, const HybridMeasures *measures, HybridRow *row) {
    int64_t steps = 0;
    int asked = 0, answered = 0;
    for (int i = 0; i < run->count; i++) {
        const TabulationLaunch *launch = &run->since[i];
        steps += launch->steps;
        asked += launch->asked;
        answered += launch->answered;
        run->learned += launch->learning;
        run->saved += 1e-6 * launch->answered * or_zero(measures->us_solve - measures->us_answer) -
                      1e-6 * (launch->asked - launch->answered) * or_zero(measures->us_question) - launch->learning;
        if (run->saved < 0)
            run->paid = NAN;
        else if (isnan(run->paid))
            run->paid = launch->number;
    }
    run->count = 0;
    row->share = asked > 0 ? (double)answered / asked : NAN;
    row->share_all = steps > 0 ? (double)answered / (double)steps : NAN;
}

static bool add_row(Run *run, const TabulationLaunch *launch, Error *error) {
    HybridMeasures measures;
    HybridRow row = {.scene = run->learning->scene,
                     .tolerance = (double)run->learning->tolerance,
                     .changes = run->learning->changes,
                     .turned = run->learning->changes && launch->number > run->change,
                     .launches = launch->number};
    if (!hybrid_measure(run->times, launch->memory, row.turned != 0, &measures, error)) return false;
    account(run, &measures, &row);
    row.error = measures.error;
    row.error_95 = measures.error_95;
    row.us_answer = measures.us_answer;
    row.us_solve = measures.us_solve;
    row.us_question = measures.us_question;
    row.us_step = measures.us_step;
    row.us_step_solve = measures.us_step_solve;
    row.online_error = run->online_steps > 0 ? run->online_error / run->online_steps : (double)NAN;
    row.online_us = run->online_steps > 0 ? 1e6 * run->online_seconds / run->online_steps : (double)NAN;
    run->online_error = run->online_seconds = run->online_steps = 0;
    row.entries = launch->memory->entry_count;
    row.kib = (double)tabulation_bytes(launch->memory) / 1024;
    row.learning_ms = 1e3 * run->learned;
    row.saved_ms = 1e3 * run->saved;
    row.paid = run->paid;
    return piece_tables_print(run->lines, &hybrid_layout, -1, &row, error);
}

static bool note(void *context, const TabulationLaunch *launch, Error *error) {
    Run *run = context;
    run->since[run->count++] = *launch;
    return launch->memory == NULL || !is_checkpoint(run, launch->number) || add_row(run, launch, error);
}

static bool note_entry(void *context, const ContactProblem *problem, Error *error) {
    Run *run = context;
    double wrong, seconds;
    if (run->online_entries++ >= ONLINE_ENTRIES) return true;
    if (!online_net_learn(run->online, problem, &wrong, &seconds, error)) return false;
    if (isnan(wrong)) return true;
    run->online_error += wrong;
    run->online_seconds += seconds;
    run->online_steps++;
    return true;
}

static bool learn(Run *run, const Progress *progress, Error *error) {
    const TabulationTraining training = {.launches = run->launches,
                                         .turned_from = run->learning->changes ? run->change : -1,
                                         .steps = run->learning->steps,
                                         .components = TABULATION_STANDARD_COMPONENTS,
                                         .tolerance = run->learning->tolerance,
                                         .limit = MEMORY_LIMIT,
                                         .seed = run->study->seed,
                                         .command = "",
                                         .on_launch = note,
                                         .on_added = run->online != NULL ? note_entry : NULL,
                                         .context = run};
    Tabulation *memory = tabulation_training_run(run->scene, &training, progress, error);
    const bool whole = memory != NULL && memory->launches == run->launches;
    tabulation_destroy(memory);
    return whole || (memory == NULL ? false : error_interrupted(error, "hybrid", "stopped"));
}

static bool write_learning(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Learning *learning = &learnings[index];
    char path[CSV_PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/%s.yaml", study->scenes, paper_scene_names[learning->scene]) >=
        (int)sizeof path)
        return error_input(error, study->scenes, "the name is too long");
    Scene *scene = scene_read(path, error);
    Run *run = scene != NULL ? calloc(1, sizeof *run) : NULL;
    if (run == NULL) {
        scene_destroy(scene);
        return scene == NULL ? false : error_memory(error, "hybrid");
    }
    *run = (Run){.study = study, .learning = learning, .scene = scene, .lines = lines, .paid = NAN};
    run->launches = study->quick ? QUICK_LAUNCHES : LAUNCHES;
    run->change = study->quick ? QUICK_CHANGE : CHANGE;
    run->times = hybrid_times_create(scene, learning->steps, study->seed, study->quick, error);
    const bool online = learning->online && !study->quick;
    if (online) run->online = online_net_create(study->seed, error);
    const bool ok = run->times != NULL && (run->online != NULL || !online) && learn(run, progress, error);
    online_net_destroy(run->online);
    hybrid_times_destroy(run->times);
    free(run);
    scene_destroy(scene);
    return ok;
}

const SystemPart hybrid_parts[] = {
    {"single", .weight = 2, .quick_weight = 0.1, .index = 0, .write = write_learning, .timed = true},
    {"stack", .weight = 20, .quick_weight = 0.2, .index = 1, .write = write_learning, .timed = true},
    {"pyramid", .weight = 4, .quick_weight = 0.2, .index = 2, .write = write_learning, .timed = true},
    {"pyramid_settled", .weight = 15, .quick_weight = 0.5, .index = 3, .write = write_learning, .timed = true},
    {"single-change", .weight = 2, .quick_weight = 0.1, .index = 4, .write = write_learning, .timed = true},
    {"stack-change", .weight = 7, .quick_weight = 0.2, .index = 5, .write = write_learning, .timed = true},
    {"pyramid_settled-change", .weight = 15, .quick_weight = 0.5, .index = 6, .write = write_learning, .timed = true},
    {"stack-narrow", .weight = 7, .quick_weight = 0.2, .index = 7, .write = write_learning, .timed = true},
    {"stack-wide", .weight = 7, .quick_weight = 0.2, .index = 8, .write = write_learning, .timed = true},
    {0}};

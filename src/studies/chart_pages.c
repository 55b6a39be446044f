/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launch that was worst for a method, and chart_pages.csv. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/chart_pages.h"
#include "studies/chart_table.h"
#include "studies/rollout.h"
#include "studies/scene_study.h"
#include "studies/statistics.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* Phases with points: impact and after. */
static const char *const phase_words[] = {"impact", "after", NULL};

#define TEXT(member, size) CSV_MEMBER(LaunchPage, member, CSV_TEXT, .maximum = (size)-1)
#define COUNT(member, least) CSV_MEMBER(LaunchPage, member, CSV_INTEGER, .minimum = least, .maximum = INT_MAX)
#define NUMBER(member, kind) \
    CSV_MEMBER(LaunchPage, member, kind, .minimum = -INFINITY, .maximum = INFINITY, .digits = 9)
#define ERROR(member) CSV_MEMBER(LaunchPage, member, CSV_NUMBER, .maximum = INFINITY)

static const CsvColumn columns[] = {
    TEXT(scene, CHART_NAME_SIZE),
    TEXT(method, CHART_NAME_SIZE),
    TEXT(setting, CHART_SETTING_SIZE),
    CSV_MEMBER(LaunchPage, phase, CSV_WORD, .words = phase_words),
    COUNT(launch, 1),
    NUMBER(x, CSV_FLOAT),
    NUMBER(rotation, CSV_FLOAT),
    NUMBER(spin, CSV_FLOAT),
    NUMBER(mass, CSV_FLOAT),
    COUNT(launch_frame, 0),
    ERROR(error_worst),
    ERROR(error),
    NUMBER(time, CSV_NUMBER),
    COUNT(frame, 0),
    COUNT(body, -1),
    TEXT(page, CSV_PATH_SIZE),
    COUNT(bytes, 0),
};

const CsvLayout launch_page_layout =
    CSV_LAYOUT("chart_pages", columns, LaunchPage, .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);

typedef struct Search {
    const SceneStudy *study;
    const Method *method;
    WorstLaunch (*of)[PHASES]; /* [launches] */
} Search;

static WorstLaunch worst_launch_measure(const StepScores *scores, const RunLog *log, int launch) {
    WorstLaunch worst = {.launch = -1, .frame = -1, .body = -1, .touch = log->touch, .frames = log->frames};
    for (int i = 0; i < scores->count; i++) {
        if (worst.launch >= 0 && scores->error[i] <= worst.error) continue;
        worst.launch = launch;
        worst.error = scores->error[i];
        worst.frame = scores->place[i].frame;
        worst.body = scores->place[i].body;
    }
    if (scores->count > 0) worst.mean = statistics_mean(scores->error, scores->count);
    return worst;
}

static bool search_launch(void *context, int i, Error *error) {
    const Search *search = context;
    const Sampling sampling = {.after = search->study->size.closed.after, .rest = INT_MAX};
    const Scene scene = scene_study_launch(search->study, i), *launched = &scene;
    Rollout rollout = {0};
    StepScores scores[PHASES] = {0};
    Stepper *stepper = stepper_create(search->method, launched, error);
    const bool ok = stepper != NULL && rollout_run(&rollout, stepper, launched, &sampling, scores, error);
    for (int phase = 0; phase < PHASES; phase++) {
        if (ok) search->of[i][phase] = worst_launch_measure(&scores[phase], &rollout.log, i);
        step_scores_free(&scores[phase]);
    }
    stepper_destroy(stepper);
    rollout_free(&rollout);
    return ok;
}

bool worst_launch_find(const SceneStudy *study, const Method *method, WorstLaunch worst[PHASES],
                       const Progress *progress, Error *error) {
    Search search = {study, method, calloc((size_t)study->launch_count, sizeof *search.of)};
    if (search.of == NULL) return error_memory(error, "worst launch");
    const ParallelWork work = {search_launch, &search};
    const bool ok = parallel_for(&work, study->launch_count, study->scene->name, progress, error);
    for (int phase = 0; ok && phase < PHASES; phase++) {
        worst[phase] = (WorstLaunch){.launch = -1};
        for (int i = 0; i < study->launch_count; i++) {
            const WorstLaunch *found = &search.of[i][phase];
            if (found->launch >= 0 && (worst[phase].launch < 0 || found->mean > worst[phase].mean))
                worst[phase] = *found;
        }
    }
    free(search.of);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/worst_launch.h"

#include "common/parallel.h"
#include "study/rollout.h"
#include "study/statistics.h"

#include <limits.h>
#include <stdlib.h>

typedef struct Search {
    const SceneStudy *study;
    const Method *method;
    WorstLaunch (*of)[PHASES]; /* [launches] */
} Search;

static WorstLaunch measure(const StepScores *scores, const RunLog *log, int launch) {
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
        if (ok) search->of[i][phase] = measure(&scores[phase], &rollout.log, i);
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

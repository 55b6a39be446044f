/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_study.h"

#include "common/parallel.h"
#include "scene/launch.h"
#include "study/scene_rows.h"
#include "study/statistics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether methods are scored against converged velocities without push-out. */
static bool scores_without_push_out(const SceneStudy *study) {
    for (int i = 0; i < study->contender_count; i++)
        if (study->contenders[i]->method.kind->description->no_push_out) return true;
    return false;
}

static bool choose_launches(SceneStudy *study, const LaunchChoice *choice, Error *error) {
    Launch *launches = launch_choice_make(choice, study->scene, study->size.launches, &study->launch_count, error);
    if (launches == NULL) return false;
    size_t count = (size_t)study->launch_count;
    study->launches = malloc(count * sizeof *study->launches);
    study->converged = calloc(count, sizeof *study->converged);
    study->snapshots = calloc(count, sizeof *study->snapshots);
    bool ok = study->launches != NULL && study->converged != NULL && study->snapshots != NULL;
    if (!ok) error_memory(error, "study");
    for (int i = 0; ok && i < study->launch_count; i++) {
        study->launches[i] = launch_scene(study->scene, &launches[i]);
        study->snapshots[i].no_push_out = scores_without_push_out(study);
    }
    free(launches);
    return ok;
}

/* A step takes time in proportion to its bodies, its converged solution even more. So larger scenes have fewer launches
   and fewer scored steps after the impact. */
static StudySize size_for(const StudySize *full, const Scene *scene) {
    enum { SMALL = 110, LEAST_LAUNCHES = 4, LEAST_TIMED = 2 }; /* SMALL: bodies */
    StudySize size = *full;
    if (scene->body_count <= SMALL) return size;
    const int launches = size.launches * SMALL / scene->body_count,
              timed = size.timed_launches * SMALL / scene->body_count;
    size.closed.after *= 2;
    size.closed.rest *= 4;
    size.launches = launches > LEAST_LAUNCHES ? launches : LEAST_LAUNCHES;
    size.timed_launches = timed > LEAST_TIMED ? timed : LEAST_TIMED;
    return size;
}

bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error) {
    *study = (SceneStudy){.scene = scene_read(path, error)};
    if (study->scene != NULL) study->size = size_for(size, study->scene);
    bool ok = study->scene != NULL && (study->scene->bomb.present || error_input(error, path, "the scene has no bomb"));
    if (ok) {
        study->contenders = malloc((size_t)(contenders->count + 1) * sizeof *study->contenders);
        ok = study->contenders != NULL || error_memory(error, "study");
    }
    if (ok) study->contender_count = contenders_for(contenders, study->scene, study->contenders);
    if (ok && choose_launches(study, launches, error)) return true;
    scene_study_end(study);
    return false;
}

void scene_study_end(SceneStudy *study) {
    for (int i = 0; i < study->launch_count; i++) {
        if (study->converged != NULL) run_log_free(&study->converged[i]);
        if (study->snapshots != NULL) snapshots_free(&study->snapshots[i]);
    }
    free(study->converged);
    free(study->snapshots);
    free(study->launches);
    free(study->contenders);
    scene_destroy(study->scene);
    *study = (SceneStudy){0};
}

static bool prepare_launch(void *context, int i, Error *error) {
    SceneStudy *study = context;
    const Scene *launched = &study->launches[i];
    Method method;
    Rollout rollout = {0};
    Stepper *stepper = method_parse(&method, "reference", error) ? stepper_create(&method, launched, error) : NULL;
    bool ok = stepper != NULL && rollout_run(&rollout, stepper, launched, NULL, NULL, error) &&
              snapshots_add(&study->snapshots[i], launched, &study->size.frozen, error);
    study->converged[i] = rollout.log;
    rollout.log = (RunLog){0};
    rollout_free(&rollout);
    stepper_destroy(stepper);
#pragma omp critical(study_residual)
    if (study->snapshots[i].residual > study->frozen_residual) study->frozen_residual = study->snapshots[i].residual;
    return ok;
}

bool scene_study_prepare(SceneStudy *study, const Progress *progress, Error *error) {
    const ParallelWork work = {prepare_launch, study};
    return parallel_for(&work, study->launch_count, "converged runs", progress, error);
}

/* Results of one contender. */
typedef struct Scores {
    StepScores frozen[PHASES], closed[PHASES];
    RunMeasures *measures; /* [launch_count] */
    double worst[PHASES];  /* m/s: largest mean error of a launch in closed loop; NaN without a scored step */
} Scores;

static void scores_free(Scores *scores) {
    for (int phase = 0; phase < PHASES; phase++) {
        step_scores_free(&scores->frozen[phase]);
        step_scores_free(&scores->closed[phase]);
    }
    free(scores->measures);
}

/* scored[PHASES]: number of steps scored before this launch. */
static void update_worst(Scores *scores, const int scored[PHASES]) {
    for (int phase = 0; phase < PHASES; phase++) {
        const StepScores *closed = &scores->closed[phase];
        if (closed->count == scored[phase]) continue;
        double mean = statistics_mean(closed->error + scored[phase], closed->count - scored[phase]);
        scores->worst[phase] = fmax(scores->worst[phase], mean); /* ignores NaN */
    }
}

static bool score_launches(SceneStudy *study, Stepper *stepper, Scores *scores, Error *error) {
    Rollout rollout = {0};
    bool ok = true;
    for (int i = 0; ok && i < study->launch_count; i++) {
        const Scene *launched = &study->launches[i];
        int scored[PHASES];
        for (int phase = 0; phase < PHASES; phase++) scored[phase] = scores->closed[phase].count;
        ok = rollout_run(&rollout, stepper, launched, &study->size.closed, scores->closed, error);
        if (ok) scores->measures[i] = run_measures(&rollout.log, &study->converged[i], launched);
        if (ok) update_worst(scores, scored);
        ok = ok && snapshots_score(&study->snapshots[i], stepper, rollout.world, scores->frozen, error);
    }
#pragma omp critical(study_residual)
    {
        study->solves += rollout.solves;
        study->unconverged += rollout.unconverged;
    }
    rollout_free(&rollout);
    return ok;
}

bool scene_study_score(SceneStudy *study, int contender, ChartRow *rows, Error *error) {
    Scores scores = {.measures = calloc((size_t)study->launch_count, sizeof(RunMeasures)), .worst = {NAN, NAN, NAN}};
    if (scores.measures == NULL) return error_memory(error, "study");
    const Contender *tested = study->contenders[contender];
    Stepper *stepper = stepper_create(&tested->method, study->scene, error);
    bool ok = stepper != NULL && score_launches(study, stepper, &scores, error);
    stepper_destroy(stepper);
    for (int phase = 0; ok && phase < PHASES; phase++) {
        ChartRow *frozen = &rows[PROTOCOL_FROZEN * PHASES + phase], *closed = &rows[PROTOCOL_CLOSED * PHASES + phase];
        *frozen = scene_row(study->scene->name, study->launch_count, tested, PROTOCOL_FROZEN, phase);
        *closed = scene_row(study->scene->name, study->launch_count, tested, PROTOCOL_CLOSED, phase);
        scene_row_errors(frozen, &scores.frozen[phase]);
        scene_row_errors(closed, &scores.closed[phase]);
        closed->error_worst = scores.worst[phase];
        scene_row_measures(closed, scores.measures, study->launch_count);
    }
    scores_free(&scores);
    return ok;
}

/* Picks launches evenly. Runs end 20 frames after the phase "after", so that all three phases are timed. */
static bool choose_timed(const SceneStudy *study, Scene *launches, SnapshotList *snapshots, TimingOptions *options,
                         Error *error) {
    options->last_frame = 0;
    for (int i = 0; i < options->launch_count; i++) {
        int from = (2 * i + 1) * study->launch_count / (2 * options->launch_count);
        const RunLog *log = &study->converged[from];
        int last = log->touch + study->scene->bomb.impact_frames + AFTER_FRAMES + 20;
        launches[i] = study->launches[from];
        if (last > options->last_frame) options->last_frame = last;
        if (!snapshots_add(snapshots, &launches[i], &study->size.frozen, error)) return false;
    }
    if (options->last_frame > study->scene->frames) options->last_frame = study->scene->frames;
    return true;
}

bool scene_study_time(SceneStudy *study, ChartRow *rows, const Progress *progress, Error *error) {
    size_t contenders = (size_t)study->contender_count;
    int timed = study->size.timed_launches < study->launch_count ? study->size.timed_launches : study->launch_count;
    Scene *launches = malloc((size_t)timed * sizeof *launches);
    StepCost(*costs[PROTOCOLS])[PHASES] = {malloc((contenders + 1) * sizeof(StepCost[PHASES])),
                                           malloc((contenders + 1) * sizeof(StepCost[PHASES]))};
    SnapshotList snapshots = {0};
    TimingOptions options = {.launches = launches, .launch_count = timed, .repetitions = study->size.repetitions};
    bool ok = launches != NULL && costs[0] != NULL && costs[1] != NULL;
    if (!ok) error_memory(error, "study");
    ok = ok && choose_timed(study, launches, &snapshots, &options, error) &&
         timing_measure(study->contenders, study->contender_count, &options, &snapshots, costs[PROTOCOL_CLOSED],
                        costs[PROTOCOL_FROZEN], progress, error);
    for (size_t i = 0; ok && i < contenders; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++)
                scene_row_cost(&rows[i * ROWS_EACH + (size_t)(p * PHASES + phase)], &costs[p][i][phase]);
    snapshots_free(&snapshots);
    free(launches);
    free(costs[0]);
    free(costs[1]);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a scene: a launch with all methods, and the times of all methods. */
#include "base/base.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/frozen.h"
#include "studies/launch_scores.h"
#include "studies/rollout.h"
#include "studies/scene_study.h"
#include "studies/stepper_pool.h"
#include "studies/timing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* About the share of a piece that its converged run takes. */
static const double converged_share = 0.2;

typedef struct LaunchPiece {
    SceneStudy *study;
    Scene launched;
    RunLog converged;
    SnapshotList snapshots;
    int first;            /* contender that is tried first */
    bool *chosen;         /* [contenders] */
    LaunchScores *scores; /* [contenders] */
} LaunchPiece;

static bool launch_piece_begin(LaunchPiece *piece, SceneStudy *study, int launch, Error *error) {
    const size_t count = (size_t)study->contender_count + 1;
    const double golden = 0.6180339887498949; /* neighbouring launches, which run at once, begin far apart */
    *piece = (LaunchPiece){.study = study,
                           .launched = scene_study_launch(study, launch),
                           .snapshots = {.no_push_out = study->no_push_out},
                           .first = (int)(fmod(launch * golden, 1) * study->contender_count),
                           .chosen = calloc(count, sizeof *piece->chosen),
                           .scores = calloc(count, sizeof *piece->scores)};
    return (piece->chosen != NULL && piece->scores != NULL) || error_memory(error, "study");
}

static void launch_piece_end(LaunchPiece *piece) {
    for (int i = 0; piece->scores != NULL && i < piece->study->contender_count; i++)
        launch_scores_free(&piece->scores[i]);
    run_log_free(&piece->converged);
    snapshots_free(&piece->snapshots);
    free(piece->chosen);
    free(piece->scores);
}

static bool scene_pieces_prepare(LaunchPiece *piece, Error *error) {
    return rollout_log(&piece->converged, "reference", &piece->launched, error) &&
           snapshots_add(&piece->snapshots, &piece->launched, &piece->study->size.frozen, error);
}

static bool score_with(LaunchPiece *piece, Stepper *stepper, LaunchScores *scores, Error *error) {
    Rollout rollout = {0};
    bool ok = rollout_run(&rollout, stepper, &piece->launched, &piece->study->size.closed,
                          scores->steps[PROTOCOL_CLOSED], error);
    if (ok) scores->measures = run_measures(&rollout.log, &piece->converged, &piece->launched);
    const bool frozen = !stepper_describe(stepper)->whole_scenes;
    ok = ok &&
         (!frozen || snapshots_score(&piece->snapshots, stepper, rollout.world, scores->steps[PROTOCOL_FROZEN], error));
    scores->unconverged = rollout.unconverged;
    rollout_free(&rollout);
    return ok;
}

/* Scores a contender, whichever is free. */
static bool scene_pieces_score(void *context, int i, Error *error) {
    (void)i;
    LaunchPiece *piece = context;
    SceneStudy *study = piece->study;
    const int contender = stepper_pool_take(&study->steppers, piece->chosen, piece->first);
    Stepper *stepper =
        stepper_pool_stepper(&study->steppers, contender, &study->contenders[contender]->method, study->scene, error);
    const bool ok = stepper != NULL && score_with(piece, stepper, &piece->scores[contender], error);
    stepper_pool_give(&study->steppers, contender);
    return ok;
}

bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error) {
    LaunchPiece piece;
    ProgressStage stage = {progress, converged_share, 1 - converged_share, false};
    const ParallelWork work = {scene_pieces_score, &piece};
    const bool ok =
        launch_piece_begin(&piece, study, launch, error) && scene_pieces_prepare(&piece, error) &&
        parallel_for(&work, study->contender_count, study->scene->name, &(Progress){progress_stage, &stage}, error);
    if (ok)
        launch_scores_write(results, piece.scores, study->contender_count, piece.snapshots.unconverged,
                            piece.converged.unconverged);
    launch_piece_end(&piece);
    return ok;
}

/* About the share of the time that preparations take. */
static const double prepared_share = 0.1;

/* Frames of a run behind the phase "after", so that all three phases are timed. */
enum { FRAMES_BEHIND = 20 };

typedef struct Timed {
    SnapshotList snapshots;
    int touch; /* of the converged run */
} Timed;

typedef struct SceneTimes {
    const SceneStudy *study;
    int count;
    Timed *timed;    /* [count] */
    Scene *launches; /* [count] */
    SnapshotList snapshots;
    StepCost (*costs[PROTOCOLS])[PHASES]; /* [contenders] */
} SceneTimes;

static bool prepare_launch(void *context, int i, Error *error) {
    SceneTimes *times = context;
    Timed *timed = &times->timed[i];
    const SceneStudy *study = times->study;
    Scene *launched = &times->launches[i];
    const int spread = (2 * i + 1) * study->striking_count / (2 * times->count);
    *launched = scene_study_launch(study, study->striking[spread]);
    return launch_find_touch(launched, "reference", &timed->touch, error) &&
           snapshots_add(&timed->snapshots, launched, &study->size.frozen, error);
}

/* Moves the frozen steps of all launches into one list. */
static bool gather_snapshots(SceneTimes *times, Error *error) {
    SnapshotList *all = &times->snapshots;
    for (int i = 0; i < times->count; i++) {
        SnapshotList *list = &times->timed[i].snapshots;
        if (!array_reserve((void **)&all->items, &all->capacity, (size_t)(all->count + list->count) + 1,
                           sizeof *all->items))
            return error_memory(error, "study");
        if (list->count > 0) memcpy(all->items + all->count, list->items, (size_t)list->count * sizeof *all->items);
        all->count += list->count;
        list->count = 0;
    }
    return true;
}

static int last_frame(const SceneTimes *times) {
    const Scene *scene = times->study->scene;
    int last = 0;
    for (int i = 0; i < times->count; i++) {
        const int frame = times->timed[i].touch + scene->bomb.impact_frames + AFTER_FRAMES + FRAMES_BEHIND;
        if (frame > last) last = frame;
    }
    return last < scene->frames ? last : scene->frames;
}

static bool scene_times_begin(SceneTimes *times, const SceneStudy *study, Error *error) {
    const size_t contenders = (size_t)study->contender_count + 1;
    *times = (SceneTimes){.study = study, .count = scene_study_timed(study)};
    times->timed = calloc((size_t)times->count, sizeof *times->timed);
    times->launches = calloc((size_t)times->count, sizeof *times->launches);
    bool ok = times->timed != NULL && times->launches != NULL;
    for (int p = 0; p < PROTOCOLS; p++) {
        times->costs[p] = calloc(contenders, sizeof *times->costs[p]);
        ok = ok && times->costs[p] != NULL;
    }
    return ok || error_memory(error, "study");
}

static void scene_times_end(SceneTimes *times) {
    for (int i = 0; times->timed != NULL && i < times->count; i++) snapshots_free(&times->timed[i].snapshots);
    snapshots_free(&times->snapshots);
    for (int p = 0; p < PROTOCOLS; p++) free(times->costs[p]);
    free(times->timed);
    free(times->launches);
}

static bool scene_times_measure(SceneTimes *times, const Progress *progress, Error *error) {
    const SceneStudy *study = times->study;
    ProgressStage before = {progress, 0, prepared_share, false},
                  then = {progress, prepared_share, 1 - prepared_share, false};
    const ParallelWork work = {prepare_launch, times};
    if (!parallel_for(&work, times->count, study->scene->name, &(Progress){progress_stage, &before}, error) ||
        !gather_snapshots(times, error))
        return false;
    const TimingOptions options = {.launches = times->launches,
                                   .launch_count = times->count,
                                   .repetitions = study->size.repetitions,
                                   .last_frame = last_frame(times)};
    return timing_measure(study->contenders, study->contender_count, &options, &times->snapshots,
                          times->costs[PROTOCOL_CLOSED], times->costs[PROTOCOL_FROZEN],
                          &(Progress){progress_stage, &then}, error);
}

bool scene_times_write(const SceneStudy *study, FILE *results, const Progress *progress, Error *error) {
    SceneTimes times;
    const bool ok = scene_times_begin(&times, study, error) && scene_times_measure(&times, progress, error);
    for (int i = 0; ok && i < study->contender_count; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++) {
                const StepCost *cost = &times.costs[p][i][phase];
                const double stored[] = {cost->solver,       cost->solver_q1, cost->solver_q3, cost->step,
                                         cost->instructions, cost->engine,    cost->varies};
                fwrite(stored, sizeof stored, 1, results);
            }
    scene_times_end(&times);
    return ok;
}

static bool is_time(double value) { return !(value < 0); }

/* What chart.csv can have. */
static bool is_cost(const StepCost *cost) {
    return is_time(cost->solver_q1) && !(cost->solver_q1 > cost->solver) && !(cost->solver > cost->solver_q3) &&
           is_time(cost->step) && is_time(cost->instructions) && is_time(cost->engine);
}

MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error) {
    double stored[7];
    const size_t count = (size_t)study->contender_count;
    MethodTimes *times = calloc(count + 1, sizeof *times);
    if (times == NULL) return error_memory(error, path), NULL;
    bool whole = size == count * PROTOCOLS * PHASES * sizeof stored;
    for (size_t i = 0; whole && i < count * PROTOCOLS * PHASES; i++) {
        memcpy(stored, bytes + i * sizeof stored, sizeof stored);
        StepCost *cost = &times[i / (PROTOCOLS * PHASES)].costs[i / PHASES % PROTOCOLS][i % PHASES];
        *cost = (StepCost){stored[0],
                           stored[1],
                           stored[2],
                           stored[3],
                           .instructions = stored[4],
                           .engine = stored[5],
                           .varies = stored[6] == 1};
        whole = is_cost(cost) && (stored[6] == 0 || stored[6] == 1);
    }
    if (whole) return times;
    error_input(error, path, "is no result of times; delete it, and run the command again");
    free(times);
    return NULL;
}

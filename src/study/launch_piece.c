/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/launch_piece.h"

#include "common/parallel.h"
#include "study/frozen.h"
#include "study/method_scores.h"

#include <math.h>
#include <stdlib.h>

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

static bool begin(LaunchPiece *piece, SceneStudy *study, int launch, Error *error) {
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

static void end(LaunchPiece *piece) {
    for (int i = 0; piece->scores != NULL && i < piece->study->contender_count; i++)
        launch_scores_free(&piece->scores[i]);
    run_log_free(&piece->converged);
    snapshots_free(&piece->snapshots);
    free(piece->chosen);
    free(piece->scores);
}

static bool prepare(LaunchPiece *piece, Error *error) {
    Method method;
    Rollout rollout = {0};
    Stepper *stepper =
        method_parse(&method, "reference", error) ? stepper_create(&method, &piece->launched, error) : NULL;
    const bool ok = stepper != NULL && rollout_run(&rollout, stepper, &piece->launched, NULL, NULL, error) &&
                    snapshots_add(&piece->snapshots, &piece->launched, &piece->study->size.frozen, error);
    piece->converged = rollout.log;
    rollout.log = (RunLog){0};
    rollout_free(&rollout);
    stepper_destroy(stepper);
    return ok;
}

static bool score_with(LaunchPiece *piece, Stepper *stepper, LaunchScores *scores, Error *error) {
    Rollout rollout = {0};
    bool ok = rollout_run(&rollout, stepper, &piece->launched, &piece->study->size.closed,
                          scores->steps[PROTOCOL_CLOSED], error);
    if (ok) scores->measures = run_measures(&rollout.log, &piece->converged, &piece->launched);
    ok = ok && snapshots_score(&piece->snapshots, stepper, rollout.world, scores->steps[PROTOCOL_FROZEN], error);
    scores->unconverged = rollout.unconverged;
    rollout_free(&rollout);
    return ok;
}

/* Scores a contender, whichever is free. */
static bool score(void *context, int i, Error *error) {
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
    const ParallelWork work = {score, &piece};
    const bool ok =
        begin(&piece, study, launch, error) && prepare(&piece, error) &&
        parallel_for(&work, study->contender_count, study->scene->name, &(Progress){progress_stage, &stage}, error);
    if (ok) launch_scores_write(results, piece.scores, study->contender_count, piece.snapshots.residual);
    end(&piece);
    return ok;
}

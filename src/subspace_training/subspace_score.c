/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subspace_training/subspace_score.h"

#include <math.h>
#include <stdlib.h>

typedef enum Kind { FLOOR, LINEAR, NET, KINDS } Kind;

/* Of one launch. */
typedef struct LaunchErrors {
    double squares; /* m^2 */
    int frames;
} LaunchErrors;

/* Adds a state; true while no body is apart. */
static bool add_state(const float *numbers, const float *recorded, int bodies, double *squares) {
    double most = 0;
    for (int i = 0; i < bodies; i++) {
        const double x = (double)numbers[SUBSPACE_POSE * i] - (double)recorded[SUBSPACE_POSE * i],
                     y = (double)numbers[SUBSPACE_POSE * i + 1] - (double)recorded[SUBSPACE_POSE * i + 1];
        *squares += x * x + y * y;
        most = fmax(most, x * x + y * y);
    }
    return most <= SUBSPACE_APART * SUBSPACE_APART;
}

static void run_launch(Subspace *subspace, const PoseRows *rows, int launch, Kind kind, LaunchErrors *errors) {
    bool near = true;
    *errors = (LaunchErrors){0, 0};
    subspace_start(subspace, pose_row(rows, launch, 0), pose_row(rows, launch, 1));
    for (int state = 2; state < rows->states; state++) {
        const float *recorded = pose_row(rows, launch, state);
        if (kind == FLOOR)
            subspace_start(subspace, recorded, recorded);
        else
            subspace_step(subspace, rows->launch + (size_t)launch * SUBSPACE_LAUNCH);
        subspace_reconstruct(subspace);
        near = add_state(subspace->numbers, recorded, rows->numbers / SUBSPACE_POSE, &errors->squares) && near;
        errors->frames += near;
    }
}

static int compare(const void *a, const void *b) {
    const int x = ((const LaunchErrors *)a)->frames, y = ((const LaunchErrors *)b)->frames;
    return (x > y) - (x < y);
}

/* Sums the launches in their order. */
static SubspaceErrors total(const PoseRows *rows, LaunchErrors *errors) {
    double squares = 0;
    const double bodies = rows->numbers / SUBSPACE_POSE;
    for (int i = 0; i < rows->launches; i++) squares += errors[i].squares;
    qsort(errors, (size_t)rows->launches, sizeof *errors, compare);
    return (SubspaceErrors){sqrt(squares / (bodies * (rows->states - 2) * rows->launches)),
                            (double)errors[rows->launches / 2].frames};
}

static bool score_kind(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows, Kind kind,
                       SubspaceErrors *result, Error *error) {
    Subspace subspace;
    LaunchErrors *errors = calloc((size_t)rows->launches, sizeof *errors);
    const bool ok = subspace_make(&subspace, net, predictor, kind == NET, error) &&
                    (errors != NULL || error_memory(error, "subspace"));
    for (int i = 0; ok && i < rows->launches; i++) run_launch(&subspace, rows, i, kind, &errors[i]);
    if (ok) *result = total(rows, errors);
    subspace_free(&subspace);
    free(errors);
    return ok;
}

bool subspace_score(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows,
                    SubspaceScore *score, Error *error) {
    SubspaceErrors *const results[KINDS] = {&score->floor, &score->linear, &score->net};
    score->components = predictor->components;
    for (int kind = 0; kind < KINDS; kind++)
        if (!score_kind(net, predictor, rows, (Kind)kind, results[kind], error)) return false;
    return true;
}

bool subspace_distance(const PoseRows *rows, const PoseRows *others, SubspaceErrors *errors, Error *error) {
    LaunchErrors *launches = calloc((size_t)rows->launches, sizeof *launches);
    if (launches == NULL) return error_memory(error, "subspace");
    for (int i = 0; i < rows->launches; i++) {
        bool near = true;
        for (int state = 2; state < rows->states; state++) {
            near = add_state(pose_row(others, i, state), pose_row(rows, i, state), rows->numbers / SUBSPACE_POSE,
                             &launches[i].squares) &&
                   near;
            launches[i].frames += near;
        }
    }
    *errors = total(rows, launches);
    free(launches);
    return true;
}

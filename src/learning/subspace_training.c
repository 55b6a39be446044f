/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of subspace: errors of predictors, recording, components, and a fit for each number of components. */
#include "learning/subspace_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "learning/learning.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static int subspace_training_compare(const void *a, const void *b) {
    const int x = ((const LaunchErrors *)a)->frames, y = ((const LaunchErrors *)b)->frames;
    return (x > y) - (x < y);
}

/* Sums the launches in their order. */
static SubspaceErrors subspace_training_total(const PoseRows *rows, LaunchErrors *errors) {
    double squares = 0;
    const double bodies = rows->numbers / SUBSPACE_POSE;
    for (int i = 0; i < rows->launches; i++) squares += errors[i].squares;
    qsort(errors, (size_t)rows->launches, sizeof *errors, subspace_training_compare);
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
    if (ok) *result = subspace_training_total(rows, errors);
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
    *errors = subspace_training_total(rows, launches);
    free(launches);
    return true;
}

static const int sizes[SUBSPACE_PREDICTORS_MAX] = {8, 32, SUBSPACE_COMPONENTS_MAX};

static const double first_rate = 1e-2;

/* A window through an impact may have any slope. */
static const double longest_slopes = 1;

/* Shares of the progress. */
static const double recording_share = 0.1;

typedef struct Trainer {
    const Scene *scene;
    const SubspaceTraining *training;
    SubspaceNet *net;
    PoseRows rows, held_out;
    float *components; /* [launches, states, components] */
    double linear[SUBSPACE_PREDICTORS_MAX][2 * SUBSPACE_COMPONENTS_MAX];
    WindowData data[SUBSPACE_PREDICTORS_MAX];
    WindowFit *fits[SUBSPACE_PREDICTORS_MAX];
    int64_t first[SUBSPACE_PREDICTORS_MAX + 1]; /* of the predictors' weights */
    Fit fit;                                    /* stage: predictor; its Adam has the weights of all */
    double *slopes;
} Trainer;

bool subspace_record(PoseRows *rows, const Scene *scene, const char *method, const Launch *launches, int count,
                     const Progress *progress, Error *error) {
    Method recorder;
    LaunchRuns runs = {0};
    *rows = (PoseRows){0};
    const bool ok = method_parse(&recorder, method, error) &&
                    launch_runs_record(&runs, scene, &recorder, launches, count, progress, error) &&
                    pose_rows_make(rows, scene, &runs, error);
    launch_runs_free(&runs);
    return ok;
}

static bool subspace_training_record(Trainer *trainer, PoseRows *rows, bool scoring, int count, Error *error) {
    Launch *launches = malloc((size_t)count * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "subspace");
    ok = ok && (scoring ? launches_for_scoring : launches_for_training)(trainer->scene, count, launches, error) &&
         subspace_record(rows, trainer->scene, SUBSPACE_OFFLINE, launches, count, &trainer->fit.progress, error);
    free(launches);
    return ok;
}

/* The run in which no bomb appears. */
static bool record_rest(Trainer *trainer, LaunchRuns *rest, Error *error) {
    Method offline;
    Launch never = launch_of(trainer->scene);
    never.frame = trainer->scene->frames + 1;
    return method_parse(&offline, SUBSPACE_OFFLINE, error) &&
           launch_runs_record(rest, trainer->scene, &offline, &never, 1, NULL, error);
}

static bool make_net(Trainer *trainer, Error *error) {
    const Scene *scene = trainer->scene;
    SubspaceShape shape = {.bodies = trainer->rows.numbers / SUBSPACE_POSE,
                           .hidden = trainer->training->hidden,
                           .frames_before = scene->bomb.frame};
    for (int i = 0; i < SUBSPACE_PREDICTORS_MAX && shape.components < trainer->rows.numbers; i++) {
        shape.components = sizes[i] < trainer->rows.numbers ? sizes[i] : trainer->rows.numbers;
        shape.predictors[shape.predictor_count++] = shape.components;
    }
    if (!subspace_shape_check(&shape, scene->name, error)) return false;
    trainer->net = subspace_net_create(&shape, error);
    if (trainer->net == NULL) return false;
    trainer->net->physics = subspace_physics(scene);
    snprintf(trainer->net->scene, sizeof trainer->net->scene, "%s", scene->name);
    snprintf(trainer->net->command, sizeof trainer->net->command, "%s", trainer->training->command);
    return true;
}

static void fill_before(const Trainer *trainer, const LaunchRuns *rest) {
    float *at = trainer->net->before;
    for (int frame = 1; frame <= trainer->net->shape.frames_before; frame++)
        for (int body = 0; body < trainer->scene->body_count; body++) {
            if (trainer->scene->bodies[body].fixed) continue;
            const BodyPose *pose = &launch_runs_frame(rest, 0, frame)[body];
            *at++ = pose->position.x;
            *at++ = pose->position.y;
            *at++ = pose->angle;
        }
}

static bool fit_components(Trainer *trainer, Error *error) {
    LaunchRuns rest = {0};
    const PoseRows *rows = &trainer->rows;
    bool ok = record_rest(trainer, &rest, error) && make_net(trainer, error);
    if (ok) {
        trainer->components = malloc((size_t)rows->launches * (size_t)rows->states *
                                     (size_t)trainer->net->shape.components * sizeof *trainer->components);
        ok = trainer->components != NULL || error_memory(error, "subspace");
    }
    if (ok) {
        fill_before(trainer, &rest);
        ok = pose_components_fit(rows, trainer->scene, launch_runs_frame(&rest, 0, trainer->scene->frames),
                                 trainer->net, error);
    }
    if (ok) pose_components_project(rows, trainer->net, trainer->components);
    launch_runs_free(&rest);
    return ok;
}

static bool make_fits(Trainer *trainer, Error *error) {
    SubspaceNet *net = trainer->net;
    for (int i = 0; i < net->shape.predictor_count; i++) {
        WindowData *data = &trainer->data[i];
        *data = (WindowData){.rows = &trainer->rows,
                             .components = trainer->components,
                             .stride = net->shape.components,
                             .count = net->shape.predictors[i],
                             .linear = trainer->linear[i],
                             .low = net->low,
                             .high = net->high};
        window_linear(data, trainer->linear[i]);
        trainer->fits[i] = window_fit_create(data, net->shape.hidden, error);
        if (trainer->fits[i] == NULL) return false;
        trainer->first[i + 1] = trainer->first[i] + network_parameter_count(window_fit_shape(trainer->fits[i]));
    }
    return true;
}

static bool begin_fit(Trainer *trainer, Error *error) {
    const SubspaceTraining *training = trainer->training;
    const int count = trainer->net->shape.predictor_count;
    Fit *fit = &trainer->fit;
    bool found;
    trainer->slopes = malloc((size_t)trainer->first[count] * sizeof *trainer->slopes);
    if (trainer->slopes == NULL) return error_memory(error, "subspace");
    if (!fit_begin(fit, trainer->first[count], &found, error)) return false;
    fit->adam.steps = (int64_t)fit->epoch * training->batches;
    if (found) return true;
    for (int i = 0; i < count; i++)
        window_fit_begin(trainer->fits[i], training->seed + (uint64_t)i, fit->adam.weights + trainer->first[i]);
    return fit_write(fit, error);
}

/* The rate falls to 0 by the square of what is left. */
static double rate_at(const SubspaceTraining *training, int64_t steps) {
    const double left = 1 - (double)steps / ((double)training->epochs * training->batches);
    return first_rate * left * left;
}

static bool subspace_training_step(void *context, Adam *adam, double *loss, Error *error) {
    Trainer *trainer = context;
    const SubspaceTraining *training = trainer->training;
    const int i = trainer->fit.stage;
    const uint64_t seed = (training->seed << 32) + ((uint64_t)i << 24) + (uint64_t)adam->steps;
    *loss += window_fit_slopes(trainer->fits[i], adam->weights, seed, trainer->slopes) / training->batches;
    if (!slopes_limit(trainer->slopes, adam->count, longest_slopes) || !isfinite(*loss))
        return error_input(error, "subspace", "training diverged in epoch %d", trainer->fit.epoch + 1);
    adam_step(adam, trainer->slopes, rate_at(training, adam->steps));
    return true;
}

static bool subspace_training_score(Trainer *trainer, int i, double loss, Error *error) {
    SubspacePredictor *predictor = &trainer->net->predictors[i];
    SubspaceScore result;
    window_scales_store(&trainer->data[i], window_fit_scales(trainer->fits[i]),
                        trainer->fit.adam.weights + trainer->first[i], predictor);
    if (trainer->training->on_score == NULL) return true;
    if (!subspace_score(trainer->net, predictor, &trainer->held_out, &result, error)) return false;
    trainer->training->on_score(trainer->training->context, &result, loss);
    return true;
}

/* The time of an epoch grows with the weights. */
static bool fit_networks(Trainer *trainer, Error *error) {
    const SubspaceTraining *training = trainer->training;
    const FitSteps steps = {(int64_t)training->epochs * training->batches, training->batches, subspace_training_step,
                            NULL, trainer};
    const int begun = trainer->fit.stage, count = trainer->net->shape.predictor_count;
    const double all = 1 - trainer->fit.share.begin - trainer->fit.share.share;
    for (int i = 0; i < count; i++) {
        const int64_t first = trainer->first[i], weights = trainer->first[i + 1] - first;
        double loss = 0;
        progress_next_stage(&trainer->fit.share, all * (double)weights / (double)trainer->first[count]);
        if (i > begun) fit_stage(&trainer->fit, i);
        if ((i >= begun && !fit_run(&trainer->fit, first, weights, &steps, &loss, error)) ||
            !subspace_training_score(trainer, i, loss, error))
            return false;
    }
    return true;
}

static bool subspace_training_run(Trainer *trainer, Error *error) {
    const SubspaceTraining *training = trainer->training;
    progress_next_stage(&trainer->fit.share, recording_share);
    if (!subspace_training_record(trainer, &trainer->rows, false, training->launches, error)) return false;
    if (trainer->rows.states < WINDOW_FRAMES + 3)
        return error_input(error, trainer->scene->name, "%d frames with the bomb; training needs %d",
                           trainer->rows.states - 1, WINDOW_FRAMES + 2);
    progress_next_stage(&trainer->fit.share, recording_share / 10);
    if (!subspace_training_record(trainer, &trainer->held_out, true, SUBSPACE_HELD_OUT, error)) return false;
    return fit_components(trainer, error) && make_fits(trainer, error) && begin_fit(trainer, error) &&
           fit_networks(trainer, error);
}

static void trainer_free(Trainer *trainer) {
    pose_rows_free(&trainer->rows);
    pose_rows_free(&trainer->held_out);
    free(trainer->components);
    free(trainer->slopes);
    fit_free(&trainer->fit);
    for (int i = 0; i < SUBSPACE_PREDICTORS_MAX; i++) window_fit_destroy(trainer->fits[i]);
    subspace_net_destroy(trainer->net);
    free(trainer);
}

SubspaceNet *subspace_train(const Scene *scene, const SubspaceTraining *training, const Progress *progress,
                            Error *error) {
    Trainer *trainer = calloc(1, sizeof *trainer);
    if (trainer == NULL) return error_memory(error, "subspace"), NULL;
    trainer->scene = scene;
    trainer->training = training;
    fit_init(&trainer->fit, training->command, training->state_path, progress);
    SubspaceNet *net = NULL;
    if (subspace_training_run(trainer, error)) {
        net = trainer->net;
        trainer->net = NULL;
    }
    trainer_free(trainer);
    return net;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of subspace: recorded poses and their components, errors of predictors, and a fit for each of them. */
#include "learning/subspace_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "learning/principal.h"
#include "methods/methods.h"
#include "methods/subspace.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double apart = 0.1; /* m */

/* The method that the launches are recorded with. */
static const char offline[] = "interior:near=0.001";

static const int sizes[SUBSPACE_PREDICTORS_MAX] = {8, 32, SUBSPACE_COMPONENTS_MAX};

static const double first_rate = 1e-2;
static const double longest_slopes = 1;    /* a window through an impact may have any slope */
static const double recording_share = 0.1; /* of the progress */

static bool moves(const Scene *scene, int body) { return body == scene->body_count || !scene->bodies[body].fixed; }

/* One step before the bomb appears: recorded, or, in the first state of a scene and of the bomb, from the velocity. */
static void fill_earlier(const Scene *launched, const LaunchRuns *runs, int launch, int body, const BodyDef *def,
                         float numbers[SUBSPACE_POSE]) {
    const int frame = launched->bomb.frame;
    if (frame > 0 && body < launched->body_count) {
        const BodyPose *pose = &launch_runs_frame(runs, launch, frame - 1)[body];
        subspace_pose_numbers(def->size, pose->position, pose->angle, numbers);
        return;
    }
    subspace_pose_numbers(def->size, vec2_sub(def->position, vec2_scale(launched->dt, def->velocity)),
                          def->angle - launched->dt * def->angular_velocity, numbers);
}

static bool make_rows(PoseRows *rows, const Scene *scene, const LaunchRuns *runs, Error *error) {
    int moving = 0;
    for (int body = 0; body < runs->bodies; body++) moving += moves(scene, body);
    *rows = (PoseRows){
        .launches = runs->count, .states = runs->frames - scene->bomb.frame + 1, .numbers = SUBSPACE_POSE * moving};
    const size_t count = (size_t)rows->states * (size_t)rows->numbers;
    rows->rows = malloc((size_t)rows->launches * (count + SUBSPACE_LAUNCH) * sizeof *rows->rows);
    if (rows->rows == NULL) return error_memory(error, "subspace");
    rows->launch = rows->rows + (size_t)rows->launches * count;
    for (int launch = 0; launch < rows->launches; launch++) {
        const Scene launched = launch_scene(scene, &runs->launches[launch]);
        float *at = rows->rows + (size_t)launch * count;
        subspace_launch(&launched, rows->launch + (size_t)launch * SUBSPACE_LAUNCH);
        for (int state = 0; state < rows->states; state++)
            for (int body = 0; body < runs->bodies; body++) {
                if (!moves(scene, body)) continue;
                const BodyDef def = body == scene->body_count ? scene_bomb_body(&launched) : launched.bodies[body];
                const BodyPose *pose =
                    &launch_runs_frame(runs, launch, launched.bomb.frame + (state > 0 ? state - 1 : 0))[body];
                if (state == 0)
                    fill_earlier(&launched, runs, launch, body, &def, at);
                else
                    subspace_pose_numbers(def.size, pose->position, pose->angle, at);
                at += SUBSPACE_POSE;
            }
    }
    return true;
}

void pose_rows_free(PoseRows *rows) {
    free(rows->rows);
    *rows = (PoseRows){0};
}

bool subspace_record(PoseRows *rows, const Scene *scene, const Launch *launches, int count, const Progress *progress,
                     Error *error) {
    Method recorder;
    LaunchRuns runs = {0};
    *rows = (PoseRows){0};
    const bool ok = method_parse(&recorder, offline, error) &&
                    launch_runs_record(&runs, scene, &recorder, launches, count, progress, error) &&
                    make_rows(rows, scene, &runs, error);
    launch_runs_free(&runs);
    return ok;
}

typedef enum Kind { FLOOR, LINEAR, NET, KINDS } Kind;

/* Of one launch. */
typedef struct LaunchErrors {
    double squares; /* m^2 */
    int frames;
} LaunchErrors;

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
        double most = 0;
        for (int i = 0; i < rows->numbers; i += SUBSPACE_POSE) {
            const double x = (double)subspace->numbers[i] - (double)recorded[i],
                         y = (double)subspace->numbers[i + 1] - (double)recorded[i + 1];
            errors->squares += x * x + y * y;
            most = fmax(most, x * x + y * y);
        }
        near = near && most <= apart * apart;
        errors->frames += near;
    }
}

static int compare_frames(const void *a, const void *b) {
    const int x = ((const LaunchErrors *)a)->frames, y = ((const LaunchErrors *)b)->frames;
    return (x > y) - (x < y);
}

static bool score_kind(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows, Kind kind,
                       SubspaceErrors *result, Error *error) {
    Subspace subspace;
    LaunchErrors *errors = calloc((size_t)rows->launches, sizeof *errors);
    const bool ok = subspace_make(&subspace, net, predictor, kind == NET, error) &&
                    (errors != NULL || error_memory(error, "subspace"));
    double squares = 0;
    for (int i = 0; ok && i < rows->launches; i++) {
        run_launch(&subspace, rows, i, kind, &errors[i]);
        squares += errors[i].squares;
    }
    if (ok) {
        const double bodies = rows->numbers / SUBSPACE_POSE;
        qsort(errors, (size_t)rows->launches, sizeof *errors, compare_frames);
        *result = (SubspaceErrors){sqrt(squares / (bodies * (rows->states - 2) * rows->launches)),
                                   (double)errors[rows->launches / 2].frames};
    }
    subspace_free(&subspace);
    free(errors);
    return ok;
}

bool subspace_score(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows,
                    SubspaceScore *score, Error *error) {
    score->components = predictor->components;
    return score_kind(net, predictor, rows, FLOOR, &score->floor, error) &&
           score_kind(net, predictor, rows, LINEAR, &score->linear, error) &&
           score_kind(net, predictor, rows, NET, &score->net, error);
}

typedef struct Trainer {
    const Scene *scene;
    const SubspaceTraining *training;
    SubspaceNet *net;
    PoseRows rows, held_out;
    float *components; /* [launches, states, components] */
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static bool record(Trainer *trainer, PoseRows *rows, bool scoring, int count, Error *error) {
    Launch *launches = malloc((size_t)count * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "subspace");
    ok = ok && (scoring ? launches_for_scoring : launches_for_training)(trainer->scene, count, launches, error) &&
         subspace_record(rows, trainer->scene, launches, count, &trainer->progress, error);
    free(launches);
    return ok;
}

static bool make_net(Trainer *trainer, Error *error) {
    const Scene *scene = trainer->scene;
    const int numbers = trainer->rows.numbers;
    SubspaceShape shape = {
        .bodies = numbers / SUBSPACE_POSE, .hidden = trainer->training->hidden, .frames_before = scene->bomb.frame};
    for (int i = 0; i < SUBSPACE_PREDICTORS_MAX && shape.components < numbers; i++) {
        shape.components = sizes[i] < numbers ? sizes[i] : numbers;
        shape.predictors[shape.predictor_count++] = shape.components;
    }
    if (!subspace_shape_check(&shape, scene->name, error)) return false;
    SubspaceNet *net = trainer->net = subspace_net_create(&shape, error);
    if (net == NULL) return false;
    net->physics = subspace_physics(scene);
    snprintf(net->scene, sizeof net->scene, "%s", scene->name);
    return true;
}

/* What the net has of the run in which no bomb appears: its poses up to the bomb's frame, and where the bodies rest;
   the rest of the bomb is the mean of its rows. */
static void take_rest(const Trainer *trainer, const LaunchRuns *quiet) {
    const Scene *scene = trainer->scene;
    const PoseRows *rows = &trainer->rows;
    float *before = trainer->net->before, *rest = trainer->net->rest;
    for (int frame = 1; frame <= scene->bomb.frame; frame++)
        for (int body = 0; body < scene->body_count; body++) {
            if (scene->bodies[body].fixed) continue;
            const BodyPose *pose = &launch_runs_frame(quiet, 0, frame)[body];
            *before++ = pose->position.x;
            *before++ = pose->position.y;
            *before++ = pose->angle;
        }
    for (int body = 0; body < scene->body_count; body++) {
        if (scene->bodies[body].fixed) continue;
        const BodyPose *pose = &launch_runs_frame(quiet, 0, scene->frames)[body];
        subspace_pose_numbers(scene->bodies[body].size, pose->position, pose->angle, rest);
        rest += SUBSPACE_POSE;
    }
    for (int j = 0; j < SUBSPACE_POSE; j++) {
        double sum = 0;
        for (int launch = 0; launch < rows->launches; launch++)
            for (int state = 0; state < rows->states; state++)
                sum += (double)pose_row(rows, launch, state)[rows->numbers - SUBSPACE_POSE + j];
        rest[j] = (float)(sum / ((double)rows->launches * rows->states));
    }
}

/* The basis of the net, the components of all rows, and their ranges. */
static bool find_components(Trainer *trainer, Error *error) {
    SubspaceNet *net = trainer->net;
    const PoseRows *rows = &trainer->rows;
    const size_t numbers = (size_t)rows->numbers, count = (size_t)net->shape.components;
    const size_t states = (size_t)rows->launches * (size_t)rows->states;
    const PrincipalRows of = {rows->rows, states, rows->numbers, (size_t)rows->states};
    double *centre = malloc((2 + numbers) * numbers * sizeof *centre), *values = centre + numbers,
           *vectors = values + numbers;
    trainer->components = malloc(states * count * sizeof *trainer->components);
    bool ok = (centre != NULL && trainer->components != NULL) || error_memory(error, "subspace");
    for (size_t j = 0; ok && j < numbers; j++) centre[j] = (double)net->rest[j];
    ok = ok && principal_components(&of, centre, values, vectors, error);
    if (ok) {
        const size_t lanes = (size_t)subspace_lanes(rows->numbers);
        for (size_t k = 0; k < count; k++)
            for (size_t j = 0; j < numbers; j++) net->basis[k * lanes + j] = (float)vectors[k * numbers + j];
#pragma omp parallel for schedule(static)
        for (size_t i = 0; i < states; i++)
            for (size_t k = 0; k < count; k++)
                trainer->components[i * count + k] = subspace_component(net, rows->rows + i * numbers, (int)k);
        for (size_t k = 0; k < count; k++) {
            net->low[k] = net->high[k] = trainer->components[k];
            for (size_t i = 0; i < states; i++) {
                const float z = trainer->components[i * count + k];
                if (z < net->low[k]) net->low[k] = z;
                if (z > net->high[k]) net->high[k] = z;
            }
        }
    }
    free(centre);
    return ok;
}

/* Fits a predictor; its rate falls to 0 by the square of what is left. */
static bool fit_predictor(Trainer *trainer, int i, Error *error) {
    const SubspaceTraining *training = trainer->training;
    SubspaceNet *net = trainer->net;
    SubspacePredictor *predictor = &net->predictors[i];
    double linear[2 * SUBSPACE_COMPONENTS_MAX], loss = 0, *slopes = NULL;
    const WindowData data = {.rows = &trainer->rows,
                             .components = trainer->components,
                             .stride = net->shape.components,
                             .count = net->shape.predictors[i],
                             .linear = linear,
                             .low = net->low,
                             .high = net->high};
    Adam adam = {0};
    window_linear(&data, linear);
    WindowFit *fit = window_fit_create(&data, net->shape.hidden, error);
    bool ok = fit != NULL && adam_create(&adam, network_parameter_count(fit->shape), error);
    if (ok) {
        slopes = malloc((size_t)adam.count * sizeof *slopes);
        ok = slopes != NULL || error_memory(error, "subspace");
        window_fit_begin(fit, training->seed + (uint64_t)i, adam.weights);
    }
    for (int epoch = 0; ok && epoch < training->epochs; epoch++) {
        if (!progress_report(&trainer->progress, epoch, training->epochs)) break;
        loss = 0;
        for (int batch = 0; ok && batch < training->batches; batch++) {
            const uint64_t seed = (training->seed << 32) + ((uint64_t)i << 24) + (uint64_t)adam.steps;
            const double left = 1 - (double)adam.steps / ((double)training->epochs * training->batches);
            loss += window_fit_slopes(fit, adam.weights, seed, slopes) / training->batches;
            ok = (slopes_limit(slopes, adam.count, longest_slopes) && isfinite(loss)) ||
                 error_input(error, "subspace", "training diverged in epoch %d", epoch + 1);
            adam_step(&adam, slopes, first_rate * left * left);
        }
    }
    if (ok) window_fit_store(fit, adam.weights, predictor);
    if (ok && !trainer->stage.stopped && training->on_score != NULL) {
        SubspaceScore score;
        ok = subspace_score(net, predictor, &trainer->held_out, &score, error);
        if (ok) training->on_score(training->context, &score, loss);
    }
    free(slopes);
    adam_free(&adam);
    window_fit_destroy(fit);
    return ok;
}

static bool run(Trainer *trainer, Error *error) {
    progress_next_stage(&trainer->stage, recording_share);
    if (!record(trainer, &trainer->rows, false, trainer->training->launches, error)) return false;
    if (trainer->rows.states < WINDOW_FRAMES + 3)
        return error_input(error, trainer->scene->name, "%d frames with the bomb; training needs %d",
                           trainer->rows.states - 1, WINDOW_FRAMES + 2);
    progress_next_stage(&trainer->stage, recording_share / 10);
    if (!record(trainer, &trainer->held_out, true, SUBSPACE_HELD_OUT, error)) return false;

    /* The components, from a run in which no bomb appears. */
    Method recorder;
    LaunchRuns quiet = {0};
    Launch never = launch_of(trainer->scene);
    never.frame = trainer->scene->frames + 1;
    bool ok = method_parse(&recorder, offline, error) &&
              launch_runs_record(&quiet, trainer->scene, &recorder, &never, 1, NULL, error) && make_net(trainer, error);
    if (ok) take_rest(trainer, &quiet);
    launch_runs_free(&quiet);
    if (!ok || !find_components(trainer, error)) return false;

    /* The predictors; shares of the progress are by components, with which the time grows. */
    const SubspaceShape *shape = &trainer->net->shape;
    const double all = 1 - trainer->stage.begin - trainer->stage.share;
    int components = 0;
    for (int i = 0; i < shape->predictor_count; i++) components += shape->predictors[i];
    for (int i = 0; ok && i < shape->predictor_count; i++) {
        progress_next_stage(&trainer->stage, all * shape->predictors[i] / components);
        ok = fit_predictor(trainer, i, error);
    }
    return ok;
}

SubspaceNet *subspace_train(const Scene *scene, const SubspaceTraining *training, const Progress *progress,
                            Error *error) {
    Trainer trainer = {.scene = scene, .training = training, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    const bool ok = run(&trainer, error);
    if (!ok) subspace_net_destroy(trainer.net);
    pose_rows_free(&trainer.rows);
    pose_rows_free(&trainer.held_out);
    free(trainer.components);
    return ok ? trainer.net : NULL;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: recorded steps, samples of them, the loss and its gradient, and the rounds. */
#include "learning/sain_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "base/random.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Every so many frames after the impact and at rest; they differ little. */
enum { AFTER_STEP = 6, REST_EVERY = 30, FACTORIZATIONS_MAX = 120 /* 95% of the impacts on pyramids take fewer */ };

static const ReferenceAim aim = {.tolerance = 1e-6, .most = FACTORIZATIONS_MAX, .push_out = true};
static const double first_rate = 0.003;

static bool make_solver(void *context, int i, ContactSolver *solver, Error *error) {
    const SainLaunches *launches = context;
    if (launches->network != NULL) return sain_make(solver, launches->network, error);
    return i % 2 == 0 ? solver_with(solver, &solver_engine, SAIN_ENGINE_SETTINGS, error)
                      : solver_with(solver, &solver_momentum, "k=50", error);
}

static bool keep_some(void *context, const LaunchStep *step, Error *error) {
    (void)context;
    const bool wanted = step->phase == PHASE_IMPACT ||
                        (step->phase == PHASE_AFTER ? step->since % AFTER_STEP : step->frame % REST_EVERY) == 0;
    return !wanted || step->problem->contact_count == 0 ||
           (reference_solve_to(step->reference, step->problem, &aim, error) &&
            launch_step_record(step, step->reference->residual <= aim.tolerance, error));
}

bool sain_launches_record(const SainLaunches *launches, RecordedSteps *steps, const Progress *progress, Error *error) {
    const int count = launches->launches, all = launches->rounds * count;
    Launch *list = malloc((size_t)all * sizeof *list);
    bool ok = list != NULL || error_memory(error, "sain");
    for (int s = 0; ok && s < launches->scene_count; s++) {
        const Scene *scene = launches->scenes[s];
        const LaunchWatch watch = {.scene = scene,
                                   .launches = list,
                                   .count = count,
                                   .impact_frames = scene->bomb.impact_frames,
                                   .after_frames = AFTER_FRAMES,
                                   .may_fail = launches->network != NULL,
                                   .from_start = true,
                                   .make = make_solver,
                                   .see = keep_some,
                                   .context = (void *)launches};
        ok = (launches->held_out ? launches_for_scoring : launches_for_training)(scene, all, list, error);
        /* Launches rise along the family: a round takes one in `rounds`, so that each covers the family. */
        for (int i = 0; ok && i < count; i++) list[i] = list[i * launches->rounds + launches->round];
        ok = ok && launches_check(scene, list, count, error) && launches_observe(&watch, steps, progress, error);
    }
    free(list);
    return ok;
}

void sain_samples_free(SainSamples *samples) {
    free(samples->items);
    free(samples->rows);
    *samples = (SainSamples){.count = 0};
}

/* The receivers in a view, and their corrections to the converged velocities. */
static bool add_view(SainSamples *samples, const SainView *view, const ReferenceVelocity *velocities) {
    if (!array_reserve((void **)&samples->items, &samples->item_capacity, samples->count + (size_t)view->body_count + 1,
                       sizeof *samples->items) ||
        !array_reserve((void **)&samples->rows, &samples->row_capacity,
                       samples->row_count + (size_t)view->row_count + 1, sizeof *samples->rows))
        return false;
    for (int b = 0; b < view->body_count; b++) {
        const SainBody *body = &view->bodies[b];
        const ReferenceVelocity *velocity = &velocities[body->body];
        SainSample *sample = &samples->items[samples->count++];
        double target[SAIN_OUTPUTS];
        *sample = (SainSample){.first = (int)samples->row_count, .rows = body->rows, .scale = body->scale};
        sain_target(body, velocity->x, velocity->y, velocity->spin, target);
        for (int o = 0; o < SAIN_OUTPUTS; o++) sample->target[o] = (float)target[o];
        for (int i = 0; i < SAIN_BODY_INPUTS; i++) sample->body[i] = view->body_inputs[i * view->body_count + b];
        for (int r = body->first; r < body->first + body->rows; r++, samples->row_count++)
            for (int i = 0; i < SAIN_PAIR_INPUTS; i++)
                samples->rows[samples->row_count].numbers[i] = view->pair_inputs[i * view->row_count + r];
    }
    samples->problems += view->body_count > 0;
    return true;
}

bool sain_samples_add(SainSamples *samples, const RecordedSteps *steps, bool impacts_only, Error *error) {
    ContactSolver engine = {0};
    PairMoment moment = {0};
    SainView view = {0};
    samples->unconverged += steps->unconverged;
    bool ok = solver_with(&engine, &solver_engine, SAIN_ENGINE_SETTINGS, error);
    for (size_t i = 0; ok && i < steps->count; i++) {
        const RecordedStep *step = &steps->items[i];
        if (impacts_only && !step->impact) continue;
        ok = pair_moment_reserve(&moment, &step->problem) || error_memory(error, "sain");
        if (!ok) break;
        ContactSolution solution = pair_moment_solution(&moment);
        ok = solver_engine.solve(engine.state, &step->problem, &solution, error) &&
             ((sain_view_make(&view, &step->problem, solution.velocities) &&
               add_view(samples, &view, step->velocities)) ||
              error_memory(error, "sain"));
    }
    solver_destroy(&engine);
    pair_moment_free(&moment);
    sain_view_free(&view);
    return ok;
}

/* Errors count in proportion to the scale of the outputs, so that a box at rest, which must not creep, counts as much
   as one in a crash; `slow` (m/s) is added to the scale. Below `smooth_below` by their square, as in Ajay et al., above
   by their size: a few crashes would outweigh all else. */
static const double slow = 0.2, smooth_below = 1;

int sain_weight_count(const SainNetwork *network) {
    return network_parameter_count(network->relation) + network_parameter_count(network->object);
}

bool sain_loss_begin(SainLoss *loss, const SainNetwork *network, Error *error) {
    loss->network = network;
    loss->object = network_block_create(network->object, error);
    if (loss->object == NULL) return false;
    loss->slopes = calloc((size_t)SAIN_OBJECT_INPUTS * BLOCK_ROWS, sizeof *loss->slopes);
    return loss->slopes != NULL || error_memory(error, "sain");
}

void sain_loss_free(SainLoss *loss) {
    for (int i = 0; i < loss->block_count; i++) network_block_destroy(loss->relation[i]);
    network_block_destroy(loss->object);
    free(loss->relation);
    free(loss->slopes);
    *loss = (SainLoss){0};
}

static int block_count(const SainPart *part) {
    int rows = 0;
    for (int i = 0; i < part->count; i++) rows += part->samples->items[part->items[i]].rows;
    return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
}

/* Normalised numbers to row `row` of a block. */
static void fill_row(double *values, int row, const float *numbers, int count, const Normalisation *by) {
    for (int i = 0; i < count; i++)
        values[i * BLOCK_ROWS + row] = ((double)numbers[i] - (double)by->offset[i]) * (double)by->scale[i];
}

/* Answers to a part: object->values of its last layer, [SAIN_OUTPUTS, BLOCK_ROWS]. False when memory is short. */
static bool forward(SainLoss *loss, const SainPart *part, const double *weights) {
    const SainNetwork *network = loss->network;
    const SainSamples *samples = part->samples;
    const int blocks = block_count(part);
    Error error = {0};
    if (!array_reserve((void **)&loss->relation, &loss->block_capacity, (size_t)blocks, sizeof *loss->relation))
        return false;
    for (; loss->block_count < blocks; loss->block_count++)
        if ((loss->relation[loss->block_count] = network_block_create(network->relation, &error)) == NULL) return false;

    for (int i = 0, r = 0; i < part->count; i++) {
        const SainSample *sample = &samples->items[part->items[i]];
        for (int k = 0; k < sample->rows; k++, r++)
            fill_row(loss->relation[r / BLOCK_ROWS]->values[0], r % BLOCK_ROWS,
                     samples->rows[sample->first + k].numbers, SAIN_PAIR_INPUTS, &network->relation->input);
    }
    for (int b = 0; b < blocks; b++) network_forward(loss->relation[b], weights);

    /* The object network sees the body's inputs, then sums of effects. */
    const Normalisation *by = &network->object->input;
    double *values = loss->object->values[0];
    for (int i = 0, r = 0; i < part->count; i++) {
        const SainSample *sample = &samples->items[part->items[i]];
        fill_row(values, i, sample->body, SAIN_BODY_INPUTS, by);
        for (int e = 0; e < SAIN_EFFECTS; e++) {
            const int at = SAIN_BODY_INPUTS + e;
            double sum = 0;
            for (int k = r; k < r + sample->rows; k++)
                sum +=
                    loss->relation[k / BLOCK_ROWS]->values[network->relation->layers][e * BLOCK_ROWS + k % BLOCK_ROWS];
            values[at * BLOCK_ROWS + i] = (sum - (double)by->offset[at]) * (double)by->scale[at];
        }
        r += sample->rows;
    }
    network_forward(loss->object, weights + network_parameter_count(network->relation));
    return true;
}

/* Returns the loss of the answers; fills the slopes of the outputs, 0 in unused rows. */
static double judge(SainLoss *loss, const SainPart *part) {
    const int last = loss->object->shape->layers;
    double *deltas = loss->object->deltas[last - 1], sum = 0;
    const double *outputs = loss->object->values[last];
    memset(deltas, 0, (size_t)SAIN_OUTPUTS * BLOCK_ROWS * sizeof *deltas);
    for (int i = 0; i < part->count; i++) {
        const SainSample *sample = &part->samples->items[part->items[i]];
        const double scale = (double)sample->scale, by = 1 / (scale + slow);
        for (int o = 0; o < SAIN_OUTPUTS; o++) {
            const double error = by * (scale * outputs[o * BLOCK_ROWS + i] - (double)sample->target[o]),
                         size = fabs(error);
            const bool small = size < smooth_below;
            sum += small ? error * error / 2 : smooth_below * (size - smooth_below / 2);
            deltas[o * BLOCK_ROWS + i] = by * scale * (small ? error : copysign(smooth_below, error));
        }
    }
    return sum;
}

bool sain_loss_add(SainLoss *loss, const SainPart *part, const double *weights, double *sum, double *gradient) {
    const Network *relation = loss->network->relation;
    const int object = network_parameter_count(relation), blocks = block_count(part), last = relation->layers - 1;
    const float *scale = loss->network->object->input.scale + SAIN_BODY_INPUTS;
    if (!forward(loss, part, weights)) return false;
    *sum += judge(loss, part);
    network_backward(loss->object, weights + object);
    network_add_gradient(loss->object, gradient + object);
    network_backward_to_inputs(loss->object, weights + object, loss->slopes);

    /* From the slopes of the sums to those of each row's effects. */
    for (int b = 0; b < blocks; b++)
        memset(loss->relation[b]->deltas[last], 0, (size_t)SAIN_EFFECTS * BLOCK_ROWS * sizeof(double));
    for (int i = 0, r = 0; i < part->count; i++)
        for (int k = 0; k < part->samples->items[part->items[i]].rows; k++, r++)
            for (int e = 0; e < SAIN_EFFECTS; e++)
                loss->relation[r / BLOCK_ROWS]->deltas[last][e * BLOCK_ROWS + r % BLOCK_ROWS] =
                    loss->slopes[(SAIN_BODY_INPUTS + e) * BLOCK_ROWS + i] * (double)scale[e];
    for (int b = 0; b < blocks; b++) {
        network_backward(loss->relation[b], weights);
        network_add_gradient(loss->relation[b], gradient);
    }
    return true;
}

/* Inputs of new launches exceed those of the training by a little; a share of the range on both sides is allowed. */
static const float widen = 0.1f;
static const float limit_widen = 1.5f; /* of the largest correction */
static const double output_weight = 0.1;
/* Of the weights, in proportion to the rate: a few launches have fewer impacts than the network has weights. Source:
   Loshchilov, Hutter, "Decoupled Weight Decay Regularization" (2019). */
static const double shrink = 3;

/* One number of each item; the sums of all. */
typedef struct Moments {
    double sum, square;
    float low, high;
    size_t count;
} Moments;

static Moments moments_of(const void *first, size_t stride, size_t count) {
    Moments moments = {.low = INFINITY, .high = -INFINITY, .count = count};
    const char *at = first;
    for (size_t i = 0; i < count; i++, at += stride) {
        float x;
        memcpy(&x, at, sizeof x);
        moments.sum += (double)x;
        moments.square += (double)x * (double)x;
        moments.low = x < moments.low ? x : moments.low;
        moments.high = x > moments.high ? x : moments.high;
    }
    return moments;
}

/* Inputs that never change keep their size. */
static void standardise(const Moments *moments, float *offset, float *scale) {
    const double n = (double)moments->count, mean = moments->sum / n, variance = moments->square / n - mean * mean;
    *offset = (float)mean;
    *scale = moments->high > moments->low && variance > 1e-12 ? (float)(1 / sqrt(variance)) : 1.0f;
}

static void set_range(const Moments *moments, float *low, float *high) {
    const float margin = widen * (moments->high - moments->low);
    *low = moments->low - margin;
    *high = moments->high + margin;
}

void sain_normalise(SainNetwork *network, const SainSamples *samples, bool first) {
    Normalisation *pair = &network->relation->input, *body = &network->object->input;
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) {
        const Moments moments = moments_of(&samples->rows[0].numbers[i], sizeof *samples->rows, samples->row_count);
        if (first) standardise(&moments, &pair->offset[i], &pair->scale[i]);
        set_range(&moments, &network->pair_low[i], &network->pair_high[i]);
    }
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) {
        const Moments moments = moments_of(&samples->items[0].body[i], sizeof *samples->items, samples->count);
        if (first) standardise(&moments, &body->offset[i], &body->scale[i]);
        set_range(&moments, &network->body_low[i], &network->body_high[i]);
    }
    for (int o = 0; o < SAIN_OUTPUTS; o++) {
        float most = 0;
        for (size_t i = 0; i < samples->count; i++) {
            const SainSample *sample = &samples->items[i];
            const float size = fabsf(sample->target[o]);
            if (size <= sample->scale * SAIN_ANSWER_MAX && size > most * sample->scale) most = size / sample->scale;
        }
        network->limit[o] = limit_widen * most;
    }
}

void sain_first_weights(const SainNetwork *network, uint64_t seed, double *weights) {
    const Network *relation = network->relation, *object = network->object;
    uint64_t state = seed;
    for (int l = 0; l < relation->layers; l++)
        weights = weights_of_layer(weights, relation->widths[l], relation->widths[l + 1], 1, &state);
    for (int l = 0; l < object->layers; l++)
        weights = weights_of_layer(weights, object->widths[l], object->widths[l + 1],
                                   l + 1 < object->layers ? 1 : output_weight, &state);
}

/* Work space of a round. */
typedef struct Fit {
    const SainSamples *samples;
    SainNetwork *network;
    SainLoss losses[SAIN_PARTS];
    double *gradients; /* [SAIN_PARTS, weights] */
    int items[SAIN_PARTS][BLOCK_ROWS];
    int batch; /* samples in a step */
} Fit;

/* Step `number` of Adam, on samples drawn by seed and number. *loss: mean over the batch. The same bits for any number
   of threads. False when memory is short. */
static bool fit_step(Fit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss, Error *error) {
    const size_t weights = (size_t)adam->count;
    double sums[SAIN_PARTS] = {0};
    bool ok = true;
    /* Drawn with replacement: what a step draws depends on no other step. */
    uint64_t state = seed + (uint64_t)number * UINT64_C(0x9e3779b97f4a7c15);
    split_mix(&state);
    for (int i = 0; i < fit->batch; i++)
        fit->items[i % SAIN_PARTS][i / SAIN_PARTS] = random_below(&state, (int)fit->samples->count);
    memset(fit->gradients, 0, SAIN_PARTS * weights * sizeof *fit->gradients);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok)
    for (int p = 0; p < SAIN_PARTS; p++) {
        const SainPart part = {fit->samples, fit->items[p], (fit->batch + SAIN_PARTS - 1 - p) / SAIN_PARTS};
        const bool done =
            sain_loss_add(&fit->losses[p], &part, adam->weights, &sums[p], fit->gradients + (size_t)p * weights);
        ok = ok && done;
    }
    if (!ok) return error_memory(error, "sain");
    *loss = 0;
    for (int p = 0; p < SAIN_PARTS; p++) *loss += sums[p] / fit->batch;
    for (size_t i = 0; i < weights; i++) {
        double slope = 0;
        for (size_t p = 0; p < SAIN_PARTS; p++) slope += fit->gradients[p * weights + i];
        fit->gradients[i] = slope / fit->batch;
    }
    adam_step(adam, fit->gradients, rate);
    for (size_t i = 0; i < weights; i++) adam->weights[i] *= 1 - rate * shrink;
    return true;
}

/* Whether the method would use the answer (methods/sain.c). */
static bool is_used(const SainNetwork *network, const SainSamples *samples, const SainSample *sample,
                    const double *outputs) {
    bool used = true;
    for (int o = 0; o < SAIN_OUTPUTS; o++) used = used && fabs(outputs[o * BLOCK_ROWS]) <= (double)network->limit[o];
    for (int i = 0; i < SAIN_BODY_INPUTS; i++)
        used = used && sample->body[i] >= network->body_low[i] && sample->body[i] <= network->body_high[i];
    for (int r = sample->first; r < sample->first + sample->rows; r++)
        for (int i = 0; i < SAIN_PAIR_INPUTS; i++) {
            const float x = samples->rows[r].numbers[i];
            used = used && x >= network->pair_low[i] && x <= network->pair_high[i];
        }
    return used;
}

/* The errors on other samples, of which there must be some. */
static bool find_errors(Fit *fit, const double *weights, const SainSamples *samples, SainErrors *errors, Error *error) {
    SainLoss *loss = &fit->losses[0];
    double mean[SAIN_OUTPUTS] = {0}, with = 0, without = 0, constant = 0;
    const double count = (double)samples->count;
    for (int o = 0; o < SAIN_OUTPUTS; o++) {
        for (size_t i = 0; i < fit->samples->count; i++) mean[o] += (double)fit->samples->items[i].target[o];
        mean[o] /= (double)fit->samples->count;
    }
    for (size_t first = 0; first < samples->count;) {
        SainPart part = {samples, fit->items[0], 0};
        for (; part.count < BLOCK_ROWS && first < samples->count; first++) fit->items[0][part.count++] = (int)first;
        if (!forward(loss, &part, weights)) return error_memory(error, "sain");
        for (int i = 0; i < part.count; i++) {
            const SainSample *sample = &samples->items[part.items[i]];
            const double *outputs = loss->object->values[loss->object->shape->layers] + i;
            const bool used = is_used(fit->network, samples, sample, outputs);
            for (int o = 0; o < SAIN_OUTPUTS; o++) {
                const double target = (double)sample->target[o], off = mean[o] - target,
                             left = (used ? (double)sample->scale * outputs[o * BLOCK_ROWS] : 0) - target;
                with += left * left;
                without += target * target;
                constant += off * off;
            }
        }
    }
    *errors = (SainErrors){sqrt(with / count), sqrt(without / count), sqrt(constant / count)};
    return true;
}

enum { REPORT_EVERY = 100 }; /* steps */

typedef struct Trainer {
    const SainTraining *training;
    SainNetwork *network;
    Adam adam;
    SainSamples samples, held_out;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

/* Records a round and adds its samples; ranges, and in the first round the normalisation, follow from the samples. */
static bool record_round(Trainer *trainer, int round, Error *error) {
    const SainTraining *training = trainer->training;
    SainNetwork *network = trainer->network;
    RecordedSteps steps = {0}, held_out = {0};
    const SainLaunches launches = {.scenes = training->scenes,
                                   .scene_count = training->scene_count,
                                   .launches = training->launches,
                                   .rounds = training->rounds,
                                   .round = round,
                                   .network = round > 0 ? network : NULL},
                       others = {.scenes = training->scenes,
                                 .scene_count = training->scene_count,
                                 .launches = training->launches / 4 + 1,
                                 .rounds = 1,
                                 .held_out = true};
    bool ok = sain_launches_record(&launches, &steps, &trainer->progress, error);
    if (round == 0)
        ok = ok && sain_launches_record(&others, &held_out, &trainer->progress, error) &&
             sain_samples_add(&trainer->held_out, &held_out, true, error);
    ok = ok && sain_samples_add(&trainer->samples, &steps, false, error);
    recorded_steps_free(&steps);
    recorded_steps_free(&held_out);
    if (ok && trainer->samples.count == 0) return error_input(error, "sain", "no box is touched: more launches needed");
    if (ok) sain_normalise(network, &trainer->samples, round == 0);
    return ok;
}

/* Fits the samples so far, and scores the result. The rate falls from the first to 0 in equal steps; each round begins
   with half that of the round before, and without moments, as its loss is another. */
static bool fit_round(Trainer *trainer, int round, Error *error) {
    const SainTraining *training = trainer->training;
    SainNetwork *network = trainer->network;
    Adam *adam = &trainer->adam;
    const uint64_t seed = training->seed + (uint64_t)(round + 1) * 1000003;
    double loss = 0, sum = 0;
    int in_sum = 0;
    SainScore score = {.round = round,
                       .problems = trainer->samples.problems,
                       .bodies = trainer->samples.count,
                       .unconverged = trainer->samples.unconverged + trainer->held_out.unconverged};
    Fit fit = {.samples = &trainer->samples,
               .network = network,
               .batch = training->batch,
               .gradients = calloc((size_t)SAIN_PARTS * (size_t)adam->count, sizeof *fit.gradients)};
    bool ok = fit.gradients != NULL || error_memory(error, "sain");
    for (int p = 0; ok && p < SAIN_PARTS; p++) ok = sain_loss_begin(&fit.losses[p], network, error);
    adam_restart(adam);
    for (int done = 0, all = training->steps; ok && done < all; done++) {
        if (done % REPORT_EVERY == 0) {
            if (!progress_report(&trainer->progress, done, all)) break;
            sum = in_sum = 0;
        }
        const double rate = first_rate / (1 << round) * (1 - (double)done / all);
        ok = fit_step(&fit, adam, seed, done, rate, &loss, error);
        sum += loss;
        in_sum++;
    }
    const int relation = network_parameter_count(network->relation);
    /* Rounded into the network, as a file would. */
    for (int i = 0; i < relation; i++) network->relation->weights[0][i] = (float)adam->weights[i];
    for (int i = relation; i < adam->count; i++) network->object->weights[0][i - relation] = (float)adam->weights[i];
    if (ok && !trainer->stage.stopped && training->on_score != NULL) {
        ok = find_errors(&fit, adam->weights, &trainer->held_out, &score.held_out, error);
        score.loss = sum / in_sum;
        if (ok) training->on_score(training->context, &score);
    }
    for (int p = 0; p < SAIN_PARTS; p++) sain_loss_free(&fit.losses[p]);
    free(fit.gradients);
    return ok;
}

static bool run(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds;
    if (!sain_network_create(trainer->network, error) ||
        !adam_create(&trainer->adam, sain_weight_count(trainer->network), error))
        return false;
    sain_first_weights(trainer->network, trainer->training->seed, trainer->adam.weights);
    for (int round = 0; round < rounds; round++) {
        progress_next_stage(&trainer->stage, 0.2 / rounds);
        bool ok = record_round(trainer, round, error);
        progress_next_stage(&trainer->stage, 0.8 / rounds);
        ok = ok && fit_round(trainer, round, error);
        if (!ok && (error->kind != ERROR_INTERRUPTED || round == 0)) return false;
        if (trainer->stage.stopped) break;
    }
    *error = (Error){0}; /* a later round that was stopped leaves the network of the one before */
    return true;
}

bool sain_training_run(const SainTraining *training, SainNetwork *network, const Progress *progress, Error *error) {
    Trainer trainer = {.training = training, .network = network, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    *network = (SainNetwork){0};
    const bool ok = run(&trainer, error);
    adam_free(&trainer.adam);
    sain_samples_free(&trainer.samples);
    sain_samples_free(&trainer.held_out);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of gns: the loss of a batch on all threads, first weights and units, steps and scores. */
#include "learning/gns_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/learning.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Beyond this error, in units of the acceleration, the loss is linear (Huber), so that a hit does not outweigh all
   else. */
static const float knee = 1.0f;

void gns_fit_free(GnsFit *fit) {
    for (int i = 0; fit->workers != NULL && i < fit->threads; i++) {
        gns_example_free(&fit->workers[i].example);
        gns_pass_free(&fit->workers[i].pass);
        gns_backward_free(&fit->workers[i].back);
        free(fit->workers[i].slopes);
    }
    free(fit->workers);
    free(fit->mean_gradient);
    *fit = (GnsFit){.examples = NULL};
}

bool gns_fit_begin(GnsFit *fit, const GnsExamples *examples, GnsNet *net, int batch, Error *error) {
    const size_t count = (size_t)net->layout.parameters;
    *fit = (GnsFit){.examples = examples, .net = net, .batch = batch, .threads = omp_get_max_threads()};
    fit->workers = calloc((size_t)fit->threads, sizeof *fit->workers);
    fit->mean_gradient =
        calloc(1, (count + (size_t)batch) * sizeof(double) + count * (1 + (size_t)batch) * sizeof(float));
    if (fit->workers == NULL || fit->mean_gradient == NULL) return error_memory(error, "gns");
    fit->losses = fit->mean_gradient + count;
    fit->transposed = (float *)(fit->losses + batch);
    fit->gradients = fit->transposed + count;
    for (int i = 0; i < fit->threads; i++) fit->workers[i].pass.tape = true;
    return true;
}

/* Particles that count. */
static int count_particles(const GnsExample *example) {
    int count = 0;
    for (int i = 0; i < example->particles.bodies; i++) count += example->counts[i] > 0 ? BOX_PARTICLES : 0;
    return count;
}

/* The loss of the example in the worker, whose pass has run: the mean over particles that count of the squared error,
   in units of the net's acceleration. Fills worker->slopes. */
static double gns_example_loss(GnsWorker *worker, const GnsScales *scales) {
    const GnsExample *example = &worker->example;
    const int count = count_particles(example);
    const float share = 1.0f / (float)(count > 0 ? count : 1);
    double sum = 0;
    for (int i = 0; i < GNS_OUTPUTS * gns_particle_count(&example->particles); i++) {
        const float by = example->counts[i / (GNS_OUTPUTS * BOX_PARTICLES)] * share;
        const float off = worker->pass.outputs[i] - example->targets[i] / scales->acceleration, size = fabsf(off);
        sum += (double)by * (double)(size < knee ? off * off : knee * (2 * size - knee));
        worker->slopes[i] = by * 2 * (size < knee ? off : copysignf(knee, off));
    }
    return sum;
}

static bool run_example(GnsFit *fit, GnsWorker *worker, const GnsExamples *examples, uint64_t number, double *loss,
                        float *gradient) {
    const GnsNet *net = fit->net;
    GnsExample *example = &worker->example;
    if (!gns_example_make(example, examples, number) ||
        !gns_graph_build(&example->graph, &example->particles, example->from->ground, example->from->ground_count,
                         &net->scales) ||
        !array_reserve((void **)&worker->slopes, &worker->slope_capacity,
                       (size_t)gns_particle_count(&example->particles), GNS_OUTPUTS * sizeof *worker->slopes) ||
        !gns_forward(&worker->pass, &net->layout, net->parameters, &example->graph))
        return false;
    *loss = gns_example_loss(worker, &net->scales);
    return gradient == NULL || gns_backward(&worker->back, &worker->pass, &net->layout, net->parameters,
                                            fit->transposed, &example->graph, worker->slopes, gradient);
}

static bool run_batch(GnsFit *fit, const GnsExamples *examples, uint64_t first, bool gradients) {
    const ptrdiff_t count = fit->net->layout.parameters;
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) num_threads(fit->threads)
    for (int i = 0; i < fit->batch; i++) {
        float *gradient = gradients ? fit->gradients + i * count : NULL;
        if (gradients) memset(gradient, 0, (size_t)count * sizeof *gradient);
        const bool done = run_example(fit, &fit->workers[omp_get_thread_num()], examples, first + (uint64_t)i,
                                      &fit->losses[i], gradient);
        ok = ok && done;
    }
    return ok;
}

static double mean_loss(const GnsFit *fit) {
    double sum = 0;
    for (int i = 0; i < fit->batch; i++) sum += fit->losses[i] / fit->batch;
    return sum;
}

/* The same without a gradient. */
static bool gns_fit_loss(GnsFit *fit, const GnsExamples *examples, uint64_t first, double *loss, Error *error) {
    if (!run_batch(fit, examples, first, false)) return error_memory(error, "gns");
    *loss = mean_loss(fit);
    return true;
}

bool gns_fit_batch(GnsFit *fit, uint64_t first, double *loss, Error *error) {
    const int count = fit->net->layout.parameters;
    gns_transpose(&fit->net->layout, fit->net->parameters, fit->transposed);
    if (!run_batch(fit, fit->examples, first, true)) return error_memory(error, "gns");
    memset(fit->mean_gradient, 0, (size_t)count * sizeof *fit->mean_gradient);
    for (int i = 0; i < fit->batch; i++)
        for (int k = 0; k < count; k++)
            fit->mean_gradient[k] += (double)fit->gradients[(ptrdiff_t)i * count + k] / fit->batch;
    *loss = mean_loss(fit);
    return true;
}

enum {
    EPOCH = 250,           /* gradient steps between two states on disk */
    SCALE_EXAMPLES = 2000, /* that set the units */
    HELD_OUT_BATCHES = 64,
    SCORES = 10
};

/* Trajectories come from nearly converged steps, as those of playback. */
const char gns_teacher[] = "momentum:k=30";

static const double slope_max = 1; /* of a batch */
static const double record_share = 0.1;

typedef struct Trainer {
    GnsTraining *training;
    GnsNet *net;
    GnsExamples examples, held_out; /* held_out: the same runs, other examples */
    GnsFit batches;
    Fit fit;
    double scoring; /* s */
} Trainer;

/* Uniform, with the variance 1 / inputs, so that a layer keeps the size of its numbers. Biases 0, gains 1. */
static void first_layer(double *weights, const GnsMlp *mlp, int layer, int inputs, int outputs, uint64_t *random) {
    weights_uniform(weights + mlp->weights[layer], inputs * outputs, sqrt(3.0 / inputs), random);
}

static void first_mlp(double *weights, const GnsMlp *mlp, uint64_t *random) {
    first_layer(weights, mlp, 0, mlp->inputs, mlp->width, random);
    first_layer(weights, mlp, 1, mlp->width, mlp->width, random);
    first_layer(weights, mlp, 2, mlp->width, mlp->outputs, random);
    for (int i = 0; mlp->gain >= 0 && i < mlp->outputs; i++) weights[mlp->gain + i] = 1;
}

static void first_weights(double *weights, const GnsLayout *layout, uint64_t seed) {
    uint64_t random = seed;
    first_mlp(weights, &layout->nodes, &random);
    first_mlp(weights, &layout->edges, &random);
    for (int m = 0; m < layout->rounds; m++) {
        first_mlp(weights, &layout->edge_rounds[m], &random);
        first_mlp(weights, &layout->node_rounds[m], &random);
    }
    first_mlp(weights, &layout->decoder, &random);
}

/* What examples have. */
typedef struct Measured {
    double velocity, acceleration, count; /* sum of squares; of sizes, as squares follow the few hits; of numbers */
    float fastest, strongest;
} Measured;

static void gns_training_measure(Measured *sum, const GnsExample *example) {
    for (int i = 0; i < gns_particle_count(&example->particles); i++) {
        const Vec2 velocity = example->particles.velocity[i][GNS_HISTORY - 1];
        const float *target = example->targets + (ptrdiff_t)GNS_OUTPUTS * i;
        sum->velocity += (double)vec2_dot(velocity, velocity);
        sum->acceleration += fabs((double)target[0]) + fabs((double)target[1]);
        sum->count += 2;
        sum->fastest = fmaxf(sum->fastest, fmaxf(fabsf(velocity.x), fabsf(velocity.y)));
        sum->strongest = fmaxf(sum->strongest, fmaxf(fabsf(target[0]), fabsf(target[1])));
    }
}

static bool find_scales(const GnsExamples *examples, float radius, GnsScales *scales, Error *error) {
    Measured sum = {.count = 0};
    GnsExample example = {.from = NULL};
    bool ok = true;
    for (uint64_t i = 0; ok && i < SCALE_EXAMPLES; i++) {
        ok = gns_example_make(&example, examples, i);
        if (ok) gns_training_measure(&sum, &example);
    }
    gns_example_free(&example);
    if (!ok) return error_memory(error, "gns");
    *scales = (GnsScales){radius, (float)sqrt(sum.velocity / sum.count), (float)(sum.acceleration / sum.count),
                          sum.fastest, sum.strongest};
    if (!isfinite(scales->velocity) || !isfinite(scales->acceleration) || !(scales->velocity > 0) ||
        !(scales->acceleration > 0))
        return error_input(error, "gns", "the recorded launches have no motion to learn from");
    return true;
}

static bool gns_training_record(Trainer *trainer, Error *error) {
    const GnsTraining *training = trainer->training;
    Method method;
    bool ok = method_parse(&method, gns_teacher, error);
    for (int i = 0; i < training->scene_count; i++) {
        if (!ok) {
            scene_destroy(training->scenes[i]);
            continue;
        }
        progress_next_stage(&trainer->fit.share, record_share / training->scene_count);
        ok = gns_examples_add(&trainer->examples, training->scenes[i], &method, training->launches,
                              &trainer->fit.progress, error);
    }
    return ok;
}

static void use_weights(Trainer *trainer) {
    const Adam *adam = &trainer->fit.adam;
    for (int64_t i = 0; i < adam->count; i++) trainer->net->parameters[i] = (float)adam->weights[i];
}

static bool gns_training_step(void *context, Adam *adam, double *loss, Error *error) {
    Trainer *trainer = context;
    const GnsTraining *training = trainer->training;
    double *slopes = trainer->batches.mean_gradient, batch_loss;
    if (!gns_fit_batch(&trainer->batches, (uint64_t)adam->steps * (uint64_t)training->batch, &batch_loss, error))
        return false;
    *loss += batch_loss;
    slopes_limit(slopes, adam->count, slope_max);
    adam_step(adam, slopes, training->rate * (double)(training->steps - adam->steps) / training->steps);
    use_weights(trainer);
    return true;
}

static bool gns_training_score(Trainer *trainer, double loss, Error *error) {
    GnsScore result = {.steps = (int)trainer->fit.adam.steps, .loss = loss};
    for (int i = 0; i < HELD_OUT_BATCHES; i++) {
        double held_out = 0;
        if (!gns_fit_loss(&trainer->batches, &trainer->held_out, (uint64_t)i * (uint64_t)trainer->training->batch,
                          &held_out, error))
            return false;
        result.held_out += held_out / HELD_OUT_BATCHES;
    }
    if (trainer->training->on_score != NULL) trainer->training->on_score(trainer->training->context, &result);
    return true;
}

static bool score_some(void *context, double loss, int64_t steps, Error *error) {
    Trainer *trainer = context;
    const int64_t now = trainer->fit.adam.steps, all = trainer->training->steps;
    if (now * SCORES / all == (now - steps) * SCORES / all) return true;
    const double begin = clock_seconds();
    if (!gns_training_score(trainer, loss / (double)steps, error)) return false;
    trainer->scoring += clock_seconds() - begin;
    return true;
}

static bool run_steps(Trainer *trainer, Error *error) {
    GnsTraining *training = trainer->training;
    const FitSteps steps = {training->steps, EPOCH, gns_training_step, score_some, trainer};
    const double begin = clock_seconds();
    const int64_t before = trainer->fit.adam.steps;
    double loss;
    if (!fit_run(&trainer->fit, 0, trainer->fit.adam.count, &steps, &loss, error)) return false;
    if (training->steps > before)
        training->seconds_a_step = (clock_seconds() - begin - trainer->scoring) / (double)(training->steps - before);
    return true;
}

bool gns_training_time_pass(const GnsNet *net, const GnsRuns *runs, double *seconds, int *boxes, Error *error) {
    enum { PASSES = 3 };
    GnsExample example = {.from = NULL};
    GnsPass pass = {.tape = false};
    bool ok = gns_example_frame(&example, runs, 0, runs->scene->bomb.frame);
    *seconds = INFINITY;
    for (int i = 0; ok && i < PASSES; i++) {
        const double begin = clock_seconds();
        ok = gns_graph_build(&example.graph, &example.particles, runs->ground, runs->ground_count, &net->scales) &&
             gns_forward(&pass, &net->layout, net->parameters, &example.graph);
        *seconds = fmin(*seconds, clock_seconds() - begin);
    }
    *boxes = example.particles.bodies;
    gns_pass_free(&pass);
    gns_example_free(&example);
    return ok || error_memory(error, "gns");
}

static bool gns_training_begin(Trainer *trainer, Error *error) {
    const GnsTraining *training = trainer->training;
    const GnsLayout *layout = &trainer->net->layout;
    bool found;
    if (!fit_begin(&trainer->fit, layout->parameters, &found, error)) return false;
    if (found) return true;
    first_weights(trainer->fit.adam.weights, layout, training->seed);
    return fit_write(&trainer->fit, error);
}

static void destroy_scenes(const GnsTraining *training) {
    for (int i = 0; i < training->scene_count; i++) scene_destroy(training->scenes[i]);
}

/* A network learns one gravity: what holds resting boxes against it. */
static bool take_gravity(const GnsTraining *training, GnsNet *net, Error *error) {
    const Scene *first = training->scenes[0];
    net->gravity[0] = first->gravity.x;
    net->gravity[1] = first->gravity.y;
    for (int i = 1; i < training->scene_count; i++) {
        const Scene *other = training->scenes[i];
        if (other->gravity.x != first->gravity.x || other->gravity.y != first->gravity.y)
            return error_input(error, other->name, "its gravity is not that of %s; one network learns one gravity",
                               first->name);
    }
    return true;
}

static bool run_gns_training(Trainer *trainer, Error *error) {
    const GnsTraining *training = trainer->training;
    trainer->examples.noise = training->noise;
    trainer->examples.seed = training->seed << 32;
    const bool begun = gns_net_create(trainer->net, training->width, training->rounds, error) &&
                       take_gravity(training, trainer->net, error) && gns_training_begin(trainer, error);
    if (!begun) {
        destroy_scenes(training);
        return false;
    }
    if (!gns_training_record(trainer, error)) return false;
    trainer->held_out = trainer->examples;
    trainer->held_out.seed = ~trainer->examples.seed;
    progress_next_stage(&trainer->fit.share, 1 - record_share);
    if (!find_scales(&trainer->examples, training->radius, &trainer->net->scales, error) ||
        !gns_fit_begin(&trainer->batches, &trainer->examples, trainer->net, training->batch, error))
        return false;
    use_weights(trainer);
    return run_steps(trainer, error) &&
           gns_training_time_pass(trainer->net, &trainer->examples.scenes[trainer->examples.count - 1],
                                  &trainer->training->seconds_a_pass, &trainer->training->pass_boxes, error);
}

bool gns_training_run(GnsTraining *training, GnsNet *net, const Progress *progress, Error *error) {
    Trainer *trainer = calloc(1, sizeof *trainer);
    *net = (GnsNet){.parameters = NULL};
    if (trainer == NULL) {
        destroy_scenes(training);
        return error_memory(error, "gns");
    }
    trainer->training = training;
    trainer->net = net;
    fit_init(&trainer->fit, training->command, training->state_path, progress);
    const bool ok = run_gns_training(trainer, error);
    gns_fit_free(&trainer->batches);
    gns_examples_free(&trainer->examples);
    fit_free(&trainer->fit);
    free(trainer);
    return ok;
}

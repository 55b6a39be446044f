/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of gns: the loss of a batch on all threads, first weights and units, steps and scores. */
#include "learning/gns_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "base/random.h"
#include "engine/engine.h"
#include "learning/gns_backward.h"
#include "learning/learning.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    EPOCH = 250,           /* gradient steps between two reports */
    SCALE_EXAMPLES = 2000, /* that set the units */
    HELD_OUT_BATCHES = 64,
    SCORES = 10
};

/* The method whose runs are recorded: they come from nearly converged steps, as those of playback. */
static const char teacher[] = "momentum:k=30";

/* Beyond this error, in units of the acceleration, the loss is linear (Huber), so that a hit does not outweigh all
   else. */
static const float knee = 1.0f;

static const double slope_max = 1; /* of a batch */
static const double record_share = 0.1;

/* Of one thread. */
typedef struct Worker {
    GnsExample example;
    GnsPass pass;
    GnsBackward back;
    float *slopes; /* [particles, GNS_OUTPUTS] of the loss */
    size_t slope_capacity;
} Worker;

typedef struct Trainer {
    const GnsTraining *training;
    GnsNet *net;                    /* its parameters are those of a pass */
    GnsExamples examples, held_out; /* held_out: the same runs, other examples */
    int threads;
    Worker *workers;   /* [threads] */
    double *slopes;    /* [parameters] of the batch's mean loss; the block of these arrays */
    double *losses;    /* [batch] */
    float *transposed; /* [parameters] */
    float *gradients;  /* [batch, parameters] */
    Adam adam;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

/* The loss of the example in the worker, whose pass has run: the mean over particles that count of the squared error,
   in units of the net's acceleration. Fills worker->slopes. */
static double example_loss(Worker *worker, const GnsScales *scales) {
    const GnsExample *example = &worker->example;
    int count = 0;
    for (int i = 0; i < example->particles.bodies; i++) count += example->counts[i] > 0 ? BOX_PARTICLES : 0;
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

static bool run_example(Trainer *trainer, Worker *worker, const GnsExamples *examples, uint64_t number, double *loss,
                        float *gradient) {
    const GnsNet *net = trainer->net;
    GnsExample *example = &worker->example;
    if (!gns_example_make(example, examples, number) ||
        !gns_graph_build(&example->graph, &example->particles, example->from->ground, example->from->ground_count,
                         &net->scales) ||
        !array_reserve((void **)&worker->slopes, &worker->slope_capacity,
                       (size_t)gns_particle_count(&example->particles), GNS_OUTPUTS * sizeof *worker->slopes) ||
        !gns_forward(&worker->pass, &net->layout, net->parameters, &example->graph))
        return false;
    *loss = example_loss(worker, &net->scales);
    return gradient == NULL || gns_backward(&worker->back, &worker->pass, &net->layout, net->parameters,
                                            trainer->transposed, &example->graph, worker->slopes, gradient);
}

/* The mean loss of batch `number` of the examples, and, if `back`, its gradient in trainer->slopes; the same bits for
   any number of threads. */
static bool run_batch(Trainer *trainer, const GnsExamples *examples, uint64_t number, bool back, double *loss,
                      Error *error) {
    const ptrdiff_t count = trainer->net->layout.parameters;
    const int batch = trainer->training->batch;
    bool ok = true;
    if (back) gns_transpose(&trainer->net->layout, trainer->net->parameters, trainer->transposed);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) num_threads(trainer->threads)
    for (int i = 0; i < batch; i++) {
        float *gradient = back ? trainer->gradients + i * count : NULL;
        if (back) memset(gradient, 0, (size_t)count * sizeof *gradient);
        const bool done = run_example(trainer, &trainer->workers[omp_get_thread_num()], examples,
                                      number * (uint64_t)batch + (uint64_t)i, &trainer->losses[i], gradient);
        ok = ok && done;
    }
    if (!ok) return error_memory(error, "gns");
    if (back) memset(trainer->slopes, 0, (size_t)count * sizeof *trainer->slopes);
    for (int i = 0; back && i < batch; i++)
        for (int k = 0; k < count; k++) trainer->slopes[k] += (double)trainer->gradients[i * count + k] / batch;
    *loss = 0;
    for (int i = 0; i < batch; i++) *loss += trainer->losses[i] / batch;
    return true;
}

/* Biases 0, gains 1. */
static void first_weights(double *weights, const GnsMlp *mlp, uint64_t *random) {
    const int widths[4] = {mlp->inputs, mlp->width, mlp->width, mlp->outputs};
    double *at = weights + mlp->weights[0];
    for (int l = 0; l < 3; l++) at = weights_of_layer(at, widths[l], widths[l + 1], 1, random);
    for (int i = 0; mlp->gain >= 0 && i < mlp->outputs; i++) weights[mlp->gain + i] = 1;
}

/* The units of inputs and outputs, from examples. */
static bool find_scales(const GnsExamples *examples, float radius, GnsScales *scales, Error *error) {
    GnsExample example = {.from = NULL};
    double velocities = 0, accelerations = 0,
           count = 0; /* squares; sizes, as squares follow the few hits; of numbers */
    float fastest = 0, strongest = 0;
    bool ok = true;
    for (uint64_t e = 0; ok && e < SCALE_EXAMPLES; e++) {
        ok = gns_example_make(&example, examples, e);
        for (int i = 0; ok && i < gns_particle_count(&example.particles); i++) {
            const Vec2 velocity = example.particles.velocity[i][GNS_HISTORY - 1];
            const float *target = example.targets + (ptrdiff_t)GNS_OUTPUTS * i;
            velocities += (double)vec2_dot(velocity, velocity);
            accelerations += fabs((double)target[0]) + fabs((double)target[1]);
            count += 2;
            fastest = fmaxf(fastest, fmaxf(fabsf(velocity.x), fabsf(velocity.y)));
            strongest = fmaxf(strongest, fmaxf(fabsf(target[0]), fabsf(target[1])));
        }
    }
    gns_example_free(&example);
    if (!ok) return error_memory(error, "gns");
    *scales = (GnsScales){radius, (float)sqrt(velocities / count), (float)(accelerations / count), fastest, strongest};
    return (isfinite(scales->velocity) && isfinite(scales->acceleration) && scales->velocity > 0 &&
            scales->acceleration > 0) ||
           error_input(error, "gns", "the recorded launches have no motion to learn from");
}

static void use_weights(Trainer *trainer) {
    const Adam *adam = &trainer->adam;
    for (int64_t i = 0; i < adam->count; i++) trainer->net->parameters[i] = (float)adam->weights[i];
}

/* After each tenth of the steps; loss: the sum over the last `steps`. */
static bool score_some(Trainer *trainer, double loss, int steps, Error *error) {
    const GnsTraining *training = trainer->training;
    const int64_t now = trainer->adam.steps, all = training->steps;
    GnsScore score = {.steps = (int)now, .loss = loss / steps};
    if (training->on_score == NULL || now * SCORES / all == (now - steps) * SCORES / all) return true;
    for (int i = 0; i < HELD_OUT_BATCHES; i++) {
        double held_out = 0;
        if (!run_batch(trainer, &trainer->held_out, (uint64_t)i, false, &held_out, error)) return false;
        score.held_out += held_out / HELD_OUT_BATCHES;
    }
    training->on_score(training->context, &score);
    return true;
}

/* The rate falls to 0 in equal steps. */
static bool take_steps(Trainer *trainer, Error *error) {
    Adam *adam = &trainer->adam;
    const int all = trainer->training->steps;
    for (int done = 0; done < all && progress_report(&trainer->progress, done, all);) {
        const int begun = done, end = all - done < EPOCH ? all : done + EPOCH;
        double sum = 0, loss = 0;
        for (; done < end; done++) {
            if (!run_batch(trainer, &trainer->examples, (uint64_t)done, true, &loss, error)) return false;
            sum += loss;
            slopes_limit(trainer->slopes, adam->count, slope_max);
            adam_step(adam, trainer->slopes, trainer->training->rate * (double)(all - done) / all);
            use_weights(trainer);
        }
        if (!score_some(trainer, sum, end - begun, error)) return false;
    }
    return true;
}

/* The net, with the one gravity that it learns: what holds resting boxes against it. */
static bool make_net(Trainer *trainer, Error *error) {
    const GnsTraining *training = trainer->training;
    const Scene *first = training->scenes[0];
    GnsNet *net = trainer->net;
    if (!gns_net_create(net, training->width, training->rounds, error)) return false;
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

static bool draw_weights(Trainer *trainer, Error *error) {
    const GnsLayout *layout = &trainer->net->layout;
    uint64_t random = trainer->training->seed;
    if (!adam_create(&trainer->adam, layout->parameters, error)) return false;
    double *weights = trainer->adam.weights;
    first_weights(weights, &layout->nodes, &random);
    first_weights(weights, &layout->edges, &random);
    for (int m = 0; m < layout->rounds; m++) {
        first_weights(weights, &layout->edge_rounds[m], &random);
        first_weights(weights, &layout->node_rounds[m], &random);
    }
    first_weights(weights, &layout->decoder, &random);
    return true;
}

static bool make_space(Trainer *trainer, Error *error) {
    const size_t count = (size_t)trainer->net->layout.parameters, batch = (size_t)trainer->training->batch;
    trainer->threads = omp_get_max_threads();
    trainer->workers = calloc((size_t)trainer->threads, sizeof *trainer->workers);
    trainer->slopes = calloc(1, (count + batch) * sizeof(double) + count * (1 + batch) * sizeof(float));
    if (trainer->workers == NULL || trainer->slopes == NULL) return error_memory(error, "gns");
    trainer->losses = trainer->slopes + count;
    trainer->transposed = (float *)(trainer->losses + batch);
    trainer->gradients = trainer->transposed + count;
    for (int i = 0; i < trainer->threads; i++) trainer->workers[i].pass.tape = true;
    return true;
}

/* *taken: how many scenes the examples have. */
static bool run(Trainer *trainer, int *taken, Error *error) {
    const GnsTraining *training = trainer->training;
    Method method;
    trainer->examples.noise = training->noise;
    trainer->examples.seed = training->seed << 32;
    if (!make_net(trainer, error) || !draw_weights(trainer, error) || !method_parse(&method, teacher, error))
        return false;
    while (*taken < training->scene_count) {
        Scene *scene = training->scenes[(*taken)++];
        progress_next_stage(&trainer->stage, record_share / training->scene_count);
        if (!gns_examples_add(&trainer->examples, scene, &method, training->launches, &trainer->progress, error))
            return false;
    }
    trainer->held_out = trainer->examples;
    trainer->held_out.seed = ~trainer->examples.seed;
    progress_next_stage(&trainer->stage, 1 - record_share);
    if (!find_scales(&trainer->examples, training->radius, &trainer->net->scales, error) || !make_space(trainer, error))
        return false;
    use_weights(trainer);
    return take_steps(trainer, error);
}

bool gns_training_run(const GnsTraining *training, GnsNet *net, const Progress *progress, Error *error) {
    Trainer *trainer = calloc(1, sizeof *trainer);
    int taken = 0;
    bool ok = trainer != NULL || error_memory(error, "gns");
    *net = (GnsNet){.parameters = NULL};
    if (ok) {
        trainer->training = training;
        trainer->net = net;
        trainer->stage = (ProgressStage){.whole = progress};
        trainer->progress = (Progress){progress_stage, &trainer->stage};
        ok = run(trainer, &taken, error);
        gns_examples_free(&trainer->examples);
        for (int i = 0; trainer->workers != NULL && i < trainer->threads; i++) {
            gns_example_free(&trainer->workers[i].example);
            gns_pass_free(&trainer->workers[i].pass);
            gns_backward_free(&trainer->workers[i].back);
            free(trainer->workers[i].slopes);
        }
        free(trainer->workers);
        free(trainer->slopes);
        adam_free(&trainer->adam);
        free(trainer);
    }
    for (; taken < training->scene_count; taken++) scene_destroy(training->scenes[taken]);
    return ok;
}

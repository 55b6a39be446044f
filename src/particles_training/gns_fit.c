/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles_training/gns_fit.h"

#include "common/array.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Beyond this error, in units of the acceleration, the loss is linear (Huber), so that a hit does not outweigh all else. */
static const float knee = 1.0f;

void gns_fit_free(GnsFit *fit) {
    for (int i = 0; fit->workers != NULL && i < fit->threads; i++) {
        gns_example_free(&fit->workers[i].example);
        gns_pass_free(&fit->workers[i].pass);
        gns_backward_free(&fit->workers[i].back);
        free(fit->workers[i].slopes);
    }
    free(fit->workers);
    free(fit->transposed);
    free(fit->gradients);
    free(fit->losses);
    free(fit->mean_gradient);
    *fit = (GnsFit){.examples = NULL};
}

bool gns_fit_begin(GnsFit *fit, const GnsExamples *examples, GnsNet *net, int batch, Error *error) {
    const size_t count = (size_t)net->layout.parameters;
    *fit = (GnsFit){.examples = examples, .net = net, .batch = batch, .threads = omp_get_max_threads()};
    fit->workers = calloc((size_t)fit->threads, sizeof *fit->workers);
    fit->transposed = calloc(count, sizeof *fit->transposed);
    fit->gradients = calloc(count * (size_t)batch, sizeof *fit->gradients);
    fit->losses = calloc((size_t)batch, sizeof *fit->losses);
    fit->mean_gradient = calloc(count, sizeof *fit->mean_gradient);
    if (fit->workers == NULL || fit->transposed == NULL || fit->gradients == NULL || fit->losses == NULL ||
        fit->mean_gradient == NULL)
        return error_memory(error, "gns");
    for (int i = 0; i < fit->threads; i++) fit->workers[i].pass.tape = true;
    return true;
}

/* Particles that count. */
static int count_particles(const GnsExample *example) {
    int count = 0;
    for (int i = 0; i < example->particles.bodies; i++) count += example->counts[i] > 0 ? BOX_PARTICLES : 0;
    return count;
}

double gns_example_loss(GnsWorker *worker, const GnsScales *scales) {
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

bool gns_fit_loss(GnsFit *fit, const GnsExamples *examples, uint64_t first, double *loss, Error *error) {
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

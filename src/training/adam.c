/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adam: each parameter steps by its mean gradient, divided by the root of its mean squared gradient.

       m = b1 m + (1 - b1) g,   v = b2 v + (1 - b2) g^2,   p = p - rate * (m / c1) / (sqrt(v / c2) + epsilon)

   with bias corrections c1 = 1 - b1^t and c2 = 1 - b2^t. Source: Kingma and Ba, "Adam: A Method for Stochastic
   Optimization" (2015); the rate decays to 0 by half a cosine (Loshchilov and Hutter, "SGDR", 2017). Full batch, so the
   gradient has no noise. Converges slowly in narrow valleys of the loss; lm does not. */
#include "training/optimizer.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8; /* Kingma and Ba */
static const double first_rate = 0.05;

typedef struct Moments {
    double *gradient, *mean, *square; /* [parameters], one block */
} Moments;

static void step(const Trainer *trainer, const Moments *moments, double *parameters) {
    double t = trainer->iteration + 1;
    double rate = first_rate * (1 + cos(pi * trainer->iteration / trainer->options->iterations)) / 2;
    double correction1 = 1 - pow(beta1, t), correction2 = 1 - pow(beta2, t);
    for (int p = 0; p < trainer->parameters; p++) {
        double g = moments->gradient[p];
        moments->mean[p] = beta1 * moments->mean[p] + (1 - beta1) * g;
        moments->square[p] = beta2 * moments->square[p] + (1 - beta2) * g * g;
        parameters[p] -= rate * (moments->mean[p] / correction1) / (sqrt(moments->square[p] / correction2) + epsilon);
    }
}

static bool minimize(Trainer *trainer, double *parameters, Error *error) {
    size_t count = (size_t)trainer->parameters;
    double *block = calloc(3 * count, sizeof *block);
    if (block == NULL) return error_memory(error, "training");
    Moments moments = {block, block + count, block + 2 * count};
    bool ok = true;
    while (ok && !trainer->finished) {
        double loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, parameters, moments.gradient);
        ok = trainer_visit(trainer, parameters, loss, error);
        if (ok && !trainer->finished) step(trainer, &moments, parameters);
    }
    free(block);
    return ok;
}

const Optimizer optimizer_adam = {"adam", "adaptive step per parameter, cosine decay (Kingma, Ba 2015)", minimize};

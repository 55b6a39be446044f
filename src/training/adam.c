/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adam (learning/adam.h) on full batches, so the gradient has no noise; the rate decays to 0 by half a cosine. Converges
   slowly in narrow valleys of the loss; lm does not. */
#include "learning/adam.h"
#include "training/optimizer.h"

#include <stdlib.h>

static const double first_rate = 0.05;

static bool minimize(Trainer *trainer, double *parameters, Error *error) {
    const size_t count = (size_t)trainer->parameters;
    double *block = calloc(3 * count, sizeof *block), *gradient = block;
    if (block == NULL) return error_memory(error, "training");
    Adam adam = adam_over(parameters, block + count, block + 2 * count, trainer->parameters, 0, ADAM_SQUARE_DECAY);
    bool ok = true;
    while (ok && !trainer->finished) {
        const double loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, parameters, gradient);
        ok = trainer_visit(trainer, parameters, loss, error);
        const double done = (double)trainer->iteration / trainer->options->iterations;
        if (ok && !trainer->finished) adam_step(&adam, gradient, first_rate * adam_cosine(done));
    }
    free(block);
    return ok;
}

const Optimizer optimizer_adam = {"adam", "adaptive step per parameter, cosine decay (Kingma, Ba 2015)", minimize};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Full-batch gradient descent with a fixed rate:

       p = p - rate * g

   Source: Cauchy, "Methode generale pour la resolution des systemes d'equations simultanees" (1847); the paper's
   gradient descent (3.3). The rate was chosen among 0.1, 0.2, 0.3, 0.5, 1 and 2 by 1000 steps on pairs of the training
   scenes, for eight networks of 10-10-2 and 10-8-8-6 with all activations and scalings. 0.5 beat the lower rates for
   six of the eight; at 1 one network with linear outputs rose to the loss of the constant predictor; at 2 three
   diverged. Much wider layers oscillate or diverge at 0.5 too. Converges slowly on ill-conditioned losses. */
#include "training/optimizer.h"

#include <stdlib.h>

static const double rate = 0.5;

static bool minimize(Trainer *trainer, double *parameters, Error *error) {
    double *gradient = calloc((size_t)trainer->parameters, sizeof *gradient);
    if (gradient == NULL) return error_memory(error, "training");
    bool ok = true;
    while (ok && !trainer->finished) {
        double loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, parameters, gradient);
        ok = trainer_visit(trainer, parameters, loss, error);
        for (int p = 0; p < trainer->parameters; p++) parameters[p] -= rate * gradient[p];
    }
    free(gradient);
    return ok;
}

const Optimizer optimizer_gd = {"gd", "gradient descent with a fixed rate", minimize};

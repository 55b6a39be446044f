/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "learning/adam.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double decay = 0.9, epsilon = 1e-8; /* Kingma and Ba */

bool adam_create(Adam *adam, int64_t count, double square_decay, Error *error) {
    double *numbers = calloc(3 * (size_t)count, sizeof *numbers);
    *adam = adam_over(numbers, numbers, numbers, count, 0, square_decay);
    if (numbers == NULL) return error_memory(error, "training");
    adam->mean += count;
    adam->square += 2 * count;
    return true;
}

void adam_free(Adam *adam) {
    free(adam->weights);
    *adam = (Adam){0};
}

/* Not pow(): its last bit depends on the maths library. */
Adam adam_over(double *weights, double *mean, double *square, int64_t count, int64_t steps, double square_decay) {
    Adam adam = {count, weights, mean, square, steps, square_decay, 1, 1};
    for (int64_t i = 0; i < steps; i++) adam.mean_left *= decay, adam.square_left *= square_decay;
    return adam;
}

void adam_restart(Adam *adam) {
    memset(adam->mean, 0, (size_t)adam->count * sizeof *adam->mean);
    memset(adam->square, 0, (size_t)adam->count * sizeof *adam->square);
    *adam = adam_over(adam->weights, adam->mean, adam->square, adam->count, 0, adam->square_decay);
}

void adam_step(Adam *adam, const double *slopes, double rate) {
    adam->steps++;
    adam->mean_left *= decay;
    adam->square_left *= adam->square_decay;
    const double over_mean = 1 / (1 - adam->mean_left), over_square = 1 / (1 - adam->square_left),
                 square_decay = adam->square_decay;
    for (int64_t i = 0; i < adam->count; i++) {
        adam->mean[i] = decay * adam->mean[i] + (1 - decay) * slopes[i];
        adam->square[i] = square_decay * adam->square[i] + (1 - square_decay) * slopes[i] * slopes[i];
        adam->weights[i] -= rate * adam->mean[i] * over_mean / (sqrt(adam->square[i] * over_square) + epsilon);
    }
}

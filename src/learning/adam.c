/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "learning/adam.h"

#include <stdlib.h>
#include <string.h>

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
    for (int64_t i = 0; i < steps; i++) adam.mean_left *= ADAM_DECAY, adam.square_left *= square_decay;
    return adam;
}

void adam_restart(Adam *adam) {
    memset(adam->mean, 0, (size_t)adam->count * sizeof *adam->mean);
    memset(adam->square, 0, (size_t)adam->count * sizeof *adam->square);
    *adam = adam_over(adam->weights, adam->mean, adam->square, adam->count, 0, adam->square_decay);
}

AdamStep adam_next(Adam *adam, double rate) {
    adam->steps++;
    adam->mean_left *= ADAM_DECAY;
    adam->square_left *= adam->square_decay;
    return (AdamStep){rate, 1 / (1 - adam->mean_left), 1 / (1 - adam->square_left), adam->square_decay};
}

double adam_cosine(double done) {
    const double pi = 3.14159265358979323846;
    return (1 + (double)(float)cos(pi * done)) / 2;
}

void adam_step(Adam *adam, const double *slopes, double rate) {
    const AdamStep step = adam_next(adam, rate);
    for (int64_t i = 0; i < adam->count; i++)
        adam->weights[i] -= adam_change(&step, slopes[i], &adam->mean[i], &adam->square[i]);
}

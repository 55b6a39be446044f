/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps of Adam, and their rate. */
#include "base/base.h"
#include "learning/learning.h"

#include <stdlib.h>
#include <string.h>

Adam adam_over(double *weights, double *mean, double *square, int64_t count) {
    return (Adam){count, weights, mean, square, 0, 1, 1};
}

bool adam_create(Adam *adam, int64_t count, Error *error) {
    double *numbers = calloc(3 * (size_t)count, sizeof *numbers);
    if (numbers == NULL) return *adam = (Adam){0}, error_memory(error, "training");
    *adam = adam_over(numbers, numbers + count, numbers + 2 * count, count);
    return true;
}

void adam_free(Adam *adam) {
    free(adam->weights);
    *adam = (Adam){0};
}

void adam_restart(Adam *adam) {
    memset(adam->mean, 0, (size_t)adam->count * sizeof *adam->mean);
    memset(adam->square, 0, (size_t)adam->count * sizeof *adam->square);
    *adam = adam_over(adam->weights, adam->mean, adam->square, adam->count);
}

AdamStep adam_next(Adam *adam, double rate) {
    adam->steps++;
    adam->mean_left *= ADAM_DECAY; /* not pow(): its last bit depends on the maths library */
    adam->square_left *= ADAM_SQUARE_DECAY;
    return (AdamStep){rate, 1 / (1 - adam->mean_left), 1 / (1 - adam->square_left)};
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

bool slopes_limit(double *slopes, int64_t count, double most) {
    double sum = 0;
    for (int64_t i = 0; i < count; i++) sum += slopes[i] * slopes[i];
    const double length = sqrt(sum), by = length > most ? most / length : 1;
    const bool finite = isfinite(length);
    for (int64_t i = 0; i < count; i++) slopes[i] = finite ? slopes[i] * by : 0;
    return finite;
}

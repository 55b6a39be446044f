/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "learning/learning.h"

#include <math.h>
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

#define KIND "training"

enum { VERSION = 1, PLACES = 3, ROWS = 3 };

/* Weights, means and squares; one list for writing and reading. */
static void list(const Adam *adam, NpzArray arrays[ROWS]) {
    const NpzArray all[ROWS] = {{"weights", NPZ_FLOAT64, 1, {adam->count}, adam->weights},
                                {"mean", NPZ_FLOAT64, 1, {adam->count}, adam->mean},
                                {"square", NPZ_FLOAT64, 1, {adam->count}, adam->square}};
    memcpy(arrays, all, sizeof all);
}

bool fit_state_write(const FitState *state, const char *path, Error *error) {
    const int32_t version = VERSION;
    const int64_t places[PLACES] = {state->stage, state->epoch, state->adam.steps};
    NpzArray arrays[4 + ROWS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                 {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                 {.name = "command", .type = NPZ_TEXT, .data = state->command},
                                 {.name = "at", .type = NPZ_INT64, .rank = 1, .shape = {PLACES}, .data = places}};
    list(&state->adam, arrays + 4);
    return npz_write(path, arrays, 4 + ROWS, error);
}

static bool read_places(NpzFile *file, int64_t places[PLACES], Error *error) {
    const int64_t shape = PLACES;
    int64_t *at = npz_read(file, "at", NPZ_INT64, 1, &shape, error);
    if (at == NULL) return false;
    bool ok = true;
    for (int i = 0; ok && i < PLACES; i++)
        ok = (at[i] >= 0 && at[i] <= INT32_MAX) ||
             error_input(error, npz_path(file), "at: number %d, %lld, is not possible", i, (long long)at[i]);
    memcpy(places, at, PLACES * sizeof *places);
    free(at);
    return ok;
}

static double *read_numbers(NpzFile *file, const NpzArray *array, Error *error) {
    double *numbers = npz_read(file, array->name, array->type, array->rank, array->shape, error);
    for (int64_t i = 0; numbers != NULL && i < array->shape[0]; i++)
        if (!isfinite(numbers[i])) {
            error_input(error, npz_path(file), "%s: number %lld is NaN or infinite", array->name, (long long)i);
            free(numbers);
            return NULL;
        }
    return numbers;
}

static bool read_all(NpzFile *file, FitState *state, Error *error) {
    NpzArray arrays[ROWS];
    double *read[ROWS] = {NULL}, *const to[ROWS] = {state->adam.weights, state->adam.mean, state->adam.square};
    int64_t places[PLACES];
    list(&state->adam, arrays);
    bool ok = npz_expect(file, arrays, ROWS, error) && read_places(file, places, error);
    for (int i = 0; ok && i < ROWS; i++) ok = (read[i] = read_numbers(file, &arrays[i], error)) != NULL;
    for (int i = 0; i < ROWS; i++) {
        if (ok) memcpy(to[i], read[i], (size_t)state->adam.count * sizeof *to[i]);
        free(read[i]);
    }
    if (!ok) return false;
    state->stage = (int32_t)places[0];
    state->epoch = (int32_t)places[1];
    state->adam = adam_over(to[0], to[1], to[2], state->adam.count, places[2], state->adam.square_decay);
    return true;
}

bool fit_state_read(FitState *state, const char *path, bool *found, Error *error) {
    char command[FIT_COMMAND_SIZE];
    if (!file_find(path, found, error)) return false;
    if (!*found) return true;
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    bool ok =
        npz_check_kind(file, KIND, VERSION, error) && npz_read_text(file, "command", command, sizeof command, error);
    *found = ok && strcmp(command, state->command) == 0;
    if (*found) ok = read_all(file, state, error);
    npz_close(file);
    return ok;
}

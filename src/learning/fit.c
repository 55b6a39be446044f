/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adam, and the course of a training that keeps its state on disk. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "learning/learning.h"
#include "nets/nets.h"

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

bool slopes_limit(double *slopes, int64_t count, double most) {
    double sum = 0;
    for (int64_t i = 0; i < count; i++) sum += slopes[i] * slopes[i];
    const double length = sqrt(sum), by = length > most ? most / length : 1;
    const bool finite = isfinite(length);
    for (int64_t i = 0; i < count; i++) slopes[i] = finite ? slopes[i] * by : 0;
    return finite;
}

/* Files of states: kind "training"; at: stage, epoch, steps. */

enum { PLACES = 3 };

typedef struct FitFile {
    Fit *fit;
    int64_t at[PLACES];
} FitFile;

static int list_fields(void *of, NetField *fields) {
    FitFile *file = of;
    const Adam *adam = &file->fit->adam;
    const NetField all[] = {
        {"command", NPZ_TEXT, 0, {FIT_COMMAND_SIZE}, .data = (char *)file->fit->command, .known = true},
        {"at", NPZ_INT64, 1, {PLACES}, .data = file->at},
        {"weights", NPZ_FLOAT64, 1, {adam->count}, .data = adam->weights},
        {"mean", NPZ_FLOAT64, 1, {adam->count}, .data = adam->mean},
        {"square", NPZ_FLOAT64, 1, {adam->count}, .data = adam->square}};
    memcpy(fields, all, sizeof all);
    return sizeof all / sizeof *all;
}

static const NetFileKind kind = {"training", 1, list_fields, NULL, NULL, NULL};

bool fit_write(const Fit *fit, Error *error) {
    const FitFile file = {(Fit *)fit, {fit->stage, fit->epoch, fit->adam.steps}};
    return net_file_write(&kind, &file, fit->path, error);
}

/* The numbers of a state of the same command. */
static bool read_numbers(Fit *fit, NpzFile *npz, Error *error) {
    FitFile file = {.fit = fit};
    NetField fields[NET_FIELDS_MAX];
    Adam *adam = &fit->adam;
    if (!net_fields_read(npz, fields, list_fields(&file, fields), error)) return false;
    for (int i = 0; i < PLACES; i++)
        if (file.at[i] < 0 || file.at[i] > INT32_MAX)
            return error_input(error, fit->path, "at: number %d, %lld, is not possible", i, (long long)file.at[i]);
    fit->stage = (int32_t)file.at[0];
    fit->epoch = (int32_t)file.at[1];
    *adam = adam_over(adam->weights, adam->mean, adam->square, adam->count, file.at[2], adam->square_decay);
    return true;
}

void fit_init(Fit *fit, const char *command, const char *path, const Progress *progress) {
    *fit = (Fit){.command = command, .path = path, .share = {.whole = progress}};
    fit->progress = (Progress){progress_stage, &fit->share};
}

bool fit_begin(Fit *fit, int64_t weights, bool *found, Error *error) {
    char command[FIT_COMMAND_SIZE];
    if (!adam_create(&fit->adam, weights, ADAM_SQUARE_DECAY, error) || !file_find(fit->path, found, error))
        return false;
    if (!*found) return true;
    NpzFile *npz = npz_open(fit->path, error);
    if (npz == NULL) return false;
    bool ok = npz_check_kind(npz, kind.name, kind.version, error) &&
              npz_read_text(npz, "command", command, sizeof command, error);
    *found = ok && strcmp(command, fit->command) == 0;
    if (*found) ok = read_numbers(fit, npz, error);
    npz_close(npz);
    return ok;
}

void fit_free(Fit *fit) { adam_free(&fit->adam); }

void fit_stage(Fit *fit, int stage) {
    fit->stage = stage;
    fit->epoch = 0;
    adam_restart(&fit->adam);
}

bool fit_run(Fit *fit, int64_t at, int64_t count, const FitSteps *steps, double *loss, Error *error) {
    const Adam *all = &fit->adam;
    Adam adam = adam_over(all->weights + at, all->mean + at, all->square + at, count, all->steps, all->square_decay);
    for (*loss = 0; adam.steps < steps->count;) {
        const int64_t begun = adam.steps;
        if (!progress_report(&fit->progress, (double)begun, (double)steps->count))
            return error_interrupted(error, fit->path, "stopped; the same command continues");
        *loss = 0;
        do
            if (!steps->step(steps->context, &adam, loss, error)) return false;
        while (adam.steps < steps->count && adam.steps % steps->written != 0);
        fit->epoch++;
        fit->adam.steps = adam.steps;
        if (!fit_write(fit, error) ||
            (steps->on_written != NULL && !steps->on_written(steps->context, *loss, adam.steps - begun, error)))
            return false;
    }
    return true;
}

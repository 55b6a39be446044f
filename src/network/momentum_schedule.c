/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/momentum_schedule.h"

#include "network/file_floats.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define KIND "momentum-schedules"

void momentum_schedules_free(MomentumSchedules *schedules) {
    for (int i = 0; i < schedules->count; i++) free(schedules->factors[i]);
    *schedules = (MomentumSchedules){0};
}

const float *momentum_schedules_find(const MomentumSchedules *schedules, int sweeps) {
    for (int i = 0; i < schedules->count; i++)
        if (schedules->sweeps[i] == sweeps) return schedules->factors[i];
    return NULL;
}

bool momentum_schedules_add(MomentumSchedules *schedules, int sweeps, const float *factors, Error *error) {
    size_t size = (size_t)sweeps * sizeof *factors;
    float *copy = malloc(size);
    if (copy == NULL) return error_memory(error, "momentum schedules");
    memcpy(copy, factors, size);
    schedules->sweeps[schedules->count] = sweeps;
    schedules->factors[schedules->count++] = copy;
    return true;
}

bool momentum_schedules_write(const MomentumSchedules *schedules, const char *path, Error *error) {
    const int32_t version = MOMENTUM_VERSION;
    int32_t sweeps[MOMENTUM_MAX_SCHEDULES];
    float *factors = malloc((size_t)MOMENTUM_MAX_SCHEDULES * MOMENTUM_MAX_SWEEPS * sizeof *factors);
    if (factors == NULL) return error_memory(error, path);
    int64_t total = 0;
    for (int i = 0; i < schedules->count; i++) {
        sweeps[i] = schedules->sweeps[i];
        memcpy(factors + total, schedules->factors[i], (size_t)sweeps[i] * sizeof *factors);
        total += sweeps[i];
    }
    const NpzArray arrays[] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = KIND},
        {.name = "command", .type = NPZ_TEXT, .data = schedules->command},
        {.name = "sweeps", .type = NPZ_INT32, .rank = 1, .shape = {schedules->count}, .data = sweeps},
        {.name = "factors", .type = NPZ_FLOAT32, .rank = 1, .shape = {total}, .data = factors},
    };
    bool ok = npz_write(path, arrays, sizeof arrays / sizeof arrays[0], error);
    free(factors);
    return ok;
}

/* Checks the numbers of sweeps; their sum in *total. */
static int32_t *read_sweeps(NpzFile *file, const char *path, int64_t *count, int64_t *total, Error *error) {
    if (!npz_shape(file, "sweeps", NPZ_INT32, 1, count, error)) return NULL;
    if (*count < 1 || *count > MOMENTUM_MAX_SCHEDULES) {
        error_input(error, path, "has %lld schedules; expected 1 to %d", (long long)*count, MOMENTUM_MAX_SCHEDULES);
        return NULL;
    }
    int32_t *sweeps = npz_read(file, "sweeps", NPZ_INT32, 1, count, error);
    *total = 0;
    for (int i = 0; sweeps != NULL && i < *count; i++) {
        int least = i > 0 ? sweeps[i - 1] + 1 : 1;
        if (sweeps[i] < least || sweeps[i] > MOMENTUM_MAX_SWEEPS) {
            error_input(error, path, "sweeps[%d] is %d; %d to %d is possible, rising", i, (int)sweeps[i], least,
                        MOMENTUM_MAX_SWEEPS);
            free(sweeps);
            return NULL;
        }
        *total += sweeps[i];
    }
    return sweeps;
}

static bool read_schedules(MomentumSchedules *schedules, NpzFile *file, const char *path, Error *error) {
    int64_t count, total;
    if (!npz_check_kind(file, KIND, MOMENTUM_VERSION, error) ||
        !npz_read_text(file, "command", schedules->command, sizeof schedules->command, error))
        return false;
    int32_t *sweeps = read_sweeps(file, path, &count, &total, error);
    if (sweeps == NULL) return false;
    float *factors = malloc((size_t)total * sizeof *factors);
    bool ok = factors != NULL || error_memory(error, path);
    const FileFloats stored = {"factors", 1, {total}, factors, &float_momentum};
    ok = ok && file_floats_read(file, &stored, 1, error);
    const float *next = factors;
    for (int i = 0; ok && i < count; i++) {
        ok = momentum_schedules_add(schedules, sweeps[i], next, error);
        next += sweeps[i];
    }
    free(sweeps);
    free(factors);
    return ok;
}

bool momentum_schedules_read(MomentumSchedules *schedules, const char *path, Error *error) {
    *schedules = (MomentumSchedules){0};
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    bool ok = read_schedules(schedules, file, path, error);
    npz_close(file);
    if (!ok) momentum_schedules_free(schedules);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/net_state.h"

#include "common/file.h"
#include "npz/npz.h"

#include <math.h>
#include <stdlib.h>

#define KIND "interior-net-training"

enum { VERSION = 1, ARRAYS = 4 };

/* One list for writing and reading. */
static void list(NetState *state, NpzArray arrays[ARRAYS]) {
    const NpzArray all[ARRAYS] = {{"weights", NPZ_FLOAT64, 1, {INTERIOR_NET_WEIGHTS}, state->weights},
                                  {"mean", NPZ_FLOAT64, 1, {INTERIOR_NET_WEIGHTS}, state->mean},
                                  {"square", NPZ_FLOAT64, 1, {INTERIOR_NET_WEIGHTS}, state->square},
                                  {"drivers", NPZ_FLOAT64, 2, {NET_ROUNDS_MAX, INTERIOR_NET_WEIGHTS}, state->drivers}};
    memcpy(arrays, all, sizeof all);
}

bool net_state_write(const NetState *state, const char *path, Error *error) {
    const int32_t version = VERSION, at[3] = {state->round, state->epoch, state->steps};
    NetState copy = *state;
    NpzArray arrays[4 + ARRAYS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                   {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                   {.name = "command", .type = NPZ_TEXT, .data = state->command},
                                   {.name = "at", .type = NPZ_INT32, .rank = 1, .shape = {3}, .data = at}};
    list(&copy, arrays + 4);
    return npz_write(path, arrays, 4 + ARRAYS, error);
}

static bool read_numbers(NpzFile *file, const NpzArray *array, double *numbers, Error *error) {
    size_t count = 1;
    for (int i = 0; i < array->rank; i++) count *= (size_t)array->shape[i];
    double *read = npz_read(file, array->name, array->type, array->rank, array->shape, error);
    if (read == NULL) return false;
    bool ok = true;
    for (size_t i = 0; ok && i < count; i++)
        ok = isfinite(read[i]) ||
             error_input(error, npz_path(file), "%s: number %zu is NaN or infinite", array->name, i);
    if (ok) memcpy(numbers, read, count * sizeof *numbers);
    free(read);
    return ok;
}

static bool read_place(NpzFile *file, NetState *state, Error *error) {
    const int64_t shape = 3;
    int32_t *at = npz_read(file, "at", NPZ_INT32, 1, &shape, error);
    if (at == NULL) return false;
    const bool ok = (at[0] >= 0 && at[0] < NET_ROUNDS_MAX && at[1] >= 0 && at[2] >= 0) ||
                    error_input(error, npz_path(file), "at: round %d, epoch %d, step %d is not possible", (int)at[0],
                                (int)at[1], (int)at[2]);
    state->round = at[0];
    state->epoch = at[1];
    state->steps = at[2];
    free(at);
    return ok;
}

static bool read_all(NpzFile *file, NetState *state, Error *error) {
    NpzArray arrays[ARRAYS];
    double *const numbers[ARRAYS] = {state->weights, state->mean, state->square, state->drivers[0]};
    list(state, arrays);
    if (!npz_expect(file, arrays, ARRAYS, error) || !read_place(file, state, error)) return false;
    for (int i = 0; i < ARRAYS; i++)
        if (!read_numbers(file, &arrays[i], numbers[i], error)) return false;
    return true;
}

bool net_state_read(NetState *state, const char *path, const char *command, Error *error) {
    bool there;
    if (!file_find(path, &there, error) || !there) return false;
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    bool ok = npz_check_kind(file, KIND, VERSION, error) &&
              npz_read_text(file, "command", state->command, sizeof state->command, error) &&
              strcmp(state->command, command) == 0 && read_all(file, state, error);
    npz_close(file);
    return ok;
}

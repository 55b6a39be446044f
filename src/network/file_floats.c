/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/file_floats.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

const FloatRange float_any = {-FLT_MAX, FLT_MAX, "finite"};
const FloatRange float_positive = {FLT_TRUE_MIN, FLT_MAX, "finite and greater than 0"};
const FloatRange float_not_negative = {0, FLT_MAX, "finite and not negative"};
const FloatRange float_momentum = {0, 2, "from 0 to 2"};

NpzArray file_floats_array(const FileFloats *floats) {
    return (NpzArray){floats->name, NPZ_FLOAT32, floats->rank, {floats->shape[0], floats->shape[1]}, floats->numbers};
}

static bool read(NpzFile *file, const FileFloats *floats, Error *error) {
    float *numbers = npz_read(file, floats->name, NPZ_FLOAT32, floats->rank, floats->shape, error);
    if (numbers == NULL) return false;
    size_t size = 1, i = 0;
    for (int r = 0; r < floats->rank; r++) size *= (size_t)floats->shape[r];
    while (i < size && numbers[i] >= floats->range->least && numbers[i] <= floats->range->most) i++;
    if (i == size)
        memcpy(floats->numbers, numbers, size * sizeof *numbers);
    else
        error_input(error, npz_path(file), "%s: number %zu is %g; it must be %s", floats->name, i, (double)numbers[i],
                    floats->range->words);
    free(numbers);
    return i == size;
}

bool file_floats_expect(const NpzFile *file, const FileFloats *list, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        const NpzArray array = file_floats_array(&list[i]);
        if (!npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

bool file_floats_read(NpzFile *file, const FileFloats *list, int count, Error *error) {
    if (!file_floats_expect(file, list, count, error)) return false;
    for (int i = 0; i < count; i++)
        if (!read(file, &list[i], error)) return false;
    return true;
}

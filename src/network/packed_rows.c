/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/packed_rows.h"

#include <math.h>
#include <stdlib.h>

enum { STEPS = INT8_MAX };

static const float nothing =
    1e-30f; /* a row with no larger number becomes 0, because the reciprocal of its unit is infinite */

bool packed_rows_make(PackedRows *packed, int count, int width) {
    *packed =
        (PackedRows){count, width, calloc((size_t)count * (size_t)width, 1), calloc((size_t)count, sizeof(float))};
    return packed->numbers != NULL && packed->units != NULL;
}

void packed_rows_free(PackedRows *packed) {
    free(packed->numbers);
    free(packed->units);
    *packed = (PackedRows){0};
}

static float largest(const float *row, int width) {
    float most = 0;
    for (int i = 0; i < width; i++) most = fabsf(row[i]) > most ? fabsf(row[i]) : most;
    return most;
}

static int8_t nearest(float number) { return (int8_t)(number + (number < 0 ? -0.5f : 0.5f)); }

void packed_rows_fill(PackedRows *packed, const float *rows) {
    for (int64_t i = 0; i < packed->count; i++) {
        const float *row = rows + i * packed->width;
        int8_t *numbers = packed->numbers + i * packed->width;
        const float most = largest(row, packed->width), steps = most > nothing ? STEPS / most : 0;
        packed->units[i] = most > nothing ? most / STEPS : 0;
        for (int k = 0; k < packed->width; k++) numbers[k] = nearest(row[k] * steps);
    }
}

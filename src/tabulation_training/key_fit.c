/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulation_training/key_fit.h"

#include "impact_training/principal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* principal_fit() gives each component the variance 1; in a key all have the same unit, m/s. */
static void take_directions(Tabulation *memory, const Projection *projection) {
    for (int c = 0; c < memory->components; c++) {
        double squares = 0;
        for (int i = 0; i < memory->numbers; i++) {
            const double row = (double)projection->rows[i * projection->to + c];
            squares += row * row;
        }
        const double factor = squares > 0 ? 1 / sqrt(squares) : 0;
        for (int i = 0; i < memory->numbers; i++)
            memory->rows[i * memory->components + c] =
                (float)(factor * (double)projection->rows[i * projection->to + c]);
    }
}

static void take_mean(Tabulation *memory, const float *others, int count) {
    for (int i = 0; i < memory->numbers; i++) {
        double sum = 0;
        for (int s = 0; s < count; s++) sum += (double)others[(size_t)s * (size_t)memory->numbers + (size_t)i];
        memory->centre[i] = (float)(sum / count);
    }
}

bool key_fit(Tabulation *memory, const float *others, int count, uint64_t seed, Error *error) {
    const size_t width = (size_t)memory->numbers, numbers = (size_t)count * width;
    const int to = (memory->components + ROW_LANES - 1) / ROW_LANES * ROW_LANES;
    Projection projection = {.from = memory->numbers,
                             .to = to,
                             .rows = calloc(width * (size_t)to, sizeof(float)),
                             .centre = calloc((size_t)to, sizeof(float))};
    int64_t *begin = malloc(((size_t)count + 1) * sizeof *begin);
    int32_t *column = malloc(numbers * sizeof *column);
    bool ok = (projection.rows != NULL && projection.centre != NULL && begin != NULL && column != NULL) ||
              error_memory(error, "hybrid");
    for (int s = 0; ok && s <= count; s++) begin[s] = (int64_t)s * memory->numbers;
    for (size_t i = 0; ok && i < numbers; i++) column[i] = (int32_t)(i % width);
    const SparseRows rows = {count, memory->numbers, begin, column, others};
    ok = ok && principal_fit(&rows, seed, &projection, error);
    if (ok) {
        take_mean(memory, others, count);
        take_directions(memory, &projection);
    }
    free(begin);
    free(column);
    free(projection.rows);
    free(projection.centre);
    return ok;
}

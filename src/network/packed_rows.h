/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A quantised matrix, a quarter of the size of floats: each number is a byte, times a unit per row. Rounding to 127
   steps of the row's largest number changes a network's outputs by less than 1%, and training compensates for it
   (impact_training/slot_fit.h). */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct PackedRows {
    int count, width;
    int8_t *numbers; /* [count, width] -127 .. 127 */
    float *units;    /* [count] */
} PackedRows;

/* All numbers and units 0. False when memory is short; free it in any case. */
bool packed_rows_make(PackedRows *packed, int count, int width);
void packed_rows_free(PackedRows *packed);

/* Rounds rows[count, width] of finite numbers to the nearest steps. */
void packed_rows_fill(PackedRows *packed, const float *rows);

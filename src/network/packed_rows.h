/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A matrix in a quarter of a float's room: each number a byte, times a unit of its row. Rounding a row to 127 steps of
   its largest number moves what a network says by less than 1%, which training sees (impact_training/slot_fit.h) and makes up
   for. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct PackedRows {
    int count, width;
    int8_t *numbers; /* [count, width] -127 .. 127 */
    float *units;    /* [count] */
} PackedRows;

/* All numbers and units 0. False when memory is short; what there is must be freed all the same. */
bool packed_rows_make(PackedRows *packed, int count, int width);
void packed_rows_free(PackedRows *packed);

/* Rounds rows[count, width] of finite numbers to the nearest steps. */
void packed_rows_fill(PackedRows *packed, const float *rows);

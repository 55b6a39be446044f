/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The float32 arrays of a network's file: one list for writing and reading. */
#pragma once
#include "npz/npz.h"

/* The range of the numbers, which must be finite. */
typedef struct FloatRange {
    float least, most;
    const char *words; /* "must be ..." */
} FloatRange;

extern const FloatRange float_any, float_positive, float_not_negative, float_momentum;

typedef struct FileFloats {
    char name[24];
    int rank;
    int64_t shape[2];
    float *numbers; /* the network's array, at least of the shape's size */
    const FloatRange *range;
} FileFloats;

NpzArray file_floats_array(const FileFloats *floats);

/* Whether the file has the arrays in these shapes; for a network too large for its file, before memory is taken for it. */
bool file_floats_expect(const NpzFile *file, const FileFloats *list, int count, Error *error);

/* Reads the arrays, after a look at all their shapes; an error names the file, the array and the number. */
bool file_floats_read(NpzFile *file, const FileFloats *list, int count, Error *error);

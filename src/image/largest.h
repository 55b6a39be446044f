/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest of many values that come one after another, for an exact percentile in little memory. */
#pragma once
#include "common/error.h"

#include <stddef.h>

typedef struct Largest {
    size_t keep;  /* how many of the largest values matter */
    size_t count; /* of `values`; at most 2 * keep */
    float least;  /* values that are not larger need not be kept */
    float *values;
} Largest;

bool largest_create(Largest *largest, size_t keep, Error *error);
void largest_free(Largest *largest);

/* Adds a value from 0. */
void largest_add(Largest *largest, float value);

/* The least of the `keep` largest values; 0 if fewer were added. */
float largest_least(Largest *largest);

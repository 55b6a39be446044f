/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts as stored in files: one array per quantity. Only trajectory_read.c and trajectory_write.c include this. */
#pragma once
#include "trajectory/trajectory.h"

typedef struct ContactArrays {
    int32_t (*bodies)[2]; /* a, b */
    uint32_t *feature;
    Vec2 *point, *normal;
    float (*impulse)[2]; /* normal, tangent */
} ContactArrays;

void contact_arrays_free(ContactArrays *arrays);

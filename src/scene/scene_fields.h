/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The types of values in scene files; yaml/fields.h reads the mappings. */
#pragma once
#include "yaml/fields.h"

/* The ranges keep a scene within what float32 can compute: no product of them is infinite, and no inverse. */
extern const Range range_size, range_mass, range_position, range_angle, range_speed, range_spin, range_friction,
    range_gravity, range_dt, range_rate;

/* float; float32 nearest to the decimal, a fraction such as 1/60, or a chain (chain.h). */
FieldParser field_number;
/* Vec2: a list of two numbers. */
FieldParser field_vector;
/* int; digits, or a chain whose value is whole. */
FieldParser field_int;

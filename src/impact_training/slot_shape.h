/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The slot network that fits a scene: its slots, what it sees, and the units of what it says, from samples. */
#pragma once
#include "impact_training/slot_samples.h"

#include <stdint.h>

typedef struct SlotWidths {
    int state, present, warm; /* components of what it sees */
    int hidden;
} SlotWidths;

/* A network with random weights for labelled samples, and their views of it. Slots are the contacts of at least 3
   samples. NULL with error set: no samples, memory, or shapes out of bounds (slot_network_create). */
SlotNetwork *slot_network_for(SlotSamples *samples, const SlotWidths *widths, uint64_t seed, Error *error);

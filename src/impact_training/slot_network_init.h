/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Initialises a slot network from samples of a scene: slots, input projections, output scales, random weights. */
#pragma once
#include "impact_training/slot_samples.h"

#include <stdint.h>

typedef struct SlotWidths {
    int state, present, warm; /* number of input components of each projection */
    int hidden;
} SlotWidths;

/* Makes an untrained network for labelled samples and computes their inputs. Slots are the contacts that occur in at
   least 3 samples. NULL with error set: no samples, memory, or a shape out of bounds (slot_network_create). */
SlotNetwork *slot_network_from_samples(SlotSamples *samples, const SlotWidths *widths, uint64_t seed, Error *error);

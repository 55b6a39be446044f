/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts between boxes in given poses, as the engine's collision detection finds them: for runs that do not state
   theirs. Zero-initialise; free with contact_finder_free(). */
#pragma once
#include "base/base.h"
#include "engine/contact_set.h"

typedef struct ContactFinder {
    SortAndSweep broad_phase;
    PairList pairs;
    Box *boxes;
    Bounds *bounds;
    bool *fixed;
    size_t box_capacity, bound_capacity, fixed_capacity;
    ContactRules rules; /* set by the caller; {0}: Box2D-Lite's contacts */
    ContactSet set;     /* positions, normals, separations and feature ids of the last search */
} ContactFinder;

void contact_finder_free(ContactFinder *finder);

/* Makes room in bounds and fixed, from which contact_finder_pairs() finds the pairs whose bounds overlap. ERROR_INPUT:
   too many. */
bool contact_finder_reserve(ContactFinder *finder, int count, Error *error);
bool contact_finder_pairs(ContactFinder *finder, int count, Error *error);

/* Boxes that are apart by less than 2 `skin` (m) touch, too: separation > 0. ERROR_INPUT: too many pairs. */
bool contact_finder_find(ContactFinder *finder, const Body *bodies, int count, float skin, Error *error);

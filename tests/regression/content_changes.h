/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What content_name() says of two pictures. */
#pragma once
#include "testing.h"

#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"
#include "regression/regression_internal.h"

#include <string.h>

/* Destroys both, which differ. */
static inline FrameChanges changes_of(Image *a, Image *b) {
    FrameChanges changes = {.count = 0};
    ImageDifference difference;
    Error error = {0};
    memset(changes.region_change, -1, sizeof changes.region_change);
    image_compare(a, b, &difference);
    assert_true(difference.pixels > 0);
    assert_ok(image_regions_find(a, b, NULL, &difference, &changes.regions, &error), error);
    assert_ok(content_name(a, b, NULL, &difference, &changes, &error), error);
    image_destroy(a);
    image_destroy(b);
    return changes;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two pictures differ: clusters of differing pixels. Two differing pixels belong to one region if a chain of
   differing pixels links them whose steps are at most the gap, in x and in y. So a moved box is one or two regions, and
   so is a caption. Time is linear in the pixels and memory in the width, whatever the pictures show. */
#pragma once
#include "image/image_compare.h"

enum { IMAGE_REGIONS_MAX = 16 };

typedef struct ImageRegion {
    int64_t pixels;               /* differing */
    int left, top, right, bottom; /* bounds; right and bottom are exclusive */
} ImageRegion;

typedef struct ImageRegions {
    int64_t count; /* of all regions */
    int kept;
    ImageRegion list[IMAGE_REGIONS_MAX]; /* [kept], the largest: most pixels first, then by top, then by left */
} ImageRegions;

/* The gap in pixels for pictures of this size: the space between two words of a caption, or more. */
int image_regions_gap(int width, int height);

/* `difference` is what image_compare_masked() found in the same pictures and mask. False with error set if out of memory. */
bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error);

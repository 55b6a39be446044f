/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison in the measure of odiff and pixelmatch, for clients that were written for odiff: a pixel differs if its
   colour does by more than a threshold in YIQ, on white where it is transparent. Kotsarenko, Ramos, "Measuring
   perceived color difference using YIQ NTSC transmission color space in mobile applications" (2010). */
#pragma once
#include "base/base.h"
#include "pixels/png.h"

#include <stdint.h>

/* Pixels that are not compared; x2 and y2 are inside. */
typedef struct OdiffRegion {
    int64_t x1, y1, x2, y2;
} OdiffRegion;

typedef struct OdiffOptions {
    double threshold; /* 0 to 1 */
    bool antialias; /* ignore edges that moved by a part of a pixel, as compare --antialias; in pictures of one size */
    int region_count;
    const OdiffRegion *regions; /* [region_count] */
} OdiffOptions;

/* Where two pictures differ. Where only one has a pixel, that differs unless it is transparent. */
typedef struct OdiffDifference {
    int width, height; /* of the larger picture, by side */
    int64_t count;     /* pixels that differ */
    uint8_t *pixels;   /* [height, width]: ODIFF_DIFFERS, or what is ignored (regression/compare.h) */
    bool *rows;        /* [height]: has pixels that differ */
    bool *columns;     /* [width] */
} OdiffDifference;

enum { ODIFF_DIFFERS = 3 };

/* ERROR_INPUT, of `name`, if the sizes are too different. odiff_difference_free() also after a failure.
   8 bits of a channel are compared; with threshold 0, all 16 are. */
bool odiff_compare(const Image *base, const Image *compared, const OdiffOptions *options, const char *name,
                   OdiffDifference *difference, Error *error);
void odiff_difference_free(OdiffDifference *difference);

typedef enum OdiffGround {
    ODIFF_ON_PICTURE, /* the base picture, on white where it is transparent */
    ODIFF_ON_PALE,    /* the same, grey and with a share of white */
    ODIFF_ON_NOTHING  /* transparent */
} OdiffGround;

typedef struct OdiffPicture {
    OdiffGround ground;
    double white; /* 0 to 1 */
    uint8_t color[3];
} OdiffPicture;

/* Writes a picture of the size of the base with the pixels that differ in this colour; paints it into `base`. */
bool odiff_picture_write(Image *base, const OdiffDifference *difference, const OdiffPicture *picture, const char *path,
                         Error *error);

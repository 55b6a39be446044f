/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What happened to one drawn box between two pictures, from the pixels alone. Its pose in the first picture is known; line
   width and colours are fitted to it. Then three explanations are fitted to the difference of the pictures: the box moved
   or turned, its colours changed, its line width changed. The one that leaves the least squared difference wins. */
#pragma once
#include "common/error.h"
#include "naming/box_model.h"
#include "naming/change.h"

#include <stdint.h>

enum { FIT_PIXELS_MAX = 8000, MOVEMENT_STARTS_MAX = 8 };

/* A pixel near the box; colours are 0..255. */
typedef struct FitPixel {
    double x, y;                     /* centre */
    double before[3], difference[3]; /* colour in the first picture; second minus first */
    double behind[3];                /* what a box that moves away uncovers, as far as known */
} FitPixel;

typedef struct FitPixels {
    int count;
    FitPixel list[FIT_PIXELS_MAX];
} FitPixels;

typedef struct BodyFit {
    ChangeKind kind;         /* CHANGE_OTHER: no explanation leaves less than half of the squared difference */
    double right, up, turn;  /* of CHANGE_MOVED, as in Change */
    double total, explained; /* squared differences */
} BodyFit;

/* `starts`: movements (pixels right, down) from which the search begins besides (0, 0); at most
   MOVEMENT_STARTS_MAX. */
BodyFit body_fit(const BoxModel *box, const FitPixels *pixels, const double (*starts)[2], int start_count);

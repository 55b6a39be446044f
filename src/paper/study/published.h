/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers that the paper states (Avatavului, Ifrim, Voncila 2023). */
#pragma once

enum { PUBLISHED_SCORES = 6 };

/* Table 1: mean squared errors after so many iterations. */
typedef struct PublishedScore {
    double iteration, test, train;
} PublishedScore;

extern const PublishedScore published_scores[PUBLISHED_SCORES];

/* A network goes into the engine if it is right in more than this share of cases (section 3). */
#define PUBLISHED_GATE 0.9

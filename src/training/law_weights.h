/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weights of the laws, parsed from text. */
#pragma once
#include "common/error.h"
#include "training/law_terms.h"

/* One number per law: weights, or violations in the law's unit. */
typedef struct LawNumbers {
    double of[LAWS];
} LawNumbers;

bool law_weights_any(const LawNumbers *weights);

/* "momentum=0.1,cone=1"; laws not named have weight 0. ERROR_INPUT: an unknown or repeated law, or a weight that is
   negative or not a number. */
bool law_weights_parse(const char *text, LawNumbers *weights, Error *error);

/* Sets one weight for the law of this name, for "all" or for "none". ERROR_INPUT: another name. */
bool law_weights_named(const char *laws, double weight, LawNumbers *weights, Error *error);

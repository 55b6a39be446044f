/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weights of the laws, in words. */
#pragma once
#include "common/error.h"
#include "training/law_terms.h"

/* A number for each law: weights, or violations in the law's unit. */
typedef struct LawNumbers {
    double of[LAWS];
} LawNumbers;

/* Whether any weight is not 0. */
bool law_weights_any(const LawNumbers *weights);

/* "momentum=0.1,cone=1": laws that are not named have weight 0. ERROR_INPUT: an unknown law or one named twice, or what
   is no number of 0 or more. */
bool law_weights_parse(const char *text, LawNumbers *weights, Error *error);

/* One weight for a law by name, for "all" of them, or for "none". ERROR_INPUT: another word. */
bool law_weights_named(const char *laws, double weight, LawNumbers *weights, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training data of a form of sain: what its network sees of each receiver in recorded problems, and the correction that
   would make its velocity converged. */
#pragma once
#include "impact_training/impact_problems.h"
#include "relation/relation_network.h"

typedef struct RelationSample {
    int first, rows; /* in rows */
    float body[RELATION_BODY_INPUTS];
    float target[RELATION_OUTPUTS]; /* m/s, in the receiver's frame; spin times the radius of gyration */
    float scale;                    /* m/s: of the outputs */
} RelationSample;

typedef struct RelationRowInputs {
    float numbers[RELATION_PAIR_INPUTS];
} RelationRowInputs;

/* Zero-initialise. */
typedef struct RelationSamples {
    RelationForm form;
    RelationSample *items;
    RelationRowInputs *rows;
    size_t count, row_count, problems;
    size_t item_capacity, row_capacity;
} RelationSamples;

void relation_samples_free(RelationSamples *samples);

/* Appends the receivers of all problems, or of those in impact frames. False with error set when memory is short. */
bool relation_samples_add(RelationSamples *samples, const ImpactProblems *problems, bool impacts_only, Error *error);

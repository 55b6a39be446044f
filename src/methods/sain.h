/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of sain, and the method with a network in memory. A relation network answers each row of a view
   (methods/sain_view.h) with effects; the effects of a receiver's rows are added; an object network answers its own
   state and the sum with its outputs.

   Here the relation network has two hidden layers of 32 units and 16 effects, the object network one layer of 32.
   The interaction network of Battaglia et al. (2016) has four of 150 and 50 effects, and one of 100; a
   reimplementation of Ajay et al. (2019) has 128, 64, 32 and 16. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"
#include "methods/sain_view.h"
#include "nets/nets.h"

#include <stdbool.h>

enum {
    SAIN_VERSION = 1,
    SAIN_EFFECTS = 16,
    SAIN_HIDDEN = 32,
    SAIN_OBJECT_INPUTS = SAIN_BODY_INPUTS + SAIN_EFFECTS,
    SAIN_COMMAND_SIZE = 512,
    SAIN_ANSWER_MAX = 100 /* times the scale: larger corrections are not trained */
};

typedef struct SainNetwork {
    Network *relation; /* SAIN_PAIR_INPUTS to SAIN_EFFECTS */
    Network *object;   /* body inputs, then the sum of effects, to SAIN_OUTPUTS */
    /* Ranges of the training data; outputs beyond +-limit are discarded. */
    float pair_low[SAIN_PAIR_INPUTS], pair_high[SAIN_PAIR_INPUTS];
    float body_low[SAIN_BODY_INPUTS], body_high[SAIN_BODY_INPUTS];
    float limit[SAIN_OUTPUTS];
    char command[SAIN_COMMAND_SIZE]; /* that trained it */
} SainNetwork;

/* Weights and ranges 0. False with error set when memory is short; destroy it in any case. */
bool sain_network_create(SainNetwork *network, Error *error);
void sain_network_destroy(SainNetwork *network);

bool sain_network_write(const SainNetwork *network, const char *path, Error *error);

/* False with error set, and nothing to be destroyed: not such a file, of other widths, or a number that is NaN,
   infinite or out of range. */
bool sain_network_read(SainNetwork *network, const char *path, Error *error);

/* Answers to a view. Zero-initialise, free with sain_answers_free. */
typedef struct SainAnswers {
    float *outputs; /* [body_count, SAIN_OUTPUTS] */
    bool *known;    /* [body_count] all inputs of the body and its rows are within the ranges of the training data */
    float *effects, *inputs, *columns, *scratch;
    ArrayBlock arrays;
} SainAnswers;

void sain_answers_free(SainAnswers *answers);

/* False when memory is short. */
bool sain_answer(SainAnswers *answers, const SainNetwork *network, const SainView *view);

/* The method sain with a network in memory, for training: the caller's, which must outlive the solver. False with error
   set when memory is short. */
bool sain_make(ContactSolver *solver, const SainNetwork *network, Error *error);

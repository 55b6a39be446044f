/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The networks of sain, their answers, and the method with a network in memory. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"
#include "methods/relation_view.h"
#include "nets/nets.h"

#include <stdbool.h>

/* A relation network answers each row of a view with effects; the effects of a
   receiver's rows are added; an object network answers its own state and the sum with its outputs. Here the first has
   two hidden layers of 32 units and 16 effects, the second one of 32. The interaction network of Battaglia et al.
   (2016) has four of 150 and 50 effects, and one of 100; a reimplementation of Ajay et al. (2019) has 128, 64, 32 and
   16. */

enum {
    RELATION_VERSION = 1,
    RELATION_EFFECTS = 16,
    RELATION_HIDDEN = 32,
    RELATION_OBJECT_INPUTS = RELATION_BODY_INPUTS + RELATION_EFFECTS,
    RELATION_COMMAND_SIZE = 512,
    RELATION_ANSWER_MAX = 100 /* times the scale: larger corrections are not trained */
};

/* The networks of one form. */
typedef struct RelationNetwork {
    Network *relation; /* RELATION_PAIR_INPUTS to RELATION_EFFECTS */
    Network *object;   /* body inputs, then the sum of effects, to RELATION_OUTPUTS */
    /* Ranges of the training data; outputs beyond +-limit are discarded. */
    float pair_low[RELATION_PAIR_INPUTS], pair_high[RELATION_PAIR_INPUTS];
    float body_low[RELATION_BODY_INPUTS], body_high[RELATION_BODY_INPUTS];
    float limit[RELATION_OUTPUTS];
} RelationNetwork;

/* A file holds the networks of all forms. */
typedef struct RelationNetworks {
    RelationNetwork forms[RELATION_FORMS];
    char command[RELATION_COMMAND_SIZE]; /* that trained them */
} RelationNetworks;

/* Weights and ranges 0. False with error set when memory is short; destroy it in any case. */
bool relation_network_create(RelationNetwork *network, Error *error);
void relation_network_destroy(RelationNetwork *network);

bool relation_networks_write(const RelationNetworks *networks, const char *path, Error *error);

/* False with error set, and nothing to be destroyed: not such a file, of other widths, or a number that is NaN,
   infinite or out of range. */
bool relation_networks_read(RelationNetworks *networks, const char *path, Error *error);
void relation_networks_destroy(RelationNetworks *networks);

/* Answers to a view. Zero-initialise, free with relation_answers_free. */
typedef struct RelationAnswers {
    float *outputs; /* [body_count, RELATION_OUTPUTS] */
    bool *known;    /* [body_count] all inputs of the body and its rows are within the ranges of the training data */
    float *effects, *inputs, *columns, *scratch;
    ArrayBlock arrays;
} RelationAnswers;

void relation_answers_free(RelationAnswers *answers);

/* clamp: inputs beyond the ranges are moved to their ends. False when memory is short. */
bool relation_answer(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp);

/* The method sain with a network in memory, for training. */

/* The networks remain the caller's and must outlive the solver. False with error set when memory is short. */
bool sain_make(ContactSolver *solver, const RelationNetwork *network, RelationForm form, Error *error);

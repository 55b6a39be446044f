/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the options say in words about a network's form: activations, and the scaling of its outputs; and about its loss. */
#pragma once
#include "training/loss.h"
#include "training/training.h"

typedef struct Form {
    Activation hidden, output;
    OutputScale scale;
} Form;

/* ERROR_INPUT: an unknown word. */
bool form_choose_loss(LossKind *kind, const TrainingOptions *options, Error *error);

/* Words left out take the defaults of training.h. ERROR_INPUT: an unknown word, or outputs scaled to where their
   activation does not reach. */
bool form_choose(Form *form, const TrainingOptions *options, Error *error);

/* ERROR_INPUT where the options ask for another form than that of the network to go on from. */
bool form_fits(const Network *start, const TrainingOptions *options, Error *error);

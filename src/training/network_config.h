/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the option words of training.h: activations, output scaling and loss. */
#pragma once
#include "training/loss.h"
#include "training/training.h"

typedef struct NetworkConfig {
    Activation hidden, output;
    OutputScale scale;
} NetworkConfig;

/* ERROR_INPUT: an unknown word. */
bool loss_kind_parse(LossKind *kind, const TrainingOptions *options, Error *error);

/* NULL words take the defaults of training.h. ERROR_INPUT: an unknown word, or output targets outside the range of the
   output activation. */
bool network_config_parse(NetworkConfig *config, const TrainingOptions *options, Error *error);

/* ERROR_INPUT if an option contradicts the start network. */
bool network_config_matches(const Network *start, const TrainingOptions *options, Error *error);

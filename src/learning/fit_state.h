/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of a training on disk: the same command continues an interrupted training, with the same result. What follows
   from command and weights, such as recorded launches, is not stored. */
#pragma once
#include "learning/adam.h"

enum { FIT_COMMAND_SIZE = 512 };

typedef struct FitState {
    const char *command;  /* of the training, at most FIT_COMMAND_SIZE - 1 bytes; another one does not continue it */
    int32_t stage, epoch; /* to do next; the training says what they count, from 0 */
    Adam adam;
} FitState;

/* Writes the state, atomically. */
bool fit_state_write(const FitState *state, const char *path, Error *error);

/* Reads the state; `command` and adam.count must be set. *found: whether there is one of this command; if not, the state is
   not changed. ERROR_INPUT, with the file, if it is damaged or of another number of weights: the user can delete it. */
bool fit_state_read(FitState *state, const char *path, bool *found, Error *error);

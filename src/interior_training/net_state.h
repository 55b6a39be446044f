/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of a training of interior-net, stored after each epoch: an interrupted training is resumed with the same
   result. Recorded problems are not stored; they follow from the networks that recorded them. */
#pragma once
#include "network/interior_net.h"

enum { NET_ROUNDS_MAX = 8 };

typedef struct NetState {
    char command[sizeof((InteriorNet *)NULL)->command]; /* of the training; another one does not resume it */
    int32_t round, epoch;                               /* to do next */
    int32_t steps;                                      /* of Adam, in the round */
    double weights[INTERIOR_NET_WEIGHTS], mean[INTERIOR_NET_WEIGHTS], square[INTERIOR_NET_WEIGHTS];
    double drivers[NET_ROUNDS_MAX][INTERIOR_NET_WEIGHTS]; /* weights at the start of each round so far */
} NetState;

bool net_state_write(const NetState *state, const char *path, Error *error);

/* False without an error if there is no such file or it is of another command. ERROR_INPUT if it is damaged; the user
   can delete it. */
bool net_state_read(NetState *state, const char *path, const char *command, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of physics in the loss of a network of six outputs (the paper's outlook): for each law (law_terms.h) the mean
   over rows of the square of how far the prediction breaks it beyond what the label itself does. So a law is never asked
   for more than the engine keeps: where position correction adds energy, or other pairs push back, a network may too.

   What is added to the loss for a weight w is

       w * mean(excess^2) / scale

   with scales from the labels of the rows to train on, so that w = 1 makes a violation of all of the label's own size as
   bad as predicting nothing is for standardised outputs:

       momentum, cone  mean |J|^2, J the pair's impulse
       energy          mean square of the change of the pair's kinetic energy
       approach        mean square of the change of the velocity along the normal

   A scale of 0 (labels that do nothing) counts as 1. Raissi, Perdikaris, Karniadakis, "Physics-informed neural networks"
   (2019). */
#pragma once
#include "dataset/dataset.h"
#include "network/network_gradient.h"
#include "training/law_weights.h"

/* ERROR_INPUT: a weight that is negative or not finite; a dataset without context, or whose target is not the pair's
   change in world axes; not six outputs. */
bool laws_check(const Dataset *dataset, int outputs, const LawNumbers *weights, Error *error);

/* The laws for the rows to train on, in their order, where laws_check() lets them; the network for its output
   normalisation, which must outlive it. */
typedef struct Laws Laws;
Laws *laws_create(const Dataset *dataset, const Network *network, const LawNumbers *weights, Error *error);
void laws_destroy(Laws *laws);

/* Of the first `rows` rows of block b, which has been run forward: returns the sum over rows of what the laws add, times
   the number of outputs, as the loss sums over them too; and adds half its slope by each output to
   half_slopes[outputs, BLOCK_ROWS]. */
double laws_add(const Laws *laws, const NetworkBlock *block, int64_t b, int rows, double *half_slopes);

/* Mean violation of each law over the rows held out for the test: by a network's predictions, or where it is NULL by
   the labels. Errors as laws_check; also a network of other inputs, or no rows held out. */
bool laws_measure(const Dataset *dataset, const Network *network, LawNumbers *violations, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Physics-informed loss terms for networks with six outputs (the paper's outlook). Each law (law_terms.h) of weight w
   adds

       w * mean(excess^2) / scale

   to the loss, where excess = max(0, violation by the prediction - violation by the label): the label violates laws
   too, where position correction adds energy or other pairs push back. The scale is measured on the labels of the
   training rows. With w = 1, a violation as large as the label itself costs as much as predicting 0 for a standardised
   output:

       momentum, cone  mean |J|^2, J the pair's impulse
       energy          mean square of the change of the pair's kinetic energy
       approach        mean square of the change of the velocity along the normal

   A scale of 0 (labels without a change) is replaced by 1. Source: Raissi, Perdikaris, Karniadakis, "Physics-informed
   neural networks" (2019). */
#pragma once
#include "dataset/dataset.h"
#include "network/network_gradient.h"
#include "training/law_weights.h"

/* ERROR_INPUT: a weight that is negative or not finite; a dataset without context, or with another target than the
   pair's change in world axes; not six outputs. */
bool laws_check(const Dataset *dataset, int outputs, const LawNumbers *weights, Error *error);

/* Prepares the laws for the training rows, in their order. The caller has run laws_check(). Uses the network's output
   normalisation; the network must outlive the laws. */
typedef struct Laws Laws;
Laws *laws_create(const Dataset *dataset, const Network *network, const LawNumbers *weights, Error *error);
void laws_destroy(Laws *laws);

/* For the first `rows` rows of block b, after its forward pass: returns the laws' terms summed over rows, times the
   number of outputs (the loss is a mean over outputs), and adds half their derivative with respect to each output to
   half_slopes[outputs, BLOCK_ROWS]. */
double laws_add(const Laws *laws, const NetworkBlock *block, int64_t b, int rows, double *half_slopes);

/* Mean violation of each law over the test rows, by the network's predictions or, if network is NULL, by the labels.
   Errors as laws_check; also a network with other inputs, or no test rows. */
bool laws_measure(const Dataset *dataset, const Network *network, LawNumbers *violations, Error *error);

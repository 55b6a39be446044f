/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of physics in the loss of pair networks: violations, and terms of the loss.

       law_weights_parse("momentum=0.1,cone=1", &options.laws, error);    pair_training.h adds their terms
       laws_measure(dataset, network, &violations, error);                on the test rows */
#pragma once
#include "base/base.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "nets/nets.h"

/* Physical laws for one touching pair: the violation of each law by a change of the pair's velocities, and the gradient
   of the violation with respect to that change. The change of a static body is ignored.

       momentum  |ma dva + mb dvb|, N s: net momentum change; 0 if a body is static
       energy    increase of the pair's kinetic energy, J
       approach  approach velocity along the normal that remains at the mean contact point, m/s
       cone      distance of the pair's impulse J from Coulomb's friction cone, N s: max(0, |J.t| - mu max(J.n, 0))
                 along the tangent plus max(0, -J.n) for pulling. J is the impulse on b, or if b is static minus that
                 on a */

enum { LAW_MOMENTUM, LAW_ENERGY, LAW_APPROACH, LAW_CONE, LAWS };

/* A pair, prepared from its context. Arrays hold velocity (x, y) and spin of a, then of b. */
typedef struct LawPair {
    double mass[PAIR_CHANGES];     /* kg, kg m^2; 0 for a static body */
    double velocity[PAIR_CHANGES]; /* before the change */
    double approach[PAIR_CHANGES]; /* its dot product with velocities is the separation velocity along the normal */
    double normal[2], friction;
} LawPair;

LawPair law_pair(const float context[PAIR_CONTEXT]);

typedef struct Law {
    const char *name, *unit, *summary;
    /* Returns the violation, >= 0. slope[PAIR_CHANGES] is its gradient, valid if the violation is above 0. */
    double (*violation)(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]);
    /* The size of the change in the law's unit; normalises the violation. */
    double (*size)(const LawPair *pair, const double change[PAIR_CHANGES]);
} Law;

extern const Law laws_known[LAWS];

/* Weights of the laws, parsed from text. */

/* One number per law: weights, or violations in the law's unit. */
typedef struct LawNumbers {
    double of[LAWS];
} LawNumbers;

bool law_weights_any(const LawNumbers *weights);

/* "momentum=0.1,cone=1"; laws not named have weight 0. ERROR_INPUT: an unknown or repeated law, or a weight that is
   negative or not a number. */
bool law_weights_parse(const char *text, LawNumbers *weights, Error *error);

/* Sets one weight for the law of this name, for "all" or for "none". ERROR_INPUT: another name. */
bool law_weights_named(const char *laws, double weight, LawNumbers *weights, Error *error);

/* Physics-informed loss terms for networks with six outputs (the paper's outlook). Each law of weight w
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The networks of the paper's study (Avatavului, Ifrim, Voncila 2023): a baseline, and others that differ from it in
   one factor each. The paper's own words for the baseline: ten inputs made of differences of positions (3.1), one
   hidden layer of ten, two outputs, sigmoids throughout, outputs scaled to [0, 1] (3.2), the sweep of launches (3.3).
   */
#pragma once
#include "dataset/dataset.h"

/* Recorded launches of the single box and of the stack. DATA_PAPER has the paper's 201 places; the baseline has fewer,
   to keep the study short. */
typedef enum PaperData {
    DATA_SWEPT,
    DATA_RANDOM,
    DATA_MIXED,
    DATA_FINE,
    DATA_FINEST,
    DATA_PAPER,
    PAPER_DATA
} PaperData;

extern const char *const paper_data_names[PAPER_DATA];

/* Words are those of training.h. Zero-initialised members are the baseline's: swept, labels by the engine, relative,
   pair, sigmoid, mse. */
typedef struct PaperNetwork {
    const char *name, *factor, *value; /* value: of the factor in which it differs from the baseline */
    PaperData data;
    DatasetLabels labels;
    PairView view;
    PairTarget target;
    const char *layers; /* "10-10-2" */
    const char *hidden, *output, *scale, *optimizer, *loss;
    int iterations; /* 0: 2000, as the paper's Table 1 */
    bool quick;     /* also part of the quick study */
} PaperNetwork;

enum { PAPER_NETWORK_NAME_SIZE = 64 };

extern const PaperNetwork paper_networks[];
extern const int paper_network_count;

/* With all defaults set. */
PaperNetwork paper_network(int i);

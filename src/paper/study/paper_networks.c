/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_networks.h"

#include <string.h>

const char *const paper_data_names[PAPER_DATA] = {
    "swept", "random", "mixed", "swept finely", "swept most finely", "swept as in the paper"};

#define SEARCHED(form) \
    { .name = "layers-" form, .factor = "layers", .value = form, .layers = form }

/* Searched widths are around 6, the mean of ten inputs and two outputs. The networks of the factor "best" are the best
   that a search with Adam found for each target within 500 parameters, among 20 to 40 layouts with inputs of all views.
   */
const PaperNetwork paper_networks[] = {
    {.name = "baseline", .factor = "baseline", .value = "10-10-2", .quick = true},
    {.name = "inputs-raw", .factor = "inputs", .value = "raw", .view = PAIR_RAW, .layers = "12-10-2", .quick = true},
    {.name = "inputs-raw-unturned", .factor = "inputs", .value = "raw-unturned", .view = PAIR_RAW_UNTURNED},
    {.name = "outputs-six", .factor = "outputs", .value = "six", .layers = "10-10-6", .output = "sigmoid"},
    {.name = "outputs-six-two-layers",
     .factor = "outputs",
     .value = "six, 10-8-8-6",
     .layers = "10-8-8-6",
     .output = "linear",
     .quick = true},
    {.name = "target-net", .factor = "target", .value = "net", .target = TARGET_NET, .quick = true},
    {.name = "target-impulse", .factor = "target", .value = "impulse", .target = TARGET_IMPULSE, .quick = true},
    {.name = "data-random", .factor = "data", .value = "random", .data = DATA_RANDOM},
    {.name = "data-mixed", .factor = "data", .value = "mixed", .data = DATA_MIXED},
    {.name = "data-paper", .factor = "data", .value = "201 launches", .data = DATA_PAPER},
    {.name = "labels-reference",
     .factor = "labels",
     .value = "reference",
     .labels = DATASET_BY_REFERENCE,
     .quick = true},
    {.name = "scaling-linear", .factor = "scaling", .value = "min-max, linear", .output = "linear", .scale = "minmax"},
    {.name = "scaling-standard", .factor = "scaling", .value = "standard, linear", .output = "linear", .quick = true},
    {.name = "hidden-tanh", .factor = "hidden", .value = "tanh", .hidden = "tanh"},
    {.name = "hidden-relu", .factor = "hidden", .value = "relu", .hidden = "relu"},
    SEARCHED("10-4-2"),
    SEARCHED("10-6-2"),
    SEARCHED("10-8-2"),
    SEARCHED("10-4-4-2"),
    SEARCHED("10-6-6-2"),
    SEARCHED("10-8-8-2"),
    SEARCHED("10-4-4-4-2"),
    SEARCHED("10-6-6-6-2"),
    SEARCHED("10-8-8-8-2"),
    SEARCHED("10-4-4-4-4-2"),
    SEARCHED("10-6-6-6-6-2"),
    SEARCHED("10-8-8-8-8-2"),
    {.name = "optimizer-gd", .factor = "optimizer", .value = "gd", .optimizer = "gd"},
    {.name = "optimizer-bfgs", .factor = "optimizer", .value = "bfgs", .optimizer = "bfgs"},
    {.name = "optimizer-lm", .factor = "optimizer", .value = "lm", .optimizer = "lm", .quick = true},
    {.name = "net-gd", .factor = "optimizer", .value = "gd", .target = TARGET_NET, .optimizer = "gd"},
    {.name = "net-bfgs", .factor = "optimizer", .value = "bfgs", .target = TARGET_NET, .optimizer = "bfgs"},
    {.name = "net-lm", .factor = "optimizer", .value = "lm", .target = TARGET_NET, .optimizer = "lm"},
    {.name = "impulse-gd", .factor = "optimizer", .value = "gd", .target = TARGET_IMPULSE, .optimizer = "gd"},
    {.name = "impulse-bfgs", .factor = "optimizer", .value = "bfgs", .target = TARGET_IMPULSE, .optimizer = "bfgs"},
    {.name = "impulse-lm", .factor = "optimizer", .value = "lm", .target = TARGET_IMPULSE, .optimizer = "lm"},
    {.name = "best-pair",
     .factor = "best",
     .value = "pair",
     .data = DATA_FINE,
     .view = PAIR_NEIGHBOURS,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-net",
     .factor = "best",
     .value = "net",
     .data = DATA_FINE,
     .view = PAIR_NEIGHBOURS,
     .target = TARGET_NET,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-impulse",
     .factor = "best",
     .value = "impulse",
     .data = DATA_FINEST,
     .view = PAIR_CONTACT,
     .target = TARGET_IMPULSE,
     .layers = "20-21-2",
     .hidden = "relu",
     .output = "linear"},
    {.name = "contact-net",
     .factor = "contact-net",
     .value = "contact-net",
     .data = DATA_FINE,
     .view = PAIR_NEIGHBOURS,
     .target = TARGET_POINTS,
     .layers = "32-24-12-4",
     .hidden = "relu",
     .output = "linear",
     .loss = "smooth-l1",
     .quick = true},
};

const int paper_network_count = sizeof paper_networks / sizeof paper_networks[0];

PaperNetwork paper_network(int i) {
    PaperNetwork network = paper_networks[i];
    if (network.layers == NULL) network.layers = "10-10-2";
    if (network.hidden == NULL) network.hidden = "sigmoid";
    if (network.output == NULL) network.output = "sigmoid";
    if (network.scale == NULL) network.scale = strcmp(network.output, "linear") == 0 ? "standard" : "minmax";
    if (network.optimizer == NULL) network.optimizer = "adam";
    if (network.loss == NULL) network.loss = "mse";
    if (network.iterations == 0) network.iterations = 2000;
    return network;
}


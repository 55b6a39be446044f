/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "training/network_config.h"

#include "common/names.h"

#include <stdio.h>
#include <string.h>

typedef struct Word {
    const char *name; /* NULL ends a list */
    int value;
} Word;

static const Word hidden_words[] = {
    {"sigmoid", ACTIVATION_SIGMOID}, {"tanh", ACTIVATION_TANH}, {"relu", ACTIVATION_RELU}, {NULL, 0}};
static const Word output_words[] = {{"sigmoid", ACTIVATION_SIGMOID}, {"linear", ACTIVATION_LINEAR}, {NULL, 0}};
static const Word scale_words[] = {{"minmax", SCALE_MINMAX}, {"standard", SCALE_STANDARD}, {NULL, 0}};
static const Word loss_words[] = {{"mse", LOSS_MSE}, {"smooth-l1", LOSS_SMOOTH_L1}, {NULL, 0}};

/* If name is NULL, value keeps its default. */
static bool choose(const char *option, const char *name, const Word *words, int *value, Error *error) {
    if (name == NULL) return true;
    NameList known = {0};
    for (int i = 0; words[i].name != NULL; i++) {
        if (strcmp(words[i].name, name) == 0) return *value = words[i].value, true;
        name_list_add(&known, words[i].name);
    }
    return error_unknown(error, option, name, "a valid value", &known);
}

bool loss_kind_parse(LossKind *kind, const TrainingOptions *options, Error *error) {
    int loss = LOSS_MSE;
    if (!choose("loss", options->loss, loss_words, &loss, error)) return false;
    *kind = (LossKind)loss;
    return true;
}

bool network_config_parse(NetworkConfig *config, const TrainingOptions *options, Error *error) {
    bool two = options->widths[options->layers] == 2;
    int hidden = ACTIVATION_SIGMOID, output = two ? ACTIVATION_SIGMOID : ACTIVATION_LINEAR;
    if (!choose("hidden", options->hidden, hidden_words, &hidden, error) ||
        !choose("output activation", options->output_activation, output_words, &output, error))
        return false;
    int scale = output == ACTIVATION_LINEAR ? SCALE_STANDARD : SCALE_MINMAX;
    if (!choose("scale", options->scale, scale_words, &scale, error)) return false;
    if (output == ACTIVATION_SIGMOID && scale == SCALE_STANDARD)
        return error_input(error, "scale", "standard needs linear outputs: a sigmoid stays between 0 and 1");
    *config = (NetworkConfig){(Activation)hidden, (Activation)output, (OutputScale)scale};
    return true;
}

bool network_config_matches(const Network *start, const TrainingOptions *options, Error *error) {
    if (options->scale != NULL)
        return error_input(error, "scale", "the start network keeps its own scale; omit this option");
    int last = start->layers - 1, hidden = ACTIVATION_SIGMOID, output = (int)start->activations[last];
    if (!choose("hidden", options->hidden, hidden_words, &hidden, error) ||
        !choose("output activation", options->output_activation, output_words, &output, error))
        return false;
    for (int l = 0; options->hidden != NULL && l < last; l++)
        if (start->activations[l] != (Activation)hidden)
            return error_input(error, "hidden", "the start network has a hidden activation other than %s",
                               options->hidden);
    if (start->activations[last] == (Activation)output) return true;
    return error_input(error, "output activation", "the start network's is not %s", options->output_activation);
}

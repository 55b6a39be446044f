/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulation_training/online_net.h"

#include "common/clock.h"
#include "impact_training/slot_loss.h"
#include "impact_training/slot_network_init.h"
#include "learning/adam.h"
#include "solvers/momentum.h"

#include <math.h>
#include <stdlib.h>

/* As `train --kind scene-net` has them, but for the rate: it stays, as there is no end to decay to. */
enum { SWEEPS = 14 };
static const SlotWidths widths = {.state = 16, .present = 32, .warm = 16, .hidden = 32};
static const double impulse_weight = 0.02, rate = 1e-3;

struct OnlineNet {
    uint64_t seed;
    SlotSamples first; /* until there is a network */
    SlotNetwork *network;
    SlotLoss loss;
    Adam adam;
    float *gradient; /* [parameter_count] */
    double *slopes;  /* [parameter_count] */
    double factors[SWEEPS];
};

OnlineNet *online_net_create(uint64_t seed, Error *error) {
    OnlineNet *net = calloc(1, sizeof *net);
    if (net == NULL) {
        error_memory(error, "scene-net");
        return NULL;
    }
    net->seed = seed;
    for (int s = 0; s < SWEEPS; s++) net->factors[s] = (double)momentum_factor_tuned(s, SWEEPS);
    return net;
}

void online_net_destroy(OnlineNet *net) {
    if (net == NULL) return;
    slot_samples_free(&net->first);
    slot_network_destroy(net->network);
    slot_loss_free(&net->loss);
    adam_free(&net->adam);
    free(net->gradient);
    free(net->slopes);
    free(net);
}

static bool begin(OnlineNet *net, Error *error) {
    net->network = slot_network_from_samples(&net->first, &widths, net->seed, error);
    if (net->network == NULL) return false;
    const size_t count = net->network->parameter_count;
    if (!adam_create(&net->adam, (int64_t)count, ADAM_SQUARE_DECAY, error)) return false;
    net->gradient = calloc(count, sizeof *net->gradient);
    net->slopes = calloc(count, sizeof *net->slopes);
    if (net->gradient == NULL || net->slopes == NULL) return error_memory(error, "scene-net");
    for (size_t i = 0; i < count; i++) net->adam.weights[i] = (double)net->network->parameters[i];
    slot_samples_free(&net->first);
    return true;
}

/* One step on one sample. */
static bool train(OnlineNet *net, const SlotSample *sample, double *wrong, Error *error) {
    const SlotTask task = {impulse_weight, 1, SWEEPS, net->factors};
    SlotNetwork *network = net->network;
    SlotScore score;
    for (size_t i = 0; i < network->parameter_count; i++) net->gradient[i] = 0;
    if (!slot_loss(&net->loss, network, sample, &task, net->gradient, NULL, &score))
        return error_memory(error, "scene-net");
    if (!isfinite(score.loss)) return error_input(error, "scene-net", "training diverged");
    for (size_t i = 0; i < network->parameter_count; i++) net->slopes[i] = (double)net->gradient[i];
    adam_step(&net->adam, net->slopes, rate);
    for (size_t i = 0; i < network->parameter_count; i++) network->parameters[i] = (float)net->adam.weights[i];
    slot_network_pack_layers(network);
    *wrong = score.error;
    return true;
}

static bool learn_now(OnlineNet *net, const ContactProblem *problem, double *wrong, double *seconds, Error *error) {
    SlotSamples one = {0};
    double begin = 0;
    const bool ok = (slot_samples_add(&one, problem, 0, 0) || error_memory(error, "scene-net")) &&
                    slot_samples_label(&one, 0, NULL, error) &&
                    (begin = clock_thread_seconds(), slot_samples_compute_inputs(&one, 0, net->network, error)) &&
                    train(net, &one.items[0], wrong, error);
    *seconds = clock_thread_seconds() - begin;
    slot_samples_free(&one);
    return ok;
}

bool online_net_learn(OnlineNet *net, const ContactProblem *problem, double *wrong, double *seconds, Error *error) {
    *wrong = NAN;
    *seconds = 0;
    if (net->network != NULL) return learn_now(net, problem, wrong, seconds, error);
    if (!slot_samples_add(&net->first, problem, 0, 0)) return error_memory(error, "scene-net");
    if (!slot_samples_label(&net->first, net->first.count - 1, NULL, error)) return false;
    return net->first.count < ONLINE_FIRST || begin(net, error);
}

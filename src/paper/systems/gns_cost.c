/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/gns_cost.h"

#include "particles_training/gns_fit.h"
#include "particles_training/gns_training.h"
#include "study/meter.h"

static double since(int64_t begin) { return 1e-9 * (double)(meter_time() - begin); }

/* Weights do not matter for the time; 0 would make all units the same. */
static bool make_net(GnsNet *net, int width, int rounds, Error *error) {
    if (!gns_net_create(net, width, rounds, error)) return false;
    for (int i = 0; i < net->layout.parameters; i++) net->parameters[i] = (float)(i % 7 - 3) / (float)width;
    net->scales = (GnsScales){0.6f, 5, 20, 100, 1000};
    return true;
}

static bool measure(const GnsExamples *examples, GnsNet *net, int steps, GnsCost *cost, Error *error) {
    GnsFit fit;
    double loss;
    bool ok = gns_fit_begin(&fit, examples, net, GNS_PAPER_BATCH, error) && gns_fit_batch(&fit, 0, &loss, error);
    const int64_t begin = meter_time();
    for (int i = 0; ok && i < steps; i++) ok = gns_fit_batch(&fit, (uint64_t)i * GNS_PAPER_BATCH, &loss, error);
    cost->seconds_a_gradient = since(begin) / steps;
    cost->hours = cost->seconds_a_gradient * GNS_PAPER_STEPS / 3600;
    ok = ok && gns_training_time_pass(net, &examples->scenes[0], &cost->seconds_a_pass, &cost->boxes, error);
    gns_fit_free(&fit);
    return ok;
}

bool gns_cost_measure(const char *scene, const int *widths, const int *rounds, int count, int steps, GnsCost *costs,
                      const Progress *progress, Error *error) {
    GnsExamples examples = {.seed = 1};
    Method teacher;
    Scene *read = scene_read(scene, error);
    bool ok = read != NULL && method_parse(&teacher, gns_teacher, error) &&
              gns_examples_add(&examples, read, &teacher, 1, NULL, error);
    for (int i = 0; ok && i < count; i++) {
        GnsNet net;
        ok = make_net(&net, widths[i], rounds[i], error) && measure(&examples, &net, steps, &costs[i], error);
        gns_net_free(&net);
        if (ok && !progress_report(progress, i + 1, count)) ok = error_interrupted(error, "gns", "stopped");
    }
    gns_examples_free(&examples);
    return ok;
}

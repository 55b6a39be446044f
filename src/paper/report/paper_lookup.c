/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

const PaperScore paper_scores[PAPER_ROWS] = {
    {0, 0.105798, 0.106044},   {10, 0.051244, 0.051222},   {50, 0.015246, 0.015388},
    {100, 0.007767, 0.007789}, {1000, 0.001212, 0.001225}, {2000, 0.000728, 0.000730},
};

const PaperTarget paper_targets[PAPER_TARGETS] = {
    {"pair", "what the pair's own impulses change over the step", 0.4},
    {"net", "the net change of the two bodies over the step", 0.4},
    {"impulse", "a single impulse: one visit of the pair in one sweep", 0.1},
};

const NetworkRow *paper_network_row(const PaperFiles *files, const char *factor) {
    for (int i = 0; i < files->network_count; i++)
        if (strcmp(files->networks[i].factor, factor) == 0) return &files->networks[i];
    return NULL;
}

const NetworkRow *paper_best(const PaperFiles *files, const char *target, int *among) {
    const NetworkRow *best = NULL;
    *among = 0;
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (strcmp(row->target, target) != 0 || row->parameters > PAPER_SMALL_NETWORK || isnan(row->ratio)) continue;
        ++*among;
        if (best == NULL || row->ratio < best->ratio) best = row;
    }
    return best;
}

const RateRow *paper_rate(const PaperFiles *files, const char *network, const char *scene, const char *definition,
                          const char *phase) {
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        if (strcmp(row->network, network) == 0 && strcmp(row->scene, scene) == 0 && strcmp(row->phase, phase) == 0 &&
            strcmp(row->definition, definition) == 0)
            return row;
    }
    return NULL;
}

bool paper_has_factor(const PaperFiles *files, const char *network, const char *factor) {
    for (int i = 0; i < files->network_count; i++)
        if (strcmp(files->networks[i].network, network) == 0 && strcmp(files->networks[i].factor, factor) == 0)
            return true;
    return false;
}

double paper_constant(const PaperFiles *files, const char *target) {
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (strcmp(row->target, target) == 0 && strcmp(row->scale, "minmax") == 0 && !isnan(row->constant))
            return row->constant;
    }
    return NAN;
}

bool paper_comparable(const PaperFiles *files, const char *network, const char *target) {
    bool asked = false;
    for (int i = 0; i < PAPER_TARGETS; i++) asked |= strcmp(paper_targets[i].name, target) == 0;
    for (int i = 0; i < files->network_count; i++)
        if (strcmp(files->networks[i].network, network) == 0)
            return asked && strcmp(files->networks[i].scale, "minmax") == 0;
    return false;
}

const RateRow *paper_contact_net_rate(const PaperFiles *files, const char *scene) {
    const RateRow *best = NULL;
    for (int i = 0; i < files->network_count; i++) {
        if (strcmp(files->networks[i].factor, "contact-net") != 0) continue;
        const RateRow *row = paper_rate(files, files->networks[i].network, scene, "absolute", "all");
        if (row != NULL && !isnan(row->rate) && (best == NULL || row->rate > best->rate)) best = row;
    }
    return best;
}

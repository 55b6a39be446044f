/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first network of scene-net, from samples: its slots, projections, scales and weights. */
#include "base/base.h"
#include "engine/engine.h"
#include "learning/principal.h"
#include "learning/scene_net_fit.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OCCURRENCES_MIN = 3 };

/* The bomb's contacts show where it struck. They are few, so without extra weight no component would represent them. */
static const float bomb_weight = 5;

static int compare_slots(const void *first, const void *second) {
    const Slot *x = first, *y = second;
    int order = (x->a > y->a) - (x->a < y->a);
    if (order == 0) order = (x->b > y->b) - (x->b < y->b);
    return order != 0 ? order : (x->feature > y->feature) - (x->feature < y->feature);
}

/* The distinct contacts of the samples that occur often enough. The caller frees the array. */
static Slot *find_slots(const SceneNetSamples *samples, int *count, Error *error) {
    size_t contacts = 0;
    for (int i = 0; i < samples->count; i++) contacts += (size_t)samples->items[i].step.problem.contact_count;
    Slot *slots = malloc((contacts + 1) * sizeof *slots);
    if (slots == NULL) return error_memory(error, "slots"), NULL;
    size_t filled = 0, kept = 0;
    for (int i = 0; i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].step.problem;
        for (int k = 0; k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            slots[filled++] = (Slot){contact->a, contact->b, scene_view_feature(problem, contact)};
        }
    }
    qsort(slots, contacts, sizeof *slots, compare_slots);
    for (size_t i = 0, end; i < contacts; i = end) {
        for (end = i; end < contacts && compare_slots(&slots[i], &slots[end]) == 0;) end++;
        if (end - i >= OCCURRENCES_MIN && kept < SLOTS_MAX) slots[kept++] = slots[i];
    }
    *count = (int)kept;
    return slots;
}

/* The unit of a slot's outputs: mean(sqrt(|goal - base|))^2. Rare shocks are hundreds of times larger than the rest; in
   a unit such as the RMS the rest would be negligible. */
static bool find_scales(SceneNet *network, const SceneNetSamples *samples) {
    double *sums = calloc(2 * (size_t)network->slot_count, sizeof *sums);
    if (sums == NULL) return false;
    double *counts = sums + network->slot_count;
    for (int i = 0; i < samples->count; i++) {
        const SceneNetSample *sample = &samples->items[i];
        for (int k = 0; k < sample->view.slots.slot_count; k++) {
            const int contact = sample->view.contacts[k], slot = sample->view.slots.slots[k];
            const double normal = (double)(sample->step.impulses[contact].normal - sample->view.base[contact].normal);
            const double tangent =
                (double)(sample->step.impulses[contact].tangent - sample->view.base[contact].tangent);
            sums[slot] += sqrt(sqrt(normal * normal + tangent * tangent));
            counts[slot]++;
        }
    }
    const double least = 0.05; /* N s */
    for (int i = 0; i < network->slot_count; i++) {
        const double mean = counts[i] > 0 ? sums[i] / counts[i] : 0;
        network->scale[i] = (float)(mean * mean + least);
    }
    free(sums);
    return true;
}

/* The whitened principal components of rows [samples, projection->from]: over the rows, components have mean 0,
   variance
   1 and no correlation, strongest first; those beyond the rank are 0. */
static bool fit_projection(const float *numbers, int samples, Projection *projection, Error *error) {
    const PrincipalRows rows = {numbers, (size_t)samples, projection->from, 1};
    const size_t from = (size_t)projection->from, to = (size_t)projection->to;
    double *mean = malloc((2 + from) * from * sizeof *mean), *values = mean + from, *vectors = values + from;
    bool ok = mean != NULL || error_memory(error, "projections");
    if (ok) principal_mean(&rows, mean);
    ok = ok && principal_components(&rows, mean, values, vectors, error);
    if (ok) {
        memset(projection->rows, 0, from * to * sizeof *projection->rows);
        memset(projection->centre, 0, to * sizeof *projection->centre);
        /* Smaller ones are rounding errors of the float rows; below FLT_MIN^2 a direction would overflow float. */
        const double least = fmax(1e-10 * values[0] / samples, (double)FLT_MIN * (double)FLT_MIN);
        for (size_t c = 0; c < to && c < from; c++) {
            const double variance = values[c] / samples;
            if (!(variance > least)) continue;
            double centre = 0;
            for (size_t j = 0; j < from; j++) {
                const float number = (float)(vectors[c * from + j] / sqrt(variance));
                projection->rows[j * to + c] = number;
                centre += mean[j] * (double)number;
            }
            projection->centre[c] = (float)centre;
        }
    }
    free(mean);
    return ok;
}

/* What the projections see of a sample, one row after the other: the states of the bomb and of the other bodies, which
   contacts there are, and their warm impulses. */
static void fill_row(const SceneNet *network, const SceneView *view, int which, float *row) {
    const SceneNetView *slots = &view->slots;
    if (which == 0) memcpy(row, view->bomb, (size_t)network->bomb_state.from * sizeof *row);
    if (which == 1) memcpy(row, view->state, (size_t)network->state.from * sizeof *row);
    for (int k = 0; which == 2 && k < slots->slot_count; k++) row[slots->slots[k]] = 1;
    for (int k = 0; which == 3 && k < 2 * slots->slot_count; k++) row[slots->impulses[k]] = slots->warm[k];
}

/* The weight of each number: 1 / spread of a state variable, where `least` keeps irrelevant variations small; more for
   the bomb's contacts. */
static void find_weights(const SceneNet *network, const float *numbers, int samples, int which, int count,
                         float *weights) {
    static const double least[SLOT_BODY_NUMBERS] = {0.01, 0.01, 0.01, 0.1, 0.1, 0.1}; /* m, rad, m/s, rad/s */
    for (int k = 0; k < count; k++) {
        weights[k] = 1;
        if (which == 2 && (network->slots[k].a == network->bomb || network->slots[k].b == network->bomb))
            weights[k] = bomb_weight;
        if (which > 1) continue;
        double sum = 0, squares = 0;
        for (int i = 0; i < samples; i++) {
            const double x = (double)numbers[(size_t)i * (size_t)count + (size_t)k];
            sum += x;
            squares += x * x;
        }
        const double mean = sum / samples, variance = fmax(squares / samples - mean * mean, 0);
        const double small = least[k % SLOT_BODY_NUMBERS];
        weights[k] = (float)(1 / sqrt(variance + small * small));
    }
}

static bool find_projections(SceneNet *network, const SceneNetSamples *samples, Error *error) {
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int which = 0; which < 4; which++) {
        Projection *projection = projections[which];
        const size_t count = (size_t)projection->from;
        float *numbers = calloc(((size_t)samples->count + 1) * count, sizeof *numbers),
              *weights = numbers + (size_t)samples->count * count;
        if (numbers == NULL) return error_memory(error, "projections");
        for (int i = 0; i < samples->count; i++)
            fill_row(network, &samples->items[i].view, which, numbers + (size_t)i * count);
        find_weights(network, numbers, samples->count, which, projection->from, weights);
        for (size_t i = 0; i < (size_t)samples->count * count; i++) numbers[i] *= weights[i % count];
        const bool ok = fit_projection(numbers, samples->count, projection, error);
        for (size_t k = 0; ok && k < count * (size_t)projection->to; k++)
            projection->rows[k] *= weights[k / (size_t)projection->to];
        free(numbers);
        if (!ok) return false;
    }
    return true;
}

static void draw(float *numbers, size_t count, double spread, gsl_rng *generator) {
    for (size_t i = 0; i < count; i++) numbers[i] = (float)gsl_ran_gaussian(generator, spread);
}

/* Hidden layers preserve the variance of their inputs (Glorot, Bengio 2010); the last layer starts with outputs near
   0. */
static bool draw_weights(SceneNet *network, uint64_t seed) {
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return false;
    gsl_rng_set(generator, (unsigned long)seed);
    const size_t inputs = (size_t)scene_net_inputs(network), hidden = (size_t)scene_net_hidden(network);
    draw(network->first.rows, inputs * hidden, 1 / sqrt((double)inputs), generator);
    draw(network->second.rows, hidden * hidden, 1 / sqrt((double)hidden), generator);
    draw(network->rows, 2 * (size_t)network->slot_count * hidden, 0.1 / sqrt((double)hidden), generator);
    gsl_rng_free(generator);
    return true;
}

SceneNet *scene_net_from_samples(SceneNetSamples *samples, const SceneNetWidths *widths, uint64_t seed, Error *error) {
    if (samples->count == 0)
        return error_input(error, "scene-net", "no launch has an impact whose residual reaches the gate"), NULL;
    const ContactProblem *problem = &samples->items[0].step.problem;
    SceneNetShape shape = {problem->body_count, problem->bomb, 0, widths->state, widths->present,
                           widths->warm,        widths->hidden};
    Slot *slots = find_slots(samples, &shape.slot_count, error);
    SceneNet *network = slots != NULL ? scene_net_create(&shape, slots, error) : NULL;
    free(slots);
    if (network == NULL) return NULL;
    /* Warm impulses are capped at the largest one seen at the first touch: what exceeds it is left over from the shock
       in the step before. */
    for (int i = 0; i < samples->count; i++) {
        problem = &samples->items[i].step.problem;
        for (int k = 0; samples->items[i].step.since == 0 && k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            const int slot = scene_net_find(network, contact->a, contact->b, scene_view_feature(problem, contact));
            if (slot >= 0 && network->cap[slot] < contact->warm_normal) network->cap[slot] = contact->warm_normal;
        }
    }
    bool ok = scene_net_samples_look(samples, 0, network, error) &&
              (find_scales(network, samples) || error_memory(error, "scene-net")) &&
              find_projections(network, samples, error) &&
              (draw_weights(network, seed) || error_memory(error, "scene-net"));
    if (ok) scene_net_pack(network);
    ok = ok && scene_net_samples_look(samples, 0, network, error);
    /* Packing the projections to bytes shifted the means of the inputs; they move back to 0. */
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int p = 0, input = 0; ok && p < 4; p++)
        for (int k = 0; k < projections[p]->to; k++, input++) {
            double sum = 0;
            for (int i = 0; i < samples->count; i++) sum += (double)samples->items[i].inputs[input];
            projections[p]->centre[k] += (float)(sum / samples->count);
        }
    if (ok && scene_net_samples_look(samples, 0, network, error)) return network;
    scene_net_destroy(network);
    return NULL;
}

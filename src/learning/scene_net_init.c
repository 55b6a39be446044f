/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first network of scene-net, from samples: its slots, projections, scales and weights. */
#include "base/base.h"
#include "engine/engine.h"
#include "learning/scene_training.h"
#include "learning/scene_training_internal.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"

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
    for (int i = 0; i < samples->count; i++) contacts += (size_t)samples->items[i].problem.contact_count;
    Slot *slots = malloc((contacts + 1) * sizeof *slots);
    if (slots == NULL) return error_memory(error, "slots"), NULL;
    size_t filled = 0, kept = 0;
    for (int i = 0; i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].problem;
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

/* Warm impulses are capped at the largest one seen at the first touch: what exceeds it is left over from the shock in
   the step before. */
static void find_caps(SceneNet *network, const SceneNetSamples *samples) {
    for (int i = 0; i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].problem;
        for (int k = 0; samples->items[i].since == 0 && k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            const int slot = scene_net_find(network, contact->a, contact->b, scene_view_feature(problem, contact));
            if (slot >= 0 && network->cap[slot] < contact->warm_normal) network->cap[slot] = contact->warm_normal;
        }
    }
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
            const double normal = (double)(sample->goal[contact].normal - sample->view.base[contact].normal);
            const double tangent = (double)(sample->goal[contact].tangent - sample->view.base[contact].tangent);
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

/* Sparse rows under construction. */
typedef struct Numbers {
    int64_t *begin;
    int32_t *column;
    float *value;
    int64_t count;
} Numbers;

static bool make_numbers(Numbers *numbers, const SceneNetSamples *samples, size_t each) {
    const size_t rows = (size_t)samples->count;
    *numbers = (Numbers){malloc((rows + 1) * sizeof(int64_t)), malloc((rows * each + 1) * sizeof(int32_t)),
                         malloc((rows * each + 1) * sizeof(float)), 0};
    return numbers->begin != NULL && numbers->column != NULL && numbers->value != NULL;
}

static void scene_net_init_append(Numbers *numbers, int column, float value) {
    numbers->column[numbers->count] = column;
    numbers->value[numbers->count++] = value;
}

static bool touches_bomb(const SceneNet *network, int slot) {
    return network->slots[slot].a == network->bomb || network->slots[slot].b == network->bomb;
}

static bool fit(Numbers *numbers, const SceneNetSamples *samples, uint64_t seed, Projection *projection, Error *error) {
    numbers->begin[samples->count] = numbers->count;
    const SparseRows rows = {samples->count, projection->from, numbers->begin, numbers->column, numbers->value};
    bool ok = principal_fit(&rows, seed, projection, error);
    numbers->count = 0;
    return ok;
}

static void weigh_row(Projection *projection, int i, float weight) {
    for (int k = 0; k < projection->to; k++) projection->rows[(size_t)i * (size_t)projection->to + (size_t)k] *= weight;
}

/* 1 / spread of each state variable; `least` keeps irrelevant variations small. */
static void find_units(const SceneNetSamples *samples, bool bomb, int count, float *units) {
    static const double least[SLOT_BODY_NUMBERS] = {0.01, 0.01, 0.01, 0.1, 0.1, 0.1}; /* m, rad, m/s, rad/s */
    for (int k = 0; k < count; k++) {
        double sum = 0, squares = 0;
        for (int i = 0; i < samples->count; i++) {
            const SceneView *view = &samples->items[i].view;
            const double x = (double)(bomb ? view->bomb[k] : view->state[k]);
            sum += x;
            squares += x * x;
        }
        const double mean = sum / samples->count, variance = fmax(squares / samples->count - mean * mean, 0);
        const double small = least[k % SLOT_BODY_NUMBERS];
        units[k] = (float)(1 / sqrt(variance + small * small));
    }
}

static bool fit_body_projections(SceneNet *network, const SceneNetSamples *samples, Numbers *numbers, uint64_t seed,
                                 Error *error) {
    Projection *projections[] = {&network->bomb_state, &network->state};
    for (int p = 0; p < 2; p++) {
        const int count = projections[p]->from;
        float *units = malloc((size_t)count * sizeof *units);
        if (units == NULL) return error_memory(error, "projections");
        find_units(samples, p == 0, count, units);
        for (int i = 0; i < samples->count; i++) {
            const SceneView *view = &samples->items[i].view;
            numbers->begin[i] = numbers->count;
            for (int k = 0; k < count; k++)
                scene_net_init_append(numbers, k, units[k] * (p == 0 ? view->bomb[k] : view->state[k]));
        }
        bool ok = fit(numbers, samples, seed, projections[p], error);
        for (int k = 0; k < count; k++) weigh_row(projections[p], k, units[k]);
        free(units);
        if (!ok) return false;
    }
    return true;
}

static bool fit_contact_projections(SceneNet *network, const SceneNetSamples *samples, Numbers *numbers, uint64_t seed,
                                    Error *error) {
    for (int i = 0; i < samples->count; i++) {
        const SceneNetView *slots = &samples->items[i].view.slots;
        numbers->begin[i] = numbers->count;
        for (int k = 0; k < slots->slot_count; k++)
            scene_net_init_append(numbers, slots->slots[k], touches_bomb(network, slots->slots[k]) ? bomb_weight : 1);
    }
    if (!fit(numbers, samples, seed, &network->present, error)) return false;
    for (int slot = 0; slot < network->slot_count; slot++)
        if (touches_bomb(network, slot)) weigh_row(&network->present, slot, bomb_weight);
    for (int i = 0; i < samples->count; i++) {
        const SceneNetView *slots = &samples->items[i].view.slots;
        numbers->begin[i] = numbers->count;
        for (int k = 0; k < 2 * slots->slot_count; k++)
            scene_net_init_append(numbers, slots->impulses[k], slots->warm[k]);
    }
    return fit(numbers, samples, seed, &network->warm, error);
}

static bool find_projections(SceneNet *network, const SceneNetSamples *samples, uint64_t seed, Error *error) {
    size_t each = (size_t)network->state.from;
    for (int i = 0; i < samples->count; i++) {
        const size_t impulses = 2 * (size_t)samples->items[i].view.slots.slot_count;
        if (each < impulses) each = impulses;
    }
    Numbers numbers;
    bool ok = make_numbers(&numbers, samples, each) || error_memory(error, "projections");
    ok = ok && fit_body_projections(network, samples, &numbers, seed, error) &&
         fit_contact_projections(network, samples, &numbers, seed, error);
    free(numbers.begin);
    free(numbers.column);
    free(numbers.value);
    return ok;
}

static void scene_net_init_draw(float *numbers, size_t count, double spread, gsl_rng *generator) {
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
    scene_net_init_draw(network->first.rows, inputs * hidden, 1 / sqrt((double)inputs), generator);
    scene_net_init_draw(network->second.rows, hidden * hidden, 1 / sqrt((double)hidden), generator);
    scene_net_init_draw(network->rows, 2 * (size_t)network->slot_count * hidden, 0.1 / sqrt((double)hidden), generator);
    gsl_rng_free(generator);
    return true;
}

/* Packing the projections to bytes shifted the means of the inputs; moves them back to 0. */
static void recentre(SceneNet *network, const SceneNetSamples *samples) {
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int p = 0, input = 0; p < 4; p++)
        for (int k = 0; k < projections[p]->to; k++, input++) {
            double sum = 0;
            for (int i = 0; i < samples->count; i++) sum += (double)samples->items[i].inputs[input];
            projections[p]->centre[k] += (float)(sum / samples->count);
        }
}

SceneNet *scene_net_from_samples(SceneNetSamples *samples, const SceneNetWidths *widths, uint64_t seed, Error *error) {
    if (samples->count == 0)
        return error_input(error, "scene-net", "no launch has an impact whose residual reaches the gate"), NULL;
    const ContactProblem *problem = &samples->items[0].problem;
    SceneNetShape shape = {problem->body_count, problem->bomb, 0, widths->state, widths->present,
                           widths->warm,        widths->hidden};
    Slot *slots = find_slots(samples, &shape.slot_count, error);
    SceneNet *network = slots != NULL ? scene_net_create(&shape, slots, error) : NULL;
    free(slots);
    if (network == NULL) return NULL;
    find_caps(network, samples);
    bool ok = scene_net_samples_compute_inputs(samples, 0, network, error) &&
              (find_scales(network, samples) || error_memory(error, "scene-net")) &&
              find_projections(network, samples, seed, error) &&
              (draw_weights(network, seed) || error_memory(error, "scene-net"));
    if (ok) scene_net_pack(network);
    ok = ok && scene_net_samples_compute_inputs(samples, 0, network, error);
    if (ok) recentre(network, samples);
    if (ok && scene_net_samples_compute_inputs(samples, 0, network, error)) return network;
    scene_net_destroy(network);
    return NULL;
}

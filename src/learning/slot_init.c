/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "learning/scene_training.h"
#include "learning/scene_training_internal.h"
#include "methods/solvers.h"
#include "nets/kinds.h"

#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OVERSAMPLING = 8,    /* minimum number of extra directions; the source recommends 5 to 10 */
    POWER_ITERATIONS = 4 /* one pass over the rows each; the source's 2 suffice only if the spectrum decays fast */
};

/* Relative to the largest variance. Smaller variances are rounding errors of the float rows. */
static const double least_variance = 1e-10;

/* Relative to the longest column. A shorter remainder is rounding: the column is in the span of the others. */
static const double least_length = 1e-14;

typedef struct Fit {
    SparseCovariance covariance;
    size_t columns, width; /* width: number of directions; those beyond the rank become 0 */
    double *basis, *image; /* [columns, width] Q and C Q */
    double *products;      /* [width] work space */
    gsl_rng *generator;
    gsl_matrix *small, *axes; /* [width, width] Q^T C Q and its eigenvectors */
    gsl_vector *variances;
    gsl_eigen_symmv_workspace *eigen;
} Fit;

static void fit_free(Fit *fit) {
    sparse_covariance_free(&fit->covariance);
    free(fit->basis);
    free(fit->image);
    free(fit->products);
    if (fit->generator != NULL) gsl_rng_free(fit->generator);
    if (fit->small != NULL) gsl_matrix_free(fit->small);
    if (fit->axes != NULL) gsl_matrix_free(fit->axes);
    if (fit->variances != NULL) gsl_vector_free(fit->variances);
    if (fit->eigen != NULL) gsl_eigen_symmv_free(fit->eigen);
}

static bool fit_make(Fit *fit, const SparseRows *rows, int wanted, Error *error) {
    gsl_set_error_handler_off(); /* its default aborts */
    const size_t columns = (size_t)rows->columns, least = (size_t)wanted + OVERSAMPLING;
    const size_t width = (least + DIRECTIONS_BLOCK - 1) / DIRECTIONS_BLOCK * DIRECTIONS_BLOCK;
    *fit = (Fit){.columns = columns, .width = width};
    if (!sparse_covariance_make(&fit->covariance, rows, width, error)) return false;
    fit->basis = calloc(columns * width, sizeof *fit->basis);
    fit->image = calloc(columns * width, sizeof *fit->image);
    fit->products = calloc(width, sizeof *fit->products);
    fit->generator = gsl_rng_alloc(gsl_rng_mt19937);
    fit->small = gsl_matrix_calloc(width, width);
    fit->axes = gsl_matrix_calloc(width, width);
    fit->variances = gsl_vector_calloc(width);
    fit->eigen = gsl_eigen_symmv_alloc(width);
    return (fit->basis && fit->image && fit->products && fit->generator && fit->small && fit->axes && fit->variances &&
            fit->eigen) ||
           error_memory(error, "principal components");
}

static void start(Fit *fit, uint64_t seed) {
    gsl_rng_set(fit->generator, (unsigned long)((seed ^ seed >> 32) & UINT32_MAX)); /* it takes 32 bits */
    for (size_t i = 0; i < fit->columns * fit->width; i++) fit->basis[i] = gsl_ran_gaussian_ziggurat(fit->generator, 1);
}

/* products[k] = dot product of columns j and k of the basis, for k >= from. */
static void multiply_columns(Fit *fit, size_t j, size_t from) {
    memset(fit->products, 0, fit->width * sizeof *fit->products);
    for (size_t i = 0; i < fit->columns; i++) {
        const double *row = fit->basis + i * fit->width;
        add_scaled(fit->products + from, row[j], row + from, fit->width - from);
    }
}

static double longest_column(const Fit *fit, double *squares) {
    double largest = 0;
    memset(squares, 0, fit->width * sizeof *squares);
    for (size_t i = 0; i < fit->columns * fit->width; i++) squares[i % fit->width] += fit->basis[i] * fit->basis[i];
    for (size_t k = 0; k < fit->width; k++) largest = fmax(largest, squares[k]);
    return sqrt(largest);
}

/* Modified Gram-Schmidt on the columns of the basis, repeated once to remove the rounding errors of the first round.
   Columns in the span of earlier ones become 0. */
static void orthonormalise(Fit *fit) {
    for (int round = 0; round < 2; round++) {
        const double least = least_length * longest_column(fit, fit->products);
        for (size_t j = 0; j < fit->width; j++) {
            multiply_columns(fit, j, j);
            const double length = sqrt(fit->products[j]), scale = length > least ? 1 / length : 0;
            for (size_t i = 0; i < fit->columns; i++) {
                double *row = fit->basis + i * fit->width;
                row[j] *= scale;
                add_scaled(row + j + 1, -row[j] * scale, fit->products + j + 1, fit->width - j - 1);
            }
        }
    }
}

/* Eigenvectors of Q^T C Q, strongest first. */
static void find_axes(Fit *fit) {
    for (size_t a = 0; a < fit->width; a++) {
        double *row = gsl_matrix_ptr(fit->small, a, 0);
        for (size_t j = 0; j < fit->columns; j++)
            add_scaled(row, fit->basis[j * fit->width + a], fit->image + j * fit->width, fit->width);
    }
    gsl_eigen_symmv(fit->small, fit->variances, fit->axes, fit->eigen);
    gsl_eigen_symmv_sort(fit->variances, fit->axes, GSL_EIGEN_SORT_VAL_DESC);
}

/* scale: 1 / standard deviation of the component. */
static void write_component(const Fit *fit, size_t c, double scale, Projection *projection) {
    const size_t to = (size_t)projection->to;
    float largest = 0;
    for (size_t j = 0; j < fit->columns; j++) {
        double sum = 0;
        for (size_t a = 0; a < fit->width; a++) sum += fit->basis[j * fit->width + a] * gsl_matrix_get(fit->axes, a, c);
        const float number = projection->rows[j * to + c] = (float)(scale * sum);
        if (fabsf(number) > fabsf(largest)) largest = number;
    }
    double centre = 0;
    for (size_t j = 0; j < fit->columns; j++) {
        if (largest < 0) projection->rows[j * to + c] *= -1;
        centre += fit->covariance.mean[j] * (double)projection->rows[j * to + c];
    }
    projection->centre[c] = (float)centre;
}

static void write_components(const Fit *fit, Projection *projection) {
    const size_t to = (size_t)projection->to;
    memset(projection->rows, 0, fit->columns * to * sizeof *projection->rows);
    memset(projection->centre, 0, to * sizeof *projection->centre);
    /* Below FLT_MIN^2 the scaled direction would overflow float. */
    const double least = fmax(least_variance * gsl_vector_get(fit->variances, 0), (double)FLT_MIN * (double)FLT_MIN);
    for (size_t c = 0; c < to; c++) {
        const double variance = gsl_vector_get(fit->variances, c);
        if (variance > least) write_component(fit, c, 1 / sqrt(variance), projection);
    }
}

static void fit_components(Fit *fit, uint64_t seed) {
    start(fit, seed);
    for (int pass = 0; pass <= POWER_ITERATIONS; pass++) {
        if (pass > 0) memcpy(fit->basis, fit->image, fit->columns * fit->width * sizeof *fit->basis);
        orthonormalise(fit);
        sparse_covariance_multiply(&fit->covariance, fit->basis, fit->image);
    }
    find_axes(fit);
}

bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error) {
    if (rows->rows < 1 || rows->columns < 1 || projection->from != rows->columns || projection->to < 1)
        return error_input(error, "principal components", "%d rows of %d columns for a projection of %d to %d",
                           rows->rows, rows->columns, projection->from, projection->to);
    Fit fit;
    const bool ok = fit_make(&fit, rows, projection->to, error);
    if (ok) {
        fit_components(&fit, seed);
        write_components(&fit, projection);
    }
    fit_free(&fit);
    return ok;
}

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
static Slot *find_slots(const SlotSamples *samples, int *count, Error *error) {
    size_t contacts = 0;
    for (int i = 0; i < samples->count; i++) contacts += (size_t)samples->items[i].problem.contact_count;
    Slot *slots = malloc((contacts + 1) * sizeof *slots);
    if (slots == NULL) {
        error_memory(error, "slots");
        return NULL;
    }
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
static void find_caps(SlotNetwork *network, const SlotSamples *samples) {
    for (int i = 0; i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].problem;
        for (int k = 0; samples->items[i].since == 0 && k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            const int slot = slot_network_find(network, contact->a, contact->b, scene_view_feature(problem, contact));
            if (slot >= 0 && network->cap[slot] < contact->warm_normal) network->cap[slot] = contact->warm_normal;
        }
    }
}

/* The unit of a slot's outputs: mean(sqrt(|goal - base|))^2. Rare shocks are hundreds of times larger than the rest; in
   a unit such as the RMS the rest would be negligible. */
static bool find_scales(SlotNetwork *network, const SlotSamples *samples) {
    double *sums = calloc(2 * (size_t)network->slot_count, sizeof *sums);
    if (sums == NULL) return false;
    double *counts = sums + network->slot_count;
    for (int i = 0; i < samples->count; i++) {
        const SlotSample *sample = &samples->items[i];
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

static bool make_numbers(Numbers *numbers, const SlotSamples *samples, size_t each) {
    const size_t rows = (size_t)samples->count;
    *numbers = (Numbers){malloc((rows + 1) * sizeof(int64_t)), malloc((rows * each + 1) * sizeof(int32_t)),
                         malloc((rows * each + 1) * sizeof(float)), 0};
    return numbers->begin != NULL && numbers->column != NULL && numbers->value != NULL;
}

static void append(Numbers *numbers, int column, float value) {
    numbers->column[numbers->count] = column;
    numbers->value[numbers->count++] = value;
}

static bool touches_bomb(const SlotNetwork *network, int slot) {
    return network->slots[slot].a == network->bomb || network->slots[slot].b == network->bomb;
}

static bool fit(Numbers *numbers, const SlotSamples *samples, uint64_t seed, Projection *projection, Error *error) {
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
static void find_units(const SlotSamples *samples, bool bomb, int count, float *units) {
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

static bool fit_body_projections(SlotNetwork *network, const SlotSamples *samples, Numbers *numbers, uint64_t seed,
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
            for (int k = 0; k < count; k++) append(numbers, k, units[k] * (p == 0 ? view->bomb[k] : view->state[k]));
        }
        bool ok = fit(numbers, samples, seed, projections[p], error);
        for (int k = 0; k < count; k++) weigh_row(projections[p], k, units[k]);
        free(units);
        if (!ok) return false;
    }
    return true;
}

static bool fit_contact_projections(SlotNetwork *network, const SlotSamples *samples, Numbers *numbers, uint64_t seed,
                                    Error *error) {
    for (int i = 0; i < samples->count; i++) {
        const SlotView *slots = &samples->items[i].view.slots;
        numbers->begin[i] = numbers->count;
        for (int k = 0; k < slots->slot_count; k++)
            append(numbers, slots->slots[k], touches_bomb(network, slots->slots[k]) ? bomb_weight : 1);
    }
    if (!fit(numbers, samples, seed, &network->present, error)) return false;
    for (int slot = 0; slot < network->slot_count; slot++)
        if (touches_bomb(network, slot)) weigh_row(&network->present, slot, bomb_weight);
    for (int i = 0; i < samples->count; i++) {
        const SlotView *slots = &samples->items[i].view.slots;
        numbers->begin[i] = numbers->count;
        for (int k = 0; k < 2 * slots->slot_count; k++) append(numbers, slots->impulses[k], slots->warm[k]);
    }
    return fit(numbers, samples, seed, &network->warm, error);
}

static bool find_projections(SlotNetwork *network, const SlotSamples *samples, uint64_t seed, Error *error) {
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

static void draw(float *numbers, size_t count, double spread, gsl_rng *generator) {
    for (size_t i = 0; i < count; i++) numbers[i] = (float)gsl_ran_gaussian(generator, spread);
}

/* Hidden layers preserve the variance of their inputs (Glorot, Bengio 2010); the last layer starts with outputs near
   0. */
static bool draw_weights(SlotNetwork *network, uint64_t seed) {
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return false;
    gsl_rng_set(generator, (unsigned long)seed);
    const size_t inputs = (size_t)slot_network_inputs(network), hidden = (size_t)slot_network_hidden(network);
    draw(network->first.rows, inputs * hidden, 1 / sqrt((double)inputs), generator);
    draw(network->second.rows, hidden * hidden, 1 / sqrt((double)hidden), generator);
    draw(network->rows, 2 * (size_t)network->slot_count * hidden, 0.1 / sqrt((double)hidden), generator);
    gsl_rng_free(generator);
    return true;
}

/* Packing the projections to bytes shifted the means of the inputs; moves them back to 0. */
static void recentre(SlotNetwork *network, const SlotSamples *samples) {
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int p = 0, input = 0; p < 4; p++)
        for (int k = 0; k < projections[p]->to; k++, input++) {
            double sum = 0;
            for (int i = 0; i < samples->count; i++) sum += (double)samples->items[i].inputs[input];
            projections[p]->centre[k] += (float)(sum / samples->count);
        }
}

SlotNetwork *slot_network_from_samples(SlotSamples *samples, const SlotWidths *widths, uint64_t seed, Error *error) {
    if (samples->count == 0) {
        error_input(error, "scene-net", "no launch has an impact whose residual reaches the gate");
        return NULL;
    }
    const ContactProblem *problem = &samples->items[0].problem;
    SlotShape shape = {problem->body_count, problem->marked, 0, widths->state, widths->present,
                       widths->warm,        widths->hidden};
    Slot *slots = find_slots(samples, &shape.slot_count, error);
    SlotNetwork *network = slots != NULL ? slot_network_create(&shape, slots, error) : NULL;
    free(slots);
    if (network == NULL) return NULL;
    find_caps(network, samples);
    bool ok = slot_samples_compute_inputs(samples, 0, network, error) &&
              (find_scales(network, samples) || error_memory(error, "scene-net")) &&
              find_projections(network, samples, seed, error) &&
              (draw_weights(network, seed) || error_memory(error, "scene-net"));
    if (ok) slot_network_pack(network);
    ok = ok && slot_samples_compute_inputs(samples, 0, network, error);
    if (ok) recentre(network, samples);
    if (ok && slot_samples_compute_inputs(samples, 0, network, error)) return network;
    slot_network_destroy(network);
    return NULL;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_subset.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* Copies items of `size` bytes; NULL stays NULL. */
static bool copy(void **to, const void *from, size_t count, size_t size) {
    if (from == NULL) return true;
    *to = malloc((count + 1) * size);
    if (*to != NULL) memcpy(*to, from, count * size);
    return *to != NULL;
}

static bool copy_launches(Dataset *to, const Dataset *from) {
    const size_t count = (size_t)from->launches;
    return copy((void **)&to->launch_scene, from->launch_scene, count, sizeof *to->launch_scene) &&
           copy((void **)&to->launch_x, from->launch_x, count, sizeof *to->launch_x) &&
           copy((void **)&to->launch_rotation, from->launch_rotation, count, sizeof *to->launch_rotation) &&
           copy((void **)&to->launch_spin, from->launch_spin, count, sizeof *to->launch_spin) &&
           copy((void **)&to->launch_test, from->launch_test, count, sizeof *to->launch_test);
}

static bool is_kept(const Dataset *dataset, const bool *keep, int64_t row) {
    return dataset_is_test(dataset, row) || keep[dataset->launch[row]];
}

/* Copies the kept rows of an array with `size` bytes per row. */
static bool copy_rows(void **to, const void *from, const Dataset *dataset, const bool *keep, int64_t kept,
                      size_t size) {
    if (from == NULL) return true;
    char *at = *to = malloc((size_t)kept * size);
    if (at == NULL) return false;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!is_kept(dataset, keep, row)) continue;
        memcpy(at, (const char *)from + (size_t)row * size, size);
        at += size;
    }
    return true;
}

static bool copy_all_rows(Dataset *to, const Dataset *from, const bool *keep) {
    const int64_t kept = to->rows;
    const size_t inputs = (size_t)dataset_inputs(from), changes = (size_t)pair_change_count(from->target);
    return copy_rows((void **)&to->inputs, from->inputs, from, keep, kept, inputs * sizeof *to->inputs) &&
           copy_rows((void **)&to->changes, from->changes, from, keep, kept, changes * sizeof *to->changes) &&
           copy_rows((void **)&to->context, from->context, from, keep, kept, PAIR_CONTEXT * sizeof *to->context) &&
           copy_rows((void **)&to->launch, from->launch, from, keep, kept, sizeof *to->launch) &&
           copy_rows((void **)&to->frame, from->frame, from, keep, kept, sizeof *to->frame) &&
           copy_rows((void **)&to->bodies, from->bodies, from, keep, kept, 2 * sizeof *to->bodies);
}

Dataset *dataset_subset(const Dataset *dataset, const bool *keep, Error *error) {
    int64_t kept = 0, train = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        kept += is_kept(dataset, keep, row);
        train += is_kept(dataset, keep, row) && !dataset_is_test(dataset, row);
    }
    if (train == 0) return error_input(error, "dataset", "no rows are left to train on"), NULL;
    Dataset *subset = malloc(sizeof *subset);
    if (subset == NULL) return error_memory(error, "dataset"), NULL;
    *subset = *dataset;
    subset->rows = kept;
    subset->inputs = subset->changes = subset->context = NULL;
    subset->launch = subset->frame = subset->bodies = subset->launch_scene = NULL;
    subset->launch_x = subset->launch_rotation = subset->launch_spin = NULL;
    subset->launch_test = NULL;
    if (copy_launches(subset, dataset) && copy_all_rows(subset, dataset, keep)) return subset;
    dataset_destroy(subset);
    return error_memory(error, "dataset"), NULL;
}

/* Writes the indices of training launches with rows to order[launches]; returns their number. */
static int list_launches(const Dataset *dataset, bool *has_rows, int *order) {
    int count = 0;
    for (int64_t row = 0; row < dataset->rows; row++) has_rows[dataset->launch[row]] = !dataset_is_test(dataset, row);
    for (int i = 0; i < dataset->launches; i++)
        if (has_rows[i]) order[count++] = i;
    return count;
}

static bool draw(const Dataset *dataset, int count, uint64_t seed, bool *keep, int *order, Error *error) {
    const int launches = list_launches(dataset, keep, order);
    if (count < 1 || count > launches)
        return error_input(error, "dataset", "%d training launches requested; expected 1 to %d", count, launches);
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return error_memory(error, "dataset");
    gsl_rng_set(generator, (unsigned long)seed);
    gsl_ran_shuffle(generator, order, (size_t)launches, sizeof *order);
    gsl_rng_free(generator);
    memset(keep, 0, (size_t)dataset->launches * sizeof *keep);
    for (int i = 0; i < count; i++) keep[order[i]] = true;
    return true;
}

Dataset *dataset_draw_subset(const Dataset *dataset, int count, uint64_t seed, Error *error) {
    bool *keep = calloc((size_t)dataset->launches, sizeof *keep);
    int *order = malloc((size_t)dataset->launches * sizeof *order);
    Dataset *subset = NULL;
    if (keep == NULL || order == NULL)
        error_memory(error, "dataset");
    else if (draw(dataset, count, seed, keep, order, error))
        subset = dataset_subset(dataset, keep, error);
    free(order);
    free(keep);
    return subset;
}

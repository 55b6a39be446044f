/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The slopes of the loss of sain, and that training and run time give the same answers. */
#include "testing.h"

#include "base/base.h"
#include "base/random.h"
#include "learning/sain_training.h"

enum { SAMPLES = 40, ROWS = 3 * SAMPLES };

/* Any samples: body i has 1 to 5 rows. */
typedef struct Any {
    SainSample items[SAMPLES];
    SainRowInputs rows[5 * SAMPLES];
    int order[SAMPLES];
    SainSamples samples;
    SainNetwork network;
    double *weights;
    int weight_count;
} Any;

static void fill(Any *any) {
    Error error = {0};
    uint64_t state = 5;
    any->samples = (SainSamples){.items = any->items, .rows = any->rows};
    for (int i = 0; i < SAMPLES; i++) {
        SainSample *sample = &any->items[i];
        sample->first = (int)any->samples.row_count;
        sample->rows = 1 + i % 5;
        sample->scale = (float)(1.5 + random_signed(&state));
        for (int k = 0; k < SAIN_BODY_INPUTS; k++) sample->body[k] = (float)random_signed(&state);
        for (int k = 0; k < SAIN_OUTPUTS; k++) sample->target[k] = (float)random_signed(&state);
        for (int r = 0; r < sample->rows; r++)
            for (int k = 0; k < SAIN_PAIR_INPUTS; k++)
                any->rows[any->samples.row_count + (size_t)r].numbers[k] = (float)random_signed(&state);
        any->samples.row_count += (size_t)sample->rows;
        any->order[i] = SAMPLES - 1 - i;
    }
    any->samples.count = SAMPLES;
    any->samples.problems = 1;
    assert_ok(sain_network_create(&any->network, &error), error);
    sain_normalise(&any->network, &any->samples, true);
    any->weight_count = sain_weight_count(&any->network);
    any->weights = calloc((size_t)any->weight_count, sizeof *any->weights);
    assert_non_null(any->weights);
    sain_first_weights(&any->network, 3, any->weights);
    for (int i = 0; i < any->weight_count; i++) any->weights[i] += 0.1 * random_signed(&state);
}

static void clear(Any *any) {
    sain_network_destroy(&any->network);
    free(any->weights);
}

TEST(slopes_are_finite_differences) {
    static Any any;
    SainLoss loss = {0};
    fill(&any);
    assert_ok(sain_loss_begin(&loss, &any.network, &error), error);
    const SainPart part = {&any.samples, any.order, SAMPLES};
    double *slopes = calloc((size_t)any.weight_count, sizeof *slopes),
           *unused = calloc((size_t)any.weight_count, sizeof *unused);
    assert_true(slopes != NULL && unused != NULL);
    double sum = 0;
    assert_true(sain_loss_add(&loss, &part, any.weights, &sum, slopes));
    const double step = 1e-6;
    for (int i = 0; i < any.weight_count; i += 37) {
        double more = 0, less = 0;
        const double kept = any.weights[i];
        any.weights[i] = kept + step;
        assert_true(sain_loss_add(&loss, &part, any.weights, &more, unused));
        any.weights[i] = kept - step;
        assert_true(sain_loss_add(&loss, &part, any.weights, &less, unused));
        any.weights[i] = kept;
        assert_near(slopes[i], (more - less) / (2 * step), 1e-6 + 1e-5 * fabs(slopes[i]));
    }
    free(slopes);
    free(unused);
    sain_loss_free(&loss);
    clear(&any);
}

RUN_TESTS(NULL, NULL)

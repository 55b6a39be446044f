/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Slopes through 32 predictions are finite differences of the loss; the stored predictor is the trained one. */
#include "owned.h"

#include "engine/uniform.h"
#include "learning/subspace_fit.h"

enum { LAUNCHES = 3, STATES = 40, COMPONENTS = 3, HIDDEN = 16 };

typedef struct Case {
    PoseRows rows;
    float components[LAUNCHES * STATES * COMPONENTS], launch[LAUNCHES * SUBSPACE_LAUNCH];
    float low[COMPONENTS], high[COMPONENTS];
    double linear[2 * COMPONENTS];
    WindowData data;
} Case;

/* Swings of three frequencies. */
static void make(Case *c) {
    *c = (Case){.rows = {.launches = LAUNCHES, .states = STATES}};
    for (int l = 0; l < LAUNCHES; l++) {
        for (int j = 0; j < SUBSPACE_LAUNCH; j++)
            c->launch[l * SUBSPACE_LAUNCH + j] = (float)(j < 2 ? l * (j + 1) : 50);
        for (int s = 0; s < STATES; s++)
            for (int k = 0; k < COMPONENTS; k++)
                c->components[(l * STATES + s) * COMPONENTS + k] = (float)sin(0.1 * (k + 1) * s + l);
    }
    for (int k = 0; k < COMPONENTS; k++) c->low[k] = -1.2f, c->high[k] = 1.2f;
    c->rows.launch = c->launch;
    c->data = (WindowData){&c->rows, c->components, COMPONENTS, COMPONENTS, c->linear, c->low, c->high};
}

static WindowFit *fit_of(Case *c) {
    Error error = {0};
    WindowFit *fit = window_fit_create(&c->data, HIDDEN, &error);
    assert_ok(fit != NULL, error);
    return fit;
}

/* sin(w s + p) = 2 cos(w) sin(w (s - 1) + p) - sin(w (s - 2) + p) */
TEST(the_linear_term_of_a_swing) {
    static Case c;
    make(&c);
    window_linear(&c.data, c.linear);
    for (int k = 0; k < COMPONENTS; k++) {
        assert_near(c.linear[k], 2 * cos(0.1 * (k + 1)), 1e-4);
        assert_near(c.linear[COMPONENTS + k], -1, 1e-4);
    }
}

/* With a linear term that is off, so that errors are not small and some states are clamped. */
TEST(slopes_are_differences) {
    static Case c;
    make(&c);
    for (int k = 0; k < COMPONENTS; k++) c.linear[k] = 1.7, c.linear[COMPONENTS + k] = -0.7;
    WindowFit *fit = fit_of(&c);
    const int count = network_parameter_count(fit->shape);
    double *parameters = calloc(3 * (size_t)count, sizeof *parameters), *slopes = parameters + count;
    assert_non_null(parameters);
    window_fit_begin(fit, 1, parameters);
    window_fit_slopes(fit, parameters, 9, slopes);
    for (int i = 0; i < count; i += count / 7) {
        const double step = 1e-6, start = parameters[i];
        parameters[i] = start + step;
        const double above = window_fit_slopes(fit, parameters, 9, slopes + count);
        parameters[i] = start - step;
        const double below = window_fit_slopes(fit, parameters, 9, slopes + count);
        parameters[i] = start;
        assert_near(slopes[i], (above - below) / (2 * step), 1e-4 * (fabs(slopes[i]) + 0.01));
    }
    free(parameters);
    window_fit_destroy(fit);
}

/* Of one prediction, by the network of the training with its scales. */
TEST(the_stored_predictor_is_the_trained_one) {
    static Case c;
    make(&c);
    window_linear(&c.data, c.linear);
    c.linear[0] = 0.5;
    WindowFit *fit = fit_of(&c);
    const WindowScales *scales = &fit->scales;
    const Network *shape = fit->shape;
    FREED double *parameters = calloc((size_t)network_parameter_count(shape), sizeof *parameters);
    assert_non_null(parameters);
    window_fit_begin(fit, 4, parameters);
    NetworkBlock *block = network_block_create(shape, &error);
    assert_ok(block != NULL, error);
    const SubspaceShape sizes = {
        .bodies = 2, .components = COMPONENTS, .hidden = HIDDEN, .predictor_count = 1, .predictors = {COMPONENTS}};
    OWN(SubspaceNet) *net = subspace_net_create(&sizes, &error);
    assert_ok(net != NULL, error);
    for (int k = 0; k < COMPONENTS; k++) net->low[k] = -100, net->high[k] = 100;
    window_fit_store(fit, parameters, &net->predictors[0]);
    OWN(Subspace) subspace;
    assert_ok(subspace_make(&subspace, net, &net->predictors[0], true, &error), error);
    const float last[] = {0.2f, 0.3f, -0.4f}, now[] = {0.25f, 0.2f, -0.5f}, launch[SUBSPACE_LAUNCH] = {1.5f, 2, 50, 50};
    for (int k = 0; k < COMPONENTS; k++) {
        subspace.last[k] = last[k], subspace.now[k] = now[k];
        block->values[0][k * BLOCK_ROWS] = (double)now[k] * scales->value[k];
        block->values[0][(COMPONENTS + k) * BLOCK_ROWS] = ((double)now[k] - (double)last[k]) * scales->change[k];
    }
    for (int j = 0; j < SUBSPACE_LAUNCH; j++)
        block->values[0][(2 * COMPONENTS + j) * BLOCK_ROWS] =
            ((double)launch[j] - scales->launch_offset[j]) * scales->launch[j];
    network_forward(block, parameters);
    subspace_step(&subspace, launch);
    for (int k = 0; k < COMPONENTS; k++)
        assert_near(subspace.now[k],
                    c.linear[k] * (double)now[k] + c.linear[COMPONENTS + k] * (double)last[k] +
                        scales->output[k] * block->values[3][k * BLOCK_ROWS],
                    1e-5);
    network_block_destroy(block);
    window_fit_destroy(fit);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training_internal.h"

#include <omp.h>

/* More blocks than chunks, and a partly filled last block. */
enum { ROWS = 6000 };

/* For checks that take long per row. */
enum { FEW_ROWS = 500 };

typedef struct Case {
    Dataset *dataset;
    Laws *laws; /* NULL: without */
    Network *network;
    Samples *train;
    Loss *loss;
    GaussNewton *gauss_newton;
    int count;
    double *parameters;
} Case;

static Case make_case_of(Dataset *dataset, LossKind kind, int layers, const int *widths, Activation hidden,
                         Activation last, OutputScale scale) {
    Error error = {0};
    Case made = {.dataset = dataset, .network = network_sized(layers, widths)};
    for (int l = 0; l < layers; l++) made.network->activations[l] = l < layers - 1 ? hidden : last;
    samples_fit_normalisation(made.dataset, scale, made.network);
    made.train = samples_create(made.dataset, made.network, false, &error);
    made.loss = loss_create(made.network, kind, &error);
    made.gauss_newton = gauss_newton_create(made.network, &error);
    assert_ok(made.train != NULL && made.loss != NULL && made.gauss_newton != NULL, error);
    made.count = network_parameter_count(made.network);
    made.parameters = malloc((size_t)made.count * sizeof(double));
    assert_non_null(made.parameters);
    uint32_t sequence = 21;
    for (int p = 0; p < made.count; p++) made.parameters[p] = (double)next_number(&sequence);
    return made;
}

static Case make_case(int layers, const int *widths, Activation hidden, Activation last, OutputScale scale) {
    return make_case_of(make_taught_dataset(ROWS), LOSS_MSE, layers, widths, hidden, last, scale);
}

static void free_case(Case *made) {
    free(made->parameters);
    laws_destroy(made->laws);
    gauss_newton_destroy(made->gauss_newton);
    loss_destroy(made->loss);
    samples_destroy(made->train);
    network_destroy(made->network);
    dataset_destroy(made->dataset);
}

OWNED_VALUE(Case, free_case)

static double *numbers(size_t count) {
    double *made = calloc(count, sizeof *made);
    assert_non_null(made);
    return made;
}

static size_t residual_count(const Case *made) {
    return (size_t)made->train->blocks * (size_t)made->train->outputs * BLOCK_ROWS;
}

static void check_gradient(Case made) {
    const double step = 1e-5;
    FREED double *gradient = numbers((size_t)made.count);
    double value = loss_gradient(made.loss, made.train, made.laws, made.parameters, gradient);
    assert_true(value == loss_value(made.loss, made.train, made.laws, made.parameters));
    for (int p = 0; p < made.count; p++) {
        double kept = made.parameters[p];
        made.parameters[p] = kept + step;
        double above = loss_value(made.loss, made.train, made.laws, made.parameters);
        made.parameters[p] = kept - step;
        double slope = (above - loss_value(made.loss, made.train, made.laws, made.parameters)) / (2 * step);
        made.parameters[p] = kept;
        assert_near(gradient[p], slope, 1e-9 + 1e-6 * fabs(slope));
    }
    free_case(&made);
}

/* With these numbers no row is within a step of a rectifier's kink, so the tolerance need not allow for one. */
TEST(gradient_of_the_loss_is_the_finite_difference) {
    const Activation hidden[] = {ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU};
    for (int h = 0; h < 3; h++) {
        const int widths[] = {10, 5, 2};
        check_gradient(make_case(2, widths, hidden[h], ACTIVATION_SIGMOID, SCALE_MINMAX));
        check_gradient(make_case(2, widths, hidden[h], ACTIVATION_LINEAR, SCALE_MINMAX));
        check_gradient(make_case(2, widths, hidden[h], ACTIVATION_LINEAR, SCALE_STANDARD));
    }
}

/* Errors are on both sides of the threshold of 0.3. */
TEST(gradient_of_the_smooth_loss_is_the_finite_difference) {
    const int widths[] = {10, 5, 2};
    for (int scale = 0; scale < 2; scale++) {
        Case made = make_case_of(make_taught_dataset(FEW_ROWS), LOSS_SMOOTH_L1, 2, widths, ACTIVATION_TANH,
                                 ACTIVATION_LINEAR, scale == 0 ? SCALE_MINMAX : SCALE_STANDARD);
        Loss *mse = loss_create(made.network, LOSS_MSE, &error);
        assert_ok(mse != NULL, error);
        const double smooth = loss_value(made.loss, made.train, NULL, made.parameters);
        assert_true(smooth < 0.95 * loss_value(mse, made.train, NULL, made.parameters) && smooth > 1e-3);
        loss_destroy(mse);
        check_gradient(made);
    }
}

/* Each law alone with mse, and all laws with smooth-l1. */
TEST(gradient_of_the_laws_is_the_finite_difference) {
    const int widths[] = {10, 4, 6};
    for (int law = 0; law <= LAWS; law++) {
        LawNumbers weights;
        Case made = make_case_of(make_pushed_dataset(FEW_ROWS), law < LAWS ? LOSS_MSE : LOSS_SMOOTH_L1, 2, widths,
                                 ACTIVATION_TANH, ACTIVATION_LINEAR, law % 2 == 0 ? SCALE_STANDARD : SCALE_MINMAX);
        assert_ok(law_weights_named(law < LAWS ? laws_known[law].name : "all", 2, &weights, &error), error);
        made.laws = laws_create(made.dataset, made.network, &weights, &error);
        assert_ok(made.laws != NULL, error);
        const double without = loss_value(made.loss, made.train, NULL, made.parameters);
        assert_true(loss_value(made.loss, made.train, made.laws, made.parameters) > 1.05 * without);
        check_gradient(made);
    }
}

TEST(squared_residuals_sum_to_the_loss) {
    OWN(Case) made = make_case(2, (const int[]){10, 5, 2}, ACTIVATION_SIGMOID, ACTIVATION_SIGMOID, SCALE_MINMAX);
    size_t count = residual_count(&made);
    double *residuals = numbers(count), sum = 0;
    loss_residuals(made.loss, made.train, made.parameters, residuals);
    for (size_t i = 0; i < count; i++) sum += residuals[i] * residuals[i];
    assert_near(sum / (double)(made.train->rows * 2), loss_value(made.loss, made.train, NULL, made.parameters), 1e-12);
    free(residuals);
}

/* Column p of J [residuals, parameters], by central differences. */
static void fill_jacobian(Case *made, double *jacobian, size_t count) {
    const double step = 1e-4;
    FREED double *above = numbers(count);
    for (int p = 0; p < made->count; p++) {
        double kept = made->parameters[p], *column = jacobian + (size_t)p * count;
        made->parameters[p] = kept + step;
        loss_residuals(made->loss, made->train, made->parameters, above);
        made->parameters[p] = kept - step;
        loss_residuals(made->loss, made->train, made->parameters, column);
        made->parameters[p] = kept;
        for (size_t i = 0; i < count; i++) column[i] = (above[i] - column[i]) / (2 * step);
    }
}

static double dot(const double *a, const double *b, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* An entry is a sum over 10^4 residuals; differences with step 1e-4 are accurate to 1e-8 each. */
static void check_gauss_newton(int layers, const int *widths, Activation hidden, Activation last, OutputScale scale) {
    OWN(Case) made = make_case(layers, widths, hidden, last, scale);
    size_t count = residual_count(&made), size = (size_t)made.count;
    FREED double *jacobian = numbers(size * count), *u = numbers(count), *jtu = numbers(size),
                 *jtj = numbers(size * size);
    fill_jacobian(&made, jacobian, count);
    loss_residuals(made.loss, made.train, made.parameters, u);
    gauss_newton_sum(made.gauss_newton, made.train, made.parameters, u, jtu, jtj);
    for (size_t p = 0; p < size; p++) {
        assert_near(jtu[p], dot(jacobian + p * count, u, count), 1e-4);
        for (size_t q = 0; q <= p; q++)
            assert_near(jtj[p * size + q], dot(jacobian + p * count, jacobian + q * count, count), 1e-4);
    }
}

TEST(gauss_newton_is_that_of_the_jacobian) {
    const Activation sigmoid = ACTIVATION_SIGMOID, linear = ACTIVATION_LINEAR;
    check_gauss_newton(1, (const int[]){10, 2}, sigmoid, sigmoid, SCALE_MINMAX);
    check_gauss_newton(2, (const int[]){10, 3, 2}, sigmoid, sigmoid, SCALE_MINMAX);
    check_gauss_newton(3, (const int[]){10, 2, 3, 6}, sigmoid, linear, SCALE_STANDARD);
    check_gauss_newton(2, (const int[]){10, 3, 2}, ACTIVATION_TANH, linear, SCALE_MINMAX);
}

/* J^T u must also be the same if J^T J is not requested. */
TEST(sums_do_not_depend_on_threads) {
    OWN(Case) made = make_case(2, (const int[]){10, 5, 2}, ACTIVATION_SIGMOID, ACTIVATION_SIGMOID, SCALE_MINMAX);
    size_t size = (size_t)made.count;
    FREED double *u = numbers(residual_count(&made)), *gradient = numbers(2 * size), *jtu = numbers(2 * size);
    double *jtj = numbers(2 * size * size), value[2];
    int threads = omp_get_max_threads();
    loss_residuals(made.loss, made.train, made.parameters, u);
    for (size_t i = 0; i < 2; i++) {
        omp_set_num_threads(i == 0 ? 1 : 3);
        value[i] = loss_gradient(made.loss, made.train, NULL, made.parameters, gradient + i * size);
        gauss_newton_sum(made.gauss_newton, made.train, made.parameters, u, jtu + i * size, jtj + i * size * size);
    }
    omp_set_num_threads(threads);
    assert_true(value[0] == value[1]);
    assert_memory_equal(gradient, gradient + size, size * sizeof(double));
    assert_memory_equal(jtu, jtu + size, size * sizeof(double));
    assert_memory_equal(jtj, jtj + size * size, size * size * sizeof(double));
    gauss_newton_sum(made.gauss_newton, made.train, made.parameters, u, jtu + size, NULL);
    assert_memory_equal(jtu, jtu + size, size * sizeof(double));
    free(jtj);
}

RUN_TESTS(NULL, NULL)

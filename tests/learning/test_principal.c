/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components by their definition. */
#include "testing.h"

#include "engine/uniform.h"
#include "learning/principal.h"

#include <omp.h>

/* Points at +-(a, a) and +-(b, -b) about a centre: the moments have 2 (2 a^2) along (1, 1) and 2 (2 b^2) along
   (1, -1). */
TEST(two_by_two_in_closed_form) {
    const float rows[] = {5 + 3, 1 + 3, 5 - 3, 1 - 3, 5 + 1, 1 - 1, 5 - 1, 1 + 1};
    const PrincipalRows of = {rows, 4, 2, 1};
    double mean[2], values[2], vectors[4];
    principal_mean(&of, mean);
    assert_near(mean[0], 5, 1e-15);
    assert_near(mean[1], 1, 1e-15);
    assert_ok(principal_components(&of, mean, values, vectors, &error), error);
    assert_near(values[0], 36, 1e-12);
    assert_near(values[1], 4, 1e-12);
    assert_near(vectors[0], sqrt(0.5), 1e-15);
    assert_near(vectors[1], sqrt(0.5), 1e-15);
    assert_near(fabs(vectors[2] - vectors[3]), sqrt(2), 1e-15);
}

/* Rows in a space of few dimensions, so that most values are 0, as of poses at rest: moments times a direction are the
   value times the direction; directions are orthonormal. The same bits for any number of threads. */
TEST(many_columns_are_taken_apart) {
    enum { COLUMNS = 40, ROWS = 90, RANK = 12 };
    static float rows[ROWS * COLUMNS];
    static double centre[COLUMNS], values[COLUMNS], vectors[COLUMNS * COLUMNS], again[COLUMNS],
        others[sizeof vectors / sizeof *vectors];
    uint32_t seed = 5;
    for (int k = 0; k < RANK; k++) {
        float u[COLUMNS];
        for (int j = 0; j < COLUMNS; j++) u[j] = uniform(&seed, -1, 1) * (float)(k + 1);
        for (int r = 0; r < ROWS; r++) {
            const float share = uniform(&seed, -1, 1);
            for (int j = 0; j < COLUMNS; j++) rows[r * COLUMNS + j] += share * u[j];
        }
    }
    for (int j = 0; j < COLUMNS; j++) centre[j] = 0.1 * j;
    for (int r = 0; r < ROWS; r++)
        for (int j = 0; j < COLUMNS; j++) rows[r * COLUMNS + j] += (float)centre[j];
    const int threads = omp_get_max_threads();
    const PrincipalRows of = {rows, ROWS, COLUMNS, 7};
    omp_set_num_threads(1);
    assert_ok(principal_components(&of, centre, values, vectors, &error), error);
    omp_set_num_threads(3);
    assert_ok(principal_components(&of, centre, again, others, &error), error);
    omp_set_num_threads(threads);
    assert_memory_equal(values, again, sizeof values);
    assert_memory_equal(vectors, others, sizeof vectors);
    for (int k = 0; k < COLUMNS; k++) {
        const double *v = vectors + k * COLUMNS;
        double product[COLUMNS] = {0}, largest = 0;
        for (int j = 0; j < COLUMNS; j++) largest = fabs(v[j]) > fabs(largest) ? v[j] : largest;
        assert_true(largest > 0);
        if (k > 0) assert_true(values[k] <= values[k - 1]);
        if (k >= RANK) assert_near(values[k], 0, 1e-6 * values[0]);
        for (int r = 0; r < ROWS; r++) {
            double along = 0;
            for (int j = 0; j < COLUMNS; j++) along += ((double)rows[r * COLUMNS + j] - centre[j]) * v[j];
            for (int j = 0; j < COLUMNS; j++) product[j] += along * ((double)rows[r * COLUMNS + j] - centre[j]);
        }
        for (int i = 0; i < COLUMNS; i++) {
            double dot = 0;
            for (int j = 0; j < COLUMNS; j++) dot += vectors[i * COLUMNS + j] * v[j];
            assert_near(product[i], values[k] * v[i], 1e-9 * values[0]);
            assert_near(dot, i == k, 1e-12);
        }
    }
}

TEST(what_is_not_finite_is_refused) {
    const float rows[] = {1, 2, 3, NAN};
    const double centre[2] = {0};
    double values[2], vectors[4];
    assert_refused(principal_components(&(PrincipalRows){rows, 2, 2, 1}, centre, values, vectors, &error),
                   "a number is NaN or infinite");
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eigenvectors by their definition. */
#include "testing.h"

#include "engine/uniform.h"
#include "learning/learning.h"

TEST(two_by_two_in_closed_form) {
    double matrix[4] = {2, 1, 1, 2}, values[2], vectors[4];
    assert_true(symmetric_eigenvectors(matrix, 2, values, vectors));
    assert_near(values[0], 3, 1e-15);
    assert_near(values[1], 1, 1e-15);
    assert_near(vectors[0], sqrt(0.5), 1e-15);
    assert_near(vectors[1], sqrt(0.5), 1e-15);
    assert_near(fabs(vectors[2] - vectors[3]), sqrt(2), 1e-15);
}

/* Of a sum of few outer products, so that most values are 0, as of poses at rest. */
TEST(a_large_matrix_is_taken_apart) {
    enum { SIZE = 40, RANK = 12 };
    static double matrix[SIZE * SIZE], copy[SIZE * SIZE], vectors[SIZE * SIZE], values[SIZE];
    uint32_t seed = 5;
    for (int k = 0; k < RANK; k++) {
        double u[SIZE];
        for (int i = 0; i < SIZE; i++) u[i] = (double)uniform(&seed, -1, 1) * (k + 1);
        for (int i = 0; i < SIZE * SIZE; i++) matrix[i] += u[i / SIZE] * u[i % SIZE];
    }
    memcpy(copy, matrix, sizeof copy);
    assert_true(symmetric_eigenvectors(matrix, SIZE, values, vectors));
    for (int k = 0; k < SIZE; k++) {
        const double *v = vectors + k * SIZE;
        if (k > 0) assert_true(values[k] <= values[k - 1]);
        if (k >= RANK) assert_near(values[k], 0, 1e-9);
        for (int i = 0; i < SIZE; i++) {
            double product = 0, dot = 0;
            for (int j = 0; j < SIZE; j++) product += copy[i * SIZE + j] * v[j], dot += vectors[i * SIZE + j] * v[j];
            assert_near(product, values[k] * v[i], 1e-9);
            assert_near(dot, i == k, 1e-12);
        }
    }
}

RUN_TESTS(NULL, NULL)

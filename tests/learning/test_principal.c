/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components against their definition, and against the eigenvalues of small covariances. */
#include "testing.h"

#include "learning/scene_training_internal.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <omp.h>

/* Sparse rows with capacity for dense ones. */
typedef struct Table {
    SparseRows sparse;
    int64_t *begin;
    int32_t *column;
    float *value;
} Table;

/* Memory of all tests, which free_all() frees. */
static void *kept[512];
static int kept_count;

static void *keep(size_t count, size_t size) {
    assert_in_range(kept_count, 0, 511);
    void *block = kept[kept_count++] = calloc(count, size);
    assert_non_null(block);
    return block;
}

FIXTURE(free_all) {
    while (kept_count > 0) free(kept[--kept_count]);
}

static Table make_table(int rows, int columns) {
    const size_t all = (size_t)rows * (size_t)columns;
    Table table = {.begin = keep((size_t)rows + 1, sizeof(int64_t)),
                   .column = keep(all, sizeof(int32_t)),
                   .value = keep(all, sizeof(float))};
    table.sparse = (SparseRows){0, columns, table.begin, table.column, table.value};
    return table;
}

/* sparse: omits the zeros. */
static void add_row(Table *table, const float *numbers, bool sparse) {
    int64_t end = table->begin[table->sparse.rows];
    for (int j = 0; j < table->sparse.columns; j++) {
        if (sparse && numbers[j] == 0) continue;
        table->column[end] = j;
        table->value[end++] = numbers[j];
    }
    table->begin[++table->sparse.rows] = end;
}

static Projection make_projection(int from, int to) {
    Projection projection = {.from = from,
                             .to = to,
                             .rows = keep((size_t)(from * to), sizeof(float)),
                             .centre = keep((size_t)to, sizeof(float))};
    for (int i = 0; i < from * to; i++) projection.rows[i] = NAN;
    for (int c = 0; c < to; c++) projection.centre[c] = NAN;
    return projection;
}

static Projection fit(const Table *table, int to, uint64_t seed) {
    Error error = {0};
    Projection projection = make_projection(table->sparse.columns, to);
    assert_ok(principal_fit(&table->sparse, seed, &projection, &error), error);
    return projection;
}

static size_t bytes(const Projection *projection) {
    return (size_t)(projection->from * projection->to) * sizeof(float);
}

static bool same(const Projection *a, const Projection *b) {
    return memcmp(a->rows, b->rows, bytes(a)) == 0 && memcmp(a->centre, b->centre, (size_t)a->to * sizeof(float)) == 0;
}

static double component(const Table *table, const Projection *projection, int row, int c) {
    double sum = -(double)projection->centre[c];
    for (int64_t k = table->begin[row]; k < table->begin[row + 1]; k++)
        sum += (double)table->value[k] * (double)projection->rows[table->column[k] * projection->to + c];
    return sum;
}

/* The first `rank` components have mean 0 and variance 1 and are uncorrelated; the others are 0. */
static void assert_white(const Table *table, const Projection *projection, int rank, double tolerance) {
    const int rows = table->sparse.rows;
    for (int a = 0; a < projection->to; a++)
        for (int b = 0; b <= a; b++) {
            double mean = 0, product = 0;
            for (int i = 0; i < rows; i++) {
                const double x = component(table, projection, i, a);
                mean += x / rows;
                product += x * component(table, projection, i, b) / rows;
            }
            assert_near(mean, 0, tolerance);
            assert_near(product, a == b && a < rank, tolerance);
        }
    for (int i = 0; i < projection->from * projection->to; i++)
        if (i % projection->to >= rank) assert_true(projection->rows[i] == 0);
    for (int c = rank; c < projection->to; c++) assert_true(projection->centre[c] == 0);
}

/* The variance along the direction of component c: whitening scaled the direction by 1 / sqrt(variance). */
static double variance(const Projection *projection, int c) {
    double square = 0;
    for (int j = 0; j < projection->from; j++) square += pow((double)projection->rows[j * projection->to + c], 2);
    return 1 / square;
}

/* All eigenvalues of the covariance, largest first. */
static gsl_vector *eigenvalues(const Table *table) {
    const size_t columns = (size_t)table->sparse.columns;
    const int rows = table->sparse.rows;
    gsl_matrix *c = gsl_matrix_calloc(columns, columns), *axes = gsl_matrix_alloc(columns, columns);
    gsl_vector *mean = gsl_vector_calloc(columns), *row = gsl_vector_alloc(columns), *all = gsl_vector_alloc(columns);
    gsl_eigen_symmv_workspace *eigen = gsl_eigen_symmv_alloc(columns);
    for (int i = 0; i < rows; i++)
        for (int64_t k = table->begin[i]; k < table->begin[i + 1]; k++)
            *gsl_vector_ptr(mean, (size_t)table->column[k]) += (double)table->value[k] / rows;
    for (int i = 0; i < rows; i++) {
        for (size_t j = 0; j < columns; j++) gsl_vector_set(row, j, -gsl_vector_get(mean, j));
        for (int64_t k = table->begin[i]; k < table->begin[i + 1]; k++)
            *gsl_vector_ptr(row, (size_t)table->column[k]) += (double)table->value[k];
        for (size_t a = 0; a < columns; a++)
            for (size_t b = 0; b < columns; b++)
                *gsl_matrix_ptr(c, a, b) += gsl_vector_get(row, a) * gsl_vector_get(row, b) / rows;
    }
    gsl_eigen_symmv(c, all, axes, eigen);
    gsl_eigen_symmv_sort(all, axes, GSL_EIGEN_SORT_VAL_DESC);
    gsl_eigen_symmv_free(eigen);
    gsl_matrix_free(c);
    gsl_matrix_free(axes);
    gsl_vector_free(mean);
    gsl_vector_free(row);
    return all;
}

/* Gaussian numbers scaled by falloff^column, with correlated neighbours; a third of them are set to 0. */
static Table make_random(int rows, int columns, double falloff, bool sparse) {
    Table table = make_table(rows, columns);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    float *numbers = keep((size_t)columns, sizeof *numbers);
    for (int i = 0; i < rows; i++) {
        double last = gsl_ran_gaussian(generator, 1);
        for (int j = 0; j < columns; j++) {
            const double next = gsl_ran_gaussian(generator, 1);
            const bool none = gsl_rng_uniform(generator) < 1.0 / 3;
            numbers[j] = none ? 0 : (float)(pow(falloff, j) * (1 + next + last / 2));
            last = next;
        }
        add_row(&table, numbers, sparse);
    }
    gsl_rng_free(generator);
    return table;
}

TEST(directions_of_known_variance_are_found) {
    /* Mean (7, -1); variance 4 along (3, 4) / 5 and 1/4 along (4, -3) / 5. */
    Table table = make_table(4, 2);
    for (int i = 0; i < 4; i++) {
        const float along = i % 2 == 0 ? 2 : -2, across = i < 2 ? 0.5F : -0.5F;
        add_row(&table, (float[]){7 + (3 * along + 4 * across) / 5, -1 + (4 * along - 3 * across) / 5}, true);
    }
    Projection projection = fit(&table, 2, 1);
    const double expected[4] = {0.6 / 2, 0.8 / 0.5, 0.8 / 2, -0.6 / 0.5};
    for (int i = 0; i < 4; i++) assert_near(projection.rows[i], expected[i], 1e-6);
    assert_near(projection.centre[0], 7 * 0.3 - 0.4, 1e-6);
    assert_near(projection.centre[1], 7 * 1.6 + 1.2, 1e-5);
}

TEST(components_are_white_and_the_strongest) {
    Table table = make_random(400, 40, 0.9, true);
    gsl_vector *all = eigenvalues(&table);
    const int counts[] = {40, 8};
    for (int i = 0; i < 2; i++) {
        Projection projection = fit(&table, counts[i], 1);
        assert_white(&table, &projection, counts[i], 1e-5);
        for (int c = 0; c < counts[i]; c++)
            assert_near(variance(&projection, c) / gsl_vector_get(all, (size_t)c), 1, 1e-5);
    }
    gsl_vector_free(all);
}

TEST(a_flat_spectrum_is_nearly_captured) {
    Table table = make_random(400, 60, 1, true);
    gsl_vector *all = eigenvalues(&table);
    Projection projection = fit(&table, 8, 1);
    double captured = 0, most = 0;
    for (int c = 0; c < 8; c++) {
        captured += variance(&projection, c);
        most += gsl_vector_get(all, (size_t)c);
    }
    assert_white(&table, &projection, 8, 1e-5);
    assert_near(captured / most, 0.95, 0.05 + 1e-6);
    gsl_vector_free(all);
}

/* Integers, so that nothing is rounded: twelve columns depend on three hidden numbers. */
TEST(components_beyond_the_rank_are_0) {
    Table table = make_table(200, 12), few = make_table(5, 12), narrow = make_table(200, 3);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < 200; i++) {
        float hidden[3], numbers[12];
        for (int s = 0; s < 3; s++) hidden[s] = (float)gsl_rng_uniform_int(generator, 9);
        for (int j = 0; j < 12; j++)
            numbers[j] = (float)(j % 4) * hidden[0] - (float)(j % 3) * hidden[1] + (float)(j / 6) * hidden[2];
        add_row(&table, numbers, true);
        add_row(&narrow, hidden, true);
        for (int j = 0; j < 12; j++) numbers[j] = (float)gsl_rng_uniform(generator);
        if (i < 5) add_row(&few, numbers, true);
    }
    gsl_rng_free(generator);
    const Table *const tables[] = {&table, &few, &narrow};
    const int ranks[] = {3, 4, 3};
    for (int i = 0; i < 3; i++) {
        Projection projection = fit(tables[i], 16, 1);
        assert_white(tables[i], &projection, ranks[i], 1e-5);
    }
}

/* Two independent columns, one with a deviation (and its square as variance) that is `weak` times the other's. */
TEST(components_too_weak_for_float_are_0) {
    const float weak[] = {1e-4F, 1e-6F};
    for (int rank = 2; rank >= 1; rank--) {
        Table table = make_table(4, 2);
        for (int i = 0; i < 4; i++) add_row(&table, (float[]){i % 2 == 0 ? 1 : -1, i < 2 ? weak[2 - rank] : 0}, true);
        Projection projection = fit(&table, 2, 1);
        assert_white(&table, &projection, rank, 1e-5);
    }
}

/* Independent deviations 1/2 and 1/4, at most 1e-6 of the mean. */
TEST(a_large_mean_costs_no_digits) {
    Table table = make_table(1000, 2);
    for (int i = 0; i < 1000; i++)
        add_row(&table, (float[]){1e6F + (i % 2 == 0 ? 0.5F : -0.5F), -1e6F + (i % 4 < 2 ? 0.25F : -0.25F)}, true);
    Projection projection = fit(&table, 2, 1);
    const double expected[] = {2, 0, 0, 4};
    for (int i = 0; i < 4; i++) assert_near(projection.rows[i], expected[i], 1e-6);
}

/* Rounding must not be taken for variance. */
TEST(equal_rows_have_no_components) {
    Table table = make_table(1000, 10);
    for (int i = 0; i < 1000; i++) {
        float numbers[10];
        for (int j = 0; j < 10; j++) numbers[j] = sqrtf((float)j) * powf(7, (float)(j % 5));
        add_row(&table, numbers, i % 2 == 0);
    }
    Projection projection = fit(&table, 3, 1);
    assert_white(&table, &projection, 0, 0);
}

TEST(constant_columns_contribute_nothing) {
    Table table = make_table(1000, 3), faint = make_table(1000, 3);
    for (int i = 0; i < 1000; i++) {
        add_row(&table, (float[]){0.1F, i % 5 == 0, 1e6F}, true);
        add_row(&faint, (float[]){0, i % 2 == 0 ? 1e-40F : 0, 0}, true);
    }
    Projection projection = fit(&table, 3, 1);
    for (int i = 0; i < 9; i++) assert_true(projection.rows[i] == 0 || i == 3);
    assert_near(projection.rows[3], 2.5, 1e-6); /* 1 in every fifth row: variance 1/5 - 1/25 */
    assert_white(&table, &projection, 1, 1e-5);
    projection = fit(&faint, 3, 1);
    assert_white(&faint, &projection, 0, 0);
}

TEST(same_seed_same_bits) {
    Table sparse = make_random(300, 40, 0.99, true), dense = make_random(300, 40, 0.99, false);
    assert_true(sparse.begin[300] < dense.begin[300]);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    Projection first = fit(&sparse, 8, 1);
    omp_set_num_threads(2);
    Projection threaded = fit(&sparse, 8, 1), with_zeros = fit(&dense, 8, 1), other = fit(&sparse, 8, 2);
    omp_set_num_threads(threads);
    assert_true(same(&first, &threaded));
    assert_true(same(&first, &with_zeros));
    assert_false(same(&first, &other));
}

TEST(the_largest_number_is_positive) {
    Table table = make_random(300, 40, 0.9, true);
    Projection projection = fit(&table, 32, 1);
    for (int c = 0; c < 32; c++) {
        float low = 0, high = 0;
        for (int j = 0; j < 40; j++) {
            low = fminf(low, projection.rows[32 * j + c]);
            high = fmaxf(high, projection.rows[32 * j + c]);
        }
        assert_true(high >= -low);
    }
}

static void refuse(const SparseRows *rows, int from, const char *text) {
    Error error = {0};
    Projection projection = make_projection(from, 2);
    assert_refused(principal_fit(rows, 1, &projection, &error), text);
    for (int i = 0; i < 2 * from; i++) assert_true(isnan(projection.rows[i]));
}

TEST(invalid_rows_are_refused) {
    const int64_t begin[] = {0, 2, 4};
    const int32_t column[] = {1, 0, 2, 0}, below[] = {1, 0, -1, 0}, beyond[] = {1, 0, 3, 0}, twice[] = {1, 0, 2, 2};
    const float value[] = {1, 2, 3, 4}, unknown[] = {1, 2, 3, NAN}, endless[] = {INFINITY, 2, 3, 4};
    refuse(&(SparseRows){2, 3, begin, below, value}, 3, "row 1: column -1 of 3");
    refuse(&(SparseRows){2, 3, begin, beyond, value}, 3, "row 1: column 3 of 3");
    refuse(&(SparseRows){2, 3, begin, twice, value}, 3, "row 1: column 2 is repeated");
    refuse(&(SparseRows){2, 3, begin, column, unknown}, 3, "row 1: column 0 is not finite");
    refuse(&(SparseRows){2, 3, begin, column, endless}, 3, "row 0: column 1 is not finite");
    refuse(&(SparseRows){0, 3, begin, column, value}, 3, "0 rows of 3 columns");
    refuse(&(SparseRows){2, 3, begin, column, value}, 4, "for a projection of 4 to 2");
}

RUN_TESTS(NULL, free_all)

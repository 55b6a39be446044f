/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/cma_es.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Candidate {
    double cost;
    double *step; /* [n] (point - mean) / sigma */
} Candidate;

typedef struct Strategy {
    int n, offspring, parents;
    double *weights; /* [parents] */
    double mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, chi;
    double sigma;
    gsl_vector *mean, *path_sigma, *path_c, *scale, *normal, *whitened,
        *shift; /* scale: square roots of the eigenvalues */
    gsl_matrix *covariance, *axes, *scratch;
    gsl_eigen_symmv_workspace *eigen;
    gsl_rng *generator;
    Candidate *candidates; /* [offspring] */
    double *steps;         /* [offspring, n] */
} Strategy;

static void strategy_free(Strategy *s) {
    gsl_vector *vectors[] = {s->mean, s->path_sigma, s->path_c, s->scale, s->normal, s->whitened, s->shift};
    gsl_matrix *matrices[] = {s->covariance, s->axes, s->scratch};
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++)
        if (vectors[i] != NULL) gsl_vector_free(vectors[i]);
    for (size_t i = 0; i < sizeof matrices / sizeof matrices[0]; i++)
        if (matrices[i] != NULL) gsl_matrix_free(matrices[i]);
    if (s->eigen != NULL) gsl_eigen_symmv_free(s->eigen);
    if (s->generator != NULL) gsl_rng_free(s->generator);
    free(s->weights);
    free(s->candidates);
    free(s->steps);
}

/* Default parameters: table 1 of the tutorial. */
static void set_rates(Strategy *s) {
    double n = s->n, sum = 0, squares = 0;
    for (int i = 0; i < s->parents; i++) {
        s->weights[i] = log(s->parents + 0.5) - log(i + 1.0);
        sum += s->weights[i];
    }
    for (int i = 0; i < s->parents; i++) {
        s->weights[i] /= sum;
        squares += s->weights[i] * s->weights[i];
    }
    s->mu_eff = 1 / squares;
    s->c_sigma = (s->mu_eff + 2) / (n + s->mu_eff + 5);
    s->d_sigma = 1 + 2 * fmax(0, sqrt((s->mu_eff - 1) / (n + 1)) - 1) + s->c_sigma;
    s->c_c = (4 + s->mu_eff / n) / (n + 4 + 2 * s->mu_eff / n);
    s->c_1 = 2 / ((n + 1.3) * (n + 1.3) + s->mu_eff);
    s->c_mu = fmin(1 - s->c_1, 2 * (s->mu_eff - 2 + 1 / s->mu_eff) / ((n + 2) * (n + 2) + s->mu_eff));
    s->chi = sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
}

static bool strategy_begin(Strategy *s, const CmaEs *task, const double *start) {
    size_t n = (size_t)task->dimension;
    *s = (Strategy){.n = task->dimension, .offspring = 4 + (int)(3 * log(task->dimension)), .sigma = task->step};
    s->parents = s->offspring / 2;
    gsl_vector **vectors[] = {&s->mean, &s->path_sigma, &s->path_c, &s->scale, &s->normal, &s->whitened, &s->shift};
    gsl_matrix **matrices[] = {&s->covariance, &s->axes, &s->scratch};
    bool ok = true;
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) ok &= (*vectors[i] = gsl_vector_calloc(n)) != NULL;
    for (size_t i = 0; i < sizeof matrices / sizeof matrices[0]; i++)
        ok &= (*matrices[i] = gsl_matrix_calloc(n, n)) != NULL;
    s->eigen = gsl_eigen_symmv_alloc(n);
    s->generator = gsl_rng_alloc(gsl_rng_mt19937);
    s->weights = calloc((size_t)s->parents, sizeof *s->weights);
    s->candidates = calloc((size_t)s->offspring, sizeof *s->candidates);
    s->steps = calloc((size_t)s->offspring * n, sizeof *s->steps);
    if (!ok || !s->eigen || !s->generator || !s->weights || !s->candidates || !s->steps) return false;
    for (int i = 0; i < s->offspring; i++) s->candidates[i].step = s->steps + (size_t)i * n;
    for (size_t i = 0; i < n; i++) gsl_vector_set(s->mean, i, start[i]);
    gsl_matrix_set_identity(s->covariance);
    gsl_rng_set(s->generator, (unsigned long)task->seed);
    set_rates(s);
    return true;
}

/* covariance = axes scale^2 axes^T */
static void decompose(Strategy *s) {
    gsl_matrix_memcpy(s->scratch, s->covariance);
    gsl_eigen_symmv(s->scratch, s->scale, s->axes, s->eigen);
    for (size_t i = 0; i < s->scale->size; i++)
        gsl_vector_set(s->scale, i, sqrt(fmax(gsl_vector_get(s->scale, i), 1e-20)));
}

/* step ~ N(0, covariance); point = mean + sigma step. */
static void sample(Strategy *s, double *step, double *point) {
    for (size_t i = 0; i < s->normal->size; i++)
        gsl_vector_set(s->normal, i, gsl_vector_get(s->scale, i) * gsl_ran_gaussian_ziggurat(s->generator, 1));
    gsl_vector_view out = gsl_vector_view_array(step, s->normal->size);
    gsl_blas_dgemv(CblasNoTrans, 1, s->axes, s->normal, 0, &out.vector);
    for (size_t i = 0; i < s->normal->size; i++) point[i] = gsl_vector_get(s->mean, i) + s->sigma * step[i];
}

static int by_cost(const void *a, const void *b) {
    double x = ((const Candidate *)a)->cost, y = ((const Candidate *)b)->cost;
    return (x > y) - (x < y);
}

/* path = (1 - c) path + weight sqrt(c (2 - c) mu_eff) step */
static void update_path(gsl_vector *path, double c, double mu_eff, const gsl_vector *step, double weight) {
    gsl_vector_scale(path, 1 - c);
    gsl_blas_daxpy(weight * sqrt(c * (2 - c) * mu_eff), step, path);
}

/* Moves the mean to the weighted mean of the better half of a generation. */
static void move_mean(Strategy *s) {
    qsort(s->candidates, (size_t)s->offspring, sizeof *s->candidates, by_cost);
    gsl_vector_set_zero(s->shift);
    for (int i = 0; i < s->parents; i++) {
        gsl_vector_view step = gsl_vector_view_array(s->candidates[i].step, (size_t)s->n);
        gsl_blas_daxpy(s->weights[i], &step.vector, s->shift);
    }
    gsl_blas_daxpy(s->sigma, s->shift, s->mean);
}

/* Updates the evolution paths, the covariance and sigma. */
static void adapt(Strategy *s, int generation) {
    /* covariance^(-1/2) shift */
    gsl_blas_dgemv(CblasTrans, 1, s->axes, s->shift, 0, s->normal);
    gsl_vector_div(s->normal, s->scale);
    gsl_blas_dgemv(CblasNoTrans, 1, s->axes, s->normal, 0, s->whitened);
    update_path(s->path_sigma, s->c_sigma, s->mu_eff, s->whitened, 1);
    double length = gsl_blas_dnrm2(s->path_sigma);
    double expected = sqrt(1 - pow(1 - s->c_sigma, 2.0 * (generation + 1)));
    double h_sigma = length / expected < (1.4 + 2.0 / (s->n + 1)) * s->chi ? 1 : 0;
    update_path(s->path_c, s->c_c, s->mu_eff, s->shift, h_sigma);

    gsl_matrix_scale(s->covariance, 1 - s->c_1 - s->c_mu + (1 - h_sigma) * s->c_1 * s->c_c * (2 - s->c_c));
    gsl_blas_dger(s->c_1, s->path_c, s->path_c, s->covariance);
    for (int i = 0; i < s->parents; i++) {
        gsl_vector_view step = gsl_vector_view_array(s->candidates[i].step, (size_t)s->n);
        gsl_blas_dger(s->c_mu * s->weights[i], &step.vector, &step.vector, s->covariance);
    }
    s->sigma *= exp(s->c_sigma / s->d_sigma * (length / s->chi - 1));
}

bool cma_es_minimize(const CmaEs *task, double *best, const Progress *progress, Error *error) {
    gsl_set_error_handler_off(); /* its default aborts */
    Strategy s;
    double *point = calloc((size_t)task->dimension, sizeof *point);
    bool ok = strategy_begin(&s, task, best) && point != NULL;
    double lowest = ok ? task->cost(task->context, best) : 0;
    for (int generation = 0; ok && generation < task->generations; generation++) {
        if (!progress_report(progress, generation, task->generations)) break;
        decompose(&s);
        for (int i = 0; i < s.offspring; i++) {
            sample(&s, s.candidates[i].step, point);
            s.candidates[i].cost = task->cost(task->context, point);
            if (s.candidates[i].cost >= lowest) continue;
            lowest = s.candidates[i].cost;
            memcpy(best, point, (size_t)task->dimension * sizeof *best);
        }
        move_mean(&s);
        adapt(&s, generation);
    }
    free(point);
    strategy_free(&s);
    return ok || error_memory(error, "cma-es");
}

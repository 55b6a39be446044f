/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The optimisers of pair networks: adam, gd, lm with its Gauss-Newton products, bfgs. */
#include "base/base.h"
#include "learning/learning.h"
#include "learning/pair_training_internal.h"
#include "nets/nets.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multilarge_nlinear.h>
#include <gsl/gsl_multimin.h>
#include <stdlib.h>
#include <string.h>

/* Adam (learning/learning.h) on full batches, so the gradient has no noise; the rate decays to 0 by half a cosine.
   Converges slowly in narrow valleys of the loss; lm does not. */
static const double first_rate = 0.05;

static bool adam_minimize(Trainer *trainer, double *parameters, Error *error) {
    const size_t count = (size_t)trainer->parameters;
    double *block = calloc(3 * count, sizeof *block), *gradient = block;
    if (block == NULL) return error_memory(error, "training");
    Adam adam = adam_over(parameters, block + count, block + 2 * count, trainer->parameters);
    bool ok = true;
    while (ok && !trainer->finished) {
        const double loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, parameters, gradient);
        ok = trainer_visit(trainer, parameters, loss, error);
        const double done = (double)trainer->iteration / trainer->options->iterations;
        if (ok && !trainer->finished) adam_step(&adam, gradient, first_rate * adam_cosine(done));
    }
    free(block);
    return ok;
}

const Optimizer optimizer_adam = {"adam", "adaptive step per parameter, cosine decay (Kingma, Ba 2015)", adam_minimize};

/* Full-batch gradient descent with a fixed rate:

       p = p - rate * g

   Source: Cauchy, "Methode generale pour la resolution des systemes d'equations simultanees" (1847); the paper's
   gradient descent (3.3). The rate was chosen among 0.1, 0.2, 0.3, 0.5, 1 and 2 by 1000 steps on pairs of the training
   scenes, for eight networks of 10-10-2 and 10-8-8-6 with all activations and scalings. 0.5 beat the lower rates for
   six of the eight; at 1 one network with linear outputs rose to the loss of the constant predictor; at 2 three
   diverged. Much wider layers oscillate or diverge at 0.5 too. Converges slowly on ill-conditioned losses. */

static const double rate = 0.5;

static bool gd_minimize(Trainer *trainer, double *parameters, Error *error) {
    double *gradient = calloc((size_t)trainer->parameters, sizeof *gradient);
    if (gradient == NULL) return error_memory(error, "training");
    bool ok = true;
    while (ok && !trainer->finished) {
        double loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, parameters, gradient);
        ok = trainer_visit(trainer, parameters, loss, error);
        for (int p = 0; p < trainer->parameters; p++) parameters[p] -= rate * gradient[p];
    }
    free(gradient);
    return ok;
}

const Optimizer optimizer_gd = {"gd", "gradient descent with a fixed rate", gd_minimize};

/* The derivative of output k with respect to the weight from unit i to unit j is d_j(k) x_i, so an entry of J^T J is

       sum over rows of D x_i x_i',   D = sum over outputs k of d_j(k) d_j'(k)

   D is computed once per pair of units and x_i x_i' once per pair of layers: a third of the multiplications of forming
   J^T J from J for 10-10-2, a seventh for 10-8-8-6. Two cores, 10^6 rows of 10-10-2: 0.8 s; OpenBLAS's dsyrk on blocks
   of J: 2.2 s. */

/* As for the loss (pair_laws.c), but each chunk holds a matrix. */
enum { MAX_CHUNKS = 32, MAX_MATRIX_NUMBERS = 1 << 24 };

typedef struct Chunk {
    NetworkBlock *block;
    double *deltas;   /* [outputs, units, BLOCK_ROWS]: d prediction k / d sum of each unit of all layers */
    double *products; /* [pairs of inputs, BLOCK_ROWS] of a pair of layers */
    double *jtu;      /* [parameters] */
    double *jtj;      /* [parameters, parameters], lower triangle */
} Chunk;

struct GaussNewton {
    const Network *shape;
    size_t parameters;
    int units; /* in all layers except the inputs */
    int first_unit[NETWORK_MAX_LAYERS];
    size_t first_parameter[NETWORK_MAX_LAYERS];
    double ones[BLOCK_ROWS]; /* the input of a bias */
    int chunk_count;
    Chunk chunks[MAX_CHUNKS];
};

GaussNewton *gauss_newton_create(const Network *shape, Error *error) {
    GaussNewton *work = calloc(1, sizeof *work);
    if (work == NULL) return error_memory(error, "training"), NULL;
    work->shape = shape;
    for (int l = 0; l < shape->layers; l++) {
        work->first_unit[l] = work->units;
        work->first_parameter[l] = work->parameters;
        work->units += shape->widths[l + 1];
        work->parameters += (size_t)shape->widths[l + 1] * (size_t)(shape->widths[l] + 1);
    }
    for (int r = 0; r < BLOCK_ROWS; r++) work->ones[r] = 1;
    size_t affordable = MAX_MATRIX_NUMBERS / (work->parameters * work->parameters);
    work->chunk_count = affordable < 1 ? 1 : affordable < MAX_CHUNKS ? (int)affordable : MAX_CHUNKS;
    const size_t outputs = (size_t)shape->widths[shape->layers], widest = (size_t)network_scratch_width(shape) + 1,
                 deltas = outputs * (size_t)work->units * BLOCK_ROWS, products = widest * widest * BLOCK_ROWS;
    for (int c = 0; c < work->chunk_count; c++) {
        Chunk *chunk = &work->chunks[c];
        chunk->block = network_block_create(shape, error);
        chunk->deltas = calloc(deltas + products + work->parameters * (1 + work->parameters), sizeof(double));
        if (chunk->block == NULL || chunk->deltas == NULL)
            return error_memory(error, "training"), gauss_newton_destroy(work), NULL;
        chunk->products = chunk->deltas + deltas;
        chunk->jtu = chunk->products + products;
        chunk->jtj = chunk->jtu + work->parameters;
    }
    return work;
}

void gauss_newton_destroy(GaussNewton *work) {
    if (work == NULL) return;
    for (int c = 0; c < work->chunk_count; c++) {
        network_block_destroy(work->chunks[c].block);
        free(work->chunks[c].deltas);
    }
    free(work);
}

/* Input i of layer l; the last input is that of the bias. */
static const double *input_values(const GaussNewton *work, const Chunk *chunk, int l, int i) {
    return i < work->shape->widths[l] ? chunk->block->values[l] + i * BLOCK_ROWS : work->ones;
}

/* Index of the weight from input i to unit j of layer l. */
static size_t parameter_index(const GaussNewton *work, int l, int j, int i) {
    int inputs = work->shape->widths[l], outputs = work->shape->widths[l + 1];
    return work->first_parameter[l] + (size_t)(i < inputs ? j * inputs + i : outputs * inputs + j);
}

static void add_symmetric(const GaussNewton *work, Chunk *chunk, size_t a, size_t b, double value) {
    size_t row = a > b ? a : b, column = a > b ? b : a;
    chunk->jtj[row * work->parameters + column] += value;
}

/* Adds D x_i x_i' of unit j of layer l and unit j2 of layer m, for all their inputs; the products x_i x_i' are those of
   the pair of layers. */
static void add_unit_pair(const GaussNewton *work, Chunk *chunk, int l, int j, int m, int j2) {
    const int unit = work->first_unit[l] + j, unit2 = work->first_unit[m] + j2;
    double weights[BLOCK_ROWS] = {0};
    for (int k = 0; k < work->shape->widths[work->shape->layers]; k++) {
        const double *a = chunk->deltas + (k * work->units + unit) * BLOCK_ROWS;
        const double *b = chunk->deltas + (k * work->units + unit2) * BLOCK_ROWS;
        for (int r = 0; r < BLOCK_ROWS; r++) weights[r] += a[r] * b[r];
    }
    const double *product = chunk->products;
    for (int i = 0; i <= work->shape->widths[l]; i++)
        for (int i2 = 0; i2 <= (l == m ? i : work->shape->widths[m]); i2++, product += BLOCK_ROWS) {
            double sum = network_block_dot(weights, product);
            add_symmetric(work, chunk, parameter_index(work, l, j, i), parameter_index(work, m, j2, i2), sum);
            if (l == m && j != j2 && i != i2)
                add_symmetric(work, chunk, parameter_index(work, l, j, i2), parameter_index(work, m, j2, i), sum);
        }
}

/* m <= l */
static void add_layer_pair(const GaussNewton *work, Chunk *chunk, int l, int m) {
    const bool both_last = m == work->shape->layers - 1;
    double *product = chunk->products; /* only i' <= i if l == m */
    for (int i = 0; i <= work->shape->widths[l]; i++)
        for (int i2 = 0; i2 <= (l == m ? i : work->shape->widths[m]); i2++, product += BLOCK_ROWS) {
            const double *a = input_values(work, chunk, l, i), *b = input_values(work, chunk, m, i2);
            for (int r = 0; r < BLOCK_ROWS; r++) product[r] = a[r] * b[r];
        }
    for (int j = 0; j < work->shape->widths[l + 1]; j++)
        for (int j2 = 0; j2 <= (l == m ? j : work->shape->widths[m + 1] - 1); j2++)
            if (!both_last || j == j2) add_unit_pair(work, chunk, l, j, m, j2); /* outputs share no prediction */
}

static void add_block(const GaussNewton *work, Chunk *chunk, const Samples *samples, int64_t b,
                      const double *parameters, const double *u, bool with_jtj) {
    const Network *shape = work->shape;
    const int layers = shape->layers, outputs = samples->outputs, rows = samples_in_block(samples, b);
    double *last = chunk->block->deltas[layers - 1];
    loss_forward(chunk->block, samples, b, parameters);
    memcpy(last, u + b * outputs * BLOCK_ROWS, (size_t)outputs * BLOCK_ROWS * sizeof *u);
    network_backward(chunk->block, parameters);
    network_add_gradient(chunk->block, chunk->jtu);
    if (!with_jtj) return;
    /* One backward pass per output k, with output delta 1 for k and 0 for the others. */
    for (int k = 0; k < outputs; k++) {
        for (int i = 0; i < outputs * BLOCK_ROWS; i++) last[i] = i / BLOCK_ROWS == k && i % BLOCK_ROWS < rows;
        network_backward(chunk->block, parameters);
        for (int l = 0; l < layers; l++)
            memcpy(chunk->deltas + (k * work->units + work->first_unit[l]) * BLOCK_ROWS, chunk->block->deltas[l],
                   (size_t)shape->widths[l + 1] * BLOCK_ROWS * sizeof(double));
    }
    for (int l = 0; l < layers; l++)
        for (int m = 0; m <= l; m++) add_layer_pair(work, chunk, l, m);
}

static void add_chunk(double *total, const double *part, size_t count, bool first) {
    for (size_t i = 0; i < count; i++) total[i] = first ? part[i] : total[i] + part[i];
}

void gauss_newton_sum(GaussNewton *work, const Samples *samples, const double *parameters, const double *u, double *jtu,
                      double *jtj) {
    size_t count = work->parameters;
    /* With less than one block per chunk, waking threads costs more than it saves. */
#pragma omp parallel for schedule(dynamic, 1) if (samples->blocks >= work->chunk_count)
    for (int c = 0; c < work->chunk_count; c++) {
        Chunk *chunk = &work->chunks[c];
        memset(chunk->jtu, 0, count * sizeof(double));
        memset(chunk->jtj, 0, count * count * sizeof(double));
        for (int64_t b = samples->blocks * c / work->chunk_count; b < samples->blocks * (c + 1) / work->chunk_count;
             b++)
            add_block(work, chunk, samples, b, parameters, u, jtj != NULL);
    }
    for (int c = 0; c < work->chunk_count; c++) {
        add_chunk(jtu, work->chunks[c].jtu, count, c == 0);
        if (jtj != NULL) add_chunk(jtj, work->chunks[c].jtj, count * count, c == 0);
    }
}

/* Levenberg-Marquardt: each step solves the damped, linearised least-squares problem

       (J^T J + mu D^T D) step = -J^T residuals

   Source: Marquardt (1963), More (1978); implemented with GSL's gsl_multilarge_nlinear. J would take gigabytes, so only
   J^T J and J^T u are computed. Needs far fewer steps than adam. For small networks: the cost of a step grows with the
   square of the number of parameters. */

enum { MAX_PARAMETERS = 2000 }; /* 32 MB for each of several copies of J^T J */

typedef struct LeastSquares {
    const Trainer *trainer;
    GaussNewton *derivatives;
} LeastSquares;

static int residuals(const gsl_vector *x, void *context, gsl_vector *f) {
    const Trainer *trainer = ((LeastSquares *)context)->trainer;
    loss_residuals(trainer->loss, trainer->train, x->data, f->data);
    return GSL_SUCCESS;
}

static int derivatives(CBLAS_TRANSPOSE_t transpose, const gsl_vector *x, const gsl_vector *u, void *context,
                       gsl_vector *v, gsl_matrix *jtj) {
    if (transpose != CblasTrans) return GSL_EUNIMPL; /* J u: only conjugate gradients need it */
    LeastSquares *problem = context;
    gauss_newton_sum(problem->derivatives, problem->trainer->train, x->data, u->data, v->data,
                     jtj == NULL ? NULL : jtj->data);
    return GSL_SUCCESS;
}

static bool lm_minimize(Trainer *trainer, double *parameters, Error *error) {
    const Samples *samples = trainer->train;
    long long numbers = (long long)samples->rows * samples->outputs;
    if (trainer->loss_kind != LOSS_MSE || trainer->laws != NULL)
        return error_input(error, "lm", "needs loss mse and no laws; use adam, bfgs or gd");
    if (trainer->parameters > MAX_PARAMETERS)
        return error_input(error, "lm", "at most %d weights (got %d); for more use adam, bfgs or gd", MAX_PARAMETERS,
                           trainer->parameters);
    if (numbers < trainer->parameters)
        return error_input(error, "lm", "needs at least as many target values as weights (got %lld and %d)", numbers,
                           trainer->parameters);
    gsl_multilarge_nlinear_parameters settings = gsl_multilarge_nlinear_default_parameters();
    settings.trs = gsl_multilarge_nlinear_trs_lm;
    settings.solver = gsl_multilarge_nlinear_solver_cholesky;
    size_t residual_count = (size_t)samples->blocks * (size_t)samples->outputs * BLOCK_ROWS;
    gsl_multilarge_nlinear_workspace *work = gsl_multilarge_nlinear_alloc(gsl_multilarge_nlinear_trust, &settings,
                                                                          residual_count, (size_t)trainer->parameters);
    GaussNewton *gauss_newton = gauss_newton_create(trainer->network, error);
    bool ok = (work != NULL && gauss_newton != NULL) || error_memory(error, "training");
    if (ok) {
        LeastSquares problem = {trainer, gauss_newton};
        gsl_multilarge_nlinear_fdf function = {
            .f = residuals, .df = derivatives, .n = work->n, .p = work->p, .params = &problem};
        gsl_vector_view start = gsl_vector_view_array(parameters, work->p);
        int status = gsl_multilarge_nlinear_init(&start.vector, &function, work);
        if (status != GSL_SUCCESS) ok = error_system(error, "lm", "%s", gsl_strerror(status));
        while (ok && !trainer->finished && status == GSL_SUCCESS) { /* ends early if no damping lowers the loss */
            const double norm = gsl_blas_dnrm2(work->f);
            ok = trainer_visit(trainer, work->x->data, norm * norm / ((double)samples->rows * samples->outputs), error);
            if (ok && !trainer->finished) status = gsl_multilarge_nlinear_iterate(work);
        }
    }
    gauss_newton_destroy(gauss_newton);
    gsl_multilarge_nlinear_free(work);
    return ok;
}

const Optimizer optimizer_lm = {"lm", "Levenberg-Marquardt, for small networks (GSL multilarge_nlinear)", lm_minimize};

/* BFGS: quasi-Newton steps, with curvature estimated from changes of the gradient, and a line search that evaluates the
   loss several times per step. Source: Fletcher, "Practical Methods of Optimization" (1987), section 2.6; implemented
   by GSL's vector_bfgs2. Stops if the line search finds no lower loss within rounding. */

static const double first_step = 0.1;
static const double line_search_accuracy = 0.1; /* recommended by GSL for this method */

static double value(const gsl_vector *x, void *context) {
    Trainer *trainer = context;
    return loss_value(trainer->loss, trainer->train, trainer->laws, x->data);
}

static void value_and_gradient(const gsl_vector *x, void *context, double *loss, gsl_vector *gradient) {
    Trainer *trainer = context;
    *loss = loss_gradient(trainer->loss, trainer->train, trainer->laws, x->data, gradient->data);
}

static void gradient_only(const gsl_vector *x, void *context, gsl_vector *gradient) {
    double loss;
    value_and_gradient(x, context, &loss, gradient);
}

static bool bfgs_minimize(Trainer *trainer, double *parameters, Error *error) {
    size_t count = (size_t)trainer->parameters;
    gsl_multimin_function_fdf function = {value, gradient_only, value_and_gradient, count, trainer};
    gsl_vector_view start = gsl_vector_view_array(parameters, count);
    gsl_multimin_fdfminimizer *minimizer =
        gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, count);
    if (minimizer == NULL) return error_memory(error, "training");
    gsl_multimin_fdfminimizer_set(minimizer, &function, &start.vector, first_step, line_search_accuracy);
    bool ok = true, lowered = true;
    while (ok && !trainer->finished && lowered) {
        ok = trainer_visit(trainer, minimizer->x->data, minimizer->f, error);
        if (!ok || trainer->finished) break;
        /* If the line search fails, it is tried once more along the gradient. */
        lowered = gsl_multimin_fdfminimizer_iterate(minimizer) == GSL_SUCCESS ||
                  (gsl_multimin_fdfminimizer_restart(minimizer) == GSL_SUCCESS &&
                   gsl_multimin_fdfminimizer_iterate(minimizer) == GSL_SUCCESS);
    }
    gsl_multimin_fdfminimizer_free(minimizer);
    return ok;
}

const Optimizer optimizer_bfgs = {"bfgs", "quasi-Newton with line search (GSL vector_bfgs2)", bfgs_minimize};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Levenberg-Marquardt: each step solves the damped, linearised least-squares problem

       (J^T J + mu D^T D) step = -J^T residuals

   Source: Marquardt (1963), More (1978); implemented with GSL's gsl_multilarge_nlinear. J would take gigabytes, so only
   J^T J and J^T u are computed. Needs far fewer steps than adam. For small networks: the cost of a step grows with the
   square of the number of parameters. */
#include "training/gauss_newton.h"
#include "training/optimizer.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multilarge_nlinear.h>

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

static double loss_of(const Trainer *trainer, const gsl_vector *f) {
    double norm = gsl_blas_dnrm2(f);
    return norm * norm / ((double)trainer->train->rows * trainer->train->outputs);
}

/* Ends early, without an error, if no damping lowers the loss. */
static bool run(Trainer *trainer, gsl_multilarge_nlinear_workspace *work, GaussNewton *gauss_newton, double *parameters,
                Error *error) {
    LeastSquares problem = {trainer, gauss_newton};
    gsl_multilarge_nlinear_fdf function = {
        .f = residuals, .df = derivatives, .n = work->n, .p = work->p, .params = &problem};
    gsl_vector_view start = gsl_vector_view_array(parameters, work->p);
    int status = gsl_multilarge_nlinear_init(&start.vector, &function, work);
    if (status != GSL_SUCCESS) return error_system(error, "lm", "%s", gsl_strerror(status));
    bool ok;
    do ok = trainer_visit(trainer, work->x->data, loss_of(trainer, work->f), error);
    while (ok && !trainer->finished && gsl_multilarge_nlinear_iterate(work) == GSL_SUCCESS);
    return ok;
}

static bool minimize(Trainer *trainer, double *parameters, Error *error) {
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
    bool ok = work != NULL && gauss_newton != NULL ? run(trainer, work, gauss_newton, parameters, error)
                                                   : error_memory(error, "training");
    gauss_newton_destroy(gauss_newton);
    gsl_multilarge_nlinear_free(work);
    return ok;
}

const Optimizer optimizer_lm = {"lm", "Levenberg-Marquardt, for small networks (GSL multilarge_nlinear)", minimize};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* BFGS: quasi-Newton steps, with curvature estimated from changes of the gradient, and a line search that evaluates the
   loss several times per step. Source: Fletcher, "Practical Methods of Optimization" (1987), section 2.6; implemented
   by GSL's vector_bfgs2. Stops if the line search finds no lower loss within rounding. */
#include "training/optimizer.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <stdlib.h>

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

/* One step. If the line search fails, restarts once along the gradient. False if that fails too. */
static bool iterate(gsl_multimin_fdfminimizer *minimizer) {
    if (gsl_multimin_fdfminimizer_iterate(minimizer) == GSL_SUCCESS) return true;
    return gsl_multimin_fdfminimizer_restart(minimizer) == GSL_SUCCESS &&
           gsl_multimin_fdfminimizer_iterate(minimizer) == GSL_SUCCESS;
}

static bool minimize(Trainer *trainer, double *parameters, Error *error) {
    size_t count = (size_t)trainer->parameters;
    gsl_multimin_function_fdf function = {value, gradient_only, value_and_gradient, count, trainer};
    gsl_vector_view start = gsl_vector_view_array(parameters, count);
    gsl_multimin_fdfminimizer *minimizer =
        gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, count);
    if (minimizer == NULL) return error_memory(error, "training");
    gsl_multimin_fdfminimizer_set(minimizer, &function, &start.vector, first_step, line_search_accuracy);
    bool ok;
    do ok = trainer_visit(trainer, minimizer->x->data, minimizer->f, error);
    while (ok && !trainer->finished && iterate(minimizer));
    gsl_multimin_fdfminimizer_free(minimizer);
    return ok;
}

const Optimizer optimizer_bfgs = {"bfgs", "quasi-Newton with line search (GSL vector_bfgs2)", minimize};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits the network of scene-net: samples, sweeps that are unrolled and differentiated, the loss, mini-batches. */
#include "learning/scene_net_fit.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "nets/kernels.h"
#include "nets/kinds.h"

#include <gsl/gsl_randist.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* A visit of one contact, with Jacobian rows J, inverse masses W and coupling c = J_t W J_n^T:

       forward                                            backward, x* the derivative of the loss by x, w* = W v*
       Pn' = max(Pn - m_n (J_n v - bias), 0)              Pt'* += J_t w*,  Pn'* += J_n w*
       Pt' = clamp(Pt - m_t (J_t v + c dPn), +-mu Pn')    Pt'* into m_t J_t v, c dPn, Pt or into mu Pn'
       v'  = v + W (J_n^T dPn + J_t^T dPt)                w*  += W (J_n^T (J_n v)* + J_t^T (J_t v)*)

   w* behaves like a velocity, so both passes share velocity_along() and push(). */

/* The piece that the clamps took: 3 if the normal impulse is above 0, plus 0, 1 or 2 for a tangent impulse at the lower
   limit of the cone, inside, or at the upper limit. With a limit of 0 there is no inside. */
static inline uint8_t piece_of(double normal, double tangent, double limit) {
    return (uint8_t)(3 * (normal > 0) + (tangent > -limit) + (tangent > limit));
}

/* Lookup tables: branches mispredict at impacts. */
static const double pushes[6] = {0, 0, 0, 1, 1, 1}, within[6] = {0, 1, 0, 0, 1, 0}, side[6] = {-1, 0, 1, -1, 0, 1};

static inline double clamp(double value, double limit) {
    double capped = value < limit ? value : limit;
    return capped > -limit ? capped : -limit;
}

static void make_row(double row[4], Vec2 direction, const ContactPoint *point) {
    row[0] = (double)direction.x;
    row[1] = (double)direction.y;
    row[2] = (double)point->arm_a.y * row[0] - (double)point->arm_a.x * row[1];
    row[3] = (double)point->arm_b.x * row[1] - (double)point->arm_b.y * row[0];
}

bool unrolled_problem_make(UnrolledProblem *unrolled, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    Colours colours = {0};
    UnrolledContact *block =
        malloc(contacts * (sizeof *block + sizeof *unrolled->visits) + (5 * bodies + 1) * sizeof(double));
    if (block == NULL || !colours_order(&colours, problem)) {
        free(block);
        colours_free(&colours);
        return false;
    }
    double *numbers = (double *)(block + contacts);
    int32_t *visits = (int32_t *)(numbers + 5 * bodies);
    *unrolled = (UnrolledProblem){.body_count = problem->body_count,
                                  .contact_count = problem->contact_count,
                                  .contacts = block,
                                  .visits = visits,
                                  .inv_mass = numbers,
                                  .inv_inertia = numbers + bodies,
                                  .free = numbers + 2 * bodies};
    if (contacts > 0) memcpy(visits, colours.visits, contacts * sizeof *visits);
    colours_free(&colours);
    for (size_t i = 0; i < contacts; i++) {
        const ContactPoint *point = &problem->contacts[i];
        UnrolledContact *contact = &block[i];
        *contact = (UnrolledContact){.a = point->a,
                                     .b = point->b,
                                     .mass_normal = (double)point->mass_normal,
                                     .mass_tangent = (double)point->mass_tangent,
                                     .friction = (double)point->friction,
                                     .bias = (double)point->bias};
        make_row(contact->normal, point->normal, point);
        make_row(contact->tangent, vec2_cross_scalar(point->normal, 1.0f), point);
        /* The directions are perpendicular, so only the angular parts couple. */
        contact->coupling = (double)problem->bodies[point->a].inv_inertia * contact->normal[2] * contact->tangent[2] +
                            (double)problem->bodies[point->b].inv_inertia * contact->normal[3] * contact->tangent[3];
    }
    for (size_t i = 0; i < bodies; i++) {
        const ProblemBody *body = &problem->bodies[i];
        unrolled->inv_mass[i] = (double)body->inv_mass;
        unrolled->inv_inertia[i] = (double)body->inv_inertia;
        unrolled->free[3 * i] = (double)body->velocity.x;
        unrolled->free[3 * i + 1] = (double)body->velocity.y;
        unrolled->free[3 * i + 2] = (double)body->angular_velocity;
    }
    return true;
}

void unrolled_problem_free(UnrolledProblem *problem) {
    free(problem->contacts);
    *problem = (UnrolledProblem){0};
}

void unrolled_free(Unrolled *unrolled) {
    free(unrolled->states);
    free(unrolled->pieces);
    free(unrolled->factors);
    free(unrolled->adjoints);
    *unrolled = (Unrolled){0};
}

static size_t state_size(const UnrolledProblem *problem) {
    return 3 * (size_t)problem->body_count + 2 * (size_t)problem->contact_count;
}

/* Relative velocity of b's contact point along a row. */
static inline double velocity_along(const double row[4], const double *a, const double *b) {
    return row[0] * (b[0] - a[0]) + row[1] * (b[1] - a[1]) + (row[2] * a[2] + row[3] * b[2]);
}

static inline void push(const UnrolledProblem *problem, const UnrolledContact *contact, double *velocities,
                        double normal, double tangent) {
    double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    double effect[4];
    for (int i = 0; i < 4; i++) effect[i] = normal * contact->normal[i] + tangent * contact->tangent[i];
    const double inv_a = problem->inv_mass[contact->a], inv_b = problem->inv_mass[contact->b];
    a[0] -= inv_a * effect[0];
    a[1] -= inv_a * effect[1];
    a[2] += problem->inv_inertia[contact->a] * effect[2];
    b[0] += inv_b * effect[0];
    b[1] += inv_b * effect[1];
    b[2] += problem->inv_inertia[contact->b] * effect[3];
}

/* One contact update; returns the piece. */
static inline uint8_t visit(const UnrolledProblem *problem, const UnrolledContact *contact, double *velocities,
                            double *impulse) {
    const double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    const double normal = impulse[0] - contact->mass_normal * (velocity_along(contact->normal, a, b) - contact->bias);
    const double pushed = normal > 0 ? normal : 0, by_normal = pushed - impulse[0];
    const double sliding = velocity_along(contact->tangent, a, b) + contact->coupling * by_normal;
    const double tangent = impulse[1] - contact->mass_tangent * sliding, limit = contact->friction * pushed;
    const double dragged = clamp(tangent, limit);
    push(problem, contact, velocities, by_normal, dragged - impulse[1]);
    impulse[0] = pushed;
    impulse[1] = dragged;
    return piece_of(normal, tangent, limit);
}

/* Turns the adjoints after the visit into those before it. */
static inline void visit_back(const UnrolledProblem *problem, const UnrolledContact *contact, uint8_t piece,
                              double *velocities, double *impulse) {
    const double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    const double along_normal = velocity_along(contact->normal, a, b);
    const double along_tangent = velocity_along(contact->tangent, a, b);
    const double dragged = impulse[1] + along_tangent, inside = within[piece] * dragged;
    const double by_sliding = -contact->mass_tangent * inside;
    const double by_normal = along_normal + contact->coupling * by_sliding;
    const double pushed = pushes[piece] * (impulse[0] + by_normal + side[piece] * contact->friction * dragged);
    push(problem, contact, velocities, -contact->mass_normal * pushed, by_sliding);
    impulse[0] = pushed - by_normal;
    impulse[1] = inside - along_tangent;
}

/* The derivative by a contact's impulse, including its effect on the velocities. */
static inline void by_impulse(const UnrolledProblem *problem, int contact, const double *adjoint, double by[2]) {
    const UnrolledContact *at = &problem->contacts[contact];
    const double *a = adjoint + 3 * at->a, *b = adjoint + 3 * at->b;
    const double *impulse = adjoint + 3 * problem->body_count + 2 * contact;
    by[0] = impulse[0] + velocity_along(at->normal, a, b);
    by[1] = impulse[1] + velocity_along(at->tangent, a, b);
}

bool unrolled_run(Unrolled *unrolled, const UnrolledProblem *problem, const double *start, const double *factors,
                  int sweeps) {
    const size_t count = (size_t)sweeps, size = state_size(problem), contacts = (size_t)problem->contact_count;
    if (!array_reserve((void **)&unrolled->states, &unrolled->state_capacity, (count + 1) * size + 1,
                       sizeof *unrolled->states) ||
        !array_reserve((void **)&unrolled->pieces, &unrolled->piece_capacity, (count + 1) * contacts + 1,
                       sizeof *unrolled->pieces) ||
        !array_reserve((void **)&unrolled->factors, &unrolled->factor_capacity, count + 1, sizeof *unrolled->factors) ||
        !array_reserve((void **)&unrolled->adjoints, &unrolled->adjoint_capacity, 2 * size + 1,
                       sizeof *unrolled->adjoints))
        return false;
    double *now = unrolled->states;
    memcpy(now, problem->free, 3 * (size_t)problem->body_count * sizeof *now);
    for (size_t i = 0; i < contacts; i++) {
        const UnrolledContact *contact = &problem->contacts[i];
        double *impulse = now + 3 * problem->body_count + 2 * i;
        const double normal = start[2 * i] > 0 ? start[2 * i] : 0, limit = contact->friction * normal;
        impulse[0] = normal;
        impulse[1] = clamp(start[2 * i + 1], limit);
        unrolled->pieces[i] = piece_of(start[2 * i], start[2 * i + 1], limit);
        push(problem, contact, now, impulse[0], impulse[1]);
    }
    for (size_t s = 0; s < count; s++, now += size) {
        const double factor = unrolled->factors[s] = s > 0 ? factors[s] : 0;
        const double *before = s > 0 ? now - size : now;
        double *next = now + size;
        for (size_t i = 0; i < size; i++) next[i] = now[i] + factor * (now[i] - before[i]);
        uint8_t *pieces = unrolled->pieces + (s + 1) * contacts;
        double *impulses = next + 3 * problem->body_count;
        for (size_t i = 0; i < contacts; i++) {
            const int32_t at = problem->visits[i];
            pieces[at] = visit(problem, &problem->contacts[at], next, impulses + 2 * at);
        }
    }
    unrolled->sweeps = sweeps;
    unrolled->velocities = now;
    unrolled->impulses = now + 3 * problem->body_count;
    return true;
}

void unrolled_back(Unrolled *unrolled, const UnrolledProblem *problem, const double *by_velocity, double *by_start,
                   double *by_factors) {
    const size_t size = state_size(problem), contacts = (size_t)problem->contact_count;
    double *adjoint = unrolled->adjoints, *impulses = adjoint + 3 * problem->body_count;
    double *later = adjoint + size; /* contribution of the extrapolation one sweep later */
    memset(adjoint, 0, 2 * size * sizeof *adjoint);
    for (int i = 0; i < problem->body_count; i++) {
        adjoint[3 * i] = problem->inv_mass[i] * by_velocity[3 * i];
        adjoint[3 * i + 1] = problem->inv_mass[i] * by_velocity[3 * i + 1];
        adjoint[3 * i + 2] = problem->inv_inertia[i] * by_velocity[3 * i + 2];
    }
    for (size_t s = (size_t)unrolled->sweeps; s-- > 0;) {
        const uint8_t *pieces = unrolled->pieces + (s + 1) * contacts;
        for (size_t i = contacts; i-- > 0;) {
            const int32_t at = problem->visits[i];
            visit_back(problem, &problem->contacts[at], pieces[at], adjoint, impulses + 2 * at);
        }
        if (by_factors != NULL && s > 0) {
            const double *now = unrolled->states + s * size + 3 * problem->body_count, *before = now - size;
            double sum = 0;
            for (size_t i = 0; i < contacts; i++) {
                double by[2];
                by_impulse(problem, (int)i, adjoint, by);
                sum += by[0] * (now[2 * i] - before[2 * i]) + by[1] * (now[2 * i + 1] - before[2 * i + 1]);
            }
            by_factors[s] += sum;
        }
        const double factor = unrolled->factors[s];
        for (size_t i = 0; i < size; i++) {
            const double at = adjoint[i];
            adjoint[i] = at + factor * at + later[i];
            later[i] = -factor * at;
        }
    }
    for (int i = 0; i < problem->contact_count; i++) {
        double by[2];
        by_impulse(problem, i, adjoint, by);
        const uint8_t piece = unrolled->pieces[i];
        by_start[2 * i] = pushes[piece] * (by[0] + side[piece] * problem->contacts[i].friction * by[1]);
        by_start[2 * i + 1] = within[piece] * by[1];
    }
}

void scene_net_samples_free(SceneNetSamples *samples) {
    for (int i = 0; i < samples->count; i++) {
        SceneNetSample *sample = &samples->items[i];
        problem_copy_free(&sample->step.problem);
        free(sample->step.velocities);
        unrolled_problem_free(&sample->unrolled);
        scene_view_free(&sample->view);
        free(sample->inputs);
    }
    free(samples->items);
    *samples = (SceneNetSamples){0};
}

bool scene_net_samples_take(SceneNetSamples *samples, RecordedSteps *steps) {
    if (!array_reserve((void **)&samples->items, &samples->capacity, (size_t)samples->count + steps->count + 1,
                       sizeof *samples->items))
        return false;
    for (size_t i = 0; i < steps->count; i++)
        samples->items[samples->count++] = (SceneNetSample){.step = steps->items[i]};
    samples->unconverged += steps->unconverged;
    steps->count = steps->unconverged = 0;
    return true;
}

bool scene_net_samples_look(SceneNetSamples *samples, int first, const SceneNet *network, Error *error) {
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 64) reduction(&& : ok)
    for (int i = first; i < samples->count; i++) {
        SceneNetSample *sample = &samples->items[i];
        if (sample->inputs == NULL) sample->inputs = malloc((size_t)scene_net_inputs(network) * sizeof *sample->inputs);
        const bool fine =
            sample->inputs != NULL &&
            (sample->unrolled.contacts != NULL || unrolled_problem_make(&sample->unrolled, &sample->step.problem)) &&
            scene_view_take(&sample->view, network, &sample->step.problem);
        if (fine) scene_net_look(network, &sample->view.slots, sample->inputs);
        ok = ok && fine;
    }
    return ok || error_memory(error, "samples");
}

static const double linear_from = 0.3;  /* threshold of smooth L1, in scales */
static const double least_error = 0.01; /* m/s: below it the loss is nearly quadratic */

void scene_net_loss_free(SceneNetLoss *loss) {
    unrolled_free(&loss->unrolled);
    free(loss->outputs);
    free(loss->by_outputs);
    free(loss->numbers);
    *loss = (SceneNetLoss){0};
}

/* Smooth L1 and its derivative. */
static double smooth(double x, double *by) {
    const double size = fabs(x);
    *by = size < linear_from ? x / linear_from : copysign(1, x);
    return size < linear_from ? x * x / (2 * linear_from) : size - linear_from / 2;
}

/* Returns the impulse loss; writes its derivative with respect to the outputs. */
static double impulse_loss(const SceneNet *network, const SceneNetSample *sample, const double *start, double weight,
                           float *by_outputs) {
    const SceneNetView *slots = &sample->view.slots;
    double sum = 0;
    for (int i = 0; i < slots->slot_count; i++) {
        const int contact = sample->view.contacts[i];
        const double scale = (double)network->scale[slots->slots[i]], share = weight / slots->slot_count;
        const double goal[2] = {(double)sample->step.impulses[contact].normal,
                                (double)sample->step.impulses[contact].tangent};
        for (int k = 0; k < 2; k++) {
            double by;
            sum += share * smooth((start[2 * contact + k] - goal[k]) / scale, &by);
            by_outputs[2 * i + k] = (float)(share * by / scale);
        }
    }
    return sum;
}

/* Adds the velocity loss to the score and, if `back`, its derivative to loss->by_outputs. The error is that of
   solution_error(). */
static bool velocity_loss(SceneNetLoss *loss, const SceneNetSample *sample, const SceneNetTask *task, bool back,
                          double *by_factors, SceneNetErrors *score) {
    const SceneNetView *slots = &sample->view.slots;
    const ContactProblem *problem = &sample->step.problem;
    double *start = loss->numbers, *by_start = start + 2 * problem->contact_count,
           *by_velocity = by_start + 2 * problem->contact_count, sum = 0;
    if (!unrolled_run(&loss->unrolled, &sample->unrolled, start, task->factors, task->sweeps)) return false;
    int counted = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *goal = &sample->step.velocities[i];
        const double *velocity = loss->unrolled.velocities + 3 * i;
        double *by = by_velocity + 3 * i; /* half the derivative of the squared error */
        by[0] = velocity[0] - goal->x;
        by[1] = velocity[1] - goal->y;
        by[2] = (velocity[2] - goal->spin) / 6;
        if (!(problem->bodies[i].inv_mass > 0)) by[0] = by[1] = by[2] = 0;
        counted += problem->bodies[i].inv_mass > 0;
        sum += by[0] * by[0] + by[1] * by[1] + 6 * by[2] * by[2];
    }
    score->error = counted > 0 ? sqrt(sum / counted) : 0;
    const double root = sqrt(score->error * score->error + least_error * least_error);
    score->loss += task->velocity_weight * root;
    if (!back) return true;
    for (int i = 0; i < 3 * problem->body_count; i++) by_velocity[i] *= task->velocity_weight / (counted * root);
    unrolled_back(&loss->unrolled, &sample->unrolled, by_velocity, by_start, by_factors);
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) loss->by_outputs[2 * i + k] += (float)by_start[2 * sample->view.contacts[i] + k];
    return true;
}

/* The gradient entry of a parameter. */
static float *place(const SceneNet *network, float *gradient, const float *parameter) {
    return gradient + (parameter - network->parameters);
}

static void back_through_layer(const SceneNet *network, const SceneNetLayer *layer, const float *in, const float *out,
                               float *by_out, float *by_in, float *gradient) {
    const RowKernels *kernels = network->kernels;
    float *biases = place(network, gradient, layer->biases);
    for (int j = 0; j < layer->to; j++) by_out[j] *= 1 - out[j] * out[j];
    for (int j = 0; j < layer->to; j++) biases[j] += by_out[j];
    kernels->spread(place(network, gradient, layer->rows), layer->to, NULL, in, by_out, layer->from);
    if (by_in != NULL) kernels->multiply(by_in, &layer->packed, NULL, by_out, layer->from / 2);
}

static void back(SceneNetLoss *loss, const SceneNet *network, const SceneNetSample *sample, float *gradient) {
    const SceneNetView *slots = &sample->view.slots;
    const RowKernels *kernels = network->kernels;
    const int hidden = scene_net_hidden(network), outputs = 2 * slots->slot_count;
    float *biases = place(network, gradient, network->biases), *by = loss->by_outputs;
    for (int i = 0; i < outputs; i++) {
        by[i] *= network->scale[slots->slots[i / 2]];
        biases[slots->impulses[i]] += by[i];
    }
    memset(loss->by_second, 0, sizeof loss->by_second);
    kernels->add(loss->by_second, &network->packed, slots->impulses, by, outputs);
    kernels->spread(place(network, gradient, network->rows), hidden, slots->impulses, by, loss->second, outputs);
    back_through_layer(network, &network->second, loss->first, loss->second, loss->by_second, loss->by_first, gradient);
    back_through_layer(network, &network->first, sample->inputs, loss->first, loss->by_first, NULL, gradient);
}

bool scene_net_loss(SceneNetLoss *loss, const SceneNet *network, const SceneNetSample *sample, const SceneNetTask *task,
                    float *gradient, double *by_factors, SceneNetErrors *score) {
    const SceneNetView *slots = &sample->view.slots;
    const size_t contacts = (size_t)sample->step.problem.contact_count,
                 bodies = (size_t)sample->step.problem.body_count;
    if (!array_reserve((void **)&loss->outputs, &loss->output_capacity, 2 * contacts + 2, sizeof(float)) ||
        !array_reserve((void **)&loss->by_outputs, &loss->by_output_capacity, 2 * contacts + 2, sizeof(float)) ||
        !array_reserve((void **)&loss->numbers, &loss->number_capacity, 4 * contacts + 3 * bodies, sizeof(double)))
        return false;
    scene_net_predict(network, sample->inputs, slots, loss->first, loss->second, loss->outputs);
    double *start = loss->numbers;
    for (int i = 0; i < sample->step.problem.contact_count; i++) {
        start[2 * i] = (double)sample->view.base[i].normal;
        start[2 * i + 1] = (double)sample->view.base[i].tangent;
    }
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) start[2 * sample->view.contacts[i] + k] += (double)loss->outputs[2 * i + k];
    *score = (SceneNetErrors){.loss = impulse_loss(network, sample, start, task->impulse_weight, loss->by_outputs)};
    const bool run_sweeps = task->velocity_weight > 0 || gradient == NULL;
    if (run_sweeps && !velocity_loss(loss, sample, task, gradient != NULL, by_factors, score)) return false;
    if (gradient != NULL) back(loss, network, sample, gradient);
    return true;
}

/* A batch has a fixed number of parts, so that the order of sums does not depend on the number of threads. */
enum { BATCH = 32, PARTS = 4, PART = BATCH / PARTS };

typedef struct Fitter {
    SceneNet *network;
    const SceneNetSamples *samples;
    const SceneNetFit *fit;
    float *gradients;     /* [PARTS, parameter_count] */
    float *mean, *square; /* [parameter_count] moments of Adam; in double they would need twice the memory */
    double factors[SCENE_NET_SWEEPS_MAX], factor_mean[SCENE_NET_SWEEPS_MAX], factor_square[SCENE_NET_SWEEPS_MAX];
    double by_factors[PARTS][SCENE_NET_SWEEPS_MAX], losses[PARTS];
    SceneNetLoss loss[PARTS];
    Adam adam;  /* of the factors; its steps are those of all parameters */
    int *order; /* [samples] */
} Fitter;

/* The gradients of a batch, one per part. */
static bool do_batch(Fitter *fitter, const SceneNetTask *task, const int *items, int count) {
    bool ok = true;
#pragma omp parallel for schedule(static, 1) reduction(&& : ok)
    for (int part = 0; part < PARTS; part++) {
        const int begin = part * PART < count ? part * PART : count, end = begin + PART < count ? begin + PART : count;
        float *gradient = fitter->gradients + (size_t)part * fitter->network->parameter_count;
        double *by_factors = fitter->fit->learn_factors && task->velocity_weight > 0 ? fitter->by_factors[part] : NULL;
        bool done = true;
        for (int i = begin; done && i < end; i++) {
            SceneNetErrors score;
            done = scene_net_loss(&fitter->loss[part], fitter->network, &fitter->samples->items[items[i]], task,
                                  gradient, by_factors, &score);
            if (done) fitter->losses[part] += score.loss;
        }
        ok = ok && done;
    }
    return ok;
}

static void step_parameters(Fitter *fitter, int count, const AdamStep *step) {
    const int64_t parameters = (int64_t)fitter->network->parameter_count;
#pragma omp parallel for schedule(static)
    for (int64_t p = 0; p < parameters; p++) {
        float sum = 0;
        for (int part = 0; part < PARTS; part++) {
            sum += fitter->gradients[part * parameters + p];
            fitter->gradients[part * parameters + p] = 0;
        }
        double mean = (double)fitter->mean[p], square = (double)fitter->square[p];
        fitter->network->parameters[p] -= (float)adam_change(step, (double)sum / count, &mean, &square);
        fitter->mean[p] = (float)mean;
        fitter->square[p] = (float)square;
    }
    scene_net_pack_layers(fitter->network);
}

/* Factors are clamped to 0 .. 2: extrapolating further than two sweeps gains nothing. */
static void step_factors(Fitter *fitter, int count, const AdamStep *step) {
    for (int s = 1; s < fitter->network->sweeps; s++) {
        double sum = 0;
        for (int part = 0; part < PARTS; part++) {
            sum += fitter->by_factors[part][s];
            fitter->by_factors[part][s] = 0;
        }
        fitter->factors[s] -= adam_change(step, sum / count, &fitter->adam.mean[s], &fitter->adam.square[s]);
        fitter->factors[s] = fmin(fmax(fitter->factors[s], 0), 2);
    }
}

static bool do_epoch(Fitter *fitter, int epoch, double *mean_loss) {
    const bool impulses_only = epoch < fitter->fit->impulse_epochs;
    const SceneNetTask task = {impulses_only ? 1 : fitter->fit->impulse_weight, impulses_only ? 0 : 1,
                               fitter->network->sweeps, fitter->factors};
    const int count = fitter->samples->count, batches = (count + BATCH - 1) / BATCH;
    memset(fitter->losses, 0, sizeof fitter->losses);
    for (int batch = 0; batch < batches; batch++) {
        const int first = batch * BATCH, size = count - first < BATCH ? count - first : BATCH;
        if (!do_batch(fitter, &task, fitter->order + first, size)) return false;
        const double done = (epoch + (double)batch / batches) / fitter->fit->epochs;
        const AdamStep step = adam_next(&fitter->adam, fitter->fit->rate * adam_cosine(done));
        step_parameters(fitter, size, &step);
        if (fitter->fit->learn_factors && task.velocity_weight > 0) step_factors(fitter, size, &step);
    }
    *mean_loss = 0;
    for (int part = 0; part < PARTS; part++) *mean_loss += fitter->losses[part] / count;
    return true;
}

bool scene_net_fit(SceneNet *network, const SceneNetSamples *samples, const SceneNetFit *fit, const Progress *progress,
                   Error *error) {
    const size_t parameters = network->parameter_count;
    Fitter *fitter = calloc(1, sizeof *fitter);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    bool ok = fitter != NULL && generator != NULL;
    if (ok) {
        gsl_rng_set(generator, (unsigned long)fit->seed);
        *fitter = (Fitter){.network = network, .samples = samples, .fit = fit};
        fitter->gradients = calloc((PARTS + 2) * parameters, sizeof *fitter->gradients);
        fitter->order = malloc(((size_t)samples->count + 1) * sizeof *fitter->order);
        ok = fitter->gradients != NULL && fitter->order != NULL;
    }
    if (ok) {
        fitter->mean = fitter->gradients + PARTS * parameters;
        fitter->square = fitter->mean + parameters;
        for (int s = 0; s < network->sweeps; s++) fitter->factors[s] = (double)network->factors[s];
        fitter->adam = adam_over(fitter->factors, fitter->factor_mean, fitter->factor_square, network->sweeps, 0,
                                 ADAM_SQUARE_DECAY);
        for (int i = 0; i < samples->count; i++) fitter->order[i] = i;
    }
    if (!ok) error_memory(error, "scene-net");
    for (int epoch = 0; ok && epoch < fit->epochs; epoch++) {
        double loss;
        gsl_ran_shuffle(generator, fitter->order, (size_t)samples->count, sizeof *fitter->order);
        ok = do_epoch(fitter, epoch, &loss) || error_memory(error, "scene-net");
        if (ok && !isfinite(loss)) ok = error_input(error, "scene-net", "training diverged in epoch %d", epoch + 1);
        if (ok && !progress_report(progress, epoch + 1, fit->epochs)) break;
    }
    for (int s = 0; ok && s < network->sweeps; s++) network->factors[s] = (float)fitter->factors[s];
    for (int part = 0; fitter != NULL && part < PARTS; part++) scene_net_loss_free(&fitter->loss[part]);
    if (fitter != NULL) {
        free(fitter->gradients);
        free(fitter->order);
    }
    free(fitter);
    if (generator != NULL) gsl_rng_free(generator);
    return ok;
}

bool scene_net_error(const SceneNet *network, const SceneNetSamples *samples, double *mean, Error *error) {
    double factors[SCENE_NET_SWEEPS_MAX], sum = 0;
    for (int s = 0; s < network->sweeps; s++) factors[s] = (double)network->factors[s];
    const SceneNetTask task = {0, 1, network->sweeps, factors};
    SceneNetLoss *losses = calloc((size_t)omp_get_max_threads(), sizeof *losses);
    double *errors = calloc((size_t)samples->count + 1, sizeof *errors);
    bool ok = losses != NULL && errors != NULL;
#pragma omp parallel for schedule(dynamic, 16) reduction(&& : ok) if (ok)
    for (int i = 0; i < samples->count; i++) {
        SceneNetErrors score = {0};
        if (ok)
            ok = scene_net_loss(&losses[omp_get_thread_num()], network, &samples->items[i], &task, NULL, NULL, &score);
        if (ok) errors[i] = score.error;
    }
    for (int i = 0; ok && i < samples->count; i++) sum += errors[i];
    *mean = samples->count > 0 ? sum / samples->count : NAN;
    for (int i = 0; losses != NULL && i < omp_get_max_threads(); i++) scene_net_loss_free(&losses[i]);
    free(losses);
    free(errors);
    return ok || error_memory(error, "scene-net");
}

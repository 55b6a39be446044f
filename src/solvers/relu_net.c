/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses (sequential_impulses.c) written as a network of rectifiers, relu(x) = max(x, 0). With m = mu Pn'
   and w = Pt - mass_t vt,

       Pn' = relu(Pn - mass_n (vn - bias)),   Pt' = -m + relu(w + m) - relu(w - m)

   because max(x, 0) is a rectifier and a clamp is a difference of two: below -m both are 0, between -m and m only the
   second is 0, and above m they differ by 2 m. All other operations are linear: velocities at a contact, the effect of
   an impulse, accumulation. So k sweeps are a network with 2 k layers per contact, of one and of two rectifiers, whose
   weights are computed from the contact problem: nothing is trained, and it is valid for every scene. Apart from
   rounding it equals the engine: tangent impulses come from a sum and a difference.

   It is neither faster nor more accurate, but shows what a network can achieve. A network that sees one contact at a
   time, its velocity and its accumulated impulse, does not fail for lack of neurons: three are enough to equal the
   engine. What the engine lacks in stacks and pyramids is information beyond the contact, which more neurons per
   contact do not add. Source of ReLU networks as piecewise linear functions, and of these functions as networks: Arora,
   Basu, Mianjy, Mukherjee, "Understanding Deep Neural Networks with Rectified Linear Units" (2018). */
#include "network/activation.h"
#include "solvers/solvers.h"
#include "sweeps/contact_velocity.h"
#include "sweeps/sequential_impulses.h"
#include "sweeps/sweeps.h"

#include <stdlib.h>

typedef struct ReluNet {
    int sweep_count;
} ReluNet;

static const SettingSpec settings[] = {{"k", "sweeps over all contacts per step (default: the scene's, else 10)"},
                                       {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    ReluNet values = {.sweep_count = 10};
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &values.sweep_count, error)) return NULL;
    ReluNet *solver = malloc(sizeof *solver);
    if (solver == NULL)
        error_memory(error, "relu-net");
    else
        *solver = values;
    return solver;
}

/* The layers of one contact: the normal impulse, then the tangent impulse from the velocities that result. */
static void visit(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                  ContactImpulse *sum) {
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];
    const float separating = vec2_dot(contact_relative_velocity(a, b, contact), contact->normal);
    const float normal = relu_float(sum->normal - contact->mass_normal * (separating - contact->bias));
    contact_apply(a, b, contact, bodies, vec2_scale(normal - sum->normal, contact->normal));

    const Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    const float sliding = vec2_dot(contact_relative_velocity(a, b, contact), direction);
    const float stopping = sum->tangent - contact->mass_tangent * sliding, limit = contact->friction * normal;
    const float tangent = -limit + relu_float(stopping + limit) - relu_float(stopping - limit);
    contact_apply(a, b, contact, bodies, vec2_scale(tangent - sum->tangent, direction));
    *sum = (ContactImpulse){normal, tangent};
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    (void)error;
    static const SequentialOptions start = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    const ReluNet *solver = state;
    sequential_impulses_begin(problem, &start, solution);
    for (int sweep = 0; sweep < solver->sweep_count; sweep++)
        for (int i = 0; i < problem->contact_count; i++)
            visit(&problem->contacts[i], problem->bodies, solution->velocities, &solution->impulses[i]);
    return true;
}

const ContactSolverKind solver_relu_net = {
    .description = {.name = "relu-net",
                    .summary = "sequential impulses written as a ReLU network; nothing is trained",
                    .caption = "sequential impulses as a ReLU network",
                    .look = {METHOD_WINE, METHOD_CIRCLE},
                    .settings = settings,
                    .chart = METHOD_NO_RUNS,
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = free};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Augmented vertex block descent (AVBD): a step is implicit Euler, solved on positions, body after body. Chris Giles,
   Elie Diaz and Cem Yuksel, "Augmented Vertex Block Descent" (SIGGRAPH 2025), with the choices of their 2D program.

   d is the displacement of a body in the step (x, y, angle), y = v dt + g dt^2 what it would be without contacts, J the
   gradient of a contact's gap C(d) = C0 + J d. A visit of a body solves one 3 x 3 system,

       (M / dt^2 + sum k J J^T) delta = -M / dt^2 (d - y) + sum J f,   f = l - k C,   f >= 0 or |f| <= mu l_normal

   and adds delta to d. After each pass over the bodies, every contact takes l = f, and the penalty k rises by beta |C|
   while f is inside its bounds. l and k are those of the step before, k times gamma. So the forces come from the
   multipliers l, and k need not be large.

   Overlap does not change velocities: C0 is left out of the passes, the velocity is d / dt after the last of them, and
   one more pass with C0 moves the bodies out (post-stabilization, the default of the 2D program). With the setting
   alpha, every pass has (1 - alpha) C0 and multipliers decay by alpha gamma, as in the paper.

   Contacts that stick keep their points on both bodies, so that a slope does not creep. The gap ends at
   COLLISION_MARGIN, or resting contacts would come and go.

   Fails where passes are few: bodies move by what their neighbours did before, so momentum is not conserved until the
   passes have converged, and a shock moves up a stack one box a pass. New contacts begin soft. */
#include "simulate/avbd.h"

#include <math.h>
#include <stdlib.h>

static const SettingSpec settings[] = {
    {"k", "passes over all bodies per step (default: 10)"},
    {"alpha", "share of the overlap that a step leaves (default: one more pass removes it instead)"},
    {"beta", "rise of a penalty, N/m for each m of gap and pass (default: 1e5)"},
    {"gamma", "share of a penalty that the next step begins with (default: 0.99)"},
    {NULL, NULL}};

static void destroy(void *state) {
    Avbd *avbd = state;
    step_memory_free(&avbd->memory);
    free(avbd->bodies);
    free(avbd->rotations);
    free(avbd->poses);
    free(avbd->before);
    free(avbd->contacts);
    free(avbd->last);
    free(avbd->visits);
    free(avbd);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    (void)scene;
    Avbd *avbd = calloc(1, sizeof *avbd);
    if (avbd == NULL) {
        error_memory(error, "avbd");
        return NULL;
    }
    *avbd = (Avbd){.iterations = 10, .alpha = -1, .beta = 1e5f, .gamma = 0.99f};
    if (settings_int(chosen, "k", 1, 10000, &avbd->iterations, error) &&
        settings_float(chosen, "alpha", 0, 1, &avbd->alpha, error) &&
        settings_float(chosen, "beta", 0, 1e12f, &avbd->beta, error) &&
        settings_float(chosen, "gamma", 0, 1, &avbd->gamma, error))
        return avbd;
    destroy(avbd);
    return NULL;
}

/* The momentum that no contact force accounts for: 0 once the passes have converged. */
static float momentum_error(const Avbd *avbd, const ContactProblem *problem, const ContactSolution *solution) {
    float sum = 0;
    for (int i = 0; i < avbd->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (!(body->inv_mass > 0)) continue;
        Vec2 change = vec2_scale(1.0f / body->inv_mass, vec2_sub(solution->velocities[i].linear, body->velocity));
        for (int v = avbd->bodies[i].first; v < avbd->bodies[i].first + avbd->bodies[i].count; v++) {
            const ContactPoint *point = &problem->contacts[avbd->visits[v]];
            const ContactImpulse *impulse = &solution->impulses[avbd->visits[v]];
            Vec2 given = vec2_add(vec2_scale(impulse->normal, point->normal),
                                  vec2_scale(impulse->tangent, vec2_cross_scalar(point->normal, 1.0f)));
            change = point->b == i ? vec2_sub(change, given) : vec2_add(change, given);
        }
        sum += sqrtf(vec2_dot(change, change));
    }
    return sum;
}

/* False if an impulse is NaN or infinite. */
static bool end(Avbd *avbd, const ContactProblem *problem, ContactSolution *solution) {
    bool finite = true;
    for (int i = 0; i < avbd->body_count; i++) {
        const Vec3 *moved = &avbd->bodies[i].moved;
        avbd->poses[i].position = vec2_add(avbd->poses[i].position, vec2(moved->x, moved->y));
        avbd->poses[i].angle += moved->turn;
    }
    for (int i = 0; i < avbd->contact_count; i++) {
        const AvbdContact *contact = &avbd->contacts[i];
        solution->impulses[i] =
            (ContactImpulse){problem->dt * contact->normal.force, problem->dt * contact->tangent.force};
        finite &= isfinite(solution->impulses[i].normal) && isfinite(solution->impulses[i].tangent);
    }
    return finite;
}

/* What the next step begins with. */
static void keep(Avbd *avbd, const World *world) {
    AvbdContact *contacts = avbd->last;
    size_t capacity = avbd->last_capacity;
    avbd->last = avbd->contacts;
    avbd->last_capacity = avbd->contact_capacity;
    avbd->contacts = contacts;
    avbd->contact_capacity = capacity;
    for (int i = 0; i < avbd->body_count; i++) avbd->before[i] = avbd->bodies[i].start;
    step_memory_keep(&avbd->memory, world);
}

static bool step(void *state, World *world, const Step *which, Error *error) {
    Avbd *avbd = state;
    ContactProblem problem;
    ContactSolution *solution;
    if (!world_begin_step(world, which->scene->dt, &problem, &solution, error)) return false;
    step_solving_begins(which);
    bool begun = avbd_begin(avbd, world, &problem, which);
    if (begun) avbd_solve(avbd, which, &problem, solution);
    bool finite = begun && end(avbd, &problem, solution);
    step_solving_ends(which);
    if (!begun) return error_memory(error, "avbd");
    if (!finite) return error_input(error, "avbd", "an impulse is NaN or infinite");
    solution->momentum_error = momentum_error(avbd, &problem, solution);
    if (!world_end_step_at(world, avbd->poses, error)) return false;
    keep(avbd, world);
    return true;
}

const SteppingKind stepping_avbd = {
    .description = {.name = "avbd",
                    .summary = "augmented vertex block descent: implicit positions, body after body",
                    .caption = "augmented vertex block descent",
                    .look = {METHOD_GREEN, METHOD_DIAMOND},
                    .settings = settings,
                    .own_settings = "k=10",
                    .no_push_out = true,
                    .chart = METHOD_RUNS("k=4", "k=10", "k=20", "k=50"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .step = step,
    .destroy = destroy};

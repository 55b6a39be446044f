/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a step is for each island. */
#include "methods/interior_look.h"

#include "engine/engine.h"
#include "methods/interior_point_internal.h"

#include <math.h>

/* Speeds at rest are multiples of the island's pace, which a body has after a fall through five slops: 1 m/s on Earth.
   An island is calm if bodies that touch move there, relative to each other, by less than `calm_below` and what gravity
   adds in a step. Each contact counts, not the mean, which is small if a bomb strikes one of many boxes. The tolerance
   of calm islands is at most `calm_near`, or `many_near` among many bodies, where smaller ones take a tenth more time;
   `slippery_near` without friction, where nothing holds what an error moves: a stack of 12 stands 380 s, and 160 s at
   2e-5; and `slender_near` in towers: at 1e-4 a stack of 40 falls, and at 3e-5 some stacks of 41 to 60 boxes sway for
   seconds; at 1e-5 no step ends with sweeps, and rounding errors of iterations move a stack of 20 by 15 um in 10 s. */
static const float calm_below = 1.03f, calm_near = 1e-4f, many_near = 4e-4f, slippery_near = 1e-6f,
                   slender_near = 2e-5f;
/* In calm islands plain sweeps are enough below this, or below so many roundings of what the impulses hold; without
   friction, and in towers, only below the latter. At 1e-4 a house of cards falls, and a stack of 60 at 3 roundings. */
static const float still = 2e-5f, roundings = 0.3f;
/* A calm island of some size whose first sweeps leave more than this multiple of the tolerance of impacts is
   restless. */
static const float restless_from = 2;
/* Multiples of the other's mass, of two bodies that touch. Beyond the first, sweeps carry little between them. Beyond
   the second, iterations from near the bounds break down at impacts: on 36 boxes under a bomb of 1e5 times their mass,
   the error of sweeps of the same work is 3.5 times that of interior if it tries them, 10 times if not. */
static const float uneven_from = 10, heavy_from = 100;
/* Of the pace. */
static const float closing = 1e-3f, calm_speed = 10;

static float smaller(float x, float y) { return x < y ? x : y; }
static float larger(float x, float y) { return x > y ? x : y; }

static bool is_uneven(float inv_mass_a, float inv_mass_b, float from) {
    return inv_mass_a > 0 && inv_mass_b > 0 && (inv_mass_a > from * inv_mass_b || inv_mass_b > from * inv_mass_a);
}

static void look_at_contact(InteriorLook *look, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    const float motion = residual_of_motion(problem, i);
    if (!(motion <= look->fastest)) look->fastest = motion; /* NaN, too */
    look->slippery |= contact->friction < INTERIOR_SLIPPERY;
    const float inv_mass_a = problem->bodies[contact->a].inv_mass, inv_mass_b = problem->bodies[contact->b].inv_mass;
    look->uneven |= is_uneven(inv_mass_a, inv_mass_b, uneven_from);
    look->heavy |= is_uneven(inv_mass_a, inv_mass_b, heavy_from);
}

bool interior_look_jams(const InteriorLook *look) { return look->slippery || look->uneven; }

static float tolerance(const InteriorLook *look, float near) {
    if (!look->calm) return near;
    if (look->slippery) return smaller(near, slippery_near * look->pace);
    if (look->slender) return smaller(near, slender_near * look->pace);
    return smaller(near, look->many && !look->uneven ? many_near * look->pace : calm_near * look->pace);
}

static void interior_look_decide(InteriorLook *look, float near) {
    const float limit = look->fall + calm_below * look->pace;
    look->calm = look->fastest < limit * limit;
    look->near = tolerance(look, near);
    look->enough = look->calm && look->many ? look->near : near;
}

void interior_look(InteriorLook *looks, const Islands *islands, const ContactProblem *problem, float near) {
    const float pace = sqrtf(10 * CONTACT_SLOP * problem->fall / problem->dt);
    for (int k = 0; k < islands->count; k++)
        looks[k] = (InteriorLook){.bodies = islands->islands[k].bodies,
                                  .loops = islands->islands[k].loops,
                                  .fall = problem->fall,
                                  .pace = pace,
                                  .slender = islands->islands[k].bodies > 4 * (islands->islands[k].loops + 1),
                                  .many = islands->islands[k].bodies > INTERIOR_MANY_BODIES};
    for (int i = 0; i < problem->contact_count; i++)
        if (islands->island[i] >= 0) look_at_contact(&looks[islands->island[i]], problem, i);
    for (int k = 0; k < islands->count; k++) interior_look_decide(&looks[k], near);
}

void interior_look_at_residuals(InteriorLook *looks, const Sweeps *sweeps, const int32_t *island) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int32_t k = island != NULL ? island[sweeps->first[i]] : 0;
        if (k < 0) continue;
        const PairResidual residual = residual_of_pair(sweeps, i);
        looks[k].left.visit += residual.visit;
        looks[k].left.held += residual.held;
    }
}

double interior_look_residual(const InteriorLook *look, int contacts) {
    return sqrt((double)look->left.visit / contacts);
}

bool interior_look_is_still(const InteriorLook *look, int contacts) {
    const float held = sqrtf(look->left.held / (float)contacts);
    const float least = look->slippery || look->slender ? 0 : still * look->pace;
    const float limit = larger(roundings * 0x1p-24f * (look->pace + held), least);
    return look->calm && look->left.visit < limit * limit * (float)contacts;
}

void interior_look_again(InteriorLook *look, float near, int contacts) {
    const float limit = restless_from * near;
    look->restless = look->calm && look->bodies > INTERIOR_FEW_BODIES && !look->slippery && !look->slender &&
                     look->left.visit > limit * limit * (float)contacts;
    if (look->restless) look->near = look->enough = near;
}

double interior_look_speed(const InteriorLook *look) {
    return look->calm ? (double)(calm_speed * look->pace) : sqrt((double)look->fastest);
}

double interior_look_closing(const InteriorLook *look, float near) {
    return (double)smaller(near, closing * look->pace);
}

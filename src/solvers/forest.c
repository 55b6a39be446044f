/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/forest.h"

#include "common/array.h"
#include "sweeps/contact_velocity.h"

#include <math.h>
#include <stdlib.h>

void forest_free(Forest *forest) {
    free(forest->bodies);
    free(forest->pairs);
    *forest = (Forest){0};
}

static void link_bodies(Forest *forest, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        forest->bodies[i] = (ForestBody){.after = {body->velocity, body->angular_velocity}};
    }
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) {
        ForestBody *ends[] = {&forest->bodies[problem->contacts[i].a], &forest->bodies[problem->contacts[i].b]};
        for (int k = 0; k < 2; k++) {
            ends[k]->pairs++;
            ends[k]->links ^= i;
        }
    }
}

/* Collects pairs from the tips down, and removes them from their bodies. Bodies that keep pairs are static or in a
   loop. */
static void collect_pairs(Forest *forest, const ContactProblem *problem) {
    forest->pair_count = 0;
    for (int i = 0; i < problem->body_count; i++)
        for (int above = i; forest->bodies[above].pairs == 1 && problem_body_moves(&problem->bodies[above]);) {
            int first = forest->bodies[above].links;
            const ContactPoint *contact = &problem->contacts[first];
            int below = contact->a == above ? contact->b : contact->a;
            forest->pairs[forest->pair_count++] =
                (ForestPair){first, contact_surface_points(problem, first), above, below};
            forest->bodies[above].pairs = 0;
            forest->bodies[below].pairs--;
            forest->bodies[below].links ^= first;
            above = below;
        }
}

/* 1 if the body above is b of the contact, which a positive impulse pushes; -1 if it is a. */
static float side_of(const ForestPair *pair, const ContactPoint *contact) {
    return contact->b == pair->above ? 1.0f : -1.0f;
}

static Vec2 arm_above(float side, const ContactPoint *contact) { return side > 0 ? contact->arm_b : contact->arm_a; }
static Vec2 arm_below(float side, const ContactPoint *contact) { return side > 0 ? contact->arm_a : contact->arm_b; }

/* The velocity of the body above, if both contacts stick. False if the velocity of the body below is unknown. */
static bool carry(Forest *forest, const ContactProblem *problem, const ForestPair *pair) {
    const ContactPoint *contact = &problem->contacts[pair->first];
    const ForestBody *below = &forest->bodies[pair->below];
    ForestBody *above = &forest->bodies[pair->above];
    above->grounded = pair->points == 2 && (below->grounded || !problem_body_moves(&problem->bodies[pair->below]));
    if (!above->grounded) return false;
    const float side = side_of(pair, contact);
    const Vec2 arm = arm_above(side, contact);
    const float width = vec2_cross(vec2_sub(arm_above(side, &contact[1]), arm), contact->normal);
    const float spin = below->after.angular + side * (contact[1].bias - contact->bias) / width;
    Vec2 point = vec2_add(below->after.linear, scalar_cross_vec2(below->after.angular, arm_below(side, contact)));
    point = vec2_add(point, vec2_scale(side * contact->bias, contact->normal));
    above->after = (BodyVelocity){vec2_sub(point, scalar_cross_vec2(spin, arm)), spin};
    return true;
}

/* Shares the impulse that the body above needs between two points. False if a point would have to pull or to exceed
   friction, or if a number is NaN or infinite: then as much of the impulse as the cones allow. */
static bool share_out(const ContactPoint *contact, float side, Vec2 push, float turn, ContactImpulse out[2]) {
    const Vec2 normal = contact->normal, tangent = vec2_cross_scalar(normal, 1.0f);
    const Vec2 arm = arm_above(side, contact), other = arm_above(side, &contact[1]);
    const float dragged = side * vec2_dot(push, tangent), needed = side * vec2_dot(push, normal);
    const float lever = vec2_cross(arm, normal), width = vec2_cross(other, normal) - lever;
    const float second = (side * turn - dragged * vec2_cross(arm, tangent) - needed * lever) / width;
    const float pushed = needed > 0 ? needed : 0.0f;
    out[1].normal = contact_clamp(second, 0.0f, pushed);
    out[0].normal = pushed - out[1].normal;
    for (int k = 0; k < 2; k++) {
        const float limit = contact->friction * out[k].normal;
        out[k].tangent = pushed > 0 ? contact_clamp(dragged * (out[k].normal / pushed), -limit, limit) : 0.0f;
    }
    return second >= 0 && second <= needed && fabsf(dragged) <= contact->friction * pushed;
}

/* Impulses for a body and all that it carries, and their reaction on the body below. True if all contacts stick. */
static bool pass_on(Forest *forest, const ContactProblem *problem, const ForestPair *pair, ContactImpulse *impulses) {
    const ContactPoint *contact = &problem->contacts[pair->first];
    const ProblemBody *body = &problem->bodies[pair->above];
    const ForestBody *above = &forest->bodies[pair->above];
    ForestBody *below = &forest->bodies[pair->below];
    const float side = side_of(pair, contact);
    bool holds = false;
    if (above->grounded) {
        Vec2 change = vec2_sub(above->after.linear, body->velocity);
        Vec2 push = vec2_sub(vec2_scale(1.0f / body->inv_mass, change), above->push);
        float turn = (above->after.angular - body->angular_velocity) / body->inv_inertia - above->turn;
        holds = share_out(contact, side, push, turn, impulses);
    }
    const Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
    for (int k = 0; k < pair->points; k++) {
        Vec2 along =
            vec2_add(vec2_scale(impulses[k].normal, contact->normal), vec2_scale(impulses[k].tangent, tangent));
        Vec2 impulse = vec2_scale(-side, along);
        below->push = vec2_add(below->push, impulse);
        below->turn += vec2_cross(arm_below(side, &contact[k]), impulse);
    }
    return holds;
}

bool forest_solve(Forest *forest, const ContactProblem *problem, ContactImpulse *impulses, ForestResult *result) {
    size_t bodies = (size_t)problem->body_count;
    if (!array_reserve((void **)&forest->bodies, &forest->body_capacity, bodies, sizeof *forest->bodies) ||
        !array_reserve((void **)&forest->pairs, &forest->pair_capacity, bodies, sizeof *forest->pairs))
        return false;
    for (int i = 0; i < problem->contact_count; i++)
        impulses[i] = (ContactImpulse){problem->contacts[i].warm_normal, problem->contacts[i].warm_tangent};
    link_bodies(forest, problem);
    collect_pairs(forest, problem);
    int grounded = 0, solved = 0;
    for (int i = forest->pair_count - 1; i >= 0; i--) grounded += carry(forest, problem, &forest->pairs[i]);
    for (int i = 0; i < forest->pair_count; i++) {
        const ForestPair *pair = &forest->pairs[i];
        if (pass_on(forest, problem, pair, &impulses[pair->first])) solved += pair->points;
    }
    *result = solved == problem->contact_count ? FOREST_WHOLE : grounded > 0 ? FOREST_PART : FOREST_NONE;
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What sain sees of a step: the touched bodies, and a row of inputs for each body that touches one. */
#include "methods/sain_view.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

/* m/s, added to each pace: gravity makes 0.17 in a step. Slower motion counts less and less. */
static const float slowest = 0.02f;
/* m. Of the ground, 100 m long, a box feels no more than of one twice its own size. */
static const float size_max = 2.0f;
static const float fastest = 20.0f;   /* m/s: the scale stays below; few corrections are larger */
static const float usual_pace = 1.0f; /* m/s: tells the network a touch from a crash */

/* Two touching bodies, seen from one of them. */
typedef struct SainViewRow {
    int receiver, sender; /* in the problem */
    int points;
    Vec2 normal, at;    /* from the sender to the receiver; mean of the contact points, from the receiver's centre */
    Vec2 before, after; /* m/s: velocity of the sender there relative to the receiver's, before and after the engine */
    float friction, bias;
} SainViewRow;

void sain_view_free(SainView *view) {
    free(view->arrays.memory);
    *view = (SainView){0};
}

static float limited(float x, float pace) { return x / (pace + fabsf(x)); }

static float square(Vec2 v) { return vec2_dot(v, v); }

static BodyVelocity velocity_before(const ProblemBody *body) {
    return (BodyVelocity){body->velocity, body->angular_velocity};
}

/* The cosine of a box's first axis is the largest in the world's direction x among its four; ties keep the first. */
static Vec2 upright_axis(float angle) {
    const Vec2 x = mat22_rotation(angle).column1;
    const Vec2 axes[4] = {x, vec2(-x.y, x.x), vec2(-x.x, -x.y), vec2(x.y, -x.x)};
    int best = 0;
    for (int i = 1; i < 4; i++)
        if (axes[i].x > axes[best].x) best = i;
    return axes[best];
}

/* Receivers in the order of the problem, with the numbers of their rows. */
static void find_receivers(SainView *view, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) view->receivers[i] = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        if (i > 0 && contact->a == contact[-1].a && contact->b == contact[-1].b) continue;
        view->receivers[contact->a]++;
        view->receivers[contact->b]++;
    }
    view->body_count = view->row_count = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const int rows = view->receivers[i];
        view->receivers[i] = -1;
        if (rows == 0 || !problem_body_moves(body)) continue;
        view->receivers[i] = view->body_count;
        view->bodies[view->body_count++] = (SainBody){
            .body = i,
            .first = view->row_count,
            .axis = upright_axis(body->angle),
            .radius = sqrtf(square(body->size) / 12.0f),
            .base = view->changed[i],
        };
        view->row_count += rows;
    }
}

static Vec2 velocity_at(const BodyVelocity *velocity, Vec2 arm) {
    return vec2_add(velocity->linear, scalar_cross_vec2(velocity->angular, arm));
}

/* The row of the contacts from `first` on for the receiver, if it is one. */
static void add_row(SainView *view, const ContactProblem *problem, int first, int points, bool receiver_is_b) {
    const ContactPoint *contact = &problem->contacts[first];
    SainViewRow row = {receiver_is_b ? contact->b : contact->a, receiver_is_b ? contact->a : contact->b, points,
                       receiver_is_b ? contact->normal : vec2_negate(contact->normal), .friction = contact->friction};
    if (view->receivers[row.receiver] < 0) return;
    SainBody *body = &view->bodies[view->receivers[row.receiver]];
    Vec2 arm = {0, 0};
    for (int i = 0; i < points; i++) {
        row.at = vec2_add(row.at, receiver_is_b ? contact[i].arm_b : contact[i].arm_a);
        arm = vec2_add(arm, receiver_is_b ? contact[i].arm_a : contact[i].arm_b);
        row.bias = contact[i].bias > row.bias ? contact[i].bias : row.bias;
    }
    row.at = vec2_scale(1.0f / (float)points, row.at);
    arm = vec2_scale(1.0f / (float)points, arm);
    const BodyVelocity before = velocity_before(&problem->bodies[row.receiver]),
                       before_sender = velocity_before(&problem->bodies[row.sender]);
    row.before = vec2_sub(velocity_at(&before_sender, arm), velocity_at(&before, row.at));
    row.after = vec2_sub(velocity_at(&view->changed[row.sender], arm), velocity_at(&body->base, row.at));
    view->rows[body->first + body->rows++] = row;
}

/* What the engine did to a body, in the frame and with the radius of a receiver. */
typedef struct Change {
    Vec2 linear;
    float spin;
} Change;

static float square_of(Change change) { return square(change.linear) + change.spin * change.spin; }

static Change change_since(const BodyVelocity *before, const BodyVelocity *after, const SainBody *seen_by) {
    return (Change){sain_into_frame(seen_by, vec2_sub(after->linear, before->linear)),
                    seen_by->radius * (after->angular - before->angular)};
}

static Change change_of(const SainView *view, const ContactProblem *problem, int i, const SainBody *seen_by) {
    const BodyVelocity before = velocity_before(&problem->bodies[i]);
    return change_since(&before, &view->changed[i], seen_by);
}

/* Pace: of all velocities that the inputs divide by it. Scale: only what moves between bodies that touch, and what the
   engine did beyond the impulses of the step before. At rest neither is left, so a stack at rest stays at rest. */
static void find_pace(SainView *view, const ContactProblem *problem, SainBody *body) {
    const float radius = body->radius;
    float motion = square_of(change_of(view, problem, body->body, body)),
          unrest = square_of(change_since(&view->warmed[body->body], &body->base, body));
    for (int r = body->first; r < body->first + body->rows; r++) {
        const SainViewRow *row = &view->rows[r];
        const float spin = radius * (problem->bodies[row->sender].angular_velocity -
                                     problem->bodies[row->receiver].angular_velocity),
                    spin_after = radius * (view->changed[row->sender].angular - body->base.angular);
        motion += square(row->before) + spin * spin + row->bias * row->bias + square(row->after) +
                  spin_after * spin_after + square_of(change_of(view, problem, row->sender, body));
        unrest += square(row->after) + spin_after * spin_after;
        if (problem_body_moves(&problem->bodies[row->sender]))
            unrest += square_of(change_since(&view->warmed[row->sender], &view->changed[row->sender], body));
    }
    body->pace = slowest + sqrtf(motion);
    body->scale = fastest * limited(sqrtf(unrest), fastest);
}

static float limited_size(float size) { return size < size_max ? size : size_max; }

static void fill_pair(const SainView *view, const ContactProblem *problem, const SainBody *body, int r) {
    const SainViewRow *row = &view->rows[r];
    const ProblemBody *receiver = &problem->bodies[row->receiver], *sender = &problem->bodies[row->sender];
    const float pace = body->pace, radius = body->radius;
    const Vec2 at = sain_into_frame(body, row->at), normal = sain_into_frame(body, row->normal),
               velocity = sain_into_frame(body, sender->velocity), before = sain_into_frame(body, row->before),
               after = sain_into_frame(body, row->after);
    const Change own = change_of(view, problem, row->receiver, body), its = change_of(view, problem, row->sender, body);
    const float inputs[SAIN_PAIR_INPUTS] = {
        at.x,
        at.y,
        normal.x,
        normal.y,
        vec2_cross(body->axis, upright_axis(sender->angle)),
        (float)row->points,
        row->friction,
        row->bias / pace,
        receiver->inv_mass / (receiver->inv_mass + sender->inv_mass),
        limited_size(receiver->size.x),
        limited_size(receiver->size.y),
        limited_size(sender->size.x),
        limited_size(sender->size.y),
        limited(velocity.x, pace),
        limited(velocity.y, pace),
        before.x / pace,
        before.y / pace,
        radius * (sender->angular_velocity - receiver->angular_velocity) / pace,
        after.x / pace,
        after.y / pace,
        radius * (view->changed[row->sender].angular - body->base.angular) / pace,
        its.linear.x / pace,
        its.linear.y / pace,
        its.spin / pace,
        own.linear.x / pace,
        own.linear.y / pace,
        own.spin / pace,
    };
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) view->pair_inputs[i * view->row_count + r] = inputs[i];
}

static void fill_body(const SainView *view, const ContactProblem *problem, int b) {
    const SainBody *body = &view->bodies[b];
    const ProblemBody *receiver = &problem->bodies[body->body];
    const float pace = body->pace;
    const Vec2 velocity = sain_into_frame(body, receiver->velocity);
    const Change own = change_of(view, problem, body->body, body);
    const float inputs[SAIN_BODY_INPUTS] = {
        body->axis.y,
        limited(velocity.x, pace),
        limited(velocity.y, pace),
        limited(body->radius * receiver->angular_velocity, pace),
        own.linear.x / pace,
        own.linear.y / pace,
        own.spin / pace,
        (float)body->rows,
        limited(pace, usual_pace),
        body->scale / pace,
    };
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) view->body_inputs[i * view->body_count + b] = inputs[i];
}

bool sain_view_make(SainView *view, const ContactProblem *problem, const BodyVelocity *engine) {
    const size_t bodies = (size_t)problem->body_count + 1, rows = 2 * (size_t)problem->contact_count + 1;
    if (!ARRAY_BLOCK_RESERVE(&view->arrays, ARRAY_PART(view->bodies, bodies), ARRAY_PART(view->changed, bodies),
                             ARRAY_PART(view->warmed, bodies), ARRAY_PART(view->receivers, bodies),
                             ARRAY_PART(view->rows, rows), ARRAY_PART(view->pair_inputs, rows * SAIN_PAIR_INPUTS),
                             ARRAY_PART(view->body_inputs, bodies * SAIN_BODY_INPUTS)))
        return false;
    for (int i = 0; i < problem->body_count; i++) {
        const BodyVelocity before = velocity_before(&problem->bodies[i]);
        view->changed[i] = problem_body_moves(&problem->bodies[i]) ? engine[i] : before;
        view->warmed[i] = before;
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        contact_push(view->warmed, contact, problem->bodies,
                     (ContactImpulse){contact->warm_normal, contact->warm_tangent});
    }
    find_receivers(view, problem);
    for (int first = 0, points; first < problem->contact_count; first += points) {
        const ContactPoint *contact = &problem->contacts[first];
        points = 1;
        while (first + points < problem->contact_count && contact[points].a == contact->a &&
               contact[points].b == contact->b)
            points++;
        add_row(view, problem, first, points, true);
        add_row(view, problem, first, points, false);
    }
    for (int b = 0; b < view->body_count; b++) find_pace(view, problem, &view->bodies[b]);
    for (int b = 0; b < view->body_count; b++) {
        const SainBody *body = &view->bodies[b];
        fill_body(view, problem, b);
        for (int r = body->first; r < body->first + body->rows; r++) fill_pair(view, problem, body, r);
    }
    return true;
}

BodyVelocity sain_corrected(const SainBody *body, const float *outputs) {
    const Vec2 change = vec2_scale(body->scale, sain_out_of_frame(body, vec2(outputs[0], outputs[1])));
    return (BodyVelocity){vec2_add(body->base.linear, change),
                          body->base.angular + body->scale * outputs[2] / body->radius};
}

void sain_target(const SainBody *body, double x, double y, double spin, double target[SAIN_OUTPUTS]) {
    const double dx = x - (double)body->base.linear.x, dy = y - (double)body->base.linear.y, ax = (double)body->axis.x,
                 ay = (double)body->axis.y;
    target[0] = ax * dx + ay * dy;
    target[1] = ax * dy - ay * dx;
    target[2] = (double)body->radius * (spin - (double)body->base.angular);
}

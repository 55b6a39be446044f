/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Soft step: the solver of Box2D v3. One collision pass, then n substeps of h = dt / n; each applies its gravity and
   the impulses of the substep before, visits all contacts once as damped springs, moves the bodies, and visits all
   contacts once more without the springs (relaxation), so that the velocity that corrects overlap does not stay in the
   bodies; both with friction. Erin Catto, "Solver2D" (box2d.org, 2024) and "Soft Constraints" (GDC 2011).

   A contact of effective mass m with overlap s < 0, relative normal velocity v and impulse p of this substep gets

       dp = -m (c v + c r s) - (1 - c) p,   c = w h (2 z + w h) / (1 + w h (2 z + w h)),   r = w / (2 z + w h),

   w = 2 pi hertz, z the damping ratio; c r s is at least -3 m/s. While s > 0, dp = -m (v + s / h): the gap may close,
   no more. The arms of impulses stay those of the collision pass; s follows the poses.

   With `keep` contacts stay, as in Box2D since March 2026. Left out are Box2D's bounds on speed, its continuous
   collision, sleep and restitution. It visits one contact after the other, not four at a time.

   Fails as few sweeps do: n substeps carry a shock through about 2 n boxes. Heavy boxes sink into light ones. Without
   `keep`, a stack of more than cbrt(7.84 c / (m g h)) boxes buckles as Euler's column does, whatever the substeps; a
   pair of contacts has the stiffness c = m (2 pi hertz)^2 / 10 against turning, for boxes of 1 m. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "methods/sweeps.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

/* c, 1 - c and c r of the equation. */
typedef struct Softness {
    float mass_share, impulse_share, bias_rate;
} Softness;

typedef struct SoftBody {
    Vec2 velocity;
    float spin, inv_mass, inv_inertia;
    Vec2 moved; /* m, since the step began */
    Vec2 turn;  /* (cos, sin) of the rotation since the step began */
} SoftBody;

typedef struct SoftPoint {
    Vec2 arm_a, arm_b;
    float base;                      /* m, separation if the arms had no length */
    float mass_normal, mass_tangent; /* kg */
    ContactImpulse impulse;          /* N s, of a substep: what the next one begins with */
    ContactImpulse total;            /* N s, of the step */
} SoftPoint;

typedef struct SoftPair {
    int a, b, first, count; /* bodies; points */
    Vec2 normal;
    float friction;
    const Softness *softness;
} SoftPair;

typedef struct SoftStep {
    int substeps;
    float hertz, damping, keep;
    Softness moving, fixed; /* of contacts between moving bodies; with a static body: twice the frequency */
    StepMemory memory;      /* of each contact: the impulses of the last substep */
    SoftBody *bodies;
    BodyPose *poses;
    SoftPair *pairs;
    SoftPoint *points;
    int pair_count, body_count, point_count;
    ArrayBlock arrays; /* of this step */
} SoftStep;

#define PUSH_OUT_SPEED 3.0f /* m/s, the limit of correction */

static void push(SoftBody *a, SoftBody *b, const SoftPoint *point, Vec2 impulse) {
    a->velocity = vec2_sub(a->velocity, vec2_scale(a->inv_mass, impulse));
    a->spin -= a->inv_inertia * vec2_cross(point->arm_a, impulse);
    b->velocity = vec2_add(b->velocity, vec2_scale(b->inv_mass, impulse));
    b->spin += b->inv_inertia * vec2_cross(point->arm_b, impulse);
}

static Vec2 relative_velocity(const SoftBody *a, const SoftBody *b, const SoftPoint *point) {
    Vec2 of_a = vec2_add(a->velocity, scalar_cross_vec2(a->spin, point->arm_a));
    Vec2 of_b = vec2_add(b->velocity, scalar_cross_vec2(b->spin, point->arm_b));
    return vec2_sub(of_b, of_a);
}

static Vec2 turned(Vec2 turn, Vec2 v) { return vec2(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y); }

static float separation(const SoftBody *a, const SoftBody *b, const SoftPoint *point, Vec2 normal) {
    Vec2 arms = vec2_sub(turned(b->turn, point->arm_b), turned(a->turn, point->arm_a));
    return point->base + vec2_dot(vec2_add(vec2_sub(b->moved, a->moved), arms), normal);
}

/* Gravity and warm start of a substep. */
static void apply_forces(SoftStep *stepping, Vec2 fall) {
    for (int i = 0; i < stepping->body_count; i++)
        if (stepping->bodies[i].inv_mass > 0)
            stepping->bodies[i].velocity = vec2_add(stepping->bodies[i].velocity, fall);
    for (const SoftPair *pair = stepping->pairs; pair < stepping->pairs + stepping->pair_count; pair++) {
        Vec2 tangent = vec2_cross_scalar(pair->normal, 1.0f);
        for (SoftPoint *point = &stepping->points[pair->first]; point < &stepping->points[pair->first + pair->count];
             point++) {
            const ContactImpulse *impulse = &point->impulse;
            point->total.normal += impulse->normal;
            point->total.tangent += impulse->tangent;
            push(&stepping->bodies[pair->a], &stepping->bodies[pair->b], point,
                 vec2_add(vec2_scale(impulse->normal, pair->normal), vec2_scale(impulse->tangent, tangent)));
        }
    }
}

/* Inlined, so that both bodies stay in registers: that spares a tenth of a step. */
static inline __attribute__((always_inline)) void solve_normal(const SoftPair *pair, SoftPoint *point, SoftBody *a,
                                                               SoftBody *b, const Softness *softness, float inverse_h) {
    const float gap = separation(a, b, point, pair->normal);
    float bias = gap * inverse_h, mass_share = 1, impulse_share = 0;
    if (!(gap > 0)) {
        bias = contact_clamp(softness->bias_rate * gap, -PUSH_OUT_SPEED, 0);
        mass_share = softness->mass_share;
        impulse_share = softness->impulse_share;
    }
    float velocity = vec2_dot(relative_velocity(a, b, point), pair->normal), old = point->impulse.normal;
    float sum = old - point->mass_normal * (mass_share * velocity + bias) - impulse_share * old;
    point->impulse.normal = 0.0f > sum ? 0.0f : sum;
    point->total.normal += point->impulse.normal - old;
    push(a, b, point, vec2_scale(point->impulse.normal - old, pair->normal));
}

/* One visit of all contacts; relaxing: without the springs. */
static void sweep(SoftStep *stepping, bool relaxing, float inverse_h) {
    static const Softness rigid = {1, 0, 0};
    for (const SoftPair *pair = stepping->pairs; pair < stepping->pairs + stepping->pair_count; pair++) {
        SoftPoint *points = &stepping->points[pair->first];
        SoftBody a = stepping->bodies[pair->a], b = stepping->bodies[pair->b];
        const Softness *softness = relaxing ? &rigid : pair->softness;
        for (int k = 0; k < pair->count; k++) solve_normal(pair, &points[k], &a, &b, softness, inverse_h);
        const Vec2 tangent = vec2_cross_scalar(pair->normal, 1.0f);
        for (SoftPoint *point = points; point < points + pair->count; point++) {
            const float velocity = vec2_dot(relative_velocity(&a, &b, point), tangent), old = point->impulse.tangent;
            const float most = pair->friction * point->impulse.normal;
            point->impulse.tangent = contact_clamp(old - point->mass_tangent * velocity, -most, most);
            point->total.tangent += point->impulse.tangent - old;
            push(&a, &b, point, vec2_scale(point->impulse.tangent - old, tangent));
        }
        stepping->bodies[pair->a] = a;
        stepping->bodies[pair->b] = b;
    }
}

/* The rotation by its tangent, scaled to length 1, as in Box2D: a cosine for each substep would cost more than its
   contacts. */
static void integrate(SoftStep *stepping, float h) {
    for (int i = 0; i < stepping->body_count; i++) {
        SoftBody *body = &stepping->bodies[i];
        BodyPose *pose = &stepping->poses[i];
        Vec2 way = vec2_scale(h, body->velocity);
        float angle = h * body->spin;
        Vec2 turn = vec2(body->turn.x - angle * body->turn.y, body->turn.y + angle * body->turn.x);
        body->turn = vec2_scale(1.0f / sqrtf(vec2_dot(turn, turn)), turn);
        body->moved = vec2_add(body->moved, way);
        pose->position = vec2_add(pose->position, way);
        pose->angle += angle;
    }
}

static const SettingSpec settings[] = {
    {"substeps", "small steps per step (default: 4)", SETTING_INT(SoftStep, substeps, 1, 1000)},
    {"hertz", "frequency of the contacts' springs (default: 30)", SETTING_FLOAT(SoftStep, hertz, 0.01f, 1e4f)},
    {"damping", "their damping ratio (default: 10)", SETTING_FLOAT(SoftStep, damping, 0, 1e3f)},
    KEEP_SETTING(SETTING_FLOAT(SoftStep, keep, 0, 1)),
    {0}};

static void destroy(void *state) {
    SoftStep *stepping = state;
    step_memory_free(&stepping->memory);
    free(stepping->arrays.memory);
    free(stepping);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const SoftStep standard = {
        .substeps = 4, .hertz = 30, .damping = 10, .memory.each_contact = sizeof(ContactImpulse)};
    (void)scene;
    return settings_make(chosen, settings, &standard, sizeof standard, "soft-step", error);
}

static Softness make_softness(float hertz, float damping, float h) {
    const float omega = 6.28318531f * hertz;
    float rate = 2.0f * damping + h * omega, stiffness = h * omega * rate, rigid = 1.0f / (1.0f + stiffness);
    return (Softness){stiffness * rigid, rigid, stiffness * rigid * (omega / rate)};
}

static void add_point(SoftStep *stepping, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    SoftPair *last = stepping->pair_count > 0 ? &stepping->pairs[stepping->pair_count - 1] : NULL;
    if (last != NULL && last->a == contact->a && last->b == contact->b) {
        last->count++;
    } else {
        bool moving = stepping->bodies[contact->a].inv_mass > 0 && stepping->bodies[contact->b].inv_mass > 0;
        stepping->pairs[stepping->pair_count++] = (SoftPair){contact->a,
                                                             contact->b,
                                                             i,
                                                             1,
                                                             contact->normal,
                                                             contact->friction,
                                                             moving ? &stepping->moving : &stepping->fixed};
    }
    /* The impulses of the last substep. In a step of unknown past an equal share of those of the last step. */
    const int before = stepping->memory.before[i];
    const ContactImpulse *kept = stepping->memory.of_contacts;
    const float share = 1.0f / (float)stepping->substeps;
    const ContactImpulse start =
        before >= 0 ? kept[before] : (ContactImpulse){share * contact->warm_normal, share * contact->warm_tangent};
    const Vec2 between = vec2_sub(contact->arm_b, contact->arm_a);
    stepping->points[i] = (SoftPoint){.arm_a = contact->arm_a,
                                      .arm_b = contact->arm_b,
                                      .base = contact->separation - vec2_dot(between, contact->normal),
                                      .mass_normal = contact->mass_normal,
                                      .mass_tangent = contact->mass_tangent,
                                      .impulse = start};
}

static bool begin(SoftStep *stepping, const BegunStep *begun) {
    const ContactProblem *problem = begun->problem;
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!step_memory_match(&stepping->memory, begun->world, begun->step) ||
        !ARRAY_BLOCK_RESERVE(&stepping->arrays, ARRAY_PART(stepping->bodies, bodies),
                             ARRAY_PART(stepping->poses, bodies), ARRAY_PART(stepping->pairs, contacts),
                             ARRAY_PART(stepping->points, contacts)))
        return false;
    /* A spring of a higher frequency than an eighth of the substeps' would swing. */
    const float h = problem->dt / (float)stepping->substeps, highest = 0.125f / h;
    const float hertz = stepping->hertz < highest ? stepping->hertz : highest;
    stepping->moving = stepping->fixed = (Softness){1, 0, 0};
    if (begun->step->scene->position_correction) {
        stepping->moving = make_softness(hertz, stepping->damping, h);
        stepping->fixed = make_softness(2.0f * hertz, stepping->damping, h);
    }
    stepping->body_count = problem->body_count;
    stepping->point_count = problem->contact_count;
    stepping->pair_count = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const Body *body = &world_bodies(begun->world)[i];
        stepping->bodies[i] = (SoftBody){.velocity = body->velocity,
                                         .spin = body->angular_velocity,
                                         .inv_mass = body->inv_mass,
                                         .inv_inertia = body->inv_inertia,
                                         .turn = vec2(1, 0)};
        stepping->poses[i] = (BodyPose){body->position, body->angle};
    }
    for (int i = 0; i < problem->contact_count; i++) add_point(stepping, problem, i);
    return true;
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    SoftStep *stepping = state;
    if (!begin(stepping, begun)) return error_memory(error, "soft-step");
    const float h = begun->problem->dt / (float)stepping->substeps, inverse_h = 1.0f / h;
    for (int i = 0; i < stepping->substeps; i++) {
        apply_forces(stepping, vec2_scale(h, begun->step->scene->gravity));
        sweep(stepping, false, inverse_h);
        integrate(stepping, h);
        sweep(stepping, true, inverse_h);
    }
    ContactSolution *solution = begun->solution;
    begun->poses = stepping->poses;
    for (int i = 0; i < stepping->body_count; i++)
        solution->velocities[i] = (BodyVelocity){stepping->bodies[i].velocity, stepping->bodies[i].spin};
    bool finite = true;
    for (int i = 0; i < stepping->point_count; i++) {
        solution->impulses[i] = stepping->points[i].total;
        finite &= isfinite(solution->impulses[i].normal) && isfinite(solution->impulses[i].tangent);
    }
    return finite || error_failure(error, FAILURE_NOT_FINITE, "soft-step", "an impulse is NaN or infinite");
}

static void keep(void *state, const World *world) {
    (void)world;
    SoftStep *stepping = state;
    ContactImpulse *kept = stepping->memory.of_contacts;
    for (int i = 0; i < stepping->point_count; i++) kept[i] = stepping->points[i].impulse;
}

static StepMemory *memory_of(void *state) { return &((SoftStep *)state)->memory; }

const SteppingKind stepping_soft_step = {
    .description = {.name = "soft-step",
                    .summary = "Box2D v3's solver: soft contacts, substeps and relaxation",
                    .caption = "Box2D v3's solver",
                    .settings = settings,
                    .own_settings = "substeps=4",
                    .no_push_out = true,
                    .chart = METHOD_RUNS("substeps=1", "substeps=1,hertz=15", "substeps=2,hertz=60", "substeps=4",
                                         "substeps=8", "substeps=16", "substeps=32,hertz=60", "substeps=4,keep=0.05"),
                    .chart_quick = METHOD_RUNS("substeps=4"),
                    .stability = METHOD_RUNS("", "keep=0.05")},
    .create = create,
    .solve = solve,
    .keep = keep,
    .memory = memory_of,
    .destroy = destroy};

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
   collision, sleep and restitution.

   Pairs of bodies that share no moving body are visited four at a time, as in Box2D, but without its colours: the bits
   are those of visits one after the other.

   Fails as few sweeps do: n substeps carry a shock through about 2 n boxes. Heavy boxes sink into light ones. Without
   `keep`, a stack of more than cbrt(7.84 c / (m g h)) boxes buckles as Euler's column does, whatever the substeps; a
   pair of contacts has the stiffness c = m (2 pi hertz)^2 / 10 against turning, for boxes of 1 m. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/impulses.h"
#include "methods/lanes.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* c, 1 - c and c r of the equation. */
typedef struct Softness {
    float mass_share, impulse_share, bias_rate;
} Softness;

/* Two rows of four floats. */
typedef struct SoftBody {
    Vec2 velocity;
    float spin, inv_mass;
    Vec2 moved; /* m, since the step began */
    Vec2 turn;  /* (cos, sin) of the rotation since the step began */
} SoftBody;

typedef struct LaneImpulse {
    Lanes normal, tangent;
} LaneImpulse;

typedef struct SoftPoint {
    LaneVec arm_a, arm_b;
    Lanes base;                      /* m, separation if the arms had no length */
    Lanes mass_normal, mass_tangent; /* kg */
    LaneImpulse impulse;             /* N s, of a substep: what the next one begins with */
    LaneImpulse total;               /* N s, of the step */
} SoftPoint;

/* One pair in each lane; they share no moving body. A lane without a pair has the spare body, and zeros. */
typedef struct SoftPairs {
    int32_t a[LANES], b[LANES]; /* offsets of the bodies' rows, in floats */
    int32_t first[LANES];       /* contact; its second point, if there is one, follows. -1: no pair */
    Lanes two;                  /* -1 if the pair has a second point, else 0 */
    LaneVec normal;
    Lanes friction, inv_inertia_a, inv_inertia_b;
    Lanes mass_share, impulse_share, bias_rate; /* of its Softness */
    SoftPoint points[2];
} SoftPairs;

typedef struct SoftStep {
    int substeps;
    float hertz, damping, keep;
    Softness moving, fixed; /* of contacts between moving bodies; with a static body: twice the frequency */
    StepMemory memory;      /* of each contact: the impulses of the last substep */
    SoftBody *bodies;       /* [body_count + 1] the last one is spare */
    BodyPose *poses;        /* [body_count] */
    SoftPairs *pairs;       /* [group_count] in the order of levels */
    ContactImpulse *last;   /* [contact_count] N s, of the last substep */
    int *ready;             /* [body_count] the first level that may visit the body */
    int *level, *next;      /* [pairs] level of each; [levels] the next lane of each */
    int body_count, contact_count, group_count;
    ArrayBlock arrays; /* of this step */
} SoftStep;

enum { BODY_FLOATS = sizeof(SoftBody) / sizeof(float) };

#define PUSH_OUT_SPEED 3.0f /* m/s, the limit of correction */

/* What a visit needs of a pair's bodies besides their velocities. */
typedef struct Ways {
    LaneVec moved;          /* b's relative to a's */
    LaneVec turn_a, turn_b; /* as in SoftBody */
} Ways;

static inline Ways load_ways(const SoftBody *bodies, const SoftPairs *pairs) {
    Lanes a[4], b[4];
    load_rows(a, &bodies->moved.x, pairs->a);
    load_rows(b, &bodies->moved.x, pairs->b);
    return (Ways){{b[0] - a[0], b[1] - a[1]}, {a[2], a[3]}, {b[2], b[3]}};
}

static inline LaneVec relative_velocity(const Side *a, const Side *b, const SoftPoint *point) {
    return (LaneVec){(b->x - b->spin * point->arm_b.y) - (a->x - a->spin * point->arm_a.y),
                     (b->y + b->spin * point->arm_b.x) - (a->y + a->spin * point->arm_a.x)};
}

static inline LaneVec turned(LaneVec turn, LaneVec v) {
    return (LaneVec){turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y};
}

static inline Lanes separation(const Ways *ways, const SoftPoint *point, LaneVec normal) {
    const LaneVec a = turned(ways->turn_a, point->arm_a), b = turned(ways->turn_b, point->arm_b);
    return point->base + dot((LaneVec){ways->moved.x + (b.x - a.x), ways->moved.y + (b.y - a.y)}, normal);
}

/* Gravity and warm start of a substep. */
static void apply_forces(SoftStep *stepping, Vec2 fall) {
    float *bodies = &stepping->bodies->velocity.x;
    for (int i = 0; i < stepping->body_count; i++)
        if (stepping->bodies[i].inv_mass > 0)
            stepping->bodies[i].velocity = vec2_add(stepping->bodies[i].velocity, fall);
    for (SoftPairs *pairs = stepping->pairs; pairs < stepping->pairs + stepping->group_count; pairs++) {
        const LaneVec normal = pairs->normal, tangent = {normal.y, -normal.x};
        Side a = load_side(bodies, pairs->a, pairs->inv_inertia_a),
             b = load_side(bodies, pairs->b, pairs->inv_inertia_b), single_a, single_b;
        for (SoftPoint *point = pairs->points; point < pairs->points + 2; point++) {
            const LaneImpulse impulse = point->impulse;
            point->total.normal += impulse.normal;
            point->total.tangent += impulse.tangent;
            single_a = a, single_b = b;
            apply(&a, &b, point->arm_a, point->arm_b,
                  (LaneVec){impulse.normal * normal.x + impulse.tangent * tangent.x,
                            impulse.normal * normal.y + impulse.tangent * tangent.y});
        }
        keep_where_single(&a, &single_a, pairs->two);
        keep_where_single(&b, &single_b, pairs->two);
        store_side(bodies, pairs->a, &a);
        store_side(bodies, pairs->b, &b);
    }
}

/* relaxing: without the springs. */
static inline void solve_normal(Side *a, Side *b, const SoftPairs *pairs, SoftPoint *point, const Ways *ways,
                                bool relaxing, float inverse_h) {
    const Lanes none = {0}, all = none + 1.0f;
    const Lanes gap = separation(ways, point, pairs->normal), old = point->impulse.normal;
    const LaneMask apart = gap > 0.0f;
    const Lanes spring = relaxing ? none : pairs->bias_rate * gap;
    const Lanes bias = lanes_where(apart, gap * inverse_h, lanes_clamp(spring, none - PUSH_OUT_SPEED, none));
    const Lanes mass_share = relaxing ? all : lanes_where(apart, all, pairs->mass_share);
    const Lanes impulse_share = relaxing ? none : lanes_where(apart, none, pairs->impulse_share);
    const Lanes velocity = dot(relative_velocity(a, b, point), pairs->normal);
    const Lanes sum = old - point->mass_normal * (mass_share * velocity + bias) - impulse_share * old;
    point->impulse.normal = lanes_max(none, sum);
    const Lanes change = point->impulse.normal - old;
    point->total.normal += change;
    apply(a, b, point->arm_a, point->arm_b, scaled(change, pairs->normal));
}

static inline void solve_tangent(Side *a, Side *b, const SoftPairs *pairs, SoftPoint *point) {
    const LaneVec tangent = {pairs->normal.y, -pairs->normal.x};
    const Lanes velocity = dot(relative_velocity(a, b, point), tangent), old = point->impulse.tangent;
    const Lanes most = pairs->friction * point->impulse.normal;
    point->impulse.tangent = lanes_clamp(old - point->mass_tangent * velocity, -most, most);
    const Lanes change = point->impulse.tangent - old;
    point->total.tangent += change;
    apply(a, b, point->arm_a, point->arm_b, scaled(change, tangent));
}

/* One visit of all contacts. */
static inline void sweep(SoftStep *stepping, bool relaxing, float inverse_h) {
    float *bodies = &stepping->bodies->velocity.x;
    for (SoftPairs *pairs = stepping->pairs; pairs < stepping->pairs + stepping->group_count; pairs++) {
        SoftPoint *first = &pairs->points[0], *second = &pairs->points[1];
        Side a = load_side(bodies, pairs->a, pairs->inv_inertia_a),
             b = load_side(bodies, pairs->b, pairs->inv_inertia_b);
        const Ways ways = load_ways(stepping->bodies, pairs);
        solve_normal(&a, &b, pairs, first, &ways, relaxing, inverse_h);
        Side single_a = a, single_b = b;
        solve_normal(&a, &b, pairs, second, &ways, relaxing, inverse_h);
        keep_where_single(&a, &single_a, pairs->two);
        keep_where_single(&b, &single_b, pairs->two);
        solve_tangent(&a, &b, pairs, first);
        single_a = a, single_b = b;
        solve_tangent(&a, &b, pairs, second);
        keep_where_single(&a, &single_a, pairs->two);
        keep_where_single(&b, &single_b, pairs->two);
        store_side(bodies, pairs->a, &a);
        store_side(bodies, pairs->b, &b);
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

static void put_point(SoftStep *stepping, const ContactProblem *problem, int i, SoftPoint *to, int lane) {
    const ContactPoint *contact = &problem->contacts[i];
    /* The impulses of the last substep. In a step of unknown past an equal share of those of the last step. */
    const int before = stepping->memory.before[i];
    const ContactImpulse *kept = stepping->memory.of_contacts;
    const float share = 1.0f / (float)stepping->substeps;
    const ContactImpulse start =
        before >= 0 ? kept[before] : (ContactImpulse){share * contact->warm_normal, share * contact->warm_tangent};
    const Vec2 between = vec2_sub(contact->arm_b, contact->arm_a);
    to->arm_a.x[lane] = contact->arm_a.x;
    to->arm_a.y[lane] = contact->arm_a.y;
    to->arm_b.x[lane] = contact->arm_b.x;
    to->arm_b.y[lane] = contact->arm_b.y;
    to->base[lane] = contact->separation - vec2_dot(between, contact->normal);
    to->mass_normal[lane] = contact->mass_normal;
    to->mass_tangent[lane] = contact->mass_tangent;
    to->impulse.normal[lane] = start.normal;
    to->impulse.tangent[lane] = start.tangent;
}

static void put_pair(SoftStep *stepping, const ContactProblem *problem, int i, int points, SoftPairs *to, int lane) {
    const ContactPoint *contact = &problem->contacts[i];
    const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
    const Softness *softness = a->inv_mass > 0 && b->inv_mass > 0 ? &stepping->moving : &stepping->fixed;
    to->a[lane] = contact->a * BODY_FLOATS;
    to->b[lane] = contact->b * BODY_FLOATS;
    to->first[lane] = i;
    to->two[lane] = points == 2 ? -1 : 0;
    to->normal.x[lane] = contact->normal.x;
    to->normal.y[lane] = contact->normal.y;
    to->friction[lane] = contact->friction;
    to->inv_inertia_a[lane] = a->inv_inertia;
    to->inv_inertia_b[lane] = b->inv_inertia;
    to->mass_share[lane] = softness->mass_share;
    to->impulse_share[lane] = softness->impulse_share;
    to->bias_rate[lane] = softness->bias_rate;
    for (int k = 0; k < points; k++) put_point(stepping, problem, i + k, &to->points[k], lane);
}

/* Puts each pair into the level after those of the pairs before it that share a moving body with it. A level begins
   with a new group of lanes. */
static void put_pairs(SoftStep *stepping, const ContactProblem *problem) {
    int *ready = stepping->ready, *next = stepping->next, levels = 0, pairs = 0;
    memset(ready, 0, (size_t)stepping->body_count * sizeof *ready);
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) {
        const int a = problem->contacts[i].a, b = problem->contacts[i].b;
        const bool moves_a = problem_body_moves(&problem->bodies[a]), moves_b = problem_body_moves(&problem->bodies[b]);
        int level = moves_a ? ready[a] : 0;
        if (moves_b && ready[b] > level) level = ready[b];
        if (moves_a) ready[a] = level + 1;
        if (moves_b) ready[b] = level + 1;
        if (level == levels) next[levels++] = 0;
        next[level]++;
        stepping->level[pairs++] = level;
    }
    stepping->group_count = lanes_of_levels(next, levels) / LANES;
    for (SoftPairs *group = stepping->pairs; group < stepping->pairs + stepping->group_count; group++) {
        *group = (SoftPairs){0};
        for (int lane = 0; lane < LANES; lane++) {
            group->a[lane] = group->b[lane] = stepping->body_count * BODY_FLOATS;
            group->first[lane] = -1;
        }
    }
    for (int i = 0, pair = 0, points; i < problem->contact_count; i += points) {
        points = contact_surface_points(problem, i);
        const int at = next[stepping->level[pair++]]++;
        put_pair(stepping, problem, i, points, &stepping->pairs[at / LANES], at % LANES);
    }
}

static bool begin(SoftStep *stepping, const BegunStep *begun) {
    const ContactProblem *problem = begun->problem;
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!step_memory_match(&stepping->memory, begun->world, begun->step) ||
        !ARRAY_BLOCK_RESERVE(&stepping->arrays, ARRAY_PART(stepping->bodies, bodies + 1),
                             ARRAY_PART(stepping->poses, bodies), ARRAY_PART(stepping->pairs, contacts),
                             ARRAY_PART(stepping->last, contacts), ARRAY_PART(stepping->ready, bodies),
                             ARRAY_PART(stepping->level, contacts), ARRAY_PART(stepping->next, contacts)))
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
    stepping->contact_count = problem->contact_count;
    stepping->bodies[problem->body_count] = (SoftBody){0};
    for (int i = 0; i < problem->body_count; i++) {
        const Body *body = &world_bodies(begun->world)[i];
        stepping->bodies[i] = (SoftBody){
            .velocity = body->velocity, .spin = body->angular_velocity, .inv_mass = body->inv_mass, .turn = vec2(1, 0)};
        stepping->poses[i] = (BodyPose){body->position, body->angle};
    }
    put_pairs(stepping, problem);
    return true;
}

static void take_impulses(SoftStep *stepping, ContactImpulse *totals) {
    for (const SoftPairs *group = stepping->pairs; group < stepping->pairs + stepping->group_count; group++)
        for (int lane = 0; lane < LANES; lane++)
            for (int k = 0; group->first[lane] >= 0 && k < (group->two[lane] < 0 ? 2 : 1); k++) {
                const int i = group->first[lane] + k;
                const SoftPoint *point = &group->points[k];
                totals[i] = (ContactImpulse){point->total.normal[lane], point->total.tangent[lane]};
                stepping->last[i] = (ContactImpulse){point->impulse.normal[lane], point->impulse.tangent[lane]};
            }
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
    take_impulses(stepping, solution->impulses);
    bool finite = true;
    for (int i = 0; i < stepping->contact_count; i++)
        finite &= isfinite(solution->impulses[i].normal) && isfinite(solution->impulses[i].tangent);
    return finite || error_failure(error, FAILURE_NOT_FINITE, "soft-step", "an impulse is NaN or infinite");
}

static void keep(void *state, const World *world) {
    (void)world;
    SoftStep *stepping = state;
    if (stepping->contact_count > 0)
        memcpy(stepping->memory.of_contacts, stepping->last, (size_t)stepping->contact_count * sizeof *stepping->last);
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Augmented vertex block descent (AVBD): a step is implicit Euler, solved on positions, body after body. Chris Giles,
   Elie Diaz and Cem Yuksel, "Augmented Vertex Block Descent" (SIGGRAPH 2025), with the choices of their 2D program.

   d is the displacement of a body in the step (x, y, angle), y = v dt + g dt^2 what it would be without contacts, J the
   gradient of a contact's gap C(d) = C0 + J d. A visit of a body solves one 3 x 3 system,

       (M / dt^2 + sum k J J^T) delta = -M / dt^2 (d - y) + sum J f,   f = l - k C,   f >= 0 or |f| <= mu l_normal

   and adds delta to d. After each pass over the bodies, every contact takes l = f, and the penalty k rises by beta |C|
   while f is inside its bounds. l and k are those of the step before, k times gamma. So the forces come from the
   multipliers l, and k need not be large. Penalties and beta are in N/m for each kg of a contact's effective mass, so
   that masses may have any unit; those of the 2D program are for boxes of about 1 kg.

   Overlap does not change velocities: C0 is left out of the passes, the velocity is d / dt after the last of them, and
   one more pass with C0 moves the bodies out (post-stabilization, the default of the 2D program). With the setting
   alpha, every pass has (1 - alpha) C0 and multipliers decay by alpha gamma, as in the paper.

   Contacts that stick keep their points on both bodies, so that a slope does not creep. The gap ends at
   COLLISION_MARGIN, or resting contacts would come and go.

   Bodies that do not touch each other are visited four at a time; the bits are those of visits one after the other.

   Fails where passes are few: bodies move by what their neighbours did before, so momentum is not conserved until the
   passes have converged, and a shock moves up a stack one box a pass. New contacts begin soft; so do those of a single
   step of unknown past, which lacks the penalties that a run keeps: on a pyramid that costs it two thirds of its
   accuracy. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/impulses.h"
#include "methods/lanes.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

#define PENALTY_MIN 1.0f         /* N/m for each kg of the contact's effective mass */
#define PENALTY_MAX 1e9f         /* the same */
#define COLLISION_MARGIN 0.0005f /* m, overlap at rest */
#define STICK_DISTANCE 0.01f     /* m, by which points that stick may slide */

/* A displacement or its gradient. */
typedef struct Vec3 {
    float x, y, turn;
} Vec3;

/* Begins with two rows of four floats. */
typedef struct AvbdBody {
    Vec3 moved;       /* displacement in this step */
    float mass;       /* over dt^2; 0: static */
    Vec3 free;        /* displacement without contacts */
    float inertia;    /* over dt^2 */
    Vec2 start;       /* m/s, velocity at the start of the step */
    int first, count; /* its contacts */
} AvbdBody;

/* Along the normal or the tangent of a contact. The last four floats are a row for lanes. */
typedef struct AvbdRow {
    Vec3 of_a, of_b; /* gradient of the gap */
    float start;     /* m, gap at the start of the step */
    float mass;      /* kg, effective */
    float penalty;   /* N/m */
    float force;     /* N, the multiplier; on b */
} AvbdRow;

typedef struct AvbdContact {
    int a, b;
    float friction;
    Vec2 point_a, point_b; /* m, on each body, in its own frame */
    bool sticks;
    AvbdRow normal, tangent;
} AvbdContact;

typedef struct LaneVec3 {
    Lanes x, y, turn;
} LaneVec3;

/* The last four of an AvbdRow. */
typedef struct LaneForce {
    Lanes start, mass, penalty, force;
} LaneForce;

/* Of the gap, by the displacement of the lane's body and by that of the other one. */
typedef struct LaneGradient {
    LaneVec3 own, other;
} LaneGradient;

/* A contact of a body in each lane. */
typedef struct LaneVisit {
    int32_t contact[LANES], own[LANES], other[LANES]; /* offsets of contacts and bodies, in floats */
    LaneMask is_a;                                    /* the lane's body is the contact's a */
    Lanes friction;
    LaneGradient normal, tangent;
} LaneVisit;

enum { BODY_FLOATS = sizeof(AvbdBody) / sizeof(float), CONTACT_FLOATS = sizeof(AvbdContact) / sizeof(float) };

typedef struct Avbd {
    int iterations;
    float alpha, beta, gamma; /* alpha < 0: post-stabilization */
    StepMemory memory;        /* of each contact: an AvbdContact; of each body: its velocity at the start of the step */
    AvbdBody *bodies;         /* [bodies + 1] the last one is spare */
    Mat22 *rotations;         /* [bodies] */
    BodyPose *poses;          /* [bodies] */
    AvbdContact *contacts;    /* [contacts + LANES] with spare ones */
    int *of_bodies;           /* [2 contacts] contacts of a body, body after body */
    int *level;               /* [bodies] */
    int *next;                /* [levels] the end of each in `order` */
    int *order;               /* [order_count] bodies by level; a level begins with new lanes */
    LaneVisit *visits;        /* of all bodies in that order */
    int *visits_end;          /* [order_count / LANES] of each LANES bodies */
    LaneVisit *updates;       /* of all contacts, as visits of their a */
    int body_count, contact_count, order_count;
    ArrayBlock arrays; /* of this step */
} Avbd;

/* The start of a step: where bodies and contacts begin, with what forces and penalties. */

/* A body begins where it would be if its contacts gave it the acceleration of the last step. */
static void begin_body(Avbd *avbd, const Body *body, int i, Vec2 gravity, float dt) {
    avbd->poses[i] = (BodyPose){body->position, body->angle};
    avbd->rotations[i] = mat22_rotation(body->angle);
    avbd->bodies[i] = (AvbdBody){0};
    if (!(body->inv_mass > 0)) return;
    const Vec2 way = vec2_scale(dt, body->velocity), fall = vec2_scale(dt * dt, gravity);
    const float square = vec2_dot(gravity, gravity);
    const Vec2 *before = avbd->memory.of_bodies;
    float falling = 0; /* the share of gravity that the last step's acceleration had: 0 at rest, 1 in free fall */
    if (avbd->memory.known[i] && square > 0) {
        const Vec2 acceleration = vec2_scale(1.0f / dt, vec2_sub(body->velocity, before[i]));
        falling = contact_clamp(vec2_dot(acceleration, gravity) / square, 0, 1);
    }
    const Vec2 guess = vec2_add(way, vec2_scale(falling, fall));
    const float turn = dt * body->angular_velocity, inverse = 1.0f / (dt * dt);
    avbd->bodies[i] = (AvbdBody){.moved = {guess.x, guess.y, turn},
                                 .free = {way.x + fall.x, way.y + fall.y, turn},
                                 .start = body->velocity,
                                 .mass = inverse / body->inv_mass,
                                 .inertia = inverse / body->inv_inertia};
}

static AvbdRow make_row(Vec2 axis, Vec2 arm_a, Vec2 arm_b, float start, float mass) {
    return (AvbdRow){.of_a = {-axis.x, -axis.y, -vec2_cross(arm_a, axis)},
                     .of_b = {axis.x, axis.y, vec2_cross(arm_b, axis)},
                     .start = start,
                     .mass = mass};
}

/* A contact that was there begins with the penalty that it had; a new one with the smallest. In a step of unknown past,
   only the impulse tells which it is: then the penalty is that at which a pass moves as far as a rigid contact
   would. */
static float first_penalty(const Avbd *avbd, const AvbdRow *last, bool loaded, float mass, float dt) {
    float penalty = last != NULL ? avbd->gamma * last->penalty : loaded ? mass / (dt * dt) : 0;
    return contact_clamp(penalty, PENALTY_MIN * mass, PENALTY_MAX * mass);
}

static void begin_contact(Avbd *avbd, const ContactPoint *point, int i, float dt) {
    const int before = avbd->memory.before[i];
    const AvbdContact *last = before >= 0 ? (const AvbdContact *)avbd->memory.of_contacts + before : NULL;
    const Mat22 *of_a = &avbd->rotations[point->a], *of_b = &avbd->rotations[point->b];
    AvbdContact contact = {.a = point->a, .b = point->b, .friction = point->friction};
    if (last != NULL && last->sticks) {
        contact.point_a = last->point_a;
        contact.point_b = last->point_b;
    } else {
        Vec2 overlap = vec2_scale(point->separation, point->normal);
        contact.point_a = mat22_multiply(mat22_transpose(*of_a), point->arm_a);
        contact.point_b = mat22_multiply(mat22_transpose(*of_b), vec2_add(point->arm_b, overlap));
    }
    Vec2 arm_a = mat22_multiply(*of_a, contact.point_a), arm_b = mat22_multiply(*of_b, contact.point_b);
    Vec2 centres = vec2_sub(avbd->poses[point->b].position, avbd->poses[point->a].position);
    Vec2 gap = vec2_add(centres, vec2_sub(arm_b, arm_a)), tangent = vec2_cross_scalar(point->normal, 1.0f);
    contact.normal =
        make_row(point->normal, arm_a, arm_b, vec2_dot(gap, point->normal) + COLLISION_MARGIN, point->mass_normal);
    contact.tangent = make_row(tangent, arm_a, arm_b, vec2_dot(gap, tangent), point->mass_tangent);
    /* Multipliers are the world's impulses, so that a copy of a world has them. */
    const float decay = avbd->alpha < 0 ? 1.0f : avbd->alpha * avbd->gamma;
    const bool loaded = point->warm_normal > 0;
    contact.normal.force = decay * point->warm_normal / dt;
    contact.tangent.force = decay * point->warm_tangent / dt;
    contact.normal.penalty = first_penalty(avbd, last != NULL ? &last->normal : NULL, loaded, point->mass_normal, dt);
    contact.tangent.penalty =
        first_penalty(avbd, last != NULL ? &last->tangent : NULL, loaded, point->mass_tangent, dt);
    avbd->contacts[i] = contact;
}

/* The contacts of each body, in their order. */
static void list_contacts(Avbd *avbd) {
    for (int i = 0; i < avbd->contact_count; i++) {
        avbd->bodies[avbd->contacts[i].a].count++;
        avbd->bodies[avbd->contacts[i].b].count++;
    }
    for (int i = 0, first = 0; i < avbd->body_count; i++) {
        avbd->bodies[i].first = first;
        first += avbd->bodies[i].count;
        avbd->bodies[i].count = 0;
    }
    for (int i = 0; i < avbd->contact_count; i++) {
        AvbdBody *a = &avbd->bodies[avbd->contacts[i].a], *b = &avbd->bodies[avbd->contacts[i].b];
        avbd->of_bodies[a->first + a->count++] = i;
        avbd->of_bodies[b->first + b->count++] = i;
    }
}

/* A pass visits bodies from the last to the first, as the 2D program does: gravity enters a stack at its top. Bodies of
   a level do not touch each other, and come after those that they touch and that are visited before them. */
static void order_bodies(Avbd *avbd) {
    int *next = avbd->next, levels = 0;
    for (int i = avbd->body_count - 1; i >= 0; i--) {
        const AvbdBody *body = &avbd->bodies[i];
        if (!(body->mass > 0)) continue;
        int level = 0;
        for (int v = body->first; v < body->first + body->count; v++) {
            const AvbdContact *contact = &avbd->contacts[avbd->of_bodies[v]];
            const int other = contact->a == i ? contact->b : contact->a;
            if (other > i && avbd->bodies[other].mass > 0 && avbd->level[other] >= level)
                level = avbd->level[other] + 1;
        }
        if (level == levels) next[levels++] = 0;
        next[level]++;
        avbd->level[i] = level;
    }
    avbd->order_count = lanes_of_levels(next, levels);
    for (int k = 0; k < avbd->order_count; k++) avbd->order[k] = avbd->body_count;
    for (int i = avbd->body_count - 1; i >= 0; i--)
        if (avbd->bodies[i].mass > 0) avbd->order[next[avbd->level[i]]++] = i;
}

/* Fills the state for a step of the world that has begun. False when memory is short. */
static bool begin(Avbd *avbd, const BegunStep *begun) {
    const ContactProblem *problem = begun->problem;
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!step_memory_match(&avbd->memory, begun->world, begun->step) ||
        !ARRAY_BLOCK_RESERVE(&avbd->arrays, ARRAY_PART(avbd->bodies, bodies + 1), ARRAY_PART(avbd->rotations, bodies),
                             ARRAY_PART(avbd->poses, bodies), ARRAY_PART(avbd->contacts, contacts + LANES),
                             ARRAY_PART(avbd->of_bodies, 2 * contacts), ARRAY_PART(avbd->level, bodies),
                             ARRAY_PART(avbd->next, bodies), ARRAY_PART(avbd->order, LANES * bodies),
                             ARRAY_PART(avbd->visits, 2 * contacts), ARRAY_PART(avbd->visits_end, bodies),
                             ARRAY_PART(avbd->updates, contacts)))
        return false;
    avbd->body_count = problem->body_count;
    avbd->contact_count = problem->contact_count;
    for (int i = 0; i < avbd->body_count; i++)
        begin_body(avbd, &world_bodies(begun->world)[i], i, begun->step->scene->gravity, problem->dt);
    for (int i = 0; i < avbd->contact_count; i++) begin_contact(avbd, &problem->contacts[i], i, problem->dt);
    list_contacts(avbd);
    order_bodies(avbd);
    /* A lane without a body has the spare one, which stays where it is. One without a contact adds -0 to all sums,
       which changes none of them, not even one that is -0. */
    avbd->bodies[bodies] = (AvbdBody){.mass = 1, .inertia = 1};
    const Vec3 none = {-0.0f, -0.0f, -0.0f};
    const AvbdRow row = {.of_a = none, .of_b = none, .penalty = -0.0f};
    for (int i = 0; i < LANES; i++)
        avbd->contacts[contacts + (size_t)i] =
            (AvbdContact){.a = avbd->body_count, .b = avbd->body_count, .normal = row, .tangent = row};
    return true;
}

/* The passes over all bodies: a body in each lane, then a contact in each lane. */

static inline Lanes dot3(LaneVec3 a, LaneVec3 b) { return a.x * b.x + a.y * b.y + a.turn * b.turn; }
static inline LaneVec3 where3(LaneMask mask, LaneVec3 a, LaneVec3 b) {
    return (LaneVec3){lanes_where(mask, a.x, b.x), lanes_where(mask, a.y, b.y), lanes_where(mask, a.turn, b.turn)};
}

static inline LaneVec3 load3(const Vec3 *first, const int32_t *at) {
    Lanes rows[4];
    load_rows(rows, &first->x, at);
    return (LaneVec3){rows[0], rows[1], rows[2]};
}

static inline LaneForce load_force(const AvbdRow *first, const int32_t *at) {
    Lanes rows[4];
    load_rows(rows, &first->start, at);
    return (LaneForce){rows[0], rows[1], rows[2], rows[3]};
}

static inline LaneGradient load_gradient(const AvbdRow *first, const int32_t *at, LaneMask is_a) {
    const LaneVec3 of_a = load3(&first->of_a, at), of_b = load3(&first->of_b, at);
    return (LaneGradient){where3(is_a, of_a, of_b), where3(is_a, of_b, of_a)};
}

/* A contact of a body in each lane. */
static LaneVisit make_visit(const Avbd *avbd, const int contacts[LANES], const int bodies[LANES]) {
    LaneVisit visit;
    for (int lane = 0; lane < LANES; lane++) {
        const AvbdContact *contact = &avbd->contacts[contacts[lane]];
        const bool is_a = contact->a == bodies[lane];
        visit.contact[lane] = contacts[lane] * CONTACT_FLOATS;
        visit.own[lane] = bodies[lane] * BODY_FLOATS;
        visit.other[lane] = (is_a ? contact->b : contact->a) * BODY_FLOATS;
        visit.is_a[lane] = is_a ? -1 : 0;
        visit.friction[lane] = contact->friction;
    }
    visit.normal = load_gradient(&avbd->contacts->normal, visit.contact, visit.is_a);
    visit.tangent = load_gradient(&avbd->contacts->tangent, visit.contact, visit.is_a);
    return visit;
}

static void make_visits(Avbd *avbd) {
    int visits = 0, contacts[LANES], bodies[LANES];
    for (int k = 0; k < avbd->order_count; k += LANES) {
        int most = 0;
        for (int lane = 0; lane < LANES; lane++) {
            const int count = avbd->bodies[avbd->order[k + lane]].count;
            if (count > most) most = count;
        }
        for (int n = 0; n < most; n++) {
            for (int lane = 0; lane < LANES; lane++) {
                const AvbdBody *body = &avbd->bodies[avbd->order[k + lane]];
                contacts[lane] = n < body->count ? avbd->of_bodies[body->first + n] : avbd->contact_count;
            }
            avbd->visits[visits++] = make_visit(avbd, contacts, &avbd->order[k]);
        }
        avbd->visits_end[k / LANES] = visits;
    }
    for (int i = 0; i < avbd->contact_count; i += LANES) {
        for (int lane = 0; lane < LANES; lane++) {
            contacts[lane] = i + lane;
            bodies[lane] = avbd->contacts[i + lane].a;
        }
        avbd->updates[i / LANES] = make_visit(avbd, contacts, bodies);
    }
}

/* The gap, with this share of what it was at the start. */
static inline Lanes gap(const LaneVisit *visit, const LaneGradient *gradient, Lanes start, LaneVec3 own, LaneVec3 other,
                        float share) {
    const Lanes by_own = dot3(gradient->own, own), by_other = dot3(gradient->other, other);
    return share * start + lanes_where(visit->is_a, by_own, by_other) + lanes_where(visit->is_a, by_other, by_own);
}

static inline Lanes normal_force(const LaneForce *normal, Lanes gap) {
    return lanes_max((Lanes){0}, normal->force - normal->penalty * gap);
}

static inline Lanes tangent_force(const LaneForce *tangent, Lanes gap, Lanes most) {
    return lanes_clamp(tangent->force - tangent->penalty * gap, -most, most);
}

/* The symmetric system of a body: rows of the lower triangle and the right-hand side. */
typedef struct System {
    Lanes xx, yx, yy, tx, ty, tt;
    LaneVec3 right;
} System;

static inline void add_row(System *system, LaneVec3 j, Lanes penalty, Lanes force) {
    const LaneVec3 scaled = {penalty * j.x, penalty * j.y, penalty * j.turn};
    system->xx += scaled.x * j.x;
    system->yx += scaled.y * j.x;
    system->yy += scaled.y * j.y;
    system->tx += scaled.turn * j.x;
    system->ty += scaled.turn * j.y;
    system->tt += scaled.turn * j.turn;
    system->right.x += force * j.x;
    system->right.y += force * j.y;
    system->right.turn += force * j.turn;
}

/* By its factors L D L^T. */
static inline LaneVec3 solve_system(const System *system) {
    const Lanes d1 = system->xx, l21 = system->yx / d1, l31 = system->tx / d1;
    const Lanes d2 = system->yy - l21 * l21 * d1, l32 = (system->ty - l21 * l31 * d1) / d2;
    const Lanes d3 = system->tt - l31 * l31 * d1 - l32 * l32 * d2;
    const Lanes y1 = system->right.x, y2 = system->right.y - l21 * y1, y3 = system->right.turn - l31 * y1 - l32 * y2;
    const Lanes turn = y3 / d3, y = y2 / d2 - l32 * turn, x = y1 / d1 - l21 * y - l31 * turn;
    return (LaneVec3){x, y, turn};
}

/* bodies[LANES], with their visits up to `end`. */
static void visit_bodies(Avbd *avbd, const int *bodies, const LaneVisit *visit, const LaneVisit *end, float share) {
    int32_t at[LANES];
    for (int lane = 0; lane < LANES; lane++) at[lane] = bodies[lane] * BODY_FLOATS;
    Lanes moved[4], free[4]; /* with mass and inertia */
    load_rows(moved, &avbd->bodies->moved.x, at);
    load_rows(free, &avbd->bodies->free.x, at);
    const LaneVec3 own = {moved[0], moved[1], moved[2]};
    System system = {.xx = moved[3], .yy = moved[3], .tt = free[3]};
    system.right =
        (LaneVec3){moved[3] * (free[0] - own.x), moved[3] * (free[1] - own.y), free[3] * (free[2] - own.turn)};
    for (; visit < end; visit++) {
        const LaneVec3 other = load3(&avbd->bodies->moved, visit->other);
        const LaneForce normal = load_force(&avbd->contacts->normal, visit->contact),
                        tangent = load_force(&avbd->contacts->tangent, visit->contact);
        const Lanes apart = gap(visit, &visit->normal, normal.start, own, other, share),
                    slid = gap(visit, &visit->tangent, tangent.start, own, other, share);
        add_row(&system, visit->normal.own, normal.penalty, normal_force(&normal, apart));
        /* N/m: at its bound a force hardly resists more, the less the further the contact slides (its secant). The 2D
           program has the penalty there, too: then each pass gives a box that slides only a part of its friction. */
        const Lanes most = visit->friction * normal.force, way = lanes_abs(slid);
        const Lanes stiffness = lanes_where(tangent.penalty * way > most, most / way, tangent.penalty);
        add_row(&system, visit->tangent.own, stiffness, tangent_force(&tangent, slid, most));
    }
    const LaneVec3 more = solve_system(&system);
    const Lanes rows[4] = {own.x + more.x, own.y + more.y, own.turn + more.turn, moved[3]};
    store_rows(&avbd->bodies->moved.x, at, rows);
}

static void visit_all(Avbd *avbd, float share) {
    for (int k = 0, begin = 0; k < avbd->order_count; k += LANES) {
        const int end = avbd->visits_end[k / LANES];
        visit_bodies(avbd, &avbd->order[k], &avbd->visits[begin], &avbd->visits[end], share);
        begin = end;
    }
}

/* The multiplier takes the force; the penalty rises where that is inside its bounds. */
static inline void store_force(const Avbd *avbd, AvbdRow *first, const int32_t *at, const LaneForce *last, Lanes force,
                               LaneMask inside, Lanes gap) {
    const Lanes raised = lanes_clamp(last->penalty + avbd->beta * last->mass * lanes_abs(gap), PENALTY_MIN * last->mass,
                                     PENALTY_MAX * last->mass);
    const Lanes rows[4] = {last->start, last->mass, lanes_where(inside, raised, last->penalty), force};
    store_rows(&first->start, at, rows);
}

/* The friction bound is that of the normal force before this update, as in the visits. */
static void update_multipliers(Avbd *avbd, float share) {
    for (int i = 0; i < avbd->contact_count; i += LANES) {
        const LaneVisit *update = &avbd->updates[i / LANES];
        const LaneVec3 own = load3(&avbd->bodies->moved, update->own),
                       other = load3(&avbd->bodies->moved, update->other);
        const LaneForce normal = load_force(&avbd->contacts->normal, update->contact),
                        tangent = load_force(&avbd->contacts->tangent, update->contact);
        const Lanes apart = gap(update, &update->normal, normal.start, own, other, share),
                    slid = gap(update, &update->tangent, tangent.start, own, other, share);
        const Lanes most = update->friction * normal.force;
        const Lanes pushed = normal_force(&normal, apart), dragged = tangent_force(&tangent, slid, most);
        store_force(avbd, &avbd->contacts->normal, update->contact, &normal, pushed, pushed > 0.0f, apart);
        store_force(avbd, &avbd->contacts->tangent, update->contact, &tangent, dragged, lanes_abs(dragged) < most,
                    slid);
    }
}

/* Makes the passes of a step: moves the bodies, and fills the velocities of the solution, which come from the
   displacements before the pass that only moves bodies out. */
static void make_passes(Avbd *avbd, const Step *step, const ContactProblem *problem, ContactSolution *solution) {
    const bool correct = step->scene->position_correction, stabilize = avbd->alpha < 0 && correct;
    const float share = avbd->alpha < 0 || !correct ? 0.0f : 1.0f - avbd->alpha, inverse_dt = 1.0f / problem->dt;
    make_visits(avbd);
    for (int k = 0; k < avbd->iterations; k++) {
        visit_all(avbd, share);
        update_multipliers(avbd, share);
    }
    for (int i = 0; i < avbd->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const Vec3 *moved = &avbd->bodies[i].moved;
        solution->velocities[i] =
            (BodyVelocity){vec2_scale(inverse_dt, vec2(moved->x, moved->y)), inverse_dt * moved->turn};
        if (!(body->inv_mass > 0)) solution->velocities[i] = (BodyVelocity){body->velocity, body->angular_velocity};
    }
    if (stabilize) visit_all(avbd, 1);
}

static const SettingSpec settings[] = {
    {"k", "passes over all bodies per step (default: 10)", SETTING_INT(Avbd, iterations, 1, 10000)},
    {"alpha", "share of the overlap that a step leaves (default: one more pass removes it instead)",
     SETTING_FLOAT(Avbd, alpha, 0, 1)},
    {"beta", "rise of a penalty, N/m for each m of gap, kg and pass (default: 1e5)",
     SETTING_FLOAT(Avbd, beta, 0, 1e12f)},
    {"gamma", "share of a penalty that the next step begins with (default: 0.99)", SETTING_FLOAT(Avbd, gamma, 0, 1)},
    {0}};

static void destroy(void *state) {
    Avbd *avbd = state;
    step_memory_free(&avbd->memory);
    free(avbd->arrays.memory);
    free(avbd);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Avbd standard = {.iterations = 10,
                                  .alpha = -1,
                                  .beta = 1e5f,
                                  .gamma = 0.99f,
                                  .memory = {.each_body = sizeof(Vec2), .each_contact = sizeof(AvbdContact)}};
    (void)scene;
    return settings_make(chosen, settings, &standard, sizeof standard, "avbd", error);
}

/* The momentum that no contact force accounts for: 0 once the passes have converged. */
static void measure(void *state, const BegunStep *begun) {
    const Avbd *avbd = state;
    const ContactProblem *problem = begun->problem;
    ContactSolution *solution = begun->solution;
    float sum = 0;
    for (int i = 0; i < avbd->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (!(body->inv_mass > 0)) continue;
        Vec2 change = vec2_scale(1.0f / body->inv_mass, vec2_sub(solution->velocities[i].linear, body->velocity));
        for (int v = avbd->bodies[i].first; v < avbd->bodies[i].first + avbd->bodies[i].count; v++) {
            const ContactPoint *point = &problem->contacts[avbd->of_bodies[v]];
            const ContactImpulse *impulse = &solution->impulses[avbd->of_bodies[v]];
            Vec2 given = vec2_add(vec2_scale(impulse->normal, point->normal),
                                  vec2_scale(impulse->tangent, vec2_cross_scalar(point->normal, 1.0f)));
            change = point->b == i ? vec2_sub(change, given) : vec2_add(change, given);
        }
        sum += sqrtf(vec2_dot(change, change));
    }
    solution->momentum_error = sum;
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    Avbd *avbd = state;
    if (!begin(avbd, begun)) return error_memory(error, "avbd");
    make_passes(avbd, begun->step, begun->problem, begun->solution);
    for (int i = 0; i < avbd->body_count; i++) {
        const Vec3 *moved = &avbd->bodies[i].moved;
        avbd->poses[i].position = vec2_add(avbd->poses[i].position, vec2(moved->x, moved->y));
        avbd->poses[i].angle += moved->turn;
    }
    begun->poses = avbd->poses;
    bool finite = true;
    for (int i = 0; i < avbd->contact_count; i++) {
        AvbdContact *contact = &avbd->contacts[i];
        const float pushed = contact->normal.force, dragged = contact->tangent.force;
        contact->sticks = fabsf(dragged) < contact->friction * pushed && fabsf(contact->tangent.start) < STICK_DISTANCE;
        ContactImpulse *impulse = &begun->solution->impulses[i];
        *impulse = (ContactImpulse){begun->problem->dt * pushed, begun->problem->dt * dragged};
        finite &= isfinite(impulse->normal) && isfinite(impulse->tangent);
    }
    return finite || error_failure(error, FAILURE_NOT_FINITE, "avbd", "an impulse is NaN or infinite");
}

static void keep(void *state, const World *world) {
    (void)world;
    Avbd *avbd = state;
    AvbdContact *last = avbd->memory.of_contacts;
    Vec2 *before = avbd->memory.of_bodies;
    for (int i = 0; i < avbd->contact_count; i++) last[i] = avbd->contacts[i];
    for (int i = 0; i < avbd->body_count; i++) before[i] = avbd->bodies[i].start;
}

static StepMemory *memory_of(void *state) { return &((Avbd *)state)->memory; }

const SteppingKind stepping_avbd = {
    .description = {.name = "avbd",
                    .summary = "augmented vertex block descent: implicit positions, body after body",
                    .caption = "augmented vertex block descent",
                    .settings = settings,
                    .own_settings = "k=10",
                    .no_push_out = true,
                    .chart = METHOD_RUNS("k=2", "k=2,beta=1e9", "k=2,beta=1e6,gamma=0.95", "k=10", "k=50,gamma=0.95"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .measure = measure,
    .keep = keep,
    .memory = memory_of,
    .destroy = destroy};

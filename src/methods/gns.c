/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Graph network-based simulator: boxes are particles, and a network learned how they move. Alvaro Sanchez-Gonzalez,
   Jonathan Godwin, Tobias Pfaff, Rex Ying, Jure Leskovec and Peter Battaglia, "Learning to Simulate Complex Physics
   with Graph Networks" (ICML 2020, arXiv 2002.09405).

   Each box is nine particles. Edges connect particles within a radius, of one box or two. A network passes messages
   along them (nets/kinds.h) and returns each particle's acceleration besides gravity's, and then

       v' = v + dt (g + a),   x' = x + dt v'       (semi-implicit Euler)

   There are no contacts and no solver: collision detection serves measurement only. With rigid=on each box takes the
   pose that fits its particles best, and the particles their places on it; with rigid=off, as in the paper, particles
   stay where they are, and that pose is only shown. The paper's network also learns gravity; here it is given, so that
   net=off is the same without what was learned: boxes in free fall.

   A particle's past is kept from step to step. A box in another state than the last step left it in, or new, begins
   with a past of constant velocity.

   Fails where it was not trained: nothing in the method keeps boxes apart, or momentum. It is as good as its data for
   that motion, and slow: its cost is that of tens of edges of each particle, M times. Under another gravity than in its
   training boxes rise or sink, as the network holds what rests against the gravity that it learned; such steps are
   counted as unlike the training. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/gns_graph.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Accelerations beyond this multiple of the strongest in training are discarded. */
static const float beyond_strongest = 2.0f;

/* The particles of a body that moves, as a step leaves them. */
typedef struct BodyPast {
    Vec2 position[BOX_PARTICLES], velocity[BOX_PARTICLES][GNS_HISTORY];
} BodyPast;

typedef struct Gns {
    GnsNet net;
    bool uses_net, rigid;
    GnsParticles particles;
    int *body;   /* [particles.bodies] bodies of the world */
    Box *ground; /* [ground_count] static boxes */
    int ground_count;
    BodyPose *poses;   /* [bodies of the world] after the step */
    bool *touched;     /* [bodies of the world] */
    StepMemory memory; /* of each body of the world: a BodyPast */
    GnsGraph graph;
    GnsPass pass;
    ArrayBlock arrays; /* of this step */
} Gns;

static const SettingSpec settings[] = {
    {"network", "file of the network (default: the scene's)", SETTING_OWN},
    {"net", "off: gravity alone (default: on)", SETTING_BOOL(Gns, uses_net)},
    {"rigid", "off: particles are not put back to rigid boxes (default: on)", SETTING_BOOL(Gns, rigid)},
    {0}};

static void destroy(void *state) {
    Gns *gns = state;
    gns_net_free(&gns->net);
    free(gns->arrays.memory);
    step_memory_free(&gns->memory);
    gns_graph_free(&gns->graph);
    gns_pass_free(&gns->pass);
    free(gns);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Gns standard = {.uses_net = true, .rigid = true, .memory.each_body = sizeof(BodyPast)};
    Gns *gns = settings_make(chosen, settings, &standard, sizeof standard, "gns", error);
    if (gns == NULL || !gns->uses_net) return gns;
    const char *path = settings_get(chosen, "network");
    if (path == NULL) path = scene_network(scene, "gns");
    if (path != NULL ? gns_net_read(&gns->net, path, error)
                     : error_input(error, "gns", "needs a network: network=FILE, or the scene's `networks`"))
        return gns;
    destroy(gns);
    return NULL;
}

/* A past of constant velocity and spin: the particles of the poses dt, 2 dt, ... ago. */
static void begin_past(Gns *gns, int i, const Body *body, float dt) {
    Vec2 *now = gns->particles.position + (ptrdiff_t)i * BOX_PARTICLES, before[BOX_PARTICLES], after[BOX_PARTICLES];
    Vec2(*velocity)[GNS_HISTORY] = gns->particles.velocity + (ptrdiff_t)i * BOX_PARTICLES;
    box_particles_place(now, body->size, &(BodyPose){body->position, body->angle});
    memcpy(after, now, sizeof after);
    for (int k = GNS_HISTORY - 1; k >= 0; k--) {
        const float back = dt * (float)(GNS_HISTORY - k);
        const BodyPose pose = {vec2_sub(body->position, vec2_scale(back, body->velocity)),
                               body->angle - back * body->angular_velocity};
        box_particles_place(before, body->size, &pose);
        for (int p = 0; p < BOX_PARTICLES; p++) velocity[p][k] = vec2_scale(1.0f / dt, vec2_sub(after[p], before[p]));
        memcpy(after, before, sizeof after);
    }
}

/* Particles of all bodies that move, and the boxes that do not. */
static bool begin(Gns *gns, const BegunStep *begun) {
    const ContactProblem *problem = begun->problem;
    const size_t count = (size_t)problem->body_count + 1, particles = count * BOX_PARTICLES;
    GnsParticles *now = &gns->particles;
    if (!ARRAY_BLOCK_RESERVE(&gns->arrays, ARRAY_PART(now->body, count), ARRAY_PART(now->position, particles),
                             ARRAY_PART(now->velocity, particles), ARRAY_PART(gns->body, count),
                             ARRAY_PART(gns->ground, count), ARRAY_PART(gns->poses, count),
                             ARRAY_PART(gns->touched, count)) ||
        !step_memory_match(&gns->memory, begun->world, begun->step))
        return false;
    const Body *bodies = world_bodies(begun->world);
    now->bodies = gns->ground_count = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const Body *body = &bodies[i];
        gns->poses[i] = (BodyPose){body->position, body->angle};
        if (!problem_body_moves(&problem->bodies[i])) {
            gns->ground[gns->ground_count++] = box_make(body->position, body->size, body->angle);
            continue;
        }
        const int at = now->bodies++;
        now->body[at] = (GnsBody){body->size, 1.0f / body->inv_mass, i == problem->bomb};
        gns->body[at] = i;
        if (!gns->memory.known[i]) {
            begin_past(gns, at, body, problem->dt);
            continue;
        }
        const BodyPast *past = (const BodyPast *)gns->memory.of_bodies + i;
        memcpy(now->position + (ptrdiff_t)at * BOX_PARTICLES, past->position, sizeof past->position);
        memcpy(now->velocity + (ptrdiff_t)at * BOX_PARTICLES, past->velocity, sizeof past->velocity);
    }
    return true;
}

static void move_particles(Gns *gns, int i, Vec2 gravity, float dt, Fallbacks *fallbacks) {
    const float most = beyond_strongest * gns->net.scales.strongest / gns->net.scales.acceleration;
    bool learned = gns->uses_net; /* and no acceleration is NaN, infinite or far beyond the training's */
    for (int k = i * BOX_PARTICLES * GNS_OUTPUTS; learned && k < (i + 1) * BOX_PARTICLES * GNS_OUTPUTS; k++)
        learned = fabsf(gns->pass.outputs[k]) <= most;
    if (gns->uses_net && !learned) fallbacks->not_finite++;
    for (int p = i * BOX_PARTICLES; p < (i + 1) * BOX_PARTICLES; p++) {
        Vec2 *velocity = gns->particles.velocity[p], change = vec2_scale(dt, gravity);
        if (learned) {
            const float unit = dt * gns->net.scales.acceleration;
            const float *outputs = gns->pass.outputs + (ptrdiff_t)p * GNS_OUTPUTS;
            change = vec2_add(change, vec2(unit * outputs[0], unit * outputs[1]));
        }
        const Vec2 newest = vec2_add(velocity[GNS_HISTORY - 1], change);
        memmove(velocity, velocity + 1, (GNS_HISTORY - 1) * sizeof *velocity);
        velocity[GNS_HISTORY - 1] = newest;
        gns->particles.position[p] = vec2_add(gns->particles.position[p], vec2_scale(dt, newest));
    }
}

/* Pose and velocity of a body that moves, from its particles. If it is rigid, these take their places on it, and their
   newest velocities lead there. */
static void end_body(Gns *gns, int i, const ContactProblem *problem, ContactSolution *solution) {
    const int body = gns->body[i];
    const float per = 1.0f / problem->dt;
    const Vec2 size = gns->particles.body[i].size;
    const BodyPose before = gns->poses[body];
    BodyPose *pose = &gns->poses[body];
    Vec2 from[BOX_PARTICLES], *to = gns->particles.position + (ptrdiff_t)i * BOX_PARTICLES;
    *pose = box_particles_fit(to, size, &before);
    if (gns->rigid) {
        box_particles_place(from, size, &before);
        box_particles_place(to, size, pose);
        for (int p = 0; p < BOX_PARTICLES; p++)
            gns->particles.velocity[i * BOX_PARTICLES + p][GNS_HISTORY - 1] = vec2_scale(per, vec2_sub(to[p], from[p]));
    }
    solution->velocities[body] =
        (BodyVelocity){vec2_scale(per, vec2_sub(pose->position, before.position)), per * (pose->angle - before.angle)};
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    Gns *gns = state;
    const ContactProblem *problem = begun->problem;
    ContactSolution *solution = begun->solution;
    const GnsNet *net = &gns->net;
    if (!begin(gns, begun) || (gns->uses_net && (!gns_graph_build(&gns->graph, &gns->particles, gns->ground,
                                                                  gns->ground_count, &net->scales) ||
                                                 !gns_forward(&gns->pass, &net->layout, net->parameters, &gns->graph))))
        return error_memory(error, "gns");
    const Vec2 gravity = begun->step->scene->gravity;
    const bool other_gravity = gravity.x != net->gravity[0] || gravity.y != net->gravity[1];
    solution->fallbacks.beyond_training += gns->uses_net && (gns->graph.beyond || other_gravity);
    memset(solution->velocities, 0, (size_t)problem->body_count * sizeof *solution->velocities);
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0};
    for (int i = 0; i < gns->particles.bodies; i++) {
        move_particles(gns, i, gravity, problem->dt, &solution->fallbacks);
        end_body(gns, i, problem, solution);
    }
    begun->poses = gns->poses;
    return true;
}

static void measure(void *state, const BegunStep *begun) {
    begun->solution->momentum_error = free_flight_momentum(begun->problem, begun->solution, ((Gns *)state)->touched);
}

static void keep(void *state, const World *world) {
    (void)world;
    Gns *gns = state;
    const GnsParticles *now = &gns->particles;
    for (int i = 0; i < now->bodies; i++) {
        BodyPast *past = (BodyPast *)gns->memory.of_bodies + gns->body[i];
        memcpy(past->position, now->position + (ptrdiff_t)i * BOX_PARTICLES, sizeof past->position);
        memcpy(past->velocity, now->velocity + (ptrdiff_t)i * BOX_PARTICLES, sizeof past->velocity);
    }
}

static StepMemory *memory_of(void *state) { return &((Gns *)state)->memory; }

const SteppingKind stepping_gns = {
    .description = {.name = "gns",
                    .summary = "graph network-based simulator: boxes as particles, moved by a learned network",
                    .caption = "graph network on particles",
                    .settings = settings,
                    .no_contacts = true,
                    .falls_back = true,
                    .needs_network = true,
                    .twin = "gns:net=off",
                    .own_settings = "",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .measure = measure,
    .keep = keep,
    .memory = memory_of,
    .destroy = destroy};

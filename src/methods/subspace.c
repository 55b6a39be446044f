/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subspace neural physics: no collision detection and no solver; a network predicts where all bodies of one scene are
   next, as principal components of their poses (nets/kinds.h has the equations). Source: Holden, Duong, Datta,
   Nowrouzezahrai, "Subspace Neural Physics: Fast Data-Driven Interactive Simulation" (SCA 2019).

   A step predicts the components, clamps them to their range in training, and reconstructs the poses from them; a
   velocity is the difference of two poses over dt. A state that the method has not reached itself, as in the first
   step, is projected: its poses, and those one step before, from the velocities. Before the bomb appears all launches
   are the same run, so the file has that run's poses and the method repeats them. With net=off the linear term predicts
   alone.

   The step is begun, so contacts are detected, only for those who measure them: the method reads none of it.

   Fails by what it does not know: nothing keeps boxes apart or momentum constant; poses that differ from all launches
   of the training have no components. Another scene, and another size or mass of its bodies, is refused. */
#include "methods/subspace.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct SubspaceStepper {
    SubspaceNet *net;
    Subspace subspace;
    Body *after;     /* [after_count] the world's bodies when the last step ended in the subspace */
    int after_count; /* 0: it did not */
    BodyPose *poses; /* [bodies of the world] */
    bool *touched;   /* [bodies of the world] */
    float *start;    /* [2, 4 bodies] numbers of the state before and of the state */
    int components;
    bool corrects;
    ArrayBlock arrays; /* poses and touched */
    size_t after_capacity;
} SubspaceStepper;

static const SettingSpec settings[] = {
    {"network", "file of the trained network (default: the scene's)", SETTING_OWN},
    {"components", "8|32|128: principal components, at most as many as the scene has (default: 32)",
     SETTING_INT(SubspaceStepper, components, 1, SUBSPACE_COMPONENTS_MAX)},
    {"net", "on|off: off leaves out the network; the linear term predicts alone (default: on)",
     SETTING_BOOL(SubspaceStepper, corrects)},
    {0}};

uint64_t subspace_physics(const Scene *scene) {
    Scene plain = *scene;
    plain.iterations = 1;
    plain.warm_starting = plain.accumulate_impulses = plain.position_correction = true;
    plain.bomb.present = true; /* a launch may be run without its bomb, to check the scene */
    plain = launch_scene(&plain, &(Launch){.mass = plain.bomb.own_mass});
    return scene_hash(&plain);
}

void subspace_launch(const Scene *launched, float launch[SUBSPACE_LAUNCH]) {
    const Launch own = launch_of(launched);
    const float numbers[SUBSPACE_LAUNCH] = {own.x, own.rotation, own.spin, own.mass};
    memcpy(launch, numbers, sizeof numbers);
}

void subspace_pose_numbers(Vec2 size, Vec2 position, float angle, float numbers[SUBSPACE_POSE]) {
    const Mat22 turn = mat22_rotation(angle);
    const float radius = sqrtf(vec2_dot(size, size) / 12.0f);
    numbers[0] = position.x;
    numbers[1] = position.y;
    numbers[2] = radius * turn.column1.y;
    numbers[3] = radius * turn.column1.x;
}

static void destroy(void *state) {
    SubspaceStepper *method = state;
    if (method == NULL) return;
    subspace_free(&method->subspace);
    subspace_net_destroy(method->net);
    free(method->after);
    free(method->arrays.memory);
    free(method->start);
    free(method);
}

/* The first pose before the bomb is one step after the scene's start. Bodies that overlap may be pushed farther. */
static bool check_before(const SubspaceNet *net, const Scene *scene, const char *path, Error *error) {
    const double slack = 0.1, dt = (double)scene->dt; /* m, s */
    const float *pose = net->before;
    double speed = dt * vec2_distance(scene->gravity, vec2(0, 0));
    for (int i = 0; i < scene->body_count; i++)
        speed = fmax(speed, vec2_distance(scene->bodies[i].velocity, vec2(0, 0)));
    for (int i = 0; i < scene->body_count && net->shape.frames_before > 0 && !scene->overlaps_allowed; i++) {
        const BodyDef *body = &scene->bodies[i];
        if (body->fixed) continue;
        if (vec2_distance(body->position, vec2(pose[0], pose[1])) > slack + 2 * speed * dt)
            return error_input(error, path, "before: body %d is at (%g, %g) m after a step, but starts at (%g, %g) m",
                               i, (double)pose[0], (double)pose[1], (double)body->position.x, (double)body->position.y);
        pose += 3;
    }
    return true;
}

static bool check_scene(const SubspaceNet *net, const Scene *scene, const char *path, Error *error) {
    int moving = 1;
    for (int i = 0; i < scene->body_count; i++) moving += !scene->bodies[i].fixed;
    if (moving != net->shape.bodies)
        return error_input(error, path, "the network is for scene %s with %d bodies that move; scene %s has %d",
                           net->scene, net->shape.bodies, scene->name, moving);
    return net->physics == subspace_physics(scene) ||
           error_input(error, path,
                       "the network is for scene %s; bodies, bomb, gravity or time step of scene %s differ", net->scene,
                       scene->name);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const SubspaceStepper standard = {.components = 32, .corrects = true};
    const char *path = method_network(chosen, scene, "subspace", error);
    SubspaceStepper *method =
        path != NULL ? settings_make(chosen, settings, &standard, sizeof standard, "subspace", error) : NULL;
    if (method == NULL) return NULL;
    const int components = method->components;
    bool ok = components == 8 || components == 32 || components == 128 ||
              error_input(error, "subspace", "components must be 8, 32 or 128 (got %d)", components);
    ok = ok && (method->net = subspace_net_read(path, error)) != NULL && check_scene(method->net, scene, path, error) &&
         check_before(method->net, scene, path, error);
    if (ok) {
        method->start = calloc(2 * SUBSPACE_POSE * (size_t)method->net->shape.bodies, sizeof *method->start);
        ok = (method->start != NULL || error_memory(error, "subspace")) &&
             subspace_make(&method->subspace, method->net, subspace_net_choose(method->net, components),
                           method->corrects, error);
    }
    if (ok) return method;
    destroy(method);
    return NULL;
}

/* Projects the poses of the world and those one step before. */
static void start_subspace(SubspaceStepper *method, const Body *bodies, int count, float dt) {
    float *last = method->start, *now = last + SUBSPACE_POSE * method->net->shape.bodies;
    for (int i = 0; i < count; i++) {
        const Body *body = &bodies[i];
        if (body->inv_mass == 0) continue;
        subspace_pose_numbers(body->size, vec2_sub(body->position, vec2_scale(dt, body->velocity)),
                              body->angle - dt * body->angular_velocity, last);
        subspace_pose_numbers(body->size, body->position, body->angle, now);
        last += SUBSPACE_POSE, now += SUBSPACE_POSE;
    }
    subspace_start(&method->subspace, method->start, method->start + SUBSPACE_POSE * method->net->shape.bodies);
}

/* Poses after a step in which the bomb is there. Bodies whose numbers are not finite stay where they are. */
static Fallbacks predict(SubspaceStepper *method, const Body *bodies, const ContactProblem *problem,
                         const Step *which) {
    const SceneSpan *mass = &which->scene->bomb.mass;
    const size_t size = (size_t)problem->body_count * sizeof *bodies;
    float launch[SUBSPACE_LAUNCH];
    /* The run goes on if the world is, bit for bit, where the last step left it; a body has no padding. */
    if (which->frame <= 1 || method->after_count != problem->body_count || memcmp(method->after, bodies, size) != 0)
        start_subspace(method, bodies, problem->body_count, problem->dt);
    subspace_launch(which->scene, launch);
    const SubspaceReport report = subspace_step(&method->subspace, launch);
    subspace_reconstruct(&method->subspace);
    Fallbacks fallbacks = {.not_finite = report.not_finite,
                           .beyond_training = report.beyond > 0 || mass->value < mass->from || mass->value > mass->to};
    const float *numbers = method->subspace.numbers;
    for (int i = 0; i < problem->body_count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        const BodyPose pose = {vec2(numbers[0], numbers[1]), turn_angle(numbers[2], numbers[3], bodies[i].angle)};
        if (isfinite(pose.position.x) && isfinite(pose.position.y) && isfinite(pose.angle))
            method->poses[i] = pose;
        else
            fallbacks.not_finite++;
        numbers += SUBSPACE_POSE;
    }
    return fallbacks;
}

/* Poses after a step before the bomb appears; after the end of the recorded run, its last. */
static void repeat(SubspaceStepper *method, const Body *bodies, int body_count, int frame) {
    const SubspaceShape *shape = &method->net->shape;
    if (shape->frames_before == 0) return;
    const int row = (frame <= shape->frames_before ? frame : shape->frames_before) - 1;
    const float *pose = method->net->before + (size_t)row * (size_t)(shape->bodies - 1) * 3;
    for (int i = 0; i < body_count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        method->poses[i] = (BodyPose){vec2(pose[0], pose[1]), pose[2]};
        pose += 3;
    }
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    SubspaceStepper *method = state;
    const ContactProblem *problem = begun->problem;
    ContactSolution *solution = begun->solution;
    const Body *bodies = world_bodies(begun->world);
    const size_t count = (size_t)problem->body_count;
    if (!array_reserve((void **)&method->after, &method->after_capacity, count, sizeof *method->after) ||
        !ARRAY_BLOCK_RESERVE(&method->arrays, ARRAY_PART(method->poses, count), ARRAY_PART(method->touched, count)))
        return error_memory(error, "subspace");
    /* The network's bodies must be those of the world: a caller may step any world of the scene. */
    int moving = problem->bomb < 0;
    for (int i = 0; i < problem->body_count; i++) {
        moving += bodies[i].inv_mass != 0;
        method->poses[i] = (BodyPose){bodies[i].position, bodies[i].angle};
    }
    if (moving != method->net->shape.bodies)
        return error_input(error, "subspace", "the world has %d bodies that move, with the bomb; the network is for %d",
                           moving, method->net->shape.bodies);
    if (problem->bomb >= 0)
        solution->fallbacks = predict(method, bodies, problem, begun->step);
    else
        repeat(method, bodies, problem->body_count, begun->step->frame);
    const float rate = 1 / problem->dt;
    for (int i = 0; i < problem->body_count; i++) {
        const BodyPose *pose = &method->poses[i];
        solution->velocities[i] = (BodyVelocity){vec2_scale(rate, vec2_sub(pose->position, bodies[i].position)),
                                                 rate * (pose->angle - bodies[i].angle)};
    }
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    begun->poses = method->poses;
    return true;
}

static void measure(void *state, const BegunStep *begun) {
    bool *touched = ((SubspaceStepper *)state)->touched;
    begun->solution->momentum_error = free_flight_momentum(begun->problem, begun->solution, touched);
}

static void keep(void *state, const World *world) {
    SubspaceStepper *method = state;
    const ContactProblem *problem = world_problem(world);
    method->after_count = problem->bomb >= 0 ? problem->body_count : 0;
    memcpy(method->after, world_bodies(world), (size_t)problem->body_count * sizeof *method->after);
}

const SteppingKind stepping_subspace = {
    .description = {.name = "subspace",
                    .summary = "no solver: a network predicts principal components of all poses",
                    .caption = "principal components",
                    .settings = settings,
                    .needs_network = true,
                    .twin = "subspace:net=off",
                    .own_settings = "components=32",
                    .no_push_out = true,
                    .no_contacts = true,
                    .chart = METHOD_RUNS("", "components=8", "components=128", "net=off"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .measure = measure,
    .keep = keep,
    .destroy = destroy};

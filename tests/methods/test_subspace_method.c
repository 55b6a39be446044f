/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of the method with a network made by hand: boxes go on as they move. */
#include "made.h"

#include "methods/subspace_nets.h"
#include "methods/subspace.h"

static const float dt = 1 / 60.0f;

static Scene *single;
static SubspaceNet *net;

FIXTURE(make) {
    single = scene_named("single");
    net = subspace_net_by_hand(0);
}

FIXTURE(destroy) {
    subspace_net_destroy(net);
    scene_destroy(single);
}

/* Writes a net for the scene; returns the method with it. */
static Method method_of(SubspaceNet *written, const Scene *scene, const char *name) {
    const char *path = temporary_path("by_hand.npz");
    Error error = {0};
    Method method;
    written->physics = subspace_physics(scene);
    assert_ok(subspace_net_write(written, path, &error), error);
    assert_ok(method_with_network(&method, name, path, &error), error);
    return method;
}

typedef struct Watch {
    Body bodies[2]; /* of the last frame */
    float momentum; /* of the last frame */
} Watch;

static bool observe(void *context, int frame, const World *world, Error *error) {
    (void)frame, (void)error;
    Watch *watch = context;
    for (int i = 0; i < 2 && i + 1 < world_body_count(world); i++) watch->bodies[i] = world_bodies(world)[i + 1];
    watch->momentum = world_solution(world)->momentum_error;
    return true;
}

static Watch run(const Scene *scene, const Method *method, Fallbacks *fallbacks) {
    Watch watch = {0};
    Error error = {0};
    const StepObserver observer = {observe, &watch};
    assert_ok(simulate_watched(scene, method,
                               &(RunWatch){.observers = &observer, .observer_count = 1, .fallbacks = fallbacks},
                               &error),
              error);
    return watch;
}

/* The box stays, the bomb flies on a straight line: gravity is missing, and counted as momentum created. */
TEST_WITH(boxes_go_on_as_they_move, make, destroy) {
    single->frames = 10;
    single->bomb.spin.value = 3;
    /* A network by hand is for any launch: the physics do not depend on it. */
    const Method method = method_of(net, single, "subspace");
    Fallbacks fallbacks = {0};
    const Watch watch = run(single, &method, &fallbacks);
    const BodyDef bomb = scene_bomb_body(single);
    assert_near(watch.bodies[0].position.y, 4, 1e-4);
    assert_near(watch.bodies[1].position.x, bomb.position.x + 10 * dt * bomb.velocity.x, 1e-4);
    assert_near(watch.bodies[1].position.y, bomb.position.y + 10 * dt * bomb.velocity.y, 1e-4);
    assert_near(watch.bodies[1].velocity.y, bomb.velocity.y, 1e-2);
    assert_near(watch.momentum, 250 * 10 * dt, 1);
    assert_int_equal(fallbacks.not_finite + fallbacks.beyond_training, 0);
}

/* Sine and cosine go on in a straight line, so the angle does what they tell. */
TEST_WITH(angles_follow_sine_and_cosine, make, destroy) {
    single->frames = 4;
    single->bomb.rotation.value = 9; /* more than a turn */
    single->bomb.spin.value = 1.5f;
    const Method method = method_of(net, single, "subspace");
    const Watch watch = run(single, &method, NULL);
    const double before = 9 - (double)dt * 1.5, sine = sin(9) + 4 * (sin(9) - sin(before)),
                 cosine = cos(9) + 4 * (cos(9) - cos(before));
    assert_near(watch.bodies[1].angle, atan2(sine, cosine) + 2 * 3.14159265358979, 1e-4);
}

static void step_world(Stepper *stepper, World *world, const Scene *scene, int frame) {
    Error error = {0};
    assert_ok(stepper_step(stepper, world, &(Step){.scene = scene, .frame = frame}, &error), error);
}

/* The steps of one world do not change those of another: the second starts from its own poses. */
TEST_WITH(another_world_starts_from_its_poses, make, destroy) {
    Launch launch = launch_of(single);
    launch.x = -2;
    const Scene other = launch_scene(single, &launch);
    const Method method = method_of(net, single, "subspace");
    OWN(Stepper) *both = stepper_of(single, &method), *alone = stepper_of(single, &method);
    OWN(World) *first = world_of(single), *second = world_of(&other), *expected = world_of(&other);
    for (int frame = 1; frame <= 3; frame++) step_world(both, first, single, frame);
    for (int frame = 4; frame <= 6; frame++) step_world(both, second, &other, frame);
    for (int frame = 1; frame <= 3; frame++) step_world(alone, expected, &other, frame);
    assert_memory_equal(world_bodies(second), world_bodies(expected), 3 * sizeof(Body));
}

TEST_WITH(before_the_bomb_the_recorded_run_is_repeated, make, destroy) {
    single->bomb.frame = 5;
    single->frames = 5;
    OWN(SubspaceNet) *recorded = subspace_net_by_hand(3);
    for (int i = 0; i < 9; i++) recorded->before[i] = 0.5f * (float)i;
    recorded->before[1] = 4; /* the box's height at the start */
    const Method method = method_of(recorded, single, "subspace");
    single->frames = 2;
    Watch watch = run(single, &method, NULL);
    assert_near(watch.bodies[0].position.x, 1.5, 0);
    assert_near(watch.bodies[0].velocity.x, 1.5 * 60, 1e-3);
    assert_near(watch.bodies[0].angle, 2.5, 0);
    single->frames = 4;
    watch = run(single, &method, NULL);
    assert_near(watch.bodies[0].position.y, 3.5, 0);
    assert_near(watch.bodies[0].velocity.y, 0, 0);
}

TEST_WITH(a_recorded_run_begins_where_the_scene_does, make, destroy) {
    OWN(SubspaceNet) *recorded = subspace_net_by_hand(1);
    recorded->before[1] = 4 / 2;
    const Method method = method_of(recorded, single, "subspace");
    assert_refused(simulate_watched(single, &method, &(RunWatch){0}, &error),
                   "before: body 1 is at (0, 2) m after a step, but starts at (0, 4) m");
}

/* As `twinbox check` runs a scene. */
TEST_WITH(without_its_bomb_a_launch_stands_still, make, destroy) {
    single->frames = 3;
    const Method method = method_of(net, single, "subspace");
    single->bomb.present = false;
    const Watch watch = run(single, &method, NULL);
    assert_near(watch.bodies[0].position.y, 4, 0);
}

TEST_WITH(what_training_did_not_see_is_counted, make, destroy) {
    single->frames = 10;
    Method method = method_of(net, single, "subspace");
    Launch launch = launch_of(single);
    launch.mass = 80;
    const Scene heavy = launch_scene(single, &launch);
    Fallbacks fallbacks = {0};
    run(&heavy, &method, &fallbacks);
    assert_int_equal(fallbacks.beyond_training, 10);
    net->low[5] = 14; /* the bomb's height */
    method = method_of(net, single, "subspace");
    fallbacks = (Fallbacks){0};
    const Watch watch = run(single, &method, &fallbacks);
    assert_near(watch.bodies[1].position.y, 14, 0);
    assert_in_range(fallbacks.beyond_training, 1, 9);
}

/* A basis so large that poses overflow: bodies stay where they are. */
TEST_WITH(poses_that_are_not_finite_are_discarded, make, destroy) {
    single->frames = 3;
    for (int k = 4; k < TEST_NUMBERS; k++) {
        net->basis[k * subspace_lanes(TEST_NUMBERS) + k] = 3e38f;
        net->low[k] = net->high[k] = 1000;
    }
    const Method method = method_of(net, single, "subspace");
    Fallbacks fallbacks = {0};
    const Watch watch = run(single, &method, &fallbacks);
    assert_near(watch.bodies[1].position.y, 15, 0);
    assert_true(fallbacks.not_finite >= 3);
}

static void refuse(const Method *method, const Scene *scene, const char *reason) {
    Error error = {0};
    assert_refused(stepper_create(method, scene, &error), reason);
}

TEST_WITH(what_does_not_fit_is_refused, make, destroy) {
    Method method = method_of(net, single, "subspace");
    OWN(Scene) *stack = scene_named("stack");
    refuse(&method, stack, "the network is for scene single with 2 bodies that move; scene stack has 11");
    single->bodies[1].mass = 20;
    refuse(&method, single, "by_hand.npz: error: the network is for scene single; bodies, bomb, gravity or time");
    single->bodies[1].mass = 200;
    const SceneBomb bomb = single->bomb;
    single->bomb = (SceneBomb){0};
    refuse(&method, single, "bodies, bomb, gravity or time");
    single->bomb = bomb;
    method = method_of(net, single, "subspace:components=9");
    refuse(&method, single, "components must be 8, 32 or 128 (got 9)");
    assert_ok(method_parse(&method, "subspace", &error), error);
    single->network_count = 0;
    refuse(&method, single, "the scene names no network for it");
}

RUN_TESTS(NULL, NULL)

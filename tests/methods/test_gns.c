/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stepper gns. Its learned part is any network here: laws do not depend on what was learned. */
#include "made.h"
#include "methods/particle_heap.h"
#include "allocations.h"

static BodyDef box_at(float x, float y) {
    return (BodyDef){.size = {1, 1}, .mass = 2, .friction = 0.2f, .position = {x, y}, .angle = 0.1f * y};
}

static Scene scene_of(BodyDef *bodies, int count) {
    return (Scene){.name = "laws",
                   .gravity = {0, -10},
                   .dt = 1.0f / 60.0f,
                   .iterations = 10,
                   .warm_starting = true,
                   .body_count = count,
                   .bodies = bodies};
}

/* size: of the parameters, each uniform between -size and size. */
static const char *write_net(float size, float strongest) {
    Error error = {0};
    OWN(GnsNet) net;
    make_net(&net, 16, 2);
    for (int i = 0; i < net.layout.parameters; i++) net.parameters[i] *= size / 0.4f;
    net.scales.strongest = strongest;
    const char *path = temporary_path("net.npz");
    assert_ok(gns_net_write(&net, path, &error), error);
    return path;
}

typedef struct Run {
    Scene scene;
    World *world;
    Stepper *stepper;
} Run;

static void begin(Run *run, BodyDef *bodies, int count, const char *settings, const char *net) {
    Error error = {0};
    Method method;
    assert_ok(method_with_network(&method, printed("gns%s", settings), net, &error), error);
    run->scene = scene_of(bodies, count);
    run->world = world_of(&run->scene);
    run->stepper = stepper_of(&run->scene, &method);
}

static void end(Run *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

static void steps(Run *run, int first, int last) {
    Error error = {0};
    for (int frame = first; frame <= last; frame++)
        assert_ok(simulate_step(run->stepper, run->world, &(Step){.scene = &run->scene, .frame = frame}, &error),
                  error);
}

static const BodyDef ground = {.fixed = true, .size = {200, 20}, .position = {0, -10}, .friction = 0.2f};

/* Without the network, and with outputs that are not credible, boxes fall: y = -g t (t + dt) / 2, through
   everything. */
TEST(boxes_fall_without_the_network) {
    static const struct {
        const char *settings;
        float strongest;
        int discarded;
    } cases[] = {{":net=off", 1000, 0}, {":net=off,rigid=off", 1000, 0}, {"", 1e-30f, 2}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        BodyDef bodies[] = {ground, box_at(0, 0.9f), box_at(0.2f, 1.8f)};
        bodies[2].velocity = vec2(3, 1);
        bodies[2].angular_velocity = 2;
        Run run;
        begin(&run, bodies, 3, cases[c].settings, write_net(0.4f, cases[c].strongest));
        steps(&run, 1, 60);
        const Body *now = world_bodies(run.world);
        assert_near(now[1].position.y, 0.9f - 5 * (1 + 1.0 / 60), 1e-3);
        assert_near(now[2].position.x, 3.2, 1e-3);
        assert_near(now[2].position.y, 1.8f + 1 - 5 * (1 + 1.0 / 60), 1e-3);
        /* Particles on straight ways, so that a box that is not kept rigid grows: the network has to learn what turns
           them. */
        assert_near(now[2].angle, 0.18 + 2, c == 1 ? 1 : 0.1);
        assert_near(now[0].position.y, -10, 0);
        assert_int_equal(world_solution(run.world)->fallbacks.not_finite, cases[c].discarded);
        end(&run);
    }
}

/* What the network makes of boxes in the air is momentum from nothing, and is reported as that. */
TEST(momentum_in_free_flight_is_an_error) {
    BodyDef bodies[] = {box_at(0, 50)};
    Run run;
    begin(&run, bodies, 1, "", write_net(0.4f, 1e6f));
    steps(&run, 1, 1);
    const Vec2 velocity = world_bodies(run.world)[0].velocity;
    const double change = hypot((double)velocity.x, (double)velocity.y + 10.0 / 60);
    assert_true(change > 1e-3);
    assert_near(world_solution(run.world)->momentum_error, 2 * change, 1e-4);
    end(&run);
}

/* A box that the stepper left in another state, or does not know, begins with a past of constant velocity. */
TEST(another_world_begins_without_a_past) {
    const char *net = write_net(0.4f, 1e6f);
    BodyDef bodies[] = {ground, box_at(0, 0.6f), box_at(0.5f, 1.7f)};
    Run fresh, used;
    begin(&fresh, bodies, 3, "", net);
    begin(&used, bodies, 3, "", net);
    World *start = world_create(&(WorldDef){.gravity = {0, -10}}, &error);
    assert_ok(start != NULL && world_copy(start, used.world, &error), error);
    steps(&used, 1, 5);
    assert_ok(world_copy(used.world, start, &error), error);
    steps(&used, 6, 9);
    steps(&fresh, 1, 4);
    for (int i = 0; i < 3; i++)
        assert_memory_equal(&world_bodies(used.world)[i], &world_bodies(fresh.world)[i], sizeof(Body));
    world_destroy(start);
    end(&fresh);
    end(&used);
}

TEST(steps_allocate_nothing) {
    for (int rigid = 0; rigid < 2; rigid++) {
        BodyDef bodies[] = {ground, box_at(0, 0.6f), box_at(0.5f, 1.7f)};
        Run run;
        begin(&run, bodies, 3, rigid ? "" : ":rigid=off", write_net(0.01f, 1e6f));
        steps(&run, 1, 20);
        allocations = 0;
        steps(&run, 21, 25);
        assert_int_equal(allocations, 0);
        end(&run);
    }
}

/* The network's gravity is (0, -10). */
TEST(another_gravity_than_in_training_is_counted) {
    BodyDef bodies[] = {box_at(0, 9)};
    Run run;
    begin(&run, bodies, 1, "", write_net(0.4f, 1e6f));
    run.scene.gravity = (Vec2){0, -1.6f};
    steps(&run, 1, 2);
    assert_int_equal(world_solution(run.world)->fallbacks.beyond_training, 1);
    end(&run);
}

/* Boxes of one place: too many neighbours. Counted once a step. */
TEST(states_beyond_training_are_counted) {
    enum { BOXES = 12 };
    BodyDef bodies[BOXES];
    for (int i = 0; i < BOXES; i++) bodies[i] = box_at(0, 9);
    Run run;
    begin(&run, bodies, 1, "", write_net(0.4f, 1e6f));
    steps(&run, 1, 1);
    assert_int_equal(world_solution(run.world)->fallbacks.beyond_training, 0);
    end(&run);
    begin(&run, bodies, BOXES, "", write_net(0.4f, 1e6f));
    steps(&run, 1, 1);
    assert_int_equal(world_solution(run.world)->fallbacks.beyond_training, 1);
    end(&run);
}

TEST(other_networks_are_refused) {
    BodyDef bodies[] = {ground};
    const Scene scene = scene_of(bodies, 1);
    Method method = method_named("gns");
    assert_refused(stepper_create(&method, &scene, &error), "needs a network");
    error = (Error){0};
    assert_ok(method_with_network(&method, "gns", SOURCE_DIR "/scenes/networks/sain.npz", &error), error);
    assert_refused(stepper_create(&method, &scene, &error), "sain.npz: error: not a file of kind 'gns'");
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws that hold for soft-step and avbd, the steppers that remove overlap without giving it a velocity. */
#include "allocations.h"
#include "made.h"

#include "base/hash.h"

static const char *const methods[] = {"soft-step", "avbd", "soft-step:substeps=8", "avbd:alpha=0.99",
                                      "soft-step:keep=0.05"};

enum { METHOD_COUNT = sizeof methods / sizeof methods[0] };

static const BodyDef ground = {.fixed = true, .size = {200, 20}, .position = {0, -10}, .friction = 0.2f};

static BodyDef box_at(float x, float y) {
    return (BodyDef){.size = {1, 1}, .mass = 2, .friction = 0.2f, .position = {x, y}};
}

static Scene scene_of(BodyDef *bodies, int count, Vec2 gravity) {
    Scene scene = scene_of_bodies(bodies, count, 0);
    scene.gravity = gravity;
    return scene;
}

static void take_steps(Stepper *stepper, World *world, const Scene *scene, int first, int last) {
    Error error = {0};
    for (int frame = first; frame <= last; frame++)
        assert_ok(simulate_step(stepper, world, &(Step){.scene = scene, .frame = frame}, &error), error);
}

static World *run(const Scene *scene, const char *text, int steps) {
    World *world = world_of(scene);
    OWN(Stepper) *stepper = stepper_by(scene, text);
    take_steps(stepper, world, scene, 1, steps);
    return world;
}

static Scene stack_of_ten(BodyDef bodies[11]) {
    bodies[0] = ground;
    for (int i = 1; i <= 10; i++) bodies[i] = box_at(0, 1.05f * (float)i - 0.54f);
    return scene_of(bodies, 11, vec2(0, -10));
}

/* With substeps of h, a fall is g t^2 / 2 (1 + h / t). */
TEST(a_box_falls_by_its_substeps) {
    const float substeps[METHOD_COUNT] = {4, 1, 8, 1, 4};
    BodyDef bodies[] = {box_at(0, 100)};
    const Scene scene = scene_of(bodies, 1, vec2(0, -10));
    for (int m = 0; m < METHOD_COUNT; m++) {
        OWN(World) *world = run(&scene, methods[m], 30);
        const float t = 0.5f, fall = 0.5f * 10 * t * t * (1 + 1 / (60 * substeps[m] * t));
        assert_near(world_bodies(world)[0].position.y, 100 - fall, 1e-4);
        assert_near(world_bodies(world)[0].velocity.y, -10 * t, 1e-4);
    }
}

TEST(a_box_at_rest_carries_its_weight) {
    BodyDef bodies[] = {ground, box_at(0, 0.6f)};
    const Scene scene = scene_of(bodies, 2, vec2(0, -10));
    for (int m = 0; m < METHOD_COUNT; m++) {
        OWN(World) *world = run(&scene, methods[m], 300);
        float carried = 0;
        assert_int_equal(world_problem(world)->contact_count, 2);
        for (int i = 0; i < 2; i++) carried += world_solution(world)->impulses[i].normal;
        assert_near(carried, 2 * 10.0 / 60, 2e-4);
        assert_near(world_bodies(world)[1].velocity.y, 0, 1e-4);
    }
}

/* Overlap at rest: at most 15 mm a contact, also by two passes of avbd, thanks to its warm start. Not with kept
   contacts, the last method: without a skin, boxes that drop may land up to 0.2 m askew, as the engine's do. That their
   stacks stand is a test of kept_contacts. */
TEST(a_stack_of_ten_stands_for_ten_seconds) {
    BodyDef bodies[11];
    const Scene scene = stack_of_ten(bodies);
    for (int m = 0; m < METHOD_COUNT - 1; m++) {
        OWN(World) *world = run(&scene, m == 1 ? "avbd:k=2" : methods[m], 600);
        for (int i = 1; i <= 10; i++) {
            const Body *body = &world_bodies(world)[i];
            assert_near(body->position.x, 0, 0.05);
            assert_near(body->angle, 0, 0.01);
            assert_in_range((int)(1e4f * ((float)i - 0.5f - body->position.y)), 0, 150 * i);
        }
    }
}

/* A first step in a stack at rest begins with the impulses of the step before, which another stepper took. */
TEST(a_step_of_unknown_past_has_a_warm_start) {
    BodyDef bodies[11];
    const Scene scene = stack_of_ten(bodies);
    OWN(World) *world = run(&scene, "soft-step", 300);
    OWN(Stepper) *stepper = stepper_by(&scene, "soft-step");
    take_steps(stepper, world, &scene, 301, 301);
    for (int i = 1; i <= 10; i++) assert_near(world_bodies(world)[i].velocity.y, 0, 0.01);
}

/* 5 s on a slope of friction 0.2: it holds at 0.19, at 0.25 it slides with g (0.25 - 0.2) from the start. */
TEST(a_slope_holds_below_its_friction) {
    BodyDef bodies[] = {ground, box_at(0, 0.495f)};
    for (int m = 0; m < METHOD_COUNT; m++) {
        const Scene held = scene_of(bodies, 2, vec2(1.9f, -10)), slides = scene_of(bodies, 2, vec2(2.5f, -10));
        World *world = run(&held, methods[m], 300);
        assert_near(world_bodies(world)[1].position.x, 0, 0.01);
        world_destroy(world);
        world = run(&slides, methods[m], 300);
        assert_near(world_bodies(world)[1].position.x, 0.5 * 0.5 * 25, 0.15);
        world_destroy(world);
    }
}

/* 12 m/s with friction 0.6: v^2 / (2 mu g), less what a (sub)step's friction takes in its first half. */
TEST(a_box_that_slides_stops_where_friction_stops_it) {
    BodyDef bodies[] = {ground, box_at(-50, 0.399f)};
    bodies[0].friction = bodies[1].friction = 0.6f;
    bodies[1].size = (Vec2){0.8f, 0.8f};
    bodies[1].velocity = (Vec2){12, 0};
    const double substeps[METHOD_COUNT] = {4, 1, 8, 1, 4};
    const Scene scene = scene_of(bodies, 2, vec2(0, -10));
    for (int m = 0; m < METHOD_COUNT; m++) {
        OWN(World) *world = run(&scene, methods[m], 180);
        const float slid = world_bodies(world)[1].position.x + 50;
        const double way = 12 - 0.1 / substeps[m];
        if (!(fabs((double)slid - way) < 0.02)) fail_msg("%s: slid %g m, not %g", methods[m], (double)slid, way);
    }
}

/* A heavier box strikes a free one off its centre. avbd conserves momentum only as far as its passes converge. */
TEST(a_free_collision_conserves_momentum) {
    const struct {
        const char *method;
        double tolerance;
    } cases[] = {{"soft-step", 1e-4}, {"soft-step:substeps=8", 1e-4}, {"avbd:k=10", 2}, {"avbd:k=1000", 1e-2}};
    BodyDef bodies[] = {box_at(-1.2f, 0.3f), box_at(0, 0)};
    bodies[0].mass = 6;
    bodies[0].velocity = vec2(5, 0);
    const Scene scene = scene_of(bodies, 2, vec2(0, 0));
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        OWN(World) *world = run(&scene, cases[c].method, 30);
        const Body *a = &world_bodies(world)[0], *b = &world_bodies(world)[1];
        assert_true(b->velocity.x > 2 && fabsf(b->angular_velocity) > 0.1f);
        assert_near(6 * a->velocity.x + 2 * b->velocity.x, 30, cases[c].tolerance);
        assert_near(6 * a->velocity.y + 2 * b->velocity.y, 0, cases[c].tolerance);
    }
}

/* A box deep in the ground comes out and stops there. */
TEST(overlap_gives_no_velocity) {
    BodyDef bodies[] = {ground, box_at(0, 0.2f)};
    const Scene scene = scene_of(bodies, 2, vec2(0, -10));
    for (int m = 0; m < METHOD_COUNT; m++)
        for (int steps = 1; steps < 600; steps += steps) {
            OWN(World) *world = run(&scene, methods[m], steps);
            const Body *body = &world_bodies(world)[1];
            assert_true(body->position.y < 0.501f);
            if (steps > 500) assert_near(body->position.y, 0.5f, 0.02f);
        }
}

/* A turned box strikes one at rest, hardly overlapping: with overlap, the arms of avbd and of the contact problem end
   in different points. */
TEST(many_passes_of_avbd_meet_the_reference) {
    BodyDef bodies[] = {ground, box_at(0, 0.499f), box_at(0.6f, 1.6537f)};
    bodies[2].mass = 5;
    bodies[2].angle = 0.4f;
    bodies[2].velocity = vec2(-3, -4);
    for (int i = 0; i < 3; i++) bodies[i].friction = 0.5f;
    Scene scene = scene_of(bodies, 3, vec2(0, -10));
    scene.position_correction = false;
    OWN(World) *found = run(&scene, "avbd:k=1000", 1), *expected = run(&scene, "reference", 1);
    assert_true(world_bodies(expected)[2].velocity.y > 0.2f);
    for (int i = 1; i < 3; i++) {
        const Body *x = &world_bodies(found)[i], *y = &world_bodies(expected)[i];
        assert_near(x->velocity.x, y->velocity.x, 2e-3);
        assert_near(x->velocity.y, y->velocity.y, 2e-3);
        assert_near(x->angular_velocity, y->angular_velocity, 2e-3);
    }
    assert_near(world_solution(found)->momentum_error, 0, 1e-3);
}

static uint64_t state_hash(const World *world) {
    return hash_fnv1a64(FNV1A64_START, world_bodies(world), (size_t)world_body_count(world) * sizeof(Body));
}

/* Worlds that the stepper has not stepped last, though it has seen their past or future: an earlier copy, and one whose
   run begins in the state that the last one ended with. */
TEST(other_worlds_step_without_memory) {
    BodyDef bodies[11];
    const Scene scene = stack_of_ten(bodies);
    const int first[] = {51, 1}, ahead[] = {10, 0};
    for (int m = 0; m < METHOD_COUNT; m++)
        for (int i = 0; i < 2; i++) {
            OWN(World) *world = world_of(&scene), *copy = world_of(&scene);
            OWN(Stepper) *stepper = stepper_by(&scene, methods[m]), *fresh = stepper_by(&scene, methods[m]);
            take_steps(stepper, world, &scene, 1, 50);
            assert_ok(world_copy(copy, world, &error), error);
            take_steps(stepper, world, &scene, 51, 50 + ahead[i]);
            assert_ok(world_copy(world, copy, &error), error);
            take_steps(stepper, world, &scene, first[i], first[i]);
            take_steps(fresh, copy, &scene, first[i], first[i]);
            assert_true(state_hash(world) == state_hash(copy));
        }
}

TEST(a_settled_stack_steps_without_allocating) {
    BodyDef bodies[11];
    const Scene scene = stack_of_ten(bodies);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        if (kind->stepping == NULL || method->external || method->no_contacts || method->role == METHOD_BASELINE)
            continue;
        OWN(World) *world = world_of(&scene);
        OWN(Stepper) *stepper = stepper_by(&scene, method->name);
        allocations = 0;
        take_steps(stepper, world, &scene, 1, 60);
        assert_true(allocations > 5);
        allocations = 0;
        take_steps(stepper, world, &scene, 61, 120);
        assert_int_equal(allocations, 0);
    }
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The step around the solver: what a contact problem holds, what persists, and what a failed step leaves. */
#include "owned.h"

#include "engine/engine.h"

static const float dt = 1.0f / 60.0f;

/* A solver that hands on what it is told to. */
typedef struct FakeSolver {
    float impulse;  /* N s, claimed for every contact */
    float velocity; /* m/s, upwards, of every body that can move */
    bool fails;
} FakeSolver;

static bool fake_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    const FakeSolver *fake = state;
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){vec2(0, problem->bodies[i].inv_mass > 0 ? fake->velocity : 0), 0};
    for (int i = 0; i < problem->contact_count; i++)
        solution->impulses[i] = (ContactImpulse){fake->impulse + (float)i, -fake->impulse};
    return !fake->fails || error_input(error, "fake", "told to fail");
}

static World *box_on_ground(bool warm_starting, bool position_correction, float height) {
    Error error = {0};
    const WorldDef def = {{0, -10}, warm_starting, position_correction};
    World *world = world_create(&def, &error);
    assert_ok(world != NULL, error);
    const BodyDef ground = {.size = {100, 20}, .fixed = true, .friction = 0.4f, .position = {0, -10}};
    const BodyDef box = {.size = {1, 1}, .mass = 3, .friction = 0.9f, .position = {0, height}};
    assert_ok(world_add_body(world, &ground, &error), error);
    assert_ok(world_add_body(world, &box, &error), error);
    return world;
}

static void step(World *world, FakeSolver *fake) {
    Error error = {0};
    assert_ok(world_step(world, fake_solve, fake, dt, &error), error);
}

/* A unit box of mass 3 (inertia m (1 + 1) / 12 = 0.5) whose corners are 0.5 m below and beside its centre:
   1/m_n = 1/3 + (1/0.5) 0.5^2, and the same along the tangent. Depth 0.03 m: bias = 0.2 / dt (0.03 - 0.01). */
TEST(a_contact_problem_holds_what_the_step_froze) {
    OWN(World) *world = box_on_ground(true, true, 0.47f);
    FakeSolver fake = {0};
    world_set_bomb(world, 1);
    step(world, &fake);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->body_count, 2);
    assert_int_equal(problem->contact_count, 2);
    assert_int_equal(problem->bomb, 1);
    assert_near(problem->dt, dt, 0);
    assert_near(problem->bodies[1].velocity.y, -10 * dt, 1e-6);
    assert_near(problem->bodies[0].velocity.y, 0, 0);
    for (int i = 0; i < 2; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        assert_int_equal(contact->a, 0);
        assert_int_equal(contact->b, 1);
        assert_near(contact->separation, -0.03, 1e-5);
        assert_near(contact->mass_normal, 1 / (1 / 3.0 + 2 * 0.25), 1e-4);
        assert_near(contact->mass_tangent, 1 / (1 / 3.0 + 2 * 0.47 * 0.47), 1e-4);
        assert_near(contact->friction, 0.6, 1e-6);
        assert_near(contact->bias, 0.2 * 60 * 0.02, 1e-4);
        assert_near(contact->arm_b.x, i == 0 ? -0.5 : 0.5, 1e-5);
        assert_near(contact->arm_b.y, -0.47, 1e-5);
    }
}

TEST(position_correction_can_be_switched_off) {
    OWN(World) *world = box_on_ground(true, false, 0.47f);
    FakeSolver fake = {0};
    step(world, &fake);
    assert_near(world_problem(world)->contacts[0].bias, 0, 0);
}

/* The impulses of a step come back as the warm start of the next, point by point; not once the pair has parted. */
TEST(impulses_persist_while_the_pair_touches) {
    OWN(World) *world = box_on_ground(true, true, 0.495f);
    FakeSolver fake = {.impulse = 7};
    step(world, &fake);
    assert_near(world_problem(world)->contacts[1].warm_normal, 0, 0);
    step(world, &fake);
    for (int i = 0; i < 2; i++) {
        assert_near(world_problem(world)->contacts[i].warm_normal, 7 + i, 0);
        assert_near(world_problem(world)->contacts[i].warm_tangent, -7, 0);
    }
    fake.velocity = 1;
    step(world, &fake); /* lifted off after this step */
    fake.velocity = -1;
    step(world, &fake); /* apart: no contacts; down again after it */
    assert_int_equal(world_problem(world)->contact_count, 0);
    step(world, &fake);
    assert_int_equal(world_problem(world)->contact_count, 2);
    assert_near(world_problem(world)->contacts[0].warm_normal, 0, 0);
}

TEST(warm_starting_can_be_switched_off) {
    OWN(World) *world = box_on_ground(false, true, 0.495f);
    FakeSolver fake = {.impulse = 7};
    step(world, &fake);
    step(world, &fake);
    assert_int_equal(world_problem(world)->contact_count, 2);
    assert_near(world_problem(world)->contacts[0].warm_normal, 0, 0);
}

static void fail_step(World *world, FakeSolver *fake, const char *message) {
    Body before[2];
    memcpy(before, world_bodies(world), sizeof before);
    Error error = {0};
    assert_refused(world_step(world, fake_solve, fake, dt, &error), message);
    assert_memory_equal(world_bodies(world), before, sizeof before);
}

/* Unchanged means: the bodies, and the impulses that the next step starts from. */
TEST(a_step_that_fails_leaves_the_world_unchanged) {
    OWN(World) *world = box_on_ground(true, true, 0.495f);
    FakeSolver fake = {.impulse = 7};
    step(world, &fake);
    fail_step(world, &(FakeSolver){.impulse = 99, .fails = true}, "told to fail");
    fail_step(world, &(FakeSolver){.impulse = 99, .velocity = INFINITY}, "the state of body 1 is NaN or infinite");
    fail_step(world, &(FakeSolver){.impulse = 99, .velocity = NAN}, "the state of body 1 is NaN or infinite");
    step(world, &fake);
    assert_near(world_problem(world)->contacts[0].warm_normal, 7, 0);
}

/* A copy continues as the original does, impulses included; a step that is begun and not ended changes neither. */
TEST(a_copy_goes_on_as_the_original) {
    OWN(World) *world = box_on_ground(true, true, 0.495f), *copy = box_on_ground(false, false, 3);
    FakeSolver fake = {.impulse = 7, .velocity = -0.1f};
    step(world, &fake);
    assert_ok(world_copy(copy, world, &error), error);
    ContactProblem problem;
    ContactSolution *solution;
    assert_ok(world_begin_step(world, dt, &problem, &solution, &error), error);
    assert_near(problem.contacts[1].warm_normal, 8, 0);
    for (int i = 0; i < 3; i++) {
        fake.impulse += 1;
        step(world, &fake);
        step(copy, &fake);
        assert_memory_equal(world_bodies(world), world_bodies(copy), 2 * sizeof(Body));
        assert_near(world_problem(copy)->contacts[1].warm_normal, 7 + (float)i + 1, 0);
    }
}

/* Poses from the method, velocities from the solution. */
TEST(a_step_can_end_at_poses_given) {
    OWN(World) *world = box_on_ground(true, true, 2);
    ContactProblem problem;
    ContactSolution *solution;
    assert_ok(world_begin_step(world, dt, &problem, &solution, &error), error);
    solution->velocities[0] = solution->velocities[1] = (BodyVelocity){vec2(1, 2), 3};
    const BodyPose poses[] = {{{0, -10}, 0}, {{4, 5}, 6}};
    assert_ok(world_end_step_at(world, poses, &error), error);
    assert_near(world_bodies(world)[1].position.x, 4, 0);
    assert_near(world_bodies(world)[1].angle, 6, 0);
    assert_near(world_bodies(world)[1].angular_velocity, 3, 0);
}

/* Ground, a box on it and a box on that; each pair touches in two points. */
static World *two_boxes_on_ground(Vec2 upper_size) {
    Error error = {0};
    World *world = box_on_ground(true, true, 0.495f);
    const BodyDef upper = {.size = upper_size, .mass = 1, .position = {0, 1.485f}};
    assert_ok(world_add_body(world, &upper, &error), error);
    return world;
}

static void expect_warm(const World *world, int contact, float warm) {
    assert_near(world_problem(world)->contacts[contact].warm_normal, warm, 0);
}

/* A box that passes over the edge of the one below has a point made by another edge, at the same place. */
TEST(mended_contacts_keep_their_impulses_by_place) {
    OWN(World) *world = two_boxes_on_ground(vec2(1, 1));
    world_set_contacts(world, (ContactRules){.mend = true});
    const BodyPose poses[] = {{{0, -10}, 0}, {{0, 0.495f}, 0}, {{1e-4f, 1.485f}, 0}};
    ContactProblem problem;
    ContactSolution *solution;
    assert_ok(world_begin_step(world, dt, &problem, &solution, &error), error);
    assert_int_equal(problem.contact_count, 4);
    assert_int_equal(world_contacts_before(world)[3], -1);
    contact_solution_begin(&problem, solution);
    const bool left = problem.contacts[2].arm_b.x < 0;
    solution->impulses[2] = (ContactImpulse){5, 1};
    solution->impulses[3] = (ContactImpulse){7, -1};
    const uint32_t features = problem.contacts[2].feature ^ problem.contacts[3].feature;
    assert_ok(world_end_step_at(world, poses, &error), error);
    assert_ok(world_begin_step(world, dt, &problem, &solution, &error), error);
    assert_int_not_equal(problem.contacts[2].feature ^ problem.contacts[3].feature, features);
    const int first = (problem.contacts[2].arm_b.x < 0) == left ? 2 : 3;
    assert_int_equal(world_contacts_before(world)[first], 2);
    expect_warm(world, first, 5);
    expect_warm(world, 5 - first, 7);
}

/* At 1000 m a coordinate rounds to 61 micrometres: a gap of one rounding must not let a box fall, one of 5 mm must. */
TEST(a_gap_below_rounding_is_none) {
    for (int k = 0; k < 2; k++) {
        OWN(World) *world = world_create(&(WorldDef){{0, -10}, true, true}, &error);
        world_set_contacts(world, (ContactRules){.mend = true});
        const float gap = k == 0 ? 0x1p-14f : 0x1.4p-8f;
        assert_ok(world_add_body(world, &(BodyDef){.size = {9, 9}, .fixed = true, .position = {0, 1000}}, &error),
                  error);
        const BodyDef box = {.size = {1, 1}, .mass = 1, .position = {0, 1005 + gap}};
        assert_ok(world_add_body(world, &box, &error), error);
        FakeSolver fake = {0};
        step(world, &fake);
        const ContactProblem *problem = world_problem(world);
        assert_int_equal(problem->contact_count, 2);
        assert_near(problem->contacts[0].separation, gap, 1e-9);
        assert_near(problem->contacts[0].bias, k == 0 ? 0 : -gap / dt, 1e-6);
    }
}

/* What the step did can be read until the next, which has the others' contacts and their impulses. */
TEST(a_body_taken_out_takes_its_contacts_with_it) {
    OWN(World) *world = two_boxes_on_ground(vec2(1, 1));
    FakeSolver fake = {.impulse = 7};
    world_set_bomb(world, 2);
    step(world, &fake);
    world_remove_last_body(world);
    assert_int_equal(world_body_count(world), 2);
    assert_int_equal(world_problem(world)->contact_count, 4);
    assert_int_equal(world_problem(world)->contacts[3].b, 2);
    assert_near(world_solution(world)->impulses[3].normal, 10, 0);
    step(world, &fake);
    assert_int_equal(world_problem(world)->body_count, 2);
    assert_int_equal(world_problem(world)->bomb, -1);
    assert_int_equal(world_problem(world)->contact_count, 2);
    for (int i = 0; i < 2; i++) expect_warm(world, i, 7 + (float)i);
}

/* A body added in its place has neither its impulses nor its box; a copy made meanwhile continues alike. */
TEST(a_body_in_the_place_of_one_taken_out_starts_anew) {
    for (int same_size = 0; same_size <= 1; same_size++) {
        World *world = two_boxes_on_ground(vec2(1, 1)), *copy = box_on_ground(false, false, 3);
        FakeSolver fake = {.impulse = 7};
        step(world, &fake);
        world_remove_last_body(world);
        assert_ok(world_copy(copy, world, &error), error);
        World *both[] = {world, copy};
        for (int i = 0; i < 2; i++) {
            const BodyDef other = {.size = {1, same_size ? 1 : 0.5f}, .mass = 1, .position = {0, 1.485f}};
            assert_ok(world_add_body(both[i], &other, &error), error);
            step(both[i], &fake);
            assert_int_equal(world_problem(both[i])->contact_count, same_size ? 4 : 2);
            for (int k = 0; k < world_problem(both[i])->contact_count; k++)
                expect_warm(both[i], k, k < 2 ? 7 + (float)k : 0);
            world_destroy(both[i]);
        }
    }
}

/* n boxes in one place are n (n - 1) / 2 pairs: 1448 are just below 2^20, 1449 above. */
TEST(too_many_pairs_are_refused) {
    const WorldDef def = {.gravity = {0, -10}};
    const BodyDef box = {.size = {1, 1}, .mass = 1};
    OWN(World) *world = world_create(&def, &error);
    ContactProblem problem;
    ContactSolution *solution;
    for (int i = 0; i < 1448; i++) assert_ok(world_add_body(world, &box, &error), error);
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
    assert_ok(world_add_body(world, &box, &error), error);
    assert_refused(world_begin_step(world, 0.01f, &problem, &solution, &error),
                   "more than 1048576 pairs of boxes overlap");
    error = (Error){0};
    world_remove_last_body(world);
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
}

TEST(fixed_bodies_stay) {
    OWN(World) *world = box_on_ground(true, true, 5);
    FakeSolver fake = {0};
    for (int i = 0; i < 10; i++) step(world, &fake);
    assert_near(world_bodies(world)[0].position.y, -10, 0);
    assert_near(world_bodies(world)[0].inv_mass, 0, 0);
    assert_int_equal(world_body_count(world), 2);
}

RUN_TESTS(NULL, NULL)

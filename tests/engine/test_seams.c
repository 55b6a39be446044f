/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts that are mended: which faces a box and a tile touch with, and from which gap on boxes touch. Answers
   follow from the places of the boxes. */
#include "owned.h"

#include "engine/engine.h"

/* A box of 0.8 m on the end of a tile of 1 m at x = 0, sunk by 5 mm, whose front is over the next tile. */
typedef struct Place {
    float ahead; /* m, of the front of the box beyond the seam */
    float step;  /* m, by which the second tile is higher */
    float gap;   /* m, between the tiles */
    float scale; /* of all lengths */
    float angle; /* rad, of the world */
    bool tall;   /* the second tile is 3 m high */
} Place;

static BodyDef turned(Vec2 position, Vec2 size, float mass, const Place *place) {
    const Mat22 rotation = mat22_rotation(place->angle);
    return (BodyDef){.size = vec2_scale(place->scale, size),
                     .fixed = mass == 0,
                     .mass = mass,
                     .position = vec2_scale(place->scale, mat22_multiply(rotation, position)),
                     .angle = place->angle};
}

/* The normal from a body to the last one in a step, in the world's frame before its turn; (0, 0): they do not touch. */
static Vec2 normal_from(const World *world, int body, float angle) {
    const ContactProblem *problem = world_problem(world);
    for (int i = 0; i < problem->contact_count; i++)
        if (problem->contacts[i].a == body && problem->contacts[i].b == problem->body_count - 1)
            return mat22_multiply(mat22_transpose(mat22_rotation(angle)), problem->contacts[i].normal);
    return vec2(0, 0);
}

/* The normal from the second tile to the box. */
static Vec2 normal_at(const Place *place, bool mend) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -10}};
    const float high = place->tall ? 3 : 1;
    const BodyDef bodies[] = {
        turned(vec2(-0.5f, -0.5f), vec2(1, 1), 0, place),
        turned(vec2(0.5f + place->gap, place->step - 0.5f + (place->tall ? 1.5f : 0)), vec2(1, high), 0, place),
        turned(vec2(place->ahead - 0.4f, 0.395f), vec2(0.8f, 0.8f), 1, place)};
    ContactProblem problem;
    ContactSolution *solution;
    OWN(World) *world = world_create(&def, &error);
    assert_ok(world != NULL, error);
    for (int i = 0; i < 3; i++) assert_ok(world_add_body(world, &bodies[i], &error), error);
    world_set_contacts(world, (ContactRules){.mend = mend});
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
    const Vec2 first = normal_from(world, 0, place->angle), second = normal_from(world, 1, place->angle);
    assert_near(first.x, 0, 1e-5);
    assert_near(first.y, 1, 1e-5);
    return second;
}

static void assert_normal(const Place *place, bool mend, float x, float y) {
    const Vec2 normal = normal_at(place, mend);
    if (hypot((double)normal.x - (double)x, (double)normal.y - (double)y) > 1e-5)
        fail_msg("ahead %g, step %g, gap %g, scale %g, angle %g: normal %g, %g", (double)place->ahead,
                 (double)place->step, (double)place->gap, (double)place->scale, (double)place->angle, (double)normal.x,
                 (double)normal.y);
}

/* Box2D-Lite's contacts stop it at the side of the second tile. */
TEST(a_box_is_on_flush_tiles) {
    static const float aheads[] = {1e-4f, 1e-3f, 3e-3f, 4.9e-3f}, scales[] = {0.125f, 1, 128};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            for (int turn = -6; turn <= 6; turn++) {
                const Place place = {.ahead = aheads[i], .scale = scales[k], .angle = 0.5f * (float)turn};
                assert_normal(&place, true, 0, 1);
                assert_normal(&place, false, -1, 0);
            }
}

/* It has sunk by 5 mm, so its front is 3 mm deep in a tile that is lower by 2 mm. */
TEST(a_box_does_not_catch_where_the_floor_descends) {
    const Place place = {.ahead = 1e-3f, .step = -0.002f, .scale = 1};
    assert_normal(&place, true, 0, 1);
}

TEST(a_box_does_not_catch_behind_a_narrow_gap) {
    const Place narrow = {.ahead = 0.011f, .gap = 0.01f, .scale = 1}, wide = {.ahead = 0.601f, .gap = 0.6f, .scale = 1};
    assert_normal(&narrow, true, 0, 1);
    assert_normal(&wide, true, -1, 0);
}

/* A step of a hundredth of the side, 8 mm, is none. */
TEST(a_step_stops_a_box) {
    static const float steps[] = {8.1e-3f, 0.01f, 0.3f};
    for (int i = 0; i < 3; i++) {
        const Place place = {.ahead = 1e-3f, .step = steps[i], .scale = 1};
        assert_normal(&place, true, -1, 0);
    }
    const Place less = {.ahead = 1e-3f, .step = 7.9e-3f, .scale = 1}, wall = {.ahead = 1e-3f, .scale = 1, .tall = true};
    assert_normal(&less, true, 0, 1);
    assert_normal(&wall, true, -1, 0);
}

/* The overlap along the floor is empty: no face carries the box. */
TEST(a_box_that_only_touches_a_covered_side_has_no_contact_there) {
    const Place place = {.ahead = 0, .scale = 1};
    assert_normal(&place, true, 0, 0);
}

static int contacts_of_plates(float thickness, float gap, ContactRules rules, ContactPoint *first) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -10}, .position_correction = true};
    const BodyDef below = {.size = {2, thickness}, .fixed = true, .position = {0, -0.5f * thickness}};
    const BodyDef above = {.size = {2, thickness}, .mass = 1, .position = {0, 0.5f * thickness + gap}};
    ContactProblem problem;
    ContactSolution *solution;
    OWN(World) *world = world_create(&def, &error);
    assert_ok(world != NULL && world_add_body(world, &below, &error) && world_add_body(world, &above, &error), error);
    world_set_contacts(world, rules);
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
    const int count = problem.contact_count;
    if (count > 0) *first = problem.contacts[0];
    return count;
}

/* From a gap of 1% of the smaller side on, which may close within the step, and no more. */
TEST(boxes_touch_before_they_overlap) {
    const ContactRules mend = {.mend = true}, lite = {0};
    static const float sides[] = {0.01f, 0.1f, 1};
    for (int i = 0; i < 3; i++) {
        ContactPoint point;
        const float gap = 0.0095f * sides[i];
        assert_int_equal(contacts_of_plates(sides[i], gap, mend, &point), 2);
        assert_near(point.separation, gap, 1e-6 * (double)sides[i]);
        assert_near(point.bias, -100 * gap, 1e-4 * (double)sides[i]);
        assert_int_equal(contacts_of_plates(sides[i], 1.1f * gap, mend, &point), 0);
        assert_int_equal(contacts_of_plates(sides[i], gap, lite, &point), 0);
        assert_int_equal(contacts_of_plates(sides[i], -gap, lite, &point), 2);
    }
}

/* The upper one has been pressed past the centre of the lower one, and is pushed back up. */
TEST(boxes_that_touch_keep_their_sides) {
    const Box below = box_make(vec2(0, 0), vec2(2, 0.1f), 0),
              above = box_make(vec2(0.3f, -0.03f), vec2(1, 0.1f), 0.01f);
    const Vec2 last = vec2(0.02f, 0.9998f);
    Manifold manifold;
    manifold_compute_within(&manifold, &below, &above, 0.001f, &last);
    assert_int_equal(manifold.count, 2);
    assert_true(manifold.normal.y > 0.99f);
    for (int i = 0; i < 2; i++) assert_near(manifold.points[i].separation, -0.13, 0.006);
    manifold_compute_within(&manifold, &below, &above, 0.001f, NULL);
    assert_true(manifold.normal.y < -0.99f);
}

RUN_TESTS(NULL, NULL)

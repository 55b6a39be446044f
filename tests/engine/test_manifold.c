/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "uniform.h"

#include "engine/engine.h"

static const float tolerance = 1e-5f;

static Manifold collide(Box a, Box b) {
    Manifold manifold;
    manifold_compute(&manifold, &a, &b);
    return manifold;
}

static uint32_t feature(Edge a_in, Edge a_out, Edge b_in, Edge b_out) {
    return (uint32_t)a_in | (uint32_t)a_out << 8 | (uint32_t)b_in << 16 | (uint32_t)b_out << 24;
}

/* A unit box 0.02 m deep in the ground: its two lower corners, each named by the edges that meet there. */
TEST(box_on_ground_touches_with_its_lower_corners) {
    Manifold m = collide(box_make(vec2(0, -10), vec2(100, 20), 0), box_make(vec2(3, 0.48f), vec2(1, 1), 0));
    assert_int_equal(m.count, 2);
    assert_near(m.normal.x, 0, 0);
    assert_near(m.normal.y, 1, 0);
    const float x[2] = {2.5f, 3.5f};
    const uint32_t features[2] = {feature(NO_EDGE, NO_EDGE, EDGE_LEFT, EDGE_BOTTOM),
                                  feature(NO_EDGE, NO_EDGE, EDGE_BOTTOM, EDGE_RIGHT)};
    for (int i = 0; i < 2; i++) {
        assert_near(m.points[i].position.x, x[i], tolerance);
        assert_near(m.points[i].position.y, 0, tolerance);
        assert_near(m.points[i].separation, -0.02f, tolerance);
        assert_int_equal(m.points[i].feature, features[i]);
    }
}

/* Half over the edge of the box below: one corner of its own, one cut by the side of the box below. */
TEST(overhanging_box_is_clipped_to_the_box_below) {
    Manifold m = collide(box_make(vec2(0, 0), vec2(1, 1), 0), box_make(vec2(0.5f, 0.99f), vec2(1, 1), 0));
    assert_int_equal(m.count, 2);
    assert_near(m.points[0].position.x, 0, tolerance);
    assert_near(m.points[1].position.x, 0.5f, tolerance);
    /* The cut takes the reference box's edge in place of the incident box's. */
    assert_int_equal(m.points[1].feature, feature(NO_EDGE, EDGE_RIGHT, EDGE_BOTTOM, NO_EDGE));

    m = collide(box_make(vec2(0, 0), vec2(1, 1), 0), box_make(vec2(-0.5f, 0.99f), vec2(1, 1), 0));
    assert_int_equal(m.count, 2);
    assert_near(m.points[1].position.x, -0.5f, tolerance);
    assert_int_equal(m.points[1].feature, feature(EDGE_LEFT, NO_EDGE, NO_EDGE, EDGE_BOTTOM));
}

/* A corner of a box turned by 45 degrees pokes 0.01 m into the ground. */
TEST(a_corner_touches_in_one_point) {
    float reach = sqrtf(0.5f);
    Manifold m = collide(box_make(vec2(0, -10), vec2(100, 20), 0),
                         box_make(vec2(1, reach - 0.01f), vec2(1, 1), 0.25f * 3.14159265f));
    assert_int_equal(m.count, 1);
    assert_near(m.points[0].position.x, 1, 1e-4f);
    assert_near(m.points[0].separation, -0.01f, 1e-4f);
}

TEST(boxes_apart_do_not_touch) {
    Box a = box_make(vec2(0, 0), vec2(1, 1), 0);
    assert_int_equal(collide(a, box_make(vec2(1.001f, 0), vec2(1, 1), 0)).count, 0);
    assert_int_equal(collide(a, box_make(vec2(0, -1.001f), vec2(1, 1), 0)).count, 0);
    /* Bounds overlap, boxes do not: only the turned box's own axis separates them. */
    assert_int_equal(collide(a, box_make(vec2(0.9f, 0.9f), vec2(1, 1), 0.25f * 3.14159265f)).count, 0);
}

/* Box2D-Lite's choices where both signs are as good. */
TEST(ties_go_to_the_negative_normal) {
    Manifold m = collide(box_make(vec2(0, 0), vec2(1, 1), 0), box_make(vec2(0, 0), vec2(1, 1), 0));
    assert_int_equal(m.count, 2);
    assert_near(m.normal.x, -1, 0);
    assert_near(m.normal.y, 0, 0);
    assert_near(m.points[0].separation, -1, tolerance);
}

static bool contains(const Box *box, Vec2 point, float margin) {
    Vec2 local = mat22_multiply(mat22_transpose(box->rotation), vec2_sub(point, box->position));
    return fabsf(local.x) <= box->half.x + margin && fabsf(local.y) <= box->half.y + margin;
}

/* Laws of any manifold: a unit normal from a to b, overlaps that are not positive, points on the reference box and
   within the overlap of the incident one; and the boxes apart once b is moved out along the normal. */
TEST(manifolds_of_random_boxes_obey_their_laws) {
    uint32_t seed = 1;
    int touching = 0;
    for (int i = 0; i < 20000; i++) {
        Box a = box_make(vec2(0, 0), vec2(uniform(&seed, 0.2f, 3), uniform(&seed, 0.2f, 3)), uniform(&seed, -4, 4));
        Box b = box_make(vec2(uniform(&seed, -2, 2), uniform(&seed, -2, 2)),
                         vec2(uniform(&seed, 0.2f, 3), uniform(&seed, 0.2f, 3)), uniform(&seed, -4, 4));
        Manifold m = collide(a, b);
        if (m.count == 0) continue;
        touching++;
        assert_near(vec2_dot(m.normal, m.normal), 1, tolerance);
        assert_true(vec2_dot(m.normal, vec2_sub(b.position, a.position)) >= 0);
        float deepest = 0;
        for (int k = 0; k < m.count; k++) {
            assert_true(m.points[k].separation <= 0);
            float depth = -m.points[k].separation;
            if (depth > deepest) deepest = depth;
            assert_true(contains(&a, m.points[k].position, 1e-4f) || contains(&b, m.points[k].position, 1e-4f));
            assert_true(contains(&a, m.points[k].position, depth + 1e-4f));
            assert_true(contains(&b, m.points[k].position, depth + 1e-4f));
        }
        b.position = vec2_add(b.position, vec2_scale(deepest + 1e-3f, m.normal));
        assert_int_equal(collide(a, b).count, 0);
    }
    assert_in_range(touching, 2000, 19000);
}

/* A point found as a's corner in b is found as such from the other side: normal turned, feature halves swapped. */
TEST(swapping_the_boxes_swaps_the_manifold) {
    Box wide = box_make(vec2(0, 0), vec2(4, 1), 0.1f), small = box_make(vec2(0.3f, 0.9f), vec2(1, 1), 0.15f);
    Manifold m = collide(wide, small), swapped = collide(small, wide);
    assert_int_equal(m.count, 2);
    assert_int_equal(swapped.count, 2);
    assert_near(m.normal.x, -swapped.normal.x, tolerance);
    assert_near(m.normal.y, -swapped.normal.y, tolerance);
    for (int i = 0; i < 2; i++) {
        uint32_t f = m.points[i].feature;
        assert_int_equal(swapped.points[i].feature, f >> 16 | f << 16);
        assert_near(swapped.points[i].separation, m.points[i].separation, tolerance);
    }
}

RUN_TESTS(NULL, NULL)

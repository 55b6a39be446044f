/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Overlaps of boxes: closed forms, and agreement with the narrow phase. */
#include "testing.h"
#include "uniform.h"

#include "engine/engine.h"

/* The slop. */
static const double depth = 0.01;

static Box unit_box(float x, float y, float angle) { return box_make(vec2(x, y), vec2(1, 1), angle); }

TEST(depth_is_the_smallest_overlap) {
    const Box a = unit_box(0, 0, 0), beside = unit_box(0.75f, 0.25f, 0), apart = unit_box(0.5f, 1.5f, 0);
    assert_near(overlap_depth(&a, &beside), 0.25, 1e-7);
    assert_near(overlap_depth(&a, &apart), -0.5, 1e-7);
    /* A square on its corner reaches half its diagonal. */
    const Box corner = unit_box(0, 1.1f, (float)(M_PI / 4));
    assert_near(overlap_depth(&a, &corner), 0.5 + sqrt(0.5) - 1.1, 1e-6);
    /* A small box within a large one: out by the nearest face. */
    const Box large = box_make(vec2(0, -10), vec2(100, 20), 0), within = unit_box(3, -2, 0);
    assert_near(overlap_depth(&large, &within), 2.5, 1e-6);
}

static Box random_box(uint32_t *seed) {
    const float x = uniform(seed, -2, 2), y = uniform(seed, -2, 2), w = uniform(seed, 0.2f, 2);
    const float h = uniform(seed, 0.2f, 2), angle = uniform(seed, -4, 4);
    return box_make(vec2(x, y), vec2(w, h), angle);
}

/* The engine may choose a face of deeper penetration, never one of less. */
TEST(narrow_phase_finds_the_same_pairs) {
    uint32_t seed = 1;
    int touching = 0;
    for (int i = 0; i < 20000; i++) {
        const Box a = random_box(&seed), b = random_box(&seed);
        const double overlap = overlap_depth(&a, &b);
        Manifold manifold;
        manifold_compute(&manifold, &a, &b);
        if (fabs(overlap) < 1e-5) continue;
        if ((manifold.count > 0) != (overlap > 0)) fail_msg("pair %d: %d points, depth %g", i, manifold.count, overlap);
        double deepest = 0;
        for (int k = 0; k < manifold.count; k++) deepest = fmax(deepest, -(double)manifold.points[k].separation);
        if (manifold.count > 0 && deepest < overlap - 1e-5) fail_msg("pair %d: %g, depth %g", i, deepest, overlap);
        touching += manifold.count > 0;
    }
    assert_in_range(touching, 2000, 18000);
}

/* Just inside the ends of the span they overlap by more than the depth, just outside they do not. */
TEST(spans_end_where_the_overlap_does) {
    uint32_t seed = 2;
    int spans = 0;
    for (int i = 0; i < 5000; i++) {
        const Box a = random_box(&seed);
        Box b = random_box(&seed);
        const Vec2 from = b.position, way = vec2(cosf((float)i), sinf((float)i));
        const OverlapSpan span = overlap_span(&a, &b, way, depth, false), any = overlap_span(&a, &b, way, depth, true);
        if (!(span.from < span.to)) {
            assert_false(overlap_exceeds(&a, &b, depth));
            continue;
        }
        if (any.from > span.from || any.to < span.to) fail_msg("pair %d: turned, it has less room to overlap", i);
        if (span.to - span.from < 1e-3) continue;
        spans++;
        const double places[] = {span.from - 1e-4, span.from + 1e-4, span.to - 1e-4, span.to + 1e-4};
        for (int k = 0; k < 4; k++) {
            b.position = vec2_add(from, vec2_scale((float)places[k], way));
            if (overlap_exceeds(&a, &b, depth) != (k == 1 || k == 2)) fail_msg("pair %d: end %d of the span", i, k);
        }
    }
    assert_true(spans > 1000);
}

TEST(boxes_that_never_meet_have_no_span) {
    const Box ground = box_make(vec2(0, -10), vec2(100, 20), 0), above = unit_box(0, 5, 0.3f),
              beside = unit_box(60, -1, 0);
    OverlapSpan span = overlap_span(&ground, &above, vec2(1, 0), depth, true);
    assert_false(span.from < span.to);
    span = overlap_span(&ground, &beside, vec2(1, 0), depth, false);
    assert_near(span.from, -110.5 + depth, 1e-4);
    assert_near(span.to, -9.5 - depth, 1e-4);
}

/* Positions are float32: 1e6 m from the origin they are 6 cm apart, so boxes that touch may overlap by that. */
TEST(rounding_is_no_overlap) {
    const Box a = unit_box(1e6f, 0, 0), touching = unit_box(1e6f + 0.9375f, 0, 0),
              inside = unit_box(1e6f + 0.25f, 0, 0);
    assert_false(overlap_exceeds(&a, &touching, depth));
    assert_true(overlap_exceeds(&a, &inside, depth));
}

enum { BODIES = 60 };

/* A pair that overlaps is found if there is one, on either axis of the sweep. */
TEST(some_pair_is_found_if_there_is_one) {
    uint32_t seed = 3;
    int with = 0, without = 0;
    for (int round = 0; round < 400; round++) {
        Box boxes[BODIES];
        bool fixed[BODIES], expected = false;
        const float wide = round % 2 == 0 ? 40 : 4, high = round % 2 == 0 ? 4 : 40;
        for (int i = 0; i < BODIES; i++) {
            boxes[i] = box_make(vec2(uniform(&seed, -wide, wide), uniform(&seed, -high, high)), vec2(0.4f, 0.4f),
                                uniform(&seed, -4, 4));
            fixed[i] = uniform(&seed, 0, 1) < 0.5f;
        }
        for (int b = 0; b < BODIES; b++)
            for (int a = 0; a < b; a++)
                expected |= !(fixed[a] && fixed[b]) && overlap_depth(&boxes[a], &boxes[b]) > depth + 1e-4;
        BodyPair pair;
        assert_true(overlap_find(boxes, fixed, BODIES, depth, &pair));
        if (expected) {
            assert_true(pair.a >= 0 && pair.a < pair.b && pair.b < BODIES);
            assert_true(overlap_depth(&boxes[pair.a], &boxes[pair.b]) > depth);
            assert_false(fixed[pair.a] && fixed[pair.b]);
            with++;
        } else {
            without += pair.a < 0;
        }
    }
    assert_true(with > 20 && without > 20);
}

RUN_TESTS(NULL, NULL)

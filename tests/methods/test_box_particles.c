/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nine particles of a box, and the box that fits them best. */
#include "testing.h"

#include "methods/gns_graph.h"

/* m: the root of the mean square distance of the particles from those of the pose. */
static double distance_from(const Vec2 *particles, Vec2 size, const BodyPose *pose) {
    Vec2 placed[BOX_PARTICLES];
    double sum = 0;
    box_particles_place(placed, size, pose);
    for (int k = 0; k < BOX_PARTICLES; k++) sum += pow(vec2_distance(particles[k], placed[k]), 2);
    return sqrt(sum / BOX_PARTICLES);
}

TEST(angles_are_those_of_the_maths_library) {
    for (int i = -1000; i <= 1000; i++) {
        const double angle = 3.14159 * i / 1000, length = 0.01 + (double)(i * i);
        assert_near(plane_angle(length * cos(angle), length * sin(angle)), angle, 1e-13);
    }
    assert_near(plane_angle(-1, 0), 3.141592653589793, 1e-15);
    assert_near(plane_angle(0, 0), 0, 0);
}

TEST(a_moved_box_is_found_again) {
    const Vec2 size = {1, 0.4f};
    for (int i = -50; i <= 50; i++) {
        Vec2 particles[BOX_PARTICLES];
        const BodyPose near = {{3, 4}, 6.5f}, moved = {{3.2f, 3.9f}, 6.5f + 0.06f * (float)i};
        box_particles_place(particles, size, &moved);
        const BodyPose found = box_particles_fit(particles, size, &near);
        assert_near(found.position.x, moved.position.x, 1e-6);
        assert_near(found.position.y, moved.position.y, 1e-6);
        assert_near(found.angle, moved.angle, 1e-5);
        assert_near(distance_from(particles, size, &found), 0, 1e-6);
    }
}

/* A box that is stretched along an edge keeps its pose; its particles are off by the stretch of two of three
   columns. */
TEST(a_stretched_box_keeps_its_pose) {
    const Vec2 size = {1, 1};
    const BodyPose pose = {{0, 0}, 0};
    Vec2 particles[BOX_PARTICLES];
    for (int k = 0; k < BOX_PARTICLES; k++)
        particles[k] = vec2(1.2f * box_particle(k, size).x, box_particle(k, size).y);
    const BodyPose found = box_particles_fit(particles, size, &pose);
    assert_near(found.position.x, 0, 1e-7);
    assert_near(found.angle, 0, 1e-7);
    assert_near(distance_from(particles, size, &found), 0.1 * sqrt(2.0 / 3), 1e-6);
}

RUN_TESTS(NULL, NULL)

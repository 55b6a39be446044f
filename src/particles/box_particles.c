/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles/box_particles.h"

Vec2 box_particle(int k, Vec2 size) {
    const int column = k % 3 - 1, row = k / 3 - 1;
    return vec2(0.5f * (float)column * size.x, 0.5f * (float)row * size.y);
}

void box_particles_place(Vec2 *particles, Vec2 size, const BodyPose *pose) {
    const Mat22 rotation = mat22_rotation(pose->angle);
    for (int k = 0; k < BOX_PARTICLES; k++)
        particles[k] = vec2_add(pose->position, mat22_multiply(rotation, box_particle(k, size)));
}

/* tan(a/2) = sin a / (1 + cos a), twice more tan(a/2) = t / (1 + sqrt(1 + t^2)); then at most tan(pi / 16) = 0.2, where the
   series of the arc tangent needs few terms. Beyond a quarter turn: pi less the angle of the mirror image. */
double plane_angle(double cosine, double sine) {
    enum { TERMS = 12, HALVINGS = 2 };
    const double pi = 0x1.921fb54442d18p1, length = sqrt(cosine * cosine + sine * sine);
    if (!(length > 0)) return 0;
    double t = sine / (length + fabs(cosine)), sum = 0;
    for (int i = 0; i < HALVINGS; i++) t = t / (1 + sqrt(1 + t * t));
    for (int n = TERMS; n >= 0; n--) sum = 1.0 / (2 * n + 1) - t * t * sum;
    const double angle = (2 << HALVINGS) * t * sum;
    return cosine < 0 ? (sine < 0 ? -pi : pi) - angle : angle;
}

BodyPose box_particles_fit(const Vec2 *particles, Vec2 size, const BodyPose *near) {
    const Mat22 rotation = mat22_rotation(near->angle);
    double x = 0, y = 0, cosine = 0, sine = 0;
    for (int k = 0; k < BOX_PARTICLES; k++) {
        x += (double)particles[k].x;
        y += (double)particles[k].y;
    }
    x /= BOX_PARTICLES;
    y /= BOX_PARTICLES;
    for (int k = 0; k < BOX_PARTICLES; k++) {
        const Vec2 arm = mat22_multiply(rotation, box_particle(k, size));
        const double ax = (double)arm.x, ay = (double)arm.y;
        const double px = (double)particles[k].x - x, py = (double)particles[k].y - y;
        cosine += ax * px + ay * py;
        sine += ax * py - ay * px;
    }
    return (BodyPose){vec2((float)x, (float)y), (float)((double)near->angle + plane_angle(cosine, sine))};
}

float box_particles_distance(const Vec2 *particles, Vec2 size, const BodyPose *pose) {
    Vec2 placed[BOX_PARTICLES];
    float sum = 0;
    box_particles_place(placed, size, pose);
    for (int k = 0; k < BOX_PARTICLES; k++) {
        const Vec2 away = vec2_sub(particles[k], placed[k]);
        sum += vec2_dot(away, away);
    }
    return sqrtf(sum / BOX_PARTICLES);
}

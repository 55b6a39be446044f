/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What contacts do, by closed forms: a box on a slope below and above the friction, on level ground, in the air; the
   same for every method. And how many contacts of two runs do the same, counted in another way. */
#include "made.h"

static const char *const methods[] = {"engine", "momentum", "interior", "reference", "soft-step"};
enum { METHODS_TRIED = sizeof methods / sizeof *methods, STEPS = 30 };

/* A box of 1 m on a slope with this tangent, or `height` above level ground; friction 0.2. */
static Trajectory *run_of(const char *method, float slope, float height) {
    BodyDef bodies[] = {
        {.fixed = true, .size = {1000, 20}, .position = {400, -10}, .friction = 0.2F},
        {.mass = 1, .size = {1, 1}, .position = {0, 0.5F + height}, .friction = 0.2F},
    };
    Scene scene = scene_of_bodies(bodies, 2, STEPS);
    scene.gravity.x = 10 * slope;
    return run_by(&scene, method);
}

/* Of the contacts that push in steps from `first` on; there is one at least in each step. */
static void assert_mode(const Trajectory *run, int first, ContactMode mode, const char *what) {
    for (int step = first; step <= STEPS; step++) {
        int pushing = 0;
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++) {
            const ContactMode found = trajectory_mode(run, step, i);
            assert_true((found == CONTACT_OPEN) == !(run->contacts[i].normal_impulse > 0));
            if (found == CONTACT_OPEN) continue;
            pushing++;
            if (found != mode) fail_msg("%s, %s, step %d: mode %d", what, run->method, step, (int)found);
        }
        if (pushing == 0) fail_msg("%s, %s, step %d: nothing pushes", what, run->method, step);
    }
}

/* On the slope it slides if the slope exceeds the friction, after k steps at k dt g (slope - friction). Just below the
   friction the engine slides at first, as its ten sweeps do not converge. */
TEST(a_box_sticks_below_the_friction_and_slips_above_it) {
    for (int i = 0; i < METHODS_TRIED; i++) {
        const float slopes[] = {0, 0.05F, 0.1F, 0.25F, 0.4F};
        for (int k = 0; k < 5; k++) {
            OWN(Trajectory) *run = run_of(methods[i], slopes[k], 0);
            const double faster = 10.0 / 60 * ((double)slopes[k] - 0.2); /* m/s per step */
            const int first = faster > 0 ? 3 + (int)(CONTACT_SLIDING / faster) : 10;
            assert_mode(run, first, faster > 0 ? CONTACT_SLIPS : CONTACT_STICKS, slopes[k] > 0 ? "slope" : "level");
        }
    }
}

TEST(a_box_in_the_air_has_no_contact) {
    OWN(Trajectory) *run = run_of("engine", 0, 10);
    assert_int_equal(run->contact_start[STEPS + 1], 0);
}

/* The point of the other body counts: a box that rolls with what carries it does not slide, and one beside it does. */
TEST(the_velocity_at_the_contact_decides) {
    OWN(Trajectory) *run = run_sized(2, 2);
    TrajectoryContact contact = {.a = 0, .b = 1, .point = {0, 0}, .normal = {0, 1}, .normal_impulse = 1};
    add_contact(run, 1, contact);
    trajectory_end_contacts(run);
    for (int frame = 0; frame < 2; frame++)
        for (int body = 0; body < 2; body++) {
            run->position[2 * frame + body] = vec2(0, body == 1 ? 0.5F : -10);
            run->velocity[2 * frame + body] = vec2(frame == 1 && body == 1 ? 1 : 0, 0);
            run->angular_velocity[2 * frame + body] = 0;
        }
    assert_int_equal(trajectory_mode(run, 1, 0), CONTACT_SLIPS);
    run->angular_velocity[3] = -2; /* half a metre above the point, which now rests */
    assert_int_equal(trajectory_mode(run, 1, 0), CONTACT_STICKS);
    run->velocity[3] = vec2(1, 5); /* leaving is not sliding */
    assert_int_equal(trajectory_mode(run, 1, 0), CONTACT_STICKS);
    run->contacts[0].normal_impulse = 0;
    assert_int_equal(trajectory_mode(run, 1, 0), CONTACT_OPEN);
}

/* The modes of a run's step by keys in a table, which bodies and feature index. */
typedef struct Listed {
    int32_t a, b;
    uint32_t feature;
    int mode, other;
} Listed;

static int list_modes(const Trajectory *run, int step, Listed *all, int count, bool other) {
    for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++) {
        const TrajectoryContact *c = &run->contacts[i];
        const size_t a = trajectory_at(run, step, c->a), b = trajectory_at(run, step, c->b),
                     bodies = (size_t)run->bodies;
        const double ax = (double)c->point.x - (double)run->position[a - bodies].x,
                     ay = (double)c->point.y - (double)run->position[a - bodies].y,
                     bx = (double)c->point.x - (double)run->position[b - bodies].x,
                     by = (double)c->point.y - (double)run->position[b - bodies].y,
                     wa = (double)run->angular_velocity[a], wb = (double)run->angular_velocity[b];
        const double x = (double)run->velocity[b].x - wb * by - (double)run->velocity[a].x + wa * ay,
                     y = (double)run->velocity[b].y + wb * bx - (double)run->velocity[a].y - wa * ax;
        const bool slides = fabs(x * (double)c->normal.y - y * (double)c->normal.x) > 0.01;
        const int mode = c->normal_impulse > 0 ? slides ? 2 : 1 : 0;
        int k = 0;
        while (k < count && (all[k].a != c->a || all[k].b != c->b || all[k].feature != c->feature)) k++;
        if (k == count) all[count++] = (Listed){c->a, c->b, c->feature, 0, 0};
        *(other ? &all[k].other : &all[k].mode) = mode;
    }
    return count;
}

TEST(contacts_with_the_same_mode_are_counted) {
    enum { MOST = 400 };
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 120;
    OWN(Trajectory) *engine = run_by(scene, "engine:k=4"), *reference = run_by(scene, "reference");
    const Trajectory *const runs[] = {engine, reference};
    int differing = 0, only_one = 0;
    for (int step = 1; step < engine->frames; step++) {
        Listed all[MOST] = {{0}};
        const int count = list_modes(reference, step, all, list_modes(engine, step, all, 0, false), true);
        int same = 0;
        for (int k = 0; k < count; k++) same += all[k].mode == all[k].other;
        const ModeCount found = trajectory_same_modes(engine, step, reference, step),
                        back = trajectory_same_modes(reference, step, engine, step);
        assert_int_equal(found.of, count);
        assert_int_equal(found.same, same);
        assert_true(back.same == same && back.of == count);
        differing += same < count;
        only_one += count > engine->contact_start[step + 1] - engine->contact_start[step];
    }
    assert_true(differing > 10 && only_one > 10);
    assert_int_equal(trajectory_reference(runs, 2), 1);
    assert_int_equal(trajectory_reference(runs, 1), -1);
    assert_int_equal(trajectory_reference(runs + 1, 1), -1); /* nothing to compare */
    reference->size[1].x = 2;                                /* another world */
    assert_int_equal(trajectory_reference(runs, 2), -1);
}

RUN_TESTS(NULL, NULL)

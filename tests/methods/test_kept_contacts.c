/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kept contacts, whose lever arms and normal are frozen, and what soft contacts do without them. */
#include "made.h"
#include "sanitized.h"
#include "worlds.h"

static const BodyDef ground = {.fixed = true, .size = {100, 20}, .position = {0, -10}, .friction = 0.2f};

/* Steps a world by a method; returns the largest angle of the bodies on the way. */
static float turn_within(World *world, const Scene *scene, const char *text, int first, int last) {
    Error error = {0};
    float most = 0;
    OWN(Stepper) *stepper = stepper_by(scene, text);
    for (int frame = first; frame <= last; frame++) {
        assert_ok(simulate_step(stepper, world, &(Step){.scene = scene, .frame = frame}, &error), error);
        for (int i = 0; i < world_body_count(world); i++) most = fmaxf(most, fabsf(world_bodies(world)[i].angle));
    }
    return most;
}

static Scene *scene_with(const char *name, const char *parameter, double value) {
    Error error = {0};
    SceneSetting setting = {.value = value};
    const char *path = printed(SOURCE_DIR "/scenes/stability/%s.yaml", name);
    snprintf(setting.name, sizeof setting.name, "%s", parameter);
    Scene *scene = scene_read_with(path, &setting, 1, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

/* True if no box of the stack turns by 0.1 rad in two minutes. */
static bool stays_upright(const char *text, int height, float gravity) {
    OWN(Scene) *scene = scene_with("stack_height", "height", height);
    scene->gravity = vec2(0, -gravity);
    scene->bodies[1].position.x = 1e-3f;
    OWN(World) *world = world_of(scene);
    const bool stands = turn_within(world, scene, text, 1, 7200) < 0.1f;
    return stands;
}

/* A column of n boxes (mass m, side h) whose contacts have the stiffness c against turning buckles under its own weight
   if m g h n^3 > 7.837 c (Greenhill 1881). Two contacts at h / 2 beside the centre have c = 2 k (h / 2)^2; each is a
   spring of the frequency `hertz` on its effective mass, k = m_n (2 pi hertz)^2, with 1 / m_n = 2 / m + 2 (h / 2)^2 /
   (m h^2 / 6). */
static double euler_height(double hertz, double gravity) {
    const double pi = 3.14159265358979, m = 1, h = 1, radius = h / 2;
    const double effective = 1 / (2 / m + 2 * radius * radius / (m * h * h / 6));
    const double k = effective * pow(2 * pi * hertz, 2), c = 2 * k * radius * radius;
    return cbrt(7.837 * c / (m * gravity * h));
}

TEST(a_stack_of_soft_contacts_buckles_as_eulers_column) {
    static const struct {
        const char *text;
        double hertz, gravity;
    } cases[] = {{"soft-step:hertz=15", 15, 5},
                 {"soft-step:hertz=15", 15, 10},
                 {"soft-step:hertz=15", 15, 20},
                 {"soft-step", 30, 5},
                 {"soft-step", 30, 10},
                 {"soft-step", 30, 20},
                 {"soft-step", 30, 40},
                 {"soft-step:substeps=16", 30, 10},
                 {"soft-step:hertz=60,substeps=8", 60, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i += (size_t)sampled(3)) {
        const double expected = euler_height(cases[i].hertz, cases[i].gravity);
        int height = (int)expected - 2;
        while (height < (int)expected + 3 && stays_upright(cases[i].text, height + 1, (float)cases[i].gravity))
            height++;
        printf("%s, g = %g: %d boxes, Euler's column %.1f\n", cases[i].text, cases[i].gravity, height, expected);
        if (fabs(height - floor(expected)) > 1)
            fail_msg("%s, g = %g: %d boxes, Euler's column %.1f", cases[i].text, cases[i].gravity, height, expected);
    }
}

/* Twice Euler's height: as a rigid column, a leaning one of frozen contacts has no moment that tips it. */
TEST(a_stack_of_kept_contacts_does_not_buckle) {
    assert_true(stays_upright("soft-step:keep=0.05", 28, 10));
    assert_true(stays_upright("soft-step:hertz=15,keep=0.05", 18, 10));
    assert_false(stays_upright("soft-step:hertz=15,keep=0", 18, 10));
}

/* A box of 1 m on the ground, at x, y and an angle in its second step. */
typedef struct Second {
    ContactPoint first, then; /* the left contact in both steps */
    int count;                /* contacts of the second step */
} Second;

static Second step_to(float keep, Vec2 position, float angle, bool removed) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -10}, .warm_starting = true, .position_correction = true};
    const BodyDef box = {.size = {1, 1}, .mass = 1, .position = {0, 0.495f}, .friction = 0.2f};
    const BodyPose poses[] = {{ground.position, 0}, {position, angle}};
    ContactProblem problem;
    ContactSolution *solution;
    Second second;
    OWN(World) *world = world_create(&def, &error);
    assert_ok(world != NULL, error);
    world_set_contacts(world, (ContactRules){.keep = keep});
    assert_ok(world_add_body(world, &ground, &error) && world_add_body(world, &box, &error), error);
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
    assert_int_equal(problem.contact_count, 2);
    second.first = problem.contacts[0];
    contact_solution_begin(&problem, solution);
    solution->impulses[0].normal = 7;
    assert_ok(world_end_step_at(world, poses, &error), error);
    if (removed) {
        BodyDef other = box;
        other.position = position;
        world_remove_last_body(world);
        assert_ok(world_add_body(world, &other, &error), error);
    }
    assert_ok(world_begin_step(world, 0.01f, &problem, &solution, &error), error);
    second.count = problem.contact_count;
    if (second.count > 0) second.then = problem.contacts[0];
    return second;
}

static bool is_frozen(const Second *second) {
    return second->count == 2 && memcmp(&second->first.arm_a, &second->then.arm_a, 2 * sizeof(Vec2)) == 0 &&
           memcmp(&second->first.normal, &second->then.normal, sizeof(Vec2)) == 0;
}

TEST(arms_stay_while_boxes_shift_by_less) {
    const Second shifted = step_to(0.05f, vec2(0.03f, 0.49f), 0, false),
                 far = step_to(0.05f, vec2(0.06f, 0.49f), 0, false);
    const Second off = step_to(0, vec2(0.03f, 0.49f), 0, false), less = step_to(0.02f, vec2(0.03f, 0.49f), 0, false);
    assert_true(is_frozen(&shifted));
    assert_near(shifted.then.separation, -0.01, 1e-6);
    assert_near(shifted.then.warm_normal, 7, 0);
    assert_false(is_frozen(&far) || is_frozen(&off) || is_frozen(&less));
    assert_near(far.then.warm_normal, 7, 0);
}

/* How far it sinks does not count. */
TEST(arms_stay_while_boxes_sink) {
    const Second deep = step_to(0.05f, vec2(0, 0.4f), 0, false);
    assert_true(is_frozen(&deep));
    assert_near(deep.then.separation, -0.1, 1e-6);
}

/* The tolerance is a share of the smaller side: the same of boxes of 0.1, 1 and 10 m. Sinking uses none of it, so that
   a stack of 20 whose contacts give way stands with 0.01. */
TEST(stacks_of_all_sizes_stand) {
    const struct {
        const char *text;
        float side;
        int height;
    } cases[] = {{"soft-step:keep=0.01", 1, 20}, {"soft-step:keep=0.05", 0.1f, 12}, {"soft-step:keep=0.05", 10, 20}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float side = cases[i].side;
        BodyDef bodies[21] = {
            {.fixed = true, .size = {200 * side, 20 * side}, .position = {0, -10 * side}, .friction = 0.5f}};
        for (int k = 1; k <= cases[i].height; k++)
            bodies[k] =
                (BodyDef){.size = {side, side}, .mass = 1, .position = {0, side * ((float)k - 0.5f)}, .friction = 0.5f};
        const Scene scene = scene_of_bodies(bodies, cases[i].height + 1, 1200);
        OWN(World) *world = world_of(&scene);
        const float turn = turn_within(world, &scene, cases[i].text, 1, 1200);
        if (!(turn < 0.1f))
            fail_msg("%s, %d boxes of %g m: %g rad", cases[i].text, cases[i].height, (double)side, (double)turn);
    }
}

/* The left corner of a box that turns clockwise by t about its centre rises by t / 2. 0.7 m is the distance of a corner
   from the centre, 0.7 t its shift. */
TEST(a_separation_follows_the_turn_of_a_box) {
    const Second turned = step_to(0.05f, vec2(0, 0.495f), -0.04f, false),
                 far = step_to(0.05f, vec2(0, 0.495f), -0.08f, false);
    assert_true(is_frozen(&turned));
    assert_near(turned.then.separation, -0.005 + 0.5 * sin(0.04) + 0.5 * (1 - cos(0.04)), 1e-5);
    assert_false(is_frozen(&far));
}

/* A gap may close within the step, and no more: v >= -gap / dt. */
TEST(an_open_contact_is_kept_and_lets_the_gap_close) {
    const Second open = step_to(0.05f, vec2(0, 0.52f), 0, false);
    assert_true(is_frozen(&open));
    assert_near(open.then.separation, 0.02, 1e-6);
    assert_near(open.then.bias, -0.02 / 0.01, 1e-3);
    assert_int_equal(step_to(0.05f, vec2(0, 0.56f), 0, false).count, 0);
    assert_int_equal(step_to(0, vec2(0, 0.52f), 0, false).count, 0);
}

/* A box that was found on the ground is 0.005 m above it, and falls at 1 m/s. */
TEST(solvers_let_a_gap_close_within_the_step) {
    const ContactSolverKind *const kinds[] = {&solver_engine, &solver_momentum, &solver_nncg, &solver_interior,
                                              &solver_reference};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        ContactProblem problem;
        ContactSolution *solution;
        OWN(World) *world = make_world();
        world_set_contacts(world, (ContactRules){.keep = 0.05f});
        add_ground(world, 0.2f);
        add_box(world, 1, 0.2f, vec2(0, 0.495f));
        assert_ok(world_begin_step(world, world_dt, &problem, &solution, &error), error);
        contact_solution_begin(&problem, solution);
        solution->velocities[1].linear = vec2(0, -1);
        assert_ok(world_end_step_at(world, (const BodyPose[]){{{0, -10}, 0}, {{0, 0.505f}, 0}}, &error), error);
        OWN(ContactSolver) solver = make_solver(kinds[i], "");
        assert_ok(world_step(world, solver.kind->solve, solver.state, world_dt, &error), error);
        if (fabsf(world_bodies(world)[1].velocity.y + 0.005f * 60) > 3e-3f)
            fail_msg("%s: %g m/s", kinds[i]->description.name, (double)world_bodies(world)[1].velocity.y);
    }
}

TEST(the_contact_of_a_removed_body_is_not_kept) {
    const Second removed = step_to(0.05f, vec2(0.03f, 0.49f), 0, true);
    assert_false(is_frozen(&removed));
    assert_near(removed.then.warm_normal, 0, 0);
}

static const char *const keeping[] = {"engine:keep=0.05",   "momentum:keep=0.05",  "nncg:keep=0.05",
                                      "interior:keep=0.05", "reference:keep=0.05", "soft-step:keep=0.05",
                                      "soft-step:keep=0.01"};

enum { KEEPING = sizeof keeping / sizeof keeping[0] };

/* keep=0 is the method without the setting, bit for bit; what keeps has other bits, the same in each run. */
TEST(only_what_is_kept_changes_bits) {
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 120;
    for (int i = 0; i < KEEPING; i++) {
        char plain[32], none[40];
        snprintf(plain, sizeof plain, "%.*s", (int)strcspn(keeping[i], ":"), keeping[i]);
        snprintf(none, sizeof none, "%s:keep=0", plain);
        Trajectory *runs[] = {run_by(scene, plain), run_by(scene, none), run_by(scene, keeping[i]),
                              run_by(scene, keeping[i])};
        TrajectoryDifference difference;
        assert_same_run(runs[0], runs[1]);
        assert_same_run(runs[2], runs[3]);
        trajectory_compare(runs[0], runs[2], &difference);
        assert_false(difference.equal);
        for (int k = 0; k < 4; k++) trajectory_destroy(runs[k]);
    }
}

/* A copy goes on as its original, from contacts that were kept for some steps. */
TEST(a_copied_world_keeps_the_same_contacts) {
    OWN(Scene) *scene = scene_with("tilted_stack", "shift", 0.05);
    OWN(World) *world = world_of(scene), *copy = world_of(scene);
    turn_within(world, scene, "engine:keep=0.05", 1, 50);
    assert_ok(world_copy(copy, world, &error), error);
    turn_within(world, scene, "engine:keep=0.05", 51, 150);
    turn_within(copy, scene, "engine:keep=0.05", 51, 150);
    assert_memory_equal(world_bodies(world), world_bodies(copy), (size_t)world_body_count(world) * sizeof(Body));
}

/* A box that slides is found anew from time to time, up to `keep` late: its contacts must not throw it up then. It
   stops with its centre 0.02 m before the edge of a ledge, where rigid boxes stay level. */
TEST(finding_contacts_anew_does_not_tilt_a_sliding_box) {
    for (int i = 0; i < KEEPING; i++) {
        OWN(Scene) *scene = scene_with("ledge", "past", -0.02);
        OWN(World) *world = world_of(scene);
        const float turn = turn_within(world, scene, keeping[i], 1, 300);
        printf("%s: %.2g rad\n", keeping[i], (double)turn);
        assert_true(turn < 1e-3f);
    }
}

/* A tall box that rocks has a single contact most of the time. Were it kept, its corner would swing in from up to
   `keep` away, and rocking would gain energy. */
TEST(rocking_gains_no_energy) {
    for (int i = 0; i < KEEPING; i++) {
        for (int speed = 4; speed <= 16; speed += 2 * sampled(3)) {
            OWN(Scene) *scene = scene_with("kick", "kick", 0.1 * speed);
            OWN(World) *world = world_of(scene);
            const double before = world_energy(world, scene->gravity);
            turn_within(world, scene, keeping[i], 1, 300);
            const double after = world_energy(world, scene->gravity);
            if (!(after < before)) fail_msg("%s, kick %g m/s: %g J gained", keeping[i], 0.1 * speed, after - before);
        }
    }
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems in files: they come back bit by bit, and what is inconsistent is refused. */
#include "testing.h"

#include "runs/problem_file.h"

enum { BODIES = 3, CONTACTS = 3 };

/* A static ground, a box on it, and the bomb in the corner of both. */
typedef struct Example {
    ContactProblem problem;
    ProblemBody bodies[BODIES];
    ContactPoint contacts[CONTACTS];
} Example;

static const ProblemBody box = {.position = {1.5f, 2},
                                .angle = 0.25f,
                                .size = {1, 2},
                                .inv_mass = 0.5f,
                                .inv_inertia = 0.75f,
                                .velocity = {3, -4},
                                .angular_velocity = 5};
static const ContactPoint touch = {.a = 0,
                                   .b = 1,
                                   .position = {0.1f, 0.2f},
                                   .normal = {0.6f, -0.8f},
                                   .arm_a = {1, 2},
                                   .arm_b = {3, 4},
                                   .separation = -0.01f,
                                   .mass_normal = 0.3f,
                                   .mass_tangent = 0.4f,
                                   .friction = 0.2f,
                                   .bias = 0.05f,
                                   .feature = 0xfedcba98u,
                                   .warm_normal = 7,
                                   .warm_tangent = -0.5f};

static void make_example(Example *example) {
    *example = (Example){
        .problem = {.body_count = BODIES, .contact_count = CONTACTS, .bomb = 2, .dt = 1.0f / 60.0f, .fall = 0.2f},
        .bodies = {{.size = {100, 20}}, box, box},
        .contacts = {touch, touch, touch}};
    example->problem.bodies = example->bodies;
    example->problem.contacts = example->contacts;
    example->bodies[2].position.x = -9;
    example->contacts[1].feature = 1;
    example->contacts[2].b = 2;
}

TEST(written_is_read) {
    const char *path = temporary_path("problem.npz");
    Example example;
    make_example(&example);
    assert_ok(problem_write(&example.problem, "stack", 41, path, &error), error);
    StoredProblem *stored = problem_read(path, &error);
    assert_ok(stored != NULL, error);
    assert_string_equal(stored->scene, "stack");
    assert_int_equal(stored->frame, 41);
    assert_int_equal(stored->problem.bomb, 2);
    assert_true(stored->problem.dt == example.problem.dt);
    assert_true(stored->problem.fall == example.problem.fall);
    assert_int_equal(stored->problem.body_count, BODIES);
    assert_int_equal(stored->problem.contact_count, CONTACTS);
    assert_memory_equal(stored->problem.bodies, example.bodies, sizeof example.bodies);
    assert_memory_equal(stored->problem.contacts, example.contacts, sizeof example.contacts);
    problem_destroy(stored);
}

TEST(a_problem_without_contacts_is_one) {
    const char *path = temporary_path("alone.npz");
    Example example;
    make_example(&example);
    example.problem.contact_count = 0;
    example.problem.contacts = NULL;
    example.problem.bomb = -1;
    assert_ok(problem_write(&example.problem, "", 1, path, &error), error);
    StoredProblem *stored = problem_read(path, &error);
    assert_ok(stored != NULL, error);
    assert_int_equal(stored->problem.contact_count, 0);
    assert_int_equal(stored->problem.bomb, -1);
    problem_destroy(stored);
}

static void expect_refused(const Example *example, int frame, const char *scene, const char *reason) {
    const char *path = temporary_path("refused.npz");
    Error error = {0};
    assert_ok(problem_write(&example->problem, scene, frame, path, &error), error);
    StoredProblem *stored = problem_read(path, &error);
    if (stored != NULL) fail_msg("taken, though '%s'", reason);
    assert_error(error, ERROR_INPUT, "refused.npz: error: ");
    assert_error(error, ERROR_INPUT, reason);
}

/* Writes a value into the example, expects a refusal. */
#define REFUSE(place, value, reason)                  \
    do {                                              \
        Example example;                              \
        make_example(&example);                       \
        example.place = (value);                      \
        expect_refused(&example, 1, "stack", reason); \
    } while (0)

TEST(bad_contacts_are_refused) {
    REFUSE(contacts[0].a, -1, "contact 0: bodies -1 and 1 are not a valid pair");
    REFUSE(contacts[0].a, 1, "contact 0: bodies 1 and 1 are not a valid pair");
    REFUSE(contacts[2].b, 3, "contact 2: bodies 0 and 3 are not a valid pair");
    REFUSE(contacts[0].b, 2, "contact 1: pairs are not sorted");
    REFUSE(contacts[1].a, INT32_MIN, "contact 1: bodies -2147483648 and 1 are not a valid pair");
    REFUSE(contacts[1].normal.x, 0.7f, "contact 1: its normal is not of unit length");
    REFUSE(contacts[1].normal.x, NAN, "contact_normal[1] is not finite");
    REFUSE(contacts[1].mass_normal, 0, "contact 1: its effective masses");
    REFUSE(contacts[1].mass_tangent, -1, "contact 1: its effective masses");
    REFUSE(contacts[1].friction, -0.1f, "contact 1: friction");
    REFUSE(contacts[1].bias, INFINITY, "contact_bias[1] is not finite");
    REFUSE(contacts[1].separation, NAN, "contact_separation[1] is not finite");
    REFUSE(contacts[1].arm_a.x, NAN, "contact_arm_a[1] is not finite");
    REFUSE(contacts[1].arm_b.y, NAN, "contact_arm_b[1] is not finite");
    REFUSE(contacts[1].position.y, NAN, "contact_position[1] is not finite");
    REFUSE(contacts[1].warm_tangent, NAN, "contact_warm[1] is not finite");
}

TEST(contacts_of_static_bodies_are_refused) {
    Example example;
    make_example(&example);
    example.bodies[1] = example.bodies[0];
    expect_refused(&example, 1, "stack", "contact 0: bodies 0 and 1 are both static");
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a relation network sees does not depend on the numbers of the bodies, or on the tilt of the scene. */
#include "sain_networks.h"
#include "owned.h"

OWNED_VALUE(SainView, sain_view_free)

enum { BODIES = 12, PAIRS = 16 };

typedef struct Problem {
    ProblemBody bodies[BODIES];
    ContactPoint contacts[2 * PAIRS];
    BodyVelocity engine[BODIES];
    ContactProblem problem;
} Problem;

static Vec2 any(uint32_t *seed, float size) {
    const float x = uniform(seed, -size, size), y = uniform(seed, -size, size);
    return vec2(x, y);
}

/* Body 0 is the ground; each other body touches the one before, and some the ground. */
static void fill(Problem *p, uint32_t seed) {
    *p = (Problem){.problem = {.body_count = BODIES, .bomb = -1, .bodies = p->bodies, .contacts = p->contacts}};
    for (int i = 0; i < BODIES; i++) {
        const float inverse = i == 0 ? 0 : uniform(&seed, 0.1f, 1);
        p->bodies[i] = (ProblemBody){.position = any(&seed, 1),
                                     .angle = uniform(&seed, -0.3f, 0.3f),
                                     .size = {i == 0 ? 100 : 1, i == 0 ? 20 : 1},
                                     .inv_mass = inverse,
                                     .inv_inertia = 6 * inverse,
                                     .velocity = i == 0 ? vec2(0, 0) : any(&seed, 5),
                                     .angular_velocity = i == 0 ? 0 : uniform(&seed, -3, 3)};
        p->engine[i] = i == 0 ? (BodyVelocity){{0, 0}, 0} : (BodyVelocity){any(&seed, 5), uniform(&seed, -3, 3)};
    }
    for (int a = 0; a < BODIES; a++)
        for (int b = a + 1; b < BODIES; b++)
            for (int k = 0; k < 2 && (b == a + 1 || (a == 0 && b % 3 == 0)); k++)
                p->contacts[p->problem.contact_count++] = (ContactPoint){.a = a,
                                                                         .b = b,
                                                                         .normal = {0.6f, 0.8f},
                                                                         .arm_a = any(&seed, 0.5f),
                                                                         .arm_b = any(&seed, 0.5f),
                                                                         .friction = 0.2f,
                                                                         .bias = uniform(&seed, 0, 0.1f),
                                                                         .warm_normal = uniform(&seed, 0, 1)};
}

static Vec2 turned(Vec2 v, float angle) { return mat22_multiply(mat22_rotation(angle), v); }

static void turn(Problem *p, float angle) {
    for (int i = 0; i < BODIES; i++) {
        ProblemBody *body = &p->bodies[i];
        body->angle += angle;
        body->velocity = turned(body->velocity, angle);
        p->engine[i].linear = turned(p->engine[i].linear, angle);
    }
    for (int i = 0; i < p->problem.contact_count; i++) {
        ContactPoint *contact = &p->contacts[i];
        contact->normal = turned(contact->normal, angle);
        contact->arm_a = turned(contact->arm_a, angle);
        contact->arm_b = turned(contact->arm_b, angle);
    }
}

/* Body i becomes body BODIES - 1 - i: the roles of a and b are exchanged, and the order of contacts reversed. */
static void renumber(Problem *to, const Problem *from) {
    *to = *from;
    to->problem.bodies = to->bodies;
    to->problem.contacts = to->contacts;
    for (int i = 0; i < BODIES; i++) {
        to->bodies[BODIES - 1 - i] = from->bodies[i];
        to->engine[BODIES - 1 - i] = from->engine[i];
    }
    const int count = from->problem.contact_count;
    for (int i = 0; i < count; i++) {
        const ContactPoint *contact = &from->contacts[i];
        ContactPoint *other = &to->contacts[count - 1 - i];
        *other = *contact;
        other->a = BODIES - 1 - contact->b;
        other->b = BODIES - 1 - contact->a;
        other->normal = vec2_negate(contact->normal);
        other->arm_a = contact->arm_b;
        other->arm_b = contact->arm_a;
    }
}

/* Velocities of all bodies, the answers added. */
static void answer(const Problem *p, const SainNetwork *network, BodyVelocity *velocities) {
    OWN(SainView) view = {0};
    SainAnswers answers = {0};
    for (int i = 0; i < BODIES; i++) velocities[i] = p->engine[i];
    assert_true(sain_view_make(&view, &p->problem, p->engine));
    assert_int_equal(view.body_count, BODIES - 1);
    assert_true(sain_answer(&answers, network, &view));
    for (int b = 0; b < view.body_count; b++) {
        assert_true(answers.known[b]);
        velocities[view.bodies[b].body] = sain_corrected(&view.bodies[b], answers.outputs + b * SAIN_OUTPUTS);
    }
    sain_answers_free(&answers);
}

TEST(numbers_of_bodies_do_not_matter) {
    static Problem problem, other;
    uint32_t seed = 3;
    OWN(SainNetwork) network;
    make_sain_network(&network, &seed, 0.4f);
    BodyVelocity first[BODIES], second[BODIES];
    fill(&problem, 7);
    renumber(&other, &problem);
    answer(&problem, &network, first);
    answer(&other, &network, second);
    for (int i = 0; i < BODIES; i++) {
        assert_near(first[i].linear.x, second[BODIES - 1 - i].linear.x, 1e-4);
        assert_near(first[i].linear.y, second[BODIES - 1 - i].linear.y, 1e-4);
        assert_near(first[i].angular, second[BODIES - 1 - i].angular, 3e-4);
    }
}

/* Quarter turns of the world leave each box's frame where it was, so a box must be seen from a frame that turns with
   it. */
TEST(answers_turn_with_the_scene) {
    static Problem problem;
    uint32_t seed = 4;
    const float angle = 0.4f;
    OWN(SainNetwork) network;
    make_sain_network(&network, &seed, 0.4f);
    network.body_low[0] = -FLT_MAX;
    for (int h = 0; h < SAIN_HIDDEN; h++) /* the tilt itself is an input */
        network.object->weights[0][h * SAIN_OBJECT_INPUTS] = 0;
    BodyVelocity before[BODIES], after[BODIES];
    fill(&problem, 9);
    answer(&problem, &network, before);
    turn(&problem, angle);
    answer(&problem, &network, after);
    for (int i = 1; i < BODIES; i++) {
        const Vec2 expected = turned(before[i].linear, angle);
        assert_near(after[i].linear.x, expected.x, 2e-4);
        assert_near(after[i].linear.y, expected.y, 2e-4);
        assert_near(after[i].angular, before[i].angular, 5e-4);
    }
}

TEST(answers_reach_their_target) {
    static Problem problem;
    OWN(SainView) view = {0};
    fill(&problem, 1);
    assert_true(sain_view_make(&view, &problem.problem, problem.engine));
    for (int b = 0; b < view.body_count; b++) {
        const SainBody *body = &view.bodies[b];
        double target[SAIN_OUTPUTS];
        float outputs[SAIN_OUTPUTS];
        sain_target(body, 1, -2, 3, target);
        for (int o = 0; o < SAIN_OUTPUTS; o++) outputs[o] = (float)(target[o] / (double)body->scale);
        const BodyVelocity velocity = sain_corrected(body, outputs);
        assert_near(velocity.linear.x, 1, 1e-5);
        assert_near(velocity.linear.y, -2, 1e-5);
        assert_near(velocity.angular, 3, 1e-4);
    }
}

/* What touches nothing is not seen; a problem without contacts has no receivers. */
TEST(an_empty_problem_is_seen) {
    static Problem problem;
    OWN(SainView) view = {0};
    SainAnswers answers = {0};
    OWN(SainNetwork) network;
    uint32_t seed = 1;
    fill(&problem, 2);
    make_sain_network(&network, &seed, 1);
    problem.problem.contact_count = 0;
    assert_true(sain_view_make(&view, &problem.problem, problem.engine));
    assert_int_equal(view.body_count, 0);
    assert_true(sain_answer(&answers, &network, &view));
    sain_answers_free(&answers);
}

/* A box of 4 kg, moving at (3, 0), strikes one of 1 kg at rest from the left, and the engine gives them (2, 0) and (4,
   0): of the light box's row the numbers that no symmetry tells. */
TEST(a_pair_has_its_inputs_by_hand) {
    static Problem p;
    p = (Problem){
        .problem = {.body_count = 2, .contact_count = 1, .bomb = -1, .bodies = p.bodies, .contacts = p.contacts}};
    for (int i = 0; i < 2; i++)
        p.bodies[i] = (ProblemBody){.position = {(float)i, 0},
                                    .size = {1, 1},
                                    .inv_mass = i == 0 ? 0.25f : 1,
                                    .inv_inertia = i == 0 ? 1.5f : 6,
                                    .velocity = {i == 0 ? 3.0f : 0, 0}};
    p.contacts[0] = (ContactPoint){.a = 0, .b = 1, .normal = {1, 0}, .friction = 0.2f};
    p.engine[0].linear.x = 2;
    p.engine[1].linear.x = 4;
    OWN(SainView) view = {0};
    assert_true(sain_view_make(&view, &p.problem, p.engine));
    assert_int_equal(view.row_count, 2);
    const SainBody *body = &view.bodies[1];
    const struct {
        int first;
        Vec2 value;
    } vectors[] = {{2, {1, 0}}, {15, {3, 0}}, {18, {-2, 0}}, {21, {-1, 0}}, {24, {4, 0}}};
    assert_int_equal(body->body, 1);
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const Vec2 expected = sain_into_frame(body, vectors[i].value);
        const float unit = i == 0 ? 1 : body->pace, *x = &view.pair_inputs[vectors[i].first * 2 + body->first];
        assert_near(x[0] * unit, expected.x, 1e-4);
        assert_near(x[2] * unit, expected.y, 1e-4);
    }
    assert_near(view.pair_inputs[6 * 2 + body->first], 0.2, 1e-6);
    assert_near(view.pair_inputs[8 * 2 + body->first], 1 / 1.25, 1e-6);
}

RUN_TESTS(NULL, NULL)

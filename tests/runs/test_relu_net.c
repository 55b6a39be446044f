/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of rectifiers gives what the engine does, frame by frame of the scenes. */
#include "made.h"

#include "methods/kernels.h"
#include "methods/worlds.h"

enum { ROUNDINGS = 50 }; /* that ten sweeps gather; a branch taken wrongly makes thousands */

static int lower_ends, released; /* contacts met at the lower end of the cone, and without an impulse */

/* The same contacts push, and the same are at the lower end of the cone, where no rounding is made. */
static void assert_same_impulse(const ContactPoint *contact, ContactImpulse net, ContactImpulse engine,
                                double rounding) {
    const float mass = fmaxf(contact->mass_normal, contact->mass_tangent), friction = contact->friction;
    const double tolerance = ROUNDINGS * (rounding * (double)mass + ldexp((double)engine.normal, -24));
    assert_near(net.normal, engine.normal, tolerance);
    assert_near(net.tangent, engine.tangent, tolerance);
    const bool pushes = engine.normal > 0, lower = pushes && engine.tangent <= -friction * engine.normal;
    assert_int_equal(net.normal > 0, pushes);
    assert_int_equal(pushes && net.tangent <= -friction * net.normal, lower);
    lower_ends += lower;
    released += !pushes;
}

static bool agrees(void *context, int frame, const World *world, Error *error) {
    (void)frame;
    const ContactSolver *net = context;
    const ContactProblem *problem = world_problem(world);
    const ContactSolution *engine = world_solution(world);
    const double rounding = rounding_of(problem);
    ContactSolution found = make_solution(problem);
    assert_ok(net->kind->solve(net->state, problem, &found, error), *error);
    assert_velocities(found.velocities, engine->velocities, problem->body_count, ROUNDINGS * rounding);
    for (int i = 0; i < problem->contact_count; i++)
        assert_same_impulse(&problem->contacts[i], found.impulses[i], engine->impulses[i], rounding);
    free_solution(&found);
    return true;
}

static void run_scene(const char *name, int sweeps) {
    Error error = {0};
    Method engine, net;
    ContactSolver solver;
    Scene *scene = scene_named(name);
    scene->iterations = sweeps;
    assert_ok(method_parse(&engine, "engine", &error) && method_parse(&net, "relu-net", &error), error);
    assert_ok(method_create_solver(&net, scene, &solver, &error), error);
    assert_ok(simulate_observed(scene, &engine, &(StepObserver){agrees, &solver}, &error), error);
    solver.kind->destroy(solver.state);
    scene_destroy(scene);
}

TEST(every_frame_is_the_engines) {
    lower_ends = released = 0;
    run_scene("single", 10);
    run_scene("stack", 13);
    run_scene("pyramid", 10);
    run_scene("pyramid_settled", 10);
    assert_true(lower_ends > 1000 && released > 1000);
}

RUN_TESTS(NULL, NULL)

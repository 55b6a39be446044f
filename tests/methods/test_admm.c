/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ADMM: the kernels have the same bits, the friction is Coulomb's, no unit matters. test_rivals.c and test_laws.c have
   what all rivals must keep. */
#include "kernels.h"
#include "random_problem.h"

#include "methods/admm_internal.h"

#ifdef TWINBOX_AVX
/* Some iterations of these kernels; the caller frees all. */
static void run_kernels(Admm *admm, const AdmmKernels *kernels, const ContactProblem *problem) {
    assert_true(sweeps_begin(&admm->sweeps, sweeps_best_kernel(), problem, true));
    assert_true(interior_load(&admm->interior, &interior_scalar, &admm->sweeps, problem));
    assert_true(ARRAY_BLOCK_RESERVE(&admm->memory, ARRAY_PART(admm->groups, admm->interior.group_count)));
    kernels->begin(admm);
    admm->penalty = 0.01 * kernels->largest(admm);
    for (int i = 0; i < 30; i++) {
        if (i % 10 == 0) kernels->factorize(admm);
        kernels->iterate(admm);
    }
}

static void free_kernels_run(Admm *admm) {
    sweeps_free(&admm->sweeps);
    interior_free(&admm->interior);
    free(admm->memory.memory);
}
#endif

TEST(all_kernels_have_the_same_bits) {
#ifdef TWINBOX_AVX
    static RandomProblem random;
    uint32_t seed = 3;
    if (!sweeps_can(SWEEP_LANES)) skip();
    for (int i = 0; i < 60; i++) {
        Admm plain = {0}, fast = {0};
        make_random(&random, &seed, 2 + i % 40, 0.2f, 2);
        run_kernels(&plain, &admm_scalar, &random.problem);
        run_kernels(&fast, &admm_avx2, &random.problem);
        assert_memory_equal(&plain.primal, &fast.primal, 2 * sizeof plain.primal);
        assert_memory_equal(plain.groups, fast.groups, (size_t)plain.interior.group_count * sizeof *plain.groups);
        free_kernels_run(&plain);
        free_kernels_run(&fast);
    }
#else
    skip();
#endif
}

/* The root mean square of what one more visit of each contact would change, m/s. */
static double residual_of_solution(const ContactProblem *problem, const ContactSolution *found) {
    double sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const Vec2 v =
            contact_relative_velocity(&found->velocities[contact->a], &found->velocities[contact->b], contact);
        const double missing = (double)(vec2_dot(v, contact->normal) - contact->bias),
                     held = (double)(found->impulses[i].normal / contact->mass_normal);
        const double normal = fmin(missing, held);
        sum += normal * normal;
    }
    return problem->contact_count > 0 ? sqrt(sum / problem->contact_count) : 0;
}

static World *make_struck_stack(float scale) {
    World *world = make_world();
    add_ground(world, 0.4f);
    for (int i = 0; i < 8; i++) add_box(world, scale * (1 + (float)(i % 3)), 0.4f, vec2(0, 0.5f + 0.995f * (float)i));
    add_body(world,
             &(BodyDef){
                 .size = {1, 1}, .mass = 5 * scale, .friction = 0.4f, .position = {-0.99f, 3.5f}, .velocity = {9, -2}});
    run_engine(world, "", 1);
    return world;
}

/* It stops when the residual is below `near`, not before, and not as late as it may. */
TEST(iterations_end_near_the_solution) {
    OWN(World) *world = make_struck_stack(1);
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) found = make_solution(problem), other = make_solution(problem);
    const double limits[] = {0.1, 1e-3, 1e-5};
    for (int i = 0; i < 3; i++) {
        char text[64];
        snprintf(text, sizeof text, "k=1,near=%g,more=100000", limits[i]);
        solve_with(&solver_admm, text, problem, &found);
        assert_true(residual_of_solution(problem, &found) < 1.5 * limits[i] * sqrt(2));
        snprintf(text, sizeof text, "k=1,near=%g,more=5000", limits[i]);
        solve_with(&solver_admm, text, problem, &other);
        assert_same_bits(problem, &other, &found, text);
        assert_true(residual_of_solution(problem, &found) > limits[i] / 1000);
    }
    solve_with(&solver_admm, "k=1", problem, &found);
    assert_true(residual_of_solution(problem, &found) > 0.1);
    solve_with(&solver_reference, "", problem, &other);
    solve_with(&solver_admm, "k=20000", problem, &found);
    assert_velocities(found.velocities, other.velocities, problem->body_count, 2e-5);
}

/* Where nothing is left but rounding, iterations would divide the penalty until it is the least, 1e-8. */
TEST(iterations_end_at_rounding) {
    OWN(World) *world = make_world();
    add_ground(world, 0.4f);
    for (int i = 0; i < 8; i++) add_box(world, 1, 0.4f, vec2(0, 0.5f + 0.995f * (float)i));
    run_engine(world, "", 1);
    OWN(ContactSolver) solver = make_solver(&solver_admm, "k=10000");
    OWN(ContactSolution) found = make_solution(world_problem(world));
    assert_ok(solver_admm.solve(solver.state, world_problem(world), &found, &error), error);
    const Admm *admm = solver.state;
    assert_true(fmax(admm->primal, admm->dual) <= 0x1p-34 * admm->largest_g);
    assert_true(admm->penalty > 1e-7);
}

/* Masses 1024 times as large: the same velocities, 1024 times the impulses, to the last bit. */
TEST(the_unit_of_mass_changes_no_bit) {
    OWN(World) *world = make_struck_stack(1), *heavy = make_struck_stack(1024);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, world_problem(heavy)->contact_count);
    OWN(ContactSolution) found = make_solution(problem), scaled = make_solution(problem);
    solve_with(&solver_admm, "k=77", problem, &found);
    solve_with(&solver_admm, "k=77", world_problem(heavy), &scaled);
    for (int i = 0; i < problem->contact_count; i++) {
        found.impulses[i].normal *= 1024;
        found.impulses[i].tangent *= 1024;
    }
    assert_same_bits(problem, &scaled, &found, "heavy");
}

/* Where sweeps carry nothing: 10,000 times the mass on a box. */
TEST(a_heavy_box_on_a_light_one_is_carried_at_once) {
    OWN(World) *world = make_heavy_on_light(10000, 0.499f, 1.498f);
    OWN(ContactSolver) solver = make_solver(&solver_admm, "k=50");
    run(world, &solver, 1);
    const ContactImpulse *impulses = world_solution(world)->impulses;
    assert_int_equal(world_problem(world)->contact_count, 4);
    assert_near(impulses[0].normal + impulses[1].normal, 10001 * 10 * world_dt, 2);
}

/* NaN or infinity ends in the engine's sweeps, with the same bits everywhere, and is counted. */
TEST(what_is_not_finite_is_left_to_sweeps) {
    static RandomProblem random;
    uint32_t seed = 9;
    make_random(&random, &seed, 10, 0.5f, 1);
    assert_true(random.problem.contact_count > 4);
    OWN(ContactSolution) found = make_solution(&random.problem), plain = make_solution(&random.problem);
    solve_with(&solver_admm, "k=5", &random.problem, &found);
    assert_int_equal(found.fallbacks.by_sweeps, 0);
    random.bodies[random.contacts[0].b].inv_mass = 0.1f;
    random.bodies[random.contacts[0].b].velocity.x = NAN;
    sequential_impulses_solve(&random.problem, &engine_options, 5, &plain);
    solve_with(&solver_admm, "k=5", &random.problem, &found);
    assert_int_equal(found.fallbacks.by_sweeps, 1);
    assert_same_bits(&random.problem, &found, &plain, "NaN");
}

RUN_TESTS(NULL, NULL)

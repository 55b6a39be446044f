/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws that every contact solver of the registry must keep that needs no program and no network. */
#include "base/settings.h"
#include "consistent.h"
#include "kernels.h"

#include "worlds.h"

/* The next contact solver of the registry that can be made of its settings alone; NULL: no more. */
static const ContactSolverKind *next_solver(int *place) {
    const MethodKind *kind;
    while ((kind = &method_kinds[(*place)++])->description != NULL)
        if (kind->solver != NULL && !kind->description->external && !kind->description->needs_network)
            return kind->solver;
    return NULL;
}

/* Four boxes in the air, which a fast and heavy one is about to hit; no ground, so momentum is kept. */
static World *make_crash(void) {
    World *world = make_world();
    for (int i = 0; i < 4; i++) add_box(world, 1, 0.5f, vec2(0.1f * (float)i, (float)i));
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 5, .friction = 0.5f, .position = {0.6f, 3.99f}, .velocity = {-1, -5}});
    run_engine(world, "", 1);
    assert_true(world_problem(world)->contact_count >= 6);
    return world;
}

/* The chain's impulse needs many sweeps. Those that converge, by their description, find the same velocities. */
TEST(all_meet_the_plain_sweeps) {
    OWN(World) *world = make_crash();
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) plain = make_solution(problem), found = make_solution(problem);
    sequential_impulses_solve(problem, &engine_options, 100000, &plain);
    solve_with(&solver_engine, "k=10", problem, &found);
    assert_true(fabsf(found.velocities[0].linear.y - plain.velocities[0].linear.y) > 0.1f);
    int judged = 0;
    const ContactSolverKind *kind;
    for (int place = 0; (kind = next_solver(&place)) != NULL;) {
        if (kind->description.converges == NULL) continue;
        solve_with(kind, kind->description.converges, problem, &found);
        assert_velocities(found.velocities, plain.velocities, problem->body_count, 5e-3);
        judged++;
    }
    assert_true(judged > 5);
}

/* After any number of sweeps: the last thing done is a sweep, not an extrapolation. */
TEST(cone_momentum_and_velocities_fit_after_every_sweep) {
    OWN(World) *world = make_crash();
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) found = make_solution(problem);
    double before[2], after[2];
    linear_momentum(problem, NULL, before);
    for (int k = 1; k <= 40; k++) {
        const char *text = printed("k=%d", k);
        const ContactSolverKind *kind;
        for (int place = 0; (kind = next_solver(&place)) != NULL;) {
            const bool sweeps = settings_known(kind->description.settings, "k");
            if (!sweeps && k > 1) continue;
            solve_with(kind, sweeps ? text : "", problem, &found);
            linear_momentum(problem, found.velocities, after);
            for (int i = 0; i < 2; i++) assert_near(before[i], after[i], 4e-3);
            assert_in_cone(problem, found.impulses);
            assert_velocities_fit(problem, &found, true);
        }
    }
}

/* Contacts never pull: a box that flies up from the ground keeps its velocity. */
TEST(a_box_that_leaves_the_ground_is_not_held) {
    OWN(World) *world = make_world();
    add_ground(world, 0.5f);
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 1, .friction = 0.5f, .position = {0, 0.495f}, .velocity = {2, 3}});
    run_engine(world, "", 1);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, 2);
    OWN(ContactSolution) found = make_solution(problem);
    const ContactSolverKind *kind;
    for (int place = 0; (kind = next_solver(&place)) != NULL;) {
        solve_with(kind, settings_known(kind->description.settings, "k") ? "k=20" : "", problem, &found);
        for (int c = 0; c < 2; c++) assert_true(found.impulses[c].normal == 0 && found.impulses[c].tangent == 0);
        assert_true(found.velocities[1].linear.x == 2);
    }
}

/* Without the warm start it matters no more what the problem says of it. */
TEST(a_cold_engine_starts_from_zero) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < 5; i++) add_box(world, 1, 0.2f, vec2(0, 0.5f + (float)i));
    run_engine(world, "", 60);
    ContactProblem cold = *world_problem(world);
    ContactPoint contacts[16];
    assert_in_range(cold.contact_count, 1, 16);
    memcpy(contacts, cold.contacts, (size_t)cold.contact_count * sizeof *contacts);
    for (int i = 0; i < cold.contact_count; i++) contacts[i].warm_normal = contacts[i].warm_tangent = 0;
    cold.contacts = contacts;
    OWN(ContactSolution) off = make_solution(&cold), on = make_solution(&cold), of_cold = make_solution(&cold);
    solve_with(&solver_engine, "k=3,warm=off", world_problem(world), &off);
    solve_with(&solver_engine, "k=3", world_problem(world), &on);
    solve_with(&solver_engine, "k=3", &cold, &of_cold);
    assert_same_bits(&cold, &off, &of_cold, "warm=off");
    assert_memory_not_equal(off.impulses, on.impulses, (size_t)cold.contact_count * sizeof *on.impulses);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy available in converged runs, and verdicts on scenes. */
#include "made.h"
#include "studies/trial.h"

/* Boxes of 1 kg at 10 m/s^2: 10 J per metre. From 3 m to 1 m, 20 of 30 J are lost. A box is added with 40 J; with both
   at 0, 70 of 70 J are lost. It is removed with 5 J that it had regained: 65 of 65 J are lost then, and 75 at -1 m.
   Lifted to 80 J, the highest level so far, 120 J are lost down to -4 m. */
TEST(lost_energy_is_available) {
    OWN(EnergyLog) log = {0};
    Body bodies[2] = {trial_box, trial_box};
    const struct {
        int count;
        float y[2];
        double energy, available;
    } rows[] = {{1, {3, 0}, 30, 0},    {1, {1, 0}, 10, 20}, {2, {1, 4}, 50, 20},   {2, {0, 0}, 0, 70},
                {2, {0, 0.5f}, 5, 70}, {1, {0, 0}, 0, 70},  {1, {5, 0}, 50, 70},   {1, {6, 0}, 60, 70},
                {1, {-1, 0}, -10, 75}, {1, {8, 0}, 80, 75}, {1, {-4, 0}, -40, 120}};
    const int frames = (int)(sizeof rows / sizeof rows[0]) - 1;
    for (int i = 0; i <= frames; i++) {
        for (int k = 0; k < 2; k++) bodies[k].position.y = rows[i].y[k];
        if (i == 0)
            assert_ok(energy_log_begin(&log, vec2(0, -10), frames, bodies, rows[i].count, &error), error);
        else
            energy_log_step(&log, i, bodies, rows[i].count);
        assert_near(log.energy[i], rows[i].energy, 1e-6);
        assert_near(log.balance.available, rows[i].available, 1e-6);
    }
}

/* A stack of ten boxes, 1 kg and 10 m/s^2: 0 + 1 + ... + 9 m are 450 J. A bomb of 2 kg is added 9 m above the lowest:
   180 J; one below the lowest adds nothing. */
TEST(the_height_of_a_stack_is_available) {
    OWN(EnergyLog) log = {0};
    Body bodies[14];
    for (int i = 0; i < 14; i++) bodies[i] = trial_box;
    for (int i = 1; i < 11; i++) bodies[i].position.y = (float)i - 0.5f;
    bodies[0] = trial_ground;
    bodies[11].inv_mass = 0.5f;
    bodies[11].position.y = 9.5f;
    bodies[12].position.y = -3;
    assert_ok(energy_log_begin(&log, vec2(0, -10), 3, bodies, 11, &error), error);
    assert_near(log.balance.available, 450, 1e-6);
    energy_log_step(&log, 1, bodies, 12);
    assert_near(log.balance.available, 630, 1e-6);
    energy_log_step(&log, 2, bodies, 13);
    assert_near(log.balance.available, 630, 1e-6);
    energy_log_step(&log, 3, bodies, 12);
    assert_near(log.balance.available, 630, 1e-6);
    /* Up is opposite to gravity: along -x here, 2 m/s^2. All boxes but one have the same height. */
    for (int i = 1; i < 11; i++) bodies[i].position = vec2(i == 4 ? -7.0f : 3.0f, (float)i);
    assert_ok(energy_log_begin(&log, vec2(2, 0), 3, bodies, 11, &error), error);
    assert_near(log.balance.available, 20, 1e-6);
    /* Without dynamic bodies at the start, the first one added is the lowest. */
    assert_ok(energy_log_begin(&log, vec2(0, -10), 3, bodies, 1, &error), error);
    energy_log_step(&log, 1, bodies, 2);
    assert_near(log.balance.available, 0, 0);
}

static void parse(Method *method, const char *text) {
    Error error = {0};
    assert_ok(method_parse(method, text, &error), error);
}

static void converge(EnergyLog *log, const Scene *scene) {
    Error error = {0};
    Method method;
    parse(&method, "reference");
    assert_ok(energy_log_run(log, scene, &method, &error), error);
}

static VerdictReading judge(const Scene *scene, bool stands, const EnergyLog *converged) {
    Error error = {0};
    Method method;
    VerdictReading reading;
    parse(&method, "engine");
    const VerdictRun run = beside(scene, stands, converged);
    assert_ok(verdict_run(&reading, scene, &method, &run, &error), error);
    return reading;
}

/* Two boxes of 1 kg, the upper one 1 m above the lower. They sink to the slop, 0.01 and 0.02 m, which loses less: at
   most 0.3 J. */
TEST(a_stack_of_two_settles) {
    BodyDef bodies[] = {{.size = {100, 20}, .fixed = true, .friction = 0.2f, .position = {0, -10}},
                        {.size = {1, 1}, .mass = 1, .friction = 0.2f, .position = {0, 0.5f}},
                        {.size = {1, 1}, .mass = 1, .friction = 0.2f, .position = {0, 1.5f}}};
    const Scene scene = scene_of_bodies(bodies, 3, 1500);
    OWN(EnergyLog) converged = {0};
    converge(&converged, &scene);
    assert_near(converged.balance.available, 10, 1e-5);
    assert_true(converged.balance.level - converged.energy[1500] < 0.3);
    VerdictReading reading = judge(&scene, true, &converged);
    assert_verdict(reading, VERDICT_SETTLES);
    assert_true(reading.frame < 60);
}

/* Dropped on a slab of 0.25 m from 1.5 m above its centre; added after frame 5. */
static Scene shot_at_slab(BodyDef *slab, float speed) {
    *slab = (BodyDef){.size = {20, 0.25f}, .fixed = true, .friction = 0.2f};
    Scene scene = scene_of_bodies(slab, 1, 100);
    scene.bomb = (SceneBomb){.present = true,
                             .frame = 5,
                             .size = {1, 1},
                             .mass.value = 1,
                             .friction = 0.2f,
                             .y = 1.5f,
                             .velocity = {0, -speed}};
    return scene;
}

/* 200 m/s are 3.3 m per step: the next position is 1.8 m below, without a contact. */
TEST(a_fast_box_tunnels_through_a_thin_slab) {
    BodyDef slab;
    OWN(EnergyLog) converged = {0};
    Scene scene = shot_at_slab(&slab, 200);
    converge(&converged, &scene);
    assert_reading(judge(&scene, false, &converged), VERDICT_TUNNELS, 1, 6, 200 + 10.0 / 60, 1e-3, "m/s");
    scene = shot_at_slab(&slab, 2);
    converge(&converged, &scene);
    assert_verdict(judge(&scene, false, &converged), VERDICT_SETTLES);
    /* It starts at 1.5 m with 2 m/s and ends 0.625 m above the centre: 8.75 + 2 J. It penetrates by less than a step at
       its 4.6 m/s: at most 0.8 J more. */
    assert_near(converged.balance.available, 10.75 + 0.4, 0.4);
}

/* At 3e38 m/s the position overflows a float, 3.4e38 m, in the 69th step. */
TEST(a_run_that_overflows_is_judged) {
    Method method;
    BodyDef slab;
    OWN(EnergyLog) converged = {0};
    Scene scene = shot_at_slab(&slab, 2);
    converge(&converged, &scene);
    scene = shot_at_slab(&slab, 3e38f);
    assert_reading(judge(&scene, false, &converged), VERDICT_NON_FINITE, -1, 5 + 69, 3e38, 1e33, "m/s");
    parse(&method, "reference");
    assert_refused(energy_log_run(&converged, &scene, &method, &error), "is NaN or infinite");
}

RUN_TESTS(NULL, NULL)

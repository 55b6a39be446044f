/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method `interior` at rest: what it holds for a minute and the engine with ten sweeps does not. */
#include "made.h"
#include "sanitized.h"

#include "engine/uniform.h"
#include "studies/stability.h"

typedef struct Case {
    const char *scene;
    SceneSetting settings[3];
    int count;
} Case;

static VerdictReading judge_allowing(const Case *the, const char *text, double allowed) {
    VerdictReading reading;
    Error error = {0};
    const Method method = method_named(text);
    const char *path = printed("%s/scenes/stability/%s.yaml", SOURCE_DIR, the->scene);
    OWN(Scene) *scene = scene_read_with(path, the->settings, the->count, &error);
    assert_ok(scene != NULL, error);
    assert_ok(verdict_run(&reading, scene, &method, allowed, &error), error);
    return reading;
}

static VerdictReading judge(const Case *the, const char *text) { return judge_allowing(the, text, 0); }

/* The engine with ten sweeps fails in each. */
TEST(what_the_engine_loses_settles) {
    static const Case cases[] = {{"stack_height", {{"height", 40}}, 1},
                                 {"stack_cold", {{"height", 20}}, 1},
                                 {"heavy_on_one", {{"ratio", 1000}}, 1},
                                 {"heavy_on_five", {{"ratio", 1000}}, 1},
                                 {"heavy_on_nine", {{"ratio", 1000}}, 1},
                                 {"gate", {{"mass", 500}}, 1},
                                 {"plate", {{"ratio", 1000}}, 1},
                                 {"top_removed", {{"ratio", 200}}, 1},
                                 {"time_step", {{"rate", 20}, {"height", 10}}, 2},
                                 {"tilted_stack", {{"shift", 0.09}}, 1},
                                 {"arch", {{"friction", 0.2}}, 1},
                                 {"card_house", {{"friction", 0.28}}, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i += (size_t)sampled(4)) {
        const VerdictReading engine = judge(&cases[i], "engine:k=10"), interior = judge(&cases[i], "interior");
        if (verdict_holds(engine.verdict) || !verdict_holds(interior.verdict) || interior.moving)
            fail_msg("%s: engine %s, interior %s", cases[i].scene, verdict_name(engine.verdict),
                     verdict_name(interior.verdict));
    }
}

/* No more is held than can stand. The house needs a friction of 0.27: the reference falls below. */
TEST(a_card_house_without_enough_friction_falls) {
    const Case house = {"card_house", {{"friction", 0.25}}, 1};
    assert_int_equal(judge(&house, "interior").verdict, VERDICT_FALLS);
}

/* Impulses that push overlapping boxes apart must not be used as a warm start. */
TEST(an_overlapping_stack_does_not_explode) {
    const Case overlap = {.scene = "overlap"};
    const double allowed = judge_allowing(&overlap, "reference", INFINITY).excess;
    assert_int_equal(judge_allowing(&overlap, "interior", allowed).verdict, VERDICT_SETTLES);
}

static void assert_strike_does_not_explode(float x, float spin, float mass) {
    const Case strike = {"random_bombs", {{"x", (double)x}, {"spin", (double)spin}, {"mass", (double)mass}}, 3};
    const VerdictReading reading = judge(&strike, "interior");
    if (reading.verdict >= VERDICT_EXPLODES)
        fail_msg("x %g, spin %g, mass %g: %g J", (double)x, (double)spin, (double)mass, reading.value);
}

/* A box that is hit may slide, tip or fly: neither the impulses that would hold it in place nor those of the impact
   itself are a valid warm start for the next step. */
TEST(stacks_that_bombs_strike_do_not_explode) {
    uint32_t seed = 1;
    assert_strike_does_not_explode(0, 10, 50);
    for (int trial = 0; trial < 15; trial += sampled(4)) {
        const float x = uniform(&seed, -1, 1), spin = uniform(&seed, 0, 20);
        assert_strike_does_not_explode(x, spin, uniform(&seed, 10, 200));
    }
}

RUN_TESTS(NULL, NULL)

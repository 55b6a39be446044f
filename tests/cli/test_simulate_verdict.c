/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which failures of a run are verdicts. */
#include "made.h"

#include "base/file.h"
#include "cli/judge.h"

/* At 3e38 m/s the position overflows a float, 3.4e38 m, in the 69th step; no scene file may have that speed. */
TEST(a_run_that_overflows_has_a_verdict) {
    BodyDef body = {.size = {1, 1}, .mass = 1, .position = {0, 1}, .velocity = {3e38f, 0}};
    const Scene scene = {.name = "fast",
                         .gravity = {0, -10},
                         .dt = 1.0f / 60.0f,
                         .iterations = 10,
                         .frames = 100,
                         .body_count = 1,
                         .bodies = &body};
    SimulateVerdict verdict;
    const Method method = method_named("engine");
    assert_ok(simulate_verdict_begin(&verdict, &scene, &method, &error), error);
    const StepObserver observer = {verdict_watch_observe, &verdict.watch};
    assert_refused(simulate_observed(&scene, &method, &observer, &error), "is NaN or infinite");
    assert_true(simulate_verdict_end(&verdict, &error));
    assert_int_equal(verdict.reading.verdict, VERDICT_NON_FINITE);
    assert_int_equal(verdict.reading.frame, 69);
    Error other = {0};
    size_t size;
    assert_ok(simulate_verdict_write(&verdict, temporary_path("v.json"), &other), other);
    FREED char *text = file_read(temporary_path("v.json"), 10000, &size, &other);
    assert_ok(text != NULL, other);
    assert_non_null(strstr(text, "\"verdict\": \"non-finite\""));
    assert_non_null(strstr(text, "\"frame\": 69"));
    assert_non_null(strstr(text, "\"steps\": 69"));
    simulate_verdict_free(&verdict);
}

TEST(other_failures_have_none) {
    const Scene scene = {.name = "empty", .dt = 1.0f / 60.0f, .frames = 1};
    const Method method = method_named("engine");
    SimulateVerdict verdict;
    assert_ok(simulate_verdict_begin(&verdict, &scene, &method, &error), error);
    error_input(&error, "empty", "stopped after step 1 of 10");
    assert_false(simulate_verdict_end(&verdict, &error));
    simulate_verdict_free(&verdict);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods exec and exec-solver read what a program writes: answers with random damage end the run with a reason, or
   are numbers that an engine or a solver could have answered. The program is a shell that writes a file whatever it is
   asked. */
#include "owned.h"

#include "methods/adapter.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

enum { FRAMES = 6, BODIES = 2, DAMAGES = 100, ANSWERS_MAX = 4096 };

typedef struct Answers {
    char bytes[ANSWERS_MAX];
    size_t size;
} Answers;

static void add(Answers *answers, const void *bytes, size_t size) {
    assert_true(answers->size + size <= ANSWERS_MAX / 2);
    memcpy(answers->bytes + answers->size, bytes, size);
    answers->size += size;
}

static void add_text(Answers *answers, const char *text) { add(answers, text, strlen(text)); }

/* Of a solver, for the first step of a box that rests on the ground. */
static Answers right_impulses(void) {
    Answers answers = {.size = 0};
    add_text(&answers, "{\"twinbox\": 1, \"name\": \"cat\", \"version\": \"1\", \"answers\": \"impulses\"}\n"
                       "{\"problem\": 1, \"ns\": 1500, \"impulses\": [0.0833, 0.001, 0.0833, -0.001]}\n");
    return answers;
}

static Answers right_answers(bool binary) {
    Answers answers = {.size = 0};
    const float states[BODIES * ADAPTER_NUMBERS] = {0, -10, 0, 0, 0, 0, 0.25f, 0.5f, 0.125f, -1, 2, 3};
    add_text(&answers, "{\"twinbox\": 1, \"name\": \"cat\", \"version\": \"1\"");
    add_text(&answers, binary ? ", \"form\": \"binary\"}\n" : "}\n");
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        const uint32_t head[] = {1, frame, BODIES, 0, 1500, 0};
        char line[256];
        snprintf(
            line, sizeof line,
            "{\"scene\": 1, \"frame\": %u, \"ns\": 1500, \"states\": [0, -10, 0, 0, 0, 0, 0.25, 0.5, 0.125, -1, 2, "
            "3]}\n",
            frame);
        if (binary) add(&answers, head, sizeof head), add(&answers, states, sizeof states);
        if (!binary) add_text(&answers, line);
    }
    return answers;
}

static uint32_t next(uint32_t *random) {
    *random = *random * 1664525u + 1013904223u;
    return *random >> 8;
}

/* One to three times: another byte, a missing piece, a piece twice. */
static void damage(Answers *answers, uint32_t *random) {
    static const char bytes[] = "0123456789-+.,eE{}[]\":\n\r aZ\0\x7f\xff";
    for (uint32_t times = 1 + next(random) % 3; times > 0 && answers->size > 0; times--) {
        const size_t at = next(random) % answers->size, length = 1 + next(random) % (answers->size - at);
        const uint32_t kind = next(random) % 4;
        char *place = answers->bytes + at;
        if (kind == 0) *place = bytes[next(random) % sizeof bytes];
        if (kind == 1) *place = (char)(*place ^ (1 << next(random) % 8));
        if (kind == 2) {
            memmove(place, place + length, answers->size - at - length);
            answers->size -= length;
        }
        if (kind == 3 && answers->size + length <= ANSWERS_MAX) {
            memmove(place + length, place, answers->size - at);
            answers->size += length;
        }
    }
}

/* The run of a scene of this height by a program that gives these answers, and may take these seconds for each. */
static bool run_program(const char *name, const Answers *answers, float y, int frames, int seconds, Error *error) {
    static char method_text[300];
    static int runs;
    Method method;
    const char *path = write_bytes(temporary_path("answers"), answers->bytes, answers->size);
    static const char program[] = "read hello; head -n 1 $1; head -c 1 >/dev/null; tail -n +2 $1\n";
    const char *shell = write_bytes(temporary_path("program"), program, strlen(program));
    /* The number gives each run a process of its own. */
    snprintf(method_text, sizeof method_text, "%s:/bin/sh %s %s %d,step_limit=%d", name, shell, path, runs++, seconds);
    programs_allow(method_text);
    const char *text = printed("gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: %d\nbodies:\n"
                               "  - {static: true, size: [100, 20], position: [0, -10], friction: 0.2}\n"
                               "  - {size: [1, 1], mass: 1, position: [0, %g], friction: 0.2}\n",
                               frames, (double)y);
    OWN(Scene) *scene = scene_read(write_bytes(temporary_path("fall.yaml"), text, strlen(text)), error);
    assert_ok(scene != NULL, *error);
    assert_ok(method_parse(&method, method_text, error), *error);
    const bool done = simulate_watched(scene, &method, &(RunWatch){.observer_count = 0}, error);
    return done;
}

static bool run_answers(const Answers *answers, int seconds, Error *error) {
    return run_program("exec", answers, 100, FRAMES, seconds, error);
}

static bool run_impulses(const Answers *answers, int seconds, Error *error) {
    return run_program("exec-solver", answers, 0.495f, 1, seconds, error);
}

TEST(right_answers_are_taken) {
    const Answers impulses = right_impulses();
    assert_ok(run_impulses(&impulses, 60, &error), error);
    for (int binary = 0; binary < 2; binary++) {
        const Answers answers = right_answers(binary);
        assert_ok(run_answers(&answers, 60, &error), error);
    }
}

TEST(damaged_answers_end_the_run_or_are_numbers) {
    int refused = 0;
    for (uint32_t seed = 0; seed < 2 * DAMAGES; seed++) {
        uint32_t random = seed;
        Answers answers = right_answers(seed % 2);
        damage(&answers, &random);
        error = (Error){0};
        if (run_answers(&answers, 1, &error)) continue;
        refused++;
        assert_error(error, ERROR_INPUT, "adapter failed: ");
    }
    assert_in_range(refused, DAMAGES, 2 * DAMAGES - 1);
}

TEST(damaged_impulses_end_the_run_or_are_numbers) {
    int refused = 0;
    for (uint32_t seed = 0; seed < DAMAGES; seed++) {
        uint32_t random = seed;
        Answers answers = right_impulses();
        damage(&answers, &random);
        error = (Error){0};
        if (run_impulses(&answers, 1, &error)) continue;
        refused++;
        assert_error(error, ERROR_INPUT, "adapter failed: ");
    }
    assert_in_range(refused, DAMAGES / 2, DAMAGES - 1);
}

RUN_TESTS(NULL, NULL)

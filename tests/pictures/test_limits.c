/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a page leaves out, and what is refused. Runs of noise, which does not pack. */
#include "base/random.h"
#include "made.h"
#include "player_page.h"

#include "pictures/player.h"

enum { FRAMES = 300, BODIES = 40, CONTACTS = 100 };

static float noise(uint64_t *random) { return (float)(split_mix(random) >> 40) / (1 << 24); }

static Trajectory *noisy_run(const char *method, uint64_t random) {
    Trajectory *run = run_sized(FRAMES, BODIES);
    snprintf(run->scene, sizeof run->scene, "noise");
    snprintf(run->method, sizeof run->method, "%s", method);
    run->dt = 1.0F / 60;
    run->bomb = -1;
    for (int body = 0; body < BODIES; body++) run->size[body] = vec2(1, 1);
    for (int i = 0; i < FRAMES * BODIES; i++) {
        run->position[i] = vec2(noise(&random), noise(&random));
        run->velocity[i] = vec2(noise(&random), noise(&random));
        run->angle[i] = noise(&random);
        run->angular_velocity[i] = noise(&random);
    }
    for (int step = 1; step < FRAMES; step++)
        for (int i = 0; i < CONTACTS; i++) {
            const TrajectoryContact contact = {.a = 0,
                                               .b = 1 + i % (BODIES - 1),
                                               .feature = (uint32_t)split_mix(&random),
                                               .point = vec2(noise(&random), noise(&random)),
                                               .normal = vec2(noise(&random), noise(&random)),
                                               .normal_impulse = noise(&random),
                                               .tangent_impulse = noise(&random)};
            add_contact(run, step, contact);
        }
    trajectory_end_contacts(run);
    return run;
}

typedef struct Pair {
    const Trajectory *runs[2];
} Pair;

FIXTURE(begin) {
    static Pair pair;
    pair = (Pair){{noisy_run("engine", 1), noisy_run("momentum", 2)}};
    *state = &pair;
}

FIXTURE(end) {
    const Pair *pair = *state;
    for (int i = 0; i < 2; i++) trajectory_destroy((Trajectory *)pair->runs[i]);
}

static bool write_page(const Pair *pair, const PlayerOptions *options, const char *path, PlayerResult *result,
                       Error *error) {
    *error = (Error){0};
    return player_write(pair->runs, 2, options, path, result, error);
}

/* The page with contacts is too large, the states alone fit. */
TEST(contacts_are_left_out_first) {
    const char *path = temporary_path("left.html");
    PlayerResult whole, less;
    assert_ok(write_page(*state, &(PlayerOptions){.last = -1}, path, &whole, &error), error);
    assert_ok(write_page(*state, &(PlayerOptions){.last = -1, .most_bytes = whole.bytes * 9 / 10}, path, &less, &error),
              error);
    assert_true(less.left_contacts && less.bytes < whole.bytes * 9 / 10);
    FREED char *text = text_of(path);
    assert_null(strstr(text, "id=\"c0-0\""));
    FREED char *data = page_data(path);
    assert_non_null(strstr(data, "without contacts"));
}

/* With the step that the message proposes, the page is small enough. */
TEST(what_is_too_large_is_refused_with_a_way_out) {
    const char *path = temporary_path("refused.html");
    const int64_t most = 500000;
    PlayerResult result;
    assert_refused(write_page(*state, &(PlayerOptions){.last = -1, .most_bytes = most}, path, &result, &error),
                   "use --every ");
    assert_int_not_equal(access(path, F_OK), 0);
    const int every = atoi(strstr(error.message, "--every ") + 8);
    assert_true(every > 1);
    assert_ok(
        write_page(*state, &(PlayerOptions){.last = -1, .every = every, .most_bytes = most}, path, &result, &error),
        error);
    assert_true(result.bytes <= most && result.frames == (FRAMES - 1) / every + 1);
}

TEST(a_link_names_moment_and_body) {
    char text[PLAYER_LINK_SIZE];
    player_link(text, 0.55, 7);
    assert_string_equal(text, "#t=0.55&body=7");
    player_link(text, 12, -1);
    assert_string_equal(text, "#t=12");
}

RUN_TESTS(begin, end)

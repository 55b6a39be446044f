/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a page leaves out, and what is refused. Runs of noise, which does not pack. */
#include "made.h"
#include "files.h"

#include "pictures/player.h"

enum { FRAMES = 300, BODIES = 40, CONTACTS = 100 };

static float noise(uint64_t *random) { return (float)(split_mix(random) >> 40) / (1 << 24); }

static Trajectory *noisy_run(const char *method, uint64_t random) {
    Error error = {0};
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
            assert_ok(trajectory_add_contact(run, step, &contact, &error), error);
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

TEST(the_same_runs_give_the_same_bytes) {
    const char *paths[] = {temporary_path("a.html"), temporary_path("b.html")};
    char *texts[2];
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        PlayerResult result;
        assert_ok(write_page(*state, &(PlayerOptions){.last = -1}, paths[i], &result, &error), error);
        texts[i] = read_whole(paths[i], &sizes[i]);
        assert_int_equal(result.bytes, sizes[i]);
        assert_int_equal(result.frames, FRAMES);
        assert_false(result.left_contacts);
        assert_non_null(strstr(texts[i], "id=\"c1-0\""));
    }
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(texts[0], texts[1], sizes[0]);
    free(texts[0]);
    free(texts[1]);
}

/* The page with contacts is too large, the states alone fit. */
TEST(contacts_are_left_out_first) {
    const char *path = temporary_path("left.html");
    PlayerResult whole, less;
    assert_ok(write_page(*state, &(PlayerOptions){.last = -1}, path, &whole, &error), error);
    assert_ok(write_page(*state, &(PlayerOptions){.last = -1, .most_bytes = whole.bytes * 9 / 10}, path, &less, &error),
              error);
    assert_true(less.left_contacts && less.bytes < whole.bytes * 9 / 10);
    char *text = text_of(path);
    assert_null(strstr(text, "id=\"c0-0\""));
    assert_non_null(strstr(text, "without contacts"));
    free(text);
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

TEST(frames_beyond_the_end_are_refused) {
    const char *path = temporary_path("frames.html");
    PlayerResult result;
    assert_refused(write_page(*state, &(PlayerOptions){.last = FRAMES}, path, &result, &error),
                   "300 is beyond the last frame, 299");
    assert_refused(write_page(*state, &(PlayerOptions){.first = FRAMES, .last = -1}, path, &result, &error),
                   "beyond the last frame");
}

TEST(a_link_names_moment_and_body) {
    char text[PLAYER_LINK_SIZE];
    player_link(text, 0.55, 7);
    assert_string_equal(text, "#t=0.55&body=7");
    player_link(text, 12, -1);
    assert_string_equal(text, "#t=12");
}

RUN_TESTS(begin, end)

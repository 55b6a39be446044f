/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequences: the same files with any number of processes, and an error message for every failure. */
#include "made.h"

#include "pixels/built_contexts.h"
#include "files.h"
#include "mesa.h"
#include "pictures/render.h"
#include "runs.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

enum { FRAMES = 11 };

static Trajectory *runs[2];
static const Trajectory *panels[2];

FIXTURE(make) {
    panels[0] = runs[0] = run_make("engine", FRAMES);
    panels[1] = runs[1] = run_make("pair-net:network=nets/small.npz", FRAMES - 3);
    run_position(runs[1], 4, FIRST_BOX)->x -= 0.25F;
}

FIXTURE(destroy) {
    trajectory_destroy(runs[0]);
    trajectory_destroy(runs[1]);
}

static RenderOptions options_for(const char *directory, int jobs) {
    return (RenderOptions){.width = 160, .height = 90, .last = -1, .jobs = jobs, .directory = directory};
}

TEST_WITH(any_number_of_jobs_writes_the_same_files, make, destroy) {
    static const int jobs[] = {2, 3, 20}; /* fewer and more than frames */
    for (int i = 0; i < 2; i++) {
        trajectory_destroy(runs[i]);
        panels[i] = runs[i] = run_make(i == 0 ? "engine" : "momentum", 4 - i);
    }
    RenderOptions one = options_for(temporary_path("one/deep"), 1);
    assert_ok(render_sequence(panels, 2, &one, NULL, NULL, &error), error);
    assert_int_equal(count_files(one.directory, ".png"), 4);
    for (int i = 0; i < 3; i++) {
        RenderOptions many = options_for(temporary_path("many"), jobs[i]);
        many.context = built_context(jobs[i] == 3 ? CONTEXT_EGL : CONTEXT_OSMESA);
        assert_ok(render_sequence(panels, 2, &many, NULL, NULL, &error), error);
        assert_same_folder(one.directory, many.directory);
    }
}

TEST_WITH(a_sequence_holds_the_frames_of_the_renderer, make, destroy) {
    RenderOptions options = options_for(temporary_path("range"), 2);
    options.first = 3, options.last = 7;
    assert_ok(render_sequence(panels, 2, &options, NULL, NULL, &error), error);
    assert_int_equal(count_files(options.directory, ".png"), 5);
    Renderer *renderer = renderer_create(panels, 2, &options, &error);
    OWN(Image) *image = image_sized(options.width, options.height);
    for (int frame = 3; frame <= 7; frame++) {
        assert_ok(renderer_draw(renderer, frame, image, &error), error);
        OWN(Image) *written = image_of(frame_path(options.directory, frame));
        assert_true(image_hash(written) == image_hash(image));
    }
    renderer_destroy(renderer);
}

static void assert_text(const char *path, const char *key, const char *wanted) {
    char value[256];
    text_of_image(path, key, value, sizeof value);
    assert_string_equal(value, wanted);
}

TEST_WITH(frames_tell_their_origin, make, destroy) {
    RenderOptions options = options_for(temporary_path("texts"), 1);
    options.first = options.last = FRAMES - 1;
    assert_ok(render_sequence(panels, 2, &options, NULL, NULL, &error), error);
    const char *path = frame_path(options.directory, FRAMES - 1);
    const char *hashes =
        printed("%016llx | %016llx", (unsigned long long)trajectory_frame_hash(panels[0], FRAMES - 1),
                (unsigned long long)trajectory_frame_hash(panels[1], FRAMES - 4)); /* its last frame: it has ended */
    assert_text(path, "Scene", "two_boxes");
    assert_text(path, "Method", "engine | pair-net:network=nets/small.npz");
    assert_text(path, "Frame", "10");
    assert_text(path, "State", hashes);
    assert_text(path, "Software", "twinbox");
}

typedef struct Listener {
    double last, total;
    double stop_at;
    int calls;
} Listener;

static bool listen_to(void *context, double done, double total) {
    Listener *listener = context;
    assert_true(done >= listener->last && done <= total);
    listener->last = done;
    listener->total = total;
    listener->calls++;
    return done < listener->stop_at;
}

TEST_WITH(progress_counts_the_frames, make, destroy) {
    Listener listener = {.stop_at = 1000};
    RenderOptions options = options_for(temporary_path("progress"), 3);
    assert_ok(render_sequence(panels, 2, &options, NULL, &(Progress){listen_to, &listener}, &error), error);
    assert_true(listener.last == FRAMES && listener.total == FRAMES && listener.calls >= 3);
}

/* No process remains, and no file is incomplete. */
TEST_WITH(a_sequence_can_be_stopped, make, destroy) {
    trajectory_destroy(runs[0]);
    panels[0] = runs[0] = run_make("engine", 2000);
    Listener listener = {.stop_at = 5};
    RenderOptions options = options_for(temporary_path("stopped"), 3);
    assert_false(render_sequence(panels, 2, &options, NULL, &(Progress){listen_to, &listener}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped");
    assert_true(count_files(options.directory, ".png") < 1000);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    for (int frame = 0; access(frame_path(options.directory, frame), F_OK) == 0; frame++) {
        OWN(Image) *image = image_read_png(frame_path(options.directory, frame), &(Error){0});
        assert_non_null(image);
    }
}

static void limit_files(rlim_t bytes) {
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    assert_int_equal(setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0}), 0);
    signal(SIGXFSZ, SIG_DFL);
}

/* By the signal of a limit of file sizes. */
TEST_WITH(a_killed_process_is_reported, make, destroy) {
    RenderOptions options = options_for(temporary_path("killed"), 2);
    limit_files(2000);
    bool ok = render_sequence(panels, 2, &options, NULL, NULL, &error);
    limit_files(RLIM_INFINITY);
    assert_false(ok);
    assert_error(error, ERROR_SYSTEM, "a drawing process was killed by signal");
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Signals that cut calls short change nothing in a sequence; files that cannot be removed are reported. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "owned.h"

#include "files.h"
#include "mesa.h"
#include "pictures/render.h"
#include "runs.h"

#include <dlfcn.h>
#include <errno.h>

enum { FRAMES = 6 };

static bool interrupting;                /* every other call, and short calls in between */
static const char *undeletable, *unseen; /* ending of a path */

#define REAL(name, type, ...)  \
    type (*real)(__VA_ARGS__); \
    *(void **)&real = dlsym(RTLD_NEXT, name)

static bool is_interrupted(size_t *size) {
    static unsigned calls;
    if (!interrupting) return false;
    errno = EINTR;
    if (++calls % 2 == 0) return true;
    *size = (*size + 1) / 2;
    return false;
}

ssize_t write(int file, const void *data, size_t size) {
    REAL("write", ssize_t, int, const void *, size_t);
    return is_interrupted(&size) ? -1 : real(file, data, size);
}

ssize_t read(int file, void *data, size_t size) {
    REAL("read", ssize_t, int, void *, size_t);
    return is_interrupted(&size) ? -1 : real(file, data, size);
}

int unlink(const char *path) {
    REAL("unlink", int, const char *);
    if (undeletable == NULL || !file_name_ends_with(path, undeletable)) return real(path);
    errno = EIO;
    return -1;
}

int lstat(const char *restrict path, struct stat *restrict status) {
    REAL("lstat", int, const char *restrict, struct stat *restrict);
    if (unseen == NULL || !file_name_ends_with(path, unseen)) return real(path, status);
    errno = EIO;
    return -1;
}

static RenderOptions options_for(const char *directory) {
    return (RenderOptions){.width = 96, .height = 64, .last = -1, .jobs = 2, .directory = directory};
}

static bool draw(const RenderOptions *options, int frames, Error *error) {
    OWN(Trajectory) *run = run_make("engine", frames);
    const bool done = render_sequence((const Trajectory *[]){run}, 1, options, NULL, NULL, error);
    return done;
}

TEST(interrupted_calls_are_continued) {
    const char *whole = printed("%s", temporary_path("whole"));
    RenderOptions options = options_for(whole);
    assert_ok(draw(&options, FRAMES, &error), error);
    options = options_for(temporary_path("interrupted"));
    interrupting = true;
    const bool done = draw(&options, FRAMES, &error);
    interrupting = false;
    assert_ok(done, error);
    assert_same_folder(whole, options.directory);
}

/* Each is left over by a call that ends well otherwise. */
TEST(what_cannot_be_removed_is_an_error) {
    static const struct {
        const char *ending;
        int frames; /* of a second call */
    } cases[] = {{"manifest.json.part", FRAMES}, {"manifest.json", FRAMES - 1}, {"frame_000005.png", FRAMES - 1}};
    RenderOptions options = options_for(temporary_path("left"));
    assert_ok(draw(&options, FRAMES, &error), error);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        undeletable = cases[i].ending;
        assert_false(draw(&options, cases[i].frames, &error));
        undeletable = NULL;
        assert_error(error, ERROR_SYSTEM, cases[i].ending);
        assert_error(error, ERROR_SYSTEM, "error: cannot be removed: Input/output error");
        error = (Error){0};
        assert_ok(draw(&options, FRAMES, &error), error);
    }
}

/* The system is to blame, not the file. */
TEST(what_cannot_be_inspected_is_an_error) {
    static const char *const endings[] = {"manifest.json", "manifest.json.part"};
    RenderOptions options = options_for(temporary_path("unseen"));
    for (int i = 0; i < 2; i++) {
        error = (Error){0};
        unseen = endings[i];
        assert_false(draw(&options, FRAMES, &error));
        unseen = NULL;
        assert_error(error, ERROR_SYSTEM, endings[i]);
        assert_error(error, ERROR_SYSTEM, "Input/output error");
    }
}

RUN_TESTS(NULL, NULL)

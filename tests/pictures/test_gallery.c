/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Redraws the pictures of golden/gallery, one of every style, the dark ones by EGL: the pixels must be equal. A
   picture that differs is written to actual_NAME.png in the working directory of the test. Given a folder like
   golden/, the program writes the pictures of its runs into its gallery/, as `golden/renew` does. */
#include "made.h"

#include "pixels/built_contexts.h"
#include "regression/image_compare.h"
#include "mesa.h"
#include "pictures/render_internal.h"

#include <limits.h>

static const char *golden = SOURCE_DIR "/golden"; /* with gallery/ and trajectories/ */
enum { WIDTH = 960, HEIGHT = 540, NAME_SIZE = 64 };

static const char *const near_pair[] = {"trajectories/stack-engine", "gallery/stack-momentum", NULL};
static const char *const pyramids[] = {"trajectories/pyramid_settled-engine", "trajectories/pyramid_settled-pair-net",
                                       NULL};
static const char *const six[] = {"trajectories/stack-engine",
                                  "trajectories/stack-pair-net",
                                  "gallery/stack-momentum",
                                  "gallery/stack-contact-net",
                                  "gallery/stack-interior",
                                  "gallery/stack-reference",
                                  NULL};
static const char *const three[] = {"gallery/stack-reference", "trajectories/stack-engine", "gallery/stack-momentum",
                                    NULL};
/* By other engines: scenes/engines. */
static const char *const stacks[] = {"trajectories/stack-engine", "gallery/stack-chipmunk", "gallery/stack-box2d",
                                     NULL};
static const char *const engines[] = {"trajectories/pyramid-engine", "gallery/pyramid-chipmunk",
                                      "gallery/pyramid-box2d", NULL};
static const char *const one[] = {"trajectories/pyramid-engine", NULL};

#define STORED(frame) \
    { MOMENT_STORED, frame, 0, 1, 1 }
#define SLOW \
    { MOMENT_BETWEEN, 33, 2, 4, 4 }

/* Each in both themes, unless one is given. */
static const struct {
    const char *name;
    const char *const *runs;
    Moment moment;
    RenderLook look;
    bool dark;
} entries[] = {
    {"split", near_pair, STORED(40), {0}, true},
    {"split_six", six, STORED(30), {0}, false},
    {"overlay_six", six, STORED(40), {.compare = LOOK_OVERLAY, .show = SHOW_TIMELINE}, true},
    {"overlay", three, STORED(48), {.compare = LOOK_OVERLAY}, true},
    {"difference", near_pair, STORED(44), {.compare = LOOK_DIFFERENCE}, true},
    {"ghosts", near_pair, STORED(40), {.show = SHOW_GHOSTS}, true},
    {"distance", pyramids, STORED(20), {.show = SHOW_DISTANCE}, true},
    {"trails", near_pair, STORED(52), {.show = SHOW_TRAILS}, true},
    {"contacts", one, STORED(40), {.show = SHOW_CONTACTS}, false},
    {"impulses", near_pair, STORED(35), {.camera = LOOK_BOMB, .show = SHOW_CONTACTS | SHOW_IMPULSES}, true},
    {"modes", three, STORED(36), {.show = SHOW_MODES, .view = {0, 5, 8, 11}}, true},
    {"velocities", near_pair, STORED(36), {.show = SHOW_VELOCITIES}, true},
    {"timeline", three, STORED(44), {.show = SHOW_TIMELINE | SHOW_GHOSTS}, true},
    {"timeline_six", six, STORED(44), {.show = SHOW_TIMELINE}, false},
    {"camera_bomb", near_pair, STORED(34), {.camera = LOOK_BOMB, .show = SHOW_TRAILS}, false},
    {"camera_divergence",
     near_pair,
     STORED(37),
     {.camera = LOOK_DIVERGENCE, .show = SHOW_GHOSTS | SHOW_DISTANCE},
     false},
    {"slow_motion", near_pair, SLOW, {.show = SHOW_TRAILS | SHOW_TIMELINE}, false},
    {"all", near_pair, STORED(36), {.show = 127, .costs = {"3.8 \xC2\xB5s a step", "8.3 \xC2\xB5s a step"}}, true},
    {"engines_stack", stacks, STORED(60), {0}, false},
    {"engines_pyramid", engines, STORED(40), {0}, false},
    {"title", three, {MOMENT_TITLE, 0, 0, 1, 1}, {0}, true},
    {"end", three, {MOMENT_END, 75, 0, 1, 1}, {0}, true},
};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

typedef struct Runs {
    Trajectory *owned[RENDER_PANELS_MAX];
    const Trajectory *panels[RENDER_PANELS_MAX];
    int count;
} Runs;

static Runs read_runs(const char *const *names) {
    Runs runs = {0};
    for (; names[runs.count] != NULL; runs.count++) {
        runs.panels[runs.count] = runs.owned[runs.count] =
            trajectory_of(printed("%s/%s.npz", golden, names[runs.count]));
    }
    return runs;
}

static Image *draw(int i, bool dark, ContextChoice context) {
    Error error = {0};
    Runs runs = read_runs(entries[i].runs);
    RenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .context = context, .look = entries[i].look, .describe = method_describe};
    if (dark) options.look.theme = LOOK_DARK;
    Renderer *renderer = renderer_create(runs.panels, runs.count, &options, &error);
    assert_ok(renderer != NULL, error);
    Image *image = image_sized(WIDTH, HEIGHT);
    const bool *changed;
    assert_ok(renderer_draw_next(renderer, entries[i].moment, image, &changed, &error), error);
    renderer_destroy(renderer);
    for (int run = 0; run < runs.count; run++) trajectory_destroy(runs.owned[run]);
    return image;
}

static void name_entry(char name[NAME_SIZE], int i, bool dark) {
    snprintf(name, NAME_SIZE, "%s%s", entries[i].name, dark ? "_dark" : "");
}

static bool is_equal(const Image *expected, int i, bool dark, ContextChoice context) {
    char name[NAME_SIZE], path[PATH_MAX];
    Error error = {0};
    ImageDifference difference;
    OWN(Image) *actual = draw(i, dark, context);
    image_compare_masked(expected, actual, NULL, 0, &difference);
    name_entry(name, i, dark);
    snprintf(path, sizeof path, "actual_%s.png", name);
    if (!difference.equal) {
        image_write_png(actual, path, NULL, 0, &error);
        print_error("%s: %lld pixels differ; see %s\n", name, (long long)difference.pixels, path);
    }
    return difference.equal;
}

TEST(the_gallery_is_drawn_again) {
    int different = 0;
    for (int i = 0; i < ENTRIES; i++)
        for (int dark = 0; dark <= (entries[i].dark ? 1 : 0); dark++) {
            char name[NAME_SIZE], path[PATH_MAX];
            name_entry(name, i, dark);
            snprintf(path, sizeof path, "%s/gallery/%s.png", golden, name);
            OWN(Image) *expected = image_of(path);
            different += !is_equal(expected, i, dark, built_context(dark ? CONTEXT_EGL : CONTEXT_OSMESA));
        }
    assert_int_equal(different, 0);
}

static void write_all(void) {
    for (int i = 0; i < ENTRIES; i++)
        for (int dark = 0; dark <= (entries[i].dark ? 1 : 0); dark++) {
            char name[NAME_SIZE], path[PATH_MAX];
            Error error = {0};
            name_entry(name, i, dark);
            snprintf(path, sizeof path, "%s/gallery/%s.png", golden, name);
            OWN(Image) *image = draw(i, dark, CONTEXT_AUTO);
            if (!image_write_png(image, path, NULL, 0, &error)) print_error("%s\n", error.message);
        }
}

int main(int argc, char **argv) {
    if (argc > 1) {
        golden = argv[1];
        write_all();
        return 0;
    }
    return _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The smallest possible changes, each with its verdict: the cause and the first frame. */
#include "made.h"

#include "base/file.h"
#include "pictures/mesa.h"
#include "pictures/render.h"
#include "pictures/runs.h"
#include "regression/regression.h"

#include <math.h>

/* The camera sees 10 m in a picture of 320 pixels, so a metre is at most 32 pixels, and a 512th of one a 16th of a
   pixel. */
enum { FRAMES = 6, WIDTH = 320, HEIGHT = 180, SEEN = 10 };
static const float SIXTEENTH = 1.0F / 512;

static char expected[256], actual[256], kept[256];
static Trajectory *run;

static const char *in(const char *folder, const char *name) {
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static const char *frame_path(const char *folder, int frame) {
    char name[32];
    snprintf(name, sizeof name, "frame_%06d.png", frame);
    return in(folder, name);
}

/* Writes the frames of the current run, and the run. */
static void render_into(const char *folder) {
    Error error = {0};
    const Trajectory *const panels[] = {run};
    const RenderOptions options = {.width = WIDTH, .height = HEIGHT, .last = -1, .jobs = 1, .directory = folder};
    assert_ok(render_sequence(panels, 1, &options, NULL, NULL, &error), error);
    assert_ok(trajectory_write(run, in(folder, "two_boxes-engine.npz"), &error), error);
}

static Trajectory *make_run(void) {
    Trajectory *made = run_make("engine", FRAMES);
    made->camera_center = vec2(0, 2);
    made->camera_size = vec2(SEEN, SEEN * HEIGHT / WIDTH);
    return made;
}

/* Rendered once, copied for each test. */
FIXTURE(draw_expected) {
    snprintf(expected, sizeof expected, "%s", temporary_path("expected"));
    snprintf(actual, sizeof actual, "%s", temporary_path("actual"));
    snprintf(kept, sizeof kept, "%s", temporary_path("kept"));
    run = make_run();
    render_into(kept);
    trajectory_destroy(run);
}

FIXTURE(make) {
    char command[2048];
    run = make_run();
    snprintf(command, sizeof command, "cp -r %s %s && cp -r %s %s", kept, actual, kept, expected);
    assert_int_equal(system(command), 0);
}

FIXTURE(remove_folders) {
    char command[1024];
    trajectory_destroy(run);
    snprintf(command, sizeof command, "rm -r %s %s", actual, expected);
    assert_int_equal(system(command), 0);
}

static Regression compared_by(RegressionOptions options) {
    Error error = {0};
    Regression regression;
    options.max_pixels = IMAGE_MAX_PIXELS;
    assert_ok(regression_run(&regression, expected, actual, &options, NULL, &error), error);
    assert_int_equal(regression.count, FRAMES);
    return regression;
}

static Regression compared(void) { return compared_by((RegressionOptions){0}); }

/* One letter per frame: (e)qual, (w)ithin tolerance, (r)enderer or (r)un, (p)hysics, (v)iew; and the overall verdict.
   */
static void assert_verdicts(const Regression *regression, const char *letters, const char *whole) {
    char found[FRAMES + 1] = "";
    for (int i = 0; i < FRAMES; i++) found[i] = frame_verdict(&regression->frames[i])[0];
    assert_string_equal(found, letters);
    assert_string_equal(regression_verdict(regression).text, whole);
    assert_true(regression_passed(regression) == (strcmp(whole, "equal") == 0));
}

static void remove_runs(void) {
    assert_int_equal(remove(in(expected, "two_boxes-engine.npz")), 0);
    assert_int_equal(remove(in(actual, "two_boxes-engine.npz")), 0);
}

static void remove_manifests(void) {
    assert_int_equal(remove(in(expected, "manifest.json")), 0);
    assert_int_equal(remove(in(actual, "manifest.json")), 0);
}

static void assert_cause(const Regression *regression, int cause, const char *words) {
    assert_true(cause < regression->cause_count);
    assert_string_equal(cause_words(&regression->causes[cause]).text, words);
}

static void assert_name(const Regression *regression, int frame, const char *name) {
    assert_non_null(regression->frames[frame].changes);
    assert_string_equal(region_name(regression->frames[frame].changes, 0).text, name);
}

/* A picture as from another renderer: new pixels, but the frame's original texts. */
static void replace_pixels(int frame, const Image *image) {
    static const char *const keys[] = {"Scene", "Frame", "State"};
    char values[3][512];
    ImageText texts[3];
    Error error = {0};
    const char *path = frame_path(actual, frame);
    for (int i = 0; i < 3; i++) {
        text_of_image(path, keys[i], values[i], sizeof values[i]);
        texts[i] = (ImageText){keys[i], values[i]};
    }
    assert_ok(image_write_png(image, path, texts, 3, &error), error);
}

static Image *drawn(int frame) {
    Error error = {0};
    const Trajectory *const panels[] = {run};
    const RenderOptions options = {.width = WIDTH, .height = HEIGHT};
    Renderer *renderer = renderer_create(panels, 1, &options, &error);
    Image *image = image_sized(WIDTH, HEIGHT);
    assert_ok(renderer != NULL && renderer_draw(renderer, frame, image, &error), error);
    renderer_destroy(renderer);
    return image;
}

TEST_WITH(nothing_changed, make, remove_folders) {
    Regression regression = compared();
    assert_verdicts(&regression, "eeeeee", "equal");
    assert_string_equal(regression_begin(&regression).text, "");
    regression_free(&regression);
}

TEST_WITH(a_box_drawn_a_sixteenth_of_a_pixel_aside, make, remove_folders) {
    run_position(run, 3, FIRST_BOX)->x += SIXTEENTH;
    Image *image = drawn(3);
    replace_pixels(3, image);
    Regression regression = compared();
    assert_verdicts(&regression, "eeeree", "renderer changed");
    assert_string_equal(regression_begin(&regression).text, "renderer changed first in frame_000003.png");
    assert_int_equal(regression.cause_count, 1);
    const Change *change = &regression.frames[3].changes->list[0];
    assert_true(change->kind == CHANGE_OTHER && change->body == FIRST_BOX);
    assert_string_equal(cause_words(&regression.causes[0]).text, "frame 3: body 1 changed");
    image_destroy(image);
    regression_free(&regression);
}

TEST_WITH(a_box_moved_a_sixteenth_of_a_pixel, make, remove_folders) {
    run_position(run, 3, FIRST_BOX)->x += SIXTEENTH;
    render_into(actual);
    Regression regression = compared();
    assert_verdicts(&regression, "eeepee", "physics changed");
    assert_int_equal(regression.frames[3].pixels, PIXELS_DIFFER);
    assert_int_equal(regression.runs[0].difference.frame, 3);
    assert_int_equal(regression.runs[0].difference.body, FIRST_BOX);
    assert_int_equal(regression.cause_count, 1);
    assert_cause(&regression, 0, "frame 3: states differ, body 1 first");
    assert_name(&regression, 3, "body 1 moved 0.06 px right");
    regression_free(&regression);
    /* Without runs, the pictures' texts give the frame and the panel, but no body. */
    remove_runs();
    regression = compared();
    assert_verdicts(&regression, "eeepee", "physics changed");
    assert_cause(&regression, 0, "frame 3: states differ in panel 1");
    assert_name(&regression, 3, "noise along edges");
    assert_string_equal(regression_begin(&regression).text, "");
    regression_free(&regression);
    /* A picture by itself says it in its own words, and nowhere else. */
    const RegressionOptions options = {.max_pixels = IMAGE_MAX_PIXELS};
    assert_ok(regression_run(&regression, frame_path(expected, 3), frame_path(actual, 3), &options, NULL, &error),
              error);
    assert_string_equal(regression_verdict(&regression).text, "physics changed");
    assert_non_null(strstr(case_words(&regression.frames[0]).text, "states differ in panel 1"));
    assert_true(regression.cause_count == 0 && regression_begin(&regression).text[0] == '\0');
    regression_free(&regression);
}

/* A frame passes if it is within all limits that are given: states by those of poses, or else by those of pixels. */
TEST_WITH(limits_that_are_given_decide, make, remove_folders) {
    static const struct {
        PoseTolerance poses;
        unsigned given;
        bool runs, passes;
        const char *frames;
    } cases[] = {
        {{0}, 0, true, false, "eeepee"},
        {{0}, LIMIT_TOLERANCE, true, false, "eeewee"}, /* but the run differs */
        {{.given = true, .distance = 0.01, .angle = INFINITY}, LIMIT_BEYOND, true, true, "eeewee"},
        {{.given = true, .distance = 0.01, .angle = INFINITY}, 0, true, false, "eeepee"}, /* its pixels */
        {{.given = true, .distance = 0.001, .angle = INFINITY}, LIMIT_BEYOND, true, false, "eeepee"},
        {{0}, LIMIT_TOLERANCE, false, true, "eeewee"},
        {{0}, LIMIT_BEYOND, false, true, "eeewee"},
    };
    run_position(run, 3, FIRST_BOX)->x += SIXTEENTH;
    render_into(actual);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (!cases[i].runs && cases[i - 1].runs) remove_runs();
        const Tolerance limits = {.given = cases[i].given,
                                  .tolerance = cases[i].given == LIMIT_TOLERANCE ? 255 : 0,
                                  .beyond = {cases[i].given == LIMIT_BEYOND, false}};
        Regression regression = compared_by((RegressionOptions){.tolerance = limits, .poses = cases[i].poses});
        const bool differs = cases[i].frames[3] == 'p';
        assert_verdicts(&regression, cases[i].frames, cases[i].passes ? "equal" : "physics changed");
        assert_true(regression.failed == differs && regression.by_verdict[PIXELS_DIFFER] == differs);
        assert_int_equal(regression.by_verdict[PIXELS_WITHIN], !differs);
        assert_int_equal(regression.cause_count, differs);
        regression_free(&regression);
    }
}

/* One channel of one pixel of the caption differs by one. */
TEST_WITH(one_pixel_of_a_label, make, remove_folders) {
    Image *image = drawn(4);
    uint8_t *pixel = image->pixels + (12 * WIDTH + 20) * 4;
    pixel[1] = (uint8_t)(pixel[1] > 0 ? pixel[1] - 1 : 1);
    replace_pixels(4, image);
    Regression regression = compared();
    assert_verdicts(&regression, "eeeere", "renderer changed");
    const ImageDifference *difference = &regression.frames[4].difference;
    assert_true(difference->pixels == 1 && difference->largest == 1);
    assert_true(difference->first_x == 20 && difference->first_y == 12);
    image_destroy(image);
    regression_free(&regression);
}

/* A cause has one line, with the frames that it covers. */
TEST_WITH(causes_of_several_frames, make, remove_folders) {
    static const int frames[] = {1, 2, 3, 5};
    for (int i = 0; i < 4; i++) {
        Vec2 *box = run_position(run, frames[i], SECOND_BOX), old = *box;
        box->y += 2.0F * (float)(i + 1) / 32;
        Image *image = drawn(frames[i]);
        if (frames[i] == 2) memset(image->pixels + 4 * 20 * WIDTH, 0x70, 40); /* above the panel is the page */
        replace_pixels(frames[i], image);
        image_destroy(image);
        *box = old;
    }
    Regression regression = compared();
    assert_verdicts(&regression, "errrer", "renderer changed");
    assert_cause(&regression, 0, "frames 1 to 3, 5: body 2 changed");
    assert_name(&regression, 1, "body 2 changed, and 1 more change"); /* the background where it now is */
    regression_free(&regression);
}

/* A run that has not drawn the pictures gives no names. */
TEST_WITH(a_run_of_other_pictures, make, remove_folders) {
    run_position(run, 3, FIRST_BOX)->x += 1;
    Image *image = drawn(3);
    replace_pixels(3, image);
    assert_ok(trajectory_write(run, in(actual, "two_boxes-engine.npz"), &error), error);
    Regression regression = compared();
    assert_name(&regression, 3, "");
    assert_cause(&regression, 0, "frame 3: states differ, body 1 first");
    image_destroy(image);
    regression_free(&regression);
}

TEST_WITH(two_frames_swapped, make, remove_folders) {
    char second[512], third[512];
    snprintf(second, sizeof second, "%s", frame_path(actual, 2));
    snprintf(third, sizeof third, "%s", frame_path(actual, 3));
    const char *aside = in(actual, "aside");
    assert_true(rename(second, aside) == 0 && rename(third, second) == 0 && rename(aside, third) == 0);
    Regression regression = compared();
    assert_verdicts(&regression, "eeppee", "physics changed");
    regression_free(&regression);
}

/* Not visible in any pixel; detected by the run. */
TEST_WITH(the_last_bit_of_one_body, make, remove_folders) {
    float *angle = run_angle(run, 4, SECOND_BOX);
    *angle = nextafterf(*angle, 10);
    assert_ok(trajectory_write(run, in(actual, "two_boxes-engine.npz"), &error), error);
    Regression regression = compared();
    assert_verdicts(&regression, "eeeepe", "physics changed");
    assert_int_equal(regression.frames[4].pixels, PIXELS_EQUAL);
    assert_int_equal(regression.runs[0].difference.frame, 4);
    assert_int_equal(regression.runs[0].difference.body, SECOND_BOX);
    assert_non_null(strstr(regression_begin(&regression).text,
                           "physics changed first in two_boxes-engine.npz: from frame 4, body 2"));
    regression_free(&regression);
    /* The texts of its frames show it too. */
    render_into(actual);
    remove_runs();
    regression = compared();
    assert_verdicts(&regression, "eeeepe", "physics changed");
    assert_int_equal(regression.frames[4].pixels, PIXELS_EQUAL);
    regression_free(&regression);
}

TEST_WITH(both_at_once, make, remove_folders) {
    run_position(run, 5, FIRST_BOX)->y += 1;
    render_into(actual);
    Image *image = drawn(1);
    image->pixels[0] ^= 1;
    replace_pixels(1, image);
    Regression regression = compared();
    assert_verdicts(&regression, "ereeep", "physics and renderer changed");
    assert_non_null(strstr(regression_begin(&regression).text, "\nrenderer changed first in frame_000001.png"));
    image_destroy(image);
    regression_free(&regression);
}

/* A run of another length differs from its end on, a run of other bodies everywhere. */
TEST_WITH(other_runs_beside_the_frames, make, remove_folders) {
    Trajectory *other = run_make("engine", 4);
    assert_ok(trajectory_write(other, in(actual, "two_boxes-engine.npz"), &error), error);
    Regression regression = compared();
    assert_verdicts(&regression, "eeeepp", "physics changed");
    regression_free(&regression);
    other->size[FIRST_BOX].x = 3;
    assert_ok(trajectory_write(other, in(actual, "two_boxes-engine.npz"), &error), error);
    regression = compared();
    assert_verdicts(&regression, "pppppp", "physics changed");
    trajectory_destroy(other);
    regression_free(&regression);
}

/* If most bodies leave where they start, their motion moves the camera of frame 0; the renderer has not changed. */
TEST_WITH(a_camera_that_follows_the_run, make, remove_folders) {
    run->camera_size = vec2(0, 0);
    render_into(expected);
    for (int frame = 1; frame < FRAMES; frame++)
        for (int body = FIRST_BOX; body <= SECOND_BOX; body++) run_position(run, frame, body)->y += 30;
    render_into(actual);
    Regression regression = compared();
    assert_int_equal(regression.by_verdict[PIXELS_DIFFER], FRAMES);
    assert_verdicts(&regression, "vppppp", "physics changed");
    assert_int_equal(regression.frames[0].states, STATES_DIFFER_ELSEWHERE);
    assert_int_equal(regression.runs[0].difference.frame, 1);
    /* The view, higher and so in a narrower panel, is the first cause, of all frames; the states are the second, of all
       others. */
    assert_int_equal(regression.cause_count, 2);
    assert_true(regression.causes[0].of_view && regression.causes[0].count == FRAMES);
    assert_non_null(strstr(cause_words(&regression.causes[0]).text, "frames 0 to 5: the place of panel 1 differs: "));
    assert_string_equal(cause_words(&regression.causes[1]).text, "frames 1 to 5: states differ, body 1 first");
    regression_free(&regression);
    remove_runs();
    remove_manifests();
    regression = compared();
    assert_verdicts(&regression, "rppppp", "physics changed");
    assert_string_equal(frame_verdict(&regression.frames[0]), "run changed");
    assert_int_equal(regression.frames[0].states, STATES_DIFFER_ELSEWHERE);
    assert_string_equal(cause_words(&regression.causes[regression.cause_count - 1]).text,
                        "frames 1 to 5: states differ in panel 1");
    regression_free(&regression);
}

RUN_TESTS(draw_expected, NULL)

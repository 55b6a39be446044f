/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The manifest describes what was drawn, and an interrupted sequence is resumed to the same bytes as an
   uninterrupted one. */
#include "made.h"

#include "base/hash.h"
#include "files.h"
#include "mesa.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "runs.h"
#include "sanitized.h"

#include <jansson.h>
#include <sys/stat.h>

enum { FRAMES = 12, PICTURES = FRAMES + 2 * 11 + 3, WIDTH = 160, HEIGHT = 90 };

static Trajectory *runs[2];
static const Trajectory *panels[2];
static char whole[256]; /* folder of an uninterrupted sequence */

/* The impact is in step 5, and everything is in slow motion; three pictures hold the last frame. */
static RenderOptions options_for(const char *directory) {
    return (RenderOptions){
        .width = WIDTH, .height = HEIGHT, .last = -1, .jobs = 1, .directory = directory, .slow = 3, .hold = 0.05};
}

FIXTURE(make) {
    TrajectoryContact contact = {.a = FIRST_BOX, .b = BOMB_BODY, .normal = {0, 1}};
    panels[0] = runs[0] = run_make("engine", FRAMES);
    panels[1] = runs[1] = run_make("pair-net:network=nets/small.npz", FRAMES - 3);
    add_contact(runs[0], 5, contact);
    trajectory_end_contacts(runs[0]);
    snprintf(whole, sizeof whole, "%s", temporary_path("whole"));
    RenderOptions options = options_for(whole);
    assert_ok(render_sequence(panels, 2, &options, NULL, NULL, &error), error);
}

FIXTURE(destroy) {
    trajectory_destroy(runs[0]);
    trajectory_destroy(runs[1]);
}

static const char *manifest_of(const char *directory) {
    static char path[512];
    snprintf(path, sizeof path, "%s/manifest.json", directory);
    return path;
}

/* Resumes in a folder, which must then equal the uninterrupted one; returns the number of pictures kept. */
static int resume(const char *directory, char why[256]) {
    Error error = {0};
    RenderResult result;
    RenderOptions options = options_for(directory);
    options.resume = true;
    assert_ok(render_sequence(panels, 2, &options, &result, NULL, &error), error);
    assert_true(result.first == 0 && result.last == PICTURES - 1);
    free(result.hashes);
    if (why != NULL) memcpy(why, result.why, sizeof result.why);
    assert_same_folder(whole, directory);
    return result.kept;
}

/* A copy of the whole sequence. */
static const char *copied(const char *name) {
    Error error = {0};
    const char *directory = temporary_path(name);
    assert_ok(file_make_directory(directory, &error), error);
    for (int i = -1; i < PICTURES; i++) {
        size_t size;
        FREED char *data = read_whole(i < 0 ? manifest_of(whole) : frame_path(whole, i), &size);
        const char *to = printed("%s", i < 0 ? manifest_of(directory) : frame_path(directory, i));
        assert_ok(file_write_soon(to, data, size, &error), error);
    }
    return directory;
}

static uint64_t hash_of(const json_t *value) {
    assert_int_equal(json_string_length(value), 16);
    return strtoull(json_string_value(value), NULL, 16);
}

static void check_states(const json_t *states, int frame) {
    assert_int_equal(json_array_size(states), 2);
    for (size_t panel = 0; panel < 2; panel++) {
        int last = panels[panel]->frames - 1;
        uint64_t hash = trajectory_frame_hash(panels[panel], frame < last ? frame : last);
        assert_true(hash_of(json_array_get(states, panel)) == hash);
    }
}

static void check_picture(const json_t *item, int index) {
    size_t size;
    const char *path = frame_path(whole, index), *part = json_string_value(json_object_get(item, "part"));
    int frame = (int)json_integer_value(json_object_get(item, "frame"));
    char *data = read_whole(path, &size), text[64] = "";
    OWN(Image) *image = image_of(path);
    assert_true(hash_of(json_object_get(item, "pixels")) == image_hash(image));
    assert_true(hash_of(json_object_get(item, "file_hash")) == hash_xxh3(data, size));
    assert_non_null(strstr(path, json_string_value(json_object_get(item, "file"))));
    assert_true(json_is_integer(json_object_get(item, "frame")));
    assert_in_range(frame, 0, FRAMES - 1);
    check_states(json_object_get(item, "states"), frame);
    /* The picture's own texts state the same. */
    text_of_image(path, "Frame", text, sizeof text);
    assert_int_equal(atoi(text), frame);
    text_of_image(path, "Part", text, sizeof text);
    assert_string_equal(text, part != NULL ? part : "");
    free(data);
}

TEST(a_manifest_tells_of_every_picture) {
    json_error_t failure;
    json_t *manifest = json_load_file(manifest_of(whole), JSON_REJECT_DUPLICATES, &failure);
    if (manifest == NULL) fail_msg("manifest.json:%d:%d: %s", failure.line, failure.column, failure.text);
    const json_t *pictures = json_object_get(manifest, "pictures");
    assert_int_equal(json_array_size(pictures), PICTURES);
    FREED char *text = text_of(manifest_of(whole));
    assert_null(strstr(text, temporary_folder)); /* no place is named */
    for (int i = 0; i < PICTURES; i++) check_picture(json_array_get(pictures, (size_t)i), i);
    json_decref(manifest);
}

/* The colour of a pixel, 0xRRGGBB. */
static uint32_t colour_at(const Image *image, double x, double y) {
    assert_true(x >= 0 && x < image->width && y >= 0 && y < image->height);
    const uint8_t *pixel = image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
    return (uint32_t)pixel[0] << 16 | (uint32_t)pixel[1] << 8 | pixel[2];
}

static double number_of(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

/* The pixel of a point in a panel, by the manifest alone, has this colour. */
static void assert_colour(const json_t *panel, const json_t *camera, const Image *image, Vec2 at, uint32_t colour) {
    const json_t *rect = json_object_get(panel, "rectangle");
    const double x = json_number_value(json_array_get(rect, 0)) + number_of(camera, "left") +
                     number_of(camera, "scale") * (double)at.x;
    const double y = json_number_value(json_array_get(rect, 1)) + number_of(camera, "top") -
                     number_of(camera, "scale") * (double)at.y;
    assert_int_equal(colour_at(image, x, y), colour);
}

/* A box has the colour of its run's method; the bomb has a light dot in its centre. */
static void check_bodies(const json_t *view_panels, const json_t *picture, const Image *image) {
    static const uint32_t fills[2] = {0x0072B2, 0xE69F00}; /* of engine and pair-net */
    const Theme *theme = theme_get(LOOK_LIGHT);
    const json_t *moving = json_object_get(picture, "camera");
    const int frame = (int)number_of(picture, "frame");
    for (int run = 0; run < 2; run++) {
        const json_t *panel = json_array_get(view_panels, (size_t)run);
        const int shown = frame < runs[run]->frames ? frame : runs[run]->frames - 1;
        if (moving == NULL)
            assert_colour(panel, panel, image, *run_position(runs[run], shown, SECOND_BOX), fills[run]);
        else if (shown >= 2)
            assert_colour(panel, moving, image, *run_position(runs[run], shown, BOMB_BODY), theme->bomb.band);
    }
}

static void check_view(const char *directory, bool moving) {
    json_t *manifest = json_load_file(manifest_of(directory), JSON_REJECT_DUPLICATES, NULL);
    const json_t *all = json_object_get(json_object_get(manifest, "view"), "panels");
    const json_t *pictures = json_object_get(manifest, "pictures");
    assert_int_equal(json_array_size(all), 2);
    for (size_t i = 0; i < json_array_size(pictures); i++) {
        const json_t *picture = json_array_get(pictures, i);
        assert_int_equal(json_object_get(picture, "camera") != NULL, moving);
        if (strcmp(json_string_value(json_object_get(picture, "shows")), "frame") != 0) continue;
        OWN(Image) *image = image_of(frame_path(directory, (int)i));
        check_bodies(all, picture, image);
    }
    json_decref(manifest);
}

TEST(the_view_leads_to_the_bodies) {
    RenderOptions options = options_for(temporary_path("moving"));
    options.look.camera = LOOK_BOMB;
    options.width = 4 * WIDTH, options.height = 4 * HEIGHT;
    check_view(whole, false);
    assert_ok(render_sequence(panels, 2, &options, NULL, NULL, &error), error);
    check_view(options.directory, true);
    options.resume = true; /* the lines with a camera are recalled, too */
    RenderResult result;
    assert_ok(render_sequence(panels, 2, &options, &result, NULL, &error), error);
    assert_int_equal(result.kept, PICTURES);
    free(result.hashes);
}

TEST(the_view_names_the_files_of_the_runs) {
    RenderOptions options = options_for(temporary_path("named"));
    options.look.show = SHOW_GHOSTS;
    assert_ok(render_sequence(panels, 2, &options, NULL, NULL, &error), error);
    json_t *manifest = json_load_file(manifest_of(options.directory), JSON_REJECT_DUPLICATES, NULL);
    const json_t *panel = json_array_get(json_object_get(json_object_get(manifest, "view"), "panels"), 1);
    const json_t *names = json_object_get(panel, "runs");
    assert_int_equal(json_array_size(names), 2);
    assert_string_equal(json_string_value(json_array_get(names, 0)), "two_boxes-pair-net_network=small.npz.npz");
    assert_string_equal(json_string_value(json_array_get(names, 1)), "two_boxes-engine.npz");
    json_decref(manifest);
}

TEST(nothing_is_drawn_twice) {
    char why[256];
    assert_int_equal(resume(copied("again"), why), PICTURES);
    assert_string_equal(why, "");
    assert_int_equal(resume(temporary_path("fresh"), why), 0);
    assert_non_null(strstr(why, "fresh/manifest.json: error: cannot open"));
}

TEST(what_is_missing_or_damaged_is_drawn_again) {
    size_t size, other_size;
    const char *directory = copied("damaged");
    char *data = read_whole(frame_path(directory, 4), &size),
         *other = read_whole(frame_path(directory, 5), &other_size);
    assert_int_equal(unlink(frame_path(directory, 0)), 0);
    write_bytes(frame_path(directory, 1), data, size / 2);    /* truncated */
    write_bytes(frame_path(directory, 2), data, 0);           /* empty */
    write_bytes(frame_path(directory, 4), other, other_size); /* exchanged */
    write_bytes(frame_path(directory, 5), data, size);
    data[size / 2] ^= 1;
    write_bytes(frame_path(directory, 7), data, size); /* one bit changed */
    other = realloc(other, other_size + 1);
    write_bytes(frame_path(directory, PICTURES - 1), other, other_size + 1); /* one byte appended */
    assert_int_equal(unlink(frame_path(directory, 9)), 0);
    free(data);
    free(other);
    assert_int_equal(resume(directory, NULL), PICTURES - 8);
}

static bool stop_at_6(void *context, double done, double total) {
    (void)context, (void)total;
    return done < 6;
}

/* A power failure cuts a write: the last line may be partial, and so may pictures. */
TEST(every_cut_of_the_journal_is_survived) {
    RenderOptions options = options_for(temporary_path("cut"));
    assert_false(render_sequence(panels, 2, &options, NULL, &(Progress){stop_at_6, NULL}, &error));
    const char *journal = printed("%s.part", manifest_of(options.directory));
    size_t size;
    FREED char *text = read_whole(journal, &size);
    /* In the head, in the first line, in and after the last. */
    const size_t cuts[] = {0,        50,  (size_t)(strstr(text, "{\"file\"") - text) + 30, size - 90, size - 20,
                           size - 1, size};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i += (size_t)sampled(3)) {
        assert_int_equal(unlink(manifest_of(options.directory)), i == 0 ? -1 : 0);
        write_bytes(journal, text, cuts[i]);
        resume(options.directory, NULL);
    }
}

/* Pictures of another sequence are not kept. */
TEST(another_sequence_is_redrawn) {
    static const struct {
        RenderOptions options;
        const char *why;
    } others[] = {
        {{.width = 320, .height = HEIGHT, .slow = 3, .hold = 0.05}, "manifest.json:4 differs: other runs"},
        {{.width = WIDTH, .height = HEIGHT, .slow = 3}, "differs: other runs"},
        {{.width = WIDTH, .height = HEIGHT, .slow = 3, .hold = 0.05, .small = true}, "manifest.json:6 differs"},
        {{.width = WIDTH, .height = HEIGHT, .slow = 3, .hold = 0.05, .title = "x"}, "manifest.json:7 differs"},
        {{.width = WIDTH, .height = HEIGHT, .slow = 3, .hold = 0.05, .notes = {"x"}}, "differs: other runs"}};
    char why[256];
    for (size_t i = 0; i < sizeof others / sizeof *others; i += (size_t)sampled(2)) {
        const char *name = printed("other%zu", i);
        RenderOptions options = others[i].options;
        options.directory = temporary_path(name);
        options.last = -1;
        options.jobs = 1;
        RenderResult result;
        assert_ok(render_sequence(panels, 2, &options, &result, NULL, &error), error);
        free(result.hashes);
        for (int k = PICTURES; k <= result.last; k++) unlink(frame_path(options.directory, k));
        assert_int_equal(resume(options.directory, why), 0);
        if (strstr(why, others[i].why) == NULL) fail_msg("\"%s\" lacks \"%s\"", why, others[i].why);
    }
}

/* One different bit of a run makes it another run, even if no picture shows it. */
TEST(another_run_is_redrawn) {
    const char *directory = copied("run");
    char why[256];
    runs[0]->velocity[2 * RUN_BODIES + FIRST_BOX].x = 1e-9F;
    RenderOptions options = options_for(directory);
    options.resume = true;
    RenderResult result;
    assert_ok(render_sequence(panels, 2, &options, &result, NULL, &error), error);
    assert_int_equal(result.kept, 0);
    free(result.hashes);
    runs[0]->velocity[2 * RUN_BODIES + FIRST_BOX].x = 0;
    assert_int_equal(resume(directory, why), 0);
    assert_non_null(strstr(why, "differs: other runs"));
}

static char *replaced(const char *text, const char *from, const char *to) {
    const char *at = strstr(text, from);
    char *result = malloc(strlen(text) + strlen(to) + 1);
    assert_non_null(at);
    sprintf(result, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return result;
}

/* Whatever a manifest contains, the pictures become correct. */
TEST(a_manifest_is_not_trusted) {
    static const char *const changes[][2] = {
        {"\"file\": \"frame_000003.png\"", "\"file\": \"frame_000004.png\""},
        {"\"file\": \"frame_000003.png\"", "\"file\": \"frame_999999999999999999999.png\""},
        {"\"file\": \"frame_000003.png\"", "\"file\": \"../frame_000003.png\""},
        {"\"frame\": 1,", "\"frame\": 2,"},
        {"\"pixels\": \"", "\"pixels\": \"0"},
        {"\"file_hash\": \"", "\"file_hash\": \"ABCDEF"},
        {"\"shows\": \"between\"", "\"shows\": \"frame\""},
        {"\n", "\n\n"},
    };
    size_t size;
    FREED char *text = read_whole(manifest_of(whole), &size);
    const char *directory = copied("changed");
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i += (size_t)sampled(3)) {
        char *changed = replaced(text, changes[i][0], changes[i][1]);
        bool ours = strncmp(changed, text, 12) == 0;
        write_bytes(manifest_of(directory), changed, strlen(changed));
        free(changed);
        if (ours) assert_true(resume(directory, NULL) < PICTURES);
    }
    FREED char *large = calloc(1, 1 << 20);
    memcpy(large, text, size);
    write_bytes(manifest_of(directory), large, 1 << 20);
    assert_int_equal(resume(directory, NULL), 0);
}

/* Files of other programs are not touched. */
TEST(files_that_are_not_manifests_stay) {
    static const char foreign[] = "{\"name\": \"my own\"}";
    RenderOptions options = options_for(copied("foreign"));
    for (int again = 0; again < 2; again++) {
        options.resume = again == 1;
        write_bytes(manifest_of(options.directory), foreign, sizeof foreign - 1);
        assert_refused(render_sequence(panels, 2, &options, NULL, NULL, &error),
                       "foreign/manifest.json: error: is not a manifest of twinbox");
        assert_file(manifest_of(options.directory), foreign);
    }
    assert_int_equal(unlink(manifest_of(options.directory)), 0);
    assert_int_equal(mkdir(manifest_of(options.directory), 0700), 0);
    assert_false(render_sequence(panels, 2, &options, NULL, NULL, &error));
    assert_int_equal(rmdir(manifest_of(options.directory)), 0);
    assert_int_equal(mkfifo(manifest_of(options.directory), 0600), 0);
    assert_false(render_sequence(panels, 2, &options, NULL, NULL, &error));
    assert_int_equal(unlink(manifest_of(options.directory)), 0);
    write_bytes(temporary_path("elsewhere.json"), foreign, sizeof foreign - 1);
    assert_int_equal(symlink("../elsewhere.json", manifest_of(options.directory)), 0);
    assert_false(render_sequence(panels, 2, &options, NULL, NULL, &error));
    assert_int_equal(count_files(options.directory, ".png"), PICTURES);
}

RUN_TESTS(make, destroy)

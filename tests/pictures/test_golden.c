/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Redraws the frames of golden/frames in each context that is built in, from golden/trajectories: SCENE_NNNNNN.png is frame NNNNNN
   of SCENE-engine.npz and SCENE-pair-net.npz side by side. The pixels must be equal. A picture that differs is
   written to actual_SCENE_NNNNNN_CONTEXT.png in the working directory of the test. */
#include "made.h"

#include "regression/compare.h"
#include "mesa.h"
#include "pictures/render.h"

#include <dirent.h>
#include <limits.h>

static const char FRAMES[] = SOURCE_DIR "/golden/frames", TRAJECTORIES[] = SOURCE_DIR "/golden/trajectories";
enum { PANELS = 2, DIGITS = 6 };

typedef struct Golden {
    char scene[256];
    int frame;
    Image *image;
    Trajectory *panels[PANELS];
} Golden;

/* "pyramid_settled_000120.png": scene and frame. False for any other file name. */
static bool parse_name(const char *file, Golden *golden) {
    size_t length = strlen(file), tail = 1 + DIGITS + strlen(".png");
    if (length <= tail || length - tail >= sizeof golden->scene) return false;
    const char *number = file + length - tail + 1;
    if (number[-1] != '_' || strcmp(number + DIGITS, ".png") != 0 || strspn(number, "0123456789") != DIGITS)
        return false;
    snprintf(golden->scene, sizeof golden->scene, "%.*s", (int)(length - tail), file);
    golden->frame = atoi(number);
    return true;
}

static void load(Golden *golden, const char *file) {
    static const char *const methods[PANELS] = {"engine", "pair-net"};
    char path[PATH_MAX];
    Error error = {0};
    snprintf(path, sizeof path, "%s/%s", FRAMES, file);
    assert_ok((golden->image = image_read_png(path, &error)) != NULL, error);
    for (int i = 0; i < PANELS; i++) {
        snprintf(path, sizeof path, "%s/%s-%s.npz", TRAJECTORIES, golden->scene, methods[i]);
        assert_ok((golden->panels[i] = trajectory_read(path, &error)) != NULL, error);
    }
}

static void unload(Golden *golden) {
    image_destroy(golden->image);
    for (int i = 0; i < PANELS; i++) trajectory_destroy(golden->panels[i]);
}

static Image *draw(const Golden *golden, ContextChoice context) {
    Error error = {0};
    RenderOptions options = {.width = golden->image->width,
                             .height = golden->image->height,
                             .context = context,
                             .describe = method_describe};
    const Trajectory *const panels[PANELS] = {golden->panels[0], golden->panels[1]};
    Renderer *renderer = renderer_create(panels, PANELS, &options, &error);
    assert_ok(renderer != NULL, error);
    Image *image = image_sized(options.width, options.height);
    assert_ok(renderer_draw(renderer, golden->frame, image, &error), error);
    renderer_destroy(renderer);
    return image;
}

/* Number of contexts in which the frame differs. */
static int compare(const Golden *golden) {
    int different = 0;
    for (int i = 0; context_kinds[i] != NULL; i++) {
        Image *actual = draw(golden, context_kinds[i]->choice);
        ImageDifference difference;
        image_compare(golden->image, actual, &difference);
        if (!difference.equal) {
            char path[PATH_MAX];
            Error error = {0};
            snprintf(path, sizeof path, "actual_%s_%06d_%s.png", golden->scene, golden->frame, context_kinds[i]->name);
            image_write_png(actual, path, NULL, 0, &error);
            print_error("%s, frame %d, %s: %lld pixels differ, by up to %d, the first at (%d, %d); see %s\n",
                        golden->scene, golden->frame, context_kinds[i]->name, (long long)difference.pixels,
                        difference.largest, difference.first_x, difference.first_y, path);
            different++;
        }
        image_destroy(actual);
    }
    return different;
}

TEST(golden_frames_are_drawn_again) {
    int frames = 0, different = 0;
    DIR *directory = opendir(FRAMES);
    if (directory == NULL) fail_msg("%s cannot be read", FRAMES);
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        Golden golden;
        if (entry->d_name[0] == '.') continue;
        if (!parse_name(entry->d_name, &golden)) fail_msg("%s/%s is no SCENE_NNNNNN.png", FRAMES, entry->d_name);
        load(&golden, entry->d_name);
        different += compare(&golden);
        unload(&golden);
        frames++;
    }
    closedir(directory);
    assert_int_equal(different, 0);
    if (frames == 0) fail_msg("there is no golden frame in %s", FRAMES);
}

RUN_TESTS(NULL, NULL)

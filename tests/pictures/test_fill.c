/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much of a panel the boxes fill by default: every scene of scenes/, 1 to 6 panels, pictures of all shapes. */
#include "made.h"

#include "pictures/pictures_internal.h"

#include <glob.h>

static const int sizes[][2] = {{1280, 720}, {1080, 1080}, {720, 1280}};
enum { SIZES = sizeof sizes / sizeof sizes[0], STATES_MAX = 20000, WILD_FRAMES = 120 };
static const double LEAST = 0.7;
/* A struck scene: its view steps back to this share of its scale, at most, and in steps of so many sides of what stands
   (runs/framing.c). */
static const double STEPPED_BACK = 0.7, STEP = 0.25;
static const double LARGEST = 20; /* m: a wider static body is the ground */

/* In pixels of a panel, y up. */
static void include_body(Extent *seen, const Camera *camera, const Trajectory *run, int frame, int body) {
    Extent all = extent_empty;
    extent_include(&all, run, frame, body);
    if (extent_is_empty(&all)) return;
    seen->left = fmin(seen->left, camera->left + camera->scale * all.left);
    seen->right = fmax(seen->right, camera->left + camera->scale * all.right);
    seen->top = fmax(seen->top, camera->scale * all.top - camera->top);
    seen->bottom = fmin(seen->bottom, camera->scale * all.bottom - camera->top);
}

/* The share of a panel's width or height, the larger, that the boxes and static bodies in view cover together, in any
   of the frames; from the ground, which is at 0 m or below, if they are in the air. */
static double share_filled(const Picture *picture, int first, int last, bool with_bomb) {
    const Trajectory *run = picture->runs[0];
    const Rect *panel = &picture->layout.panels[0];
    const double width = panel->right - panel->left, height = panel->bottom - panel->top;
    Extent seen = extent_empty;
    for (int frame = first; frame <= last; frame++)
        for (int body = 0; body < run->bodies; body++)
            if ((!run->fixed[body] || (double)run->size[body].x <= LARGEST) && (with_bomb || body != run->bomb))
                include_body(&seen, &picture->camera, run, frame, body);
    const double ground = fmin(-picture->camera.top, seen.bottom);
    if (ground >= -height) seen.bottom = ground;
    const double across = fmin(seen.right, width) - fmax(seen.left, 0);
    const double up = fmin(seen.top, 0) - fmax(seen.bottom, -height);
    return fmax(across / width, up / height);
}

static Trajectory *run_of_scene(const char *path) {
    OWN(Scene) *scene = scene_from(path);
    const int most = STATES_MAX / (scene->body_count + 1) + 2;
    if (scene->bomb.present && scene->bomb.frame + WILD_FRAMES < scene->frames)
        scene->frames = scene->bomb.frame + WILD_FRAMES;
    if (!scene->bomb.present && most < scene->frames) scene->frames = most;
    Trajectory *run = run_by(scene, "engine");
    return run;
}

/* At the start, and when the bomb strikes: a single box has fallen by then. A view that steps back is
   filled over the run. */
static int check_scene(const char *path) {
    OWN(Trajectory) *run = run_of_scene(path);
    const Trajectory *const runs[RENDER_PANELS_MAX] = {run, run, run, run, run, run};
    const int impact = trajectory_impact(run), struck = strstr(path, "/single.yaml") == NULL && impact > 0 ? impact : 0;
    int bare = 0;
    for (int i = 0; i < SIZES; i++)
        for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
            Error error = {0};
            Picture picture;
            assert_ok(picture_plan(&picture, runs, count, sizes[i][0], sizes[i][1], &error), error);
            const double start = share_filled(&picture, 0, 0, false),
                         later = share_filled(&picture, struck, struck, struck > 0);
            const double most = share_filled(&picture, 0, run->frames - 1, true), least = STEPPED_BACK * LEAST;
            if (fmin(start, later) >= LEAST || (fmin(start, later) >= least && most >= LEAST / (1 + STEP))) continue;
            print_error("%s, %d x %d, %d panels: %.2f at the start, %.2f struck, %.2f over the run\n",
                        path + sizeof SOURCE_DIR, sizes[i][0], sizes[i][1], count, start, later, most);
            bare++;
        }
    return bare;
}

static int check_all(const char *pattern) {
    glob_t found;
    int bare = 0;
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) bare += check_scene(found.gl_pathv[i]);
    globfree(&found);
    return bare;
}

TEST(every_scene_fills_its_panels) {
    assert_int_equal(check_all(SOURCE_DIR "/scenes/*.yaml") + check_all(SOURCE_DIR "/scenes/*/*.yaml"), 0);
}

RUN_TESTS(NULL, NULL)

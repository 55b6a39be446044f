/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 4: the three scenes with the bomb in flight, rendered, with the bomb's path drawn over them. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <math.h>
#include <string.h>

/* What each picture shows, m. */
static const double view_left = -8, view_bottom = -1, view_width = 16, view_height = 22.6;

/* On the page, mm; the scale is 39 pixels per metre in the PNG. */
static const double width = FIGURE_PAGE_WIDTH, height = 87, scale = 3.302, gap = 3.4, lowest = 1;

/* The renderer then has 39 pixels per metre, too. */
enum { RENDER_WIDTH = 1300, RENDER_HEIGHT = 1075 };

/* The run up to two thirds of the bomb's flight to its first touch. */
static Trajectory *run_part(const Scene *scene, Error *error) {
    EngineRun run;
    Method engine;
    if (!engine_run_begin(&run, scene, error)) return NULL;
    const bool touched = engine_run_to_touch(&run, error);
    engine_run_end(&run);
    if (!touched) return NULL;
    Scene part = *scene;
    part.frames = scene->bomb.frame + (run.frame - scene->bomb.frame) * 2 / 3;
    part.camera_center = vec2((float)(view_left + view_width / 2), (float)(view_bottom + view_height / 2));
    part.camera_size = vec2((float)view_width, (float)view_height);
    return method_parse(&engine, "engine", error) ? simulate(&part, &engine, NULL, error) : NULL;
}

/* The part of the last frame inside the figure's window. */
static Image *render_last(const Trajectory *run, Error *error) {
    const RenderOptions options = {.width = RENDER_WIDTH, .height = RENDER_HEIGHT};
    Picture picture;
    if (!picture_plan(&picture, &run, 1, options.width, options.height, error)) return NULL;
    const Rect *panel = &picture.layout.panels[0];
    const Camera *camera = &picture.camera;
    const int x0 = panel->left + (int)lrint(camera->left + camera->scale * view_left);
    const int y0 = panel->top + (int)lrint(camera->top - camera->scale * (view_bottom + view_height));
    const int columns = (int)lrint(camera->scale * view_width), rows = (int)lrint(camera->scale * view_height);
    if (x0 < panel->left || y0 < panel->top || x0 + columns > panel->right || y0 + rows > panel->bottom)
        return error_input(error, run->scene, "the picture does not show all of the figure's window"), NULL;
    Image *frame = image_create(options.width, options.height, error), *window = NULL;
    Renderer *renderer = frame != NULL ? renderer_create(&run, 1, &options, error) : NULL;
    if (renderer != NULL && renderer_draw(renderer, run->frames - 1, frame, error))
        window = image_create(columns, rows, error);
    for (int y = 0; window != NULL && y < rows; y++)
        memcpy(window->pixels + (size_t)y * (size_t)columns * 4,
               frame->pixels + ((size_t)(y0 + y) * (size_t)frame->width + (size_t)x0) * 4, (size_t)columns * 4);
    renderer_destroy(renderer);
    image_destroy(frame);
    return window;
}

/* Where the bomb came from and where it goes, at a distance from the bomb itself. */
static void draw_path(Sketch *sketch, const View *view, const Trajectory *run, int begin) {
    const Pen dashed = pen_line(BOMB.fill, 1.8, "(6,5)");
    const size_t first = trajectory_at(run, begin, run->bomb), last = trajectory_at(run, run->frames - 1, run->bomb);
    const Vec2 from = run->position[first], to = run->position[last], v = run->velocity[last];
    const Box start = box_make(from, run->size[run->bomb], run->angle[first]);
    const float clear = 0.8f, seconds = 0.12f, speed = hypotf(v.x, v.y), away = hypotf(to.x - from.x, to.y - from.y);
    sketch_box(sketch, view, &start, &dashed);
    if (away > clear) {
        Vec2 end = vec2_add(to, vec2_scale(clear / away, vec2_sub(from, to)));
        sketch_line(sketch, view_place(view, from), view_place(view, end), &dashed);
    }
    if (speed == 0) return;
    Vec2 tail = vec2_add(to, vec2_scale(clear / speed, v));
    sketch_arrow(sketch, view_place(view, tail), view_place(view, vec2_add(tail, vec2_scale(seconds, v))), ACCENT, 2);
}

static bool draw_scene(Sketch *sketch, int i, const Scene *scene, int *boxes, int *step, Error *error) {
    static const char *const titles[ILLUSTRATION_SCENES] = {"1  Single", "2  Stack", "3  Pyramid"};
    Trajectory *run = run_part(scene, error);
    if (run == NULL) return false;
    const double x = (width - 3 * scale * view_width - 2 * gap) / 2 + i * (scale * view_width + gap);
    const View view = {{x, lowest},
                       {x + scale * view_width, lowest + scale * view_height},
                       {view_left + view_width / 2, view_bottom + view_height / 2},
                       scale};
    const Vec2 v = run->velocity[trajectory_at(run, run->frames - 1, run->bomb)];
    *step = run->frames - 1;
    *boxes = 0;
    for (int k = 0; k < scene->body_count; k++) *boxes += !scene->bodies[k].fixed;
    Image *window = render_last(run, error);
    if (window != NULL) {
        const TextStyle heading = {8.5, TEXT_LEFT, INK, 0, false}, words = {7.5, TEXT_LEFT, INK_SOFT, 0, false};
        sketch_image(sketch, window, view.low, scale * view_width);
        draw_path(sketch, &view, run, scene->bomb.frame);
        sketch_text(sketch, (Point){view.low.x, height - 2.8}, &heading, "%s: %d %s", titles[i], *boxes,
                    *boxes == 1 ? "box" : "boxes");
        sketch_text(sketch, (Point){view.low.x, height - 7}, &words, "Step %d: bomb of %g kg at %.1f m/s", *step,
                    (double)scene->bomb.mass.value, (double)hypotf(v.x, v.y));
        sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
        if (i == 0) sketch_scale_bar(sketch, (Point){x + 2.5, lowest + 1.6}, view.scale, 5, "m", 7.5);
    }
    image_destroy(window);
    trajectory_destroy(run);
    return window != NULL;
}

static bool draw_scenes(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                        Error *error) {
    int steps[ILLUSTRATION_SCENES], boxes[ILLUSTRATION_SCENES];
    for (int i = 0; i < ILLUSTRATION_SCENES; i++)
        if (!draw_scene(sketch, i, scenes[i], &boxes[i], &steps[i], error)) return false;
    snprintf(
        caption, CAPTION_SIZE,
        "The three scenes at one scale, at two thirds of the bomb's flight to its first touch: %d box (single.yaml, "
        "step %d), a stack of %d (stack.yaml, step %d) and a pyramid of %d, still falling into place (pyramid.yaml, "
        "step %d). Dashed: the bomb's start. Arrow: its path in 0.12 s.",
        boxes[0], steps[0], boxes[1], steps[1], boxes[2], steps[2]);
    return true;
}

const Illustration illustration_scenes = {width, height, draw_scenes};

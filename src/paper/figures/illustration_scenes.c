/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 4: the three scenes with the bomb in flight, rendered, with the bomb's path drawn over them. */
#include "paper/figures/illustration_parts.h"
#include "paper/figures/engine_run.h"

#include "picture/picture.h"
#include "picture/style.h"
#include "render/render.h"

#include <stdio.h>
#include <string.h>

/* What each picture shows, m. */
static const double left = -8, bottom = -1, wide = 16, high = 22.6;

/* On the page, mm; the scale is 39 pixels per metre in the PNG. */
static const double width = FIGURE_PAGE_WIDTH, height = 87, scale = 3.302, gap = 3.4, low = 1;

/* The renderer then has 39 pixels per metre, too. */
enum { RENDER_WIDTH = 1300, RENDER_HEIGHT = 1075 };

static const char *const titles[ILLUSTRATION_SCENES] = {"1  Single", "2  Stack", "3  Pyramid"};

/* The part of a rendered frame inside the figure's window. */
static Image *cut_window(const Image *frame, const Picture *picture, Error *error) {
    const Rect *panel = &picture->layout.panels[0];
    const Camera *camera = &picture->camera;
    int x0 = panel->left + (int)lrint(camera->left + camera->scale * left);
    int y0 = panel->top + (int)lrint(camera->top - camera->scale * (bottom + high));
    int columns = (int)lrint(camera->scale * wide), rows = (int)lrint(camera->scale * high);
    if (x0 < panel->left || y0 < panel->top || x0 + columns > panel->right || y0 + rows > panel->bottom) {
        error_input(error, picture->runs[0]->scene, "the picture does not show all of the figure's window");
        return NULL;
    }
    Image *window = image_create(columns, rows, error);
    for (int y = 0; window != NULL && y < rows; y++)
        memcpy(window->pixels + (size_t)y * (size_t)columns * 4,
               frame->pixels + ((size_t)(y0 + y) * (size_t)frame->width + (size_t)x0) * 4, (size_t)columns * 4);
    return window;
}

static Image *render_last(const Trajectory *run, Error *error) {
    const RenderOptions options = {.width = RENDER_WIDTH, .height = RENDER_HEIGHT};
    Picture picture;
    if (!picture_plan(&picture, &run, 1, options.width, options.height, error)) return NULL;
    Image *image = image_create(options.width, options.height, error), *window = NULL;
    Renderer *renderer = image != NULL ? renderer_create(&run, 1, &options, error) : NULL;
    if (renderer != NULL && renderer_draw(renderer, run->frames - 1, image, error))
        window = cut_window(image, &picture, error);
    renderer_destroy(renderer);
    image_destroy(image);
    return window;
}

/* The step of the bomb's first touch; 0 with error set if it never touches. */
static int touching_step(const Scene *scene, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, scene, error)) return 0;
    bool touched = engine_run_to_touch(&run, error);
    engine_run_end(&run);
    return touched ? run.frame : 0;
}

/* The scene's run up to two thirds of the bomb's flight. */
static Trajectory *run_part(const Scene *scene, Error *error) {
    int touch = touching_step(scene, error), begin = scene->bomb.frame;
    if (touch == 0) return NULL;
    Scene part = *scene;
    part.frames = begin + (touch - begin) * 2 / 3;
    part.camera_center = vec2((float)(left + wide / 2), (float)(bottom + high / 2));
    part.camera_size = vec2((float)wide, (float)high);
    Method engine;
    return method_parse(&engine, "engine", error) ? simulate(&part, &engine, NULL, error) : NULL;
}

/* Index of the bomb's state in a frame. */
static size_t bomb_row(const Trajectory *run, int frame) {
    return (size_t)frame * (size_t)run->bodies + (size_t)run->bomb;
}

/* Where the bomb came from and where it goes, at a distance from the bomb itself. */
static void draw_path(Sketch *sketch, const View *view, const Trajectory *run, int begin) {
    const Pen dashed = pen_line(BOMB.fill, 1.8, "(6,5)");
    const size_t first = bomb_row(run, begin), last = bomb_row(run, run->frames - 1);
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
    sketch_arrow(sketch, view_place(view, tail), view_place(view, vec2_add(tail, vec2_scale(seconds, v))), HEAD_AT_END,
                 ACCENT, 2);
}

static int count_boxes(const Scene *scene) {
    int count = 0;
    for (int i = 0; i < scene->body_count; i++) count += !scene->bodies[i].fixed;
    return count;
}

static double bomb_speed(const Trajectory *run) {
    Vec2 v = run->velocity[bomb_row(run, run->frames - 1)];
    return (double)hypotf(v.x, v.y);
}

static void draw_words(Sketch *sketch, const View *view, const char *title, const Scene *scene, const Trajectory *run) {
    const TextStyle heading = {8.5, TEXT_LEFT, INK, 0, false}, words = {7.5, TEXT_LEFT, INK_SOFT, 0, false};
    int boxes = count_boxes(scene);
    sketch_text(sketch, (Point){view->low.x, height - 2.8}, &heading, "%s: %d %s", title, boxes,
                boxes == 1 ? "box" : "boxes");
    sketch_text(sketch, (Point){view->low.x, height - 7}, &words, "Step %d: bomb of %g kg at %.1f m/s", run->frames - 1,
                (double)scene->bomb.body.mass, bomb_speed(run));
}

static bool draw_scene(Sketch *sketch, int i, const Scene *scene, int *step, Error *error) {
    Trajectory *run = run_part(scene, error);
    if (run == NULL) return false;
    const double x = (width - 3 * scale * wide - 2 * gap) / 2 + i * (scale * wide + gap);
    const View view = {{x, low}, {x + scale * wide, low + scale * high}, {left + wide / 2, bottom + high / 2}, scale};
    Image *window = render_last(run, error);
    if (window != NULL) {
        sketch_image(sketch, window, view.low, scale * wide);
        draw_path(sketch, &view, run, scene->bomb.frame);
        draw_words(sketch, &view, titles[i], scene, run);
        sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
        if (i == 0) sketch_scale_bar(sketch, (Point){x + 2.5, low + 1.6}, view.scale, 5, "m", 7.5);
    }
    *step = run->frames - 1;
    image_destroy(window);
    trajectory_destroy(run);
    return window != NULL;
}

static bool draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error) {
    int steps[ILLUSTRATION_SCENES];
    for (int i = 0; i < ILLUSTRATION_SCENES; i++)
        if (!draw_scene(sketch, i, scenes[i], &steps[i], error)) return false;
    snprintf(
        caption, CAPTION_SIZE,
        "The three scenes at one scale, at two thirds of the bomb's flight to its first touch: %d box (single.yaml, "
        "step %d), a stack of %d (stack.yaml, step %d) and a pyramid of %d, still falling into place (pyramid.yaml, "
        "step %d). Dashed: the bomb's start. Arrow: its path in 0.12 s.",
        count_boxes(scenes[0]), steps[0], count_boxes(scenes[1]), steps[1], count_boxes(scenes[2]), steps[2]);
    return true;
}

const Illustration illustration_scenes = {width, height, draw};

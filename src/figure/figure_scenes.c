/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 4: the three scenes with the bomb on its way, by the renderer, with words and measures over its pictures. */
#include "figure/engine_figure.h"
#include "figure/engine_run.h"

#include "render/picture.h"
#include "render/style.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What each picture shows, m; and how. */
static const double left = -8, bottom = -1, wide = 16, high = 22.6;
static const double width = 174, height = 86;          /* mm */
static const double scale = 3.302, gap = 3.2, low = 1; /* mm a metre: 39 pixels at 300 dots an inch; mm */
enum { RENDER_WIDTH = 1300, RENDER_HEIGHT = 1000 };

/* The part of a rendered frame that shows the figure's window. */
static Image *cut_window(const Image *frame, const Picture *picture, Error *error) {
    const Rect *panel = &picture->layout.panels[0];
    const Camera *camera = &picture->camera;
    int x0 = panel->left + (int)lrint(camera->left + camera->scale * left);
    int y0 = panel->top + (int)lrint(camera->top - camera->scale * (bottom + high));
    int columns = (int)lrint(camera->scale * wide), rows = (int)lrint(camera->scale * high);
    if (x0 < 0 || y0 < 0 || x0 + columns > frame->width || y0 + rows > frame->height) {
        error_input(error, picture->panels[0]->scene, "the figure's window is not in the picture");
        return NULL;
    }
    Image *window = image_create(columns, rows, error);
    for (int y = 0; window != NULL && y < rows; y++)
        memcpy(window->pixels + (size_t)y * (size_t)columns * 4,
               frame->pixels + ((size_t)(y0 + y) * (size_t)frame->width + (size_t)x0) * 4, (size_t)columns * 4);
    return window;
}

static Image *render(Trajectory *run, int frame, Error *error) {
    const RenderOptions options = {.width = RENDER_WIDTH, .height = RENDER_HEIGHT};
    const Trajectory *panels[1] = {run};
    Picture picture;
    if (!picture_plan(&picture, panels, 1, options.width, options.height, error)) return NULL;
    Image *image = image_create(options.width, options.height, error), *window = NULL;
    Renderer *renderer = image != NULL ? renderer_create(panels, 1, &options, error) : NULL;
    if (renderer != NULL && renderer_draw(renderer, frame, image, error)) window = cut_window(image, &picture, error);
    renderer_destroy(renderer);
    image_destroy(image);
    return window;
}

static bool draw_scene(Sketch *sketch, int i, const Scene *scene, Error *error) {
    EngineRun to_touch;
    if (!engine_run_begin(&to_touch, scene, error)) return false;
    bool touched = engine_run_to_touch(&to_touch, error);
    engine_run_end(&to_touch);
    if (!touched) return false;
    Scene seen = *scene;
    seen.frames = to_touch.frame * 2 / 3;
    seen.camera_center = vec2((float)(left + wide / 2), (float)(bottom + high / 2));
    seen.camera_size = vec2((float)wide, (float)high);
    Method engine;
    Trajectory *run = method_parse(&engine, "engine", error) ? simulate(&seen, &engine, NULL, error) : NULL;
    Image *window = run != NULL ? render(run, seen.frames, error) : NULL;
    double x = (width - 3 * scale * wide - 2 * gap) / 2 + i * (scale * wide + gap);
    if (window != NULL) fprintf(stderr, "window %d x %d\n", window->width, window->height);
    if (window != NULL) sketch_image(sketch, window, (Point){x, low}, scale * wide);
    image_destroy(window);
    trajectory_destroy(run);
    return window != NULL;
}

static bool draw(Sketch *sketch, Scene *const scenes[FIGURE_SCENES], char caption[CAPTION_SIZE], Error *error) {
    for (int i = 0; i < FIGURE_SCENES; i++)
        if (!draw_scene(sketch, i, scenes[i], error)) return false;
    snprintf(caption, CAPTION_SIZE, "todo");
    return true;
}

const EngineFigure figure_scenes = {width, height, draw};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture, a context and a canvas: single frames. */
#include "render/renderer.h"

#include "render/canvas.h"
#include "render/context.h"
#include "render/style.h"

#include <stdlib.h>

struct Renderer {
    Picture picture;
    Context context;
    GlFunctions gl;
    Canvas *canvas;
    Drawing drawing;
};

static bool set_up(Renderer *renderer, const RenderOptions *options, Error *error) {
    if (!context_create(&renderer->context, options->context, error)) return false;
    const Context *context = &renderer->context;
    if (!gl_load(&renderer->gl, context->kind->find, context->state, error)) return false;
    renderer->canvas = canvas_create(&renderer->gl, options->width, options->height, error);
    return renderer->canvas != NULL;
}

Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error) {
    Renderer *renderer = calloc(1, sizeof *renderer);
    if (renderer == NULL) {
        error_memory(error, "render");
        return NULL;
    }
    renderer->picture = *picture;
    if (set_up(renderer, options, error)) return renderer;
    renderer_destroy(renderer);
    return NULL;
}

Renderer *renderer_create(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                          Error *error) {
    Picture picture;
    if (!picture_plan(&picture, panels, panel_count, options->width, options->height, error)) return NULL;
    return renderer_create_planned(&picture, options, error);
}

bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error) {
    if (frame < 0 || frame >= renderer->picture.frames)
        return error_input(error, "render", "frame %d asked for; the frames are 0 to %d", frame,
                           renderer->picture.frames - 1);
    drawing_clear(&renderer->drawing);
    picture_draw(&renderer->picture, frame, &renderer->drawing);
    return context_make_current(&renderer->context, error) &&
           canvas_paint(renderer->canvas, &renderer->drawing, PAGE, image, error);
}

void renderer_destroy(Renderer *renderer) {
    if (renderer == NULL) return;
    Error ignored = {0};
    if (renderer->canvas != NULL && context_make_current(&renderer->context, &ignored))
        canvas_destroy(renderer->canvas);
    if (renderer->context.kind != NULL) context_destroy(&renderer->context);
    drawing_free(&renderer->drawing);
    free(renderer);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Combines a picture, a context and a canvas. */
#include "render/renderer.h"

#include "common/trace.h"
#include "gl/canvas.h"
#include "gl/context.h"
#include "gl/damage.h"

#include <stdlib.h>
#include <string.h>

struct Renderer {
    Picture picture;
    bool owns_picture;
    Context context;
    GlFunctions gl;
    Canvas *canvas;
    Drawing drawing, before; /* of this frame and of the previous one */
    bool in_sync;            /* the canvas and the caller's image show `drawing` */
    bool *changed;           /* [height] */
};

static void trace(const Context *context) {
    enum { RENDERER = 0x1F01 /* GL_RENDERER */ };
    const GlFunction found = context->kind->find(context->state, "glGetString");
    const unsigned char *(*get_string)(unsigned);
    memcpy(&get_string, &found, sizeof get_string);
    const unsigned char *name = get_string != NULL ? get_string(RENDERER) : NULL;
    trace_line("OpenGL by %s: %s", context->kind->name, name != NULL ? (const char *)name : "no name");
}

static bool set_up(Renderer *renderer, const RenderOptions *options, Error *error) {
    renderer->changed = calloc((size_t)options->height, sizeof *renderer->changed);
    if (renderer->changed == NULL) return error_memory(error, "render");
    if (!context_create(&renderer->context, options->context, error)) return false;
    const Context *context = &renderer->context;
    if (!gl_load(&renderer->gl, context->kind->find, context->state, error)) return false;
    trace(context);
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
    Renderer *renderer = NULL;
    if (picture_apply_options(&picture, options, error)) renderer = renderer_create_planned(&picture, options, error);
    if (renderer == NULL)
        picture_free(&picture);
    else
        renderer->owns_picture = true;
    return renderer;
}

/* `changed` NULL: paint everything. */
static bool paint(Renderer *renderer, const bool *changed, Image *image, Error *error) {
    return context_make_current(&renderer->context, error) &&
           canvas_paint(renderer->canvas, &renderer->drawing, renderer->picture.theme->page, changed, image, error);
}

static bool compose(Renderer *renderer, Moment moment, Error *error) {
    const int frame = moment.frame;
    if (frame < 0 || frame >= renderer->picture.frames)
        return error_input(error, "render", "there is no frame %d; the frames are 0 to %d", frame,
                           renderer->picture.frames - 1);
    drawing_clear(&renderer->drawing);
    picture_draw(&renderer->picture, moment, &renderer->drawing);
    return true;
}

bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error) {
    renderer->in_sync = false;
    return compose(renderer, moment_stored(frame), error) && paint(renderer, NULL, image, error);
}

bool renderer_draw_next(Renderer *renderer, Moment moment, Image *image, const bool **changed, Error *error) {
    const Drawing before = renderer->drawing;
    bool in_sync = renderer->in_sync;
    renderer->in_sync = false; /* until this frame has succeeded */
    renderer->drawing = renderer->before;
    renderer->before = before;
    *changed = renderer->changed;
    if (!compose(renderer, moment, error)) return false;
    bool part = in_sync && damage_find(&renderer->before, &renderer->drawing, image->height, renderer->changed);
    if (!part) memset(renderer->changed, true, (size_t)image->height);
    renderer->in_sync = paint(renderer, part ? renderer->changed : NULL, image, error);
    return renderer->in_sync;
}

void renderer_destroy(Renderer *renderer) {
    if (renderer == NULL) return;
    Error ignored = {0};
    if (renderer->canvas != NULL && context_make_current(&renderer->context, &ignored))
        canvas_destroy(renderer->canvas);
    if (renderer->context.kind != NULL) context_destroy(&renderer->context);
    drawing_free(&renderer->drawing);
    drawing_free(&renderer->before);
    free(renderer->changed);
    if (renderer->owns_picture) picture_free(&renderer->picture);
    free(renderer);
}

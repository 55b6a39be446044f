/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws pictures in this process: the texts of their files, frames of a sequence, still bodies. */
#include "base/base.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add(FrameTexts *texts, const char *key, const char *value) {
    texts->entries[texts->count++] = (ImageText){key, value};
}

void frame_part_text(char *text, size_t size, Moment moment) {
    snprintf(text, size, "%d/%d", moment.part, moment.parts);
}

void frame_texts_fill(FrameTexts *texts, const Picture *picture, Moment moment) {
    bool networks = false;
    texts->methods[0] = texts->states[0] = texts->networks[0] = '\0';
    texts->count = 0;
    for (int i = 0; i < picture->count; i++) {
        const Trajectory *run = picture->runs[i];
        const int shown = picture_run_frame(picture, i, moment.frame);
        text_join(texts->methods, sizeof texts->methods, " | ", "%s", run->method);
        text_join(texts->states, sizeof texts->states, " | ", "%016" PRIx64, trajectory_frame_hash(run, shown));
        text_join(texts->networks, sizeof texts->networks, " | ", run->network_hash == 0 ? "none" : "%016" PRIx64,
                  run->network_hash);
        networks |= run->network_hash != 0;
    }
    snprintf(texts->frame, sizeof texts->frame, "%d", moment.frame);
    frame_part_text(texts->part, sizeof texts->part, moment);
    add(texts, "Scene", picture->runs[0]->scene);
    add(texts, "Method", texts->methods);
    if (networks) add(texts, "Network", texts->networks);
    add(texts, "Frame", texts->frame);
    if (moment.kind == MOMENT_BETWEEN) add(texts, "Part", texts->part);
    if (moment.kind == MOMENT_TITLE) add(texts, "Card", "title");
    if (moment.kind == MOMENT_END) add(texts, "Card", "end");
    add(texts, "State", texts->states);
    add(texts, "Software", "twinbox");
}

/* A context and what is drawn in it. */
typedef struct Painter {
    Context context;
    GlFunctions gl;
    Canvas *canvas;
} Painter;

/* painter_close() also after a failure. */
static bool painter_open(Painter *painter, ContextChoice choice, int width, int height, bool traced, Error *error) {
    enum { RENDERER = 0x1F01 /* GL_RENDERER */ };
    Context *context = &painter->context;
    if (!context_create(context, choice, error) || !gl_load(&painter->gl, context->kind->find, context->state, error))
        return false;
    if (traced) {
        const unsigned char *name = painter->gl.GetString(RENDERER);
        trace_line("OpenGL by %s: %s", context->kind->name, name != NULL ? (const char *)name : "no name");
    }
    painter->canvas = canvas_create(&painter->gl, width, height, error);
    return painter->canvas != NULL;
}

static void painter_close(Painter *painter) {
    if (painter->canvas != NULL && context_make_current(&painter->context, &(Error){0}))
        canvas_destroy(painter->canvas);
    if (painter->context.kind != NULL) context_destroy(&painter->context);
}

struct Renderer {
    Picture picture;
    bool owns_picture;
    Painter painter;
    Drawing drawing, before; /* of this frame and of the previous one */
    bool in_sync;            /* the canvas and the caller's image show `drawing` */
    Damage damage;           /* since `before` */
};

Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error) {
    Renderer *renderer = calloc(1, sizeof *renderer);
    if (renderer == NULL) return error_memory(error, "render"), NULL;
    renderer->picture = *picture;
    if (damage_init(&renderer->damage, options->width, options->height, error) &&
        painter_open(&renderer->painter, options->context, options->width, options->height, true, error))
        return renderer;
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

/* `damage` NULL: paint everything. */
static bool paint(Renderer *renderer, const Damage *damage, Image *image, Error *error) {
    return context_make_current(&renderer->painter.context, error) &&
           canvas_paint(renderer->painter.canvas, &renderer->drawing, renderer->picture.theme->page, damage, image,
                        error);
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
    *changed = renderer->damage.rows;
    if (!compose(renderer, moment, error)) return false;
    const bool part = damage_find(&renderer->damage, in_sync ? &renderer->before : NULL, &renderer->drawing);
    renderer->in_sync = paint(renderer, part ? &renderer->damage : NULL, image, error);
    return renderer->in_sync;
}

void renderer_destroy(Renderer *renderer) {
    if (renderer == NULL) return;
    painter_close(&renderer->painter);
    drawing_free(&renderer->drawing);
    drawing_free(&renderer->before);
    damage_free(&renderer->damage);
    if (renderer->owns_picture) picture_free(&renderer->picture);
    free(renderer);
}

/* Bodies on a transparent background. Frames are opaque: drawing on black and on white gives alpha from the
   difference. */

struct Still {
    Painter painter;
    Drawing drawing;
    Image *on_white;
};

Still *still_create(int width, int height, Error *error) {
    if (width < 1 || height < 1 || width > RENDER_SIDE_MAX || height > RENDER_SIDE_MAX)
        return error_input(error, "render", "each side of the picture must be 1 to %d pixels (got %d x %d)",
                           RENDER_SIDE_MAX, width, height),
               NULL;
    Still *still = calloc(1, sizeof *still);
    if (still == NULL) return error_memory(error, "render"), NULL;
    still->on_white = image_create(width, height, error);
    if (still->on_white != NULL && painter_open(&still->painter, CONTEXT_AUTO, width, height, false, error))
        return still;
    still_destroy(still);
    return NULL;
}

void still_destroy(Still *still) {
    if (still == NULL) return;
    painter_close(&still->painter);
    drawing_free(&still->drawing);
    image_destroy(still->on_white);
    free(still);
}

/* A picture of one panel without margins, in the requested colours. */
static Picture picture_of(const Still *still, const StillShot *shot) {
    Picture picture = {.count = 1,
                       .frames = shot->run->frames,
                       .camera = shot->camera,
                       .theme = theme_get(LOOK_LIGHT),
                       .look.labels = shot->labels,
                       .labels_apart = true,
                       .label_least = shot->label_least};
    picture.layout.panels[0] = (Rect){0, 0, still->on_white->width, still->on_white->height};
    picture.runs[0] = shot->run;
    picture.colours[0].light = shot->colours;
    return picture;
}

bool still_label(const Still *still, const StillShot *shot, int body, StillLabel *label) {
    const Picture picture = picture_of(still, shot);
    const BodyColors *colours = body == shot->run->bomb ? &picture.theme->bomb : &shot->colours;
    const Shape shape = body_shape(&picture, 0, 0, moment_stored(shot->frame), body, colours);
    BodyLabel found;
    if (!trajectory_has(shot->run, shot->frame, body) || !body_label(&picture, 0, 0, body, &shape, &found))
        return false;
    *label = (StillLabel){.at = {shape.x, shape.y}, .size = found.font.pixels, .ink = found.ink};
    snprintf(label->text, sizeof label->text, "%s", found.text);
    return true;
}

bool still_draw(Still *still, const StillShot *shot, Image *image, Error *error) {
    const Picture picture = picture_of(still, shot);
    const Moment moment = moment_stored(shot->frame);
    Drawing *drawing = &still->drawing;
    drawing_clear(drawing);
    if ((shot->parts & STILL_FIXED) != 0) body_draw_all(&picture, 0, 0, moment, true, drawing);
    if ((shot->parts & STILL_MOVING) != 0) {
        body_draw_all(&picture, 0, 0, moment, false, drawing);
        if (shot->run->bomb >= 0) body_draw(&picture, 0, 0, moment, shot->run->bomb, drawing);
    }
    if (!context_make_current(&still->painter.context, error) ||
        !canvas_paint(still->painter.canvas, drawing, 0x000000, NULL, image, error) ||
        !canvas_paint(still->painter.canvas, drawing, 0xFFFFFF, NULL, still->on_white, error))
        return false;

    /* Colour and alpha of a pixel follow from its values on black and on white. */
    for (size_t at = 0; at < 4 * (size_t)image->width * (size_t)image->height; at += 4) {
        uint8_t *black = image->pixels + at;
        const int alpha = 255 - (still->on_white->pixels[at + 1] - black[1]);
        for (int i = 0; i < 3; i++) {
            const int colour = alpha > 0 ? (black[i] * 255 + alpha / 2) / alpha : 0;
            black[i] = (uint8_t)(colour < 255 ? colour : 255);
        }
        black[3] = (uint8_t)(alpha < 255 ? alpha : 255);
    }
    return true;
}

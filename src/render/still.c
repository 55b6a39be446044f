/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames are opaque: drawing on black and on white gives alpha from the difference. */
#include "render/still.h"

#include "gl/canvas.h"
#include "gl/context.h"
#include "picture/body.h"

#include <stdlib.h>

struct Still {
    Context context;
    GlFunctions gl;
    Canvas *canvas;
    Drawing drawing;
    Image *on_white;
};

static bool set_up(Still *still, int width, int height, Error *error) {
    if (width < 1 || height < 1 || width > RENDER_SIDE_MAX || height > RENDER_SIDE_MAX)
        return error_input(error, "render", "each side of the picture must be 1 to %d pixels (got %d x %d)",
                           RENDER_SIDE_MAX, width, height);
    if ((still->on_white = image_create(width, height, error)) == NULL ||
        !context_create(&still->context, CONTEXT_AUTO, error) ||
        !gl_load(&still->gl, still->context.kind->find, still->context.state, error))
        return false;
    still->canvas = canvas_create(&still->gl, width, height, error);
    return still->canvas != NULL;
}

Still *still_create(int width, int height, Error *error) {
    Still *still = calloc(1, sizeof *still);
    if (still == NULL) {
        error_memory(error, "render");
        return NULL;
    }
    if (set_up(still, width, height, error)) return still;
    still_destroy(still);
    return NULL;
}

void still_destroy(Still *still) {
    if (still == NULL) return;
    if (still->canvas != NULL && context_make_current(&still->context, &(Error){0})) canvas_destroy(still->canvas);
    if (still->context.kind != NULL) context_destroy(&still->context);
    drawing_free(&still->drawing);
    image_destroy(still->on_white);
    free(still);
}

/* A picture of one panel without margins, in the requested colours. */
static Picture plan(const Still *still, const StillShot *shot) {
    Picture picture = {.count = 1, .frames = shot->run->frames, .camera = shot->camera};
    picture.layout.panels[0] = (Rect){0, 0, still->on_white->width, still->on_white->height};
    picture.runs[0] = shot->run;
    picture.colours[0] = shot->colour;
    picture.theme = theme_get(LOOK_LIGHT);
    return picture;
}

static void draw_bodies(const Picture *picture, const StillShot *shot, Drawing *drawing) {
    const Moment moment = moment_stored(shot->frame);
    if ((shot->parts & STILL_FIXED) != 0) body_draw_all(picture, 0, 0, moment, true, drawing);
    if ((shot->parts & STILL_MOVING) == 0) return;
    body_draw_all(picture, 0, 0, moment, false, drawing);
    if (shot->run->bomb >= 0) body_draw(picture, 0, 0, moment, shot->run->bomb, drawing);
}

/* Computes colour and alpha of a pixel from its values on black and on white. */
static void take_alpha(uint8_t *black, const uint8_t *white) {
    int alpha = 255 - (white[1] - black[1]);
    for (int i = 0; i < 3; i++) {
        int colour = alpha > 0 ? (black[i] * 255 + alpha / 2) / alpha : 0;
        black[i] = (uint8_t)(colour < 255 ? colour : 255);
    }
    black[3] = (uint8_t)(alpha < 255 ? alpha : 255);
}

bool still_draw(Still *still, const StillShot *shot, Image *image, Error *error) {
    const Picture picture = plan(still, shot);
    Drawing *drawing = &still->drawing;
    drawing_clear(drawing);
    draw_bodies(&picture, shot, drawing);
    if (!context_make_current(&still->context, error) ||
        !canvas_paint(still->canvas, drawing, 0x000000, NULL, image, error) ||
        !canvas_paint(still->canvas, drawing, 0xFFFFFF, NULL, still->on_white, error))
        return false;
    for (size_t i = 0; i < 4 * (size_t)image->width * (size_t)image->height; i += 4)
        take_alpha(image->pixels + i, still->on_white->pixels + i);
    return true;
}

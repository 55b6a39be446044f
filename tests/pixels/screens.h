/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A canvas in each kind of context, for tests of single pixels. Include testing.h first. */
#pragma once
#include "made.h"
#include "built_contexts.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"
#include "regression/image_compare.h"

enum { SCREEN_SIDE = 96, SCREENS = 2 };
static const uint32_t BLACK = 0x000000, WHITE = 0xFFFFFF;
static const Rect everything = {0, 0, SCREEN_SIDE, SCREEN_SIDE};

typedef struct Screen {
    ContextChoice wanted;
    Context context;
    GlFunctions gl;
    Canvas *canvas;
    Image *image;
} Screen;

static Screen screens[SCREENS] = {{.wanted = CONTEXT_OSMESA}, {.wanted = CONTEXT_EGL}};
static Drawing drawing;

/* A context that is built in but missing fails the test: both must give equal frames. */
FIXTURE(open_screens) {
    for (int i = 0; i < SCREENS; i++) {
        Screen *s = &screens[i];
        ContextChoice wanted = built_context(s->wanted);
        assert_ok(context_create(&s->context, wanted, &error), error);
        assert_int_equal(s->context.kind->choice, wanted);
        assert_ok(gl_load(&s->gl, s->context.kind->find, s->context.state, &error), error);
        s->canvas = canvas_create(&s->gl, SCREEN_SIDE, SCREEN_SIDE, &error);
        s->image = image_sized(SCREEN_SIDE, SCREEN_SIDE);
        assert_ok(s->canvas != NULL, error);
    }
}

FIXTURE(close_screens) {
    for (int i = 0; i < SCREENS; i++) {
        assert_ok(context_make_current(&screens[i].context, &error), error);
        canvas_destroy(screens[i].canvas);
        context_destroy(&screens[i].context);
        image_destroy(screens[i].image);
    }
    drawing_free(&drawing);
}

/* Paints the drawing over black on every screen, then clears it. All screens must show the same picture. */
static inline const Image *painted(void) {
    for (int i = 0; i < SCREENS; i++) {
        Error error = {0};
        assert_ok(context_make_current(&screens[i].context, &error), error);
        assert_ok(canvas_paint(screens[i].canvas, &drawing, BLACK, NULL, screens[i].image, &error), error);
    }
    ImageDifference difference;
    image_compare_masked(screens[0].image, screens[1].image, NULL, 0, &difference);
    assert_true(difference.equal);
    drawing_clear(&drawing);
    return screens[0].image;
}

static inline const uint8_t *pixel(const Image *image, int x, int y) {
    return image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * 4;
}

static inline uint32_t rgb(const Image *image, int x, int y) {
    const uint8_t *p = pixel(image, x, y);
    return (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
}

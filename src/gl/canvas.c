/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The static layer (background, rectangles, static shapes) is painted once into its own framebuffer. A frame blits
   the changed rows of that layer and adds two instanced draw calls, for shapes and for glyphs, clipped to these
   rows. Row 0 of a framebuffer is the top row of the picture, so no image is flipped. */
#include "gl/canvas.h"

#include "common/memory_limit.h"
#include "gl/font_atlas.h"
#include "gl/program.h"
#include "gl/shaders.h"

#include <stdlib.h>

/* A program and the instance buffer that feeds it. */
typedef struct Batch {
    GLuint program, vertices, buffer;
} Batch;

typedef struct Target {
    GLuint framebuffer, color;
} Target;

struct Canvas {
    const GlFunctions *gl;
    int width, height;
    Target static_layer, picture;
    GLuint font_buffer, font_texture; /* the atlas, then bitmaps of the drawing */
    size_t bitmap_capacity;           /* of the drawing's bitmaps there */
    Batch rects, shapes, glyphs;
    Drawing moving; /* moving instances, clipped to the changed rows */
};

static bool check_gl(const GlFunctions *gl, const char *when, Error *error) {
    const GLenum problem = gl->GetError();
    return problem == GL_NO_ERROR ||
           error_system(error, "render", "OpenGL error 0x%04x%s %s%s", problem,
                        problem == GL_OUT_OF_MEMORY ? " (out of memory)" : "", when, memory_limit().text);
}

static bool create_target(Canvas *canvas, Target *target, Error *error) {
    const GlFunctions *gl = canvas->gl;
    gl->GenRenderbuffers(1, &target->color);
    gl->BindRenderbuffer(GL_RENDERBUFFER, target->color);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, canvas->width, canvas->height);
    gl->GenFramebuffers(1, &target->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target->color);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
    return error_system(error, "render", "OpenGL cannot create a framebuffer of %d x %d pixels%s", canvas->width,
                        canvas->height, memory_limit().text);
}

static void create_font(Canvas *canvas) {
    const GlFunctions *gl = canvas->gl;
    gl->GenBuffers(1, &canvas->font_buffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, canvas->font_buffer);
    gl->BufferData(GL_TEXTURE_BUFFER, font_bitmaps_size, font_bitmaps, GL_STATIC_DRAW);
    gl->GenTextures(1, &canvas->font_texture);
    gl->BindTexture(GL_TEXTURE_BUFFER, canvas->font_texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_R8UI, canvas->font_buffer);
}

/* Attribute i of an instance has components[i] integers; a 0 ends the list. */
static bool create_batch(Canvas *canvas, Batch *batch, const char *name, const char *vertex, const char *fragment,
                         const int *components, GLsizei stride, Error *error) {
    const GlFunctions *gl = canvas->gl;
    if ((batch->program = program_create(gl, name, vertex, fragment, error)) == 0) return false;
    gl->UseProgram(batch->program);
    gl->Uniform2i(gl->GetUniformLocation(batch->program, "size"), canvas->width, canvas->height);
    gl->GenVertexArrays(1, &batch->vertices);
    gl->BindVertexArray(batch->vertices);
    gl->GenBuffers(1, &batch->buffer);
    gl->BindBuffer(GL_ARRAY_BUFFER, batch->buffer);
    size_t offset = 0;
    for (GLuint i = 0; components[i] != 0; offset += sizeof(GLint) * (size_t)components[i++]) {
        gl->EnableVertexAttribArray(i);
        /* OpenGL takes an offset as a pointer. NOLINTNEXTLINE(performance-no-int-to-ptr) */
        gl->VertexAttribIPointer(i, components[i], GL_INT, stride, (const void *)offset);
        gl->VertexAttribDivisor(i, 1);
    }
    return true;
}

static bool setup_gl(Canvas *canvas, Error *error) {
    static const int rect[] = {4, 1, 0}, shape[] = {4, 4, 4, 4, 0}, glyph[] = {4, 2, 0};
    const GlFunctions *gl = canvas->gl;
    if (!create_target(canvas, &canvas->static_layer, error) || !create_target(canvas, &canvas->picture, error) ||
        !create_batch(canvas, &canvas->rects, "shaders/rect", shader_rect_vert, shader_rect_frag, rect,
                      sizeof(RectInstance), error) ||
        !create_batch(canvas, &canvas->shapes, "shaders/shape", shader_shape_vert, shader_shape_frag, shape,
                      sizeof(ShapeInstance), error) ||
        !create_batch(canvas, &canvas->glyphs, "shaders/text", shader_text_vert, shader_text_frag, glyph,
                      sizeof(GlyphInstance), error))
        return false;
    create_font(canvas);
    gl->Viewport(0, 0, canvas->width, canvas->height);
    gl->Disable(GL_DITHER);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE); /* alpha stays 1 */
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    return check_gl(gl, "in set-up", error);
}

Canvas *canvas_create(const GlFunctions *gl, int width, int height, Error *error) {
    Canvas *canvas = calloc(1, sizeof *canvas);
    if (canvas == NULL) {
        error_memory(error, "render");
        return NULL;
    }
    canvas->gl = gl;
    canvas->width = width;
    canvas->height = height;
    if (setup_gl(canvas, error)) return canvas;
    canvas_destroy(canvas);
    return NULL;
}

static void destroy_batch(const GlFunctions *gl, Batch *batch) {
    gl->DeleteProgram(batch->program);
    gl->DeleteVertexArrays(1, &batch->vertices);
    gl->DeleteBuffers(1, &batch->buffer);
}

static void destroy_target(const GlFunctions *gl, Target *target) {
    gl->DeleteFramebuffers(1, &target->framebuffer);
    gl->DeleteRenderbuffers(1, &target->color);
}

void canvas_destroy(Canvas *canvas) {
    if (canvas == NULL) return;
    const GlFunctions *gl = canvas->gl;
    destroy_batch(gl, &canvas->rects);
    destroy_batch(gl, &canvas->shapes);
    destroy_batch(gl, &canvas->glyphs);
    gl->DeleteTextures(1, &canvas->font_texture);
    gl->DeleteBuffers(1, &canvas->font_buffer);
    destroy_target(gl, &canvas->static_layer);
    destroy_target(gl, &canvas->picture);
    drawing_free(&canvas->moving);
    free(canvas);
}

static void draw(const GlFunctions *gl, const Batch *batch, const void *instances, size_t count, size_t size) {
    if (count == 0) return;
    gl->UseProgram(batch->program);
    gl->BindVertexArray(batch->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, batch->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * size), instances, GL_STREAM_DRAW);
    gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
}

/* The atlas stays in the buffer unless it has to grow. */
static void load_bitmaps(Canvas *canvas, const Drawing *drawing) {
    const GlFunctions *gl = canvas->gl;
    if (drawing->bitmap_size == 0) return;
    gl->BindBuffer(GL_TEXTURE_BUFFER, canvas->font_buffer);
    if (drawing->bitmap_size > canvas->bitmap_capacity) {
        canvas->bitmap_capacity = drawing->bitmap_capacity;
        gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(font_bitmaps_size + canvas->bitmap_capacity), NULL,
                       GL_STATIC_DRAW);
        gl->BufferSubData(GL_TEXTURE_BUFFER, 0, font_bitmaps_size, font_bitmaps);
        gl->TexBuffer(GL_TEXTURE_BUFFER, GL_R8UI, canvas->font_buffer);
    }
    gl->BufferSubData(GL_TEXTURE_BUFFER, font_bitmaps_size, (GLsizeiptr)drawing->bitmap_size, drawing->bitmaps);
}

static void paint_static(const Canvas *canvas, const Drawing *drawing, uint32_t background) {
    const GlFunctions *gl = canvas->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, canvas->static_layer.framebuffer);
    gl->ClearColor((float)(background >> 16 & 255) / 255, (float)(background >> 8 & 255) / 255,
                   (float)(background & 255) / 255, 1);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->Disable(GL_BLEND);
    draw(gl, &canvas->rects, drawing->rects, drawing->rect_count, sizeof *drawing->rects);
    gl->Enable(GL_BLEND);
    draw(gl, &canvas->shapes, drawing->shapes, drawing->static_shapes, sizeof *drawing->shapes);
}

/* Consecutive rows to paint. */
typedef struct Band {
    int top, bottom;
} Band;

/* The first band at or below row y; empty if there is none. */
static Band next_band(const Canvas *canvas, const bool *changed, int y) {
    if (changed == NULL) return (Band){y, canvas->height};
    while (y < canvas->height && !changed[y]) y++;
    Band band = {y, y};
    while (band.bottom < canvas->height && changed[band.bottom]) band.bottom++;
    return band;
}

/* One blit per band, but one draw call per batch for all bands: calls cost more than instances. */
static void paint_changed_rows(Canvas *canvas, const Drawing *drawing, const bool *changed) {
    const GlFunctions *gl = canvas->gl;
    Drawing *moving = &canvas->moving;
    drawing_clear(moving);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, canvas->static_layer.framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, canvas->picture.framebuffer);
    for (Band b = next_band(canvas, changed, 0); b.top < b.bottom; b = next_band(canvas, changed, b.bottom)) {
        gl->BlitFramebuffer(0, b.top, canvas->width, b.bottom, 0, b.top, canvas->width, b.bottom, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
        drawing_add_rows(moving, drawing, b.top, b.bottom);
    }
    draw(gl, &canvas->shapes, moving->shapes, moving->shape_count, sizeof *moving->shapes);
    draw(gl, &canvas->glyphs, moving->glyphs, moving->glyph_count, sizeof *moving->glyphs);
}

static void read_back(const Canvas *canvas, const bool *changed, Image *image) {
    const GlFunctions *gl = canvas->gl;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, canvas->picture.framebuffer);
    for (Band b = next_band(canvas, changed, 0); b.top < b.bottom; b = next_band(canvas, changed, b.bottom))
        gl->ReadPixels(0, b.top, canvas->width, b.bottom - b.top, GL_RGBA, GL_UNSIGNED_BYTE,
                       image->pixels + (size_t)b.top * (size_t)canvas->width * 4);
}

bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, const bool *changed, Image *image,
                  Error *error) {
    if (drawing->failed) return error_memory(error, "render");
    load_bitmaps(canvas, drawing);
    if (changed == NULL) paint_static(canvas, drawing, background);
    paint_changed_rows(canvas, drawing, changed);
    if (canvas->moving.failed) return error_memory(error, "render");
    read_back(canvas, changed, image);
    return check_gl(canvas->gl, "in a frame", error);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three instanced draw calls a frame: all rectangles, all shapes, all glyphs. Row 0 of the framebuffer is the
   top row of the picture, so that nothing has to be turned over. */
#include "render/canvas.h"

#include "render/font_atlas.h"
#include "render/program.h"
#include "render/shaders.h"

#include <stdlib.h>

/* One kind of instance: its program and the buffer that feeds it. */
typedef struct Batch {
    GLuint program, vertices, buffer;
} Batch;

struct Canvas {
    const GlFunctions *gl;
    int width, height;
    GLuint framebuffer, color, font_buffer, font_texture;
    Batch rects, shapes, glyphs;
};

static bool create_framebuffer(Canvas *canvas, Error *error) {
    const GlFunctions *gl = canvas->gl;
    gl->GenRenderbuffers(1, &canvas->color);
    gl->BindRenderbuffer(GL_RENDERBUFFER, canvas->color);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, canvas->width, canvas->height);
    gl->GenFramebuffers(1, &canvas->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, canvas->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, canvas->color);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
    return error_system(error, "render", "OpenGL makes no framebuffer of %d x %d pixels", canvas->width,
                        canvas->height);
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

/* Attribute i of an instance: components[i] integers; the list ends with 0. */
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
        gl->VertexAttribIPointer(i, components[i], GL_INT, stride, (const void *)offset);
        gl->VertexAttribDivisor(i, 1);
    }
    return true;
}

static bool set_up(Canvas *canvas, Error *error) {
    static const int rect[] = {4, 1, 0}, shape[] = {4, 4, 4, 4, 0}, glyph[] = {4, 2, 0};
    const GlFunctions *gl = canvas->gl;
    if (!create_framebuffer(canvas, error) ||
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
    GLenum problem = gl->GetError();
    return problem == GL_NO_ERROR || error_system(error, "render", "OpenGL error 0x%04x in set-up", problem);
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
    if (set_up(canvas, error)) return canvas;
    canvas_destroy(canvas);
    return NULL;
}

static void destroy_batch(const GlFunctions *gl, Batch *batch) {
    gl->DeleteProgram(batch->program);
    gl->DeleteVertexArrays(1, &batch->vertices);
    gl->DeleteBuffers(1, &batch->buffer);
}

void canvas_destroy(Canvas *canvas) {
    if (canvas == NULL) return;
    const GlFunctions *gl = canvas->gl;
    destroy_batch(gl, &canvas->rects);
    destroy_batch(gl, &canvas->shapes);
    destroy_batch(gl, &canvas->glyphs);
    gl->DeleteTextures(1, &canvas->font_texture);
    gl->DeleteBuffers(1, &canvas->font_buffer);
    gl->DeleteFramebuffers(1, &canvas->framebuffer);
    gl->DeleteRenderbuffers(1, &canvas->color);
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

bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, Image *image, Error *error) {
    const GlFunctions *gl = canvas->gl;
    if (drawing->failed) return error_memory(error, "render");
    gl->ClearColor((float)(background >> 16 & 255) / 255, (float)(background >> 8 & 255) / 255,
                   (float)(background & 255) / 255, 1);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->Disable(GL_BLEND);
    draw(gl, &canvas->rects, drawing->rects, drawing->rect_count, sizeof *drawing->rects);
    gl->Enable(GL_BLEND);
    draw(gl, &canvas->shapes, drawing->shapes, drawing->shape_count, sizeof *drawing->shapes);
    draw(gl, &canvas->glyphs, drawing->glyphs, drawing->glyph_count, sizeof *drawing->glyphs);
    gl->ReadPixels(0, 0, canvas->width, canvas->height, GL_RGBA, GL_UNSIGNED_BYTE, image->pixels);
    GLenum problem = gl->GetError();
    return problem == GL_NO_ERROR || error_system(error, "render", "OpenGL error 0x%04x", problem);
}

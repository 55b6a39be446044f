/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shaders, and the painting of drawings with OpenGL. */
#include "base/base.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { LOG_SIZE = 1500 };

static GLuint compile(const GlFunctions *gl, GLenum type, const char *name, const char *source, Error *error) {
    GLuint shader = gl->CreateShader(type);
    GLint ok = 0;
    gl->ShaderSource(shader, 1, &source, NULL);
    gl->CompileShader(shader);
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    char log[LOG_SIZE] = "";
    gl->GetShaderInfoLog(shader, LOG_SIZE, NULL, log);
    error_system(error, name, "the %s shader does not compile: %s", type == GL_VERTEX_SHADER ? "vertex" : "fragment",
                 log);
    gl->DeleteShader(shader);
    return 0;
}

/* Returns a linked program, or 0 with ERROR_SYSTEM and the compiler's log. `name` is used in the message. */
static GLuint program_create(const GlFunctions *gl, const char *name, const char *vertex, const char *fragment,
                             Error *error) {
    GLuint shaders[2] = {compile(gl, GL_VERTEX_SHADER, name, vertex, error), 0}, program = 0;
    if (shaders[0] != 0) shaders[1] = compile(gl, GL_FRAGMENT_SHADER, name, fragment, error);
    if (shaders[1] != 0) {
        GLint ok = 0;
        program = gl->CreateProgram();
        gl->AttachShader(program, shaders[0]);
        gl->AttachShader(program, shaders[1]);
        gl->LinkProgram(program);
        gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
        if (!ok) {
            char log[LOG_SIZE] = "";
            gl->GetProgramInfoLog(program, LOG_SIZE, NULL, log);
            error_system(error, name, "the shaders do not link: %s", log);
            gl->DeleteProgram(program);
            program = 0;
        }
    }
    for (int i = 0; i < 2; i++)
        if (shaders[i] != 0) gl->DeleteShader(shaders[i]);
    return program;
}

/* The static layer (background, rectangles, static shapes) is painted once into its own framebuffer. A frame blits
   the damaged parts of that layer and adds two instanced draw calls, for shapes and for glyphs, clipped to these
   parts. Row 0 of a framebuffer is the top row of the picture, so no image is flipped. */

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
    Drawing moving; /* moving instances, clipped to the damaged parts */
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
    static const int rect[] = {4, 1, 0}, shape[] = {4, 4, 4, 4, 0}, glyph[] = {4, 3, 0};
    const GlFunctions *gl = canvas->gl;
    if (!create_target(canvas, &canvas->static_layer, error) || !create_target(canvas, &canvas->picture, error) ||
        !create_batch(canvas, &canvas->rects, "shaders/rect", shader_rect_vert, shader_rect_frag, rect,
                      sizeof(RectInstance), error) ||
        !create_batch(canvas, &canvas->shapes, "shaders/shape", shader_shape_vert, shader_shape_frag, shape,
                      sizeof(ShapeInstance), error) ||
        !create_batch(canvas, &canvas->glyphs, "shaders/text", shader_text_vert, shader_text_frag, glyph,
                      sizeof(GlyphInstance), error))
        return false;
    gl->GenBuffers(1, &canvas->font_buffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, canvas->font_buffer);
    gl->BufferData(GL_TEXTURE_BUFFER, font_bitmaps_size, font_bitmaps, GL_STATIC_DRAW);
    gl->GenTextures(1, &canvas->font_texture);
    gl->BindTexture(GL_TEXTURE_BUFFER, canvas->font_texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_R8UI, canvas->font_buffer);
    gl->Viewport(0, 0, canvas->width, canvas->height);
    gl->Disable(GL_DITHER);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE); /* alpha stays 1 */
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, canvas->width);
    return check_gl(gl, "in set-up", error);
}

Canvas *canvas_create(const GlFunctions *gl, int width, int height, Error *error) {
    Canvas *canvas = calloc(1, sizeof *canvas);
    if (canvas == NULL) return error_memory(error, "render"), NULL;
    canvas->gl = gl;
    canvas->width = width;
    canvas->height = height;
    if (setup_gl(canvas, error)) return canvas;
    canvas_destroy(canvas);
    return NULL;
}

void canvas_destroy(Canvas *canvas) {
    if (canvas == NULL) return;
    const GlFunctions *gl = canvas->gl;
    const Batch *batches[] = {&canvas->rects, &canvas->shapes, &canvas->glyphs};
    const Target *targets[] = {&canvas->static_layer, &canvas->picture};
    for (int i = 0; i < 3; i++) {
        gl->DeleteProgram(batches[i]->program);
        gl->DeleteVertexArrays(1, &batches[i]->vertices);
        gl->DeleteBuffers(1, &batches[i]->buffer);
    }
    gl->DeleteTextures(1, &canvas->font_texture);
    gl->DeleteBuffers(1, &canvas->font_buffer);
    for (int i = 0; i < 2; i++) {
        gl->DeleteFramebuffers(1, &targets[i]->framebuffer);
        gl->DeleteRenderbuffers(1, &targets[i]->color);
    }
    drawing_free(&canvas->moving);
    free(canvas);
}

static void draw_batch(const GlFunctions *gl, const Batch *batch, const void *instances, size_t count, size_t size) {
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

/* Without damage, the picture is the only part. */
static bool next_part(const Canvas *canvas, const Damage *damage, Rect *part) {
    if (damage != NULL) return damage_next(damage, part);
    const bool first = part->bottom == 0;
    *part = (Rect){0, 0, canvas->width, canvas->height};
    return first;
}

bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, const Damage *damage, Image *image,
                  Error *error) {
    const GlFunctions *gl = canvas->gl;
    if (drawing->failed) return error_memory(error, "render");
    load_bitmaps(canvas, drawing);
    if (damage == NULL) {
        gl->BindFramebuffer(GL_FRAMEBUFFER, canvas->static_layer.framebuffer);
        gl->ClearColor((float)(background >> 16 & 255) / 255, (float)(background >> 8 & 255) / 255,
                       (float)(background & 255) / 255, 1);
        gl->Clear(GL_COLOR_BUFFER_BIT);
        gl->Disable(GL_BLEND);
        draw_batch(gl, &canvas->rects, drawing->rects, drawing->rect_count, sizeof *drawing->rects);
        gl->Enable(GL_BLEND);
        draw_batch(gl, &canvas->shapes, drawing->shapes, drawing->static_shapes, sizeof *drawing->shapes);
    }

    /* One blit per part, but one draw call per batch for all parts: calls cost more than instances. */
    Drawing *moving = &canvas->moving;
    drawing_clear(moving);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, canvas->static_layer.framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, canvas->picture.framebuffer);
    for (Rect p = {0}; next_part(canvas, damage, &p);) {
        gl->BlitFramebuffer(p.left, p.top, p.right, p.bottom, p.left, p.top, p.right, p.bottom, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
        drawing_add_part(moving, drawing, &p);
    }
    draw_batch(gl, &canvas->shapes, moving->shapes, moving->shape_count, sizeof *moving->shapes);
    draw_batch(gl, &canvas->glyphs, moving->glyphs, moving->glyph_count, sizeof *moving->glyphs);
    if (moving->failed) return error_memory(error, "render");

    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, canvas->picture.framebuffer);
    for (Rect p = {0}; next_part(canvas, damage, &p);)
        gl->ReadPixels(p.left, p.top, p.right - p.left, p.bottom - p.top, GL_RGBA, GL_UNSIGNED_BYTE,
                       image->pixels + ((size_t)p.top * (size_t)canvas->width + (size_t)p.left) * 4);
    return check_gl(gl, "in a frame", error);
}

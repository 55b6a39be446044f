/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lower bounds for a renderer of this kind, in ms per frame: copying the pixels, clearing and reading them back, and
   writing a file of the same size. Arguments: DIR WIDTH HEIGHT BYTES. */
#include "base/file.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATED = 50 };

static double copy(Image *to, const Image *from) {
    double start = clock_seconds();
    for (int i = 0; i < REPEATED; i++) {
        from->pixels[i]++; /* otherwise the compiler would merge the copies */
        memcpy(to->pixels, from->pixels, (size_t)from->width * (size_t)from->height * 4);
    }
    return clock_seconds() - start;
}

static double clear_and_read(const GlFunctions *gl, Image *image) {
    GLuint color, framebuffer;
    gl->GenRenderbuffers(1, &color);
    gl->BindRenderbuffer(GL_RENDERBUFFER, color);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, image->width, image->height);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    double start = clock_seconds();
    for (int i = 0; i < REPEATED; i++) {
        gl->ClearColor((float)i / REPEATED, 0, 0, 1);
        gl->Clear(GL_COLOR_BUFFER_BIT);
        gl->ReadPixels(0, 0, image->width, image->height, GL_RGBA, GL_UNSIGNED_BYTE, image->pixels);
    }
    return clock_seconds() - start;
}

static double write_files(const char *directory, const void *data, size_t size, Error *error) {
    double start = clock_seconds();
    for (int i = 0; i < REPEATED; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/floor_%06d", directory, i);
        if (!file_write_soon(path, data, size, error)) return 0;
    }
    return clock_seconds() - start;
}

int main(int argc, char **argv) {
    if (argc != 5) return 2;
    Error error = {0};
    Context context;
    GlFunctions gl;
    Image *a = image_create(atoi(argv[2]), atoi(argv[3]), &error), *b = image_create(a->width, a->height, &error);
    if (!context_create(&context, CONTEXT_AUTO, &error) || !gl_load(&gl, context.kind->find, context.state, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 3;
    }
    double scale = 1000.0 / REPEATED;
    double copied = copy(a, b), read = clear_and_read(&gl, a);
    printf("%.6f %.6f %.6f\n", scale * copied, scale * read,
           scale * write_files(argv[1], b->pixels, (size_t)atol(argv[4]), &error));
    image_destroy(a);
    image_destroy(b);
    context_destroy(&context);
    return 0;
}

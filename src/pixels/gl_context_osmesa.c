/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OSMesa: a context that needs only memory. */
#include "base/base.h"
#include "base/machine.h"
#include "pixels/gl.h"

#include <GL/osmesa.h>
#include <stdlib.h>

enum { SURFACE_SIDE = 16 };

typedef struct Osmesa {
    OSMesaContext(GLAPIENTRY *create)(const int *attributes, OSMesaContext share);
    GLboolean(GLAPIENTRY *make_current)(OSMesaContext, void *, GLenum, GLsizei, GLsizei);
    OSMESAproc(GLAPIENTRY *get_proc_address)(const char *name);
    void(GLAPIENTRY *destroy)(OSMesaContext);
    OSMesaContext context;
    unsigned char surface[SURFACE_SIDE * SURFACE_SIDE * 4]; /* required by OSMesa, never drawn to */
} Osmesa;

static const ContextFunction functions[] = {
    {"OSMesaCreateContextAttribs", offsetof(Osmesa, create)},
    {"OSMesaMakeCurrent", offsetof(Osmesa, make_current)},
    {"OSMesaGetProcAddress", offsetof(Osmesa, get_proc_address)},
    {"OSMesaDestroyContext", offsetof(Osmesa, destroy)},
};

static void destroy(void *state) {
    Osmesa *osmesa = state;
    if (osmesa->context != NULL) osmesa->destroy(osmesa->context);
    free(osmesa);
}

static bool bind_context(void *state) {
    Osmesa *osmesa = state;
    return osmesa->make_current(osmesa->context, osmesa->surface, GL_UNSIGNED_BYTE, SURFACE_SIDE, SURFACE_SIDE);
}

static GlFunction find(void *state, const char *name) { return ((Osmesa *)state)->get_proc_address(name); }

static void *create(Error *error) {
    static const int attributes[] = {OSMESA_FORMAT,
                                     OSMESA_RGBA,
                                     OSMESA_PROFILE,
                                     OSMESA_CORE_PROFILE,
                                     OSMESA_CONTEXT_MAJOR_VERSION,
                                     3,
                                     OSMESA_CONTEXT_MINOR_VERSION,
                                     3,
                                     0};
    Osmesa *osmesa = calloc(1, sizeof *osmesa);
    if (osmesa == NULL) return error_memory(error, "render"), NULL;
    if (context_load("libOSMesa.so.8", "libosmesa6", functions, sizeof functions / sizeof functions[0], osmesa,
                     error)) {
        osmesa->context = osmesa->create(attributes, NULL);
        if (osmesa->context != NULL && bind_context(osmesa)) return osmesa;
        error_system(error, "render", "OSMesa cannot create an OpenGL 3.3 context%s", memory_limit().text);
    }
    destroy(osmesa);
    return NULL;
}

const ContextKind context_osmesa = {CONTEXT_OSMESA, "osmesa", create, bind_context, find, destroy};

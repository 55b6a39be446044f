/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which kind of context, and loading its library. */
#include "render/context.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

static const ContextKind *const kinds[] = {&context_osmesa, &context_egl};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

bool context_load(const char *library, const ContextFunction *functions, int count, void *table,
                  Error *error) {
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (handle == NULL) return error_system(error, "render", "cannot load %s", library);
    for (int i = 0; i < count; i++) {
        void *symbol = dlsym(handle, functions[i].name);
        if (symbol == NULL) return error_system(error, "render", "%s lacks %s", library, functions[i].name);
        memcpy((char *)table + functions[i].offset, &symbol, sizeof symbol);
    }
    return true;
}

/* Frames must be the same on every machine: Mesa's own rasteriser, and no shader cache in the user's home. */
static void prepare_mesa(void) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

static bool create(Context *context, const ContextKind *kind, Error *error) {
    Error reason = {0};
    *context = (Context){kind, kind->create(&reason)};
    if (context->state != NULL) return true;
    return error_system(error, "render", "no OpenGL by %s (%s); the Debian package%s %s should bring it",
                        kind->name, reason.message, strchr(kind->packages, ' ') ? "s" : "", kind->packages);
}

bool context_create(Context *context, RenderContext wanted, Error *error) {
    prepare_mesa();
    if (wanted != RENDER_CONTEXT_AUTO)
        return create(context, wanted == RENDER_CONTEXT_OSMESA ? &context_osmesa : &context_egl, error);
    Error last = {0};
    for (int i = 0; i < KINDS; i++) {
        last = (Error){0};
        if (create(context, kinds[i], &last)) return true;
    }
    *error = last;
    return false;
}

bool context_make_current(const Context *context, Error *error) {
    if (context->kind->make_current(context->state)) return true;
    return error_system(error, "render", "cannot use the OpenGL context of %s", context->kind->name);
}

void context_destroy(Context *context) {
    if (context->state != NULL) context->kind->destroy(context->state);
    context->state = NULL;
}

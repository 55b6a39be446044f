/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choice of a context, and library loading. */
#include "base/base.h"
#include "base/machine.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"

#include <dlfcn.h>
#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

const ContextKind *const context_kinds[] = {
#ifdef TWINBOX_OSMESA
    &context_osmesa,
#endif
#ifdef TWINBOX_EGL
    &context_egl,
#endif
    NULL,
};

const ContextKind *context_kind(ContextChoice wanted) {
    for (int i = 0; context_kinds[i] != NULL; i++)
        if (context_kinds[i]->choice == wanted) return context_kinds[i];
    return NULL;
}

bool context_load(const char *library, const char *package, const ContextFunction *functions, int count, void *table,
                  Error *error) {
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (handle == NULL) {
        /* A library that is there may fail to load as well: for want of memory or descriptors. */
        const char *why = dlerror();
        if (why == NULL || strstr(why, strerror(ENOENT)) != NULL)
            return error_system(error, "render", "cannot load %s; install the Debian package %s", library, package);
        return error_system(error, "render", "cannot load %s: %s%s", library, why, memory_limit().text);
    }
    for (int i = 0; i < count; i++) {
        void *symbol = dlsym(handle, functions[i].name);
        if (symbol == NULL) return error_system(error, "render", "%s has no function %s", library, functions[i].name);
        memcpy((char *)table + functions[i].offset, &symbol, sizeof symbol);
    }
    return true;
}

static bool create(Context *context, const ContextKind *kind, Error *error) {
    *context = (Context){kind, kind->create(error)};
    return context->state != NULL;
}

bool context_create(Context *context, ContextChoice wanted, Error *error) {
    /* Frames must be identical on every machine: force Mesa's software rasteriser. No shader cache in the user's home,
       unless the environment asks for one: it saves a quarter of the start, and is for this processor only. No
       rasteriser threads: they would not survive a fork, and would compete with the other processes of a sequence. */
    setenv("LP_NUM_THREADS", "0", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    setenv("EGL_LOG_LEVEL", "fatal", 0); /* its warnings guess at reasons */
    const ContextKind *kind = context_kind(wanted);
    if (kind != NULL) return create(context, kind, error);
    if (wanted != CONTEXT_AUTO)
        return error_input(error, "render", "twinbox was built without %s; use %s",
                           wanted == CONTEXT_OSMESA ? "osmesa" : "egl", context_kinds[0]->name);
    Error reasons[sizeof context_kinds / sizeof *context_kinds] = {0};
    int count = 0;
    for (; context_kinds[count] != NULL; count++)
        if (create(context, context_kinds[count], &reasons[count])) return true;
    error_system(error, "render", "no OpenGL without a display works");
    for (int i = 0; i < count; i++) error_add(error, "\n%s: %s", context_kinds[i]->name, reasons[i].message);
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

bool gl_load(GlFunctions *gl, GlFunction (*find)(void *state, const char *name), void *state, Error *error) {
    static const ContextFunction functions[] = {
#define ENTRY(type, name) {"gl" #name, offsetof(GlFunctions, name)},
        GL_FUNCTIONS(ENTRY)
#undef ENTRY
    };
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        GlFunction function = find(state, functions[i].name);
        if (function == NULL) return error_system(error, "render", "OpenGL has no function %s", functions[i].name);
        memcpy((char *)gl + functions[i].offset, &function, sizeof function);
    }
    /* Found functions do not prove the version: a loader may return an address for any name. */
    GLint major = 0, minor = 0;
    gl->GetIntegerv(GL_MAJOR_VERSION, &major);
    gl->GetIntegerv(GL_MINOR_VERSION, &minor);
    return major > 3 || (major == 3 && minor >= 3) ||
           error_system(error, "render", "OpenGL 3.3 or newer is needed (found %d.%d)", major, minor);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EGL on Mesa's surfaceless platform: no display server, no window. */
#include "base/base.h"
#include "base/machine.h"
#include "pixels/gl.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <stdlib.h>

typedef struct Egl {
    PFNEGLGETPLATFORMDISPLAYPROC get_platform_display;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLBINDAPIPROC bind_api;
    PFNEGLCHOOSECONFIGPROC choose_config;
    PFNEGLCREATECONTEXTPROC create_context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLGETPROCADDRESSPROC get_proc_address;
    PFNEGLDESTROYCONTEXTPROC destroy_context;
    EGLDisplay display;
    EGLContext context;
} Egl;

static const ContextFunction functions[] = {
    {"eglGetPlatformDisplay", offsetof(Egl, get_platform_display)},
    {"eglInitialize", offsetof(Egl, initialize)},
    {"eglBindAPI", offsetof(Egl, bind_api)},
    {"eglChooseConfig", offsetof(Egl, choose_config)},
    {"eglCreateContext", offsetof(Egl, create_context)},
    {"eglMakeCurrent", offsetof(Egl, make_current)},
    {"eglGetProcAddress", offsetof(Egl, get_proc_address)},
    {"eglDestroyContext", offsetof(Egl, destroy_context)},
};

static bool bind_context(void *state) {
    Egl *egl = state;
    /* The bound API is a state of the thread; other EGL code may have changed it. */
    return egl->bind_api(EGL_OPENGL_API) &&
           egl->make_current(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl->context);
}

static GlFunction find(void *state, const char *name) { return ((Egl *)state)->get_proc_address(name); }

/* The display is shared by the whole process and stays open: another context may use it. */
static void destroy(void *state) {
    Egl *egl = state;
    if (egl->context != EGL_NO_CONTEXT) {
        egl->make_current(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        egl->destroy_context(egl->display, egl->context);
    }
    free(egl);
}

void *context_egl_open(unsigned platform, void *native, int major, int minor, Error *error) {
    Egl *egl = calloc(1, sizeof *egl);
    if (egl == NULL) return error_memory(error, "render"), NULL;
    if (context_load("libEGL.so.1", "libegl1", functions, sizeof functions / sizeof functions[0], egl, error)) {
        static const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                        EGL_NONE};
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     major,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     minor,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        EGLConfig config;
        EGLint count = 0;
        egl->display = egl->get_platform_display(platform, native, NULL);
        if (egl->display != EGL_NO_DISPLAY && egl->initialize(egl->display, NULL, NULL) &&
            egl->bind_api(EGL_OPENGL_API) && egl->choose_config(egl->display, wanted, &config, 1, &count) && count > 0)
            egl->context = egl->create_context(egl->display, config, EGL_NO_CONTEXT, attributes);
        if (egl->context != EGL_NO_CONTEXT && bind_context(egl)) return egl;
        /* EGL gives no reason. With a limit, that is the likely one. */
        const MemoryLimit limit = memory_limit();
        error_system(error, "render", "EGL cannot create a surfaceless OpenGL %d.%d context%s", major, minor,
                     limit.text[0] != '\0' ? limit.text : "; install the Debian package libgl1-mesa-dri");
    }
    destroy(egl);
    return NULL;
}

static void *create(Error *error) {
    return context_egl_open(EGL_PLATFORM_SURFACELESS_MESA, (void *)EGL_DEFAULT_DISPLAY, 3, 3, error);
}

const ContextKind context_egl = {CONTEXT_EGL, "egl", create, bind_context, find, destroy};

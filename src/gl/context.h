/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An OpenGL context without a display: OSMesa or EGL's surfaceless platform. A build has one of them or both (Mesa dropped
   OSMesa in 25.1). Both are loaded at run time, so the program runs if one is missing. Nothing is drawn to the context's
   own surface: the canvas has a framebuffer, so both run the same code. */
#pragma once
#include "common/error.h"
#include "gl/gl_functions.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum ContextChoice { CONTEXT_AUTO, CONTEXT_OSMESA, CONTEXT_EGL } ContextChoice;

typedef struct ContextKind {
    ContextChoice choice;
    const char *name;
    /* Loads the libraries and creates a context; NULL with error set on failure. */
    void *(*create)(Error *error);
    bool (*make_current)(void *state);
    GlFunction (*find)(void *state, const char *name);
    void (*destroy)(void *state);
} ContextKind;

extern const ContextKind context_osmesa, context_egl;

/* Those that are built in, in the order in which CONTEXT_AUTO tries them. NULL ends them. */
extern const ContextKind *const context_kinds[];

typedef struct Context {
    const ContextKind *kind;
    void *state;
} Context;

/* NULL: CONTEXT_AUTO, or not built in. */
const ContextKind *context_kind(ContextChoice wanted);

/* Creates a context of this kind; CONTEXT_AUTO takes the first kind that works. ERROR_SYSTEM names the packages to
   install, ERROR_INPUT a kind that is not built in. */
bool context_create(Context *context, ContextChoice wanted, Error *error);
bool context_make_current(const Context *context, Error *error);
void context_destroy(Context *context);

/* A function to load, and its offset in the struct that holds it. */
typedef struct ContextFunction {
    const char *name;
    size_t offset;
} ContextFunction;

/* Opens a library and fills `table`. The library is never closed: Mesa does not survive it. `package` is its Debian
   package. */
bool context_load(const char *library, const char *package, const ContextFunction *functions, int count, void *table,
                  Error *error);

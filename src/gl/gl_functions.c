/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every line of GL_FUNCTIONS becomes an entry with its name and its offset in the struct. */
#include "gl/gl_functions.h"

#include <stddef.h>
#include <string.h>

typedef struct Entry {
    const char *name;
    size_t offset;
} Entry;

static const Entry entries[] = {
#define ENTRY(type, name) {"gl" #name, offsetof(GlFunctions, name)},
    GL_FUNCTIONS(ENTRY)
#undef ENTRY
};

/* Found functions do not prove the version: a loader may return an address for any name. */
static bool check_version(const GlFunctions *gl, Error *error) {
    GLint major = 0, minor = 0;
    gl->GetIntegerv(GL_MAJOR_VERSION, &major);
    gl->GetIntegerv(GL_MINOR_VERSION, &minor);
    if (major > 3 || (major == 3 && minor >= 3)) return true;
    return error_system(error, "render", "OpenGL 3.3 or newer is needed (found %d.%d)", major, minor);
}

bool gl_load(GlFunctions *gl, GlFunction (*find)(void *state, const char *name), void *state, Error *error) {
    for (size_t i = 0; i < sizeof entries / sizeof entries[0]; i++) {
        GlFunction function = find(state, entries[i].name);
        if (function == NULL) return error_system(error, "render", "OpenGL has no function %s", entries[i].name);
        memcpy((char *)gl + entries[i].offset, &function, sizeof function);
    }
    return check_version(gl, error);
}

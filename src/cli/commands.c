/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of the commands, and the contexts that --version -v lists. */
#include "base/base.h"
#include "cli/cli.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"

/* False with error set, where there is no such context. */
static bool print_used(FILE *file, ContextChoice choice, const char *mark, Error *error) {
    Context context;
    GlFunctions gl;
    if (!context_create(&context, choice, error)) return false;
    bool loaded = gl_load(&gl, context.kind->find, context.state, error);
    if (loaded)
        fprintf(file, "%s: OpenGL %s, %s%s\n", context.kind->name, (const char *)gl.GetString(GL_VERSION),
                (const char *)gl.GetString(GL_RENDERER), mark);
    context_destroy(&context);
    return loaded;
}

void print_contexts(FILE *file) {
    static const ContextChoice choices[] = {CONTEXT_OSMESA, CONTEXT_EGL};
    static const char *const names[] = {"osmesa", "egl"};
    const char *mark = "; used by default";
    for (int i = 0; i < 2; i++) {
        Error error = {0};
        if (context_kind(choices[i]) == NULL)
            fprintf(file, "%s: not built in\n", names[i]);
        else if (print_used(file, choices[i], mark, &error))
            mark = "";
        else
            fprintf(file, "%s: %s\n", names[i], error.message);
    }
}

const char program_summary[] = "Rigid-box physics and neural networks, side by side.";
const char program_begin[] = "twinbox render scenes/stack.yaml -o out/stack --video out/stack.mp4";

#define COMMAND_ENTRY(name, summary, heading) {#name, summary, heading, command_##name},
const Command commands[] = {COMMANDS(COMMAND_ENTRY){0}};

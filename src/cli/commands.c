/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of the commands, and the contexts that --version -v lists. */
#include "base/base.h"
#include "cli/cli.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"

void print_contexts(FILE *file) {
    static const ContextChoice choices[] = {CONTEXT_OSMESA, CONTEXT_EGL};
    static const char *const names[] = {"osmesa", "egl"};
    const char *mark = "; used by default";
    for (int i = 0; i < 2; i++) {
        Error error = {0};
        Context context;
        GlFunctions gl;
        if (context_kind(choices[i]) == NULL) {
            fprintf(file, "%s: not built in\n", names[i]);
            continue;
        }
        bool used = context_create(&context, choices[i], &error);
        if (used) {
            used = gl_load(&gl, context.kind->find, context.state, &error);
            if (used)
                fprintf(file, "%s: OpenGL %s, %s%s\n", context.kind->name, (const char *)gl.GetString(GL_VERSION),
                        (const char *)gl.GetString(GL_RENDERER), mark);
            context_destroy(&context);
        }
        if (used)
            mark = "";
        else
            fprintf(file, "%s: %s\n", names[i], error.message);
    }
}

const char program_summary[] = "Rigid-box physics and neural networks, side by side.";
const char program_begin[] = "twinbox render scenes/stack.yaml -o out/stack --video out/stack.mp4";

#define COMMAND_ENTRY(name, summary, heading) {#name, summary, heading, command_##name},
const Command commands[] = {COMMANDS(COMMAND_ENTRY){0}};

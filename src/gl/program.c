/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gl/program.h"

#include <stddef.h>

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

static bool link_program(const GlFunctions *gl, GLuint program, const char *name, Error *error) {
    GLint ok = 0;
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok) return true;
    char log[LOG_SIZE] = "";
    gl->GetProgramInfoLog(program, LOG_SIZE, NULL, log);
    return error_system(error, name, "the shaders do not link: %s", log);
}

GLuint program_create(const GlFunctions *gl, const char *name, const char *vertex, const char *fragment, Error *error) {
    GLuint shaders[2] = {compile(gl, GL_VERTEX_SHADER, name, vertex, error), 0};
    if (shaders[0] != 0) shaders[1] = compile(gl, GL_FRAGMENT_SHADER, name, fragment, error);
    GLuint program = 0;
    if (shaders[1] != 0) {
        program = gl->CreateProgram();
        gl->AttachShader(program, shaders[0]);
        gl->AttachShader(program, shaders[1]);
        if (!link_program(gl, program, name, error)) {
            gl->DeleteProgram(program);
            program = 0;
        }
    }
    for (int i = 0; i < 2; i++)
        if (shaders[i] != 0) gl->DeleteShader(shaders[i]);
    return program;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compiling and linking GLSL. */
#pragma once
#include "gl/gl_functions.h"

/* A linked program, or 0 with error (ERROR_SYSTEM) holding the compiler's log. `name` is for the message. */
GLuint program_create(const GlFunctions *gl, const char *name, const char *vertex, const char *fragment, Error *error);

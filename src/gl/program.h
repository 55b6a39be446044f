/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compiles and links GLSL. */
#pragma once
#include "gl/gl_functions.h"

/* Returns a linked program, or 0 with ERROR_SYSTEM and the compiler's log. `name` is used in the message. */
GLuint program_create(const GlFunctions *gl, const char *name, const char *vertex, const char *fragment, Error *error);

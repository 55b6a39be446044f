/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The GLSL of shaders/, embedded in the binary by tools/embed.cmake. */
#pragma once

extern const char shader_rect_vert[], shader_rect_frag[];
extern const char shader_shape_vert[], shader_shape_frag[];
extern const char shader_text_vert[], shader_text_frag[];

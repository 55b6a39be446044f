/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inter as an OpenType file; written at build time from src/render/font. */
#pragma once
#include <stddef.h>

extern const unsigned char plot_font[];
extern const size_t plot_font_size;

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inter as an OpenType file, embedded at build time from src/gl/font. */
#pragma once
#include <stddef.h>

extern const unsigned char font_inter_regular_subset_otf[];
extern const size_t font_inter_regular_subset_otf_size;

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inter as an OpenType file; written at build time from src/render/font. */
#pragma once
#include <stddef.h>

extern const unsigned char font_inter_regular_subset_otf[];
extern const size_t font_inter_regular_subset_otf_size;

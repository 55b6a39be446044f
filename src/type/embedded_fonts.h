/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of src/gl/font as bytes. */
#pragma once
#include <stddef.h>

extern const unsigned char font_inter_regular_subset_otf[], font_inter_regular_otf[];
extern const size_t font_inter_regular_subset_otf_size, font_inter_regular_otf_size;

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory for libpng, and for zlib below it. They report a lack of memory as damage of the file, or only warn and skip a
   text; these functions, with a bool as their mem_ptr, set it. */
#pragma once
#include <png.h>

png_voidp png_memory_take(png_structp png, png_alloc_size_t size);
void png_memory_release(png_structp png, png_voidp block);

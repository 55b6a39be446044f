/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture that masks where it is neither black nor transparent. It is decompressed when it is first drawn on a picture of
   its size: a small file of any size costs nothing where it does not fit. Only mask.c includes this. */
#pragma once
#include "image/image.h"

typedef struct MaskPicture MaskPicture;

/* Checks the file without decompressing it. NULL with error set. */
MaskPicture *mask_picture_read(const char *path, Error *error);
void mask_picture_destroy(MaskPicture *picture);

/* Sets the masked bytes to IGNORED_MASK. ERROR_INPUT if `expected`, whose file is `path`, has another size, or if the
   pixels are damaged. Threads may share a picture. */
bool mask_picture_draw(MaskPicture *picture, const Image *expected, const char *path, uint8_t *masked, Error *error);

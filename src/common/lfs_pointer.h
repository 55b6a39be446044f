/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pointers that Git LFS leaves in place of files that were not downloaded: text of about 130 bytes. */
#pragma once
#include "common/error.h"

#include <stddef.h>

/* Sets ERROR_INPUT and returns false if this is the content of a pointer. */
bool lfs_pointer_refuse(const void *data, size_t size, const char *path, Error *error);

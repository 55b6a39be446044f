/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/lfs_pointer.h"

#include <string.h>

bool lfs_pointer_refuse(const void *data, size_t size, const char *path, Error *error) {
    static const char start[] = "version https://git-lfs.github.com/spec/";
    if (size < sizeof start || memcmp(data, start, sizeof start - 1) != 0) return true;
    return error_input(error, path, "a Git LFS pointer, not the file itself; run: git lfs pull");
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An open .npz file. Internal to npz_open.c, which checks the directory, and npz.c, which reads the arrays. */
#pragma once
#include "npz/npy.h"
#include "npz/npz.h"

#include <zip.h>

enum { NPZ_MAX_ARRAYS = 256, NPZ_NAME_SIZE = 64 };

typedef struct StoredArray {
    char name[NPZ_NAME_SIZE]; /* without .npy */
    NpyHead head;
} StoredArray;

struct NpzFile {
    zip_t *archive;
    char *path;
    uint64_t size;       /* of the file, bytes */
    uint64_t budget;     /* bytes that its arrays may take in memory, see npz.h */
    uint64_t bytes_read; /* of that so far */
    bool converts;
    zip_uint64_t count;
    StoredArray arrays[NPZ_MAX_ARRAYS]; /* in the order of the archive */
};

/* NULL if no array has this name. */
const StoredArray *npz_find(const NpzFile *file, const char *name);

/* Sets the error for a failure of libzip at this array, and returns false. */
bool npz_failed(const NpzFile *file, const char *name, zip_error_t *cause, Error *error);

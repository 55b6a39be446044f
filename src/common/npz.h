/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The container of trajectories, datasets and networks: .npz, a zip (libzip) of .npy arrays (NumPy format
   specification, version 1.0), little-endian, C order, no pickle. The same arrays give the same bytes: zip time
   stamps are fixed. Files from outside are hostile: shapes are checked before anything is inflated. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef enum NpzType {
    NPZ_FLOAT32,
    NPZ_FLOAT64,
    NPZ_INT32,
    NPZ_UINT32,
    NPZ_INT64,
    NPZ_UINT64,
    NPZ_UINT8,
    NPZ_TEXT
} NpzType;

enum { NPZ_MAX_RANK = 4 };

/* NPZ_TEXT is always of rank 0: data is a NUL-terminated UTF-8 string, stored as NumPy's '<Un'. */
typedef struct NpzArray {
    const char *name;
    NpzType type;
    int rank;
    int64_t shape[NPZ_MAX_RANK];
    const void *data;
} NpzArray;

/* Writes the arrays as one file, in place only when whole (file_write). */
bool npz_write(const char *path, const NpzArray *arrays, size_t count, Error *error);

typedef struct NpzFile NpzFile;

/* Opens an archive and reads the headers of its arrays (no data yet). NULL with error set ("path: error: ...")
   when it is no archive, is truncated, holds what is no .npy of the types above, or a name twice. */
NpzFile *npz_open(const char *path, Error *error);
void npz_close(NpzFile *file);

/* As it was opened. */
const char *npz_path(const NpzFile *file);

bool npz_has(const NpzFile *file, const char *name);

/* Fills shape[rank] of an array; an error where it is missing or its type or rank is another. */
bool npz_shape(const NpzFile *file, const char *name, NpzType type, int rank, int64_t *shape, Error *error);

/* Inflates one array into a malloc'ed block that the caller frees. Its type, rank and shape must be the ones
   given. An error names path, array, what was found and what was wanted; also when the whole of what has been
   read from this file passes 2 GiB, or the data is damaged (checksum). A rank-0 array is read with shape NULL. */
void *npz_read(NpzFile *file, const char *name, NpzType type, int rank, const int64_t *shape, Error *error);

/* Reads a NPZ_TEXT of at most size - 1 bytes into text. */
bool npz_read_text(NpzFile *file, const char *name, char *text, size_t size, Error *error);

/* The same for a text that gets shown: one with control characters is refused. */
bool npz_read_name(NpzFile *file, const char *name, char *text, size_t size, Error *error);

/* Reads the `size` bytes of an array of rank 0. */
bool npz_read_scalar(NpzFile *file, const char *name, NpzType type, void *value, size_t size, Error *error);

/* That the text `kind` is this one and the int32 `version` this number. */
bool npz_check_kind(NpzFile *file, const char *kind, int32_t version, Error *error);

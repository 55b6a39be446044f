/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The container of trajectories, datasets and networks: .npz, a zip (libzip) of .npy arrays (NumPy format
   specification, version 1.0), little-endian, C order, no pickle. The same arrays give the same bytes: zip time stamps
   are fixed. Files are untrusted: shapes are checked before anything is inflated. */
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
    /* Only read, and only converted to one of the above (npz_convert). */
    NPZ_INT8,
    NPZ_INT16,
    NPZ_UINT16,
    NPZ_BOOL,
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

/* Writes the arrays to one file, atomically (file_write). */
bool npz_write(const char *path, const NpzArray *arrays, size_t count, Error *error);

typedef struct NpzFile NpzFile;

/* Opens an archive and reads the headers of its arrays (no data yet). NULL with error set ("path: error: ...") if it is
   not an archive, is truncated, holds a member that is not a .npy of the types above, a name twice, or more than its
   budget. */
NpzFile *npz_open(const char *path, Error *error);
void npz_close(NpzFile *file);

/* From now on, reading accepts arrays that programs write without a thought for the type: any type of number, big-endian,
   Fortran order, and one number in an array of one dimension as a scalar. It converts them to the type that is read: a
   float64 is rounded to float32. A value out of that type's range is an error, and so is a fraction read as an integer.
   Without this call only the type that is read is accepted. */
void npz_convert(NpzFile *file);

/* The names of all arrays, in the order of the file; NULL from the last on. */
const char *npz_name(const NpzFile *file, size_t index);

/* The path that the file was opened by. */
const char *npz_path(const NpzFile *file);

bool npz_has(const NpzFile *file, const char *name);

/* What the arrays of a file may take in memory together, as they are stored and as they are converted: NPZ_ALWAYS bytes and
   NPZ_RATIO times its size, at most 2 GiB. Files of npz_write() do: its fastest deflate, which large arrays get, shrinks
   zeros to 1/230. A program that deflates better reaches 1/1032, but only with arrays that hold almost nothing. */
#define NPZ_ALWAYS (UINT64_C(16) << 20)
#define NPZ_RATIO UINT64_C(256)
uint64_t npz_budget(uint64_t size);

/* Fills shape[rank] of an array. False with error set if it is missing or has another type or rank. */
bool npz_shape(const NpzFile *file, const char *name, NpzType type, int rank, int64_t *shape, Error *error);

/* False with error set unless the file has all these arrays, each of this type, rank and shape; their data is not used. A
   reader calls this for all its arrays before it inflates the first: a contradiction costs neither time nor memory. */
bool npz_expect(const NpzFile *file, const NpzArray *arrays, size_t count, Error *error);

/* Inflates one array into a malloc'ed block that the caller frees. Its type, rank and shape must be those given; the
   error names path, array, what was found and what was expected. Also an error if all data read from this file exceeds
   its budget or the data is damaged (checksum). A rank-0 array is read with shape NULL. */
void *npz_read(NpzFile *file, const char *name, NpzType type, int rank, const int64_t *shape, Error *error);

/* Reads an NPZ_TEXT of at most size - 1 bytes into text. */
bool npz_read_text(NpzFile *file, const char *name, char *text, size_t size, Error *error);

/* The same for a text that is displayed: refuses control characters. */
bool npz_read_name(NpzFile *file, const char *name, char *text, size_t size, Error *error);

/* Reads a scalar (rank 0) of `size` bytes. */
bool npz_read_scalar(NpzFile *file, const char *name, NpzType type, void *value, size_t size, Error *error);

/* Checks that the text `kind` and the int32 `version` have these values. */
bool npz_check_kind(NpzFile *file, const char *kind, int32_t version, Error *error);

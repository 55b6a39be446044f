/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The container of trajectories, datasets and networks: .npz, a zip (libzip) of .npy arrays (NumPy format
   specification, version 1.0), little-endian, C order, no pickle. The same arrays give the same bytes: zip time stamps
   are fixed. Files are untrusted: shapes are checked before anything is inflated. */
#pragma once
#include "base/base.h"

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
    NPZ_FLOAT16,
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
   not an archive, is truncated, holds a member that is not a .npy, a damaged header, a name twice, or more than its
   budget. An array of a kind that NumPy can store and this library not read (strings, objects, structures, more than
   NPZ_MAX_RANK dimensions) is refused where it is read. */
NpzFile *npz_open(const char *path, Error *error);
void npz_close(NpzFile *file);

/* From now on, reading accepts arrays that programs write without a thought for the type: any type of number,
   big-endian, Fortran order, and one number in an array of one dimension as a scalar. It converts them to the type that
   is read: a float64 is rounded to float32. A value out of that type's range is an error, and so is a fraction read as
   an integer. Without this call only the type that is read is accepted. */
void npz_convert(NpzFile *file);

/* The names of all arrays, in the order of the file; NULL from the last on. */
const char *npz_name(const NpzFile *file, size_t index);

/* The path that the file was opened by. */
const char *npz_path(const NpzFile *file);

bool npz_has(const NpzFile *file, const char *name);

/* True for numbers of 32 or 64 bits that float32 does not hold: float64, and integers. */
bool npz_is_wide(const NpzFile *file, const char *name);

/* What the arrays of a file may take in memory together, as they are stored and as they are converted: NPZ_ALWAYS bytes
   and NPZ_RATIO times its size, at most 2 GiB. Files of npz_write() do: its fastest deflate, which large arrays get,
   shrinks zeros to 1/230. A program that deflates better reaches 1/1032, but only with arrays that hold almost
   nothing. */
#define NPZ_ALWAYS (UINT64_C(16) << 20)
#define NPZ_RATIO UINT64_C(256)
uint64_t npz_budget(uint64_t size);

/* Fills shape[rank] of an array. False with error set if it is missing or has another type or rank. */
bool npz_shape(const NpzFile *file, const char *name, NpzType type, int rank, int64_t *shape, Error *error);

/* False with error set unless the file has all these arrays, each of this type, rank and shape; their data is not used.
   A reader calls this for all its arrays before it inflates the first: a contradiction costs neither time nor
   memory. */
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

/* Writes .npz whose arrays grow by rows while the program works, in bounded memory: of an array at most NPZ_LARGE bytes
   are kept, the rest is in unnamed files beside the output. npz_write() is the same with all arrays given at once, and
   gives the same bytes. */

/* From this size on, an array is packed while it grows. */
enum { NPZ_LARGE = 1 << 20 };

typedef struct NpzStream NpzStream;

/* A stream of at most `most` arrays. NULL with error set if no file can be written at `path`. */
NpzStream *npz_stream_create(const char *path, int most, Error *error);

/* Discards what npz_stream_finish() has not written. */
void npz_stream_destroy(NpzStream *stream);

/* Adds an array and returns its number, from 0. Its data must last until the stream is finished, or is NULL: then
   rows are appended, which shape[0] must not count. -1 with error set. */
int npz_stream_add(NpzStream *stream, const NpzArray *array, Error *error);

/* Appends rows to an array that was added without data. */
bool npz_stream_append(NpzStream *stream, int array, const void *rows, int64_t count, Error *error);

/* Writes the file, atomically. */
bool npz_stream_finish(NpzStream *stream, Error *error);

/* Inside this room: the archive of an .npz, a zip (npz_zip.c). Members are numbered from 0; `array` is the name of one
   in messages. */

typedef struct NpzArchive NpzArchive;

/* Sets the size of the file, bytes. NULL with error set. */
NpzArchive *npz_archive_open(const char *path, uint64_t *size, Error *error);
void npz_archive_close(NpzArchive *archive);

int64_t npz_archive_count(const NpzArchive *archive);

/* The name of a member, valid until the archive is closed; NULL with error set. */
const char *npz_archive_name(NpzArchive *archive, int64_t index, Error *error);

/* Checks the entry of a member, and sets its size, bytes. */
bool npz_archive_check(NpzArchive *archive, int64_t index, const char *array, uint64_t *size, Error *error);

/* Reads the first bytes of a member, at most `size`. Returns their number; -1 with error set. */
int64_t npz_archive_begin(NpzArchive *archive, int64_t index, const char *array, char *text, size_t size, Error *error);

/* Reads the bytes of a member behind the first `head`, of which there must be `size`. */
bool npz_archive_read(NpzArchive *archive, int64_t index, const char *array, size_t head, void *data, uint64_t size,
                      Error *error);

/* Inside this room (npy.c): the header of one .npy array (NumPy format specification), which npz_write.c writes before
   the data of each member and npz.c parses. */

/* Enough for the longest header of four dimensions; a longer one is refused. */
enum { NPY_HEAD_MAX = 512, NPY_REASON_SIZE = 128 };

/* The most that an array or a file may hold. */
#define NPZ_MAX_BYTES (UINT64_C(1) << 31)

typedef struct NpyHead {
    NpzType type;
    bool big_endian, fortran; /* in files of other programs; fortran: the first index runs fastest */
    bool is_foreign;          /* of a kind that cannot be read; the rest is unknown */
    int rank;
    int64_t shape[NPZ_MAX_RANK];
    int64_t characters; /* of NPZ_TEXT, 4 bytes each */
    size_t head_size;   /* bytes before the data */
    uint64_t data_size; /* bytes */
} NpyHead;

const char *npy_type_name(NpzType type);
size_t npy_type_size(NpzType type);

/* Computes data_size from type, shape and characters; false if it exceeds NPZ_MAX_BYTES. */
bool npy_measure(NpyHead *head);

/* Writes the header to text and sets head_size. */
void npy_write_head(NpyHead *head, char text[NPY_HEAD_MAX]);

/* Parses the first `size` bytes of a member; accepts only the form that NumPy writes. False with a reason:
   the header is damaged, or head->is_foreign. */
bool npy_parse_head(NpyHead *head, const char *text, size_t size, char reason[NPY_REASON_SIZE]);

/* Number of items; of a text, its characters. */
size_t npy_count(const NpyHead *head);

/* Reverses the bytes of each item. */
void npy_swap(const NpyHead *head, void *data);

/* Converts data (native byte order, not text) to `type` in C order, in converted[npy_count()]. False with a reason if a
   value does not fit. */
bool npy_convert(const NpyHead *head, const void *data, NpzType type, void *converted, char reason[NPY_REASON_SIZE]);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes .npz whose arrays grow by rows while the program works, in bounded memory: of an array at most NPZ_LARGE bytes
   are kept, the rest is in unnamed files beside the output. npz_write() is the same with all arrays given at once, and
   gives the same bytes. */
#pragma once
#include "npz/npz.h"

/* From this size on, an array is packed while it grows (npz/npz_pack.h). */
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header of one .npy array (NumPy format specification). npz_stream.c writes it before the data of each member,
   npz.c parses it. Only those two and npy_convert.c include this file. */
#pragma once
#include "npz/npz.h"

#include <stdbool.h>

/* Enough for the longest header of four dimensions; a longer one is refused. */
enum { NPY_HEAD_MAX = 512, NPY_REASON_SIZE = 128 };

/* The most that an array or a file may hold. */
#define NPZ_MAX_BYTES (UINT64_C(1) << 31)

typedef struct NpyHead {
    NpzType type;
    bool big_endian, fortran; /* in files of other programs; fortran: the first index runs fastest */
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

/* Parses the first `size` bytes of a member; accepts only the form that NumPy writes. False with a reason. */
bool npy_parse_head(NpyHead *head, const char *text, size_t size, char reason[NPY_REASON_SIZE]);

/* Number of items; of a text, its characters. */
size_t npy_count(const NpyHead *head);

/* Reverses the bytes of each item. */
void npy_swap(const NpyHead *head, void *data);

/* Converts data (native byte order, not text) to `type` in C order, in converted[npy_count()]. False with a reason if a
   value does not fit. */
bool npy_convert(const NpyHead *head, const void *data, NpzType type, void *converted, char reason[NPY_REASON_SIZE]);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The head of one .npy array (NumPy format specification): what npz_write.c puts before the data of each
   member and npz.c takes apart. Only those two include it. */
#pragma once
#include "common/npz.h"

#include <stdbool.h>

/* Enough for the longest head of four dimensions; a longer one is refused. */
enum { NPY_HEAD_MAX = 512, NPY_REASON_SIZE = 128 };

/* No array and no file may hold more. */
#define NPZ_MAX_BYTES (UINT64_C(1) << 31)

typedef struct NpyHead {
    NpzType type;
    int rank;
    int64_t shape[NPZ_MAX_RANK];
    int64_t characters; /* of NPZ_TEXT, 4 bytes each */
    size_t head_size;   /* bytes before the data */
    uint64_t data_size; /* bytes */
} NpyHead;

const char *npy_type_name(NpzType type);

/* Fills data_size from type, shape and characters; false when it passes NPZ_MAX_BYTES. */
bool npy_measure(NpyHead *head);

/* Writes the head to text and fills head_size. */
void npy_write_head(NpyHead *head, char text[NPY_HEAD_MAX]);

/* Takes the first `size` bytes of a member apart, as strictly as NumPy writes them. False with a reason. */
bool npy_parse_head(NpyHead *head, const char *text, size_t size, char reason[NPY_REASON_SIZE]);

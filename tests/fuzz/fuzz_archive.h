/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A .npz with valid checksums and sizes from any bytes, so that readers look at shapes and numbers.

   The bytes are arrays, one after the other (record.py writes them from a .npz):

     kind          bits 0-3: an item's type, in the order of NpzType; NPZ_TEXT; above it the member's own bytes follow
                   16: deflated   32: big-endian, or a text of 4 bytes for each character   64: Fortran order
                   128: version 2 of .npy
     length, name  1 byte, then that many
     rank, shape   1 byte modulo 5, then 2 bytes for each dimension, little-endian; not of texts and own bytes
     length, data  2 bytes, then that many; repeated up to the size of the array, zeros where nothing follows */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* Writes the archive to a file of the fuzzer (fuzz_file) and returns its path. An array that is too large is cut. */
const char *fuzz_archive(const uint8_t *data, size_t size);

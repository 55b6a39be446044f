/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files in and out. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>

/* Reads a regular file of at most `limit` bytes into a malloc'ed block with a NUL behind its last byte (not
   counted in *size). NULL with error set when it is missing, no regular file, too large or unreadable. */
char *file_read(const char *path, size_t limit, size_t *size, Error *error);

/* Puts a whole file in place: writes beside it, fsyncs, renames. Under its name there is either the old file
   or the new one, never a part. */
bool file_write(const char *path, const void *data, size_t size, Error *error);

/* What `print` writes, in the C locale, whose decimal point is a point: a malloc'ed text; NULL when memory is short. */
char *file_print(void (*print)(FILE *out, const void *context), const void *context, size_t *size);

/* Puts in place what `print` writes, as file_print() has it. */
bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error);

/* file_write() for one of many files, without waiting for the disk: still whole or not there, whatever becomes of the
   program, but after a power cut only once file_sync() has returned. Waiting for each file apart takes longer than
   all else that a small frame needs. */
bool file_write_soon(const char *path, const void *data, size_t size, Error *error);

/* Waits until a file, or the names in a directory, are on the disk. */
bool file_sync(const char *path, Error *error);

/* Makes the directory and those above it where missing. */
bool file_make_directory(const char *path, Error *error);

/* Prints a path into path[size], as snprintf does. False with error set where it is longer. */
bool file_path(char *path, size_t size, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* Length of the folder part of a path with its slash: 7 for "scenes/single.yaml", 0 for "single.yaml". */
size_t file_folder_length(const char *path);

/* Turns what does not belong in a file name to '_'. */
void file_name_clean(char *name);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading and writing whole files. The path "-" is standard input or output (common/standard_io.h). */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* Sets an error from errno after a file could not be opened: ERROR_INPUT, unless the system lacks memory or file
   descriptors, or the disk fails. Returns false. */
bool file_open_error(const char *path, Error *error);

/* Reads a regular file of at most `limit` bytes into a malloc'ed block with a NUL behind its last byte (not counted in
   *size). NULL with error set if the file is missing, not regular, too large or unreadable. */
char *file_read(const char *path, size_t limit, size_t *size, Error *error);

/* The same of standard input, up to its end; it may be a pipe. */
char *file_read_input(size_t limit, size_t *size, Error *error);

/* Replaces a file atomically: writes a temporary file in the same folder, fsyncs, renames. */
bool file_write(const char *path, const void *data, size_t size, Error *error);

/* Writes a new file, whole or not at all. ERROR_INPUT if there is one of that name. */
bool file_create(const char *path, const void *data, size_t size, Error *error);

/* file_read() and file_write() for a file `name` of the open directory `folder`, without following links:
   file_read_at() refuses one, file_write_at() replaces it. `path` is used in messages. */
char *file_read_at(int folder, const char *name, const char *path, size_t limit, size_t *size, Error *error);
bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error);

/* Returns the output of `print` as a malloc'ed string, with the C locale's decimal point; NULL when memory is short. */
char *file_print(void (*print)(FILE *out, const void *context), const void *context, size_t *size);

/* Writes the output of `print` to a file: file_print(), then file_write(). */
bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error);

/* file_write() without fsync, for one of many files: atomic if the program ends, but safe from a power cut only after
   file_sync(). An fsync per file takes longer than rendering a small frame. */
bool file_write_soon(const char *path, const void *data, size_t size, Error *error);

/* Writes behind what is in the file; creates it if it is missing. */
bool file_append(const char *path, const void *data, size_t size, Error *error);

/* A file that is written piece by piece: a draft without a name, in the folder of `path`, open for reading and writing.
   The caller closes it. A program that is killed leaves nothing of it. -1 with error set. */
int file_draft(const char *path, Error *error);
bool file_draft_write(int draft, const char *path, const void *data, size_t size, Error *error);

/* Makes the draft that file `path`, atomically, or copies it there if `path` is a pipe or a device. Still to be closed. */
bool file_draft_publish(int draft, const char *path, Error *error);

/* Writes all, or reads all that there is of `size` bytes, also after a signal. file_write_all() is false and file_read_all()
   is -1 with errno set. */
bool file_write_all(int file, const void *data, size_t size);
ssize_t file_read_all(int file, void *data, size_t size);

/* Removes a file, if there is one. */
bool file_remove(const char *path, Error *error);

/* Whether there is a file or folder of that name; false with error set if the system cannot tell. */
bool file_find(const char *path, bool *there, Error *error);

/* Copies an open file from its beginning to where the file `to` stands. False with errno set. */
bool file_copy(int to, int from);

/* Waits until a file, or the entries of a directory, are on the disk. */
bool file_sync(const char *path, Error *error);

/* Creates the directory and its parents where missing. */
bool file_make_directory(const char *path, Error *error);

/* Prints a path into path[size], as snprintf does. False with error set if it does not fit. */
bool file_path(char *path, size_t size, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* Length of the folder part of a path with its slash: 7 for "scenes/single.yaml", 0 for "single.yaml". */
size_t file_folder_length(const char *path);

/* Whether a name has this ending, ".npz", and something before it. */
bool file_name_ends_with(const char *name, const char *ending);

/* Replaces characters that do not belong in a file name by '_'. */
void file_name_clean(char *name);

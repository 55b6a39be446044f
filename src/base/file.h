/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are whole or absent: paths, reading, writing beside the name and renaming, temporary files, locks. */
#pragma once
#include "base/base.h"

#include <limits.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/types.h>

/* Reading and writing whole files. */

/* Reads a regular file of at most `limit` bytes into a malloc'ed block with a NUL behind its last byte (not counted in
   *size). NULL with error set if the file is missing, not regular, too large or unreadable. */
char *file_read(const char *path, size_t limit, size_t *size, Error *error);

/* Opens what file_read() would read, for a caller that reads it in pieces and closes it. *size: its bytes now. -1 with
   error set. */
int file_open(const char *path, size_t limit, size_t *size, Error *error);

/* The same of standard input, up to its end; it may be a pipe. */
char *file_read_input(size_t limit, size_t *size, Error *error);

/* Replaces a file atomically: writes a temporary file in the same folder, fsyncs, renames. */
bool file_write(const char *path, const void *data, size_t size, Error *error);

/* Writes the output of `print` to a file: file_print(), then file_write(). */
bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error);

/* Writes a new file, whole or not at all. ERROR_INPUT if there is one of that name. */
bool file_create(const char *path, const void *data, size_t size, Error *error);

/* file_write() without fsync, for one of many files: atomic if the program ends, but safe from a power cut only after
   file_sync(). An fsync per file takes longer than rendering a small frame. */
bool file_write_soon(const char *path, const void *data, size_t size, Error *error);

/* Waits until a file, or the entries of a directory, are on the disk. */
bool file_sync(const char *path, Error *error);

/* file_read() and file_write() for a file `name` of the open directory `folder`, without following links:
   file_read_at() refuses one, file_write_at() replaces it. `path` is used in messages. */
char *file_read_at(int folder, const char *name, const char *path, size_t limit, size_t *size, Error *error);
bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error);

/* A file that is written piece by piece: a draft without a name, in the folder of `path`, open for reading and writing.
   The caller closes it. A program that is killed leaves nothing of it. -1 with error set. */
int file_draft(const char *path, Error *error);
bool file_draft_write(int draft, const char *path, const void *data, size_t size, Error *error);

/* Makes the draft that file `path`, atomically, or copies it there if `path` is a pipe or a device. Still to be
   closed. */
bool file_draft_publish(int draft, const char *path, Error *error);

/* Writes all, or reads all that there is of `size` bytes, also after a signal. file_write_all() is false and
   file_read_all() is -1 with errno set. */
bool file_write_all(int file, const void *data, size_t size);
ssize_t file_read_all(int file, void *data, size_t size);

/* Copies an open file from its beginning to where the file `to` stands. False with errno set. */
bool file_copy(int to, int from);

/* Sets an error from errno after a file could not be opened: ERROR_INPUT, unless the system lacks memory or file
   descriptors, or the disk fails. Returns false. */
bool file_open_error(const char *path, Error *error);

/* Sets ERROR_INPUT and returns false if this is the content of a pointer that Git LFS leaves in place of a file that
   was not downloaded: text of about 130 bytes. */
bool lfs_pointer_refuse(const void *data, size_t size, const char *path, Error *error);

/* Names of files and folders. */

/* Removes a file, if there is one. */
bool file_remove(const char *path, Error *error);

/* Whether there is a file or folder of that name; false with error set if the system cannot tell. */
bool file_find(const char *path, bool *there, Error *error);

/* Why nothing can be made at the path, from errno: a missing folder, or one such as /proc, is told from the other. */
const char *file_make_cause(const char *path, int cause);

/* Creates the directory and its parents where missing. */
bool file_make_directory(const char *path, Error *error);

/* Where a file may be that is not under its path, as typed; it may return the path itself. NULL: nowhere. The program
   sets it to look among what is installed, so that what names the file keeps its name. */
extern const char *(*file_elsewhere)(const char *path);

/* Prints a path into path[size], as snprintf does. False with error set if it does not fit. */
bool file_path(char *path, size_t size, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* Length of the folder part of a path with its slash: 7 for "scenes/single.yaml", 0 for "single.yaml". */
size_t file_folder_length(const char *path);

/* Whether a name has this ending, ".npz", and something before it. */
bool file_name_ends_with(const char *name, const char *ending);

/* Replaces characters that do not belong in a file name by '_'. */
void file_name_clean(char *name);

/* Text that is printed into memory. */

/* Returns the output of `print` as a malloc'ed string, with the C locale's decimal point; NULL when memory is short. */
char *file_print(void (*print)(FILE *out, const void *context), const void *context, size_t *size);

/* open_memstream(), but memory that runs out sets the stream's error flag: the C library's own stream then drops what
   does not fit, and ferror() and fclose() report success. What cannot be written is dropped from there to the end.

   Returns NULL when memory is short. After fclose(), *text is a malloc'ed string of *size characters, for the caller to
   free, even if writing failed; fflush() makes both current, too. */
FILE *memory_stream(char **text, size_t *size);

/* fwrite() of an array that may be empty, and then NULL. */
static inline void stream_put(FILE *stream, const void *items, size_t size, size_t count) {
    if (count > 0) fwrite(items, size, count, stream);
}

/* The files below a folder. */

typedef struct FolderList {
    char **names; /* [count], relative to the folder ("sub/x.png"), sorted by strcmp */
    size_t count, capacity;
    size_t skipped; /* files in subfolders, if these are not listed */
} FolderList;

/* Lists the files that `wanted` accepts by their own names, also in subfolders if recursive. Hidden files and folders
   are ignored. Links to folders are not followed; links to files are, within the folder.

   ERROR_INPUT for a link that leads out of the folder, or to a hidden place in it: what lies there would be left out
   silently; and for a folder that does not exist. ERROR_SYSTEM if an entry cannot be read: half a list must never pass
   for the whole. On failure nothing needs to be freed. */
bool folder_list(FolderList *list, const char *folder, bool (*wanted)(const char *name), bool recursive, Error *error);
void folder_list_free(FolderList *list);

/* Sets an error from errno after a path could not be opened or inspected: ERROR_INPUT if nothing has that name,
   otherwise ERROR_SYSTEM. Returns false. */
bool folder_error(const char *path, Error *error);

/* The path "-": standard input where a file is read, standard output where one is written. */

bool path_is_standard(const char *path);

/* Opens a copy of standard input, each time from its beginning, so that it can be read more than once and sought.
   The copy has no name. -1 with error set. */
int standard_input_open(Error *error);

/* Whether standard input is a zip archive, as .npz are; false also if it cannot be read. */
bool standard_input_is_zip(void);

/* From now on only the file "-" is written to standard output; what is printed there goes to standard error. False
   with error set if that was done before. */
bool standard_output_reserve(Error *error);
bool standard_output_is_reserved(void);

/* The descriptor of the file "-". */
int standard_output(void);

/* Whether standard output is the file of this status: /dev/stdout may be a regular file. */
bool standard_output_is(const struct stat *status);

/* Makes the folder where missing, and reserves it until this process ends: by an advisory lock on the folder itself, so
   that no file is left when the process is killed. Calls after the first have no effect. Waits for some seconds, as
   children of a process that has ended may still write; then ERROR_SYSTEM. Where the file system has no locks, nothing
   is reserved. */
bool folder_reserve(const char *folder, Error *error);

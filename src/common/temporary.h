/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that get their name when they are whole. Before, they have none where the file system can do that; otherwise, and
   for the moment in which one replaces a file, the name is `.twinbox-MACHINE-PID-....tmp` and the file is locked by flock():
   so a file that a killed process left can be told from one in use, also in a folder that machines share. Functions set
   errno when they fail. */
#pragma once
#include <limits.h>
#include <stdbool.h>

typedef struct TemporaryFile {
    int at;              /* the open directory that names are relative to, or AT_FDCWD */
    int file;            /* open for reading and writing */
    char name[PATH_MAX]; /* "": none */
} TemporaryFile;

/* Opens an empty file in the folder of path. */
bool temporary_open(TemporaryFile *temporary, int at, const char *path);

/* Opens one that never gets a name, after a sweep. Returns the file, or -1. */
int temporary_nameless(const char *path);

/* Gives it the name `path`, instead of a file that has it; EEXIST from temporary_link() if there is one. */
bool temporary_rename(TemporaryFile *temporary, const char *path);
bool temporary_link(TemporaryFile *temporary, const char *path);

/* Removes a temporary name; the file lasts until it is closed. */
bool temporary_remove_name(TemporaryFile *temporary);

/* The same, and closes the file. Leaves errno unchanged. */
void temporary_close(TemporaryFile *temporary);

/* Removes what killed processes of this machine left in the folder of path: once for each folder, as it reads the whole of
   it. Best effort: nothing depends on it. */
void temporary_sweep(int at, const char *path);

/* The folder for temporary files: TMPDIR, or /tmp. */
const char *temporary_files_folder(void);

/* Takes the lock that files in use have, without waiting. False if another process has it, or if the file has lost its
   name to a process that found it unlocked. True where the file system has no locks. */
bool temporary_lock(int file);

/* "MACHINE-PID-", with which names of temporary files and folders begin. Two machines, two starts of one, and two
   containers of one have different names. */
enum { TEMPORARY_OWNER = 48 };
void temporary_owner(char owner[TEMPORARY_OWNER]);

/* Whether the name begins with an owner on this machine whose process has ended. */
bool temporary_owner_ended(const char *name);

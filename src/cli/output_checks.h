/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of output paths before the work begins, so that hours of training do not end in "cannot write". A check
   leaves nothing behind. What may still fail later (a full disk) is reported by the writer. */
#pragma once
#include "base/base.h"

#include <stdbool.h>

/* A file can be written to `path`: its folder exists and takes new files, and the path is no folder. ending: of the
   name, such as ".npz"; NULL: any. "-" (standard output), devices and pipes pass. ERROR_INPUT: another ending, or a
   folder; ERROR_SYSTEM: the folder is missing or takes no files. */
bool output_check_file(const char *path, const char *ending, Error *error);

/* The same for a .npz file of this kind (npz_check_kind; NULL: a run, which has none). ERROR_INPUT also if there is a
   file of another kind: it must not be lost by a mistyped name. */
bool output_check_npz(const char *path, const char *kind, Error *error);

/* ERROR_INPUT for a folder with the name of a file, such as "chart.png", which is a mistake. */
bool output_check_folder_name(const char *path, Error *error);

/* A folder exists and takes new files, or can be made with its parents; and its name. */
bool output_check_folder(const char *path, Error *error);

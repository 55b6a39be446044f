/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accepts the changes that a comparison's report shows. Nothing else changes expected files. */
#pragma once
#include "common/error.h"

typedef struct Approval {
    int replaced, added, removed; /* files of the expected folder */
    int already;                  /* approved earlier */
    int not_shown;                /* failures whose pictures the report omitted; not approved */
    int not_selected;             /* failures whose names do not match */
} Approval;

/* Replaces the expected files of failures by the actual ones, in the folders that results.json in `report` names, and
   removes expected files whose actual file is missing. only: a glob (fnmatch) of file names, or NULL for all.

   Everything is checked before anything is written: names must be plain names of .png and .npz files, and both files
   must be regular files with the hashes in the report; otherwise ERROR_INPUT. Files are written atomically; on_change
   is called after each with "replaced", "added" or "removed". */
bool approve(const char *report, const char *only, void (*on_change)(const char *what, const char *path),
             Approval *approval, Error *error);

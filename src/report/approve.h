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

typedef struct ApprovalRequest {
    const char *report;   /* folder of results.json */
    const char *expected; /* the folder to change; NULL: the one that results.json names, below the current directory */
    const char *only;     /* a glob (fnmatch) of file names; NULL: all */
    void (*on_change)(const char *what, const char *path); /* after each file: "replaced", "added" or "removed" */
} ApprovalRequest;

/* Replaces the expected files of failures by the actual ones, in the folder that results.json names, and removes
   expected files whose actual file is missing.

   Everything is checked before anything is written: names must be plain names of .png and .npz files, and both files
   must be regular files with the hashes in the report; otherwise ERROR_INPUT. Files are written atomically, in folders
   that stay open; no link below the expected folder is followed. */
bool approve(const ApprovalRequest *request, Approval *approval, Error *error);

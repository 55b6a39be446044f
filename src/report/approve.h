/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accepting what a comparison's report has shown: the one way by which an expected picture changes. */
#pragma once
#include "common/error.h"

typedef struct Approval {
    int replaced, added, removed; /* files of the expected folder */
    int already;                  /* that are as approved since an earlier time */
    int not_shown;                /* failures whose pictures the report left out: they stay */
    int not_asked;                /* failures whose names do not match */
} Approval;

/* Puts the actual files of failures in the place of the expected ones, in the folders that results.json of `report` names,
   and takes away the expected ones that were missing. only, NULL or a glob (fnmatch) of file names, picks some.

   Nothing is written before all is checked: names that are plain names of .png and .npz files, both files
   with the bytes that the report was made of, no links. ERROR_INPUT where one is not. Each file is put in place whole; told is
   called after each, with what was done ("replaced", "added", "removed"). */
bool approve(const char *report, const char *only, void (*told)(const char *what, const char *path), Approval *approval,
             Error *error);

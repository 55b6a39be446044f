/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The temporary folder of one run of gnuplot, in TMPDIR or /tmp. It is locked while it is in use: the next one that is made
   removes those that killed processes of this machine left. */
#pragma once
#include "common/error.h"

#include <limits.h>

typedef struct GnuplotFolder {
    char path[PATH_MAX]; /* absolute */
    int lock;
} GnuplotFolder;

bool gnuplot_folder_make(GnuplotFolder *folder, Error *error);

/* With all files in it. ERROR_SYSTEM if one is left. */
bool gnuplot_folder_remove(GnuplotFolder *folder, Error *error);

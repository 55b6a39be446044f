/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that only one process at a time makes, which takes long. */
#pragma once
#include "common/temporary.h"
#include "common/error.h"

typedef struct FileReservation {
    TemporaryFile lock; /* beside the file; what a killed process left is removed as other temporary files are */
} FileReservation;

/* One file at a time. ERROR_SYSTEM names the process that has reserved it. Pipes and devices are not reserved. The
   reservation must last until file_release(), or until the program ends. */
bool file_reserve(FileReservation *reservation, const char *path, Error *error);
bool file_release(FileReservation *reservation, Error *error);

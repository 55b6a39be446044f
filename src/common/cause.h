/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Libraries that read a file report a lack of memory or of descriptors as damage of the file. What they leave in errno
   tells the truth, if it was 0 before. */
#pragma once
#include "common/error.h"

/* Whether this errno says that the machine failed (memory, descriptors, disk), not the file. */
bool cause_is_system(int cause);

/* Sets a system error: "path: error: out of memory", "path: error: cannot read: Input/output error". Returns false. */
bool cause_error(int cause, const char *path, Error *error);

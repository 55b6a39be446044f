/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Advisory locks on open files and folders, for two processes that would write the same. */
#pragma once
#include "common/error.h"

/* Locks until all copies of the open file are closed. Waits shortly for the children of a process that has ended.
   ERROR_SYSTEM names the process that has the lock: "another process (NUMBER) `what`". True where the file system has no
   locks. */
bool lock_take(int file, const char *path, const char *what, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Folders that only one process at a time writes into. */
#pragma once
#include "common/error.h"

/* Makes the folder where missing, and reserves it until this process ends: by an advisory lock on the folder itself, so that
   no file is left when the process is killed. Calls after the first have no effect. Waits shortly for the children of a
   process that has ended. ERROR_SYSTEM names the process that has the folder. Where the file system has no locks, nothing
   is reserved. */
bool folder_reserve(const char *folder, Error *error);

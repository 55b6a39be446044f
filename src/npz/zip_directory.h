/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks a zip's directory before libzip reads it. libzip reads every directory that the last 64 KiB point to, with all
   entries; a malicious file costs it minutes and gigabytes (tests/common/test_npz_hostile.c). */
#pragma once
#include "common/error.h"

#include <stdint.h>

/* False with error set unless the open file ends with the directory of one small zip. */
bool zip_directory_check(int descriptor, uint64_t size, const char *path, Error *error);

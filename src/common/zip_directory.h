/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A look at a zip's directory before libzip sees it. libzip reads every directory that the last 64 KiB point
   to, with all its entries; a file made for that costs it minutes and gigabytes. */
#pragma once
#include "common/error.h"

#include <stdint.h>

/* False with error set unless the open file ends in the directory of a small, plain zip. */
bool zip_directory_check(int descriptor, uint64_t size, const char *path, Error *error);

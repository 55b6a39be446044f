/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of a study of stability, for the terminal. */
#pragma once
#include "common/error.h"

#include <stdbool.h>

/* Prints the borders of folder/stability.csv and what folder/rest.csv has, a block a study, a line a method, and where the
   tables are. */
bool stability_print(const char *folder, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The path "-": standard input where a file is read, standard output where one is written. */
#pragma once
#include "common/error.h"

bool path_is_standard(const char *path);

/* Opens a copy of standard input, each time from its beginning, so that it can be read more than once and sought.
   The copy has no name. -1 with error set. */
int standard_input_open(Error *error);

/* Whether standard input is a zip archive, as .npz are; false also if it cannot be read. */
bool standard_input_is_zip(void);

/* From now on only the file "-" is written to standard output; what is printed there goes to standard error. False
   with error set if that was done before. */
bool standard_output_reserve(Error *error);
bool standard_output_is_reserved(void);

/* The descriptor of the file "-". */
int standard_output(void);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The title of a PDF file that another program wrote. */
#pragma once
#include "common/error.h"

#include <stddef.h>

/* Appends a title as an incremental update (ISO 32000-1, 7.5.6); it replaces the file's other document information. Reads
   cross-reference tables, as cairo 1.16 writes them, and cross-reference streams, as cairo 1.18 does. *pdf is malloc'ed
   and grows. ERROR_SYSTEM, and *pdf is unchanged, if memory is short or the file is neither. */
bool pdf_set_title(char **pdf, size_t *size, const char *title, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory for cmark-gfm, which aborts the program where malloc() fails. */
#pragma once
#include "common/error.h"

/* Calls `work`, which may use cmark-gfm's extensions. cmark-gfm's blocks are freed afterwards, as a whole: neither it nor
   `work` frees any. When memory is short, longjmp leaves both: `work` must hold nothing else while it calls cmark-gfm. False
   with error set then; else what `work` returns. Not thread-safe. */
bool markdown_memory_run(bool (*work)(void *context), void *context, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refuses text that cannot be drawn, before any work is done. */
#pragma once
#include "common/error.h"

/* ERROR_INPUT, which names the character, if the font lacks one, or if the text is not UTF-8; `where`: the option or file
   that it comes from. NULL passes. */
bool type_check(const char *text, const char *where, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "common/error.h"

/* Refuses a title or caption that is too long or cannot be drawn (type/type_check.h); `where`: its option. NULL passes. */
bool caption_check(const char *text, const char *where, Error *error);

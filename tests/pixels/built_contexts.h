/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For tests that draw in both contexts, where the build may have only one. */
#pragma once
#include "pixels/gl.h"

/* The wanted kind if it is built in, else the other. */
static inline ContextChoice built_context(ContextChoice wanted) {
    return context_kind(wanted) != NULL ? wanted : context_kinds[0]->choice;
}

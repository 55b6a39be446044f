/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of names for messages. */
#pragma once
#include "common/error.h"

#include <stddef.h>

/* "a, b, c"; begin with {0}. */
typedef struct NameList {
    size_t used;
    char text[1536];
} NameList;

/* Appends a name that the list does not have yet; ignores it if there is no room. */
void name_list_add(NameList *list, const char *name);

/* The error for a name that a table lacks: "'fo' is not a method; did you mean 'foo'?" or, if no known name is near,
   "'x' is not a method; known: foo, bar", where `what` is "a method". */
bool error_unknown(Error *error, const char *where, const char *name, const char *what, const NameList *known);

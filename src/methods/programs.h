/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The programs behind the methods `exec` and `exec-solver`, as commands and studies know them. */
#pragma once
#include "methods/methods.h"

#include <stdbool.h>

/* Files may name methods, too: of runs that are to be repeated, of
   tables. So only a program is started that an option for methods names, "exec:PROGRAM", alone or in a list; the text
   must outlive the methods. Without a call, none is. */
void programs_allow(const char *methods);

enum { PROGRAM_NAME_SIZE = 48 };

/* What a program says that it is. */
typedef struct ProgramName {
    char name[PROGRAM_NAME_SIZE], version[PROGRAM_NAME_SIZE];
} ProgramName;

/* The first failure of a program in this process; NULL: none. For studies, in which it only ends a run. */
const char *programs_failure(void);

/* False for methods that are no program, or one that has not run yet. */
bool method_program(const Method *method, ProgramName *name);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands of twinbox. Each is one file: option table and glue only. */
#pragma once
#include "common/error.h"

#include <stdbool.h>

/* Exit statuses beside those of ErrorKind. */
enum { STATUS_SAME = 0, STATUS_DIFFERENT = 1 };

typedef struct Command {
    const char *name, *summary;
    /* Returns STATUS_SAME or STATUS_DIFFERENT; with error set, the caller prints it and exits with its kind. argv[0]
       is "twinbox NAME". Bad options and --help end the program from within argp. */
    int (*run)(int argc, char **argv, Error *error);
} Command;

/* All commands, ended by a NULL name. */
extern const Command commands[];

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Python programs within tests: NumPy has the last word on what an .npz is. */
#pragma once
#include "testing.h"

/* Runs a program with a path as its argument by Debian's Python, and fails with its output where it fails.
   Needs python3-numpy. */
static inline void run_python(const char *program, const char *path) {
    const char *script = temporary_path("script.py");
    FILE *out = fopen(script, "w");
    assert_non_null(out);
    fputs(program, out);
    fclose(out);
    char command[1024], output[4096];
    snprintf(command, sizeof command, "/usr/bin/python3 %s %s 2>&1", script, path);
    FILE *python = popen(command, "r");
    assert_non_null(python);
    size_t size = fread(output, 1, sizeof output - 1, python);
    output[size] = '\0';
    if (pclose(python) != 0) fail_msg("%s", output);
}

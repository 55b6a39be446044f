/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Include testing.h first. */
#pragma once
#include "base/process.h"

/* The program, with this file, prints this line first. */
static inline void expect_first_line(const char *program, const char *path, const char *line) {
    Error error = {0};
    Process process;
    char printed[2000];
    assert_ok(process_start(&process, (const char *const[]){program, path, NULL}, &error), error);
    assert_ok(process_finish(&process, printed, sizeof printed, &error), error);
    printed[strcspn(printed, "\n")] = '\0';
    assert_string_equal(printed, line);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Made-up tables in a folder of the test, and the claims that follow from them. */
#pragma once
#include "testing.h"
#include "files.h"

#include "paper/paper.h"

static inline const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

static inline void write_text(const char *name, const char *text) {
    write_bytes(temporary_path(name), text, strlen(text));
}

/* The rows that a system states from its table in the folder. */
static inline char *claims_of(const PaperSystem *system) {
    static char text[8192];
    Error error = {0};
    FILE *lines = fmemopen(text, sizeof text, "w");
    assert_non_null(lines);
    Claims claims = {.lines = lines};
    assert_ok(system_claims_state(system, folder(), &claims, &error), error);
    assert_int_equal(fclose(lines), 0);
    return text;
}

/* "yes partly no" */
static inline void expect_verdicts(const PaperSystem *system, const char *expected) {
    char found[64] = "";
    for (char *line = strtok(claims_of(system), "\n"); line != NULL; line = strtok(NULL, "\n"))
        strcat(strcat(found, found[0] != '\0' ? " " : ""), strrchr(line, ',') + 1);
    assert_string_equal(found, expected);
}

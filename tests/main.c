/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program of a folder's tests: `tests_solvers laws` runs the main() of tests/methods/test_laws.c. TEST_FILES lists
   the files as TEST_FILE(what); tests/CMakeLists.txt writes it. */
#include <stdio.h>
#include <string.h>

#define TEST_FILE(what) int main_##what(void);
#include TEST_FILES
#undef TEST_FILE

static const struct {
    const char *what;
    int (*run)(void);
} files[] = {
#define TEST_FILE(what) {#what, main_##what},
#include TEST_FILES
};

int main(int argc, char **argv) {
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        if (argc == 2 && strcmp(argv[1], files[i].what) == 0) return files[i].run();
    fprintf(stderr, "Usage: %s WHAT, where WHAT is one of:\n", argv[0]);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) fprintf(stderr, "  %s\n", files[i].what);
    return 2;
}

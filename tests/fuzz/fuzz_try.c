/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of targets, and their files. */
#include "fuzz.h"

#include <fcntl.h>
#include <ftw.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct {
    const char *name;
    void (*run)(const uint8_t *data, size_t size);
} targets[] = {
#define FUZZ_ENTRY(name) {#name, fuzz_##name},
    FUZZ_TARGETS(FUZZ_ENTRY)};

enum { TARGETS = sizeof targets / sizeof *targets };

void fuzz_fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("fuzz: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    abort();
}

/* The lowest number of a file that is not open. */
static int next_descriptor(void) {
    const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (file >= 0) close(file);
    return file;
}

bool fuzz_try(const char *target, const uint8_t *data, size_t size) {
    for (int i = 0; i < TARGETS; i++) {
        if (strcmp(targets[i].name, target) != 0) continue;
        const int before = next_descriptor();
        targets[i].run(data, size);
        if (next_descriptor() != before) fuzz_fail("a file stays open");
        return true;
    }
    return false;
}

static char folder[256];

static int remove_entry(const char *path, const struct stat *status, int flag, struct FTW *walk) {
    (void)status, (void)flag, (void)walk;
    return remove(path);
}

static void remove_folder(void) { nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS); }

static void make_folder(void) {
    const char *parent = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/twinbox-fuzz-XXXXXX", parent != NULL && parent[0] != '\0' ? parent : "/tmp");
    if (mkdtemp(folder) == NULL) fuzz_fail("%s: cannot make the folder", folder);
    atexit(remove_folder);
}

const char *fuzz_file(const char *name, const void *data, size_t size) {
    static char paths[4][sizeof folder + 32];
    static int next;
    if (folder[0] == '\0') make_folder();
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0 || write(file, data, size) != (ssize_t)size || close(file) != 0) fuzz_fail("%s: cannot write", path);
    return path;
}

void fuzz_text(char *text, size_t room, const uint8_t *data, size_t size) {
    const size_t length = size < room ? size : room - 1;
    if (length > 0) memcpy(text, data, length);
    text[length] = '\0';
}

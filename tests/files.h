/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files, and what a folder holds. */
#pragma once
#include "testing.h"

#include "base/file.h"

#include <dirent.h>

static inline const char *frame_path(const char *directory, int frame) {
    static char path[4][512];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/frame_%06d.png", directory, frame);
    return path[next];
}

/* Hidden files, too. */
static inline bool is_file_name(const char *name) { return strcmp(name, ".") != 0 && strcmp(name, "..") != 0; }

static inline int count_files(const char *directory, const char *ending) {
    DIR *stream = opendir(directory);
    int count = 0;
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream)) != NULL;) {
        size_t length = strlen(entry->d_name), end = strlen(ending);
        count += is_file_name(entry->d_name) && length >= end && strcmp(entry->d_name + length - end, ending) == 0;
    }
    closedir(stream);
    return count;
}

static inline char *read_whole(const char *path, size_t *size) {
    Error error = {0};
    char *data = file_read(path, 1 << 30, size, &error);
    assert_ok(data != NULL, error);
    return data;
}

static inline char *text_of(const char *path) {
    size_t size;
    return read_whole(path, &size);
}

static inline void assert_file(const char *path, const char *text) {
    size_t size;
    char *data = read_whole(path, &size);
    assert_int_equal(size, strlen(text));
    assert_string_equal(data, text);
    free(data);
}

static inline void assert_same_file(const char *a, const char *b) {
    size_t size_a, size_b;
    char *data_a = read_whole(a, &size_a), *data_b = read_whole(b, &size_b);
    if (size_a != size_b || memcmp(data_a, data_b, size_a) != 0) fail_msg("%s and %s differ", a, b);
    free(data_a);
    free(data_b);
}

/* The same files with the same bytes. */
static inline void assert_same_folder(const char *a, const char *b) {
    char path_a[512], path_b[512];
    DIR *stream = opendir(a);
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream)) != NULL;) {
        if (!is_file_name(entry->d_name)) continue;
        snprintf(path_a, sizeof path_a, "%s/%.200s", a, entry->d_name);
        snprintf(path_b, sizeof path_b, "%s/%.200s", b, entry->d_name);
        assert_same_file(path_a, path_b);
    }
    closedir(stream);
    assert_int_equal(count_files(a, ""), count_files(b, ""));
}

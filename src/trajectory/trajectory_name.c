/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_name.h"

#include "common/file.h"
#include "common/standard_io.h"
#include "common/utf8.h"

#include <string.h>

enum { STEM_SIZE = 2 * TRAJECTORY_NAME_SIZE + 2 };

static void make_stem(const Trajectory *run, char stem[STEM_SIZE]) {
    snprintf(stem, STEM_SIZE, "%s-%s", run->scene, run->method);
    file_name_clean(stem);
}

void trajectory_file_name(const Trajectory *const *runs, int index, char name[TRAJECTORY_FILE_NAME_SIZE]) {
    char stem[STEM_SIZE], other[STEM_SIZE], number[16] = "";
    int same = 1;
    make_stem(runs[index], stem);
    for (int i = 0; i < index; i++) {
        make_stem(runs[i], other);
        same += strcmp(stem, other) == 0;
    }
    if (same > 1) snprintf(number, sizeof number, "-%d", same);
    snprintf(name, TRAJECTORY_FILE_NAME_SIZE, "%s%s.npz", stem, number);
}

void trajectory_name_from_path(const char *path, char name[TRAJECTORY_NAME_SIZE]) {
    const char *file = path_is_standard(path) ? "stdin" : path + file_folder_length(path), *ending = strrchr(file, '.');
    size_t length = ending != NULL && ending > file ? (size_t)(ending - file) : strlen(file), used = 0;
    for (size_t at = 0, width; at < length && used + 4 < TRAJECTORY_NAME_SIZE; at += width > 0 ? width : 1) {
        uint32_t character;
        width = utf8_decode(file + at, length - at, &character);
        if (width == 0 || character < 0x20 || character == 0x7f)
            name[used++] = '_';
        else
            for (size_t i = 0; i < width; i++) name[used++] = file[at + i];
    }
    name[used] = '\0';
}

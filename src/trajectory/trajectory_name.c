/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_name.h"

#include "common/file.h"

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

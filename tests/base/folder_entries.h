/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "testing.h"

#include <dirent.h>
#include <string.h>

/* Hidden ones, too. */
static inline int count_entries(const char *folder) {
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return count;
}

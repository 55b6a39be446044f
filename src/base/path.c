/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of files as text (base/file.h): no file is looked at. */
#include "base/file.h"

#include <ctype.h>
#include <string.h>

bool path_is_standard(const char *path) { return strcmp(path, "-") == 0; }

bool file_name_ends_with(const char *name, const char *ending) {
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && strcmp(name + length - tail, ending) == 0;
}

size_t file_folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

void file_name_clean(char *name) {
    for (char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && strchr("-_.=", *c) == NULL) *c = '_';
    if (name[0] == '.') name[0] = '_';
}

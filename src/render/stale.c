/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/stale.h"

#include "common/file.h"
#include "render/manifest_print.h"
#include "render/sink.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool remove_listed(const Manifest *manifest, const char *line, Error *error) {
    char path[PATH_MAX];
    PictureHashes hashes;
    const int index = manifest_line_read(line, strlen(line), &hashes);
    const char *directory = manifest->options->directory;
    if (index < 0 || (index >= manifest->first && index <= manifest->last)) return true;
    return !sink_frame_path(path, sizeof path, directory, index) || !sink_frame_is(directory, index, hashes.file) ||
           file_remove(path, error);
}

/* Lines longer than those that manifests have are read in pieces, none of which looks like one. */
static bool remove_all(const Manifest *manifest, FILE *list, const char *path, Error *error) {
    char line[MANIFEST_LINE_SIZE];
    while (fgets(line, sizeof line, list) != NULL) {
        const size_t end = strcspn(line, "\n"), begin = strspn(line, " ");
        if (line[end] == '\0' || begin > end) continue;
        line[end > 0 && line[end - 1] == ',' ? end - 1 : end] = '\0';
        if (!remove_listed(manifest, line + begin, error)) return false;
    }
    return !ferror(list) || error_system(error, path, "cannot read: %s", strerror(errno));
}

/* What is not a regular file lists nothing. */
static bool remove_listed_in(const Manifest *manifest, const char *path, Error *error) {
    struct stat status;
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return errno == ENOENT || errno == ELOOP || file_open_error(path, error);
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(file);
        return true;
    }
    FILE *list = fdopen(file, "r");
    if (list == NULL) {
        close(file);
        return error_memory(error, path);
    }
    const bool done = remove_all(manifest, list, path, error);
    fclose(list);
    return done;
}

bool stale_remove(const Manifest *manifest, Error *error) {
    return remove_listed_in(manifest, manifest->path, error) && remove_listed_in(manifest, manifest->journal, error);
}
